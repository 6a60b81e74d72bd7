"""What lies outside ROS, for the JSON document: facts as stated, what they hold, what nobody stated.

In: an analysis. Out: plain dicts and lists, in the order of the graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.non_ros import TAKEN, limited, not_stated

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Element, NonRosFacts
    from rosprivacy.analysis.model.recording import Recording
    from rosprivacy.report.contract.stated import NonRosEntry, NonRosNotKnown, NonRosStated, RecordingEntry


def inventory(analysis: Analysis, hierarchy: Hierarchy) -> list[NonRosEntry]:
    """Return every element outside ROS with its facts (rule S9)."""
    found = analysis.spread
    numbers = {element: i for i, element in enumerate(analysis.graph.elements)}
    rows: list[NonRosEntry] = []
    for element, facts in analysis.outside.items():
        holds = found.names(found.present(numbers[element]))
        row: NonRosEntry = {
            "element": {"robot": element.robot, "kind": element.kind, "name": element.name},
            "file": facts.place.file,
            "line": facts.place.line,
            **_facts(facts),
            "holds": list(holds),
            **_not_known(element, facts, holds, hierarchy),
        }
        rows.append(row)
    return rows


def taken_by_kind(analysis: Analysis) -> dict[str, str]:
    """Return what each kind that there is does unless a label says otherwise."""
    return {kind: TAKEN[kind] for kind in sorted({e.kind for e in analysis.outside} & set(TAKEN))}


def without_backups(analysis: Analysis) -> list[Element]:
    """Return the storages of whose backups nothing is stated: they are taken to have none (rule S9)."""
    return [e for e, facts in analysis.outside.items() if e.kind == "storage" and facts.backups is None]


def _facts(facts: NonRosFacts) -> NonRosStated:
    said: NonRosStated = {}
    if facts.retention:
        said["retention"] = _durations(facts.retention)
    if facts.backups is not None:
        said["backups"] = facts.backups if isinstance(facts.backups, bool) else str(facts.backups)
    if facts.encrypted is not None:
        said["encrypted"] = facts.encrypted
    if facts.country:
        said["country"] = facts.country
    if facts.area:
        said["area"] = facts.area
    if facts.operator:
        said["operator"] = facts.operator
    if facts.recipient:
        said["recipient"] = facts.recipient
    if facts.transfer:
        said["transfer"] = facts.transfer
    if facts.contract:
        said["contract"] = facts.contract
    if facts.recording:
        said["recording"] = _recording(facts.recording)
    return said


def _recording(recording: Recording) -> RecordingEntry:
    from rosprivacy.analysis.model.recording import iso  # noqa: PLC0415 - light start

    said: RecordingEntry = {"bag": recording.bag, "bytes": recording.size, "topics": recording.topics}
    if recording.messages is not None:
        said["messages"] = recording.messages
    if recording.start is not None:
        said["start"] = iso(recording.start)
    if recording.end is not None:
        said["end"] = iso(recording.end)
    if recording.oldest is not None:
        said["oldest"] = iso(recording.oldest)
    return said


def _durations(stated: tuple[tuple[str, Any], ...]) -> dict[str, str]:
    return {category or "every": str(duration) for category, duration in stated}


def _not_known(element: Element, facts: NonRosFacts, holds: tuple[str, ...], hierarchy: Hierarchy) -> NonRosNotKnown:
    """What the answer could not judge: what nobody states, or a retention without a limit to hold it against."""
    found: NonRosNotKnown = {}
    if missing := not_stated(element, facts):
        found["missing"] = list(missing)
    judged = element.kind == "storage" and facts.retention
    if judged and (without := [name for name in holds if not limited(facts, name, hierarchy)]):
        found["without_limit"] = without
    return found
