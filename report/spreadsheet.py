"""Cells of CSV, which people open in spreadsheets: these run what begins with ``=`` and the like.

In: a cell. Out: the same, with an apostrophe in front where it could be a formula, which they take as 'this is text'.
"""

from __future__ import annotations

FORMULA = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")


def guarded(cell: str) -> str:
    """Return a cell that no spreadsheet takes for a formula.

    >>> guarded("=1+1"), guarded("  =1+1"), guarded("video")
    ("'=1+1", "'  =1+1", 'video')
    """
    return f"'{cell}" if cell.startswith(FORMULA) or cell.lstrip().startswith(FORMULA) else cell
