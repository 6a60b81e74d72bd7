"""The options that several commands take, and the values that they can have."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class Format(StrEnum):
    """Of the report."""

    text = "text"
    json = "json"
    turtle = "turtle"
    json_ld = "json-ld"
    sarif = "sarif"
    cnil_pia = "cnil-pia"


class View(StrEnum):
    """Rule S6."""

    declared = "declared"
    enforced = "enforced"


class PathsShown(StrEnum):
    """Which paths to list for a finding."""

    witness = "witness"
    disjoint = "disjoint"
    all = "all"


class FailOn(StrEnum):
    """What ends with an exit code other than 0: verdicts, or what is decided about findings."""

    leak = "leak"
    undetermined = "undetermined"
    never = "never"
    off = "off"
    undecided = "undecided"
    todo = "todo"
    all = "all"


class TextOrJson(StrEnum):
    """For people, or for programs."""

    text = "text"
    json = "json"


class Engine(StrEnum):
    """What carries data through a fleet."""

    memory = "memory"
    spark = "spark"


def complete_category(incomplete: str) -> list[str]:
    """Return the categories that begin so, for shell completion."""
    from rosprivacy.ontology.vocabulary import load

    return [name for name in load().categories if name.casefold().startswith(incomplete.casefold())]


Policies = Annotated[
    list[str] | None,
    typer.Argument(metavar="POLICY", help="SROS 2 policies: files, folders or globs.", show_default=False),
]
IncludeRoot = Annotated[
    Path | None,
    typer.Option(help="Folder that includes may read from; by default the policy's own.", show_default=False),
]
MaxBytes = Annotated[int, typer.Option(min=1, help="Bound on a policy with all that it includes.")]
Output = Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file instead.", show_default=False)]
Standard = Annotated[
    str,
    typer.Option("--standard-channels", metavar="FILE", help="Label file of the standard ROS channels."),
]
NoStandard = Annotated[bool, typer.Option("--no-standard-channels", help="Take no channel as mundane by itself.")]
LabelFiles = Annotated[
    list[str] | None,
    typer.Option(
        "--labels", "-l", metavar="FILE", help="Label file, YAML or JSON; may be repeated.", show_default=False
    ),
]
SixLists = Annotated[
    str, typer.Option(metavar="NAME", autocompletion=complete_category, help="What a six-list JSON is about.")
]
FleetFile = Annotated[
    str | None,
    typer.Option("--fleet", metavar="FILE", show_default=False, help="Fleet file: many robots and what they share."),
]
EngineChosen = Annotated[
    Engine, typer.Option(help="Of a fleet: in memory here, or in parts on Apache Spark (the [spark] extra).")
]
Master = Annotated[
    str | None,
    typer.Option(
        "--master",
        metavar="URL",
        show_default=False,
        help="Spark cluster, such as spark://host:7077; by default the cores of this machine.",
    ),
]
ViewChosen = Annotated[View, typer.Option(help="What nodes declare, or what DDS enforces per enclave.")]
DecisionsFile = Annotated[
    Path | None,
    typer.Option("--decisions", metavar="FILE", help="What people have decided about findings.", show_default=False),
]
Server = Annotated[
    str | None,
    typer.Option(
        "--neo4j",
        metavar="URI",
        show_default=False,
        help="Neo4j to use; by default that of NEO4J_URI, else the private one. The password stands in NEO4J_PASSWORD.",
    ),
]
Ontologies = Annotated[
    list[str] | None,
    typer.Option(
        "--ontology",
        metavar="FILE.ttl",
        show_default=False,
        help="More categories, in Turtle, beside those that come with the program; may be repeated.",
    ),
]
