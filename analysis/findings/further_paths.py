"""Further paths of a finding: how many share no flow, and which there are (the paper, section II-B).

In: a search from a source. Out: counts and paths, by networkx, on the small part of the graph that lies between the
source and the leak. A path is one over (element, category): where nothing is derived on the path, one over elements.
"""

from __future__ import annotations

import hashlib
from array import array
from collections import defaultdict, deque
from itertools import chain, product
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.disjoint_in_groups import number_in_groups
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.states import States
from rosprivacy.analysis.many_flows import one_by_one
from rosprivacy.analysis.modes import Paths

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from collections.abc import Set as AbstractSet
    from typing import Any

    from rosprivacy.analysis.bounds import Tally
    from rosprivacy.analysis.findings.disjoint_in_groups import Group
    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.states import Net
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Element, FlowGraph

State = int  # vertex * width + form
LEAK, SOURCE, FIRST = 0, 1, 2  # forms: the leak and the source are one state each; then categories by their number
SEARCHED = 10  # times the bound: so many paths of data are looked at, of which many may be one to the reader


class FurtherPaths(NamedTuple):
    """Paths between a source and a leak.

    Attributes
    ----------
    disjoint
        How many share no flow.
    paths
        Those asked for, shortest first.
    bounded
        Whether there are more.
    """

    disjoint: int
    paths: tuple[tuple[Element, ...], ...] = ()
    bounded: bool = False


class Between:
    """The paths from one source, for one category that arrives at leaks.

    Parameters
    ----------
    reach
        The search that they lie in.
    category
        Its number.
    relevant
        Bits of the categories that it can be made of, its own included.
    stop
        Vertex -> bits that are not followed on from there.
    """

    def __init__(
        self, net: Net, reach: Search, source: int, category: int, relevant: int, stop: Mapping[int, int]
    ) -> None:
        self.graph, self.derives = net.spread.graph, net.spread.derives
        self.source = source
        self.category = category
        self.bits = net.spread.bits
        self.states = States(net, relevant, stop)
        self.emits = self.states.emitted(source)
        self.width = FIRST + self.bits.merged(net.spread.all_bits).bit_length()
        self.begin = self.state(source, SOURCE)
        self.reached = len(reach.arrived_bits)
        self._reach: Search | None = reach
        self._meetings: dict[int, list[tuple[int, int]]] = {}
        self.back: dict[State, set[State]] = defaultdict(set)
        self.met: dict[tuple[int, int], tuple[Meeting, set[State]]] = {}  # by meeting and bits: who sends these
        self.groups: list[tuple[set[State], set[State]]] = []
        self.into: dict[State, list[int]] = defaultdict(list)
        self._meet(self.begin, source, self.emits)
        for _, target, bits in (*self.states.after_alone(source, self.emits), *self.states.single(source)):
            for state in self._at(target, bits):
                self.back[state].add(self.begin)
        self.one_way_out = len(self.back) == 1 and not self.met

    def state(self, vertex: int, form: int) -> State:
        """Return the number of a state."""
        return vertex * self.width + form

    def link(self, work: Tally) -> None:
        """Link all states to those that follow, once and where it is needed; the work is counted."""
        if self._reach is None:
            return
        for before, after in self._edges(self._reach):
            work.count += 1
            self.back[after].add(before)
        self._reach = None
        self.groups = [(befores, set(self._read(meeting, bits))) for (_, bits), (meeting, befores) in self.met.items()]
        for number, (befores, afters) in enumerate(self.groups):
            work.count += len(befores) + len(afters)
            for after in afters:
                self.into[after].append(number)

    def _edges(self, reach: Search) -> Iterator[tuple[State, State]]:
        """The steps from what arrives somewhere; those from the source's own data are linked before."""
        states, net = self.states, self.states.net
        for vertex, seen in reach.arrived_bits.items():
            moves, single = net.flows.get(vertex, ()), net.spread.flow_emits if vertex == self.source else {}
            for form, both in self._forms(seen) if moves or vertex in net.meetings else ():
                if self._begun(vertex, form):
                    continue
                here, leaving = self.state(vertex, form), states.leaving(vertex, seen & both)
                self._meet(here, vertex, leaving)
                for index, target, passing in moves if leaving else ():
                    # what a source emits along a flow does not go there a second time
                    if moved := leaving & passing & ~single.get(index, 0):
                        yield from ((here, state) for state in self._at(target, moved))

    def _meet(self, state: State, vertex: int, leaving: int) -> None:
        """Note what a state sends to all that its meetings read."""
        for meeting in self.states.net.meetings.get(vertex, ()) if leaving else ():
            self.met.setdefault((id(meeting), leaving), (meeting, set()))[1].add(state)

    def _read(self, meeting: Meeting, bits: int) -> Iterator[State]:
        spread = self.states.net.spread
        for target in meeting.read:
            yield from self._at(target, bits & spread.absorbed(target))

    def _at(self, vertex: int, bits: int) -> list[State]:
        """The states that data with some bits is in at a vertex, its two planes put together."""
        start = vertex * self.width
        if vertex != self.source:
            return [start + form for form, _ in self._forms(bits)]
        return [self.begin if self._begun(vertex, form) else start + form for form, _ in self._forms(bits)]

    def _forms(self, bits: int) -> list[tuple[int, int]]:
        """Form and bits of each category among some."""
        forms = self._meetings.get(bits)
        if forms is None:
            numbers = bits_of(self.bits.merged(bits & self.states.allowed))
            forms = self._meetings[bits] = [(number + FIRST, self.bits.pair(number)) for number in numbers]
        return forms

    def _begun(self, vertex: int, form: int) -> bool:
        """Whether data in this form is what the vertex, as the source, emits anyway."""
        return vertex == self.source and bool(self.emits >> self.bits.plain(form - FIRST) & 1)

    def to(self, leak: int, memory: dict[Any, Any]) -> tuple[list[list[int]], list[tuple[State, State]]]:
        """Return the paths to a leak that share no flow, as vertices, and the edges that they lie among."""
        edges, groups = self._leading_to(leak)
        if groups:
            one_by_one(self.graph.flows)
            edges = sorted([*edges, *(pair for group in groups for pair in product(*group))])
        key = self._key(leak, edges)
        if key not in memory:
            paths = _disjoint(edges, self.begin, self.state(leak, LEAK))
            memory[key] = [[state // self.width for state in path] for path in paths]
        return memory[key], edges

    def number_to(self, leak: int, memory: dict[Any, Any], work: Tally) -> int:
        """Return how many paths to a leak share no flow; the work is counted.

        Parameters
        ----------
        memory
            Answers for equal graphs: kinds of data often take the same paths.
        """
        if self.one_way_out:
            work.count += self.reached
            return 1
        self.link(work)
        ends = self._ends(leak)
        last = {before for end in ends for before in self.back.get(end, ())} - ends
        if len(last) == 1 and not any(end in self.into for end in ends):
            work.count += self.reached
            return 1
        edges, groups = self._leading_to(leak)
        work.count += len(edges) + sum(len(befores) + len(afters) for befores, afters in groups)
        alike = [[(state, state) for state in some] for some in chain(*groups)]
        key = "number", *(self._key(leak, some) for some in (edges, *alike))
        if key not in memory:
            between = self.begin, self.state(leak, LEAK)
            memory[key] = (
                number_in_groups(edges, groups, *between, work) if groups else number_disjoint(edges, *between, work)
            )
        return int(memory[key])

    def _key(self, leak: int, edges: Sequence[tuple[State, State]]) -> tuple[int, int, bool, bytes]:
        """What the answer hangs on; a hash of the edges, which are many."""
        # one kind of data is like another where nothing is made into it
        width, own = self.width, {SOURCE, self.category + FIRST}
        differs = any(before % width not in own for before, _ in edges)
        states = [state for edge in edges for state in edge]
        numbers = array("q", states if differs else [state // width for state in states])
        # on a ring two sources have equal graphs
        return self.source, leak, differs, hashlib.sha256(numbers.tobytes()).digest()

    def _ends(self, leak: int) -> set[State]:
        """The states in which data of the category is at a leak, or what the leak makes it of."""
        category = self.bits.category
        made_of = (category(b) for b, after in self.derives.get(leak, ()) if category(after) == self.category)
        return {self.state(leak, number + FIRST) for number in (*made_of, self.category)}

    def _leading_to(self, leak: int) -> tuple[list[tuple[State, State]], list[Group]]:
        """The edges from which a leak can be reached, sorted; of groups, in place of their pairs, what begins and ends.

        Whatever comes to one state of a group comes to all that lead on, so each group is walked back once.
        """
        ends = self._ends(leak)
        edges: set[tuple[State, State]] = set()
        reached, waiting = set(ends), list(ends)
        groups: dict[int, set[State]] = {}
        while waiting:
            after = waiting.pop()
            shown = self.state(leak, LEAK) if after in ends else after
            befores = self.back.get(after, set()) - ends
            edges.update((before, shown) for before in befores)
            for number in self.into.get(after, ()):
                if number not in groups:
                    befores |= self.groups[number][0] - ends
                groups.setdefault(number, set()).add(shown)
            new = befores - reached
            reached |= new
            waiting += (before for before in new if before != self.begin)
        met = ((sorted(self.groups[number][0] - ends), sorted(afters)) for number, afters in groups.items())
        return sorted(edges), sorted((befores, afters) for befores, afters in met if befores)


def _disjoint(edges: list[tuple[State, State]], source: State, leak: State) -> list[list[int]]:
    """The paths that share no flow, as states, shortest first."""
    first, last = [b for a, b in edges if a == source], [a for a, b in edges if b == leak]
    if len(first) == 1 or len(last) == 1:  # a flow that all paths share: the shortest is one of them
        return [_shortest(edges, source, leak)]
    import networkx as nx  # noqa: PLC0415 - heavy, and only needed where there may be several

    paths = nx.edge_disjoint_paths(nx.DiGraph(edges), source, leak)
    return sorted(paths, key=lambda path: (len(path), path))


def number_disjoint(edges: Sequence[tuple[State, State]], source: State, leak: State, work: Tally) -> int:
    """Return how many paths share no flow; as long as ``_disjoint``'s list, and found in a fraction of the time.

    Each path found may take back a step of an earlier one, until there is none left, or one for each way out or in
    (Ford and Fulkerson; a search in breadth for each path). O(paths x edges).

    >>> from rosprivacy.analysis.bounds import BOUNDS, Tally
    >>> camera, left, right, cloud = range(4)
    >>> edges = [(camera, left), (camera, right), (left, cloud), (right, cloud), (left, right)]
    >>> number_disjoint(edges, camera, cloud, Tally(BOUNDS, "path_steps"))
    2
    """
    ahead: dict[State, list[State]] = defaultdict(list)  # steps that no path takes, from their start
    for before, after in edges:
        ahead[before].append(after)
    taken: dict[State, set[State]] = defaultdict(set)  # those that one does, from their end
    most = min(len(ahead[source]), sum(after == leak for _, after in edges))
    for number in range(most):
        came = _one_more(ahead, taken, source, leak, work)
        if leak not in came:
            return number
        after = leak
        while after != source:
            before = came[after]
            if after in taken[before]:  # against the direction: taken back
                taken[before].remove(after)
                ahead[after].append(before)
            else:
                ahead[before].remove(after)
                taken[after].add(before)
            after = before
    return most


def _one_more(
    ahead: Mapping[State, Sequence[State]], step_origins: Mapping[State, AbstractSet[State]], source: State,
    leak: State, work: Tally,
) -> dict[State, State]:  # fmt: skip
    """Where a search came from at each state: along steps that no path takes, and back along those that one does."""
    came = {source: source}
    waiting = deque([source])
    while waiting and leak not in came:
        here = waiting.popleft()
        nexts = [*ahead.get(here, ()), *step_origins.get(here, ())]
        work.count += len(nexts) + 1
        for after in nexts:
            if after not in came:
                came[after] = here
                waiting.append(after)
    return came


def _shortest(edges: list[tuple[State, State]], source: State, leak: State) -> list[int]:
    ahead: dict[State, list[State]] = defaultdict(list)
    for before, after in edges:
        ahead[before].append(after)
    came: dict[State, State] = {}
    waiting = deque([source])
    while leak not in came:
        here = waiting.popleft()
        for after in ahead[here]:
            if after not in came:
                came[after] = here
                waiting.append(after)
    path = [leak]
    while path[-1] != source:
        path.append(came[path[-1]])
    return path[::-1]


def further(between: Between, leak: int, memory: dict[Any, Any], detail: str, bound: int, work: Tally) -> FurtherPaths:
    """Count the paths that share no flow, and list those asked for.

    Parameters
    ----------
    detail
        ``witness`` (none), ``disjoint`` or ``all``.
    bound
        Bound on the list.
    work
        Counts the steps.

    Examples
    --------
    >>> from rosprivacy.analysis.bounds import BOUNDS, Tally
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
    >>> from rosprivacy.analysis.kernel.search import search
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> reach = search(net, [CAMERA], net.spread.all_bits, {})
    >>> number = net.spread.categories.index("Video")
    >>> between = Between(net, reach, CAMERA, number, net.spread.all_bits, {})
    >>> paths = further(between, ARCHIVE, {}, "all", 10, Tally(BOUNDS, "path_steps"))
    >>> paths.disjoint, [[element.name for element in path] for path in paths.paths]
    (1, [['/camera', '/video', '/filter', '/filtered', '/archive']])
    """
    mode = Paths(detail)
    if mode is Paths.witness:
        return FurtherPaths(between.number_to(leak, memory, work))
    between.link(work)
    disjoint, edges = between.to(leak, memory)
    work.count += len(edges) * (1 + len(disjoint))
    chosen: Iterable[list[int]] = disjoint
    if mode is Paths.all:
        import networkx as nx  # noqa: PLC0415 - as above

        paths = nx.shortest_simple_paths(nx.DiGraph(edges), between.begin, between.state(leak, LEAK))
        chosen = ([state // between.width for state in path] for path in paths)
    shown: dict[tuple[Element, ...], None] = {}
    for number, path in enumerate(chosen):  # two paths of data that differs may be one path to the reader
        shown[_elements(between.graph, path)] = None
        if len(shown) > bound or number >= SEARCHED * bound:
            return FurtherPaths(len(disjoint), tuple(shown)[:bound], bounded=True)
    return FurtherPaths(len(disjoint), tuple(shown))


def _elements(graph: FlowGraph, path: list[int]) -> tuple[Element, ...]:
    """The elements of a path; the two sides of one wildcard are one to the reader."""
    elements: list[Element] = []
    for vertex in path:
        element = graph.elements[vertex]
        if not elements or element.shown_as != elements[-1].shown_as:
            elements.append(element)
    return tuple(elements)
