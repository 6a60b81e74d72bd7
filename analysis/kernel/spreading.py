"""Graph + labels -> what every element does with every category, and what arrives where (rules S7, S8).

In: a ``FlowGraph``, the statements bound to it, the hierarchy. Out: a ``Spread``: sets of bits per vertex, as Python
integers, which have as many bits as are needed (``bits.py``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.kernel.arrays import GraphArrays, as_numbers
from rosprivacy.analysis.kernel.fixpoint import fixpoint
from rosprivacy.analysis.kernel.named_channels import keep_named, named, stated_flows
from rosprivacy.analysis.kernel.overruled import overruled
from rosprivacy.analysis.kernel.roles import NOTHING_SAID, Facts, facts
from rosprivacy.analysis.kernel.spread import Spread
from rosprivacy.analysis.model import Method

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping
    from typing import Any

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.arrays import Bits
    from rosprivacy.analysis.model import Bound, FlowGraph, Statement


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
    if any(fact.method == Method.ABSENT for fact in decided.values()):
        found.absent.add(vertex)
    number = {category: i for i, category in enumerate(found.categories)}
    found.keeps[vertex] = _bits(found, decided, lambda fact: fact.passes)
    found.leaks[vertex] = _bits(found, decided, lambda fact: fact.leaks)
    found.covered[vertex] = _bits(found, decided, lambda fact: fact.covered)
    for to in {to for fact in decided.values() for to in fact.derives}:  # who makes it knows of it
        found.covered[vertex] |= found.both(to)
    made = _closed({c: decided[c].derives for c in found.categories if c in decided})
    pairs: set[tuple[int, int]] = set()
    emits = 0
    for category, i in number.items():
        fact = decided.get(category, NOTHING_SAID)
        plain, pseudonymised = found.bits.forms(i)
        after = {number[to] for to in made.get(category, ())}
        for j in after:
            pairs.update(zip((plain, pseudonymised), found.bits.forms(j), strict=True))
        found.made.update(after)
        if fact.pseudonymises:
            pairs.add((plain, pseudonymised))
            found.keeps[vertex] |= 1 << pseudonymised  # what is pseudonymised already goes on so (rule S8)
        if fact.emits:  # what a node makes of its own data leaves it like what it makes of others'
            emits |= sum(1 << found.bits.plain(j) for j in after)
            emits |= 0 if fact.through else 1 << plain
        for flow in {*bound.through.get((vertex, fact.through), ()), *stated.get(vertex, ())} if fact.through else ():
            found.flow_emits[flow] = found.flow_emits.get(flow, 0) | 1 << plain
            found.flow_begins[vertex] = found.flow_begins.get(vertex, 0) | 1 << plain
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
