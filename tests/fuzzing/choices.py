"""Bytes -> choices: what a fuzzer mutates becomes what a grammar decides.

The first four bytes seed what is drawn after the others have ended, so that few bytes make a whole input too, and a
change of one byte leaves the choices before it as they were.
"""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Sequence

T = TypeVar("T")
SEED = 4


class Choices:
    """Choices that some bytes stand for."""

    def __init__(self, data: bytes) -> None:
        self._left = iter(data[SEED:])
        self._then = Random(data[:SEED])  # noqa: S311 - repeatable

    def below(self, bound: int) -> int:
        """A number from 0 to below a bound of at most 256."""
        byte = next(self._left, None)
        return self._then.randrange(bound) if byte is None else byte % bound

    def once_in(self, times: int) -> bool:
        return self.below(times) == times - 1

    def pick(self, options: Sequence[T]) -> T:
        return options[self.below(len(options))]

    def some(self, options: Sequence[T], least: int = 0, most: int = 3) -> list[T]:
        """A few of the options, each once, in their order."""
        count = min(len(options), least + self.below(most - least + 1))
        chosen = {self.below(len(options)) for _ in range(count)}
        while len(chosen) < min(least, len(options)):
            chosen.add(min(set(range(len(options))) - chosen))
        return [options[index] for index in sorted(chosen)]

    def random(self) -> Random:
        """A source for what is no choice of a grammar."""
        return Random(self.below(256) << 16 | self.below(256) << 8 | self.below(256))  # noqa: S311 - repeatable
