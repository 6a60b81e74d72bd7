"""Elements and flows that only globs of a user answer for: nobody need have seen that this data gets there (rule S11).

In: a spread and its labels. Out: ``ByGlobs``. It is what ``labels --pin`` keeps in label files, and without pins a
doubt. A glob answers for a kind where, without all that globs take away or call reviewed, the element would do
something else with it, or be open. What is pinned has been seen, and is not here.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.closures import closures
from rosprivacy.analysis.kernel.ranks import by_line, closes
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.model import STANDARD

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, Place, Statement


class ByGlobs(NamedTuple):
    """An element, or a flow, that only globs answer for.

    Attributes
    ----------
    element
        The start of a flow; of a service or action one of its legs.
    to
        The end of a flow; None of an element.
    categories
        Kinds that get there, as they are emitted, sorted; those that end there are among them.
    places
        The lines of the globs, sorted.
    """

    element: Element
    to: Element | None
    categories: tuple[str, ...]
    places: tuple[Place, ...]


def answered_by_globs(spread: Spread, bound: Bound, hierarchy: Hierarchy) -> tuple[ByGlobs, ...]:
    """Return a row for each element and flow, and the lines that answer for it, in the order of the graph.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> rows = answered_by_globs(spread(graph, bound, hierarchy), bound, hierarchy)
    >>> [(row.element.name, row.categories, *map(str, row.places)) for row in rows]
    [('/faces', ('FaceTemplate', 'Video'), 'labels.yaml:5')]
    """
    vertices = {vertex for vertex, said in bound.elements.items() if any(map(_unseen, said))}
    flows = {index for index, said in bound.flows.items() if any(map(_unseen, said))}
    if not vertices and not flows:
        return ()
    ends: dict[int, int] = defaultdict(int)
    for closure in closures(spread):
        if closure.to < 0:
            ends[closure.vertex] |= closure.bits
    elements = spread.graph.elements
    rows: dict[tuple[Element, Element | None, tuple[Place, ...]], set[str]] = defaultdict(set)
    first: dict[tuple[str, str, str], Element] = {}
    decided = _Decided(hierarchy)
    for vertex in sorted(vertices):
        element = first.setdefault(elements[vertex].identity, elements[vertex])
        makes = {made for fact in spread.facts[vertex].values() for made in fact.derives}  # who makes it knows of it
        for category in spread.names(spread.present(vertex) | ends[vertex] | _taken_back(spread, vertex)):
            said = bound.elements[vertex]
            if spread.named.get(vertex, 0) & spread.both(category):
                said = tuple(s for s in said if s.by_name or not closes(s, category, hierarchy))
            if places := decided.by(said, category, known=category in makes):
                rows[element, None, places].add(category)
    for index in sorted(flows):
        flow = spread.graph.flows[index]
        for category in spread.names(spread.sent.get(flow.source, 0) | spread.flow_emits.get(index, 0)):
            if places := decided.by(bound.flows[index], category, known=True):
                source, target = (
                    first.setdefault(elements[v].identity, elements[v]) for v in (flow.source, flow.target)
                )
                rows[source, target, places].add(category)
    return tuple(ByGlobs(one, to, tuple(sorted(kinds)), places) for (one, to, places), kinds in rows.items())


def _unseen(statement: Statement) -> bool:
    """Whether a user's file without pins says by a glob what a person has to have seen."""
    return statement.to_be_seen and statement.rank[0] > STANDARD and statement.pinned is None


def _taken_back(spread: Spread, vertex: int) -> int:
    """The bits of what it would bring in, if a glob did not take the source away."""
    lost = (c for c, fact in spread.facts[vertex].items() if any(s.role == "source" for s, _ in fact.outdone))
    return sum(map(spread.both, lost))


class _Decided:
    """What globs decide, each set of statements once: globs say the same of many elements."""

    def __init__(self, hierarchy: Hierarchy) -> None:
        self._hierarchy = hierarchy
        self._known: dict[tuple[tuple[int, ...], str, bool], tuple[Place, ...]] = {}

    def by(self, said: Sequence[Statement], category: str, *, known: bool) -> tuple[Place, ...]:
        """The lines of globs that answer for a category; none where all would be the same without them.

        Parameters
        ----------
        known
            Whether it is no question there, whatever labels say.
        """
        key = tuple(map(id, said)), category, known
        if key not in self._known:
            self._known[key] = self._by(said, category, known=known)
        return self._known[key]

    def _by(self, said: Sequence[Statement], category: str, *, known: bool) -> tuple[Place, ...]:
        without = tuple(s._replace(pinned=()) if _unseen(s) else s for s in said)
        now, then = (_does(facts("", some, category, self._hierarchy), known=known) for some in (said, without))
        if now == then:
            return ()
        globs = [s for s in said if _unseen(s)]
        holding = facts("", said, category, self._hierarchy).accepted
        return _places([s for s in globs if s in holding] or globs)


def _does(fact: Facts, *, known: bool) -> tuple[object, ...]:
    """What an element does with a category, whatever the lines that say so."""
    through = fact.through if fact.emits else ()
    flows = (fact.emits, through, fact.passes, fact.pseudonymises, fact.derives, fact.method)
    return (*flows, fact.leaks, known or fact.covered)


def _places(globs: Iterable[Statement]) -> tuple[Place, ...]:
    return tuple(dict.fromkeys(s.place for s in sorted(globs, key=by_line)))
