"""What an answer takes over from the one before it: the same as if all were worked out anew, on random systems."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.findings.review_order import review_order
from rosprivacy.analysis.findings.witness import WhyCarried
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.model import Method
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.systems import PARENTS, System, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Statement

NOT_COUNTED = Options(count_paths=False)
CATEGORY = st.sampled_from(tuple(PARENTS))
AT_NODES: st.SearchStrategy[list[Statement]] = st.one_of(
    st.just([statement("conduit")]),  # by far the most common answer of a person: no data goes another way
    st.just([statement("conduit")]),
    st.just([]),
    st.builds(lambda role, kind: [statement(role, kind)], st.sampled_from(["conduit", "leak", "source"]), CATEGORY),
    st.builds(lambda kind: [statement("sanitizer", kind, method=Method.DROP)], CATEGORY),
)
AT_CHANNELS: st.SearchStrategy[list[Statement]] = st.one_of(
    st.sampled_from([[], [statement("sensitive")], [statement("sensitive")], [statement("mundane")]]),
    st.builds(lambda kind: [statement("never", kind)], CATEGORY),
)


@given(st.one_of(systems(), wildcards(), ranked()), st.data())
def test_an_answer_after_others_is_the_answer(system: System, data: st.DataObject) -> None:
    """One edit after the other, as in a session; each is also asked about anew, of a graph that nobody has seen."""
    graph, before = system.graph(), None
    for _ in range(4):
        after = _told(graph, system, before)
        anew = _told(system.graph(), system, None)
        assert (after is None) == (anew is None)  # labels that contradict each other
        if after and anew:
            assert _facts(after) == _facts(anew)
            before = after.spread
        system = _edited(system, data)


def _told(graph: Any, system: System, before: Spread | None) -> Analysis | None:
    try:
        return analyse(graph, system.bound(), system.hierarchy, NOT_COUNTED, before)
    except InputErrors:
        return None


def _edited(system: System, data: st.DataObject) -> System:
    if data.draw(st.integers(0, 5)) == 0:
        never = st.dictionaries(st.integers(0, len(system.edges) - 1), st.sets(CATEGORY, min_size=1), max_size=2)
        return replace(system, never=data.draw(never))
    vertex = data.draw(st.integers(0, system.nodes + system.channels - 1))
    said = data.draw(AT_NODES if vertex < system.nodes else AT_CHANNELS)
    if data.draw(st.booleans()):  # beside what is said there, not in its place
        said = list(dict.fromkeys([*system.said.get(vertex, ()), *said]))
    return replace(system, said={**system.said, vertex: said})


def _facts(analysis: Analysis) -> dict[str, Any]:
    """All that an analysis says, and what is found of it later."""
    told = {field.name: getattr(analysis, field.name) for field in fields(analysis) if field.name != "spread"}
    ours = analysis.spread
    names = ("decisions", "course", "shape", "memory", "graph", "_names", "_bits_of_category")
    told |= {f"spread.{f.name}": getattr(ours, f.name) for f in fields(ours) if f.name not in names}
    why = WhyCarried(analysis)
    ways = {(e, c): why.path(e, c) for e in analysis.graph.elements for c in ours.categories}
    return {**told, "order": review_order(analysis), "ways": ways}


def test_an_answer_that_moves_no_data_goes_on_with_what_was_found() -> None:
    graph, bound, hierarchy = factory()
    first = spread(graph, bound, hierarchy)
    other = replace(bound, elements={v: said for v, said in bound.elements.items() if v != ARCHIVE})
    assert spread(graph, other, hierarchy, first).course is first.course


@pytest.mark.parametrize("what", ["labels", "graph"])
def test_where_data_goes_other_ways_nothing_is_taken_over(what: str) -> None:
    graph, bound, hierarchy = factory()
    first = spread(graph, bound, hierarchy)
    if what == "graph":
        graph = replace(graph, flows=graph.flows[:5])
    else:
        bound = replace(bound, elements={v: said for v, said in bound.elements.items() if v != CAMERA})
    assert spread(graph, bound, hierarchy, first).course is not first.course
