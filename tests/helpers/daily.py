"""What is run every day of many rows that are alike, what in CI (``--slow``), and what each week (``--thorough``)."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence


MANY = 3  # rows of a test, of which all are for every day
IN_CI = 3  # of the rows that are not for every day, every so many-th


def one_in(number: int, rows: Iterable[Any], *, in_ci: int = IN_CI) -> list[Any]:
    """Rows of ``parametrize``: the first and every so many-th is for every day; of the others a third is for CI.

    ``in_ci=1`` where each row could fail alone: CI takes all.
    """
    chosen: list[Any] = []
    others = 0
    for i, row in enumerate(rows):
        values = row if isinstance(row, tuple) else (row,)
        if i % number == 0:
            chosen.append(pytest.param(*values))
            continue
        mark = pytest.mark.thorough if others % in_ci else pytest.mark.slow
        chosen.append(pytest.param(*values, marks=mark))
        others += 1
    return chosen


def sampled(items: Sequence[pytest.Item]) -> Iterator[pytest.Item]:
    """Give, in order, of a test with many rows the first and every third after it."""
    tests = [item.nodeid.partition("[")[0] for item in items]
    rows, seen = Counter(tests), Counter[str]()
    for item, test in zip(items, tests, strict=True):
        if rows[test] <= MANY or seen[test] % 3 == 0:
            yield item
        seen[test] += 1
