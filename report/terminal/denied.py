"""Denied flows -> lines for the terminal: what one policy line allows and another takes back (rule S5).

In: a JSON document of the contract. Out: lines, with the places of both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.naming import shown_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

Line = tuple[str, str]  # text, style


def denied_lines(report: Mapping[str, Any], *, most: int | None) -> Iterator[Line]:
    """Return the denied flows; ``most`` of them, all if None."""
    flows = report["denied"]
    if not flows:
        return
    yield "", ""
    yield f"Allowed by one line and denied by another: {len(flows)}", "bold"
    for flow in flows[:most]:
        allowed, denied = _places(flow["allowed_by"]), _places(flow["denied_by"])
        ends = f"{shown_name(flow['source'])} -> {shown_name(flow['target'])}"
        yield f"   {ends}  ({flow['role']}; ALLOW at {allowed}, DENY at {denied})", ""
    if most is not None and len(flows) > most:
        yield f"   … and {len(flows) - most} more (-v shows all)", "dim"


def _places(lines: Iterable[Mapping[str, Any]]) -> str:
    places = list(dict.fromkeys(f"{shown(line['file'])}:{line['line']}" for line in lines))
    return f"{places[0]} and {len(places) - 1} more" if len(places) > 1 else places[0]
