"""The real middleware as judge: what two secured participants of Fast DDS may exchange, on loopback.

A trial has a writer and a reader, each with its enclave, and some topics. The trials of a call run at one time, each in
its own domain, all writers in one process and all readers in another one.
"""

from __future__ import annotations

import os
import shutil
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import pytest

from tests.helpers.fastdds import PEERS, built, running
from tests.helpers.keystores import Keystore

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from tests.helpers.fastdds import Peer
    from tests.helpers.keystores import Enclave

    Judge = Callable[[Mapping[str, "Trial"]], dict[str, "Outcome"]]

CONTROL = "rt/control"  # permissions are not asked for it, and it is stated last: after it, what did not come will not
FIRST_DOMAIN = 100 + os.getpid() % 60
SETTLE, PATIENCE = 2.0, 10.0  # seconds without news: if all met, and if some may still be about to


@dataclass(frozen=True)
class Trial:
    """A writer and a reader of each topic; ``None`` is a participant without security."""

    writer: Enclave | None
    reader: Enclave | None
    topics: tuple[str, ...] = ("rt/chatter",)
    partition: str = ""


@dataclass(frozen=True)
class Outcome:
    """What became of a trial.

    Attributes
    ----------
    there
        Whether the participants of the writer and of the reader could be made.
    met
        Whether data of a topic came for which permissions are not asked.
    writers, readers
        The topics for which one could be made.
    arrived
        The topics of which data came.
    """

    there: tuple[bool, bool]
    met: bool
    writers: frozenset[str]
    readers: frozenset[str]
    arrived: frozenset[str]

    def said(self, topic: str) -> str:
        """How far data of a topic came."""
        stops = [
            ("the writer's participant is refused", self.there[0]),
            ("the reader's participant is refused", self.there[1]),
            ("the participants do not meet", self.met),
            ("the writer is refused", topic in self.writers),
            ("the reader is refused", topic in self.readers),
            ("nothing arrives", topic in self.arrived),
        ]
        return next((stop for stop, passed in stops if not passed), "arrives")


def judged(program: Path, keystore: Keystore, trials: Mapping[str, Trial]) -> dict[str, Outcome]:
    """Run trials, given by name."""
    with running(program) as writers, running(program) as readers:
        made = {
            name: (
                _made(writers, "writer", f"w{number}", number, keystore, trial),
                _made(readers, "reader", f"r{number}", number, keystore, trial),
            )
            for number, (name, trial) in enumerate(trials.items())
        }
        both = {f"r{number}": name for number, name in enumerate(made) if None not in made[name]}
        came = {both[one]: topics for one, topics in _listened(readers, tuple(both)).items()}
    return {
        name: Outcome(
            (written is not None, read is not None),
            CONTROL in came.get(name, ()),
            (written or frozenset()) - {CONTROL},
            (read or frozenset()) - {CONTROL},
            came.get(name, frozenset()) - {CONTROL},
        )
        for name, (written, read) in made.items()
    }


def _made(peer: Peer, side: str, one: str, number: int, keystore: Keystore, trial: Trial) -> frozenset[str] | None:
    """Make a participant and its endpoints; return the topics of those that it may have, or nothing without it."""
    enclave = trial.writer if side == "writer" else trial.reader
    folder = "" if enclave is None else str(keystore.enclave(f"/trial{number}/{side}", _controlled(enclave)))
    if peer.does("participant", one, FIRST_DOMAIN + number, int(side == "reader"), folder) == "no":
        return None
    wanted = [(topic, trial.partition) for topic in trial.topics] + [(CONTROL, "")]
    return frozenset(topic for topic, partition in wanted if peer.does(side, one, topic, partition) == "yes")


def _controlled(enclave: Enclave) -> Enclave:
    """As governance protects its first topics, it protects the one for which it asks for no permissions."""
    rules = enclave.governance.topics
    control = replace(rules[0], topics=CONTROL, read=False, write=False)
    return replace(enclave, governance=replace(enclave.governance, topics=(control, *rules)))


def _listened(readers: Peer, names: tuple[str, ...]) -> dict[str, frozenset[str]]:
    """The topics of which data came to each, when no more come."""
    came: dict[str, frozenset[str]] = {}
    last = time.monotonic()
    while True:
        seen = {name: frozenset(readers.does("received", name).split()) for name in names}
        if seen != came:
            came, last = seen, time.monotonic()
        if time.monotonic() - last > (SETTLE if all(CONTROL in topics for topics in came.values()) else PATIENCE):
            return came
        time.sleep(0.05)


@pytest.fixture(scope="session")
def judge(tmp_path_factory: pytest.TempPathFactory) -> Judge:
    """Judge trials by Fast DDS; what it logs goes to standard error."""
    if shutil.which("g++") is None or shutil.which("openssl") is None:
        pytest.skip("NO openssl, g++ and Fast DDS (libfastrtps-dev): no middleware judged what permissions say")
    program = built(tmp_path_factory.mktemp("secured"), PEERS / "secured_peer.cpp")
    return lambda trials: judged(program, Keystore(tmp_path_factory.mktemp("keystore")), trials)
