"""The report of a document, as an outline, a page and texts."""

from __future__ import annotations

import csv
import io
import re
from typing import TYPE_CHECKING, Any

from lxml import html as lxml_html

from rosprivacy.formats import Style, written
from rosprivacy.report import catalogs
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.compare.earlier import Earlier
from rosprivacy.report.page.article30 import RecordEntry
from rosprivacy.report.page.html import html
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.outline import Outline, outline

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.result import Result

LANGUAGES = catalogs.LANGUAGES


def told(document: dict[str, Any], language: str = "en", **options: Any) -> Outline:
    return outline(document, language, **options)


def page(document: dict[str, Any], language: str = "en", **options: Any) -> Any:
    return lxml_html.document_fromstring(html(told(document, language, **options)))


def texts(document: dict[str, Any], language: str = "en", **options: Any) -> Iterator[str]:
    """The report in both forms, as text without marks, with plain spaces."""
    return texts_of(told(document, language, **options))


def texts_of(report: Outline) -> Iterator[str]:
    for text in (lxml_html.document_fromstring(html(report)).text_content(), re.sub(r"\\(.)", r"\1", markdown(report))):
        yield plain(text)


def seen(result: Result, name: str, language: str = "en") -> str:
    """What a reader of an output sees: of a page the text; the others as they are written."""
    text = written(result, name, Style(language=language))
    assert isinstance(text, str)
    return plain(lxml_html.document_fromstring(text).text_content() if name in ("html", "works-council") else text)


def record_rows(result: Result) -> dict[tuple[str, str], dict[str, str]]:
    """The record of processing: (kind of data, place) -> the cells of its row, by the names of its columns."""
    text = seen(result, "article30").removeprefix("\ufeff")
    columns = {Words("en")(f"record.{name}"): name for name in RecordEntry.__dataclass_fields__}
    found = [{columns[key]: cell for key, cell in row.items()} for row in csv.DictReader(io.StringIO(text))]
    return {(row["category"], row["exit"]): row for row in found}


def earlier(document: dict[str, Any]) -> Earlier:
    return Earlier(document, "old.json", "0" * 64)
