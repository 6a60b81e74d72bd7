"""Random systems in which labels say of some nodes whose data they bring in."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from hypothesis import strategies as st

from rosprivacy.ontology.vocabulary import load
from tests.helpers.systems import systems

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.model import Bound
    from tests.helpers.systems import System

VOCABULARY = load()
KINDS = ("PersonalData", "Biometric", "FaceTemplate", "Video", "Voice")


class Case(NamedTuple):
    system: System
    persons: Mapping[int, tuple[str, ...]]  # of nodes, as labels state them

    def bound(self) -> Bound:
        return replace(self.system.bound(), subjects=self.persons)


@st.composite
def cases(draw: st.DrawFn) -> Case:
    system = replace(draw(systems(KINDS)), hierarchy=VOCABULARY.hierarchy)
    named = draw(st.sets(st.integers(0, system.nodes - 1)))
    return Case(system, {vertex: (f"group-{vertex}",) for vertex in named})
