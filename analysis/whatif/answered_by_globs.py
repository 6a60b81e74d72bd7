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
    at = [v for v, said in sorted(bound.elements.items()) if answers.answers_alone(spread.facts[v], said)]
    along = [
        index for index, said in sorted(bound.flows.items()) if answers.answers_alone(spread.flow_facts[index], said)
    ]
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
        named = spread.channel_sources.get(vertex, 0)
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
    return sum(map(spread.forms_of, lost))


class _Answers:
    """What globs answer for, once for all elements of which the same is said: these share what is decided."""

    def __init__(self, spread: Spread, hierarchy: Hierarchy) -> None:
        self._spread, self._hierarchy = spread, hierarchy
        self._questioned: dict[int, bool] = {}
        self._answers: dict[tuple[int, int, int], Mapping[tuple[Place, ...], set[str]]] = {}

    def answers_alone(self, decided: Mapping[str, Facts], statements: Sequence[Statement]) -> bool:
        """Whether a glob says there what nobody need have seen."""
        if id(decided) not in self._questioned:
            self._questioned[id(decided)] = any(map(_unseen, statements))
        return self._questioned[id(decided)]

    def of(
        self,
        decided: Mapping[str, Facts],
        statements: Sequence[Statement],
        bits: int,
        named_bits: int = 0,
        *,
        flow: bool = False,
    ) -> Mapping[tuple[Place, ...], set[str]]:
        """Lines of globs -> the kinds of what is there for which they answer.

        Parameters
        ----------
        named_bits
            Bits for which sources name a channel: there no glob takes anything away (rule S7).
        flow
            Whether it is one: nobody is asked to review it.
        """
        key = id(decided), bits, named_bits
        if key not in self._answers:
            by_places: dict[tuple[Place, ...], set[str]] = defaultdict(set)
            makes = {made for fact in decided.values() for made in fact.derives}  # who makes it knows of it
            for category in self._spread.names(bits):
                holding = statements
                if named_bits & self._spread.forms_of(category):
                    holding = [s for s in statements if s.by_name or not closes(s, category, self._hierarchy)]
                if places := self._by(holding, category, is_covered=flow or category in makes):
                    by_places[places].add(category)
            self._answers[key] = by_places
        return self._answers[key]

    def _by(self, holding: Sequence[Statement], category: str, *, is_covered: bool) -> tuple[Place, ...]:
        """The lines of globs without which something else would be done with a category; none if nothing would."""
        without = [s._replace(pinned=()) if _unseen(s) else s for s in holding]
        now, then = (facts("", statements, category, self._hierarchy) for statements in (holding, without))
        if _does(now, is_covered=is_covered) == _does(then, is_covered=is_covered):
            return ()
        globs = [s for s in holding if _unseen(s)]
        lines = sorted([s for s in globs if s in now.accepted] or globs, key=by_line)
        return tuple(dict.fromkeys(s.place for s in lines))


def _does(fact: Facts, *, is_covered: bool) -> tuple[object, ...]:
    """What an element does with a category, whatever the lines that say so."""
    through = fact.through if fact.emits else ()
    flows = (fact.emits, through, fact.passes, fact.pseudonymises, fact.derives, fact.method)
    return (*flows, fact.leaks, is_covered or fact.covered)
