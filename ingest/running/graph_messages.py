"""Messages in which ROS says its own graph (``rosgraph_msgs``, ``Graph`` and ``Node``) -> observations (rule S16).

In: what ``ros2 topic echo --full-length`` prints, or a recording. Out: ``Observation``, and a door. Values of
parameters are passed over.

Source: ros2/rcl_interfaces, ``rosgraph_msgs`` 2.5.0; ros-tooling/nodl, ``describe.md`` (how types stand in it);
ros2/rosidl_runtime_py, ``convert.py`` (how a list is cut in print).
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import ObservationError, shown
from rosprivacy.ingest.policies.observed_metadata import SAME_NAME, UNANSWERED
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.file_kinds import ROS_GRAPH
from rosprivacy.ingest.reading.yaml_values import Value
from rosprivacy.ingest.running.bag_folders import is_recording, read_bag
from rosprivacy.ingest.running.bag_messages import messages_of
from rosprivacy.ingest.running.cdr import Message
from rosprivacy.ingest.running.node_info import LONGEST, observed_in, text_of_what_runs
from rosprivacy.ingest.running.observation import (
    ROLES,
    Observation,
    ObservedEndpoint,
    ObservedNode,
    Span,
    moment,
)
from rosprivacy.ingest.running.observed_names import whole_type

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


DOOR = "rosgraph"
TYPES = {"rosgraph_msgs/msg/Graph": "Graph", "rosgraph_msgs/msg/Node": "Node"}
SECTIONS = {
    "publishers": ("publish", ("type",)),
    "subscriptions": ("subscribe", ("type",)),
    "service_servers": ("reply", ("request_type",)),
    "service_clients": ("request", ("request_type",)),
    "action_servers": ("execute", ("send_goal", "request_type")),
    "action_clients": ("call", ("send_goal", "request_type")),
}  # field -> the right, and where its type stands
SORTS = {"topic": "msg", "service": "srv", "action": "action"}
GENERATED = "_SendGoal"  # of an action's type
LAYOUT = {
    "Graph": (("nodes", "Node[]"),),
    "Node": (
        ("name", "string"),
        ("parameters", "ParameterDescriptor[]"),
        ("parameter_values", "ParameterValue[]"),
        ("publishers", "Topic[]"),
        ("subscriptions", "Topic[]"),
        ("service_clients", "Service[]"),
        ("service_servers", "Service[]"),
        ("action_clients", "Action[]"),
        ("action_servers", "Action[]"),
    ),
    "Topic": (("name", "string"), ("type", "InterfaceType"), ("qos", "QoSProfile")),
    "Service": (
        ("name", "string"),
        ("request_type", "InterfaceType"),
        ("request_qos", "QoSProfile"),
        ("response_type", "InterfaceType"),
        ("response_qos", "QoSProfile"),
    ),
    "Action": (
        ("name", "string"),
        ("send_goal", "Service"),
        ("get_result", "Service"),
        ("cancel_goal", "Service"),
        ("feedback", "Topic"),
        ("status", "Topic"),
    ),
    "InterfaceType": (("name", "string"), ("hash", "TypeHash")),
    "TypeHash": (("version", "uint8"), ("value", "uint8[32]")),
    "QoSProfile": (
        ("depth", "uint32"),
        ("deadline", "Duration"),
        ("lifespan", "Duration"),
        ("history", "uint8"),
        ("reliability", "uint8"),
        ("durability", "uint8"),
        ("liveliness", "uint8"),
        ("liveliness_lease_duration", "Duration"),
    ),
    "Duration": (("sec", "int32"), ("nanosec", "uint32")),
    "ParameterDescriptor": (
        ("name", "string"),
        ("type", "uint8"),
        ("description", "string"),
        ("additional_constraints", "string"),
        ("read_only", "bool"),
        ("dynamic_typing", "bool"),
        ("floating_point_range", "FloatingPointRange[]"),
        ("integer_range", "IntegerRange[]"),
    ),
    "FloatingPointRange": (("from_value", "float64"), ("to_value", "float64"), ("step", "float64")),
    "IntegerRange": (("from_value", "int64"), ("to_value", "int64"), ("step", "uint64")),
    "ParameterValue": (
        ("type", "uint8"),
        ("bool_value", "bool"),
        ("integer_value", "int64"),
        ("double_value", "float64"),
        ("string_value", "string"),
        ("byte_array_value", "byte[]"),
        ("bool_array_value", "bool[]"),
        ("integer_array_value", "int64[]"),
        ("double_array_value", "float64[]"),
        ("string_array_value", "string[]"),
    ),
}
HASH_BYTES = 32
SLACK = 64  # bytes; a buffer of Fast DDS is longer than the message in it, by up to a hundredth as measured
HINT = "give the output of `ros2 topic echo --full-length /rosgraph`, or a recording of it"
CUT = ("lists in it are cut: what is missing is not known", "print it anew with `ros2 topic echo --full-length`")
_END = re.compile(r"^---\r?\n", re.MULTILINE)  # of a message, in print


def decoded(data: bytes, message: str) -> Value:
    """Read a message as it goes over the wire.

    Parameters
    ----------
    message
        ``Graph`` or ``Node``.

    Raises
    ------
    ValueError
        If it is something else.
    """
    reader = Message(data)
    value = reader.value(message, LAYOUT)
    reader.ended(max(SLACK, len(data) // 8))
    return value


def read_graph(top: Value, at: str, file: str, before: int = 0) -> Observation:
    """Read one message.

    Parameters
    ----------
    at
        When it was seen.
    file, before
        For messages: the file, and how many of its lines stand before the message.

    Raises
    ------
    ObservationError
        If it is something else, or a part of one.
    """
    return _GraphReader(Span(at, at), partial(_later, file, before)).graph(top)


class _GraphReader:
    def __init__(self, span: Span, fail: Callable[[int, str, str], ObservationError]) -> None:
        self.span, self.fail = span, fail
        self.gaps: Counter[str] = Counter()
        self.remarks: list[str] = []

    def graph(self, top: Value) -> Observation:
        nodes = self.items(top, "nodes") if top.get("nodes") else (top,)
        names = Counter(self.name(node, "node") for node in nodes)
        several = {name: number for name, number in names.items() if number > 1}
        for name, number in several.items():
            self.gaps[SAME_NAME] += number - 1
            self.remarks.append(shown(f"{number} nodes are named {name}"))
        endpoints = tuple(one for node in nodes for one in self.endpoints(node))
        seen = tuple(ObservedNode(name, self.span) for name in names)
        return Observation((DOOR,), self.span, seen, endpoints, (), self.gaps, tuple(self.remarks))

    def endpoints(self, node: Value) -> Iterator[ObservedEndpoint]:
        owner = self.name(node, "node")
        if any(node.get(section) is None for section in SECTIONS):
            self.gaps[UNANSWERED] += 1
            self.remarks.append(shown(f"{owner}: not all of its fields are there, so not all that it does is known"))
        for section, (role, way) in SECTIONS.items():
            for end in self.items(node, section):
                kind = self.inner(end, way)
                yield ObservedEndpoint(
                    owner, role, self.name(end, section), self.span, type_of(kind, ROLES[role]), hash_of(kind)
                )

    def items(self, value: Value, key: str) -> tuple[Value, ...]:
        """The maps of a list; what stands in place of a list or of maps says that it was cut in print."""
        several = value.get(key) or Value(value.line, "list")
        bad = next(
            (one for one in (several, *several.items) if one.kind != ("list" if one is several else "map")), None
        )
        if bad:
            raise self.fail(bad.line, *CUT)
        return several.items

    def name(self, value: Value, sort: str) -> str:
        name = value.get("name")
        if value.kind != "map" or name is None or not name.text.startswith("/"):
            raise self.fail(value.line, f"no message of rosgraph_msgs: a {sort} without a name", HINT)
        return name.text

    def inner(self, value: Value, way: tuple[str, ...]) -> Value:
        for key in way:
            value = value.get(key) or Value(value.line, "empty")
        return value


def type_of(kind: Value, channel: str) -> str:
    """Return a type in ROS' words, without what is generated of it; empty where none is known."""
    name = kind.get("name")
    text = name.text if name else ""
    return whole_type(text.removesuffix(GENERATED) if channel == "action" else text, SORTS[channel])


def hash_of(kind: Value) -> str:
    """Return the hash of a type (REP 2016); empty where none is known."""
    value = (kind.get("hash") or kind).get("value")
    numbers = [one.text for one in value.items] if value else []
    if len(numbers) != HASH_BYTES or not all(one.isascii() and one.isdecimal() and len(one) < 4 for one in numbers):  # noqa: PLR2004 - a byte
        return ""
    found = [int(one) for one in numbers]
    return f"RIHS01_{bytes(found).hex()}" if any(found) and max(found) < 256 else ""  # noqa: PLR2004 - a byte


@dataclass(frozen=True, slots=True)
class GraphFiles:
    """A door of graphs that were printed or recorded before.

    Attributes
    ----------
    files, clock, at
        As those of ``TextFiles``; a recording has its own times.
    """

    files: tuple[str, ...]
    clock: Callable[[], str]
    at: str = ""

    def looks(self, seconds: float | None = None) -> Iterator[Observation]:  # noqa: ARG002 - files have looked already
        """Read all files; ``InputErrors`` has every problem."""
        yield observed_in(self.files, lambda file: (self._recorded if is_recording(file) else self._printed)(file))

    def _printed(self, file: str) -> Iterator[Observation]:
        text, at, name = text_of_what_runs(file, self.at, self.clock, ROS_GRAPH)
        line = 0
        printed: dict[str, int] = {}
        for message in _END.split(text if text.endswith("\n") else f"{text}\n"):
            if message.strip():
                printed.setdefault(message, line)
            line += message.count("\n") + 1
        for message, before in printed.items():
            yield read_graph(yaml_values.parse(message, partial(_later, name, before)), at, name, before)
        if not printed:
            raise ObservationError(name, 1, "no message is there", HINT)

    def _recorded(self, file: str) -> Iterator[Observation]:
        times: dict[tuple[str, bytes], tuple[int, int]] = {}
        size = 0
        read_bag(file)  # says what is wrong with it, or not installed
        for message in messages_of([file], set()):
            kind = TYPES.get(message.channel.schema.name if message.channel.schema else "")
            if kind:
                size += 0 if (kind, message.data) in times else len(message.data)
                first, last = times.get((kind, message.data), (message.log_time, message.log_time))
                times[kind, message.data] = min(first, message.log_time), max(last, message.log_time)
            if size > LONGEST:
                what = f"more than {LONGEST} bytes of messages of rosgraph_msgs that differ"
                raise ObservationError(file, 0, what, "split the recording (`mcap filter`)")
        for (kind, data), seen in times.items():
            try:
                top = decoded(data, kind)
            except ValueError as error:
                what = f"a message of rosgraph_msgs that cannot be read: {error}"
                raise ObservationError(file, 0, what, "record it with the rosgraph_msgs of your distribution") from None
            for at in sorted({self.at or _time(one) for one in seen}):
                yield read_graph(top, at, file)
        if not times:
            raise ObservationError(file, 0, "no message of rosgraph_msgs is in it", HINT)


def _time(nanoseconds: int) -> str:
    return moment(datetime.fromtimestamp(nanoseconds // 10**9, timezone.utc))


def _later(file: str, before: int, line: int, problem: str, hint: str) -> ObservationError:
    return ObservationError(file, line + before, problem, hint)
