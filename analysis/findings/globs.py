"""What each glob of a user's label files decides and closes, and on which of them the verdict hangs.

In: an ``Analysis`` with its labels and its ledger. Out: ``GlobUse`` rows, for what is assumed. A person who writes a
glob sees one line; what it answers for can be most of a system.

Source: rules S7, S11 and S12: what is taken away is told, by name, with how much hangs on it.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.findings.closures import ABSENT
from rosprivacy.analysis.findings.ledger import REVIEW
from rosprivacy.analysis.model import STANDARD

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.ledger import TakenAway
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, FlowGraph, Place, Statement

LAST = "last-path"
WATCHED = frozenset({"mundane", "conduit", "sanitizer"})  # what one word too much turns into a wrong 'nothing found'
CLOSERS = frozenset({"mundane", "only", "never", "sanitizer", ABSENT})
Identity = tuple[str, str, str]
Ends = tuple[Identity, Identity]


class GlobUse(NamedTuple):
    """What one line of labels does that names elements, or the ends of flows, by a glob.

    Attributes
    ----------
    says
        The roles that it gives, sorted.
    elements
        How many elements it decides: it is about them, and no label of higher rank says otherwise.
    closed, reviewed
        At how many of them data ends for it; how many are not asked about for it.
    flows, flows_closed
        How many flows between two elements it decides, and along how many data ends for it.
    leak, open
        A leak, and an open element, behind what it closes; None where there is none.
    warning
        ``LAST`` if without it the answer would not be that no leak was found; else empty.
    """

    place: Place
    says: tuple[str, ...]
    elements: int
    closed: int
    reviewed: int
    leak: Element | None = None
    open: Element | None = None
    warning: str = ""
    flows: int = 0
    flows_closed: int = 0


def globs(
    analysis: Analysis, bound: Bound, taken: Iterable[TakenAway], beside: Collection[str] = ()
) -> tuple[GlobUse, ...]:
    """Return a row for each line of a user's label files that names by a glob, in the order of the lines.

    Parameters
    ----------
    taken
        The ledger.
    beside
        Robots that are not counted: another one stands for them.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.findings.ledger import ledger
    >>> graph, bound, hierarchy = factory()
    >>> analysis = analyse(graph, bound, hierarchy)
    >>> uses = globs(analysis, bound, ledger(analysis, bound, hierarchy))
    >>> [(str(use.place), use.says, use.elements, use.closed, use.leak.name) for use in uses]
    [('labels.yaml:5', ('only',), 1, 1, '/archive')]
    """
    decided = _decided(analysis, bound, beside)
    if not decided:
        return ()
    rows: dict[Place, list[TakenAway]] = defaultdict(list)
    for row in taken:
        if row.glob and (row.by in CLOSERS or row.by == REVIEW):
            for place in row.places:
                rows[place].append(row)
    return tuple(
        _use(place, decided[place], rows[place], analysis.verdict)
        for place in sorted(decided, key=lambda place: (place.file, place.line))
    )


@dataclass(frozen=True, slots=True)
class _Decided:
    """What one line says, and the elements and flows at which it holds; all that it covers where nothing is emitted."""

    says: set[str] = field(default_factory=set)
    elements: set[Identity] = field(default_factory=set)
    flows: set[Ends] = field(default_factory=set)


def _decided(analysis: Analysis, bound: Bound, beside: Collection[str]) -> dict[Place, _Decided]:
    spread = analysis.spread
    lines: dict[Place, _Decided] = defaultdict(_Decided)
    for vertex, said in bound.elements.items():
        element = spread.graph.elements[vertex]
        if element.robot in beside:
            continue
        for statement, holds in _stated(said, spread.facts.get(vertex, {}), spread):
            lines[statement.place].says.add(statement.role)
            lines[statement.place].elements.update([element.identity] if holds else ())
    for index, said in bound.flows.items():
        source, target = _ends(spread.graph, index)
        if source.robot in beside:
            continue
        for statement, holds in _stated(said, spread.flow_facts.get(index, {}), spread):
            lines[statement.place].says.add(statement.role)
            lines[statement.place].flows.update([(source.identity, target.identity)] if holds else ())
    return lines


def _stated(said: Iterable[Statement], facts: Mapping[str, Facts], spread: Spread) -> Iterator[tuple[Statement, bool]]:
    """What globs of a user say of an element or a flow, and whether it holds there."""
    for statement in filter(_of_a_user, said):
        holds = any(statement.line in fact.accepted for fact in facts.values())
        yield statement, holds or not spread.categories


def _ends(graph: FlowGraph, index: int) -> tuple[Element, Element]:
    flow = graph.flows[index]
    return graph.elements[flow.source], graph.elements[flow.target]


def _of_a_user(statement: Statement) -> bool:
    return statement.glob and statement.rank[0] > STANDARD


def _use(place: Place, decided: _Decided, rows: list[TakenAway], verdict: Verdict) -> GlobUse:
    at = [row for row in rows if row.element and not row.to]
    closed = {row.element for row in at if row.element and row.by in CLOSERS}
    reviewed = {row.element for row in at if row.element and row.by == REVIEW}
    flows = {(row.element.identity, row.to.identity) for row in rows if row.element and row.to}
    watched = decided.flows or WATCHED.intersection(decided.says)
    last = watched and verdict is Verdict.NO_LEAK_FOUND and any(row.closes or row.itself for row in rows)
    return GlobUse(
        place,
        tuple(sorted(decided.says)),
        len(decided.elements),
        len({element.identity for element in closed}),
        len({element.identity for element in reviewed}),
        next((row.leak for row in rows if row.leak), None),
        next((row.open for row in rows if row.open), None),
        LAST if last else "",
        len(decided.flows),
        len(flows),
    )
