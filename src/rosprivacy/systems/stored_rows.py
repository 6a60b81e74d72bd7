"""Questions to what is in a database: a driver and Cypher in, out come rows, and what a reader has to know of them.

The command line and the explorer's page ask the same way: names that nothing has are refused with the nearest ones,
and robots that another version loaded are told (rule S11).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.ingest.neo4j_graph.ids import LABELS_OF_CATEGORIES, schema_names
from rosprivacy.ingest.neo4j_graph.robot_facts import HINT, ROBOTS, of_other_schemas
from rosprivacy.ingest.neo4j_graph.schema import CARRIES, FLOWS_TO, KIND_LABELS
from rosprivacy.ontology.vocabulary import load
from rosprivacy.queries.run import check_names, run
from rosprivacy.report.stored import StoredNames

if TYPE_CHECKING:
    from collections.abc import Mapping

    from neo4j import Driver

    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.queries.library import Query
    from rosprivacy.queries.run import QueryRows

STORED_NAMES = StoredNames({label: kind for kind, label in KIND_LABELS.items()}, FLOWS_TO.type, CARRIES)


class StoredRows(NamedTuple):
    """What a question gives.

    Attributes
    ----------
    warning
        That robots were loaded by another version, so that rows can be missing; empty if none was.
    """

    rows: QueryRows
    warning: str


def rows_of(
    driver: Driver, text: str, values: Mapping[str, Any], *,
    limit: int | None, timeout: float | None, query: Query | None = None, vocabulary: Vocabulary | None = None,
) -> StoredRows:  # fmt: skip
    """Ask Cypher that only reads.

    Parameters
    ----------
    limit, timeout
        As of ``run``.
    query
        The question of the pack that the Cypher is; None for Cypher of somebody's own.
    vocabulary
        Of the kinds of data that there can be; None for the shipped one.

    Raises
    ------
    QueryError
        If it does more than read, or names what nothing has; what else ``run`` refuses.
    DatabaseError
        If the server cannot answer for a reason of its own.
    """
    if query:
        check_names(driver, query, values)
    known = known_names(driver, vocabulary or load())
    rows = run(driver, text, values, limit=limit, timeout=timeout, known_names=known)
    robots = run(driver, ROBOTS, limit=None, timeout=timeout)
    others = of_other_schemas(dict(zip(robots.columns, row, strict=True)) for row in robots.rows)
    return StoredRows(rows, f"{others}, so rows can be missing or differ; {HINT}" if others else "")


def known_names(driver: Driver, vocabulary: Vocabulary) -> dict[str, frozenset[str]]:
    """Return the names that a query can ask for: those of the schema, and of all kinds of data, loaded or not."""
    stored = {str(label) for (label,) in run(driver, LABELS_OF_CATEGORIES, limit=None).rows}
    return schema_names(stored | {category.label for category in vocabulary.categories.values()})
