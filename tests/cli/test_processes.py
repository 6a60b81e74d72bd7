"""What tests see of a command that they call in this process is what a process gives, for each command and ending.

Hundreds of tests call commands in this process (``cli``), since a process takes a second. Here each command runs both
ways, for each exit code that it ends with: bytes and codes are equal.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
import typer.main

from rosprivacy.cli.app import program
from rosprivacy.cli.exit_code import OWN_ERROR
from tests.helpers.command import run
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from _pytest.mark.structures import ParameterSet

    from tests.helpers.command import Cli

pytestmark = pytest.mark.slow

NOWHERE = "bolt://127.0.0.1:1"
BEFORE = "examples/factory/before.policy.xml -l examples/factory/run2.labels.yaml"
AFTER = "examples/factory/after.policy.xml -l examples/factory/run5.labels.yaml"
ENDINGS = {
    "--version": 0,
    "--help": 0,
    "--nope": 2,
    f"analyze {AFTER}": 0,
    f"analyze {BEFORE}": 1,
    f"analyze {BEFORE} --format json": 1,
    f"analyze {BEFORE} --format sarif": 1,
    "analyze examples/factory/nope.xml": 2,
    "analyze --nope": 2,
    "analyze --from-database": 3,
    "analyze examples/factory/before.policy.xml": 4,
    "analyze --fleet examples/fleet/fleet.yaml": 1,
    f"show nope {BEFORE}": 2,
    f"show dc57 {BEFORE}": 0,
    f"why-not /robot_camera /archive_server {BEFORE}": 0,
    "why-not /a /b examples/factory/nope.xml": 2,
    "diff examples/care-home/care-home.policy.xml examples/care-home/care-home.policy.xml": 0,
    f"diff {BEFORE}": 2,
    "diff examples/scan_robot --base nowhere": 2,
    "bag examples/care-home/recording -l examples/care-home/care-home.labels.yaml": 1,
    "bag examples/care-home/nope.mcap": 2,
    "bag examples/care-home/recording --without Video -o nope.mcap": 2,  # an answer would write a file
    "lint examples/factory/before.policy.xml": 0,
    "lint examples/factory/nope.xml": 2,
    "check examples/factory/before.policy.xml examples/factory/before.policy.xml": 0,
    "check examples/factory/before.policy.xml examples/factory/after.policy.xml": 1,
    "check examples/factory/before.policy.xml nope": 2,
    "scan examples/scan_robot": 4,
    "scan examples/factory/before.policy.xml": 2,
    "scan nope.nodl.yaml": 2,
    "check examples/scan_robot examples/scan_robot": 4,
    "observe --rosgraph nope.yaml": 2,
    "observe --text nope.txt": 2,  # an answer would name the time
    f"report {BEFORE} -f markdown --lang de": 0,
    f"report {BEFORE} -f notice --lang fr": 0,
    f"report {BEFORE} -f article30-processors --lang de": 0,
    f"report {BEFORE} -f notice --since old.json": 2,
    "report examples/factory/nope.xml": 2,
    f"graph {BEFORE} --format mermaid": 0,
    f"graph {BEFORE} --format nope": 2,
    "labels --init examples/factory/before.policy.xml": 0,
    f"labels --pin-code {BEFORE}": 2,  # an answer would write into the file
    "try examples/factory/before.policy.xml": 4,
    "try examples/factory/nope.xml": 2,
    "init --from-try examples/factory/nope.xml": 2,  # an answer would write files
    "help words": 0,
    "help wrods": 2,
    "suggest examples/factory/before.policy.xml": 0,
    "suggest examples/factory/nope.xml": 2,
    "labels --init examples/factory/nope.xml": 2,
    "explore examples/factory/nope.xml": 2,  # an answer is a page, and stays
    "annotations examples/annotated": 0,
    "annotations examples/annotated --check examples/annotated/robot.labels.yaml": 0,
    "annotations examples/annotated/camera.py --check examples/annotated/robot.labels.yaml": 1,
    "annotations nope": 2,
    "categories Video": 0,
    "categories Vidoe": 2,
    "law": 0,
    f"mitigate {BEFORE}": 0,
    "mitigate examples/factory/nope.xml": 2,
    "fleet examples/fleet/fleet.yaml": 0,
    "fleet nope.yaml": 2,
    "decide accept x --reason y --owner z": 2,
    "decisions verify nope.jsonl": 2,  # an answer is in test_decisions.py: no log is shipped
    "load examples/factory/nope.xml": 2,
    f"load {AFTER} --robot r": 3,
    "unload --robot r": 3,
    "query": 0,
    "query leak-paths": 3,
    "query leak-pahts": 2,
    "db status": 0,
}


def rows() -> Iterator[ParameterSet]:
    """An ending of each command, and of ``analyze`` each exit code, for each change; all of them each week."""
    met = set()
    for line, code in ENDINGS.items():
        command = line.split()[0]
        first = (command, code if command == "analyze" else None)
        yield pytest.param(line, code, marks=[pytest.mark.thorough] if first in met else [])
        met.add(first)


@pytest.mark.parametrize(("line", "code"), rows())
def test_a_process_says_the_same(line: str, code: int, cli: Cli) -> None:
    here, process = (
        start(*line.split(), cwd=ROOT, NEO4J_URI=NOWHERE, NEO4J_PASSWORD="none", SOURCE_DATE_EPOCH="0")  # noqa: S106
        for start in (cli, run)
    )
    assert process.returncode == here.returncode == code
    assert (named(process.stdout), named(process.stderr)) == (named(here.stdout), named(here.stderr))


def named(text: str) -> str:
    """In 'Usage' and 'Try' stands how the program was started, here as a part of pytest."""
    return re.sub(" +", " ", re.sub(r"python -m [\w.]*rosprivacy", "rosprivacy", text))


def test_every_command_is_there_with_an_answer_and_a_refusal() -> None:
    commands = set(typer.main.get_command(program()).commands)  # type: ignore[attr-defined]  # of a group
    ends = {name: {code for line, code in ENDINGS.items() if line.split()[0] == name} for name in commands}
    assert all(ends.values()), ends
    answers_only, needs_a_server = {"law", "db"}, {"unload"}
    assert {name for name, codes in ends.items() if not codes & {2, 3}} == answers_only
    refused_only = {"decide", "decisions", "explore", "init", "load", "observe"}
    assert {name for name, codes in ends.items() if not codes & {0, 1, 4}} == needs_a_server | refused_only
    assert set().union(*ends.values()) == {0, 1, 2, 3, 4}, f"{OWN_ERROR} stands in test_own_errors.py"
