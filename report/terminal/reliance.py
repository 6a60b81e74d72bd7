"""What the answer hangs on, in the report for the terminal: what there would be if one statement were wrong.

In: a JSON document of the contract. Out: how many statements there are, and the worst; with ``-v`` all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

Line = tuple[str, str]  # text, style
WORST = 3
FEW = 3  # findings, questions and elements that are named in a line


def reliance_lines(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    """Return what the answer hangs on: its own part of the report."""
    rows = report.get("hangs_on", ())
    if not rows:
        return
    own = sum(not row["shipped"] for row in rows)
    parts = [counted(own, "statement of your labels", "statements of your labels")] if own else []
    parts += [counted(len(rows) - own, "shipped one", "shipped ones")] if len(rows) > own else []
    yield "", ""
    yield f"What the answer hangs on: {' and '.join(parts)}", "bold"
    worst = [row for row in rows if not row["shipped"] and (row["findings"] or row["perhaps"])]
    told = rows if verbose else worst[:WORST]
    for row in told:
        yield f"   {_row(row, None if verbose else FEW)}", "yellow" if row["findings"] else ""
    if len(told) < len(rows):
        yield "   if one of these is wrong, there are more findings or open questions (-v lists them)", "dim"


def _row(row: Mapping[str, Any], most: int | None) -> str:
    ends = _some([shown_name(element) for element in row["elements"]], FEW)
    to = f" -> {_some([shown_name(element) for element in row['to']], FEW)}" if row["to"] else ""
    by = f", says {shown(row['author'])}" if row["author"] else ""
    why = f" ({shown(row['why'])})" if row["why"] else ""
    glob = " by a glob" if row["glob"] else ""
    return f"{shown(row['file'])}:{row['line']}: {ends}{to} {_says(row)}{glob}{by}{why}; if wrong: {_opened(row, most)}"


def _says(row: Mapping[str, Any]) -> str:
    """What the statement says, in the words of label files."""
    names = ", ".join(row["categories"])
    if row["role"] == "sanitizer":
        return "absent" if row["method"] == "absent" else f"sanitizer of {names} ({row['method']})"
    if row["role"] in ("only", "never"):
        return f"{row['role']} [{names}]"
    said = {"no-leak": "leak: none", "no-source": "source: none"}.get(row["role"], row["role"])
    return f"{said} of {names}" if names else said


def _opened(row: Mapping[str, Any], most: int | None) -> str:
    if row["refused"]:
        return f"the other labels contradict each other: {shown(row['refused'])}"
    if row["perhaps"]:
        return "this was not worked out, too many statements need an analysis of the whole"
    found = _some([_finding(opening) for opening in row["findings"]], most)
    asked = _some([f"{shown_name(one['element'])} ({', '.join(one['categories'])})" for one in row["questions"]], most)
    return "; ".join(filter(None, (found, f"to review: {asked}" if asked else "")))


def _finding(opening: Mapping[str, Any]) -> str:
    form = "pseudonymised " if opening["pseudonymised"] else ""
    through = " through another leak" if opening["dismissed"] else ""
    kind = "" if opening["kind"] == "disclosure" else f" ({opening['kind']})"
    worse = "" if opening["new"] else ", worse than today"
    source, leak = shown_name(opening["source"]), shown_name(opening["leak"])
    return f"{form}{opening['category']}: {source} -> {leak}{kind}{through}{worse}"


def _some(names: Sequence[str], most: int | None) -> str:
    texts = list(dict.fromkeys(names))  # the legs of a service have one name
    more = f" and {len(texts) - most:,} more" if most is not None and len(texts) > most else ""
    return f"{', '.join(texts[:most])}{more}"
