"""What is in a database, with what people added to it there -> ``System``, and the answer back into it; or rows.

In: a driver, and Cypher. Out: a ``Result``; the answer about all categories is written back. Or rows, and what a reader
has to know of them: the command line and the explorer's page ask the same way, names that nothing has are refused with
the nearest ones, and robots that another version loaded are told (rule S11).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.analysis.text import counted
from rosprivacy.answering import answer
from rosprivacy.assumptions import put_together
from rosprivacy.ingest.neo4j_graph.fleet_rows import MOST_ACROSS
from rosprivacy.ingest.neo4j_graph.ids import LABELS_OF_CATEGORIES, schema_names
from rosprivacy.ingest.neo4j_graph.read_back import Stored, read_stored
from rosprivacy.ingest.neo4j_graph.robot_facts import HINT, ROBOTS, diagnostics_of, of_other_schemas
from rosprivacy.ingest.neo4j_graph.schema import CARRIES, DATABASE, FLOWS_TO, KIND_LABELS
from rosprivacy.ingest.neo4j_graph.write_back import write_back
from rosprivacy.ontology.vocabulary import load
from rosprivacy.queries.run import check_names, run
from rosprivacy.question import question_of
from rosprivacy.report.stored import StoredNames
from rosprivacy.robot_doubts import breaking, doubt_lines, doubts_by_robot
from rosprivacy.system import System

if TYPE_CHECKING:
    from collections.abc import Mapping

    from neo4j import Driver

    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.queries.library import Query
    from rosprivacy.queries.run import QueryRows
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

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


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredSystem(System):
    """A system with the database's own keys."""

    stored: Stored


def stored_system(driver: Driver, vocabulary: Vocabulary) -> StoredSystem:
    """Read everything that is in a database."""
    stored = read_stored(driver, vocabulary)
    said, rests_on = put_together(stored.robots.values())
    said += _left_out(stored.robots)
    return StoredSystem(
        stored.graph, stored.bound, vocabulary, said, rests_on,
        likeness=stored.likeness, is_fleet=len(stored.robots) > 1, stored=stored,
    )  # fmt: skip


def _left_out(robots: Mapping[str, Mapping[str, Any]]) -> tuple[Diagnostic, ...]:
    """That standard channels are not there, and in no count, because ``load`` was told to leave them out."""
    robots_without = sum(bool(robot.get("without_standard")) for robot in robots.values())
    if not robots_without:
        return ()
    what = "channels that only the standard file speaks of are not in the database: no count has them, "
    what += f"nor what the answer hangs on; --without-standard was said of {counted(robots_without, 'robot')}"
    return (Diagnostic(Place(DATABASE, 0), Severity.NOTICE, what),)


def answer_unwritten(driver: Driver, settings: Settings) -> Result:
    """Analyse what is in the database, and write nothing back; raises as ``answer_stored``."""
    question = question_of(settings)._replace(every=True)
    return answer(stored_system(driver, question.vocabulary), question)


def answer_stored(driver: Driver, settings: Settings) -> Result:
    """Analyse what is in the database, and write the answer about all categories back."""
    question = question_of(settings)._replace(every=True, most_across=MOST_ACROSS)
    system = stored_system(driver, question.vocabulary)
    everything = question._replace(categories_asked=None, decisions=None)
    result = answer(system, everything)
    stored = system.stored
    names = {element: stored.robot_of(vertex) for vertex, element in enumerate(stored.graph.elements)}
    files_of = {name: diagnostics_of(robot) for name, robot in stored.robots.items()}
    told = doubts_by_robot(result.doubts, files_of, stored.graph, stored.likeness, names.__getitem__)
    lines = {name: doubt_lines(doubts) for name, doubts in told.items()}
    write_back(driver, stored, result.analysis, question.vocabulary, lines, breaking(told))
    return result if question == everything else answer(system, question)
