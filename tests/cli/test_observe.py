"""``rosprivacy observe``: from a running robot to a finding, through the door of text (rules S3, S16)."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
from textwrap import dedent
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.command import Cli, refused, run
from tests.helpers.observed import AT, node_info

if TYPE_CHECKING:
    from pathlib import Path

CAMERA = node_info("/cam", publishers="/image: sensor_msgs/msg/Image", service_servers="/cam/get_parameters: r/srv/G")
GRAPH = CAMERA + node_info("/up", subscribers="/image: sensor_msgs/msg/Image")
LABELS = "labels: 1\nnodes:\n  /cam: {source: [Video]}\n  /up: {leak: [Video]}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "graph.txt").write_text(GRAPH, "utf-8")
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    return tmp_path


def observe(cli: Cli, robot: Path, *more: str | Path) -> str:
    done = cli("observe", "--text", "graph.txt", "--at", AT, "-o", "robot.policy.xml", *more, cwd=robot)
    assert done.returncode == 0, done.stderr
    return done.stderr


def test_from_text_to_a_finding(cli: Cli, robot: Path) -> None:
    said = observe(cli, robot)
    assert "2 nodes, 2 channels: observed from 2026-11-22T10:00:00Z to 2026-11-22T10:00:00Z by text" in said
    assert "enclaves are made up: one per node (2)" in said
    done = cli("analyze", "robot.policy.xml", "-l", "labels.yaml", "-f", "json", cwd=robot)
    document = json.loads(done.stdout)
    assert done.returncode == 1
    assert [element["name"] for element in document["findings"][0]["witness"]] == ["/cam", "/image", "/up"]
    assert "observed" in {one.get("code") for one in document["diagnostics"]}


def test_times_and_doors_come_back_from_the_metadata(cli: Cli, robot: Path) -> None:
    observe(cli, robot)
    grants = read_policy(str(robot / "robot.policy.xml")).grants
    assert len(grants) == 3
    assert {(one.seen.by, one.seen.first, one.seen.last) for one in grants if one.seen} == {(("text",), AT, AT)}
    assert all(one.seen for one in grants)


def test_the_same_input_gives_the_same_bytes_and_time_stamps_of_files_are_facts(cli: Cli, robot: Path) -> None:
    """Rule S14; when a text was taken is a fact of the observation, by default when the file was written."""
    os.utime(robot / "graph.txt", (0, 1_764_000_000))
    texts = []
    for _ in range(2):
        assert cli("observe", "--text", "graph.txt", "-o", "robot.policy.xml", cwd=robot).returncode == 0
        texts.append((robot / "robot.policy.xml").read_bytes() + (robot / "robot.types.yaml").read_bytes())
    assert texts[0] == texts[1]
    assert b"2025-11-24T16:00:00Z" in texts[0]


def test_standard_input_and_several_files_add_up(robot: Path) -> None:
    command = [sys.executable, "-m", "rosprivacy", "observe", "--text", "-", "--text", "graph.txt"]
    other = node_info("/other", publishers="/more: t/msg/T").encode()
    done = subprocess.run(command, input=other, capture_output=True, cwd=robot, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert b'node="other"' in done.stdout
    assert b'node="cam"' in done.stdout


def test_nothing_seen_writes_nothing(cli: Cli, robot: Path) -> None:
    (robot / "graph.txt").write_text("", "utf-8")
    done = cli("observe", "--text", "graph.txt", "-o", "robot.policy.xml", cwd=robot)
    assert done.returncode == 4
    assert "nothing was seen, so nothing is written" in done.stderr
    assert not (robot / "robot.policy.xml").exists()


def test_a_gap_makes_the_verdict_undetermined_at_best(cli: Cli, robot: Path) -> None:
    """Rule S16: a node of which nothing is known may do anything."""
    (robot / "graph.txt").write_text(GRAPH.replace("/up", "/nav") + "/ghost\n", "utf-8")
    (robot / "labels.yaml").write_text(
        "labels: 1\nnodes:\n  /cam: {source: [Video]}\n  /nav: {sanitizer: {Video: drop}}\n  /ghost: {leak: [Video]}\n"
        "channels:\n  /image: sensitive\n",
        "utf-8",
    )
    assert "known gap (1): nodes of which not all is known" in observe(cli, robot)
    done = cli("analyze", "robot.policy.xml", "-l", "labels.yaml", cwd=robot)
    assert done.returncode == 4, done.stdout
    assert done.stdout.startswith("undetermined: ")
    whole = (robot / "robot.policy.xml").read_text("utf-8").replace(' gaps="unanswered:1"', "")
    (robot / "whole.xml").write_text(whole, "utf-8")
    assert cli("analyze", "whole.xml", "-l", "labels.yaml", cwd=robot).returncode == 0


def test_metadata_that_cannot_be_read_are_a_gap_too(cli: Cli, robot: Path) -> None:
    observe(cli, robot)
    broken = (robot / "robot.policy.xml").read_text("utf-8").replace(f'from="{AT}"', 'from="yesterday"', 1)
    (robot / "broken.xml").write_text(broken, "utf-8")
    done = cli("analyze", "broken.xml", cwd=robot)
    assert "what an observation says here cannot be read: from='yesterday' is no time" in done.stdout
    assert done.returncode == 4


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--text", "nowhere.txt"], "file not found"),
        (["--text", "labels.yaml"], "not the output of `ros2 node info`"),
        (["--text", "graph.txt", "--at", "noon"], "is no time"),
        (["--text", "graph.txt", "--for", "soon"], "is no duration"),
    ],
)
def test_what_is_no_observation_is_refused(cli: Cli, robot: Path, words: list[str], why: str) -> None:
    assert why in refused(cli("observe", *words, cwd=robot))[0]


FAKE = """\
    #!/bin/sh
    echo "$@" >> "$CALLS"
    case "$1 $2" in
    "node list") cat "$HERE/nodes.txt"; echo 'WARNING: a warning' >&2;;
    "node info") cat "$HERE/info$(echo "$4" | tr / _).txt";;
    esac
"""


def fake_ros2(folder: Path, text: str = FAKE) -> dict[str, Any]:
    """A program ``ros2`` that prints what lies in a folder; the variables that put it on the path."""
    program = folder / "bin" / "ros2"
    program.parent.mkdir()
    program.write_text(dedent(text), "utf-8")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    return {"PATH": path, "HERE": str(folder), "CALLS": str(folder / "calls")}


def test_ros2_is_run_by_us_with_arguments_and_no_shell(robot: Path) -> None:
    variables = fake_ros2(robot)
    (robot / "nodes.txt").write_text("/cam\n/up\n/$(touch owned)\n/_ros2cli_12\n", "utf-8")
    (robot / "info_cam.txt").write_text(CAMERA, "utf-8")
    (robot / "info_up.txt").write_text(GRAPH.removeprefix(CAMERA), "utf-8")
    done = run("observe", "--ros2", "--for", "0s", "-o", "robot.policy.xml", cwd=robot, **variables)
    assert done.returncode == 0, done.stderr
    assert "known gap (1): nodes of which not all is known" in done.stderr
    assert not (robot / "owned").exists()
    calls = (robot / "calls").read_text("utf-8").splitlines()
    assert calls[0] == "node list --all"
    assert calls[1:-1] == ["node info --include-hidden /cam", "node info --include-hidden /up"]
    assert {grant.node for grant in read_policy(str(robot / "robot.policy.xml")).grants} == {"/cam", "/up"}


def test_no_ros2_on_the_path_is_one_line(robot: Path) -> None:
    done = run("observe", "--ros2", cwd=robot, PATH="/nowhere")
    assert refused(done) == [
        "ros2: not found on the path; source the setup file of your ROS 2 installation, or give its output with --text"
    ]


def test_a_ros2_that_fails_is_a_server_that_cannot_be_reached(robot: Path) -> None:
    done = run("observe", "--ros2", cwd=robot, **fake_ros2(robot, "#!/bin/sh\necho 'no rmw' >&2; exit 1\n"))
    assert done.returncode == 3
    assert done.stderr == "ros2 node list --all: failed: no rmw; run it by hand\n"
