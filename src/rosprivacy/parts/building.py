"""Units of a fleet are read and placed, wherever it is: what the driver has to know of them before they are carried.

In: units. Out: each placed by itself, and a ``Report``, which is small and goes to the driver.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields, replace
from functools import partial, reduce
from operator import or_
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.kernel.spreading import emitted
from rosprivacy.ingest.fleet.fleet_graph import Some, likeness, place_some
from rosprivacy.ingest.fleet.joins import let_out
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from rosprivacy.parts.units import Lines, crossing_lines, naming_lines

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

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
    types
        Files of observed message types, without what they say of channels.
    typed
        Whether the message type of any channel is known.
    letting_out
        Robots at which data is let out or kept, if it gets there.
    """

    problems: tuple[Problem, ...] = ()
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
    types: frozenset[TypesFile] = frozenset()
    typed: bool = False
    letting_out: frozenset[str] = frozenset()


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
            reports.append(Report(problems=problems_of(error)))
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
        types=frozenset(replace(file, channels=()) for member in members for file in member.types),
        typed=any(placed.part.types.values()),
        letting_out=let_out(placed.part.elements.items()),
    )


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
