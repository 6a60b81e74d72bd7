"""What was taken away on the data's side, in the report for the terminal.

In: a JSON document of the contract. Out: the lines of ``Assumed``, and with ``-v`` one for each row that closed a path.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.called_alike import both
from rosprivacy.report.document.ledger import hanging
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


def taken_away_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return what ``Assumed`` says: how much was taken away, by what, and how much of it closed a path."""
    taken = report["assumptions"]["taken_away_by"]
    if not taken:
        return
    parts = [words.count(number, f"tty.by.{by}") for by, number in taken.items()]
    yield f"   {words('tty.taken', what=', '.join(parts))}", ""
    closing = sum(_closes(row) for row in report["taken_away"])
    if closing:
        yield f"   {words('tty.closing', n=closing)}", "yellow"


def hanging_lines(report: Mapping[str, Any], most: int | None, words: Words) -> Iterator[Line]:
    """Return on which labels it hangs that no leak was found: data gets there and ends on their word (rule S12)."""
    rows = hanging(report)
    if rows:
        said = [
            f"{place} ({shown_name(row['element'])} {_says(row, words)}{_leak_behind(row, words)})"
            for place, row in rows
        ]
        left_out = len(said) - most if most is not None else 0
        more = words("tty.more.verbose", n=left_out) if left_out > 0 else ""
        labels = ", ".join(said[:most]) + more
        yield f"   {words.count(len(said), 'tty.hanging', labels=labels)}", "bold yellow"


def _says(row: Mapping[str, Any], words: Words) -> str:
    return words(f"tty.says.{row['by']}")


def _leak_behind(row: Mapping[str, Any], words: Words) -> str:
    return words("tty.leak.behind", leak=shown_name(row["leak"])) if row["leak"] else ""


def ledger_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return a line for each row that closed a path: what, where, on whose word, and what lies behind."""
    rows = [row for row in report["taken_away"] if _closes(row)]
    if not rows:
        return
    yield "", ""
    yield words("tty.ledger", n=len(rows)), "bold"
    for row in rows:
        yield f"   {_row(row, words)}", ""


def _closes(row: Mapping[str, Any]) -> bool:
    return bool(row["leak"] or row["open"] or row["perhaps"])


def _row(row: Mapping[str, Any], words: Words) -> str:
    ends = " -> ".join(shown_name(row[end]) for end in ("element", "to") if row[end])
    lines = ", ".join(f"{shown(place['file'])}:{place['line']}" for place in row["places"])
    kinds = ", ".join(row["categories"])
    said = _says(row, words) + (words("tty.by.glob") if row["glob"] else "")
    said += f" ({shown(row['note'])})" if row["by"] == "outdone" else ""
    return words(
        "tty.ledger.line",
        where=words("tty.ledger.at", kinds=kinds, ends=ends) if ends else kinds,
        said=said,
        lines=words("tty.ledger.lines", lines=lines) if lines else "",
        behind=_behind(row, words),
    )


def _behind(row: Mapping[str, Any], words: Words) -> str:
    """What data would get to."""
    if row["by"] == "decision":
        return words("tty.reaches.finding", leak=shown_name(row["leak"]), id=shown(row["note"]))
    if row["by"] == "restriction":
        return words("tty.reaches", leak=shown_name(row["leak"]))
    places = [words("tty.the.leak", leak=shown_name(row["leak"]))] if row["leak"] else []
    places += [words("tty.the.open", element=shown_name(row["open"]))] if row["open"] else []
    return words("tty.without", places=both(places, words)) if places else words("tty.not.worked.out")
