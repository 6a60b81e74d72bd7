"""The rows of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.answering import answer
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet

if TYPE_CHECKING:
    from rosprivacy.ingest.neo4j_graph.fleet_rows import FleetRows
    from rosprivacy.result import Result

VOCABULARY = load_vocabulary()


def rows(file: str) -> FleetRows:
    return rows_and_answer(file)[0]


def rows_and_answer(file: str) -> tuple[FleetRows, Result]:
    """The rows, and the answer that they are made of, with all its findings."""
    question = question_of(Settings())._replace(every=True)
    system = fleet_system(file, question)
    result = answer(system, question)
    return rows_of_fleet(system, question, result), result
