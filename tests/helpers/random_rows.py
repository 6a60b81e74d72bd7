"""Random systems for the database."""

from __future__ import annotations

from hypothesis import Phase, given, settings

from rosprivacy.analysis.model import Category
from rosprivacy.ontology.vocabulary import Vocabulary
from tests.helpers.systems import PARENTS, System, analysed, systems

VOCABULARY = Vocabulary.of(Category(n, f"urn:test:{n}", f"Test{n}", n, n, up) for n, up in PARENTS.items())


def random_systems(count: int) -> list[System]:
    """The same each time."""
    some: list[System] = []

    @settings(max_examples=3 * count, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(systems())
    def take(system: System) -> None:
        if analysed(system) is not None:
            some.append(system)

    take()
    assert len(some) >= count
    return some[:count]
