"""``types`` of label files: the message types of a channel, as a person states them for all who write it (rule S15).

In: the values of an entry; the graph that it is joined to. Out: ``MessageType`` facts; a problem for what is no type,
and for the type of another kind of channel.
"""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import OF_KIND, MessageType, Place, kind_of_type

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.reading.format_reader import FileReader
    from rosprivacy.ingest.reading.yaml_values import Value

LONGEST_TYPE = 500  # characters; what was observed is anybody's


def read_types(reader: FileReader, label: Value, kinds: Collection[str]) -> tuple[MessageType, ...]:
    """Return the types that an entry states for channels of some kinds; what is none is a problem."""
    value = label.get("types")
    if value is None:
        return ()
    if not value.items and value.kind in ("list", "empty"):
        reader.problem(value.line, "types names no type", "name one, such as [std_msgs/msg/Bool], or remove it")
    found = []
    for item in reader.list_of(value, "types", "write [std_msgs/msg/Bool]"):
        kind = kind_of_type(item.text) if item.kind == "text" and len(item.text) <= LONGEST_TYPE else ""
        if not kind:
            what = f"{shown(item.text or item.kind)!r} is not the name of a type"
            reader.problem(item.line, what, "write it in full, such as sensor_msgs/msg/Image")
        elif kind not in kinds:
            other = " or ".join(kinds)
            reader.problem(item.line, f"{item.text} is the type of a {kind}", f"move it, or name the type of a {other}")
        else:
            found.append(MessageType(item.text, Place(reader.file, item.line), stated=True))
    return tuple(found)


def stated_at(graph: FlowGraph, entry: Entry, vertices: Iterable[int]) -> Iterator[tuple[int, MessageType]]:
    """Yield (vertex, type) for the elements that an entry covers: a type goes to its own kind of channel."""
    for vertex in vertices:
        for one in entry.types:
            if graph.elements[vertex].kind == kind_of_type(one.name):
                yield vertex, one


def of_no_channel(graph: FlowGraph, entry: Entry, vertices: Collection[int]) -> Iterator[InputError]:
    """Yield a problem for each type of an entry that is for none of the channels that it covers."""
    kinds = sorted({graph.elements[vertex].kind for vertex in vertices})
    for one in entry.types:
        if kinds and kind_of_type(one.name) not in kinds:
            what = f"{one.name} is the type of a {kind_of_type(one.name)}, and {shown(entry.name)!r} is a {kinds[0]}"
            hint = f"name the type of a {kinds[0]}: pkg/{OF_KIND[kinds[0]]}/Name"
            yield LabelError(one.place.file, one.place.line, what, hint)


def in_order(types: Mapping[int, Iterable[MessageType]]) -> dict[int, tuple[MessageType, ...]]:
    """Return the types of each element once and sorted (rule S14)."""
    order = attrgetter("name", "hash", "robot", "place.file", "place.line", "writers", "readers", "first", "last")
    return {vertex: tuple(sorted(set(some), key=order)) for vertex, some in sorted(types.items()) if some}
