"""The report as a Word document: each block of its Markdown in a style of Word's own, which people go on with.

In: the report as Markdown (``markdown.py``), so that no sentence stands in one of them only. Out: the bytes of a
``.docx``. Only the blocks that ``report.md.j2`` writes are known; any other is an error, never left out in silence.
"""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Any, NamedTuple
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import docx
from docx.enum.section import WD_ORIENT
from docx.opc.pkgwriter import PackageWriter
from docx.oxml import OxmlElement
from docx.oxml.ns import qn
from docx.shared import Mm, Pt
from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from rosprivacy.analysis.python_311 import from_iso
from rosprivacy.analysis.text import blanked

if TYPE_CHECKING:
    from collections.abc import Iterator

    from docx.document import Document
    from docx.opc.packuri import PackURI
    from docx.table import _Row
    from docx.text.paragraph import Paragraph
    from docx.text.run import Run
    from lxml.etree import _Element


def word_document(text: str, title: str, language: str, date: str) -> bytes:
    """Return a report as the bytes of a ``.docx``.

    Parameters
    ----------
    text
        CommonMark with tables.
    title, language, date
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
    laid_out(document, title, language, date)
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


def same_bytes(document: Document) -> bytes:
    """Return the package of a Word document: the same document, the same bytes."""
    package, packed = document.part.package, BytesIO()
    assert package is not None
    for part in package.parts:
        part.before_marshal()
    with ZipFile(packed, "w") as archive:
        target = _FirstDate(archive)
        steps: Any = PackageWriter  # its own `write` opens an archive of its own
        steps._write_content_types_stream(target, package.parts)  # noqa: SLF001
        steps._write_pkg_rels(target, package.rels)  # noqa: SLF001
        steps._write_parts(target, package.parts)  # noqa: SLF001
    return packed.getvalue()


class _FirstDate(NamedTuple):
    """Where python-docx writes the parts of a document to: all carry 1980-01-01, the first date that ZIP knows.

    Left to themselves they carry the time of now; from Python 3.14 on that of ``SOURCE_DATE_EPOCH``, and where that is
    before 1980, such as 0, nothing can be written.
    """

    archive: ZipFile

    def write(self, name: PackURI, data: bytes | str) -> None:
        """Add a part."""
        self.archive.writestr(ZipInfo(name.membername), data, ZIP_DEFLATED)


A4 = (Mm(210), Mm(297))
MARGIN = Mm(18)
CODE, BODY = "Consolas", "Calibri"
SPELLING = {"en": "en-GB", "de": "de-DE", "fr": "fr-FR"}  # Word checks no spelling of a language without a country


def laid_out(document: Document, title: str, language: str, date: str) -> None:
    """Set the paper (A4, lying, for the tables), the fonts, the language and the properties of an empty document."""
    section = document.sections[0]
    section.orientation = WD_ORIENT.LANDSCAPE
    section.page_height, section.page_width = A4
    section.left_margin = section.right_margin = section.top_margin = section.bottom_margin = MARGIN
    normal = document.styles["Normal"]
    normal.font.name, normal.font.size = BODY, Pt(10)
    normal.paragraph_format.space_after = Pt(4)
    spoken = OxmlElement("w:lang")
    spoken.set(qn("w:val"), SPELLING.get(language, language))
    normal.element.get_or_add_rPr().append(spoken)
    known = document.core_properties
    known.title, known.author, known.last_modified_by, known.comments = title[:255], "rosprivacy", "rosprivacy", ""
    known.language, known.revision = language, 1
    known.created = known.modified = from_iso(date)
    numbered(document.sections[0].footer.paragraphs[0], title, date)


def numbered(footer: Paragraph, title: str, date: str) -> None:
    """Write on each page what the document is, of which day, and which page of how many it is."""
    footer.add_run(f"{blanked(title)[:100]} · {date} · ")
    paragraph: _Element = footer._p  # noqa: SLF001 - python-docx has no word for it
    for field, after in (("PAGE", " / "), ("NUMPAGES", "")):
        counted = OxmlElement("w:fldSimple")
        counted.set(qn("w:instr"), field)
        paragraph.append(counted)
        footer.add_run(after)
    for run in footer.runs:
        run.font.size = Pt(8)


def repeated_on_each_page(row: _Row) -> None:
    """Let the first row of a table stand on each page that the table goes on to."""
    header = OxmlElement("w:tblHeader")
    header.set(qn("w:val"), "true")
    properties: _Element = row._tr.get_or_add_trPr()  # noqa: SLF001 - python-docx has no word for it
    properties.append(header)


def table_text(paragraph: Paragraph) -> None:
    """Write a cell smaller, without space below."""
    paragraph.paragraph_format.space_after = Pt(0)
    for run in paragraph.runs:
        run.font.size = Pt(8)


def code_font(run: Run) -> None:
    """Write a name as it stands in a file."""
    run.font.name = CODE
    run.font.size = Pt(9)
    run.font.no_proof = True
