"""Cypher -> rows: read-only by the server's own plan and access mode, with bounds on rows, size and time.

In: a driver, Cypher, values. Out: ``QueryRows`` of plain values. What does more than read the graph is refused, by the
server's plan of it (``EXPLAIN``, which runs nothing), before it is run; what a server's parser would not survive is
refused by its text, before the server gets it. The access mode of the session stops what writes to the graph. It does
not stop ``LOAD CSV``, procedures, and what acts on the server; the plan shows these, whatever the text looks like. Only
what is known to read the graph passes: a step that a newer server brings is refused until it stands here. So is a name
that nothing has: Neo4j itself answers such a query with no rows (rule S11).
"""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from queue import Empty, SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import DatabaseError as OurDatabaseError
from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.written_names import A_LITTLE, FEW, did_you_mean, nearest
from rosprivacy.queries.graph_values import GraphValue, graph_values, nodes_in, plain, value_of, with_known
from rosprivacy.queries.library import NAMES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from neo4j import Driver, ResultSummary, Transaction

    from rosprivacy.queries.library import Query

DEEPEST = 150  # brackets and CASE within each other
ALIKE = 200  # of one operator with no other between: NOT NOT …, .a.a…
OPERATORS = 2_000  # between two commas or clauses; beyond each of these the server's stack overflows, or it plans on
_TEXT = r"""'(?:[^'\\]|\\.)*'?|"(?:[^"\\]|\\.)*"?|`[^`]*`?|//[^\n]*"""  # what is not closed goes to the end
_CLAUSES = "MATCH|WITH|WHERE|RETURN|UNWIND|CALL|UNION|ORDER|LIMIT|SKIP|YIELD"
_WORDS = rf"(?P<clause>\b(?:{_CLAUSES})\b|,)|(?P<open>\bCASE\b|[(\[{{])|(?P<close>\bEND\b|[)\]}}])"
_TOKEN = re.compile(
    rf"(?:{_TEXT})|{_WORDS}|(?P<operator>\b(?:NOT|AND|OR|XOR|IN|IS)\b|[-+*/%^=<>.:|])", re.IGNORECASE | re.DOTALL
)
INSTEAD = "queries only read the graph: use cypher-shell or the driver for it"
# Operators of plans, as Neo4j's manual lists them, without what stands before and behind: `Partitioned`,
# `Directed` and `Undirected`, `(All)`, `@neo4j`.
_STEPS = """
    AllNodesScan AllRelationshipsScan NodeByLabelScan UnionNodeByLabelsScan IntersectionNodeByLabelsScan
    SubtractionNodeByLabelsScan RelationshipTypeScan UnionRelationshipTypesScan DynamicLabelNodeLookup
    NodeIndexScan NodeIndexContainsScan NodeIndexEndsWithScan NodeIndexSeek NodeIndexSeekByRange NodeUniqueIndexSeek
    NodeUniqueIndexSeekByRange MultiNodeIndexSeek NodeByIdSeek NodeByElementIdSeek
    RelationshipIndexScan RelationshipIndexContainsScan RelationshipIndexEndsWithScan RelationshipIndexSeek
    RelationshipIndexSeekByRange RelationshipUniqueIndexSeek RelationshipUniqueIndexSeekByRange
    RelationshipByIdSeek RelationshipByElementIdSeek NodeCountFromCountStore RelationshipCountFromCountStore
    Expand OptionalExpand VarLengthExpand ProjectEndpoints ShortestPath StatefulShortestPath PathPropagatingBFS
    Repeat BidirectionalRepeat TriadicBuild TriadicFilter TriadicSelection
    Apply SemiApply AntiSemiApply LetSemiApply LetAntiSemiApply SelectOrSemiApply SelectOrAntiSemiApply
    LetSelectOrSemiApply LetSelectOrAntiSemiApply ConditionalApply AntiConditionalApply RollUpApply Anti Optional
    CartesianProduct NodeHashJoin NodeLeftOuterHashJoin NodeRightOuterHashJoin ValueHashJoin
    AssertSameNode AssertSameRelationship Union OrderedUnion Argument EmptyRow EmptyResult ProduceResults Projection
    Filter Unwind Distinct OrderedDistinct EagerAggregation OrderedAggregation Aggregation Eager PreserveOrder
    Sort PartialSort Top PartialTop Top1WithTies Limit ExhaustiveLimit Skip CacheProperties RemoteBatchProperties
    ShowIndexes ShowConstraints ShowProcedures ShowFunctions
"""
_PROCEDURES = """
    db.labels db.relationshipTypes db.propertyKeys db.info db.ping dbms.components
    db.schema.visualization db.schema.nodeTypeProperties db.schema.relTypeProperties
    db.index.fulltext.listAvailableAnalyzers db.index.fulltext.queryNodes db.index.fulltext.queryRelationships
    db.index.vector.queryNodes db.index.vector.queryRelationships
"""
STEPS, PROCEDURES = frozenset(_STEPS.split()), frozenset(_PROCEDURES.split())
CALL = "ProcedureCall"
SCHEMA = ("CreateIndex", "DropIndex", "CreateConstraint", "DropConstraint", "DoNothingIf")
LOAD = "LoadCSV"
_STEP = re.compile(r"(?:Partitioned)?(?:Directed|Undirected)?([^(@]+).*", re.DOTALL)
# A subquery inside an expression is no step of its own: the server writes it out in the details of the step, in its
# own words. What text of a user stands there too is refused with it if it looks the same.
_LOADS = re.compile(r"\bLOAD\s+CSV\b", re.IGNORECASE)
_CALLS = re.compile(r"\b(?:Unr|R)esolvedCall\b|\bCALL\s+[^\s({]|\b(?:TERMINATE|SHOW)\s+TRANSACTION", re.IGNORECASE)
KnownNames = Mapping[str, Collection[str]]  # by "label", "relationship type", "property"
_LISTED = {
    "label": "CALL db.labels()",
    "relationship type": "CALL db.relationshipTypes()",
    "property": "CALL db.propertyKeys()",
}
_UNKNOWN = {"01N50": "label", "01N51": "relationship type", "01N52": "property"}  # statuses of GQL
_MISSING_NAME = re.compile(r"`(.+)` does not exist", re.DOTALL)
_EARLIER = re.compile(
    r"\(the missing (label|relationship type|property)(?: name)? is: (.+)\)", re.DOTALL
)  # before 5.23
_ADDED = "SHOW FUNCTIONS YIELD name, isBuiltIn WHERE NOT isBuiltIn RETURN name ORDER BY name"


def refuse_too_much(text: str) -> None:
    """Let a query pass that a server can take apart in its time.

    Examples
    --------
    >>> refuse_too_much("RETURN 1" + " + 1" * 100)
    """
    rows, last, alike = [0], "", 0  # operators so far, at each level of brackets; the last one, and how many of it
    for token in _TOKEN.finditer(text):
        sort, word = token.lastgroup, token[0].upper()
        if sort == "open":
            rows.append(0)
        elif sort == "close":
            rows = rows[:-1] or [0]
        elif sort == "clause":
            rows[-1] = alike = 0
        elif sort == "operator":
            rows[-1] += 1
            last, alike = word, alike + 1 if word == last else 1
        if len(rows) > DEEPEST + 1:
            raise QueryError(f"the query has brackets within brackets, more than {DEEPEST} deep; ask for less")
        if alike > ALIKE or rows[-1] > OPERATORS:
            raise QueryError(f"the query has too many operators in a row, {rows[-1]:,} and more; ask for less")


def refuse_unless_reading(transaction: Transaction, text: str, values: Mapping[str, Any]) -> ResultSummary:
    """Let a query pass that only reads the graph; return what the server says of it.

    Parameters
    ----------
    transaction
        The one that the query is to run in, so that it is the same server that plans and runs it.

    Raises
    ------
    QueryError
        If the query writes, reads files or addresses, calls what is not known to only read, or acts on the server.
    """
    summary = transaction.run(f"EXPLAIN {text}", dict(values)).consume()
    if not summary.plan:
        raise QueryError(f"the server gives no plan of the query, so what it does is not known; {INSTEAD}")
    steps = list(_steps(summary.plan))
    if summary.query_type in ("w", "rw") or steps[0]["operatorType"].startswith(SCHEMA):
        raise QueryError("the query would write; queries only read: write with cypher-shell or the driver")
    for step in steps:
        for what in _faults(step):
            raise QueryError(f"the query {what}; {INSTEAD}")
    added = [record[0] for record in transaction.run(_ADDED)]
    for name in added:
        if any(name.lower() in _details(step).lower().replace("`", "") for step in steps):
            what = f"calls {shown(name)}, which was added to Neo4j and is not known to only read"
            raise QueryError(f"the query {what}; {INSTEAD}")
    return summary


def _steps(plan: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    waiting = [plan]
    while waiting:
        step = waiting.pop()
        yield step
        waiting += reversed(step.get("children", ()))


def _details(step: Mapping[str, Any]) -> str:
    return str(step["args"].get("Details", ""))


def _faults(step: Mapping[str, Any]) -> Iterator[str]:
    operator, details = step["operatorType"], _details(step)
    match = _STEP.fullmatch(operator)
    name = match.group(1) if match else operator
    if name == LOAD or _LOADS.search(details):
        yield "reads a file or an address (LOAD CSV)"
    elif name == CALL:
        procedure = details.partition("(")[0]
        if procedure not in PROCEDURES:
            yield f"calls {shown(procedure)}, which is not known to only read"
    elif name not in STEPS:
        yield f"has the step {shown(name)}, which is not known to only read"
    if _CALLS.search(details):
        yield "calls a procedure inside an expression; call it in a clause of its own"


def refuse_unknown_names(transaction: Transaction, summary: ResultSummary, known_names: KnownNames) -> None:
    """Let a query pass that names only what there can be.

    Parameters
    ----------
    summary
        Of the query's ``EXPLAIN``.
    known_names
        What the graph can have, whether the database has it or not.
    """
    problems = []
    for kind, name in sorted(set(_unknown(summary))):
        if name in known_names[kind]:
            continue
        there = set(known_names[kind]) | {str(record[0]) for record in transaction.run(_LISTED[kind])}
        hint = did_you_mean(nearest(name, sorted(there), FEW), "see them with rosprivacy query --schema")
        problems.append(f"nothing has the {kind} {shown(name)!r}; {hint}")
    if problems:
        raise QueryError("\n".join(problems))


def _unknown(summary: ResultSummary) -> Iterator[tuple[str, str]]:
    """(kind, name), as the server says it; in its own sentence where the name cannot be told."""
    for status in summary.gql_status_objects:
        said = status.status_description
        if kind := _UNKNOWN.get(status.gql_status):
            named = _MISSING_NAME.search(said)
            yield kind, named.group(1) if named else said
        elif earlier := _EARLIER.search(said):
            yield earlier.group(1), earlier.group(2)


LIMIT = 1000
LISTED = 30  # names of a hint, where none is near
FETCHED = 100  # rows at once; the server keeps them in memory until they are read
TIMEOUT = 60.0  # seconds
LARGEST = 100 * 2**20  # of all rows, as `_size` counts; what is held here while it is turned into text
LONGEST_REASON = 400
GRACE = 10.0  # seconds beyond that bound: the server keeps it while it runs a query, not while it plans one
WAY = "path"  # the column of the pack that names elements in the order of the flow


@dataclass(frozen=True, slots=True)
class QueryRows:
    """What a query gives.

    Attributes
    ----------
    columns
        Their names.
    rows
        Values as JSON has them, and nodes, relationships and paths as ``graph_values`` has them.
    truncated
        Whether there were more than the bound.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    truncated: bool = False


def run(
    driver: Driver,
    text: str,
    values: Mapping[str, Any] | None = None,
    *,
    limit: int | None = LIMIT,
    timeout: float | None = TIMEOUT,
    known_names: KnownNames | None = None,
) -> QueryRows:
    """Run Cypher that only reads.

    Parameters
    ----------
    limit
        Most rows to return; None for all.
    timeout
        Seconds that the server may take; None for as long as it takes. What it has not even planned ``GRACE`` later is
        waited for no more.
    known_names
        Names that the graph can have: one that is neither among these nor in the database is refused; None lets all
        names pass.

    Raises
    ------
    QueryError
        If it does more than read the graph, or the server refuses it: it is not Cypher, lacks a parameter, or takes
        too long or too much memory; also if its rows are too large.
    DatabaseError
        If the server cannot answer for a reason of its own.
    """
    refuse_too_much(text)
    answer = partial(_answer, driver, text, dict(values or {}), limit, timeout, known_names)
    with _refusals(driver, timeout):
        return answer() if timeout is None else _in_time(answer, timeout + GRACE)


def _in_time(answer: Callable[[], QueryRows], seconds: float) -> QueryRows:
    """Wait for an answer so long: what then still waits for the server ends when the driver is closed."""
    answers: SimpleQueue[QueryRows | BaseException] = SimpleQueue()

    def work() -> None:
        try:
            answers.put(answer())
        except BaseException as error:  # noqa: BLE001 - it is raised by whoever waits
            answers.put(error)

    Thread(target=work, daemon=True).start()
    try:
        answered = answers.get(timeout=seconds)
    except Empty:
        what = f"the server has not answered within {seconds:g} s: it may still be planning the query"
        raise QueryError(f"{what}; ask for less") from None
    if isinstance(answered, BaseException):
        raise answered
    return answered


def _answer(
    driver: Driver,
    text: str,
    values: dict[str, Any],
    limit: int | None,
    timeout: float | None,
    known_names: KnownNames | None,
) -> QueryRows:
    import neo4j  # noqa: PLC0415 - light start

    with (
        driver.session(
            default_access_mode=neo4j.READ_ACCESS,
            fetch_size=FETCHED,
            notifications_min_severity="WARNING" if known_names is not None else "OFF",
        ) as session,
        session.begin_transaction(timeout=timeout) as transaction,
    ):
        planned = refuse_unless_reading(transaction, text, values)
        if known_names is not None:
            refuse_unknown_names(transaction, planned, known_names)
        result = transaction.run(text, values)
        columns = tuple(result.keys())
        rows: list[tuple[Any, ...]] = []
        held = 0
        for record in result:
            if limit is not None and len(rows) == limit:
                return QueryRows(columns, _with_ends(transaction, rows), truncated=True)
            row = tuple(value_of(value) for value in record.values())
            held += _size([plain(value) for value in row])
            if held > LARGEST:
                raise QueryError(f"the rows take more than {LARGEST // 2**20} MB; ask for less")
            rows.append(row)
        return QueryRows(columns, _with_ends(transaction, rows))


def _with_ends(transaction: Transaction, rows: list[tuple[Any, ...]]) -> tuple[tuple[Any, ...], ...]:
    """Look up the ends of relationships that stand without them: the server names these by their ids only."""
    bare = {node.id for value in graph_values(rows) for node in nodes_in(value) if node.bare}
    if not bare:
        return tuple(rows)
    found = transaction.run("MATCH (n) WHERE elementId(n) IN $ids RETURN n", ids=sorted(bare))
    known = {node.id: node for node in (value_of(record["n"]) for record in found)}
    return tuple(with_known(row, known) for row in rows)


def check_names(driver: Driver, query: Query, values: Mapping[str, Any]) -> None:
    """See that the names that a question is asked about are in the database.

    Raises
    ------
    QueryError
        For each that is not, with the nearest that are: a mistyped name must not look like an answer (rule S11).
    """
    problems = []
    for field in query.parameters:
        asked = values[field.name]
        if field.type not in NAMES or asked == field.default:
            continue
        where, name = NAMES[field.type]
        if not run(driver, f"MATCH {where} WHERE {name} = $name RETURN 1 LIMIT 1", {"name": asked}).rows:
            rows = run(driver, f"MATCH {where} RETURN DISTINCT {name}", limit=None).rows
            names = sorted(str(name) for (name,) in rows)
            every = f"it is one of {', '.join(map(shown, names))}" if names else "load a robot first"
            others = every if len(names) <= LISTED else f"{len(names):,} others are there"
            hint = did_you_mean(nearest(asked, names, FEW, A_LITTLE), others)
            problems.append(f"{query.name}: no {field.type} {shown(asked)!r} is in the database; {hint}")
    if problems:
        raise QueryError("\n".join(problems))


def as_cell(value: Any, column: str = WAY, words: Callable[[GraphValue], str] = str) -> str:
    """Return a value as a reader of a table sees it.

    Parameters
    ----------
    column
        Its name: the names on a way stand in the order of the flow, other lists have no direction.
    words
        How a node, a relationship or a path is told.

    >>> as_cell(["/camera", "/video"], "path"), as_cell(["r1", "r2"], "robots"), as_cell(None), as_cell(True)
    ('/camera -> /video', 'r1, r2', '', 'true')
    """
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, GraphValue):
        return words(value)
    if isinstance(value, list) and value and all(isinstance(item, GraphValue) for item in value):
        return ", ".join(map(words, value))
    if isinstance(value, list) and all(isinstance(item, str) for item in value):
        return (" -> " if column == WAY else ", ").join(value)
    return json.dumps(plain(value), ensure_ascii=False, sort_keys=True)


def _size(value: Any) -> int:
    """Return about how many bytes a plain value takes as text."""
    if isinstance(value, str):
        return len(value)
    if isinstance(value, dict):
        return sum(len(key) + _size(item) for key, item in value.items())
    return sum(map(_size, value)) if isinstance(value, list | tuple) else 8


@contextmanager
def _refusals(driver: Driver, timeout: float | None) -> Iterator[None]:
    """What the server refuses, as one line; that it is lost is said by whoever opened the driver."""
    from neo4j.exceptions import (  # noqa: PLC0415 - light start
        ClientError,
        DatabaseError,
        DriverError,
        Neo4jError,
        ServiceUnavailable,
        SessionExpired,
    )

    try:
        yield
    except (ServiceUnavailable, SessionExpired):
        # A server that has no memory left for a value breaks the connection, and goes on.
        with suppress(DriverError, Neo4jError):
            driver.verify_connectivity()
            what = "the server broke off, and runs: the query or its answer is too much for it"
            raise QueryError(f"{what}; ask for less") from None
        raise
    except RecursionError:
        raise QueryError("the rows hold lists in lists that are too deep to be read; ask for less") from None
    except Neo4jError as error:
        code, what = error.code or "", shown(" ".join((error.message or str(error)).split())[:LONGEST_REASON])
        if code.endswith("Statement.AccessMode"):
            raise QueryError(
                "the query would write; queries only read: write with cypher-shell or the driver"
            ) from None
        if ".TransactionTimedOut" in code:
            hint = "ask for less, or give it longer with rosprivacy query --timeout"
            raise QueryError(f"the query took longer than {timeout:g} s; {hint}") from None
        if isinstance(error, ClientError | DatabaseError):
            raise QueryError(f"the server refuses the query: {what}; correct it") from None
        if "OutOfMemory" in code:
            raise QueryError(f"the query needs more memory than the server gives: {what}; ask for less") from None
        raise OurDatabaseError(f"the server cannot answer now: {what}; try again") from None
    except (OverflowError, UnicodeError) as error:  # before anything is sent
        raise QueryError(f"the query or a value cannot be sent: {shown(str(error))}; correct it") from None
