"""What the enforced view adds -> the rows that Neo4j takes: findings and flows of kinds of their own (rule S6).

In: ``Added``, and the flows that profiles allow. Out: plain values. Nothing of it is a ``Finding`` or a ``FLOWS_TO``:
what queries give of the declared view stays as it is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.findings.beyond import beyond
from rosprivacy.ingest.database.ids import enclave_id

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.findings.beyond import Added, Ends
    from rosprivacy.analysis.model import Element

    Row = dict[str, Any]


class Beyond(NamedTuple):
    """What the enforced view adds, and the flows that profiles allow."""

    added: tuple[Added, ...] = ()
    declared: frozenset[Ends] = frozenset()


class BeyondRows(NamedTuple):
    """Rows of one robot.

    Attributes
    ----------
    findings
        As those of ``RobotRows``.
    flows
        ``source``, ``target`` (ids), ``properties``: steps that no profile of their node allows.
    possible, split
        ``source`` (id of the finding), ``target`` (id of the enclave), ``properties``.
    """

    findings: list[Row]
    flows: list[Row]
    possible: list[Row]
    split: list[Row]


NOTHING = BeyondRows([], [], [], [])


def add_beyond(
    rows: BeyondRows,
    said: Row,
    one: Added,
    finding: Finding,
    ids: Mapping[Element, str],
    robots: Mapping[Element, str],
    declared: frozenset[Ends],
) -> None:
    """Add a finding that only the enforced view has, with its steps and enclaves.

    Parameters
    ----------
    said
        Its row, as that of any finding.
    ids, robots
        Of the elements of its witness.
    """
    properties = {key: value for key, value in said["properties"].items() if key != "dismissed"}
    steps = beyond(finding, declared)
    told = {"view": "enforced", **_told(one, finding), "beyond": [_step(finding, number) for number in steps]}
    rows.findings.append({**said, "properties": {**properties, **told}})
    robot, taken = properties["robot"], {(row["source"], row["target"]) for row in rows.flows}
    for number in steps:
        step = finding.steps[number]
        node = step.target if step.source.is_channel else step.source
        row = {"source": ids[step.source], "target": ids[step.target], "properties": _line(finding, number, robot)}
        if (row["source"], row["target"]) not in taken:
            rows.flows.append(row)
        for path in sorted({grant.enclave for grant in step.grants} & set(one.enclaves)):
            end = {"source": said["id"], "target": enclave_id(robots[node], path), "properties": {}}
            if end not in rows.possible:
                rows.possible.append(end)
    rows.split.extend({"source": said["id"], "target": enclave_id(robot, path), "properties": {}} for path in one.split)


def _line(finding: Finding, number: int, robot: str) -> Row:
    step = finding.steps[number]
    grant = step.grants[0]
    return {
        "role": step.role, "robot": robot, "file": grant.place.file, "line": grant.place.line,
        "enclave": grant.enclave, "profile": grant.node,
    }  # fmt: skip


def _step(finding: Finding, number: int) -> str:
    step = finding.steps[number]
    return f"{step.source.name} {step.role} {step.target.name} ({step.grants[0].place})"


def _told(one: Added, finding: Finding) -> Row:
    return {
        "way": [element.name for element in finding.witness],
        "enclaves": list(one.enclaves),
        "split": list(one.split),
        "move": f"{one.move[1]} from {one.move[0]}" if one.move else None,
        "deny": [f"{line.role} {line.name} in {line.enclave} ({line.policy})" for line in one.deny],
        "loses": [f"{node[2]} {role} {channel[2]}" for node, role, channel in one.loses],
        "plain": one.plain,
        "opened_by": [str(place) for place in one.opened] or None,
    }
