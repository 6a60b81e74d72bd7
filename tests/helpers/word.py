"""What a person reads in a Word document."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING

import docx
from docx.table import Table

if TYPE_CHECKING:
    from collections.abc import Iterator

    from docx.document import Document


def text_of(package: bytes) -> str:
    """All text in the order of the pages: a line for each paragraph and each row."""
    return "\n".join(_lines(docx.Document(BytesIO(package))))


def _lines(document: Document) -> Iterator[str]:
    for block in document.iter_inner_content():
        if isinstance(block, Table):
            yield from (" | ".join(cell.text for cell in row.cells) for row in block.rows)
        else:
            yield block.text
