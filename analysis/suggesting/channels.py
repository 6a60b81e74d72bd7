"""Channels: who writes and who reads each, and what its types and its name suggest of what goes through it.

Who writes and reads is by the flows of grants, without standard channels (rules S3, S13); what a wildcard covers is not
followed, since a grant for everything says nothing of what a node is for. How types and names go together:

1. A type that the table knows says which kinds, with its confidence. Of several types of a channel each says its own.
2. The name of a topic says no more than ``may`` by itself. It is not asked about services and actions, whose names are
   verbs, nor of a kind that the types cannot carry, nor where the types are known and suggest nothing, unless what the
   name says can have any type.
3. Where the name says that it is something else (a depth image), what the type says of that (video) is ``may``.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import CANNOT, Confidence, interface_of
from rosprivacy.analysis.suggesting.evidence import NAMED, TYPE
from rosprivacy.analysis.suggesting.name_rules import of_topic

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.type_limits import TypeLimit
    from rosprivacy.analysis.model import Bound, Element, FlowGraph, Place, Suggestion
    from rosprivacy.analysis.suggesting.name_rules import NameRules

    Key = tuple[str, str]  # name of a type, leg


class Traffic(NamedTuple):
    """By vertex of a node the vertices of channels that it writes and reads; by channel who writes it; sorted."""

    writes: Mapping[int, tuple[int, ...]]
    reads: Mapping[int, tuple[int, ...]]
    writers: Mapping[int, tuple[int, ...]]


def traffic(graph: FlowGraph, bound: Bound) -> Traffic:
    """Return the traffic of a graph; of a service or action each leg is a channel (rule S2).

    >>> from rosprivacy.analysis.example import CAMERA, FILTER, factory
    >>> graph, bound, _ = factory()
    >>> known = traffic(graph, bound)
    >>> named = lambda vertices: [graph.elements[vertex].name for vertex in vertices]
    >>> named(known.writes[CAMERA]), named(known.reads[FILTER]), named(known.writers[known.writes[CAMERA][0]])
    (['/video'], ['/video'], ['/camera'])
    """
    is_channel = [element.is_channel for element in graph.elements]
    standard = standard_in(bound)
    found: list[dict[int, set[int]]] = [defaultdict(set) for _ in Traffic._fields]
    writes, reads, writers = found
    for _, flow in parted(graph.flows)[0]:  # a meeting is one of channels
        source, target = flow.source, flow.target
        if is_channel[source] == is_channel[target] or source in standard or target in standard:
            continue
        if is_channel[target]:
            writes[source].add(target)
            writers[target].add(source)
        else:
            reads[target].add(source)
    return Traffic(*({at: tuple(sorted(ends)) for at, ends in sorted(one.items())} for one in found))


def standard_in(bound: Bound) -> set[int]:
    """Return the vertices of which a shipped file says that they are standard: nothing else decides the traffic.

    >>> from rosprivacy.analysis.example import factory
    >>> graph, bound, _ = factory()
    >>> [graph.elements[vertex].name for vertex in standard_in(bound)]
    ['/rosout']
    """
    return {
        vertex for vertex, said in bound.elements.items() if any(one.shipped and one.role != CANNOT for one in said)
    }


class Rules(NamedTuple):
    """What is known of types and names, and of kinds.

    Attributes
    ----------
    suggestions
        By type and leg; none for a type that was looked at and suggests no kind.
    limits
        What types cannot carry.
    """

    suggestions: Mapping[Key, tuple[Suggestion, ...]]
    limits: Mapping[Key, TypeLimit]
    names: NameRules
    hierarchy: Hierarchy

    def related_to_one(self, kind: str, kinds: Iterable[str]) -> bool:
        """Return whether data of one kind can be of one of some others."""
        return not self.hierarchy.overlaps[kind].keys().isdisjoint(kinds)

    def limited(self, kind: str, key: Key) -> bool:
        """Return whether a type cannot carry a kind."""
        limit = self.limits.get(key)
        return limit is not None and kind in limit.kinds

    def excludes(self, kind: str, key: Key) -> bool:
        """Return whether a type is not made for a kind: it cannot carry it, or suggests other kinds."""
        suggested = self.suggestions.get(key)
        others = suggested is not None and not any(self.related_to_one(kind, rule.kinds) for rule in suggested)
        return others or self.limited(kind, key)

    def cannot_carry(self, kind: str, element: Element, types: Sequence[str]) -> bool:
        """Return whether a channel is not made for a kind, by all of its types."""
        return bool(types) and all(self.excludes(kind, (interface_of(name), element.leg)) for name in types)

    def no_leg_carries(self, kind: str, type_: str, legs: Iterable[str]) -> bool:
        """Return whether a type is not made for a kind, in none of its legs.

        Where the table limits one leg and not another, the other has a text or a field that can carry anything.
        """
        keys = [(interface_of(type_), leg) for leg in legs]
        limited = [self.limited(kind, key) for key in keys]
        return all(self.excludes(kind, key) for key in keys) and (all(limited) or not any(limited))

    def suggests_nothing(self, kind: str, type_: str, legs: Iterable[str]) -> bool:
        """Return whether the table says of a type, in all legs, that it suggests no kind, or cannot carry this one.

        A type that suggests another kind is not enough: in a map there is what a scanner saw.
        """
        keys = [(interface_of(type_), leg) for leg in legs]
        return all(self.suggestions.get(key) == () or self.limited(kind, key) for key in keys)


class Clue(NamedTuple):
    """One reason to think that a channel carries a kind."""

    kind: str
    ground: str
    confidence: Confidence
    reason: str
    place: Place


def carried_kinds(graph: FlowGraph, bound: Bound, rules: Rules) -> dict[int, tuple[Clue, ...]]:
    """Return what is suggested of each channel of a graph, by vertex; what suggests nothing is left out.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import VIDEO, factory
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> graph, bound, hierarchy = factory()
    >>> clues = carried_kinds(graph, bound, Rules({}, {}, NAMES, hierarchy))
    >>> [(graph.elements[vertex].name, one.kind, one.reason) for vertex, said in clues.items() for one in said]
    [('/faces', 'FaceTemplate', "'faces' in the name /faces"), ('/video', 'Video', "'video' in the name /video")]
    """
    channels = ((vertex, element) for vertex, element in enumerate(graph.elements) if element.is_channel)
    clues = (
        (vertex, _clues(element, {one.name: one.place for one in reversed(bound.types.get(vertex, ()))}, rules))
        for vertex, element in channels
    )
    return {vertex: some for vertex, some in clues if some}


def _clues(element: Element, types: Mapping[str, Place], rules: Rules) -> tuple[Clue, ...]:
    by_type = [clue for name, place in sorted(types.items()) for clue in _by_type(name, place, element, rules)]
    spoken = of_topic(element.name, rules.names) if element.kind == "topic" else None
    keys = [(interface_of(name), "") for name in types]
    looked_at = bool(keys) and not by_type and all(key in rules.suggestions for key in keys)
    if spoken is None or (looked_at and not spoken.rule.any_type):
        return tuple(dict.fromkeys(by_type))
    reason = f"{spoken.quoted} in the name {element.name}"
    by_name = [
        Clue(kind, NAMED, spoken.rule.confidence, reason, spoken.rule.place)
        for kind in spoken.rule.kinds
        if not keys or not all(rules.limited(kind, key) for key in keys)
    ]
    instead_of = spoken.rule.instead_of if by_name else ()
    by_type = [one._replace(confidence=Confidence.MAY) if one.kind in instead_of else one for one in by_type]
    return tuple(dict.fromkeys([*by_type, *by_name]))


def _by_type(name: str, place: Place, element: Element, rules: Rules) -> Iterator[Clue]:
    for rule in rules.suggestions.get((interface_of(name), element.leg), ()):
        for kind in rule.kinds:
            yield Clue(kind, TYPE, rule.confidence, f"type {name} of {element.name} ({place}): {rule.why}", rule.place)
