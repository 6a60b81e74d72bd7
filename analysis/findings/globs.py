"""What each glob of a user's label files decides and closes, and which of them decides too much to go unseen.

In: an ``Analysis`` with its labels and its ledger. Out: ``GlobUse`` rows, for what is assumed. A person who writes a
glob sees one line; what it answers for can be most of a system.

Source: rules S7, S11 and S12: what is taken away is told, by name, with how much hangs on it.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.findings.closures import ABSENT
from rosprivacy.analysis.findings.ledger import REVIEW
from rosprivacy.analysis.model import STANDARD

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.ledger import TakenAway
    from rosprivacy.analysis.model import Bound, Element, Place, Statement

HALF, LAST = "half", "last-path"
WATCHED = frozenset({"mundane", "conduit", "sanitizer"})  # what one word too much turns into a wrong 'nothing found'
CLOSERS = frozenset({"mundane", "only", "never", "sanitizer", ABSENT})
Identity = tuple[str, str, str]


@dataclass(frozen=True, slots=True)
class GlobUse:
    """What one line of labels does that names elements by a glob.

    Attributes
    ----------
    says
        The roles that it gives, sorted.
    elements
        How many elements it decides: it is about them, and no label of higher rank says otherwise.
    closed, reviewed
        At how many of them data ends for it; how many are not asked about for it.
    leak, open
        A leak, and an open element, behind what it closes; None where there is none.
    warning
        ``HALF`` if it closes, or answers for, more than half of the nodes or of the channels that data gets to;
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


def globs(
    analysis: Analysis, bound: Bound, taken: Iterable[TakenAway], beside: Collection[str] = ()
) -> tuple[GlobUse, ...]:
    """Return a row for each line of a user's label files that names elements by a glob, in the order of the lines.

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
    says, decides = _decided(analysis, bound, beside)
    rows: dict[Place, list[TakenAway]] = defaultdict(list)
    for row in taken:
        if row.glob and row.to is None and (row.by in CLOSERS or row.by == REVIEW):
            for place in row.places:
                rows[place].append(row)
    reached = _reached(analysis)
    return tuple(
        _use(place, tuple(sorted(says[place])), decides[place], rows[place], reached, analysis.verdict)
        for place in sorted(says, key=lambda place: (place.file, place.line))
    )


def _decided(
    analysis: Analysis, bound: Bound, beside: Collection[str]
) -> tuple[dict[Place, set[str]], dict[Place, set[Identity]]]:
    """What each line says, and the elements at which it holds; where nothing is emitted, those that it covers."""
    spread = analysis.spread
    says: dict[Place, set[str]] = defaultdict(set)
    decides: dict[Place, set[Identity]] = defaultdict(set)
    for vertex, said in bound.elements.items():
        mine = [statement for statement in said if _of_a_user(statement)]
        if not mine or spread.graph.elements[vertex].robot in beside:
            continue
        accepted = {s for fact in spread.facts.get(vertex, {}).values() for s in fact.accepted}
        for statement in mine:
            says[statement.place].add(statement.role)
            if statement in accepted or not spread.categories:
                decides[statement.place].add(spread.graph.elements[vertex].identity)
    return says, decides


def _of_a_user(statement: Statement) -> bool:
    return statement.glob and statement.rank[0] > STANDARD


def _reached(analysis: Analysis) -> dict[bool, int]:
    """How many channels, and how many other elements, data gets to; whether it goes on or not."""
    spread = analysis.spread
    there = {spread.graph.elements[vertex] for vertex in {*spread.arrives, *spread.leaves}}
    return {channel: len({e.identity for e in there if e.is_channel == channel}) for channel in (True, False)}


def _use(
    place: Place, says: tuple[str, ...], decides: set[Identity], rows: list[TakenAway], reached: dict[bool, int],
    verdict: Verdict,
) -> GlobUse:  # fmt: skip
    closed = {row.element for row in rows if row.element and row.by in CLOSERS}
    reviewed = {row.element for row in rows if row.element and row.by == REVIEW}
    warning = ""
    if WATCHED.intersection(says):
        halves = (
            2 * len({e.identity for e in closed | reviewed if e.is_channel == channel}) > number > 1
            for channel, number in reached.items()
        )
        last = verdict is Verdict.NO_LEAK_FOUND and any(row.closes or row.itself for row in rows)
        warning = LAST if last else HALF if any(halves) else ""
    return GlobUse(
        place,
        says,
        len(decides),
        len({element.identity for element in closed}),
        len({element.identity for element in reviewed}),
        next((row.leak for row in rows if row.leak), None),
        next((row.open for row in rows if row.open), None),
        warning,
    )
