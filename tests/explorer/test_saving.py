"""Saving changes the lines that the edits are about, and no byte beside them."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputError
from rosprivacy.explorer.edited_file import Conflict, SavedFile
from rosprivacy.explorer.session import Session
from rosprivacy.ingest.labels.edited_entries import SaidOfElement
from rosprivacy.ingest.labels.label_writer import with_entries
from tests.helpers.factory import FACTORY
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

BEFORE = str(FACTORY / "before.policy.xml")
LINES = 449


@pytest.mark.slow
def test_three_edits_change_three_lines_of_449(cli: Cli, corpus: Path, tmp_path: Path) -> None:
    policy = str(corpus / TURTLEBOT3)
    file = tmp_path / "tb3.labels.yaml"
    assert cli("labels", "--init", policy, "-o", file).returncode == 0
    lines = file.read_text("utf-8").splitlines()
    lines = [line for line in lines if "yaml-language-server" not in line]
    assert len(lines) < LINES
    at = lines.index("nodes:")
    lines[at:at] = [f"# Remark {number}: who drives looks ahead." for number in range(LINES - len(lines))]
    file.write_text("\n".join(lines) + "\n", "utf-8")
    session = Session.open([policy], [str(file)])
    session.label("/turtlebot3_laserscan", source="HomeMap")
    session.label("/amcl", conduit=True)
    session.label("/map", kind="topic", sensitive=True)
    saved = session.save()
    assert isinstance(saved, SavedFile)
    assert (saved.lines, saved.remarks) == (3, ())
    after = file.read_text("utf-8").splitlines()
    changed = [(old, new) for old, new in zip(lines, after, strict=True) if old != new]
    assert len(after) == LINES
    assert len(changed) == 3
    for old, new in changed:
        name, _, remark = old.partition(":")
        assert new.startswith(f"{name}: ")
        assert new.endswith(remark.strip())  # its comment
    assert session.result.to("json1") == rosprivacy.analyze(policy, file).to("json1")


ODD = """\
# A file as people write them.
labels:   1
author: "Ada Judge"

nodes:   # who does what
    /robot_camera:   {source: [Video]}      # the old one
    /archive_server:
        leak:
            - Video     # to the cloud
        note: far away
        # until June
    '/navigator': conduit


channels:
    "/robot_video":    sensitive


# the end
"""


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_odd_spaces_stay(tmp_path: Path, end: str) -> None:
    file = tmp_path / "l.yaml"
    file.write_bytes(ODD.replace("\n", end).encode("utf-8-sig"))
    session = Session.open([BEFORE], [str(file)])
    session.label("/navigator", leak="Video")
    session.label("/new_pose", kind="topic", mundane=True)
    assert isinstance(session.save(), SavedFile)
    wanted = ODD.replace("'/navigator': conduit", "'/navigator': {leak: [Video]}")
    after = file.read_bytes().decode("utf-8")
    assert after.startswith("\ufefflabels" if ODD.startswith("labels") else "\ufeff#")
    kept = [line for line in wanted.splitlines() if line in after]
    assert kept == wanted.splitlines()
    assert [line for line in after.removeprefix("\ufeff").split(end) if line not in wanted.splitlines()] == [
        "topics:",
        "    /new_pose: mundane",
    ]


def test_a_comment_of_a_line_that_goes_stands_above(tmp_path: Path) -> None:
    file = tmp_path / "l.yaml"
    file.write_text(ODD)
    session = Session.open([BEFORE], [str(file)])
    session.label("/archive_server", conduit=True, note="")
    saved = session.save()
    assert isinstance(saved, SavedFile)
    assert "stand above the entry" in saved.remarks[0]
    after = file.read_text()
    assert "    # to the cloud\n" in after
    assert "# until June" in after
    assert session.result.to("json1") == rosprivacy.analyze(BEFORE, file).to("json1")


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ('{"labels": 1, "nodes": {"/a": "conduit"}}', '{"labels": 1, "nodes": {"/a": {"leak": ["Video"]}}}'),
        ('{\n  "labels": 1,\n  "nodes": {"/a": "conduit"}\n}\n', None),
        ("labels: 1\nnodes: {/a: conduit}\n", "labels: 1\nnodes: {/a: {leak: [Video]}}\n"),
        ("labels: 1\nnodes:\n", "labels: 1\nnodes:\n  /a: {leak: [Video]}\n"),
        ("labels: 1", "labels: 1\nnodes:\n  /a: {leak: [Video]}\n"),
        ("labels: 1\nnodes:\n  /a: {source: [Voice]}\n  # mine\n  /b: conduit", None),
    ],
)
def test_forms_of_files(text: str, wanted: str | None) -> None:
    new = with_entries("l", text, [SaidOfElement("nodes", "/a", {"leak": ["Video"]})])
    if wanted is not None:
        assert new.text == wanted
    entries = {entry.name: entry for entry in rosprivacy.parse_labels(new.text).entries}
    assert [said.role for said in entries["/a"].statements] == ["leak"]
    assert ("# mine" in text) == ("# mine" in new.text)


def test_the_six_lists_are_not_edited(tmp_path: Path) -> None:
    lists = tmp_path / "six.json"
    lists.write_text('{"source": ["/safety_camera"], "leak": [], "conduit": [], "sanitizer": [], "mundane": []}')
    session = Session.open([BEFORE], [str(lists)])
    session.label("/archive_server", leak="Video")
    with pytest.raises(InputError, match="no file to be saved in"):
        session.save()
    both = Session.open([BEFORE], [str(lists), str(tmp_path / "mine.yaml")])
    both.label("/archive_server", leak="Video")
    assert isinstance(both.save(), SavedFile)
    assert (tmp_path / "mine.yaml").read_text() == "labels: 1\nnodes:\n  /archive_server: {leak: [Video]}\n"
    assert "labels" not in lists.read_text()


def test_a_file_that_appears_meanwhile_is_not_written_over(tmp_path: Path) -> None:
    file = tmp_path / "l.yaml"
    session = Session.open([BEFORE], [str(file)])
    session.label("/archive_server", leak="Video")
    shutil.copy(FACTORY / "run2.labels.yaml", file)
    assert isinstance(session.save(), Conflict)
    assert session.changed_on_disk()
    session.merge()
    assert session.changed_on_disk() is None
    assert isinstance(session.save(), SavedFile)
    file.unlink()
    assert isinstance(session.save(), Conflict)  # gone is changed, too


def test_save_as_writes_over_nothing(tmp_path: Path) -> None:
    file = tmp_path / "l.yaml"
    shutil.copy(FACTORY / "run2.labels.yaml", file)
    session = Session.open([BEFORE], [str(FACTORY / "run2.labels.yaml")])
    session.label("/archive_server", conduit=True)
    with pytest.raises(InputError, match="is there already"):
        session.save_as(str(file))
    session.save_as(str(tmp_path / "new.yaml"))
    assert "/archive_server: conduit" in (tmp_path / "new.yaml").read_text()
    assert session.unsaved == 1  # the file of the session is as it was
