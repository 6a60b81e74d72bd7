"""Observed types + graph -> the types of its channels, and what of the files matches nothing (rules S15, S16).

In: files of types, a flow graph. Out: ``MessageType`` facts by vertex; a notice that counts and names what matches
nothing: observation only adds, so it is no error.
"""

from __future__ import annotations

from collections import defaultdict
from types import MappingProxyType
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import TYPES_OF_NOTHING, Diagnostic, MessageType, Place, Severity
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.model import Element, FlowGraph
    from rosprivacy.ingest.types.types_file import SeenType, TypesFile

    Written = Mapping[Element, Element]

LISTED = 5  # names in a notice


def channel_types(
    graph: FlowGraph, files: Collection[TypesFile], written: Written = MappingProxyType({})
) -> dict[int, tuple[MessageType, ...]]:
    """Return the observed types of the channels of a graph, by vertex; a wildcard has none.

    A service and an action are two legs: what their clients write their servers read, and the other way round (S2).

    Parameters
    ----------
    written
        Elements that the files call otherwise -> the same under the names of the files.
    """
    if not files:
        return {}
    at, called = _vertices(graph, written), _Called(graph, written)
    found: dict[int, list[MessageType]] = defaultdict(list)
    for file in files:
        for channel in file.channels:
            for vertex in at.get((channel.kind, channel.name), ()):
                found[vertex] += [_at_leg(one, graph.elements[vertex], file.file, called) for one in channel.types]
    return {vertex: tuple(types) for vertex, types in sorted(found.items())}


def matching_nothing(
    graph: FlowGraph, files: Collection[TypesFile], written: Written = MappingProxyType({})
) -> tuple[Diagnostic, ...]:
    """Return a warning for each file with names, of channels or of nodes, that nothing of the system is called."""
    if not files:
        return ()
    at = _vertices(graph, written)
    nodes = {written.get(element, element).name for element in graph.elements if not element.is_channel}
    said = []
    for file in files:
        lost = {f"{c.kind} {shown(c.name)}" for c in file.channels if (c.kind, c.name) not in at}
        seen = {name for c in file.channels for one in c.types for end in one.ends for name in end}
        lost |= {f"node {shown(name)}" for name in seen - nodes}
        if lost:
            names = ", ".join(sorted(lost)[:LISTED]) + (f" and {len(lost) - LISTED} more" if len(lost) > LISTED else "")
            what = f"{counted(len(lost), 'name')} of observed types that nothing of the system is called: {names}"
            said.append(Diagnostic(Place(file.file, 0), Severity.WARNING, what, TYPES_OF_NOTHING))
    return tuple(said)


class _Called:
    """What the nodes of a graph are called there that files name."""

    def __init__(self, graph: FlowGraph, written: Written) -> None:
        nodes = [element for element in graph.elements if not element.is_channel]
        self._by_leg = {written.get(node, node).name: node.name for node in nodes}
        self._name_owners = set(self._by_leg.values())

    def names(self, written: Iterable[str]) -> tuple[str, ...]:
        """The names of nodes; without those of others that are called there as one of the graph is called here."""
        known = [
            self._by_leg.get(name, name) for name in written if name in self._by_leg or name not in self._name_owners
        ]
        return tuple(sorted(set(known)))


def _vertices(graph: FlowGraph, written: Written) -> Mapping[tuple[str, str], list[int]]:
    at: dict[tuple[str, str], list[int]] = defaultdict(list)
    for vertex, element in enumerate(graph.elements):
        if element.is_channel and not element.pattern:
            at[element.kind, written.get(element, element).name].append(vertex)
    return at


def _at_leg(seen_type: SeenType, element: Element, file: str, names: _Called) -> MessageType:
    first, second = map(names.names, seen_type.ends)  # writers and readers, or servers and clients
    writers, readers = (second, first) if element.leg == "request" else (first, second)
    place = Place(file, seen_type.line)
    fields = seen_type.fields[element.leg == "response"] if seen_type.fields else ()
    return MessageType(
        seen_type.type, place, False, seen_type.hash, writers, readers, seen_type.first, seen_type.last,
        definition=seen_type.definition, fields=fields,
    )  # fmt: skip
