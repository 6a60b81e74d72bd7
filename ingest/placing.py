"""Fleet + what each kind of robot is -> one graph, in which a robot stands for all that are alike (S1, S9, S10).

In: a fleet, its groups, and the graph of one robot of each. Out: the graph of the fleet with all statements, and which
robot stands for which.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import FleetError, InputError, InputErrors, shown
from rosprivacy.analysis.model import Element
from rosprivacy.analysis.outside import by_kind
from rosprivacy.analysis.patterns import Likeness
from rosprivacy.ingest.alike import COLON, chosen, known_to_flows
from rosprivacy.ingest.domains import alone, pseudo_robot, shared
from rosprivacy.ingest.outside import FLOW, Ends, line_of, merged, missing
from rosprivacy.ingest.parts import Part, numbered, together

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.model import Bound, FlowGraph, Place, Profile, Statement
    from rosprivacy.analysis.outside import Outside
    from rosprivacy.ingest.alike import Alike
    from rosprivacy.ingest.domains import Member
    from rosprivacy.ingest.elements import Limit
    from rosprivacy.ingest.fleet import Fleet


@dataclass(frozen=True, slots=True)
class Placed:
    """The graph of a fleet.

    Attributes
    ----------
    likeness
        Which robots of the graph stand for which of the fleet.
    profiles
        By robot of the graph.
    """

    graph: FlowGraph
    bound: Bound
    likeness: Likeness
    profiles: Mapping[str, tuple[Profile, ...]]


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
    placing = _Placing(fleet)
    for group in groups:
        for robot in group.placed:
            placing.take(replace(members[group.robots[0].id], robot=robot))
    part, profiles = placing.part(view)
    if placing.problems:
        raise InputErrors(placing.problems)
    everything = {profile for some in profiles.values() for profile in some}
    graph, bound = numbered(
        part, sorted(everything, key=lambda p: (p.enclave, p.node, p.place.file, p.place.line)), view
    )
    return Placed(graph, bound, likeness(groups), profiles)


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

    def __init__(self, fleet: Fleet) -> None:
        self.problems: list[InputError] = []
        self._fleet = fleet
        self._members: list[Member] = []
        self._ends: dict[str, Ends] = {}

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
                self._ends[member.robot.id] = Ends(parts[-1].elements)
        for domain, members in sorted(domains.items()):
            parts.append(shared(domain, members, view))
            for member in members:
                self._ends[member.robot.id] = Ends(_seen_by(parts[-1], member.robot.id))
            self._ends[pseudo_robot(domain)] = Ends(_of(parts[-1], pseudo_robot(domain)))
        parts.append(self._own())
        whole = together(parts)
        whole.outside = {element: self._limited(element, facts) for element, facts in whole.outside.items()}
        self._add_flows(whole)
        return whole, {member.robot.id: member.profiles for member in self._members}

    def _own(self) -> Part:
        """The elements that the fleet file states."""
        fleet = self._fleet
        stated = merged(fleet.elements, self.problems, FleetError)
        said: dict[str, list[Statement]] = defaultdict(list)
        for entry in fleet.entries:
            said[entry.name] += entry.statements
        part = Part()
        for name, one in stated.items():
            element = Element(one.kind, name, fleet.name)
            part.elements[element] = (*dict.fromkeys(said[name]), *by_kind(element))
            part.outside[element] = one.outside
        self._ends[""] = Ends(part.elements)
        return part

    def _limited(self, element: Element, facts: Outside) -> Outside:
        """The facts with the limits that hold there: for what is shared, those of every robot."""
        limits: set[Limit] = {*facts.limits, *self._fleet.limits}
        if element.robot == self._fleet.name:
            limits |= {limit for member in self._members for file in member.files for limit in file.limits}
        return replace(facts, limits=tuple(sorted(limits, key=lambda pair: (pair[0], str(pair[1])))))

    def _add_flows(self, whole: Part) -> None:
        lines: dict[tuple[Element, Element, str], list[Place]] = defaultdict(list)
        for flow in self._fleet.flows:
            ends = [self._find(end, flow.place) for end in (flow.source, flow.target)]
            for source in ends[0]:
                for target in ends[1]:
                    key = (source, target, FLOW)
                    lines[key].append(flow.place)
                    whole.said[key] = tuple(dict.fromkeys((*whole.said.get(key, ()), *flow.statements)))
        for key, places in lines.items():
            known = whole.flows.get(key, ())
            new = [line_of(place) for place in sorted(set(places), key=lambda place: (place.file, place.line))]
            whole.flows[key] = tuple(dict.fromkeys((*known, *new)))
        whole.said = {key: said for key, said in whole.said.items() if said}

    def _find(self, end: str, place: Place) -> list[Element]:
        robots, colon, name = end.partition(COLON)
        if not colon:
            return self._named([""], end, end, place)
        known = known_to_flows(self._fleet)
        if not chosen(end, known):
            close = get_close_matches(robots, known, n=3, cutoff=0.5)
            hint = f"did you mean {' or '.join(close)}?" if close else "name robots of the fleet, such as *:/camera"
            what = f"a flow names the robot {shown(robots)!r}, which is not there"
            self.problems.append(FleetError(place.file, place.line, what, hint))
            return []
        return self._named(chosen(end, self._ends), name, end, place)

    def _named(self, owners: Iterable[str], name: str, end: str, place: Place) -> list[Element]:
        ends = [self._ends[owner] for owner in owners]
        found = [element for one in ends for element in one.find(name)]
        if not found and COLON not in end and name.startswith("/"):
            what = f"a flow names {shown(name)!r} and does not say on which robots"
            self.problems.append(FleetError(place.file, place.line, what, f"write *:{name}, or the robot's id"))
        elif not found:
            known = [other for one in ends for kind in one.names.values() for other in kind]
            self.problems.append(missing(name, known, place, FleetError))
        return found


def _seen_by(part: Part, robot: str) -> Iterable[Element]:
    """What belongs to a robot, and the channels of its domain that it writes or reads."""
    own = {element for element in part.elements if element.robot == robot}
    near = {other for a, b, _ in part.flows for one, other in ((a, b), (b, a)) if one in own and other.is_channel}
    return own | near


def _of(part: Part, robot: str) -> Iterable[Element]:
    return [element for element in part.elements if element.robot == robot]
