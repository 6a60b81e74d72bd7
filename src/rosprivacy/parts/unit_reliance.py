"""What hangs on the statements of one unit of a fleet, as far as it can be seen there: what gets how to its border.

In: a unit with its graph, and what is at the border today. Out: ``Summary`` facts: of the unit as it is, and of it
without each statement that takes data or a question away. With these of all units ``fleet_reliance.py`` says what
there would be in the whole fleet. Transfer takes unions apart (rule S8), so it is enough to know what each single bit
does that comes in at one place of the border.

The core is one more unit, seen from the other side: data comes in at its gates, and leaves it where it comes into the
others.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.kernel.bits import bits_of
from rosprivacy.analysis.kernel.lanes import Doing
from rosprivacy.analysis.kernel.spreading import fill, meaning
from rosprivacy.analysis.non_ros import on_day, unanswered
from rosprivacy.analysis.whatif.reach import PlacesOfFindings, Reach, Run, runs_of
from rosprivacy.analysis.whatif.spots import spots
from rosprivacy.parts.units import GATE, HUB, crossing_lines, naming_lines, units_piece

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.lanes import Flood
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, Statement
    from rosprivacy.analysis.whatif.spots import Identity, Spots
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.parts.crossings import Crossings, Exits, Passes
    from rosprivacy.parts.units import Border, Lines, Piece
    from rosprivacy.parts.workers import Built

    FindingKey = tuple[str, int, Element, Element]  # kind, number of the category, source, leak


class Arriving(NamedTuple):
    """Of data of a category at a leak: whether it is there, past no other leak of the category, as it is."""

    present: bool = False
    stands: bool = False
    plain: bool = False

    def joined(self, other: Arriving) -> Arriving:
        """Return what there is of both."""
        return Arriving(*(a or b for a, b in zip(self, other, strict=True)))

    def worse(self, before: Arriving) -> bool:
        """Return whether there is a finding that was none, or was dismissed, or had nothing as it is in it."""
        return self.present and any(now and not then for now, then in zip(self, before, strict=True))


NOT_THERE = Arriving()


class Entries(NamedTuple):
    """What has to come in for data to be at a leak; the same for past no other leak, and as it is."""

    present: Crossings = 0
    stands: Crossings = 0
    plain: Crossings = 0

    def arriving(self, coming: Crossings, past_no_leak: Crossings) -> Arriving:
        """Return what gets there of what comes in."""
        return Arriving(bool(self.present & coming), bool(self.stands & past_no_leak), bool(self.plain & coming))


@dataclass(frozen=True, slots=True)
class Summary:
    """A unit in one state of its labels.

    Attributes
    ----------
    exits
        Source -> where its data gets out, in each run; the first is past whatever leaks there are.
    passes
        In each run: one crossing that comes in -> where it gets out.
    entries
        (kind, number of the category, leak) -> what has to come in.
    pairs
        What gets from a source of the unit to a leak of it without leaving it.
    questions
        (element, number of the category) that is not open today -> what has to come in for it to be; the last
        crossing, which always comes in, stands for the unit's own sources.
    """

    exits: Mapping[Element, Exits]
    passes: Passes
    entries: Mapping[tuple[str, int, Element], Entries]
    pairs: Mapping[FindingKey, Arriving]
    questions: Mapping[tuple[Element, int], Crossings]


@dataclass(frozen=True, slots=True)
class Without:
    """A unit without one statement.

    Attributes
    ----------
    with_data
        The elements where it is said, as far as data is there today.
    elements
        All of these.
    flows
        The ends of the flows of which it is said; a hub where they come from other units.
    reached
        Whether data is at any of them, or a source is named there.
    refused
        Why the labels contradict each other without it; else empty.
    summary
        None where nothing changes.
    """

    identity: Identity
    with_data: tuple[Element, ...]
    elements: tuple[Element, ...]
    flows: tuple[tuple[Element, Element], ...]
    reached: bool
    refused: str
    summary: Summary | None


@dataclass(frozen=True, slots=True)
class UnitReliance:
    """A unit as it is, and without each statement."""

    unit: str
    summary: Summary
    without: tuple[Without, ...]


@dataclass(frozen=True, slots=True)
class RelianceQuestion:
    """What all units have to know.

    Attributes
    ----------
    categories
        That have bits.
    mask
        Bits of those that the answer is about.
    made_categories
        Numbers of the categories that others are made into, by any derivation of the fleet.
    arriving
        What comes in today, from the side that a unit sees: what leaves the border.
    hub_names
        Hub -> the name of the elements whose data it takes on, where all have one.
    width
        How many bits the spread has.
    """

    categories: tuple[str, ...]
    hierarchy: Hierarchy
    mask: int
    made_categories: frozenset[int]
    arriving: Crossings
    hub_names: Mapping[Element, str]
    width: int

    @property
    def run_of(self) -> dict[int, int]:
        """Number of a category -> the run in which nothing passes its leaks; the first run is past whatever leaks."""
        unmade = [i for i, _ in enumerate(self.categories) if i not in self.made_categories]
        after = 2 if unmade else 1
        return {
            **dict.fromkeys(unmade, 1),
            **{i: after + number for number, i in enumerate(sorted(self.made_categories))},
        }

    def always(self, border: int) -> Crossings:
        """Return the crossing that stands for a unit's own sources, of so many elements of the border."""
        return 1 << border * self.width


def units_reliance(
    part: Built, fleet: Fleet, at: Border, view: str, today: str, question: RelianceQuestion
) -> list[UnitReliance]:
    """Return what hangs on the statements of each unit of a part."""
    answers = []
    for name, placed in zip(part.names, part.units, strict=True):
        piece = units_piece(fleet, (placed,), at, view)
        piece = replace(piece, bound=replace(piece.bound, outside=on_day(piece.bound.outside, today)))
        spread = meaning(piece.graph, piece.bound, question.hierarchy, question.categories)
        answers.append(_Unit(piece, spread, question, piece.border).answer(name))
    return answers


@dataclass(frozen=True, slots=True)
class HubSources:
    """What a part has to say before: the elements that hubs stand for, and the categories that derivations make."""

    hubs: Mapping[Lines, tuple[Element, ...]]
    made_categories: frozenset[str]


def hub_sources(part: Built, fleet: Fleet) -> HubSources:
    """Return which elements the lines from robot to robot name as sources, and what is made of other data."""
    hubs: dict[Lines, list[Element]] = defaultdict(list)
    for placed in part.units:
        for element, lines in naming_lines(placed, crossing_lines(fleet), 0).items():
            hubs[lines].append(element)
    made = (names for placed in part.units for names in made_by(placed.part.elements.values()))
    return HubSources({lines: tuple(elements) for lines, elements in hubs.items()}, frozenset(made))


def made_by(labels: Iterable[Iterable[Statement]]) -> Iterator[str]:
    """The categories that derivations make."""
    return (statement.to for statements in labels for statement in statements if statement.role == "derivation")


def core_reliance(piece: Piece, gates: Sequence[int], question: RelianceQuestion, name: str) -> UnitReliance:
    """Return the same of the core; what comes in there is what arrives at the border."""
    spread = meaning(piece.graph, piece.bound, question.hierarchy, question.categories)
    return _Unit(piece, spread, question, tuple(gates)).answer(name)


@dataclass(eq=False, repr=False)
class _Unit:
    """Follows the data of one unit; ``gates`` are where data comes in."""

    piece: Piece
    spread: Spread
    question: RelianceQuestion
    gates: tuple[int, ...]

    @cached_property
    def own_sources(self) -> Crossings:
        return self.question.always(len(self.gates))

    @cached_property
    def unknown(self) -> Collection[int]:
        return frozenset(unanswered(self.piece.graph.elements, self.piece.bound.outside))

    @cached_property
    def sources(self) -> list[int]:
        """Also those that another label takes away today."""
        said = self.piece.bound.elements.items()
        return [v for v, statements in said if any(s.role == "source" for s in statements)]

    @cached_property
    def runs(self) -> list[Run]:
        return runs_of(self.spread, (i for i, _ in enumerate(self.spread.categories)), self.question.made_categories)

    @cached_property
    def foreign(self) -> frozenset[int]:
        """What stands for elements of others."""
        border = () if self.is_core else self.piece.border
        elements = enumerate(self.piece.graph.elements)
        return frozenset({*border, *(v for v, element in elements if element.robot in (HUB, GATE))})

    @property
    def is_core(self) -> bool:
        return self.gates != self.piece.border

    def answer(self, name: str) -> UnitReliance:
        """Return the unit as it is, and without each statement of it."""
        graph, bound = self.piece.graph, self.piece.bound
        today = self._reach(self.spread, bound)
        self._fill(today)
        questions = self._questions(today)
        coming = self.question.arriving | self.own_sources
        is_open = {(element.shown_as, i) for (element, i), some in questions.items() if some & coming}
        summary = self._summary(today, questions, is_open)
        named = [
            replace(element, name=self.question.hub_names.get(element, element.name))
            if element.robot == HUB
            else element
            for element in graph.elements
        ]
        without = (self._without(identity, at, summary, is_open) for identity, at in spots(graph, bound, named).items())
        return UnitReliance(name, summary, tuple(without))

    def _without(
        self, identity: Identity, at: Spots, summary: Summary, is_open: Collection[tuple[tuple[str, ...], int]]
    ) -> Without:
        graph, elements = self.piece.graph, self.piece.graph.elements
        refused, changed = "", None
        try:
            changed = self._changed(identity[0], at, summary, is_open)
        except InputErrors as error:
            refused = str(error.errors[0])
        return Without(
            identity,
            tuple(elements[v] for v in at.with_data(self.spread)),
            tuple(elements[v] for v in at.vertices),
            tuple((elements[graph.flows[i].source], elements[graph.flows[i].target]) for i in at.flows),
            at.has_data(self.spread, self.piece.bound),
            refused,
            changed,
        )

    def _changed(
        self, statement: Statement, at: Spots, summary: Summary, is_open: Collection[tuple[tuple[str, ...], int]]
    ) -> Summary | None:
        """Follow the data without a statement; None where that changes nothing."""
        bound, less = self.piece.bound, at.without(self.piece.bound, statement)
        bound = replace(bound, elements={**bound.elements, **less.elements}, flows={**bound.flows, **less.flows})
        spread = meaning(self.piece.graph, bound, self.question.hierarchy, self.question.categories, before=self.spread)
        if _does(spread) == _does(self.spread):
            return None
        reach = self._reach(spread, bound)
        now = self._summary(reach, self._questions(reach), is_open)
        return None if now == summary else now

    def _reach(self, spread: Spread, bound: Bound) -> Reach:
        """Follow the data of the unit's sources, and each bit that can come in, in a lane of its own."""
        crossings = range(len(self.gates) * self.question.width)
        doing = Doing.of(spread, [*self.sources, *(~crossing for crossing in crossings)])
        begun = dict(doing.emits)
        for crossing in crossings:
            gate, bit = divmod(crossing, self.question.width)
            vertex = self.gates[gate]
            begun[vertex] = begun.get(vertex, 0) | doing.lanes.lane_of(~crossing, 1 << bit)
        closed = {} if self.is_core else dict.fromkeys(self.gates, 0)  # nothing passes the border
        doing = doing._replace(emits=begun, keeps={**doing.keeps, **closed}, labelled={**spread.keeps, **closed})
        places = PlacesOfFindings(
            spread, tuple(concerns(spread, bound, self.question.hierarchy)), self.question.mask, None
        )
        return Reach.along(places, doing, self.runs)

    def _fill(self, reach: Reach) -> None:
        """Put in what is at the elements today."""
        flood, lanes = reach.flood, reach.flood.doing.lanes
        coming = [*self.sources, *(~crossing for crossing in bits_of(self.question.arriving))]
        mask = sum(lanes.lane_of(key, self.spread.all_bits) for key in coming)
        arrives, leaves = (
            {v: bits for v, laned in some.items() if (bits := lanes.merged(laned & mask))}
            for some in (flood.arrives, flood.leaves)
        )
        fill(self.spread, arrives, leaves)

    def _summary(
        self,
        reach: Reach,
        questions: Mapping[tuple[Element, int], Crossings],
        is_open: Collection[tuple[tuple[str, ...], int]],
    ) -> Summary:
        elements = self.piece.graph.elements
        floods = [reach.flood, *(flood for _, flood in reach.past)]
        out = [self._out(flood) for flood in floods]
        entries: dict[tuple[str, int, Element], list[int]] = defaultdict(lambda: [0, 0, 0])
        pairs: dict[FindingKey, Arriving] = {}
        for vertex in reach.places.vertices() - self.foreign:
            for (kind, i, key, _), (stands, plain) in reach.states(vertex).items():
                if key >= 0:
                    pairs[kind, i, elements[key], elements[vertex]] = Arriving(True, stands, plain)
                    continue
                for number, holds in enumerate((True, stands, plain)):
                    entries[kind, i, elements[vertex]][number] |= holds << ~key
        return Summary(
            {elements[v]: tuple(of_run.get(v, 0) for of_run in out) for v in self.sources},
            tuple({~key: some for key, some in of_run.items() if key < 0} for of_run in out),
            {key: Entries(*some) for key, some in entries.items()},
            pairs,
            {key: some for key, some in questions.items() if (key[0].shown_as, key[1]) not in is_open},
        )

    def _out(self, flood: Flood) -> dict[int, Crossings]:
        """Source, or crossing that comes in -> where its data gets out."""
        found: dict[int, Crossings] = defaultdict(int)
        leaves = flood.leaving if self.is_core else flood.arrived
        for number, vertex in enumerate(self.piece.border):
            for key, bits in flood.doing.lanes.apart(leaves(vertex)):
                found[key] |= bits << number * self.question.width
        return dict(found)

    def _questions(self, reach: Reach) -> dict[tuple[Element, int], Crossings]:
        """What has to come in for each element to be open for a category (rule S11)."""
        spread, lanes = reach.places.spread, reach.flood.doing.lanes
        found: dict[tuple[Element, int], Crossings] = defaultdict(int)
        for vertex, element, laned in self._present(reach):
            covered = 0 if vertex in self.unknown else spread.covered.get(vertex, 0)
            uncovered = self.question.mask & ~spread.absent_bits.get(vertex, 0) & ~covered
            for key, bits in lanes.apart(laned & lanes.every(uncovered)):
                crossing = self.own_sources if key >= 0 else 1 << ~key
                for i in bits_of(spread.bits.merged(bits)):
                    found[element, i] |= crossing
        return dict(found)

    def _present(self, reach: Reach) -> Iterator[tuple[int, Element, int]]:
        """What is at each element that belongs to the unit, in lanes."""
        flood, spread, elements = reach.flood, reach.places.spread, self.piece.graph.elements
        lanes = flood.doing.lanes
        for vertex in {*flood.arrives, *flood.leaves, *spread.flow_begins} - self.foreign:
            begun = lanes.lane_of(vertex, spread.flow_begins.get(vertex, 0))
            arrives = 0 if elements[vertex].is_channel else flood.arrived(vertex)
            yield vertex, elements[vertex], arrives | flood.leaving(vertex) | begun


def _does(spread: Spread) -> tuple[object, ...]:
    """All in which a state of the labels can differ from another, for what is asked here."""
    return (
        spread.emits, spread.keeps, spread.leaks, spread.covered, spread.derives, spread.absent_bits,
        spread.flow_emits, spread.flow_keeps, spread.flow_begins,
    )  # fmt: skip
