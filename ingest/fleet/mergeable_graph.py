"""Flow graphs with what is said about them, by element and not by number, so that many become one.

In: graphs and bound statements. Out: ``Part``, under other names, which can be put together; and numbers again.

Elements are asked for their hash as seldom as may be: of a large fleet that is much of the work.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import starmap
from operator import itemgetter
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.model import Bound, Element, Flow, FlowGraph
from rosprivacy.ingest.labels.stated_facts import in_order

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.model import (
        Exposure,
        Grant,
        MessageType,
        NonRosFacts,
        Processing,
        Profile,
        Statement,
        Surroundings,
    )

K = TypeVar("K")
V = TypeVar("V")
Key = tuple[Element, Element, str]  # source, target, role of a flow


@dataclass(slots=True)
class Part:
    """A part of a graph.

    Attributes
    ----------
    elements
        With the statements about each.
    flows
        Allowed ones, with their grants.
    denied
        With grants and denials; matches that DENYs take out too.
    flow_statements
        Statements about flows.
    through
        (source, name expressions) -> the flows that these mean.
    outside
        What is stated about elements outside ROS.
    subjects, surroundings, processing
        Whom data of elements are about; where they work; what data there are processed for, and on which basis.
    of_robots
        By robot: who is responsible, what for, on which basis.
    types
        Message types of channels.
    exposed
        Why who is on the network can read what flows on channels.
    """

    elements: dict[Element, tuple[Statement, ...]] = field(default_factory=dict)
    flows: dict[Key, tuple[Grant, ...]] = field(default_factory=dict)
    denied: dict[Key, tuple[tuple[Grant, ...], tuple[Grant, ...]]] = field(default_factory=dict)
    flow_statements: dict[Key, tuple[Statement, ...]] = field(default_factory=dict)
    through: dict[tuple[Element, tuple[str, ...]], tuple[Key, ...]] = field(default_factory=dict)
    outside: dict[Element, NonRosFacts] = field(default_factory=dict)
    subjects: dict[Element, tuple[str, ...]] = field(default_factory=dict)
    surroundings: dict[Element, Surroundings] = field(default_factory=dict)
    processing: dict[Element, Processing] = field(default_factory=dict)
    of_robots: dict[str, Processing] = field(default_factory=dict)
    types: dict[Element, tuple[MessageType, ...]] = field(default_factory=dict)
    exposed: dict[Element, tuple[Exposure, ...]] = field(default_factory=dict)

    @classmethod
    def of(cls, graph: FlowGraph, bound: Bound, name: Callable[[Element], Element]) -> Part:
        """Take the numbers out of a graph and its statements, without what is said of robots.

        Parameters
        ----------
        name
            Gives each element its name; two may become one.
        """
        elements = [name(element) for element in graph.elements]
        keys = [(elements[flow.source], elements[flow.target], flow.role) for flow in graph.flows]
        return cls(
            _joined([(element, bound.elements.get(vertex, ())) for vertex, element in enumerate(elements)]),
            _joined([(key, flow.grants) for key, flow in zip(keys, graph.flows, strict=True)]),
            {(elements[f.source], elements[f.target], f.role): (f.grants, f.denials) for f in graph.taken_back},
            _joined([(keys[index], said) for index, said in bound.flows.items()]),
            {(elements[v], names): tuple(keys[i] for i in flows) for (v, names), flows in bound.through.items()},
            {elements[vertex]: facts for vertex, facts in bound.outside.items()},
            _joined([(elements[vertex], groups) for vertex, groups in bound.subjects.items()]),
            {elements[vertex]: where for vertex, where in bound.surroundings.items()},
            {elements[vertex]: said for vertex, said in bound.processing.items()},
            types=_joined([(elements[vertex], types) for vertex, types in bound.types.items()]),
            exposed=_joined([(elements[vertex], some) for vertex, some in bound.exposed.items()]),
        )


def together(parts: Iterable[Part]) -> Part:
    """Put parts together: what they have in common is one, with all that any of them says of it."""
    parts = list(parts)
    return Part(
        _merged([part.elements for part in parts]),
        _merged([part.flows for part in parts]),
        {key: both for part in parts for key, both in part.denied.items()},
        _merged([part.flow_statements for part in parts]),
        _merged([part.through for part in parts]),
        {element: facts for part in parts for element, facts in part.outside.items()},
        _merged([part.subjects for part in parts]),
        {element: where for part in parts for element, where in part.surroundings.items()},
        {element: said for part in parts for element, said in part.processing.items()},
        {robot: said for part in parts for robot, said in part.of_robots.items()},
        _merged([part.types for part in parts]),
        _merged([part.exposed for part in parts]),
    )


def numbered(part: Part, profiles: Mapping[str, tuple[Profile, ...]], view: str) -> tuple[FlowGraph, Bound]:
    """Number the elements and sort everything (rule S14); a flow that one part allows is not denied.

    Parameters
    ----------
    profiles
        By robot; what several have is there once.
    """
    everything = {profile for some in profiles.values() for profile in some}
    sorted_profiles = sorted(everything, key=lambda p: (p.enclave, p.node, p.place.file, p.place.line))
    elements = tuple(sorted(part.elements, key=Element.sort_key))
    number = {element: i for i, element in enumerate(elements)}

    def ends(key: Key) -> tuple[int, int, str]:
        return (number[key[0]], number[key[1]], key[2])

    rows = sorted(
        [(number[a], number[b], role, grants) for (a, b, role), grants in part.flows.items()]
    )  # none is twice
    index = {row[:3]: i for i, row in enumerate(rows)} if part.flow_statements or part.through else {}
    flows = tuple(starmap(Flow, rows))
    refused = [(*ends(key), *both) for key, both in part.denied.items() if key not in part.flows]
    denied = [Flow(*row) for row in sorted(refused, key=itemgetter(0, 1, 2))]
    graph = FlowGraph(
        elements,
        flows,
        tuple(flow for flow in denied if flow.role != "matches"),
        tuple(sorted_profiles),
        view,
        tuple(flow for flow in denied if flow.role == "matches"),
    )
    bound = Bound(
        {number[element]: said for element, said in part.elements.items() if said},
        {index[ends(key)]: said for key, said in part.flow_statements.items() if said},
        {
            (number[v], names): tuple(sorted(index[ends(key)] for key in keys))
            for (v, names), keys in part.through.items()
        },
        _by_number(number, part.outside),
        _by_number(number, {element: tuple(sorted(groups)) for element, groups in part.subjects.items()}),
        _by_number(number, part.surroundings),
        _by_number(number, part.processing),
        dict(sorted(part.of_robots.items())),
        types=in_order(_by_number(number, part.types)),
        exposed=_by_number(number, {element: tuple(sorted(some)) for element, some in part.exposed.items()}),
    )
    return graph, replace(bound, elements=dict(sorted(bound.elements.items())), flows=dict(sorted(bound.flows.items())))


def _by_number(number: Mapping[Element, int], values: Mapping[Element, V]) -> dict[int, V]:
    return dict(sorted(((number[element], one) for element, one in values.items()), key=itemgetter(0)))


def _merged(parts: Sequence[Mapping[K, tuple[V, ...]]]) -> dict[K, tuple[V, ...]]:
    """Dictionaries put together; most have no key in common."""
    found: dict[K, tuple[V, ...]] = {}
    for part in parts:
        found.update(part)
    return found if len(found) == sum(map(len, parts)) else _joined([pair for part in parts for pair in part.items()])


def _joined(pairs: Sequence[tuple[K, tuple[V, ...]]]) -> dict[K, tuple[V, ...]]:
    """Tuples of one key put together, each value once."""
    found = dict(pairs)
    if len(found) == len(pairs):
        return found
    found = {}
    for key, values in pairs:
        found[key] = tuple(dict.fromkeys((*found[key], *values))) if key in found else values
    return found
