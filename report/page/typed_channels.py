"""The message types of channels with data, for a report: from where each is known, and what they close (rule S15).

In: an ``Index``. Out: rows; channels that differ only in the robot are one. A type that only a bag tells has no writer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import key, name
from rosprivacy.report.page.entries_of_robots import grouped

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class Typed:
    """A channel, or a leg of one, that data gets to.

    Attributes
    ----------
    types
        (name, from where it is known) of each.
    data
        Kinds that it carries.
    closed
        Kinds that end there, since its types cannot carry them.
    """

    name: str
    kind: str
    types: tuple[tuple[str, str], ...]
    data: str
    closed: str


def typed(index: Index) -> tuple[Typed, ...]:
    """Return the channels with data of which types are known, in the order of the document."""
    carries = {key(row["element"]): row for row in index.document["carries"]}
    limits = index.document["assumptions"].get("type_limits_reached", ())
    closed = {key(row["element"]): row["categories"] for row in limits}

    def channel_of(row: Mapping[str, Any]) -> tuple[str, str]:
        at = key(row["element"])
        return _data(carries.get(at, {}), index), index.all_data(closed.get(at, ()))

    def merge_key(row: Mapping[str, Any]) -> Any:
        types = tuple((one["type"], one["file"], one["line"]) for one in row["types"])
        return key(row["element"])[1:], channel_of(row), types

    with_data = {*carries, *closed}
    rows = [row for row in index.document.get("types", ()) if key(row["element"]) in with_data]
    return tuple(_typed(some, channel_of(some[0]), index) for some in grouped(rows, merge_key))


def _data(row: Mapping[str, Any], index: Index) -> str:
    hidden = (index.data(category, pseudonymised=True) for category in row.get("pseudonymised", ()))
    return index.words.row([*map(index.data, row.get("categories", ())), *hidden])


def _typed(entries: list[Mapping[str, Any]], channel: tuple[str, str], index: Index) -> Typed:
    return Typed(
        index.words.row(index.names([row["element"] for row in entries])),
        index.words.kind(entries[0]["element"]),
        tuple((fit(one["type"]), _origin(one, index)) for one in entries[0]["types"]),
        *channel,
    )


def _origin(type_entry: Mapping[str, Any], index: Index) -> str:
    observed = {entry["file"] for entry in index.document["assumptions"].get("types", ())}
    how = "stated" if type_entry["stated"] else "observed" if type_entry["file"] in observed else "recorded"
    return index.words(f"channel_type.{how}", place=f"{fit(type_entry['file'])}:{type_entry['line']}")


def only_by_types(index: Index) -> tuple[tuple[str, str], ...]:
    """Return (kind of data, from where to where) of what only types close."""
    return tuple(
        (index.data(row["category"]), index.words("entry.from.to", source=name(row["source"]), leak=name(row["leak"])))
        for row in index.document["assumptions"].get("closed_by_types", ())
    )
