"""The liveliness tokens behind a Zenoh router, looked at by a client that declares nothing of ROS.

In: where the router is, or the user's own session file (with TLS). Out: observations, as tokens come and go.
"""

from __future__ import annotations

import json
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import MiddlewareError, ObservationError, shown
from rosprivacy.ingest.doors.polling import Pace, polled
from rosprivacy.ingest.doors.zenoh_tokens import DOOR, observation, tokens_of
from rosprivacy.ingest.observe.declared import DDS_TYPE, Declared, declared
from rosprivacy.ingest.reading.bounded_file import read_regular

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from rosprivacy.ingest.doors.polling import Wait
    from rosprivacy.ingest.observe.observation import Observation

ROUTER = "tcp/localhost:7447"
"""Where the sessions of rmw_zenoh look for theirs."""
SECURED = ("tls/", "quic/")
"""How endpoints begin that need certificates."""
PACE = Pace(told_after=(0.25,), settled=1)
LONGEST = 2**20
"""Bytes of a session file."""
MISSING = "install the extra [zenoh] from where rosprivacy came from, or give the output of `ros2 node info` (--text)"


@dataclass(frozen=True, slots=True)
class ZenohDoor:
    """A router to look behind.

    Attributes
    ----------
    clock
        Tells the time, as observations hold it.
    domain
        The ROS domain id.
    endpoint
        Of the router, such as ``tcp/127.0.0.1:7447``; empty: as the session file says, or rmw_zenoh's own.
    session_file
        The user's own, in JSON5, such as one with TLS.
    wait
        Waits so many seconds, and returns whether somebody has asked to stop.
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

            def seen(_: bool) -> Observation:  # noqa: FBT001 - as ``polled`` calls it
                return observation(tokens, since, self.clock(), self.domain, said)

            yield from polled(take, seen, PACE, seconds, self.wait)
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
