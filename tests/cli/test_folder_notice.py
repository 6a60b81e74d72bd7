"""Who names nothing is told what lies in the folder, and the one command to begin with; that command runs."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING

import pytest

from rosprivacy.cli.app import COMMANDS as COMMAND_NAMES
from tests.helpers.checkouts import put_checkout
from tests.helpers.factory import BEFORE
from tests.helpers.observed import node_info

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

POLICY = BEFORE.parents[1] / "paper" / "servers.policy.xml"
HERE = {  # what lies in the folder -> the command
    "nothing": "rosprivacy try --ros2",
    "prose": "rosprivacy try --ros2",
    "labels": "rosprivacy try --ros2",
    "policy": "rosprivacy try 'my robot.xml'",
    "policies": "rosprivacy try .",
    "text": "rosprivacy try graph.txt",
    "project": "rosprivacy analyze",
    "below a project": "rosprivacy analyze",
    "launch": "rosprivacy observe --ros2",
    "workspace": "rosprivacy try .",
    "bag": "rosprivacy bag .",
    "keystore": "rosprivacy try .",
}
SHORT = 16  # lines after the first: they fit a terminal
RUN = ("policy", "policies", "text", "project", "below a project", "workspace")
COMMANDS = (("analyze",), ("try",), ("suggest",), ("init",), ("init", "--from-try"), ("report",), ("lint",))


def filled(folder: Path, what: str) -> Path:
    """A folder with something in it; return where a person stands."""
    match what:
        case "prose":
            (folder / "README.md").write_text("# Robot\n\nIt has a <policy> and labels: 1\n")
        case "labels":
            (folder / "l.yaml").write_text("labels: 1\n")
        case "policy":
            shutil.copy(POLICY, folder / "my robot.xml")
        case "policies":
            for file in (BEFORE, BEFORE.with_name("node.xml")):
                shutil.copy(file, folder)
        case "text":
            (folder / "graph.txt").write_text(node_info("/cam"))
        case "project" | "below a project":
            shutil.copy(POLICY, folder / "robot.policy.xml")
            (folder / "rosprivacy.toml").write_text('policies = "robot.policy.xml"\n')
        case "launch":
            (folder / "robot.launch.py").write_text("def generate_launch_description():\n    pass\n")
        case "workspace":
            put_checkout(folder / "src" / "guide")
        case "bag":
            (folder / "metadata.yaml").write_text("rosbag2_bagfile_information:\n  version: 5\n")
        case "keystore":
            (folder / "enclaves").mkdir()
    if what == "below a project":
        (folder / "src").mkdir()
        return folder / "src"
    return folder


@pytest.mark.parametrize("what", HERE)
def test_the_program_alone_says_what_to_begin_with(cli: Cli, tmp_path: Path, what: str) -> None:
    done = cli(cwd=filled(tmp_path, what))
    assert (done.returncode, done.stderr) == (2, "")
    first, *rest = done.stdout.splitlines()
    assert first.endswith(HERE[what])
    assert len(rest) < SHORT
    assert "rosprivacy --help" in rest[-1]
    assert set(COMMAND_NAMES) <= set(re.findall(r"[\w-]+", "\n".join(rest[1:-1])))


@pytest.mark.parametrize("what", RUN)
def test_what_it_says_can_be_run(cli: Cli, tmp_path: Path, what: str) -> None:
    here = filled(tmp_path, what)
    words = HERE[what].replace("'my robot.xml'", "my+robot.xml").split()[1:]
    done = cli(*(word.replace("+", " ") for word in words), cwd=here)
    assert done.returncode in (0, 4)  # undetermined: nobody has labelled anything
    assert done.stdout


@pytest.mark.parametrize("words", COMMANDS)
@pytest.mark.parametrize("what", ["nothing", "policy", "text", "launch"])
def test_a_command_without_a_policy_says_it_too(cli: Cli, tmp_path: Path, what: str, words: tuple[str, ...]) -> None:
    done = cli(*words, cwd=filled(tmp_path, what))
    assert (done.returncode, done.stdout) == (2, "")
    line = " ".join(done.stderr.replace("│", "").replace("╰", " ").replace("─", "").split())
    assert f"Here {'this folder has' if what == 'nothing' else ''}" in line
    assert HERE[what] in line


def test_a_broken_project_file_hides_no_command(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "rosprivacy.toml").write_text("policies = [\n")
    (tmp_path / "pyproject.toml").write_text("[tool.rosprivacy]\n")
    done = cli(cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, "")
    assert done.stdout.splitlines()[0].endswith("--project, or work in its folder")
