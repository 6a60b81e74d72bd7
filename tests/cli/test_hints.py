"""What is wrong is told with what to write instead, and no place is made up."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.suggesting.evidence import ROLES
from tests.helpers.command import Cli, refused
from tests.helpers.factory import BEFORE
from tests.helpers.observed import node_info

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (("analyse",), "Did you mean 'analyze'"),
        (("analyze", "--lables", "x"), "--labels"),
        (("analyze", "p.xml", "--view", "declard"), "did you mean declared"),
        (("analyze", "p.xml", "--fail-on", "off"), "write never"),
        (("analyze", "p.xml", "--fail-on", "todo"), "write leak"),
        (("analyze", "p.xml", "--fail-on", "all"), "leave out --decisions"),
        (("analyze", "p.xml", "--fail-on", "Undetermined"), "did you mean undetermined"),
        (("analyze", "p.xml", "--fail-on", "nope"), "one of undetermined, leak, undecided, doubt, never"),
        (("decide", "acept"), "did you mean accept"),
        (("graph", "p.xml", "--format", "svgg"), "did you mean svg"),
        (("categories", "Vidio"), "did you mean Video"),
        (("analyze", BEFORE, "-c", "Vidio"), "unknown category 'Vidio'; did you mean Video"),
        (("why-not", "/robot_camra", "/archive_server", BEFORE), "did you mean /robot_camera"),
        (("graph", BEFORE, "--around", "/navigatr"), "did you mean /navigator"),
        (("analyze", "nope.xml"), "nope.xml: file not found; correct the path"),
        (("analyze", "none.policy.xml"), "did you mean one.policy.xml?"),
        (("analyze", BEFORE, "-l", "labls.yaml"), "did you mean labels.yaml?"),
        (("analyze", "--fleet", "one.policy.xml"), "this is XML, such as a policy, and not YAML or JSON"),
    ],
    ids=lambda words: words[0] if isinstance(words, tuple) else "",
)
def test_the_nearest_is_named(cli: Cli, tmp_path: Path, words: tuple[str, ...], hint: str) -> None:
    (tmp_path / "one.policy.xml").write_text('<?xml version="1.0"?>\n<policy/>')
    (tmp_path / "labels.yaml").write_text("labels: 1\n")
    done = cli(*words, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert hint in " ".join(done.stderr.replace("│", "").split())
    assert ":0:" not in done.stderr
    assert "Value error" not in done.stderr


@pytest.mark.parametrize(
    ("name", "text", "what"),
    [
        ("l.yaml", "# ours\nlabels: 1\nnodes: {}\n", r"a label file, .*; give it with --labels"),
        ("l.json", '{"labels": 1, "nodes": {}}', r"a label file, .*; give it with --labels"),
        ("f.yaml", "fleet: 1\n", r"a fleet file, .*; give it with --fleet"),
        ("t.yaml", "types: 1\n", r"a file of message types, .*; give it with --types"),
        ("d.yaml", "decisions: 1\n", r"a file of decisions, .*; give it with --decisions"),
        ("g.json", '{"format": "rosprivacy.graph/1"}', r"a saved graph, .*; give it with --add"),
        ("graph.txt", node_info("/cam"), r"the output of `ros2 node info`, .*: rosprivacy observe --text graph.txt"),
        ("graph.txt", f"WARNING: Be aware\n/cam\n{node_info('/cam')}", r".*: rosprivacy observe --text graph.txt"),
        ("x.launch.py", "def generate_launch_description():\n    pass\n", r"a launch file, .*rosprivacy observe"),
        ("x.launch.yaml", "launch: []\n", r"a launch file, .*rosprivacy observe"),
        ("x.launch.xml", "<launch/>", r"a launch file, .*rosprivacy observe"),
        ("up.json", "{access_control: {enabled: true}}", r"an access list of Zenoh, .*\.json5"),
    ],
)  # fmt: skip
def test_a_file_of_another_kind_is_told_once_with_where_it_belongs(
    cli: Cli, tmp_path: Path, name: str, text: str, what: str
) -> None:
    (tmp_path / name).write_text(text)
    (line,) = refused(cli("analyze", name, cwd=tmp_path))
    assert re.match(rf"{re.escape(name)}:1: this is {what}", line)
    if not what.endswith("graph.txt"):
        (line,) = refused(cli("observe", "--text", name, "-o", "p.xml", cwd=tmp_path))
        assert re.match(rf"{re.escape(name)}:1: this is {what}", line)


def test_a_warning_without_a_place_has_none(cli: Cli) -> None:
    assert "\nwarning: labels: no label names a source" in cli("analyze", BEFORE).stdout


@pytest.mark.parametrize(
    "words",
    [
        ("report", BEFORE),
        *(pytest.param(("graph", BEFORE, *form), marks=pytest.mark.slow) for form in ((), ("-f", "mermaid"))),
    ],
)
def test_a_page_or_a_drawing_is_not_poured_into_a_terminal(words: tuple[str, ...]) -> None:
    here, there = pty.openpty()
    command = [sys.executable, "-m", "rosprivacy", *map(str, words)]
    done = subprocess.run(command, stdout=there, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    os.close(there)
    os.close(here)
    assert done.returncode == 2
    assert re.search("is not for a terminal; name a file with --output, or pipe it", done.stderr)


def test_the_words_of_the_program_stand_on_one_screen(cli: Cli) -> None:
    done = cli("help", "words")
    lines = done.stdout.splitlines()
    assert done.returncode == 0
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 80
    assert cli("help").stdout == done.stdout
    explained = {line.split("  ")[0] for line in lines}
    assert {*ROLES} - {"derivation", "never"} | {"leg", "absent", "declared", "enforced", "open"} <= explained


def test_a_command_is_explained_as_by_its_own_help(cli: Cli) -> None:
    assert cli("help", "analyze").stdout == cli("analyze", "--help").stdout
    assert "did you mean words?" in " ".join(cli("help", "wrods").stderr.replace("│", "").split())
