"""What is done with one part of a fleet, wherever it is: read, placed, carried, asked for pairs.

In: units of a fleet. Out: small answers, which go to the driver, and the part itself, which stays where it was made.
All of it is the program's own kernel on the part's graph; ``distributed.py`` puts the answers together.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np

from rosprivacy.analysis.border import Bringer, Cut
from rosprivacy.analysis.counts import Counts, counted
from rosprivacy.analysis.crossed import End, Source, Within
from rosprivacy.analysis.crossing import Class, Crossing
from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.outside import concerns, country_unknown
from rosprivacy.analysis.questions import open_bits
from rosprivacy.analysis.spread import Spread, emitted, fill, meaning
from rosprivacy.ingest.placing import Some, likeness, place_some
from rosprivacy.ingest.split import HUB, Lines, Piece, crossing_lines, named, units_piece

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Diagnostic, Element, Place
    from rosprivacy.analysis.outside import Concern
    from rosprivacy.analysis.patterns import Likeness
    from rosprivacy.ingest.domains import Member
    from rosprivacy.ingest.elements import Limit
    from rosprivacy.ingest.fleet import Fleet, Robot
    from rosprivacy.ingest.split import Border, Unit

    Bits = NDArray[np.uint64]
    Read = Callable[[Robot], Member]  # a robot -> the same with its graph

T = TypeVar("T")
S = TypeVar("S")
Problem = tuple[type[InputError], str, int, str, str]  # an error in a form that can be sent
Run = tuple[int, bool]  # number of the category; whether nothing passes its leaks


class Parts(Protocol[T]):
    """A value for each part, wherever it is."""

    def map(self, function: Callable[[Any], S], *, keep: bool = False) -> Parts[S]:
        """Do the same with each; ``keep`` what comes of it for more than one use."""

    def collect(self) -> list[T]:
        """Bring all values here, in order."""


def problems_of(errors: InputErrors) -> tuple[Problem, ...]:
    """Return problems in a form that can be sent."""
    return tuple((type(e), e.file, e.line, e.problem, e.hint) for e in errors.errors)


def raised(problems: Iterable[Problem]) -> None:
    """Raise problems again, if there are any."""
    errors = [kind(file, line, problem, hint) for kind, file, line, problem, hint in problems]
    if errors:
        raise InputErrors(errors)


@dataclass(frozen=True, slots=True)
class Told:
    """What a part tells when its robots are read.

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
    found
        Per flow of the fleet file: whether its ends are here.
    named
        (lines, side 0 or 1) -> (unit, for how many elements of the fleet the elements stand that these lines name).
    restated
        Places of flows that a label file says more of.
    """

    problems: tuple[Problem, ...] = ()
    emitted: frozenset[str] = frozenset()
    sources: frozenset[tuple[str, str]] = frozenset()
    labels: frozenset[tuple[str, str, bool]] = frozenset()
    diagnostics: tuple[Diagnostic, ...] = ()
    limits: frozenset[Limit] = frozenset()
    countries: bool = False
    found: tuple[tuple[bool, bool], ...] = ()
    named: Mapping[tuple[Lines, int], Mapping[str, int]] = field(default_factory=dict)
    restated: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class Built:
    """Units that were read and placed, each by itself."""

    names: tuple[str, ...]
    units: tuple[Some, ...]
    likeness: Likeness
    told: Told


def built(units: Sequence[Unit], fleet: Fleet, view: str, reader: Callable[[], Read]) -> Built:
    """Read the robots of some units."""
    read = reader()
    alike = likeness(group for unit in units for group in unit.groups)
    some: list[Some] = []
    told = Told()
    for unit in units:
        try:
            members = [(group, read(group.robots[0])) for group in unit.groups]
            placed = [replace(member, robot=robot) for group, member in members for robot in group.placed]
            one = place_some(fleet, placed, view, own=False)
        except InputErrors as error:
            told = replace(told, problems=(*told.problems, *problems_of(error)))
            continue
        some.append(one)
        told = _with(told, fleet, unit.name, one, [member for _, member in members], alike)
    return Built(tuple(unit.name for unit in units), tuple(some), alike, told)


def _with(told: Told, fleet: Fleet, name: str, one: Some, members: Sequence[Member], likeness: Likeness) -> Told:
    ends: dict[tuple[Lines, int], dict[str, int]] = {}
    for side in (0, 1):
        for element, lines in named(one, crossing_lines(fleet), side).items():
            units = ends.setdefault((lines, side), {})
            units[name] = units.get(name, 0) + likeness.weight(element.robot)
    return joined(told, replace(told_of(one, members), named=ends))


def told_of(one: Some, members: Sequence[Member]) -> Told:
    """Return what robots tell that were placed together."""
    files = [labels for member in members for labels in member.files]
    return Told(
        emitted=frozenset(emitted(one.part.elements.values())),
        sources=frozenset(s for member in members for policy in member.policies for s in policy.sources),
        labels=frozenset((file.file, file.sha256, file.shipped) for file in files),
        diagnostics=tuple(dict.fromkeys(d for member in members for d in member.diagnostics)),
        limits=frozenset(limit for file in files for limit in file.limits),
        countries=any(facts.country for facts in one.part.outside.values()),
        found=tuple((bool(sources), bool(targets)) for sources, targets in one.ends),
        restated=one.restated,
    )


def joined(one: Told, other: Told) -> Told:
    """Put together what two tell."""
    ends = {key: dict(units) for key, units in one.named.items()}
    for key, units in other.named.items():
        ends.setdefault(key, {}).update(units)
    found = (
        tuple((a or c, b or d) for (a, b), (c, d) in zip(one.found, other.found, strict=True))
        if one.found and other.found
        else one.found or other.found
    )
    return Told(
        problems=(*one.problems, *other.problems),
        emitted=one.emitted | other.emitted,
        sources=one.sources | other.sources,
        labels=one.labels | other.labels,
        diagnostics=tuple(dict.fromkeys((*one.diagnostics, *other.diagnostics))),
        limits=one.limits | other.limits,
        countries=one.countries or other.countries,
        found=found,
        named=ends,
        restated=(*one.restated, *other.restated),
    )


def names_on(part: Built, robots: frozenset[str]) -> frozenset[str]:
    """Return the names of the elements that are on some robots, for messages."""
    return frozenset(e.name for some in part.units for e in some.part.elements if e.robot in robots)


def told(part: Built) -> Told:
    """Return what a part tells."""
    return part.told


@dataclass(frozen=True, slots=True)
class Ready:
    """A part with its graph.

    Attributes
    ----------
    names
        Of its units.
    found
        What labels mean; None where they contradict each other.
    """

    names: tuple[str, ...]
    piece: Piece
    found: Spread | None
    cut: Cut | None
    likeness: Likeness
    problems: tuple[Problem, ...] = ()


def ready(part: Built, fleet: Fleet, at: Border, view: str, categories: Iterable[str], hierarchy: Hierarchy) -> Ready:
    """Make the graph of a part."""
    piece = units_piece(fleet, part.units, at, view)
    try:
        found = meaning(piece.graph, piece.bound, hierarchy, categories)
    except InputErrors as error:
        return Ready(part.names, piece, None, None, part.likeness, problems_of(error))
    return Ready(part.names, piece, found, Cut.of(found, piece.border, piece.unit), part.likeness)


def steps(part: Ready) -> tuple[tuple[Problem, ...], frozenset[tuple[int, int]]]:
    """Return what data is made into other data in a part: bits of the spread."""
    derives = part.found.derives.values() if part.found else ()
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
    cut: Cut
    categories: Mapping[int, Crossing]


def kernel(part: Ready, forms: Mapping[int, tuple[int, ...]], hierarchy: Hierarchy) -> Kernel:
    """Make the arrays of a part."""
    found, cut = _known(part)
    kinds = kinds_of(part.piece, found, hierarchy)
    crossings = {number: Crossing.of(found, cut, number, some, kinds) for number, some in forms.items()}
    return Kernel(part.names, cut, crossings)


def kinds_of(piece: Piece, found: Spread, hierarchy: Hierarchy) -> tuple[Concern, ...]:
    """Return where each kind of finding can be."""
    return tuple(concerns(found, piece.bound, hierarchy))


def _known(part: Ready) -> tuple[Spread, Cut]:
    assert part.found is not None
    assert part.cut is not None
    return part.found, part.cut


Brought = dict[tuple[int, int], str]  # number in the border, bit -> name of the unit


def _names(found: Bringer, names: Sequence[str]) -> Brought:
    return {key: names[unit] for key, unit in found.items()}


def carried(part: Kernel, leaving: Bits, known: Bits) -> tuple[Bits, Brought]:
    """Return what gets to the border when this leaves it, and who brings what is not known there: one round."""
    arrives, leaves = part.cut.carried(leaving)
    arrived = arrives[part.cut.border]
    return arrived, _names(part.cut.bringers(leaves, arrived & ~known), part.names)


def classes(part: Kernel) -> list[tuple[int, str, int, Class]]:
    """Return (number of the category, name of the unit, vertex, class) of each source."""
    found = []
    for number, crossing in part.categories.items():
        for vertex, met in crossing.classes().items():
            found.append((number, part.names[int(part.cut.unit[vertex])], vertex, met))
    return found


def classes_carried(
    part: Kernel, leaving: Mapping[Run, Bits], known: Mapping[Run, Bits], counts: Mapping[int, int]
) -> dict[Run, tuple[Bits, Brought]]:
    """The same as ``carried`` for the classes of sources: one round of all categories."""
    answers = {}
    for (number, stop), given in leaving.items():
        arrives, leaves = part.categories[number].carried(given, counts[number], stop=stop)
        arrived = arrives[part.cut.border]
        new = arrived & ~known[number, stop]
        answers[number, stop] = arrived, _names(part.cut.bringers(leaves, new), part.names)
    return answers


@dataclass(frozen=True, slots=True)
class Answer:
    """What a part has to say in the end.

    Attributes
    ----------
    open
        Robot -> number of what is open there, in ``sets``.
    sets
        Elements without their robot, with the categories for which they are open, and what has to be known of them.
    begins
        Whether there is a source of what is asked for.
    """

    within: tuple[Within, ...]
    sources: tuple[Source, ...]
    ends: tuple[End, ...]
    open: Mapping[str, int]
    sets: tuple[frozenset[tuple[Element, tuple[str, ...]]], ...]
    begins: bool
    counts: Counts


@dataclass(frozen=True, slots=True)
class Asked:
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
    found, cut = _known(part)
    fill(found, *cut.carried(leaving))
    return found


def answered(part: Ready, forms: Mapping[int, tuple[int, ...]], asked: Asked) -> Answer:
    """Return pairs, ends, open elements and counts of a part."""
    found = filled(part, asked.leaving)
    cut = _known(part)[1]
    graph, names = part.piece.graph, part.names
    within: list[Within] = []
    sources: list[Source] = []
    ends: list[End] = []
    crossings = kernel(part, forms, asked.hierarchy).categories
    for number, crossing in crossings.items():
        name, n = found.categories[number], asked.counts[number]
        if not n:
            continue
        of_source = {vertex: asked.numbers[number][met] for vertex, met in crossing.classes().items()}
        for vertex, klass in of_source.items():
            sources.append(Source(name, graph.elements[vertex], names[int(cut.unit[vertex])], klass))
        arriving = crossing.arriving((asked.runs[number, True], asked.runs[number, False]), n)
        for kind, source, end, how in crossing.within(arriving, of_source):
            within.append(Within(kind, name, graph.elements[source], graph.elements[end], how))
        for kind, codes in arriving.items():
            for row in np.flatnonzero(codes.any(axis=1)).tolist():
                vertex = int(crossing.ends[kind][row])
                unit = names[int(cut.unit[vertex])]
                ends.append(End(kind, name, graph.elements[vertex], unit, codes[row].tobytes()))
    on_robots, sets = _open(part, found, asked.mask)
    begins = any(found.begins(vertex) & asked.mask for vertex in found.facts)
    border = set(part.piece.border)
    counts = counted(graph, found, part.likeness, border, {v for v in border if graph.elements[v].robot == HUB})
    return Answer(tuple(within), tuple(sources), tuple(ends), on_robots, sets, begins, counts)


def _open(
    part: Ready, found: Spread, mask: int
) -> tuple[dict[str, int], tuple[frozenset[tuple[Element, tuple[str, ...]]], ...]]:
    """What is open on each robot, where many have the same."""
    by_robot: dict[str, set[tuple[Element, tuple[str, ...]]]] = {}
    for element, names in open_elements(part.piece, found, mask).items():
        by_robot.setdefault(element.robot, set()).add((part.likeness.alike(element), names))
    numbers: dict[frozenset[tuple[Element, tuple[str, ...]]], int] = {}
    on_robots = {robot: numbers.setdefault(frozenset(some), len(numbers)) for robot, some in sorted(by_robot.items())}
    return on_robots, tuple(numbers)


def open_elements(piece: Piece, found: Spread, mask: int) -> dict[Element, tuple[str, ...]]:
    """Return the open elements of a piece, without its border, and the categories for which they are (rule S11)."""
    elements, border = piece.graph.elements, set(piece.border)
    unknown = {v for v, facts in piece.bound.outside.items() if country_unknown(elements[v], facts)}
    merged: dict[tuple[str, str, str, str], tuple[Element, tuple[str, ...]]] = {}
    for vertex, bits in sorted(open_bits(found, unknown).items()):
        element, names = elements[vertex], found.names(bits & mask)
        if names and vertex not in border:
            first, known = merged.get(element.shown_as, (element, ()))  # the other side of a wildcard
            merged[element.shown_as] = first, tuple(sorted({*known, *names}))
    return dict(merged.values())
