"""What is not reviewed, in the page and in Markdown: the same facts as in the terminal (rule S11)."""

from __future__ import annotations

import re
from html import unescape
from typing import TYPE_CHECKING

import pytest

from tests.helpers.reports import policy

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

PROFILES = {
    "camera": (["/video"], []),
    "planner": (["/plan", "/dead", "/planner/transition_event"], ["/video"]),
    "arm": ([], ["/plan"]),
    "cloud": ([], ["/plan"]),
}
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /cloud: {leak: [Video]}, /arm: {source: [Location]}}\n"
ROWS = [  # name, through, only past it
    ("/planner", "/video", "3 other open elements, 1 recipient"),
    ("/arm", "/plan", "–"),
]
WAITS = "1 element can wait: from there data gets to no recipient and to no node that is not reviewed: /dead"
PROPOSED = (
    "1 element: lifecycle or other infrastructure channels, which the label file rosprivacy:infrastructure proposes "
    "to take as free of personal data: /planner/transition_event"
)
FOLDED = [WAITS, PROPOSED]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "p.xml").write_text(policy(PROFILES))
    (tmp_path / "l.yaml").write_text(LABELS)
    return tmp_path


def told(cli: Cli, folder: Path, *options: str) -> str:
    done = cli("report", "p.xml", "-l", "l.yaml", *options, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_text_says_through_which_element_and_what_a_label_would_close(cli: Cli, folder: Path) -> None:
    text = told(cli, folder, "-f", "markdown").replace("`", "")
    rows = [[cell.strip() for cell in line.split("|")] for line in text.splitlines() if "(node)" in line]
    assert [(row[1].split(" (")[0], row[3], row[5]) for row in rows if len(row) == 7 and "step" in row[4]] == ROWS
    assert [line for line in text.splitlines() if line in FOLDED] == FOLDED
    (arm,) = [line for line in text.splitlines() if line.startswith("| /arm (node) is a source")]
    assert "is a source itself (location); does it pass on what comes in?" in arm


def test_the_page_says_the_same(cli: Cli, folder: Path) -> None:
    page = told(cli, folder)
    section = page[page.index('id="questions"') : page.index('id="criteria"')]
    plain = " ".join(unescape(re.sub("<[^>]+>", "", section)).split())
    assert all(line in plain for line in FOLDED)
    for name, through, closes in ROWS:
        (row,) = [
            row
            for row in section.split("<tr>")
            if row.startswith('<th scope="row">') and f">{name}<" in row.split("</th>")[0]
        ]
        assert [f">{through}<" in row, closes in row] == [True, True]


def test_a_picture_of_the_page_cuts_no_words(cli: Cli, folder: Path) -> None:
    """'laser scan with…tion of a robot with a person'."""
    makes = "/planner: {derives: [{from: LaserScan, to: RobotPosition}]}"
    ends = "/camera: {source: [LaserScan]}, /cloud: {leak: [RobotPosition]}"
    (folder / "l.yaml").write_text(f"labels: 1\nnodes: {{{ends}, {makes}}}\n")
    page = told(cli, folder)
    words = "makes position of a robot with a person of laser scan with persons"
    drawn = [unescape(text) for text in re.findall("<text [^>]*>([^<]*)</text>", page)]
    assert words in " ".join(drawn).replace("\xa0", " ")
    assert not [text for text in drawn if "…" in text]
    assert f"<title>/planner; {words}</title>" in page


def test_what_can_wait_is_what_the_terminal_says(cli: Cli, folder: Path) -> None:
    text = cli("analyze", "p.xml", "-l", "l.yaml", cwd=folder).stdout
    assert "   1 can wait: from there" in text
    assert "   1 are lifecycle or other infrastructure channels" in text
    assert "only past it: 4 other open elements and 1 way out" in text
