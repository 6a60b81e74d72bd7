"""The rows of a fleet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.fleets import analysed, read_all, rows_of_fleet
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from rosprivacy.ingest.database.fleet_rows import FleetRows

VOCABULARY = load_vocabulary()


def rows(file: str) -> FleetRows:
    read = read_all(file, VOCABULARY, Settings())
    return rows_of_fleet(read, analysed(read, VOCABULARY, Settings(), every=True), Settings())
