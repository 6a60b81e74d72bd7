"""What message types close, and when they were observed, in the report for the terminal (rules S15, S16).

In: a JSON document of the contract. Out: lines of what is assumed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.catalogs.words import Words

Line = tuple[str, str]  # text, style


def type_lines(report: Mapping[str, Any], most: int | None, words: Words) -> Iterator[Line]:
    """Return which files of types were read, how many flows types close, and the findings that only these close."""
    assumptions = report["assumptions"]
    for file in assumptions.get("types", ()):
        seen = file["observed"]
        start, end = (words.moment(shown(seen[at])) for at in ("from", "to"))
        times = words("tty.types.times", start=start, end=end) if start else ""
        yield f"   {words('tty.types.file', file=shown(file['file']), sha=file['sha256'][:12], times=times)}", ""
    if "type_limits" not in assumptions:
        return
    limits = assumptions["type_limits"]
    if limits is None:
        yield f"   {words('tty.types.none')}", ""
        return
    flows = words.count(limits["flows"], "tty.types.flows")
    yield f"   {words('tty.types.limits', flows=flows, file=shown(limits['file']), sha=limits['sha256'][:12])}", ""
    closed = [_closed(row) for row in assumptions.get("closed_by_types", ())]
    if closed:
        more = words("tty.more.verbose", n=len(closed) - most) if most is not None and len(closed) > most else ""
        yield f"   {words.count(len(closed), 'tty.types.closed')} {'; '.join(closed[:most])}{more}", "yellow"


def _closed(row: Mapping[str, Any]) -> str:
    return f"{row['category']}: {shown_name(row['source'])} -> {shown_name(row['leak'])}"
