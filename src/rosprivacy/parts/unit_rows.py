"""Units of a fleet -> their rows for the database, made where they are: no machine has all of them.

In: units, and those in which the ways lie that data takes between units. Out: ``RobotRows`` of their robots, and of
what is shared as far as it concerns them. What gets there is what gets there in the whole fleet, since the units that
bring data to what is shared are placed along.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import robot_verdicts
from rosprivacy.analysis.findings.doubts import doubts
from rosprivacy.analysis.findings.findings import Options, analyse
from rosprivacy.analysis.fleet.source_leak_pairs import pairs
from rosprivacy.analysis.whatif.answered_by_globs import answered_by_globs
from rosprivacy.assumptions import assumptions_of, files_read, remembered, types_read
from rosprivacy.ingest.fleet.dds_domains import is_domain, pseudo_robot
from rosprivacy.ingest.neo4j_graph.fleet_rows import FleetRows
from rosprivacy.ingest.neo4j_graph.rows import rows_of
from rosprivacy.ontology.vocabulary import load
from rosprivacy.parts.shown_robots import Choice, place_groups
from rosprivacy.parts.units import unit_of
from rosprivacy.question import Question
from rosprivacy.robot_doubts import breaking, doubt_lines, doubts_by_robot

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.concerns import Concern
    from rosprivacy.analysis.fleet.source_leak_pairs import Pairs
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Diagnostic, Doubt, Element, NonRosFacts
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.ingest.fleet.fleet_graph import Placed
    from rosprivacy.ingest.neo4j_graph.rows import RobotRows, Row
    from rosprivacy.parts.units import Unit
    from rosprivacy.parts.workers import Read
    from rosprivacy.settings import Settings

AT_ONCE = 25  # units that are placed in one graph


@dataclass(frozen=True, slots=True)
class Plan:
    """What is needed of the whole fleet to make the rows of some of it.

    Attributes
    ----------
    fleet
        Without its robots.
    fixed
        The infrastructure of the core.
    examples
        See ``Found``.
    shared
        What is stated about elements of the core.
    leaking
        See ``Found``.
    lacking
        See ``Found``.
    assumptions
        Of the answer about the whole fleet.
    joins
        What a reader has to know of the fleet: what joins nothing.
    broken
        See ``Found``.
    doubts
        Of the whole answer, and about elements of the core.
    """

    fleet: Fleet
    fixed: tuple[Alike, ...]
    examples: tuple[Unit, ...]
    shared: Mapping[Element, NonRosFacts]
    leaking: frozenset[str]
    lacking: str
    assumptions: Mapping[str, Any]
    settings: Settings
    reader: Callable[[], Read]
    joins: tuple[Diagnostic, ...] = ()
    broken: frozenset[str] = frozenset()
    doubts: tuple[Doubt, ...] = ()


def unit_rows(units: Sequence[Unit], plan: Plan) -> list[RobotRows]:
    """Return the rows of the robots of some units, and of what is shared as far as it concerns them."""
    made: list[RobotRows] = []
    read = plan.reader()
    for start in range(0, len(units), AT_ONCE):
        made += _rows(units[start : start + AT_ONCE], plan, read)
    return made


def core_rows(plan: Plan) -> list[RobotRows]:
    """Return the rows of what is shared, as far as it concerns no unit."""
    placed, members = _placed((), plan, plan.reader())
    fleet_rows = _fleet_rows(placed, members, plan, unit_of(()))
    core = _core(plan)
    made = [rows for owner in core for rows in fleet_rows.of(owner)]
    mine = _ids(made)
    return [_ending_at(rows, mine, whole=True) for rows in made]


def _rows(units: Sequence[Unit], plan: Plan, read: Read) -> Iterator[RobotRows]:
    placed, members = _placed(units, plan, read)
    fleet_rows = _fleet_rows(placed, members, plan, unit_of(units))
    core = _core(plan)
    made = [rows for owner in sorted(unit_of(units)) for rows in fleet_rows.of(owner)]
    mine = _ids(made)
    shared = {key for owner in core for key in _ids(fleet_rows.of(owner))}
    yield from (_derived_at(rows, mine | shared) for rows in made)
    for owner in core:
        yield from (_ending_at(rows, mine, whole=False) for rows in fleet_rows.of(owner))


def _ids(robots: Iterable[RobotRows]) -> set[str]:
    """The ids of elements, and of their intakes."""
    return {row["id"] for rows in robots for row in (*rows.elements, *rows.intakes)}


def _core(plan: Plan) -> list[str]:
    """The names under which the core is filed."""
    domains = {pseudo_robot(group.robots[0].domain) for group in plan.fixed if group.robots[0].domain}
    return sorted({plan.fleet.name, *(robot.id for group in plan.fixed for robot in group.robots), *domains})


def _placed(units: Sequence[Unit], plan: Plan, read: Read) -> tuple[Placed, dict[str, Member]]:
    names = {unit.name for unit in units}
    others = [unit for unit in plan.examples if unit.name not in names]
    groups = [*plan.fixed, *(group for unit in (*units, *others) for group in unit.groups)]
    return place_groups(plan.fleet, groups, read, plan.settings.view, plan.shared)


def _each_finding(part: Pairs) -> Iterator[tuple[int, int, bool, bool, bool]]:
    """(source, leak, dismissed, pseudonymised, beside) of each finding of the pairs."""
    columns = (part.sources, part.leaks, part.dismissed, part.pseudonymised, part.plain_also)
    for source, leak, dismissed, hidden, beside in zip(*(c.tolist() for c in columns), strict=True):
        yield source, leak, dismissed, hidden, False
        if beside:
            yield source, leak, True, False, True


def _fleet_rows(placed: Placed, members: Mapping[str, Member], plan: Plan, mine: Mapping[str, str]) -> FleetRows:
    """Findings that begin in our units: each that stays there or ends at what is shared, and one for all others."""
    vocabulary = load(ontologies=plan.settings.ontologies)
    unit = {**unit_of(plan.examples), **mine}

    def choose(spread: Spread, kinds: Sequence[Concern], mask: int) -> Choice:
        elements = spread.graph.elements
        owner = [unit.get(element.robot, "") for element in elements]
        ours = [element.robot in mine for element in elements]
        wanted: Choice = {}
        for part in pairs(spread, kinds, mask):
            beyond: dict[tuple[int, Element, bool], tuple[bool, bool, int]] = {}
            for source, leak, dismissed, hidden, beside in _each_finding(part):
                if owner[source] == owner[leak] or not owner[source] or not owner[leak]:
                    if ours[source] or ours[leak] or not (owner[source] or owner[leak]):
                        wanted.setdefault(source, set()).add((part.kind, leak, part.category, beside))
                elif ours[source]:
                    key = source, placed.likeness.alike(elements[leak]), beside
                    beyond[key] = min(beyond.get(key, (True, True, leak)), (dismissed, hidden, leak))
            for (source, _, beside), (_, _, leak) in beyond.items():
                wanted.setdefault(source, set()).add((part.kind, leak, part.category, beside))
        return wanted

    analysis = analyse(
        placed.graph,
        placed.bound,
        vocabulary.hierarchy,
        Options(choose=choose, today=plan.settings.today or "", bounds=plan.settings.bounds),
    )
    told = _doubts(placed, members, analysis, plan, mine)
    said: dict[str, dict[str, str | list[str]]] = {
        name: _properties(member, analysis, plan, vocabulary, told[name]) for name, member in members.items()
    }
    everything = {**plan.assumptions, "policies": [], "labels": [], "types": []}
    said |= {name: {"doubts": doubt_lines(some)} for name, some in told.items() if name not in said}
    said[plan.fleet.name] = remembered(everything, plan.joins, doubt_lines(told[plan.fleet.name]))
    analysis = replace(analysis, lacking=plan.lacking)
    verdicts = robot_verdicts(
        analysis, said, lambda element: element.robot, {*breaking(told), *plan.broken}, plan.leaking
    )
    more = {
        name: {**some, **({} if is_domain(name) else {"verdict": str(verdicts[name])})} for name, some in said.items()
    }
    return FleetRows(placed, analysis, vocabulary, more, most_across=0)


def _doubts(
    placed: Placed, members: Mapping[str, Member], analysis: Analysis, plan: Plan, mine: Mapping[str, str]
) -> dict[str, list[Doubt]]:
    """The doubts of each robot: about elements those of our units; about files, and the whole, all."""
    everything = dict.fromkeys((*(said for member in members.values() for said in member.diagnostics), *plan.joins))
    by_globs = answered_by_globs(analysis.spread, placed.bound, load(ontologies=plan.settings.ontologies).hierarchy)
    listed = doubts(analysis, everything, placed.likeness.weight, by_globs=by_globs)
    some = [doubt for doubt in listed if not doubt.element or doubt.element.robot in mine]
    names: dict[str, tuple[Diagnostic, ...]] = {element.robot: () for element in placed.graph.elements}
    names |= {plan.fleet.name: (), **{name: member.diagnostics for name, member in members.items()}}
    return doubts_by_robot([*some, *plan.doubts], names, placed.graph, placed.likeness, lambda element: element.robot)


def _properties(
    member: Member, analysis: Analysis, plan: Plan, vocabulary: Any, of_robot: list[Doubt]
) -> dict[str, str | list[str]]:
    files = {**files_read(member.policies, member.files, plan.settings), **types_read(member.types)}
    question = Question(plan.settings, vocabulary, None, None, plan.settings.today or "")
    said = assumptions_of(files, analysis, question)
    if said["standard_channels"]:
        spread = analysis.spread
        robots = [spread.graph.elements[vertex] for vertex in spread.standard]
        taken = {element.identity for element in robots if element.robot == member.robot.id}
        said["standard_channels"] = {**said["standard_channels"], "taken": len(taken)}
    return remembered(said, member.diagnostics, doubt_lines(of_robot))


def _derived_at(rows: RobotRows, ids: Collection[str]) -> RobotRows:
    """Without what is made of the data of other units."""
    parts = parts_of(rows)
    parts["derived"] = [row for row in rows.derived if row["target"] in ids]
    return rows_of(rows.robot, own_properties(rows.properties), _with_foreign(parts, rows))


def _ending_at(rows: RobotRows, ids: Collection[str], *, whole: bool) -> RobotRows:
    """Of what is shared, the flows, findings and what is made that end at some elements; or with all else, too."""
    parts = parts_of(rows)
    for name in ("flows", "findings", "derived", "carried"):
        parts[name] = [row for row in parts[name] if row["target"] in ids]
    found = {row["id"] for row in parts["findings"]}
    parts["across"] = [row for row in rows.across if row["source"] in found]
    if not whole:
        parts |= {"elements": [], "intakes": [], "enclaves": [], "memberships": [], "roles": {}}
    return rows_of(rows.robot, own_properties(rows.properties), _with_foreign(parts, rows))


def _with_foreign(parts: dict[str, Any], rows: RobotRows) -> dict[str, Any]:
    """Only those elements of others that the rows name."""
    named = {
        row[end]
        for name in ("flows", "derived", "carried", "findings")
        for row in parts[name]
        for end in ("source", "target")
    }
    named |= {row["target"] for row in parts["across"]}
    return {**parts, "foreign": [row for row in rows.foreign if row["id"] in named]}


def put_together(shares: Sequence[RobotRows]) -> RobotRows:
    """Return the rows of what is shared, made of those that parts have of it; the first says what it is."""
    first, *others = shares
    parts = parts_of(first)
    for rows in others:
        for name in ("flows", "derived", "carried", "findings", "across", "foreign"):
            parts[name] = [*parts[name], *getattr(rows, name)]
    parts["foreign"] = sorted({row["id"]: row for row in parts["foreign"]}.values(), key=lambda row: str(row["id"]))
    return rows_of(first.robot, own_properties(first.properties), parts)


def parts_of(rows: RobotRows) -> dict[str, Any]:
    """Return all but the robot and its properties, by name; what the enforced view adds only where it was asked for."""
    left_out = ("robot", "properties", *(() if "beyond" in rows.properties else ("beyond",)))
    return {field.name: getattr(rows, field.name) for field in fields(rows) if field.name not in left_out}


def own_properties(properties: Row) -> Row:
    """Return properties without what ``rows_of`` adds."""
    added = ("digest", "elements", "flows", "roles", "carried")
    return {key: value for key, value in properties.items() if key not in added}
