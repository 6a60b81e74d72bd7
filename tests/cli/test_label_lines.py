"""``labels --update`` and ``labels --next``: lines into a person's file, which keeps the rest (S11, S13)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import yaml

import rosprivacy
from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import NewLine, with_lines
from rosprivacy.labelling.label_lines import next_lines
from rosprivacy.ontology.vocabulary import load
from rosprivacy.settings import Settings
from tests.helpers.policies import policy
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

OURS = """\
# our robot

labels: 1
nodes:
  # who looks
  /robot_camera: {source: [Video]}   # on the arm
  /archive_server:
    leak: [Video]  # on a disk

# what it says
topics:
  "/safety_*": sensitive
"""
STEP_5 = "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations/categorization_turtlebot3_step_5.json"
OFFICE = "policies/open-rmf__rmf_demos/rmf_demos/sros2/policies/office.policy.xml"


def labels_of(file: Path) -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load(file.read_text("utf-8"))
    return found


@pytest.fixture
def factory(examples: Path, tmp_path: Path) -> tuple[str, Path]:
    (tmp_path / "l.yaml").write_text(OURS)
    return str(examples / "factory" / "before.policy.xml"), tmp_path / "l.yaml"


def test_update_adds_what_no_line_speaks_of_and_keeps_the_rest(cli: Cli, factory: tuple[str, Path]) -> None:
    policy, file = factory
    done = cli("labels", "--update", policy, "-l", file)
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr.endswith(" lines added\n")
    text = file.read_text("utf-8")
    kept = [line for line in text.splitlines() if line in OURS.splitlines()]
    assert kept == OURS.splitlines()  # every line, comment and blank, in its order
    graph = rosprivacy.analyze(policy).analysis.graph
    said = labels_of(file)
    assert set(said["nodes"]) == {e.name for e in graph.elements if e.is_node}
    assert {"/safety_*", "/new_pose", "/robot_video"} == set(said["topics"])  # the glob speaks of /safety_video
    assert set(said["services"]) == {"/save_footage", "/stop_arm"}  # no standard channel
    again = cli("labels", "--update", policy, "-l", file)
    assert again.stderr.endswith(": 0 lines added\n")
    assert file.read_text("utf-8") == text


def test_update_tells_of_lines_that_match_nothing_any_more(cli: Cli, factory: tuple[str, Path]) -> None:
    policy, file = factory
    file.write_text(f"{OURS}services:\n  /gone: mundane\n")
    done = cli("labels", "--update", policy, "-l", file, "-o", file.parent / "new.yaml")
    assert done.returncode == 0
    assert "l.yaml:14: '/gone' matches no service of the policies" in done.stderr
    assert file.read_text("utf-8") == f"{OURS}services:\n  /gone: mundane\n"  # with -o it stays
    assert labels_of(file.parent / "new.yaml")["services"]["/gone"] == "mundane"


def test_update_writes_out_what_a_glob_said_before_it_lost_its_rank(cli: Cli, factory: tuple[str, Path]) -> None:
    """Rule S13: a glob with an open end no longer outranks the standard channels."""
    policy, file = factory
    file.write_text('labels: 1\nnodes: {/robot_camera: {source: [Video]}}\nservices:\n  "/robot_camera/*": sensitive\n')
    before = rosprivacy.analyze(policy, str(file)).document()
    lost = {e["name"] for e in before["assumptions"]["standard_channels_unchanged"]}
    assert "/robot_camera/get_parameters" in lost
    done = cli("labels", "--update", policy, "-l", file)
    assert "/robot_camera/get_parameters is written out: as /robot_camera/* said before" in done.stderr
    after = rosprivacy.analyze(policy, str(file)).document()
    assert after["assumptions"]["standard_channels_unchanged"] == []
    reached = {row["element"]["name"] for row in after["carries"]}
    assert lost <= reached
    assert cli("labels", "--update", policy, "-l", file).stderr.endswith(": 0 lines added\n")


def test_next_begins_a_file_with_what_sounds_like_a_sensor(cli: Cli, factory: tuple[str, Path]) -> None:
    policy, file = factory
    file.unlink()
    assert cli("labels", "--next", policy, "-l", file).returncode == 0
    assert labels_of(file) == {"labels": 1, "nodes": {"/robot_camera": None, "/safety_camera": None}}


def test_where_no_name_sounds_like_a_sensor_it_says_how_to_name_a_source(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(policy('<topics publish="ALLOW"><topic>/x</topic></topics>'))
    done = cli("labels", "--next", "p.xml", "-l", "l.yaml", cwd=tmp_path)
    assert "l.yaml: no source is named; no node sounds like a sensor; say which, such as nodes: {" in done.stderr
    assert not (tmp_path / "l.yaml").exists()


def test_in_a_template_that_is_empty_the_candidates_are_told(cli: Cli, factory: tuple[str, Path]) -> None:
    policy, file = factory
    file.write_text(cli("labels", "--init", policy).stdout)
    done = cli("labels", "--next", policy, "-l", file)
    assert "no source is named; candidates by name: /robot_camera, /safety_camera; say which" in done.stderr
    assert done.stderr.endswith(": 0 lines added\n")


@pytest.mark.corpus
def test_the_candidates_begin_with_the_scanner(cli: Cli, corpus: Path, tmp_path: Path) -> None:
    """In the order of names the first five of TurtleBot3 left out its only sensor."""
    step = cli("analyze", corpus / TURTLEBOT3).stdout.splitlines()[-1]
    assert "by name: /turtlebot3_laserscan, /teleop_keyboard, /amcl, " in step
    file = tmp_path / "l.yaml"
    cli("labels", "--next", corpus / TURTLEBOT3, "-l", file)
    assert {"/turtlebot3_laserscan", "/slam_toolbox", "/lifecycle_manager_slam"} <= set(labels_of(file)["nodes"])


def test_next_writes_the_lines_of_the_next_round_with_where_data_comes_from(
    cli: Cli, tmp_path: Path, examples: Path
) -> None:
    policy, file = str(examples / "factory" / "before.policy.xml"), tmp_path / "l.yaml"
    file.write_text("labels: 1\nnodes:\n  /robot_camera: {source: [Video]}\n")
    assert cli("labels", "--next", policy, "-l", file).returncode == 0
    text = file.read_text("utf-8")
    assert "  /robot_video: # Video through /robot_camera; only past it: " in text
    assert text.startswith("labels: 1\nnodes:\n  /robot_camera: {source: [Video]}\n")
    offered = {q["element"]["name"] for q in rosprivacy.analyze(policy, str(file)).document()["open"]}
    said = labels_of(file)
    assert {name for names in list(said.values())[1:] for name in names} - {"/robot_camera"} <= offered


def test_what_data_comes_through_carries_that_data(cli: Cli, tmp_path: Path, examples: Path) -> None:
    """/robot_video is as near and carries Video only; the voice comes along another flow."""
    policy, file = str(examples / "factory" / "before.policy.xml"), tmp_path / "l.yaml"
    file.write_text(
        "labels: 1\nnodes:\n  /robot_camera: {source: [Video]}\n  /safety_camera: {source: [Voice]}\n"
        "  /navigator: {conduit: [Video]}\ntopics: {/robot_video: {only: [Video]}, /safety_video: {only: [Voice]}}\n"
        "flows:\n  - {from: /safety_camera, to: memory}\n  - {from: memory, to: /navigator}\n"
        "elements: {memory: {kind: shared-memory}}\n"
    )
    assert (
        "   /navigator  (node; 2 steps from a source; Voice through memory;"
        in cli("analyze", policy, "-l", file).stdout
    )


def test_a_source_is_asked_about_the_kinds_that_it_does_not_bring(cli: Cli, tmp_path: Path, examples: Path) -> None:
    policy, file = str(examples / "factory" / "before.policy.xml"), tmp_path / "l.yaml"
    file.write_text("labels: 1\nnodes:\n  /robot_camera: {source: [Video]}\n  /navigator: {source: [RobotPosition]}\n")
    asked = "a source of RobotPosition: if it passes on the rest, add conduit: [Video]"
    assert asked in cli("analyze", policy, "-l", file).stdout
    done = cli("labels", "--next", policy, "-l", file)
    assert f"l.yaml:4: /navigator is not reviewed: Video through /robot_video; {asked}" in done.stderr
    assert labels_of(file)["nodes"]["/navigator"] == {"source": ["RobotPosition"]}


def test_without_a_file_to_write_into_it_is_refused(cli: Cli, factory: tuple[str, Path]) -> None:
    for option in ("--update", "--next"):
        done = cli("labels", option, factory[0], "-l", "rosprivacy:infrastructure")
        assert done.returncode == 2
        assert "add -l labels.yaml" in done.stderr
    assert cli("labels", "--init", factory[0], "-l", factory[1]).returncode == 2


STATED = """labels: 1
context: [care]
purpose: {Video: safety}
nodes:
  /a: {source: [Video], purpose: help, legal_basis: [6(1)(f)], note: why, author: B}
elements:
  disk:
    kind: storage
    legal_basis: {Video: [6(1)(a)]}
flows: [{from: /a, to: disk}]
"""


@pytest.mark.parametrize(
    "text", [OURS, OURS.replace("\n", "\r\n"), STATED, "labels: 1\nnodes: {/a: conduit}\n", "labels: 1\n"]
)
def test_nothing_is_lost_and_nothing_but_the_lines_comes(text: str) -> None:
    lines = [NewLine("nodes", "/new", "why: # so"), NewLine("topics", "=/*"), NewLine("actions", "/go", "", "mundane")]
    new = with_lines("l.yaml", text, lines, load())
    old, entries = (parse_labels(t, load(), name="l").entries for t in (text, new))
    assert len(entries) == len(old) + 3
    assert [e.name for e in old] == [e.name for e in entries if e.name in {o.name for o in old}]
    assert ("\r\n" in new) == ("\r\n" in text)


def test_what_is_there_is_not_written_twice() -> None:
    with pytest.raises(LabelError, match="without changing another entry"):
        with_lines("l.yaml", OURS, [NewLine("nodes", "/robot_camera")], load())


# ---------------------------------------------------------------- what is left to review, on real policies


def left(document: dict[str, Any]) -> tuple[int, int]:
    """How many elements are open, and how many of them a person has to look at now."""
    now = [q for q in document["open"] if not (q["waits"] or q["infrastructure"])]
    return len(document["open"]), len(now)


@pytest.mark.slow
@pytest.mark.corpus
def test_turtlebot3_after_the_papers_step_5(corpus: Path, tmp_path: Path) -> None:
    """With /root dropped 144 elements stayed open, all of them listed as if they were alike."""
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes:\n  /root: {absent: an administrator's shell}\n")
    files = [str(corpus / STEP_5), str(tmp_path / "l.yaml")]
    policy = str(corpus / TURTLEBOT3)
    assert left(rosprivacy.analyze(policy, files[:1]).document()) == (257, 145)
    assert left(rosprivacy.analyze(policy, files).document()) == (144, 41)
    assert left(rosprivacy.analyze(policy, [*files, "rosprivacy:infrastructure"]).document()) == (67, 34)


@pytest.mark.slow
@pytest.mark.corpus
def test_rmf_office_is_labelled_from_nothing_in_four_rounds(corpus: Path, tmp_path: Path) -> None:
    """37 lines typed in five rounds. Now three lines are typed, the others are one word each."""
    policy, file = str(corpus / OFFICE), tmp_path / "l.yaml"
    said: dict[str, Any] = {
        "nodes": {
            "/slotcar": {"source": ["RobotPosition"], "conduit": ["DeliveryOrder"]},
            "/rmf_panel": {"source": ["DeliveryOrder"], "conduit": ["RobotPosition"]},
            "/rviz": {"leak": ["RobotPosition", "DeliveryOrder"]},
        }
    }
    rounds = words = 0
    document: dict[str, Any] = {"open": True}
    while document["open"]:
        file.write_text(yaml.safe_dump({"labels": 1, **said}))
        written = next_lines((policy,), (str(file),), Settings())
        said = {section: names for section, names in yaml.safe_load(written.text).items() if section != "labels"}
        for section, names in said.items():
            for name in [name for name, label in names.items() if label is None]:
                names[name] = "conduit" if section == "nodes" else "mundane" if "door" in name else "sensitive"
                words += 1
        rounds += 1
        file.write_text(yaml.safe_dump({"labels": 1, **said}))
        document = rosprivacy.analyze(policy, str(file)).document()
        assert rounds < 10
    assert document["verdict"] == "leak"
    assert rounds <= 4
    assert words <= 60
