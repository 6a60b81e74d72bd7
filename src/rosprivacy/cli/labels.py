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
    pin_code: Annotated[
        bool,
        typer.Option(
            "--pin-code",
            help="Keep in the label files which version of the code their nodes have, in a checkout or what a launch "
            "file starts: when it changes, such a node is open again.",
        ),
    ] = False
    accept: Annotated[
        list[str] | None,
        typer.Option(
            metavar="WHAT",
            help="Make labels of suggestions in the file of --labels: the surest of an element, by its name "
            "(/camera=Video where there are several), or all that are certain, likely or may, with those that are "
            "surer; what takes data away only if policies are given too; may be repeated. by-type, alone: a line "
            "'only: by-type', with its pin, for each open channel at which these close no way.",
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
        hint = (
            "name one of --init, --update, --next, --pin, --pin-code, --accept, --schema, --standard, --infrastructure"
        )
        raise typer.BadParameter(hint)
    if work.pin or work.pin_code:
        name = "labels --pin" if work.pin else "labels --pin-code"
        refuse(name, "what it reads, and writes into it", ["--by"] if by else [])
        if work.pin_code:
            refuse(name, "the code of one robot", inputs.given_options("fleet"))
        _pin(inputs, output, of_code=work.pin_code)
        return
    refuse("labels", "the policies of one robot, but with --pin", inputs.given_options("fleet"))
    if work.accept:
        _accept(inputs, work.accept, by, output)
        return
    refuse("labels", "--by with --accept only", ["--by"] if by else [])
    if work.update or work.next_round:
        _add(inputs, output, update=work.update)
        return
    refuse(
        "labels",
        "label files with --update, --next, --pin, --pin-code and --accept only",
        inputs.given_options("labels"),
    )
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


def _pin(inputs: Inputs, output: Path | None, *, of_code: bool) -> None:
    """Pins into every label file, those that need none left as they are; remarks go to the terminal."""
    from rosprivacy.labelling.code_pinning import pinned_code
    from rosprivacy.labelling.pinning import pinned, pinned_in_fleet
    from rosprivacy.report.atomic import editing

    if inputs.fleet:
        files = list(pinned_in_fleet(inputs.fleet, inputs.settings))
    elif of_code:
        files = list(pinned_code(inputs.required_policies, tuple(inputs.labels or ()), inputs.settings))
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
    from rosprivacy.labelling.by_type_lines import WORD, with_lines_by_type
    from rosprivacy.labelling.label_lines import own_file
    from rosprivacy.labelling.suggested_lines import with_accepted
    from rosprivacy.report.atomic import editing

    labels, policies = tuple(inputs.labels or ()), tuple(inputs.policies or ())
    if WORD in accepted:
        refuse("labels --accept by-type", "nothing else at once", sorted({*accepted} - {WORD}))
    file = output if output and output != PRINTED else Path(own_file(labels))
    with editing(file):
        if WORD in accepted:
            written = with_lines_by_type(policies, labels, by, inputs.settings)
        else:
            written = with_accepted(labels, accepted, by, inputs.settings, policies)
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
