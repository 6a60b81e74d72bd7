"""A fleet in SARIF: on which robots each finding is, which robot stands for which.

In: a log of the robots that are shown, and the ``FleetView``. Out: the same with the robots of each pattern, so that
nobody takes the robot that is shown for the only one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.report.robots import note, on_robots

if TYPE_CHECKING:
    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern

FINDING = "rosprivacyFinding/v1"  # fingerprint that is the finding's id


def with_robots(log: dict[str, Any], view: FleetView, counts: Counts) -> dict[str, Any]:
    """Return a SARIF log in which each result of a finding tells on which robots it is."""
    patterns = {pattern.finding.id: pattern for pattern in view.patterns}
    (run,) = log["runs"]
    results = [_result(result, patterns, view) for result in run["results"]]
    invocation = run["invocations"][0]
    told = {"level": "note", "descriptor": {"id": "fleet"}, "message": {"text": f"{note(view)}."}}
    notices = [*invocation["toolExecutionNotifications"], told]
    invocations = [{**invocation, "toolExecutionNotifications": notices}]
    channels = {"standardChannels": counts.standard_channels}
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
