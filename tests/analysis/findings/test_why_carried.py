"""Why an element carries a kind: the path against brute force, on random graphs with cycles and both planes."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.example import ARCHIVE, CAMERA, ROSOUT, factory
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.witness import WhyCarried, why_carried
from tests.helpers.more_systems import wildcards
from tests.helpers.systems import analysed, systems

if TYPE_CHECKING:
    from tests.helpers.systems import System


@given(st.one_of(systems(), wildcards()))
def test_there_is_a_path_where_brute_force_gets_and_it_is_the_shortest(system: System) -> None:
    """Rules S10, S11: of all that any source sends, in either form."""
    analysis = analysed(system)
    if analysis is None:
        return
    brute, why = system.brute(), WhyCarried(analysis)
    expected: dict[tuple[tuple[str, ...], str], int] = {}
    elements = analysis.graph.elements
    for (vertex, (category, _)), level in brute.spread(brute.sources()).items():
        key = elements[vertex].shown_as, category
        expected[key] = min(level, expected.get(key, level))
    found = {
        (element.shown_as, category): len(path.steps)
        for element in elements
        for category in analysis.spread.categories
        if (path := why.path(element, category))
    }
    assert found == expected


@given(st.one_of(systems(), wildcards()))
def test_each_step_is_a_flow_that_carries_what_the_step_says(system: System) -> None:
    analysis = analysed(system)
    if analysis is None:
        return
    brute, why, elements = system.brute(), WhyCarried(analysis), analysis.graph.elements
    sources = {elements[vertex] for vertex in brute.sources()}
    brute.spread(brute.sources())
    along = {(elements[a].shown_as, elements[b].shown_as, data) for a, b, data in brute.along}
    for element in elements:
        for category in analysis.spread.categories:
            path = why.path(element, category)
            if path is None:
                continue
            assert path.elements[0] in sources
            assert path.elements[-1].shown_as == element.shown_as
            assert [(s.source, s.target) for s in path.steps] == list(pairwise(path.elements))
            for step in path.steps:
                data = step.category, step.pseudonymised
                assert (step.source.shown_as, step.target.shown_as, data) in along


def test_a_path_to_the_source_itself_has_no_step() -> None:
    analysis = analyse(*factory())
    path = why_carried(analysis, analysis.graph.elements[CAMERA], "Video")
    assert path is not None
    assert (len(path.elements), path.steps) == (1, ())


def test_what_does_not_get_there_has_no_path() -> None:
    analysis = analyse(*factory())
    elements = analysis.graph.elements
    assert why_carried(analysis, elements[ROSOUT], "Video") is None
    assert why_carried(analysis, elements[ARCHIVE], "Biometric") is None  # nothing emits it under this name
    assert why_carried(analysis, elements[ARCHIVE], "FaceTemplate") is not None
