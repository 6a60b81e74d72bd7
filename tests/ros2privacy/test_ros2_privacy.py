"""``ros2 privacy``: every word reaches rosprivacy as it was typed, and its exit code comes back.

The package is installed as it ships. ros2cli is on no package index: a small stand-in for it is here, with the one
class that is extended and the two rounds of parsing of ros2cli 0.36.1. With ROS2CLI_SOURCE (the folder that holds the
package ``ros2cli``) and a Python in which it starts, the same tests run with the real one.
"""

from __future__ import annotations

import ast
import json
import os
import re
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
import yaml
from lxml import etree

from rosprivacy.analysis.python_311 import tomllib
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE = ROOT / "ros2privacy"
SOURCES = [*PACKAGE.glob("*.py"), *(PACKAGE / "ros2privacy").glob("*.py")]
PYTHONS = ("python3.8", "python3.9", "python3.10", "python3.12", "python3.13", "python3.14")
PEERS = ["fake", "real"] if "ROS2CLI_SOURCE" in os.environ else ["fake"]

FAKE_COMMAND = """
class CommandExtension:
    def add_arguments(self, parser, cli_name, *, argv=None):
        pass
    def main(self, *, parser, args):
        raise NotImplementedError
"""
FAKE_CLI = """
import argparse
from importlib.metadata import entry_points

def main():
    parser = argparse.ArgumentParser(prog="ros2")
    commands = parser.add_subparsers(dest="command")
    child = commands.add_parser("privacy")
    ours = child.print_help, child.exit
    child.print_help, child.exit = lambda: None, lambda status=0, message=None: None
    chosen, _ = parser.parse_known_args()  # the first round says which command is loaded
    child.print_help, child.exit = ours
    points = entry_points()
    points = points.select(group="ros2cli.command") if hasattr(points, "select") else points["ros2cli.command"]
    extension = [point.load()() for point in points if point.name == chosen.command][0]
    extension.add_arguments(child, "ros2 privacy")
    return extension.main(parser=parser, args=parser.parse_args())
"""
# ros2cli imports one class of rclpy when it starts; rclpy comes with ROS only.
RCLPY = "class ExternalShutdownException(Exception): pass\n"
TELL = "#!{python}\nimport json, sys\nprint(json.dumps(sys.argv[1:]))\nsys.exit(4)\n"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package as pip installs it, from a copy, since setuptools writes beside the sources."""
    folder = tmp_path_factory.mktemp("ros2privacy")
    shutil.copytree(PACKAGE, folder / "source")
    arguments = ["--quiet", "--no-deps", "--target", str(folder / "lib")]
    subprocess.run([sys.executable, "-m", "pip", "install", *arguments, str(folder / "source")], check=True)
    return folder / "lib"


@pytest.fixture(params=PEERS)
def ros2cli(request: pytest.FixtureRequest, tmp_path: Path) -> list[str]:
    """Folders for PYTHONPATH."""
    if request.param == "real":
        (tmp_path / "rclpy").mkdir()
        (tmp_path / "rclpy" / "__init__.py").touch()
        (tmp_path / "rclpy" / "executors.py").write_text(RCLPY)
        return [os.environ["ROS2CLI_SOURCE"], str(tmp_path)]
    for name, text in {"command.py": FAKE_COMMAND, "cli.py": FAKE_CLI, "__init__.py": ""}.items():
        (tmp_path / "ros2cli").mkdir(exist_ok=True)
        (tmp_path / "ros2cli" / name).write_text(text)
    return [str(tmp_path)]


def ros2(
    words: list[str], installed: Path, ros2cli: list[str], path: Path, python: str = sys.executable
) -> subprocess.CompletedProcess[str]:
    """``ros2 WORDS`` with nothing on the path but what stands in the folder PATH."""
    environment = {"PATH": str(path), "PYTHONPATH": os.pathsep.join([str(installed), *ros2cli]), "HOME": str(path)}
    command = [python, "-c", "import sys; from ros2cli.cli import main; sys.exit(main())", *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def _telling(folder: Path) -> Path:
    """A folder with a program ``rosprivacy`` that tells its words, and ends with 4."""
    folder.mkdir()
    program = folder / "rosprivacy"
    program.write_text(TELL.format(python=sys.executable))
    program.chmod(0o755)
    return folder


WORDS = [
    [],
    ["--help"],
    ["-h"],
    ["analyze", "--help"],
    ["analyze", "a.policy.xml", "-l", "labels.yaml", "--fail-on", "leak"],
    ["report", "--", "-odd.policy.xml"],
    ["analyze", "with space.xml", "--categories=Video,Voice", "", "*", "$HOME", "-"],
]


@pytest.mark.slow
@pytest.mark.parametrize("words", WORDS, ids=" ".join)
def test_every_word_arrives_as_it_was_typed(
    words: list[str], installed: Path, ros2cli: list[str], tmp_path: Path
) -> None:
    answer = ros2(["privacy", *words], installed, ros2cli, _telling(tmp_path / "bin"))
    assert (json.loads(answer.stdout), answer.stderr, answer.returncode) == (words, "", 4)


@pytest.mark.slow
def test_where_rosprivacy_is_missing_one_line_says_what_to_do(
    installed: Path, ros2cli: list[str], tmp_path: Path
) -> None:
    answer = ros2(["privacy", "analyze", "a.xml"], installed, ros2cli, tmp_path)
    assert (answer.returncode, answer.stdout) == (2, "")
    assert re.fullmatch(r"ros2 privacy: the program rosprivacy is not on the path; install it .*\n", answer.stderr)


@pytest.mark.slow
def test_the_program_itself_answers(installed: Path, ros2cli: list[str], tmp_path: Path) -> None:
    binaries = tmp_path / "bin"
    binaries.mkdir()
    program = binaries / "rosprivacy"
    program.write_text(f"#!{sys.executable}\nfrom rosprivacy.cli import main\nmain()\n")
    program.chmod(0o755)
    factory = ROOT / "examples" / "factory"
    words = ["analyze", str(factory / "before.policy.xml"), "-l", str(factory / "run2.labels.yaml")]
    answer = ros2(["privacy", *words], installed, ros2cli, binaries)
    assert answer.returncode == 1, answer.stderr
    assert answer.stdout.startswith("leak: data can reach a leak")


@pytest.mark.slow
def test_a_build_for_colcon_brings_what_ros_looks_for(installed: Path) -> None:
    assert (installed / "share" / "ament_index" / "resource_index" / "packages" / "ros2privacy").is_file()
    shipped = installed / "share" / "ros2privacy" / "package.xml"
    package = etree.parse(shipped)
    facts = [package.findtext(path) for path in ("name", "license", "export/build_type")]
    assert facts == ["ros2privacy", "Apache-2.0", "ament_python"]
    needed = [str(each.text) for each in package.findall("exec_depend")]
    rules = yaml.safe_load((PACKAGE / "rosdep.yaml").read_text("utf-8"))
    assert needed == ["ros2cli", *rules]
    program = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["name"]
    (systems,) = rules.values()
    assert all(rule == {"pip": {"packages": [program]}} for rule in systems.values())
    version = re.search(r'version="([0-9.]+)"', (PACKAGE / "setup.py").read_text())
    assert version is not None
    assert package.findtext("version") == version[1]


def test_its_sources_are_those_of_python_3_8_and_import_the_standard_library_only() -> None:
    for source in SOURCES:
        tree = ast.parse(source.read_text(), feature_version=(3, 8))
        imported = {name.name for node in ast.walk(tree) if isinstance(node, ast.Import) for name in node.names}
        imported |= {str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
        assert {name.split(".")[0] for name in imported} <= sys.stdlib_module_names | {"ros2cli", "setuptools"}


@pytest.mark.slow
def test_every_python_of_this_machine_hands_over(installed: Path, ros2cli: list[str], tmp_path: Path) -> None:
    """The distributions of ROS bring a Python each: 3.8 in Foxy, 3.10 in Humble, 3.12 in Jazzy, 3.14 in Lyrical."""
    told = _telling(tmp_path / "bin")
    answering = [sys.executable]
    for name in PYTHONS:
        asked = (
            subprocess.run(
                [name, "-c", "import sys; print(sys.executable)"], capture_output=True, text=True, check=False
            )
            if shutil.which(name)
            else None
        )
        if asked is not None and asked.returncode == 0:
            answering.append(asked.stdout.strip())
    for python in answering:
        answer = ros2(["privacy", *WORDS[-1]], installed, ros2cli, told, python)
        assert (json.loads(answer.stdout), answer.returncode) == (WORDS[-1], 4), (python, answer.stderr)
