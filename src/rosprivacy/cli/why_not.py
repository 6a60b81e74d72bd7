"""``rosprivacy why-not``: why data of one element does not get to another, and on whose word."""

from __future__ import annotations

from typing import Annotated

import typer

from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import QUESTION_PANEL, Output, TextOrJson, complete_category
from rosprivacy.cli.output import emit


@reads_system("policies, saved graphs or a fleet", without=("from_database", "neo4j", "decisions"))
def why_not(
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="Where data comes in: a name; of a fleet robot:name.")
    ],
    leak: Annotated[
        str, typer.Argument(metavar="LEAK", help="Where it should not get: a name; of a fleet robot:name.")
    ],
    inputs: Inputs,
    categories: Annotated[
        list[str] | None,
        typer.Option(
            "--categories",
            "-c",
            metavar="NAME",
            autocompletion=complete_category,
            show_default=False,
            help="Ask about this kind only.",
            rich_help_panel=QUESTION_PANEL,
        ),
    ] = None,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Tell why data of one element does not get to another: where its way ends, and on whose word."""
    from rosprivacy.report.document.ledger import why_not_document
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.text.taken_away import lines

    result = inputs.result(inputs.settings)
    answers = result.why_not(source, leak, *(categories or ()))
    if format is TextOrJson.json:
        emit(as_text(why_not_document(answers)), output)
    else:
        emit("".join(f"{line}\n" for line in lines(answers)), output)
