"""Units of a fleet are read and placed, wherever it is: what the driver has to know of them before they are carried.

In: units. Out: each placed by itself, and ``Told``, which is small and goes to the driver.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.kernel.spreading import emitted
from rosprivacy.ingest.fleet.fleet_graph import Some, likeness, place_some
from rosprivacy.ingest.fleet.joins import let_out
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from rosprivacy.parts.units import Lines, crossing_lines, named

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Diagnostic, Place
    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Fleet, Robot
    from rosprivacy.ingest.fleet.joins import Met
    from rosprivacy.ingest.labels.entries import Limit
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.parts.units import Unit

    Read = Callable[[Robot], Member]  # a robot -> the same with its graph

Problem = tuple[type[InputError], str, int, str, str]  # an error in a form that can be sent


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
    met
        Where the flows of the fleet file begin and end.
    types
        Files of observed message types, without what they say of channels.
    typed
        Whether the message type of any channel is known.
    letting_out
        Robots at which data is let out or kept, if it gets there.
    contexts
        (kind, name, context) of its elements: a pattern stands for robots that are not shown, too.
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
    met: frozenset[Met] = frozenset()
    contexts: frozenset[tuple[str, str, str]] = frozenset()
    types: frozenset[TypesFile] = frozenset()
    typed: bool = False
    letting_out: frozenset[str] = frozenset()


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
    """Return what robots tell that were placed together; a pin of nothing may be one of a robot in another part."""
    files = [labels for member in members for labels in member.files]
    return Told(
        emitted=frozenset(emitted(one.part.elements.values())),
        sources=frozenset(s for member in members for policy in member.policies for s in policy.sources),
        labels=frozenset((file.file, file.sha256, file.shipped) for file in files),
        diagnostics=tuple(
            dict.fromkeys(d for member in members for d in member.diagnostics if d.code != PIN_OF_NOTHING)
        ),
        limits=frozenset(limit for file in files for limit in file.limits),
        countries=any(facts.country for facts in one.part.outside.values()),
        found=tuple((bool(sources), bool(targets)) for sources, targets in one.ends),
        restated=one.restated,
        met=one.met,
        contexts=frozenset(
            (element.kind, element.name, context)
            for element, where in one.part.surroundings.items()
            for context in where.contexts
        ),
        types=frozenset(replace(file, channels=()) for member in members for file in member.types),
        typed=any(one.part.types.values()),
        letting_out=let_out(one.part.elements.items()),
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
        met=one.met | other.met,
        contexts=one.contexts | other.contexts,
        types=one.types | other.types,
        typed=one.typed or other.typed,
        letting_out=one.letting_out | other.letting_out,
    )


def names_on(part: Built, robots: frozenset[str]) -> frozenset[str]:
    """Return the names of the elements that are on some robots, for messages."""
    return frozenset(e.name for some in part.units for e in some.part.elements if e.robot in robots)


def told(part: Built) -> Told:
    """Return what a part tells."""
    return part.told
