"""A query that names what nothing has is refused, with the nearest name: a mistyped label is no answer (rule S11).

In: the server's notifications about a query that it has planned, and the names that the graph can have. Out: nothing,
or one line for each name that is neither in the database nor among these. Neo4j itself answers such a query with no
rows.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import ResultSummary, Transaction

Known = Mapping[str, Collection[str]]  # by "label", "relationship type", "property"
_LISTED = {
    "label": "CALL db.labels()",
    "relationship type": "CALL db.relationshipTypes()",
    "property": "CALL db.propertyKeys()",
}
_UNKNOWN = {"01N50": "label", "01N51": "relationship type", "01N52": "property"}  # statuses of GQL
_NAMED = re.compile(r"`(.+)` does not exist", re.DOTALL)
_EARLIER = re.compile(
    r"\(the missing (label|relationship type|property)(?: name)? is: (.+)\)", re.DOTALL
)  # before 5.23


def refuse_unknown_names(transaction: Transaction, summary: ResultSummary, known: Known) -> None:
    """Let a query pass that names only what there can be.

    Parameters
    ----------
    summary
        Of the query's ``EXPLAIN``.
    known
        What the graph can have, whether the database has it or not.

    Raises
    ------
    QueryError
        With one line for each other name.
    """
    problems = []
    for kind, name in sorted(set(_unknown(summary))):
        if name in known[kind]:
            continue
        there = set(known[kind]) | {str(record[0]) for record in transaction.run(_LISTED[kind])}
        hint = did_you_mean(nearest(name, sorted(there), FEW), "see them with rosprivacy query --schema")
        problems.append(f"nothing has the {kind} {shown(name)!r}; {hint}")
    if problems:
        raise QueryError("\n".join(problems))


def _unknown(summary: ResultSummary) -> Iterator[tuple[str, str]]:
    """(kind, name), as the server says it; in its own sentence where the name cannot be told."""
    for status in summary.gql_status_objects:
        said = status.status_description
        if kind := _UNKNOWN.get(status.gql_status):
            named = _NAMED.search(said)
            yield kind, named.group(1) if named else said
        elif earlier := _EARLIER.search(said):
            yield earlier.group(1), earlier.group(2)
