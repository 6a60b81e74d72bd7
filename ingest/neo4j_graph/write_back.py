"""Analysis of what is stored -> the database: only what changed is written. Takes a driver.

In: ``Stored`` and its analysis. Out: properties and labels of elements, what flows carry, findings. Labels, policies
and what people added are not touched. If a robot was loaded since it was read, nothing of its batch is written.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import robot_verdicts
from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.errors import DatabaseError
from rosprivacy.analysis.findings.derived_from import origins
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.ingest.neo4j_graph import cypher
from rosprivacy.ingest.neo4j_graph.carrying import Carrying
from rosprivacy.ingest.neo4j_graph.ids import category_labels, element_id
from rosprivacy.ingest.neo4j_graph.loading import delete_beyond, refusals, run, write
from rosprivacy.ingest.neo4j_graph.rows import (
    Names,
    Roles,
    element_results,
    end_id,
    finding_row,
    flow_results,
    intake_row,
    kind_labels,
    origin_properties,
)
from rosprivacy.ingest.neo4j_graph.schema import DERIVES_FROM, DOMAIN, ELEMENT, KIND_LABELS, SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from neo4j import Driver, ManagedTransaction

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.ingest.neo4j_graph.read_back import Stored
    from rosprivacy.ontology.vocabulary import Vocabulary

Row = dict[str, Any]
ROBOTS = 200  # whose changes are written in one transaction

WRITE_ELEMENTS = (
    "UNWIND $rows AS row MATCH (n) WHERE elementId(n) = row.key "
    "SET n += row.properties REMOVE n:$(row.stale) SET n:$(row.labels)"
)
WRITE_FLOWS = "UNWIND $rows AS row MATCH ()-[f]->() WHERE elementId(f) = row.key SET f += row.properties"
# Flows, findings and what is carried end at elements that people added, also at those of a later transaction.
NAME_ELEMENTS = "UNWIND $rows AS row MATCH (n) WHERE elementId(n) = row.key SET n:Element, n.id = row.properties.id"
READ_ORIGINS = (
    "MATCH (a)-[d:DERIVES_FROM]->(b) WHERE d.robot IN $names "
    "RETURN elementId(d) AS key, a.id AS source, b.id AS target, properties(d) AS properties"
)
DELETE_ORIGINS = "UNWIND $rows AS row MATCH ()-[d:DERIVES_FROM]->() WHERE elementId(d) = row.key DELETE d"
VERDICTS = (
    "UNWIND $rows AS row MATCH (r:Robot {name: row.robot}) "
    "SET r.verdict = row.verdict, r.doubts = row.doubts, r.version = r.version + 1 REMOVE r.digest"
)


def write_back(
    driver: Driver,
    stored: Stored,
    analysis: Analysis,
    vocabulary: Vocabulary,
    doubts: Mapping[str, list[str]] = {},
    broken: Collection[str] = (),
) -> int:
    """Write the answer; return how many elements and flows changed.

    Parameters
    ----------
    doubts
        By robot, as its property keeps them.
    broken
        Robots of which one of these breaks the verdict (rule S11).

    Raises
    ------
    DatabaseError
        If the server refuses, or a robot was written since ``stored`` was read.
    """
    rows = _Changes(stored, analysis, vocabulary, doubts, broken)
    with refusals(), driver.session() as session:
        for start in range(0, len(rows.robots), ROBOTS):
            session.execute_write(rows.write, rows.robots[start : start + ROBOTS])
    return rows.changed


class _Changes:
    """What differs, by robot; what belongs to no robot stands under the empty name and comes first."""

    def __init__(
        self,
        stored: Stored,
        analysis: Analysis,
        vocabulary: Vocabulary,
        doubts: Mapping[str, list[str]],
        broken: Collection[str],
    ) -> None:
        self._stored, self._doubts = stored, doubts
        self._analysis = analysis
        labels = category_labels(vocabulary)
        self._ours = {label + suffix for label in labels.values() for suffix in SUFFIXES}
        names = Names(analysis.spread, vocabulary, labels)
        elements = analysis.graph.elements
        robots = [stored.robot_of(vertex) for vertex in range(len(elements))]
        ids = [
            str(p.get("id") or element_id(r, e)) for p, r, e in zip(stored.properties, robots, elements, strict=True)
        ]
        results = list(element_results(analysis, stored.bound, names, Roles(vocabulary, labels)))
        self._elements = self._changed_elements(results, ids, robots)
        self._unnamed = [row for rows in self._elements.values() for row in rows if ELEMENT.label in row["labels"]]
        self._flows = self._changed_flows(names, robots)
        carrying = Carrying(analysis, [said for _, said in results], labels)
        self._intakes = [
            intake_row(robots[v], ids[v], elements[v], carrying.labels(v)) for v in sorted(carrying.intakes)
        ]
        self._carried: dict[str, dict[tuple[str, str], set[str]]] = defaultdict(dict)
        for (a, part), (b, to), types in carrying.steps:
            self._carried[robots[a]][end_id(ids[a], part), end_id(ids[b], to)] = set(types)
        self.changed = sum(map(len, self._elements.values())) + sum(map(len, self._flows.values()))
        by_element = dict(zip(elements, ids, strict=True))
        of_robot = dict(zip(elements, robots, strict=True))
        contexts = Contexts.of(analysis.graph, stored.bound, vocabulary.categories)
        self._findings: dict[str, list[Row]] = defaultdict(list)
        self._across: dict[str, list[Row]] = defaultdict(list)
        for finding in analysis.findings:
            pattern, across = pattern_id(finding, stored.likeness), stored.likeness.across(finding)
            row, steps = finding_row(finding, pattern, vocabulary, by_element, of_robot, contexts, across=across)
            self._findings[of_robot[finding.source]].append(row)
            self._across[of_robot[finding.source]] += steps
        self._origins: dict[str, list[Row]] = defaultdict(list)
        for origin in origins(analysis.spread):
            robot = robots[origin.maker]
            properties = origin_properties(analysis, origin, robot)
            self._origins[robot].append(
                {"source": ids[origin.maker], "target": ids[origin.source], "properties": properties}
            )
        self.robots = sorted({*robots, *stored.robots})
        self._verdicts = robot_verdicts(analysis, self.robots, of_robot.__getitem__, broken)

    def _changed_elements(
        self, results: Iterable[tuple[Row, list[str]]], ids: list[str], robots: list[str]
    ) -> dict[str, list[Row]]:
        rows: dict[str, list[Row]] = defaultdict(list)
        stored, elements = self._stored, self._analysis.graph.elements
        for vertex, (properties, labels) in enumerate(results):
            known = {"id": ids[vertex], "kind": elements[vertex].kind, **properties}
            new = {ELEMENT.label, *kind_labels(elements[vertex]), *labels}
            old = stored.labels[vertex]
            stale = (old & (self._ours | set(KIND_LABELS.values()))) - new
            changes = {key: value for key, value in known.items() if stored.properties[vertex].get(key) != value}
            if changes or stale or new - old:
                row = {
                    "key": stored.keys[vertex],
                    "properties": changes,
                    "stale": sorted(stale),
                    "labels": sorted(new - old),
                }
                rows[robots[vertex]].append(row)
        return rows

    def _changed_flows(self, names: Names, robots: list[str]) -> dict[str, list[Row]]:
        rows: dict[str, list[Row]] = defaultdict(list)
        stored = self._stored
        for index, properties in enumerate(flow_results(self._analysis, names)):
            flow, old = self._analysis.graph.flows[index], stored.flow_properties[index]
            known = {"role": flow.role, "decision": "allow", **properties}
            changes = {key: value for key, value in known.items() if old.get(key) != value}
            if changes:
                rows[robots[flow.source]].append({"key": stored.flow_keys[index], "properties": changes})
        return rows

    def write(self, transaction: ManagedTransaction, robots: list[str]) -> None:
        """Write some robots, if they are still as they were read."""
        names = [name for name in robots if name]
        run(transaction, cypher.LOCK_KNOWN_ROBOTS, names=names)
        versions = {r["name"]: r["version"] for r in transaction.run(cypher.READ_ROBOTS, names=names)}
        for name in names:
            if versions.get(name) != self._stored.robots[name].get("version"):
                raise DatabaseError(f"robot {name!r} was loaded meanwhile; analyse the database again")
        write(transaction, NAME_ELEMENTS, self._unnamed)
        write(transaction, WRITE_ELEMENTS, _rows(self._elements, robots))
        write(transaction, WRITE_FLOWS, _rows(self._flows, robots))
        run(transaction, cypher.DELETE_FINDINGS, names=robots)
        if self.changed:  # what is there is not what was loaded: what the enforced view adds to it is not known
            delete_beyond(transaction, robots)
        self._write_origins(transaction, robots)
        write(transaction, cypher.CREATE_FINDINGS, _rows(self._findings, robots))
        write(transaction, cypher.CREATE_ACROSS, _rows(self._across, robots))
        self._write_carried(transaction, robots)
        write(transaction, VERDICTS, [self._verdict_on(name) for name in names])

    def _verdict_on(self, robot: str) -> Row:
        domain = self._stored.robots[robot].get("part") == DOMAIN
        verdict = None if domain else str(self._verdicts[robot])
        return {"robot": robot, "verdict": verdict, "doubts": self._doubts.get(robot)}

    def _write_origins(self, transaction: ManagedTransaction, robots: list[str]) -> None:
        """What nodes of some robots make of data of which source, as far as it differs."""
        new = {_origin(row): row for row in _rows(self._origins, robots)}
        there = transaction.run(READ_ORIGINS, names=robots)
        stale = [{"key": row["key"]} for row in there if new.pop(_origin(row), None) is None]  # or there twice
        write(transaction, DELETE_ORIGINS, stale)
        write(transaction, cypher.create_relationships(DERIVES_FROM), list(new.values()))

    def _write_carried(self, transaction: ManagedTransaction, robots: list[str]) -> None:
        """Where kinds of data go from elements of some robots, as far as it differs; intakes stand before."""
        write(transaction, cypher.MERGE_INTAKES, self._intakes, labels=sorted(self._ours))
        new = {ends: types for robot in robots for ends, types in self._carried.get(robot, {}).items()}
        old = {(a, b): set(types) for a, b, types in transaction.run(cypher.READ_CARRIES, names=robots)}
        write(transaction, cypher.DELETE_CARRIES, _additions(old, new))
        write(transaction, cypher.CREATE_CARRIES, _additions(new, old))
        run(transaction, cypher.DELETE_INTAKES, names=robots, ids=[row["id"] for row in self._intakes])


def _additions(present: Mapping[tuple[str, str], set[str]], former: Mapping[tuple[str, str], set[str]]) -> list[Row]:
    """What goes between two ends in one and not in the other."""
    more = {ends: types - former.get(ends, set()) for ends, types in present.items()}
    return [{"source": a, "target": b, "types": sorted(types)} for (a, b), types in more.items() if types]


def _origin(row: Mapping[str, Any]) -> tuple[str, str, str]:
    """What a ``DERIVES_FROM`` says, to compare by."""
    properties = {key: value for key, value in row["properties"].items() if value is not None}
    return row["source"], row["target"], json.dumps(properties, sort_keys=True)


def _rows(grouped: Mapping[str, list[Row]], robots: list[str]) -> list[Row]:
    return [row for robot in robots for row in grouped.get(robot, ())]
