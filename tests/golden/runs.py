"""Calls of the command line about examples, cases, random systems, and public policies where they are at hand.

In: a folder to lay the inputs out in. Out: arguments, in an order that is always the same.
"""

from __future__ import annotations

import shutil
from itertools import pairwise
from typing import TYPE_CHECKING

from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import COSTMAP, MEMORY, TURTLEBOT3, TYPES
from tests.helpers.written_fleets import fleet

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    Arguments = tuple[str, ...]

LANGUAGES = ("en", "de", "fr")
LEGAL = ("article30", "article30-processors", "notice", "works-council", "edpb-dpia")  # views of the register
FLEETS = 8  # random fleets; of each, one model is a robot alone
HERE = ("examples", "tests/cases")

ROBOTS = {
    "care-home": ("examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml"),
    "factory-1": ("examples/factory/before.policy.xml", "-l", "examples/factory/run1.labels.yaml"),
    "factory-2": ("examples/factory/before.policy.xml", "-l", "examples/factory/run2.labels.yaml"),
    "factory-5": ("examples/factory/after.policy.xml", "-l", "examples/factory/run5.labels.yaml"),
    "annotated": ("examples/annotated/robot.policy.xml", "-l", "examples/annotated/robot.labels.yaml"),
    "paper": ("examples/paper/servers.policy.xml", "-l", "examples/paper/servers.labels.yaml"),
    "misspelt": ("examples/paper/servers.policy.xml", "-l", "examples/paper/misspelt.labels.yaml"),
    "kiosk": ("tests/cases/queries/systems/kiosk.policy.xml", "-l", "tests/cases/queries/systems/kiosk.labels.yaml"),
    "unprotected": (
        "tests/cases/unprotected/keystore", "--allow-unsigned", "-l", "tests/cases/unprotected/labels.yaml",
    ),
    "decided": (
        "examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml",
        "--decisions", "tests/cases/earlier/care-home/decisions.yaml",
    ),
}  # fmt: skip
TURTLEBOT3_LABELLED = (
    f"corpus/{TURTLEBOT3.removeprefix('policies/')}", "-l", "random/turtlebot3.labels.yaml",
    "-l", "random/types.labels.yaml",
)  # fmt: skip
EXAMPLE_FLEET = ("--fleet", "examples/fleet/fleet.yaml")


def lay_out(folder: Path, corpus: Path | None) -> None:
    """Copy the inputs into a folder, so that no answer depends on where the repository lies."""
    for name in HERE:
        shutil.copytree(ROOT / name, folder / name)
    if corpus:
        shutil.copytree(corpus / "policies", folder / "corpus")
    (folder / "random").mkdir()
    (folder / "random" / "turtlebot3.labels.yaml").write_text(COSTMAP + MEMORY, "utf-8")
    (folder / "random" / "types.labels.yaml").write_text(TYPES, "utf-8")
    for number in range(FLEETS):
        fleet(number, folder / "random", apart=number % 2 == 1)


def calls(folder: Path) -> Iterator[Arguments]:
    """Yield the calls about what ``lay_out`` laid out."""
    for name, robot in ROBOTS.items():
        yield from shortly(robot) if name == "misspelt" else of_one_robot(robot)
    yield from of_a_fleet(EXAMPLE_FLEET, every=True)
    yield from of_single_commands()
    for number in range(FLEETS):
        yield from of_a_fleet(("--fleet", f"random/f{number:02}.fleet.yaml"), every=False)
        yield from shortly((f"random/f{number:02}x.xml", "-l", f"random/f{number:02}x.yaml"))
    if (folder / "corpus").exists():
        yield from shortly(TURTLEBOT3_LABELLED)
        yield ("report", *TURTLEBOT3_LABELLED, "-o", "out")
    for policy in sorted((folder / "corpus").rglob("*.xml")):
        if b"<policy" in policy.read_bytes():
            yield from of_a_policy(str(policy.relative_to(folder)))


def of_one_robot(robot: Arguments) -> Iterator[Arguments]:
    yield from shortly(robot)
    for form in ("turtle", "json-ld"):
        yield ("analyze", *robot, "-f", form)
        yield ("analyze", *robot, "-f", form, "--redact")
    for language in LANGUAGES:
        yield ("analyze", *robot, "--lang", language, "-v")
        yield ("analyze", *robot, "--lang", language, "--view", "both")
        yield ("analyze", *robot, "-f", "cnil-pia", "--lang", language)
        for form in ("html", "markdown", "docx", *LEGAL):
            yield ("report", *robot, "-f", form, "--lang", language, "-o", "out")
    for form in ("html", "markdown"):
        yield ("report", *robot, "-f", form, "--redact", "-o", "out")
    yield ("analyze", *robot, "-f", "json1", "--standard-channels", "none", "--type-limits", "none")
    yield ("analyze", *robot, "-f", "json1", "--article9", "--paths", "all")
    undecided = robot[:-2] if "--decisions" in robot else robot
    for form in ("dot", "svg", "graphml", "mermaid"):
        yield ("graph", *undecided, "-f", form, "-o", "out")
    yield ("graph", *undecided, "--show", "ros", "-f", "dot", "-o", "out")
    yield ("mitigate", *robot)
    yield ("mitigate", *robot, "-f", "json", "--view", "enforced")
    yield ("suggest", *undecided)
    yield ("suggest", *undecided, "-f", "json")
    yield ("try", *undecided)
    yield ("labels", *undecided, "--update", "-o", "-")
    yield ("lint", robot[0])
    yield ("lint", robot[0], "-f", "json")


def shortly(robot: Arguments) -> Iterator[Arguments]:
    """Yield the calls that answer about one robot, without those that only say the answer in other words."""
    yield ("analyze", *robot)
    yield ("analyze", *robot, "-q")
    for form in ("json1", "sarif"):
        yield ("analyze", *robot, "-f", form)
    yield ("analyze", *robot, "-f", "json1", "--view", "both")
    yield ("report", *robot, "-f", "markdown", "-o", "out")


def of_a_fleet(given: Arguments, *, every: bool) -> Iterator[Arguments]:
    yield from shortly(given)
    yield ("fleet", given[1])
    yield ("analyze", *given, "-f", "json1", "--hangs-on")
    if every:
        yield ("analyze", *given, "-v", "--decisions", "tests/cases/earlier/fleet/decisions.yaml")
        for language in LANGUAGES:
            for form in ("html", "docx", *LEGAL):
                yield ("report", *given, "-f", form, "--lang", language, "-o", "out")
            yield ("analyze", *given, "-f", "cnil-pia", "--lang", language)
        for form in ("turtle", "json-ld"):
            yield ("analyze", *given, "-f", form)
        yield ("graph", *given, "-f", "dot", "-o", "out")
        yield ("suggest", *given)


def of_a_policy(policy: str) -> Iterator[Arguments]:
    yield ("analyze", policy)
    yield ("analyze", policy, "-f", "json1")
    yield ("lint", policy)
    yield ("graph", policy, "-f", "dot", "-o", "out")
    yield ("labels", policy, "--init", "-o", "-")
    yield ("suggest", policy)
    yield ("try", policy)


def of_single_commands() -> Iterator[Arguments]:
    """Yield what is asked once, or of two inputs."""
    yield ("analyze", *ROBOTS["care-home"], "-f", "json")
    yield ("analyze", *ROBOTS["care-home"], "-f", "json", "--hangs-on", "--view", "both")
    yield ("analyze", *EXAMPLE_FLEET, "-f", "json")
    care, labels = ROBOTS["care-home"][0], ROBOTS["care-home"][2]
    earlier = "tests/cases/earlier/care-home"
    yield ("--help",)
    yield ("categories",)
    yield ("categories", "FaceTemplate")
    yield ("law",)
    yield ("labels", "--schema")
    yield ("labels", "--standard")
    yield ("labels", "--infrastructure")
    yield ("annotations", "examples/annotated")
    yield ("check", "examples/factory/before.policy.xml", "tests/cases/unprotected/keystore", "--allow-unsigned")
    yield ("bag", "examples/care-home/recording", "--policy", care, "-l", labels)
    yield ("bag", "examples/care-home/recording", "-f", "json", "--policy", care, "-l", labels)
    for source, leak in (("/camera", "/uplink"), ("/microphone", "/uplink"), ("/camera", "/nowhere")):
        for form in ("text", "json"):
            yield ("why-not", source, leak, care, "-l", labels, "-f", form)
    for finding in ("9f25", "329b"):
        yield ("show", finding, care, "-l", labels)
        yield ("show", finding, care, "-l", labels, "-f", "json", "--decisions", f"{earlier}/decisions.yaml")
    yield ("analyze", "--add", f"{earlier}/graph.json", "-l", labels, "-f", "json1")
    yield ("analyze", care, "-l", labels, "--save-graph", "out")
    yield ("report", care, "-l", labels, "--since", f"{earlier}/analysis.json", "-f", "markdown", "-o", "out")
    for form in ("text", "json", "markdown"):
        yield ("diff", f"{earlier}/analysis.json", care, "-l", labels, "-f", form)
        yield ("diff", "examples/factory/before.policy.xml", "examples/factory/after.policy.xml", "-f", form)
    for one, other in pairwise(name for name in ROBOTS if name.startswith("factory")):
        yield ("diff", ROBOTS[one][0], ROBOTS[other][0], "--old-labels", ROBOTS[one][2], "-l", ROBOTS[other][2])
