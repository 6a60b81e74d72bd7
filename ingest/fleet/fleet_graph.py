"""Fleet + what each kind of robot is -> one graph, in which a robot stands for all that are alike (S1, S9, S10).

In: a fleet, its groups, and the graph of one robot of each. Out: the graph of the fleet with all statements, and which
robot stands for which.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.durations import ordered
from rosprivacy.analysis.errors import FleetError, InputError, InputErrors, shown
from rosprivacy.analysis.fleet.likeness import Likeness
from rosprivacy.analysis.model import UNSTATED, Element, Surroundings
from rosprivacy.analysis.non_ros import by_kind
from rosprivacy.analysis.written_names import A_LITTLE, FEW, bare_name, did_you_mean, nearest
from rosprivacy.ingest.fleet.alike_robots import COLON, chosen, known_to_flows
from rosprivacy.ingest.fleet.dds_domains import alone, pseudo_robot, shared
from rosprivacy.ingest.fleet.mergeable_graph import Part, numbered, together
from rosprivacy.ingest.labels.add_non_ros import FLOW, FlowEnds, ambiguous, line_of, merged, missing, two_meanings
from rosprivacy.ingest.labels.entries import End
from rosprivacy.ingest.labels.stated_facts import joined, over, united

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, FlowGraph, NonRosFacts, Place, Processing, Profile, Statement
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.dds_domains import Member
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.ingest.fleet.joins import Met
    from rosprivacy.ingest.fleet.mergeable_graph import Key
    from rosprivacy.ingest.labels.entries import FlowEntry, Limit


@dataclass(frozen=True, slots=True)
class Placed:
    """The graph of a fleet.

    Attributes
    ----------
    likeness
        Which robots of the graph stand for which of the fleet.
    profiles
        By robot of the graph.
    met
        Where the flows of the fleet file begin and end.
    feeding
        The elements from which these lead to robots: of some robots, also to those that are not placed.
    """

    graph: FlowGraph
    bound: Bound
    likeness: Likeness
    profiles: Mapping[str, tuple[Profile, ...]]
    met: frozenset[Met] = frozenset()
    feeding: frozenset[Element] = frozenset()


def place(fleet: Fleet, groups: Sequence[Alike], members: Mapping[str, Member], view: str) -> Placed:
    """Make the graph of a fleet.

    Parameters
    ----------
    members
        By id of the first robot of each group.

    Raises
    ------
    InputErrors
        With every robot and element that a flow names and that is not there.
    """
    return _placed(_Placing(fleet), groups, members, view)


def _placed(placing: _Placing, groups: Sequence[Alike], members: Mapping[str, Member], view: str) -> Placed:
    for group in groups:
        for robot in group.placed:
            placing.take(replace(members[group.robots[0].id], robot=robot))
    part, profiles = placing.part(view)
    if placing.problems:
        raise InputErrors(placing.problems)
    graph, bound = numbered(part, profiles, view)
    return Placed(graph, bound, likeness(groups), profiles, frozenset(placing.met), frozenset(placing.feeding))


@dataclass(frozen=True, slots=True)
class Some:
    """A part of a fleet, placed by itself.

    Attributes
    ----------
    part
        With the flows of the fleet file that stay within it.
    ends
        Per flow of the fleet file: the elements here that its two ends mean.
    restated
        Lines of the fleet file that state a flow within one robot of which a label file says more.
    met
        Where the flows of the fleet file begin and end here.
    """

    part: Part
    profiles: Mapping[str, tuple[Profile, ...]]
    ends: tuple[tuple[tuple[Element, ...], tuple[Element, ...]], ...]
    restated: tuple[Place, ...]
    met: frozenset[Met] = frozenset()


def place_some(fleet: Fleet, members: Iterable[Member], view: str, *, own: bool) -> Some:
    """Place some robots; a name that is not there may be on others.

    Parameters
    ----------
    own
        Whether the elements of the fleet file belong to these. Limits of the other robots are not known here.

    Raises
    ------
    InputErrors
        If the fleet file defines an element twice.
    """
    placing = _Placing(fleet, whole=False, own=own)
    for member in members:
        placing.take(member)
    part, profiles = placing.part(view)
    if placing.problems:
        raise InputErrors(placing.problems)
    return Some(part, profiles, tuple(placing.ends()), tuple(placing.restated), frozenset(placing.met))


def place_chosen(fleet: Fleet, groups: Sequence[Alike], members: Mapping[str, Member], view: str) -> Placed:
    """Make the graph of some robots of a fleet and of what they share, as ``place`` does of all."""
    return _placed(_Placing(fleet, whole=False), groups, members, view)


def flow_said(
    flow: FlowEntry, key: Key, lines: dict[Key, list[Place]], flow_statements: dict[Key, tuple[Statement, ...]]
) -> None:
    """Note that a line states a flow, with what it says of it."""
    lines[key].append(flow.place)
    flow_statements[key] = tuple(dict.fromkeys((*flow_statements.get(key, ()), *flow.statements)))


def add_lines(part: Part, lines: Mapping[Key, Sequence[Place]]) -> None:
    """Add the lines that state flows, and drop what is empty."""
    for key, places in lines.items():
        known = part.flows.get(key, ())
        new = [line_of(place) for place in sorted(set(places), key=lambda place: (place.file, place.line))]
        part.flows[key] = tuple(dict.fromkeys((*known, *new)))
    part.flow_statements = {key: said for key, said in part.flow_statements.items() if said}


def nowhere(flow: FlowEntry, end: End, names: Iterable[str]) -> InputError:
    """Return the error for the end of a flow that is on no robot; ``names`` are the names that it could mean."""
    name = end.name.partition(COLON)[2] if COLON in end.name else end.name
    if COLON not in end.name and bare_name(name).startswith("/"):
        what = f"a flow names {shown(name)!r} and does not say on which robots"
        return FleetError(flow.place.file, flow.place.line, what, f"write *:{name}, or the robot's id")
    return missing(End(name, end.kind), names, flow.place, FleetError)


def no_robot(fleet: Fleet, flow: FlowEntry, end: str) -> InputError | None:
    """Return the error for the end of a flow that means no robot of the fleet."""
    robots, colon, _ = end.partition(COLON)
    known = known_to_flows(fleet)
    if not colon or chosen(end, known):
        return None
    close = nearest(robots, known, FEW, A_LITTLE)
    hint = did_you_mean(close, "name robots of the fleet, such as *:/camera")
    what = f"a flow names the robot {shown(robots)!r}, which is not there"
    return FleetError(flow.place.file, flow.place.line, what, hint)


def likeness(groups: Iterable[Alike]) -> Likeness:
    """Return which robots stand for which."""
    robots = [group for group in groups if not group.fixed]
    return Likeness(
        {group.robots[0].id: tuple(robot.id for robot in group.robots) for group in robots},
        {group.placed[1].id: group.robots[0].id for group in robots if len(group.placed) > 1},
        {group.robots[0].id: group.robots[0].model for group in robots},
    )


class _Placing:
    """Puts the parts of robots, domains and the fleet itself together."""

    def __init__(self, fleet: Fleet, *, whole: bool = True, own: bool = True) -> None:
        self.problems: list[InputError] = []
        self.restated: list[Place] = []
        self.met: set[Met] = set()
        self.feeding: set[Element] = set()
        self._fleet = fleet
        self._whole = whole
        self._owns = own
        self._members: list[Member] = []
        self._ends: dict[str, FlowEnds] = {}

    def take(self, member: Member) -> None:
        """Place a robot."""
        self._members.append(member)

    def part(self, view: str) -> tuple[Part, dict[str, tuple[Profile, ...]]]:
        """Return the whole, and the profiles of each robot."""
        domains: dict[str, list[Member]] = defaultdict(list)
        parts = []
        for member in self._members:
            if member.robot.domain:
                domains[member.robot.domain].append(member)
            else:
                parts.append(alone(member))
                self._ends[member.robot.id] = FlowEnds(parts[-1].elements)
        for domain, members in sorted(domains.items()):
            parts.append(shared(domain, members, view, self._fleet.bounds))
            for member in members:
                self._ends[member.robot.id] = FlowEnds(_seen_by(parts[-1], member.robot.id))
            self._ends[pseudo_robot(domain)] = FlowEnds(_of(parts[-1], pseudo_robot(domain)))
        parts.append(self._own())
        whole = together(parts)
        whole.of_robots = self._responsible(whole)
        whole.outside = {element: self._limited(element, facts) for element, facts in whole.outside.items()}
        self._add_flows(whole)
        return whole, {member.robot.id: member.profiles for member in self._members}

    def _own(self) -> Part:
        """The elements that the fleet file states."""
        fleet = self._fleet
        stated = merged(fleet.elements, self.problems, FleetError) if self._owns else {}
        said: dict[str, list[Statement]] = defaultdict(list)
        for entry in fleet.entries:
            said[entry.name] += entry.statements
        part = Part()
        for name, one in stated.items():
            element = Element(one.kind, name, fleet.name)
            part.elements[element] = (*dict.fromkeys(said[name]), *by_kind(element))
            part.outside[element] = one.outside
            about = [entry for entry in fleet.entries if entry.name == name]
            part.subjects[element] = tuple(g for entry in about for g in entry.subjects)
            part.processing[element] = united((entry.rank, entry.processing) for entry in about)
            own = (Surroundings(entry.contexts) for entry in about)
            part.surroundings[element] = joined((Surroundings(fleet.surroundings.contexts), *own))
        part.subjects = {element: groups for element, groups in part.subjects.items() if groups}
        part.processing = {element: said for element, said in part.processing.items() if said}
        part.surroundings = {element: where for element, where in part.surroundings.items() if where}
        self._ends[""] = FlowEnds(part.elements)
        return part

    def _responsible(self, whole: Part) -> dict[str, Processing]:
        """What is said of each robot, and of what is shared: where its label files say nothing, what the fleet says."""
        own = {member.robot.id: member.bound.of_robots.get("", UNSTATED) for member in self._members}
        owners = sorted({element.robot for element in whole.elements})
        said = {owner: over(own.get(owner, UNSTATED), self._fleet.processing) for owner in owners}
        return {owner: one for owner, one in said.items() if one}

    def _limited(self, element: Element, facts: NonRosFacts) -> NonRosFacts:
        """The facts with the limits that hold there: for what is shared, those of every robot."""
        limits: set[Limit] = {*facts.limits, *self._fleet.limits}
        if element.robot == self._fleet.name:
            limits |= {limit for member in self._members for file in member.files for limit in file.limits}
        return facts._replace(limits=ordered(limits))

    def ends(self) -> Iterator[tuple[tuple[Element, ...], tuple[Element, ...]]]:
        """Return, per flow of the fleet file, the elements that its ends mean."""
        for number, flow in enumerate(self._fleet.flows):
            source, target = flow.ends
            sources = tuple(self._find(source, flow, (number, 0)))
            yield sources, tuple(self._find(target, flow, (number, 1)))

    def _add_flows(self, whole: Part) -> None:
        lines: dict[Key, list[Place]] = defaultdict(list)
        for flow, (sources, targets) in zip(self._fleet.flows, self.ends(), strict=True):
            self.feeding.update(sources if COLON in flow.target else ())
            for source in sources:
                for target in targets:
                    key = (source, target, FLOW)
                    if source.robot == target.robot and key not in lines and whole.flow_statements.get(key):
                        self.restated.append(flow.place)
                    flow_said(flow, key, lines, whole.flow_statements)
        add_lines(whole, lines)

    def _find(self, end: End, flow: FlowEntry, at: tuple[int, int]) -> list[Element]:
        if self._whole and (problem := no_robot(self._fleet, flow, end.name)):
            self.problems.append(problem)
            return []
        robots = chosen(end.name, self._ends) if COLON in end.name else [""]
        name = end.name.partition(COLON)[2] if COLON in end.name else end.name
        ends = [self._ends[robot] for robot in robots]
        there = {robot: one.find(End(name, end.kind)) for robot, one in zip(robots, ends, strict=True)}
        self.met |= {(*at, robot) for robot, elements in there.items() if elements}
        found = [element for elements in there.values() for element in elements]
        kinds = next((kinds for elements in there.values() if (kinds := two_meanings(end, elements))), ())
        if kinds:
            self.problems.append(ambiguous(end, kinds, flow.place, FleetError))
        if self._whole and not found:
            known = [other for one in ends for kind in one.names.values() for other in kind]
            self.problems.append(nowhere(flow, end, known))
        return found


def _seen_by(part: Part, robot: str) -> Iterable[Element]:
    """What belongs to a robot, and the channels of its domain that it writes or reads."""
    own = {element for element in part.elements if element.robot == robot}
    near = {other for a, b, _ in part.flows for one, other in ((a, b), (b, a)) if one in own and other.is_channel}
    return own | near


def _of(part: Part, robot: str) -> Iterable[Element]:
    return [element for element in part.elements if element.robot == robot]
