"""Searches that are kept from answer to answer: each is the one that would be made anew, and no other is taken."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

from hypothesis import assume, given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.example import CAMERA, FACES, FILTER, ROSOUT, factory
from rosprivacy.analysis.kernel.search import ROOM, Search, Searches, search, searches
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.kernel.states import Net
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.systems import PARENTS, System, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.kernel.spread import Spread

AT_NODES, AT_CHANNELS = ("conduit", "leak", "source"), ("sensitive", "never")


@given(st.one_of(systems(), wildcards(), ranked()), st.data())
def test_a_kept_search_is_the_one_that_would_be_made(system: System, data: st.DataObject) -> None:
    graph, hierarchy = system.graph(), system.hierarchy
    vertex = data.draw(st.integers(0, system.nodes + system.channels - 1))
    role = data.draw(st.sampled_from(AT_NODES if vertex < system.nodes else AT_CHANNELS))
    kind = data.draw(st.sampled_from(tuple(PARENTS)))
    edited = replace(system, said={**system.said, vertex: [statement(role, kind)]})
    try:
        before = spread(graph, system.bound(), hierarchy)
        _made(before)
        now = spread(graph, edited.bound(), hierarchy, before)
    except InputErrors:
        assume(False)
    net = Net.of(now)
    for key, kept in _kept(now).items():
        source, allowed, stopping = key
        stop = {v: bits & allowed for v, bits in now.leaks.items() if bits & allowed} if stopping else {}
        assert _told(kept) == _told(search(net, [source], allowed, stop))


def test_a_search_is_made_again_only_where_it_met_what_is_otherwise() -> None:
    graph, bound, hierarchy = factory()
    bound = replace(bound, elements={**bound.elements, FILTER: (statement("source", "Video"),)})
    before = spread(graph, bound, hierarchy)
    made = _made(before)
    assert FACES in made[CAMERA].arrived_bits
    assert FACES not in made[FILTER].arrived_bits
    edited = replace(bound, elements={**bound.elements, FACES: (statement("mundane"),)})
    after = _made(spread(graph, edited, hierarchy, before))
    assert after[FILTER] is made[FILTER]
    assert after[CAMERA] is not made[CAMERA]


def test_where_a_channel_takes_up_more_its_writers_are_searched_anew() -> None:
    graph, bound, hierarchy = factory()
    before = spread(graph, bound, hierarchy)
    made = _made(before)
    assert ROSOUT not in made[CAMERA].arrived_bits  # it is taken as mundane, and so nothing gets there
    edited = replace(bound, elements={**bound.elements, ROSOUT: (statement("sensitive"),)})
    assert ROSOUT in _made(spread(graph, edited, hierarchy, before))[CAMERA].arrived_bits


def test_of_another_graph_none_is_kept() -> None:
    graph, bound, hierarchy = factory()
    before = spread(graph, bound, hierarchy)
    assert _made(before)
    assert not _kept(spread(replace(graph, view="enforced"), bound, hierarchy, before))


def test_no_more_are_kept_than_there_is_room_for() -> None:
    made = spread(*factory())
    net, some = Net.of(made), Searches(room=3)
    assert some.of(net, CAMERA, made.all_bits, {}, None) is not some.of(net, CAMERA, made.all_bits, {}, None)
    some = Searches(room=ROOM)
    assert some.of(net, CAMERA, made.all_bits, {}, None) is some.of(net, CAMERA, made.all_bits, {}, None)


def _made(found: Spread) -> dict[int, Search]:
    """Search from each source, past every leak and up to the leaks."""
    net, some = Net.of(found), searches(found, ROOM)
    stop = {vertex: bits for vertex, bits in found.leaks.items() if bits}
    sources = [vertex for vertex in found.facts if found.begins(vertex)]
    for source in sources:
        some.of(net, source, found.all_bits, stop, "leaks")
    return {source: some.of(net, source, found.all_bits, {}, None) for source in sources}


def _kept(found: Spread) -> dict[Any, Search]:
    return searches(found)._earlier


def _told(reach: Search) -> dict[str, Any]:
    """All of a search, in order."""
    parts = {field.name: getattr(reach, field.name) for field in fields(reach)}
    return {name: sorted(part) if isinstance(part, set) else list(part.items()) for name, part in parts.items()}
