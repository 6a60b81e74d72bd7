"""What is run every day of many rows that are alike, what in CI (``--slow``), and what each week (``--thorough``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable


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
