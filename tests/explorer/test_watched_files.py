"""A session knows which files, of those that its answer rests on, are no longer what it read."""

from __future__ import annotations

import os
import shutil
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.explorer.edited_file import SavedFile, digest_of
from rosprivacy.explorer.session import Session
from rosprivacy.explorer.watched_files import WatchedFiles
from rosprivacy.settings import Settings
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>/image</topic></topics></profile>
<profile ns="/" node="recorder"><topics subscribe="ALLOW"><topic>/image</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
SOURCE = "labels: 1\nnodes: {/camera: {source: [Video]}}\n"
CONDUIT = "labels: 1\nnodes: {/recorder: conduit}\n"
LEAK = "labels: 1\nnodes: {/recorder: {leak: [Video]}}\n"
TYPES = "types: 1\nobserved: {from: 2026-01-01, to: 2026-01-02, by: [me]}\nchannels: {/image: sensor_msgs/msg/Image}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Session:
    """One robot with two label files, of which the first is edited."""
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "a.yaml").write_text(SOURCE)
    (tmp_path / "b.yaml").write_text(CONDUIT)
    return Session.open([str(tmp_path / "p.xml")], [str(tmp_path / "a.yaml"), str(tmp_path / "b.yaml")])


@pytest.fixture
def fleet(tmp_path: Path) -> Session:
    """Two robots that are alike, since their own label files say the same."""
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "model.yaml").write_text(SOURCE)
    for name in ("one.yaml", "two.yaml"):
        (tmp_path / name).write_text(CONDUIT)
    (tmp_path / "fleet.yaml").write_text(
        "fleet: 1\nmodels:\n  cart: {policies: [p.xml], labels: [model.yaml]}\n"
        "robots:\n  r1: {model: cart, labels: [one.yaml]}\n  r2: {model: cart, labels: [two.yaml]}\n"
    )
    return Session.open_fleet(str(tmp_path / "fleet.yaml"))


def test_a_label_file_that_is_not_edited_is_told_and_the_answer_stays(robot: Session, tmp_path: Path) -> None:
    assert list(robot.changed_inputs) == []
    (tmp_path / "b.yaml").write_text(LEAK)
    assert list(robot.changed_inputs) == [str(tmp_path / "b.yaml")]
    assert robot.changed_on_disk() is None
    assert str(robot.verdict) != "leak"
    (tmp_path / "b.yaml").write_text(CONDUIT)  # as it was read
    assert list(robot.changed_inputs) == []


def test_a_file_is_told_after_labels_saving_and_merging_too(robot: Session, tmp_path: Path) -> None:
    robot.label("/recorder", source="Voice")
    assert list(robot.changed_inputs) == []
    (tmp_path / "p.xml").unlink()
    assert isinstance(robot.save(), SavedFile)
    assert list(robot.changed_inputs) == [str(tmp_path / "p.xml")]
    (tmp_path / "a.yaml").write_text(SOURCE)
    robot.merge()
    assert list(robot.changed_inputs) == [str(tmp_path / "p.xml")]  # and not the edited one, which was taken in


def test_decisions_and_vocabularies_are_among_what_an_answer_rests_on(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "a.yaml").write_text(SOURCE + "  \n")
    (tmp_path / "d.yaml").write_text("decisions: 1\nfindings: []\n")
    settings = Settings(decisions=str(tmp_path / "d.yaml"))
    session = Session.open([str(tmp_path / "p.xml")], [str(tmp_path / "a.yaml")], settings)
    session.label("/recorder", leak="Video")
    session.decide(session.findings[0].id, "mitigate")
    assert list(session.changed_inputs) == []  # what the session writes, it knows
    (tmp_path / "d.yaml").write_text("decisions: 1\n")
    assert list(session.changed_inputs) == [str(tmp_path / "d.yaml")]


def test_labels_from_memory_are_no_file(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(POLICY)
    labels = [rosprivacy.parse_labels(SOURCE), rosprivacy.parse_labels(CONDUIT, name="more")]
    assert Session.open([str(tmp_path / "p.xml")], labels).changed_inputs == ()


@pytest.mark.parametrize("name", ["two.yaml", "p.xml", "fleet.yaml", "model.yaml"])
def test_each_file_of_a_fleet_is_told_also_one_that_another_was_read_for(
    fleet: Session, tmp_path: Path, name: str
) -> None:
    assert list(fleet.changed_inputs) == []
    with (tmp_path / name).open("a") as file:
        file.write("\n")
    assert list(fleet.changed_inputs) == [str(tmp_path / name)]


def test_a_label_file_that_was_answered_into_is_told_as_one_that_can_be_taken_in(
    fleet: Session, tmp_path: Path
) -> None:
    fleet.label("r2:/recorder", conduit=True, note="seen", only_this_robot=True)
    assert list(fleet.changed_inputs) == []
    (tmp_path / "two.yaml").write_text(LEAK)
    assert list(fleet.changed_inputs) == []
    changed = fleet.changed_on_disk()
    assert changed
    assert changed.file == str(tmp_path / "two.yaml")
    fleet.merge()
    assert (fleet.changed_inputs, fleet.changed_on_disk()) == ((), None)
    (tmp_path / "one.yaml").write_text(LEAK)
    assert isinstance(fleet.save(), SavedFile)
    assert list(fleet.changed_inputs) == [str(tmp_path / "one.yaml")]


def test_nothing_is_told_of_the_examples() -> None:
    hospital = rosprivacy.explore(fleet=ROOT / "examples" / "fleet" / "fleet.yaml")
    factory = ROOT / "examples" / "factory"
    assert list(hospital.changed_inputs) == []
    assert rosprivacy.explore(factory / "before.policy.xml", factory / "run2.labels.yaml").changed_inputs == ()


def test_a_signed_file_is_told_when_it_changes_and_not_before(tmp_path: Path) -> None:
    """What is read is the text within: its hash is not that of the file."""
    keystore = shutil.copytree(ROOT / "tests" / "cases" / "unprotected" / "keystore", tmp_path / "keystore")
    session = Session.open([str(keystore)])
    assert list(session.changed_inputs) == []
    file = keystore / "enclaves" / "camera" / "permissions.p7s"
    file.write_bytes(file.read_bytes() + b"\n")
    assert list(session.changed_inputs) == [str(file)]


def test_a_file_that_looks_as_before_is_not_read_again(tmp_path: Path) -> None:
    """A change that looks like none is known by the time that the system keeps itself."""
    file = tmp_path / "a.yaml"
    file.write_text("one")
    read = [(str(file), digest_of(b"one"))]
    watched = WatchedFiles()
    assert watched.changed(read) == ()
    file.write_text("two")
    os.utime(file, (1, 1))
    assert watched.changed(read) == (str(file),)
    assert watched.changed([("rosprivacy:standard", "0")]) == ()
    assert watched.changed([(os.devnull, "0")]) == ()  # what can be read only once is not read again
