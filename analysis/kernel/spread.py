"""What labels mean for a graph, and what arrives where: sets of bits per vertex, as Python integers (rules S7, S8)."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

from rosprivacy.analysis.kernel.bits import CategoryBits, bits_of
from rosprivacy.analysis.many_flows import find

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.overruled import Overruled
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.model import FlowGraph, Statement

    Value = TypeVar("Value")

Computed = TypeVar("Computed")


class Course:
    """What was found of one way that data goes; made with each ``Spread``, and shared by those that are alike.

    Whoever asks names in ``under`` all that it rests on beside what ``Spread.otherwise`` compares. That is compared by
    value, so what is kept cannot grow old.

    Examples
    --------
    >>> course = Course()
    >>> [course.memoised("length", words, lambda: len(words)) for words in (("a", "b"), ("a", "b"), ("c",))]
    [2, 2, 1]
    """

    def __init__(self) -> None:
        self._memory: dict[str, tuple[object, Any]] = {}

    def memoised(self, name: str, under: object, find: Callable[[], Computed]) -> Computed:
        """Return what is found, or was found before under the same; of each thing the last is kept."""
        known = self._memory.get(name)
        if known is None or known[0] != under:
            known = self._memory[name] = under, find()
        found: Computed = known[1]
        return found


@lru_cache(maxsize=1)  # what is said of single elements is asked for again and again
def _bits_of(categories: tuple[str, ...]) -> Mapping[str, int]:
    bits = CategoryBits(len(categories))
    return {category: bits.pair(number) for number, category in enumerate(categories)}


@dataclass(slots=True, eq=False, repr=False)
class Spread:
    """What labels mean for a graph, and the fixpoint of it. Made by ``spread``, then only read.

    Attributes
    ----------
    categories
        Emitted ones, sorted; their order is that of their numbers.
    bits
        Which bits they have.
    all_bits
        Every one of these.
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
    channel_sources
        Channel -> bits that a source names it for.
    standard
        Channels taken as mundane on a shipped file's word alone (rule S13).
    limited
        Channel -> bits that stop there only since its type cannot carry them (rule S15).
    absent
        Nodes that a label says are not on the robot; what is sent to them gets to nobody.
    absent_bits
        Vertex -> bits for which that holds; of some that are there for others, since a label of higher rank says so.
    overruled
        Sources and leaks that a statement says and another takes away.
    made_categories
        Numbers of the categories that others are made into.
    arrives, leaves
        Vertex -> bits, where there are any.
    sent
        Vertex -> bits that leave along all of its flows.
    decisions
        What was decided, by all that is said of elements or flows; what an answer after it need not decide anew.
    hierarchy
        By which it was decided.
    course
        What is found of how data goes on; the same one where it goes the same ways as in an answer before.
    shape
        What is found of the graph alone; the same one as in an answer before about the same graph.
    memory
        What is found of this answer only.
    """

    graph: FlowGraph
    categories: tuple[str, ...]
    bits: CategoryBits = field(init=False)
    all_bits: int = field(init=False)
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
    channel_sources: dict[int, int] = field(default_factory=dict)
    standard: set[int] = field(default_factory=set)
    limited: dict[int, int] = field(default_factory=dict)
    absent: set[int] = field(default_factory=set)
    absent_bits: dict[int, int] = field(default_factory=dict)
    overruled: tuple[Overruled, ...] = ()
    made_categories: set[int] = field(default_factory=set)
    arrives: dict[int, int] = field(default_factory=dict)
    leaves: dict[int, int] = field(default_factory=dict)
    sent: dict[int, int] = field(default_factory=dict)

    decisions: dict[tuple[Statement, ...], dict[str, Facts]] = field(default_factory=dict)
    hierarchy: Hierarchy | None = None
    course: Course = field(default_factory=Course, init=False)
    shape: Course = field(default_factory=Course, init=False)
    memory: Course = field(default_factory=Course, init=False)
    _bits_of_category: Mapping[str, int] = field(init=False, repr=False, compare=False)
    _names: dict[int, tuple[str, ...]] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Number the bits."""
        self.bits = CategoryBits(len(self.categories))
        self.all_bits = self.bits.all
        self._bits_of_category = _bits_of(self.categories)

    def with_fewer_flows(self, graph: FlowGraph) -> Spread:
        """Return the same for a graph that lacks some flows; what arrives where is no less than it is there.

        No source may name channels: what a channel carries hangs on flows then.
        """
        flows, old = graph.flows, self.graph.flows
        found = ((index, find(flows, old[index])) for index in {*self.told_apart, *self.flow_facts})
        now = {index: there for index, there in found if there is not None}
        return replace(
            self,
            graph=graph,
            flow_facts={now[index]: facts for index, facts in self.flow_facts.items() if index in now},
            flow_emits={now[index]: bits for index, bits in self.flow_emits.items() if index in now},
            flow_keeps={now[index]: bits for index, bits in self.flow_keeps.items() if index in now},
        )

    def otherwise(self, other: Spread) -> set[int] | None:
        """Return the vertices at which labels let data go on otherwise than in another spread.

        It is all that the fixpoint and searches rest on, but for where searches are stopped; where none is, the
        fixpoint is the same, too. None where it cannot be said of single vertices: of another graph, of other
        categories, and where flows emit or keep something else.
        """
        if self.graph is not other.graph or self.categories != other.categories:
            return None
        if (self.flow_emits, self.flow_keeps) != (other.flow_emits, other.flow_keeps):
            return None
        return {
            *differing(self.emits, other.emits, 0),
            *differing(self.keeps, other.keeps, self.all_bits),
            *differing(self.derives, other.derives, ()),
            *differing(self.flow_begins, other.flow_begins, 0),
        }

    @property
    def told_apart(self) -> set[int]:
        """Flows that emit or keep something of their own; all others of a meeting are alike."""
        return {*self.flow_emits, *self.flow_keeps}

    def begins(self, vertex: int) -> int:
        """Bits that a vertex emits, along all of its flows or single ones."""
        return self.emits.get(vertex, 0) | self.flow_begins.get(vertex, 0)

    def forms_of(self, category: str) -> int:
        """The two bits of a category, as it is and pseudonymised; none of one that nothing here emits."""
        return self._bits_of_category.get(category, 0)

    def present(self, vertex: int) -> int:
        """What arrives at or starts from an element, or is carried by a channel; nothing at what is not there."""
        arrives, leaves = self.arrives.get(vertex, 0), self.leaves.get(vertex, 0)
        here = leaves if self.graph.elements[vertex].is_channel else arrives | leaves
        return here & ~self.absent_bits.get(vertex, 0)

    def sends(self, index: int) -> int:
        """What is sent along a flow, whether its end takes it up or not."""
        bits = self.sent.get(self.graph.flows[index].source, 0) | self.flow_emits.get(index, 0)
        return bits & self.flow_keeps.get(index, self.all_bits)

    def passing(self, index: int) -> int:
        """What can go along a flow and be taken up at its end."""
        return self.flow_keeps.get(index, self.all_bits) & self.absorbed(self.graph.flows[index].target)

    def absorbed(self, vertex: int) -> int:
        """What an element takes up of what is sent to it: a channel what it carries, any other all."""
        return self.keeps.get(vertex, self.all_bits) if self.graph.elements[vertex].is_channel else self.all_bits

    def along(self, index: int) -> int:
        """What goes along a flow and is taken up at its end."""
        return self.sends(index) & self.passing(index)

    def names(self, bits: int) -> tuple[str, ...]:
        """The categories of some bits, planes put together, in order."""
        names = self._names.get(bits)
        if names is None:
            names = self._names[bits] = tuple(self.categories[i] for i in bits_of(self.bits.merged(bits)))
        return names

    def planes(self, bits: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """The categories of some bits, as they are and pseudonymised."""
        plain, pseudonymised = self.bits.planes(bits)
        return self.names(plain), self.names(pseudonymised)


def differing(first: Mapping[int, Value], second: Mapping[int, Value], nothing: Value) -> Iterator[int]:
    """Yield where two mappings say something else; what is absent says ``nothing``.

    >>> list(differing({1: 3, 2: 0}, {1: 2}, 0))
    [1]
    """
    return (at for at in first.keys() | second.keys() if first.get(at, nothing) != second.get(at, nothing))
