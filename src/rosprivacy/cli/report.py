"""``rosprivacy report``: what was found, for the people who assess it: HTML, Markdown, the record of Article 30."""

from __future__ import annotations

import os
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Output
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from rosprivacy.assembly import Result


class ReportFormat(StrEnum):
    """What is written."""

    html = "html"
    markdown = "markdown"
    article30 = "article30"


class ReportLanguage(StrEnum):
    """Of the report."""

    en = "en"
    de = "de"


@reads_system()
def report(
    inputs: Inputs,
    format: Annotated[  # noqa: A002 - the option's name
        ReportFormat,
        typer.Option("--format", "-f", help="A page, a text, or rows for the record of processing (Article 30 GDPR)."),
    ] = ReportFormat.html,
    output: Output = None,
    lang: Annotated[ReportLanguage, typer.Option(help="Language of the report.")] = ReportLanguage.en,
    title: Annotated[
        str, typer.Option(metavar="TEXT", show_default=False, help="Name of the system; by default its policy files.")
    ] = "",
    since: Annotated[
        Path | None,
        typer.Option(
            metavar="OLD.json",
            show_default=False,
            help="Tell what changed since this document of 'analyze --format json'.",
        ),
    ] = None,
    redact: Annotated[
        bool,
        typer.Option("--redact", help="Replace names of elements, files, robots and persons, to show it to others."),
    ] = False,
) -> None:
    """Write a report for people: a page that needs no network, a text, or rows for the record of processing.

    It ends with 0 when the report is written, whatever that says; a gate in CI is ``analyze``.
    """
    result = inputs.result(inputs.settings)
    text = _text(result, format, lang.value, title, since, redact=redact)
    emit(text.encode(), output)  # it says of itself that it is UTF-8


def _text(result: Result, form: ReportFormat, language: str, title: str, since: Path | None, *, redact: bool) -> str:
    """The report; everything in it comes from the documents."""
    from dataclasses import replace

    from rosprivacy.clock import today
    from rosprivacy.report.compare.earlier import read_earlier
    from rosprivacy.report.page.outline import outline

    document = result.document()
    earlier = read_earlier(str(since)) if since else None
    aliases = None
    if redact:
        from rosprivacy.report.page.redact import redacted
        from rosprivacy.report.page.redacted_pictures import aliases_of

        copies = redacted([document, *([earlier.document] if earlier else [])])
        aliases = aliases_of(document, copies[0])
        document = copies[0]
        earlier = replace(earlier, document=copies[1], file="file-0") if earlier else None
    if form is ReportFormat.article30:
        from rosprivacy.report.page.article30 import record

        return record(document, language)
    made = today(os.environ)
    told = outline(document, language, title=title, made=made, earlier=earlier, redacted=redact)
    if form is ReportFormat.markdown:
        from rosprivacy.report.page.markdown import markdown

        return markdown(told)
    from rosprivacy.report.page.figures import figures
    from rosprivacy.report.page.html import html

    return html(told, figures(result.analysis, told, aliases))
