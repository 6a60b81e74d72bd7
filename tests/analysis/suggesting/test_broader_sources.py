"""A broader kind is asked about, where a name tells one narrower kind and persons often another one (issue 21)."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosprivacy.labelling.knowledge import UserFiles
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.fleet_files import policy


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def sources(node: str, labels: str = "labels: 1\n", rules: tuple[str, ...] = ()) -> dict[str, str]:
    """What a node is suggested as a source of, with how sure."""
    Path("p.xml").write_text(policy(f"/{node}>/w", "/m</w"), "utf-8")
    Path("l.yaml").write_text(labels, "utf-8")
    found = suggest_labels(("p.xml",), ("l.yaml",), Settings(), UserFiles(rules=rules)).proposals
    return {one.label.kind: str(one.confidence) for one in found if one.label.role == "source"}


def test_beside_a_narrower_kind_the_broader_one_is_asked_about() -> None:
    assert sources("speech_recognition") == {"SpeechTranscript": "may", "CommunicationContent": "may"}


def test_other_kinds_have_no_broader_one_that_is_asked_about() -> None:
    assert sources("webcam") == {"Video": "may"}


def test_a_file_of_ones_own_names_more_of_them() -> None:
    Path("own.yaml").write_text("name_rules: 1\nbroadened: [PersonImage]\n", "utf-8")
    assert sources("webcam", rules=("own.yaml",)) == {"Video": "may", "PersonImage": "may"}


def test_who_has_named_the_broader_kind_is_asked_about_neither() -> None:
    labels = "labels: 1\nnodes: {/speech_recognition: {source: [CommunicationContent]}}\n"
    assert sources("speech_recognition", labels) == {}


def test_of_two_narrower_kinds_the_broader_one_is_asked_about_once() -> None:
    Path("own.yaml").write_text(
        "name_rules: 1\nbrings_in: [{words: [desk], kinds: [SpeechTranscript, VoiceCommand], why: ours}]\n", "utf-8"
    )
    assert sorted(sources("desk", rules=("own.yaml",))) == ["CommunicationContent", "SpeechTranscript", "VoiceCommand"]


def test_who_has_named_the_narrower_kind_is_not_asked_about_the_broader_one() -> None:
    """Other sources of the node are asked about all the same."""
    labels = "labels: 1\nnodes: {/speech_recognition: {source: [SpeechTranscript]}}\n"
    assert sources("speech_recognition", labels) == {}
    other = "labels: 1\nnodes: {/speech_recognition: {source: [Video]}}\n"
    assert sources("speech_recognition", other) == {"SpeechTranscript": "may", "CommunicationContent": "may"}
