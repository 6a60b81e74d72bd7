"""The rights of the persons: for each group of them, where data about them can lie (Articles 15, 17 and 20).

In: an ``Index``. Out: rows of plain texts. A storage or recipient counts for a group if data that the group's sources
bring in, or that are made of these, can get there; how long it is kept is 'not known' where nobody states it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import key
from rosprivacy.report.page.non_ros import STORAGE, country, retention_text
from rosprivacy.report.page.tables import OUTSIDE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class DataPlace:
    """Where data of a group can lie: a storage, an external recipient, or an element that lets data out."""

    name: str
    kind: str
    data: str
    retention: str
    recipient: str


@dataclass(frozen=True, slots=True)
class Persons:
    """A group of persons, and the places; none where no path of their data was found to one."""

    name: str
    places: tuple[DataPlace, ...]


def rights(index: Index) -> tuple[Persons, ...]:
    """Return the groups that labels name, then the persons that they do not name.

    Complexity: O(groups x (storages + findings) x kinds of data).
    """
    sources = index.of_role.get("source", {})
    groups: dict[str, set[Key]] = {}
    for source in sources:
        for name in index.subjects.get(source, ()):
            groups.setdefault(name, set()).add(source)
    told = [Persons(fit(name), tuple(_places(name, members, index))) for name, members in sorted(groups.items())]
    silent = {source for source in sources if source not in index.subjects}
    if silent:
        told.append(Persons(index.words("subject.unknown"), tuple(_places(None, silent, index))))
    return tuple(told)


def _places(group: str | None, members: set[Key], index: Index) -> Iterator[DataPlace]:
    """Storages first, then who receives data."""
    there = sorted(_kinds(group, members, index).items(), key=lambda one: (one[0][1] != STORAGE, one[0]))
    alike: dict[tuple[str, DataPlace], list[Mapping[str, Any]]] = {}
    for place, kinds in there:
        element = index.elements[place]
        alike.setdefault((element["name"], _place(element, kinds, index)), []).append(element)
    for (_, made), elements in alike.items():
        yield replace(made, name=index.words.row(index.names(elements)))


def _kinds(group: str | None, members: set[Key], index: Index) -> dict[Key, dict[str, bool]]:
    """Place -> the kinds of the members' data that can get there, and whether these come pseudonymised only."""
    found: dict[Key, dict[str, bool]] = {}
    for finding in index.findings:
        if key(finding["source"]) in members:
            here, category = found.setdefault(key(finding["leak"]), {}), finding["category"]
            here[category] = here.get(category, True) and finding["pseudonymised"]
    for place, row in index.outside.items():
        for category in row["holds"] if row["element"]["kind"] in OUTSIDE else ():
            if index.is_of(group, category, [row["element"]]):
                hidden = index.pseudonymised(row["element"], category)
                found.setdefault(place, {}).setdefault(category, hidden)
    return found


def _place(element: Mapping[str, Any], kinds: Mapping[str, bool], index: Index) -> DataPlace:
    words, row = index.words, index.outside.get(key(element), {})
    durations = {category: retention_text(row, category, index) if row.get("retention") else "" for category in kinds}
    stated = {duration for duration in durations.values() if duration}
    if not stated:
        said = words("rights.unknown")
    elif len(set(durations.values())) == 1:
        said = stated.pop()
    else:
        said = "; ".join(
            words("outside.of", data=index.data(category), duration=duration or words("rights.unknown"))
            for category, duration in durations.items()
        )
    who = [fit(row["operator"])] if row.get("operator") else []
    who += [country(row, index)] if row.get("country") else []
    data = words.row(index.data(category, pseudonymised=hidden) for category, hidden in kinds.items())
    return DataPlace("", words.kind(element), data, said, words.row(who) or words("rights.unknown"))
