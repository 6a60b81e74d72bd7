"""Sanitizers and derivations, for a report: what is cleaned and how, what passes beside, what is made of what.

In: an ``Index`` and the entries of the report. Out: rows; elements that differ only in the robot are one.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.legal import PROHIBITED
from rosprivacy.analysis.model import SPECIAL
from rosprivacy.report.naming import key, without_leg
from rosprivacy.report.page.entries_of_robots import grouped, without_robots
from rosprivacy.report.page.index import state

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.finding_entries import Entry
    from rosprivacy.report.page.index import Index

SHOWN = 100  # entries of one row


@dataclass(frozen=True, slots=True)
class CleaningEntry:
    """What an element does to some kinds of data in one way.

    Attributes
    ----------
    method
        In words; ``weak`` if the data are still personal.
    unreached
        Kinds that never get there.
    other_readers
        Who reads the same channels and gets the data as they are; after these, who is said to clean them, too.
    past, remainder
        The first entries of these kinds whose path does not lead through the element: (anchor, number); and how many
        more there are, in words.
    recognises
        Kinds that it makes by which persons are recognised or judged: then it is no measure.
    """

    name: str
    kinds: str
    method: str
    weak: bool
    unreached: str
    leaves: str
    other_readers: tuple[str, ...]
    past: tuple[tuple[str, int], ...]
    remainder: str = ""
    recognises: str = ""


@dataclass(frozen=True, slots=True)
class MakingEntry:
    """That an element makes one kind of data of another; ``special`` if it can be a special category only then.

    ``recognises`` if persons are recognised or judged by what it makes.
    """

    name: str
    made_of: str
    product: str
    special: bool
    recognises: bool = False


def cleanings(index: Index, entries: Iterable[Entry]) -> tuple[CleaningEntry, ...]:
    """Return what sanitizers do."""
    past = _Past(index, entries)

    def merge_key(row: Mapping[str, Any]) -> Any:
        lists = (tuple(row["leaves"]), tuple(row["leaves_pseudonymised"]), without_robots(row["beside"]))
        return row["element"]["kind"], row["element"]["name"], row["method"], row["stated"], lists

    return tuple(_cleaning(group, past, index) for group in grouped(index.document["sanitizers"], merge_key))


class _Past:
    """Paths to assess on which a kind of data arrives as it is, and the elements that each leads through."""

    def __init__(self, index: Index, entries: Iterable[Entry]) -> None:
        self._paths: dict[str, Counter[tuple[str, int]]] = defaultdict(Counter)
        self._through: dict[tuple[str, Key], list[tuple[str, tuple[str, int]]]] = defaultdict(list)
        for entry in entries:
            for finding in map(index.by_id.__getitem__, (entry.id, *entry.alike)):
                if state(finding) == "open" and not finding["pseudonymised"]:
                    place = entry.anchor, entry.number
                    self._paths[entry.category][place] += 1
                    for element in {without_leg(element) for element in finding["witness"]}:
                        self._through[entry.category, element].append((finding["id"], place))

    def of(self, elements: set[Key], categories: Iterable[str]) -> tuple[list[tuple[str, int]], int]:
        """The first entries of the categories that lead through none of the elements, and how many there are."""
        first: list[tuple[str, int]] = []
        number = 0
        for category in categories:
            paths = self._paths[category]
            here = {path for element in elements for path in self._through.get((category, element), ())}
            through = Counter(place for _, place in here)
            past = (place for place in paths if paths[place] > through[place])
            first += islice(past, SHOWN)
            number += len(paths) - sum(paths[place] == count for place, count in through.items())
        return sorted(first, key=lambda place: place[1])[:SHOWN], number


def _cleaning(group: list[Mapping[str, Any]], past: _Past, index: Index) -> CleaningEntry:
    row, words = group[0], index.words
    reached = dict.fromkeys(r["category"] for r in group if r["reached"])
    unreached = [c for c in dict.fromkeys(r["category"] for r in group) if c not in reached]
    leaves = [index.data(category) for category in row["leaves"]]
    leaves += [index.data(category, pseudonymised=True) for category in row["leaves_pseudonymised"]]
    recognising = {key(r["element"]) for r in index.document["sanitizers"] if r.get("recognises")}
    too = _cleaning_too(group)
    first, number = past.of({without_leg(r["element"]) for r in group}, reached)
    return CleaningEntry(
        name=words.row(index.names([r["element"] for r in group])),
        kinds=index.all_data(reached),
        method=words(f"method.{row['method']}" if row["stated"] else "method.unstated"),
        weak=row["method"] == "pseudonymise",
        unreached=index.all_data(unreached),
        leaves=words.row(leaves),
        other_readers=(
            *index.names([*(e for r in group for e in r["beside"]), *(e for e in too if key(e) in recognising)]),
            *(
                words("sanitizer.cleans.too", element=name)
                for name in index.names(e for e in too if key(e) not in recognising)
            ),
        ),
        recognises=index.all_data(dict.fromkeys(kind for r in group for kind in r.get("recognises", ()))),
        past=tuple(first),
        remainder=words("more", n=number - len(first)) if number > len(first) else "",
    )


def _cleaning_too(group: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Older documents do not name them."""
    return [element for row in group for element in row.get("cleaning_beside", ())]


def makings(index: Index) -> tuple[MakingEntry, ...]:
    """Return which element makes which kind of data of which."""
    article9 = {name: category["article9"] in SPECIAL for name, category in index.categories.items()}
    rows = [row for row in index.document["derivations"] if row["reached"]]
    groups = grouped(rows, lambda row: (key(row["element"])[1:], row["from"], row["to"]))
    return tuple(
        MakingEntry(
            name=index.words.row(index.names([row["element"] for row in group])),
            made_of=index.data(group[0]["from"]),
            product=index.data(group[0]["to"]),
            recognises=_recognises(index.categories.get(group[0]["to"], {})),
            special=article9.get(group[0]["to"], False) and not article9.get(group[0]["from"], False),
        )
        for group in groups
    )


def _recognises(entry: Mapping[str, Any]) -> bool:
    """Whether persons are recognised or judged by such data, as ``recognises`` has it of a category."""
    special = any(legal["verdict"] in SPECIAL for legal in entry.get("law", ()))
    return special or any(at.startswith(PROHIBITED) for at in entry.get("look_at", ()))
