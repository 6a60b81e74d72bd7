"""What is in a database, with what people added to it there -> ``System``, and the answer back into it.

In: a driver. Out: a ``Result``; the answer about all categories is written back.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.answering import answer
from rosprivacy.assumptions import put_together
from rosprivacy.ingest.neo4j_graph.fleet_rows import MOST_ACROSS
from rosprivacy.ingest.neo4j_graph.read_back import Stored, read_stored
from rosprivacy.ingest.neo4j_graph.robot_facts import diagnostics_of
from rosprivacy.ingest.neo4j_graph.write_back import write_back
from rosprivacy.question import question_of
from rosprivacy.robot_doubts import breaking, doubt_lines, doubts_by_robot
from rosprivacy.system import System

if TYPE_CHECKING:
    from neo4j import Driver

    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredSystem(System):
    """A system with the database's own keys."""

    stored: Stored


def stored_system(driver: Driver, vocabulary: Vocabulary) -> StoredSystem:
    """Read everything that is in a database."""
    stored = read_stored(driver, vocabulary)
    said, rests_on = put_together(stored.robots.values())
    return StoredSystem(
        stored.graph, stored.bound, vocabulary, said, rests_on,
        likeness=stored.likeness, is_fleet=len(stored.robots) > 1, stored=stored,
    )  # fmt: skip


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
