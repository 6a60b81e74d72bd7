"""Where data ends, and what lies behind: also where one line closes several elements in a row (rules S5, S7, S13)."""

from __future__ import annotations

from dataclasses import replace

from rosprivacy.analysis.example import ARCHIVE, FACES, factory
from rosprivacy.analysis.findings.closures import PERHAPS, ROUNDS, behind, closed_by_shipped, closures, in_its_place
from rosprivacy.analysis.kernel.backward import Opened
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.model import STANDARD, Element, Method, Place, Statement
from tests.helpers.systems import System, statement

SOURCE, LEAK = statement("source", "Face"), statement("leak", "Face")
DROPS = statement("sanitizer", "Face", method=Method.DROP)


def test_a_line_that_closes_two_elements_in_a_row_is_opened_as_a_whole() -> None:
    """/n0 -> /n2 -> /n3 -> /n1: to open one of the two leads nowhere."""
    edges = [(0, 4), (2, 5), (3, 6), (4, 2), (5, 3), (6, 1)]
    for of_last, found in ((DROPS, {0: 1}), (DROPS._replace(place=Place("labels", 2)), {})):
        said = {0: [SOURCE], 1: [LEAK], 2: [DROPS], 3: [of_last]}
        carried = System(4, 3, edges, said, {}).analyse().spread
        closed = closures(carried)
        assert [(closure.vertex, closure.lines) for closure in closed] == [(2, (DROPS,))]
        assert behind(carried, closed, carried.leaks) == found


def test_of_many_such_lines_the_first_are_opened_and_of_others_it_is_said_that_they_may() -> None:
    """/n0 -> two nodes in a row, of each line -> /n1; the lines in the order of files, whatever that of the graph."""
    many = ROUNDS + 3
    said, edges, channels = {0: [SOURCE], 1: [LEAK]}, [], 2 + 2 * many
    for number in range(many):
        line = DROPS._replace(place=Place("labels", many - number))
        first, second = 2 + 2 * number, 3 + 2 * number
        said |= {first: [line], second: [line]}
        edges += [(0, channels), (channels, first), (first, channels + 1 + first), (channels + 1 + first, second)]
        edges += [(second, channels + 1 + second), (channels + 1 + second, 1)]
    carried = System(channels, 2 * many + 3, sorted(set(edges)), said, {}).analyse().spread
    closed = closures(carried)
    by_closure = ((number, line) for number, closure in enumerate(closed) for line in closure.lines)
    lines = {line.place.line: number for number, line in by_closure if isinstance(line, Statement)}
    places = behind(carried, closed, carried.leaks)
    assert [places[lines[number]] for number in sorted(lines)] == [1] * ROUNDS + [PERHAPS] * 3


def test_what_a_flow_does_not_carry_answers_for_no_element() -> None:
    """/n1 -> /n0, where the flow to the first element of the graph never carries it."""
    system = System(2, 1, [(1, 2), (2, 0)], {1: [SOURCE]}, {1: {"Face"}})
    (closure,) = closures(system.analyse().spread)
    assert (closure.vertex, closure.to, closure.itself) == (2, 0, False)


def test_behind_what_a_shipped_file_closes_may_be_another_part_of_a_graph() -> None:
    """There it is not known which element; and the lines stand in their order."""
    graph, bound, hierarchy = factory()
    lines = tuple(
        Statement("mundane", (), (STANDARD, 0), Place("rosprivacy:standard", number), shipped=True)
        for number in (12, 3, 7, 31, 1, 20)
    )
    carried = spread(graph, replace(bound, elements={**bound.elements, FACES: lines}), hierarchy)
    for beyond, end in (((), graph.elements[ARCHIVE]), ((ARCHIVE,), None)):
        (row,) = closed_by_shipped(carried, carried.all_bits, beyond)
        assert row.end == end
        assert list(row.places) == sorted(line.place for line in lines)


def test_parameter_events_are_in_their_place_below_the_namespace_of_any_node() -> None:
    assert in_its_place(Element("topic", "/map/parameter_events"), ["/map/server", "/camera"])


def test_what_a_deny_takes_back_counts_as_what_a_label_closes() -> None:
    assert Opened({0: 1}, {3: 1}, ((1, 2), (3, 4))).size == 4
