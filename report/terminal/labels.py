"""What labels take away, in the report for the terminal: standard channels, and sources and leaks that are overruled.

In: a JSON document of the contract. Out: lines of what is assumed (rules S7, S12, S13).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.naming import infrastructure_file, shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words

SHIPPED = "rosprivacy:standard"
Line = tuple[str, str]  # text, style


def standard_lines(report: Mapping[str, Any], most: int | None, words: Words) -> Iterator[Line]:
    """Return which standard channels were taken as mundane, on which file's word, and what data stops there."""
    assumptions = report["assumptions"]
    taken = assumptions["standard_channels"]
    if not taken:
        yield f"   {words('tty.standard.none')}", ""
        return
    proposed = infrastructure_file(assumptions)
    more = words("tty.standard.proposed", file=proposed) if proposed else ""
    channels = words.count(report["standard_channels"], "tty.standard")
    by = "tty.standard.shipped" if taken["file"] == SHIPPED else "tty.standard.by"
    said = words(by, channels=channels, more=more, file=shown(taken["file"]), sha=taken["sha256"][:12])
    yield f"   {said}", ""
    reached = [f"{shown_name(row['element'])} ({', '.join(row['categories'])})" for row in reached_of(report)]
    if reached:
        yield f"   {words('tty.standard.reached', n=len(reached), names=_listed(reached, most, words))}", ""
    rows = [row for row in reached_of(report) if "keeps_from" in row]
    keeping = [f"{shown_name(row['element'])} -> {shown_name(row['keeps_from'])}" for row in rows]
    if keeping:
        yield f"   {words('tty.standard.keeps', n=len(keeping), names=_listed(keeping, most, words))}", ""
    unchanged = [shown_name(element) for element in assumptions.get("standard_channels_unchanged", ())]
    if unchanged:
        names = _listed(unchanged, most, words)
        yield f"   {words('tty.standard.unchanged', n=len(unchanged), names=names)}", "yellow"


def absent_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return the nodes of which labels say that they are not on the robot."""
    for row in report["assumptions"].get("absent", ()):
        yield f"   {words('tty.absent', element=shown_name(row['element']), why=shown(row['why']))}", ""


def overruled_lines(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """Return how many sources and leaks labels say that other labels take away."""
    rows = report["assumptions"].get("overruled", ())
    if rows:
        yield f"   {words.count(len(rows), 'tty.overruled')}", "yellow"


def reached_of(report: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """Return the standard channels at which data stops; documents of earlier versions do not say."""
    rows: Sequence[Mapping[str, Any]] = report["assumptions"].get("standard_channels_reached", ())
    return rows


def _listed(names: Sequence[str], most: int | None, words: Words) -> str:
    left_out = len(names) - most if most is not None else 0
    return ", ".join(names[:most]) + (words("tty.more.verbose", n=left_out) if left_out > 0 else "")
