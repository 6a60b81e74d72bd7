"""What a language model is asked about: elements that nobody has labelled, with what may be told of them.

In: a graph with its labels and types. Out: names, types and comments, nothing else: no file, no policy, no label.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.evidence import DERIVATION, LEAK, SENSITIVE, SOURCE, whole

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.traffic import Traffic

    Comments = Mapping[tuple[str, str], tuple[str, ...]]  # kind and name of an element -> comments in code
LONGEST = 200  # signs of a name, a type or a comment
CHANNELS, TYPES, COMMENTS = 20, 3, 10  # of one element, at most: a request has a bounded size


class AskedChannel(NamedTuple):
    """A channel of a node."""

    name: str
    types: tuple[str, ...]


class Asked(NamedTuple):
    """An element as a language model is told of it.

    Attributes
    ----------
    element
        What it is; not sent.
    name, types, comments
        As sent: at most ``LONGEST`` signs each.
    writes, reads
        Of a node: its first channels, standard ones and wildcards left out.
    """

    element: Element
    name: str
    types: tuple[str, ...]
    writes: tuple[AskedChannel, ...]
    reads: tuple[AskedChannel, ...]
    comments: tuple[str, ...]

    @property
    def roles(self) -> tuple[str, ...]:
        """What a model may say of it: only what adds a question. Nothing that takes data away is asked for."""
        return (SOURCE, LEAK, DERIVATION) if self.element.is_node else (SENSITIVE,)

    def texts(self) -> Iterator[tuple[str, str]]:
        """Yield all that was sent of it, each with what it is: where a quote has to come from."""
        yield "name", self.name
        yield from (("type", one) for one in self.types)
        yield from (("comment", one) for one in self.comments)
        for channel in (*self.writes, *self.reads):
            yield "name", channel.name
            yield from (("type", one) for one in channel.types)

    def changed(self, change: Callable[[str], str]) -> Asked:
        """Return the same with another text in place of each."""

        def all_of(texts: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(map(change, texts))

        writes, reads = (
            tuple(AskedChannel(change(one.name), all_of(one.types)) for one in channels)
            for channels in (self.writes, self.reads)
        )
        name, types, comments = change(self.name), all_of(self.types), all_of(self.comments)
        return Asked(self.element, name, types, writes, reads, comments)


def asked_elements(
    graph: FlowGraph, bound: Bound, told: Traffic, open_places: Mapping[tuple[str, str, str], int], comments: Comments
) -> tuple[Asked, ...]:
    """Return the elements that are open, in the order of review, and then those that no label of a user names.

    Wildcards and standard channels are left out: no name of theirs says what they are for.

    Parameters
    ----------
    open_places
        Identities of open elements, with their places in the order of review (rule S11).
    comments
        What stands beside an element in source code.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.traffic import traffic
    >>> graph, bound, _ = factory()
    >>> said = asked_elements(graph, bound, traffic(graph, bound), {("", "topic", "/filtered"): 0}, {})
    >>> [(one.name, [channel.name for channel in one.reads]) for one in said]
    [('/filtered', []), ('/video', [])]
    """
    parts: dict[tuple[str, str, str], list[int]] = {}
    for vertex, element in enumerate(graph.elements):
        if (element.is_node or element.is_channel) and not element.pattern:
            parts.setdefault(element.identity, []).append(vertex)
    wanted = [
        identity for identity, vertices in parts.items() if identity in open_places or _unlabelled(vertices, bound)
    ]
    wanted.sort(key=lambda identity: (open_places.get(identity, len(open_places)), _order(parts[identity], graph)))
    types = {identity: _types(vertices, bound) for identity, vertices in parts.items()}

    def channels(vertices: list[int], ends: Mapping[int, tuple[int, ...]]) -> tuple[AskedChannel, ...]:
        near = dict.fromkeys(whole(graph.elements[one]) for vertex in vertices for one in ends.get(vertex, ()))
        named = [AskedChannel(_fit(one.name), types[one.identity]) for one in near if one.identity in types]
        return tuple(named[:CHANNELS])

    return tuple(
        Asked(
            whole(graph.elements[parts[identity][0]]),
            _fit(identity[2]),
            types[identity],
            channels(parts[identity], told.writes),
            channels(parts[identity], told.reads),
            tuple(map(_fit, comments.get(identity[1:], ())[:COMMENTS])),
        )
        for identity in wanted
    )


def _unlabelled(vertices: list[int], bound: Bound) -> bool:
    """Whether neither a shipped file nor a label of a user speaks of an element."""
    return not any(one.shipped or one.rank[0] > 0 for vertex in vertices for one in bound.elements.get(vertex, ()))


def _order(vertices: list[int], graph: FlowGraph) -> tuple[object, ...]:
    return graph.elements[vertices[0]].sort_key()


def _types(vertices: list[int], bound: Bound) -> tuple[str, ...]:
    names = sorted({said.name for vertex in vertices for said in bound.types.get(vertex, ())})
    return tuple(map(_fit, names[:TYPES]))


def _fit(text: str) -> str:
    return text[:LONGEST]
