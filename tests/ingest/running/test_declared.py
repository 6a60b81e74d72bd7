"""What nodes declare of themselves becomes a label file, marked as their own word (hri_privacy_msgs)."""

from __future__ import annotations

import struct
from contextlib import suppress
from typing import TYPE_CHECKING

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.running.observation import Declared, Span
from rosprivacy.ingest.running.zenoh_door import declared
from rosprivacy.observing import declared_labels
from tests.helpers.observed import AT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

SEEN = Span(AT, AT)
ONE = Declared("/greeter/processing", "/head/camera", "the camera in the head", "to greet people", "/var/faces.db")
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/"><profiles><profile ns="/head" node="camera">
<topics publish="ALLOW"><topic>/image</topic></topics></profile></profiles></enclave></enclaves></policy>"""


def sample(texts: tuple[str, ...], order: str = "<") -> bytes:
    """The texts in CDR."""
    body = b""
    for text in texts:
        data = text.encode() + b"\0"
        body += b"\0" * (-len(body) % 4) + struct.pack(f"{order}I", len(data)) + data
    return (b"\0\1\0\0" if order == "<" else b"\0\0\0\0") + body


@given(
    st.tuples(*[st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]))] * 4), st.sampled_from("<>")
)
def test_a_message_is_read_as_it_was_written(texts: tuple[str, str, str, str], order: str) -> None:
    assert declared("/t", sample(texts, order)) == Declared("/t", *texts)


@given(st.binary())
def test_any_other_bytes_are_refused_or_read_and_nothing_else(data: bytes) -> None:
    with suppress(ValueError):
        assert isinstance(declared("/t", data), Declared)


@pytest.mark.parametrize("cut", range(1, 60, 7))
def test_a_message_that_is_cut_off_is_refused(cut: int) -> None:
    with pytest.raises(ValueError, match=r"cut off|no text"):
        declared("/t", sample(("/head/camera", "the camera", "to greet people", "/var/faces.db"))[:-cut])


def test_the_labels_say_source_purpose_storage_and_whose_word_it_is() -> None:
    text = declared_labels([ONE, ONE], SEEN)
    assert "It is their own word" in text
    assert yaml.safe_load(text) == {
        "labels": 1,
        "nodes": {
            "/head/camera": {
                "source": ["PersonalData"],
                "author": "/head/camera itself",
                "note": "declared on /greeter/processing: the camera in the head",
                "purpose": ["to greet people"],
            }
        },
        "elements": {"file var/faces.db": {"kind": "storage", "author": "/head/camera itself"}},
        "flows": [{"from": "/head/camera", "to": "file var/faces.db"}],
    }


def test_the_labels_are_read_and_find_that_nobody_says_how_long_the_file_is_kept(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "robot.policy.xml").write_text(POLICY)
    (tmp_path / "declared.labels.yaml").write_text(declared_labels([ONE], SEEN))
    done = cli("analyze", "robot.policy.xml", "-l", "declared.labels.yaml", cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert "file var/faces.db" in done.stdout


HOSTILE = ["</x>", "a: b\n- c", "\x1b[31m", "x" * 10_000, "{{", "'\"", "# no", "é\u202e", "- ", "!!python/object", "*"]


@pytest.mark.parametrize("text", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_texts_stay_texts_and_the_file_can_be_read(text: str, cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "robot.policy.xml").write_text(POLICY)
    written = declared_labels(
        [Declared("/t", "/head/camera", text, text, text), Declared("/t", text, "", "", "")], SEEN
    )
    (tmp_path / "declared.labels.yaml").write_text(written)
    assert list(yaml.safe_load(written)["nodes"]) == ["/head/camera"]
    done = cli("analyze", "robot.policy.xml", "-l", "declared.labels.yaml", cwd=tmp_path)
    assert done.returncode == 1, done.stderr


def test_nothing_declared_is_no_file() -> None:
    assert declared_labels([], SEEN) == ""
    assert declared_labels([Declared("/t", "no node", "", "", "")], SEEN) == ""
