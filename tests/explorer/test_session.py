"""A session: each edit means what editing the label file would mean, and can be taken back."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors, LabelError
from rosprivacy.explorer.edited_file import Conflict, SavedFile
from rosprivacy.explorer.edits import Edit
from rosprivacy.explorer.session import Session
from tests.helpers.factory import FACTORY

if TYPE_CHECKING:
    from pathlib import Path

BEFORE = str(FACTORY / "before.policy.xml")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    shutil.copy(FACTORY / "run2.labels.yaml", tmp_path / "labels.yaml")
    return tmp_path / "labels.yaml"


@pytest.fixture
def session(file: Path) -> Session:
    return Session.open([BEFORE], [str(file)])


def test_a_session_begins_as_the_analysis(session: Session, file: Path) -> None:
    assert session.result.to("json1") == rosprivacy.analyze(BEFORE, file).to("json1")
    assert not session.history.can_undo
    assert session.unsaved == 0


def test_paths_are_counted_when_somebody_asks_for_the_whole_answer(session: Session) -> None:
    """What each edit shows at once has no number of paths, and no format can tell one."""
    session.label("/robot_camera", conduit=True)
    for name in ("text", "json", "sarif", "turtle", "json-ld", "html", "markdown"):
        with pytest.raises(ValueError, match="nobody asked for the number of paths"):
            session.uncounted.to(name)
    whole = session.result
    assert [finding.disjoint_paths for finding in whole.findings] == [1]
    assert session.result is whole
    session.undo()
    assert [finding.disjoint_paths for finding in session.result.findings] == [1, 1]


def test_undo_and_redo_give_the_answers_that_were_there(session: Session) -> None:
    """They are kept, not made again, as long as the files are the same."""
    first = session.uncounted
    session.label("/robot_camera", conduit=True)
    second = session.uncounted
    session.undo()
    assert session.uncounted is first
    session.redo()
    assert session.uncounted is second
    session.save()  # the answer names the file with its hash
    session.undo()
    assert session.uncounted is not first


def test_what_was_said_stays_whatever_becomes_of_the_list_that_it_was_said_with(session: Session) -> None:
    kinds = ["Voice"]
    session.label("/navigator", leak=kinds)
    kinds[:] = ["Video"]
    assert session.entries["nodes", "/navigator"] == {"leak": ["Voice"]}
    session.undo()
    assert session.label("/navigator", leak=kinds).opened, "no answer of before: another label was said then"


def test_what_is_equal_and_not_the_same_has_an_answer_of_its_own(session: Session) -> None:
    """To Python 1 is True; no label file may say so."""
    disk = {"kind": "storage", "encrypted": True}
    session.label("disk", kind="storage", non_ros=disk)
    session.undo()
    with pytest.raises(InputErrors, match="encrypted"):
        session.label("disk", kind="storage", non_ros={**disk, "encrypted": 1})


def test_a_label_replaces_what_the_file_says(session: Session) -> None:
    change = session.label("/robot_camera", conduit=True)
    assert change.closed == ("dc5715a35ba5591a",)
    assert (session.version, session.unsaved, len(session.findings)) == (1, 1, 1)
    assert session.undo()
    assert not session.undo()
    assert (session.version, session.unsaved, len(session.findings)) == (2, 0, 2)
    assert session.redo()
    assert not session.history.can_redo
    assert len(session.findings) == 1


def test_what_else_an_entry_states_stays(session: Session) -> None:
    session.label("/safety_camera", source={"Video": ["/safety_video"]}, purpose="safety", note="seen")
    session.label("/safety_camera", source="Voice", by="A. Lee")
    said = {"source": ["Voice"], "purpose": "safety", "note": "seen", "author": "A. Lee"}
    assert session.entries["nodes", "/safety_camera"] == said
    session.label("/safety_camera", source="Voice", purpose="", note="")
    assert session.entries["nodes", "/safety_camera"] == {"source": ["Voice"], "author": "A. Lee"}


@pytest.mark.parametrize(
    ("name", "label", "problem"),
    [
        ("/nope", {"conduit": True}, "matches no node"),
        ("/robot_camera", {"leak": "Vidio"}, "unknown category"),
        ("/robot_camera", {"sanitizer": {"Video": "wash"}}, "sanitizer method"),
        ("/robot_camera", {"mundane": True, "note": "x"}, "unknown key 'never'"),
    ],
)
def test_a_wrong_label_changes_nothing(
    session: Session, name: str, label: rosprivacy.explorer.edits.Label, problem: str
) -> None:
    before = session.result
    with pytest.raises(InputErrors, match=problem) as raised:
        session.label(name, **label)
    assert all(type(error) is LabelError for error in raised.value.errors)
    assert session.result is before
    assert not session.edits


def test_one_label_answers_for_both_legs(session: Session) -> None:
    names = [question.name for question in session.questions()]
    assert len(names) == len(set(names))
    assert names[0] == "/robot_arm_control"


def test_saving_changes_the_lines_of_the_edits(session: Session, file: Path) -> None:
    before = file.read_text().splitlines()
    session.label("/archive_server", leak="Video", note="it is far")
    saved = session.save()
    assert isinstance(saved, SavedFile)
    after = file.read_text().splitlines()
    assert [line for line in after if line not in before] == ['  /archive_server: {leak: [Video], note: "it is far"}']
    assert len(after) == len(before)
    assert session.result.to("json1") == rosprivacy.analyze(BEFORE, file).to("json1")
    session.undo()
    session.save()
    assert file.read_text().splitlines() == before


def test_what_somebody_else_wrote_is_not_written_over(session: Session, file: Path) -> None:
    session.label("/robot_camera", conduit=True)
    theirs = file.read_text().replace("/navigator: conduit", "/navigator: {leak: [Video]}")
    file.write_text(theirs)
    conflict = session.save()
    assert isinstance(conflict, Conflict)
    assert "+  /navigator: {leak: [Video]}" in conflict.diff
    assert file.read_text() == theirs
    session.merge()
    assert isinstance(session.save(), SavedFile)
    assert file.read_text() == theirs.replace("/robot_camera: {source: [Video]}", "/robot_camera: conduit")


def test_what_somebody_else_said_of_the_same_element_is_told(session: Session, file: Path) -> None:
    session.label("/navigator", leak="Voice")
    file.write_text(file.read_text().replace("/navigator: conduit", "/navigator: {leak: [Video]}"))
    assert [edit[:3] for edit in session.merge()] == [("nodes", "/navigator", {"leak": ["Video"]})]
    session.undo()
    assert session.entries["nodes", "/navigator"] == {"leak": ["Video"]}


def test_what_was_saved_before_gives_way_to_what_somebody_else_said_later(session: Session, file: Path) -> None:
    session.label("/archive_server", conduit=True)
    session.save()
    theirs = file.read_text().replace("/archive_server: conduit", "/archive_server: {leak: [Video]}")
    file.write_text(theirs)
    assert session.merge() == ()
    assert session.unsaved == 0
    assert session.result.to("json1") == rosprivacy.analyze(BEFORE, file).to("json1")
    session.label("/navigator", leak="Video")
    session.save()
    assert "/archive_server: {leak: [Video]}" in file.read_text()


def test_what_was_undone_is_saved_although_nothing_is_written(session: Session, file: Path) -> None:
    session.label("/robot_camera", conduit=True)
    session.history.do(Edit("channels", "/not_there", None))  # says nothing anew
    session.save()
    session.undo()
    session.save()
    assert session.result.assumptions["labels"][0]["file"] == str(file)
    assert session.unsaved == 0


def test_a_session_without_a_file_is_saved_under_a_name(tmp_path: Path) -> None:
    session = rosprivacy.explore(BEFORE)
    session.label("/safety_camera", source="Video")
    with pytest.raises(rosprivacy.InputError, match="no file"):
        session.save()
    session.save_as(str(tmp_path / "new.yaml"))
    assert (tmp_path / "new.yaml").read_text() == "labels: 1\nnodes:\n  /safety_camera: {source: [Video]}\n"
    assert session.result.to("json1") == rosprivacy.analyze(BEFORE, tmp_path / "new.yaml").to("json1")
