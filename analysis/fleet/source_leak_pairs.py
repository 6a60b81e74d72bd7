"""Which sources reach which leaks, for all sources at once: the kernel with one bit per source (rules S8, S10).

In: a spread, and where each kind of finding can be. Out: pairs, as arrays. A word has 64 bits, so one pass of the
kernel does 64 sources of a category; where the category is made of others, or pseudonymised on the path, a source takes
a bit for each form in which its data can be. No path is looked for: that is done for the pairs that are shown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rosprivacy.analysis.findings.concerns import shown_arrivals
from rosprivacy.analysis.kernel.arrays import GraphArrays, as_bits
from rosprivacy.analysis.kernel.fixpoint import WORD, fixpoint
from rosprivacy.analysis.model import DISCLOSURE

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.kernel.bits import CategoryBits
    from rosprivacy.analysis.kernel.spread import Spread

    Indices = NDArray[np.int64]
    Bits = NDArray[np.uint64]
    Flags = NDArray[np.bool_]
    Forms = NDArray[np.uint8]

PLAIN, PSEUDONYMISED, DISMISSED, NO_PAIR = 0, 1, 2, 4  # of ``Block.forms``; dismissed and pseudonymised is 3
MOST_WORDS = 16  # in one run of the kernel, which then folds channels once for all of them
MOST_BITS = 2**28  # of all vertices in one run: 32 MB for each of the few arrays that a run takes


@dataclass(frozen=True, slots=True)
class Pairs:
    """The pairs of one kind and category: what a finding is without its path.

    Attributes
    ----------
    category
        Its number.
    sources, leaks
        Vertices, shape (n,), sorted by source and leak.
    pseudonymised, dismissed
        Shape (n,).
    plain_also
        Whether data as it is arrives there, too, through another leak only: a finding of its own, dismissed.
    """

    kind: str
    category: int
    sources: Indices
    leaks: Indices
    pseudonymised: Flags
    dismissed: Flags
    plain_also: Flags


@dataclass(frozen=True, slots=True)
class Block:
    """The pairs of one kind and category that begin at some of the sources, as a table of sources and leaks.

    Attributes
    ----------
    category
        Its number.
    sources, leaks
        Vertices, shape (n,) and (m,), sorted. Every block of a kind and category has the same leaks.
    forms
        Shape (m, n): how the finding stands (``DISMISSED`` and ``PSEUDONYMISED`` added up), the least first; or
        ``NO_PAIR``.
    plain_also
        Shape (m, n): whether data as it is arrives there, too, through another leak only.
    """

    kind: str
    category: int
    sources: Indices
    leaks: Indices
    forms: Forms
    plain_also: Flags


def pairs(spread: Spread, kinds: Sequence[Concern], mask: int) -> Iterator[Pairs]:
    """Return all pairs, by category and kind: ``blocks`` put together, which grows with the square of a fleet.

    Examples
    --------
    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> from rosprivacy.analysis.findings.concerns import concerns
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> carried = spread(graph, bound, hierarchy)
    >>> rows = pairs(carried, tuple(concerns(carried, bound, hierarchy)), carried.all_bits)
    >>> [(carried.categories[row.category], NAMES[row.leaks[0]], bool(row.pseudonymised[0])) for row in rows][1:3]
    [('FaceTemplate', 'disk', False), ('Video', '/archive', True)]
    """
    by_kind: dict[tuple[int, str], list[Block]] = {}
    for block in blocks(spread, kinds, mask):
        by_kind.setdefault((block.category, block.kind), []).append(block)
    for (category, kind), parts in by_kind.items():
        columns = [np.concatenate(column) for column in zip(*map(_columns, parts), strict=True)]
        if len(columns[0]):
            yield Pairs(kind, category, *columns)


def _columns(block: Block) -> tuple[Indices, Indices, Flags, Flags, Flags]:
    """The pairs of a block, sorted by source and leak."""
    source, leak = np.nonzero((block.forms != NO_PAIR).T)
    forms = block.forms[leak, source]
    hidden, dismissed = (forms & PSEUDONYMISED).astype(bool), (forms & DISMISSED).astype(bool)
    return block.sources[source], block.leaks[leak], hidden, dismissed, block.plain_also[leak, source]


def blocks(spread: Spread, kinds: Sequence[Concern], mask: int) -> Iterator[Block]:
    """Return all pairs, by category, some sources at a time: what is held at once does not grow with the sources.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.

    Notes
    -----
    Two runs of the kernel per category and so many sources: one that stops at leaks of the category, one that does not.
    So many are ``MOST_WORDS`` times 64 for each form, fewer in a large graph.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.concerns import concerns
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> carried = spread(graph, bound, hierarchy)
    >>> some = list(blocks(carried, tuple(concerns(carried, bound, hierarchy)), carried.all_bits))
    >>> [(block.kind, block.forms.tolist()) for block in some][:2]  # of face templates
    [('disclosure', [[0]]), ('storage-limitation', [[0]])]
    """
    ends = [as_bits(spread, len(spread.graph.elements), concern.taken_up(spread), 0) for concern in kinds]
    network: GraphArrays | None = None
    for i, _ in enumerate(spread.categories):
        leaks = [np.flatnonzero(_has(bits, spread.bits.plain(i))) for bits in ends]
        if not mask & spread.bits.pair(i) or not any(len(some) for some in leaks):
            continue
        network = network or GraphArrays.of(spread)
        yield from _blocks_of(spread, network, i, kinds, leaks)


def _has(bits: Bits, bit: int) -> Flags:
    """Whether a bit is set, by row."""
    flags: Flags = (bits[:, bit // WORD] >> np.uint64(bit % WORD) & np.uint64(1)).astype(bool)
    return flags


def forms(category: int, bits: CategoryBits, steps: Collection[tuple[int, int]]) -> tuple[int, ...]:
    """Return the forms in which data can be on the path to a category: bits of the spread, sorted.

    Parameters
    ----------
    category
        Its number.
    steps
        (bit that arrives, bit that leaves for it), wherever data is made into other data.

    Examples
    --------
    >>> from rosprivacy.analysis.kernel.bits import CategoryBits
    >>> bits = CategoryBits(2)  # 0: face templates, 1: video
    >>> forms(0, bits, {(1, 0)})  # templates are made of video
    (0, 1)
    """
    back = _closure(set(bits.forms(category)), {(after, before) for before, after in steps})
    ahead = _closure(
        {form for form in back if not bits.is_pseudonymised(form)}, steps
    )  # a form that nothing turns into is none
    return tuple(sorted(back & ahead))


class CategoryRun:
    """One category: from whom it can come, and in which forms its data can be on the path.

    Sources are followed by number: bit ``n * at + number`` of n sources is the form at place ``at`` of this one.

    Parameters
    ----------
    forms
        Of ``forms``, for all of the graph, or for all of what the graph is a part of.

    Attributes
    ----------
    sources
        Vertices that bring it in, in any of its forms; sorted.
    """

    def __init__(self, spread: Spread, network: GraphArrays, category: int, forms: tuple[int, ...]) -> None:
        self._network = network
        self._forms_of_category = spread.bits.forms(category)
        self._forms = forms
        both = sum(1 << form for form in forms)
        self.sources = np.array(sorted(v for v in spread.facts if spread.begins(v) & both), np.int64)
        self._is_leak = _has(as_bits(spread, len(network.keep), spread.leaks, 0), self._forms_of_category[0])
        self._passes = {form: _has(network.keep, form) for form in forms}
        self._derivations = network.derivations[np.isin(network.derivations[:, 1:], forms).all(axis=1)]
        self._begins = {source: spread.begins(source) for source in self.sources.tolist()}
        flows: dict[int, list[int]] = {vertex: [] for vertex in self.sources.tolist()}
        for number, index in enumerate(network.special):
            source = spread.graph.flows[index].source
            if source in flows and spread.flow_emits.get(index, 0) & both:
                flows[source].append(network.count + number)
        self._flows = flows

    def at_once(self) -> int:
        """Return how many sources one run of the kernel takes."""
        words = max(1, min(MOST_WORDS, MOST_BITS // WORD // len(self._network.keep)))
        return max(1, words * WORD // len(self._forms))

    def nothing(self, n: int) -> Bits:
        """Return that none of n sources emits anything anywhere: shape (vertices, words)."""
        return np.zeros((len(self._network.keep), -(-n * len(self._forms) // WORD)), np.uint64, order="F")

    def begun(self, sources: Indices, numbers: Indices, n: int) -> Bits:
        """Return what sources emit, each under its number."""
        emitted = self.nothing(n)
        for at, form in enumerate(self._forms):
            begins = _has(self._network.emitted, form)
            for source, number in zip(sources.tolist(), numbers.tolist(), strict=True):
                word, place = divmod(n * at + number, WORD)
                starts = [vertex for vertex in (source, *self._flows[source]) if begins[vertex]]
                emitted[starts, word] |= np.uint64(1 << place)
        return emitted

    def carried(self, emitted: Bits, n: int, *, stop: bool) -> tuple[Bits, Bits]:
        """Return what arrives at and what leaves each vertex; ``stop`` lets nothing pass a leak of the category."""
        keep = self.nothing(n)
        for at, form in enumerate(self._forms):
            passes = self._passes[form]
            if stop and form in self._forms_of_category:
                passes = passes & ~self._is_leak
            for word, bits in _split(((1 << n) - 1) << n * at):
                np.bitwise_or(keep[:, word], bits, out=keep[:, word], where=passes)
        return fixpoint(self._network.edges, emitted, keep, self._derived(n, stop=stop)[0])

    def arriving(self, arrives: Bits, leaves: Bits, at: Indices, n: int, *, stop: bool) -> tuple[Flags, Flags]:
        """(as it is, pseudonymised): shape (len(at), n), which data gets to some vertices.

        Parameters
        ----------
        at
            Sorted; with ``stop`` all leaks of the category are among them.
        """
        there = arrives[at] | leaves[at]
        vertices, before, after = self._derived(n, stop=stop)[1].T  # what is made at a leak ends there, but gets there
        fired = arrives[vertices, before // WORD] >> (before % WORD).astype(np.uint64) & np.uint64(1)
        rows = np.searchsorted(at, vertices)
        np.bitwise_or.at(there, (rows, after // WORD), fired << (after % WORD).astype(np.uint64))
        return self._at(there, 0, n), self._at(there, 1, n)

    def brought(
        self, arriving: tuple[Flags, Flags], at: Indices, sources: Indices, numbers: Indices
    ) -> tuple[Flags, Flags]:
        """The same with what sources bring in themselves, also if it leaves along single flows only."""
        rows = {vertex: row for row, vertex in enumerate(at.tolist())}
        for source, number in zip(sources.tolist(), numbers.tolist(), strict=True):
            if source in rows:
                for flags, form in zip(arriving, self._forms_of_category, strict=True):
                    flags[rows[source], number] |= bool(self._begins[source] >> form & 1)
        return arriving

    def _derived(self, n: int, *, stop: bool) -> tuple[Indices, Indices]:
        """Derivations for each source: those that go on, and those that stop at a leak once they are made."""
        rows = self._derivations
        made = np.zeros(len(rows), bool)
        if stop:
            at_leak = self._is_leak[rows[:, 0]]
            rows = rows[~(at_leak & np.isin(rows[:, 1], self._forms_of_category))]
            made = self._is_leak[rows[:, 0]] & np.isin(rows[:, 2], self._forms_of_category)
        place = np.searchsorted(self._forms, rows[:, 1:]) * n
        number = np.tile(np.arange(n), len(rows))[:, None]
        each = np.column_stack([np.repeat(rows[:, 0], n), np.repeat(place, n, axis=0) + number]).astype(np.int64)
        ends = np.repeat(made, n)
        return each[~ends], each[ends]

    def _at(self, arriving: Bits, plane: int, n: int) -> Flags:
        if self._forms_of_category[plane] not in self._forms:
            return np.zeros((len(arriving), n), bool)
        return unpacked(arriving, n * self._forms.index(self._forms_of_category[plane]), n)


def unpacked(rows: Bits, first: int, n: int) -> Flags:
    """Return n bits of each row, from one on: shape (rows, n).

    >>> unpacked(np.array([[0b1010], [0b0110]], np.uint64), 1, 3).astype(int).tolist()
    [[1, 0, 1], [1, 1, 0]]
    """
    low = first // WORD
    some = np.ascontiguousarray(rows[:, low : -(-(first + n) // WORD)], "<u8")  # the lowest byte of a word first
    bits = np.unpackbits(some.view(np.uint8), axis=1, bitorder="little")
    return bits[:, first - low * WORD : first - low * WORD + n].astype(bool)


def _blocks_of(
    spread: Spread, network: GraphArrays, number: int, kinds: Sequence[Concern], leaks: Sequence[Indices]
) -> Iterator[Block]:
    """The pairs of each kind, of one category."""
    steps = {(before, after) for pairs in spread.derives.values() for before, after in pairs}
    category = CategoryRun(spread, network, number, forms(number, spread.bits, steps))
    disclosed = next(number for number, concern in enumerate(kinds) if concern.kind == DISCLOSURE)
    everywhere = np.unique(np.concatenate(leaks))
    for start in range(0, len(category.sources), category.at_once()):
        sources = category.sources[start : start + category.at_once()]
        through = _reached(category, sources, everywhere, stop=False)
        free = _reached(category, sources, leaks[disclosed], stop=True) if len(leaks[disclosed]) else through
        for at, concern in enumerate(kinds):
            if len(leaks[at]):
                reached = (free, through) if concern.kind == DISCLOSURE else (through, through)
                yield Block(concern.kind, number, sources, leaks[at], *_as_shown(leaks[at], *reached))


def _reached(category: CategoryRun, sources: Indices, leaks: Indices, *, stop: bool) -> tuple[Flags, Flags, Indices]:
    """(as it is, pseudonymised): shape (leaks, sources), whether data is there; and the leaks."""
    numbers, n = np.arange(len(sources)), len(sources)
    arrives, leaves = category.carried(category.begun(sources, numbers, n), n, stop=stop)
    there = category.arriving(arrives, leaves, leaks, n, stop=stop)
    return *category.brought(there, leaks, sources, numbers), leaks


def _split(bits: int) -> Iterator[tuple[int, np.uint64]]:
    """A number of any length -> (number of the word, word), where there is something in it."""
    word = 0
    while bits:
        if part := bits & ((1 << WORD) - 1):
            yield word, np.uint64(part)
        bits >>= WORD
        word += 1


def _closure(start: set[int], steps: Collection[tuple[int, int]]) -> set[int]:
    """What can be got to by some steps."""
    closed: set[int] = set()
    new = start
    while new:
        closed |= new
        new = {after for before, after in steps if before in new} - closed
    return closed


def _as_shown(
    leaks: Indices, free: tuple[Flags, Flags, Indices], through: tuple[Flags, Flags, Indices]
) -> tuple[Forms, Flags]:
    """The forms and ``plain_also`` of a block, as findings would be shown."""
    there = [_of(reached, plane, leaks) for reached in (free, through) for plane in (0, 1)]
    plain, hidden, plain_through, hidden_through = shown_arrivals(*there)
    shown = np.full(plain.shape, NO_PAIR, np.uint8)
    shown[plain_through] = DISMISSED  # beside what is pseudonymised, that stands: it comes last
    shown[hidden_through] = DISMISSED | PSEUDONYMISED
    shown[plain] = PLAIN
    shown[hidden] = PSEUDONYMISED
    return shown, hidden & plain_through


def _of(reached: tuple[Flags, Flags, Indices], plane: int, leaks: Indices) -> Flags:
    flags: Flags = (reached[0], reached[1])[plane]
    return flags[np.searchsorted(reached[2], leaks)]
