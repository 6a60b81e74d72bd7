"""What message types cannot carry, at the channels of a graph: statements of the lowest rank (rule S15).

In: a graph, what is bound to it, a table of limits. Out: the same with one statement for each channel, or leg of one,
of which the types of all writers are known and exclude a kind; and what such statements alone close.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.ranks import closes
from rosprivacy.analysis.kernel.spreading import emitted
from rosprivacy.analysis.model import CANNOT, OF_TYPES, STATED, Place, Statement
from rosprivacy.analysis.modes import View

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element, FlowGraph, MessageType


class TypeLimit(NamedTuple):
    """What one type, or a leg of one, cannot carry: names of kinds, narrower ones too; and the line that says so."""

    kinds: frozenset[str]
    place: Place


class TypeLimits(NamedTuple):
    """A table of limits, by (name of a type, leg), and the hashes of the definitions that it speaks of, by name.

    Attributes
    ----------
    made_for
        (name of a type, leg) -> the kinds that it is made for, some or none; of types that somebody looked at.
    by_purpose
        Whether the limits are what types are not made for: that says nothing of the fields of other types.
    """

    file: str
    sha256: str
    of: Mapping[tuple[str, str], TypeLimit]
    hashes: Mapping[str, frozenset[str]] = MappingProxyType({})
    made_for: Mapping[tuple[str, str], frozenset[str]] = MappingProxyType({})
    by_purpose: bool = False


def under_limits(graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, limits: TypeLimits | None) -> Bound:
    """Return what is bound to a graph with what the types of its channels cannot carry.

    Several types exclude what all of them exclude, and so do the fields of a type that is not in the table and whose
    definition was read: each is as a type of its own. A type that was seen with two hashes, or with one that is not
    that of the definition in the table, excludes nothing. A channel is limited only where what each of its writers
    sends is known, and only in the declared view. What a derivation makes, and what a label says that a flow there may
    carry, is not taken away; what labels of the channel and sources say of it outranks these statements by itself.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import VIDEO, factory
    >>> from rosprivacy.analysis.model import MessageType, Place
    >>> graph, bound, hierarchy = factory()
    >>> at = Place("types.yaml", 3)
    >>> bound = replace(bound, types={VIDEO: (MessageType("std_msgs/msg/Bool", Place("l", 1), stated=True),)})
    >>> limits = TypeLimits("types.yaml", "", {("std_msgs/msg/Bool", ""): TypeLimit(frozenset(["Video"]), at)})
    >>> [said.role for said in under_limits(graph, bound, hierarchy, limits).elements[VIDEO]]
    ['cannot']
    """
    if limits is None or not bound.types or graph.view != View.declared:
        return bound
    kept, said = KeptByWriters(graph, bound, hierarchy), dict[int, Statement]()
    begun, of_types = emitted(bound.elements.values()), _LimitsOfTypes(bound, limits)
    for vertex, types in bound.types.items():
        found = [of_types.of(one, graph.elements[vertex].leg, types) for one in types]
        some = [one for one in found if one]
        if not some or len(some) < len(found) or not kept.types_known(vertex, types):
            continue
        excluded = frozenset.intersection(*(one.kinds for one in some)) & begun
        kinds = tuple(sorted(kind for kind in excluded if not kept.keeps(vertex, kind)))
        if kinds:
            said[vertex] = Statement(CANNOT, kinds, OF_TYPES, some[0].place, shipped=True)
    if not said:
        return bound
    both = {v: (*bound.elements.get(v, ()), *([said[v]] if v in said else ())) for v in {*bound.elements, *said}}
    return replace(bound, elements=dict(sorted(both.items())))


class _LimitsOfTypes:
    """What the types of channels cannot carry: by their names, or else by their definitions."""

    def __init__(self, bound: Bound, limits: TypeLimits) -> None:
        self._limits, self._other = limits, otherwise_defined(bound, limits)
        self._hashed = {(each.robot, each.name) for types in bound.types.values() for each in types if each.hash}

    def of(self, type_: MessageType, leg: str, types: tuple[MessageType, ...]) -> TypeLimit | None:
        """Return the limit of one of the types of a channel."""
        if (type_.robot, type_.name) in self._other:
            return None
        if (type_.name, leg) in self._limits.of or self._limits.by_purpose:
            return self._limits.of.get((type_.name, leg))
        return self._of_fields(type_, types)

    def _of_fields(self, type_: MessageType, types: tuple[MessageType, ...]) -> TypeLimit | None:
        """What none of the fields can carry; what is stated is defined as what was read.

        Of a type that was seen with a hash nobody knows whether it is that of the definition.
        """
        robot, name = type_.robot, type_.name
        read = [each for each in types if (each.robot, each.name) == (robot, name) and not each.stated]
        defined = read if type_.stated else [type_]
        fields = sorted({field for each in defined for field in each.fields or ("",)})
        limits = [self._limits.of.get((field, "")) for field in fields if (robot, field) not in self._other]
        if not fields or len(limits) < len(fields) or not all(limits) or (robot, name) in self._hashed:
            return None
        kinds = frozenset.intersection(*(limit.kinds for limit in limits if limit))
        return TypeLimit(kinds, Place(defined[0].definition, 1))


def otherwise_defined(bound: Bound, limits: TypeLimits) -> set[tuple[str, str]]:
    """Return (robot, name) of types that are not, or not everywhere, the definition of which the table speaks.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import VIDEO, factory
    >>> from rosprivacy.analysis.model import MessageType, Place
    >>> _, bound, _ = factory()
    >>> bound = replace(bound, types={VIDEO: (MessageType("a/msg/A", Place("t.yaml", 1), hash="1"),)})
    >>> otherwise_defined(bound, TypeLimits("types.yaml", "", {}, {"a/msg/A": frozenset(["2"])}))
    {('', 'a/msg/A')}
    """
    seen: dict[tuple[str, str], set[str]] = defaultdict(set)
    for types in bound.types.values():
        of_channel: dict[str, set[str]] = defaultdict(set)  # robots may share it
        for one in types:
            of_channel[one.name].update(filter(None, [one.hash]))
        for one in types:
            seen[one.robot, one.name] |= of_channel[one.name]
    return {key for key, hashes in seen.items() if len(hashes) > 1 or not hashes <= limits.hashes.get(key[1], hashes)}


class KeptByWriters:
    """Who writes the channels of a graph, and what is not taken away from them."""

    def __init__(self, graph: FlowGraph, bound: Bound, hierarchy: Hierarchy) -> None:
        self._elements, self._hierarchy = graph.elements, hierarchy
        self._writers: dict[int, set[int]] = defaultdict(set)
        self._stated_flows: dict[int, list[tuple[bool, tuple[Statement, ...]]]] = defaultdict(list)
        for index, flow in enumerate(graph.flows):
            self._writers[flow.target].add(flow.source)
            stated, said = flow.role == STATED, bound.flows.get(index, ())
            for vertex in (flow.source, flow.target) if stated or said else ():
                self._stated_flows[vertex].append((stated, said))
        self._made_kinds = _made_kinds(graph, bound)

    def writers_of(self, vertex: int) -> list[Element]:
        """Return the elements from which a flow leads to a channel, sorted; a wildcard that matches it is one."""
        return sorted((self._elements[writer] for writer in self._writers[vertex]), key=lambda one: one.sort_key())

    def types_known(self, vertex: int, types: tuple[MessageType, ...]) -> bool:
        """Whether the type of all that comes to a channel is known; what comes through a wildcard only if stated."""
        return not self.unknown_writers(vertex, types)

    def unknown_writers(self, vertex: int, types: tuple[MessageType, ...]) -> list[Element]:
        """Return the elements from which something of an unknown type comes to a channel, sorted."""
        return [one for one in self.writers_of(vertex) if not any(known.written_by(one) for known in types)]

    def keeps(self, vertex: int, kind: str) -> bool:
        """Whether a node that writes a channel makes a kind of others, or a label says that a flow there carries it."""
        if kind in self._made_kinds.get(vertex, ()):
            return True
        for stated, said in self._stated_flows.get(vertex, ()):
            if any(closes(one, kind, self._hierarchy) for one in said):
                continue
            if stated or any(one.role == "only" for one in said):
                return True
        return False


def _made_kinds(graph: FlowGraph, bound: Bound) -> dict[int, set[str]]:
    """Channel -> kinds that a node which writes it makes of others, also through wildcards."""
    makers = {v: {s.to for s in said if s.role == "derivation"} for v, said in bound.elements.items()}
    made: dict[int, set[str]] = defaultdict(set)
    for flow in graph.flows:
        made[flow.target] |= makers.get(flow.source, set())
    matches = [flow for flow in graph.flows if flow.role == "matches"]
    for flow in (*matches, *matches):  # from a written wildcard to a name, and on to a read one
        made[flow.target] |= made[flow.source]
    return made


def closed(spread: Spread, mask: int) -> tuple[int, tuple[tuple[Element, tuple[str, ...]], ...]]:
    """Return how many flows end at what a type cannot carry, and (channel, kinds that get to it and stop there).

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> closed(carried, carried.all_bits)
    (0, ())
    """
    elements = spread.graph.elements
    bits: dict[tuple[str, str, str, str], int] = defaultdict(int)
    first: dict[tuple[str, str, str, str], Element] = {}
    flows = 0
    for _, vertex, stopped in _stopped(spread, mask):
        flows += 1
        element = elements[vertex]
        bits[element.shown_as] |= stopped
        first.setdefault(element.shown_as, element)
    return flows, tuple((first[key], spread.names(bits[key])) for key in sorted(bits))


def _stopped(spread: Spread, mask: int) -> Iterator[tuple[int, int, int]]:
    """(flow, channel at its end, bits that stop there only since its type cannot carry them)."""
    for index, flow in enumerate(spread.graph.flows if spread.limited else ()):
        if stopped := spread.sends(index) & mask & spread.limited.get(flow.target, 0):
            yield index, flow.target, stopped
