"""A fleet in the formats of other people's tools: which robots a finding stands for, which robot for which.

In: what a format holds of the robots that are shown, and the ``FleetView``. Out: the same with the robots of each
pattern, so that nobody takes the robot that is shown for the only one.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.report.document.fleet import counts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern
    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.report.rdf.terms import Triple

FINDING = "rosprivacyFinding/v1"  # fingerprint that is the finding's id
NAMED = 30  # robots in a row


def of_shown_robots(analysis: Analysis, view: FleetView) -> Analysis:
    """Return the analysis without robots that only stand beside others, also in its flows."""
    return replace(view.shown(analysis), graph=_without(analysis.graph, view))


def _without(graph: FlowGraph, view: FleetView) -> FlowGraph:
    beside = {v for v, element in enumerate(graph.elements) if element.robot in view.likeness.second}

    def kept(flows: Any) -> Any:
        return tuple(flow for flow in flows if flow.source not in beside and flow.target not in beside)

    return replace(graph, flows=kept(graph.flows), denied=kept(graph.denied))


def note(view: FleetView) -> str:
    """Return what a reader has to know who sees the robots that are shown only."""
    members = view.likeness.members
    standing = [f"{shown(robot)} for {len(robots):,}" for robot, robots in members.items() if len(robots) > 1]
    more = [f"and {len(standing) - NAMED:,} more"] if len(standing) > NAMED else []
    robots = counted(sum(map(len, members.values())), "robot")
    if not standing:
        return f"A fleet of {robots}"
    rows = ", ".join([*standing[:NAMED], *more])
    return f"A fleet of {robots}; of those that are alike one is named and counted: {rows}"


def on_robots(pattern: Pattern, view: FleetView) -> str:
    """Return on how many robots a pattern is, in a sentence."""
    if not pattern.robots:
        return "It begins and ends outside the robots."
    everybody = counted(sum(map(len, view.likeness.members.values())), "robot")
    across = f", from one to another, {pattern.count:,} times" if pattern.across else ""
    parts = [
        f"{number:,} {what}"
        for number, what in ((pattern.dismissed, "only through another leak"), (pattern.pseudonymised, "pseudonymised"))
        if 0 < number < pattern.count
    ]
    more = f" ({', '.join(parts)})" if parts else ""
    return f"On {len(pattern.robots):,} of {everybody}{across}{more}."


def with_robots(log: dict[str, Any], analysis: Analysis, view: FleetView) -> dict[str, Any]:
    """Return a SARIF log in which each result of a finding tells on which robots it is.

    Parameters
    ----------
    analysis
        Of the whole graph.
    """
    patterns = {pattern.finding.id: pattern for pattern in view.patterns}
    (run,) = log["runs"]
    results = [_result(result, patterns, view) for result in run["results"]]
    invocation = run["invocations"][0]
    told = {"level": "note", "descriptor": {"id": "fleet"}, "message": {"text": f"{note(view)}."}}
    notices = [*invocation["toolExecutionNotifications"], told]
    invocations = [{**invocation, "toolExecutionNotifications": notices}]
    channels = {"standardChannels": counts(analysis, view.likeness)["standard_channels"]}
    properties = {**run["properties"], **channels, "robots": sum(map(len, view.likeness.members.values()))}
    return {**log, "runs": [{**run, "invocations": invocations, "results": results, "properties": properties}]}


def _result(result: dict[str, Any], patterns: dict[str, Pattern], view: FleetView) -> dict[str, Any]:
    pattern = patterns.get(result.get("partialFingerprints", {}).get(FINDING, ""))
    if pattern is None:
        return result
    message = {**result["message"], "text": f"{result['message']['text']} {on_robots(pattern, view)}"}
    more = {
        "robots": list(map(shown, pattern.robots)),
        "pattern": pattern.id,
        "findings": pattern.count,
        "findingsDismissed": pattern.dismissed,
        "findingsPseudonymised": pattern.pseudonymised,
    }
    return {**result, "message": message, "properties": {**result["properties"], **more}}


def robot_triples(view: FleetView) -> Iterator[Triple]:
    """Yield which robots each finding stands for, as RDF."""
    from rdflib import Literal  # noqa: PLC0415 - heavy, and only where RDF is written

    from rosprivacy.report.rdf.terms import RP, finding_iri, text  # noqa: PLC0415

    for pattern in view.patterns:
        iri = finding_iri(pattern.finding)
        yield iri, RP.findings, Literal(pattern.count)
        yield from ((iri, RP.onRobot, text(shown(robot))) for robot in pattern.robots)
