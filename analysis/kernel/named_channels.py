"""Channels that a source names: nothing takes away what it sends through them (rules S7, S8).

In: what statements mean for elements and flows, before they are carried. Out: the same, where statements that would
close a channel to what a source names it for do not count there, in neither leg of a service or action; and an error
where a user's full name says so.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.kernel.ranks import closes, in_words
from rosprivacy.analysis.kernel.roles import facts
from rosprivacy.analysis.many_flows import at_most, number, parted
from rosprivacy.analysis.meeting import MATCHES
from rosprivacy.analysis.model import CHANGED, STATED

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.roles import Facts
    from rosprivacy.analysis.model import Bound, FlowGraph, Place, Statement

    Meaning = dict[int, dict[str, Facts]]  # vertex or flow -> category -> what it does with it


def stated_flows(graph: FlowGraph) -> dict[int, list[int]]:
    """Return vertex -> the flows out of it that a person states: channels that a source names do not restrict these.

    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> graph, _, _ = factory()
    >>> {NAMES[vertex]: [NAMES[graph.flows[i].target] for i in flows] for vertex, flows in stated_flows(graph).items()}
    {'/archive': ['disk']}
    """
    stated: dict[int, list[int]] = defaultdict(list)
    for index, flow in parted(graph.flows)[0]:
        if flow.role == STATED:
            stated[flow.source].append(index)
    return dict(stated)


def keep_named(
    elements: Meaning, flows: Meaning, graph: FlowGraph, bound: Bound, hierarchy: Hierarchy
) -> Iterator[InputError]:
    """Let pass what sources name channels for, in place; yield where a user's full name closes one.

    Parameters
    ----------
    elements, flows
        What statements mean for each.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.model import Bound, Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> source = Statement("source", ("Video",), (1, 1), Place("labels.yaml", 2), through=("/video",))
    >>> never = Statement("never", ("Video",), (1, 1), Place("labels.yaml", 9))
    >>> bound = Bound({CAMERA: (source,), VIDEO: (never,)}, through={(CAMERA, source.through): (2,)})
    >>> elements = {v: {"Video": facts("", said, "Video", hierarchy)} for v, said in bound.elements.items()}
    >>> print(*keep_named(elements, {}, graph, bound, hierarchy))
    labels.yaml:9: /video is never [Video] here, and the source at labels.yaml:2 names it for Video; keep one of them
    """
    told: set[tuple[Place, Place]] = set()
    for category, source, vertex, index in channels_of_sources(elements, graph, bound):
        for meaning, of, at in ((elements, bound.elements, vertex), (flows, bound.flows, index)):
            decided = meaning.get(at, {}).get(category)
            if decided is None or decided.passes:
                continue
            kept = [s for s in of[at] if s.by_name or not closes(s, category, hierarchy)]
            name = graph.elements[vertex].name
            now = facts(name, kept, category, hierarchy)
            meaning[at] = {**meaning[at], category: now}  # elements of which the same is said share the other one
            for closer in now.closers:
                if closer.rank[0] < CHANGED and (closer.place, source.place) not in told:
                    told.add((closer.place, source.place))
                    yield _contradiction(name, category, closer, source)


def channels_of_sources(
    elements: Mapping[int, Mapping[str, Facts]], graph: FlowGraph, bound: Bound
) -> list[tuple[str, Statement, int, int]]:
    """Return (category, statement of a source, channel that it names, flow to it), with what wildcards match there.

    With the leg of a service or an action that the source writes comes the other, to which it has no flow: -1.

    >>> from rosprivacy.analysis.example import CAMERA, NAMES, factory
    >>> from rosprivacy.analysis.model import Bound, Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> source = Statement("source", ("Video",), (1, 1), Place("labels.yaml", 2), through=("/video",))
    >>> bound = Bound({CAMERA: (source,)}, through={(CAMERA, source.through): (2,)})
    >>> elements = {CAMERA: {"Video": facts("/camera", (source,), "Video", hierarchy)}}
    >>> [(category, NAMES[channel], flow) for category, _, channel, flow in channels_of_sources(elements, graph, bound)]
    [('Video', '/video', 2)]
    """
    rows: list[tuple[str, Statement, int, int]] = []
    if not bound.through:
        return rows
    matches: dict[int, list[int]] = defaultdict(list)
    met: dict[int, list[int]] = defaultdict(list)
    own, meetings = parted(graph.flows)
    for index, flow in own:
        if flow.role == MATCHES and graph.elements[flow.target].is_channel:  # past a proposed filter one ends at a node
            matches[flow.source].append(index)
    for meeting in (one for one in meetings if one.of_wildcards):
        for written in meeting.written:
            met[written] += meeting.read
    legs: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    for vertex, element in enumerate(graph.elements):
        if element.leg:
            legs[element.identity].append(vertex)
    for vertex, decided in elements.items():
        for category, fact in decided.items():
            for source in fact.by_role("source")[:1] if fact.through else ():
                indices = bound.through.get((vertex, fact.through), ())
                ends = {graph.flows[i].target: i for i in _with_matches(indices, graph, matches, met)}
                both = {leg: -1 for end in ends for leg in legs.get(graph.elements[end].identity, ())}
                rows += [(category, source, end, index) for end, index in {**both, **ends}.items()]
    return rows


def _with_matches(
    indices: Iterable[int], graph: FlowGraph, matches: Mapping[int, list[int]], met: Mapping[int, list[int]]
) -> list[int]:
    """Flows, and those from the wildcards at their ends to the channels that these match or meet."""
    flows = list(indices)
    seen = set(flows)
    for index in flows:
        end = graph.flows[index].target
        every = sorted([*matches.get(end, ()), *(number(graph.flows, end, read) for read in met.get(end, ()))])
        at_most(graph.flows, len(flows) + len(every))
        new = [after for after in every if after not in seen]
        seen.update(new)
        flows += new
    return flows


def _contradiction(name: str, category: str, closer: Statement, source: Statement) -> LabelError:
    what = f"{shown(name)} is {in_words(closer)} here, and the source at {source.place} names it for {category}"
    return LabelError(closer.place.file, closer.place.line, what, "keep one of them")
