"""What changes break: which elements get less than before, and which may no longer read or write a channel.

In: two analyses, without the changes and with them. Out: ``Affected``, in the order of the graph.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Element

Shown = tuple[str, str, str, str]  # robot, kind, name and leg, as a reader sees them


@dataclass(frozen=True, slots=True)
class Affected:
    """An element that gets less than before.

    Attributes
    ----------
    filtered
        (where from, categories that no longer come from there), sorted; what else comes from there still does.
    unread, unwritten
        What it may no longer read from or write to, sorted.
    narrowed
        Wildcards that no longer give it all names that they gave, sorted.
    """

    element: Element
    filtered: tuple[tuple[Shown, tuple[str, ...]], ...] = ()
    unread: tuple[Shown, ...] = ()
    unwritten: tuple[Shown, ...] = ()
    narrowed: tuple[Shown, ...] = ()


@dataclass(slots=True)
class _ReadAndWritten:
    """What one element reads and writes."""

    reads: dict[Shown, set[str]]
    writes: set[Shown]
    without: dict[Shown, set[str]]

    @classmethod
    def empty(cls) -> _ReadAndWritten:
        return cls(defaultdict(set), set(), defaultdict(set))


def affected(before: Analysis, after: Analysis) -> tuple[Affected, ...]:
    """Return who gets less after than before; O(flows).

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> denied = replace(graph, flows=graph.flows[:7] + graph.flows[8:])  # /video -> /face_id
    >>> less = affected(analyse(graph, bound, hierarchy), analyse(denied, bound, hierarchy))
    >>> [(one.element.name, [name for _, _, name, _ in one.unread], bool(one.filtered)) for one in less]
    [('/archive', [], True), ('/face_id', ['/video'], False), ('disk', [], True)]
    """
    was, becomes = _rights(before), _rights(after)
    rows = []
    for element in sorted(was, key=lambda e: e.sort_key()):
        old, new = was[element], becomes.get(element, _ReadAndWritten.empty())
        lost = {at: names - new.reads[at] for at, names in old.reads.items() if at in new.reads}
        less = Affected(
            element,
            tuple(sorted((at, tuple(sorted(names))) for at, names in lost.items() if names)),
            tuple(sorted(old.reads.keys() - new.reads.keys())),
            tuple(sorted(old.writes - new.writes)),
            tuple(sorted(at for at, names in new.without.items() if at in old.without and names - old.without[at])),
        )
        if less != Affected(element):
            rows.append(less)
    return tuple(rows)


def _rights(analysis: Analysis) -> dict[Element, _ReadAndWritten]:
    graph, spread = analysis.graph, analysis.spread
    rights: dict[Element, _ReadAndWritten] = defaultdict(_ReadAndWritten.empty)
    for index, flow in enumerate(graph.flows):
        source, target = graph.elements[flow.source], graph.elements[flow.target]
        for reads, mine, other in ((True, target, source), (False, source, target)):
            if mine.is_channel or (flow.target if reads else flow.source) in spread.absent:
                continue
            if reads:
                rights[mine].reads[other.shown_as].update(spread.names(spread.along(index)))
            else:
                rights[mine].writes.add(other.shown_as)
            if other.pattern:
                rights[mine].without[other.shown_as].update(other.without)
    return dict(rights)
