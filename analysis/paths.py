"""Further paths of a finding: how many share no flow, and which there are (the paper, section II-B).

In: a search from a source. Out: counts and paths, by networkx, on the small part of the graph that lies between the
source and the leak. A path is one over (element, category): where nothing is derived on the way, one over elements.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.spread import bits_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.search import Net, Search

State = tuple[int, int]  # vertex, number of the category with which data arrives there
SOURCE, LEAK = -1, -2  # in place of the category's number: the source and the leak are one state each
WITNESS, DISJOINT, ALL = "witness", "disjoint", "all"


@dataclass(frozen=True, slots=True)
class Paths:
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
    """The ways from one source, for one category that arrives at leaks.

    Parameters
    ----------
    way
        The search whose reach they lie in.
    category
        Its number.
    stop
        Vertex -> bits that are not followed on from there.
    """

    def __init__(self, net: Net, way: Search, source: int, category: int, stop: Mapping[int, int]) -> None:
        self.net = net
        self.source = source
        self.category = category
        self.k = len(net.spread.categories)
        self.starts = way.begun.get(source, 0)
        self.edges = sorted(set(self._edges(way, stop)))

    def _edges(self, way: Search, stop: Mapping[int, int]) -> Iterable[tuple[State, State]]:
        spread = self.net.spread
        for index, target, passing in self.net.flows.get(self.source, ()):
            bits = (spread.emits.get(self.source, 0) | spread.flow_emits.get(index, 0)) & self.starts & passing
            yield from (((self.source, SOURCE), self._state(target, bit)) for bit in bits_of(bits))
        for vertex, seen in way.seen.items():
            for bit in bits_of(seen & ~stop.get(vertex, 0)):
                here = self._state(vertex, bit)
                leaving = 1 << bit & spread.keeps.get(vertex, spread.all_bits)
                leaving |= sum(1 << after for before, after in spread.derives.get(vertex, ()) if before == bit)
                for _, target, passing in self.net.flows.get(vertex, ()):
                    yield from ((here, self._state(target, out)) for out in bits_of(leaving & passing))

    def _state(self, vertex: int, bit: int) -> State:
        if vertex == self.source and self.starts >> bit % self.k & 1:
            return (vertex, SOURCE)
        return (vertex, bit % self.k)

    def to(self, leak: int, memory: dict[Any, Any]) -> tuple[list[list[int]], Any]:
        """Return the paths to a leak that share no flow, as vertices, and the graph that they lie in.

        Parameters
        ----------
        memory
            Answers for equal graphs: kinds of data often go the same ways.
        """
        pairs = self.net.spread.derives.get(leak, ())
        ends = {(leak, before % self.k) for before, after in pairs if after % self.k == self.category}
        ends.add((leak, self.category))
        end = (leak, LEAK)
        edges = [(a, end if b in ends else b) for a, b in self.edges if a not in ends and b[1] != SOURCE]
        kept = _leading_to(end, edges)
        number = {self.category: 0}
        key = tuple((a[0], number.get(a[1], a[1] + 1), b[0], number.get(b[1], b[1] + 1)) for a, b in kept)
        if key not in memory:
            import networkx as nx  # noqa: PLC0415 - heavy, and only needed where there is a finding

            graph = nx.DiGraph(kept)
            paths = [[state[0] for state in path] for path in nx.edge_disjoint_paths(graph, (self.source, SOURCE), end)]
            memory[key] = sorted(paths, key=lambda path: (len(path), path)), graph
        disjoint, graph = memory[key]
        return disjoint, graph


def _leading_to(end: State, edges: list[tuple[State, State]]) -> list[tuple[State, State]]:
    """The edges from which the end can be reached, sorted."""
    back: dict[State, list[State]] = defaultdict(list)
    for a, b in edges:
        back[b].append(a)
    reached = {end}
    waiting = [end]
    while waiting:
        for state in back.get(waiting.pop(), ()):
            if state not in reached:
                reached.add(state)
                waiting.append(state)
    return sorted({(a, b) for a, b in edges if b in reached and a in reached})


def further(between: Between, leak: int, memory: dict[Any, Any], asked: str, most: int) -> Paths:
    """Count the paths that share no flow, and list those asked for.

    Parameters
    ----------
    asked
        ``witness`` (none), ``disjoint`` or ``all``.
    most
        Bound on the list.
    """
    disjoint, graph = between.to(leak, memory)
    if asked == WITNESS:
        return Paths(len(disjoint))
    found: Iterable[list[int]] = disjoint
    if asked == ALL:
        import networkx as nx  # noqa: PLC0415 - as above

        ends = next(s for s in graph if s[1] == SOURCE), next(s for s in graph if s[1] == LEAK)
        found = ([state[0] for state in path] for path in nx.shortest_simple_paths(graph, *ends))
    shown: dict[tuple[Element, ...], None] = {}
    for path in found:  # two ways of data that differs may be one way to the reader
        shown[_elements(between.net, path)] = None
        if len(shown) > most:
            break
    return Paths(len(disjoint), tuple(shown)[:most], len(shown) > most)


def _elements(net: Net, path: list[int]) -> tuple[Element, ...]:
    """The elements of a path; the two sides of one wildcard are one to the reader."""
    elements: list[Element] = []
    for vertex in path:
        element = net.spread.graph.elements[vertex]
        if not elements or element.shown_as != elements[-1].shown_as:
            elements.append(element)
    return tuple(elements)
