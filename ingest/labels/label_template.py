"""Graph -> a first label file: every element that a person has to judge once, in short lines, ready to fill in.

In: a flow graph, and the channels that files of the program speak of. Out: YAML text that is a valid label file as it
is (it says nothing yet). A line names one element and no other: ``=`` stands before a name with glob signs.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import yaml

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import PARTICIPANT
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.analysis.written_names import literal
from rosprivacy.ingest.labels.entries import SECTIONS
from rosprivacy.ingest.labels.keywords import CHANNEL, NODE, keywords_of, rows

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Element, FlowGraph

HEADER = """\
# Labels: which elements bring personal data in, let it out, clean it or pass it on, per kind of data.
# Fill in what you know; an element without a label counts as not reviewed, and data passes it.
#
"""
LAST = ("conduit", "absent")  # in the head
LONGEST_KEY = 1000  # of YAML, without a question mark before it
SCHEMA_FILE = "labels.schema.json"
WITH_SCHEMA = f"# yaml-language-server: $schema={SCHEMA_FILE}\n"
Channel = tuple[str, str]  # kind, name


def header() -> str:
    """Return the head of a first label file, with what each keyword means."""
    examples = [*_examples("nodes", NODE, 37), *_examples("channels", CHANNEL, 12), ""]
    return HEADER + "".join(f"# {line}".rstrip() + "\n" for line in examples)


def _examples(section: str, where: str, width: int) -> Iterator[str]:
    """How the keywords of a section are written, and in a column behind it what they mean."""
    ordered = sorted(keywords_of(where).values(), key=lambda keyword: keyword.name in LAST)
    for number, (written, meaning) in enumerate(row for keyword in ordered for row in rows(keyword.init)):
        begin = "" if number else f"  {section}:"
        yield f"{begin:13}{f'{written:{width}}' if len(written) < width else f'{written}   '}{meaning}"


def template(
    graph: FlowGraph,
    standard: Collection[Channel] = (),
    infrastructure: Collection[Channel] = (),
    own: Iterable[str] = (),
    *,
    schema: bool = False,
) -> str:
    """Return the text of a first label file.

    Parameters
    ----------
    standard, infrastructure
        Channels that the file of standard channels takes as mundane, and that the file of infrastructure proposes:
        they are counted, not listed.
    own
        Names of categories of the user's ontologies.
    schema
        Whether the JSON Schema stands beside the file: then editors are told.
    """
    left_out = {*standard, *infrastructure}
    listed = {channel for channel in map(_channel, graph.elements) if channel not in left_out}
    head = [
        WITH_SCHEMA if schema else "",
        header(),
        *(f"# {line}\n" for line in _remarks(graph, standard, left_out, own)),
    ]
    lines = [*_nodes(graph, listed), *_channels(graph, listed), *_participants(graph, listed), ""]
    return "".join(head) + "labels: 1\n" + "\n".join(lines)


def key(name: str) -> str:
    """Return a name as the key of a line of YAML, with its colon.

    >>> key("/camera"), key("=/*")
    ('/camera:', '"=/*":')
    """
    plain = name.isascii() and name.startswith("/") and all(c.isalnum() or c in "/_-." for c in name)
    text = name if plain else yaml.dump(name, default_style='"', width=float("inf")).strip()
    return f"{text}:" if len(text) < LONGEST_KEY else f"? {text}\n  :"


def endpoint_comment(writes: Iterable[Channel], reads: Iterable[Channel]) -> str:
    """Return what a node writes and reads, topics first, as a comment; empty if nothing."""
    parts = [
        f"{verb} {', '.join(name for _, name in sorted(channels, key=_topics_first))}"
        for verb, channels in (("writes", set(writes)), ("reads", set(reads)))
        if channels
    ]
    return f"  # {blanked('; '.join(parts), '?')}" if parts else ""


def _channel(element: Element) -> Channel:
    return (element.kind, element.name)


def _topics_first(channel: Channel) -> tuple[int, str]:
    kind, name = channel
    return (["topic", "service", "action"].index(kind), name)


def _remarks(
    graph: FlowGraph, standard: Collection[Channel], left_out: Collection[Channel], own: Iterable[str]
) -> Iterator[str]:
    there = {channel for channel in map(_channel, graph.elements) if channel in left_out}
    taken = there.intersection(standard)
    names = "".join(f", {name}" for name in own)
    yield f"Kinds of data: rosprivacy categories{f'; your own:{names[1:]}' if names else ''}"
    if taken:
        yield f"Not listed: {counted(len(taken), 'standard channel')}, taken as mundane (rosprivacy labels --standard)"
    if there - taken:
        more = counted(len(there - taken), "lifecycle or other infrastructure channel")
        yield f"Not listed: {more}; add -l rosprivacy:infrastructure to take them as mundane,"
        yield "            after you have read it (rosprivacy labels --infrastructure)"


def _nodes(graph: FlowGraph, listed: Collection[Channel]) -> Iterator[str]:
    enclaves: dict[str, set[str]] = defaultdict(set)
    for profile in graph.profiles:
        enclaves[profile.node].add(profile.enclave)
    groups: dict[str, list[str]] = defaultdict(list)
    for element in graph.elements:
        if element.is_node:
            groups[", ".join(sorted(enclaves[element.name]))].append(element.name)
    writes, reads = neighbours(graph, listed)
    yield "\nnodes:"
    for group, names in sorted(groups.items()):
        yield f"  # enclave {blanked(group, '?')}"
        yield from (
            f"  {key(literal(name))}{endpoint_comment(writes.get(name, ()), reads.get(name, ()))}" for name in names
        )


def _participants(graph: FlowGraph, listed: Collection[Channel]) -> Iterator[str]:
    """What was seen and is no node (rule S16); a person may know what kind of element it is."""
    names = [element.name for element in graph.elements if element.kind == PARTICIPANT]
    writes, reads = neighbours(graph, listed) if names else ({}, {})
    if names:
        yield "\nelements:  # seen, and of no node; takes what nodes take, or another kind, such as external-system"
    for name in names:
        yield f"  {name}: {{kind: {PARTICIPANT}}}{endpoint_comment(writes.get(name, ()), reads.get(name, ()))}"


def neighbours(
    graph: FlowGraph, listed: Collection[Channel]
) -> tuple[Mapping[str, set[Channel]], Mapping[str, set[Channel]]]:
    """Return the channels that each node, or element outside ROS, writes and reads, of those that are listed."""
    writes: dict[str, set[Channel]] = defaultdict(set)
    reads: dict[str, set[Channel]] = defaultdict(set)
    own, meetings = parted(graph.flows)
    ends = [(flow.source, flow.target) for _, flow in own]
    ends += (pair for meeting in meetings if not meeting.of_wildcards for pair in meeting.pairs())
    for here, there in ends:
        source, target = graph.elements[here], graph.elements[there]
        if not source.is_channel and target.is_channel and _channel(target) in listed:
            writes[source.name].add(_channel(target))
        elif not target.is_channel and source.is_channel and _channel(source) in listed:
            reads[target.name].add(_channel(source))
    return writes, reads


def _channels(graph: FlowGraph, listed: Collection[Channel]) -> Iterator[str]:
    for section in ("topics", "services", "actions"):
        (kind,) = SECTIONS[section]
        names = sorted({e.name for e in graph.elements if e.kind == kind and _channel(e) in listed})
        if names:
            yield f"\n{section}:"
            yield from (f"  {key(literal(name))}" for name in names)
