"""Graph + labels -> what every element does with every category, and what arrives where (rules S7, S8).

In: a ``FlowGraph``, the statements bound to it, the hierarchy. Out: a ``Spread``: sets of bits per vertex, as Python
integers, which have as many bits as are needed. Bit i is the i-th emitted category as it is, bit i + k the same in
the pseudonymised plane, where k is the number of emitted categories.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.kernel.arrays import GraphArrays, as_numbers
from rosprivacy.analysis.kernel.fixpoint import fixpoint
from rosprivacy.analysis.kernel.named_channels import keep_named, named, stated_flows
from rosprivacy.analysis.kernel.overruled import Overruled, overruled
from rosprivacy.analysis.kernel.roles import NOTHING_SAID, Facts, facts

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping
    from typing import Any

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.arrays import Bits
    from rosprivacy.analysis.model import Bound, FlowGraph, Statement


@dataclass(slots=True)
class Spread:
    """What labels mean for a graph, and the fixpoint of it. Made by ``spread``, then only read.

    Attributes
    ----------
    categories
        Emitted ones, sorted; they give the bits their numbers.
    facts
        Vertex -> category -> what it does with it; labelled vertices only.
    flow_facts
        The same of single flows, by index; labelled flows only.
    emits, leaks, covered
        Vertex -> bits; 0 where absent. A leak and a cover hold in both planes.
    keeps
        Vertex -> bits that pass it as they are; all where absent.
    derives
        Vertex -> (bit that arrives, bit that leaves for it); pseudonymising is one of these.
    flow_emits, flow_keeps
        The same for single flows.
    flow_begins
        Vertex -> bits that it emits along single flows only.
    named
        Channel -> bits that a source names it for.
    standard
        Channels taken as mundane on a shipped file's word alone (rule S13).
    overruled
        Sources and leaks that a statement says and another takes away.
    made
        Numbers of the categories that others are made into.
    arrives, leaves
        Vertex -> bits, where there are any.
    sent
        Vertex -> bits that leave along all of its flows.
    """

    graph: FlowGraph
    categories: tuple[str, ...]
    facts: dict[int, dict[str, Facts]] = field(default_factory=dict)
    flow_facts: dict[int, dict[str, Facts]] = field(default_factory=dict)
    emits: dict[int, int] = field(default_factory=dict)
    leaks: dict[int, int] = field(default_factory=dict)
    covered: dict[int, int] = field(default_factory=dict)
    keeps: dict[int, int] = field(default_factory=dict)
    derives: dict[int, tuple[tuple[int, int], ...]] = field(default_factory=dict)
    flow_emits: dict[int, int] = field(default_factory=dict)
    flow_keeps: dict[int, int] = field(default_factory=dict)
    flow_begins: dict[int, int] = field(default_factory=dict)
    named: dict[int, int] = field(default_factory=dict)
    standard: set[int] = field(default_factory=set)
    overruled: tuple[Overruled, ...] = ()
    made: set[int] = field(default_factory=set)
    arrives: dict[int, int] = field(default_factory=dict)
    leaves: dict[int, int] = field(default_factory=dict)
    sent: dict[int, int] = field(default_factory=dict)

    @property
    def all_bits(self) -> int:
        """Every bit of both planes."""
        return (1 << 2 * len(self.categories)) - 1

    def begins(self, vertex: int) -> int:
        """Bits that a vertex emits, along all of its flows or single ones."""
        return self.emits.get(vertex, 0) | self.flow_begins.get(vertex, 0)

    def both(self, category: str) -> int:
        """The two bits of a category, as it is and pseudonymised."""
        i = self.categories.index(category)
        return 1 << i | 1 << i + len(self.categories)

    def present(self, vertex: int) -> int:
        """What arrives at or starts from an element, or is carried by a channel."""
        arrives, leaves = self.arrives.get(vertex, 0), self.leaves.get(vertex, 0)
        return leaves if self.graph.elements[vertex].is_channel else arrives | leaves

    def sends(self, index: int) -> int:
        """What is sent along a flow, whether its end takes it up or not."""
        bits = self.sent.get(self.graph.flows[index].source, 0) | self.flow_emits.get(index, 0)
        return bits & self.flow_keeps.get(index, self.all_bits)

    def along(self, index: int) -> int:
        """What goes along a flow and is taken up at its end."""
        flow, bits = self.graph.flows[index], self.sends(index)
        if self.graph.elements[flow.target].is_channel:
            bits &= self.keeps.get(flow.target, self.all_bits)
        return bits

    def names(self, bits: int) -> tuple[str, ...]:
        """The categories of some bits, planes put together, in order."""
        k = len(self.categories)
        either = (bits | bits >> k) & ((1 << k) - 1)
        return tuple(self.categories[i] for i in bits_of(either))

    def planes(self, bits: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """The categories of some bits, as they are and pseudonymised."""
        k = len(self.categories)
        return self.names(bits & ((1 << k) - 1)), self.names(bits >> k)


def bits_of(number: int) -> Iterator[int]:
    """The positions of the bits that are set, lowest first.

    >>> list(bits_of(0b10010))
    [1, 4]
    """
    while number:
        lowest = number & -number
        yield lowest.bit_length() - 1
        number ^= lowest


def spread(graph: FlowGraph, bound: Bound, hierarchy: Hierarchy) -> Spread:
    """Apply labels to a graph and carry every category to where it can get.

    Raises
    ------
    InputErrors
        If statements of equal rank contradict each other.
    """
    found = meaning(graph, bound, hierarchy, emitted(bound.elements.values()))
    network = GraphArrays.of(found)
    fill(found, *fixpoint(network.edges, network.emitted, network.keep, network.derivations))
    return found


def meaning(graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, categories: Iterable[str]) -> Spread:
    """Apply labels to a graph, and carry nothing yet.

    Parameters
    ----------
    categories
        That have bits: those that are emitted, here or in the other parts of what this is a part of.

    Raises
    ------
    InputErrors
        If statements of equal rank contradict each other.
    """
    categories = tuple(sorted(categories))
    found = Spread(graph, categories)
    problems: list[InputError] = []
    decided: dict[tuple[tuple[Statement, ...], str], Facts] = {}

    def decide(said: tuple[Statement, ...], name: str) -> dict[str, Facts]:
        mentioned = {category for statement in said for category in statement.categories}
        result = {}
        for category in sorted(mentioned.union(categories) or hierarchy.ancestors):
            if (said, category) not in decided:
                try:
                    decided[said, category] = facts(name, said, category, hierarchy)
                except InputError as error:
                    problems.append(error)
                    continue
            result[category] = decided[said, category]
        return result

    for vertex, said in bound.elements.items():
        found.facts[vertex] = decide(said, graph.elements[vertex].name)
    for index, said in bound.flows.items():
        ends = graph.elements[graph.flows[index].source], graph.elements[graph.flows[index].target]
        found.flow_facts[index] = decide(said, f"the flow {ends[0].name} -> {ends[1].name}")
    found.overruled = overruled(found.facts, graph.elements)
    problems += [error for one in found.overruled if (error := one.error())]
    problems += keep_named(found.facts, found.flow_facts, graph, bound, hierarchy)
    restricted = any(statement.through for said in bound.elements.values() for statement in said)
    stated = stated_flows(graph) if restricted else {}
    for category, _, vertex, _ in named(found.facts, graph, bound):
        if category in categories:
            found.named[vertex] = found.named.get(vertex, 0) | found.both(category)
    for vertex in bound.elements:
        _set_vertex(found, vertex, bound, stated)
    for index, kept in found.flow_facts.items():
        found.flow_keeps[index] = _bits(found, kept, lambda fact: fact.passes)
    if problems:
        raise InputErrors(problems)
    return found


def emitted(elements: Iterable[Iterable[Statement]]) -> set[str]:
    """Return the categories that a source names or a derivation makes: only these have bits (rule S7)."""
    names: set[str] = set()
    for said in elements:
        for statement in said:
            if statement.role == "source":
                names.update(statement.categories)
            elif statement.role == "derivation":
                names.add(statement.to)
    return names


def _bits(found: Spread, decided: Mapping[str, Facts], test: Any) -> int:
    """The bits, in both planes, of the emitted categories whose facts pass a test."""
    bits = 0
    for category, fact in decided.items():
        if category in found.categories and test(fact):
            bits |= found.both(category)
    return bits


def _set_vertex(found: Spread, vertex: int, bound: Bound, stated: Mapping[int, Collection[int]]) -> None:
    decided = found.facts[vertex]
    if any(fact.standard for fact in decided.values()):
        found.standard.add(vertex)
    k = len(found.categories)
    found.keeps[vertex] = _bits(found, decided, lambda fact: fact.passes)
    found.leaks[vertex] = _bits(found, decided, lambda fact: fact.leaks)
    found.covered[vertex] = _bits(found, decided, lambda fact: fact.covered)
    for to in {to for fact in decided.values() for to in fact.derives}:  # who makes it knows of it
        found.covered[vertex] |= found.both(to)
    number = {category: i for i, category in enumerate(found.categories)}
    made = _closed({c: decided[c].derives for c in found.categories if c in decided})
    pairs: set[tuple[int, int]] = set()
    emits = 0
    for category, i in number.items():
        fact = decided.get(category, NOTHING_SAID)
        after = sum(1 << number[to] for to in made.get(category, ()))
        pairs.update((i + plane, j + plane) for j in bits_of(after) for plane in (0, k))
        found.made.update(bits_of(after))
        if fact.pseudonymises:
            pairs.add((i, i + k))
            found.keeps[vertex] |= 1 << i + k  # what is pseudonymised already goes on so (rule S8)
        if fact.emits:
            emits |= after  # what a node makes of its own data leaves it like what it makes of others'
            emits |= 0 if fact.through else 1 << i
        for flow in {*bound.through.get((vertex, fact.through), ()), *stated.get(vertex, ())} if fact.through else ():
            found.flow_emits[flow] = found.flow_emits.get(flow, 0) | 1 << i
            found.flow_begins[vertex] = found.flow_begins.get(vertex, 0) | 1 << i
    found.derives[vertex] = tuple(sorted(pairs))
    found.emits[vertex] = emits


def _closed(derives: Mapping[str, tuple[str, ...]]) -> dict[str, set[str]]:
    """What is made of each category, and of that in turn."""
    made = {category: set(to) for category, to in derives.items()}
    changed = True
    while changed:
        changed = False
        for after in made.values():
            more = {further for to in after for further in made.get(to, ())} - after
            after.update(more)
            changed = changed or bool(more)
    return {category: after - {category} for category, after in made.items()}


def fill(found: Spread, arrives: Bits, leaves: Bits) -> None:
    """Put the fixpoint in; rows are vertices of its network, of which elements are the first."""
    count = len(found.graph.elements)
    found.arrives = as_numbers(arrives[:count])
    found.leaves = as_numbers(leaves[:count])
    found.sent = dict(found.leaves)
    for vertex, bits in found.flow_begins.items():  # through one channel only is still from here
        found.leaves[vertex] = found.leaves.get(vertex, 0) | bits
