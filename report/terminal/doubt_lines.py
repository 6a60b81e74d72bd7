"""The list of doubts in the report for the terminal: each by name, with a place, and what to do (rule S11).

In: a JSON document of the contract. Out: lines.
"""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.called_alike import kind_in
from rosprivacy.report.verdict import subject

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


def doubt_lines(report: Mapping[str, Any], most: int | None, words: Words) -> Iterator[Line]:
    """Return a line for each doubt, ``most`` of each sort, with what to do about the sort."""
    doubts = report["doubts"]
    if not doubts:
        return
    yield "", ""
    yield words("doubt.list", n=len(doubts)), "bold"
    for name, rows in groupby(doubts, key=lambda doubt: doubt["doubt"]):
        sort = list(rows)
        rank = words(f"doubt.{sort[0]['rank']}")
        yield (
            f"   {words(f'doubt.{name}.title')} ({rank}). {words('doubt.what.to.do', do=words(f'doubt.{name}.do'))}",
            "",
        )
        yield from ((f"      {_row(doubt, words)}", "yellow") for doubt in sort[:most])
        if most is not None and len(sort) > most:
            yield f"      {words('tty.rest', n=len(sort) - most)}", "dim"


def _row(doubt: Mapping[str, Any], words: Words) -> str:
    place = f"{shown(doubt['file'])}:{doubt['line']}" if doubt["line"] else shown(doubt["file"])
    if doubt.get("element"):
        kind = kind_in({**doubt["element"], "pattern": False}, words)
        about = "; ".join(part for part in (kind, ", ".join(doubt["categories"])) if part)
        text = f"{subject(doubt)} ({about})" + (f", {place}" if place else "")
    else:
        text = ": ".join(part for part in (place, doubt["message"]) if part)
    accepted = doubt["accepted"]
    if accepted:
        date = words.date(accepted["expires"])
        said = words("doubt.is.accepted", date=date, owner=shown(accepted["owner"]), reason=shown(accepted["reason"]))
        text = f"{text}; {said}"
    return f"{text}  [{doubt['id']}]"
