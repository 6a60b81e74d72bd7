"""``rosprivacy suggest --ask`` as tests answer it: by a file of keys, at a terminal, or as a person in Python."""

from __future__ import annotations

import io
import os
import select
import sys
import termios
import time
from typing import TYPE_CHECKING, Protocol

import pytest

from rosprivacy.labelling.asking import asked_now, closing, with_answer
from rosprivacy.labelling.conversation import QUIT, Conversation
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.little_robots import policy_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion
    from rosprivacy.labelling.conversation import Person
    from rosprivacy.labelling.suggesting import Suggested
    from tests.helpers.command import Cli, Done
    from tests.helpers.little_robots import Nodes

DAY = "1767225600"  # 2026-01-01
SECONDS = 60
COMMAND = [sys.executable, "-m", "rosprivacy", "suggest", "p.xml", "--into", "l.yaml", "--ask"]


class ByKeys(Protocol):
    def __call__(self, folder: Path, keys: str, *more: str) -> Done: ...


def robot_of(folder: Path, nodes: Nodes, labels: str) -> Path:
    """Write a policy and labels; return the folder."""
    (folder / "p.xml").write_text(policy_of(nodes), "utf-8")
    (folder / "l.yaml").write_text(labels, "utf-8")
    return folder


def ask(cli: Cli, folder: Path, keys: str, patch: pytest.MonkeyPatch, *more: str) -> Done:
    """Answer by a file of keys."""
    with patch.context() as context:
        context.setattr(sys, "stdin", io.StringIO(keys))
        return cli("suggest", "p.xml", "--into", "l.yaml", "--ask", *more, cwd=folder, SOURCE_DATE_EPOCH=DAY)


@pytest.fixture
def by_keys(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> ByKeys:
    """Answer by a file of keys."""

    def answered(folder: Path, keys: str, *more: str) -> Done:
        return ask(cli, folder, keys, monkeypatch, *more)

    return answered


class Pressing:
    """Somebody whose keys a function chooses of a question and the rows that are picked; what is asked is kept."""

    def __init__(self, choose: Callable[[LabelQuestion, frozenset[int]], str]) -> None:
        self.choose = choose
        self.asked: list[LabelQuestion] = []
        self.remarks: list[str] = []

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str:
        if not picked:
            self.asked.append(question)
        return self.choose(question, picked)

    def remark(self, remark: str) -> None:
        self.remarks.append(remark)


def pressing(*keys: str) -> Pressing:
    """Return somebody who presses these keys, and then stops."""
    left = [*keys]
    return Pressing(lambda _, __: left.pop(0) if left else QUIT)


def text_of(folder: Path) -> str:
    """Return the label file of a robot."""
    return (folder / "l.yaml").read_text("utf-8")


def conversation_in(folder: Path, person: Person) -> Conversation:
    """Return a conversation about the robot of a folder."""
    return conversation(folder / "p.xml", folder / "l.yaml", person)


def conversation(policy: Path, file: Path, person: Person) -> Conversation:
    """Return a conversation about a policy, whose answers go into a label file."""
    last: list[Suggested] = []

    def now() -> tuple[LabelQuestion, ...]:
        last[:] = [suggest_labels((str(policy),), (str(file),), Settings())]
        return asked_now(last[0])

    def keep(question: LabelQuestion, key: str) -> tuple[str, ...]:
        written = with_answer(str(file), question, key, "Ada", "2026-11-23", Settings())
        file.write_text(written.text, "utf-8")
        return written.remarks

    return Conversation(now, keep, person, lambda rows: closing(rows, last[0].result))


def wait_for_keys(terminal: int, *, whole_lines: bool = False) -> None:
    """Wait until the program reads single keys of a terminal, or lines: what is typed before is no answer."""
    ends = time.monotonic() + SECONDS
    while bool(termios.tcgetattr(terminal)[3] & termios.ICANON) is not whole_lines:
        assert time.monotonic() < ends
        time.sleep(0.01)


def read_until(terminal: int, end: bytes) -> bytes:
    """Read what the program writes, up to some end."""
    screen = b""
    while not screen.endswith(end):
        assert select.select([terminal], [], [], SECONDS)[0], screen
        screen += os.read(terminal, 1)
    return screen
