"""Markdown -> a Word document: each block of the text in a style of Word's own.

Only the blocks that ``report.md.j2`` writes are known; any other is an error, never left out in silence.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import docx
from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from rosprivacy.analysis.text import blanked
from rosprivacy.report.docx.package import same_bytes
from rosprivacy.report.docx.paper import code_font, laid_out, repeated_on_each_page, table_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from docx.document import Document
    from docx.text.paragraph import Paragraph


def word_document(text: str, title: str, language: str, made: str) -> bytes:
    """Return a report as the bytes of a ``.docx``.

    Parameters
    ----------
    text
        CommonMark with tables.
    title, language, made
        What the properties of the document say: its name, ``en`` or another ISO 639-1 code, the date as YYYY-MM-DD.

    Notes
    -----
    The same input gives the same bytes (rule S14). Complexity: O(size of the text).

    Examples
    --------
    >>> word_document("# A report", "A robot", "en", "2026-01-01")[:2]
    b'PK'
    """
    document = docx.Document()
    laid_out(document, title, language, made)
    tree = SyntaxTreeNode(MarkdownIt("commonmark").enable("table").parse(text))
    for block in tree.children:
        _write(block, document)
    return same_bytes(document)


def _write(block: SyntaxTreeNode, document: Document) -> None:
    if block.type == "heading":
        _inline(block.children[0], document.add_heading(level=int(block.tag[1:])))
    elif block.type == "paragraph":
        _inline(block.children[0], document.add_paragraph())
    elif block.type == "bullet_list":
        for item in block.children:
            _item(item, document, "List Bullet")
    elif block.type == "ordered_list":
        for number, item in enumerate(block.children, int(block.attrs.get("start", 1))):
            _item(item, document, "List Continue", f"{number}. ")
    elif block.type == "table":
        _table(block, document)
    else:
        raise NotImplementedError(block.type)


def _item(item: SyntaxTreeNode, document: Document, style: str, before: str = "") -> None:
    """Write an item of a list; its number stands in the text, since each list of Word's would go on with the last."""
    for part in item.children:
        if part.type != "paragraph":
            raise NotImplementedError(f"{part.type} in a list")
        paragraph = document.add_paragraph(before, style)
        _inline(part.children[0], paragraph)


def _table(block: SyntaxTreeNode, document: Document) -> None:
    rows = [list(row.children) for part in block.children for row in part.children]
    table = document.add_table(0, len(rows[0]), "Table Grid")
    for number, cells in enumerate(rows):
        row = table.add_row()
        for cell, written in zip(cells, row.cells, strict=True):
            paragraph = written.paragraphs[0]
            for part in cell.children:
                _inline(part, paragraph, bold=not number)
            table_text(paragraph)
        if not number:
            repeated_on_each_page(row)
    document.add_paragraph()  # else Word joins a table with the next


def _inline(line: SyntaxTreeNode, paragraph: Paragraph, *, bold: bool = False) -> None:
    for text, strong, code in _runs(line, strong=bold):
        run = paragraph.add_run(blanked(text))
        run.bold = strong or None
        if code:
            code_font(run)


def _runs(node: SyntaxTreeNode, *, strong: bool) -> Iterator[tuple[str, bool, bool]]:
    """Pieces of a line: their text, whether they are strong, and whether they are code."""
    for part in node.children:
        if part.type in {"text", "text_special", "code_inline"}:
            yield part.content, strong, part.type == "code_inline"
        elif part.type == "softbreak":
            yield " ", strong, False
        elif part.type in {"strong", "em"}:
            yield from _runs(part, strong=True)
        else:
            raise NotImplementedError(f"{part.type} in a line")
