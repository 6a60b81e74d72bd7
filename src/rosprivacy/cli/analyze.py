"""``rosprivacy analyze``: where each kind of data can get, and an exit code for CI."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.cli.driver import driver_of
from rosprivacy.cli.inputs import named
from rosprivacy.cli.options import (
    DecisionsFile,
    Engine,
    EngineChosen,
    FailOn,
    FleetFile,
    Format,
    IncludeRoot,
    LabelFiles,
    Master,
    MaxBytes,
    NoStandard,
    Ontologies,
    Output,
    PathsShown,
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


def analyze(
    policies: Policies = None,
    labels: LabelFiles = None,
    from_database: Annotated[
        bool, typer.Option("--from-database", help="Analyse what is in Neo4j, and write the answer back there.")
    ] = False,
    neo4j: Server = None,
    fleet: FleetFile = None,
    engine: EngineChosen = Engine.memory,
    master: Master = None,
    results: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="With --engine spark: write every robot there, for load.", show_default=False),
    ] = None,
    add: Annotated[
        list[str] | None,
        typer.Option(metavar="GRAPH.json", help="Add to a graph saved before; may be repeated.", show_default=False),
    ] = None,
    save_graph: Annotated[
        Path | None, typer.Option(metavar="GRAPH.json", help="Save what the policies grant.", show_default=False)
    ] = None,
    format: Annotated[Format, typer.Option("--format", "-f", help="Of the report.")] = Format.text,  # noqa: A002 - the option's name
    output: Output = None,
    categories: Annotated[
        list[str] | None,
        typer.Option(
            "--categories",
            "-c",
            metavar="NAME",
            autocompletion=complete_category,
            show_default=False,
            help="Answer for this category, narrower, broader and overlapping ones only; may be repeated.",
        ),
    ] = None,
    article9: Annotated[
        bool, typer.Option("--article9", help="Answer for what can fall under Article 9(1) GDPR only.")
    ] = False,
    data_type: Annotated[
        list[str] | None,
        typer.Option(metavar="TYPE", show_default=False, help="Answer for video, audio, … only; may be repeated."),
    ] = None,
    ontology: Ontologies = None,
    category: SixLists = "PersonalData",
    view: ViewChosen = View.declared,
    paths: Annotated[PathsShown, typer.Option(help="Ways to list for each finding.")] = PathsShown.witness,
    max_paths: Annotated[int, typer.Option(min=1, help="Bound on the listed ways of a finding.")] = 100,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    decisions: DecisionsFile = None,
    fail_on: Annotated[
        FailOn,
        typer.Option(
            help="Exit with 1 on a finding that is not accepted (leak, todo) or not decided (undecided), on any (all), "
            "or on none (never, off); undetermined: as leak, and with 4 if undetermined."
        ),
    ] = FailOn.leak,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the verdict only.")] = False,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Print every open element and notice.")] = False,
) -> None:
    """Find where each kind of personal data can get from its sources, and whether it reaches a leak."""
    from rosprivacy.assembly import run
    from rosprivacy.settings import Settings

    settings = Settings(
        add=tuple(add or ()),
        view=view.value,
        categories=tuple(categories or ()),
        article9=article9,
        data_types=tuple(data_type or ()),
        ontologies=tuple(ontology or ()),
        category=category,
        standard_channels=None if no_standard_channels else standard_channels,
        paths=paths.value,
        max_paths=max_paths,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=progress_of,
        decisions=str(decisions) if decisions else None,
    )
    if fleet and (policies or labels or add or save_graph):
        raise typer.BadParameter("--fleet takes what the fleet file names: no POLICY, --labels, --add, --save-graph")
    if engine is Engine.spark and not fleet:
        raise typer.BadParameter("--engine spark is for fleets: give --fleet too")
    if engine is Engine.spark and decisions:
        raise typer.BadParameter("--decisions are taken into account in memory only: leave out --engine spark")
    if (master or results) and engine is not Engine.spark:
        raise typer.BadParameter("--master and --results are for --engine spark")
    if results and output:
        from rosprivacy.report.atomic import check_outputs

        check_outputs([Path(results), output])
    if from_database:
        if policies or labels or add or save_graph or fleet:
            raise typer.BadParameter(
                "--from-database takes what is in the database: no POLICY, --labels, --add, --save-graph, --fleet"
            )
        from rosprivacy.assembly import run_stored

        with driver_of(neo4j) as driver:
            result = run_stored(driver, settings)
    elif fleet and engine is Engine.spark:
        from rosprivacy.spark.fleet_on_spark import run_on_spark

        result = run_on_spark(fleet, settings, master, results)
    elif fleet:
        from rosprivacy.fleets import run_fleet

        result = run_fleet(fleet, settings)
    else:
        result = run(named(policies, settings), tuple(labels or ()), settings)
    texts = {}
    if save_graph:
        from rosprivacy.ingest.policies.saved_graph import as_dict
        from rosprivacy.report.document.analysis import as_text

        texts[save_graph] = as_text(as_dict(result.policies))
    emit(_report(result, format, colour=output is None, quiet=quiet, verbose=verbose), output, texts)
    raise typer.Exit(_exit_code(result, fail_on))


def _report(result: Result, form: Format, *, colour: bool, quiet: bool, verbose: bool) -> str:
    from rosprivacy.report.document.analysis import as_text

    if form is Format.json:
        return as_text(result.document())
    if form in (Format.turtle, Format.json_ld):
        from rosprivacy.clock import source_date

        return result.linked_data(form.value, when=source_date(os.environ))
    if form in (Format.sarif, Format.cnil_pia):
        from rosprivacy import formats

        return as_text(formats.sarif_log(result) if form is Format.sarif else formats.pia_file(result))
    from io import StringIO

    from rich.console import Console

    from rosprivacy.report.terminal.analysis import print_report

    text = StringIO()
    console = Console(file=text, force_terminal=colour and Console().is_terminal, highlight=False, emoji=False)
    print_report(console, result.document(), verbose=verbose, quiet=quiet)
    return text.getvalue()


def _exit_code(result: Result, fail_on: FailOn) -> int:
    analysis, decided = result.analysis, result.decided
    findings = [finding for finding in analysis.findings if not finding.dismissed]
    left = [finding for finding in findings if not finding.accepted]
    undecided = [finding for finding in left if not (decided and decided.valid(finding))]
    counted = {FailOn.never: [], FailOn.off: [], FailOn.undecided: undecided, FailOn.all: findings}.get(fail_on, left)
    if counted:
        return 1
    return 4 if analysis.verdict == "undetermined" and fail_on is FailOn.undetermined else 0
