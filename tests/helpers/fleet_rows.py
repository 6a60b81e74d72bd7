"""The rows of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.answering import answer
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet

if TYPE_CHECKING:
    from rosprivacy.ingest.database.fleet_rows import FleetRows

VOCABULARY = load_vocabulary()


def rows(file: str) -> FleetRows:
    question = question_of(Settings())._replace(every=True)
    system = fleet_system(file, question)
    return rows_of_fleet(system, question, answer(system, question))
