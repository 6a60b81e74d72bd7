"""Which wildcards meet which, told by their literal ends for many at once (rule S4).

In: written and read expressions, each with a literal beginning, a ``*`` and a literal end. Out: groups, of which each
written one meets each read one. Two such expressions have a name in common if and only if one beginning begins the
other, and one end ends the other: the longer beginning, what both have in between, the longer end.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.expressions import tokens

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.analysis.model import Element

_Group = tuple[tuple[str, bool], tuple[str, bool]]


class Ends(NamedTuple):
    """The literal beginning of an expression up to its first ``*``, and the end after the last; backwards."""

    beginning: str
    end: str


def literal_ends(expression: str) -> Ends | None:
    """Return the ends of an expression, or None where it has no ``*``, no names, or ends that are not literal.

    >>> literal_ends("rt/robot*/[ab]/s*_7"), literal_ends("rt/cam?/*"), literal_ends("rt/cam?")
    (Ends(beginning='rt/robot', end='7_'), None, None)
    """
    found = tokens(expression)
    if None not in found or () in found:
        return None
    first, last = found.index(None), found[::-1].index(None)
    ends = found[:first], found[::-1][:last]
    if any(token is None or len(token) != 1 or token[0][0] != token[0][1] for end in ends for token in end):
        return None
    return Ends(*("".join(chr(token[0][0]) for token in end if token) for end in ends))


def meetings(
    written: Mapping[Element, Ends], read: Mapping[Element, Ends], count: Callable[[Element, int], None]
) -> Iterator[tuple[list[Element], list[Element]]]:
    """Yield groups of which each written element meets each read one; each pair that meets is in one of them.

    Parameters
    ----------
    written, read
        Elements with the ends of their one expression.
    count
        Is told of how many groups each element is.

    Notes
    -----
    A group is that of all pairs with one shorter beginning and one shorter end, and of whose side these are. So an
    element is in as many groups as there are others' beginnings within its own, times the same of the ends.
    """
    groups: tuple[dict[_Group, list[Element]], ...] = (defaultdict(list), defaultdict(list))
    for found, mine, others, is_read in ((groups[0], written, read, False), (groups[1], read, written, True)):
        beginnings, ends = (_Shorter({one[at] for one in others.values()}) for at in (0, 1))
        for element, own in mine.items():
            some = [*product(beginnings.of(own.beginning, is_read=is_read), ends.of(own.end, is_read=is_read))]
            for group in some:
                found[group].append(element)
            count(element, len(some))
    for group in sorted(groups[0].keys() & groups[1].keys()):
        yield groups[0][group], groups[1][group]


class _Shorter:
    """Literal texts of one side, to find those that begin one of the other side."""

    def __init__(self, names: set[str]) -> None:
        self._names = names
        self._lengths = sorted({len(text) for text in names})

    def of(self, text: str, *, is_read: bool) -> list[tuple[str, bool]]:
        """The text itself, and those of the other side that begin it; each with whether it is one that is read.

        Where both sides have one text, it counts as the read side's.
        """
        within = (text[:length] for length in self._lengths if length < len(text) + (not is_read))
        return [(text, is_read), *((one, not is_read) for one in within if one in self._names)]
