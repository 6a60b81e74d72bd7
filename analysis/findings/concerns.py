"""What makes a finding: where a category must not get and why, and which of the ways it gets there are shown (S9, S10).

In: a spread and what is stated of elements; then whether data of a source gets to a leak in each way. Out: ``Concern``
facts; of each ``Arrival`` whether a finding shows it.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from rosprivacy.analysis.model import DISCLOSURE, STORAGE_LIMITATION, THIRD_COUNTRY, UNPROTECTED, Reason
from rosprivacy.analysis.model.reason import NOT_ENCRYPTED, NOT_ENCRYPTED_NOR_CLOSED, STRANGERS
from rosprivacy.analysis.non_ros import kept_too_long, transferred

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Bound, Exposure

Flags = TypeVar("Flags", "NDArray[np.bool_]", int)


class Concern(NamedTuple):
    """A kind of finding: vertex -> bits that must not get there, and why."""

    kind: str
    bits: Mapping[int, int]
    reasons: Mapping[tuple[int, str], Reason]

    def taken_up(self, spread: Spread) -> Mapping[int, int]:
        """Return the bits without those that a channel does not carry, if they come."""
        if self.kind != UNPROTECTED:
            return self.bits
        return {v: bits & spread.keeps.get(v, spread.all_bits) for v, bits in self.bits.items()}


def concerns(spread: Spread, bound: Bound, hierarchy: Hierarchy) -> Iterator[Concern]:
    """Return where each kind of finding can be (rule S10); disclosure first.

    >>> from rosprivacy.analysis.example import DISK, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> graph, bound, hierarchy = factory()
    >>> kinds = list(concerns(spread(graph, bound, hierarchy), bound, hierarchy))
    >>> [concern.kind for concern in kinds]
    ['disclosure', 'storage-limitation', 'third-country-transfer', 'unprotected-channel']
    >>> [str(concern.reasons.get((DISK, "Video"), "")) for concern in kinds]
    ['', 'no retention is stated', '', '']
    """
    yield Concern(DISCLOSURE, spread.leaks, {})
    elements = spread.graph.elements
    storages = {v: facts for v, facts in bound.outside.items() if elements[v].kind == "storage"}
    too_long = {(v, c): kept_too_long(facts, c, hierarchy) for v, facts in storages.items() for c in spread.categories}
    abroad = {(v, c): transferred(facts) for v, facts in bound.outside.items() for c in spread.categories}
    in_the_open = {(v, c): unprotected(some) for v, some in bound.exposed.items() for c in spread.categories}
    for kind, reasons in ((STORAGE_LIMITATION, too_long), (THIRD_COUNTRY, abroad), (UNPROTECTED, in_the_open)):
        bits: dict[int, int] = {}
        for (vertex, category), why in reasons.items():
            if why:
                here = spread.forms_of(category) & ~spread.absent_bits.get(
                    vertex, 0
                )  # nothing gets to what is not on the robot
                bits[vertex] = bits.get(vertex, 0) | here
        yield Concern(kind, bits, {key: why for key, why in reasons.items() if why})


def unprotected(exposures: Iterable[Exposure]) -> Reason | None:
    """Return why who is on the network can read what flows on a channel; the first line of each cause is named.

    >>> from rosprivacy.analysis.model import Exposure, Place
    >>> by = Exposure("not-encrypted", Place("governance.p7s", 24)), Exposure("strangers", Place("governance.p7s", 5))
    >>> str(unprotected(by[:1])), unprotected(by).key, unprotected([])
    ('nothing encrypts what is sent there, by governance.p7s:24', 'not-encrypted-nor-closed', None)
    """
    first = {one.cause: one.place for one in sorted(exposures, reverse=True)}
    if len(first) == 2:  # noqa: PLR2004 - both causes
        open_at, joined_at = first[NOT_ENCRYPTED], first[STRANGERS]
        joining = {"joining_file": joined_at.file, "joining_line": joined_at.line}
        return Reason.of(NOT_ENCRYPTED_NOR_CLOSED, file=open_at.file, line=open_at.line, **joining)
    return next((Reason.of(cause, file=at.file, line=at.line) for cause, at in first.items()), None)


class Arrival(IntEnum):
    """Best first: past no other leak of the category before through one, and as it is before pseudonymised."""

    PLAIN = 0
    PSEUDONYMISED = 1
    PLAIN_THROUGH = 2
    PSEUDONYMISED_THROUGH = 3

    @property
    def dismissed(self) -> bool:
        """Whether a disclosure that is shown so is dismissed."""
        return self >= Arrival.PLAIN_THROUGH

    @property
    def pseudonymised(self) -> bool:
        """Whether the data arrives pseudonymised."""
        return self in (Arrival.PSEUDONYMISED, Arrival.PSEUDONYMISED_THROUGH)


def shown_arrivals(plain: Flags, hidden: Flags, plain_through: Flags, hidden_through: Flags) -> tuple[Flags, ...]:
    """Return of each ``Arrival`` whether a finding shows it: the best, and what stands beside it; 0 or 1, or arrays.

    Where only pseudonymised data gets there past no other leak, data as it is that gets there through one is shown
    beside it. What gets there past no other leak may count as going through one, too.

    >>> shown_arrivals(0, 1, 1, 1)
    (0, 1, 1, 0)
    """
    return (
        plain,
        hidden & ~plain,
        plain_through & ~plain,
        hidden_through & ~(plain | hidden | plain_through),
    )
