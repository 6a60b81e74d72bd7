"""What was asked for in the report for the terminal: an answer to a narrower question says so in its verdict (S11).

In: a JSON document of the contract. Out: parts of lines, and lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import MAY_REVEAL
from rosprivacy.report.terminal.fleet import named

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

Line = tuple[str, str]  # text, style
ALL = "all"
LEVELS = {
    "always": "what always falls under Article 9(1) GDPR",
    "conditional": "what falls under Article 9(1) GDPR always or on a condition",
    MAY_REVEAL: "what can fall under Article 9(1) GDPR",
}


def asked_at_verdict(report: Mapping[str, Any]) -> str:
    """Return what the answer is restricted to, for the line of the verdict; empty if it is about everything."""
    said = report["assumptions"]
    parts = []
    if said["categories_asked"] != ALL:
        parts.append(named(said["categories_asked"]))
    if said["data_types_asked"] != ALL:
        parts.append(f"data that is {' or '.join(map(shown, said['data_types_asked']))}")
    if "identity_factors_asked" in said:
        parts.append(_factors(said))
    if said["article9_only"]:
        parts.append(LEVELS[said.get("article9_level", MAY_REVEAL)])
    return f"; only {' and '.join(parts)} was asked for" if parts else ""


def _factors(said: Mapping[str, Any]) -> str:
    return f"data with the identity factor {' or '.join(map(shown, said['identity_factors_asked']))}"


def may_be_asked(report: Mapping[str, Any], category: str) -> str:
    """Return which of the kinds asked for data of another may be, with a space before; empty for what is asked for."""
    kinds = report["assumptions"].get("may_be_asked", {}).get(category)
    return f" (may be {named(kinds)})" if kinds else ""


def asked_lines(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return the restrictions, as assumptions."""
    said = report["assumptions"]
    if said["categories_asked"] != ALL:
        yield f"   only {', '.join(map(shown, said['categories_asked']))} and narrower categories", ""
    if said["data_types_asked"] != ALL:
        yield f"   only data that is {' or '.join(map(shown, said['data_types_asked']))}", ""
    if "identity_factors_asked" in said:
        yield f"   only {_factors(said)}, or of which that is not stated", ""
    if said["article9_only"]:
        yield f"   only {LEVELS[said.get('article9_level', MAY_REVEAL)]}, or of which that is not known", ""
    for category, kinds in said.get("may_be_asked", {}).items():
        yield f"   and {category}, since data of this kind may be {named(kinds)}", ""
