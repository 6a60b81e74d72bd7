"""What is done with one part of a fleet, wherever it is: read, placed, carried, asked for pairs.

In: units of a fleet. Out: small answers, which go to the driver, and the part itself, which stays where it was made.
All of it is the program's own kernel on the part's graph; ``distributed.py`` puts the answers together.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

import numpy as np

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.closures import closed_by_shipped
from rosprivacy.analysis.findings.concerns import concerns
from rosprivacy.analysis.findings.open_questions import Grounds, grounds, open_bits
from rosprivacy.analysis.fleet.counts import Counts, counted
from rosprivacy.analysis.kernel.arrays import of_elements
from rosprivacy.analysis.kernel.spreading import fill, meaning
from rosprivacy.analysis.non_ros import on_day, unanswered
from rosprivacy.parts.border import Bringer, PartNetwork
from rosprivacy.parts.building import Problem, problems_of
from rosprivacy.parts.part_pairs import Class, Crossing
from rosprivacy.parts.part_patterns import End, Source, Within
from rosprivacy.parts.units import HUB, Piece, units_piece

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from rosprivacy.analysis.answer import ClosedByShipped
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Element
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.parts.building import Built
    from rosprivacy.parts.units import Border

    Bits = NDArray[np.uint64]

T = TypeVar("T")
S = TypeVar("S")
Run = tuple[int, bool]  # number of the category; whether nothing passes its leaks


class Parts(Protocol[T]):
    """A value for each part, wherever it is."""

    def map(self, function: Callable[[Any], S], *, keep: bool = False) -> Parts[S]:
        """Do the same with each; ``keep`` what comes of it for more than one use."""

    def collect(self) -> list[T]:
        """Bring all values here, in order."""


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
    problems: tuple[Problem, ...] = ()


def ready(
    part: Built, fleet: Fleet, at: Border, view: str, categories: Iterable[str], hierarchy: Hierarchy, today: str
) -> Ready:
    """Make the graph of a part."""
    piece = units_piece(fleet, part.units, at, view)
    piece = replace(piece, bound=replace(piece.bound, outside=on_day(piece.bound.outside, today)))
    try:
        spread = meaning(piece.graph, piece.bound, hierarchy, categories)
    except InputErrors as error:
        return Ready(part.names, piece, None, None, part.likeness, problems_of(error))
    return Ready(part.names, piece, spread, PartNetwork.of(spread, piece.border, piece.unit), part.likeness)


def steps(part: Ready) -> tuple[tuple[Problem, ...], frozenset[tuple[int, int]]]:
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
class Answer:
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
    sources: tuple[Source, ...]
    ends: tuple[End, ...]
    open: Mapping[str, int]
    sets: tuple[frozenset[tuple[Element, tuple[str, ...]]], ...]
    grounds: Grounds
    counts: Counts
    closed: tuple[ClosedByShipped, ...]


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
    spread, cut = _spread_and_cut(part)
    fill(spread, *(of_elements(spread, rows) for rows in cut.carried(leaving)))
    return spread


def answered(part: Ready, forms: Mapping[int, tuple[int, ...]], question: Asked) -> Answer:
    """Return pairs, ends, open elements and counts of a part."""
    spread = filled(part, question.leaving)
    cut = _spread_and_cut(part)[1]
    graph, names = part.piece.graph, part.names
    within: list[Within] = []
    sources: list[Source] = []
    ends: list[End] = []
    crossings = kernel(part, forms, question.hierarchy).categories
    for number, crossing in crossings.items():
        name, n = spread.categories[number], question.counts[number]
        if not n:
            continue
        of_source = {vertex: question.numbers[number][met] for vertex, met in crossing.classes().items()}
        for vertex, klass in of_source.items():
            sources.append(Source(name, graph.elements[vertex], names[int(cut.unit[vertex])], klass))
        arriving = crossing.arriving((question.runs[number, True], question.runs[number, False]), n)
        for kind, source, end, how in crossing.within(arriving, of_source):
            within.append(Within(kind, name, graph.elements[source], graph.elements[end], how))
        for kind, codes in arriving.items():
            for row in np.flatnonzero(codes.any(axis=1)).tolist():
                vertex = int(crossing.ends[kind][row])
                unit = names[int(cut.unit[vertex])]
                ends.append(End(kind, name, graph.elements[vertex], unit, codes[row].tobytes()))
    on_robots, sets = _open(part, spread, question.mask)
    border = set(part.piece.border)
    counts = counted(graph, spread, part.likeness, border, {v for v in border if graph.elements[v].robot == HUB})
    closed = doubtful(spread, question.mask, part.piece.border, part.piece.unit)
    return Answer(
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
    """What is open on each robot, where many have the same."""
    by_robot: dict[str, set[tuple[Element, tuple[str, ...]]]] = {}
    for element, names in open_elements(part.piece, spread, mask).items():
        by_robot.setdefault(element.robot, set()).add((part.likeness.alike(element), names))
    numbers: dict[frozenset[tuple[Element, tuple[str, ...]]], int] = {}
    on_robots = {robot: numbers.setdefault(frozenset(some), len(numbers)) for robot, some in sorted(by_robot.items())}
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
