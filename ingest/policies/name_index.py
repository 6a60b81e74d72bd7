"""Names and expressions by how they begin and end: which of many are worth comparing with an expression.

In: DDS names and expressions, each with its element. Out: for an expression, those that can have a name in common with
it by their literal beginnings and ends; what is left out has none. Where many names begin alike they mostly end
differently, or the reverse, so the smaller of both lists is looked at; of plain names also those that hold what an
expression holds between its wildcards.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING

from rosprivacy.analysis.expressions import tokens
from rosprivacy.ingest.policies.names import literal_prefix, literal_suffix

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import Element

FEW = 16  # so many names are looked at without asking for better
SEARCHED = 64  # literal parts that are looked for in each name; of more the parts of each name are looked up
LONGEST_RUN = 16  # characters of a literal part that are looked for


class Expressions:
    """Expressions, to find those that can share a name with another one."""

    def __init__(self, expressions: Iterable[tuple[str, Element]]) -> None:
        expressions = list(expressions)
        self._beginnings = _Literals((literal_prefix(written), element) for written, element in expressions)
        self._ends = _Literals((literal_suffix(written)[::-1], element) for written, element in expressions)

    def near(self, expression: str) -> Iterator[Element]:
        """Return the elements of those whose beginning goes on from this one's, or the reverse; or whose end does."""
        begin, end = literal_prefix(expression), literal_suffix(expression)[::-1]
        if self._beginnings.number(begin) <= self._ends.number(end):
            return self._beginnings.near(begin)
        return self._ends.near(end)


class PlainNames:
    """Names without wildcards, to find those that an expression can cover.

    Parameters
    ----------
    expressions
        That ``near`` is asked for: names are found by what these hold literally inside, too.
    """

    def __init__(self, names: Iterable[tuple[str, Element]], expressions: Iterable[str] = ()) -> None:
        self._forward = sorted(names)
        self._backward = sorted((name[::-1], element) for name, element in self._forward)
        self._expressions = expressions

    def near(self, expression: str) -> Iterator[tuple[str, Element]]:
        """Return the names that begin, or that end, as all names of the expression do, or that hold a part of it."""
        first, last = _begun(self._forward, literal_prefix(expression))
        other, end = _begun(self._backward, literal_suffix(expression)[::-1])
        fewest = min(last - first, end - other)
        if fewest > FEW:
            inside = min(
                (self._holding[run] for run in _runs(expression) if run in self._holding), key=len, default=None
            )
            if inside is not None and len(inside) < fewest:
                return (self._forward[at] for at in inside)
        if last - first <= end - other:
            return iter(self._forward[first:last])
        return ((name[::-1], element) for name, element in self._backward[other:end])

    @cached_property
    def _holding(self) -> Mapping[str, Sequence[int]]:
        """By a literal part of an expression: where the names stand that hold it."""
        holding: dict[str, list[int]] = {run: [] for expression in self._expressions for run in _runs(expression)}
        if len(holding) <= SEARCHED:
            return {run: [at for at, (name, _) in enumerate(self._forward) if run in name] for run in holding}
        for length in sorted({len(run) for run in holding}):
            for at, (name, _) in enumerate(self._forward):
                for run in {name[i : i + length] for i in range(len(name) - length + 1)} & holding.keys():
                    holding[run].append(at)
        return holding


def _runs(expression: str) -> list[str]:
    """What every name that an expression covers holds somewhere: its literal parts, of long ones the first signs."""
    runs = [""]
    for token in tokens(expression):
        if token is not None and len(token) == 1 and token[0][0] == token[0][1]:
            runs[-1] += chr(token[0][0])
        else:
            runs.append("")
    return [run[:LONGEST_RUN] for run in runs if run]


class _Literals:
    """Elements by a literal text, to find those of which one text begins the other."""

    def __init__(self, literals: Iterable[tuple[str, Element]]) -> None:
        self._of: dict[str, list[Element]] = defaultdict(list)
        for literal, element in literals:
            self._of[literal].append(element)
        self._sorted = sorted(self._of)
        self._before = [0, *accumulate(len(self._of[literal]) for literal in self._sorted)]
        self._lengths = sorted({len(literal) for literal in self._of})

    def number(self, literal: str) -> int:
        """How many elements ``near`` returns."""
        first, last = self._longer(literal)
        return sum(len(self._of.get(shorter, ())) for shorter in self._shorter(literal)) + (
            self._before[last] - self._before[first]
        )

    def near(self, literal: str) -> Iterator[Element]:
        for shorter in self._shorter(literal):
            yield from self._of.get(shorter, ())
        for at in range(*self._longer(literal)):
            yield from self._of[self._sorted[at]]

    def _shorter(self, literal: str) -> Iterator[str]:
        return (literal[:length] for length in self._lengths if length < len(literal))

    def _longer(self, literal: str) -> tuple[int, int]:
        return bisect_left(self._sorted, literal), bisect_right(
            self._sorted, literal, key=lambda one: one[: len(literal)]
        )


def _begun(names: list[tuple[str, Element]], beginning: str) -> tuple[int, int]:
    """Where in a sorted list the names stand that begin so."""
    return (
        bisect_left(names, beginning, key=lambda pair: pair[0]),
        bisect_right(names, beginning, key=lambda pair: pair[0][: len(beginning)]),
    )
