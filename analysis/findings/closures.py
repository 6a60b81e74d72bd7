"""Where data ends on the word of a label, a DENY or a shipped file, and what lies behind (rules S5, S7, S11, S13).

In: a ``Spread``. Out: ``Closure`` facts; for each the nearest of some places that data would get to if what closes it
were not there; and ``ClosedByShipped`` facts: what nobody but a shipped file keeps from a leak. The nearest is found by
one search back from all places (``Nearest``), then a walk down its levels, from as many starts as one likes.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import ClosedByLine, ClosedByShipped
from rosprivacy.analysis.kernel.backward import NOTHING_OPENED, Opened, backward
from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph
from rosprivacy.analysis.kernel.least_solution import least_solution
from rosprivacy.analysis.kernel.states import back, back_from, onward
from rosprivacy.analysis.many_flows import leaving, parted
from rosprivacy.analysis.model import BY_TYPE, CANNOT, NON_ROS, STANDARD, Method, Place, Rank, Statement

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.backward import Backward
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Element, Flow

Line = Statement | Place
DENY, STANDARD_CHANNEL, ABSENT, TYPE = "deny", "standard-channel", "absent", "type"
ROUNDS = 64  # lines about several elements that are opened one by one; of others it is said that they may close a path
PERHAPS = -2  # in place of a vertex, where it was not worked out
FAR = 1 << 60  # further than any path is long


class Closure(NamedTuple):
    """Bits that get to an element or a flow and do not go on.

    Attributes
    ----------
    by
        Role of the statement, ``DENY``, ``STANDARD_CHANNEL``, or ``TYPE`` where only the type of a channel says so.
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


def _elements(spread: Spread, vertices: Iterable[int]) -> Iterator[Closure]:
    alike: dict[tuple[int, int], list[Closure]] = {}  # the same is said of many elements
    for vertex in sorted(vertices):
        decided = spread.facts[vertex]
        stopped = spread.arrives.get(vertex, 0) & ~spread.keeps[vertex]
        if (id(decided), stopped) not in alike:
            alike[id(decided), stopped] = list(_by_lines(spread, decided, stopped, vertex))
        for closure in alike[id(decided), stopped]:
            yield Closure(closure.by, vertex, -1, closure.bits, closure.lines, closure.itself)


def _flows(spread: Spread) -> Iterator[Closure]:
    for index, keeps in sorted(spread.flow_keeps.items()):
        flow = spread.graph.flows[index]
        stopped = (spread.sent.get(flow.source, 0) | spread.flow_emits.get(index, 0)) & ~keeps
        yield from _by_lines(spread, spread.flow_facts[index], stopped, flow.source, flow.target)


def _by_lines(
    spread: Spread, decided: Mapping[str, Facts], stopped: int, vertex: int, to: int = -1
) -> Iterator[Closure]:
    """What is stopped, by the statements that stop it."""
    by_lines: dict[tuple[Statement, ...], list[str]] = defaultdict(list)
    for category in spread.names(stopped) if stopped else ():
        by_lines[decided[category].closers].append(category)
    for lines, categories in by_lines.items():
        facts = [decided[category] for category in categories]
        itself = to < 0 and any(not (fact.reviewers or fact.leaks or fact.emits) for fact in facts)
        yield Closure(_role(lines), vertex, to, stopped & sum(map(spread.forms_of, categories)), lines, itself)


def _role(lines: tuple[Statement, ...]) -> str:
    statements = [line for line in lines if line.role not in (CANNOT, BY_TYPE)]
    if not statements:
        return "only" if any(line.role == BY_TYPE for line in lines) else TYPE
    if all(line.shipped for line in statements):
        return STANDARD_CHANNEL
    return ABSENT if statements[0].method is Method.ABSENT else statements[0].role


def _denied(spread: Spread) -> Iterator[Closure]:
    """Flows that a DENY takes back, with data at their start (rule S5)."""
    for flow in spread.graph.taken_back:
        if bits := spread.leaves.get(flow.source, 0):
            places = {denial.place for denial in flow.denials}
            yield Closure(DENY, flow.source, flow.target, bits, tuple(sorted(places)))


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
    result = _behind_opened(spread, dict(enumerate(closed)), places, NOTHING_OPENED)
    left = {number: closure for number, closure in enumerate(closed) if number not in result}
    extents = _extents(spread, {line for closure in left.values() for line in closure.lines})
    if not extents:
        return result
    together = backward(spread, places, Opened.of(extents.values()))
    left = {number: closure for number, closure in left.items() if _leading(closure, together)}
    lines = [line for line in extents if any(line in closure.lines for closure in left.values())]
    for line in lines[:ROUNDS]:
        by_it = {number: c for number, c in left.items() if line in c.lines and number not in result}
        result |= _behind_opened(spread, by_it, places, extents[line])
    not_opened = set(lines[ROUNDS:])
    return {number: PERHAPS for number, closure in left.items() if not_opened.intersection(closure.lines)} | result


def _behind_opened(
    spread: Spread, closed: Mapping[int, Closure], places: Mapping[int, int], opened: Opened
) -> dict[int, int]:
    """The nearest place behind each closure that has one, if some of what lines close is open."""
    by = backward(spread, places, opened)
    leading = {number: bits for number, closure in closed.items() if (bits := _leading(closure, by))}
    if not leading:
        return {}
    near = Nearest.of(spread, places, opened)
    ends = ((number, closed[number], bits) for number, bits in leading.items())
    return {n: near.after(c.vertex, bits) if c.to < 0 else near.at(c.to, bits) for n, c, bits in ends}


def _leading(closure: Closure, by: Backward) -> int:
    """The bits that would get to a place from here: from the element on, or by the end of the flow."""
    leading = by.leaving.get(closure.vertex, 0) if closure.to < 0 else by.entering.get(closure.to, 0)
    return closure.bits & leading


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
            closing[line] |= spread.forms_of(category)
    return closing


def line_key(line: Line) -> tuple[str, int, str]:
    """Statements by their place and what they say; policy lines by their place.

    >>> lines = [Place("b.yaml", 1), Place("a.yaml", 20), Place("a.yaml", 3)]
    >>> [str(line) for line in sorted(lines, key=line_key)]
    ['a.yaml:3', 'a.yaml:20', 'b.yaml:1']
    """
    return (*line, "") if isinstance(line, Place) else (*line.place, repr(line))


def closed_by_shipped(
    spread: Spread, mask: int, beyond: Collection[int] = (), unit: Sequence[int] = ()
) -> tuple[ClosedByShipped, ...]:
    """Return what shipped statements alone close, one for both legs and sides of a channel, in the order of channels.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.
    beyond
        Of a part of a graph, the vertices through which data gets to other parts: a leak may lie behind each.
    unit
        Of a part of a graph, by vertex: what a node has to have in common with its services; empty for nothing.

    Notes
    -----
    Nothing where nobody reads what was closed; else a few runs of the kernel, as for the ledger.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> faces = [element.name for element in graph.elements].index("/faces")
    >>> mundane = Statement("mundane", (), (STANDARD, 0), Place("rosprivacy:standard", 7), shipped=True)
    >>> bound = replace(bound, elements={**bound.elements, faces: (mundane,)})
    >>> carried = spread(graph, bound, hierarchy)
    >>> [(row.channel.name, row.end.name, row.rank) for row in closed_by_shipped(carried, carried.all_bits)]
    [('/faces', '/archive', None)]
    """
    elements, onward = spread.graph.elements, leaving(spread.graph.flows) if spread.standard else {}
    standard = (closure for closure in _elements(spread, spread.standard) if closure.by == STANDARD_CHANNEL)
    closed = [closure for closure in standard if closure.bits & mask and closure.vertex in onward]
    if not closed:
        return ()
    ends = {v: bits & mask for v, bits in spread.leaks.items()}
    ends |= {v: mask for v, element in enumerate(elements) if element.kind in NON_ROS}
    ends |= dict.fromkeys(beyond, mask)
    nodes: dict[int, set[str]] = defaultdict(set)
    for v, element in enumerate(elements):
        if element.is_node and v not in spread.absent:
            nodes[unit[v] if unit else 0].add(element.name)
    rows: dict[tuple[str, str, str], list[ClosedByShipped]] = defaultdict(list)
    for number, end in sorted(behind(spread, closed, ends).items()):
        closure = closed[number]
        lines = [line for line in closure.lines if isinstance(line, Statement) and line.shipped]
        by_standard = any(line.rank[0] == STANDARD for line in lines)
        channel = elements[closure.vertex]
        outside = Rank.BREAKS if not in_its_place(channel, nodes[unit[closure.vertex] if unit else 0]) else None
        row = ClosedByShipped(
            channel,
            spread.names(closure.bits & mask),
            None if end == PERHAPS or (end in beyond and elements[end].kind not in NON_ROS) else elements[end],
            tuple(sorted({line.place for line in lines})),
            outside if by_standard else Rank.RIDES,
        )
        rows[channel.identity].append(row)
    return tuple(_joined(rows[key]) for key in sorted(rows))


def closed_by_lines(spread: Spread, mask: int, *, unreviewed: bool = True) -> tuple[ClosedByLine, ...]:
    """Return at which channels only a line ``only: by-type`` closes a way on, one for both legs and sides of a channel.

    A way goes on to a leak, to an element outside ROS, or to a node that nobody reviewed. All such lines are opened
    together, and with them what only a type or a shipped file closes: a way that two of them close is none that a
    person closes. So each line on such a way is told.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.
    unreviewed
        Whether a way that goes on to a node that nobody reviewed counts.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import FACES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> line = Statement("by-type", ("FaceTemplate", "Video"), (-3, 0), Place("labels.yaml", 7))
    >>> carried = spread(graph, replace(bound, elements={**bound.elements, FACES: (line,)}), hierarchy)
    >>> [(row.channel.name, row.categories, str(row.place)) for row in closed_by_lines(carried, carried.all_bits)]
    [('/faces', ('FaceTemplate', 'Video'), 'labels.yaml:7')]
    """
    distinct = {id(decided): decided for decided in spread.facts.values()}.values()
    if not any(line.role == BY_TYPE for decided in distinct for fact in decided.values() for line in fact.closers):
        return ()
    elements, opened = spread.graph.elements, _not_by_persons(spread)
    keeps = spread.keeps | {v: spread.keeps.get(v, spread.all_bits) | bits for v, bits in opened.items()}
    arrives, _ = least_solution(LabelledGraph.of(replace(spread, keeps=keeps)))
    stopped: dict[int, int] = defaultdict(int)
    places: dict[int, Place] = {}
    for vertex, bits in opened.items():
        for category in spread.names(bits & arrives.get(vertex, 0)):
            lines = [line.place for line in spread.facts[vertex][category].closers if line.role == BY_TYPE]
            if lines:
                places.setdefault(vertex, lines[0])
                stopped[vertex] |= spread.forms_of(category) & arrives[vertex]
    ends = {v: bits & mask for v, bits in spread.leaks.items()}
    for v, element in enumerate(elements):
        if not element.is_channel and v not in spread.absent:
            uncovered = ~spread.covered.get(v, 0) if unreviewed else 0
            ends[v] = ends.get(v, 0) | (mask if element.kind in NON_ROS else mask & uncovered)
    leaving = backward(spread, ends, Opened(opened)).leaving
    rows: dict[tuple[str, str, str], ClosedByLine] = {}
    for vertex, bits in sorted(stopped.items()):
        if names := {*spread.names(bits & leaving.get(vertex, 0))}:
            key = elements[vertex].identity
            row = rows.get(key, ClosedByLine(elements[vertex], (), places[vertex]))
            rows[key] = row._replace(categories=tuple(sorted({*row.categories, *names})))
    return tuple(rows[key] for key in sorted(rows))


def _not_by_persons(spread: Spread) -> dict[int, int]:
    """Vertex -> bits that only types close, lines about these, or shipped files but for standard channels in place."""
    elements = spread.graph.elements
    nodes = {e.name for v, e in enumerate(elements) if e.is_node and v not in spread.absent}
    opened: dict[int, int] = defaultdict(int)

    def weak(line: Statement, channel: Element) -> bool:
        if line.role in (BY_TYPE, CANNOT):
            return True
        return line.shipped and (line.rank[0] < STANDARD or not in_its_place(channel, nodes))

    for vertex, decided in spread.facts.items():
        for category, fact in decided.items():
            if fact.closers and all(weak(line, elements[vertex]) for line in fact.closers):
                opened[vertex] |= spread.forms_of(category)
    return opened


def in_its_place(channel: Element, nodes: Collection[str]) -> bool:
    """Return whether a standard channel is where ROS has it: a topic at the root, a service of a node that is there.

    >>> from rosprivacy.analysis.model import Element
    >>> [in_its_place(Element("topic", name), ()) for name in ("/clock", "/patient/clock")]
    [True, False]
    >>> [in_its_place(Element("service", "/cloud/get_parameters"), nodes) for nodes in (["/cloud"], ["/camera"])]
    [True, False]

    Versions of rclcpp before Foxy name ``parameter_events`` below the namespace of the node:

    >>> [in_its_place(Element("topic", "/map/parameter_events"), nodes) for nodes in (["/map/server"], ["/camera"])]
    [True, False]
    """
    owner, _, last = channel.name.rpartition("/")
    if channel.kind == "service":
        return owner in nodes
    return not owner or (last == "parameter_events" and any(node.rpartition("/")[0] == owner for node in nodes))


def _joined(rows: list[ClosedByShipped]) -> ClosedByShipped:
    """Legs and sides of a channel as one, with what weighs most."""
    first = min(rows, key=lambda row: (row.rank is None, row.rank or "", row.end is None))
    categories = {name for row in rows for name in row.categories}
    places = {place for row in rows for place in row.places}
    return first._replace(categories=tuple(sorted(categories)), places=tuple(sorted(places)))


@dataclass(frozen=True, slots=True)
class Nearest:
    """How far each bit that arrives somewhere is from the nearest place.

    Attributes
    ----------
    levels
        Vertex -> (number of flows to a place, bits that are so far from it), the nearest first.
    leaving
        Vertex -> (target, bits that pass the flow), but for meetings.
    meetings
        Vertex -> its meetings, of which it is written.
    walked
        Vertex, bits that arrive there -> the nearest place, as walked so far: many walks go on along the same way.
    """

    spread: Spread
    opened: Opened
    levels: Mapping[int, list[tuple[int, int]]]
    leaving: Mapping[int, list[tuple[int, int]]]
    meetings: Mapping[int, list[Meeting]]
    walked: dict[tuple[int, int], int] = field(default_factory=dict)

    @classmethod
    def of(cls, spread: Spread, places: Mapping[int, int], opened: Opened = NOTHING_OPENED) -> Nearest:
        """Search back from all places at once; O(flows · levels at which bits are new)."""
        leaving: dict[int, list[tuple[int, int]]] = defaultdict(list)
        entering: dict[int, list[tuple[int, int]]] = defaultdict(list)
        for source, target, passing in _passing(spread, opened):
            leaving[source].append((target, passing))
            entering[target].append((source, passing))
        written: dict[int, list[Meeting]] = defaultdict(list)
        read: dict[int, list[Meeting]] = defaultdict(list)
        for meeting in _parted(spread, opened)[1]:
            for ends, of in ((meeting.written, written), (meeting.read, read)):
                for vertex in ends:
                    of[vertex].append(meeting)
        result = cls(spread, opened, defaultdict(list), leaving, written)
        met: dict[int, int] = defaultdict(int)  # what all that is written of a meeting was told
        seen: dict[int, int] = defaultdict(int)
        more = opened.elements
        new = {v: back_from(spread, v, bits, more.get(v, 0)) for v, bits in places.items() if bits}
        level = 0
        while new:
            further: dict[int, int] = defaultdict(int)
            for vertex, bits in sorted(new.items()):
                fresh = bits & ~seen[vertex]
                if fresh:
                    seen[vertex] |= fresh
                    result.levels[vertex].append((level, fresh))
                    for source, passing in entering.get(vertex, ()):
                        further[source] |= fresh & passing
                    for meeting in read.get(vertex, ()):
                        told = fresh & ~met[id(meeting)]
                        met[id(meeting)] |= told
                        for source in meeting.written if told else ():
                            further[source] |= told
            new = {v: before for v, bits in further.items() if (before := back(spread, v, bits, more.get(v, 0)))}
            level += 1
        return result

    def after(self, vertex: int, bits: int) -> int:
        """The nearest place for bits that leave an element; -1 if there is none."""
        return self._walk(self._after(vertex, bits))

    def at(self, vertex: int, bits: int) -> int:
        """The nearest place for bits that arrive at an element, itself included; -1 if there is none."""
        return self._walk([(vertex, bits)])

    def _walk(self, arriving: list[tuple[int, int]]) -> int:
        passed: list[tuple[int, int]] = []
        while True:
            level, vertex, bits = min((self._level(v, bits) for v, bits in arriving), default=(FAR, -1, 0))
            if level in (0, FAR) or (vertex, bits) in self.walked:
                place = self.walked.get((vertex, bits), vertex if level == 0 else -1)
                self.walked.update(dict.fromkeys(passed, place))
                return place
            passed.append((vertex, bits))
            leaving = onward(self.spread, vertex, bits, self.opened.elements.get(vertex, 0))
            arriving = self._after(vertex, leaving)

    def _after(self, vertex: int, bits: int) -> list[tuple[int, int]]:
        """What arrives where of bits that leave an element."""
        met = [(target, bits) for meeting in self.meetings.get(vertex, ()) for target in meeting.read]
        return [*((target, bits & passing) for target, passing in self.leaving.get(vertex, ())), *met]

    def _level(self, vertex: int, bits: int) -> tuple[int, int, int]:
        """How far some bits are from a place: the nearest of them; vertex; these bits."""
        for level, near in self.levels.get(vertex, ()):
            if near & bits:
                return level, vertex, near & bits
        return FAR, vertex, 0


def _passing(spread: Spread, opened: Opened) -> Iterator[tuple[int, int, int]]:
    """Source, target, bits that pass the flow; of flows that are not of meetings."""
    everything = spread.all_bits
    for index, flow in _parted(spread, opened)[0]:
        yield flow.source, flow.target, spread.flow_keeps.get(index, everything) | opened.flows.get(index, 0)
    more: Iterable[tuple[int, int]] = opened.added_flows
    yield from ((source, target, everything) for source, target in more)


def _parted(spread: Spread, opened: Opened) -> tuple[Iterable[tuple[int, Flow]], tuple[Meeting, ...]]:
    return parted(spread.graph.flows, {*spread.told_apart, *opened.flows})
