"""What is done with one part of a fleet, wherever it is: read, placed, carried, asked for pairs.

In: units of a fleet. Out: small answers, which go to the driver, and the part itself, which stays where it was made.
All of it is the program's own kernel on the part's graph; ``distributed.py`` puts the answers together.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields, replace
from functools import partial, reduce
from operator import or_
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np

from rosprivacy.analysis.contexts import scopes_of_sources
from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.findings.closures import closed_by_shipped
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.findings.open_questions import Grounds, grounds, open_bits
from rosprivacy.analysis.fleet.counts import Counts, counted
from rosprivacy.analysis.kernel.arrays import of_elements
from rosprivacy.analysis.kernel.spreading import emitted, fill, meaning
from rosprivacy.analysis.model import BY_TYPE_OPEN, TYPE_LINE, Diagnostic, Severity
from rosprivacy.analysis.non_ros import on_day, unanswered
from rosprivacy.ingest.fleet.fleet_graph import Some, likeness, place_some
from rosprivacy.ingest.fleet.joins import let_out
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from rosprivacy.parts.border import Bringer, Class, Crossing, PartNetwork
from rosprivacy.parts.part_patterns import PartEnd, PartSource, Within
from rosprivacy.parts.units import HUB, Lines, Piece, crossing_lines, naming_lines, units_piece

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.answer import ClosedByShipped
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element, Place
    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot
    from rosprivacy.ingest.fleet.joins import Met
    from rosprivacy.ingest.labels.entries import Limit
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.parts.units import Border, Unit

    Bits = NDArray[np.uint64]
    Read = Callable[[Robot], Member]  # a robot -> the same with its graph


@dataclass(frozen=True, slots=True)
class Report:
    """What a part reports when its robots are read; all of it can be put together in any order but that of messages.

    Attributes
    ----------
    emitted
        Categories that its labels bring in or make.
    sources, labels, diagnostics
        What the answer rests on: (file, SHA-256) of policies; (file, SHA-256, whether shipped) of label files.
    limits
        Of its label files.
    countries
        Whether the country of any element is stated.
    ends
        (number of a flow of the fleet file, side 0 or 1): ends that are here.
    naming
        (lines, side, unit, for how many elements of the fleet the elements stand that these lines name there).
    restated
        Places of flows that a label file says more of.
    met
        Where the flows of the fleet file begin and end.
    contexts
        (kind, name, context) of its elements: a pattern stands for robots that are not shown, too.
    scopes
        (kind, name, whether the GDPR applies) of its sources, for the same reason.
    types
        Files of observed message types, without what they say of channels.
    typed
        Whether the message type of any channel is known.
    letting_out
        Robots at which data is let out or kept, if it gets there.
    by_type
        That lines ``only: by-type`` do not hold, where not all robots are shown.
    """

    problems: tuple[InputError, ...] = ()
    emitted: frozenset[str] = frozenset()
    sources: frozenset[tuple[str, str]] = frozenset()
    labels: frozenset[tuple[str, str, bool]] = frozenset()
    diagnostics: tuple[Diagnostic, ...] = ()
    limits: frozenset[Limit] = frozenset()
    countries: bool = False
    ends: frozenset[tuple[int, int]] = frozenset()
    naming: frozenset[tuple[Lines, int, str, int]] = frozenset()
    restated: tuple[Place, ...] = ()
    met: frozenset[Met] = frozenset()
    contexts: frozenset[tuple[str, str, str]] = frozenset()
    scopes: frozenset[tuple[str, str, str]] = frozenset()
    types: frozenset[TypesFile] = frozenset()
    typed: bool = False
    letting_out: frozenset[str] = frozenset()
    by_type: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, slots=True)
class Built:
    """Units that were read and placed, each by itself."""

    names: tuple[str, ...]
    units: tuple[Some, ...]
    likeness: Likeness
    report: Report


def built(units: Sequence[Unit], fleet: Fleet, view: str, reader: Callable[[], Read]) -> Built:
    """Read the robots of some units."""
    read = reader()
    alike = likeness(group for unit in units for group in unit.groups)
    placed: list[Some] = []
    reports = [Report()]
    for unit in units:
        try:
            members = [(group, read(group.robots[0])) for group in unit.groups]
            robots = [replace(member, robot=robot) for group, member in members for robot in group.placed]
            placed.append(place_some(fleet, robots, view, own=False))
        except InputErrors as error:
            reports.append(Report(problems=error.errors))
            continue
        naming = _naming(fleet, unit.name, placed[-1], alike)
        reports.append(replace(report_of(placed[-1], [member for _, member in members]), naming=naming))
    return Built(tuple(unit.name for unit in units), tuple(placed), alike, joined(reports))


def _naming(fleet: Fleet, unit: str, placed: Some, likeness: Likeness) -> frozenset[tuple[Lines, int, str, int]]:
    """Which lines name how many elements of a unit."""
    weights: Counter[tuple[Lines, int]] = Counter()
    for side in (0, 1):
        for element, lines in naming_lines(placed, crossing_lines(fleet), side).items():
            weights[lines, side] += likeness.weight(element.robot)
    return frozenset((lines, side, unit, weight) for (lines, side), weight in weights.items())


def report_of(placed: Some, members: Sequence[Member]) -> Report:
    """Return what robots report that were placed together; a pin of nothing may be one of a robot in another part."""
    files = [labels for member in members for labels in member.files]
    diagnostics = (said for member in members for said in member.diagnostics if said.code != PIN_OF_NOTHING)
    return Report(
        emitted=frozenset(emitted(placed.part.elements.values())),
        sources=frozenset(s for member in members for policy in member.policies for s in policy.sources),
        labels=frozenset((file.file, file.sha256, file.shipped) for file in files),
        diagnostics=tuple(dict.fromkeys(diagnostics)),
        limits=frozenset(limit for file in files for limit in file.limits),
        countries=any(facts.country for facts in placed.part.outside.values()),
        ends=frozenset((i, side) for i, ends in enumerate(placed.ends) for side in (0, 1) if ends[side]),
        restated=placed.restated,
        met=placed.met,
        contexts=frozenset(
            (element.kind, element.name, context)
            for element, where in placed.part.surroundings.items()
            for context in where.contexts
        ),
        scopes=frozenset(
            (element.kind, element.name, scope)
            for element, scope in scopes_of_sources(placed.part.elements, placed.part.surroundings)
        ),
        types=frozenset(replace(file, channels=()) for member in members for file in member.types),
        typed=any(placed.part.types.values()),
        letting_out=let_out(placed.part.elements.items()),
        by_type=tuple(dict.fromkeys(_lines_that_do_not_hold(placed))),
    )


def _lines_that_do_not_hold(placed: Some) -> Iterator[Diagnostic]:
    """Say of each line ``only: by-type`` that it closes nothing in parts, where types limit nothing."""
    for element, said in placed.part.elements.items():
        for one in said:
            if one.role == TYPE_LINE:
                what = f"{shown(element.name)}: only: by-type does not hold in parts; write only: [Kinds]"
                yield Diagnostic(one.place, Severity.WARNING, what, BY_TYPE_OPEN)


def joined(reports: Iterable[Report]) -> Report:
    """Put reports together: each of their attributes by its kind."""
    columns = zip(*(map(partial(getattr, report), NAMES) for report in reports), strict=True)
    return Report(**dict(zip(NAMES, map(_union, columns), strict=True)))


NAMES = tuple(column.name for column in fields(Report))


def _union(values: Sequence[Any]) -> Any:
    """What several reports hold of one attribute: whether any does, all of it once, or a set of it."""
    if isinstance(values[0], tuple):
        return tuple(dict.fromkeys(item for value in values for item in value))
    return reduce(or_, values)


def names_on(part: Built, robots: frozenset[str]) -> frozenset[str]:
    """Return the names of the elements that are on some robots, for messages."""
    return frozenset(e.name for placed in part.units for e in placed.part.elements if e.robot in robots)


def report(part: Built) -> Report:
    """Return what a part reports."""
    return part.report


T_co = TypeVar("T_co", covariant=True)
S = TypeVar("S")
Run = tuple[int, bool]  # number of the category; whether nothing passes its leaks


class Parts(Protocol[T_co]):
    """A value for each part, wherever it is."""

    def map(self, function: Callable[[Any], S], *, keep: bool = False) -> Parts[S]:
        """Do the same with each; ``keep`` what comes of it for more than one use."""

    def collect(self) -> Iterable[T_co]:
        """Bring all values here, in order; once."""


@dataclass(frozen=True, slots=True)
class Ready:
    """A part with its graph.

    Attributes
    ----------
    names
        Of its units.
    spread
        What labels mean; None where they contradict each other.
    """

    names: tuple[str, ...]
    piece: Piece
    spread: Spread | None
    cut: PartNetwork | None
    likeness: Likeness
    problems: tuple[InputError, ...] = ()


def ready(
    part: Built, fleet: Fleet, at: Border, view: str, categories: Iterable[str], hierarchy: Hierarchy, today: str
) -> Ready:
    """Make the graph of a part."""
    piece = units_piece(fleet, part.units, at, view)
    piece = replace(piece, bound=replace(piece.bound, outside=on_day(piece.bound.outside, today)))
    try:
        spread = meaning(piece.graph, piece.bound, hierarchy, categories)
    except InputErrors as error:
        return Ready(part.names, piece, None, None, part.likeness, error.errors)
    return Ready(part.names, piece, spread, PartNetwork.of(spread, piece.border, piece.unit), part.likeness)


def steps(part: Ready) -> tuple[tuple[InputError, ...], frozenset[tuple[int, int]]]:
    """Return what data is made into other data in a part: bits of the spread."""
    derives = part.spread.derives.values() if part.spread else ()
    return part.problems, frozenset(step for some in derives for step in some)


@dataclass(frozen=True, slots=True)
class Kernel:
    """A part for the rounds: arrays only.

    Attributes
    ----------
    categories
        Number -> what is asked of it.
    """

    names: tuple[str, ...]
    cut: PartNetwork
    categories: Mapping[int, Crossing]


def kernel(part: Ready, forms: Mapping[int, tuple[int, ...]], hierarchy: Hierarchy) -> Kernel:
    """Make the arrays of a part."""
    spread, cut = _spread_and_cut(part)
    kinds = kinds_of(part.piece, spread, hierarchy)
    crossings = {number: Crossing.of(spread, cut, number, some, kinds) for number, some in forms.items()}
    return Kernel(part.names, cut, crossings)


def kinds_of(piece: Piece, spread: Spread, hierarchy: Hierarchy) -> tuple[Concern, ...]:
    """Return where each kind of finding can be."""
    return tuple(concerns(spread, piece.bound, hierarchy))


def _spread_and_cut(part: Ready) -> tuple[Spread, PartNetwork]:
    assert part.spread is not None
    assert part.cut is not None
    return part.spread, part.cut


Brought = dict[tuple[int, int], str]  # number in the border, bit -> name of the unit


def _names(bringers: Bringer, names: Sequence[str]) -> Brought:
    return {key: names[unit] for key, unit in bringers.items()}


def carried(part: Kernel, leaving: Bits, before: Bits) -> tuple[Bits, Brought]:
    """Return what gets to the border when this leaves it, and who brings what is not known there: one round."""
    arrives, leaves = part.cut.carried(leaving)
    arrived = arrives[part.cut.border]
    return arrived, _names(part.cut.bringers(leaves, arrived & ~before), part.names)


def classes(part: Kernel) -> list[tuple[int, str, int, Class]]:
    """Return (number of the category, name of the unit, vertex, class) of each source."""
    found = []
    for number, crossing in part.categories.items():
        for vertex, met in crossing.classes().items():
            found.append((number, part.names[int(part.cut.unit[vertex])], vertex, met))
    return found


def classes_carried(
    part: Kernel, leaving: Mapping[Run, Bits], before: Mapping[Run, Bits], counts: Mapping[int, int]
) -> dict[Run, tuple[Bits, Brought]]:
    """The same as ``carried`` for the classes of sources: one round of all categories."""
    answers = {}
    for (number, stop), given in leaving.items():
        arrives, leaves = part.categories[number].carried(given, counts[number], stop=stop)
        arrived = arrives[part.cut.border]
        new = arrived & ~before[number, stop]
        answers[number, stop] = arrived, _names(part.cut.bringers(leaves, new), part.names)
    return answers


@dataclass(frozen=True, slots=True)
class PartAnswer:
    """What a part has to say in the end.

    Attributes
    ----------
    open
        Robot -> number of what is open there, in ``sets``.
    sets
        Elements without their robot, with the categories for which they are open, and what has to be known of them.
    grounds
        What 'no leak found' needs, as far as it is in the part.
    closed
        What shipped files alone close there, where that is a doubt.
    """

    within: tuple[Within, ...]
    sources: tuple[PartSource, ...]
    ends: tuple[PartEnd, ...]
    open: Mapping[str, int]
    sets: tuple[frozenset[tuple[Element, tuple[str, ...]]], ...]
    grounds: Grounds
    counts: Counts
    closed: tuple[ClosedByShipped, ...]


@dataclass(frozen=True, slots=True)
class PartQuestion:
    """What the driver found out about the border, for the last round.

    Attributes
    ----------
    leaving
        Bits of the categories.
    runs
        Bits of the classes of sources.
    numbers
        Number of the category -> class -> its number.
    counts
        Number of the category -> how many classes and sources of the core there are.
    mask
        Bits of the categories that the answer is about.
    """

    leaving: Bits
    runs: Mapping[Run, Bits]
    numbers: Mapping[int, Mapping[Class, int]]
    counts: Mapping[int, int]
    mask: int
    hierarchy: Hierarchy


def filled(part: Ready, leaving: Bits) -> Spread:
    """Return the spread of a part at the fixpoint, right for all but the border."""
    spread, cut = _spread_and_cut(part)
    fill(spread, *(of_elements(spread, rows) for rows in cut.carried(leaving)))
    return spread


def answered(part: Ready, forms: Mapping[int, tuple[int, ...]], question: PartQuestion) -> PartAnswer:
    """Return pairs, ends, open elements and counts of a part."""
    spread = filled(part, question.leaving)
    cut = _spread_and_cut(part)[1]
    graph, names = part.piece.graph, part.names
    within: list[Within] = []
    sources: list[PartSource] = []
    ends: list[PartEnd] = []
    crossings = kernel(part, forms, question.hierarchy).categories
    for number, crossing in crossings.items():
        name, n = spread.categories[number], question.counts[number]
        if not n:
            continue
        of_source = {vertex: question.numbers[number][met] for vertex, met in crossing.classes().items()}
        for vertex, klass in of_source.items():
            sources.append(PartSource(name, graph.elements[vertex], names[int(cut.unit[vertex])], klass))
        arriving = crossing.arriving((question.runs[number, True], question.runs[number, False]), n)
        for kind, source, end, how in crossing.within(arriving, of_source):
            within.append(Within(kind, name, graph.elements[source], graph.elements[end], how))
        for kind, codes in arriving.items():
            for row in np.flatnonzero(codes.any(axis=1)).tolist():
                vertex = int(crossing.ends[kind][row])
                unit = names[int(cut.unit[vertex])]
                ends.append(PartEnd(kind, name, graph.elements[vertex], unit, codes[row].tobytes()))
    on_robots, sets = _open(part, spread, question.mask)
    border = set(part.piece.border)
    counts = counted(graph, spread, part.likeness, border, {v for v in border if graph.elements[v].robot == HUB})
    closed = doubtful(spread, question.mask, part.piece.border, part.piece.unit)
    return PartAnswer(
        tuple(within), tuple(sources), tuple(ends), on_robots, sets, grounds(spread, question.mask), counts, closed
    )


def doubtful(
    spread: Spread, mask: int, beyond: Collection[int], unit: Sequence[int] = ()
) -> tuple[ClosedByShipped, ...]:
    """Return what shipped files alone close, where that is a doubt; what a hub leads to is not worked out here."""
    rows = (row for row in closed_by_shipped(spread, mask, beyond, unit) if row.rank is not None)
    return tuple(row._replace(end=None) if row.end and row.end.robot == HUB else row for row in rows)


def _open(
    part: Ready, spread: Spread, mask: int
) -> tuple[dict[str, int], tuple[frozenset[tuple[Element, tuple[str, ...]]], ...]]:
    """What is open on each robot, where many have the same: unit by unit, however many are in the part."""
    unit = {element.robot: number for element, number in zip(part.piece.graph.elements, part.piece.unit, strict=True)}
    by_robot: dict[str, set[tuple[Element, tuple[str, ...]]]] = {}
    for element, names in open_elements(part.piece, spread, mask).items():
        by_robot.setdefault(element.robot, set()).add((part.likeness.alike(element), names))
    numbers: dict[frozenset[tuple[Element, tuple[str, ...]]], int] = {}
    in_order = sorted(by_robot, key=lambda robot: (unit[robot], robot))
    on_robots = {robot: numbers.setdefault(frozenset(by_robot[robot]), len(numbers)) for robot in in_order}
    return on_robots, tuple(numbers)


def open_elements(piece: Piece, spread: Spread, mask: int) -> dict[Element, tuple[str, ...]]:
    """Return the open elements of a piece, without its border, and the categories for which they are (rule S11)."""
    elements, border = piece.graph.elements, set(piece.border)
    unknown = unanswered(elements, piece.bound.outside)
    merged: dict[tuple[str, str, str, str], tuple[Element, tuple[str, ...]]] = {}
    for vertex, bits in sorted(open_bits(spread, unknown).items()):
        element, names = elements[vertex], spread.names(bits & mask)
        if names and vertex not in border:
            first, known = merged.get(element.shown_as, (element, ()))  # the other side of a wildcard
            merged[element.shown_as] = first, tuple(sorted({*known, *names}))
    return dict(merged.values())
