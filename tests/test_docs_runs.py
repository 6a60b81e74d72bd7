"""The commands of a page run as they stand there, in a folder that has what the page names; none ends with an error.

README, first hour, paper, case studies, formats, Python, databases and what a fleet needs Spark for have tests of their
own. What asks a running robot, a server or a model is left out here, and so is what a page leaves open with '…'.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.docs import blocks
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable

FACTORY, FLEET = ROOT / "examples" / "factory", ROOT / "examples" / "fleet"
ELSEWHERE = re.compile(r"…|--zenoh|--dds|--ask|json5|\.p7s|--permissions-ca")  # what runs, a person, other middleware
SERVED = re.compile(r"^rosprivacy (?:load|unload|query|db|explore)\b|--load\b")
ANSWERED = (0, 1, 4)  # what an analysis can end with; 2 is an error
SUGGESTED = """labels: 1
nodes:
  /safety_camera: {source: [Video]}
# suggest: likely {"nodes": {"/robot_camera": {"source": ["Video"]}}} because of its name
# suggest: may {"nodes": {"/display": {"leak": ["PersonalData"]}}} because of its name
"""
DESCRIPTION = """nodl_version: "2"
publishers:
  - {topic: image, type: sensor_msgs/msg/Image}
"""


def system(folder: Path) -> None:
    """A robot under the names that pages give it, with labels."""
    for name in ("my_robot", "robot", "old", "granted"):
        shutil.copy(FACTORY / "before.policy.xml", folder / f"{name}.policy.xml")
    shutil.copy(FACTORY / "after.policy.xml", folder / "new.policy.xml")
    shutil.copy(FACTORY / "node.xml", folder)
    for name in ("labels.yaml", "robot.labels.yaml"):
        shutil.copy(FACTORY / "run3.labels.yaml", folder / name)
    (folder / "examples").symlink_to(ROOT / "examples")
    (folder / "policies").mkdir()
    for name in ("before.policy.xml", "node.xml"):
        shutil.copy(FACTORY / name, folder / "policies")
    for name in ("assessment.json", "answers.json"):
        (folder / name).write_text('{"format": "rosprivacy.assessment/1", "answers": {}}', "utf-8")


def fleet(folder: Path) -> None:
    shutil.copytree(FLEET, folder, dirs_exist_ok=True)
    run("rosprivacy analyze --fleet fleet.yaml --format json -o last-week.json", folder)


def checkout(folder: Path) -> None:
    """Source code in a repository, of which the base is known."""
    shutil.copytree(ROOT / "examples" / "scan_robot", folder / "my_robot")
    (folder / "my_robot" / "launch").mkdir()
    shutil.copy(
        ROOT / "examples/scan_robot/guide_bringup/launch/guide.launch.py", folder / "my_robot/launch/robot.launch.py"
    )
    (folder / "camera.nodl.yaml").write_text(DESCRIPTION, "utf-8")
    git = "git -c user.name=A -c user.email=a@example.org"
    commit = f"git init -q . && git add . && {git} commit -qm base && git update-ref refs/remotes/origin/main HEAD"
    subprocess.run(["bash", "-c", commit], cwd=folder, check=True)


def labelled_checkout(folder: Path) -> None:
    checkout(folder)
    (folder / "robot.policy.xml").unlink()
    (folder / "labels.yaml").write_text("labels: 1\nnodes:\n  '*/camera': {source: [Video]}\n", "utf-8")


def annotated(folder: Path) -> None:
    (folder / "robot.labels.yaml").unlink()


def observed(folder: Path) -> None:
    shutil.copy(ROOT / "examples" / "telepresence" / "graph.txt", folder)
    for name in ("robot.policy.xml", "labels.yaml"):
        (folder / name).unlink()


def suggested(folder: Path) -> None:
    (folder / "robot.labels.yaml").write_text(SUGGESTED, "utf-8")


def deployed(folder: Path) -> None:
    shutil.copytree(ROOT / "tests" / "cases" / "unprotected" / "keystore", folder / "keystore")
    (folder / "robot.labels.yaml").write_text("labels: 1\n", "utf-8")


def reported(folder: Path) -> None:
    run("rosprivacy analyze my_robot.policy.xml -l labels.yaml --format json -o last_month.json", folder)
    fleet(folder)


LAID_OUT: dict[str, tuple[Callable[[Path], None], ...]] = {
    "annotations": (annotated,), "changes": (fleet, checkout), "decisions": (), "edpb": (fleet,),
    "keystores": (deployed,), "labels": (), "linked-data": (), "lint": (), "mitigation": (),
    "observe": (observed,), "report": (reported,), "scan": (labelled_checkout,), "suggestions": (suggested,),
}  # fmt: skip


def run(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """A line of a page, by a shell, with the program of this environment."""
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    line = line.replace("/etc/ros/keystore", "keystore")
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True, check=False
    )


@pytest.mark.slow
@pytest.mark.parametrize("page", LAID_OUT)
def test_a_page_runs(page: str, tmp_path: Path) -> None:
    system(tmp_path)
    for lay_out in LAID_OUT[page]:
        lay_out(tmp_path)
    lines = [line for block in blocks(ROOT / "docs" / f"{page}.md", "console") for line in block.splitlines()]
    ran = [
        line
        for line in lines
        if line.startswith("rosprivacy ")
        and not ELSEWHERE.search(line.partition("#")[0].strip())
        and not SERVED.search(line)
    ]
    assert ran
    for line in ran:
        done = run(line, tmp_path)
        assert done.returncode in ANSWERED, (line, done.stderr)


def test_each_page_with_commands_is_run() -> None:
    own = {
        "bags",
        "case-studies",
        "database",
        "explore",
        "first-hour",
        "fleets",
        "formats",
        "language-model",
        "paper",
        "what-it-finds",
    }
    shown = {
        page.stem
        for page in (ROOT / "docs").glob("*.md")
        if re.search(r"^rosprivacy ", "".join(blocks(page, "console")), re.MULTILINE)
    }
    assert shown - own == set(LAID_OUT)
