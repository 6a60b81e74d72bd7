"""Rows -> CSV, the one place where it is written: spreadsheets run what begins with ``=`` and the like.

In: a head and rows of cells. Out: CSV. A text that could be a formula gets an apostrophe in front, which spreadsheets
take as 'this is text'; a number stays.
"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

FORMULA = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")


def as_csv(head: Iterable[str], rows: Iterable[Iterable[str | float]], *, separator: str = "") -> str:
    r"""Return a table as CSV: as programs read it, or with a separator as spreadsheets of a country do.

    >>> as_csv(["a", "=b"], [["@c", -1], ["-1", "d"]])
    "a,'=b\n'@c,-1\n'-1,d\n"
    """
    text = io.StringIO()
    if separator:
        writer = csv.writer(text, delimiter=separator, quoting=csv.QUOTE_ALL, lineterminator="\r\n")  # RFC 4180
    else:
        writer = csv.writer(text, lineterminator="\n")
    writer.writerows([_guarded(cell) for cell in row] for row in (head, *rows))
    return text.getvalue()


def _guarded(cell: str | float) -> str | float:
    if not isinstance(cell, str):
        return cell
    return f"'{cell}" if cell.startswith(FORMULA) or cell.lstrip().startswith(FORMULA) else cell
