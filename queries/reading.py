"""What a query would do, by the server's own plan of it (``EXPLAIN``, which runs nothing), before it is run.

In: an open transaction and the Cypher that is to run in it. Out: nothing, or why it is refused. What a server's parser
would not survive is refused by its text, before the server gets it. The access mode of the session stops what writes to
the graph. It does not stop ``LOAD CSV``, procedures, and what acts on the server; the plan shows these, whatever the
text looks like. Only what is known to read the graph passes: a step that a newer server brings is refused until it
stands here. So is a name that nothing has: Neo4j itself answers such a query with no rows (rule S11).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import ResultSummary, Transaction

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
