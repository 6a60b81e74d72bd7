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
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.expressions import have_common_name, holds, regex, tokens
from rosprivacy.analysis.written_names import GLOB_SIGNS, bare_name, is_glob

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

ACTION_SERVICES = ("cancel_goal", "get_result", "send_goal")
ACTION_TOPICS = ("feedback", "status")
EVENTS = "/_service_event"  # the topic on which a service tells what it is asked and what it answers

_OUT = {"publish", "request", "call"}
DDS = "dds"  # kind of a grant that names a DDS topic, and what the name of a topic that is none of ROS begins with
NON_ROS_KEYS = ("zenoh/", "zenoh@/")  # what names of Zenoh keys of no ROS channel begin with: plain, with a chunk @…
_PART = re.compile(rf"(.+)/_action/({'|'.join(ACTION_SERVICES + ACTION_TOPICS)})", re.DOTALL)


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


class Endpoint(NamedTuple):
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


@lru_cache(10_000)  # robots of a fleet use the same names
def endpoints(role: str, kind: str, name: str) -> tuple[Endpoint, ...]:
    """Return the DDS topics that a grant opens, as sros2's ``permissions.xsl`` writes them (rules S2, S3).

    >>> [(e.writes, e.leg, e.dds) for e in endpoints("request", "service", "/add")]
    [(True, 'request', 'rq/addRequest'), (False, 'response', 'rr/addReply')]
    >>> endpoints("publish", "topic", "/spin/_action/status")[0].kind
    'action'
    >>> endpoints("subscribe", "dds", "rq/addRequest")
    (Endpoint(writes=False, kind='service', name='/add', leg='request', dds='rq/addRequest'),)
    """
    asks = role in _OUT
    if kind == DDS:
        return (Endpoint(asks, *_ros_channel(name), name),)
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


def writable(role: str, kind: str, name: str) -> tuple[tuple[str, str], ...]:
    """Return (kind, name) of the lines of a policy that state a role: of the parts of an action, where no line is both.

    >>> writable("publish", "action", "/spin")
    (('topic', '/spin/_action/feedback'), ('topic', '/spin/_action/status'))
    >>> writable("call", "action", "/spin"), writable("publish", "topic", "/scan")
    ((('action', '/spin'),), (('topic', '/scan'),))
    """
    if kind != "action" or role in ("call", "execute"):
        return ((kind, name),)
    parts = ("topic", ACTION_TOPICS) if role in ("publish", "subscribe") else ("service", ACTION_SERVICES)
    return tuple((parts[0], f"{name}/_action/{part}") for part in parts[1])


def _ros_channel(dds: str) -> tuple[str, str, str]:
    """(kind, name, leg) of the channel that a DDS topic, or an expression of such, is a part of."""
    if dds.startswith("rt/"):
        kind, name, leg = "topic", dds[2:], ""
    elif dds.startswith("rq/") and dds.endswith("Request"):
        kind, name, leg = "service", dds[2:-7], "request"
    elif dds.startswith("rr/") and dds.endswith("Reply"):
        kind, name, leg = "service", dds[2:-5], "response"
    else:
        return "topic", dds if dds.startswith(NON_ROS_KEYS) else f"{DDS}/{dds}", ""
    folded = None if is_pattern(name) else _PART.fullmatch(name)
    of_action = folded is not None and folded[2] in (ACTION_SERVICES if leg else ACTION_TOPICS)
    return ("action", folded[1], leg or "response") if folded and of_action else (kind, name, leg)


def dds_names(kind: str, name: str, leg: str) -> tuple[str, ...]:
    """Return the DDS topics that make up a channel, or one leg of it.

    >>> dds_names("topic", "/scan", ""), dds_names("topic", "dds/Square", ""), dds_names("topic", "zenoh/a", "")
    (('rt/scan',), ('Square',), ('zenoh/a',))
    """
    if kind == "topic":
        return (f"rt{name}",) if not name.startswith((f"{DDS}/", *NON_ROS_KEYS)) else (name.removeprefix(f"{DDS}/"),)
    if kind == "service":
        return (f"rq{name}Request",) if leg == "request" else (f"rr{name}Reply",)
    if leg == "request":
        return tuple(f"rq{name}/_action/{part}Request" for part in ACTION_SERVICES)
    replies = tuple(f"rr{name}/_action/{part}Reply" for part in ACTION_SERVICES)
    return replies + tuple(f"rt{name}/_action/{part}" for part in ACTION_TOPICS)


def recorded_channels(topic: str) -> tuple[tuple[str, str, str], ...]:
    """Return (kind, name, leg) of the channels of which a recorded topic tells: itself, or a service or action (S3).

    >>> recorded_channels("/scan"), recorded_channels("/spin/_action/feedback")
    ((('topic', '/scan', ''),), (('action', '/spin', 'response'),))
    >>> recorded_channels("/add/_service_event")[1:]
    (('service', '/add', 'request'), ('service', '/add', 'response'))
    """
    found = list(endpoints("publish", "topic", topic))
    if topic.endswith(EVENTS):
        found += endpoints("request", "service", topic.removesuffix(EVENTS))
    return tuple(dict.fromkeys((end.kind, end.name, end.leg) for end in found))


def is_pattern(name: str) -> bool:
    """Return whether DDS would read the name as a wildcard expression (rule S4)."""
    return not GLOB_SIGNS.isdisjoint(name)


def literals(pattern: str) -> int:
    """Return how many characters of an expression stand for themselves.

    >>> literals("/cam*"), literals("/[a-z]*")
    (4, 1)
    """
    return sum(token is not None and len(token) == 1 and token[0][0] == token[0][1] for token in tokens(pattern))


@lru_cache(maxsize=65536)
def literal_prefix(pattern: str) -> str:
    """Return what every name that a pattern covers begins with.

    >>> literal_prefix("rt/robot/*/image")
    'rt/robot/'
    """
    return re.split(r"[*?\[]", pattern, maxsplit=1)[0]


@lru_cache(maxsize=65536)
def literal_suffix(pattern: str) -> str:
    """Return what every name that a pattern covers ends with.

    >>> literal_suffix("rt/robot/*/image"), literal_suffix("rt/cam[0-9]"), literal_suffix("rt/scan")
    ('/image', '', 'rt/scan')
    """
    ending = []
    for token in reversed(tokens(pattern)):
        if token is None or len(token) != 1 or token[0][0] != token[0][1]:
            break
        ending.append(chr(token[0][0]))
    return "".join(reversed(ending))


def covers(pattern: str, name: str) -> bool:
    """Return whether an expression grants a name, or everything that another expression grants.

    Exact where ``name`` is a name. Where it is a pattern, True is certain and False may mean 'not shown'.

    >>> covers("/robot/*", "/robot/camera/image"), covers("/robot/*", "/other")
    (True, False)
    >>> covers("/robot/*", "/robot/cam*"), covers("/robot/cam?", "/robot/cam*")
    (True, False)
    """
    if not is_pattern(name):
        return regex(pattern).match(name) is not None if is_pattern(pattern) else pattern == name
    return pattern == name or (not _apart(pattern, name) and holds(pattern, name))


def matcher(pattern: str) -> Callable[[str], bool]:
    """Return the test whether a plain name is covered, compiled once for many names."""
    match = regex(pattern).match
    return lambda name: match(name) is not None


def covered(written: str, names: Collection[str]) -> list[str]:
    """Return those of some names that one in a label or another file of a person means wholly, in their order.

    >>> covered("/cam*", ["/camera", "/cam*", "/map"]), covered("=/cam*", ["/camera", "/cam*"])
    (['/camera', '/cam*'], ['/cam*'])
    """
    if not is_glob(written):
        return [bare_name(written)] if bare_name(written) in names else []
    plain = matcher(written)
    return [name for name in names if (covers(written, name) if is_pattern(name) else plain(name))]


@lru_cache(maxsize=65536)
def overlaps(a: str, b: str) -> bool:
    """Return whether some name is covered by both expressions.

    >>> overlaps("/a*", "/*b"), overlaps("/a*", "/b*"), overlaps("/[a-c]", "/[!a]")
    (True, False, True)
    """
    return not _apart(a, b) and have_common_name(a, b)


def _apart(a: str, b: str) -> bool:
    """Whether two expressions begin or end with characters that differ."""
    ours, theirs = literal_prefix(a), literal_prefix(b)
    if not (ours.startswith(theirs) or theirs.startswith(ours)):
        return True
    ours, theirs = literal_suffix(a), literal_suffix(b)
    return not (ours.endswith(theirs) or theirs.endswith(ours))
