"""Graph + what files state about elements outside ROS -> the graph with these and their flows (rule S9).

In: the flow graph of policies and label files. Out: a graph in which non-ROS elements take part like nodes; each of
their flows keeps the line that states it. A name that is not there is an error with the nearest (rule S11). Into a
storage that is a bag flows what was recorded, from the channels of that name (rule S3); what is not known of a bag is
told, so that the verdict is undetermined at best.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.many_flows import Flows, parted
from rosprivacy.analysis.model import (
    BAG_GAP,
    NOWHERE,
    PARTICIPANT,
    RECORDING,
    STATED,
    Diagnostic,
    Element,
    Flow,
    FlowGraph,
    Grant,
    MessageType,
    Severity,
)
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import A_LITTLE, FEW, bare_name, did_you_mean, literal, nearest
from rosprivacy.ingest.labels.entries import End, is_non_ros
from rosprivacy.ingest.policies.names import covered, covers, is_pattern, recorded_channels

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Place
    from rosprivacy.analysis.model.recording import Bag, BagTopic
    from rosprivacy.ingest.labels.entries import Stated
    from rosprivacy.ingest.labels.label_file import Labels

FLOW = STATED
SHOWN_AT_MOST = 5  # topics that no policy names, of one bag


def extend(graph: FlowGraph, files: Sequence[Labels]) -> FlowGraph:
    """Add the non-ROS elements of label files, and the flows that begin or end at them.

    Raises
    ------
    InputErrors
        With every element that is defined twice with different facts, and every end of a flow that is not there.
    """
    whole, problems = extended(graph, files)
    if problems:
        raise InputErrors(problems)
    return whole


def extended(graph: FlowGraph, files: Sequence[Labels]) -> tuple[FlowGraph, list[InputError]]:
    """Do the same as far as names go; return also what is wrong."""
    problems: list[InputError] = []
    if not any(file.elements or file.flows for file in files):
        return graph, problems
    stated: dict[str, Stated] = {}
    for own in (False, True):  # what one robot's file states takes the place of its model's
        stated |= merged((entry for file in files if file.own == own for entry in file.elements), problems)
    added = [Element(entry.kind, entry.name) for entry in stated.values()]
    graph = _with_stated_kinds(graph, stated)
    ends = FlowEnds([*graph.elements, *added])
    flows: list[tuple[Element, Element, Place]] = []
    for file in files:
        for flow in file.flows:
            if is_non_ros(flow.source) or is_non_ros(flow.target):
                flows += ends.between(*flow.ends, flow.place, problems)
    for entry in stated.values():
        for end in entry.between:
            both = list(ends.between(end, End(entry.name), entry.place, problems))
            flows += [*both, *((b, a, place) for a, b, place in both)]
        flows += recorded(graph, entry)
    return with_flows(graph, added, flows), problems


def _with_stated_kinds(graph: FlowGraph, stated: Mapping[str, Stated]) -> FlowGraph:
    """A graph in which a participant that was seen is of the kind that a person states of it (rule S16)."""
    kinds = {name: entry.kind for name, entry in stated.items()}
    elements = tuple(
        replace(e, kind=kinds[e.name]) if e.kind == PARTICIPANT and e.name in kinds else e for e in graph.elements
    )
    return graph if elements == graph.elements else replace(graph, elements=elements)


def merged(
    entries: Iterable[Stated], problems: list[InputError], error: type[InputError] = LabelError
) -> dict[str, Stated]:
    """Return elements by name; one that is defined twice with different facts is a problem."""
    found: dict[str, Stated] = {}
    for entry in entries:
        known = found.setdefault(entry.name, entry)
        if _facts(known) != _facts(entry):
            what = f"element {shown(entry.name)!r} again, with other facts than at {known.place}"
            problems.append(error(entry.place.file, entry.place.line, what, "define it once"))
    return found


def _facts(entry: Stated) -> tuple[object, ...]:
    """What is stated of an element, but for where; what its bags say of themselves is read after this."""
    stated = entry.outside._replace(place=NOWHERE, recording=None)
    return entry.kind, stated, entry.between, entry.bags


class FlowEnds:
    """The elements that the ends of stated flows name.

    A name or glob of ROS means nodes or channels, whichever have it; where both do, the kind has to be said.
    """

    def __init__(self, elements: Iterable[Element]) -> None:
        self.names: dict[str, dict[str, list[Element]]] = {kind: defaultdict(list) for kind in ("", "node", "channel")}
        for element in elements:
            kind = "channel" if element.is_channel else "node" if element.is_node else ""
            self.names[kind][element.name].append(element)

    def between(
        self, source: End, target: End, place: Place, problems: list[InputError]
    ) -> Iterator[tuple[Element, Element, Place]]:
        """The flows from each element of one name to each of another."""
        sources, targets = self.find(source), self.find(target)
        for end, found in ((source, sources), (target, targets)):
            if not found:
                known = [other for kind in self.names for other in self.names[kind]]
                problems.append(missing(end, known, place))
            elif kinds := two_meanings(end, found):
                problems.append(ambiguous(end, kinds, place))
        yield from ((a, b, place) for a in sources for b in targets)

    def find(self, end: End) -> list[Element]:
        """The elements of a name or glob, of the kind that is said or of all."""
        if is_non_ros(end.name):
            return self._of("", end.name)
        found = [*self._of("node", end.name), *self._of("channel", end.name)]
        return [element for element in found if end.kind in ("", element.kind)]

    def _of(self, kind: str, name: str) -> list[Element]:
        known = self.names[kind]
        return [element for other in (covered(name, known) if kind else [name]) for element in known.get(other, ())]


def two_meanings(end: End, elements: Iterable[Element]) -> tuple[str, ...]:
    """Return the kinds of what an end means if nodes and channels are among it, and which is not said (rule S9)."""
    kinds = {element.kind for element in elements}
    return () if end.kind or "node" not in kinds or kinds == {"node"} else ("node", *sorted(kinds - {"node"}))


def ambiguous(end: End, kinds: Iterable[str], place: Place, error: type[InputError] = LabelError) -> InputError:
    """Return the error for the end of a flow that names a node and a channel."""
    written = f"'{end.name}'" if ":" in end.name or not end.name.startswith("/") else end.name
    named = " and ".join(f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}" for kind in kinds)
    hint = " or ".join(f"{{{kind}: {shown(written)}}}" for kind in kinds)
    return error(place.file, place.line, f"a flow names {shown(end.name)!r}, which is {named}", f"write {hint}")


def missing(end: End, names: Iterable[str], place: Place, error: type[InputError] = LabelError) -> InputError:
    """Return the error for the end of a flow that is not there, with the nearest names."""
    alike = [other for other in dict.fromkeys(names) if is_non_ros(other) == is_non_ros(end.name)]
    close = nearest(bare_name(end.name), [other for other in alike if other != end.name], FEW, A_LITTLE)
    close = close if is_non_ros(end.name) else [literal(name) for name in close]
    otherwise = "define it under elements" if is_non_ros(end.name) else "see the names with rosprivacy labels --init"
    hint = did_you_mean(close, otherwise)
    kind = f"the {end.kind} " if end.kind else ""
    return error(place.file, place.line, f"a flow names {kind}{shown(end.name)!r}, which is not there", hint)


def with_flows(
    graph: FlowGraph, elements: Iterable[Element], flows: Iterable[tuple[Element, Element, Place]]
) -> FlowGraph:
    """Return a graph with more elements and flows, numbered anew and sorted (rule S14)."""
    known = sorted({*graph.elements, *elements}, key=Element.sort_key)
    number = {element: i for i, element in enumerate(known)}
    moved = [number[element] for element in graph.elements]
    lines: dict[tuple[int, int], list[Place]] = defaultdict(list)
    for source, target, place in flows:
        lines[number[source], number[target]].append(place)
    added = [Flow(*ends, FLOW, tuple(line_of(place) for place in _sorted(places))) for ends, places in lines.items()]

    def renumbered(old: Iterable[Flow], new: Sequence[Flow] = ()) -> tuple[Flow, ...]:
        kept = [Flow(moved[f.source], moved[f.target], f.role, f.grants, f.denials) for f in old]
        return tuple(sorted([*kept, *new], key=lambda f: (f.source, f.target, f.role)))

    own, meetings = parted(graph.flows)
    allowed: Sequence[Flow] = renumbered((flow for _, flow in own), added)
    if isinstance(graph.flows, Flows):  # no flow that is stated has both of its ends in a meeting
        met = tuple(
            m._replace(written=tuple(moved[v] for v in m.written), read=tuple(moved[v] for v in m.read))
            for m in meetings
        )
        allowed = replace(graph.flows, stored=tuple(allowed), meetings=met)
    denied = renumbered(graph.denied)
    matches = renumbered(graph.denied_matches)
    return FlowGraph(tuple(known), allowed, denied, graph.profiles, graph.view, matches, graph.careful)


def _sorted(places: Iterable[Place]) -> list[Place]:
    return sorted(set(places), key=lambda place: (place.file, place.line))


def line_of(place: Place) -> Grant:
    """Return the line that states a flow, in the form of the lines that grant others."""
    return Grant(True, FLOW, FLOW, "", "", "", place)


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
            for what in (*bag.gaps, *(f"{what} can hold anything" for what in bag.extras)):
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
    told = ", ".join([*map(shown, names[:SHOWN_AT_MOST]), *(["…"] if len(names) > SHOWN_AT_MOST else [])])
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
