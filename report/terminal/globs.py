"""What globs of label files decide and close, in the report for the terminal.

In: a JSON document of the contract. Out: the warnings of ``Assumed``, and with ``-v`` one line for each glob.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
WARNINGS = {
    "half": "that is more than half of the nodes, channels or flows that data gets to: check that it is meant",
    "last-path": "without it the verdict would not be no-leak-found: check that it is meant",
}


def glob_warnings(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return what ``Assumed`` says of globs that decide more than a person may see."""
    for row in report["assumptions"].get("globs", ()):
        if row["warning"]:
            yield f"   warning: {_row(row)}; {WARNINGS[row['warning']]}", "bold yellow"


def glob_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return a line for each glob of the label files."""
    rows = report["assumptions"].get("globs", ())
    if rows:
        yield "", ""
        yield f"Globs of label files: {len(rows)}", "bold"
    for row in rows:
        yield f"   {_row(row)}", ""


def _row(row: Mapping[str, Any]) -> str:
    flows = row.get("flows", 0)
    decided = [counted(row["elements"], "element")] if row["elements"] or not flows else []
    decided += [counted(flows, "flow")] if flows else []
    parts = [f"decides {' and '.join(decided)}"]
    parts += [f"ends data at {row['closed']:,}"] if row["closed"] else []
    parts += [f"ends data along {counted(row['flows_closed'], 'flow')}"] if row.get("flows_closed") else []
    parts += [f"answers for {row['reviewed']:,}"] if row["reviewed"] else []
    behind = [f"the leak {shown_name(row['leak'])}"] if row["leak"] else []
    behind += [f"{shown_name(row['open'])}, which is not reviewed"] if row["open"] else []
    lies = f" (behind it: {' and '.join(behind)})" if behind else ""
    return f"the glob at {shown(row['file'])}:{row['line']} ({', '.join(row['says'])}) {', '.join(parts)}{lies}"
