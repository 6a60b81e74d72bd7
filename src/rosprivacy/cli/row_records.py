"""Rows as records, one below the other: what is too wide for a table is wrapped between words and never cut."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

GAP = 2


def natural_width(columns: Sequence[str], cells: Sequence[Sequence[str]]) -> int:
    """Return how wide a table of these cells is when no cell is wrapped.

    >>> natural_width(["a", "long"], [["xyz", "y"]])
    9
    """
    widest = [max(map(len, column)) for column in zip(columns, *cells, strict=True)]
    return sum(widest) + GAP * (len(widest) - 1)


def records(columns: Sequence[str], cells: Sequence[Sequence[str]], width: int) -> str:
    r"""Return one line for each cell, or several; a word that is longer than a line stands whole.

    >>> print(records(["robot", "path"], [["r1", "/camera -> /image -> /uplink"]], 24), end="")
    robot  r1
    path   /camera -> /image
           -> /uplink
    """
    names = max(map(len, columns)) + GAP
    return "\n".join(
        "".join(_field(column, cell, names, width) for column, cell in zip(columns, row, strict=True)) for row in cells
    )


def _field(column: str, cell: str, names: int, width: int) -> str:
    lines = textwrap.wrap(
        cell, max(width - names, 1), break_long_words=False, break_on_hyphens=False, replace_whitespace=False
    )
    first, *others = lines or [""]
    return "".join(f"{line}\n" for line in (f"{column:<{names}}{first}".rstrip(), *(" " * names + o for o in others)))
