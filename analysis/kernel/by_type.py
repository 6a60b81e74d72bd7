"""Lines ``only: by-type``: a channel carries only what its message type is made for (rules S7, S11, S15).

In: a graph, what is bound to it, a table of types. Out: the same with one statement for each channel, or leg of one, at
which such a line holds; and a diagnostic for each line that does not hold, or of which nobody has kept with what it was
taken. A line by itself closes nothing and reviews nothing: whoever does not ask this module is told of an open channel.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.kernel.ranks import applies, by_line
from rosprivacy.analysis.kernel.spreading import emitted
from rosprivacy.analysis.kernel.type_limits import KeptByWriters, otherwise_defined
from rosprivacy.analysis.model import (
    BY_TYPE,
    BY_TYPE_LAPSED,
    BY_TYPE_OPEN,
    BY_TYPE_UNPINNED,
    OF_LINES,
    STANDARD,
    TYPE_LINE,
    Diagnostic,
    Severity,
    taken_with,
)
from rosprivacy.analysis.modes import View
from rosprivacy.analysis.text import printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.type_limits import TypeLimits
    from rosprivacy.analysis.model import Bound, FlowGraph, MessageType, Statement

OF_WRITERS = ("source", "conduit")  # words by which a person names kinds that a node sends
OF_READERS = ("leak", "conduit", "sanitizer", "derivation")  # … and that get to one
WRITE_KINDS = "or write only: [Kinds]"
LISTED = 5  # names in a message


class ByType(NamedTuple):
    """What is bound to a graph with what its lines ``only: by-type`` close, and what a reader has to know of them."""

    bound: Bound
    diagnostics: tuple[Diagnostic, ...]


def under_lines(
    graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, table: TypeLimits | None, kinds: Iterable[str] = ()
) -> ByType:
    """Return what is bound to a graph with what its lines ``only: by-type`` close.

    Several types let pass what any of them is made for. A line holds only where what each writer sends is known, is
    what the table speaks of, and is that with which a person took it. What a person says of kinds at the channel, at a
    flow there, or at a node that writes or reads it, is not taken away.

    Parameters
    ----------
    table
        What types are made for; None for nothing that is known of any type.
    kinds
        That are emitted beside those that are stated.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import FACES, factory
    >>> from rosprivacy.analysis.kernel.type_limits import TypeLimits
    >>> from rosprivacy.analysis.model import MessageType, Place, Statement
    >>> graph, bound, hierarchy = factory()
    >>> line, boolean = Statement("type-line", (), (1, 9), Place("l", 5)), MessageType("a/msg/A", Place("l", 5), True)
    >>> bound = replace(bound, elements={**bound.elements, FACES: (line,)}, types={FACES: (boolean,)})
    >>> table = TypeLimits("types.yaml", "", {}, made_for={("a/msg/A", ""): frozenset()})
    >>> said = under_lines(graph, bound, hierarchy, table)
    >>> [(one.role, one.categories) for one in said.bound.elements[FACES]]
    [('type-line', ()), ('by-type', ())]

    So ``/faces`` is reviewed, and nothing is taken away: the node that writes it makes a ``FaceTemplate``, and the one
    that reads it is a leak of ``Video``. That nobody has kept with which type the line was taken, is said:

    >>> [one.code for one in said.diagnostics]
    ['by-type-unpinned']
    """
    lines = {v: line for v, said in bound.elements.items() if (line := _line(said))}
    if not lines:
        return ByType(bound, ())
    judge = _Judge(graph, bound, hierarchy, table, kinds)
    elements, said = dict(bound.elements), list[Diagnostic]()
    for vertex, line in sorted(lines.items()):
        reason = judge.reason(vertex, line)
        if reason is None:
            elements[vertex] = (*elements[vertex], judge.statement(vertex, line))
            reason = judge.unpinned(vertex) if line.pinned is None else None
        if reason:
            code, message = reason
            said.append(Diagnostic(line.place, Severity.WARNING, message, code))
    return ByType(replace(bound, elements=elements), tuple(dict.fromkeys(said)))


def _line(statements: Iterable[Statement]) -> Statement | None:
    """The line of a channel; of several the first that says with which types it was taken."""
    lines = sorted((one for one in statements if one.role == TYPE_LINE), key=lambda s: (s.pinned is None, by_line(s)))
    return lines[0] if lines else None


def taken_today(graph: FlowGraph, bound: Bound) -> dict[int, tuple[str, ...]]:
    """Return, for each channel or leg with a line, the texts that a pin of today keeps.

    >>> from rosprivacy.analysis.example import factory
    >>> graph, bound, _ = factory()
    >>> taken_today(graph, bound)  # no label of it says so
    {}
    """
    lines = [vertex for vertex, said in bound.elements.items() if _line(said)]
    writers = _own_writers(graph) if lines else {}
    elements, types = graph.elements, bound.types
    return {v: taken_with(types.get(v, ()), writers.get(v, ()), elements[v].leg) for v in sorted(lines)}


def _own_writers(graph: FlowGraph) -> dict[int, set[str]]:
    """Names of those that write a channel by a grant of their own; not what others of their enclave may do (S6)."""
    names: dict[int, set[str]] = defaultdict(set)
    enforced = graph.view == View.enforced
    for flow in graph.flows:
        writer = graph.elements[flow.source]
        if not enforced or not flow.grants or any(grant.node == writer.name for grant in flow.grants):
            names[flow.target].add(writer.name)
    return names


class _Judge:
    """What lines mean at the channels of one graph."""

    def __init__(
        self, graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, table: TypeLimits | None, kinds: Iterable[str]
    ) -> None:
        self._graph, self._bound, self._hierarchy, self._table = graph, bound, hierarchy, table
        self._writers = KeptByWriters(graph, bound, hierarchy)
        self._other = otherwise_defined(bound, table) if table else set[tuple[str, str]]()
        self._emitted = sorted(emitted(bound.elements.values()).union(kinds))
        self._at_ends = _said_at_ends(graph, bound)
        self._today = taken_today(graph, bound)

    def reason(self, vertex: int, line: Statement) -> tuple[str, str] | None:
        """Why a line does not hold: code and message; None where it holds."""
        name = printable(self._graph.elements[vertex].name)
        if line.pinned and (changed := self._changed(vertex, line.pinned)):
            return BY_TYPE_LAPSED, f"{name} is open again: {changed}; look at it, then run rosprivacy labels --pin"
        message = self._uncertain(vertex, name) or self._without_purpose(vertex, name)
        if not message and line.pinned is not None and not line.pinned:
            what = f"nobody has looked at {name} since it is taken by its type"
            return BY_TYPE_LAPSED, f"{what}; look at it, then run rosprivacy labels --pin"
        return (BY_TYPE_OPEN, message) if message else None

    def _uncertain(self, vertex: int, name: str) -> str:
        """Why the type of what comes to a channel is not certain; empty where it is."""
        types = self._bound.types.get(vertex, ())
        if not types:
            return f"{name} has no known type; observe it, {WRITE_KINDS}"
        robots = {one.robot for one in types} | {one.robot for one in self._writers.writers_of(vertex)}
        if len(robots) > 1:
            return f"several robots write {name}; write only: [Kinds]"
        if unknown := self._writers.unknown_writers(vertex, types):
            names = _listed(one.name for one in unknown)
            return f"the type of what {names} writes to {name} is not known; observe it, {WRITE_KINDS}"
        other = [one.name for one in types if (one.robot, one.name) in self._other]
        if other:
            what = f"{printable(other[0])} of {name} is not the definition that the table of types speaks of"
            return f"{what}; write only: [Kinds]"
        return ""

    def _without_purpose(self, vertex: int, name: str) -> str:
        """Which type of a channel the table does not say the purpose of; empty for none."""
        for one in self._bound.types.get(vertex, ()):
            if self._passing(one, vertex) is None:
                what = f"the table of types does not say what {printable(one.name)} of {name} is made for"
                return f"{what}; write only: [Kinds]"
        return ""

    def unpinned(self, vertex: int) -> tuple[str, str]:
        """That nobody has kept with what the line of a channel was taken."""
        name = printable(self._graph.elements[vertex].name)
        what = f"nobody has kept with which type and writers {name} was taken by its type"
        return BY_TYPE_UNPINNED, f"{what}; run rosprivacy labels --pin"

    def statement(self, vertex: int, line: Statement) -> Statement:
        """What a line closes that holds: kinds that none of the types is made for, and that nobody names there."""
        passing = set[str]().union(*(self._passing(one, vertex) or () for one in self._bound.types[vertex]))
        closed = [kind for kind in self._emitted if kind not in passing and not self._names_kind(vertex, kind)]
        return line._replace(role=BY_TYPE, categories=tuple(closed), rank=OF_LINES, pinned=None)

    def _passing(self, message_type: MessageType, vertex: int) -> set[str] | None:
        """The emitted kinds that a type lets pass; None where the table does not say."""
        key = message_type.name, self._graph.elements[vertex].leg
        if self._table is None:
            return None
        if (kinds := self._table.made_for.get(key)) is not None:
            return {kind for kind in self._emitted if not kinds.isdisjoint(self._hierarchy.overlaps[kind])}
        if (limit := self._table.of.get(key)) is not None:  # of a fixed size, and nobody looked at what it suggests
            return {kind for kind in self._emitted if kind not in limit.kinds}
        return None

    def _names_kind(self, vertex: int, kind: str) -> bool:
        """Whether a person names a kind at a node that writes or reads a channel, or at a flow there."""
        if self._writers.keeps(vertex, kind):
            return True
        return any(applies(one, kind, self._hierarchy) for one in self._at_ends.get(vertex, ()))

    def _changed(self, vertex: int, pinned: tuple[str, ...]) -> str:
        """What is other than when a person took the line; empty for nothing."""
        today = self._today[vertex]
        parts = [f"now {_listed(new)}"] if (new := sorted({*today} - {*pinned})) else []
        parts += [f"no more {_listed(gone)}"] if (gone := sorted({*pinned} - {*today})) else []
        return " and ".join(parts)


def _listed(names: Iterable[str]) -> str:
    every = [printable(name) for name in names]
    return ", ".join(every[:LISTED]) + (f" and {len(every) - LISTED} more" if len(every) > LISTED else "")


def _said_at_ends(graph: FlowGraph, bound: Bound) -> Mapping[int, set[Statement]]:
    """Channel -> what persons say, by the names of kinds, of the nodes that write or read it, also through wildcards.

    A source that names its channels names the kind at these only.
    """
    near: dict[int, set[Statement]] = defaultdict(set)
    sent = {vertex: {*_naming(said, OF_WRITERS)} for vertex, said in bound.elements.items()}
    read = {vertex: {*_naming(said, OF_READERS)} for vertex, said in bound.elements.items()}
    for flow in graph.flows:
        if not graph.elements[flow.source].is_channel:
            near[flow.target] |= sent.get(flow.source, set())
        if not graph.elements[flow.target].is_channel:
            near[flow.source] |= read.get(flow.target, set())
    for (vertex, through), flows in bound.through.items():
        named = [one for one in bound.elements[vertex] if one.role == "source" and one.through == through]
        for index in flows:
            near[graph.flows[index].target].update(one for one in named if one.rank[0] > STANDARD)
    for _ in ("from a written wildcard to a name", "and on to a read one"):
        for flow in graph.flows:
            if graph.elements[flow.source].is_channel and graph.elements[flow.target].is_channel:
                both = near[flow.source] | near[flow.target]
                near[flow.source], near[flow.target] = set(both), set(both)
    return near


def _naming(statements: Iterable[Statement], words: tuple[str, ...]) -> Iterator[Statement]:
    for one in statements:
        if one.role in words and one.categories and one.rank[0] > STANDARD and not one.through:
            yield one
