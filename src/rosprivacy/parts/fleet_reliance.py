"""What the answer hangs on, of a fleet in parts: what each statement of any unit keeps from being found anywhere.

In: what ``unit_reliance.py`` says of each unit, and of the core. Out: ``Reliance`` rows, those of one graph. Without a
statement some units do something else with what comes in; what leaves them goes on through all others, which do what
they do today. Sources that bring the same to the border are one class, and so are leaks to which the same has to come,
so the number of robots does not matter but for what is written in the end.

Source: rules S7, S8, S10 and S11.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.findings.closures import line_key
from rosprivacy.analysis.model import CANNOT, DISCLOSURE, Element
from rosprivacy.analysis.whatif.reliance import Opening, Reliance
from rosprivacy.parts.crossings import Crossroads, image
from rosprivacy.parts.part_patterns import CORE
from rosprivacy.parts.unit_reliance import (
    NOT_THERE,
    Arriving,
    Entries,
    RelianceQuestion,
    core_reliance,
    hub_sources,
    made_by,
    units_reliance,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Statement
    from rosprivacy.analysis.whatif.spots import Identity
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.parts.crossings import Beyond, Crossings, Exits
    from rosprivacy.parts.unit_reliance import FindingKey, Summary, UnitReliance, Without
    from rosprivacy.parts.units import Border, Piece
    from rosprivacy.parts.workers import Built, Parts

    Changed = dict[str, Summary]  # unit -> what it is without a statement
    SourceClass = tuple[bool, Exits, Exits]  # whether in the core; where its data gets out today, and without
    LeakClass = tuple[str, int, bool, Entries, Entries]  # kind, category, whether in the core; what has to come in
    Members = list[tuple[str, Element]]  # with their units

NO_ENTRY = Entries()
# What is listed: of each of n robots a statement that opens something on all others makes n * n findings.
MOST_LISTED, MOST_OF_ROW, LEAST_OF_ROW = 1_000_000, 10_000, 100  # findings, and questions: in all, and of a statement


class FleetRows(NamedTuple):
    """Rows; and the statements on which more findings or questions hang than the ``limit``."""

    rows: tuple[Reliance, ...]
    cut: tuple[Statement, ...]
    limit: int


@dataclass(eq=False, repr=False)
class FleetReliance:
    """Puts together what units say.

    Attributes
    ----------
    categories
        That have bits.
    hubs
        Hub -> the elements whose data it takes on.
    run_of
        Number of a category -> the run in which nothing passes its leaks.
    always
        The crossing that stands for a unit's own sources.
    summaries
        Of each unit, and of the core, as they are.
    without
        Statement -> unit -> what it is without it.
    cut
        Statements on which more findings or questions hang than are listed.
    limit
        How many of either are listed of one statement.
    """

    categories: tuple[str, ...]
    hubs: Mapping[Element, Sequence[Element]]
    run_of: Mapping[int, int]
    always: Crossings
    summaries: dict[str, Summary] = field(default_factory=dict)
    without: dict[Identity, dict[str, Without]] = field(default_factory=lambda: defaultdict(dict))
    cut: list[Statement] = field(default_factory=list)
    limit: int = MOST_OF_ROW

    def take(self, answer: UnitReliance) -> None:
        """Take what a unit says; before anything is asked for."""
        self.summaries[answer.unit] = answer.summary
        for row in answer.without:
            self.without[row.identity][answer.unit] = row

    def arriving(self, leaving: Crossings) -> Crossings:
        """Return what units bring to the border, when this leaves it; before the core is known."""
        found = 0
        for summary in self.summaries.values():
            found |= image(summary.passes[0], leaving)
            for exits in summary.exits.values():
                found |= exits[0]
        return found

    @cached_property
    def crossroads(self) -> Crossroads:
        """The border as it is."""
        units = (summary.passes for unit, summary in self.summaries.items() if unit != CORE)
        return Crossroads.of(units, self.summaries[CORE].passes)

    @cached_property
    def sources(self) -> Mapping[SourceClass, Members]:
        """The sources by where their data gets out."""
        return _sources((unit, some, some) for unit, some in self.summaries.items())

    @cached_property
    def leaks(self) -> Mapping[LeakClass, Members]:
        """The leaks, and the like, by what has to come in."""
        return _leaks((unit, some, some) for unit, some in self.summaries.items())

    @cached_property
    def questions(self) -> Mapping[tuple[bool, Crossings], list[tuple[str, Element, int]]]:
        """What is not open today, by what has to come in for it to be: unit, element, number of the category."""
        found: dict[tuple[bool, Crossings], list[tuple[str, Element, int]]] = defaultdict(list)
        for unit, summary in self.summaries.items():
            for (element, i), crossings in summary.questions.items():
                found[unit == CORE, crossings].append((unit, element, i))
        return found

    def rows(self) -> FleetRows:
        """Return the rows on which anything hangs, in the order of files and lines."""
        order = sorted(self.without, key=lambda same: (line_key(same[0]), same[1]))
        reached = [same for same in order if any(row.reached for row in self.without[same].values())]
        self.limit = min(MOST_OF_ROW, max(LEAST_OF_ROW, MOST_LISTED // max(1, len(reached))))
        rows = (self._row(same, self.without[same]) for same in reached)
        return FleetRows(tuple(row for row in rows if row.hangs), tuple(self.cut), self.limit)

    def _row(self, identity: Identity, units: Mapping[str, Without]) -> Reliance:
        """What hangs on a statement that some units have."""
        elements = [e for row in units.values() for e in row.with_data]
        elements = elements or [e for row in units.values() for e in row.elements]
        ends = (flow for row in units.values() for flow in row.flows)
        flows = {(source, to) for begin, to in ends for source in self.hubs.get(begin, (begin,))}
        along = sorted(flows, key=lambda ends: (ends[0].sort_key(), ends[1].sort_key()))
        row = Reliance(
            identity[0],
            _distinct((*sorted(elements, key=Element.sort_key), *(source for source, _ in along))),
            _distinct(target for _, target in along),
        )
        refusing = [without for without in units.values() if without.refused]
        if refusing:
            first = min(refusing, key=lambda without: [e.sort_key() for e in without.elements])
            return row._replace(refused=first.refused)
        changed = {unit: without.summary for unit, without in units.items() if without.summary is not None}
        if not changed:
            return row
        now = self._without(changed)
        questions = () if identity[0].role == CANNOT else self._questions(changed, now)
        openings = self._findings(changed, now)
        if max(len(openings), len(questions)) > self.limit:
            self.cut.append(identity[0])
        return row._replace(findings=openings[: self.limit], questions=questions[: self.limit])

    def _without(self, changed: Changed) -> Crossroads:
        """The border where some units are something else."""
        units = [(self.summaries[unit].passes, some.passes) for unit, some in changed.items() if unit != CORE]
        return self.crossroads.changed(units, changed.get(CORE, self.summaries[CORE]).passes)

    def _findings(self, changed: Changed, now: Crossroads) -> tuple[Opening, ...]:
        """The findings that are new or worse; of many some that stand, and one more than are listed."""
        openings = []
        for (kind, i, source, leak), before, after in islice(self._worse(changed, now), self.limit + 1):
            opening = Opening(
                kind, self.categories[i], source, leak,
                dismissed=not after.stands, pseudonymised=not after.plain, new=not before.present,
            )  # fmt: skip
            openings.append(((not after.stands, i, source.sort_key(), leak.sort_key(), kind), opening))
        return tuple(opening for _, opening in sorted(openings, key=lambda pair: pair[0]))

    def _worse(self, changed: Changed, now: Crossroads) -> Iterator[tuple[FindingKey, Arriving, Arriving]]:
        """What gets to leaks today, and without a statement, where that is worse: within units first, then by class.

        Classes of which findings stand come before those of which all are dismissed.
        """
        both = [(unit, self.summaries[unit], some) for unit, some in changed.items()]
        sources = [*_classes(self.sources, changed), *_classes(_sources(both))]
        leaks = [*_classes(self.leaks, changed), *_classes(_leaks(both))]
        touched = [leak for leak in leaks if leak[0][3] != leak[0][4]]
        for unit, before, after in both:
            yield from self._within(unit, before, after, now)
        worse = []
        for (in_core, exits, exits_now), begin in sources:
            ways = self.crossroads.beyond(exits, of_core=in_core), now.beyond(exits_now, of_core=in_core)
            for leak_class, end in leaks if ways[0] != ways[1] else touched:
                over = self._over(leak_class, *ways)
                if over[1].worse(over[0]):
                    worse.append((leak_class, over, begin, end))
        for leak_class, over, begin, end in sorted(worse, key=lambda pair: (not pair[1][1].stands, pair[0][1])):
            yield from self._pairs(leak_class, over, begin(), end(), changed)

    def _over(self, leaks: LeakClass, before: Sequence[Beyond], after: Sequence[Beyond]) -> tuple[Arriving, Arriving]:
        """What gets to leaks over the border, today and without a statement."""
        kind, i, in_core, *entries = leaks
        run = self.run_of[i] if kind == DISCLOSURE else 0
        coming = ((ways[0][not in_core], ways[run][not in_core]) for ways in (before, after))
        now, then = (entry.arriving(*some) for entry, some in zip(entries, coming, strict=True))
        return now, then

    def _pairs(
        self, leaks: LeakClass, over: tuple[Arriving, Arriving], begin: Members, end: Members, changed: Changed
    ) -> Iterator[tuple[FindingKey, Arriving, Arriving]]:
        """The single pairs of two classes; without those within a unit that is something else."""
        kind, i, *_ = leaks
        for unit, source in begin:
            for other, leak in end:
                key = kind, i, source, leak
                if unit != other:
                    yield key, *over
                elif unit not in changed:
                    own = self.summaries[unit].pairs.get(key, NOT_THERE)
                    before, after = (one.joined(own) for one in over)
                    if after.worse(before):
                        yield key, before, after

    def _within(
        self, unit: str, before: Summary, after: Summary, now: Crossroads
    ) -> Iterator[tuple[FindingKey, Arriving, Arriving]]:
        """The pairs of a unit that is something else: by ways within it, and over the border."""
        in_core = unit == CORE
        ends = {(kind, i, leak) for some in (before, after) for kind, i, _, leak in some.pairs}
        ends |= {*before.entries, *after.entries}
        for source, exits in before.exits.items():
            ways = (
                self.crossroads.beyond(exits, of_core=in_core),
                now.beyond(after.exits[source], of_core=in_core),
            )
            for kind, i, leak in ends:
                entry, entry_now = (some.entries.get((kind, i, leak), NO_ENTRY) for some in (before, after))
                over = self._over((kind, i, in_core, entry, entry_now), *ways)
                key = kind, i, source, leak
                was, is_now = (
                    way.joined(some.pairs.get(key, NOT_THERE)) for way, some in zip(over, (before, after), strict=True)
                )
                if is_now.worse(was):
                    yield key, was, is_now

    def _questions(self, changed: Changed, now: Crossroads) -> tuple[tuple[Element, tuple[str, ...]], ...]:
        """The elements that would be open, with the categories for which they are not; of many one more than listed."""
        asked: dict[tuple[str, ...], list[tuple[Element, int]]] = defaultdict(list)
        for element, i in self._new_questions(changed, self._coming(changed, now)):
            if element.shown_as in asked or len(asked) <= self.limit:
                asked[element.shown_as].append((element, i))
        first = sorted((sorted(some, key=_in_order) for some in asked.values()), key=lambda some: _in_order(some[0]))
        return tuple((some[0][0], tuple(sorted({self.categories[i] for _, i in some}))) for some in first)

    def _new_questions(self, changed: Changed, coming: tuple[Crossings, Crossings]) -> Iterator[tuple[Element, int]]:
        """What would be open, of the units first that have the statement."""
        for unit, summary in changed.items():
            some = coming[unit == CORE] | self.always
            yield from (key for key, crossings in summary.questions.items() if crossings & some)
        for (in_core, crossings), members in self.questions.items():
            if crossings & coming[in_core]:
                yield from ((element, i) for unit, element, i in members if unit not in changed)

    def _coming(self, changed: Changed, now: Crossroads) -> tuple[Crossings, Crossings]:
        """All that comes into units, and into the core, without a statement."""
        exits = [0, 0]
        for (in_core, some, _), members in self.sources.items():
            if any(unit not in changed for unit, _ in members):
                exits[in_core] |= some[0]
        for unit, summary in changed.items():
            for out in summary.exits.values():
                exits[unit == CORE] |= out[0]
        ways = [now.beyond((some,), of_core=bool(number))[0] for number, some in enumerate(exits)]
        return ways[0].leaving | ways[1].leaving, ways[0].arriving | ways[1].arriving


def _sources(units: Iterable[tuple[str, Summary, Summary]]) -> dict[SourceClass, Members]:
    """Sources by where their data gets out of their unit, before and after."""
    found: dict[SourceClass, Members] = defaultdict(list)
    for unit, before, after in units:
        for element, exits in before.exits.items():
            found[unit == CORE, exits, after.exits[element]].append((unit, element))
    return found


def _leaks(units: Iterable[tuple[str, Summary, Summary]]) -> dict[LeakClass, Members]:
    """Leaks by what has to come into their unit, before and after."""
    found: dict[LeakClass, Members] = defaultdict(list)
    for unit, before, after in units:
        for kind, i, element in {**before.entries, **after.entries}:
            entry, now = (some.entries.get((kind, i, element), NO_ENTRY) for some in (before, after))
            found[kind, i, unit == CORE, entry, now].append((unit, element))
    return found


def _classes(classes: Mapping[Any, Members], units: Collection[str] = ()) -> list[tuple[Any, Callable[[], Members]]]:
    """Classes; and what gives their members that are not in some units, where they are asked for."""

    def outside(members: Members) -> Members:
        return [(unit, element) for unit, element in members if unit not in units]

    return [(key, partial(outside, members)) for key, members in classes.items()]


def _in_order(question: tuple[Element, int]) -> tuple[object, ...]:
    return question[0].sort_key()


def _distinct(elements: Iterable[Element]) -> tuple[Element, ...]:
    """The elements that a reader can tell apart, each once."""
    return tuple({element.shown_as: element for element in elements}.values())


def fleet_reliances(
    parts: Parts[Built], fleet: Fleet, at: Border, view: str, today: str, core: Piece, gates: Sequence[int],
    hierarchy: Hierarchy, categories: Sequence[str], mask: int, leaving: Crossings, width: int,
) -> FleetRows:  # fmt: skip
    """Return what hangs on each statement of a fleet on which anything does.

    Parameters
    ----------
    fleet
        Without its robots.
    at, view, today
        As the graph of each unit is made.
    core, gates
        The core, and where data comes into it.
    categories
        That have bits; sorted.
    mask
        Bits of those that the answer is about.
    leaving
        What leaves the border today.
    width
        How many bits the spread has.
    """
    hubs: dict[Element, list[Element]] = defaultdict(list)
    made = {*made_by(core.bound.elements.values())}
    for sources in parts.map(partial(hub_sources, fleet=fleet)).collect():
        made |= sources.made_categories
        for lines, elements in sources.hubs.items():
            hubs[at.hubs[lines]] += elements
    names = {hub: {element.name for element in elements} for hub, elements in hubs.items()}
    question = RelianceQuestion(
        tuple(categories), hierarchy, mask, frozenset(i for i, name in enumerate(categories) if name in made), leaving,
        {hub: min(some) for hub, some in names.items() if len(some) == 1}, width,
    )  # fmt: skip
    whole = FleetReliance(question.categories, hubs, question.run_of, question.always(len(at.elements)))
    ask = partial(units_reliance, fleet=fleet, at=at, view=view, today=today, question=question)
    for answers in parts.map(ask).collect():
        for answer in answers:
            whole.take(answer)
    whole.take(core_reliance(core, gates, replace(question, arriving=whole.arriving(leaving)), CORE))
    return whole.rows()
