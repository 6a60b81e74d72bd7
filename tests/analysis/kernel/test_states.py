"""The relation of states, walked plainly, against the fast forms: fixpoint, search, backward and nearest (S8, S10)."""

from __future__ import annotations

from collections import defaultdict, deque
from typing import TYPE_CHECKING

from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.findings.closures import Nearest
from rosprivacy.analysis.findings.findings import Options
from rosprivacy.analysis.kernel.backward import backward
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.search import search
from rosprivacy.analysis.kernel.states import Net, States, derived_bits
from tests.helpers.systems import System, analysed, statement, systems

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.kernel.states import Move

State = tuple[int, int]  # vertex, bit


def walked(states: States, moves: Iterable[Move]) -> dict[State, int]:
    """Where data arrives, and after how many flows: one state after the other."""
    levels: dict[State, int] = {}
    waiting: deque[tuple[State, int]] = deque()

    def arrive(moves: Iterable[Move], level: int) -> None:
        for _, vertex, bits in moves:
            for bit in bits_of(bits):
                if (vertex, bit) not in levels:
                    levels[vertex, bit] = level
                    waiting.append(((vertex, bit), level))

    arrive(moves, 1)
    while waiting:
        (vertex, bit), level = waiting.popleft()
        arrive(states.after(vertex, states.leaving(vertex, 1 << bit)), level + 1)
    return levels


def begun(states: States, vertex: int) -> list[Move]:
    return [*states.after(vertex, states.emitted(vertex)), *states.single(vertex)]


def by_vertex(levels: Iterable[State]) -> dict[int, int]:
    bits: dict[int, int] = defaultdict(int)
    for vertex, bit in levels:
        bits[vertex] |= 1 << bit
    return dict(bits)


@given(systems())
def test_the_fixpoint_is_what_is_walked_to(system: System) -> None:
    if (analysis := analysed(system)) is None:
        return
    found = analysis.spread
    states = States(Net.of(found), found.all_bits, {})
    arrives = by_vertex(walked(states, [move for v in found.facts for move in begun(states, v)]))
    for vertex, element in enumerate(found.graph.elements):
        here = arrives.get(vertex, 0)
        assert element.is_channel or here == found.arrives.get(vertex, 0)  # to a channel comes what it does not take up
        assert states.leaving(vertex, here) | found.begins(vertex) == found.leaves.get(vertex, 0)


@given(systems(), st.data())
def test_a_search_gets_as_far_in_as_many_flows(system: System, data: st.DataObject) -> None:
    analysis = analysed(system)
    if analysis is None or not analysis.spread.facts:
        return
    found = analysis.spread
    net, source = Net.of(found), data.draw(st.sampled_from(sorted(found.facts)))
    ending = found.forms_of(data.draw(st.sampled_from(found.categories))) if found.categories else 0
    allowed = data.draw(st.sampled_from([found.all_bits, ending]))
    stop = {v: bits & ending for v, bits in found.leaks.items()}
    states = States(net, allowed, stop)
    levels = walked(states, begun(states, source))
    fast = search(net, [source], allowed, stop)
    assert {v: bits for v, bits in fast.arrived_bits.items() if bits} == by_vertex(levels)
    arrived = {(v, b): level for v, rows in fast.arrived.items() for level, new, _ in rows for b in bits_of(new)}
    assert arrived == levels


@settings(max_examples=settings().max_examples // 2)
@given(systems(), st.data())
def test_backward_and_nearest_tell_what_is_walked_to(system: System, data: st.DataObject) -> None:
    analysis = analysed(system)
    if analysis is None or not analysis.spread.categories:
        return
    found = analysis.spread
    one = st.sampled_from([found.forms_of(name) for name in found.categories])
    places = data.draw(st.dictionaries(st.integers(0, len(found.graph.elements) - 1), one, min_size=1, max_size=2))
    states = States(Net.of(found), found.all_bits, {})
    back, near = backward(found, places), Nearest.of(found, places)
    for vertex, bit in walked(states, [move for v in found.facts for move in begun(states, v)]):
        levels = walked(states, states.after(vertex, states.leaving(vertex, 1 << bit))) | {(vertex, bit): 0}
        reached = {
            v: level
            for (v, b), level in sorted(levels.items(), key=lambda item: -item[1])  # of one vertex the least is left
            if places.get(v, 0) & (1 << b | derived_bits(found, v, 1 << b))
        }
        assert back.entering.get(vertex, 0) >> bit & 1 == bool(reached)
        least = min(reached.values(), default=-1)
        assert near.at(vertex, 1 << bit) in {v for v, level in reached.items() if level == least} or not reached
        assert (near.at(vertex, 1 << bit) < 0) == (not reached)


def test_what_is_made_at_a_leak_of_it_ends_there() -> None:
    """Node 1 makes Face and leaks it: no path of another leak goes through it (rule S10), so one is left, by node 2."""
    edges = [(0, 4), (4, 1), (0, 7), (7, 2), (1, 5), (2, 5), (5, 3), (2, 6), (6, 3)]
    makes = statement("derivation", "Loc", to="Face")
    leaks = statement("leak", "Face")
    said = {0: [statement("source", "Loc")], 1: [makes, leaks], 2: [makes], 3: [leaks]}
    analysis = System(4, 4, sorted(edges), said, {}).analyse(Options(paths="all"))
    (finding,) = [one for one in analysis.findings if one.leak.name == "/n3"]
    assert (finding.dismissed, finding.disjoint_paths) == (False, 1)
    assert {path[2].name for path in finding.paths} == {"/n2"}
