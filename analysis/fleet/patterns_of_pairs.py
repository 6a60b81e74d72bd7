"""Pairs of a fleet -> patterns, before any path is looked for: counted in arrays, one pair of each chosen to be shown.

In: the pairs of the kernel, and which robot stands for which. Out: for ``analyse``, the findings to make; for the
report, patterns and robots that differ. The same as ``patterns.py`` makes of all findings; a test holds this.

A fleet of n robots that a cloud joins has n² pairs of each pattern, so none of them is an object: a block of them is a
table, of which sums and the first in each row are taken. What is kept grows with the robots.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.fleet.patterns import Count, FleetView, Form, Pair, Tallies
from rosprivacy.analysis.fleet.source_leak_pairs import DISMISSED, NO_PAIR, PSEUDONYMISED, blocks

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.source_leak_pairs import Block, Forms
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element

    Indices = NDArray[np.int64]

FORMS = (0, PSEUDONYMISED, DISMISSED, DISMISSED | PSEUDONYMISED)  # of ``Block.forms``, that which stands most first
WantedPairs = dict[int, set[tuple[str, int, int, bool]]]  # source -> as ``Chosen`` of the findings


class _Table:
    """Elements of a graph as numbers: their robot, and what they are alike to."""

    def __init__(self, elements: Sequence[Element], likeness: Likeness) -> None:
        self._likeness = likeness
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

    def across(self, source: int, leak: int) -> bool:
        """Return whether a pair goes from robot to robot."""
        a, b = self.robot[source], self.robot[leak]
        return bool(self.is_robot[a] and self.is_robot[b] and a != b)  # as ``Likeness.apart``

    def count(self, source: int, leak: int) -> int:
        """Return for how many findings of the fleet a pair stands."""
        return self._likeness.between(self.names[self.robot[source]], self.names[self.robot[leak]])


@dataclass(slots=True)
class _Pattern:
    """What differs only in the robot: the pair that is shown of it, what is counted, and robots by form.

    Attributes
    ----------
    first
        (form, source, leak) of the pair that is shown.
    counts
        Findings of the fleet, by form.
    begins, ends
        (form, robots) where findings of that form begin, and where they end.
    pairs
        All, as long as they are no more than what is made; ``None`` after that.
    from_robot, to_robot
        Robot -> (form, source, leak) of the pair that is made of those that begin or end there.
    """

    across: bool
    first: tuple[int, int, int] = (NO_PAIR, 0, 0)
    counts: list[int] = field(default_factory=lambda: [0] * len(FORMS))
    begins: list[tuple[int, Indices]] = field(default_factory=list)
    ends: list[tuple[int, Indices]] = field(default_factory=list)
    pairs: list[tuple[Indices, Indices]] | None = field(default_factory=list)
    from_robot: dict[int, tuple[int, int, int]] = field(default_factory=dict)
    to_robot: dict[int, tuple[int, int, int]] = field(default_factory=dict)

    def robots(self, rows: list[tuple[int, Indices]]) -> dict[int, Indices]:
        """Return the robots of ``begins`` or ``ends`` by form, each once."""
        return {
            form: np.unique(np.concatenate([robots for some, robots in rows if some == form]))
            for form in sorted({form for form, _ in rows})
        }


class _Patterns:
    """The patterns of one kind and category, as blocks of their pairs are added.

    Parameters
    ----------
    most_across
        As of ``Groups``; without it only ``first`` of each pattern is kept.
    """

    def __init__(self, table: _Table, most_across: int | None = None) -> None:
        self._table, self._most_across = table, most_across
        self.by_key: dict[tuple[int, int, bool], _Pattern] = {}

    def add(self, block: Block) -> None:
        """Add pairs; blocks come in the order of their sources."""
        forms, table = block.forms.copy(), self._table
        for row, column in self._within(block):
            if forms[row, column] != NO_PAIR:
                leak, source = int(block.leaks[row]), int(block.sources[column])
                if count := table.count(source, leak):
                    one = forms[row : row + 1, column : column + 1]
                    ends = block.sources[[column]], block.leaks[[row]]
                    self._add(one, *ends, across=table.across(source, leak), count=count)
                forms[row, column] = NO_PAIR
        # What is left goes between two robots, or to or from what is shared: a second robot stands for nothing there.
        rows = np.flatnonzero(~table.is_second[table.robot[block.leaks]])
        columns = np.flatnonzero(~table.is_second[table.robot[block.sources]])
        rows = rows[np.argsort(table.alike[block.leaks[rows]], kind="stable")]
        columns = columns[np.argsort(table.alike[block.sources[columns]], kind="stable")]
        if not len(rows) or not len(columns):
            return
        forms = forms[np.ix_(rows, columns)]
        sources, leaks = block.sources[columns], block.leaks[rows]
        down, right = _starts(table.alike[leaks]), _starts(table.alike[sources])
        there = np.logical_or.reduceat(np.logical_or.reduceat(forms != NO_PAIR, down, axis=0), right, axis=1)
        down, right = np.append(down, len(rows)), np.append(right, len(columns))
        for y, x in zip(*(some.tolist() for some in np.nonzero(there)), strict=True):
            below, beside = slice(down[y], down[y + 1]), slice(right[x], right[x + 1])
            robots = table.robot[[sources[right[x]], leaks[down[y]]]]
            self._add(forms[below, beside], sources[beside], leaks[below], across=bool(table.is_robot[robots].all()))

    def _within(self, block: Block) -> Iterator[tuple[int, int]]:
        """(row, column) of the pairs on one robot, or from a robot to that which stands for others like it."""
        table = self._table
        owners = table.first[table.robot[block.leaks]]
        order = np.argsort(owners, kind="stable")
        homes = table.robot[block.sources]
        starts, ends = (np.searchsorted(owners[order], homes, side=side) for side in ("left", "right"))
        for column, (start, end) in enumerate(zip(starts.tolist(), ends.tolist(), strict=True)):
            for row in order[start:end].tolist():
                yield row, column

    def _add(self, forms: Forms, sources: Indices, leaks: Indices, *, across: bool, count: int | None = None) -> None:
        """Add pairs of one pattern.

        Parameters
        ----------
        count
            Of a single pair, where it is not that of the weights of its robots.
        """
        table = self._table
        key = int(table.alike[sources[0]]), int(table.alike[leaks[0]]), across
        pattern = self.by_key.setdefault(key, _Pattern(across))
        from_robots, to_robots = table.robot[sources], table.first[table.robot[leaks]]
        weights = table.weight[from_robots], table.weight[to_robots]
        for form in FORMS:
            some = forms == form
            from_some = some.any(axis=0)
            if from_some.any():
                counted = int(weights[1] @ (some @ weights[0])) if count is None else count
                pattern.counts[form] += counted
                pattern.begins.append((form, from_robots[from_some]))
                pattern.ends.append((form, to_robots[some.any(axis=1)]))
        least = forms.min(axis=0)
        column = int(least.argmin())
        shown = int(least[column]), int(sources[column]), int(leaks[forms[:, column].argmin()])
        pattern.first = min(pattern.first, shown)
        if self._most_across is not None:
            self._make(pattern, forms, sources, leaks)

    def _make(self, pattern: _Pattern, forms: Forms, sources: Indices, leaks: Indices) -> None:
        """Note the pairs that may be made."""
        if pattern.pairs is not None:
            rows, columns = np.nonzero(forms != NO_PAIR)
            pattern.pairs.append((sources[columns], leaks[rows]))
            if pattern.across and sum(pattern.counts) > (self._most_across or 0):
                pattern.pairs = None
        if pattern.across:
            table = self._table
            for column, row in enumerate(forms.argmin(axis=0).tolist()):
                _keep(pattern.from_robot, int(table.robot[sources[column]]), forms, (row, column), sources, leaks)
            for row, column in enumerate(forms.argmin(axis=1).tolist()):
                robot = int(table.first[table.robot[leaks[row]]])
                _keep(pattern.to_robot, robot, forms, (row, column), sources, leaks)

    def chosen(self, pattern: _Pattern) -> Iterator[tuple[int, int]]:
        """Return source and leak of each finding to make."""
        yield pattern.first[1:]
        if self._most_across is not None and pattern.pairs is not None:
            for sources, leaks in pattern.pairs:
                yield from zip(sources.tolist(), leaks.tolist(), strict=True)
        elif self._most_across is not None:
            for _, source, leak in (*pattern.from_robot.values(), *pattern.to_robot.values()):
                yield source, leak


def _starts(values: Indices) -> Indices:
    """Where runs of equal values begin."""
    return np.flatnonzero(np.diff(values, prepend=-1))


def _keep(
    pairs: dict[int, tuple[int, int, int]],
    robot: int,
    forms: Forms,
    at: tuple[int, int],
    sources: Indices,
    leaks: Indices,
) -> None:
    """Keep of a robot the pair that stands most."""
    form = int(forms[at])
    if form != NO_PAIR:
        pair = form, int(sources[at[1]]), int(leaks[at[0]])
        pairs[robot] = min(pair, pairs.get(robot, pair))


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
        patterns: dict[tuple[str, int, bool], _Patterns] = {}
        for block in blocks(spread, kinds, mask):
            for some, plain_also in _with_plain(block):
                key = block.kind, block.category, plain_also
                patterns.setdefault(key, _Patterns(table, self._most_across)).add(some)
        wanted: WantedPairs = defaultdict(set)
        for (kind, category, plain_also), group in patterns.items():
            for pattern in group.by_key.values():
                self._tally(spread, (kind, category, plain_also), pattern, table)
                for source, leak in group.chosen(pattern):
                    wanted[source].add((kind, leak, category, plain_also))
        return dict(wanted)

    def _tally(self, spread: Spread, concern: tuple[str, int, bool], pattern: _Pattern, table: _Table) -> None:
        """Count the findings of a pattern, and note on which robots they begin and end."""
        (kind, category, plain_also), elements = concern, spread.graph.elements
        form, source, leak = pattern.first
        begins, ends = pattern.robots(pattern.begins), pattern.robots(pattern.ends)
        where = begins if table.is_robot[table.robot[source]] else ends
        _, hidden, dismissed, both = pattern.counts
        key = self._tallies.add(
            Pair(kind, spread.categories[category], elements[source], elements[leak], plain_also),
            _form(form),
            Count(sum(pattern.counts), dismissed + both, 0, hidden + both),
            sorted({table.names[robot] for robots in where.values() for robot in robots.tolist()}),
        )
        for some in FORMS:
            here, there = (
                [table.names[robot] for robot in rows[some].tolist()] if some in rows else [] for rows in (begins, ends)
            )
            self._tallies.share(key, here, there, _form(some), across=pattern.across)

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
        elements = spread.graph.elements
        table = _Table(elements, self._likeness)
        wanted = defaultdict(set, Groups(self._likeness)(spread, kinds, mask))
        left: dict[tuple[str, int, bool], list[Indices]] = defaultdict(list)
        for block in blocks(self._under, kinds, mask):
            for some, plain_also in _with_plain(block):
                left[block.kind, block.category, plain_also].append(_numbers(some)[some.forms != NO_PAIR])
        numbers = {key: np.concatenate(some) for key, some in left.items()}
        gone: dict[tuple[str, int, bool], _Patterns] = {}
        for block in blocks(spread, kinds, mask):
            for some, plain_also in _with_plain(block):
                key = block.kind, block.category, plain_also
                there = np.isin(_numbers(some), numbers[key]) if key in numbers else False
                forms = np.where(there, np.uint8(NO_PAIR), some.forms)
                gone.setdefault(key, _Patterns(table)).add(replace(some, forms=forms))
        for (kind, category, plain_also), patterns in gone.items():
            for _, source, leak in (pattern.first for pattern in patterns.by_key.values()):
                wanted[source].add((kind, leak, category, plain_also))
                name = spread.categories[category]
                self._closed_pairs.add((kind, name, elements[source], elements[leak], plain_also))
        return dict(wanted)

    def of(self, findings: Iterable[Finding]) -> tuple[Finding, ...]:
        """Return those of the findings that are closed, one of each pattern."""
        return tuple(f for f in findings if (f.kind, f.category, f.source, f.leak, f.plain_also) in self._closed_pairs)


def _numbers(block: Block) -> Indices:
    """A number for each pair: shape (m, n)."""
    numbers: Indices = block.leaks[:, None] << np.int64(32) | block.sources
    return numbers


def _with_plain(block: Block) -> Iterator[tuple[Block, bool]]:
    """The pairs of a block; and the findings of data as it is that stand beside pseudonymised ones (rule S10)."""
    yield block, False
    if block.plain_also.any():
        forms = np.where(block.plain_also, np.uint8(DISMISSED), np.uint8(NO_PAIR))
        yield replace(block, forms=forms), True


def _form(form: int) -> Form:
    return Form(bool(form & DISMISSED), False, bool(form & PSEUDONYMISED))
