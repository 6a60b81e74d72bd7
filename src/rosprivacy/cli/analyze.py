"""``rosprivacy analyze``: where each kind of data can get, and an exit code for CI."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.modes import Article9Level, Paths
from rosprivacy.cli.exit_code import FailOn, exit_code
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.options import ASKED, Engine, Format, HangsOn, Language, Output, ViewOrBoth, ViewOrBothChosen
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from rosprivacy.formats import Style
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


LINKED_DATA = (Format.turtle, Format.json_ld)
TELL_BOTH = (Format.text, Format.json, Format.sarif)
IN_LANGUAGES = (Format.text, Format.cnil_pia)
SPARK = "Where it is computed"  # a panel of help


@reads_system()
def analyze(
    inputs: Inputs,
    engine: Annotated[
        Engine,
        typer.Option(
            help=r"Of a fleet: in memory here, or in parts on Apache Spark (the \[spark] extra).",
            rich_help_panel=SPARK,
        ),
    ] = Engine.memory,
    master: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            show_default=False,
            help="Spark cluster, such as spark://host:7077; by default the cores of this machine.",
            rich_help_panel=SPARK,
        ),
    ] = None,
    results: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            help="With --engine spark: write every robot there, for load.",
            show_default=False,
            rich_help_panel=SPARK,
        ),
    ] = None,
    view: ViewOrBothChosen = ViewOrBoth.declared,
    per_policy: Annotated[
        bool,
        typer.Option("--per-policy", help="Analyse each policy alone; by default several make one graph."),
    ] = False,
    save_graph: Annotated[
        Path | None, typer.Option(metavar="GRAPH.json", help="Save what the policies grant.", show_default=False)
    ] = None,
    format: Annotated[Format, typer.Option("--format", "-f", help="Of the report.")] = Format.text,  # noqa: A002 - the option's name
    output: Output = None,
    lang: Annotated[
        Language | None,
        typer.Option(
            help="Language of text and of the file for the CNIL's tool; by default English.", show_default=False
        ),
    ] = None,
    base: Annotated[
        str | None,
        typer.Option(
            metavar="IRI",
            show_default=False,
            help="Of Turtle and JSON-LD: what the IRIs of elements and findings begin with; by default a UUID of the "
            "system.",
        ),
    ] = None,
    redact: Annotated[
        bool,
        typer.Option(
            "--redact",
            help="Of Turtle and JSON-LD: replace names of elements, files, robots and persons, to show it to others.",
        ),
    ] = False,
    article9: Annotated[
        bool,
        typer.Option(
            "--article9", help="Answer for what can fall under Article 9(1) or 10 GDPR only.", rich_help_panel=ASKED
        ),
    ] = False,
    article9_level: Annotated[
        Article9Level | None,
        typer.Option(
            help="The same, up to this level: always, on a condition too, or also what may reveal such data.",
            rich_help_panel=ASKED,
            show_default=False,
        ),
    ] = None,
    data_type: Annotated[
        list[str] | None,
        typer.Option(
            metavar="TYPE",
            show_default=False,
            help="Answer for video, audio, … only; may be repeated.",
            rich_help_panel=ASKED,
        ),
    ] = None,
    identity_factor: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FACTOR",
            show_default=False,
            help="Answer for data that tell of this factor of Article 4(1) GDPR only: economic, …; may be repeated.",
            rich_help_panel=ASKED,
        ),
    ] = None,
    paths: Annotated[Paths, typer.Option(help="Ways to list for each finding.", rich_help_panel=ASKED)] = Paths.witness,
    max_paths: Annotated[
        int, typer.Option(min=1, metavar="N", help="Bound on the listed ways of a finding.", rich_help_panel=ASKED)
    ] = 100,
    hangs_on: HangsOn = False,
    fail_on: Annotated[
        list[FailOn] | None,
        typer.Option(
            show_default="undetermined",
            help="Exit with 1 on a finding that is not accepted, and with 4 if undetermined. doubt: with 4 on a doubt "
            "that is not accepted, too; leak: not with 4, unless no data was followed; undecided: with 1 only where "
            "nobody has decided; never: with 0. May be repeated: the strictest counts.",
        ),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the verdict only.")] = False,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Print every open element and notice.")] = False,
) -> None:
    """Find where each kind of personal data can get from its sources, and whether it reaches a leak."""
    from rosprivacy.formats import Style, in_pieces

    inputs = inputs.viewed(view)
    fails = tuple(fail_on or (FailOn.undetermined,))
    if FailOn.never in fails and len(set(fails)) > 1:
        raise typer.BadParameter("--fail-on never stands alone")
    settings = replace(
        inputs.settings,
        article9=article9,
        article9_level=article9_level and article9_level.value,
        data_types=tuple(data_type or ()),
        identity_factors=tuple(identity_factor or ()),
        paths=paths.value,
        max_paths=max_paths,
        hangs_on=hangs_on,
    )
    _check(inputs, engine, save_graph=bool(save_graph), per_policy=per_policy, of_spark=bool(master or results))
    if base is not None and format not in LINKED_DATA:
        raise typer.BadParameter("--base is for --format turtle and json-ld")
    if redact and format not in LINKED_DATA:
        raise typer.BadParameter("--redact is for --format turtle and json-ld; 'report' has it too")
    if lang and format not in IN_LANGUAGES:
        raise typer.BadParameter("--lang is for --format text and cnil-pia")
    language = (lang or Language.en).value
    style = Style(verbose=verbose, quiet=quiet, colour=output is None, language=language, base=base, redact=redact)
    if view is ViewOrBoth.both and (per_policy or engine is Engine.spark or format not in TELL_BOTH):
        said = "--view both writes text, json and sarif, and takes neither --per-policy nor --engine spark"
        raise typer.BadParameter(said)
    if per_policy:
        raise typer.Exit(_each_alone(inputs, settings, format, style, output, fails))
    if results and output:
        from rosprivacy.report.atomic import check_outputs

        check_outputs([Path(results), output])
    if inputs.fleet and engine is Engine.spark:
        from rosprivacy.spark.fleet_on_spark import run_on_spark

        result = run_on_spark(inputs.fleet, settings, master, results)
    else:
        result = inputs.result(settings, both=view is ViewOrBoth.both)
    graphs = {save_graph: _saved_graph(result)} if save_graph else {}
    emit(in_pieces(result, format.value, style), output, graphs)
    raise typer.Exit(exit_code(result, fails))


def _check(inputs: Inputs, engine: Engine, *, save_graph: bool, per_policy: bool, of_spark: bool) -> None:
    """Refuse options that make no sense beside others."""
    saved = ["--save-graph"] if save_graph else []
    both = [*saved, *(["--per-policy"] if per_policy else [])]
    if inputs.from_database:
        refuse("--from-database", "what is in the database", both)
    if inputs.fleet:
        refuse("--fleet", "what the fleet file names", both)
    if engine is Engine.spark:
        refuse("--engine spark", "a fleet that nobody has decided about", inputs.given("decisions"))
        if not inputs.fleet:
            raise typer.BadParameter("--engine spark is for fleets: give --fleet too")
    elif of_spark:
        raise typer.BadParameter("--master and --results are for --engine spark")
    if per_policy:
        refuse("--per-policy", "policies by themselves", [*inputs.given("add"), *saved])


def _saved_graph(result: Result) -> str:
    from rosprivacy.ingest.policies.saved_graph import as_dict
    from rosprivacy.report.json_text import as_text

    return as_text(as_dict(result.policies, result.diagnostics, result.types))


def _each_alone(
    inputs: Inputs, settings: Settings, form: Format, style: Style, output: Path | None, fail_on: tuple[FailOn, ...]
) -> int:
    from rosprivacy.cli import per_policy
    from rosprivacy.reading.robot_system import answer_each
    from rosprivacy.report.json_text import as_text

    if form not in (Format.text, Format.json):
        raise typer.BadParameter("--per-policy writes text and json")
    each = answer_each(inputs.named, tuple(inputs.labels or ()), settings)
    emit(per_policy.texts(each, style) if form is Format.text else as_text(per_policy.document(each)), output)
    codes = (exit_code(result, fail_on) for _, result in each)
    return int(per_policy.worst_of(codes, per_policy.CODES_WORST_FIRST))
