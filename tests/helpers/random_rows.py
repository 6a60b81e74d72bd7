"""Random systems for the database."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import Phase, given, settings

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.kernel.spreading import meaning
from rosprivacy.analysis.model import Category
from rosprivacy.ontology.vocabulary import Vocabulary
from tests.helpers.systems import PARENTS, System, analysed, systems

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

VOCABULARY = Vocabulary.of(Category(n, f"urn:test:{n}", f"Test{n}", n, n, up) for n, up in PARENTS.items())


def random_systems(count: int, some_of: SearchStrategy[System] | None = None) -> list[System]:
    """The same each time; ``some_of`` others than those of ``systems``."""
    some: list[System] = []

    @settings(max_examples=4 * count, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(systems() if some_of is None else some_of)
    def take(system: System) -> None:
        if analysed(system) is not None and _agree(system):
            some.append(system)

    take()
    assert len(some) >= count
    return some[:count]


def _agree(system: System) -> bool:
    """Whether labels say one thing of every kind, also of those that only other robots bring in."""
    try:
        meaning(system.graph(), system.bound(), system.hierarchy, PARENTS)
    except InputErrors:
        return False
    return True
