"""The options that several commands take, and the values that they can have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rosprivacy.analysis.bounds import COUNTED
from rosprivacy.analysis.modes import View
from rosprivacy.analysis.python_311 import StrEnum


class TextOrJson(StrEnum):
    """For people, or for programs."""

    text = "text"
    json = "json"


class ViewOrBoth(StrEnum):
    """What nodes declare, what DDS enforces per enclave, or the first with what the second adds."""

    declared = "declared"
    enforced = "enforced"
    both = "both"


class Language(StrEnum):
    """Of names and texts."""

    en = "en"
    de = "de"
    fr = "fr"


class Engine(StrEnum):
    """What carries data through a fleet."""

    memory = "memory"
    parts = "parts"
    spark = "spark"


def complete_category(incomplete: str) -> list[str]:
    """Return the categories that begin so, for shell completion."""
    from rosprivacy.ontology.vocabulary import load

    return [name for name in load().categories if name.casefold().startswith(incomplete.casefold())]


READ = "What is read"  # panels of help
QUESTION_PANEL = "What is asked"

Policies = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="POLICY",
        help="SROS 2 policies: files, folders or globs; keystores; permissions and governance; Zenoh files.",
        show_default=False,
    ),
]
LabelFiles = Annotated[
    list[str] | None,
    typer.Option(
        "--labels",
        "-l",
        metavar="FILE",
        help="Label file, YAML or JSON; may be repeated.",
        show_default=False,
        rich_help_panel=READ,
    ),
]
FleetFile = Annotated[
    str | None,
    typer.Option(
        "--fleet",
        metavar="FILE",
        show_default=False,
        help="Fleet file: many robots and what they share.",
        rich_help_panel=READ,
    ),
]
FromDatabase = Annotated[
    bool,
    typer.Option(
        "--from-database",
        help="Read what is in Neo4j; the answer is written back there (suggest writes nothing).",
        rich_help_panel=READ,
    ),
]
Server = Annotated[
    str | None,
    typer.Option(
        "--neo4j",
        metavar="URI",
        show_default=False,
        help="Neo4j to use; by default that of NEO4J_URI, else the private one. The password stands in NEO4J_PASSWORD.",
        rich_help_panel=READ,
    ),
]
SavedGraphs = Annotated[
    list[str] | None,
    typer.Option(
        "--add",
        metavar="GRAPH.json",
        help="Add to a graph saved before; may be repeated.",
        show_default=False,
        rich_help_panel=READ,
    ),
]
Ontologies = Annotated[
    list[str] | None,
    typer.Option(
        "--ontology",
        metavar="FILE.ttl",
        show_default=False,
        help="More categories, in Turtle, beside those that come with the program; may be repeated.",
        rich_help_panel=READ,
    ),
]
Standard = Annotated[
    str,
    typer.Option(
        "--standard-channels",
        metavar="FILE|none",
        help="Label file of the standard ROS channels; none: take no channel as mundane by itself.",
        rich_help_panel=READ,
    ),
]
TypesFiles = Annotated[
    list[str] | None,
    typer.Option(
        "--types",
        metavar="FILE",
        show_default=False,
        help="Message types that were observed, as observe writes them; may be repeated.",
        rich_help_panel=READ,
    ),
]
TypeLimitsFile = Annotated[
    str,
    typer.Option(
        "--type-limits",
        metavar="FILE|none",
        help="Table of what message types cannot carry, and what they suggest; none: each can carry everything.",
        rich_help_panel=READ,
    ),
]
Domain = Annotated[
    int | None,
    typer.Option(
        min=0,
        metavar="N",
        show_default=False,
        help="DDS domain of the robot, for permissions with rules for several.",
        rich_help_panel=READ,
    ),
]
AllowUnsigned = Annotated[
    bool,
    typer.Option(
        "--allow-unsigned",
        help="Read permissions and governance that are not signed by their CA; the report says so.",
        rich_help_panel=READ,
    ),
]
PermissionsCA = Annotated[
    list[str] | None,
    typer.Option(
        "--permissions-ca",
        metavar="FILE|SHA256",
        show_default=False,
        help="The CA that has to have signed all that is read: its certificate or its fingerprint; may be repeated.",
        rich_help_panel=READ,
    ),
]
IncludeRoot = Annotated[
    Path | None,
    typer.Option(
        metavar="DIR",
        help="Folder that policies and fleet files may read from; by default the file's own.",
        show_default=False,
        rich_help_panel=READ,
    ),
]
ProjectFile = Annotated[
    Path | None,
    typer.Option(
        "--project",
        metavar="FILE",
        show_default=False,
        help="Project file, which names what is not named here; by default rosprivacy.toml, or "
        r"\[tool.rosprivacy] of pyproject.toml, of the nearest folder upwards.",
        rich_help_panel=READ,
    ),
]
NoProject = Annotated[
    bool, typer.Option("--no-project", help="Take nothing from a project file.", rich_help_panel=READ)
]
BoundsRaised = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME=N",
        show_default=False,
        help=f"A bound on what is read or made; may be repeated. Names: {', '.join(COUNTED)}.",
        rich_help_panel=READ,
    ),
]
Categories = Annotated[
    list[str] | None,
    typer.Option(
        "--categories",
        "-c",
        metavar="NAME",
        autocompletion=complete_category,
        show_default=False,
        help="Answer for this category, narrower, broader and overlapping ones only; may be repeated.",
        rich_help_panel=QUESTION_PANEL,
    ),
]
SixLists = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        autocompletion=complete_category,
        help="Which kind of data a six-list JSON is about; of no effect on other files.",
        rich_help_panel=READ,
    ),
]
ViewChosen = Annotated[
    View, typer.Option(help="What nodes declare, or what DDS enforces per enclave.", rich_help_panel=QUESTION_PANEL)
]
ViewOrBothChosen = Annotated[
    ViewOrBoth,
    typer.Option(
        help="What nodes declare, or what DDS enforces per enclave; both: the first, and what the second adds.",
        rich_help_panel=QUESTION_PANEL,
    ),
]
HangsOn = Annotated[
    bool,
    typer.Option(
        "--hangs-on",
        help="Of a fleet too: work out what the answer hangs on, statement by statement. Of one robot it always is.",
        rich_help_panel=QUESTION_PANEL,
    ),
]
DecisionsFile = Annotated[
    Path | None,
    typer.Option(
        "--decisions",
        metavar="FILE",
        help="What people have decided about findings.",
        show_default=False,
        rich_help_panel=QUESTION_PANEL,
    ),
]
NOT_USED = "none"  # as a name of a shipped file: that it is not used
PRINTED = Path("-")  # as a name of an output: standard output


def _but_printed(output: Path | None) -> Path | None:
    return None if output == PRINTED else output


Output = Annotated[
    Path | None,
    typer.Option(
        "--output",
        "-o",
        metavar="FILE",
        help="Write to this file instead; - for standard output.",
        show_default=False,
        callback=_but_printed,
    ),
]
