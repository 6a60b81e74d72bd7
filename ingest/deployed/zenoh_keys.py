"""Key expressions of Zenoh -> the channels that they are about, by the names that DDS has for these (rule S4).

In: an expression, the domain, and the namespace of the session. Out: ``Channels``. ``*`` is one chunk, ``**`` any
number, ``$*`` any characters inside a chunk; a chunk that begins with ``@`` is matched only by itself. rmw_zenoh has
keys ``<domain>/<name>/<type>/<hash>``, behind the namespace of a session if it has one. Behind such a key, ``@adv``
begins what late joiners ask for, and ``@ros2_lv`` begins the tokens that say who is there. All other keys are none of
ROS: the channel has the key for its name, and a key with ``@`` one that no wildcard of the others covers. A key behind
a domain that is too short for type and hash is taken for a name.

Source: Zenoh's documentation of ``KeyExpr``; rmw_zenoh, ``docs/design.md``; ``AdvancedCache`` of zenoh-ext.
``eclipse-zenoh`` 1.10.2 is the judge of the tests.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.policies.names import NON_ROS_KEYS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

ONE, ANY, INSIDE = "*", "**", "$*"
VERBATIM = "@"
MESSAGES, HISTORY, TOKENS, OTHERS = "messages", "history", "tokens", "others"
_PART = re.compile(r"\$\*|[^$]")  # what a chunk is made of
_KEY = 2  # chunks after the name: type and hash
_LATE, _TOKENS = "@adv", "@ros2_lv"


def problem_of(expression: str) -> tuple[str, str] | None:
    """Return what is wrong with a key expression, and what to do; None if Zenoh takes it.

    >>> problem_of("0/camera/**"), problem_of("camera/")
    (None, ('an empty chunk', 'write it without a slash at its ends, and with one between chunks'))
    """
    chunks = expression.split("/")
    if not all(chunks):
        return "an empty chunk", "write it without a slash at its ends, and with one between chunks"
    if re.search("[#?]", expression):
        return "'#' and '?' are forbidden", "remove them"
    if any(chunk not in (ONE, ANY) and re.search(r"(?<!\$)\*|\$(?!\*)|\$\*\$\*|^\$\*$", chunk) for chunk in chunks):
        return "'*' or '$' where it cannot be", "write *, ** as a whole chunk, or $* once inside one"
    if any(pair in ((ANY, ANY), (ANY, ONE)) for pair in pairwise(chunks)):
        return "not the canonical form", "write **/** as **, and **/* as */**"
    return None


def includes(wide: str, narrow: str) -> bool:
    """Return whether an expression is about all keys that another one is about.

    Chunks times chunks.

    >>> includes("0/camera/**", "0/camera/image/*"), includes("0/camera/*", "0/camera/**"), includes("**", "@a")
    (True, False, False)
    """
    return _aligned(wide.split("/"), narrow.split("/"), ANY, _chunk_includes, _is_plain)


def _aligned(
    wide: Sequence[str],
    narrow: Sequence[str],
    star: str,
    includes_part: Callable[[str, str], bool],
    matches: Callable[[str], bool],
) -> bool:
    """Whether two rows of parts can be walked to their ends: part by part, or a star of ``wide`` takes parts.

    Without recursion, since an input says how long they are.
    """
    ends = len(wide), len(narrow)
    reached = {(0, 0)}
    for i in range(ends[0]):
        for j in range(ends[1] + 1):
            if (i, j) not in reached:
                continue
            if wide[i] == star:
                reached |= {(i + 1, j)} | ({(i, j + 1)} if j < ends[1] and matches(narrow[j]) else set())
            elif j < ends[1] and includes_part(wide[i], narrow[j]):
                reached.add((i + 1, j + 1))
    return ends in reached


def _is_plain(chunk: str) -> bool:
    return not chunk.startswith(VERBATIM)


def _every(_: str) -> bool:
    return True


def _chunk_includes(wide: str, narrow: str) -> bool:
    if narrow in (wide, ANY) or not (_is_plain(wide) and _is_plain(narrow)):
        return wide == narrow
    if ONE in (wide, narrow):
        return wide == ONE
    return _aligned(_PART.findall(wide), _PART.findall(narrow), INSIDE, str.__eq__, _every)


class Keys(NamedTuple):
    """Which keys the messages of a session have.

    Attributes
    ----------
    domain
        As a chunk; ``*`` where it does not matter.
    namespaces
        Its own; of a session that has none, also those of others, since it can send and get what is behind them.
    """

    domain: str
    namespaces: tuple[str, ...] = ("",)


class Channels(NamedTuple):
    """Channels that an expression is about.

    Attributes
    ----------
    sort
        ``MESSAGES`` of ROS channels, their ``HISTORY`` for late joiners, ``TOKENS`` of the graph, or ``OTHERS``.
    names
        With wildcards as policies have them: of ROS channels such as ``/camera``, of others as DDS names.
    whole
        Whether it is about nothing less than all of each.
    """

    sort: str
    names: tuple[str, ...]
    whole: bool


def channels(key: str, keys: Keys) -> Iterator[Channels]:
    """Yield what a key expression is about.

    Examples
    --------
    >>> list(channels("0/camera/image/*/*", Keys("0")))
    [Channels(sort='messages', names=('/camera/image',), whole=True)]
    >>> list(channels("robot/0/camera/*/*/@adv/**", Keys("0", ("robot",))))
    [Channels(sort='history', names=('/camera',), whole=False)]
    >>> list(channels("fleet/*/battery", Keys("0")))
    [Channels(sort='others', names=('zenoh/fleet/*/battery',), whole=False)]
    """
    chunks = key.split("/")
    if _TOKENS in chunks:
        yield _other_dds_names(TOKENS, chunks)
        return
    rests = {namespace: _rests(chunks, namespace) for namespace in keys.namespaces}
    found = {namespace: [*_of_ros(some, keys.domain)] for namespace, some in rests.items()}
    for one in dict.fromkeys(one for some in found.values() for one in some):
        yield one._replace(whole=one.whole and all(one in some for some in found.values()))
    is_ros = any(rest[0].isdigit() and _names(rest)[1] for some in rests.values() for rest in some)
    reached = "" in keys.namespaces or any(rests.values())
    if reached and not is_ros:
        yield _other_dds_names(OTHERS, chunks)


def namespaces_of(keys: Iterable[str]) -> set[str]:
    """Return the namespaces that keys are written for: what stands before a domain.

    >>> sorted(namespaces_of(["robot/0/camera/*/*", "0/camera/*/*", "**"]))
    ['', 'robot']
    """
    found = set()
    for key in keys:
        chunks = key.split("/")
        at = next((i for i, chunk in enumerate(chunks) if chunk.isdigit()), None)
        if at is not None and _TOKENS not in chunks and not any(map(_is_wild, chunks[:at])):
            found.add("/".join(chunks[:at]))
    return found


def domain_of(key: str, namespaces: Iterable[str]) -> str:
    """Return the domain that a key is written for; empty where it is written for none.

    >>> domain_of("3/camera/*/*", [""]), domain_of("robot/3/camera/*/*", ["robot"]), domain_of("*/camera/*/*", [""])
    ('3', '3', '')
    """
    rests = (rest for namespace in namespaces for rest in _rests(key.split("/"), namespace))
    return next((rest[0] for rest in rests if rest[0].isdigit()), "")


def _of_ros(rests: list[list[str]], domain: str) -> Iterator[Channels]:
    for rest in rests:
        sort, names, exact = _names(rest)
        if names and (rest[0] == domain or _is_wild(rest[0]) or (domain == ONE and rest[0].isdigit())):
            yield Channels(sort, names, exact and rest[0] in (ONE, ANY, domain))


def _names(rest: list[str]) -> tuple[str, tuple[str, ...], bool]:
    """(sort, names of channels, whether all of each) of a key behind its namespace."""
    at = _verbatim(rest)
    if at is None:
        return MESSAGES, *ros_names("/".join(rest))
    return HISTORY, ros_names("/".join(rest[:at]))[0] if rest[at] == _LATE and at else (), False


def ros_names(key: str) -> tuple[tuple[str, ...], bool]:
    """Return the names that a key expression is about, and whether it is about nothing less than all of each.

    >>> ros_names("0/camera/image/*/*"), ros_names("0/camera/**")
    ((('/camera/image',), True), (('/camera', '/camera/*'), True))
    >>> ros_names("*/$*cam/*/*"), ros_names("**")
    ((('/*cam',), False), (('/*',), True))
    """
    first, *rest = key.split("/")
    if first == ANY:
        return ("/*",), not rest
    if ANY not in rest:
        name = rest[:-_KEY] or (rest if first.isdigit() else [])  # too short for a type and a hash: all of it
        exact = len(name) < len(rest) and rest[-_KEY:] == [ONE] * _KEY and not any(map(_is_wild, name))
        return (_written(name),) if name else (), exact
    base = rest[: rest.index(ANY)]
    exact = rest[-1:] == [ANY] and len(base) == len(rest) - 1 and not any(map(_is_wild, base))
    while base and (base[-1] == ONE or "::" in base[-1] or base[-1].startswith("RIHS")):
        base, exact = base[:-1], False  # perhaps the type or the hash
    return (_written(base), _written([*base, ONE])) if base else (_written([ONE]),), exact


def _rests(chunks: list[str], namespace: str) -> list[list[str]]:
    """What is left of an expression behind a namespace."""
    reached = {0}
    for part in namespace.split("/") if namespace else ():
        reached |= {at + 1 for at in reached if chunks[at : at + 1] == [ANY]}
        reached = {at + (chunks[at] != ANY) for at in reached if at < len(chunks) and includes(chunks[at], part)}
    return [chunks[at:] for at in sorted(reached) if at < len(chunks)]


def _verbatim(chunks: list[str]) -> int | None:
    """Where the first chunk stands that is matched only by itself."""
    return next((i for i, chunk in enumerate(chunks) if chunk.startswith(VERBATIM)), None)


def _other_dds_names(sort: str, chunks: list[str]) -> Channels:
    """The DDS names that stand for keys of no ROS channel."""
    begins = NON_ROS_KEYS[_verbatim(chunks) is not None]
    first = chunks.index(ANY) if ANY in chunks else len(chunks)
    base = [_plain(chunk) for chunk in chunks[:first]]
    written = f"{begins}{'/'.join(base)}"
    exact = first == len(chunks) or (first == len(chunks) - 1 and _verbatim(chunks) is None)  # ** takes no other @…
    whole = exact and not any(map(_is_wild, chunks[:first]))
    if first == len(chunks):
        return Channels(sort, (written,), whole)
    return Channels(sort, (written, f"{written}/*") if base else (f"{begins}*",), whole)


def _is_wild(chunk: str) -> bool:
    return chunk in (ONE, ANY) or INSIDE in chunk or "[" in chunk


def _written(name: list[str]) -> str:
    """A name as policies write it, where ``*`` is more than a chunk, and ``[`` is no letter."""
    return "".join(f"/{_plain(chunk)}" for chunk in name)


def _plain(chunk: str) -> str:
    return chunk.replace(INSIDE, ONE).replace("[", "?")
