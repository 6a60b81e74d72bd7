"""Sanitizers and derivations, for a report: what is cleaned and how, what passes beside, what is made of what.

In: an ``Index`` and the entries of the report. Out: rows; elements that differ only in the robot are one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import SPECIAL
from rosprivacy.report.naming import key, whole
from rosprivacy.report.page.entries_of_robots import grouped, without_robots

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.finding_entries import Entry
    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class Cleaning:
    """What an element does to some kinds of data in one way.

    Attributes
    ----------
    method
        In words; ``weak`` if the data are still personal.
    unreached
        Kinds that never get there.
    beside
        Who reads the same channels and gets the data as they are; after these, who is said to clean them, too.
    past
        Entries of these kinds whose path does not lead through the element: (anchor, number).
    """

    name: str
    kinds: str
    method: str
    weak: bool
    unreached: str
    leaves: str
    beside: tuple[str, ...]
    past: tuple[tuple[str, int], ...]


@dataclass(frozen=True, slots=True)
class Making:
    """That an element makes one kind of data of another; ``special`` if it can be a special category only then."""

    name: str
    made_of: str
    made: str
    special: bool


def cleanings(index: Index, entries: Iterable[Entry]) -> tuple[Cleaning, ...]:
    """Return what sanitizers do."""
    past = _Past(index, entries)

    def same(row: Mapping[str, Any]) -> Any:
        lists = (tuple(row["leaves"]), tuple(row["leaves_pseudonymised"]), without_robots(row["beside"]))
        return row["element"]["kind"], row["element"]["name"], row["method"], row["stated"], lists

    return tuple(_cleaning(group, past, index) for group in grouped(index.document["sanitizers"], same))


class _Past:
    """Paths to assess on which a kind of data arrives as it is, and the elements that each leads through."""

    def __init__(self, index: Index, entries: Iterable[Entry]) -> None:
        places = {finding: (entry.anchor, entry.number) for entry in entries for finding in (entry.id, *entry.others)}
        self._paths: dict[str, list[tuple[set[Key], tuple[str, int]]]] = {}
        for finding in index.to_assess:
            if not finding["pseudonymised"]:
                through = {whole(element) for element in finding["witness"]}
                self._paths.setdefault(finding["category"], []).append((through, places[finding["id"]]))

    def of(self, elements: set[Key], categories: Iterable[str]) -> tuple[tuple[str, int], ...]:
        """Entries of the categories that lead through none of the elements."""
        paths = (path for category in categories for path in self._paths.get(category, ()))
        return tuple(sorted({place for through, place in paths if not through & elements}, key=lambda place: place[1]))


def _cleaning(group: list[Mapping[str, Any]], past: _Past, index: Index) -> Cleaning:
    row, words = group[0], index.words
    reached = dict.fromkeys(r["category"] for r in group if r["reached"])
    unreached = [c for c in dict.fromkeys(r["category"] for r in group) if c not in reached]
    leaves = [index.data(category) for category in row["leaves"]]
    leaves += [index.data(category, pseudonymised=True) for category in row["leaves_pseudonymised"]]
    return Cleaning(
        name=words.row(index.names([r["element"] for r in group])),
        kinds=index.all_data(reached),
        method=words(f"method.{row['method']}" if row["stated"] else "method.unstated"),
        weak=row["method"] == "pseudonymise",
        unreached=index.all_data(unreached),
        leaves=words.row(leaves),
        beside=(
            *index.names([element for r in group for element in r["beside"]]),
            *(words("s.cleans.too", element=name) for name in index.names(_cleaning_too(group))),
        ),
        past=past.of({whole(r["element"]) for r in group}, reached),
    )


def _cleaning_too(group: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Older documents do not name them."""
    return [element for row in group for element in row.get("cleaning_beside", ())]


def makings(index: Index) -> tuple[Making, ...]:
    """Return which element makes which kind of data of which."""
    article9 = {name: category["article9"] in SPECIAL for name, category in index.categories.items()}
    rows = [row for row in index.document["derivations"] if row["reached"]]
    groups = grouped(rows, lambda row: (key(row["element"])[1:], row["from"], row["to"]))
    return tuple(
        Making(
            name=index.words.row(index.names([row["element"] for row in group])),
            made_of=index.data(group[0]["from"]),
            made=index.data(group[0]["to"]),
            special=article9.get(group[0]["to"], False) and not article9.get(group[0]["from"], False),
        )
        for group in groups
    )
