"""``rosprivacy bag``: what is in a recording, and whether personal data can be among it."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.cli.exit_code import LEAK, UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.options import READ, Output
from rosprivacy.cli.output import emit, progress_of

if TYPE_CHECKING:
    from rosprivacy.bags import BagsAnswer


class BagFormat(StrEnum):
    """For people, for programs, or one row a bag."""

    text = "text"
    json = "json"
    csv = "csv"


@reads_system(
    "bags, and the policies of one robot",
    without=("policies", "fleet", "from_database", "categories", "decisions", "project", "no_project"),
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
    load: Annotated[
        bool, typer.Option("--load", help="Write the bags into Neo4j, too, in place of what was there of them.")
    ] = False,
    robot: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            show_default=False,
            help="With --load: the robot of the database that was recorded; topics are linked to its channels.",
        ),
    ] = None,
) -> None:
    """Say which topics are in bags, and which kinds of personal data can be among them. No message is read.

    Ends with 1 if a kind of personal data can be in a bag, with 4 if that is not known.
    """
    from rosprivacy.bags import answer_bags
    from rosprivacy.report.bags import bag_lines, bag_table
    from rosprivacy.report.json_text import as_text

    if not load:
        refuse(
            "without --load bag",
            "no server",
            [*inputs.given_options("neo4j"), *(["--robot"] if robot is not None else [])],
        )
    answer = answer_bags(
        bags, tuple(policy or ()), tuple(inputs.labels or ()), inputs.settings, lambda paths: progress_of(paths, "bags")
    )
    document = answer.document()
    if format is BagFormat.json:
        emit(as_text(document), output)
    elif format is BagFormat.csv:
        emit(bag_table(document), output)
    else:
        emit("".join(f"{line}\n" for line in bag_lines(document)), output)
    if load:
        _load(answer, robot or "", inputs.neo4j)
    raise typer.Exit({"personal-data": LEAK, "undetermined": UNDETERMINED}.get(document["verdict"], 0))


def _load(answer: BagsAnswer, robot: str, server: str | None) -> None:
    """Write the bags, and say so beside the answer."""
    from rosprivacy.analysis.errors import shown
    from rosprivacy.analysis.text import counted
    from rosprivacy.cli.driver import driver_of
    from rosprivacy.ingest.neo4j_graph.bag_rows import load_bags

    rows = answer.rows(robot)
    with driver_of(server) as driver:
        linked = load_bags(driver, rows, robot, answer.vocabulary)
    topics = counted(sum(len(one.topics) for one in rows), "topic")
    whose = f"{linked:,} of them linked to channels of {shown(robot)}" if robot else "linked to no robot (--robot NAME)"
    print(f"{counted(len(rows), 'bag')} with {topics} written into the database, {whose}", file=sys.stderr)
