"""The enforced view, and both views, against the declared one: the whole command in fresh processes (rule S6).

Public policies and a made-up vehicle of 119 nodes in one enclave, where grants grow a hundredfold under the enforced
view; with labels for one kind of data and for many.
"""

from __future__ import annotations

import json
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import vehicle
from measure import Measured, NotMeasured, Row, corpus, run, timed
from turtlebot import MANY, POLICY, chosen_categories, labels_of

from rosprivacy.api import analyze

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import FlowGraph

OFFICE = "policies/open-rmf__rmf_demos/rmf_demos/sros2/policies/office.policy.xml"
OFFICE_LABELS = {
    "labels": 1,
    "nodes": {
        "/rmf_panel": {"source": ["DeliveryOrder"]},
        "/slotcar": {"source": ["RobotPosition"]},
        "/rviz": {"leak": ["DeliveryOrder", "RobotPosition"]},
    },
}
BOUND = 3.0


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    rounds = 3 if quick else 9
    kinds = chosen_categories(MANY)[0]
    with TemporaryDirectory() as name:
        for what, policy, labels in _systems(Path(name), kinds, (MANY,) if quick else (1, MANY)):
            for view in ("enforced", "both"):
                measure = partial(measured, policy, labels, view, rounds)
                yield Row(f"the command, view {view}, {what}", "view declared", measure, bound=BOUND)


def _systems(folder: Path, kinds: list[str], some: tuple[int, ...]) -> Iterator[tuple[str, Path, Path]]:
    file, office = folder / "vehicle.policy.xml", folder / "office.labels.json"
    file.write_text(vehicle.policy(), "utf-8")
    office.write_text(json.dumps(OFFICE_LABELS), "utf-8")
    counts = {count: f"{count} kind{'s' if count > 1 else ''} of data" for count in some}
    for count, many in counts.items():
        of_vehicle = folder / f"vehicle.{count}.labels.json"
        of_vehicle.write_text(vehicle.labels(kinds[:count]), "utf-8")
        yield f"{vehicle.NODES} nodes in one enclave, {many}", file, of_vehicle
    try:
        policies = corpus()
    except NotMeasured:
        return
    for count, many in counts.items():
        yield f"TurtleBot3, {many}", policies / POLICY, labels_of(kinds[:count], folder)
    yield "RMF office, 2 kinds of data", policies / OFFICE, office


def measured(policy: Path, labels: Path, view: str, rounds: int) -> Measured:
    """Time the command under a view against the declared one."""
    command: list[str | Path] = [
        sys.executable,
        "-m",
        "rosprivacy",
        "analyze",
        policy,
        "-l",
        labels,
        "--fail-on",
        "never",
        "--view",
    ]
    return timed(rounds, partial(run, *command, view), partial(run, *command, "declared"), note=told(policy, labels))


def told(policy: Path, labels: Path) -> str:
    """Return the figures of both views, for people: grants are counted by node, role and channel."""
    grants, findings = [], []
    for view in ("declared", "enforced"):
        analysis = analyze(str(policy), labels=str(labels), view=view).analysis
        grants.append(f"{number_of_grants(analysis.graph):,}")
        findings.append(str(sum(finding.stands for finding in analysis.findings)))
    return f"grants {' -> '.join(grants)}, findings {' -> '.join(findings)}"


def number_of_grants(graph: FlowGraph) -> int:
    """Return how many grants nodes have: node, role and channel."""
    elements, grants = graph.elements, set()
    for flow in graph.flows:
        source, target = elements[flow.source], elements[flow.target]
        if source.is_channel != target.is_channel:
            node, channel = (source, target) if target.is_channel else (target, source)
            grants.add((node.identity, flow.role, channel.identity))
    return len(grants)
