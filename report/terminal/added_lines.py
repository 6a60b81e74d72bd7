"""What the enforced view adds, as lines for the terminal (rule S6)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.terminal.finding_lines import details

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.terminal.wrapped import Line
    from rosprivacy.report.words.words import Words


def enforced_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Yield what remains if nodes do not keep to their profiles; nothing where nobody asked."""
    if "enforced" not in report:
        return
    added = report["enforced"]["added"]
    yield "", ""
    yield words("tty.enforced", findings=words.count(len(added), "tty.finding")), "bold"
    for entry in added:
        yield from details(report, [entry["finding"]], words)
        yield f"   {words('tty.enforced.by', enclaves=_named(entry['enclaves']))}", ""
        key = "tty.enforced.split" if entry["split"] else "tty.enforced.no.split"
        yield f"   {words(key, enclaves=_named(entry['split']))}", ""


def _named(enclaves: list[str]) -> str:
    return ", ".join(map(shown, enclaves))
