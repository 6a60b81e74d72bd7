"""The case studies of ``docs/case-studies.md`` and beside it, and who types what they say into a label file."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

PAGES = [ROOT / "docs" / "case-studies.md", ROOT / "tests" / "turtlebot3_study.md"]
POLICIES = {
    "$RMF": "policies/open-rmf__rmf_demos/rmf_demos/sros2/policies/office.policy.xml",
    "$TB3": TURTLEBOT3,
}
STUDIES = {study.splitlines()[0]: study for page in PAGES for study in page.read_text("utf-8").split("\n## ")[1:]}
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
