"""The graph as ROS says it of itself (``rosgraph_msgs``): printed as YAML, or recorded; cut ones are refused (S16)."""

from __future__ import annotations

import io
import struct
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from mcap.writer import Writer

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.running.graph_messages import LAYOUT, GraphFiles, decoded
from rosprivacy.ingest.running.observed_names import whole_type
from tests.helpers.observed import AT

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.running.observation import Observation

SECTIONS = ("publishers", "subscriptions", "service_clients", "service_servers", "action_clients", "action_servers")
DIGEST = list(range(32))
RIHS = "RIHS01_" + bytes(DIGEST).hex()
NUMBERS = {"bool": "?", "byte": "B", "uint8": "B", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q", "float64": "d"}  # fmt: skip  # noqa: E501


def kind(name: str, digest: list[int] | None = None) -> dict[str, Any]:
    return {"name": name, "hash": {"version": 1, "value": digest or [0] * 32}}


def node(name: str, **sections: list[dict[str, Any]]) -> dict[str, Any]:
    return {"name": name} | {section: sections.get(section, []) for section in SECTIONS}


CAM = node(
    "/robot/cam",
    publishers=[{"name": "/robot/image", "type": kind("sensor_msgs/msg/Image", DIGEST)}],
    service_servers=[{"name": "/robot/save", "request_type": kind("a/srv/Save")}],
    action_clients=[{"name": "/turn", "send_goal": {"request_type": kind("a/action/Turn_SendGoal")}}],
)
UP = node("/up", subscriptions=[{"name": "/robot/image", "type": kind("sensor_msgs/Image")}])
SEEN = [
    ("/robot/cam", "call", "/turn", "a/action/Turn", ""),
    ("/robot/cam", "publish", "/robot/image", "sensor_msgs/msg/Image", RIHS),
    ("/robot/cam", "reply", "/robot/save", "a/srv/Save", ""),
    ("/up", "subscribe", "/robot/image", "sensor_msgs/msg/Image", ""),
]


def printed(value: Any, margin: str = "") -> str:
    """What ``ros2 topic echo`` prints: YAML in blocks."""
    if isinstance(value, dict):
        return "".join(f"{margin}{key}:{inner(value[key], margin)}" for key in value)
    return "".join(f"{margin}-{inner(one, margin)}" for one in value)


def inner(value: Any, margin: str) -> str:
    if isinstance(value, dict | list) and value:
        return "\n" + printed(value, f"{margin}  ")
    return f" {value}\n"


def wire(value: Any, kind: str = "Graph") -> bytes:
    """What goes over the wire, little-endian; what is not given is empty."""
    body = bytearray()

    def number(form: str, content: float) -> None:
        body.extend(bytes(-len(body) % struct.calcsize(form)) + struct.pack(f"<{form}", content))

    def write(kind: str, content: Any) -> None:
        if kind.endswith("]"):
            one, _, fixed = kind[:-1].partition("[")
            several = content or [0] * int(fixed or 0)
            if not fixed:
                number("I", len(several))
            for each in several:
                write(one, each)
        elif kind == "string":
            number("I", len(content or "") + 1)
            body.extend((content or "").encode() + b"\0")
        elif kind in NUMBERS:
            number(NUMBERS[kind], content or 0)
        else:
            for name, field in LAYOUT[kind]:
                write(field, (content or {}).get(name))

    write(kind, value)
    return b"\0\1\0\0" + bytes(body)


def recording(*messages: tuple[str, int, bytes]) -> bytes:
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start()
    for type_, seconds, data in messages:
        schema = writer.register_schema(type_, "ros2msg", b"")
        channel = writer.register_channel("/rosgraph", "cdr", schema)
        writer.add_message(channel, seconds * 10**9, data, seconds * 10**9)
    writer.finish()  # type: ignore[no-untyped-call] # it has no types
    return stream.getvalue()


def looked(file: Path, content: str | bytes, at: str = AT) -> Observation:
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    (seen,) = GraphFiles((str(file),), lambda: AT, at).looks()
    return seen


def ends(seen: Observation) -> list[tuple[str, ...]]:
    return sorted((one.node, one.role, one.name, one.type, one.hash) for one in seen.endpoints)


def test_a_graph_in_print_says_who_does_what_with_types_and_hashes(tmp_path: Path) -> None:
    seen = looked(tmp_path / "g.yaml", printed({"nodes": [CAM, UP]}) + "---\n")
    assert (ends(seen), seen.all_gaps, seen.doors) == (SEEN, {}, ("rosgraph",))
    assert [one.name for one in seen.nodes] == ["/robot/cam", "/up"]


def test_several_messages_add_up(tmp_path: Path) -> None:
    text = f"{printed({'nodes': [CAM]})}---\n{printed({'nodes': [UP]})}---\n{printed(UP)}---\n"
    assert ends(looked(tmp_path / "g.yaml", text)) == SEEN


def test_a_recorded_graph_has_the_times_of_the_recording(tmp_path: Path) -> None:
    both, one = wire({"nodes": [CAM, UP]}), wire(UP, "Node")
    data = recording(("rosgraph_msgs/msg/Graph", 60, both), ("rosgraph_msgs/msg/Node", 30, one), ("x/msg/X", 1, b"?"))
    seen = looked(tmp_path / "g.mcap", data, "")
    assert (ends(seen), seen.all_gaps) == (SEEN, {})
    assert (seen.span.first, seen.span.last) == ("1970-01-01T00:00:30Z", "1970-01-01T00:01:00Z")


def test_values_of_parameters_stay_where_they_are(tmp_path: Path) -> None:
    told = {**CAM, "parameters": [{"name": "key"}], "parameter_values": [{"string_value": "zqsecret"}]}
    for name, content in (
        ("g.yaml", printed(told)),
        ("g.mcap", recording(("rosgraph_msgs/msg/Node", 1, wire(told, "Node")))),
    ):
        assert "zqsecret" not in repr(looked(tmp_path / name, content))


@pytest.mark.parametrize(
    ("text", "gap"),
    [
        (printed({"nodes": [CAM, CAM]}), "same-name"),
        (printed({key: CAM[key] for key in CAM if key != "subscriptions"}), "unanswered"),
    ],
)
def test_what_is_known_to_be_missing_is_a_gap(tmp_path: Path, text: str, gap: str) -> None:
    assert looked(tmp_path / "g.yaml", text).all_gaps == {gap: 1}


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (printed({"nodes": [UP, "'...'"]}), 49),
        ("nodes: '<sequence type: rosgraph_msgs/msg/Node, length: 3>'\n", 1),
        (printed({**UP, "publishers": ["'...'"]}), 3),
        (printed({"nodes": [UP]}) + "---\nnodes: [{name: cam}]\n", 50),
        ("labels: 1\n", 1),
        ("a: [", 2),
        ("", 1),
        ("---\n", 1),
    ],
)
def test_a_cut_message_and_another_text_are_refused_at_a_line(tmp_path: Path, text: str, line: int) -> None:
    with pytest.raises(InputErrors) as refused:
        looked(tmp_path / "g.yaml", text)
    assert [error.line for error in refused.value.errors] == [line]


@pytest.mark.parametrize("messages", [(), (("rosgraph_msgs/msg/Graph", 1, wire(UP, "Node")),)])
def test_a_recording_without_a_graph_is_refused(tmp_path: Path, messages: tuple[tuple[str, int, bytes], ...]) -> None:
    with pytest.raises(InputErrors, match="rosgraph_msgs"):
        looked(tmp_path / "g.mcap", recording(*messages))


@pytest.mark.parametrize("name", ["g.mcap", "g.db3", "g.bag", "g.mcap.zstd"])
def test_what_is_no_recording_is_refused_in_one_line(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputErrors) as refused:
        looked(tmp_path / name, b"garbage")
    assert [error.file for error in refused.value.errors] == [str(tmp_path / name)]


@given(st.binary(max_size=400), st.integers(0, 600), st.integers(0, 600))
def test_damaged_bytes_are_refused_or_read_and_never_end_the_program(more: bytes, start: int, end: int) -> None:
    whole = wire({"nodes": [CAM, UP]})
    with suppress(ValueError):
        decoded(whole[:start] + more + whole[end:], "Graph")


def test_a_length_that_is_a_lie_costs_nothing() -> None:
    with pytest.raises(ValueError, match="longer than the message"):
        decoded(b"\0\1\0\0" + b"\xff\xff\xff\x7f", "Graph")


@pytest.mark.parametrize("name", ["x", "a/srv/B", "a/b/c/d", "", "1/msg/A", "a/msg/Ä"])
def test_what_is_no_type_of_a_message_is_none(name: str) -> None:
    assert whole_type(name, "msg") == ""
