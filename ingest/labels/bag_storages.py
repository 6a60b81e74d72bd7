"""Storages that are bags: what was recorded flows into them from the channels of that name (rules S3, S9, S11).

In: the path that a label file names, and a graph. Out: bags, the flows into their storage, and what a reader has to
know: a topic that no policy names, and whatever is not known of a bag, so that the verdict is undetermined at best.
"""

from __future__ import annotations

import os
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import BAG_GAP, RECORDING, Diagnostic, Element, MessageType, Severity
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.policies.names import covers, is_pattern, recorded_channels
from rosprivacy.ingest.reading.confined import WIDEN, leaves, unusable, what_leaves

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import FlowGraph, Place
    from rosprivacy.analysis.model.recording import Bag, BagTopic
    from rosprivacy.ingest.labels.non_ros_reader import Stated
    from rosprivacy.ingest.reading.yaml_values import Value

NAMED = 5  # topics that no policy names, of one bag


def bags_of(file: str, root: str, value: Value) -> tuple[Bag, ...]:
    """Read the bags that a storage of a label file names.

    Parameters
    ----------
    root
        Folder that they may not leave, links followed; empty for that of the file.

    Raises
    ------
    LabelError
        If that is no path, leaves the folder, or is no bag.
    """
    from rosprivacy.ingest.running.bag_folders import read_bags  # noqa: PLC0415 - light start: few files name a bag

    whole = value.kind == "text" and value.text.isprintable()
    written = value.text if whole else ""
    path = str(Path(file).parent / written)
    if not written or (why := unusable(path)):
        what = f"bag: {why}" if written else f"bag takes a path, not {shown(value.text) or f'a {value.kind}'!r}"
        raise LabelError(file, value.line, what, "write the bag's path, relative to this file")
    top = os.path.realpath(root or Path(file).parent)
    if leaves(path, top):
        raise LabelError(file, value.line, what_leaves(written, top), WIDEN)
    try:
        return read_bags([path])
    except InputErrors as error:
        first = error.errors[0]
        raise LabelError(file, value.line, f"bag {shown(first.file)}: {first.problem}", first.hint) from None


def recorded(graph: FlowGraph, stated: Stated) -> Iterator[tuple[Element, Element, Place]]:
    """Yield the flows into a storage from the channels that are in its bags."""
    storage = Element(stated.kind, stated.name)
    for bag in stated.bags:
        for topic in _with_messages(bag):
            yield from ((channel, storage, stated.place) for channel in _channels(graph, topic.name))


def recorded_types(graph: FlowGraph, elements: Iterable[Stated]) -> defaultdict[int, list[MessageType]]:
    """Return the types of the topics of bags, by vertex; who sent them no bag tells, so these limit nothing (S15)."""
    topics = {e.name: v for v, e in enumerate(graph.elements) if e.kind == "topic" and not e.pattern}
    found: defaultdict[int, list[MessageType]] = defaultdict(list)
    for stated in elements:
        for topic in (topic for bag in stated.bags for topic in bag.topics if topic.name in topics):
            found[topics[topic.name]] += [MessageType(name, stated.place) for name in topic.types]
    return found


def told_of_bags(graph: FlowGraph, elements: Iterable[Stated]) -> Iterator[Diagnostic]:
    """Yield what a reader has to know of storages that are bags."""
    for stated in elements:
        for bag in stated.bags:
            yield Diagnostic(stated.place, Severity.NOTICE, _about(stated.name, bag), RECORDING)
            for what in (*bag.gaps, *(f"{what} can hold anything" for what in bag.beside)):
                said = f"not all of the bag {shown(bag.path)} is known: {what}"
                yield Diagnostic(stated.place, Severity.WARNING, said, BAG_GAP)
            if stated.outside.retention and bag.start is None and bag.messages != 0 and bag.complete:
                said = f"nothing says when the bag {shown(bag.path)} was recorded, so its age is not judged"
                yield Diagnostic(stated.place, Severity.WARNING, said, BAG_GAP)
            unknown = [topic.name for topic in _with_messages(bag) if not _channels(graph, topic.name)]
            if unknown:
                yield Diagnostic(stated.place, Severity.WARNING, _unknown(bag, unknown), BAG_GAP)


def _about(name: str, bag: Bag) -> str:
    """What a bag says of itself: its size, its time and its topics."""
    said = [bag.storage or "unknown storage", f"{bag.size:,} bytes", counted(len(bag.topics), "topic")]
    if bag.messages is not None:
        said.append(counted(bag.messages, "message"))
    if bag.start and bag.end:
        from rosprivacy.analysis.model.recording import iso  # noqa: PLC0415 - light start

        said.append(f"{iso(bag.start)} to {iso(bag.end)}")
    return f"{shown(name)} is the bag {shown(bag.path)}: {', '.join(map(shown, said))}; no message was read"


def _unknown(bag: Bag, names: Sequence[str]) -> str:
    told = ", ".join([*map(shown, names[:NAMED]), *(["…"] if len(names) > NAMED else [])])
    what = f"{counted(len(names), 'topic')} of the bag {shown(bag.path)} that no policy names: {told}"
    return f"{what}; name the policies of the system that was recorded"


def _with_messages(bag: Bag) -> Iterator[BagTopic]:
    """The topics of which something was recorded, as far as that is known."""
    return (topic for topic in bag.topics if not (topic.messages == 0 and bag.complete))


def _channels(graph: FlowGraph, topic: str) -> list[Element]:
    """The channels of which a topic tells; where only wildcards cover its name, what is written through these (S4)."""
    wanted = recorded_channels(topic)
    exact = [e for e in graph.elements if e.is_channel and not e.pattern and (e.kind, e.name, e.leg) in wanted]
    if exact or is_pattern(topic):
        return exact
    return [
        element
        for element in graph.elements
        if element.is_channel and element.side == "write"
        and any((element.kind, element.leg) == (kind, leg) and covers(element.name, name) for kind, name, leg in wanted)
    ]  # fmt: skip
