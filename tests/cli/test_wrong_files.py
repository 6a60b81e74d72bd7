"""The wrong sort of file, wherever it is given: one line with what it is and the command that takes it."""

from __future__ import annotations

import re
import shutil
from itertools import product
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import Cli, refused
from tests.helpers.factory import BEFORE
from tests.helpers.observed import node_info

if TYPE_CHECKING:
    from pathlib import Path

PUT = (("before.policy.xml", "policy.xml"), ("node.xml", "node.xml"))
COMPOSE = "name: robot\nservices:\n  camera:\n    image: ros:jazzy\n  web: {build: .}\n"
METADATA = "rosbag2_bagfile_information:\n  version: 5\n"
OBSERVE, BAG = "rosprivacy observe --ros2", "rosprivacy bag"
FILES = {  # name -> text, what takes it
    "r.launch.py": ("from launch import *\n\n\ndef generate_launch_description():\n    pass\n", OBSERVE),
    "r.launch.xml": ("<launch>\n  <node pkg='a' exec='b'/>\n</launch>\n", OBSERVE),
    "r.launch.yaml": ("launch:\n- node: {pkg: a, exec: b}\n", OBSERVE),
    "nodl.xml": (
        "<?xml version='1.0'?>\n<interface version='1'>\n  <node name='a'/>\n</interface>\n",
        "rosprivacy try",
    ),
    "rosgraph.yaml": (
        "nodes:\n- name: /a\n  publishers: []\n  subscriptions: []\n",
        "rosprivacy observe --rosgraph rosgraph.yaml",
    ),
    "docker-compose.yml": (COMPOSE, OBSERVE),
    "r.urdf": ("<?xml version='1.0'?>\n<robot name='r'>\n  <link name='base'/>\n</robot>\n", OBSERVE),
    "world.sdf": ("<sdf version='1.9'><world name='w'/></sdf>\n", OBSERVE),
    "package.xml": ("<package format='3'><name>a</name></package>\n", OBSERVE),
    "params.yaml": ("/camera:\n  ros__parameters:\n    fps: 30\n", OBSERVE),
    "all_params.yaml": ("/**:\n  ros__parameters:\n    fps: 30\n", OBSERVE),
    "nested.yaml": ("robot:\n  camera:\n    ros__parameters:\n      fps: 30\n", OBSERVE),
    "nodes.txt": ("/camera\n/planner\n", OBSERVE),
    "metadata.yaml": (METADATA, BAG),
    "rec.mcap": ("\x89MCAP0\r\n", f"{BAG} rec.mcap"),
    "rec.db3": ("SQLite format 3\0\0", f"{BAG} rec.db3"),
    "graph.txt": (node_info("/cam"), "rosprivacy observe --text graph.txt"),
    "robot.toml": ('# ours\npolicies = ["p.xml"]\n', "--project"),
    "python.toml": ('[project]\nname = "a"\n[tool.rosprivacy]\npolicies = "p.xml"\n', "--project"),
    "g.json": ('{"format": "rosprivacy.graph/1", "policies": []}', "--add"),
    "labels.yaml": ("labels: 1\nnodes: {}\n", "--labels"),
    "fleet.yaml": ("# ours\nfleet: 1\nrobots: {}\n", "--fleet"),
    "types.yaml": ("types: 1\n", "--types"),
    "decisions.yaml": ("decisions: 1\n", "--decisions"),
}
TAKEN_BY = {"--labels": "labels.yaml", "--fleet": "fleet.yaml", "--types": "types.yaml"}
TAKEN_BY |= {"--decisions": "decisions.yaml", "--add": "g.json"}
OPTIONS = ("", *TAKEN_BY)


def words_of(option: str, name: str) -> tuple[str | Path, ...]:
    """The words that give a file as what an option takes; without an option, as a policy."""
    alone = option in ("", "--fleet", "--add")
    return ("analyze", *([option] if option else []), name, *([] if alone else ["policy.xml"]))


def put_policy(folder: Path) -> None:
    for source, name in PUT:
        shutil.copy(BEFORE.with_name(source), folder / name)


READ = {("", "r.launch.xml"), ("", "r.launch.yaml"), *TAKEN_BY.items()}  # what belongs there


@pytest.mark.parametrize(("option", "name"), [pair for pair in product(OPTIONS, FILES) if pair not in READ])
def test_one_line_says_what_a_file_is_and_what_takes_it(cli: Cli, tmp_path: Path, option: str, name: str) -> None:
    text, taker = FILES[name]
    (tmp_path / name).write_bytes(text.encode("latin-1"))
    put_policy(tmp_path)
    (line,) = refused(cli(*words_of(option, name), cwd=tmp_path))
    place, what, *remedy = line.split("; ")
    assert place.startswith((f"{name}:1: this is a", f"{name}:1: this is the output"))
    assert taker in "; ".join([what, *remedy])


@pytest.mark.parametrize("option", OPTIONS[1:])
def test_a_policy_is_given_without_an_option(cli: Cli, tmp_path: Path, option: str) -> None:
    put_policy(tmp_path)
    (line,) = refused(cli(*words_of(option, "policy.xml"), cwd=tmp_path))
    assert line.startswith("policy.xml:1: ")
    assert "policy" in line.split("; ")[0]


@pytest.mark.parametrize(
    "command", [("try",), ("init", "--from-try"), ("lint",), ("suggest",), ("observe", "--text"), ("bag",)]
)
@pytest.mark.parametrize("name", ["r.urdf", "docker-compose.yml", "params.yaml", "labels.yaml", "r.launch.py"])
def test_other_commands_say_it_too(cli: Cli, tmp_path: Path, command: tuple[str, ...], name: str) -> None:
    text, taker = FILES[name]
    (tmp_path / name).write_bytes(text.encode("latin-1"))
    (line,) = refused(cli(*command, name, cwd=tmp_path))
    assert line.startswith(f"{name}:1: this is a")
    assert taker in line


@pytest.mark.parametrize(
    ("option", "text", "line"),
    [
        ("--labels", "labels: 1\nnodes: [\n", 3),
        ("--labels", "labels: 1\nservices:\n  image: {build: 1}\n", 3),
        ("--types", "types: 1\ntopics: [\n", 3),
        ("--decisions", "decisions: 1\nfindings: [\n", 3),
        ("--fleet", "fleet: 1\nrobots: [\n", 3),
    ],
)
def test_what_is_of_the_right_sort_is_told_where_it_is_wrong(
    cli: Cli, tmp_path: Path, option: str, text: str, line: int
) -> None:
    (tmp_path / "f.yaml").write_text(text)
    put_policy(tmp_path)
    lines = refused(cli(*words_of(option, "f.yaml"), cwd=tmp_path))
    assert lines[0].startswith(f"f.yaml:{line}: ")
    assert not any("this is" in one for one in lines)


CARE_HOME = BEFORE.parents[1] / "care-home"
LABELS = BEFORE.with_name("run2.labels.yaml")


def test_the_label_file_of_another_robot_is_told_in_the_first_line(cli: Cli) -> None:
    other = CARE_HOME / "care-home.labels.yaml"
    first, *lines = refused(cli("analyze", BEFORE, "-l", other))
    assert first.startswith(f"{other}: of its 22 names 2 are in the policies")
    assert "another robot" in first
    assert len(lines) == 21  # each name is told of all the same
    assert all(re.match(rf"{re.escape(str(other))}:\d+: ", line) for line in lines)


def test_a_mistyped_name_makes_no_other_robot(cli: Cli, tmp_path: Path) -> None:
    text = LABELS.read_text("utf-8").replace("/navigator", "/navigatr").replace("/robot_camera:", "/robot_cam:")
    (tmp_path / "l.yaml").write_text(text, "utf-8")
    lines = refused(cli("analyze", BEFORE, "-l", "l.yaml", cwd=tmp_path))
    assert len(lines) == 2
    assert all(re.match(r"l\.yaml:\d+: .*did you mean", line) for line in lines)


def test_names_below_a_pushed_namespace_are_told_in_the_first_line_with_what_takes_it_off(
    cli: Cli, tmp_path: Path
) -> None:
    put_policy(tmp_path)
    shutil.copy(LABELS, tmp_path / "l.yaml")
    at_home = cli("analyze", "policy.xml", "-l", "l.yaml", "-q", cwd=tmp_path)
    text = (tmp_path / "policy.xml").read_text("utf-8").replace('ns="/"', 'ns="/r1"')
    (tmp_path / "policy.xml").write_text(text, "utf-8")
    first, *lines = refused(cli("analyze", "policy.xml", "-l", "l.yaml", cwd=tmp_path))
    assert first.startswith("l.yaml: ")
    assert "--fleet" in first
    assert "namespace: {strip: /r1}" in first
    assert len(lines) == 7
    fleet = "fleet: 1\nrobots:\n  a: {policies: [policy.xml], labels: [l.yaml], namespace: {strip: /r1}}\n"
    (tmp_path / "fleet.yaml").write_text(fleet)
    pushed = cli("analyze", "--fleet", "fleet.yaml", "-q", cwd=tmp_path)
    assert (pushed.returncode, pushed.stderr) == (at_home.returncode, at_home.stderr) == (1, "")


def test_names_below_two_namespaces_are_those_of_neither(cli: Cli, tmp_path: Path) -> None:
    put_policy(tmp_path)
    text = (tmp_path / "policy.xml").read_text("utf-8")
    for robot in ("r1", "r2"):
        there = text.replace('ns="/"', f'ns="/{robot}"').replace('path="/', f'path="/{robot}/')
        (tmp_path / f"{robot}.policy.xml").write_text(there, "utf-8")
    lines = refused(cli("analyze", "r1.policy.xml", "r2.policy.xml", "-l", LABELS, cwd=tmp_path))
    assert "strip" not in lines[0]
    assert lines[0].startswith(f"{LABELS}: of its 7 names none are in the policies")


@pytest.mark.parametrize("shared", [True, False])
def test_two_robots_in_one_call_are_told_of(cli: Cli, tmp_path: Path, shared: bool) -> None:  # noqa: FBT001 - a case
    put_policy(tmp_path)
    text = (tmp_path / "policy.xml").read_text("utf-8")
    if not shared:
        text = re.sub(r'(node="|<topic>|<service>|path="/)', r"\1other_", text)
    (tmp_path / "other.xml").write_text(text.replace("safety_video", "video"), "utf-8")
    done = cli("analyze", "policy.xml", "other.xml", "-l", LABELS, cwd=tmp_path)
    (line,) = (line for line in done.stdout.splitlines() if "2 policies make one graph" in line)
    assert re.match(r"notice: (?:policy|other)\.xml:\d+: .*--per-policy", line)


@pytest.mark.parametrize("policies", [0, 1])
def test_of_a_wrong_folder_the_first_line_says_what_is_in_it(cli: Cli, tmp_path: Path, policies: int) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.xml").write_text("<a>\n")
    if policies:
        put_policy(tmp_path)
    first, *lines = refused(cli("analyze", ".", cwd=tmp_path))
    read = "1 is a policy" if policies else "none are policies"
    assert re.match(rf"\.: of its {3 + 2 * policies} files .*{read}, and 3 cannot be read; ", first)
    assert ("policy.xml" in first) == bool(policies)
    assert [line.split(":")[0] for line in lines] == ["a.xml", "b.xml", "c.xml"]


def test_a_mistyped_kind_hides_no_mistyped_name(cli: Cli, tmp_path: Path) -> None:
    """All that is wrong with labels is told in one run."""
    text = "labels: 1\nnodes:\n  /safety_camera: {source: [Vidoe]}\n  /robot_camra: conduit\n  /navigator: conduit\n"
    (tmp_path / "l.yaml").write_text(text)
    kind, name = refused(cli("analyze", BEFORE, "-l", "l.yaml", cwd=tmp_path))
    assert kind.startswith("l.yaml:3: unknown category 'Vidoe'")
    assert name.startswith("l.yaml:4: '/robot_camra' matches no node")
    assert "did you mean /robot_camera" in name
