"""In which order open elements are worth a person's time: where data comes from, what stands behind each (rule S11).

In: an ``Analysis``. Out: ``Behind`` facts. What only one element lets data get to is what a label there can close, by
immediate dominators of the flows that carry data. A channel past which data gets to no open element and no leak can
wait.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.dominators import immediate_dominators

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element

START = -1  # before all sources
MOST = 200_000  # flows with data; of more it is not worked out what stands behind an element
Shown = tuple[str, str, str, str]
Following = dict[int, list[int]]


@dataclass(frozen=True, slots=True)
class Behind:
    """What a person wants to know of an open element before looking at it.

    Attributes
    ----------
    through
        The element that the data comes from: most kinds of it, and of several such the nearest to a source; None where
        it begins.
    closes, leaks
        How many other open elements, and how many leaks, data gets to past this one only, at least.
    waits
        Whether it is a channel from which data gets to no other open element but channels, to no leak, and to nothing
        else that a finding ends at.
    """

    through: Element | None = None
    closes: int = 0
    leaks: int = 0
    waits: bool = False


def review_order(analysis: Analysis) -> dict[Shown, Behind]:
    """Return what stands behind each open element, by what a reader sees of it.

    Notes
    -----
    Immediate dominators, on the flows that carry data.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> {name: (behind.closes, behind.leaks) for (_, _, name, _), behind in review_order(analyse(*factory())).items()}
    {'/video': (1, 1), '/filtered': (0, 0)}
    """
    if not analysis.open:
        return {}
    spread = analysis.spread
    elements = spread.graph.elements
    kinds = {q.categories: spread.bits.merged(sum(map(spread.both, q.categories))) for q in analysis.open}
    asked = {q.element.shown_as: kinds[q.categories] for q in analysis.open}
    along = [spread.along(index) for index in range(len(spread.graph.flows))]
    following: Following = defaultdict(list)
    for index, flow in enumerate(spread.graph.flows):
        if along[index]:
            following[flow.source].append(flow.target)
    following[START] = [vertex for vertex in range(len(elements)) if spread.begins(vertex)]
    reached = _reached(following)
    open_at = dict.fromkeys(vertex for vertex in reached if elements[vertex].shown_as in asked)
    through = _through(spread, along, {vertex: asked[elements[vertex].shown_as] for vertex in open_at}, reached)
    leaks = {vertex for vertex, bits in spread.leaks.items() if bits & spread.present(vertex)}
    ends = {finding.leak for finding in analysis.findings}  # storages and third countries too (rule S10)
    wanted = leaks.union(v for v in reached if elements[v] in ends or (v in open_at and not elements[v].is_channel))
    going_on = _reaching(following, wanted)
    below = _below(following, {elements[v].shown_as: v for v in reversed(open_at)}.values(), leaks)
    result: dict[Shown, Behind] = {}
    for vertex in open_at:
        element = elements[vertex]
        closes, leaking = below.get(vertex, (0, 0))
        comes_from = elements[through[vertex]] if vertex in through else None
        one = Behind(comes_from, closes, leaking, waits=element.is_channel and vertex not in going_on)
        other = result.get(element.shown_as)  # the other side of a wildcard
        result[element.shown_as] = one if other is None else _both(one, other)
    return result


def _both(one: Behind, other: Behind) -> Behind:
    first = max(one, other, key=lambda side: (side.leaks, side.closes))
    return Behind(one.through or other.through, first.closes, first.leaks, waits=one.waits and other.waits)


def _reached(following: Following) -> list[int]:
    """Every vertex that data gets to, the nearest to a source first."""
    reached = dict.fromkeys(sorted(following[START]))
    waiting = deque(reached)
    while waiting:
        new = [there for there in sorted(following.get(waiting.popleft(), ())) if there not in reached]
        reached.update(dict.fromkeys(new))
        waiting += new
    return list(reached)


def _through(spread: Spread, along: Sequence[int], asked: Mapping[int, int], reached: Iterable[int]) -> dict[int, int]:
    """Open vertex -> the vertex from which most of the kinds that are open there come along a flow."""
    order = {vertex: place for place, vertex in enumerate(reached)}
    best: dict[int, tuple[int, int, int]] = {}
    for index, flow in enumerate(spread.graph.flows):
        bits = spread.bits.merged(along[index]) & asked.get(flow.target, 0)
        if bits:
            one = (-bits.bit_count(), order[flow.source], flow.source)
            best[flow.target] = min(one, best.get(flow.target, one))
    return {vertex: source for vertex, (_, _, source) in best.items()}


def _reaching(following: Following, wanted: Iterable[int]) -> set[int]:
    """The vertices from which data gets to one of some."""
    entering: Following = defaultdict(list)
    for here, targets in following.items():
        for there in targets:
            entering[there].append(here)
    seen = set(wanted)
    waiting = deque(seen)
    while waiting:
        for here in entering.get(waiting.popleft(), ()):
            if here not in seen:
                seen.add(here)
                waiting.append(here)
    return seen


def _below(following: Following, questions: Iterable[int], leaks: Iterable[int]) -> Mapping[int, tuple[int, int]]:
    """Vertex -> how many of the questions, and of the leaks, data gets to past it only; without itself."""
    if not 0 < sum(map(len, following.values())) <= MOST:
        return {}
    parents = immediate_dominators(following, START)
    asked, leaking = set(questions), set(leaks)
    below: dict[int, tuple[int, int]] = defaultdict(lambda: (0, 0))
    for vertex in asked | leaking:
        above = parents.get(vertex, START)
        while above != START:
            closes, ends = below[above]
            below[above] = (closes + (vertex in asked), ends + (vertex in leaking))
            above = parents[above]
    return below
