"""``rosprivacy observe``: from a running robot to a finding, through the door of text (rules S3, S16)."""

from __future__ import annotations

import json
import os
import signal
import stat
import subprocess
import sys
import threading
from textwrap import dedent
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.ingest.types.types_file import read_types
from tests.helpers.command import Cli, refused, run
from tests.helpers.observed import AT, node_info

if TYPE_CHECKING:
    from pathlib import Path

CAMERA = node_info("/cam", publishers="/image: sensor_msgs/msg/Image", service_servers="/cam/get_parameters: r/srv/G")
GRAPH = CAMERA + node_info("/up", subscribers="/image: sensor_msgs/msg/Image")
LABELS = "labels: 1\nnodes:\n  /cam: {source: [Video]}\n  /up: {leak: [Video]}\n"
ENDED = (  # by /up; a third node lets out what never gets there
    "labels: 1\nnodes:\n  /cam: {source: [Video]}\n  /up: {sanitizer: {Video: drop}}\n  /out: {leak: [Video]}\n"
    "channels:\n  /image: sensitive\n"
)


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "graph.txt").write_text(GRAPH, "utf-8")
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    return tmp_path


def observe(cli: Cli, robot: Path, *more: str | Path) -> str:
    done = cli("observe", "--text", "graph.txt", "--at", AT, "-o", "robot.policy.xml", *more, cwd=robot)
    assert done.returncode == 0, done.stderr
    return done.stderr


def write(robot: Path, graph: str, labels: str = LABELS) -> None:
    (robot / "graph.txt").write_text(graph, "utf-8")
    (robot / "labels.yaml").write_text(labels, "utf-8")


def test_from_text_to_a_finding(cli: Cli, robot: Path) -> None:
    """Times and doors stand in the policy, of each grant."""
    shown = observe(cli, robot)
    assert f"2 nodes, 2 channels: observed from {AT} to {AT} by text" in shown
    assert "enclaves are made up: one per node (2)" in shown
    grants = read_policy(str(robot / "robot.policy.xml")).grants
    seen = [(one.observation.by, one.observation.first, one.observation.last) for one in grants if one.observation]
    assert seen == [(("text",), AT, AT)] * 3
    assert len(grants) == 3
    done = cli("analyze", "robot.policy.xml", "-l", "labels.yaml", "-f", "json", cwd=robot)
    document = json.loads(done.stdout)
    assert done.returncode == 1
    assert [element["name"] for element in document["findings"][0]["witness"]] == ["/cam", "/image", "/up"]
    assert "observed" in {one.get("code") for one in document["diagnostics"]}


def test_the_same_input_gives_the_same_bytes_and_time_stamps_of_files_are_facts(cli: Cli, robot: Path) -> None:
    """Rule S14; when a text was taken is a fact of the observation, by default when the file was written."""
    os.utime(robot / "graph.txt", (0, 1_764_000_000))
    texts = []
    for name in ("one", "two"):
        assert cli("observe", "--text", "graph.txt", "-o", f"{name}.policy.xml", cwd=robot).returncode == 0
        texts.append((robot / f"{name}.policy.xml").read_bytes() + (robot / f"{name}.types.yaml").read_bytes())
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
    write(robot, "")
    done = cli("observe", "--text", "graph.txt", "-o", "robot.policy.xml", cwd=robot)
    assert done.returncode == 4
    assert "nothing was seen" in done.stderr
    assert not (robot / "robot.policy.xml").exists()


def test_a_gap_makes_the_verdict_undetermined_at_best(cli: Cli, robot: Path) -> None:
    """Rule S16: a node of which nothing is known may do anything; SARIF has a result for it."""
    write(robot, GRAPH + "/out\n", ENDED)
    assert "known gap (1): nodes of which not all is known" in observe(cli, robot)
    analyze = ("analyze", "robot.policy.xml", "-l", "labels.yaml")
    done = cli(*analyze, cwd=robot)
    assert done.returncode == 4, done.stdout
    assert done.stdout.startswith("undetermined: ")
    assert "the observation is known to miss something" in done.stdout
    assert "observe again until no gap is left" in done.stdout
    sarif = json.loads(cli(*analyze, "-f", "sarif", cwd=robot).stdout)
    assert [one["ruleId"] for one in sarif["runs"][0]["results"]] == [
        "observation-gaps", "doubt-made-without-warnings", "doubt-nothing-enforced",
    ]  # fmt: skip
    whole = (robot / "robot.policy.xml").read_text("utf-8").replace(" unanswered:1", "")
    (robot / "whole.xml").write_text(whole, "utf-8")
    assert cli("analyze", "whole.xml", "-l", "labels.yaml", cwd=robot).returncode == 0


TWO = node_info("/n") + node_info("/n", subscribers="/image: sensor_msgs/msg/Image")  # as ROS may tell one of two twice
ONE, C = node_info("/n"), node_info("/c")
KNOWN = 'There are 3 nodes in the graph with the exact name "/n". You are seeing information about only one of them.\n'
UNWARNED = {"made-without-warnings": 1}


@pytest.mark.parametrize(
    ("text", "gaps"),
    [
        (CAMERA + ONE + C, UNWARNED),
        (CAMERA + TWO + C, {**UNWARNED, "same-name": 1}),
        ("/cam\n/n\n/n\n/c\n" + CAMERA + TWO + C, {**UNWARNED, "same-name": 1}),
        ("/cam\n/n\n/n\n/c\n" + CAMERA + ONE + C, {**UNWARNED, "same-name": 1}),
        ("/cam\n/n\n/c\n/d\n" + CAMERA + ONE + C, {**UNWARNED, "unanswered": 1}),
        ("/cam\n/n\n/c\n/_ros2cli_7\n" + CAMERA + ONE + C + "Unable to find node '/_ros2cli_7'\n", {}),
        (CAMERA + node_info("/n", publishers="/n/_action/status: a/msg/S") + C, {}),
        ("[WARN] [1.2] [rcl]: something\n" + CAMERA + ONE + C, {}),
        (KNOWN + CAMERA + TWO + C + "Unable to find node '/d'\n", {"same-name": 2, "unanswered": 1}),
    ],
)
def test_what_a_text_lacks_is_seen_with_and_without_standard_error(
    cli: Cli, robot: Path, text: str, gaps: dict[str, int]
) -> None:
    """Rule S16: nodes of one name, nodes that did not answer, and whether the tool's warnings were kept at all."""
    labels = "nodes: {/cam: {source: [Video], leak: none}, /n: conduit, /c: conduit}\n"
    write(robot, text, f'labels: 1\n{labels}channels: {{"/*": sensitive}}\n')
    assert ("made without warnings" in observe(cli, robot)) == ("made-without-warnings" in gaps)
    done = cli("analyze", "robot.policy.xml", "-l", "labels.yaml", "-f", "json", cwd=robot)
    codes = dict.fromkeys(("same-name", "unanswered"), "observation-gap")
    told = [one["doubt"] for one in json.loads(done.stdout)["doubts"]]
    expected = sorted(codes.get(gap, gap) for gap in gaps)
    assert sorted(name for name in told if name in ("observation-gap", "made-without-warnings")) == expected
    assert (done.returncode == 4) == bool({"same-name", "unanswered"} & set(gaps))
    for gap, number in gaps.items():
        assert f"{gap}:{number}" in (robot / "robot.policy.xml").read_text("utf-8")


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
        (["--text", "robot.policy.xml"], "analyze"),  # it is a policy already
        (["--text", "graph.txt", "--at", "noon"], "is no time"),
        (["--text", "graph.txt", "--for", "soon"], "is no duration"),
    ],
)
def test_what_is_no_observation_is_refused(cli: Cli, robot: Path, words: list[str], why: str) -> None:
    observe(cli, robot)
    (line,) = refused(cli("observe", *words, cwd=robot))
    assert why in line


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
    (line,) = refused(done)
    assert line.startswith("ros2: not found on the path; ")


def test_a_ros2_that_fails_is_a_server_that_cannot_be_reached(robot: Path) -> None:
    done = run("observe", "--ros2", cwd=robot, **fake_ros2(robot, "#!/bin/sh\necho 'no rmw' >&2; exit 1\n"))
    assert done.returncode == 3
    assert done.stderr == "ros2 node list --all: failed: no rmw; run it by hand\n"


GRANTED = """\
<policy version="0.2.0">
  <enclaves>
    <enclave path="/robot">
      <profiles>
        <profile ns="/" node="cam">
          <topics publish="ALLOW">
            <topic>/image</topic>
            <topic>/spare</topic>
          </topics>
          <topics publish="DENY">
            <topic>/im*</topic>
          </topics>
          <services reply="ALLOW" request="ALLOW">
            <service>~/get_parameters</service>
          </services>
        </profile>
      </profiles>
    </enclave>
  </enclaves>
</policy>
"""


def test_no_deny_of_a_policy_overrides_what_was_seen(cli: Cli, robot: Path) -> None:
    """Rule S16: the flow is there, and both lines are told; the enclaves have different paths, the node is one."""
    observe(cli, robot)
    (robot / "granted.policy.xml").write_text(GRANTED, "utf-8")
    done = cli("analyze", "granted.policy.xml", "robot.policy.xml", "-l", "labels.yaml", "-f", "json", cwd=robot)
    assert done.returncode == 1, done.stderr
    document = json.loads(done.stdout)
    assert [element["name"] for element in document["findings"][0]["witness"]] == ["/cam", "/image", "/up"]
    line = document["findings"][0]["steps"][0]["policy"][0]
    assert line["seen"] == {"by": ["text"], "first": AT, "last": AT}
    (denied,) = [one["message"] for one in document["diagnostics"] if one.get("code") == "seen-although-denied"]
    assert f"/cam publish /image, from {AT} to {AT}; granted.policy.xml:11 denies it" in denied
    alone = cli("analyze", "granted.policy.xml", "-f", "json", cwd=robot)
    assert "seen-although-denied" not in alone.stdout


def test_a_saved_graph_keeps_what_was_seen_and_its_gaps(cli: Cli, robot: Path) -> None:
    (robot / "graph.txt").write_text(GRAPH + "/ghost\n", "utf-8")
    observe(cli, robot)
    (robot / "granted.policy.xml").write_text(GRANTED, "utf-8")
    policies = ["granted.policy.xml", "robot.policy.xml"]
    words = ["-l", "labels.yaml", "-f", "json"]
    cli("analyze", *policies, *words, "--save-graph", "graph.json", cwd=robot)
    first = json.loads(cli("analyze", *policies, *words, cwd=robot).stdout)
    again = json.loads(cli("analyze", "--add", "graph.json", *words, cwd=robot).stdout)
    assert {"observed", "observation-gap", "seen-although-denied"} <= {one.get("code") for one in again["diagnostics"]}
    assert again["findings"] == first["findings"]
    assert again["diagnostics"] == first["diagnostics"]


WHEN = {
    "en": f"observed from {AT} to {AT} by text; what was not seen proves nothing",
    "de": "was nicht gesehen wurde, beweist nichts (beobachtet vom {at} bis zum {at} über die Textausgabe von ROS 2)",
    "fr": "ce qui n'a pas été vu ne prouve rien (observé du {at} au {at} par la sortie texte de ROS 2)",
}
MOMENT = {"en": AT, "de": "22.11.2026, 10:00:00 Uhr UTC", "fr": "22/11/2026 à 10:00:00 UTC"}


@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_every_report_says_from_when_to_when_under_assumed(cli: Cli, robot: Path, language: str) -> None:
    """S16: in the words of the reader's language, times and doors too."""
    observe(cli, robot)
    said = WHEN[language].format(at=MOMENT[language])
    words = ("robot.policy.xml", "-l", "labels.yaml", "--types", "robot.types.yaml", "--lang", language)
    text = cli("analyze", *words, cwd=robot).stdout
    assert said in text
    page = cli("report", *words, "-f", "markdown", cwd=robot).stdout.replace("\\", "")
    assert page.count(said) >= 1
    if language != "en":
        assert "observed from" not in text
        assert all(AT not in line for line in page.splitlines() if MOMENT[language] in line)


def test_the_types_come_back_from_the_file_beside_the_policy(cli: Cli, robot: Path) -> None:
    """The writer is ours, the reader that of ``--types``: who writes and reads which type, and when."""
    (robot / "graph.txt").write_text(GRAPH + node_info("/old", publishers="/image: sensor_msgs/msg/CompressedImage"))
    observe(cli, robot)
    types = read_types(str(robot / "robot.types.yaml"))
    assert (types.observed.start, types.observed.end, types.observed.by) == (AT, AT, ("text",))
    seen = {(one.kind, one.name, kind.type, kind.ends) for one in types.channels for kind in one.types}
    assert seen == {
        ("topic", "/image", "sensor_msgs/msg/CompressedImage", (("/old",), ())),
        ("topic", "/image", "sensor_msgs/msg/Image", (("/cam",), ("/up",))),
        ("service", "/cam/get_parameters", "r/srv/G", (("/cam",), ())),
    }
    done = cli("analyze", "robot.policy.xml", "--types", "robot.types.yaml", "-l", "labels.yaml", cwd=robot)
    assert done.returncode == 1, done.stderr


@pytest.mark.slow
def test_watch_tells_what_comes_and_leaves_and_each_new_finding(robot: Path) -> None:
    """An alarm at run time: a node that starts and opens a path to a leak is told, and one that leaves is told."""
    variables = fake_ros2(robot)
    (robot / "nodes.txt").write_text("/cam\n", "utf-8")
    (robot / "info_cam.txt").write_text(CAMERA, "utf-8")
    (robot / "info_up.txt").write_text(GRAPH.removeprefix(CAMERA), "utf-8")
    words = ["observe", "--ros2", "--watch", "-l", "labels.yaml", "-o", "robot.policy.xml"]
    watch = subprocess.Popen(
        [sys.executable, "-u", "-m", "rosprivacy", *words],
        cwd=robot, env={**os.environ, **variables}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert watch.stdout is not None
    told: list[str] = []

    def until(what: str) -> str:
        while what not in "".join(told[-1:]):
            line = watch.stdout.readline() if watch.stdout else ""
            assert line, told
            told.append(line)
        return told[-1]

    alarm = threading.Timer(90, watch.kill)
    alarm.start()
    try:
        until("+ node /cam")
        until("not seen yet: labels.yaml:4")
        (robot / "nodes.txt").write_text("/cam\n/up\n", "utf-8")
        until("+ /up subscribes to /image (sensor_msgs/msg/Image)")
        assert "Video: /cam -> /image -> /up" in until("! new finding [")
        (robot / "nodes.txt").write_text("/cam\n", "utf-8")
        until("- node /up")
        watch.send_signal(signal.SIGINT)
        watch.wait(60)
    finally:
        alarm.cancel()
        watch.kill()
        watch.communicate()
    assert watch.returncode == 0
    assert {grant.node for grant in read_policy(str(robot / "robot.policy.xml")).grants} == {"/cam", "/up"}
    assert sum("new finding" in line for line in told) == 1


def test_a_fleet_of_observed_robots_is_told_in_few_lines_and_one_gap_counts(cli: Cli, robot: Path) -> None:
    """Rules S10, S16: of a hundred robots the same is told once; a gap of one leaves the fleet undetermined."""
    write(robot, GRAPH + node_info("/out"), ENDED)
    observe(cli, robot)
    whole = (robot / "robot.policy.xml").read_text("utf-8")
    gap = whole.replace("made-without-warnings:1", "same-name:1")
    for number in range(8):
        (robot / f"r{number}.xml").write_text(gap if number == 7 else whole, "utf-8")

    def analysed(robots: int) -> tuple[int, str]:
        rows = "".join(f"  r{n}: {{policies: r{n}.xml, labels: labels.yaml}}\n" for n in range(robots))
        (robot / "fleet.yaml").write_text(f"fleet: 1\nrobots:\n{rows}", "utf-8")
        done = cli("analyze", "--fleet", "fleet.yaml", cwd=robot)
        return done.returncode, done.stdout

    without, with_gap = analysed(7), analysed(8)
    assert (without[0], with_gap[0]) == (0, 4)
    assert sum("tells what was seen running" in line for line in with_gap[1].splitlines()) == 1
    assert "r0.xml, r7.xml tells what was seen running" in with_gap[1]


def test_a_message_with_the_graph_is_a_door(cli: Cli, robot: Path) -> None:
    types = "{name: sensor_msgs/msg/Image}"
    rest = "  service_servers: []\n  service_clients: []\n  action_servers: []\n  action_clients: []\n"
    ends = f"[{{name: /image, type: {types}}}]"
    text = f"nodes:\n- name: /cam\n  publishers: {ends}\n  subscriptions: []\n{rest}"
    text += f"- name: /up\n  publishers: []\n  subscriptions: {ends}\n{rest}---\n"
    (robot / "rosgraph.yaml").write_text(text)
    done = cli("observe", "--rosgraph", "rosgraph.yaml", "--at", AT, "-o", "g.policy.xml", cwd=robot)
    assert done.returncode == 0, done.stderr
    assert f"observed from {AT} to {AT} by rosgraph" in done.stderr
    answer = cli("analyze", "g.policy.xml", "-l", "labels.yaml", "--types", "g.types.yaml", cwd=robot)
    assert answer.returncode == 1, answer.stderr
