"""Searches from one source each, made once: those of the answer before hold where nothing they met is otherwise now.

In: a ``Net`` and what is searched. Out: a ``Search``. An edit of a label changes what happens at a few elements; a
search that came to none of them goes as it went.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.search import search
from rosprivacy.analysis.kernel.spread import differing
from rosprivacy.analysis.many_flows import parted

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.kernel.states import Net

    Key = tuple[int, int, Hashable]

ROOM = 20_000  # vertices to which the searches that are kept came in all: some 20 MB


class Searches:
    """The searches of one answer.

    Parameters
    ----------
    room
        To how many vertices the searches may come in all that are kept; by default none are, since only where one
        answer follows another they are of use.
    made
        Those that hold already.
    """

    def __init__(self, room: int = 0, earlier: Mapping[Key, Search] | None = None) -> None:
        self._earlier = dict(earlier or {})
        self._room = room - sum(len(one.arrived_bits) for one in self._earlier.values())

    def past(self, changed: AbstractSet[int]) -> Searches:
        """Return those that came to none of some vertices, with room for more."""
        return Searches(ROOM, {key: one for key, one in self._earlier.items() if _untouched(key[0], one, changed)})

    def of(self, net: Net, source: int, allowed: int, stop: Mapping[int, int], stop_key: Hashable) -> Search:
        """Return a search as ``search`` makes it, from one source.

        Parameters
        ----------
        stop_key
            What ``stop`` is made of beside ``Spread.leaks``; equal only where it is made alike.
        """
        key = source, allowed, stop_key
        known = self._earlier.get(key)
        if known is not None:
            return known
        made = search(net, [source], allowed, stop)
        if len(made.arrived_bits) <= self._room:
            self._room -= len(made.arrived_bits)
            self._earlier[key] = made
        return made


def searches(spread: Spread, room: int = 0) -> Searches:
    """Return the searches of an answer, with those of the answer before that hold for it.

    Parameters
    ----------
    room
        As of ``Searches``, where there was no answer before.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> carried = spread(*factory())
    >>> made = searches(carried, ROOM).of(Net.of(carried), CAMERA, carried.all_bits, {}, None)
    >>> made.level(ARCHIVE, carried.forms_of("FaceTemplate"))
    4
    """
    return spread.memory.memoised("searches", None, lambda: Searches(room))


def searches_after(before: Spread, now: Spread, changed: AbstractSet[int]) -> None:
    """Let the searches of an answer hold for the next one, where they came to nothing that is otherwise there.

    Parameters
    ----------
    changed
        Of ``Spread.otherwise``.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.kernel.states import Net
    >>> first, same = spread(*factory()), factory()
    >>> made = searches(first, ROOM).of(Net.of(first), CAMERA, first.all_bits, {}, None)
    >>> now = spread(first.graph, *same[1:])
    >>> searches_after(first, now, now.otherwise(first))
    >>> searches(now).of(Net.of(now), CAMERA, now.all_bits, {}, None) is made
    True
    """
    left = searches(before).past(_met_otherwise(before, now, changed))
    now.memory.memoised("searches", None, lambda: left)


def _untouched(source: int, earlier: Search, changed: AbstractSet[int]) -> bool:
    return source not in changed and not any(vertex in earlier.arrived_bits for vertex in changed)


def _met_otherwise(before: Spread, now: Spread, changed: AbstractSet[int]) -> set[int]:
    """The vertices where something else happens to data than before, or searches are stopped otherwise.

    Where a channel takes up other data, it is its writers from which data goes on otherwise.
    """
    met = {*changed, *differing(before.leaks, now.leaks, 0)}
    channels = {vertex for vertex in changed if now.graph.elements[vertex].is_channel}
    if channels:
        own, meetings = parted(now.graph.flows, now.told_apart)
        met.update(flow.source for _, flow in own if flow.target in channels)
        met.update(vertex for one in meetings if not channels.isdisjoint(one.read) for vertex in one.written)
    return met
