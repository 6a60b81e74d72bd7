"""The command line: options in, ``assembly`` called, a report out, an exit code.

Exit codes: 0 no leak found, 1 leak, 2 bad input or usage, 3 database unreachable, 4 undetermined (only with
``--fail-on undetermined``). Heavy imports stand in the commands, so that ``--version`` and completion are quick.
"""

from __future__ import annotations

import os
import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import rosprivacy
from rosprivacy.analysis.errors import InputError, RosPrivacyError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.assembly import Result, Settings

SIGPIPE = 13  # the module signal lacks it on Windows

app = typer.Typer(
    name="rosprivacy",
    help="Where personal data can go in a ROS 2 system, per kind of data.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Format(StrEnum):
    """Of the report."""

    text = "text"
    json = "json"


class View(StrEnum):
    """Rule S6."""

    declared = "declared"
    enforced = "enforced"


class PathsShown(StrEnum):
    """Which paths to list for a finding."""

    witness = "witness"
    disjoint = "disjoint"
    all = "all"


class FailOn(StrEnum):
    """Which verdicts end with an exit code other than 0."""

    leak = "leak"
    undetermined = "undetermined"
    never = "never"


def complete_category(incomplete: str) -> list[str]:
    """Return the categories that begin so, for shell completion."""
    from rosprivacy.ontology.vocabulary import load

    return [name for name in load().categories if name.casefold().startswith(incomplete.casefold())]


Policies = Annotated[
    list[str] | None,
    typer.Argument(metavar="POLICY", help="SROS 2 policies: files, folders or globs.", show_default=False),
]
IncludeRoot = Annotated[
    Path | None,
    typer.Option(help="Folder that includes may read from; by default the policy's own.", show_default=False),
]
MaxBytes = Annotated[int, typer.Option(min=1, help="Bound on a policy with all that it includes.")]
Output = Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file instead.", show_default=False)]
Standard = Annotated[
    str,
    typer.Option("--standard-channels", metavar="FILE", help="Label file of the standard ROS channels."),
]
NoStandard = Annotated[bool, typer.Option("--no-standard-channels", help="Take no channel as mundane by itself.")]


@app.callback(invoke_without_command=True)
def root(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Where personal data can go in a ROS 2 system, per kind of data."""
    if version:
        print(f"rosprivacy {rosprivacy.__version__}")
        raise typer.Exit


@app.command()
def analyze(
    policies: Policies = None,
    labels: Annotated[
        list[str] | None,
        typer.Option(
            "--labels", "-l", metavar="FILE", help="Label file, YAML or JSON; may be repeated.", show_default=False
        ),
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
            help="Answer for this category and narrower ones only; may be repeated.",
        ),
    ] = None,
    category: Annotated[
        str, typer.Option(metavar="NAME", autocompletion=complete_category, help="What a six-list JSON is about.")
    ] = "PersonalData",
    view: Annotated[View, typer.Option(help="What nodes declare, or what DDS enforces per enclave.")] = View.declared,
    paths: Annotated[PathsShown, typer.Option(help="Ways to list for each finding.")] = PathsShown.witness,
    max_paths: Annotated[int, typer.Option(min=1, help="Bound on the listed ways of a finding.")] = 100,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    fail_on: Annotated[FailOn, typer.Option(help="Exit with 1 on a leak, also with 4 if undetermined.")] = FailOn.leak,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the verdict only.")] = False,
    verbose: Annotated[bool, typer.Option("--verbose", "-v", help="Print every open element and notice.")] = False,
) -> None:
    """Find where each kind of personal data can get from its sources, and whether it reaches a leak."""
    from rosprivacy.assembly import Settings, run

    settings = Settings(
        add=tuple(add or ()),
        view=view.value,
        categories=tuple(categories or ()),
        category=category,
        standard_channels=None if no_standard_channels else standard_channels,
        paths=paths.value,
        max_paths=max_paths,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=_progress,
    )
    result = run(_named(policies, settings), tuple(labels or ()), settings)
    texts = {}
    if save_graph:
        from rosprivacy.ingest.saved import as_dict
        from rosprivacy.report.document import as_text

        texts[save_graph] = as_text(as_dict(result.policies))
    _emit(_report(result, format, colour=output is None, quiet=quiet, verbose=verbose), output, texts)
    raise typer.Exit(_exit_code(str(result.analysis.verdict), fail_on))


@app.command()
def labels(
    policies: Policies = None,
    init: Annotated[bool, typer.Option("--init", help="Write a first label file for the policies.")] = False,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON Schema of label files.")] = False,
    standard: Annotated[bool, typer.Option("--standard", help="Print the standard channels' file.")] = False,
    infrastructure: Annotated[
        bool, typer.Option("--infrastructure", help="Print the proposal for more such channels.")
    ] = False,
    output: Output = None,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
) -> None:
    """Make a first label file, or print the schema or the files that come with the program."""
    from rosprivacy.assembly import Settings

    if [init, schema, standard, infrastructure].count(True) != 1:
        raise typer.BadParameter("name one of --init, --schema, --standard, --infrastructure")
    settings = Settings(
        standard_channels=None if no_standard_channels else standard_channels,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=_progress,
    )
    if init and output and output.is_file():
        raise InputError(str(output), 0, "is there already", "a label file is work: name another, or remove it")
    _emit(_labels_text(policies, settings, init=init, schema=schema, standard=standard), output)


def _labels_text(policies: list[str] | None, settings: Settings, *, init: bool, schema: bool, standard: bool) -> str:
    from rosprivacy.assembly import read_system, standard_channels
    from rosprivacy.ingest.graph import build
    from rosprivacy.ingest.labels import shipped_text
    from rosprivacy.ingest.labelschema import label_schema
    from rosprivacy.ingest.template import template
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.report.document import as_text

    if schema:
        return as_text(label_schema(load().categories.values()))
    if not init:
        return shipped_text("standard" if standard else "infrastructure")
    system, _ = read_system(_named(policies, settings), settings)
    graph, vocabulary = build(system), load()
    return template(graph, tuple(vocabulary.categories), standard_channels(graph, vocabulary, settings))


def _named(policies: list[str] | None, settings: Settings) -> tuple[str, ...]:
    if not policies and not settings.add:
        raise typer.BadParameter("name at least one policy: a file, a folder or a glob", param_hint="POLICY")
    return tuple(policies or ())


def _report(result: Result, form: Format, *, colour: bool, quiet: bool, verbose: bool) -> str:
    from rosprivacy.report.document import as_text

    if form is Format.json:
        return as_text(result.document())
    from io import StringIO

    from rich.console import Console

    from rosprivacy.report.terminal import print_report

    text = StringIO()
    console = Console(file=text, force_terminal=colour and Console().is_terminal, highlight=False, emoji=False)
    print_report(console, result.document(), verbose=verbose, quiet=quiet)
    return text.getvalue()


def _exit_code(verdict: str, fail_on: FailOn) -> int:
    if verdict == "leak" and fail_on is not FailOn.never:
        return 1
    return 4 if verdict == "undetermined" and fail_on is FailOn.undetermined else 0


def _emit(text: str, output: Path | None, others: Mapping[Path, str] | None = None) -> None:
    """Write the text to a file or to standard output, and other files with it."""
    texts = {**(others or {}), **({output: text} if output else {})}
    if texts:
        from rosprivacy.report.atomic import write_texts

        write_texts(texts)
    if output:
        return
    if sys.stdout is None:  # `>&-`
        raise InputError("standard output", 0, "is closed", "open it, or name a file with --output")
    try:
        sys.stdout.buffer.write(text.encode(_encoding(text), "backslashreplace"))
        sys.stdout.flush()
    except BrokenPipeError:  # `| head`: end as a program does that knows nothing of pipes, not with a verdict
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(128 + SIGPIPE)
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        hint = "free space, or write elsewhere"
        raise InputError("standard output", 0, f"cannot be written: {error.strerror}", hint) from None


def _encoding(text: str) -> str:
    """JSON is UTF-8 wherever it goes; other text is what the terminal understands."""
    return "utf-8" if text.startswith("{") else sys.stdout.encoding


def _progress(files: Sequence[str]) -> Iterable[str]:
    """Show a bar on a terminal when there is much to read."""
    many = 20
    if len(files) < many or not sys.stderr.isatty():
        return files
    from rich.console import Console
    from rich.progress import track

    return track(files, description="Reading policies", console=Console(stderr=True), transient=True)


def main() -> None:
    """Run the command line; a problem that we raise is one line each on standard error, never a traceback."""
    try:
        app()
    except RosPrivacyError as error:
        print(error, file=sys.stderr)
        sys.exit(error.exit_code)
