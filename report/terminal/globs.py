"""What globs of label files decide and close, in the report for the terminal.

In: a JSON document of the contract. Out: the warnings of ``Assumed``, and with ``-v`` one line for each glob.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.called_alike import both
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


def glob_warnings(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return what ``Assumed`` says of globs that decide more than a person may see."""
    for row in report["assumptions"].get("globs", ()):
        if row["warning"]:
            why = words(f"tty.glob.{row['warning']}")
            yield f"   {words('tty.glob.warning', row=_row(row, words), why=why)}", "bold yellow"


def glob_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return a line for each glob of the label files."""
    rows = report["assumptions"].get("globs", ())
    if rows:
        yield "", ""
        yield words("tty.globs", n=len(rows)), "bold"
    for row in rows:
        yield f"   {_row(row, words)}", ""


def _row(row: Mapping[str, Any], words: Words) -> str:
    flows = row.get("flows", 0)
    decided = [words.count(row["elements"], "element")] if row["elements"] or not flows else []
    decided += [words.count(flows, "flow")] if flows else []
    parts = [words("tty.glob.decides", what=both(decided, words))]
    parts += [words("tty.glob.closed", n=row["closed"])] if row["closed"] else []
    if row.get("flows_closed"):
        parts.append(words("tty.glob.along", flows=words.count(row["flows_closed"], "flow")))
    parts += [words("tty.glob.reviewed", n=row["reviewed"])] if row["reviewed"] else []
    behind = [words("tty.the.leak", leak=shown_name(row["leak"]))] if row["leak"] else []
    behind += [words("tty.the.open", element=shown_name(row["open"]))] if row["open"] else []
    lies = words("tty.glob.behind", places=both(behind, words)) if behind else ""
    place, says = f"{shown(row['file'])}:{row['line']}", ", ".join(row["says"])
    return words("tty.glob", place=place, says=says, parts=", ".join(parts), behind=lies)
