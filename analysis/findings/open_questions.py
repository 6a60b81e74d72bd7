"""What is not known: open elements, ends of data that nobody known is at, and what an answer has no grounds for (S11).

In: a spread. Out: open questions in the order of review: elements that a category reaches and that no label covers,
of which the frontier is found by the same search as paths are, with open nodes and leaks of the category as ends.
``UnknownEnd`` facts, which change no verdict: the reader may stand in a policy that was not given, or be a node without
any. ``Grounds``: what 'no leak found' needs before it says anything (rule S12), of a system or of a part of it.
"""

from __future__ import annotations

from collections import defaultdict
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.answer import OpenQuestion
from rosprivacy.analysis.kernel.search import from_sources, present, search
from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import (
    GOES_NOWHERE,
    NETWORK,
    NO_LEAK_NAMED,
    NO_SOURCE,
    NON_ROS,
    PARTICIPANT,
    Diagnostic,
    Place,
    Severity,
    UnknownEnd,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.kernel.states import Net
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Element, FlowGraph

NOTHING: Mapping[int, tuple[str, ...]] = MappingProxyType({})
SPEAKS_OF_LEAKS = ("leak", "no-leak")
NO_SOURCE_OF_THESE = "no source emits one of the chosen categories, and nothing makes one: no data was followed"
GOES_TO_SUCH = (
    "what the sources bring in goes nowhere, or only to standard channels and to those whose type cannot carry it: "
    "no data was followed"
)
NOTHING_FOLLOWED_BECAUSE = {
    NO_SOURCE: "no label names a source: no data was followed",
    GOES_NOWHERE: "what the sources bring in goes nowhere, or to standard channels only: no data was followed",
    NO_LEAK_NAMED: "no label says where data gets out: nothing that it gets to could be a leak",
}


def open_questions(net: Net, mask: int, unknown: Mapping[int, tuple[str, ...]] = NOTHING) -> tuple[OpenQuestion, ...]:
    """Return the elements that a category reaches and no label covers, in the order of review.

    Parameters
    ----------
    net
        Of a spread.
    mask
        Bits of the categories that the answer is about.
    unknown
        Vertex -> what has to be known of it and is not stated (``non_ros.unanswered``): open for all that gets there.

    Returns
    -------
    tuple of OpenQuestion
        Nodes on the frontier first, then by distance and name; O(flows) for each category that others are made into,
        and once for all the rest.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> net = Net.of(spread(*factory()))
    >>> [(question.element.name, question.distance) for question in open_questions(net, net.spread.all_bits)]
    [('/video', 1), ('/filtered', 3)]
    """
    spread, elements = net.spread, net.spread.graph.elements
    uncovered = open_bits(spread, unknown)
    if not uncovered:
        return ()
    _, nearest = from_sources(spread)
    first = _first(net, nearest.begun, uncovered)
    merged: dict[tuple[str, str, str, str], OpenQuestion] = {}
    levels: dict[tuple[int, int], int] = spread.course.memoised("levels", None, dict)
    names = {bits: spread.names(bits & mask) for bits in set(uncovered.values())}
    for vertex, everything in sorted(uncovered.items()):
        element, bits = elements[vertex], everything & mask
        if not bits:
            continue
        if (vertex, bits) not in levels:
            levels[vertex, bits] = nearest.level(vertex, bits) or 0
        frontier = not element.is_channel and bool(first.get(vertex, 0) & bits)
        missing = unknown.get(vertex, ())
        question = OpenQuestion(element, names[everything], levels[vertex, bits], frontier, missing)
        known = merged.get(element.shown_as)  # the other side of a wildcard
        if known:
            categories = tuple(sorted({*known.categories, *question.categories}))
            question = known._replace(categories=categories, distance=min(known.distance, question.distance))
        merged[element.shown_as] = question
    # the elements of a graph are sorted, and so are these; what is alike here stays in that order
    return tuple(sorted(merged.values(), key=lambda q: (not q.frontier, q.distance)))


def open_bits(spread: Spread, unknown: Collection[int]) -> dict[int, int]:
    """Return what is at elements without a label that covers it, or of which something has to be known and is not.

    >>> from rosprivacy.analysis.example import DISK, NAMES, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> {NAMES[vertex]: carried.names(bits) for vertex, bits in sorted(open_bits(carried, {DISK}).items())}
    {'disk': ('FaceTemplate', 'Video'), '/filtered': ('Video',), '/video': ('Video',)}
    """
    covered, present = spread.covered, spread.present
    uncovered: dict[int, int] = {}
    for vertex in {*spread.arrives, *spread.leaves}:
        if bits := present(vertex) & ~(0 if vertex in unknown else covered.get(vertex, 0)):
            uncovered[vertex] = bits
    return uncovered


def _first(net: Net, sources: Iterable[int], uncovered: Mapping[int, int]) -> dict[int, int]:
    """Open node -> bits that get there past no other open node, and past no leak of their category.

    One search does for all categories that nothing is made into; each of the others takes one, since what it is made
    of passes its leaks.
    """
    spread = net.spread
    nodes = {v: spread.bits.in_both_forms(b) for v, b in uncovered.items() if not spread.graph.elements[v].is_channel}
    asked = 0
    for bits in nodes.values():
        asked |= bits
    made = sum(map(spread.bits.pair, spread.made_categories))
    first: dict[int, int] = dict.fromkeys(nodes, 0)
    for own in [asked & ~made, *(spread.bits.pair(i) & asked for i in sorted(spread.made_categories))]:
        if own:
            ends = nodes | {v: nodes.get(v, 0) | there for v, bits in spread.leaks.items() if (there := bits & own)}
            reached = search(net, sources, _becoming(spread, own), ends)
            for vertex, bits in nodes.items():
                if bits & own:
                    first[vertex] |= present(reached, vertex) & own
    return first


def _becoming(spread: Spread, bits: int) -> int:
    """Some bits, and those that they are made of somewhere: nothing else can become one of them on its way."""
    pairs = {pair for there in spread.derives.values() for pair in there}
    found = 0
    while found != bits:
        found = bits
        for before, after in pairs:
            bits |= (bits >> after & 1) << before
    return found


def unknown_ends(spread: Spread, mask: int) -> tuple[UnknownEnd, ...]:
    """Return channels with data that nobody known reads, and elements outside ROS that no flow reaches.

    Parameters
    ----------
    mask
        Bits of the categories that the answer is about.

    Notes
    -----
    Who reads is a matter of flows: a flow that a DENY takes back makes no reader, one that some data may not take
    makes one. O(flows).

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> unread = replace(graph, flows=graph.flows[:5])  # nobody subscribes
    >>> carried = spread(unread, bound, hierarchy)
    >>> [(end.element.name, end.missing, end.categories) for end in unknown_ends(carried, carried.all_bits)]
    [('/video', 'reader', ('Video',))]
    """
    merged: dict[tuple[str, str, str, str], tuple[Element, int]] = {}
    for vertex in _unread(spread, mask):
        element = spread.graph.elements[vertex]
        first, bits = merged.get(element.shown_as, (element, 0))  # the other side of a wildcard
        merged[element.shown_as] = first, bits | spread.present(vertex) & mask
    ends = [UnknownEnd(element, "reader", spread.names(bits)) for element, bits in merged.values()]
    ends += [UnknownEnd(spread.graph.elements[vertex], "flow") for vertex in _unreached(spread)]
    return tuple(sorted(ends, key=lambda end: end.element.sort_key()))


def _unread(spread: Spread, mask: int) -> Iterator[int]:
    """Channels with data from which no flow leads to anything but channels."""
    elements = spread.graph.elements
    known = spread.shape.memoised("readable", None, lambda: _readable(spread.graph))
    for vertex in sorted(spread.leaves):
        if elements[vertex].is_channel and spread.present(vertex) & mask and vertex not in known:
            yield vertex


def _readable(graph: FlowGraph) -> Collection[int]:
    """Return the channels that a node reads, by their name or through wildcards that match it (rule S4)."""
    known: set[int] = set()
    before: dict[int, list[int]] = defaultdict(list)
    own, meetings = parted(graph.flows)
    for _, flow in own:
        if not graph.elements[flow.source].is_channel:
            continue
        if graph.elements[flow.target].is_channel:
            before[flow.target].append(flow.source)
        else:
            known.add(flow.source)
    met: dict[int, list[Meeting]] = defaultdict(list)
    for meeting in meetings:
        known.update(meeting.written if meeting.of_written else ())
        for target in meeting.read if meeting.of_wildcards else ():
            met[target].append(meeting)
    waiting = list(known)
    done: set[int] = set()
    while waiting:
        read = waiting.pop()
        new = [meeting for meeting in met.get(read, ()) if id(meeting) not in done]
        done.update(map(id, new))
        for channel in (*before.get(read, ()), *(source for meeting in new for source in meeting.written)):
            if channel not in known:
                known.add(channel)
                waiting.append(channel)
    return known


def _is_network(element: Element) -> bool:
    """Whether an element stands for whoever is on the network: what it reads is a matter of the enforced view (S6)."""
    return element.kind == PARTICIPANT and element.name == NETWORK


def _unreached(spread: Spread) -> Iterator[int]:
    """Elements outside ROS that nothing flows into; where data may begin, a flow out is enough."""
    graph = spread.graph
    outside = [v for v, e in enumerate(graph.elements) if e.kind in NON_ROS and not _is_network(e)]
    if not outside:
        return
    own = [flow for _, flow in parted(graph.flows)[0]]  # a meeting is one of channels, or of them and nodes
    entered = {flow.target for flow in own}
    left = {flow.source for flow in own}
    for vertex in outside:
        if vertex not in entered:
            begins = graph.elements[vertex].kind == PARTICIPANT  # it was seen to write, and nobody says what
            begins |= any("source" in fact.roles for fact in spread.facts.get(vertex, {}).values())
            if not (begins and vertex in left):
                yield vertex


class Grounds(NamedTuple):
    """Whether what is asked for begins or is made, whether it goes on, and whether anybody speaks of leaks."""

    source: bool = False
    onward: bool = False
    leak: bool = False

    def __or__(self, other: Grounds) -> Grounds:
        """Return the grounds of two parts of a system together."""
        return Grounds(self.source or other.source, self.onward or other.onward, self.leak or other.leak)

    @property
    def lacking(self) -> str:
        """What is missing first, as the code of a diagnostic; empty if nothing is.

        >>> Grounds(source=True, onward=True).lacking
        'no-leak-named'
        """
        if not self.source:
            return NO_SOURCE
        return GOES_NOWHERE if not self.onward else "" if self.leak else NO_LEAK_NAMED


def grounds(spread: Spread, mask: int) -> Grounds:
    """Return the grounds of a spread, for some of its categories.

    What a person closes, or a DENY, was looked at: the data got there. A standard channel and what
    the type of a channel cannot carry are nobody's word.

    Examples
    --------
    >>> from rosprivacy.analysis import example
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> found = spread(*example.factory())
    >>> grounds(found, found.all_bits)
    Grounds(source=True, onward=True, leak=True)
    """
    asked = spread.names(mask)
    return Grounds(
        source=any(spread.begins(vertex) & mask for vertex in spread.facts)
        or any(bits & mask for reached in (spread.arrives, spread.leaves) for bits in reached.values()),
        onward=_onward(spread, mask),
        leak=any(_judged(spread, vertex, asked) for vertex in spread.facts),
    )


def _onward(spread: Spread, mask: int) -> bool:
    arrived = ((v, bits & ~spread.limited.get(v, 0)) for v, bits in spread.arrives.items())
    if any(bits & mask for vertex, bits in arrived if vertex not in spread.standard):
        return True
    if any(spread.leaves.get(flow.source, 0) & mask for flow in spread.graph.taken_back):
        return True
    return any(spread.leaves.get(spread.graph.flows[index].source, 0) & mask for index in spread.flow_keeps)


def _judged(spread: Spread, vertex: int, question_role: tuple[str, ...]) -> bool:
    """Whether it is a storage, or is said to be a leak or none: by a label, outranked or not, or by its kind."""
    if spread.graph.elements[vertex].kind == "storage":
        return True
    facts = [fact for category, fact in spread.facts[vertex].items() if category in question_role]
    said = (statement for fact in facts for statement in (*fact.accepted, *(lost for lost, _ in fact.outdone)))
    return any(statement.role in SPEAKS_OF_LEAKS for statement in said)


def lacking(code: str, *, restricted: bool, limited: bool = False) -> tuple[Diagnostic, ...]:
    """Return the warning about what is missing, if anything.

    Parameters
    ----------
    restricted
        Whether only some categories are asked for.
    limited
        Whether there are channels that cannot carry some (rule S15).

    >>> [said.message.partition(":")[0] for said in lacking(NO_SOURCE, restricted=True)]
    ['no source emits one of the chosen categories, and nothing makes one']
    """
    if not code:
        return ()
    what = NO_SOURCE_OF_THESE if code == NO_SOURCE and restricted else NOTHING_FOLLOWED_BECAUSE[code]
    what = GOES_TO_SUCH if code == GOES_NOWHERE and limited else what
    return (Diagnostic(Place("labels", 0), Severity.WARNING, f"{what}, so this says nothing about the system", code),)
