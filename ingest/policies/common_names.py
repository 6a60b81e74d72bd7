"""Whether a name is left that several expressions match and no DENY takes out (rule S4).

In: expressions as DDS reads them. Out: yes or no. Each expression is a small automaton whose states are sets of
positions in it; they read a name together, character by character, and every set of states is looked at once.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.expressions import LAST_CHARACTER, tokens

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.expressions import Token

LARGEST_SEARCH = 4_096  # sets of states; beyond, the careful answer: a name is left
MOST_STEPS = 10_000_000  # of one search, for the same reason
Letter = tuple[int, ...]  # by automaton: the positions whose characters have this letter


class NameLeft(NamedTuple):
    """Whether a name is left.

    Attributes
    ----------
    steps
        That it took to tell.
    careful
        Whether it took too many: then it is taken that one is left.
    """

    exists: bool
    steps: int
    careful: bool = False


def some_name(matching: tuple[str, ...], denied: tuple[str, ...]) -> bool:
    """Return whether a name exists that all of some expressions match and none of others; True if it cannot be told.

    Examples
    --------
    >>> some_name(("/r?/image", "/r1/*"), ())
    True
    >>> some_name(("/r?/image", "/r1/*"), ("/r1/image",))
    False
    >>> some_name(("/t[0-1]",), ("/t0", "/t1")), some_name(("/t[0-2]",), ("/t0", "/t1"))
    (False, True)
    """
    return name_left(matching, denied).exists


@lru_cache(maxsize=65536)
def name_left(matching: tuple[str, ...], denied: tuple[str, ...]) -> NameLeft:
    """Return whether a name exists that all of some expressions match and none of others, and what it took to tell.

    Notes
    -----
    The sets of states can be as many as 2 to the power of the positions; ``LARGEST_SEARCH`` of them are looked at,
    for each of the letters that the expressions tell apart.
    """
    machines = [tokens(expression) for expression in (*matching, *denied)]
    first = _first(machines)
    steps = len(first) * sum(map(len, machines))
    if steps > MOST_STEPS:
        return NameLeft(exists=True, steps=0, careful=True)
    stars = [_positions(token is None for token in machine) for machine in machines]
    ends = [1 << len(machine) for machine in machines]
    letters = _letters(machines, first)
    step = len(letters) * len(machines)
    start = tuple(_onward(1, star) for star in stars)
    waiting, seen = [start], {start}
    while waiting:
        states = waiting.pop()
        accepted = [bool(state & end) for state, end in zip(states, ends, strict=True)]
        if all(accepted[: len(matching)]) and not any(accepted[len(matching) :]):
            return NameLeft(exists=True, steps=steps)
        if len(seen) > LARGEST_SEARCH or steps > MOST_STEPS:
            return NameLeft(exists=True, steps=steps, careful=True)
        steps += step
        for letter in letters:
            after = tuple(map(_read, states, letter, stars))
            if all(after[: len(matching)]) and after not in seen:
                seen.add(after)
                waiting.append(after)
    return NameLeft(exists=False, steps=steps)


def _read(state: int, letter: int, star: int) -> int:
    """The positions after one more character: past what it stands for, or still in a ``*``."""
    return _onward((state & letter) << 1 | (state & star), star)


def _onward(state: int, star: int) -> int:
    """A ``*`` may stand for nothing; no two stand beside each other."""
    return state | (state & star) << 1


def _positions(flags: Iterable[bool]) -> int:
    return sum(1 << at for at, flag in enumerate(flags) if flag)


def _first(machines: Sequence[Sequence[Token]]) -> set[int]:
    """The characters at which a set of characters begins or has ended."""
    sets = {token for machine in machines for token in machine if token is not None}
    return {0, *(at for token in sets for low, high in token for at in (low, high + 1) if at <= LAST_CHARACTER)}


def _letters(machines: Sequence[Sequence[Token]], first: set[int]) -> list[Letter]:
    """One letter for all characters that no expression tells apart."""
    found = {
        tuple(_positions(token is not None and _has(token, at) for token in machine) for machine in machines): at
        for at in sorted(first, reverse=True)
    }
    return sorted(found, key=lambda letter: found[letter])


def _has(token: Token, character: int) -> bool:
    return token is not None and any(low <= character <= high for low, high in token)
