"""The six rounds of the paper on TurtleBot3: its lists of each, and the label file that says the same by hand."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

LISTS = ("source", "leak", "conduit", "sensitive", "mundane")  # the sixth, sanitizer, is empty in each
ROUNDS = 6
FILE = "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations/categorization_turtlebot3_step_{}.json"
KIND = "LaserScan"


def papers_round(corpus: Path, number: int) -> Mapping[str, Sequence[str]]:
    """Return the lists of a round, from 0: role -> names."""
    said: dict[str, list[str]] = json.loads((corpus / FILE.format(number)).read_text("utf-8"))
    assert not said["sanitizer"]
    return {role: said[role] for role in LISTS}


def said_first(corpus: Path, number: int) -> Iterator[tuple[str, str]]:
    """Yield (role, name) of what a round says and the one before it did not."""
    before = papers_round(corpus, number - 1) if number else dict.fromkeys(LISTS, ())
    for role, names in papers_round(corpus, number).items():
        assert set(before[role]) <= set(names)  # nothing is taken back
        yield from ((role, name) for name in names if name not in before[role])


def labels_of(lists: Mapping[str, Sequence[str]]) -> str:
    """Return the label file that says what lists say, of laser scans."""
    sections: dict[str, list[str]] = {"nodes": [], "channels": []}
    for role, names in lists.items():
        for name in names:
            value = f"{{{role}: [{KIND}]}}" if role in LISTS[:2] else role
            sections["nodes" if role in LISTS[:3] else "channels"].append(f"  {name}: {value}\n")
    return "labels: 1\n" + "".join(f"{section}:\n{''.join(lines)}" for section, lines in sections.items() if lines)
