"""``rosprivacy report``: what was found, for the people who assess it: a page, Word, the record of Article 30."""

from __future__ import annotations

from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import HangsOn, Language, Output, ViewOrBoth, ViewOrBothChosen
from rosprivacy.cli.output import emit, not_for_a_terminal


class ReportFormat(StrEnum):
    """What is written."""

    html = "html"
    markdown = "markdown"
    docx = "docx"
    article30 = "article30"
    works_council = "works-council"


@reads_system()
def report(
    inputs: Inputs,
    view: ViewOrBothChosen = ViewOrBoth.declared,
    chosen: Annotated[
        ReportFormat | None,
        typer.Option(
            "--format",
            "-f",
            show_default="as the output's name ends, else html",
            help="A page, a text, a Word document, rows for the record of processing (Article 30 GDPR), "
            "or one page for works councils.",
        ),
    ] = None,
    output: Output = None,
    lang: Annotated[Language, typer.Option(help="Language of the report.")] = Language.en,
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
    assessment: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            show_default=False,
            help="Fill in the answers that the page of an earlier report saved.",
        ),
    ] = None,
    hangs_on: HangsOn = False,
    redact: Annotated[
        bool,
        typer.Option("--redact", help="Replace names of elements, files, robots and persons, to show it to others."),
    ] = False,
) -> None:
    """Write a report for people: a page that needs no network, a text, a Word document, or rows for the record.

    It ends with 0 when the report is written, whatever that says; a gate in CI is 'analyze'.
    """
    from rosprivacy.formats import Style, written

    format = chosen or _by_ending(output)  # noqa: A001 - the option's name
    if format in (ReportFormat.html, ReportFormat.works_council):
        not_for_a_terminal("a page", output)
    if format is ReportFormat.docx:
        not_for_a_terminal("a Word document", output)
    both = view is ViewOrBoth.both
    if both and format in (ReportFormat.article30, ReportFormat.works_council):
        raise typer.BadParameter("--view both is for html, markdown and docx: the others tell what is declared")
    inputs = inputs.viewed(view)
    result = inputs.result(replace(inputs.settings, hangs_on=hangs_on), both=both)
    style = Style(
        language=lang.value,
        title=title,
        since=str(since) if since else None,
        redact=redact,
        assessment=str(assessment) if assessment else None,
    )
    report = written(result, format.value, style)
    emit(report.encode() if isinstance(report, str) else report, output)  # it says of itself that it is UTF-8


def _by_ending(output: Path | None) -> ReportFormat:
    """The format that a file's name asks for; of those that end alike the first."""
    from rosprivacy.formats import FORMATS

    ending = output.suffix.lower() if output else ""
    known = {FORMATS[one].suffix: one for one in reversed(ReportFormat)} | {"": ReportFormat.html}
    if ending not in known:
        endings = ", ".join(sorted(filter(None, known)))
        raise typer.BadParameter(f"no report ends in {shown(ending)}; write one of {endings}, or --format")
    return known[ending]
