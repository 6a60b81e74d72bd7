"""What is run every day of many rows that are alike; all of them run with ``--slow``, as in CI."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable


def one_in(number: int, rows: Iterable[Any]) -> list[Any]:
    """Rows of ``parametrize``: the first and every so many-th is for every day, the others are slow."""
    slow = pytest.mark.slow
    tuples = [(row, row if isinstance(row, tuple) else (row,)) for row in rows]
    return [pytest.param(*values, marks=slow) if i % number else row for i, (row, values) in enumerate(tuples)]
