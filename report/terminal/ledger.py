"""What was taken away on the data's side, in the report for the terminal.

In: a JSON document of the contract. Out: the lines of ``Assumed``, and with ``-v`` one for each row that closed a path.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.document.ledger import hanging
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
COUNTED = {  # by -> of one, of several
    "deny": ("flow by a DENY", "flows by DENY lines"),
    "standard-channel": ("standard channel", "standard channels"),
    "mundane": ("mundane channel", "mundane channels"),
    "only": ("limit 'only'", "limits 'only'"),
    "never": ("limit 'never'", "limits 'never'"),
    "sanitizer": ("sanitizer", "sanitizers"),
    "absent": ("kind of data at a node that is not there", "kinds of data at nodes that are not there"),
    "outdone": ("source or leak by a label of higher rank", "sources or leaks by labels of higher rank"),
    "review": ("element reviewed by a label", "elements reviewed by labels"),
    "decision": ("accepted finding", "accepted findings"),
    "restriction": ("kind of data not asked about", "kinds of data not asked about"),
    "unread-file": ("file that was not read", "files that were not read"),
    "unknown-reader": ("unknown end", "unknown ends"),
}
SAYS = {
    "deny": "denied", "standard-channel": "taken as mundane", "mundane": "mundane", "only": "closed by 'only'",
    "never": "closed by 'never'", "sanitizer": "cleaned", "absent": "said not to be there",
    "outdone": "outdone", "review": "reviewed", "decision": "accepted", "restriction": "not asked about",
}  # fmt: skip


def taken_away_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return what ``Assumed`` says: how much was taken away, by what, and how much of it closed a path."""
    taken = report["assumptions"]["taken_away_by"]
    if not taken:
        return
    parts = [counted(number, *COUNTED[by]) for by, number in taken.items()]
    yield f"   taken away on the data's side: {', '.join(parts)}", ""
    closing = sum(_closes(row) for row in report["taken_away"])
    if closing:
        yield f"   {closing:,} of these closed a path to a leak or an open element (-v lists them)", "yellow"


def hanging_lines(report: Mapping[str, Any], most: int | None) -> Iterator[Line]:
    """Return on which labels it hangs that no leak was found: data gets there and ends on their word (rule S12)."""
    rows = hanging(report)
    if rows:
        said = [f"{place} ({shown_name(row['element'])} {SAYS[row['by']]}{_leak_behind(row)})" for place, row in rows]
        more = f" and {len(said) - most:,} more (-v shows all)" if most is not None and len(said) > most else ""
        what = f"no-leak-found hangs on {counted(len(said), 'label')} at which data ends"
        yield f"   warning: {what}: {', '.join(said[:most])}{more}", "bold yellow"


def _leak_behind(row: Mapping[str, Any]) -> str:
    return f"; without it data gets to the leak {shown_name(row['leak'])}" if row["leak"] else ""


def ledger_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return a line for each row that closed a path: what, where, on whose word, and what lies behind."""
    rows = [row for row in report["taken_away"] if _closes(row)]
    if not rows:
        return
    yield "", ""
    yield f"Closed on somebody's word: {len(rows)}", "bold"
    for row in rows:
        yield f"   {_row(row)}", ""


def _closes(row: Mapping[str, Any]) -> bool:
    return bool(row["leak"] or row["open"] or row["perhaps"])


def _row(row: Mapping[str, Any]) -> str:
    ends = " -> ".join(shown_name(row[end]) for end in ("element", "to") if row[end])
    lines = ", ".join(f"{shown(place['file'])}:{place['line']}" for place in row["places"])
    said = f"{SAYS[row['by']]}{' by a glob' if row['glob'] else ''}"
    said += f" ({shown(row['note'])})" if row["by"] == "outdone" else ""
    where = f"{', '.join(row['categories'])} at {ends}" if ends else ", ".join(row["categories"])
    return f"{where}: {said}{f' at {lines}' if lines else ''}; {_behind(row)}"


def _behind(row: Mapping[str, Any]) -> str:
    """What data would get to."""
    if row["by"] == "decision":
        return f"it reaches {shown_name(row['leak'])}, finding {shown(row['note'])}"
    if row["by"] == "restriction":
        return f"it reaches {shown_name(row['leak'])}"
    places = [f"the leak {shown_name(row['leak'])}"] if row["leak"] else []
    places += [f"{shown_name(row['open'])}, which is not reviewed"] if row["open"] else []
    return f"without it data gets to {' and '.join(places)}" if places else "what lies behind was not worked out"
