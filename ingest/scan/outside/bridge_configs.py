"""Configurations of bridges and brokers -> what goes where outside the robot's own domain, each with its line.

What is kept of an address is its host; users, passwords, certificates and keys are not looked at. What a file says it
states: the way is there when the bridge runs with it.

Source: the READMEs of mqtt_client, domain_bridge, foxglove_bridge and rosbridge_server; ``DEFAULT_CONFIG.json5`` of
zenoh-plugin-ros2dds and of Zenoh (``connect``, ``listen``); mosquitto.conf(5); ``mediamtx.yml`` of MediaMTX.
"""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.ingest.code.source_code import is_fleet_topic
from rosprivacy.ingest.scan.outside.config_files import (
    JSON5,
    Stated,
    config_text,
    documents,
    first_bytes,
    unread,
)
from rosprivacy.ingest.scan.outside.externals import host_of
from rosprivacy.ingest.scan.scan_facts import CodePlace, External, Gap

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ingest.scan.checkout_files import CheckoutFiles

ENDINGS = (".yaml", ".yml", ".json")
WORDS = re.compile(  # without one of these a file configures no bridge that is read here
    rb"ros2mqtt|mqtt2ros|from_domain|topic_whitelist|topics_glob|ros2dds|rtspAddress|webrtcAddress|hlsAddress"
)
MOSQUITTO = re.compile(r"[\w.-]*mosquitto[\w.-]*\.conf")
PARAMETERS = "ros__parameters"
MEDIA = ("rtspAddress", "rtmpAddress", "hlsAddress", "webrtcAddress", "srtAddress")
LOCAL_HOSTS = ("127.0.0.1", "localhost", "::1")
ALL = (".*",)
FLEET = " (fleet control, VDA 5050)"


def read_bridges(checkout: CheckoutFiles) -> Stated:
    """Return what the configurations of bridges and brokers in a checkout state."""
    found: set[External] = set()
    gaps: set[Gap] = set()
    root = Path(checkout.root)
    for file in checkout.files:
        try:
            if MOSQUITTO.fullmatch(PurePosixPath(file).name):
                found.update(_mosquitto(config_text(root, file), file))
            elif file.endswith(JSON5) or (file.endswith(ENDINGS) and WORDS.search(first_bytes(root, file))):
                for top in documents(root, file):
                    found.update(_of_document(top, file))
        except InputErrors as errors:
            gaps.update(unread(file, error) for error in errors.errors)
        except InputError as error:
            gaps.add(unread(file, error))
    return Stated(tuple(sorted(found)), tuple(sorted(gaps)))


def _of_document(top: Value, file: str) -> Iterator[External]:
    for parameters in _parameters(top):
        yield from _mqtt_client(parameters, file)
        yield from _web_sockets(parameters, file)
    yield from _domain_bridge(top, file)
    yield from _zenoh(top, file)
    yield from _mediamtx(top, file)


def _parameters(top: Value) -> Iterator[Value]:
    """The parameters of all nodes of a parameter file, however deep their namespaces are."""
    waiting = [top]
    while waiting:
        value = waiting.pop()
        for key, _, inside in value.entries:
            if key == PARAMETERS:
                yield inside
            else:
                waiting.append(inside)


def _at(value: Value | None, *keys: str) -> Value | None:
    """What stands under keys, one in the other, or under one key with dots, as parameters are written."""
    if value is not None and (whole := value.get(".".join(keys))):
        return whole
    for key in keys:
        value = value.get(key) if value else None
    return value


def _texts(value: Value | None) -> tuple[str, ...]:
    """The texts of a list; of a text, what stands in it between brackets or commas."""
    if value is None:
        return ()
    texts = [item.text for item in value.items] or re.split(r"[\s,\[\]'\";]+", value.text)
    return tuple(dict.fromkeys(text for text in texts if text))


def _mqtt_client(parameters: Value, file: str) -> Iterator[External]:
    host = _at(parameters, "broker", "host")
    name = f"MQTT broker {host.text if host and host.text else 'localhost'}"
    for side, of_ros, topics in (("ros2mqtt", "", "ros_topics"), ("mqtt2ros", "ros_topic", "mqtt_topics")):
        part = _at(parameters, "bridge", side)
        if part is not None:
            written = _texts(part.get(topics))
            channels = tuple(_written_name(part, topic, of_ros) for topic in written)
            out = side == "ros2mqtt"
            of_mqtt = [_written_name(part, topic, "mqtt_topic") for topic in written]
            own = f"{name}{FLEET}" if any(map(is_fleet_topic, of_mqtt)) else name
            yield External(CodePlace(file, part.line), own, "broker", not out, out, True, channels)


def _written_name(part: Value, topic: str, key: str) -> str:
    """What a topic is called on the other side, where that stands below it."""
    inside = _at(part, topic, key) if key else None
    return inside.text if inside and inside.text else topic


def _web_sockets(parameters: Value, file: str) -> Iterator[External]:
    """``foxglove_bridge`` and ``rosbridge_server``: clients of a web socket get and write what is listed."""
    for key, name in (("topic_whitelist", "clients of foxglove_bridge"), ("topics_glob", "clients of rosbridge")):
        listed = parameters.get(key)
        if listed is not None:
            address = parameters.get("address")
            where = " on this machine" if address and address.text in LOCAL_HOSTS else ""
            place = CodePlace(file, listed.line)
            yield External(place, f"{name}{where}", "bridge", True, True, True, _texts(listed) or ALL)


def _domain_bridge(top: Value, file: str) -> Iterator[External]:
    first, second = top.get("from_domain"), top.get("to_domain")
    by_domain: dict[tuple[str, str], list[str]] = {}
    lines: dict[tuple[str, str], int] = {}
    for section in ("topics", "services", "actions"):
        part = top.get(section)
        for name, line, entry in part.entries if part else ():
            own = entry.get("from_domain") or first, entry.get("to_domain") or second
            if own[0] and own[1]:
                pair = own[0].text, own[1].text
                by_domain.setdefault(pair, []).append(name)
                lines.setdefault(pair, line)
    for (source, target), names in by_domain.items():
        name = f"ROS domain {target} (from {source})"
        yield External(CodePlace(file, lines[source, target]), name, "bridge", True, True, True, tuple(sorted(names)))


def _zenoh(top: Value, file: str) -> Iterator[External]:
    ends = _at(top, "connect", "endpoints")
    ros = _at(top, "plugins", "ros2dds")
    if ends is None and ros is None:
        return
    allow = ros.get("allow") if ros else None
    texts = [text for _, _, inside in (allow.entries if allow else ()) for text in _texts(inside)]
    channels = tuple(dict.fromkeys(texts)) if allow else ALL
    ways = list(_zenoh_ends(ends))
    for host, line in ways:
        yield External(CodePlace(file, line), f"Zenoh {host}", "bridge", True, True, True, channels)
    if ros is not None and not ways:
        yield External(CodePlace(file, ros.line), "Zenoh", "bridge", True, True, True, channels)


def _zenoh_ends(ends: Value | None) -> Iterator[tuple[str, int]]:
    """Hosts of ``tcp/192.168.0.2:7447``, with lines; they may stand below the mode in which they count."""
    waiting = [ends] if ends else []
    while waiting:
        value = waiting.pop()
        waiting += [*value.items, *(inside for _, _, inside in value.entries)]
        protocol, slash, rest = value.text.partition("/")
        host = host_of(f"{protocol}://{rest.partition('?')[0].partition('#')[0]}") if slash else ""
        if host:
            yield host, value.line


def _mediamtx(top: Value, file: str) -> Iterator[External]:
    paths = top.get("paths")
    if paths is None or not any(top.get(key) for key in MEDIA):
        return
    names = tuple(name for name, _, _ in paths.entries)
    yield External(CodePlace(file, paths.line), "MediaMTX", "bridge", True, True, True, names)
    for name, _, entry in paths.entries:
        source = entry.get("source")
        host = host_of(source.text) if source and "://" in source.text else ""
        if source and host:
            yield External(CodePlace(file, source.line), f"stream of {host}", "bridge", True, False, True, (name,))


def _mosquitto(text: str, file: str) -> Iterator[External]:
    """Bridges to other brokers, with their topics, and listeners that others than this machine can reach."""
    bridge: tuple[str, int] | None = None
    ways: dict[tuple[str, int], list[tuple[str, str]]] = {}
    for line, written in enumerate(text.split("\n"), 1):
        key, *rest = written.split() or [""]
        if key == "listener" and rest and not (len(rest) > 1 and rest[1] in LOCAL_HOSTS):
            yield External(CodePlace(file, line), f"MQTT broker (port {rest[0]})", "broker", True, True, True)
        elif key == "address" and rest:
            host = rest[0].rpartition(":")[0] if rest[0].count(":") == 1 else rest[0]
            bridge = (host, line)
            ways[bridge] = []
        elif key == "topic" and rest and bridge:
            ways[bridge].append((rest[0], rest[1] if len(rest) > 1 else "out"))
    for (host, line), topics in ways.items():
        channels = tuple(dict.fromkeys(name for name, _ in topics))
        sides = {side for _, side in topics} or {"both"}
        incoming, outgoing = bool(sides & {"in", "both"}), bool(sides & {"out", "both"})
        name = f"MQTT broker {host}{FLEET}" if any(map(is_fleet_topic, channels)) else f"MQTT broker {host}"
        yield External(CodePlace(file, line), name, "broker", incoming, outgoing, True, channels)
