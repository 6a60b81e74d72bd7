"""A query that names what nothing has is refused, with the nearest name: a mistyped label is no answer (rule S11).

In: the server's notifications about a query that it has planned, and the names that the graph can have. Out: nothing,
or one line for each name that is neither in the database nor among these. Neo4j itself answers such a query with no
rows.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from difflib import get_close_matches
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import QueryError, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from neo4j import ResultSummary, Transaction

Known = Mapping[str, Collection[str]]  # by "label", "relationship type", "property"
_NAMED = re.compile(r"\(the missing [a-z ]+ is: (.+)\)\s*$", re.DOTALL)
_KINDS = {
    "UnknownLabelWarning": ("label", "CALL db.labels()"),
    "UnknownRelationshipTypeWarning": ("relationship type", "CALL db.relationshipTypes()"),
    "UnknownPropertyKeyWarning": ("property", "CALL db.propertyKeys()"),
}


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
    for kind, listing, name in sorted(set(_unknown(summary))):
        if name in known[kind]:
            continue
        there = set(known[kind]) | {str(record[0]) for record in transaction.run(listing)}
        close = get_close_matches(name, sorted(there), n=3)
        hint = f"did you mean {' or '.join(map(shown, close))}?" if close else "see them with rosprivacy query --schema"
        problems.append(f"nothing has the {kind} {shown(name)!r}; {hint}")
    if problems:
        raise QueryError("\n".join(problems))


def _unknown(summary: ResultSummary) -> Iterator[tuple[str, str, str]]:
    """(kind, query that lists what there is, name)."""
    for notification in summary.notifications or ():
        code = str(notification.get("code", "")).rpartition(".")[2]
        named = _NAMED.search(str(notification.get("description", "")))
        if code in _KINDS:
            yield (*_KINDS[code], named.group(1) if named else str(notification.get("description")))
