"""How data of one source gets to one leak, and what of it findings show: the order of rule S10, in one place.

In: whether data gets there in each way; for one pair, or for arrays of pairs. Out: which ways a finding is made of.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Flags = TypeVar("Flags", "NDArray[np.bool_]", int)


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
