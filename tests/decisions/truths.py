"""Hand-made labels that are the truth of the count: what a person has to say, and what comes of it.

RMF office and TurtleBot3 are the case studies (``tests/helpers/typist.py``), as a reader types them; TurtleBot3 is also
what the paper's five rounds came to; the care home is the example of ours.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from tests.helpers.papers_rounds import ROUNDS, labels_of, papers_round
from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import TURTLEBOT3
from tests.helpers.typist import POLICIES, STUDIES, Typist

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

CARE = ROOT / "examples" / "care-home"


class Truth(NamedTuple):
    """A system, and what is true of it.

    Attributes
    ----------
    text
        A label file.
    more
        Label files of the program that were used beside it.
    """

    name: str
    policy: str
    text: str
    more: tuple[str, ...] = ()


class Entry(NamedTuple):
    """What is said of one name: as it is typed, without blanks before it and remarks."""

    section: str
    name: str
    lines: tuple[str, ...]

    @property
    def keys(self) -> int:
        """Signs that are typed."""
        return sum(len(line.strip()) for line in self.lines)


def truths(corpus: Path, folder: Path) -> Iterator[Truth]:
    """Yield what is counted."""
    yield Truth("RMF office", str(corpus / POLICIES["$RMF"]), _typed("RMF office", folder))
    infrastructure = ("rosprivacy:infrastructure",)
    text = _typed("TurtleBot3", folder)
    yield Truth("TurtleBot3", str(corpus / TURTLEBOT3), text, infrastructure)
    yield Truth("TurtleBot3, the paper's rounds", str(corpus / TURTLEBOT3), labels_of(papers_round(corpus, ROUNDS - 1)))
    yield care_home()


def care_home() -> Truth:
    """Return the example of ours."""
    text = (CARE / "care-home.labels.yaml").read_text("utf-8")
    return Truth("care home", str(CARE / "care-home.policy.xml"), text)


def entries(text: str) -> list[Entry]:
    """Take a label file apart into what a person says of each name; pins are written by the program."""
    found: list[Entry] = []
    section = ""
    for line in (re.sub(r"(^|\s)#.*", "", line).rstrip() for line in text.splitlines()):
        if section == "pins" and line.startswith(" "):
            continue
        if line.startswith("   "):
            found[-1] = found[-1]._replace(lines=(*found[-1].lines, line))
        elif line.startswith("  "):
            name = line.strip().partition(": ")[0].rstrip(":").strip('"')
            found.append(Entry(section, name, (line,)))
        elif line:
            section = line.partition(":")[0]
    return found


def _typed(study: str, folder: Path) -> str:
    typist = Typist(folder / f"{study}.yaml")
    for block in re.findall(r"```yaml\n(.*?)```", STUDIES[study], re.DOTALL):
        typist.types(block)
    return typist.file.read_text("utf-8")
