"""``rosprivacy report``: what was found, for the people who assess it: HTML, Markdown, the record of Article 30."""

from __future__ import annotations

import os
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.cli.options import (
    DecisionsFile,
    FleetFile,
    IncludeRoot,
    LabelFiles,
    MaxBytes,
    NoStandard,
    Ontologies,
    Output,
    Policies,
    Server,
    SixLists,
    Standard,
    View,
    ViewChosen,
    complete_category,
)
from rosprivacy.cli.output import emit, progress_of

if TYPE_CHECKING:
    from rosprivacy.assembly import Result
    from rosprivacy.settings import Settings


class ReportFormat(StrEnum):
    """What is written."""

    html = "html"
    markdown = "markdown"
    article30 = "article30"


class ReportLanguage(StrEnum):
    """Of the report."""

    en = "en"
    de = "de"


def report(
    policies: Policies = None,
    labels: LabelFiles = None,
    fleet: FleetFile = None,
    from_database: Annotated[
        bool, typer.Option("--from-database", help="Report on what is in Neo4j; the answer is written back there.")
    ] = False,
    neo4j: Server = None,
    add: Annotated[
        list[str] | None,
        typer.Option(metavar="GRAPH.json", help="Add to a graph saved before; may be repeated.", show_default=False),
    ] = None,
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
    categories: Annotated[
        list[str] | None,
        typer.Option(
            "--categories",
            "-c",
            metavar="NAME",
            autocompletion=complete_category,
            show_default=False,
            help="Report on this category, narrower, broader and overlapping ones only; may be repeated.",
        ),
    ] = None,
    ontology: Ontologies = None,
    decisions: DecisionsFile = None,
    category: SixLists = "PersonalData",
    view: ViewChosen = View.declared,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
) -> None:
    """Write a report for people: a page that needs no network, a text, or rows for the record of processing.

    It ends with 0 when the report is written, whatever that says; a gate in CI is ``analyze``.
    """
    from rosprivacy.settings import Settings

    settings = Settings(
        add=tuple(add or ()),
        view=view.value,
        categories=tuple(categories or ()),
        ontologies=tuple(ontology or ()),
        decisions=str(decisions) if decisions else None,
        category=category,
        standard_channels=None if no_standard_channels else standard_channels,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=progress_of,
    )
    if from_database and (policies or labels or add or fleet):
        raise typer.BadParameter("--from-database takes what is in the database: no POLICY, --labels, --add, --fleet")
    if fleet and (policies or labels or add):
        raise typer.BadParameter("--fleet takes what the fleet file names: no POLICY, --labels, --add")
    if not from_database and not policies and not add and not fleet:
        raise typer.BadParameter("name at least one policy: a file, a folder or a glob", param_hint="POLICY")
    if fleet:
        from rosprivacy.fleets import run_fleet

        result = run_fleet(fleet, settings)
    else:
        result = _result(policies, labels, settings, neo4j, from_database=from_database)
    text = _text(result, format, lang.value, title, since, redact=redact)
    emit(text.encode(), output)  # it says of itself that it is UTF-8


def _result(
    policies: list[str] | None, labels: list[str] | None, settings: Settings, neo4j: str | None, *, from_database: bool
) -> Result:
    from rosprivacy.assembly import run, run_stored

    if not from_database:
        return run(tuple(policies or ()), tuple(labels or ()), settings)
    from rosprivacy.cli.driver import driver_of

    with driver_of(neo4j) as driver:
        return run_stored(driver, settings)


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
