"""Storages that are bags (rules S9 to S11): what was recorded is in them, what is not known is said."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from tests.helpers.bags import IMAGE, ODOMETRY, mcap, rosbag2
from tests.helpers.command import Cli, refused

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="cam"><topics publish="ALLOW"><topic>camera</topic><topic>log/*</topic></topics>
  <actions execute="ALLOW"><action>spin</action></actions></profile>
<profile ns="/" node="nav"><topics publish="ALLOW"><topic>odom</topic></topics></profile>
</profiles></enclave></enclaves></policy>"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    (tmp_path / "a.policy.xml").write_text(POLICY)
    return tmp_path


def analysed(folder: Path, stated: str, more: str = "", **settings: str) -> Result:
    said = "nodes: {/cam: {source: [Video]}, /nav: conduit}\nchannels: {/camera: sensitive, /odom: sensitive}"
    (folder / "l.yaml").write_text(f"labels: 1\n{said}\nelements:\n  run1: {{kind: storage, {stated}}}\n{more}\n")
    on = {"today": "2023-11-15", **settings}
    return rosprivacy.analyze(folder / "a.policy.xml", folder / "l.yaml", **on)  # type: ignore[arg-type] # one's own


def holds(result: Result) -> list[str]:
    return [kind for row in result.document()["outside"] for kind in row["holds"]]


def codes(result: Result) -> list[str]:
    return [said.code for said in result.diagnostics if said.code in ("bag-gap", "recording")]


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_what_was_recorded_is_in_the_storage(robot: Path, storage: str) -> None:
    rosbag2(robot / "run", storage)
    result = analysed(robot, "bag: run/, retention: P10D, country: DE, conduit: [Video]", "limits: {Video: P30D}")
    assert (holds(result), result.analysis.verdict, codes(result)) == (
        ["Video"],
        "undetermined",
        ["recording"],
    )  # others are open
    (told,) = [said.message for said in result.diagnostics if said.code == "recording"]
    size = sum(file.stat().st_size for file in (robot / "run").iterdir() if file.name != "metadata.yaml")
    assert f"{storage}, {size:,} bytes, 2 topics, 6 messages, 2023-11-14T22:13:20Z to 2023-11-14T22:13:25Z" in told


@pytest.mark.parametrize(
    ("stated", "why"),
    [
        ("retention: P90D", "kept for P90D, which can be longer than the P30D that Video may be kept"),
        ("encrypted: true", "no retention is stated"),
    ],
)
def test_limits_hold_on_a_real_file(robot: Path, stated: str, why: str) -> None:
    """S10: a storage that keeps it without an end or too long; the step into it names the line that states the bag."""
    rosbag2(robot / "run")
    (finding,) = analysed(robot, f"bag: run, country: DE, {stated}", "limits: {Video: P30D}").findings
    assert (finding.kind, finding.leak.name, finding.reason) == ("storage-limitation", "run1", why)
    assert [step.grants[0].place.line for step in finding.steps][-1] == 5


@pytest.mark.parametrize(
    ("retention", "today", "ended"),
    [
        ("P30D", "2023-12-14", ""),
        ("P30D", "2023-12-15", "2023-12-14"),
        ("P1M", "2023-12-15", "2023-12-14"),
        ("P900Y", "2026-01-01", ""),
        ("{Video: P30D, Voice: P1D}", "2023-12-14", ""),
        ("{Video: P30D, Voice: P1D}", "2024-01-01", "2023-12-14"),
    ],
)
def test_a_recording_that_is_older_than_it_is_kept_is_a_finding(
    robot: Path, retention: str, today: str, ended: str
) -> None:
    """S10: the bag is still there, whatever the label file says of how long it is kept; on the day that is asked."""
    rosbag2(robot / "run")
    stated = f"bag: run, country: DE, retention: {retention}"
    found = analysed(robot, stated, "limits: {Video: P900Y}", today=today).findings
    kept = "P30D" if "P30D" in retention else retention
    why = f"it holds recordings from 2023-11-14, and the {kept} for which they are kept ended on {ended}"
    assert [(one.kind, one.reason) for one in found] == ([("storage-limitation", why)] if ended else [])


def test_the_oldest_bag_of_a_folder_counts_whatever_the_others_say(robot: Path) -> None:
    """S11: that one bag does not tell its time hides no other that does; and that one is told."""
    rosbag2(robot / "runs" / "1")
    rosbag2(robot / "runs" / "2")
    metadata = robot / "runs" / "2" / "metadata.yaml"
    text = metadata.read_text().replace("1700000000000000000", "0").replace("2.mcap", "2.mcap.zstd")
    metadata.write_text(text)
    (robot / "runs" / "2" / "2.mcap").rename(robot / "runs" / "2" / "2.mcap.zstd")
    result = analysed(robot, "bag: runs, country: DE, retention: P1D", today="2024-01-01")
    assert [one.kind for one in result.findings] == ["storage-limitation"]
    (gap,) = [said.message for said in result.diagnostics if said.code == "bag-gap"]
    assert gap == f"nothing says when the bag {robot / 'runs' / '2'} was recorded, so its age is not judged"


def test_what_is_recorded_of_actions_and_through_wildcards(robot: Path) -> None:
    """S3, S4: a name that only a wildcard writes, and a part of an action."""
    for name in ("/log/b", "/spin/_action/status"):
        bag = rosbag2(robot / name.replace("/", ""), "sqlite3", {name: (IMAGE, 1)})
        result = analysed(robot, f"bag: {bag.name}, retention: P1D, country: DE, conduit: [Video]")
        assert (holds(result), codes(result)) == (["Video"], ["recording"])


def test_a_topic_that_no_policy_names_is_told_by_name(robot: Path, cli: Cli) -> None:
    """S11: what is in it is not known, so there is no 'no leak found'."""
    rosbag2(robot / "run", topics={"/odom": (ODOMETRY, 1), "/other\x1b": (IMAGE, 1), "/unsent": (IMAGE, 0)})
    result = analysed(robot, "bag: run, retention: P1D, country: DE", "  gone: {kind: external-system, country: DE}")
    (warning,) = [said for said in result.diagnostics if said.code == "bag-gap"]
    assert "1 topic of the bag" in warning.message
    assert "that no policy names: /other\\x1b; name the policies" in warning.message
    done = cli("analyze", robot / "a.policy.xml", "-l", robot / "l.yaml")
    assert done.returncode == 4
    assert "that no policy names: /other\\x1b" in done.stderr + done.stdout


@pytest.mark.parametrize("harm", ["cut", "attachment", "unreadable file beside"])
def test_no_answer_rests_on_half_a_bag(robot: Path, cli: Cli, harm: str) -> None:
    """All that is known of it is harmless; the same bag whole makes 'no leak found'."""
    labels = "nodes: {/cam: {source: {Video: [/camera]}, leak: [Voice]}, /nav: conduit}\nchannels: {/camera: sensitive}"
    (robot / "bags").mkdir()
    bag = mcap(robot / "bags" / "a.mcap", attachment="x" if harm == "attachment" else "")
    (robot / "l.yaml").write_text(
        f"labels: 1\n{labels}\nelements:\n  run1: {{kind: storage, bag: bags, retention: P900Y, country: DE,"
        " conduit: [Video]}\nlimits: {Video: P900Y}\n"
    )
    if harm == "cut":
        bag.write_bytes(bag.read_bytes()[:-20])
    elif harm != "attachment":
        (robot / "bags" / "b.db3").write_bytes(b"no database")
    verdict = rosprivacy.analyze(robot / "a.policy.xml", robot / "l.yaml").analysis.verdict
    assert verdict == "undetermined"
    assert "not all is known of the bag" in cli("analyze", robot / "a.policy.xml", "-l", robot / "l.yaml").stdout
    sarif = json.loads(cli("analyze", robot / "a.policy.xml", "-l", robot / "l.yaml", "-f", "sarif").stdout)
    assert [one["ruleId"] for one in sarif["runs"][0]["results"]] == ["bag-gaps", "doubt-backups-not-stated"]
    for file in (robot / "bags").iterdir():
        file.unlink()
    mcap(robot / "bags" / "a.mcap")
    assert rosprivacy.analyze(robot / "a.policy.xml", robot / "l.yaml").analysis.verdict == "no-leak-found"


@pytest.mark.parametrize(
    ("stated", "problem"),
    [
        ("bag: nowhere", "bag .*nowhere: bag not found; correct the path"),
        ("bag: ../out", r"'../out' leaves the folder .*; move the file inside it, or widen with --include-root"),
        ("bag: link", "'link' leaves the folder"),
        ("bag: l.yaml", "bag .*l.yaml: this is a label file, and not a bag"),
        ("bag: empty", "bag .*empty: a folder without a bag"),
        ("bag: [run]", "bag takes a path, not 'a list'"),
        ("bag: ''", "bag takes a path"),
        ('bag: "a\\u202eb"', "bag takes a path"),
    ],
)
def test_a_bag_that_cannot_be_read_is_an_error_at_its_line(robot: Path, cli: Cli, stated: str, problem: str) -> None:
    folder = robot / "in"
    folder.mkdir()
    (robot / "a.policy.xml").rename(folder / "a.policy.xml")
    rosbag2(robot / "out")
    (folder / "link").symlink_to(robot / "out")
    (folder / "empty").mkdir()
    with pytest.raises(InputErrors, match=rf"l.yaml:5: {problem}"):
        analysed(folder, stated)
    assert refused(cli("analyze", folder / "a.policy.xml", "-l", folder / "l.yaml"))


def test_the_folder_can_be_widened(robot: Path) -> None:
    folder = robot / "in"
    folder.mkdir()
    (robot / "a.policy.xml").rename(folder / "a.policy.xml")
    rosbag2(robot / "out")
    assert holds(analysed(folder, "bag: ../out, country: DE", include_root=str(robot))) == ["Video"]


def test_only_a_storage_is_a_bag(robot: Path) -> None:
    (robot / "l.yaml").write_text("labels: 1\nelements: {x: {kind: display, bag: run}}\n")
    with pytest.raises(InputErrors, match="unknown key 'bag'"):
        rosprivacy.analyze(robot / "a.policy.xml", robot / "l.yaml")


def test_a_fleet_says_it_of_a_robot(robot: Path) -> None:
    """The label file of a robot may name a bag; the fleet file, which is about no robot, may not."""
    rosbag2(robot / "run")
    analysed(robot, "bag: run, country: DE, retention: P1D")
    fleet = robot / "fleet.yaml"
    spec = "{policies: [a.policy.xml], labels: [l.yaml]}"
    fleet.write_text(f"fleet: 1\nrobots:\n  r1: {spec}\n  r2: {spec}\n")
    result = rosprivacy.analyze_fleet(fleet)
    assert holds(result) == ["Video"]
    assert codes(result) == ["recording"]
    fleet.write_text(f"fleet: 1\nrobots:\n  r1: {spec}\nelements: {{x: {{kind: storage, bag: run}}}}\n")
    with pytest.raises(InputErrors, match=r"fleet.yaml:4: a bag in a fleet file; state the storage in a label file"):
        rosprivacy.analyze_fleet(fleet)


def test_a_saved_graph_and_the_same_labels_give_the_same(robot: Path, cli: Cli) -> None:
    rosbag2(robot / "run", topics={"/camera": (IMAGE, 1), "/other": (IMAGE, 1)})
    document = analysed(robot, "bag: run, country: DE, retention: P900Y").document()
    saved = robot / "graph.json"
    done = cli("analyze", robot / "a.policy.xml", "--save-graph", saved)
    assert done.returncode == 4, done.stderr
    again = cli("analyze", "--add", saved, "-l", robot / "l.yaml", "--format", "json")
    whole = json.loads(again.stdout)
    for part in ("outside", "findings", "diagnostics"):
        assert whole[part] == json.loads(json.dumps(document[part])), part
