"""How many paths a page tells one by one: as many as a browser opens; of the others it tells the number.

In: how many there are of each kind of data. Out: how many of each kind are told. Nothing is left out in silence: the
page says how many more there are, and the JSON document has all (rule S11).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST = 2_000  # paths that one page tells one by one, some 8 MB


def share(numbers: Iterable[int], most: int = MOST) -> int:
    """Return how many of each kind are told at most, so that the page tells ``most``: what a kind lacks, others get.

    >>> share([5, 400, 3000], 1000), share([5, 400], 1000)
    (595, 400)
    """
    counts = sorted(numbers)
    for position, number in enumerate(counts):
        each = most // (len(counts) - position)
        if number > each:
            return max(each, 1)
        most -= number
    return counts[-1] if counts else 0
