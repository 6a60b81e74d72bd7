"""Flows that are alike: each of some elements sends to each of some others, and all is told once.

Wildcards that are written, each of which meets each of some that are read (rule S4); or the nodes of an enclave and the
channels that each of them may write, or read, as the enforced view has it (rule S6).
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Flow

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from rosprivacy.analysis.model import Grant

MATCHES = "matches"


class Right(NamedTuple):
    """What the nodes of an enclave may do with a channel: the role, and the policy lines that allow it."""

    role: str
    grants: tuple[Grant, ...] = ()


class Meeting(NamedTuple):
    """Elements each of which sends to each of some others, by index; both sorted.

    Attributes
    ----------
    written, read
        Wildcards; or nodes and channels, in either direction.
    of_written, of_read
        Of each channel, where the other side is the nodes of an enclave: their right. Empty for wildcards.
    """

    written: tuple[int, ...]
    read: tuple[int, ...]
    of_written: tuple[Right, ...] = ()
    of_read: tuple[Right, ...] = ()

    @property
    def size(self) -> int:
        """How many flows it stands for."""
        return len(self.written) * len(self.read)

    @property
    def of_wildcards(self) -> bool:
        """Whether both sides are channels."""
        return not self.of_written and not self.of_read

    def pairs(self) -> Iterable[tuple[int, int]]:
        """Return the ends of each flow that it stands for."""
        return ((source, target) for source in self.written for target in self.read)

    def flow(self, source: int, target: int) -> Flow:
        """Return one of the flows."""
        if self.of_read:
            return Flow(source, target, *self.of_read[bisect_left(self.read, target)])
        if self.of_written:
            return Flow(source, target, *self.of_written[bisect_left(self.written, source)])
        return Flow(source, target, MATCHES)

    def flows(self) -> Iterable[Flow]:
        """Return each flow that it stands for."""
        return (self.flow(*pair) for pair in self.pairs())

    def parted(self, ends: Iterable[tuple[int, int]]) -> tuple[Meeting, Meeting]:
        """Return it without the elements of one side that some flows are of, and with these only."""
        written, read = set(self.written), set(self.read)
        inside = [(source, target) for source, target in ends if source in written and target in read]
        sources, targets = {source for source, _ in inside}, {target for _, target in inside}
        if len(sources) <= len(targets):
            return self._part(written - sources, read), self._part(sources, read)
        return self._part(written, read - targets), self._part(written, targets)

    def _part(self, written: Collection[int], read: Collection[int]) -> Meeting:
        sides = ((self.written, self.of_written, written), (self.read, self.of_read, read))
        ends = [tuple(vertex for vertex in side if vertex in some) for side, _, some in sides]
        rights = [tuple(of for vertex, of in zip(*pair, strict=False) if vertex in some) for *pair, some in sides]
        return Meeting(ends[0], ends[1], rights[0], rights[1])


def sharing(nodes: tuple[int, ...], channels: tuple[int, ...], rights: tuple[Right, ...], *, writes: bool) -> Meeting:
    """Return what nodes of an enclave share: each writes, or reads, each of some channels.

    Parameters
    ----------
    rights
        Of each channel.

    Examples
    --------
    >>> sharing((0, 1), (5,), (Right("subscribe"),), writes=False).flow(5, 1).role
    'subscribe'
    """
    return Meeting(nodes, channels, of_read=rights) if writes else Meeting(channels, nodes, of_written=rights)
