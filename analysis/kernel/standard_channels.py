"""Standard ROS channels that are taken as mundane on a shipped file's word (rule S13): who would be reached, and globs.

In: a spread at its fixpoint. Out: the channels at which data stops for this alone, and those of which a glob of the
user's says otherwise, and does not count.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import number, parted
from rosprivacy.analysis.model import GLOB, STANDARD

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Element

SAYS_OTHERWISE = ("sensitive", "only")


def reached(spread: Spread, mask: int) -> tuple[tuple[Element, tuple[str, ...]], ...]:
    """Return (channel, categories that get to it and stop there), one for both legs and sides of a channel.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> carried = spread(*factory())
    >>> [(channel.name, names) for channel, names in reached(carried, carried.all_bits)]
    [('/rosout', ('Video',))]
    """
    elements = spread.graph.elements
    bits: dict[tuple[str, str, str], int] = defaultdict(int)
    first: dict[tuple[str, str, str], Element] = {}
    for _, target, sent in sorted(_sent(spread)):
        stopped = sent & mask & ~spread.keeps.get(target, spread.all_bits)
        standard = [c for c in spread.names(stopped) if spread.facts[target][c].standard]
        if standard:
            element = elements[target]
            bits[element.identity] |= sum(spread.forms_of(name) for name in standard)
            first.setdefault(element.identity, element)
    return tuple((first[key], spread.names(bits[key])) for key in sorted(bits))


def _sent(spread: Spread) -> Iterator[tuple[int, int, int]]:
    """(number of a flow to a standard channel, the channel, what is sent along it), of a meeting one for all alike."""
    own, meetings = parted(spread.graph.flows, spread.told_apart) if spread.standard else ((), ())
    for index, flow in own:
        if flow.target in spread.standard:
            yield index, flow.target, spread.sends(index)
    for meeting in meetings:
        senders: dict[int, int] = {}  # what is sent -> the first that sends it
        for source in reversed(meeting.written):
            senders[spread.sent.get(source, 0)] = source
        for target in spread.standard.intersection(meeting.read):
            yield from ((number(spread.graph.flows, one, target), target, sent) for sent, one in senders.items())


def unchanged(spread: Spread, bound: Bound) -> tuple[Element, ...]:
    """Return the channels of which a glob with an open end says that they may carry data, and does not count.

    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import ROSOUT, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.model import Place, Statement
    >>> graph, bound, hierarchy = factory()
    >>> said = Statement("sensitive", (), (1, 0), Place("labels.yaml", 6), naming=GLOB)
    >>> bound = replace(bound, elements={**bound.elements, ROSOUT: (*bound.elements[ROSOUT], said)})
    >>> [channel.name for channel in unchanged(spread(graph, bound, hierarchy), bound)]
    ['/rosout']
    """
    elements = spread.graph.elements
    globs = {
        elements[vertex].identity: elements[vertex]
        for vertex in sorted(spread.standard, reverse=True)
        for said in bound.elements[vertex]
        if said.naming == GLOB and said.rank[0] > STANDARD and said.role in SAYS_OTHERWISE
    }
    return tuple(globs[key] for key in sorted(globs))
