"""``rosprivacy mitigate`` says what people would set first at bridges and recorders, before lines and filters."""

from __future__ import annotations

import json
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

import rosprivacy
from rosprivacy.analysis.modes import View
from rosprivacy.mitigation import run_mitigation
from tests.helpers.fleet_files import policy
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from tests.helpers.command import Cli

SCHEMA = json.loads((ROOT / "docs" / "mitigation.schema.json").read_text("utf-8"))


def system(folder: Path, leak: str, read: str = "/video,/odom") -> tuple[Path, Path]:
    """A camera, an odometry, and a node that lets video out."""
    file, labels = folder / "p.xml", folder / "l.yaml"
    file.write_text(policy("/camera>/video", "/base>/odom", f"{leak}<{read}"), "utf-8")
    labels.write_text(
        f"labels: 1\nnodes: {{/camera: {{source: [Video]}}, {leak}: {{leak: [Video]}}}}\n"
        "channels: {/video: sensitive}\n",
        "utf-8",
    )
    return file, labels


def proposal(cli: Cli, file: Path, labels: Path, *more: str) -> Any:
    document = json.loads(cli("mitigate", file, "-l", labels, "-f", "json", *more).stdout)
    Draft202012Validator(SCHEMA).validate(document)
    (only,) = document["proposals"]
    return only


@pytest.mark.parametrize(
    ("leak", "confidence", "texts"),
    [
        ("/foxglove_bridge", "likely", ["topic_whitelist: ['(?!(/video)$).*']"]),
        ("/hall/foxglove_bridge", "likely", ["topic_whitelist: ['(?!(/video)$).*']"]),
        ("/rosbridge_websocket", "may", ['topics_glob: "[/odom]"']),
        ("/mqtt_client", "may", ["bridge.ros2mqtt.ros_topics: [/video]"]),
        ("/domain_bridge", "likely", ["topics: {video}"]),
        ("/zenoh_bridge_ros2dds", "likely", ['deny: {publishers: ["/video"]}']),
        (
            "/rosbag2_recorder",
            "may",
            [
                "ros2 bag record … --exclude-topics /video",
                "ros2 bag record … --exclude-regex '^(/video)$'",
                "record.exclude_topics: [/video]",
            ],
        ),
    ],
)
def test_a_program_is_told_what_to_leave_out(
    cli: Cli, tmp_path: Path, leak: str, confidence: str, texts: list[str]
) -> None:
    file, labels = system(tmp_path, leak)
    (row,) = proposal(cli, file, labels)["settings"]
    assert (row["node"]["name"], row["confidence"]) == (leak, confidence)
    assert [channel["name"] for channel in row["channels"]] == ["/video"]
    assert [one["text"] for one in row["write"]] == texts
    short = cli("mitigate", file, "-l", labels).stdout
    assert texts[0] in short
    assert ("(-v)" in short) == (texts[-1] not in short)
    text = cli("mitigate", file, "-l", labels, "-v").stdout
    places = [
        text.index(one) for one in (*texts, "granted, and the verdict stays", "Take the grant away", "put a filter")
    ]
    assert places == sorted(places)


def test_the_regular_expression_lets_all_else_through(cli: Cli, tmp_path: Path) -> None:
    file, labels = system(tmp_path, "/foxglove_bridge")
    (setting,) = proposal(cli, file, labels)["settings"][0]["write"]
    (expression,) = re.findall(r"'(.*)'", setting["text"])
    names = ("/video", "/odom", "/video/compressed", "/a/video")
    assert [name for name in names if not re.fullmatch(expression, name)] == ["/video"]


def test_the_page_shows_what_is_printed(cli: Cli, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "mitigation.md").read_text("utf-8")
    _, example = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    file, labels = system(tmp_path, "/foxglove_bridge")
    assert example in cli("mitigate", file, "-l", labels).stdout


def test_what_is_read_by_a_wildcard_is_named(cli: Cli, tmp_path: Path) -> None:
    file, labels = system(tmp_path, "/rosbridge_websocket", "*")
    (row,) = proposal(cli, file, labels)["settings"]
    assert [channel["name"] for channel in row["channels"]] == ["/video"]
    assert row["write"][0]["text"] == 'topics_glob: "[/odom]"'


def test_what_a_recorder_writes_into_a_storage(cli: Cli, tmp_path: Path) -> None:
    """The finding is about the storage; the recorder before it is what people set."""
    file, labels = system(tmp_path, "/rosbag2_recorder")
    labels.write_text(
        "labels: 1\nnodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n"
        "elements: {disk: {kind: storage, country: DE}}\nflows: [{from: /rosbag2_recorder, to: disk}]\n",
        "utf-8",
    )
    (row,) = proposal(cli, file, labels)["settings"]
    assert (row["program"], row["node"]["name"]) == ("recorder", "/rosbag2_recorder")
    assert row["write"][0]["text"] == "ros2 bag record … --exclude-topics /video"


def test_a_node_that_is_no_program_gets_the_policy_line_first(cli: Cli, tmp_path: Path) -> None:
    file, labels = system(tmp_path, "/uplink")
    assert proposal(cli, file, labels)["settings"] == []
    text = cli("mitigate", file, "-l", labels).stdout
    assert "DDS security" not in text
    assert text.index("Take the grant away") < text.index("subscribe topic /video") < text.index("Or put a filter")


def test_where_no_line_may_be_denied_none_is_to_be_taken_away(cli: Cli, tmp_path: Path) -> None:
    file, labels = system(tmp_path, "/uplink")
    text = cli("mitigate", file, "-l", labels, "--by", "filter").stdout
    assert "Take the grant away" not in text
    assert "   Put a filter" in text


def test_bridges_stand_before_recorders(cli: Cli, tmp_path: Path) -> None:
    file, labels = tmp_path / "p.xml", tmp_path / "l.yaml"
    leaks = ("/a/rosbag2_recorder", "/b/foxglove_bridge")
    file.write_text(policy("/camera>/video", *(f"{leak}</video" for leak in leaks)), "utf-8")
    ends = ", ".join(f"{leak}: {{leak: [Video]}}" for leak in leaks)
    labels.write_text(f"labels: 1\nnodes: {{/camera: {{source: [Video]}}, {ends}}}\n", "utf-8")
    assert [row["program"] for row in proposal(cli, file, labels)["settings"]] == ["bridge", "recorder"]


def test_lines_of_settings_fit_a_terminal(cli: Cli, tmp_path: Path) -> None:
    topics = ",".join(f"/sensors/number_{number}" for number in range(200))
    file, labels = system(tmp_path, "/rosbridge_websocket", f"/video,{topics}")
    text = cli("mitigate", file, "-l", labels, "--by", "filter").stdout
    lines = text[text.index("   Keep /video") : text.index("   Put a filter")].splitlines()
    assert max(map(len, lines)) <= 80
    assert len(lines) < 20
    assert any("more lines (--format json has all)" in line for line in lines)
    ((setting,),) = (row["write"] for row in proposal(cli, file, labels)["settings"])
    assert setting["text"].count("/sensors/") == 200


TOPICS = st.lists(st.sampled_from(["/t0", "/t1", "/t2"]), max_size=3, unique=True).map(",".join)


@given(st.lists(st.tuples(TOPICS, TOPICS), min_size=3, max_size=3), st.sampled_from(View))
def test_proposals_and_proofs_are_those_of_a_node_that_is_no_program(uses: list[tuple[str, str]], view: View) -> None:
    """Only the name of an exit differs: what is changed, and what then is proven, does not."""
    documents = []
    for leak in ("/n1/foxglove_bridge", "/n1/foxglove_bridgf"):
        nodes = [f"{n}>{w}<{r}" for n, (w, r) in zip(("/n0", leak, "/n2"), uses, strict=True)]
        nodes += ["/n0>/t0", f"{leak}</t0"]
        with TemporaryDirectory() as folder:
            file, labels = Path(folder, "p.xml"), Path(folder, "l.yaml")
            file.write_text(policy(*nodes), "utf-8")
            labels.write_text(
                f"labels: 1\nnodes: {{/n0: {{source: [Video, Voice]}}, {leak}: {{leak: [Video, Voice]}}}}\n", "utf-8"
            )
            result = rosprivacy.analyze([str(file)], [str(labels)], view=view)
            document: Any = run_mitigation(result).document()
        for one in document["proposals"]:
            leaves_out = one.pop("settings")
            assert bool(leaves_out) == (leak.endswith("bridge") and bool(one["removes"]))
        written = json.dumps(document).replace(leak, "/exit").replace(folder, "")
        documents.append(re.sub(r'"[0-9a-f]{16,64}"', "id", written))
    assert documents[0] == documents[1]


@pytest.mark.parametrize(("role", "written"), [("request", ["service_whitelist: ['(?!(/face)$).*']"]), ("reply", [])])
def test_of_services_those_that_a_bridge_calls(cli: Cli, tmp_path: Path, role: str, written: list[str]) -> None:
    """What it serves itself, no list of it is about."""
    other = {"request": "reply", "reply": "request"}[role]
    profiles = "".join(
        f"<profile ns='/' node='{node}'><services {use}='ALLOW'><service>face</service></services></profile>"
        for node, use in (("camera", other), ("foxglove_bridge", role))
    )
    file, labels = system(tmp_path, "/foxglove_bridge")
    enclave = f"<enclave path='/e'><profiles>{profiles}</profiles></enclave>"
    file.write_text(f"<policy version='0.2.0'><enclaves>{enclave}</enclaves></policy>", "utf-8")
    labels.write_text("labels: 1\nnodes: {/camera: {source: [Video]}, /foxglove_bridge: {leak: [Video]}}\n", "utf-8")
    rows = proposal(cli, file, labels)["settings"]
    assert [one["text"] for row in rows for one in row["write"]] == written


def test_what_signed_permissions_grant_is_not_to_be_taken_away(cli: Cli) -> None:
    """There is no policy whose line could be changed."""
    case = ROOT / "tests" / "cases" / "unprotected"
    text = cli("mitigate", case / "keystore", "--allow-unsigned", "-l", case / "labels.yaml").stdout
    assert "   Put a filter between /video (topic) and /uplink (node)" in text
    assert "Take the grant away" not in text
