"""Open elements, in the order of review, and ends of which nothing is known (rule S11).

In: an ``Index``. Out: groups of rows; elements that differ only in the robot are one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CHANNELS
from rosprivacy.report.page.entries_of_robots import grouped

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class Question:
    """An element that data gets to and that no label covers."""

    name: str
    kind: str
    data: str
    distance: str
    missing: str


@dataclass(frozen=True, slots=True)
class Group:
    """Questions of one urgency; ``key`` is that of its heading."""

    key: str
    questions: tuple[Question, ...]


def review(index: Index) -> tuple[Group, ...]:
    """Return the groups that are not empty."""
    rows: dict[str, list[Mapping[str, Any]]] = {"q.first": [], "q.channels": [], "q.behind": []}
    for row in index.document["open"]:
        channel = row["element"]["kind"] in CHANNELS
        rows["q.first" if row["frontier"] else "q.channels" if channel else "q.behind"].append(row)
    return tuple(Group(heading, tuple(_questions(some, index))) for heading, some in rows.items() if some)


def unknown_ends(index: Index) -> tuple[Group, ...]:
    """Return the ends of data's path of which nothing is known, by what is not; the groups that are not empty."""
    rows: dict[str, list[Mapping[str, Any]]] = {"q.reader": [], "q.flow": []}
    for row in index.document["unknown_ends"]:
        rows[f"q.{row['unknown']}"].append({**row, "distance": None})
    return tuple(Group(heading, tuple(_questions(some, index))) for heading, some in rows.items() if some)


def _questions(rows: list[Mapping[str, Any]], index: Index) -> list[Question]:
    words = index.words

    def same(row: Mapping[str, Any]) -> Any:
        e = row["element"]
        facts = (tuple(row["categories"]), row["distance"], tuple(row.get("missing", ())))
        return e["kind"], e["name"], e.get("leg", ""), facts

    return [
        Question(
            name=words.row(index.names([row["element"] for row in group])),
            kind=words.kind(group[0]["element"]),
            data=index.all_data(group[0]["categories"]),
            distance=words.count(group[0]["distance"], "step") if group[0]["distance"] is not None else "–",
            missing=words.row(words(f"missing.{what}") for what in group[0].get("missing", ())),
        )
        for group in grouped(rows, same)
    ]
