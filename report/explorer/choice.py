"""Which elements of a system matter, seen from one of them: few enough to be read, however large the system is.

In: a ``Joined``, the element in hand, the kinds of data that are shown. Out: a ``Choice``: the shortest path to that
element, paths to leaks, what it is joined to. Where nothing is in hand and nothing leaks, it is where data goes first.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import islice, pairwise
from typing import TYPE_CHECKING

from rosprivacy.report.pictures.views import core

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.findings.witness import Witness
    from rosprivacy.report.explorer.joined import Joined
    from rosprivacy.report.pictures.picture import Key

OF_PATHS = 18  # boxes that paths to leaks may take; the first one takes what it needs
OTHER_PATHS = 2  # to the element in hand, beside the shortest: of other kinds of data
LOOKED_AT, BEHIND = 200, 40  # neighbours, and what lies behind them, before channels with the same ends become one


@dataclass(frozen=True, slots=True)
class Choice:
    """What matters.

    Attributes
    ----------
    focus
        The element in hand; None for none.
    paths
        To the element in hand, the shortest first.
    findings
        Of which the shortest paths are drawn.
    left
        How many findings are not drawn.
    near
        What the element is joined to, what counts more first; nothing of it is on a path.
    """

    focus: Key | None
    paths: Sequence[Witness]
    findings: Sequence[Finding]
    left: int
    near: Sequence[Key]

    @property
    def core(self) -> set[Key]:
        """What is in hand or on a path: none of it is left out."""
        return _on(self.focus, self.paths) | core(self.findings)

    def steps(self) -> dict[tuple[Key, Key], int]:
        """Return the steps of the paths to the element in hand; those of the shortest are numbered, others are 0."""
        steps: dict[tuple[Key, Key], int] = {}
        for path in self.paths:
            for number, ends in enumerate(pairwise(element.identity for element in path.elements), 1):
                steps.setdefault(ends, number if path is self.paths[0] else 0)
        return steps


def choose(joined: Joined, focus: Key | None, wanted: Sequence[str], most: int, way: Witness | None = None) -> Choice:
    """Return what matters, seen from an element.

    Parameters
    ----------
    wanted
        Names of the emitted categories that are shown.
    most
        Boxes.
    way
        A path to the element that is in hand itself; None for the shortest ones.
    """
    asked = [kind for one in joined.analysis.open if one.element.identity == focus for kind in one.categories]
    kinds = [kind for kind in wanted if kind in asked] or wanted
    paths = [way] if way else joined.paths(focus, kinds)[: 1 + OTHER_PATHS] if focus else []
    every = [finding for finding in joined.analysis.findings if not finding.dismissed and finding.category in wanted]
    every.sort(key=lambda finding: (not finding.stands, focus not in core([finding]), len(finding.steps)))
    taken = _on(focus, paths)
    findings: list[Finding] = []
    for finding in every:
        more = taken | core([finding])
        if not findings or len(more) <= min(OF_PATHS, most):
            findings.append(finding)
            taken = more
    near = _near(joined, focus, wanted) if focus else () if findings else _first(joined, wanted, most)
    others = [key for key in dict.fromkeys(near) if key not in taken]
    return Choice(focus, paths, findings, len(every) - len(findings), others[:LOOKED_AT])


def _on(focus: Key | None, paths: Iterable[Witness]) -> set[Key]:
    return {element.identity for path in paths for element in path.elements} | ({focus} if focus else set())


def _near(joined: Joined, focus: Key, wanted: Iterable[str]) -> Iterator[Key]:
    """What an element sends to, what sends to it, and who has that then; where no data gets, all it is joined to."""
    bits = sum(map(joined.analysis.spread.both, wanted))
    after, before = joined.after(focus, bits), joined.before(focus, bits)
    if not after and not before:
        yield from joined.beside(focus)
    yield from after
    yield from before
    behind = (there for key in after for there in joined.after(key, bits))
    yield from islice(behind, max(0, BEHIND - len(after) - len(before)))


def _first(joined: Joined, wanted: Iterable[str], most: int) -> Collection[Key]:
    """The sources, and where their data goes first."""
    spread, elements = joined.analysis.spread, joined.analysis.graph.elements
    bits = sum(map(spread.both, wanted))
    found = dict.fromkeys(elements[v].identity for v in sorted(spread.facts) if spread.begins(v) & bits)
    waiting = deque(found)
    while waiting and len(found) < most:
        new = [key for key in joined.after(waiting.popleft(), bits) if key not in found]
        found.update(dict.fromkeys(new))
        waiting.extend(new)
    return found
