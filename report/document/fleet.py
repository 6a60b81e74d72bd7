"""The JSON document of a fleet: how many robots, which are alike, patterns of findings, robots that differ.

In: the document of the graph in which a robot stands for all that are alike. Out: the same with ``fleet``, and with
counts of the whole fleet.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from rosprivacy.report.document.records import element_dict
from rosprivacy.report.robots import form_rows

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.patterns import DeviantRobots, FleetView, Pattern
    from rosprivacy.analysis.fleet.tallies import Share
    from rosprivacy.report.schemas.analysis import (
        AnalysisDocument,
        DeviantEntry,
        FleetEntry,
        PatternEntry,
        ShareEntry,
        StandardFile,
    )


def fleet_document(document: AnalysisDocument, view: FleetView, counts: Counts) -> AnalysisDocument:
    """Return the document of a fleet; what the whole graph tells, it tells of one robot of those that are alike.

    Parameters
    ----------
    document
        Of the analysis as ``FleetView.shown`` gives it.
    """
    standard, likeness = document["assumptions"]["standard_channels"], view.likeness
    taken: StandardFile | None = {**standard, "taken": counts.standard_channels} if standard else None
    return {
        **document,
        "subjects": _without(document["subjects"], likeness),
        "surroundings": _without(document["surroundings"], likeness),
        "sanitizers": _without(document["sanitizers"], likeness),
        "derivations": _without(document["derivations"], likeness),
        "unreached": _without(document["unreached"], likeness),
        "elements": counts.elements,
        "flows": counts.flows,
        "denied_flows": counts.denied_flows,
        "standard_channels": counts.standard_channels,
        "assumptions": {**document["assumptions"], "standard_channels": taken},
        "fleet": _fleet(view),
    }


def _without(value: Any, likeness: Likeness) -> Any:
    """Rows without elements of robots that only stand beside others: what is true of them, the others tell."""
    if isinstance(value, list):
        return [_without(item, likeness) for item in value if not _second(item, likeness)]
    if isinstance(value, dict) and "robot" not in value:
        return {key: _without(item, likeness) for key, item in value.items()}
    return value


def _second(item: Any, likeness: Likeness) -> bool:
    element = item.get("element", item) if isinstance(item, dict) else {}
    return element.get("robot") in likeness.second


def _fleet(view: FleetView) -> FleetEntry:
    likeness = view.likeness
    models = Counter(dict.fromkeys(sorted(set(likeness.models.values())), 0))
    for robot, model in likeness.models.items():
        models[model] += likeness.weight(robot)
    return {
        "robots": sum(models.values()),
        "models": dict(models),
        "alike": [
            {"robot": robot, "model": likeness.models[robot], "robots": list(robots)}
            for robot, robots in sorted(likeness.members.items())
        ],
        "patterns": [_pattern(pattern) for pattern in view.patterns],
        "deviants": [_deviant(deviant) for deviant in view.deviants],
    }


def _pattern(pattern: Pattern) -> PatternEntry:
    return {
        "id": pattern.id,
        "finding": pattern.finding.id,
        "across": pattern.across,
        "findings": pattern.count,
        "dismissed": pattern.dismissed,
        "pseudonymised": pattern.pseudonymised,
        "accepted": pattern.accepted,
        "robots": list(pattern.robots),
        "forms": form_rows(pattern),
    }


def _deviant(deviant: DeviantRobots) -> DeviantEntry:
    return {
        "robots": list(deviant.robots),
        "model": deviant.model,
        "more": _shares(deviant.additional),
        "fewer": _shares(deviant.fewer),
        "more_open": [element_dict(element) for element in deviant.more_open],
        "fewer_open": [element_dict(element) for element in deviant.fewer_open],
    }


def _shares(shares: Iterable[Share]) -> list[ShareEntry]:
    return [
        {
            "pattern": s.pattern,
            "ends": s.ends,
            "dismissed": s.dismissed,
            "pseudonymised": s.pseudonymised,
            "accepted": s.accepted,
        }
        for s in shares
    ]
