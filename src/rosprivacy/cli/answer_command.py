"""What ``analyze`` and ``report`` have in common: what is asked, how the answer is written, how the command ends.

In: groups of options, as typer fills them. Out: an answer in one of ``FORMATS``, and an exit code.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from rosprivacy.analysis.errors import InputError, reason
from rosprivacy.analysis.modes import Article9Level, Paths
from rosprivacy.cli.exit_code import FailOn, exit_code
from rosprivacy.cli.inputs import Inputs, refuse
from rosprivacy.cli.options import QUESTION_PANEL, Engine, HangsOn, Language, Output, ViewOrBoth, ViewOrBothChosen
from rosprivacy.cli.output import emit, not_for_a_terminal
from rosprivacy.cli.suggestions_to_answer import suggestions_to_answer
from rosprivacy.formats import FORMATS, Style, in_pieces

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

COMPUTED = "Where it is computed"  # panels of help
WRITTEN = "How the answer is written"


def format_name(text: str) -> str:
    """Return a name of ``FORMATS``; ``BadParameter`` for any other."""
    if text not in FORMATS:
        raise typer.BadParameter(f"'{text}' is not one of {', '.join(map(repr, FORMATS))}.")
    return text


def complete_format(incomplete: str) -> list[str]:
    """Return the formats that begin so, for shell completion."""
    return [name for name in FORMATS if name.startswith(incomplete)]


class Asked(NamedTuple):
    """What is asked of a system."""

    view: ViewOrBothChosen = ViewOrBoth.declared
    per_policy: Annotated[
        bool, typer.Option("--per-policy", help="Analyse each policy alone; by default several make one graph.")
    ] = False
    article9: Annotated[
        bool,
        typer.Option(
            "--article9",
            help="Answer for what can fall under Article 9(1) or 10 GDPR only.",
            rich_help_panel=QUESTION_PANEL,
        ),
    ] = False
    article9_level: Annotated[
        Article9Level | None,
        typer.Option(
            help="The same, up to this level: always, on a condition too, or also what may reveal such data.",
            rich_help_panel=QUESTION_PANEL,
            show_default=False,
        ),
    ] = None
    data_type: Annotated[
        list[str] | None,
        typer.Option(
            metavar="TYPE",
            show_default=False,
            help="Answer for video, audio, … only; may be repeated.",
            rich_help_panel=QUESTION_PANEL,
        ),
    ] = None
    identity_factor: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FACTOR",
            show_default=False,
            help="Answer for data that tell of this factor of Article 4(1) GDPR only: economic, …; may be repeated.",
            rich_help_panel=QUESTION_PANEL,
        ),
    ] = None
    paths: Annotated[Paths, typer.Option(help="Ways to list for each finding.", rich_help_panel=QUESTION_PANEL)] = (
        Paths.witness
    )
    max_paths: Annotated[
        int,
        typer.Option(min=1, metavar="N", help="Bound on the listed ways of a finding.", rich_help_panel=QUESTION_PANEL),
    ] = 100
    hangs_on: HangsOn = False

    def settings(self, read: Settings) -> Settings:
        """Return how the system is read, with what is asked of it."""
        return replace(
            read,
            article9=self.article9,
            article9_level=self.article9_level and self.article9_level.value,
            data_types=tuple(self.data_type or ()),
            identity_factors=tuple(self.identity_factor or ()),
            paths=self.paths.value,
            max_paths=self.max_paths,
            hangs_on=self.hangs_on,
        )


class Computed(NamedTuple):
    """Where the answer about a fleet is computed."""

    engine: Annotated[
        Engine,
        typer.Option(
            help=r"Of a fleet: in memory; in parts, by processes here; or so on Apache Spark (the \[spark] extra).",
            rich_help_panel=COMPUTED,
        ),
    ] = Engine.memory
    resume: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            show_default=False,
            help="With --engine parts: keep there what was read, and go on with what a run that was killed has read.",
            rich_help_panel=COMPUTED,
        ),
    ] = None
    master: Annotated[
        str | None,
        typer.Option(
            metavar="URL",
            show_default=False,
            help="Spark cluster, such as spark://host:7077; by default the cores of this machine.",
            rich_help_panel=COMPUTED,
        ),
    ] = None
    results: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            help="With --engine spark: write every robot there, for load.",
            show_default=False,
            rich_help_panel=COMPUTED,
        ),
    ] = None


class Written(NamedTuple):
    """How the answer is written, where to, and on what the command fails."""

    format: Annotated[
        str | None,
        typer.Option(
            "--format",
            "-f",
            parser=format_name,
            autocompletion=complete_format,
            metavar=f"<{'|'.join(FORMATS)}>",
            show_default="as the output's name ends, else html; of analyze text",
            help="For a terminal, for programs, for code scanning; linked data; the CNIL's tool; a page, a text, a "
            "Word document; rows for the records of processing (Article 30 GDPR); a notice to persons (Articles 13 and "
            "14); a summary for works councils; an impact assessment along the EDPB's template.",
            rich_help_panel=WRITTEN,
        ),
    ] = None
    output: Output = None
    lang: Annotated[
        Language | None,
        typer.Option(
            help="Language of what people read; by default English.", show_default=False, rich_help_panel=WRITTEN
        ),
    ] = None
    title: Annotated[
        str | None,
        typer.Option(
            metavar="TEXT",
            show_default=False,
            help="Of a report: name of the system; by default its policy files.",
            rich_help_panel=WRITTEN,
        ),
    ] = None
    since: Annotated[
        Path | None,
        typer.Option(
            metavar="OLD.json",
            show_default=False,
            help="Of a report: tell what changed since this document of 'analyze --format json'.",
            rich_help_panel=WRITTEN,
        ),
    ] = None
    assessment: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.json",
            show_default=False,
            help="Of a report or a file for the CNIL's tool: fill in the answers that an earlier page saved.",
            rich_help_panel=WRITTEN,
        ),
    ] = None
    base: Annotated[
        str | None,
        typer.Option(
            metavar="IRI",
            show_default=False,
            help="Of Turtle and JSON-LD: what the IRIs of elements and findings begin with; by default a UUID of the "
            "system.",
            rich_help_panel=WRITTEN,
        ),
    ] = None
    redact: Annotated[
        bool,
        typer.Option(
            "--redact",
            help="Of a report, Turtle and JSON-LD: replace names of elements, files, robots and persons, to show it to "
            "others.",
            rich_help_panel=WRITTEN,
        ),
    ] = False
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", help="Of text: the verdict only.", rich_help_panel=WRITTEN)
    ] = False
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Of text: every open element and notice.", rich_help_panel=WRITTEN)
    ] = False

    save_graph: Annotated[
        Path | None, typer.Option(metavar="GRAPH.json", help="Save what the policies grant.", show_default=False)
    ] = None
    tables: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            show_default=False,
            help="Write the answer as tables into this folder, too: CSV files for spreadsheets and data frames.",
        ),
    ] = None
    fail_on: Annotated[
        list[FailOn] | None,
        typer.Option(
            "--fail-on",
            show_default="undetermined; of report never",
            help="Exit with 1 on a finding that is not accepted, and with 4 if undetermined. doubt: with 4 on a doubt "
            "that is not accepted, too; leak: not with 4, unless no data was followed; undecided: with 1 only where "
            "nobody has decided; never: with 0. May be repeated: the strictest counts.",
        ),
    ] = None

    def style(self, name: str) -> Style:
        """Return how the answer is shown; an option that means nothing to the format is refused."""
        for option, field in STYLES.items():
            if getattr(self, option) not in (None, False) and field not in FORMATS[name].styles:
                heeding = ", ".join(name for name, known in FORMATS.items() if field in known.styles)
                raise typer.BadParameter(f"--{option} is for --format {heeding}")
        return Style(
            verbose=self.verbose,
            quiet=self.quiet,
            colour=self.output is None,
            language=(self.lang or Language.en).value,
            title=self.title or "",
            since=str(self.since) if self.since else None,
            assessment=str(self.assessment) if self.assessment else None,
            base=self.base,
            redact=self.redact,
        )


STYLES = {"lang": "language"} | {name: name for name in ("title", "since", "assessment", "base", "redact")}


def answer(
    inputs: Inputs,
    question: Asked,
    computed: Computed,
    written: Written,
    form: str,
    default: FailOn,
) -> None:
    """Read the system, answer, write the answer in a format, and end with the exit code.

    Parameters
    ----------
    form
        A name of ``FORMATS``.
    default
        What the command fails on, where nothing is named.
    """
    stated = inputs.stated
    in_ci = stated.fail_on if stated and default is not FailOn.never else ()
    fail_on = tuple(written.fail_on or in_ci or (default,))
    per_policy, save_graph = question.per_policy, written.save_graph
    if FailOn.never in fail_on and len(set(fail_on)) > 1:
        raise typer.BadParameter("--fail-on never stands alone")
    both = question.view is ViewOrBoth.both
    inputs = inputs.viewed(question.view)
    settings = question.settings(inputs.settings)
    _check(inputs, computed, save_graph=bool(save_graph), per_policy=per_policy)
    style, known = written.style(form), FORMATS[form]
    if stated and stated.lang and not written.lang and "language" in known.styles:
        style = style._replace(language=stated.lang.value)
    if both and (per_policy or computed.engine is not Engine.memory or not known.both_views):
        able = ", ".join(name for name, each in FORMATS.items() if each.both_views)
        raise typer.BadParameter(f"--view both writes {able}, and takes neither --per-policy nor a fleet in parts")
    if known.page:
        not_for_a_terminal(known.page, written.output)
    if per_policy:
        refuse("--per-policy", "one file for all", ["--tables"] if written.tables else [])
        raise typer.Exit(_each_alone(inputs, settings, form, style, written.output, fail_on))
    if computed.results and written.output:
        from rosprivacy.report.atomic import check_outputs

        check_outputs([Path(computed.results), written.output])
    if inputs.fleet and computed.engine is not Engine.memory:
        result = _in_parts(inputs.fleet, settings, computed)
    else:
        result = inputs.result(settings, both_views=both)
    others = {save_graph: _saved_graph(result)} if save_graph else {}
    others |= _tables(result, written.tables) if written.tables else {}
    text = in_pieces(result, form, style)
    if isinstance(text, str) and form != "text":
        text = text.encode()  # a file says of itself that it is UTF-8, whatever the terminal understands
    emit(text, written.output, others)
    for line in _remarks(inputs, form, quiet=written.quiet):
        typer.echo(line, err=True)
    raise typer.Exit(exit_code(result, fail_on))


def _remarks(inputs: Inputs, form: str, *, quiet: bool) -> Iterator[str]:
    """What a person at the terminal has to know of an answer beside the answer."""
    if form == "text" and not quiet:
        yield from suggestions_to_answer(inputs)
    elif form == "html":
        from rosprivacy.report.pictures.graphviz import MISSING, available, how_to_get_it

        if not available():
            yield f"report: {MISSING} picture on the page; {how_to_get_it()}"


def _in_parts(fleet: str, settings: Settings, computed: Computed) -> Result:
    from rosprivacy.parts.fleet_in_parts import run_in_processes, run_on_spark

    if computed.engine is Engine.spark:
        return run_on_spark(fleet, settings, computed.master, computed.results)
    return run_in_processes(fleet, settings, computed.resume)


def _check(inputs: Inputs, computed: Computed, *, save_graph: bool, per_policy: bool) -> None:
    """Refuse options that make no sense beside others."""
    saved = ["--save-graph"] if save_graph else []
    both = [*saved, *(["--per-policy"] if per_policy else [])]
    if inputs.from_database:
        refuse("--from-database", "what is in the database", both)
    if inputs.fleet:
        refuse("--fleet", "what the fleet file names", both)
    engine = f"--engine {computed.engine.value}"
    if computed.engine is not Engine.memory:
        if computed.results:
            refuse("--results", "a fleet that nobody has decided about", inputs.given_options("decisions"))
        if not inputs.fleet:
            raise typer.BadParameter(f"{engine} is for fleets: give --fleet too")
    if computed.engine is not Engine.spark and (computed.master or computed.results):
        raise typer.BadParameter("--master and --results are for --engine spark")
    if computed.engine is not Engine.parts and computed.resume:
        raise typer.BadParameter("--resume is for --engine parts")
    if per_policy:
        refuse("--per-policy", "policies by themselves", [*inputs.given_options("add"), *saved])


def _tables(result: Result, folder: Path) -> dict[Path, str]:
    """The files of a folder, which is made if it is not there."""
    from rosprivacy.report.document.tables import TABLES
    from rosprivacy.report.spreadsheet import as_csv

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(str(folder), 0, reason(error), "name another folder") from None
    return {
        folder / f"{name}.csv": as_csv(TABLES[name], (row.values() for row in rows))
        for name, rows in result.tables().items()
    }


def _saved_graph(result: Result) -> str:
    from rosprivacy.ingest.policies.saved_graph import as_dict
    from rosprivacy.report.json_text import as_text

    return as_text(as_dict(result.policies, result.diagnostics, result.types))


def _each_alone(
    inputs: Inputs, settings: Settings, form: str, style: Style, output: Path | None, fail_on: tuple[FailOn, ...]
) -> int:
    from rosprivacy.cli import per_policy
    from rosprivacy.report.json_text import as_text
    from rosprivacy.systems.robot_system import answer_each

    if form not in ("text", "json", "json1"):
        raise typer.BadParameter("--per-policy writes text, json and json1")
    each = answer_each(inputs.required_policies, tuple(inputs.labels or ()), settings)
    emit(
        per_policy.texts(each, style) if form == "text" else as_text(per_policy.document(each, short=form == "json")),
        output,
    )
    codes = (exit_code(result, fail_on) for _, result in each)
    return int(per_policy.worst_of(codes, per_policy.CODES_WORST_FIRST))
