"""Edits of a session mean what editing the label file means, whatever is done, undone, done again and saved."""

from __future__ import annotations

import json
import re
import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml
from hypothesis import Phase, given, reject, settings
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.explorer.edited_file import SavedFile
from rosprivacy.explorer.edits import Edit
from rosprivacy.explorer.questions import questions
from rosprivacy.explorer.session import Session
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import answer_robot
from tests.helpers.written_systems import NODES, TOPICS, Written, written

if TYPE_CHECKING:
    from collections.abc import Callable

NODE_LABELS: tuple[Any, ...] = (
    None, "conduit", {"source": ["Video"]}, {"source": ["Voice"], "leak": ["Video"]}, {"leak": ["Biometric"]},
    {"sanitizer": {"Video": "drop"}, "note": 'no: a "filter" # of ours', "author": "Ada Judge"},
    {"conduit": ["Video"], "note": "yes"}, {"derives": [{"from": "Video", "to": "FaceTemplate"}]},
    {"absent": "a test tool"}, {"source": {"Video": ["/a"]}}, {"leak": "none"},
    {"leak": ["Vidio"]}, {"leek": ["Video"]},
)  # fmt: skip
CHANNEL_LABELS: tuple[Any, ...] = (
    None, "mundane", "sensitive", {"only": ["Video"], "note": "on"}, {"never": ["Voice"]}, {"sensitive": ["Video"]}
)  # fmt: skip
DISKS: tuple[Any, ...] = (
    None, {"kind": "storage", "retention": "P30D"}, {"kind": "external-system", "country": "US"},
    {"kind": "storage", "encrypted": True, "leak": ["Video"]},
)  # fmt: skip


@st.composite
def edits(draw: st.DrawFn) -> Edit:
    section = draw(st.sampled_from(("nodes", "nodes", "channels", "topics", "elements")))
    if section == "nodes":
        return Edit(section, draw(st.sampled_from((*NODES, "=/n1", "/n*", "/m"))), draw(st.sampled_from(NODE_LABELS)))
    if section == "elements":
        return Edit(section, draw(st.sampled_from(("disk", "cloud"))), draw(st.sampled_from(DISKS)))
    names = (*TOPICS[:3], "=/a*", "/a*")
    return Edit(section, draw(st.sampled_from(names)), draw(st.sampled_from(CHANNEL_LABELS)))


DEEDS = st.lists(st.one_of(edits(), st.sampled_from(("undo", "undo", "redo", "save"))), max_size=9)


def by_hand(text: str, done: list[Edit]) -> str:
    """The label file as somebody writes it who edits it: through PyYAML, which knows nothing of ours."""
    top = yaml.safe_load(text)
    for edit in done:
        channels = edit.section in ("topics", "channels")
        section, key = edit.section, None
        for other in [edit.section, "topics", "channels"] if channels else [edit.section]:
            for name in top.get(other) or ():
                if (key is None and name == edit.name) or (name.strip("=") == edit.name.strip("=") and "*" not in name):
                    section, key = other, name
        if edit.value is not None:
            top[section] = {**(top.get(section) or {}), key or edit.name: edit.value}
        elif key is not None and section == "elements":
            del top[section][key]
        elif key is not None:
            top[section][key] = None
    return "".join(f"{line}\n" for key, value in top.items() for line in lines_of(key, value))


def lines_of(key: str, value: Any) -> list[str]:
    """A line for each entry, since what stands in one line is told in one row."""
    if isinstance(value, dict) and key not in ("purpose", "legal_basis"):
        return [f"{key}:", *(f"  {json.dumps(name)}: {json.dumps(one)}" for name, one in value.items())]
    return [f"{key}: {json.dumps(value)}"]


def told(document: dict[str, Any]) -> Any:
    """A document, but for the lines and the hash of the label file, and what is in the order of its lines."""
    document = json.loads(json.dumps(document))
    for file in document["assumptions"]["labels"]:
        file.clear()
    return _without_lines(document)


def _without_lines(value: Any) -> Any:
    if isinstance(value, dict):
        of_labels = str(value.get("file", "")).endswith(".yaml")
        return {key: _without_lines(one) for key, one in value.items() if not (of_labels and key == "line")}
    if isinstance(value, list):
        items = [_without_lines(one) for one in value]
        return sorted(items, key=json.dumps) if any(isinstance(one, dict) for one in value) else items
    return re.sub(r"\S*/l\.yaml(:\d+)?", "l.yaml", value) if isinstance(value, str) else value


def problems(call: Callable[[], object]) -> set[str]:
    """What is wrong, without lines."""
    try:
        call()
    except InputErrors as error:
        return {_without_lines(one.problem) for one in error.errors}
    return set()


@settings(max_examples=2 * settings().max_examples, deadline=None, phases=(Phase.explicit, Phase.reuse, Phase.generate))
@given(written(), DEEDS)
def test_edits_mean_what_the_edited_file_means(system: Written, deeds: list[Edit | str]) -> None:
    held(system, deeds)


def test_an_edit_with_a_wrong_key_at_a_wrong_name_is_told_of_both() -> None:
    policy = (
        '<policy version="0.2.0"><enclaves><enclave path="/e"><profiles><profile ns="/" node="n0">'
        '<topics publish="ALLOW"><topic>/b</topic></topics></profile></profiles></enclave></enclaves></policy>'
    )
    wrong = Edit("nodes", "/m", {"leek": ["Video"]})
    new = Edit("elements", "cloud", {"kind": "storage", "leak": ["Video"]})
    labels = "labels: 1\nnodes:\n  /n0: {source: [Video]}\n"
    disk = "elements:\n  disk: {kind: storage}\nflows:\n  - {from: /n0, to: disk}\n"
    for text in (labels, labels + disk):
        held(Written(policy, text, ()), [new, wrong])


def held(system: Written, deeds: list[Edit | str]) -> None:
    """Do what is to be done, and hold the session against the file after each deed."""
    with tempfile.TemporaryDirectory() as folder:
        policy, file = (str(Path(folder) / name) for name in system.write(Path(folder), "l"))
        asked = Settings(today="2026-01-01")
        begin = Path(file).read_text("utf-8")
        try:
            session = Session.open([policy], [file], asked)
        except InputErrors:  # labels that contradict each other
            reject()
        done: list[Edit] = []
        undone: list[Edit] = []
        other = Path(folder, "other")
        other.mkdir()
        fresh = str(other / "l.yaml")

        def analysed(some: list[Edit]) -> Any:
            Path(fresh).write_text(by_hand(begin, some), "utf-8")
            return told(answer_robot((policy,), (fresh,), asked).document())

        for deed in deeds:
            if deed == "save":
                saved = session.save()
                assert isinstance(saved, SavedFile)
                there = answer_robot((policy,), (file,), asked)
                assert session.result.to("json1") == there.to("json1")
                assert session.unsaved == 0
            elif deed == "undo":
                assert session.undo() == bool(done)
                undone += [done.pop()] if done else []
            elif deed == "redo":
                assert session.redo() == bool(undone)
                done += [undone.pop()] if undone else []
            else:
                assert isinstance(deed, Edit)
                before = session.result
                wanted = problems(partial(analysed, [*done, deed]))
                assert problems(partial(session.history.do, deed)) == wanted
                if wanted:
                    assert session.result is before
                    continue
                done, undone = [*done, deed], []
            quick, whole = session.uncounted, session.result
            assert [replace(f, number_of_paths=None) for f in whole.findings] == list(quick.findings)
            assert quick.shown.open == whole.shown.open
            assert (quick.analysis.verdict, questions(quick)) == (whole.analysis.verdict, questions(whole))
            mine, theirs = told(session.result.document()), analysed(done)
            assert {key: mine[key] for key in mine if mine[key] != theirs[key]} == {
                key: theirs[key] for key in mine if mine[key] != theirs[key]
            }
        if begin.splitlines() and isinstance(session.save(), SavedFile):
            lines = Path(file).read_text("utf-8").splitlines()
            names = {edit.name.strip("=") for edit in done}
            kept = [line for line in begin.splitlines() if line.split(":")[0].strip(' "=') not in names]
            assert [line for line in lines if line in kept] == kept
