"""``types`` of label files: the message types of a channel, as a person states them (rule S15)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import rosprivacy
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ontology.vocabulary import load
from tests.helpers.fleet_files import policy

LABELS = "labels: 1\nnodes: {/cam: {source: [Video]}, /sink: {leak: [Video]}}\nchannels:\n"


@pytest.fixture(autouse=True)
def files_of_a_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy("/cam>/a,/b", "/sink</a,/b"), "utf-8")


def told(channels: str) -> Any:
    Path("l.yaml").write_text(LABELS + channels, "utf-8")
    return rosprivacy.analyze("p.xml", "l.yaml").document()


def test_a_person_states_them_for_all_writers_by_name_and_by_glob() -> None:
    document = told("  /a: {types: [sensor_msgs/msg/Image, a/msg/C], note: two}\n  /*: {types: [a/msg/B]}\n")
    names = {row["element"]["name"]: [(t["type"], t["line"]) for t in row["types"]] for row in document["types"]}
    assert names == {
        "/a": [("a/msg/B", 5), ("a/msg/C", 4), ("sensor_msgs/msg/Image", 4)],
        "/b": [("a/msg/B", 5)],
    }
    assert all(one["stated"] for row in document["types"] for one in row["types"])


def test_they_review_nothing() -> None:
    """S15: a channel of which only types are stated is as open as without."""
    assert told("  /a: {types: [sensor_msgs/msg/Image]}\n")["open"] == told("  /a:\n")["open"]


@pytest.mark.parametrize(
    ("channels", "problem"),
    [
        ("  /a: {types: [std_srvs/srv/Empty]}", "std_srvs/srv/Empty is the type of a service, and '/a' is a topic"),
        ("  /c: {types: [std_msgs/msg/Bool]}", "l.yaml:4: '/c' matches no topic"),
    ],
)
def test_what_is_no_type_of_the_channel_is_refused(channels: str, problem: str) -> None:
    with pytest.raises(rosprivacy.InputErrors) as refused:
        told(channels)
    assert problem in str(refused.value)


def test_a_file_of_standard_channels_states_none() -> None:
    """S13: it may only call channels mundane."""
    Path("s.yaml").write_text("labels: 1\nchannels: {/a: {types: [std_msgs/msg/Bool]}}\n", "utf-8")
    with pytest.raises(rosprivacy.InputErrors, match="types of '/a' in a file of standard channels"):
        rosprivacy.analyze("p.xml", standard_channels="s.yaml")


def test_robots_of_a_fleet_have_those_of_their_label_files() -> None:
    Path("l.yaml").write_text(LABELS + "  /a: {types: [std_msgs/msg/String]}\n", "utf-8")
    Path("f.yaml").write_text("fleet: 1\nrobots: {r1: {policies: p.xml, labels: l.yaml}}\n", "utf-8")
    (row,) = rosprivacy.analyze_fleet("f.yaml").document()["types"]
    assert (row["element"]["robot"], row["element"]["name"]) == ("r1", "/a")


def test_labels_in_memory_have_them() -> None:
    labels = parse_labels({"labels": 1, "channels": {"/a": {"types": ["std_msgs/msg/Bool"]}}}, load(), name="mine")
    assert rosprivacy.analyze("p.xml", labels).document()["types"][0]["types"][0]["file"] == "mine"
