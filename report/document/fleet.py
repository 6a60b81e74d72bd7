"""The JSON document of a fleet: how many robots, which are alike, patterns of findings, robots that differ.

In: the document of the graph in which a robot stands for all that are alike. Out: the same with ``fleet``, and with
counts of the whole fleet.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rosprivacy.report.document.analysis import element_dict

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.patterns import Deviant, FleetView, Likeness, Pattern, Share

ROWS = ("subjects", "sanitizers", "derivations", "unreached")  # what the whole graph tells; the rest is shown already


def fleet_document(told: dict[str, Any], view: FleetView, counts: Counts) -> dict[str, Any]:
    """Return the document of a fleet.

    Parameters
    ----------
    told
        Of the analysis as ``FleetView.shown`` gives it.
    """
    numbers = asdict(counts)
    assumptions = dict(told["assumptions"])
    if assumptions["standard_channels"]:
        assumptions["standard_channels"] = {**assumptions["standard_channels"], "taken": numbers["standard_channels"]}
    shown = {key: _without(told[key], view.likeness) for key in ROWS}
    return {**told, **shown, **numbers, "assumptions": assumptions, "fleet": _fleet(view)}


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


def _fleet(view: FleetView) -> dict[str, Any]:
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


def _pattern(pattern: Pattern) -> dict[str, Any]:
    return {
        "id": pattern.id,
        "finding": pattern.finding.id,
        "across": pattern.across,
        "findings": pattern.count,
        "dismissed": pattern.dismissed,
        "pseudonymised": pattern.pseudonymised,
        "accepted": pattern.accepted,
        "robots": list(pattern.robots),
    }


def _deviant(deviant: Deviant) -> dict[str, Any]:
    return {
        "robots": list(deviant.robots),
        "model": deviant.model,
        "more": _shares(deviant.more),
        "fewer": _shares(deviant.fewer),
        "more_open": [element_dict(element) for element in deviant.more_open],
        "fewer_open": [element_dict(element) for element in deviant.fewer_open],
    }


def _shares(shares: Iterable[Share]) -> list[dict[str, Any]]:
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
