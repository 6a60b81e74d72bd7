"""What was closed on somebody's word and had a leak or an open element behind it: the ledger, for the report.

In: an ``Index``. Out: rows, those with a leak first; rows that differ only in the robot are one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.page.entries_of_robots import grouped

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.page.index import Index


@dataclass(frozen=True, slots=True)
class Closed:
    """One row: where data ends, which data, on whose word, and where it would get to."""

    where: str
    data: str
    said: str
    lines: tuple[str, ...]
    behind: str


def closed(index: Index) -> tuple[Closed, ...]:
    """Return the rows that closed a path; older documents have none."""
    rows = [row for row in index.document.get("taken_away", ()) if row["leak"] or row["open"] or row["perhaps"]]
    rows.sort(key=lambda row: row["leak"] is None)
    return tuple(_closed(group, index) for group in grouped(rows, _same))


def _same(row: Mapping[str, Any]) -> Any:
    ends = [(row[end] or {}).get("name", "") for end in ("element", "to", "leak", "open")]
    places = tuple((place["file"], place["line"]) for place in row["places"])
    return row["by"], tuple(ends), tuple(row["categories"]), places, row["note"]


def _closed(rows: list[Mapping[str, Any]], index: Index) -> Closed:
    words, row = index.words, rows[0]

    def of(end: str) -> str:
        elements = [row[end] for row in rows if row[end]]
        return words.row(index.names(elements)) if elements else ""

    behind = [words("k.leak", element=of("leak"))] if row["leak"] else []
    behind += [words("k.open", element=of("open"))] if row["open"] else []
    said = words(f"k.{row['by']}")
    return Closed(
        where=" → ".join(end for end in (of("element"), of("to")) if end),
        data=index.all_data(row["categories"]),
        said=words("k.glob", said=said) if row["glob"] else said,
        lines=tuple(f"{fit(place['file'])}:{place['line']}" for place in row["places"]),
        behind=words.row(behind) if behind else words("k.perhaps"),
    )
