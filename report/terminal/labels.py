"""What labels take away, in the report for the terminal: standard channels, and sources and leaks that are overruled.

In: a JSON document of the contract. Out: lines of what is assumed (rules S7, S12, S13).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.naming import infrastructure_file, shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

SHIPPED = "rosprivacy:standard"
Line = tuple[str, str]  # text, style


def standard_lines(report: Mapping[str, Any], most: int | None) -> Iterator[Line]:
    """Return which standard channels were taken as mundane, on which file's word, and what data stops there."""
    assumptions = report["assumptions"]
    taken = assumptions["standard_channels"]
    if not taken:
        yield "   no standard channels taken as mundane", ""
        return
    count = report["standard_channels"]
    by = f"by {shown(taken['file'])} (sha256 {taken['sha256'][:12]})"
    by = "(rosprivacy labels --standard)" if taken["file"] == SHIPPED else by
    proposed = infrastructure_file(assumptions)
    more = f", or by {proposed} (rosprivacy labels --infrastructure)" if proposed else ""
    yield f"   {counted(count, 'standard ROS channel')} taken as mundane {by}{more}", ""
    reached = [f"{shown_name(row['element'])} ({', '.join(row['categories'])})" for row in reached_of(report)]
    if reached:
        yield f"   data gets to {len(reached):,} of them and stops there: {_listed(reached, most)}", ""
    unchanged = [shown_name(element) for element in assumptions.get("standard_channels_unchanged", ())]
    if unchanged:
        what = f"of {len(unchanged):,} of them a glob says otherwise, which does not count: {_listed(unchanged, most)}"
        yield f"   {what}; name them, or write out the end of the glob (*/rosout)", "yellow"


def absent_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return the nodes of which labels say that they are not on the robot."""
    for row in report["assumptions"].get("absent", ()):
        yield f"   {shown_name(row['element'])} is not on the robot: {shown(row['why'])}", ""


def overruled_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return how many sources and leaks labels say that other labels take away."""
    rows = report["assumptions"].get("overruled", ())
    if rows:
        what = counted(len(rows), "label of a source or leak is", "labels of sources or leaks are")
        yield f"   {what} taken away by another label (see the warnings)", "yellow"


def reached_of(report: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """Return the standard channels at which data stops; documents of earlier versions do not say."""
    rows: Sequence[Mapping[str, Any]] = report["assumptions"].get("standard_channels_reached", ())
    return rows


def _listed(names: Sequence[str], most: int | None) -> str:
    more = f" and {len(names) - most:,} more (-v shows all)" if most is not None and len(names) > most else ""
    return ", ".join(names[:most]) + more
