"""What a scan found outside ROS, as a label file that can be read: facts where a file states it, else questions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.scan.outside.outside_labels import LOG_FILES, outside_labels
from rosprivacy.ingest.scan.scan_facts import CodePlace, External, LogCall
from rosprivacy.ingest.suggestion_rules.comments import taken_apart
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from rosprivacy.ingest.labels.label_file import Labels

CHANNELS = {"/odom": "topic", "/say": "service"}
CLOUD = External(CodePlace("n.py", 3), "api.example.com", "cloud", incoming=True)
HEARING = External(CodePlace("n.py", 4), "whisper", "speech", incoming=True, outgoing=False)
BROKER = External(CodePlace("m.yaml", 6), "MQTT broker x", "broker", stated=True, channels=("odom", "/x"))
ORDERS = BROKER._replace(place=CodePlace("m.yaml", 9), incoming=True, outgoing=False, channels=("/say",))
VOLUME = External(CodePlace("compose.yaml", 9), "volume footage", "compose", incoming=True, stated=True)
LOG = LogCall(CodePlace("n.py", 8), (), "msg.data")


def labels_of(text: str) -> Labels:
    return parse_labels(taken_apart("o.labels.yaml", text)[0], load(), name="o.labels.yaml")


def test_what_a_file_states_is_an_element_with_flows_from_and_to_channels_of_the_system() -> None:
    read = labels_of(outside_labels((), (), [BROKER, ORDERS, VOLUME], CHANNELS))
    assert {(one.name, one.kind) for one in read.elements} == {
        ("MQTT broker x", "external-system"), ("volume footage", "storage"),
    }  # fmt: skip
    assert {(one.source, one.target) for one in read.flows} == {("/odom", "MQTT broker x"), ("MQTT broker x", "/say")}


def test_a_bridge_of_everything_takes_all_channels() -> None:
    read = labels_of(outside_labels((), (), [BROKER._replace(channels=(".*",))], CHANNELS))
    assert {one.source for one in read.flows} == set(CHANNELS)


def test_the_use_of_a_library_is_a_question_with_its_line() -> None:
    text = outside_labels([("/n", CLOUD), ("/n", HEARING)], (), (), CHANNELS)
    (comment,) = taken_apart("o.labels.yaml", text)[1]
    assert (comment.section, comment.name, comment.roles) == ("nodes", "/n", {"leak": ["PersonalData"]})
    assert "api.example.com" in comment.why
    assert "n.py:3" in comment.why
    assert "whisper" not in text  # on the robot: it makes text of speech, and nothing leaves
    assert labels_of(text).elements == ()


def test_who_logs_data_of_channels_writes_into_the_log_files() -> None:
    read = labels_of(outside_labels((), [("/n", LOG), ("/a", LOG)], (), CHANNELS))
    (storage,) = read.elements
    assert (storage.name, storage.kind, storage.outside.retention) == (LOG_FILES, "storage", ())
    assert [(one.source, one.target) for one in read.flows] == [("/a", LOG_FILES), ("/n", LOG_FILES)]


def test_nothing_found_is_no_file() -> None:
    assert outside_labels((), (), (), CHANNELS) == ""


@given(st.text(), st.text())
def test_whatever_things_are_called_it_is_a_label_file(name: str, file: str) -> None:
    place = CodePlace(file, 1)
    stated = External(place, name, "compose", stated=True, channels=(name,))
    labels_of(outside_labels([("/n", CLOUD._replace(place=place, name=name))], (), [stated], CHANNELS))
