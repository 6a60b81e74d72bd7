"""Lines of policies that name an element: where a person begins to look.

In: a ``FlowGraph`` and elements as readers see them. Out: a place for each that a policy names.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import Place

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence

    from rosprivacy.analysis.model import Flow, FlowGraph, Grant

    Shown = tuple[str, ...]

OURS = "rosprivacy:"  # label files that come with the program have no path


def in_a_file(place: Place) -> bool:
    """Whether a place is a line of a file that a person can open.

    >>> in_a_file(Place("p.xml", 2)), in_a_file(Place("rosprivacy:standard", 2)), in_a_file(Place("p.xml", 0))
    (True, False, False)
    """
    return place.line > 0 and bool(place.file) and not place.file.startswith(OURS)


def first_lines(graph: FlowGraph, elements: Collection[Shown]) -> dict[Shown, Place]:
    """Return the first line, by file and number, that grants something at each of some elements (``shown_as``).

    Complexity: O(flows and rights of meetings), nothing where no element is wanted.

    >>> from rosprivacy.analysis.example import factory
    >>> graph, _, _ = factory()
    >>> {name: str(place) for (_, _, name, _), place in first_lines(graph, {("", "topic", "/video", "")}).items()}
    {'/video': 'policy.xml:2'}
    """
    found: dict[Shown, tuple[str, int]] = {}
    for vertex, grants in _grants_at(graph.flows) if elements else ():
        end = graph.elements[vertex].shown_as
        if end in elements:
            lines = [(grant.place.file, grant.place.line) for grant in grants if in_a_file(grant.place)]
            known = [found[end]] if end in found else []
            if lines or known:
                found[end] = min([*lines, *known])
    return {end: Place(*line) for end, line in found.items()}


def _grants_at(flows: Sequence[Flow]) -> Iterator[tuple[int, tuple[Grant, ...]]]:
    """What allows a flow at an element; of nodes that share their rights once, at the channels."""
    own, meetings = parted(flows)
    yield from ((vertex, flow.grants) for _, flow in own for vertex in (flow.source, flow.target))
    for meeting in meetings:  # no line states those of wildcards
        for side, rights in ((meeting.written, meeting.of_written), (meeting.read, meeting.of_read)):
            yield from ((vertex, right.grants) for vertex, right in zip(side, rights, strict=False))
