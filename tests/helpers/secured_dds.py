"""The real middlewares as judges: what two secured participants may exchange, on loopback.

A trial is a keystore of two enclaves, ``/writer`` and ``/reader``, and some topics. The trials of a call run at one
time, each in its own domain, all writers in one process and all readers in another one.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.fastdds import PEERS, built, running
from tests.helpers.keystores import Keystore, governance, grant, permissions, topic_rule

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from contextlib import AbstractContextManager

    from tests.helpers.fastdds import Peer

    Start = Callable[[], AbstractContextManager[Peer]]
    Judge = Callable[[Mapping[str, "Trial"]], dict[str, "Outcome"]]

ANY_DOMAIN = "<id_range><min>0</min><max>230</max></id_range>"
CONTROL = "rt/control"  # permissions are not asked for it, and it is stated last: after it, what did not come will not
CONTROL_RULE = topic_rule(CONTROL, "false", "false")
NOTHING: frozenset[str] = frozenset()
FIRST_DOMAIN = 100 + os.getpid() % 60
SETTLE, PATIENCE = 2.0, 10.0  # seconds without news: if all met, and if some may still be about to


@dataclass(frozen=True)
class Trial:
    """A writer and a reader of each topic.

    Attributes
    ----------
    writer, reader
        Permissions; none for a participant without security.
    governance
        With ``CONTROL_RULE`` as its first rule of topics, or one that is like its others.
    named_by, signed_by
        Who gave the writer its certificate, and who signed its permissions; a CA of the keystore or a stranger.
    """

    writer: str | None
    reader: str | None
    governance: str = governance(CONTROL_RULE, topic_rule(), domains=ANY_DOMAIN)
    topics: tuple[str, ...] = ("rt/chatter",)
    partition: str = ""
    named_by: str = "identity_ca"
    signed_by: str = "permissions_ca"


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

    keystore: Path
    domain: int
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


def judged(start: Start, folder: Path, trials: Mapping[str, Trial]) -> dict[str, Outcome]:
    """Run trials, given by name, with keystores in a folder."""
    begun = Keystore(folder / "begun")
    for side in ("writer", "reader"):
        begun.enclave(f"/{side}", permissions(grant(f"/{side}")))
    places = {name: (folder / str(domain), domain) for domain, name in enumerate(trials, FIRST_DOMAIN)}
    with start() as writers, start() as readers:
        made = {}
        for name, trial in trials.items():
            keystore, domain = places[name]
            _write(begun, keystore, trial)
            made[name] = (
                _made(writers, "writer", keystore, domain, trial),
                _made(readers, "reader", keystore, domain, trial),
            )
        came = _listened(readers, tuple(places[name][1] for name in made if None not in made[name]))
    outcomes = {}
    for name, (written, read) in made.items():
        keystore, domain = places[name]
        there, arrived = (written is not None, read is not None), came.get(domain, NOTHING)
        own = [(topics or NOTHING) - {CONTROL} for topics in (written, read, arrived)]
        outcomes[name] = Outcome(keystore, domain, there, CONTROL in arrived, *own)
    return outcomes


def _write(begun: Keystore, folder: Path, trial: Trial) -> None:
    """Write the keystore of a trial: that of all, with permissions and governance of its own."""
    shutil.copytree(begun.folder, folder, symlinks=True)
    made = Keystore(folder)
    for stranger in {trial.named_by, trial.signed_by} - {"identity_ca", "permissions_ca"}:
        made.authority(stranger)
    if trial.named_by != "identity_ca":
        shutil.rmtree(folder / "enclaves" / "writer")
        made.enclave("/writer", trial.writer or "", authority=trial.named_by)
    for side, text, signer in (("writer", trial.writer, trial.signed_by), ("reader", trial.reader, "permissions_ca")):
        made.sign(text or "", folder / "enclaves" / side / "permissions.p7s", signer)
    made.governance(trial.governance)


def _made(peer: Peer, side: str, keystore: Path, domain: int, trial: Trial) -> frozenset[str] | None:
    """Make a participant and its endpoints; return the topics of those that it may have, or nothing without it."""
    secured = (trial.writer if side == "writer" else trial.reader) is not None
    folder = keystore / "enclaves" / side if secured else ""
    if peer.does("participant", domain, domain, int(side == "reader"), folder) == "no":
        return None
    wanted = [(topic, trial.partition) for topic in trial.topics] + [(CONTROL, "")]
    return frozenset(topic for topic, partition in wanted if peer.does(side, domain, topic, partition) == "yes")


def _listened(readers: Peer, domains: tuple[int, ...]) -> dict[int, frozenset[str]]:
    """The topics of which data came in each domain, when no more come."""
    came: dict[int, frozenset[str]] = {}
    last = time.monotonic()
    while True:
        seen = {domain: frozenset(readers.does("received", domain).split()) for domain in domains}
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
    return lambda trials: judged(partial(running, program), tmp_path_factory.mktemp("keystores"), trials)


@pytest.fixture(scope="session")
def cyclone_judge(tmp_path_factory: pytest.TempPathFactory) -> Judge:
    """Judge trials by Cyclone DDS; what it prints goes to standard error."""
    plugins = next(Path("/usr/lib").glob("*/libddsc*/libdds_security_ac.so"), None)
    if plugins is None or any(shutil.which(program) is None for program in ("g++", "idlc", "openssl")):
        pytest.skip("NO openssl, g++ and Cyclone DDS (cyclonedds-dev, cyclonedds-tools): it judged no permissions")
    folder = tmp_path_factory.mktemp("cyclone")
    program = folder / "cyclone_peer"
    made: list[str | Path] = [
        "g++",
        "-O0",
        "-std=c++17",
        "-I.",
        "-o",
        program,
        PEERS / "cyclone_peer.cpp",
        "secured_text.o",
        "-lddsc",
    ]
    for command in (["idlc", str(PEERS / "secured_text.idl")], ["gcc", "-c", "secured_text.c"], made):
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
    start = partial(running, program, plugins.parent)
    return lambda trials: judged(start, tmp_path_factory.mktemp("keystores"), trials)
