"""A DDS participant that is not ours: the program of ``tests/ingest/running/peers``, built once, told what to be."""

from __future__ import annotations

import shutil
import subprocess
from contextlib import contextmanager
from typing import TYPE_CHECKING
from urllib.parse import quote

import pytest

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

PEERS = ROOT / "tests" / "ingest" / "running" / "peers"


def built(folder: Path, source: Path = PEERS / "fastdds_peer.cpp") -> Path:
    """Build the program."""
    program = folder / source.stem
    command = ["g++", "-O0", "-std=c++17", "-o", str(program), str(source), "-lfastrtps", "-lfastcdr"]
    subprocess.run(command, check=True, capture_output=True, text=True)
    return program


class Peer:
    """A running one. Each command answers when it is done."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process

    def does(self, command: str, *words: object) -> str:
        """Give a command; return what it answers beside 'done'."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        line = " ".join([command, *(quote(str(word), safe="/:_") or "-" for word in words)])
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline().rstrip("\n")
        assert answer.startswith("done"), (command, answer)
        return answer.removeprefix("done").strip()

    def node(self, space: str, name: str, *endpoints: tuple[str, str, str]) -> None:
        """Be a node with endpoints: (writer or reader, topic, type)."""
        self.does("node", space, name)
        for kind, topic, type_ in endpoints:
            self.does(kind, topic, type_, *([""] if kind == "writer" else []))


@contextmanager
def running(program: Path, *arguments: str | Path) -> Iterator[Peer]:
    """Run one; it ends with the block."""
    with subprocess.Popen([program, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield Peer(process)
        finally:
            process.terminate()


@pytest.fixture(scope="session")
def fastdds(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program."""
    if shutil.which("g++") is None:
        pytest.skip("NO g++ and Fast DDS (libfastrtps-dev): observation was tested with no other DDS implementation")
    return built(tmp_path_factory.mktemp("fastdds"))


@pytest.fixture
def peer(fastdds: Path) -> Iterator[Peer]:
    with running(fastdds) as one:
        yield one


@pytest.fixture
def other(fastdds: Path) -> Iterator[Peer]:
    """A second one, in a process of its own."""
    with running(fastdds) as one:
        yield one
