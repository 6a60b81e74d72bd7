"""Which bit is which: every emitted category has two, one for its data as they are and one pseudonymised (rule S8).

In: how many categories there are. Out: ``CategoryBits``, the one place that knows how bits are numbered. A *bit* is a
position, *bits* are a set of positions, as a number with as many digits as are needed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True, slots=True)
class CategoryBits:
    """The bits of some categories, which are numbered from 0 on.

    >>> bits = CategoryBits(3)
    >>> bits.plain(1), bits.pseudonymised(1), bin(bits.pair(1))
    (1, 4, '0b10010')
    >>> bits.category(4), bits.is_pseudonymised(4), bin(bits.merged(0b10100))
    (1, True, '0b110')
    """

    _count: int

    @property
    def all(self) -> int:
        """Every bit."""
        return (1 << 2 * self._count) - 1

    def plain(self, category: int) -> int:
        """Return the bit of a category as it is."""
        return category

    def pseudonymised(self, category: int) -> int:
        """Return the bit of a category in pseudonymised form."""
        return category + self._count

    def forms(self, category: int) -> tuple[int, int]:
        """Return the bits of a category: as it is, pseudonymised."""
        return self.plain(category), self.pseudonymised(category)

    def pair(self, category: int) -> int:
        """Return the two bits of a category, as a set."""
        return 1 << self.plain(category) | 1 << self.pseudonymised(category)

    def category(self, bit: int) -> int:
        """Return the number of the category of a bit."""
        return bit % self._count

    def is_pseudonymised(self, bit: int) -> bool:
        """Return whether a bit is that of a category in pseudonymised form."""
        return bit >= self._count

    def merged(self, bits: int) -> int:
        """Return the categories of some bits, in whichever form: their numbers, as a set."""
        return (bits | bits >> self._count) & ((1 << self._count) - 1)

    def planes(self, bits: int) -> tuple[int, int]:
        """Return those of some bits that are of categories as they are, and those of pseudonymised ones."""
        plain = (1 << self._count) - 1
        return bits & plain, bits & ~plain

    def in_both_forms(self, bits: int) -> int:
        """Return the bits of all categories of which some form is among these."""
        merged = self.merged(bits)
        return merged | merged << self._count


def bits_of(number: int) -> Iterator[int]:
    """The positions of the bits that are set, lowest first.

    >>> list(bits_of(0b10010))
    [1, 4]
    """
    while number:
        lowest = number & -number
        yield lowest.bit_length() - 1
        number ^= lowest
