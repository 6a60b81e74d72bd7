"""``rosprivacy bag``: what is in a recording, and whether personal data can be among it."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from rosprivacy.cli.exit_code import LEAK, UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import READ, Output
from rosprivacy.cli.output import emit, progress_of


class BagFormat(StrEnum):
    """For people, for programs, or one row a bag."""

    text = "text"
    json = "json"
    csv = "csv"


@reads_system(
    "bags, and the policies of one robot",
    without=("policies", "fleet", "from_database", "neo4j", "categories", "decisions"),
)
def bag(
    bags: Annotated[
        list[str],
        typer.Argument(metavar="BAG", help="Bags: .mcap, .db3, folders of recordings, or folders of bags."),
    ],
    inputs: Inputs,
    policy: Annotated[
        list[str] | None,
        typer.Option(
            "--policy",
            metavar="POLICY",
            show_default=False,
            help="Policies of the system that was recorded; may be repeated.",
            rich_help_panel=READ,
        ),
    ] = None,
    format: Annotated[BagFormat, typer.Option("--format", "-f", help="Of the answer.")] = BagFormat.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Say which topics are in bags, and which kinds of personal data can be among them. No message is read.

    Ends with 1 if a kind of personal data can be in a bag, with 4 if that is not known.
    """
    from rosprivacy.bags import answer_bags
    from rosprivacy.report.bags.bag_lines import bag_lines
    from rosprivacy.report.bags.bag_table import bag_table
    from rosprivacy.report.json_text import as_text

    document = answer_bags(
        bags, tuple(policy or ()), tuple(inputs.labels or ()), inputs.settings, lambda paths: progress_of(paths, "bags")
    )
    if format is BagFormat.json:
        emit(as_text(document), output)
    elif format is BagFormat.csv:
        emit(bag_table(document), output)
    else:
        emit("".join(f"{line}\n" for line in bag_lines(document)), output)
    raise typer.Exit({"personal-data": LEAK, "undetermined": UNDETERMINED}.get(document["verdict"], 0))
