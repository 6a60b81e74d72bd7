"""Where data ends on a label's or a DENY's word, and what lies behind.

In: a ``Spread``. Out: ``Closure`` facts, and for each the nearest of some places that data would get to if what closes
it were not there. Used by the ledger.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.backward import NOTHING_OPENED, Opened, backward
from rosprivacy.analysis.kernel.nearest import Nearest
from rosprivacy.analysis.model import CANNOT, Method, Place, Statement

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.backward import Backward
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread

Line = Statement | Place
DENY, STANDARD, ABSENT, TYPE = "deny", "standard-channel", "absent", "type"
ROUNDS = 64  # lines about several elements that are opened one by one; of others it is said that they may close a path
PERHAPS = -2  # in place of a vertex, where it was not worked out


class Closure(NamedTuple):
    """Bits that get to an element or a flow and do not go on.

    Attributes
    ----------
    by
        Role of the statement, ``DENY``, ``STANDARD``, or ``TYPE`` where nothing but the type of a channel says so.
    vertex, to
        The element; or the start of a flow and its end (-1 otherwise).
    bits
        What gets there, in both planes.
    lines
        What closes it: statements, or the places of DENY lines.
    itself
        Whether nothing else answers for the element, so that it would be open.
    """

    by: str
    vertex: int
    to: int
    bits: int
    lines: tuple[Line, ...]
    itself: bool = False


def closures(spread: Spread) -> list[Closure]:
    """Return where data ends: elements, then flows, then denied flows, each in the order of the graph.

    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> [(closure.by, NAMES[closure.vertex]) for closure in closures(spread(*factory()))]
    [('sanitizer', '/filter'), ('only', '/faces'), ('standard-channel', '/rosout'), ('deny', '/video')]
    """
    return [*_elements(spread, spread.keeps), *_flows(spread), *_denied(spread)]


def standard_closures(spread: Spread) -> list[Closure]:
    """Return where data ends on the word of shipped files alone.

    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> [NAMES[closure.vertex] for closure in standard_closures(spread(*factory()))]
    ['/rosout']
    """
    return [closure for closure in _elements(spread, spread.standard) if closure.by == STANDARD]


def _elements(spread: Spread, vertices: Iterable[int]) -> Iterator[Closure]:
    alike: dict[tuple[int, int], list[tuple[int, tuple[Line, ...], bool]]] = {}  # the same is said of many elements
    for vertex in sorted(vertices):
        decided = spread.facts[vertex]
        stopped = spread.arrives.get(vertex, 0) & ~spread.keeps[vertex]
        if (id(decided), stopped) not in alike:
            alike[id(decided), stopped] = [
                (stopped & sum(map(spread.both, categories)), lines, any(_alone(decided[c]) for c in categories))
                for lines, categories in _by_lines(spread, decided, stopped).items()
            ]
        for bits, lines, itself in alike[id(decided), stopped]:
            yield Closure(_said_by(lines), vertex, -1, bits, lines, itself)


def _flows(spread: Spread) -> Iterator[Closure]:
    for index, keeps in sorted(spread.flow_keeps.items()):
        flow = spread.graph.flows[index]
        stopped = (spread.sent.get(flow.source, 0) | spread.flow_emits.get(index, 0)) & ~keeps
        for lines, categories in _by_lines(spread, spread.flow_facts[index], stopped).items():
            yield Closure(_said_by(lines), flow.source, flow.target, stopped & sum(map(spread.both, categories)), lines)


def _denied(spread: Spread) -> Iterator[Closure]:
    """Flows that a DENY takes back, with data at their start (rule S5)."""
    for flow in spread.graph.taken_back:
        bits = spread.leaves.get(flow.source, 0)
        if bits:
            lines = {denial.place: None for denial in sorted(flow.denials, key=lambda denial: line_key(denial.place))}
            yield Closure(DENY, flow.source, flow.target, bits, tuple(lines))


def _by_lines(spread: Spread, decided: Mapping[str, Facts], stopped: int) -> dict[tuple[Line, ...], list[str]]:
    """What is stopped, by the statements that stop it."""
    by_lines: dict[tuple[Line, ...], list[str]] = defaultdict(list)
    for category in spread.names(stopped) if stopped else ():
        by_lines[decided[category].closers].append(category)
    return by_lines


def _alone(fact: Facts) -> bool:
    return not fact.reviewers and not fact.leaks and not fact.emits


def _said_by(lines: tuple[Line, ...]) -> str:
    statements = [line for line in lines if isinstance(line, Statement) and line.role != CANNOT]
    if not statements:
        return TYPE
    if all(line.shipped for line in statements):
        return STANDARD
    return ABSENT if statements[0].method is Method.ABSENT else statements[0].role


def behind(spread: Spread, closed: Sequence[Closure], places: Mapping[int, int]) -> dict[int, int]:
    """Return what data would get to if it were not for a closure.

    Parameters
    ----------
    places
        Vertex -> bits that count there.

    Returns
    -------
    dict
        Number of the closure -> the nearest place, or ``PERHAPS``; those with nothing behind are absent. A search tells
        for closures by themselves. A line that closes several elements in a row has to be opened as a whole.

    Examples
    --------
    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> closed = closures(carried)
    >>> places = behind(carried, closed, carried.leaks)
    >>> {closure.by: NAMES[places[n]] if n in places else None for n, closure in enumerate(closed)}
    {'sanitizer': '/archive', 'only': '/archive', 'standard-channel': None, 'deny': '/archive'}
    """
    if not closed or not any(places.values()):
        return {}
    plain = backward(spread, places)
    behind = {number: closure for number, closure in enumerate(closed) if _led(closure, plain)}
    result = _nearest(spread, behind, places, plain, NOTHING_OPENED)
    left = {number: closure for number, closure in enumerate(closed) if number not in behind}
    extents = _extents(spread, {line for closure in left.values() for line in closure.lines})
    if not extents:
        return result
    together = backward(spread, places, Opened.of(extents.values()))
    left = {number: closure for number, closure in left.items() if _led(closure, together)}
    lines = [line for line in extents if any(line in closure.lines for closure in left.values())]
    for line in lines[:ROUNDS]:
        by = backward(spread, places, extents[line])
        behind = {n: c for n, c in left.items() if line in c.lines and n not in result and _led(c, by)}
        result |= _nearest(spread, behind, places, by, extents[line])
    untold = set(lines[ROUNDS:])
    return {number: PERHAPS for number, closure in left.items() if untold.intersection(closure.lines)} | result


def _led(closure: Closure, by: Backward) -> int:
    """The bits that would get to a place from here: from the element on, or by the end of the flow."""
    leading = by.leaving.get(closure.vertex, 0) if closure.to < 0 else by.entering.get(closure.to, 0)
    return closure.bits & leading


def _nearest(
    spread: Spread, behind: Mapping[int, Closure], places: Mapping[int, int], by: Backward, opened: Opened
) -> dict[int, int]:
    if not behind:
        return {}
    near = Nearest.of(spread, places, opened)
    return {
        number: near.after(c.vertex, _led(c, by)) if c.to < 0 else near.at(c.to, _led(c, by))
        for number, c in behind.items()
    }


def _extents(spread: Spread, lines: set[Line]) -> dict[Line, Opened]:
    """All that each of some lines closes, reached or not; only lines that close more than one element or flow."""
    elements: dict[Line, dict[int, int]] = defaultdict(dict)
    flows: dict[Line, dict[int, int]] = defaultdict(dict)
    more: dict[Line, set[tuple[int, int]]] = defaultdict(set)
    alike: dict[int, dict[Line, int]] = {}  # the same is said of many elements
    for facts, closed in ((spread.facts, elements), (spread.flow_facts, flows)):
        for number, decided in facts.items():
            if id(decided) not in alike:
                alike[id(decided)] = _closing(spread, decided)
            for line, bits in alike[id(decided)].items():
                closed[line][number] = bits
    for flow in spread.graph.taken_back:
        for denial in flow.denials:
            more[denial.place].add((flow.source, flow.target))
    extents = {line: Opened(elements[line], flows[line], tuple(sorted(more[line]))) for line in lines}
    several = [(line, opened) for line, opened in extents.items() if opened.size > 1]
    return dict(sorted(several, key=lambda pair: line_key(pair[0])))


def _closing(spread: Spread, decided: Mapping[str, Facts]) -> dict[Line, int]:
    """What each line closes, where this is decided."""
    closing: dict[Line, int] = defaultdict(int)
    for category in spread.categories:
        for line in decided[category].closers if category in decided else ():
            closing[line] |= spread.both(category)
    return closing


def line_key(line: Line) -> tuple[str, int, str]:
    """Statements by their place and what they say; policy lines by their place.

    >>> lines = [Place("b.yaml", 1), Place("a.yaml", 20), Place("a.yaml", 3)]
    >>> [str(line) for line in sorted(lines, key=line_key)]
    ['a.yaml:3', 'a.yaml:20', 'b.yaml:1']
    """
    if isinstance(line, Place):
        return (line.file, line.line, "")
    return (line.place.file, line.place.line, repr(line))
