"""``rosprivacy suggest``: what elements could be labelled as, each with its reasons."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.text import counted
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Output, TextOrJson
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.suggesting import Suggested


@reads_system(
    "the policies of one robot, and label files",
    without=("fleet", "from_database", "neo4j", "no_type_limits", "categories", "decisions"),
)
def suggest(
    inputs: Inputs,
    rules: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE",
            help="More rules about names, in the format of ontology/names.yaml; may be repeated.",
            show_default=False,
        ),
    ] = None,
    packages: Annotated[
        list[str] | None,
        typer.Option(
            metavar="FILE|DIR|ament",
            help="More packages, in the format of ontology/packages; 'ament' for those that installed packages ship; "
            "may be repeated.",
            show_default=False,
        ),
    ] = None,
    source: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SRC",
            help="Python and C++ source code of nodes, whose literal names and types are evidence; may be repeated.",
            show_default=False,
        ),
    ] = None,
    into: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Write the suggestions into this label file, as comments that 'labels --accept' reads.",
            show_default=False,
        ),
    ] = None,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Say what nodes and channels could be labelled as, with reasons: questions, in the order of review.

    Nothing is applied. 'rosprivacy labels --accept' makes labels of those that a person accepts.
    """
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.suggest.suggestion_document import suggestions_document
    from rosprivacy.report.suggest.suggestion_lines import suggestion_lines
    from rosprivacy.suggesting import suggest_labels

    def told() -> Suggested:
        labels = _with_own(tuple(inputs.labels or ()), into)
        return suggest_labels(inputs.named, labels, inputs.settings, rules or (), packages or (), source or ())

    if into:
        _write(into, told)
        return
    found = told()
    document = suggestions_document(found.proposals, found.open, found.by_hand, found.result, found.rules)
    lines = "".join(f"{line}\n" for line in suggestion_lines(document))
    emit(as_text(document) if format is TextOrJson.json else lines, output)


def _with_own(labels: tuple[str, ...], into: Path | None) -> tuple[str, ...]:
    """The label files, with the one that is written into: what it says already is not asked again."""
    if into is None or not into.is_file() or any(Path(one).exists() and into.samefile(one) for one in labels):
        return labels
    return (*labels, str(into))


def _write(file: Path, told: Callable[[], Suggested]) -> None:
    """The suggestions into a label file, in place of those that an earlier run has written there."""
    from rosprivacy.report.editing import editing
    from rosprivacy.suggested_lines import with_suggestions

    with editing(file):
        written = with_suggestions(str(file), told())
        emit(written.text, file, edited=file)
    typer.echo(f"{file}: {counted(written.added, 'suggestion')}, as comments", err=True)
