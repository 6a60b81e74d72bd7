"""The report of a document, as an outline, a page and texts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from lxml import html as lxml_html

from rosprivacy.report import catalogs
from rosprivacy.report.catalogs.words import plain
from rosprivacy.report.compare.earlier import Earlier
from rosprivacy.report.page.html import html
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.outline import Outline, outline

if TYPE_CHECKING:
    from collections.abc import Iterator


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


def earlier(document: dict[str, Any]) -> Earlier:
    return Earlier(document, "old.json", "0" * 64)
