"""``rosprivacy annotations``: a label file from comments in the source code of nodes."""

from pathlib import Path
from typing import Annotated

import typer

from rosprivacy.analysis.errors import InputError
from rosprivacy.cli.exit_code import LEAK
from rosprivacy.cli.options import Ontologies, Output
from rosprivacy.cli.output import emit


def annotations(
    sources: Annotated[
        list[str], typer.Argument(metavar="SRC", help="Python and C++ source code: files, folders or globs.")
    ],
    namespace: Annotated[
        str, typer.Option(metavar="NAME", help="Of nodes that state none in the code, such as /robot.")
    ] = "/",
    check: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Compare with this label file; ends with 1 if it says something else.",
            show_default=False,
        ),
    ] = None,
    ontology: Ontologies = None,
    output: Output = None,
) -> None:
    """Write a label file from annotations in code, such as `# privacy: source Video` beside a publisher.

    Annotations that are wrong, attached to nothing or contradict each other are told, all at once.
    """
    from rosprivacy.labelling.annotating import annotated, differences
    from rosprivacy.ontology.vocabulary import load

    if check is not None and output is not None:
        raise typer.BadParameter("--check compares and writes nothing: no --output")
    vocabulary = load(ontologies=tuple(ontology or ()))
    if output is not None:
        _not_by_hand(output)
    made = annotated(sources, vocabulary, namespace)
    typer.echo(made.size, err=True)
    if check is None:
        emit(made.text, output, edited=output)
    elif lines := differences(made, check, vocabulary):
        emit("".join(f"{line}\n" for line in lines), None)
        raise typer.Exit(LEAK)


def _not_by_hand(output: Path) -> None:
    """Refuse to write over a label file that somebody wrote."""
    from rosprivacy.labelling.annotating import is_ours

    if output.exists() and not is_ours(str(output)):
        hint = "name another file; commands take several: -l labels.yaml -l annotations.yaml"
        raise InputError(str(output), 0, "is there already, and was not written by annotations", hint)
