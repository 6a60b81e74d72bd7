"""Rows -> Neo4j: each robot replaced in one transaction, in batches, idempotent. Takes a driver.

In: ``RobotRows``, as many as there are, and the vocabulary. Out: the graph of ``schema.py``. A robot whose digest and
counts are those in the database is left alone. Whoever reads sees a robot as it was or as it is, never half; what
people added by hand (without our mark ``robot``) stays, as do other robots.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime, timezone
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar
from uuid import uuid4

from rosprivacy.analysis.errors import DatabaseError, InputError, shown
from rosprivacy.ingest.neo4j_graph import cypher
from rosprivacy.ingest.neo4j_graph.ids import category_labels
from rosprivacy.ingest.neo4j_graph.robot_facts import loaded_with, unreadable
from rosprivacy.ingest.neo4j_graph.schema import (
    BROADER,
    COULD_FLOW_TO,
    DERIVES_FROM,
    ENDED_BY_SPLITTING,
    FALLS_UNDER,
    FLOWS_TO,
    IN_ENCLAVE,
    LOOK_AT,
    MADE_POSSIBLE_BY,
    ROBOT,
    ROLES,
    SUFFIXES,
    constraints,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from neo4j import Driver, ManagedTransaction

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows, Row
    from rosprivacy.ontology.vocabulary import Vocabulary

Part = TypeVar("Part")
BATCH = 10_000  # rows per statement and, for robots smaller than that, about so many per transaction
LONGEST_NAME = 200
PARTS = {  # of ``RobotRows``: what writes them once elements are there, in this order
    "enclaves": cypher.MERGE_ENCLAVES,
    "memberships": cypher.create_relationships(IN_ENCLAVE),
    "flows": cypher.create_relationships(FLOWS_TO),
    "derived": cypher.create_relationships(DERIVES_FROM),
    "carried": cypher.CREATE_CARRIES,
    "findings": cypher.CREATE_FINDINGS,
    "across": cypher.CREATE_ACROSS,
    "beyond.findings": cypher.CREATE_ADDED,
    "beyond.flows": cypher.create_relationships(COULD_FLOW_TO),
    "beyond.possible": cypher.create_relationships(MADE_POSSIBLE_BY),
    "beyond.split": cypher.create_relationships(ENDED_BY_SPLITTING),
}


CHANGED = ("dismissed", "pseudonymised")  # of a finding: how it stands
REMEMBERED = ("pattern", "kind", "category", "source", "leak", *CHANGED)  # of a finding that came or went


@dataclass(frozen=True, slots=True)
class Run:
    """A run of ``load``, as the database remembers it.

    Attributes
    ----------
    at
        When it began, in UTC; ISO 8601, in whole seconds.
    version
        Of the program.
    """

    at: str
    version: str
    id: str = field(default_factory=lambda: str(uuid4()))

    @classmethod
    def begun(cls, version: str, at: datetime | None = None) -> Run:
        """Return a run that begins now, or at another time."""
        return cls((at or datetime.now(timezone.utc)).astimezone(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"), version)


@dataclass(frozen=True, slots=True)
class Loaded:
    """How many robots were written, and how many were there already as they are.

    Attributes
    ----------
    replaced
        Of those written, by name: the policies of the robot that was there, where these are others.
    """

    written: int
    unchanged: int
    replaced: Mapping[str, Collection[str]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class _There:
    """A robot of the database: its digest, where its counts are still those that were loaded; (file, SHA-256) of it."""

    digest: str
    policies: frozenset[tuple[str, str]]


def load(
    driver: Driver,
    robots: Iterable[RobotRows],
    vocabulary: Vocabulary,
    progress: Callable[[int], None] = lambda _: None,
    run_of: Run | None = None,
) -> Loaded:
    """Write robots and categories.

    Parameters
    ----------
    progress
        Called with the number of rows after each transaction.
    run_of
        Remembered with what it changed; without it nothing is remembered.

    Raises
    ------
    InputErrors
        If a category's label cannot be one.
    DatabaseError
        If the server refuses or is lost; what was written until then is whole, and a later load goes on.

    Notes
    -----
    Linear in the rows. The driver repeats a transaction that failed for a passing reason, such as a deadlock.
    """
    labels = sorted(label + suffix for label in category_labels(vocabulary).values() for suffix in SUFFIXES)
    written = unchanged = 0
    replaced: dict[str, Collection[str]] = {}
    with refusals(), driver.session() as session:
        for statement in constraints():
            session.run(statement).consume()
        session.execute_write(write_vocabulary, vocabulary)
        session.execute_write(_note, run_of, "running", 0, 0)
        for batch in in_batches(robots, attrgetter("size"), attrgetter("robot")):
            there = session.execute_read(_read_there, [rows.robot for rows in batch])
            changed = _changed(there, batch)
            replaced |= _of_other_policies(there, changed)
            if changed:
                session.execute_write(_write_robots, changed, labels, run_of)
            written += len(changed)
            unchanged += len(batch) - len(changed)
            session.execute_write(_note, run_of, "running", written, unchanged)
            progress(sum(rows.size for rows in batch))
        session.execute_write(_note, run_of, "whole", written, unchanged)
    return Loaded(written, unchanged, replaced)


def others_there(driver: Driver, rows: RobotRows) -> Collection[str]:
    """Return the policies of the robot of that name in the database, if there is one and these are others."""
    with refusals(), driver.session() as session:
        return _of_other_policies(session.execute_read(_read_there, [rows.robot]), [rows]).get(rows.robot, ())


def unload(driver: Driver, names: Sequence[str]) -> list[str]:
    """Remove robots; return the names of those that were there, sorted.

    What people added stays, but for what hangs on an element that goes.
    """

    def work(transaction: ManagedTransaction) -> list[str]:
        known = [record["name"] for record in transaction.run(cypher.READ_ROBOTS, names=sorted(set(names)))]
        run(transaction, cypher.LOCK_ROBOTS, names=known)
        _remove(transaction, known)
        run(transaction, cypher.DELETE_EMPTY_ENCLAVES, names=known)
        run(transaction, cypher.DELETE_ROBOTS, names=known)
        return sorted(known)

    with refusals(), driver.session() as session:
        return session.execute_write(work)


def check_robot_name(name: str) -> str:
    """Return a name that a robot can have in the database."""
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        hint = f"use 1 to {LONGEST_NAME} printable characters"
        raise InputError("--robot", 0, f"{shown(name)!r} cannot name a robot", hint)
    return name


@contextmanager
def refusals() -> Iterator[None]:
    """What the server refuses, in one line; that it is lost is said by whoever opened the driver."""
    from neo4j.exceptions import Neo4jError  # noqa: PLC0415 - light start

    try:
        yield
    except Neo4jError as error:
        if error.is_retryable():
            raise
        what = shown((error.message or str(error)).partition("\n")[0])
        raise DatabaseError(f"the server refuses to write: {what}; check its log and your user's rights") from error


def in_batches(every: Iterable[Part], size: Callable[[Part], int], name: Callable[[Part], str]) -> Iterator[list[Part]]:
    """Yield what is written as a whole, several small parts together: up to ``BATCH`` rows, no name twice."""
    batch: dict[str, Part] = {}
    rows = 0
    for part in every:
        if batch and (rows + size(part) > BATCH or name(part) in batch):
            yield [*batch.values()]
            batch, rows = {}, 0
        batch[name(part)] = part
        rows += size(part)
    if batch:
        yield [*batch.values()]


def _read_there(transaction: ManagedTransaction, names: list[str]) -> dict[str, _There]:
    """Those of some robots that are there."""
    records = transaction.run(cypher.READ_DIGESTS, names=names)
    return {r["name"]: _There(r["digest"] if r["whole"] else "", _policies(r["assumptions"])) for r in records}


def _policies(assumptions: str | None) -> frozenset[tuple[str, str]]:
    """The (file, SHA-256) of a robot's policies, as its assumptions name them; none where nobody can read these."""
    robot = {"assumptions": assumptions}
    said = {} if unreadable(robot) else loaded_with(robot)
    return frozenset((entry["file"], entry["sha256"]) for entry in said.get("policies", ()))


def _changed(stored: Mapping[str, _There], batch: list[RobotRows]) -> list[RobotRows]:
    known = {name: robot.digest for name, robot in stored.items()}
    return [rows for rows in sorted(batch, key=lambda rows: rows.robot) if known.get(rows.robot) != rows.digest]


def _of_other_policies(stored: Mapping[str, _There], robots: Iterable[RobotRows]) -> dict[str, Collection[str]]:
    """Robots that are to be replaced, and were loaded from other files; a file more or less that is included is none.

    Files of other names with the same contents are the same.
    """
    replaced: dict[str, Collection[str]] = {}
    for rows in robots:
        before = stored[rows.robot].policies if rows.robot in stored else frozenset()
        now = _policies(rows.properties.get("assumptions"))
        (old, contents), (new, same) = (
            [{entry[part] for entry in files} for part in (0, 1)] for files in (before, now)
        )
        if before and contents != same and not (old <= new or new <= old):
            replaced[rows.robot] = sorted(old)
    return replaced


def write_vocabulary(transaction: ManagedTransaction, vocabulary: Vocabulary) -> None:
    """Write the categories, with what is broader and under which provisions they fall."""
    categories = vocabulary.categories
    kinds = {
        c.iri: {
            "name": c.name,
            "label": c.label,
            "title": c.title,
            "definition": c.definition,
            "article9": c.article9,
            "data_types": list(c.data_types),
            "identity_factors": list(c.identity_factors),
            "gdpr": c.gdpr or None,
        }
        for c in categories.values()
    }
    looked_at = {name for c in categories.values() for name in c.look_at}
    pointed = {one.name: one for one in vocabulary.pointed.provisions if one.name in looked_at}
    provisions: dict[str, Row] = {
        one.iri: {
            "name": one.name,
            "title": one.meaning,
            "as_of": one.as_of,
            "applies_from": one.applies or None,
            "country": one.country or None,
        }
        for one in pointed.values()
    }
    law = [(c.iri, legal) for c in categories.values() for legal in c.law]
    provisions |= {legal.iri: {"name": legal.name, "title": legal.meaning, "as_of": legal.as_of} for _, legal in law}
    broader = [_link(c.iri, categories[up].iri) for c in categories.values() for up in c.broader]
    under = [
        _link(
            iri,
            legal.iri,
            verdict=legal.verdict,
            condition=legal.condition or None,
            stated_of=legal.stated_of,
            sources=list(legal.sources),
        )
        for iri, legal in law
    ]
    at = [_link(c.iri, pointed[name].iri) for c in categories.values() for name in c.look_at if name in pointed]
    run(transaction, cypher.MERGE_CATEGORIES, rows=[{"id": iri, "properties": p} for iri, p in kinds.items()])
    run(transaction, cypher.DROP_CATEGORY_LINKS, iris=list(kinds))
    run(transaction, cypher.create_relationships(BROADER), rows=broader)
    run(transaction, cypher.MERGE_PROVISIONS, rows=[{"id": i, "properties": p} for i, p in sorted(provisions.items())])
    run(transaction, cypher.create_relationships(FALLS_UNDER), rows=under)
    run(transaction, cypher.create_relationships(LOOK_AT), rows=at)


def _link(source: str, target: str, **properties: Any) -> Row:
    return {"source": source, "target": target, "properties": properties}


def _note(transaction: ManagedTransaction, load: Run | None, state: str, written: int, unchanged: int) -> None:
    """Write how far a run is."""
    if load is not None:
        facts = {"at": load.at, "version": load.version, "state": state, "written": written, "unchanged": unchanged}
        run(transaction, cypher.MERGE_LOADS, rows=[{"id": load.id, "properties": facts}])


def _note_changes(transaction: ManagedTransaction, robots: list[RobotRows], stored: list[str], load: Run) -> None:
    """Write which findings of robots that are there come and go; before they do."""
    before = _patterns(
        (record["robot"], record["properties"]) for record in transaction.run(cypher.READ_PATTERNS, names=stored)
    )
    there = set(stored)
    now = _patterns((r.robot, row["properties"]) for r in robots if r.robot in there for row in r.findings)
    rows: list[Row] = []
    for robot, pattern in sorted(before.keys() | now.keys()):
        old, new = before.get((robot, pattern)), now.get((robot, pattern))
        finding = new or old or {}
        what = "new" if old is None else "gone" if new is None else "changed"
        if what != "changed" or any(finding[name] != (old or {})[name] for name in CHANGED):
            facts = {"at": load.at, "robot": robot, "what": what, **{name: finding.get(name) for name in REMEMBERED}}
            rows.append({"id": f"{load.id} {robot} {pattern}", "properties": facts})
    write(transaction, cypher.MERGE_CHANGES, rows)
    write(transaction, cypher.LINK_CHANGES, [_link(row["id"], load.id) for row in rows])


def _patterns(findings: Iterable[tuple[str, Row]]) -> dict[tuple[str, str], Row]:
    """(robot, pattern) -> of its findings the one that stands most: which of many pairs are written may vary."""
    least: dict[tuple[str, str], Row] = {}
    for robot, finding in findings:
        key = robot, finding["pattern"]
        if key not in least or [finding[name] for name in CHANGED] < [least[key][name] for name in CHANGED]:
            least[key] = finding
    return least


def _write_robots(
    transaction: ManagedTransaction, robots: list[RobotRows], labels: list[str], load: Run | None
) -> None:
    """Replace some robots, sorted by name, so that two loads do not wait for each other in a ring."""
    names = [rows.robot for rows in robots]
    run(transaction, cypher.LOCK_ROBOTS, names=names)
    there = [record for record in transaction.run(cypher.READ_ROBOTS, names=names) if record["known"]]
    known = [record["name"] for record in there]
    # Of one that no load wrote, others may have made elements: it is there, and nothing of it has changed.
    written_before = [record["name"] for record in there if record["version"]]
    if written_before and load is not None:
        _note_changes(transaction, robots, written_before, load)
    if known:
        new = {row["id"] for rows in robots for row in (*rows.elements, *rows.intakes)}
        _remove(transaction, known, new)
    fresh = [row for rows in robots for row in (*rows.elements, *rows.intakes) if rows.robot not in known]
    old = [row for rows in robots for row in (*rows.elements, *rows.intakes) if rows.robot in known]
    write(transaction, cypher.CREATE_ELEMENTS, fresh)
    write(transaction, cypher.REPLACE_ELEMENTS, old, labels=labels)
    write(transaction, cypher.MERGE_FOREIGN, list({row["id"]: row for rows in robots for row in rows.foreign}.values()))
    for part, statement in PARTS.items():
        write(transaction, statement, [row for rows in robots for row in attrgetter(part)(rows)])
    for role, kind in ROLES.items():
        said = [row for rows in robots for row in rows.roles.get(role, ())]
        write(transaction, cypher.create_relationships(kind), said)
    if known:
        run(transaction, cypher.DELETE_EMPTY_ENCLAVES, names=known)
    absent = {field.name: None for field in ROBOT.properties if field.name not in (ROBOT.key, "version")}
    whole = [{"robot": r.robot, "properties": absent | r.properties} for r in robots]
    run(transaction, cypher.WRITE_ROBOTS, rows=whole)
    if load is not None:
        run(transaction, cypher.WROTE_ROBOTS, id=load.id, names=names)


def _remove(transaction: ManagedTransaction, names: list[str], but: Collection[str] = ()) -> None:
    """Remove what was written of some robots; elements that are to be written again stay."""
    run(transaction, cypher.DELETE_FINDINGS, names=names)
    delete_beyond(transaction, names)
    run(transaction, cypher.DELETE_OURS, names=names)
    ids = [record["id"] for record in transaction.run(cypher.READ_ELEMENTS, names=names)]
    write(transaction, cypher.DELETE_ELEMENTS, [key for key in ids if key not in but])


def delete_beyond(transaction: ManagedTransaction, names: list[str]) -> None:
    """Remove what the enforced view adds to some robots: what is there now may be something else."""
    for statement in cypher.DELETE_BEYOND:
        run(transaction, statement, names=names)


def write(transaction: ManagedTransaction, statement: str, rows: Sequence[Row | str], **values: Any) -> None:
    """Run a statement over rows, ``BATCH`` at a time."""
    for start in range(0, len(rows), BATCH):
        run(transaction, statement, rows=rows[start : start + BATCH], **values)


def run(transaction: ManagedTransaction, statement: str, **parameters: Any) -> None:
    """Run a statement and wait for its end."""
    transaction.run(statement, **parameters).consume()
