"""The liveliness tokens behind a Zenoh router, looked at by a client that declares nothing of ROS (rule S16).

In: where the router is, or the user's own session file (with TLS). Out: observations, as tokens come and go. A token
says which enclave, node, channel and type it is of, so nothing has to be put together.

Source: rmw_zenoh, ``docs/design.md`` and ``liveliness_utils.cpp``: ``@ros2_lv/<domain>/<session>/<node id>/<entity
id>/<kind>/<enclave>/<namespace>/<node>`` and, for endpoints, ``/<name>/<type>/<hash>/<qos>`` with more after it since
2026. A slash within a part is ``%``; an empty part is ``%`` too.
"""

from __future__ import annotations

import json
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import MiddlewareError, ObservationError, shown
from rosprivacy.ingest.policies.observed_metadata import HIDDEN, REFUSED
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.running.cdr import Message
from rosprivacy.ingest.running.doors import Pace, polled
from rosprivacy.ingest.running.observation import (
    DDS_TYPE,
    Declared,
    Observation,
    ObservedEndpoint,
    ObservedNode,
    Span,
)
from rosprivacy.ingest.running.observed_names import ros_type

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from pathlib import Path

    from rosprivacy.ingest.running.doors import Wait

DOOR = "zenoh"
ROOT = "@ros2_lv"
NODE = "NN"
ROLES = {"MP": "publish", "MS": "subscribe", "SS": "reply", "SC": "request"}
NODE_PARTS, ENDPOINT_PARTS = 9, 12
EMPTY = (
    "connected, and there is no token of ROS domain {domain}: nothing runs in it, or the access list of the router "
    "does not let us look (it has to allow liveliness_query and declare_liveliness_subscriber on @ros2_lv/**)"
)
ROUTER = "tcp/localhost:7447"
"""Where the sessions of rmw_zenoh look for theirs."""
SECURED = ("tls/", "quic/")
"""How endpoints begin that need certificates."""
PACE = Pace(told_after=(0.25,), settled=1)
LONGEST = 2**20
"""Bytes of a session file."""
FIELDS = 4
"""Texts of a declaration."""
MISSING = "install the extra [zenoh] from where rosprivacy came from, or give the output of `ros2 node info` (--text)"


@dataclass(frozen=True, slots=True)
class ZenohDoor:
    """A router to look behind.

    Attributes
    ----------
    domain
        The ROS domain id.
    endpoint
        Of the router, such as ``tcp/127.0.0.1:7447``; empty: as the session file says, or rmw_zenoh's own.
    session_file
        The user's own, in JSON5, such as one with TLS.
    """

    clock: Callable[[], str]
    domain: int
    endpoint: str = ""
    session_file: Path | None = None
    wait: Wait = time.sleep

    def looks(self, seconds: float | None) -> Iterator[Observation]:
        """Tell what is there, each time that it has changed and been quiet for a moment.

        Raises
        ------
        MiddlewareError
            If there is no router, or the session file is not accepted.
        ObservationError
            If the package that asks is not installed.
        """
        try:
            import zenoh
        except ImportError as error:
            raise ObservationError(
                f"--{DOOR}", 0, f"the package eclipse-zenoh is not there ({error})", MISSING
            ) from error
        changes: deque[tuple[bool, str]] = deque()
        messages: deque[tuple[str, bytes]] = deque()
        with self._opened(zenoh) as session:
            since, tokens, said = self.clock(), dict[str, str](), set[Declared]()
            watched = session.liveliness().declare_subscriber(
                tokens_of(self.domain),
                lambda sample: changes.append((sample.kind == zenoh.SampleKind.PUT, str(sample.key_expr))),
                history=True,
            )
            heard = _declarations(session, self.domain, messages)

            def take() -> bool:
                some = bool(changes or messages)
                _take(changes, tokens, self.clock())
                said.update(_read(messages, self.domain))
                return some

            def observation_of(_: bool) -> Observation:  # noqa: FBT001 - as ``polled`` calls it
                return observation(tokens, since, self.clock(), self.domain, said)

            yield from polled(take, observation_of, PACE, seconds, self.wait)
            heard.undeclare()
            watched.undeclare()

    def _configured(self, zenoh: Any) -> Any:
        """The user's own file, or a client of one router; we listen nowhere and ask nobody else."""
        settings = zenoh.Config() if self.session_file is None else _of_file(zenoh, str(self.session_file))
        settings.insert_json5("mode", json.dumps("client"))
        settings.insert_json5("listen/endpoints", "[]")
        if self.endpoint or self.session_file is None:
            self._connect(zenoh, settings)
            settings.insert_json5("scouting/multicast/enabled", "false")
        return settings

    def _connect(self, zenoh: Any, settings: Any) -> None:
        try:
            settings.insert_json5("connect/endpoints", json.dumps([self.endpoint or ROUTER]))
        except zenoh.ZError as error:
            what = f"{shown(repr(self.endpoint))} is no endpoint of Zenoh"
            raise ObservationError(f"--{DOOR}", 0, what, f"write {ROUTER}, or tls/HOST:7447") from error

    def _opened(self, zenoh: Any) -> Any:
        settings = self._configured(zenoh)
        try:
            return zenoh.open(settings)
        except zenoh.ZError as error:
            where = f"as {shown(str(self.session_file))} says"
            if self.endpoint or self.session_file is None:
                where = f"at {shown(self.endpoint or ROUTER)}"
            why = _why(error)
            hint = "start it (ros2 run rmw_zenoh_cpp rmw_zenohd), or say where it is (--zenoh tcp/HOST:7447)"
            if any(secured in why for secured in SECURED):  # Zenoh does not say which of these it is
                hint += "; or the certificates do not fit: see transport/link/tls in your session file"
            raise MiddlewareError(f"no Zenoh router answers {where}: {why}; {hint}") from error


def _take(changes: deque[tuple[bool, str]], tokens: dict[str, str], now: str) -> None:
    while changes:
        came, key = changes.popleft()
        if came:
            tokens.setdefault(key, now)
        else:
            tokens.pop(key, None)


def _declarations(session: Any, domain: int, messages: deque[tuple[str, bytes]]) -> Any:
    """Hear what nodes declare of themselves, and what they declared before: no other message is read."""
    from zenoh.ext import HistoryConfig, declare_advanced_subscriber

    return declare_advanced_subscriber(
        session,
        f"{domain}/**/{DDS_TYPE}/*",
        lambda sample: messages.append((str(sample.key_expr), sample.payload.to_bytes())),
        history=HistoryConfig(detect_late_publishers=True),
    )


def _read(messages: deque[tuple[str, bytes]], domain: int) -> Iterator[Declared]:
    """What is no declaration is left out; that nothing was heard on its topic is told then."""
    while messages:
        key, payload = messages.popleft()
        topic = "/" + key.removeprefix(f"{domain}/").rpartition("/")[0].removesuffix(f"/{DDS_TYPE}")
        with suppress(ValueError):
            yield declared(topic, payload)


def _of_file(zenoh: Any, file: str) -> Any:
    def fail(line: int, problem: str, hint: str) -> ObservationError:
        return ObservationError(file, line, problem, hint)

    text = read_regular(file, LONGEST, fail).decode(errors="replace")
    try:
        return zenoh.Config.from_json5(text)
    except zenoh.ZError as error:
        raise fail(0, f"Zenoh does not accept it: {_why(error)}", "give a session file of Zenoh, in JSON5") from error


def _why(error: Exception) -> str:
    """In one line, without the place in Zenoh's own source."""
    return shown(str(error).partition(" at /")[0].strip())


def tokens_of(domain: int) -> str:
    """Return the key expression of all tokens of a domain; ``**`` alone matches no part that begins with ``@``."""
    return f"{ROOT}/{domain}/**"


def observation(
    tokens: Mapping[str, str], since: str, now: str, domain: int, declared: Iterable[Declared] = ()
) -> Observation:
    """Return what tokens say, with what nodes have said of themselves so far.

    ``tokens`` say since when each is there; ``since`` is when somebody began to look, ``now`` this moment.
    """
    nodes: list[ObservedNode] = []
    endpoints: list[ObservedEndpoint] = []
    remarks: list[str] = []
    for key, first in sorted(tokens.items()):
        token = _read_token(key, Span(first, now))
        if token is None:
            remarks.append(f"left out: {shown(repr(key))} is no token of rmw_zenoh that is known")
            continue
        node, endpoint = token
        nodes.append(node)
        endpoints += [endpoint] if endpoint else []
    gaps = {REFUSED: len(remarks)} if remarks else {}
    if not tokens:
        gaps, remarks = {HIDDEN: 1}, [EMPTY.format(domain=domain)]
    seen = Span(since, now)
    said = tuple(sorted(declared))
    return Observation((DOOR,), seen, tuple(nodes), tuple(endpoints), (domain,), gaps, tuple(remarks), said)


def _read_token(key: str, span: Span) -> tuple[ObservedNode, ObservedEndpoint | None] | None:
    parts = key.split("/")
    if len(parts) < NODE_PARTS or parts[0] != ROOT:
        return None
    kind, enclave, namespace, name = parts[5], _plain(parts[6]), _plain(parts[7]), _plain(parts[8])
    node = ObservedNode(f"{namespace.rstrip('/')}/{name}", span, enclave if enclave != "/" else "")
    if kind == NODE:
        return node, None
    if kind not in ROLES or len(parts) < ENDPOINT_PARTS:
        return None
    type_ = ros_type(parts[10])
    digest = parts[11] if type_ and parts[11].startswith("RIHS") else ""
    return node, ObservedEndpoint(node.name, ROLES[kind], _plain(parts[9]), span, type_, digest, key, "", (DOOR,))


def _plain(part: str) -> str:
    return part.replace("%", "/")


def declared(topic: str, payload: bytes) -> Declared:
    r"""Read a message as it goes over the wire (CDR, OMG DDSI-RTPS clause 10).

    Raises
    ------
    ValueError
        If it is something else.

    >>> declared("/p", b"\0\1\0\0" + b"\3\0\0\0/a\0\0" + 3 * b"\1\0\0\0\0\0\0\0").node
    '/a'
    """
    message = Message(payload)
    texts = [message.text() for _ in range(FIELDS)]
    message.ended()
    return Declared(topic, *texts)
