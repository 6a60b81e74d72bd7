"""What lies outside ROS, for the JSON document: facts as stated, what they hold, what nobody stated.

In: an analysis. Out: plain dicts and lists, in the order of the graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.non_ros import TAKEN, country_unknown, limited

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Element, NonRosFacts


def inventory(analysis: Analysis, hierarchy: Hierarchy) -> list[dict[str, Any]]:
    """Return every element outside ROS with its facts (rule S9)."""
    found = analysis.spread
    numbers = {element: i for i, element in enumerate(analysis.graph.elements)}
    rows = []
    for element, facts in analysis.outside.items():
        holds = found.names(found.present(numbers[element]))
        row = {
            "element": {"robot": element.robot, "kind": element.kind, "name": element.name},
            "file": facts.place.file,
            "line": facts.place.line,
            **_facts(facts),
            "holds": list(holds),
        }
        rows.append(row | _not_known(element, facts, holds, hierarchy))
    return rows


def taken_by_kind(analysis: Analysis) -> dict[str, str]:
    """Return what each kind that there is does unless a label says otherwise."""
    return {kind: TAKEN[kind] for kind in sorted({e.kind for e in analysis.outside} & set(TAKEN))}


def without_backups(analysis: Analysis) -> list[Element]:
    """Return the storages of whose backups nothing is stated: they are taken to have none (rule S9)."""
    return [e for e, facts in analysis.outside.items() if e.kind == "storage" and facts.backups is None]


def _facts(facts: NonRosFacts) -> dict[str, Any]:
    said = {
        "retention": _durations(facts.retention),
        "backups": facts.backups if facts.backups is None or isinstance(facts.backups, bool) else str(facts.backups),
        "encrypted": facts.encrypted,
        "country": facts.country,
        "area": facts.area,
        "operator": facts.operator,
        "recipient": facts.recipient,
        "transfer": facts.transfer,
    }
    return {key: value for key, value in said.items() if value is not None and value not in ("", {})}


def _durations(stated: tuple[tuple[str, Any], ...]) -> dict[str, str]:
    return {category or "every": str(duration) for category, duration in stated}


def _not_known(element: Element, facts: NonRosFacts, holds: tuple[str, ...], hierarchy: Hierarchy) -> dict[str, Any]:
    """What the answer could not judge: the country, or a retention without a limit to hold it against."""
    found: dict[str, Any] = {}
    if country_unknown(element, facts):
        found["missing"] = ["country"]
    if element.kind == "storage" and facts.retention:
        without = [name for name in holds if not limited(facts, name, hierarchy)]
        found |= {"without_limit": without} if without else {}
    return found
