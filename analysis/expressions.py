"""Wildcard expressions -> what two of them have in common (rule S4).

In: expressions as DDS reads them: POSIX fnmatch without escape. Out: whether some name is covered by both, or all that
one covers by the other.
"""

from __future__ import annotations

import re
import sys
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

LAST_CHARACTER = 0x10FFFF

CharSet = tuple[tuple[int, int], ...]  # sorted ranges of code points, both ends included
Token = CharSet | None  # None is *


@lru_cache(maxsize=4096)
def tokens(pattern: str) -> tuple[Token, ...]:
    """Return what an expression stands for, from left to right: sets of characters, and None for ``*``.

    >>> tokens("a*")
    (((97, 97),), None)
    """
    pattern = pattern.replace("[^", "[!")  # which glibc reads alike
    found: list[Token] = []
    at = 0
    while at < len(pattern):
        char = pattern[at]
        at += 1
        if char == "*":
            if not found or found[-1] is not None:
                found.append(None)
        elif char == "?":
            found.append(((0, LAST_CHARACTER),))
        elif char == "[" and (end := _bracket_end(pattern, at)) >= 0:
            found.append(_bracket(pattern[at:end]))
            at = end + 1
        else:
            found.append(((ord(char), ord(char)),))
    return tuple(found)


def _bracket_end(pattern: str, start: int) -> int:
    """Index of the ``]`` that closes a bracket opened before ``start``, or -1; one right at the start is literal."""
    first = start + 1 if pattern.startswith("!", start) else start
    return pattern.find("]", first + 1)


def _bracket(inside: str) -> CharSet:
    negated = inside.startswith("!")
    chars = inside[1:] if negated else inside
    ranges = []
    at = 0
    while at < len(chars):
        if at + 2 < len(chars) and chars[at + 1] == "-":
            ranges.append((ord(chars[at]), ord(chars[at + 2])))
            at += 3
        else:
            ranges.append((ord(chars[at]), ord(chars[at])))
            at += 1
    merged = _merge(ranges)
    return _complement(merged) if negated else merged


def _merge(ranges: list[tuple[int, int]]) -> CharSet:
    merged: list[tuple[int, int]] = []
    for low, high in sorted(r for r in ranges if r[0] <= r[1]):
        if merged and low <= merged[-1][1] + 1:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        else:
            merged.append((low, high))
    return tuple(merged)


def _complement(ranges: CharSet) -> CharSet:
    gaps = []
    low = 0
    for start, end in ranges:
        if low < start:
            gaps.append((low, start - 1))
        low = end + 1
    return (*gaps, (low, LAST_CHARACTER)) if low <= LAST_CHARACTER else tuple(gaps)


@lru_cache(maxsize=65536)
def regex(pattern: str) -> re.Pattern[str]:
    """Return an expression as one of Python, which reads the same tokens as the comparisons below.

    Python's own ``fnmatch.translate`` differs where a range runs backwards: of ``[b-a!x]`` it makes ``[!x]``. What
    stands between two stars is read once, where it first fits, so no text takes long.

    >>> [bool(regex("/cam*[0-9]").match(name)) for name in ("/camera_1", "/camera_x", "/cam")]
    [True, False, False]
    """
    return re.compile(_source(pattern), re.DOTALL)


def _source(pattern: str) -> str:
    parts: list[list[str]] = [[]]
    for token in tokens(pattern):
        if token is None:
            parts.append([])
        else:
            parts[-1].append(_class(token))
    first, *others = ("".join(part) for part in parts)
    between = "".join(_first_fit(number, part) for number, part in enumerate(others[:-1]) if part)
    return f"{first}{between}.*{others[-1]}\\Z" if others else f"{first}\\Z"


def _first_fit(number: int, part: str) -> str:
    """What is never read a second time: an atomic group, or what stands for one on Python 3.10."""
    group = f"g{number}"
    return f"(?>.*?{part})" if sys.version_info >= (3, 11) else f"(?=(?P<{group}>.*?{part}))(?P={group})"


def _class(token: CharSet) -> str:
    if not token:
        return "(?!)"  # a range that runs backwards has nothing
    ranges = (
        f"{re.escape(chr(low))}-{re.escape(chr(high))}" if low < high else re.escape(chr(low)) for low, high in token
    )
    return f"[{''.join(ranges)}]"


def have_common_name(a: str, b: str) -> bool:
    """Return whether some name is covered by both expressions.

    >>> have_common_name("/a*", "/*b"), have_common_name("/a*", "/b*"), have_common_name("/[a-c]", "/[!a]")
    (True, False, True)
    """
    return _match(tokens(a), b, _meets, stars=True)


def holds(a: str, b: str) -> bool:
    """Return whether ``a`` covers all that ``b`` covers; False may mean 'not shown'.

    >>> holds("/robot/*", "/robot/cam*"), holds("/robot/cam?", "/robot/cam*")
    (True, False)
    """
    return _match(tokens(a), b, _within, stars=False)


def _match(a: Sequence[Token], b: str, test: Callable[[CharSet, CharSet], bool], *, stars: bool) -> bool:
    """Whether ``a`` and ``b`` can be read side by side to their ends.

    Reads ``a`` from left to right with the set of all positions in ``b`` that it can have come to, as bits of a number:
    a step for each token of ``a``, each linear in the length of ``b`` divided by the bits of a machine word.

    Parameters
    ----------
    test
        Whether a token of ``a`` can be read beside one of ``b``.
    stars
        Whether a ``*`` of ``b`` can be read beside anything; otherwise only beside a ``*``.
    """
    single, several, star, length = _positions(b)
    star = star if stars else 0
    masks: dict[CharSet, int] = {}
    at = 1 | (star & 1) << 1
    for token in a:
        if token is None:
            at = (1 << length + 1) - (at & -at)
        else:
            if token not in masks:
                if len(token) == 1 and token[0][0] == token[0][1]:
                    masks[token] = single.get(token, 0)
                else:
                    masks[token] = sum(mask for theirs, mask in single.items() if test(token, theirs))
                masks[token] |= sum(mask for theirs, mask in several if test(token, theirs))
            at = (at & masks[token]) << 1 | at & star
            at |= (at & star) << 1
        if not at:
            return False
    return bool(at >> length & 1)


@lru_cache(maxsize=4096)
def _positions(pattern: str) -> tuple[dict[CharSet, int], tuple[tuple[CharSet, int], ...], int, int]:
    """Where an expression has each single character, each other set of characters, and stars; and its length."""
    single: dict[CharSet, int] = {}
    several: dict[CharSet, int] = {}
    star = 0
    found = tokens(pattern)
    for at, token in enumerate(found):
        if token is None:
            star |= 1 << at
        else:
            places = single if len(token) == 1 and token[0][0] == token[0][1] else several
            places[token] = places.get(token, 0) | 1 << at
    return single, tuple(several.items()), star, len(found)


def _meets(a: CharSet, b: CharSet) -> bool:
    return any(low <= end and start <= high for low, high in a for start, end in b)


def _within(a: CharSet, b: CharSet) -> bool:
    """Whether b is a part of a."""
    return all(any(low <= start and end <= high for low, high in a) for start, end in b)
