"""Pairs of a fleet -> patterns, before any path is looked for: counted in arrays, one pair of each chosen to be shown.

In: the pairs of the kernel, and which robot stands for which. Out: for ``analyse``, the findings to make; for the
report, patterns and robots that differ. The same as ``patterns.py`` makes of all findings; a test holds this.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.fleet.patterns import FleetView
from rosprivacy.analysis.fleet.source_leak_pairs import pairs
from rosprivacy.analysis.fleet.tallies import Count, Form, Pair, Share, Tallies

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.source_leak_pairs import Pairs
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element

    Indices = NDArray[np.int64]
    Flags = NDArray[np.bool_]

WantedPairs = dict[int, set[tuple[str, int, int, bool]]]  # source -> as ``Chosen`` of the findings


class _Table:
    """Elements of a graph as numbers: their robot, and what they are alike to."""

    def __init__(self, elements: Sequence[Element], likeness: Likeness) -> None:
        self.names = sorted({element.robot for element in elements})
        number = {name: i for i, name in enumerate(self.names)}
        self.robot = np.array([number[element.robot] for element in elements], np.int64)
        self.is_robot = np.array([likeness.is_robot(name) for name in self.names], bool)
        self.is_second = np.array([name in likeness.second for name in self.names], bool)
        self.first = np.array([number[likeness.second.get(name, name)] for name in self.names], np.int64)
        self.weight = np.array([likeness.weight(name) for name in self.names], np.int64)
        shown = {name: "" if likeness.is_robot(name) else name for name in self.names}  # as ``Likeness.alike``
        alike = [(e.kind, e.name, shown[e.robot], e.leg, e.side, e.without) for e in elements]
        kinds = {kind: number for number, kind in enumerate(dict.fromkeys(alike))}
        self.alike = np.array([kinds[kind] for kind in alike], np.int64)
        self.kinds = len(kinds)

    def patterns(self, sources: Indices, leaks: Indices) -> Indices:
        """What pairs have in common that differ only in the robot."""
        a, b = self.robot[sources], self.robot[leaks]
        across = self.is_robot[a] & self.is_robot[b] & (a != b)
        keys: Indices = (self.alike[sources] * self.kinds + self.alike[leaks]) * 2 + across
        return keys

    def counts(self, a: Indices, b: Indices) -> Indices:
        """For how many findings of the fleet a pair of robots stands, as ``Likeness.count``."""
        to_second = self.is_second[b]
        to_other = np.where(a == b, 1, self.weight[b])
        many = self.weight[a] * np.where(to_second, self.weight[a] - 1, to_other)
        return np.where(self.is_second[a] | (to_second & (self.first[b] != a)), 0, many)


class Groups:
    """Puts the pairs of a fleet together.

    Call it with a spread, the kinds of findings and the bits of the categories that the answer is about; it returns
    the findings to make: one of each pattern. Then ``view`` gives the rest.

    Parameters
    ----------
    most_across
        With it, all findings are made; but of a pattern with more that go from robot to robot only one for each robot
        where they begin, and one for each where they end, of those that stand most.
    """

    def __init__(self, likeness: Likeness, most_across: int | None = None) -> None:
        self._likeness, self._most_across = likeness, most_across
        self._tallies = Tallies(likeness)

    def __call__(self, spread: Spread, kinds: Sequence[Concern], mask: int) -> WantedPairs:
        """Return the findings to make."""
        table = _Table(spread.graph.elements, self._likeness)
        wanted: WantedPairs = defaultdict(set)
        for part in pairs(spread, kinds, mask):
            for some, beside in _with_plain(part):
                for source, leak in self._take(spread, some, table, plain_also=beside):
                    wanted[source].add((part.kind, leak, part.category, beside))
        return dict(wanted)

    def _take(self, spread: Spread, part: Pairs, table: _Table, *, plain_also: bool) -> Iterator[tuple[int, int]]:
        """Group the pairs of one kind and category; return those to make."""
        counts = table.counts(table.robot[part.sources], table.robot[part.leaks])
        chosen = np.flatnonzero(counts)
        sources, leaks, counts = part.sources[chosen], part.leaks[chosen], counts[chosen]
        if not len(chosen):
            return
        hidden, dismissed = part.pseudonymised[chosen], part.dismissed[chosen]
        a, b = table.robot[sources], table.robot[leaks]
        across = table.is_robot[a] & table.is_robot[b] & (a != b)
        keys = table.patterns(sources, leaks)
        order = np.lexsort((np.arange(len(keys)), hidden, dismissed, keys))
        ids: dict[int, str] = {}
        starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
        ends = [*starts[1:].tolist(), len(order)]
        elements, category = spread.graph.elements, spread.categories[part.category]
        for start, end in zip(starts.tolist(), ends, strict=True):
            rows = order[start:end]
            source, leak = int(sources[rows[0]]), int(leaks[rows[0]])
            pair = Pair(part.kind, category, elements[source], elements[leak], plain_also)
            form = Form(bool(dismissed[rows[0]]), False, bool(hidden[rows[0]]))
            some = counts[rows]
            count = Count(int(some.sum()), int(some[dismissed[rows]].sum()), 0, int(some[hidden[rows]].sum()))
            where = np.unique(np.where(table.is_robot[a[rows]], a[rows], table.first[b[rows]]))
            ids[int(keys[rows[0]])] = self._tallies.add(pair, form, count, [table.names[i] for i in where.tolist()])
            yield source, leak
            if self._most_across is not None:
                if across[rows[0]] and count.all > self._most_across:
                    firsts = [np.unique(robots[rows], return_index=True)[1] for robots in (a, table.first[b])]
                    rows = rows[np.concatenate(firsts)]
                yield from zip(sources[rows].tolist(), leaks[rows].tolist(), strict=True)
        no = np.zeros(len(keys), bool)
        for robots_at, ends_here in ((a, no), (table.first[b], across)):
            rows = np.unique(np.column_stack([robots_at, keys, ends_here, dismissed, hidden]), axis=0)
            for robot, pattern, *flags in rows.tolist():
                self._tallies.shares[table.names[robot]].add(Share(ids[pattern], *map(bool, flags)))

    def view(self, analysis: Analysis) -> FleetView:
        """Return patterns and deviants, when the findings are made."""
        return FleetView.counted(self._tallies, analysis, self._likeness)


class Closed:
    """Chooses, beside what ``Groups`` chooses, one pair of each pattern that is closed on some robot (rule S15).

    Call it in place of ``Groups`` with the spread without limits of types; then ``of`` says which findings are closed.

    Parameters
    ----------
    under
        The spread under limits of types, of the same graph.
    """

    def __init__(self, likeness: Likeness, under: Spread) -> None:
        self._likeness, self._under = likeness, under
        self._closed_pairs: set[tuple[str, str, Element, Element, bool]] = set()

    def __call__(self, spread: Spread, kinds: Sequence[Concern], mask: int) -> WantedPairs:
        """Return the findings to make."""
        elements, size = spread.graph.elements, len(spread.graph.elements)
        table = _Table(elements, self._likeness)
        wanted = defaultdict(set, Groups(self._likeness)(spread, kinds, mask))
        left = {
            (part.kind, part.category, beside): some.sources * size + some.leaks
            for part in pairs(self._under, kinds, mask)
            for some, beside in _with_plain(part)
        }
        for part in pairs(spread, kinds, mask):
            for some, beside in _with_plain(part):
                there = left.get((part.kind, part.category, beside), np.zeros(0, np.int64))
                gone = np.flatnonzero(~np.isin(some.sources * size + some.leaks, there))
                for source, leak in _first_of_each(some, gone, table):
                    wanted[source].add((part.kind, leak, part.category, beside))
                    category = spread.categories[part.category]
                    self._closed_pairs.add((part.kind, category, elements[source], elements[leak], beside))
        return dict(wanted)

    def of(self, findings: Iterable[Finding]) -> tuple[Finding, ...]:
        """Return those of the findings that are closed, one of each pattern."""
        return tuple(f for f in findings if (f.kind, f.category, f.source, f.leak, f.plain_also) in self._closed_pairs)


def _first_of_each(part: Pairs, chosen: Indices, table: _Table) -> Iterator[tuple[int, int]]:
    """Of some pairs one of each pattern: as ``Groups`` chooses the one that is shown."""
    sources, leaks = part.sources[chosen], part.leaks[chosen]
    counted = np.flatnonzero(table.counts(table.robot[sources], table.robot[leaks]))
    chosen, sources, leaks = chosen[counted], sources[counted], leaks[counted]
    keys = table.patterns(sources, leaks)
    order = np.lexsort((np.arange(len(keys)), part.pseudonymised[chosen], part.dismissed[chosen], keys))
    first = order[np.flatnonzero(np.diff(keys[order], prepend=-1))]
    return zip(sources[first].tolist(), leaks[first].tolist(), strict=True)


def _with_plain(part: Pairs) -> tuple[tuple[Pairs, bool], ...]:
    """The pairs of a kind and category, and those that stand beside them."""
    return (part, False), (_plain_beside(part), True)


def _plain_beside(part: Pairs) -> Pairs:
    """The findings of data as it is that stand beside pseudonymised ones: pairs of their own, dismissed (rule S10)."""
    at = np.flatnonzero(part.plain_also)
    no = np.zeros(len(at), bool)
    return replace(
        part, sources=part.sources[at], leaks=part.leaks[at], pseudonymised=no, dismissed=~no, plain_also=no
    )  # fmt: skip
