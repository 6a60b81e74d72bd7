"""Fleet -> units that meet only at what they share (rules S1, S9), so that each can be read and analysed elsewhere.

In: a fleet, its groups of robots that are alike, and units that were placed by themselves. Out: the graph of some
units, in which what is shared is a border; and the graph of the core, where all units meet.

A unit is the robots of one DDS domain, or robots that are alike. The core is the elements of the fleet file, and the
infrastructure that shares no domain with a robot. A flow of the fleet file from unit to unit leads through a hub: one
for all elements that the same lines name as source, so that there is no flow for each pair of robots.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.durations import ordered
from rosprivacy.analysis.model import Element
from rosprivacy.ingest.fleet.alike_robots import COLON
from rosprivacy.ingest.fleet.dds_domains import pseudo_robot
from rosprivacy.ingest.fleet.fleet_graph import Some, add_lines, flow_said
from rosprivacy.ingest.fleet.mergeable_graph import Part, numbered, together
from rosprivacy.ingest.labels.add_non_ros import FLOW

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.model import Bound, FlowGraph, Place, Profile
    from rosprivacy.ingest.fleet.alike_robots import Alike
    from rosprivacy.ingest.fleet.fleet_file import Fleet
    from rosprivacy.ingest.fleet.joins import Met
    from rosprivacy.ingest.fleet.mergeable_graph import Key
    from rosprivacy.ingest.labels.entries import Limit

HUB, GATE = "\0hub", "\0gate"  # in place of a robot; none has such a name
Lines = frozenset[int]  # numbers of flows of the fleet file


@dataclass(frozen=True, slots=True)
class Unit:
    """Robots that are read and placed together; ``name`` is that of the first."""

    name: str
    groups: tuple[Alike, ...]


@dataclass(frozen=True, slots=True)
class Border:
    """What all parts agree on.

    Attributes
    ----------
    elements
        Of the core, where flows come from units or go to them; then the hubs.
    ends
        Per flow of the fleet file: the elements of the core that its ends mean.
    hubs
        The lines that name an element of a unit as source -> the hub that takes its data to other units.
    """

    elements: tuple[Element, ...]
    ends: tuple[tuple[tuple[Element, ...], tuple[Element, ...]], ...]
    hubs: Mapping[Lines, Element]


@dataclass(frozen=True, slots=True)
class Piece:
    """The graph of some units, or of the core.

    Attributes
    ----------
    border
        Vertex of each element of the border.
    unit
        By vertex: number of its unit among those of the piece, or -1.
    """

    graph: FlowGraph
    bound: Bound
    border: tuple[int, ...]
    unit: tuple[int, ...]
    profiles: Mapping[str, tuple[Profile, ...]]


def split(groups: Iterable[Alike]) -> tuple[tuple[Alike, ...], tuple[Unit, ...]]:
    """Return the infrastructure of the core, and the units, by name."""
    domains: dict[str, list[Alike]] = defaultdict(list)
    alone = []
    for group in groups:
        if group.robots[0].domain:
            domains[group.robots[0].domain].append(group)
        else:
            alone.append([group])
    together = [*alone, *domains.values()]
    core = tuple(group for some in together if all(group.fixed for group in some) for group in some)
    units = [Unit(some[0].robots[0].id, tuple(some)) for some in together if not all(group.fixed for group in some)]
    return core, tuple(sorted(units, key=lambda unit: unit.name))


def unit_of(units: Iterable[Unit]) -> dict[str, str]:
    """Return robot of the graph, or domain -> name of its unit."""
    found: dict[str, str] = {}
    for unit in units:
        for group in unit.groups:
            found |= {robot.id: unit.name for robot in group.placed}
            if group.robots[0].domain:
                found[pseudo_robot(group.robots[0].domain)] = unit.name
    return found


def joined_to(units: AbstractSet[str], met: Iterable[Met], at: Border, unit: Mapping[str, str]) -> set[str]:
    """Return units from which flows of the fleet file lead to what is shared and to some units; and the other way.

    Of each line, or element that is shared, one: where few robots are shown, nobody is to read of one of them, or of
    what all share, that no flow leads there.

    Parameters
    ----------
    unit
        Robot -> name of its unit.
    """
    sides: dict[int, tuple[list[str], list[str]]] = defaultdict(lambda: ([], []))
    for line, side, robot in sorted(met):
        if robot in unit:
            sides[line][side].append(unit[robot])
    found: set[str] = set()
    elements: set[tuple[Element, int]] = set()
    for line, ends in sorted(sides.items()):
        for side, other in ((0, 1), (1, 0)):
            shared = {(element, side) for element in at.ends[line][other]} - elements
            if ends[side] and (shared or not units.isdisjoint(ends[other])) and units.isdisjoint(ends[side]):
                found.add(ends[side][0])
            elements |= shared if ends[side] else set()
    return found


def crossing_lines(fleet: Fleet) -> Lines:
    """Return the flows of the fleet file that can lead from robot to robot."""
    return frozenset(i for i, flow in enumerate(fleet.flows) if COLON in flow.source and COLON in flow.target)


def naming_lines(placed: Some, lines: Lines, side: int) -> dict[Element, Lines]:
    """Return, for the elements that these lines name as source (side 0) or target (1), which do."""
    found: dict[Element, set[int]] = defaultdict(set)
    for line in lines:
        for element in placed.ends[line][side]:
            found[element].add(line)
    return {element: frozenset(which) for element, which in found.items()}


def border(core: Some, hubs: Iterable[Lines]) -> Border:
    """Return the border: all that lines name in the core, and a hub for each set of lines."""
    elements = {element for ends in core.ends for side in ends for element in side}
    made = {
        lines: Element("side-channel", f"hub {number}", HUB) for number, lines in enumerate(sorted(hubs, key=sorted))
    }
    return Border((*sorted(elements, key=Element.sort_key), *made.values()), core.ends, made)


def units_piece(fleet: Fleet, units: Sequence[Some], at: Border, view: str) -> Piece:
    """Return the graph of some units with the border."""
    whole = together([some.part for some in units])
    unit = {element: number for number, some in enumerate(units) for element in some.part.elements}
    whole.elements |= dict.fromkeys(at.elements, ())
    lines: dict[Key, list[Place]] = defaultdict(list)
    crossing = crossing_lines(fleet)
    for some in units:
        for (sources, targets), (from_core, to_core), flow in zip(some.ends, at.ends, fleet.flows, strict=True):
            pairs = [*((a, b) for a in sources for b in to_core), *((a, b) for a in from_core for b in targets)]
            for a, b in pairs:
                flow_said(flow, (a, b, FLOW), lines, whole.flow_statements)
        for element, which in naming_lines(some, crossing, 0).items():
            whole.flows[element, at.hubs[which], FLOW] = ()
        for element, which in naming_lines(some, crossing, 1).items():
            for others, hub in at.hubs.items():
                for line in sorted(which & others):
                    flow_said(fleet.flows[line], (hub, element, FLOW), lines, whole.flow_statements)
    add_lines(whole, lines)
    profiles = {robot: found for some in units for robot, found in some.profiles.items()}
    return _numbered(whole, at.elements, unit, profiles, view)


def core_piece(core: Some, at: Border, view: str) -> tuple[Piece, tuple[int, ...]]:
    """Return the graph of the core, and its gates: one before each element of the border."""
    whole = Part(**{name: dict(getattr(core.part, name)) for name in Part.__slots__})
    gates = [Element("side-channel", f"gate {number}", GATE) for number in range(len(at.elements))]
    whole.elements |= dict.fromkeys((*at.hubs.values(), *gates), ())
    whole.flows |= {(gate, element, FLOW): () for gate, element in zip(gates, at.elements, strict=True)}
    piece = _numbered(whole, at.elements, {}, core.profiles, view)
    vertex = {element: i for i, element in enumerate(piece.graph.elements)}
    return piece, tuple(vertex[gate] for gate in gates)


def with_limits(piece: Piece, fleet: Fleet, limits: Iterable[Limit]) -> Piece:
    """Return the core with the limits that hold for what is shared: those of the label files of every robot."""
    outside = dict(piece.bound.outside)
    for vertex, facts in outside.items():
        if piece.graph.elements[vertex].robot == fleet.name:
            known = {*facts.limits, *limits}
            outside[vertex] = facts._replace(limits=ordered(known))
    return replace(piece, bound=replace(piece.bound, outside=outside))


def _numbered(
    whole: Part,
    at: Iterable[Element],
    unit: Mapping[Element, int],
    profiles: Mapping[str, tuple[Profile, ...]],
    view: str,
) -> Piece:
    graph, bound = numbered(whole, profiles, view)
    vertex = {element: i for i, element in enumerate(graph.elements)}
    units = tuple(unit.get(element, -1) for element in graph.elements)
    return Piece(graph, bound, tuple(vertex[element] for element in at), units, profiles)
