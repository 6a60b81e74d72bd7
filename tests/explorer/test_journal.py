"""What was said is not lost: it outlives the session, is offered again, and a full disk is told."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from random import Random
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.files_read import one_run
from rosprivacy.explorer.edited_file import SavedFile
from rosprivacy.explorer.edits import Edit
from rosprivacy.explorer.journal import read_journal
from rosprivacy.explorer.session import Session
from tests.helpers.factory import FACTORY
from tests.helpers.full_disk import full_disk

if TYPE_CHECKING:
    from pathlib import Path

BEFORE = str(FACTORY / "before.policy.xml")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    shutil.copy(FACTORY / "run2.labels.yaml", tmp_path / "labels.yaml")
    return tmp_path / "labels.yaml"


def begun(file: Path, *, resume: bool = False) -> Session:
    return Session.open([BEFORE], [str(file)], journal=file.parent / "state", resume=resume)


def journals(file: Path) -> list[Path]:
    return sorted((file.parent / "state").glob("*.jsonl"))


def test_who_says_nothing_leaves_nothing(file: Path) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    session.undo()
    assert session.history.unsaved_from_before is None
    session.close()
    assert list((file.parent / "state").iterdir()) == []


def test_what_was_not_saved_is_offered_and_made_again(file: Path) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    session.label("/archive_server", leak="Voice", note="häßlich\n")
    session.undo()
    session.redo()
    entries, told = session.entries, session.result.to("json1")
    session.close()
    second = begun(file)
    offered = second.history.unsaved_from_before
    assert offered is not None
    assert not offered.changed
    assert not offered.torn
    assert second.edits == ()
    assert second.history.resume() == ()
    assert second.entries == entries
    assert second.result.to("json1") == told
    assert second.history.unsaved_from_before is None
    second.close()
    third = begun(file, resume=True)  # the second one was not saved either
    assert third.entries == entries
    assert isinstance(third.save(), SavedFile)
    assert journals(file) == []
    third.undo()  # of what is saved
    third.close()
    last = begun(file, resume=True)
    assert last.entries["nodes", "/archive_server"] == {"leak": ["Video"]}


def test_edits_of_another_file_are_a_merge(file: Path) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    session.close()
    file.write_text(file.read_text().replace("/navigator: conduit", "/navigator: {leak: [Video]}"))
    second = begun(file, resume=True)
    offered = second.history.unsaved_from_before
    assert offered is not None
    assert offered.changed
    assert second.edits == ()  # nothing is made in silence
    assert second.history.resume() == ()
    assert second.entries["nodes", "/robot_camera"] == "conduit"
    assert second.entries["nodes", "/navigator"] == {"leak": ["Video"]}


def test_what_cannot_be_made_again_stays_offered(file: Path) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    session.label("/archive_server", conduit=True)
    session.close()
    shutil.copytree(FACTORY, file.parent / "factory")
    policy = file.parent / "factory" / "p.xml"
    policy.write_text(FACTORY.joinpath("before.policy.xml").read_text().replace("archive_server", "cloud"))
    file.write_text(file.read_text().replace("archive_server", "cloud"))
    second = Session.open([str(policy)], [str(file)], journal=file.parent / "state")
    (why,) = second.history.resume()
    assert "'/archive_server' matches no node" in why
    assert [edit.name for edit in second.edits] == ["/robot_camera"]
    offered = second.history.unsaved_from_before
    assert offered is not None
    assert [edit.name for edit in offered.edits] == ["/archive_server"]


def test_two_sessions_of_one_file_are_told(file: Path) -> None:
    first, second = begun(file), begun(file)
    first.label("/robot_camera", conduit=True)
    second.label("/navigator", leak="Video")
    assert len(journals(file)) == 2
    third = begun(file)
    assert third.history.unsaved_from_before is None  # of sessions that run nothing is taken
    for session in (first, second, third):
        session.close()
    assert begun(file).history.unsaved_from_before is not None


@pytest.mark.parametrize("cut", [1, 7, 30])
def test_a_line_that_was_cut_off_is_left_out_and_told(file: Path, cut: int) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    session.label("/archive_server", conduit=True)
    session.close()
    (journal,) = journals(file)
    journal.write_bytes(journal.read_bytes()[:-cut])
    again = begun(file)
    offered = again.history.unsaved_from_before
    assert offered is not None
    names = [edit.name for edit in offered.edits]
    assert names == ["/robot_camera", "/archive_server"][: 2 if cut == 1 else 1]
    assert offered.torn == (cut > 1)
    assert ("cannot be read" in "".join(again.history.remarks)) == (cut > 1)


@pytest.mark.parametrize(
    "line", ["[]", "{}", "null", "[1, 2, 3]", '["nodes", 1, null]', '["roles", "/a", null]', "[" * 100_000, "\x00", "ß"]
)
def test_what_is_no_line_of_a_journal_is_counted(tmp_path: Path, line: str) -> None:
    head = json.dumps({"rosprivacy.session": 1, "labels": "", "policies": ""})
    (tmp_path / "j").write_text(f'{head}\n{line}\n["nodes", "/a", "conduit"]\n', "utf-8")
    left = read_journal(tmp_path / "j")
    assert (left.edits, left.torn) == ((Edit("nodes", "/a", "conduit"),), 1)


def test_a_journal_that_cannot_be_read_stays_and_is_told(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    session.close()
    monkeypatch.setattr("rosprivacy.explorer.journal.MOST_READ", 10)
    again = begun(file)
    assert again.history.unsaved_from_before is None
    assert "cannot be read" in again.history.remarks[0]
    again.close()
    assert len(journals(file)) == 1


@pytest.mark.slow
def test_a_journal_is_bounded(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rosprivacy.explorer.journal.LONGEST", 2000)
    session = begun(file)
    for number in range(100):
        session.label("/robot_camera", leak="Video", note=str(number))
    (journal,) = journals(file)
    assert journal.stat().st_size < 3000
    assert read_journal(journal).edits == session.edits[-1:]


def test_a_full_disk_loses_nothing_and_is_told(file: Path) -> None:
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    old = file.read_bytes()
    with full_disk(200):
        session.label("/archive_server", leak="Video", note="why " * 50)
        assert "edits are in this session only" in session.history.remarks[-1]
        with pytest.raises(InputError, match="cannot be written"):
            session.save()
    assert file.read_bytes() == old
    assert session.unsaved == 2
    session.label("/navigator", leak="Video")  # there is room again: all of it is written down
    (journal,) = journals(file)
    assert {edit.name for edit in read_journal(journal).edits} == {"/robot_camera", "/archive_server", "/navigator"}
    assert isinstance(session.save(), SavedFile)


def test_a_folder_that_cannot_be_made_is_told(file: Path) -> None:
    (file.parent / "state").write_text("a file")
    session = begun(file)
    session.label("/robot_camera", conduit=True)
    assert "edits are in this session only" in session.history.remarks[0]


def test_a_command_can_save_twice(file: Path) -> None:
    with one_run():
        session = begun(file)
        for name in ("/robot_camera", "/archive_server"):
            session.label(name, conduit=True)
            assert isinstance(session.save(), SavedFile)
    assert file.read_text().count("conduit") == 4


VICTIM = """
import sys
from pathlib import Path
from rosprivacy.explorer.session import Session
session = Session.open([sys.argv[1]], [sys.argv[2]], journal=Path(sys.argv[3]))
for number in range(1000):
    session.label("/robot_camera", leak="Video", note=str(number))
    print("said", number, flush=True)
    if number % 3 == 2:
        session.save()
        print("saved", number, flush=True)
"""


def killed(file: Path, lines: int) -> tuple[int, int]:
    """Kill a session after so many lines; return the last that was said, and the last that was saved."""
    arguments = [sys.executable, "-c", VICTIM, BEFORE, str(file), str(file.parent / "state")]
    done = {"said": -1, "saved": -1}
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as victim:
        assert victim.stdout is not None
        for _, line in zip(range(lines), victim.stdout, strict=False):
            what, number = line.split()
            done[what] = int(number)
        victim.kill()
        for line in victim.stdout:  # what it had said before it was killed
            what, number = line.split()
            done[what] = int(number)
    return done["said"], done["saved"]


def holds_after_a_kill(file: Path, lines: int) -> None:
    said, saved = killed(file, lines)
    session = begun(file, resume=True)
    entry = session.entries["nodes", "/robot_camera"]
    offered = session.history.unsaved_from_before  # offered still if it was killed between file and journal
    last = max([int(entry.get("note", -1))] + [int(edit.value["note"]) for edit in (offered.edits if offered else ())])
    assert said <= last <= said + 1
    in_file = Session.open([BEFORE], [str(file)]).entries["nodes", "/robot_camera"]
    assert int(in_file.get("note", -1)) >= saved
    session.history.forget()
    while session.undo():
        pass
    session.close()
    shutil.copy(FACTORY / "run2.labels.yaml", file)


@pytest.mark.slow
def test_a_killed_session_has_lost_nothing(file: Path) -> None:
    random = Random(1)  # noqa: S311 - repeatable
    for _ in range(3):
        holds_after_a_kill(file, random.randrange(1, 12))


@pytest.mark.slow
def test_sessions_killed_again_and_again_have_lost_nothing(file: Path, *, thorough: bool) -> None:
    random = Random(2)  # noqa: S311 - repeatable
    for _ in range(60 if thorough else 20):
        holds_after_a_kill(file, random.randrange(1, 25))
