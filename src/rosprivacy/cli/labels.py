"""``rosprivacy labels``: a first label file, its schema, and the files that are shipped."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import InputError
from rosprivacy.cli.inputs import named
from rosprivacy.cli.options import IncludeRoot, MaxBytes, NoStandard, Output, Policies, Standard
from rosprivacy.cli.output import emit, progress_of

if TYPE_CHECKING:
    from rosprivacy.settings import Settings


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
    from rosprivacy.settings import Settings

    if [init, schema, standard, infrastructure].count(True) != 1:
        raise typer.BadParameter("name one of --init, --schema, --standard, --infrastructure")
    settings = Settings(
        standard_channels=None if no_standard_channels else standard_channels,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=progress_of,
    )
    if init and output and output.is_file():
        raise InputError(str(output), 0, "is there already", "a label file is work: name another, or remove it")
    emit(_labels_text(policies, settings, init=init, schema=schema, standard=standard), output)


def _labels_text(policies: list[str] | None, settings: Settings, *, init: bool, schema: bool, standard: bool) -> str:
    from rosprivacy.assembly import read_system, standard_channels
    from rosprivacy.ingest.labels.label_file import shipped_text
    from rosprivacy.ingest.labels.label_schema import label_schema
    from rosprivacy.ingest.labels.label_template import template
    from rosprivacy.ingest.policies.flow_graph import build
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.report.document.analysis import as_text

    if schema:
        return as_text(label_schema(load().categories.values()))
    if not init:
        return shipped_text("standard" if standard else "infrastructure")
    system, _ = read_system(named(policies, settings), settings)
    graph, vocabulary = build(system), load()
    return template(graph, tuple(vocabulary.categories), standard_channels(graph, vocabulary, settings))
