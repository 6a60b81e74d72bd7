"""``rosprivacy labels``: a first label file, its schema, and the files that are shipped."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.text import counted
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.options import PRINTED
from rosprivacy.cli.output import emit


class LabelWork(NamedTuple):
    """What is done; one of these."""

    init: Annotated[bool, typer.Option("--init", help="Write a first label file for the policies.")] = False
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON Schema of label files.")] = False
    standard: Annotated[bool, typer.Option("--standard", help="Print the standard channels' file.")] = False
    infrastructure: Annotated[
        bool, typer.Option("--infrastructure", help="Print the proposal for more such channels.")
    ] = False
    update: Annotated[
        bool, typer.Option("--update", help="Add lines for what is new in the policies to the file of --labels.")
    ] = False
    next_round: Annotated[
        bool, typer.Option("--next", help="Add lines for what to review next to the file of --labels.")
    ] = False
    pin: Annotated[
        bool,
        typer.Option(
            "--pin",
            help="Keep in the label files which kinds of data reach the elements that their globs decide: what else "
            "gets there is open then; of a robot or a --fleet.",
        ),
    ] = False
    accept: Annotated[
        list[str] | None,
        typer.Option(
            metavar="WHAT",
            help="Make labels of suggestions in the file of --labels: the surest of an element, by its name "
            "(/camera=Video where there are several), or all that are certain, likely or may, with those that are "
            "surer; what takes data away only if policies are given too; may be repeated.",
            show_default=False,
        ),
    ] = None


@reads_system(
    "the policies of one robot",
    without=("from_database", "neo4j", "categories", "category", "decisions"),
)
def labels(
    inputs: Inputs,
    work: LabelWork,
    by: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Who accepts suggestions; by default the author of the file."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            metavar="FILE",
            help="Write to this file instead; - for standard output.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Make a label file or add to one, or print the schema or the files that come with the program."""
    if sum(map(bool, work)) != 1:
        hint = "name one of --init, --update, --next, --pin, --accept, --schema, --standard, --infrastructure"
        raise typer.BadParameter(hint)
    if work.pin:
        refuse("labels --pin", "what it reads, and writes into it", ["--by"] if by else [])
        _pin(inputs, output)
        return
    refuse("labels", "the policies of one robot, but with --pin", inputs.given_options("fleet"))
    if work.accept:
        _accept(inputs, work.accept, by, output)
        return
    refuse("labels", "--by with --accept only", ["--by"] if by else [])
    if work.update or work.next_round:
        _add(inputs, output, update=work.update)
        return
    refuse("labels", "label files with --update, --next, --pin and --accept only", inputs.given_options("labels"))
    if work.init:
        _begin(inputs, output)
    else:
        text = _schema(inputs) if work.schema else _shipped("standard" if work.standard else "infrastructure")
        emit(text, None if output == PRINTED else output)


def _add(inputs: Inputs, output: Path | None, *, update: bool) -> None:
    """Lines into the label file that is named, the one that people edit; remarks go to the terminal."""
    from rosprivacy.labelling.label_lines import next_lines, own_file, updated
    from rosprivacy.report.atomic import editing

    labels = tuple(inputs.labels or ())
    file = output if output and output != PRINTED else Path(own_file(labels))
    with editing(file):
        written = (updated if update else next_lines)(inputs.required_policies, labels, inputs.settings)
        for remark in written.remarks:
            typer.echo(remark, err=True)
        if written.added or output:
            emit(written.text, None if output == PRINTED else file, edited=Path(written.file))
    typer.echo(f"{file}: {counted(written.added, 'line')} added", err=True)


def _pin(inputs: Inputs, output: Path | None) -> None:
    """Pins into every label file with globs, those that need none left as they are; remarks go to the terminal."""
    from rosprivacy.labelling.pinning import pinned, pinned_in_fleet
    from rosprivacy.report.atomic import editing

    if inputs.fleet:
        files = list(pinned_in_fleet(inputs.fleet, inputs.settings))
    else:
        files = list(pinned(inputs.required_policies, tuple(inputs.labels or ()), inputs.settings))
    if output and len(files) != 1:
        raise InputError(
            "--output", 0, f"one file for the pins of {len(files)}", "leave it out, or name one label file"
        )
    for written in files:
        for remark in written.remarks:
            typer.echo(remark, err=True)
        file = output if output and output != PRINTED else Path(written.file)
        if written.added or output:
            with editing(file):
                emit(written.text, None if output == PRINTED else file, edited=Path(written.file))
        typer.echo(f"{file}: {counted(written.added, 'line')} changed", err=True)


def _accept(inputs: Inputs, accepted: list[str], by: str | None, output: Path | None) -> None:
    """Suggestions that a person accepts become labels, in the file that people edit."""
    from rosprivacy.labelling.label_lines import own_file
    from rosprivacy.labelling.suggested_lines import with_accepted
    from rosprivacy.report.atomic import editing

    labels = tuple(inputs.labels or ())
    file = output if output and output != PRINTED else Path(own_file(labels))
    with editing(file):
        written = with_accepted(labels, accepted, by, inputs.settings, tuple(inputs.policies or ()))
        for remark in written.remarks:
            typer.echo(remark, err=True)
        if written.added or output:
            emit(written.text, None if output == PRINTED else file, edited=Path(written.file))
    typer.echo(f"{file}: {counted(written.added, 'suggestion')} accepted", err=True)


def _begin(inputs: Inputs, output: Path | None) -> None:
    """A first label file where there is none, nor one that appears while the policies are read."""
    from rosprivacy.report.atomic import editing

    output = None if output == PRINTED else output
    with editing(output) if output else nullcontext():
        if output and output.is_file():
            raise InputError(str(output), 0, "is there already", "a label file is work: name another, or remove it")
        emit(*_first(inputs, output), edited=output)


def _first(inputs: Inputs, output: Path | None) -> tuple[str, Path | None, dict[Path, str | None]]:
    """A first label file; and beside it, if it goes into a file, the schema that its first line names."""
    from rosprivacy.ingest.labels.label_file import infrastructure_of
    from rosprivacy.ingest.labels.label_template import SCHEMA_FILE, template
    from rosprivacy.ingest.policies.flow_graph import build
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.systems.robot_system import read_graphs, read_system, standard_channels

    settings = inputs.settings
    vocabulary = load(ontologies=settings.ontologies)
    system, _ = read_system(inputs.required_policies, settings, read_graphs(settings))
    graph = build(system, settings.view, settings.bounds)
    known = standard_channels(graph, vocabulary, settings), infrastructure_of(graph.elements, vocabulary)
    own = sorted(set(vocabulary.categories) - set(load().categories))
    text = template(graph, *known, own, schema=output is not None)
    schema = output.parent / SCHEMA_FILE if output else None
    return text, output, {schema: _schema(inputs)} if schema and not schema.exists() else {}


def _schema(inputs: Inputs) -> str:
    from rosprivacy.ingest.labels.label_schema import label_schema
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.report.json_text import as_text

    return as_text(label_schema(load(ontologies=inputs.settings.ontologies).categories.values()))


def _shipped(name: str) -> str:
    from rosprivacy.ingest.labels.label_file import shipped_text

    return shipped_text(name)
