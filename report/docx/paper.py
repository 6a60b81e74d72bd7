"""How the pages of the Word document look: paper, fonts, language, tables that go on on the next page."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING

from docx.enum.section import WD_ORIENT
from docx.oxml import OxmlElement
from docx.oxml.ns import qn
from docx.shared import Mm, Pt

if TYPE_CHECKING:
    from docx.document import Document
    from docx.table import _Row
    from docx.text.paragraph import Paragraph
    from docx.text.run import Run
    from lxml.etree import _Element

A4 = (Mm(210), Mm(297))
MARGIN = Mm(18)
CODE, BODY = "Consolas", "Calibri"
SPELLING = {"en": "en-GB", "de": "de-DE", "fr": "fr-FR"}  # Word checks no spelling of a language without a country


def laid_out(document: Document, title: str, language: str, made: str) -> None:
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
    known.created = known.modified = datetime.fromisoformat(made)


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
