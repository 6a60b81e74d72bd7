"""``docs/case-studies.md`` can be repeated: commands are run and lines typed in order, and what it counts is right."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from tests.helpers.console import check, commands
from tests.helpers.daily import one_in
from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

PAGE = (ROOT / "docs" / "case-studies.md").read_text("utf-8")
POLICIES = {
    "$RMF": "policies/open-rmf__rmf_demos/rmf_demos/sros2/policies/office.policy.xml",
    "$TB3": TURTLEBOT3,
}
STUDIES = {study.splitlines()[0]: study for study in PAGE.split("\n## ")[1:]}
FILE = "labels.yaml"
COUNTS = ("lines typed", "empty lines filled in", "lines changed")


class Typist:
    """Types the lines of a block into the label file, as the page tells a person to."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.counts = dict.fromkeys(COUNTS, 0)

    def types(self, block: str) -> None:
        lines = self.file.read_text("utf-8").splitlines() if self.file.exists() else []
        section = ""
        for line in block.splitlines():
            if not line.startswith(" "):
                section = line
            at = self._at(lines, section, line)
            if at is None:
                lines.insert(self._end(lines, section), line)
                self.counts["lines typed"] += 1
            elif line.startswith(" "):
                empty = re.fullmatch(r"\s*\S+:\s*(#.*)?", lines[at])
                self.counts["empty lines filled in" if empty else "lines changed"] += 1
                lines[at] = line
        self.file.write_text("\n".join([*lines, ""]), "utf-8")

    def _at(self, lines: list[str], section: str, line: str) -> int | None:
        """Where a line of that name stands in that section; None if it has to be typed anew."""
        if line == section:
            return lines.index(line) if line in lines else None
        name = line.split(": ", maxsplit=1)[0].rstrip(":")
        there = range(lines.index(section), self._end(lines, section))
        return next((i for i in there if re.match(rf"{re.escape(name)}:( |$)", lines[i])), None)

    @staticmethod
    def _end(lines: list[str], section: str) -> int:
        """The line after the last one of a section; the end of the file for a new section."""
        if section not in lines:
            return len(lines)
        after = range(lines.index(section) + 1, len(lines))
        return next((i for i in after if not lines[i].startswith(" ")), len(lines))


@pytest.mark.corpus
@pytest.mark.parametrize("name", one_in(len(STUDIES), STUDIES))
def test_a_reader_gets_from_nothing_to_the_report(name: str, cli: Cli, corpus: Path, tmp_path: Path) -> None:
    typist = Typist(tmp_path / FILE)
    runs, rounds = 0, 0
    for language, block in re.findall(r"```(yaml|console)\n(.*?)```", STUDIES[name], re.DOTALL):
        if language == "yaml":
            typist.types(block)
            continue
        for command, lines, code in commands(block):
            before = typist.file.read_text("utf-8") if typist.file.exists() else ""
            for variable, policy in POLICIES.items():
                command = command.replace(variable, str(corpus / policy))  # noqa: PLW2901 - as a shell does
            check(cli, command, lines, code, tmp_path)
            runs += 1
            rounds += "--next" in command and typist.file.read_text("utf-8") != before
    told = [f"{runs} commands", f"{rounds} rounds", *(f"{n} {what}" for what, n in typist.counts.items() if n)]
    assert f"In all: {', '.join(told)}." in STUDIES[name], told
    assert (tmp_path / "report.html").stat().st_size > 10_000


def test_both_studies_are_there() -> None:
    assert list(STUDIES) == ["RMF office", "TurtleBot3"]


def test_a_name_is_filled_in_changed_or_typed(tmp_path: Path) -> None:
    file = tmp_path / FILE
    file.write_text("labels: 1\nnodes:\n  /a: # why\n  /b: conduit\ntopics:\n  /a:\n")
    typist = Typist(file)
    typist.types("nodes:\n  /a: conduit\n  /b: {leak: [Video]}\n  /c: conduit\nservices:\n  /s: mundane\n")
    assert file.read_text() == (
        "labels: 1\nnodes:\n  /a: conduit\n  /b: {leak: [Video]}\n  /c: conduit\ntopics:\n  /a:\n"
        "services:\n  /s: mundane\n"
    )
    assert typist.counts == {"lines typed": 3, "empty lines filled in": 1, "lines changed": 1}
