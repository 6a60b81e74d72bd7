"""``rosprivacy bag --without``: the copy of a recording that may be shared, what is in it, and what never is.

Rules S7 (a broader kind may hide a narrower one), S11 (what is not known is left out) and S14. What is in a copy is
read by the library ``mcap``, not by the program.
"""

from __future__ import annotations

import json
import os
import shlex
import sqlite3
import struct
import subprocess
import sys
import tempfile
import tracemalloc
from collections import Counter
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest
import yaml
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from jsonschema import Draft202012Validator
from mcap.reader import SeekingReader
from mcap.writer import CompressionType, Writer
from rosbags.rosbag2 import Reader

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.bag_copy import _check_copy, share_bag
from rosprivacy.ingest.running import mcap_messages
from rosprivacy.ingest.running.mcap_file import MAGIC
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.atomic import write_texts
from rosprivacy.settings import Settings
from tests.helpers.bags import IMAGE, ODOMETRY, SECRET, START, mcap, rosbag2
from tests.helpers.command import Cli, refused
from tests.helpers.docs import blocks
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

SCHEMA = json.loads((ROOT / "docs" / "shared-bag.schema.json").read_text("utf-8"))
Draft202012Validator.check_schema(SCHEMA)
QOS = {"offered_qos_profiles": "- history: 3\n  depth: 7", "topic_type_hash": "RIHS01_00"}
LOG, EVENT, CLOCK = "rcl_interfaces/msg/Log", "rcl_interfaces/msg/ParameterEvent", "rosgraph_msgs/msg/Clock"
ODD = "example_interfaces/msg/String"  # a type that suggests nothing of what is asked for here


class Row(NamedTuple):
    """A message as the library reads it."""

    topic: str
    type: str
    definition: bytes
    metadata: tuple[tuple[str, str], ...]
    sequence: int
    log_time: int
    publish_time: int
    data: bytes


def rows(file: Path) -> list[Row]:
    with file.open("rb") as stream:
        return [
            Row(
                channel.topic,
                schema.name if schema else "",
                schema.data if schema else b"",
                tuple(channel.metadata.items()),
                *(message.sequence, message.log_time, message.publish_time, message.data),
            )
            for schema, channel, message in SeekingReader(stream, validate_crcs=True).iter_messages(
                log_time_order=False
            )
        ]


def recorded(file: Path, messages: Iterable[tuple[str, str, bytes]], packed: str = "ZSTD") -> Path:
    """Write (topic, type, data) into an MCAP file; published a while before they were logged, and out of order."""
    with file.open("wb") as stream:
        writer = Writer(stream, chunk_size=300, compression=CompressionType[packed])
        writer.start("ros2")
        channels: dict[str, int] = {}
        for number, (topic, kind, data) in enumerate(messages):
            if topic not in channels:
                schema = writer.register_schema(kind, "ros2msg", b"uint8[] data")
                channels[topic] = writer.register_channel(topic, "cdr", schema, QOS)
            at = START + (number ^ 1)
            writer.add_message(channels[topic], at, data, at - 5, number)
        writer.finish()  # type: ignore[no-untyped-call] # it has no types
    return file


def labels(folder: Path, text: str) -> Path:
    file = folder / "labels.yaml"
    file.write_text(f"labels: 1\n{text}\n")
    return file


def shared(cli: Cli, *arguments: str | Path, code: int = 0) -> dict[str, Any]:
    done = cli("bag", *arguments, "--format", "json")
    assert done.returncode == code, done.stderr
    whole: dict[str, Any] = json.loads(done.stdout)
    Draft202012Validator(SCHEMA).validate(whole)
    return whole


def reasons(whole: Mapping[str, Any]) -> dict[str, str]:
    return {topic["topic"]: topic["why"] for topic in whole["left_out"]}


MIXED = [("/camera", IMAGE, SECRET), ("/odom", ODOMETRY, b"\0\1\0\0a"), ("/odom", ODOMETRY, b""), ("/log", ODD, SECRET)]


# ---------------------------------------------------------------- what is passed on


@pytest.mark.parametrize("packed", ["NONE", "ZSTD", "LZ4"])
def test_what_is_passed_on_is_what_was_there(cli: Cli, tmp_path: Path, packed: str) -> None:
    """Bytes, times, sequence, schema and QoS; S14: the same input, the same bytes."""
    bag = recorded(tmp_path / "a.mcap", MIXED * 20, packed)
    said = labels(tmp_path, "channels: {/odom: {only: [Location]}, /camera: {only: [Video]}}")
    whole = shared(cli, bag, "--without", "Video", "-l", said, "-o", tmp_path / "b.mcap")
    assert rows(tmp_path / "b.mcap") == [row for row in rows(bag) if row.topic == "/odom"]
    assert [(one["topic"], one["messages"], one["kinds"]) for one in whole["topics"]] == [("/odom", 40, ["Location"])]
    assert whole["messages"] == 40
    assert {one["topic"]: one["messages"] for one in whole["left_out"]} == {"/camera": 20, "/log": 20}
    assert whole["copy"] == str(tmp_path / "b.mcap")
    shared(cli, bag, "--without", "Video", "-l", said, "-o", tmp_path / "c.mcap")
    assert (tmp_path / "b.mcap").read_bytes() == (tmp_path / "c.mcap").read_bytes()
    assert SECRET not in (tmp_path / "b.mcap").read_bytes()


def test_a_recording_of_sqlite_becomes_mcap(cli: Cli, tmp_path: Path) -> None:
    run = rosbag2(tmp_path / "run", "sqlite3", {"/camera": (IMAGE, 3), "/odom": (ODOMETRY, 2)})
    said = labels(tmp_path, "channels: {/camera: {only: [Video]}, /odom: mundane}")
    shared(cli, run, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    (database,) = run.glob("*.db3")
    with closing(sqlite3.connect(database)) as connection, connection:
        asked = "SELECT timestamp, data FROM messages JOIN topics t ON t.id = topic_id WHERE t.name = '/odom'"
        before = connection.execute(asked).fetchall()
        definition = connection.execute(
            "SELECT encoded_message_definition FROM message_definitions WHERE topic_type = ?", (ODOMETRY,)
        ).fetchone()[0]
        qos, digest = connection.execute(
            "SELECT offered_qos_profiles, type_description_hash FROM topics WHERE name = '/odom'"
        ).fetchone()
    after = rows(tmp_path / "b.mcap")
    assert [(row.log_time, row.data) for row in after] == before
    assert {(row.topic, row.type, row.definition.decode()) for row in after} == {("/odom", ODOMETRY, definition)}
    assert dict(after[0].metadata) == {"offered_qos_profiles": qos, "topic_type_hash": digest}
    assert {row.publish_time - row.log_time for row in after} == {0}


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_another_implementation_reads_a_copy(cli: Cli, tmp_path: Path, storage: str) -> None:
    """``rosbags``, which is neither ours nor made with the library ``mcap``, finds the messages that it has written."""
    run = rosbag2(tmp_path / "run", storage, {"/camera": (IMAGE, 3), "/odom": (ODOMETRY, 2)})
    said = labels(tmp_path, "channels: {/camera: {only: [Video]}, /odom: mundane}")
    shared(cli, run, "--without", "Video", "-l", said, "-o", tmp_path / "b.mcap")

    def messages(bag: Path) -> list[tuple[str, str, int, bytes]]:
        with Reader(bag) as reader:
            return [(at.topic, at.msgtype, time, bytes(data)) for at, time, data in reader.messages()]

    copied = messages(tmp_path / "b.mcap")
    assert copied == [one for one in messages(run) if one[0] == "/odom"]
    assert len(copied) == 2


def test_files_of_a_recording_come_in_their_order(cli: Cli, tmp_path: Path) -> None:
    run = tmp_path / "run"
    run.mkdir()
    names = [f"run_{number}.mcap" for number in (0, 2, 10)]
    for name in names:
        recorded(run / name, [("/odom", ODOMETRY, name.encode())])
    about = {"name": "/odom", "type": ODOMETRY, "serialization_format": "cdr", "offered_qos_profiles": ""}
    top = {
        "version": 9, "storage_identifier": "mcap", "relative_file_paths": names,
        "starting_time": {"nanoseconds_since_epoch": START}, "duration": {"nanoseconds": 5}, "message_count": 3,
        "topics_with_message_count": [{"topic_metadata": about, "message_count": 3}],
        "compression_format": "", "compression_mode": "",
    }  # fmt: skip
    (run / "metadata.yaml").write_text(yaml.safe_dump({"rosbag2_bagfile_information": top}))
    said = labels(tmp_path, "channels: {/odom: mundane}")
    shared(cli, run, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    assert [row.data.decode() for row in rows(tmp_path / "b.mcap")] == names
    shared(cli, run / "metadata.yaml", "--without", "all", "-l", said, "-o", tmp_path / "c.mcap")
    assert rows(tmp_path / "c.mcap") == rows(tmp_path / "b.mcap")


def test_what_lies_beside_messages_is_left_out_by_name(cli: Cli, tmp_path: Path) -> None:
    bag = mcap(tmp_path / "a.mcap", attachment="face.png", metadata="driver")
    said = labels(tmp_path, "channels: {'*': mundane}")
    whole = shared(cli, bag, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    assert whole["extras"] == ["attachment 'face.png'", "metadata 'driver'"]
    with (tmp_path / "b.mcap").open("rb") as stream:
        summary = SeekingReader(stream).get_summary()
        assert summary
        assert summary.statistics
        assert (summary.statistics.attachment_count, summary.statistics.metadata_count) == (0, 0)
    assert b"A. Person" not in (tmp_path / "b.mcap").read_bytes()


@pytest.mark.slow
def test_a_large_bag_is_never_in_memory(tmp_path: Path) -> None:
    bag = tmp_path / "a.mcap"
    with bag.open("wb") as stream:
        writer = Writer(stream, compression=CompressionType.NONE)
        writer.start()
        channel = writer.register_channel("/odom", "cdr", writer.register_schema(ODOMETRY, "", b""))
        for number in range(600):
            writer.add_message(channel, START + number, os.urandom(100_000), START)
        writer.finish()  # type: ignore[no-untyped-call] # it has no types
    said = labels(tmp_path, "channels: {/odom: mundane}")
    tracemalloc.start()
    share_bag(str(bag), ["all"], tmp_path / "b.mcap", (), (str(said),), Settings())
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert bag.stat().st_size > 60_000_000
    assert most < 30_000_000


# ---------------------------------------------------------------- which topics


VIDEO, SAID = "Video can be in it: ", "no label says what it carries"


@pytest.mark.parametrize(
    ("said", "kinds", "topics"),
    [
        ("{/a: mundane}", ["Video"], "/a"),
        ("{/a: {only: [Location]}}", ["Video"], "/a"),
        ("{/a: {only: [Location]}}", ["Location"], ""),
        ("{/a: {only: [Location]}}", ["Video", "Location"], ""),
        ("{/a: {only: [Location]}}", ["all"], ""),
        ("{/a: {only: [PersonTrack]}}", ["Location"], ""),  # narrower
        ("{/a: {only: [Location]}}", ["PersonTrack"], ""),  # broader: it may be of that kind
        ("{/a: {only: [PersonalData]}}", ["Video"], ""),
        ("{/a: {never: [Video]}}", ["Video"], ""),  # a broader kind still passes, and may be a video
        ("{/a: {only: [Location], never: [PersonTrack]}}", ["PersonTrack"], ""),
        ("{/a: sensitive}", ["Video"], ""),
        ("{'*': mundane}", ["all"], "/a /b"),
        ("{'*': mundane, /a: sensitive}", ["all"], "/b"),
        ("{'*': mundane, /a: {only: [Video]}}", ["Video"], "/b"),
        ("{'*': {only: [Location]}, /a: {sensitive: [Video]}}", ["Video"], "/b"),  # it lets more pass than 'only' names
        ("{/b: mundane}", ["Video"], "/b"),
    ],
)
def test_only_what_is_known_to_be_without(cli: Cli, tmp_path: Path, said: str, kinds: list[str], topics: str) -> None:
    bag = recorded(tmp_path / "a.mcap", [("/a", ODD, b"a"), ("/b", ODD, b"b")])
    named = [word for kind in kinds for word in ("--without", kind)]
    file = labels(tmp_path, f"channels: {said}")
    copy = tmp_path / "b.mcap"
    whole = shared(cli, bag, *named, "-l", file, "-o", copy, code=0 if topics else 4)
    assert " ".join(one["topic"] for one in whole["topics"]) == topics
    assert whole["topics"] + whole["left_out"]
    assert all(reasons(whole).values())
    assert (sorted({row.topic for row in rows(copy)}) if copy.exists() else []) == topics.split()


def test_a_source_that_names_a_channel_says_nothing_of_other_kinds(cli: Cli, tmp_path: Path) -> None:
    """S11: that video is there does not say that nothing else is; a label that bounds the channel does."""
    bag = recorded(tmp_path / "a.mcap", [("/a", ODD, b"a"), ("/b", ODD, b"b")])
    nodes = "nodes: {/cam: {source: {Video: [/a, /b]}}}"
    words = (bag, "--without", "Location", "-o", tmp_path / "b.mcap", "-l")
    whole = shared(cli, *words, labels(tmp_path, f"{nodes}\nchannels: {{/b: {{only: [Video]}}}}"))
    assert [one["topic"] for one in whole["topics"]] == ["/b"]
    assert reasons(whole) == {"/a": "nobody says that it carries nothing but Video"}


def test_a_glob_of_a_file_with_pins_answers_for_nothing_new(cli: Cli, tmp_path: Path) -> None:
    """S11: a person has not seen what the glob decides here; a full name needs no pin."""
    bag = recorded(tmp_path / "a.mcap", [("/a", ODD, b"a"), ("/b", ODD, b"b")])
    said = labels(tmp_path, "channels: {'*': mundane, /b: mundane}\npins: {topics: {/other: [Video]}}")
    whole = shared(cli, bag, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    assert [one["topic"] for one in whole["topics"]] == ["/b"]


def test_topics_that_tell_of_nodes_need_a_label_of_their_own(cli: Cli, tmp_path: Path) -> None:
    """The program's own labels call the first two mundane, and of a clock that is enough (S13)."""
    events = "/add/_service_event"
    names = {
        "/rosout": LOG,
        "/r/parameter_events": EVENT,
        "/clock": CLOCK,
        events: "example_interfaces/srv/AddTwoInts_Event",
    }
    bag = recorded(tmp_path / "a.mcap", [(name, kind, b"a") for name, kind in names.items()])
    words = (bag, "--without", "Video", "-o", tmp_path / "b.mcap")
    whole = shared(cli, *words)
    assert [one["topic"] for one in whole["topics"]] == ["/clock"]
    assert "no label of the topic itself speaks of it" in reasons(whole)["/r/parameter_events"]
    said = labels(tmp_path, "channels: {/rosout: mundane, /r/parameter_events: mundane, /add: mundane}")
    assert [one["topic"] for one in shared(cli, *words, "-l", said)["topics"]] == sorted(names)


POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="cam"><topics publish="ALLOW"><topic>camera</topic></topics></profile>
<profile ns="/" node="nav"><topics publish="ALLOW"><topic>odom</topic></topics>
  <topics subscribe="ALLOW"><topic>camera</topic></topics></profile>
<profile ns="/" node="base"><topics publish="ALLOW"><topic>wheels</topic></topics>
  <topics subscribe="ALLOW"><topic>odom</topic></topics></profile>
</profiles></enclave></enclaves></policy>"""
SILENT = "data can get there from /cam, of which no label speaks"


@pytest.mark.parametrize(
    ("said", "kind", "expected"),
    [
        ("/nav: {source: [Location]}, /base: conduit", "Voice", {"/odom": SILENT, "/wheels": SILENT}),
        ("/nav: {source: [Location]}, /base: conduit, /cam: conduit", "Voice", {}),
        ("/nav: {source: [Location]}, /base: conduit, /cam: {source: [Voice]}", "Voice",
         dict.fromkeys(["/odom", "/wheels"], "Voice can be in it: what the policies and labels let arrive there")),
        ("/nav: {source: [Location], sanitizer: {Voice: drop}}, /base: conduit, /cam: {source: [Voice]}", "Voice", {}),
    ],
)  # fmt: skip
def test_by_policies_all_that_data_can_come_from_is_spoken_of(
    cli: Cli, tmp_path: Path, said: str, kind: str, expected: dict[str, str]
) -> None:
    """S11: what nobody has looked at may send anything, however far away it is."""
    bag = recorded(tmp_path / "a.mcap", [("/odom", ODD, b"a"), ("/wheels", ODD, b"b")])
    policy = tmp_path / "a.policy.xml"
    policy.write_text(POLICY)
    file = labels(tmp_path, f"nodes: {{{said}}}")
    words = (bag, "--without", kind, "--policy", policy, "-l", file, "-o", tmp_path / "b.mcap")
    assert reasons(shared(cli, *words, code=4 if expected else 0)) == expected


@pytest.mark.parametrize("pins", ["", "pins: {nodes: {/other: [Voice]}}"])
def test_by_policies_a_glob_without_a_pin_speaks_of_no_node(cli: Cli, tmp_path: Path, pins: str) -> None:
    bag = recorded(tmp_path / "a.mcap", [("/odom", ODD, b"a")])
    policy = tmp_path / "a.policy.xml"
    policy.write_text(POLICY)
    said = labels(tmp_path, f"nodes: {{/nav: {{source: [Location]}}, '/*': conduit, /base: conduit}}\n{pins}")
    words = (bag, "--without", "Voice", "--policy", policy, "-l", said, "-o", tmp_path / "b.mcap")
    assert reasons(shared(cli, *words, code=4 if pins else 0)) == ({"/odom": SILENT} if pins else {})


def test_a_type_that_suggests_the_kind_is_a_question_that_a_label_answers(cli: Cli, tmp_path: Path) -> None:
    """S15: by policies no video gets there, but the type is one of pictures."""
    bag = recorded(tmp_path / "a.mcap", [("/odom", IMAGE, b"a")])
    policy = tmp_path / "a.policy.xml"
    policy.write_text(POLICY)
    nodes = "nodes: {/nav: {source: [Location]}, /base: conduit, /cam: conduit}"
    words = (bag, "--without", "Video", "--policy", policy, "-o", tmp_path / "b.mcap", "-l")
    asked = "no label of the topic itself, and its type suggests Video"
    assert reasons(shared(cli, *words, labels(tmp_path, nodes), code=4)) == {"/odom": asked}
    whole = shared(cli, *words, labels(tmp_path, f"{nodes}\nchannels: {{/odom: {{only: [Location]}}}}"))
    assert "its type suggests" in whole["topics"][0]["why"]  # it is told all the same


KINDS = ["Video", "FaceImage", "Voice", "Location", "PersonTrack", "FaceTemplate", "Biometric", "PersonalData"]
NAMES = ["/a", "/b", "/c"]
SOME = st.lists(st.sampled_from(KINDS), min_size=1, max_size=2, unique=True)
SAYINGS = st.one_of(
    st.sampled_from(["mundane", "sensitive"]),
    SOME.map(lambda kinds: {"only": kinds}),
    SOME.map(lambda kinds: {"never": kinds}),
)
NARROWER = {kind: load().with_narrower(kind) for kind in load().categories}


def subtree(kinds: Iterable[str]) -> set[str]:
    return set().union(*(NARROWER[kind] for kind in kinds))


def carried(named: Any, glob: Any) -> tuple[set[str], set[str] | None]:
    """Brute force: each kind that a channel can carry by its label and the glob; and what is said that it carries.

    The name decides for the kinds of which it speaks, the glob for the others.
    """
    never = subtree(named["never"]) if "never" in (named or ()) else set()
    base = glob if never or named is None else named
    if base == "mundane" or "PersonalData" in never:
        return set(), set()
    if "only" in (base or ()):
        bounds = set(base["only"]) - never
        if base is named and "only" in (glob or ()):  # in doubt: what the glob names, too, if it may be the same data
            bounds |= {kind for kind in glob["only"] if NARROWER[kind] & subtree(bounds)}
        return subtree(base["only"]) - never, subtree(bounds) if bounds else None
    can = set(NARROWER) - never - (subtree(base["never"]) if "never" in (base or ()) else set())
    return can, None if can else set()


@given(
    said=st.dictionaries(st.sampled_from([*NAMES, "*"]), SAYINGS, max_size=4),
    sources=st.dictionaries(st.sampled_from(KINDS), st.sampled_from(NAMES), max_size=2),
    kinds=st.lists(st.sampled_from([*KINDS, "all"]), min_size=1, max_size=2, unique=True),
    messages=st.lists(
        st.tuples(st.sampled_from(NAMES), st.just(ODD), st.binary(max_size=40).map(lambda data: b"\0" + data)),
        min_size=1,
    ),
)
def test_no_topic_of_a_copy_can_carry_the_kind(
    said: dict[str, Any], sources: dict[str, str], kinds: list[str], messages: list[tuple[str, str, bytes]]
) -> None:
    """Against brute force; and what is known not to carry it is there, each byte and in order."""
    nodes = {"/cam": {"source": {kind: [name] for kind, name in sources.items()}}} if sources else {}
    said = {name: saying for name, saying in said.items() if name not in sources.values()}  # a contradiction else
    unwanted = set(NARROWER) if "all" in kinds else subtree(kinds)
    sent = {name: subtree(kind for kind, at in sources.items() if at == name) for name in NAMES}
    by_name = {name: carried(said.get(name), said.get("*")) for name in NAMES}
    can = {name: kinds_there | sent[name] for name, (kinds_there, _) in by_name.items()}
    expected = {
        name for name, (_, bound) in by_name.items() if bound is not None and not (bound | sent[name]) & unwanted
    }
    with tempfile.TemporaryDirectory() as folder:
        bag = recorded(Path(folder, "a.mcap"), messages)
        file = labels(Path(folder), yaml.safe_dump({"nodes": nodes, "channels": said}))
        copy = Path(folder, "b.mcap")
        share_bag(str(bag), kinds, copy, (), (str(file),), Settings())
        after = rows(copy) if copy.exists() else []
        assert not any(can[row.topic] & unwanted for row in after)
        assert after == [row for row in rows(bag) if row.topic in expected]


# ---------------------------------------------------------------- what is refused, and leaves nothing


def listing(folder: Path) -> dict[str, bytes]:
    return {str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def test_a_damaged_file_leaves_what_was_there(cli: Cli, tmp_path: Path) -> None:
    """Cut at every length, and a byte turned over: an error with the name, and the earlier copy as it was."""
    bag = recorded(tmp_path / "a.mcap", MIXED * 5)
    said = labels(tmp_path, "channels: {'*': mundane}")
    whole = bag.read_bytes()
    (tmp_path / "b.mcap").write_bytes(b"earlier")
    words = ("bag", bag, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    for length in range(0, len(whole), 97):
        bag.write_bytes(whole[:length])
        before = listing(tmp_path)
        assert all(line.startswith(f"{bag}: ") for line in refused(cli(*words)))
        assert listing(tmp_path) == before
    chunk = whole.index(b"zstd") + 30
    bag.write_bytes(whole[:chunk] + bytes([whole[chunk] ^ 255]) + whole[chunk + 1 :])
    before = listing(tmp_path)
    (line,) = refused(cli(*words))
    assert "cannot be read to its end: a chunk" in line
    assert listing(tmp_path) == before


def test_a_damaged_database_leaves_nothing(cli: Cli, tmp_path: Path) -> None:
    run = rosbag2(tmp_path / "run", "sqlite3", {"/odom": (ODOMETRY, 200)})
    (file,) = run.glob("*.db3")
    whole = file.read_bytes()
    said = labels(tmp_path, "channels: {'*': mundane}")
    words = ("bag", file, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    assert cli(*words).returncode == 0
    (tmp_path / "b.mcap").unlink()
    at = whole.index(SECRET) // 4096 * 4096
    for harm in (whole[: len(whole) // 2], whole[:at] + b"\xff" * 8 + whole[at + 8 :]):
        file.write_bytes(harm)
        before = listing(tmp_path)
        assert all(line.startswith(f"{file}: ") for line in refused(cli(*words)))
        assert listing(tmp_path) == before


TWICE = """CREATE TABLE topics2 AS SELECT * FROM topics; UPDATE topics2 SET name = '/camera';
INSERT INTO topics2 SELECT * FROM topics; DROP TABLE topics; ALTER TABLE topics2 RENAME TO topics"""


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE messages SET topic_id = 99 WHERE id = 2",
        "UPDATE messages SET data = 'text' WHERE id = 2",
        "UPDATE messages SET timestamp = -1 WHERE id = 2",
        "ALTER TABLE messages RENAME TO m; CREATE VIEW messages AS SELECT * FROM m",
        TWICE,
    ],
    ids=["no topic", "no bytes", "no time", "a view", "two topics of one number"],
)
def test_a_database_of_which_messages_are_not_known(cli: Cli, tmp_path: Path, change: str) -> None:
    run = rosbag2(tmp_path / "run", "sqlite3", {"/odom": (ODOMETRY, 3)})
    (file,) = run.glob("*.db3")
    with closing(sqlite3.connect(file)) as database, database:
        database.executescript(change)
    database.close()
    said = labels(tmp_path, "channels: {'*': mundane}")
    (line,) = refused(cli("bag", file, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap"))
    assert line.startswith(f"{file}: cannot be read to its end: ")
    assert not (tmp_path / "b.mcap").exists()


def record(code: int, content: bytes) -> bytes:
    return struct.pack("<BQ", code, len(content)) + content


def channel(number: int, topic: str) -> bytes:
    name = topic.encode()
    return record(4, struct.pack("<HHI", number, 0, len(name)) + name + struct.pack("<I", 3) + b"cdr" + b"\0" * 4)


def message(number: int, data: bytes) -> bytes:
    return record(5, struct.pack("<HIQQ", number, 0, START, START) + data)


def by_hand(file: Path, *records: bytes) -> Path:
    footer = record(2, bytes(20))
    file.write_bytes(MAGIC + record(1, bytes(8)) + b"".join(records) + footer + MAGIC)
    return file


@pytest.mark.parametrize(
    ("records", "what"),
    [
        ([channel(1, "/odom"), message(1, b"a"), channel(1, "/camera"), message(1, SECRET)], "stated twice"),
        ([channel(1, "/odom"), message(1, b"a"), message(2, SECRET)], "not stated before it"),
        ([channel(1, "/odom"), record(5, b"short")], "cannot be read to its end"),
        ([channel(1, "/odom"), message(1, b"a"), b"\0" * 9], "cannot be read to its end"),
    ],
    ids=["a number that changes its topic", "a number without a topic", "a message without a head", "no record"],
)
def test_a_file_that_is_made_to_deceive(cli: Cli, tmp_path: Path, records: list[bytes], what: str) -> None:
    """One channel never passes for another."""
    bag = by_hand(tmp_path / "a.mcap", *records)
    said = labels(tmp_path, "channels: {/odom: mundane}")
    lines = refused(cli("bag", bag, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap"))
    assert lines[0].startswith(f"{bag}: ")
    assert what in lines[0] or "not complete" in lines[0]
    assert not (tmp_path / "b.mcap").exists()


def test_a_topic_that_only_the_summary_hides_stays_out(cli: Cli, tmp_path: Path) -> None:
    """The summary of one recording over the messages of another: only labelled topics are copied, and all are told."""
    lying = recorded(tmp_path / "odom.mcap", [("/odom", ODOMETRY, b"a")], "NONE").read_bytes()
    hidden = channel(7, "/camera") + message(7, SECRET)
    end = lying.rindex(struct.pack("<BQ", 15, 4))  # where its data end
    moved = len(hidden)
    foot = lying.rindex(struct.pack("<BQ", 2, 20))
    summary, offsets = struct.unpack_from("<QQ", lying, foot + 9)
    footer = record(2, struct.pack("<QQI", summary + moved, offsets + moved, 0))
    bag = tmp_path / "a.mcap"
    bag.write_bytes(lying[:end] + hidden + lying[end:foot] + footer + lying[-8:])
    said = labels(tmp_path, "channels: {/odom: mundane}")
    whole = shared(cli, bag, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap")
    assert reasons(whole) == {"/camera": "what the bag says of itself does not name it"}
    assert [row.topic for row in rows(tmp_path / "b.mcap")] == ["/odom"]


def test_a_chunk_that_swells_is_not_unpacked_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bomb = zstandard.compress(bytes(50_000_000))
    packed = struct.pack("<QQQI", 0, 0, 50_000_000, 0) + struct.pack("<I", 4) + b"zstd" + struct.pack("<Q", len(bomb))
    bag = by_hand(tmp_path / "a.mcap", record(6, packed + bomb))
    monkeypatch.setattr(mcap_messages, "LARGEST", 2**20)
    with pytest.raises(InputError, match="a chunk or a message has more than 1 MiB"):
        list(mcap_messages.mcap_messages(str(bag), set()))
    packed = packed.replace(struct.pack("<Q", 50_000_000), struct.pack("<Q", 1_000))
    with pytest.raises(InputError, match="a chunk is longer than it says"):
        list(mcap_messages.mcap_messages(str(by_hand(bag, record(6, packed + bomb))), set()))


@pytest.mark.parametrize("mode", ["file", "message"])
def test_messages_that_another_program_could_not_read_are_refused(cli: Cli, tmp_path: Path, mode: str) -> None:
    run = rosbag2(tmp_path / "run", "sqlite3", {"/odom": (ODOMETRY, 1)}, packed=mode)
    said = labels(tmp_path, "channels: {/odom: mundane}")
    assert refused(cli("bag", run, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap"))
    if mode == "message":  # the file alone does not say it
        (file,) = run.glob("*.db3")
        (line,) = refused(cli("bag", file, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap"))
        assert "compressed one by one" in line
    assert not (tmp_path / "b.mcap").exists()


def test_outputs_that_are_refused(cli: Cli, tmp_path: Path) -> None:
    run = rosbag2(tmp_path / "run", topics={"/odom": (ODOMETRY, 1)})
    said = labels(tmp_path, "channels: {/odom: mundane}")
    (tmp_path / "link.mcap").symlink_to(run / "run.mcap")
    before = listing(tmp_path)
    words = ("bag", run, "--without", "all", "-l", said)
    for output, what in {
        run / "run.mcap": "is read in this run",
        tmp_path / "link.mcap": "is read in this run",
        run / "b.mcap": "lies in the recording",
        tmp_path / "b.bag": "the copy is an MCAP file",
        tmp_path / "no" / "b.mcap": "cannot be written",
    }.items():
        (line,) = refused(cli(*words, "-o", output))
        assert what in line
    for more in ([], ["-o", "-"], ["-o", "b.mcap", "--load"], ["-o", "b.mcap", "-f", "csv"], [run, "-o", "b.mcap"]):
        assert cli(*words, *more, cwd=tmp_path).returncode == 2
    (line,) = refused(cli("bag", run, "--without", "Vidoe", "-o", tmp_path / "b.mcap"))
    assert "did you mean Video" in line
    rosbag2(tmp_path / "runs" / "a")
    rosbag2(tmp_path / "runs" / "b")
    (line,) = refused(cli("bag", tmp_path / "runs", "--without", "all", "-o", tmp_path / "b.mcap"))
    assert "a folder of 2 bags; name one of them" in line
    assert {name: data for name, data in listing(tmp_path).items() if not name.startswith("runs")} == before


def test_without_the_library_the_extra_is_named(tmp_path: Path) -> None:
    run = rosbag2(tmp_path / "run", "sqlite3")
    words = ["rosprivacy", "bag", str(run), "--without", "all", "-o", str(tmp_path / "b.mcap")]
    code = (
        "import importlib.machinery, sys\n"
        "find = importlib.machinery.PathFinder.find_spec\n"
        "importlib.machinery.PathFinder.find_spec = lambda name, *rest: None if name == 'mcap' else find(name, *rest)\n"
        f"sys.argv = {words!r}\nfrom rosprivacy.cli import main; main()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    (line,) = refused(done)
    assert line.endswith("needs a library that is not installed; install the extra 'bags'")


@cache
def whole(storage: str) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        run = rosbag2(Path(folder, "run"), storage, {"/odom": (ODOMETRY, 2), "/camera": (IMAGE, 2)})
        (file,) = [file for file in run.iterdir() if file.suffix in (".mcap", ".db3")]
        return file.read_bytes()


@given(at=st.integers(0, 10**6), byte=st.integers(0, 255), storage=st.sampled_from(["mcap", "sqlite3"]))
def test_a_byte_that_is_another_is_an_error_or_changes_no_topic(at: int, byte: int, storage: str) -> None:
    """Whatever stands there instead: no other error, and never a topic that no label speaks of."""
    with tempfile.TemporaryDirectory() as folder:
        data = bytearray(whole(storage))
        data[at % len(data)] = byte
        file = Path(folder, "a.mcap" if storage == "mcap" else "a.db3")
        file.write_bytes(data)
        said = labels(Path(folder), "channels: {/odom: mundane}")
        copy = Path(folder, "b.mcap")
        try:
            share_bag(str(file), ["all"], copy, (), (str(said),), Settings())
        except (InputError, InputErrors):
            assert not copy.exists()
            return
        assert not copy.exists() or {row.topic for row in rows(copy)} == {"/odom"}


def test_where_nothing_is_left_nothing_is_written(cli: Cli, tmp_path: Path) -> None:
    bag = recorded(tmp_path / "a.mcap", MIXED)
    before = listing(tmp_path)
    done = cli("bag", "a.mcap", "--without", "Video", "-o", "b.mcap", cwd=tmp_path)
    assert done.returncode == 4
    assert done.stdout.startswith("nothing written: no topic of a.mcap with a message is known to be without Video\n")
    assert listing(tmp_path) == before
    empty = rosbag2(tmp_path / "run", topics={"/camera": (IMAGE, 1), "/odom": (ODOMETRY, 0)})
    whole = shared(cli, empty, "--without", "Video", "-o", bag.with_name("b.mcap"), code=4)
    assert reasons(whole)["/odom"] == "no message of it was recorded"
    assert whole["copy"] is None


def test_what_is_written_is_read_again_before_it_gets_its_name(tmp_path: Path) -> None:
    """A copy with another topic, another count or an attachment is none, and leaves what was there."""
    copy = tmp_path / "b.mcap"
    good = recorded(tmp_path / "a.mcap", [("/odom", ODOMETRY, b"a")])
    _check_copy(good, copy, {"/odom"}, Counter({"/odom": 1, "/camera": 5}))
    with_more = mcap(tmp_path / "c.mcap", attachment="face.png")
    for file, counts in (
        (good, Counter({"/odom": 2})),
        (good, Counter({"/odom": 1, "/camera": 1})),
        (with_more, Counter({"/camera": 50, "/odom": 1})),
    ):
        copy.write_bytes(b"earlier")
        with pytest.raises(InputError, match=r"b.mcap: read again, it has other topics or messages"):
            write_texts(
                [(copy, file.read_bytes())],
                check=lambda at, counts=counts: _check_copy(at, copy, {"/odom", "/camera"}, counts),  # type: ignore[misc]
            )
        assert copy.read_bytes() == b"earlier"
        assert {path.name for path in tmp_path.iterdir()} == {"a.mcap", "b.mcap", "c.mcap"}


# ---------------------------------------------------------------- what is said


TEXT = """\
written: b.mcap, 2 of 5 topics of a.mcap, 3 messages, without Video

in the copy:
  /clock, 1 message: rosprivacy:standard:8: it carries no kind of data
  /odom, 2 messages: Location; labels.yaml:2: it carries these at most; its type
      suggests RobotPosition (may)

left out:
  /camera, 1 message: Video can be in it: labels.yaml:2: it carries these at
      most
  /log, 1 message: no label says what it carries
  /rosout, 1 message: no label says what it carries

The copy was read again: it has these topics with these numbers of messages, and
nothing else. That proves the topics, not what is in their messages: labels are
a person's word, and no message was looked at.
"""


def test_what_is_said_fits_a_terminal(cli: Cli, tmp_path: Path) -> None:
    names = {"/camera": IMAGE, "/odom": ODOMETRY, "/log": ODD, "/rosout": LOG, "/clock": CLOCK}
    recorded(tmp_path / "a.mcap", [(name, kind, b"a") for name, kind in [*names.items(), ("/odom", ODOMETRY)]])
    labels(tmp_path, "channels: {/camera: {only: [Video]}, /odom: {only: [Location]}}")
    done = cli("bag", "a.mcap", "--without", "Video", "-l", "labels.yaml", "-o", "b.mcap", cwd=tmp_path)
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert done.stdout == TEXT


def test_the_command_of_the_page_runs(cli: Cli, tmp_path: Path) -> None:
    rosbag2(tmp_path / "run1")
    labels(tmp_path, "channels: {/odom: {only: [Location]}}")
    lines = [line for block in blocks(ROOT / "docs" / "bags.md", "console") for line in block.splitlines()]
    (command,) = [line for line in lines if "--without" in line]
    program, *words = shlex.split(command)
    done = cli(*words, cwd=tmp_path)
    assert (program, done.returncode, done.stderr) == ("rosprivacy", 0, "")
    assert [row.topic for row in rows(tmp_path / "shared.mcap")] == ["/odom"]


def test_hostile_names_stay_names(cli: Cli, tmp_path: Path) -> None:
    name = "/a\x1b[2J\n\u202e::error::<b>" + "x" * 3000
    bag = recorded(tmp_path / "a.mcap", [(name, ODD, b"a"), ("/odom", ODOMETRY, b"b")])
    said = labels(tmp_path, "channels: {/odom: mundane}")
    for form in ("text", "json"):
        done = cli("bag", bag, "--without", "all", "-l", said, "-o", tmp_path / "b.mcap", "-f", form)
        assert done.returncode == 0
        assert all(line.isprintable() for line in done.stdout.splitlines())
