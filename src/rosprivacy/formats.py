"""The formats in which an answer is written: one table of name, suffix and function.

In: an ``Answer``, of which a ``Document`` is made, and each format is a function of that. Out: text, or the bytes of a
Word document. What reports may not ask for themselves is found here: the root of the repository, the date. A new format
is a folder in ``report/`` and a row here.
"""

from __future__ import annotations

import os
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, overload

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.clock import source_date, today
from rosprivacy.report.catalogs import LANGUAGES
from rosprivacy.report.document.contents import (
    IN_JSON,
    LEDGER,
    PATHS,
    POSITIONS,
    PROCESSING,
    PROPOSALS,
    REGISTER,
    RELIANCE,
)
from rosprivacy.terminal_width import terminal_width

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rosprivacy.answer import Answer
    from rosprivacy.report.compare.earlier import Earlier
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.page.assessment import Answers
    from rosprivacy.report.page.outline import Outline
    from rosprivacy.report.pictures.picture import Key

    Aliases = Mapping[Key, tuple[str, str]]

# What is text, and what is Word; the table below has one row for each.
TextFormat = Literal[
    "text", "json", "json1", "sarif", "cnil-pia", "turtle", "json-ld", "html", "markdown", "article30",
    "article30-processors", "notice", "works-council",
]  # fmt: skip
WordFormat = Literal["docx", "edpb-dpia"]


class Style(NamedTuple):
    """How an answer is shown to a person.

    Attributes
    ----------
    verbose, quiet, colour
        Of text: every open element and notice, the verdict only, for a terminal.
    language
        Of text, a report and the answers for the CNIL's tool: ``en``, ``de`` or ``fr``.
    title
        Of a report.
    since
        Document of an earlier analysis, to tell what changed; of a page and of Markdown.
    redact
        Whether names of elements, files, robots and persons are replaced; of a report and of linked data.
    base
        What the IRIs of linked data begin with; by default a UUID of the system.
    assessment
        File of the answers that an earlier report saved; of a page, Markdown, Word and the CNIL's tool.
    """

    verbose: bool = False
    quiet: bool = False
    colour: bool = False
    language: str = "en"
    title: str = ""
    since: str | None = None
    redact: bool = False
    base: str | None = None
    assessment: str | None = None


class OutputFormat(NamedTuple):
    """A format in which an answer is written.

    Attributes
    ----------
    name
        On the command line.
    suffix
        What its files end in.
    write
        What makes it.
    styles
        Fields of ``Style`` that it heeds; others mean nothing to it.
    both_views
        Whether it tells what the enforced view adds (rule S6).
    page
        What it is called where it is refused at a terminal; empty of what people read there.
    asks
        Fields of the document that it tells and not every output does.
    """

    name: str
    suffix: str
    write: Callable[[Document, Style], str | bytes | Iterator[str]]
    styles: tuple[str, ...] = ()
    both_views: bool = False
    page: str = ""
    asks: tuple[str, ...] = (*IN_JSON, RELIANCE)


@overload
def written(answer: Answer, name: WordFormat, style: Style | None = None) -> bytes: ...
@overload
def written(answer: Answer, name: TextFormat, style: Style | None = None) -> str: ...
@overload
def written(answer: Answer, name: str, style: Style | None = None) -> str | bytes: ...
def written(answer: Answer, name: str, style: Style | None = None) -> str | bytes:
    """Return an answer in one of ``FORMATS``: text, or the bytes of a Word document.

    Raises
    ------
    InputError
        If there is no such format or language, ``SOURCE_DATE_EPOCH`` is no time, or the earlier document cannot be
        read.
    """
    made = in_pieces(answer, name, style)
    return made if isinstance(made, str | bytes) else "".join(made)


def in_pieces(answer: Answer, name: str, style: Style | None = None) -> str | bytes | Iterator[str]:
    """Return the same, of what can be large as pieces to be written one after the other; ``InputError`` as there."""
    if name not in FORMATS:
        raise InputError("format", 0, f"unknown format {shown(name)!r}", f"one of {', '.join(FORMATS)}")
    style = style or Style()
    if style.language not in LANGUAGES:
        raise InputError("language", 0, f"unknown language {shown(style.language)!r}", f"one of {', '.join(LANGUAGES)}")
    if name == "text" and style.quiet:
        return text_of(answer.verdict_facts(), style)
    from rosprivacy.documents import document_of

    return FORMATS[name].write(document_of(answer, FORMATS[name].asks), style)


def _text(document: Document, style: Style) -> str:
    from rosprivacy.report.document.analysis import json_document

    return text_of(json_document(document), style)


def text_of(document: Mapping[str, Any], style: Style) -> str:
    """Return a document as text, for a terminal if the style says so."""
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.text.analysis import print_report, report_text

    words = Words(style.language)
    width = terminal_width() if style.colour else None
    if width is not None:
        from io import StringIO

        from rich.console import Console

        text = StringIO()
        console = Console(file=text, force_terminal=True, highlight=False, emoji=False)
        print_report(console, document, words, verbose=style.verbose, quiet=style.quiet, width=width)
        return text.getvalue()
    return report_text(document, words, verbose=style.verbose, quiet=style.quiet)


def _json(document: Document, _: Style) -> Iterator[str]:
    from rosprivacy.report import json_text
    from rosprivacy.report.document.analysis import json_document

    return json_text.in_pieces(json_document(document))


def _short_json(document: Document, _: Style) -> Iterator[str]:
    from rosprivacy.report import json_text
    from rosprivacy.report.document.analysis import short_document

    return json_text.in_pieces(short_document(document))


def _linked_data(form: str) -> Callable[[Document, Style], str]:
    def write(document: Document, style: Style) -> str:
        from rosprivacy.report.rdf.findings import rdf_graph
        from rosprivacy.report.rdf.redacted import redacted_graph
        from rosprivacy.report.rdf.serialise import SERIALISERS

        graph_of = redacted_graph if style.redact else rdf_graph
        return SERIALISERS[form](graph_of(document, source_date(os.environ), style.base))

    return write


def _sarif(document: Document, _: Style) -> Iterator[str]:
    from rosprivacy.report import json_text
    from rosprivacy.report.sarif.locations import repository_root
    from rosprivacy.report.sarif.log import sarif

    named = [entry["file"] for kind in ("policies", "labels") for entry in document.assumptions.get(kind) or ()]
    return json_text.in_pieces(sarif(document, repository_root(named)))


def _cnil_pia(document: Document, style: Style) -> str:
    """Without ``SOURCE_DATE_EPOCH`` the file is dated now, since the tool wants a date (rule S14)."""
    from rosprivacy.report.cnil.person_answers import PersonAnswers
    from rosprivacy.report.cnil.pia import cnil_pia
    from rosprivacy.report.json_text import as_text

    given = _answers(style)
    source = f"{given.file[-120:]} (sha256 {given.sha256[:12]})" if given else ""
    people = PersonAnswers(given.texts, source) if given else PersonAnswers()
    created = (source_date(os.environ) or datetime.now(timezone.utc)).isoformat(timespec="milliseconds")
    return as_text(cnil_pia(document, created.replace("+00:00", "Z"), style.language, people))


def _article30(document: Document, style: Style) -> str:
    from rosprivacy.report.page.article30 import record

    return record(_rendered_parts(document, style)[0], style.language)


def _article30_processors(document: Document, style: Style) -> str:
    from rosprivacy.report.page.article30 import record_of_processors

    return record_of_processors(_rendered_parts(document, style)[0], style.language)


def _notice(document: Document, style: Style) -> str:
    from rosprivacy.report.page.notice import notice

    return notice(_rendered_parts(document, style)[0], style.language, style.title)


def _markdown(document: Document, style: Style) -> str:
    from rosprivacy.report.page.markdown import markdown

    return markdown(_outline(document, style)[0])


def _docx(document: Document, style: Style) -> bytes:
    """Without ``SOURCE_DATE_EPOCH`` the document says that it was made today (rule S14)."""
    from rosprivacy.report.page.markdown import markdown
    from rosprivacy.report.page.word_document import word_document

    told = _outline(document, style)[0]
    return word_document(markdown(told), told.cover.title, style.language, today(os.environ))


def _edpb_dpia(document: Document, style: Style) -> bytes:
    """The date is that of a Word report."""
    from rosprivacy.report.page.edpb_dpia import edpb_dpia
    from rosprivacy.report.page.word_document import word_document

    shown, *_ = _rendered_parts(document, style)
    title, date, answers = _shown_title(document, style), today(os.environ), _answers(style)
    text = edpb_dpia(shown, style.language, title=title, date=date, redacted=style.redact, answers=answers)
    return word_document(text, title, style.language, date)


def _html(document: Document, style: Style) -> str:
    from rosprivacy.report.page.figures import figures
    from rosprivacy.report.page.html import html

    told, aliases = _outline(document, style)
    return html(told, figures(document, told, aliases))


def _works_council(document: Document, style: Style) -> str:
    from rosprivacy.report.page.works_council import works_council

    return works_council(_outline(document, style)[0])


def _outline(document: Document, style: Style) -> tuple[Outline, Aliases | None]:
    from rosprivacy.report.page.outline import outline

    answers = _answers(style)
    told, earlier, proposals, aliases = _rendered_parts(document, style)
    report = outline(
        told,
        style.language,
        title=_shown_title(document, style),
        date=today(os.environ),
        earlier=earlier,
        redacted=style.redact,
        proposals=proposals,
        answers=answers,
    )
    return report, aliases


def _answers(style: Style) -> Answers | None:
    """What people answered in an earlier report; none where names are replaced, since free text names whom it wants."""
    from rosprivacy.report.page.assessment import read_answers

    answers = read_answers(style.assessment) if style.assessment else None
    return None if style.redact else answers


def _shown_title(document: Document, style: Style) -> str:
    return style.title or ("" if style.redact else _title(document, style))


def _title(document: Document, style: Style) -> str:
    """The policies that were named, without what they include; empty where that is not known."""
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.outline import title_of

    return title_of(list(dict.fromkeys(Path(file).name for file in document.policies)), Words(style.language))


def _rendered_parts(
    document: Document, style: Style
) -> tuple[Mapping[str, Any], Earlier | None, Mapping[str, Any] | str, Aliases | None]:
    """The document, the earlier one if there is one, proposals, and what elements are called if names are replaced."""
    from rosprivacy.report.compare.earlier import read_earlier
    from rosprivacy.report.document.analysis import json_document

    told, proposals = json_document(document), document.proposals or "graph"
    earlier = read_earlier(style.since) if style.since else None
    if not style.redact:
        return told, earlier, proposals, None
    from rosprivacy.report.page.figures import aliases_of
    from rosprivacy.report.redact import redacted

    beside = [earlier.document] if earlier else []
    also = [proposals] if not isinstance(proposals, str) else []
    copies = redacted([told, *beside, *also])
    earlier = earlier._replace(document=copies[1], file="file-0") if earlier else None
    return copies[0], earlier, copies[-1] if also else proposals, aliases_of(told, copies[0])


_REPORT = ("language", "title", "since", "redact", "assessment")
_DPIA = ("language", "title", "redact", "assessment")
_LINKED = ("base", "redact")
_PAGE = (*IN_JSON, RELIANCE, PROPOSALS)
FORMATS = {
    known.name: known
    for known in (
        OutputFormat("text", ".txt", _text, ("language", "verbose", "quiet"), both_views=True, asks=(LEDGER, RELIANCE)),
        OutputFormat("json", ".json", _short_json, both_views=True, asks=IN_JSON),
        OutputFormat("json1", ".json", _json, both_views=True),
        OutputFormat("sarif", ".sarif", _sarif, both_views=True, asks=(POSITIONS,)),
        OutputFormat("cnil-pia", ".json", _cnil_pia, ("language", "assessment"), asks=(REGISTER, PROCESSING)),
        OutputFormat("turtle", ".ttl", _linked_data("turtle"), _LINKED),
        OutputFormat("json-ld", ".jsonld", _linked_data("json-ld"), _LINKED),
        OutputFormat("html", ".html", _html, _REPORT, both_views=True, page="a page", asks=(*_PAGE, PATHS)),
        OutputFormat("markdown", ".md", _markdown, _REPORT, both_views=True, asks=_PAGE),
        OutputFormat("docx", ".docx", _docx, _REPORT, both_views=True, page="a Word document", asks=_PAGE),
        OutputFormat("article30", ".csv", _article30, ("language", "redact")),
        OutputFormat("article30-processors", ".csv", _article30_processors, ("language", "redact")),
        OutputFormat("notice", ".md", _notice, ("language", "title", "redact")),
        OutputFormat("works-council", ".html", _works_council, _REPORT, page="a page"),
        OutputFormat("edpb-dpia", ".docx", _edpb_dpia, _DPIA, page="a Word document", asks=IN_JSON),
    )
}
