"""ROS names as policies write them -> fully qualified names; DDS names; what a wildcard covers (rule S4).

In: the text of a ``<topic>``, ``<service>`` or ``<action>``, with the namespace and node of its profile.
Out: absolute names such as ``/robot/camera/image``, and the DDS names behind them. Nothing here knows about XML
or graphs.

Source: ROS 2 design, article 181 (access control policies); measured on sros2's own ``permissions.xsl``, whose
behaviour is kept even where it surprises (no trimming, no repair of a namespace). Wildcards are POSIX fnmatch
without escape, as Fast DDS and Cyclone DDS read them: ``*`` crosses ``/``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fnmatch import fnmatchcase, translate
from functools import lru_cache
from typing import TYPE_CHECKING

from rosprivacy.analysis.written_names import GLOB_SIGNS, is_glob, meant

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

ACTION_SERVICES = ("cancel_goal", "get_result", "send_goal")
ACTION_TOPICS = ("feedback", "status")
LARGEST_TABLE = 1_000_000  # cells of a comparison of two expressions; larger ones take the careful answer
LAST_CHARACTER = 0x10FFFF

_OUT = {"publish", "request", "call"}
_PART = re.compile(rf"(.+)/_action/({'|'.join(ACTION_SERVICES + ACTION_TOPICS)})", re.DOTALL)

CharSet = tuple[tuple[int, int], ...]  # sorted ranges of code points, both ends included
Token = CharSet | None  # None is *


def resolve(name: str, namespace: str, node: str) -> str:
    """Return the fully qualified form of a name.

    Parameters
    ----------
    name
        As written: ``/absolute``, ``relative`` or ``~private``.
    namespace
        Of the profile, ``/`` or ``/a/b``.
    node
        Base name of the profile's node, without its namespace.

    Examples
    --------
    >>> resolve("scan", "/", "lidar"), resolve("scan", "/robot", "lidar")
    ('/scan', '/robot/scan')
    >>> resolve("~/get_state", "/robot", "lidar")
    '/robot/lidar/get_state'
    """
    if name.startswith("/"):
        return name
    prefix = namespace if namespace.endswith("/") else f"{namespace}/"
    return f"{prefix}{node}{name[1:]}" if name.startswith("~") else prefix + name


@dataclass(frozen=True, slots=True)
class Endpoint:
    """What a role does on one DDS topic.

    Attributes
    ----------
    writes
        True where the node writes, False where it reads.
    kind, name, leg
        The channel that the topic is a part of, with ``x/_action/…`` folded into the action ``x`` (rule S3).
    dds
        Name or expression of the DDS topic.
    """

    writes: bool
    kind: str
    name: str
    leg: str
    dds: str


def endpoints(role: str, kind: str, name: str) -> tuple[Endpoint, ...]:
    """Return the DDS topics that a grant opens, as sros2's ``permissions.xsl`` writes them (rules S2, S3).

    >>> [(e.writes, e.leg, e.dds) for e in endpoints("request", "service", "/add")]
    [(True, 'request', 'rq/addRequest'), (False, 'response', 'rr/addReply')]
    >>> endpoints("publish", "topic", "/spin/_action/status")[0].kind
    'action'
    """
    asks = role in _OUT
    if kind == "topic":
        folded = None if is_pattern(name) else _PART.fullmatch(name)
        if folded and folded[2] in ACTION_TOPICS:
            return (Endpoint(asks, "action", folded[1], "response", f"rt{name}"),)
        return (Endpoint(asks, "topic", name, "", f"rt{name}"),)
    if kind == "service":
        folded = None if is_pattern(name) else _PART.fullmatch(name)
        whole = ("action", folded[1]) if folded and folded[2] in ACTION_SERVICES else ("service", name)
        return (
            Endpoint(asks, *whole, "request", f"rq{name}Request"),
            Endpoint(not asks, *whole, "response", f"rr{name}Reply"),
        )
    return tuple(
        Endpoint(asks if leg == "request" else not asks, "action", name, leg, dds)
        for leg in ("request", "response")
        for dds in dds_names("action", name, leg)
    )


def dds_names(kind: str, name: str, leg: str) -> tuple[str, ...]:
    """Return the DDS topics that make up a channel, or one leg of it.

    >>> dds_names("topic", "/scan", "")
    ('rt/scan',)
    """
    if kind == "topic":
        return (f"rt{name}",)
    if kind == "service":
        return (f"rq{name}Request",) if leg == "request" else (f"rr{name}Reply",)
    if leg == "request":
        return tuple(f"rq{name}/_action/{part}Request" for part in ACTION_SERVICES)
    replies = tuple(f"rr{name}/_action/{part}Reply" for part in ACTION_SERVICES)
    return replies + tuple(f"rt{name}/_action/{part}" for part in ACTION_TOPICS)


def is_pattern(name: str) -> bool:
    """Return whether DDS would read the name as a wildcard expression (rule S4)."""
    return not GLOB_SIGNS.isdisjoint(name)


def literals(pattern: str) -> int:
    """Return how many characters of an expression stand for themselves.

    >>> literals("/cam*"), literals("/[a-z]*")
    (4, 1)
    """
    return sum(token is not None and len(token) == 1 and token[0][0] == token[0][1] for token in _tokens(pattern))


def literal_prefix(pattern: str) -> str:
    """Return what every name that a pattern covers begins with.

    >>> literal_prefix("rt/robot/*/image")
    'rt/robot/'
    """
    return re.split(r"[*?\[]", pattern, maxsplit=1)[0]


def covers(pattern: str, name: str) -> bool:
    """Return whether an expression grants a name, or everything that another expression grants.

    Exact where ``name`` is a name. Where it is a pattern, True is certain and False may mean 'not shown'.

    >>> covers("/robot/*", "/robot/camera/image"), covers("/robot/*", "/other")
    (True, False)
    >>> covers("/robot/*", "/robot/cam*"), covers("/robot/cam?", "/robot/cam*")
    (True, False)
    """
    if not is_pattern(name):
        return fnmatchcase(name, _posix(pattern)) if is_pattern(pattern) else pattern == name
    return pattern == name or _table(_tokens(pattern), _tokens(name), _within)


def matcher(pattern: str) -> Callable[[str], bool]:
    """Return the test whether a plain name is covered, compiled once for many names."""
    match = re.compile(translate(_posix(pattern))).match
    return lambda name: match(name) is not None


def covered(written: str, names: Collection[str]) -> list[str]:
    """Return those of some names that one in a label or another file of a person means wholly, in their order.

    >>> covered("/cam*", ["/camera", "/cam*", "/map"]), covered("=/cam*", ["/camera", "/cam*"])
    (['/camera', '/cam*'], ['/cam*'])
    """
    if not is_glob(written):
        return [meant(written)] if meant(written) in names else []
    plain = matcher(written)
    return [name for name in names if (covers(written, name) if is_pattern(name) else plain(name))]


@lru_cache(maxsize=65536)
def overlaps(a: str, b: str) -> bool:
    """Return whether some name is covered by both expressions; True where it is too large to tell.

    >>> overlaps("/a*", "/*b"), overlaps("/a*", "/b*"), overlaps("/[a-c]", "/[!a]")
    (True, False, True)
    """
    ours, theirs = literal_prefix(a), literal_prefix(b)
    if not (ours.startswith(theirs) or theirs.startswith(ours)):
        return False
    return _table(_tokens(a), _tokens(b), _meets)


def tokens(pattern: str) -> tuple[Token, ...]:
    """Return what an expression stands for, from left to right: sets of characters, and None for ``*``.

    >>> tokens("a*")
    (((97, 97),), None)
    """
    return _tokens(pattern)


def _posix(pattern: str) -> str:
    """``[^…]`` is ``[!…]`` to glibc, but not to Python's fnmatch."""
    return pattern.replace("[^", "[!")


@lru_cache(maxsize=4096)
def _tokens(pattern: str) -> tuple[Token, ...]:
    pattern = _posix(pattern)
    tokens: list[Token] = []
    at = 0
    while at < len(pattern):
        char = pattern[at]
        at += 1
        if char == "*":
            if not tokens or tokens[-1] is not None:
                tokens.append(None)
        elif char == "?":
            tokens.append(((0, LAST_CHARACTER),))
        elif char == "[" and (end := _bracket_end(pattern, at)) >= 0:
            tokens.append(_bracket(pattern[at:end]))
            at = end + 1
        else:
            tokens.append(((ord(char), ord(char)),))
    return tuple(tokens)


def _bracket_end(pattern: str, start: int) -> int:
    """Index of the ``]`` that closes a bracket opened before ``start``, or -1; one right at the start is literal."""
    first = start + 1 if pattern.startswith("!", start) else start
    return pattern.find("]", first + 1)


def _bracket(inside: str) -> CharSet:
    negated = inside.startswith("!")
    chars = inside[1:] if negated else inside
    ranges = []
    at = 0
    while at < len(chars):
        if at + 2 < len(chars) and chars[at + 1] == "-":
            ranges.append((ord(chars[at]), ord(chars[at + 2])))
            at += 3
        else:
            ranges.append((ord(chars[at]), ord(chars[at])))
            at += 1
    merged = _merge(ranges)
    return _complement(merged) if negated else merged


def _merge(ranges: list[tuple[int, int]]) -> CharSet:
    merged: list[tuple[int, int]] = []
    for low, high in sorted(r for r in ranges if r[0] <= r[1]):
        if merged and low <= merged[-1][1] + 1:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        else:
            merged.append((low, high))
    return tuple(merged)


def _complement(ranges: CharSet) -> CharSet:
    gaps = []
    low = 0
    for start, end in ranges:
        if low < start:
            gaps.append((low, start - 1))
        low = end + 1
    return (*gaps, (low, LAST_CHARACTER)) if low <= LAST_CHARACTER else tuple(gaps)


def _meets(a: CharSet, b: CharSet) -> bool:
    return any(low <= end and start <= high for low, high in a for start, end in b)


def _within(a: CharSet, b: CharSet) -> bool:
    """Whether b is a part of a."""
    return all(any(low <= start and end <= high for low, high in a) for start, end in b)


def _table(a: tuple[Token, ...], b: tuple[Token, ...], test: Callable[[CharSet, CharSet], bool]) -> bool:
    """Match two token lists against each other, by dynamic programming over their suffixes.

    With ``_meets`` it answers whether both cover some name, with ``_within`` whether ``a`` covers all of ``b``
    (a ``*`` of ``b`` then needs a ``*`` of ``a``).
    """
    both = test is _meets
    if len(a) * len(b) > LARGEST_TABLE:
        return both
    below = [False] * len(b) + [True]
    for j in range(len(b) - 1, -1, -1):
        below[j] = both and b[j] is None and below[j + 1]
    for ours in reversed(a):
        row = [False] * (len(b) + 1)
        row[-1] = ours is None and below[-1]
        for j in range(len(b) - 1, -1, -1):
            theirs = b[j]
            if ours is None:
                row[j] = below[j] or row[j + 1]
            elif theirs is None:
                row[j] = both and (row[j + 1] or below[j])
            else:
                row[j] = below[j + 1] and test(ours, theirs)
        below = row
    return below[0]
