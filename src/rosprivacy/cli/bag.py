"""``rosprivacy bag``: what is in a recording, and whether personal data can be among it."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.exit_code import LEAK, UNDETERMINED
from rosprivacy.cli.inputs import Inputs, reads_system, refuse
from rosprivacy.cli.options import READ, Output, complete_category
from rosprivacy.cli.output import emit, progress_of

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.bags import BagsAnswer


class BagFormat(StrEnum):
    """For people, for programs, or one row a bag."""

    text = "text"
    json = "json"
    csv = "csv"


Without = Annotated[
    list[str] | None,
    typer.Option(
        "--without",
        metavar="KIND|all",
        autocompletion=complete_category,
        show_default=False,
        help="Write, to the file of --output, a copy of the bag with the topics that are known not to carry this "
        "kind of data; may be repeated.",
    ),
]


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
    without: Without = None,
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

    Ends with 1 if a kind of personal data can be in a bag, with 4 if that is not known. With --without it writes a copy
    that may be shared instead, and ends with 4 if no topic is left.
    """
    if without:
        refused = [*(["--load"] if load else []), *(["--robot"] if robot is not None else [])]
        _share(bags, without, inputs, tuple(policy or ()), format, output, refused)
        return
    from rosprivacy.bags import answer_bags

    if not load:
        of_server = [*inputs.given_options("neo4j"), *(["--robot"] if robot is not None else [])]
        refuse("without --load bag", "no server", of_server)
    answer = answer_bags(
        bags, tuple(policy or ()), tuple(inputs.labels or ()), inputs.settings, lambda paths: progress_of(paths, "bags")
    )
    verdict = _tell(answer, format, output)
    if load:
        _load(answer, robot or "", inputs.neo4j)
    raise typer.Exit({"personal-data": LEAK, "undetermined": UNDETERMINED}.get(verdict, 0))


def _tell(answer: BagsAnswer, form: BagFormat, output: Path | None) -> str:
    """Give the answer; return its verdict."""
    from rosprivacy.report.bags import bag_lines, bag_table
    from rosprivacy.report.json_text import as_text

    document = answer.document()
    if form is BagFormat.json:
        emit(as_text(document), output)
    elif form is BagFormat.csv:
        emit(bag_table(document), output)
    else:
        emit("".join(f"{line}\n" for line in bag_lines(document)), output)
    return document["verdict"]


def _share(
    bags: list[str],
    without: list[str],
    inputs: Inputs,
    policies: tuple[str, ...],
    form: BagFormat,
    output: Path | None,
    refused: list[str],
) -> None:
    """Write the copy of a bag, and say what is in it and what is not."""
    from rosprivacy.bag_copy import share_bag
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.shared_bag import WIDTH, shared_bag_lines
    from rosprivacy.terminal_width import terminal_width

    refused += inputs.given_options("neo4j")
    refused += ["--format csv"] if form is BagFormat.csv else []
    refuse("bag --without", "one bag, and writes one MCAP file", refused)
    if len(bags) != 1:
        raise typer.BadParameter("--without copies one bag; name one", param_hint="BAG")
    if output is None:
        raise typer.BadParameter("--without writes a file; name it with -o, such as -o shared.mcap", param_hint="-o")
    answer = share_bag(bags[0], without, output, policies, tuple(inputs.labels or ()), inputs.settings)
    document = answer.document()
    if form is BagFormat.json:
        emit(as_text(document), None)
    else:
        lines = shared_bag_lines(document, terminal_width() or WIDTH)
        emit("".join(f"{line}\n" for line in lines), None)
    raise typer.Exit(0 if answer.shared.copy else UNDETERMINED)


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
