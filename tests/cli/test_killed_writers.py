"""Whoever writes a file is killed at every call to the system: the file is the old one or the new one, whole."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.decisions.decision_log import is_log
from rosprivacy.ingest.labels.label_template import SCHEMA_FILE
from tests.helpers.factory import FACTORY
from tests.helpers.forked_runs import Forked, Run
from tests.helpers.policies import everything

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from tests.helpers.forked_runs import Ended

INPUTS = {file.name for file in FACTORY.iterdir()}
LABELS = {"run3.labels.yaml": FACTORY.joinpath("run3.labels.yaml").read_bytes()}
ANALYSES = ("text", "json", "sarif", "cnil-pia", "turtle", "json-ld")
READS = ("before.policy.xml", "-l", "run3.labels.yaml")
WHY = ("--reason", "r", "--owner", "o", "--legal-basis", "6(1)(f)")
DECISION = ("decide", "accept", "7ac677bf059b5beb", *WHY, "--decisions", "d.yaml")
STRAY = re.compile(r"\.(?P<name>.+)\.(?:[a-z0-9_]{8}|lock)")  # what report/atomic.py may leave
TIMED = 2  # kills of each writer by the clock, beside those at its calls
OLD = b"old\n"


@dataclass(frozen=True)
class Writer:
    """A command that writes.

    Attributes
    ----------
    outputs
        What it writes, and what was there before; None for no file.
    done
        Its exit code; and when all is written already.
    """

    arguments: tuple[str, ...]
    outputs: Mapping[str, bytes | None]
    done: tuple[int, int] = (0, 0)

    @property
    def is_log(self) -> bool:
        """Whether it adds to a log of decisions."""
        return any(map(is_log, self.outputs))


def report(command: str, form: str, code: int = 0) -> Writer:
    return Writer((command, *READS, "-f", form, "-o", "out"), {"out": OLD}, (code, code))


WRITERS = {
    "decide": Writer(DECISION, {"d.yaml": b"decisions: 1\nfindings: []\n"}),
    "decide, a first time": Writer(DECISION, {"d.yaml": None}),
    "decide, in a log": Writer((*DECISION[:-1], "d.jsonl"), {"d.jsonl": None}),
    "labels --init": Writer(
        ("labels", "--init", "before.policy.xml", "-o", "l.yaml"),
        {"l.yaml": None, SCHEMA_FILE: None},
        (0, 2),
    ),
    "labels --next": Writer(("labels", "--next", *READS), LABELS),
    "labels --update": Writer(("labels", "--update", "after.policy.xml", *READS[1:]), LABELS),
    **{f"analyze -f {form}": report("analyze", form, 1) for form in ANALYSES},
    **{f"report -f {form}": report("report", form) for form in ("html", "markdown", "article30")},
    **{f"graph -f {form}": report("graph", form) for form in ("svg", "dot")},
    "analyze --save-graph": Writer(
        ("analyze", *READS, "-q", "-o", "out", "--save-graph", "g.json"), {"out": OLD, "g.json": OLD}, (1, 1)
    ),
    "mitigate --patch": Writer(
        ("mitigate", *READS, "--by", "deny", "--patch", "p.diff", "-o", "out"), {"p.diff": OLD, "out": OLD}
    ),
}  # fmt: skip
IN_PLACE = """
from pathlib import Path
from rosprivacy.report import atomic
def write_texts(texts, *, edited=None):
    for file, text in texts:
        if text is not None:
            with file.open("wb") as there:
                there.write(text.encode())
                there.flush()
atomic.write_texts = write_texts
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Forked]:
    home = tmp_path_factory.mktemp("warm")
    lay(home, {})
    warm = [
        writer.arguments for name, writer in WRITERS.items() if "html" in name or "svg" in name or "a first" in name
    ]
    with Forked(home, *warm) as forked:
        yield forked


def lay(home: Path, outputs: Mapping[str, bytes | None]) -> None:
    """The inputs, and what was there before."""
    shutil.rmtree(home, ignore_errors=True)
    shutil.copytree(FACTORY, home)
    for name, before in outputs.items():
        if before is not None:
            (home / name).write_bytes(before)


def written(home: Path, writer: Writer) -> dict[str, bytes | None]:
    there = everything(home)
    return {name: there.get(name) for name in writer.outputs}


def when(name: str) -> list[pytest.MarkDecorator]:
    """One for every day; one for each way to write for each change; the other formats, which are written alike."""
    if name == "decide":
        return []
    alike = " -f " in name and name not in ("analyze -f json", "report -f html")
    return [pytest.mark.thorough if alike else pytest.mark.slow]


@dataclass
class Killing:
    """A writer, killed again and again in one folder."""

    program: Forked
    writer: Writer
    home: Path

    def whole(self) -> tuple[Ended, dict[str, bytes | None]]:
        """A run that nobody kills, and what it wrote."""
        lay(self.home, self.writer.outputs)
        ended = self.program(Run(self.writer.arguments, str(self.home)))
        assert ended.code == self.writer.done[0], ended.error
        assert everything(self.home).keys() == {*INPUTS, *self.writer.outputs}
        return ended, written(self.home, self.writer)

    def left(self, at: int = 0, seconds: float = 0, broken: str = "") -> tuple[int, dict[str, bytes | None]]:
        """Exit code, and what is there."""
        lay(self.home, self.writer.outputs)
        ended = self.program(Run(self.writer.arguments, str(self.home), at=at, seconds=seconds, before=broken))
        return ended.code, written(self.home, self.writer)

    def goes_on(self, new: dict[str, bytes | None]) -> None:
        """What is left stands in nobody's way: the command does its work, and the lock is free and gone."""
        strays = everything(self.home).keys() - {*INPUTS, *self.writer.outputs}
        assert all((at := STRAY.fullmatch(name)) and at["name"] in self.writer.outputs for name in strays), strays
        there = written(self.home, self.writer) == new
        again = self.program(Run(self.writer.arguments, str(self.home)))
        assert again.code == self.writer.done[there], again.error
        if there and self.writer.is_log:  # what is decided twice stands there twice
            twice = written(self.home, self.writer)
            assert all((twice[name] or b"").startswith(text or b"?") for name, text in new.items())
        else:
            assert written(self.home, self.writer) == new
        assert not [name for name in everything(self.home) if name.endswith(".lock")]


@pytest.mark.parametrize("name", [pytest.param(name, marks=when(name)) for name in WRITERS])
def test_a_killed_writer_leaves_the_old_or_the_new(program: Forked, tmp_path: Path, name: str, every: int) -> None:
    """Before and after each call that opens, writes, flushes, renames, removes or locks; and by the clock."""
    killing = Killing(program, WRITERS[name], tmp_path / "home")
    ended, new = killing.whole()
    old = dict(WRITERS[name].outputs)
    random = Random(name)  # noqa: S311 - repeatable
    points = [(at, 0.0) for at in range(1 + random.randrange(every), len(ended.made) + 1, every)]
    timed = [(0, random.random() * ended.seconds) for _ in range(TIMED)]
    killed = []
    for at, seconds in [*points, *timed]:
        code, left = killing.left(at, seconds)
        assert code == -9 or (seconds and code == WRITERS[name].done[0]), (at, code)
        assert all(text in (old[file], new[file]) for file, text in left.items()), (at, seconds, left)
        killed.append(left == new)
        killing.goes_on(new)
    print(f"{name}: killed {len(killed)} times")  # for the record, with -rP
    if every == 1:  # the points stand on both sides of the rename
        assert {True, False} <= set(killed)


@pytest.mark.slow
def test_a_writer_in_place_is_seen(program: Forked, tmp_path: Path) -> None:
    """That the test above can fail: without the rename a kill leaves an empty file."""
    killing = Killing(program, WRITERS["decide"], tmp_path / "home")
    _, new = killing.whole()
    old = dict(WRITERS["decide"].outputs)
    lefts = [killing.left(at, broken=IN_PLACE)[1] for at in range(1, 12)]
    assert [left for left in lefts if left not in (old, new)]
