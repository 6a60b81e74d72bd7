"""Elements and flows that only globs of a user answer for: nobody need have seen that this data gets there (rule S11).

In: a spread and its labels. Out: ``ByGlobs``. It is what ``labels --pin`` keeps in label files, and without pins a
doubt. A glob answers for a kind where, without all that globs take away or call reviewed, the element would do
something else with it, or be open. What is pinned has been seen, and is not here.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import ByGlobs
from rosprivacy.analysis.findings.closures import closures
from rosprivacy.analysis.kernel.ranks import by_line, closes
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.model import STANDARD

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, Place, Statement


def answered_by_globs(spread: Spread, bound: Bound, hierarchy: Hierarchy) -> tuple[ByGlobs, ...]:
    """Return a row for each element and flow, and the lines that answer for it, in the order of the graph.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> rows = answered_by_globs(spread(graph, bound, hierarchy), bound, hierarchy)
    >>> [(row.element.name, row.categories, *map(str, row.places)) for row in rows]
    [('/faces', ('FaceTemplate', 'Video'), 'labels.yaml:5')]
    """
    answers = _Answers(spread, hierarchy)
    at = [v for v, said in sorted(bound.elements.items()) if answers.asked(spread.facts[v], said)]
    along = [index for index, said in sorted(bound.flows.items()) if answers.asked(spread.flow_facts[index], said)]
    if not at and not along:
        return ()
    ends: dict[int, int] = defaultdict(int)
    for closure in closures(spread) if at else ():
        if closure.to < 0:
            ends[closure.vertex] |= closure.bits
    elements = spread.graph.elements
    rows: dict[tuple[Element, Element | None, tuple[Place, ...]], set[str]] = defaultdict(set)
    first: dict[tuple[str, str, str], Element] = {}  # the legs and sides of a channel are one
    for vertex in at:
        here = spread.present(vertex) | ends[vertex] | _taken_back(spread, vertex)
        named = spread.named.get(vertex, 0)
        for places, kinds in answers.of(spread.facts[vertex], bound.elements[vertex], here, named).items():
            rows[first.setdefault(elements[vertex].identity, elements[vertex]), None, places].update(kinds)
    for index in along:
        flow = spread.graph.flows[index]
        sent = spread.sent.get(flow.source, 0) | spread.flow_emits.get(index, 0)
        source, target = (first.setdefault(elements[v].identity, elements[v]) for v in (flow.source, flow.target))
        for places, kinds in answers.of(spread.flow_facts[index], bound.flows[index], sent, flow=True).items():
            rows[source, target, places].update(kinds)
    return tuple(ByGlobs(at, to, tuple(sorted(kinds)), places) for (at, to, places), kinds in rows.items())


def _unseen(statement: Statement) -> bool:
    """Whether a user's file without pins says by a glob what a person has to have seen."""
    return statement.rank[0] > STANDARD and statement.pinned is None and statement.to_be_seen


def _taken_back(spread: Spread, vertex: int) -> int:
    """The bits of what it would bring in, if a glob did not take the source away."""
    lost = (c for c, fact in spread.facts[vertex].items() if any(s.role == "source" for s, _ in fact.outdone))
    return sum(map(spread.both, lost))


class _Answers:
    """What globs answer for, once for all elements of which the same is said: these share what is decided."""

    def __init__(self, spread: Spread, hierarchy: Hierarchy) -> None:
        self._spread, self._hierarchy = spread, hierarchy
        self._asked: dict[int, bool] = {}
        self._known: dict[tuple[int, int, int], Mapping[tuple[Place, ...], set[str]]] = {}

    def asked(self, decided: Mapping[str, Facts], said: Sequence[Statement]) -> bool:
        """Whether a glob says there what nobody need have seen."""
        if id(decided) not in self._asked:
            self._asked[id(decided)] = any(map(_unseen, said))
        return self._asked[id(decided)]

    def of(
        self, decided: Mapping[str, Facts], said: Sequence[Statement], here: int, named: int = 0, *, flow: bool = False
    ) -> Mapping[tuple[Place, ...], set[str]]:
        """Lines of globs -> the kinds of what is there for which they answer.

        Parameters
        ----------
        named
            Bits for which sources name a channel: there no glob takes anything away (rule S7).
        flow
            Whether it is one: nobody is asked to review it.
        """
        key = id(decided), here, named
        if key not in self._known:
            by_places: dict[tuple[Place, ...], set[str]] = defaultdict(set)
            makes = {made for fact in decided.values() for made in fact.derives}  # who makes it knows of it
            for category in self._spread.names(here):
                holding = said
                if named & self._spread.both(category):
                    holding = [s for s in said if s.by_name or not closes(s, category, self._hierarchy)]
                if places := self._by(holding, category, known=flow or category in makes):
                    by_places[places].add(category)
            self._known[key] = by_places
        return self._known[key]

    def _by(self, said: Sequence[Statement], category: str, *, known: bool) -> tuple[Place, ...]:
        """The lines of globs without which something else would be done with a category; none if nothing would."""
        without = [s._replace(pinned=()) if _unseen(s) else s for s in said]
        now, then = (facts("", statements, category, self._hierarchy) for statements in (said, without))
        if _does(now, known=known) == _does(then, known=known):
            return ()
        globs = [s for s in said if _unseen(s)]
        lines = sorted([s for s in globs if s in now.accepted] or globs, key=by_line)
        return tuple(dict.fromkeys(s.place for s in lines))


def _does(fact: Facts, *, known: bool) -> tuple[object, ...]:
    """What an element does with a category, whatever the lines that say so."""
    through = fact.through if fact.emits else ()
    flows = (fact.emits, through, fact.passes, fact.pseudonymises, fact.derives, fact.method)
    return (*flows, fact.leaks, known or fact.covered)
