"""What bridges and brokers are told to pass on, with the line; nothing of their users, passwords and keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.scan.checkout_files import checkout_files
from rosprivacy.ingest.scan.outside.bridge_configs import read_bridges

if TYPE_CHECKING:
    from pathlib import Path

MQTT = """\
/**/mqtt_client:
  ros__parameters:
    broker: {host: broker.example.com, port: 8883, user: zqsecret, pass: zqsecret}
    bridge:
      ros2mqtt:
        ros_topics: [/camera/faces, /odom]
        /odom: {mqtt_topic: odom}
      mqtt2ros:
        mqtt_topics: [orders]
        orders: {ros_topic: /orders}
"""
DOMAINS = "name: b\nfrom_domain: 0\nto_domain: 5\ntopics:\n  odom: {type: x}\n  map: {to_domain: 6}\n"
FOXGLOVE = "foxglove_bridge:\n  ros__parameters:\n    topic_whitelist: ['/tf', '.*image.*']\n    keyfile: zqsecret\n"
ROSBRIDGE = "a:\n  b:\n    ros__parameters:\n      address: 127.0.0.1\n      topics_glob: \"['/odom', '/map']\"\n"
ZENOH = """\
// a comment
{ mode: "client",
  connect: { endpoints: ["tls/hub.example.com:7447"] },
  transport: { auth: { usrpwd: { user: "zqsecret", password: "zqsecret" } } },
  plugins: { ros2dds: { allow: { publishers: ["/odom"], subscribers: ["/cmd_vel"] } } } }
"""
MOSQUITTO = """\
listener 1883
listener 1884 127.0.0.1
connection cloud
address cloud.example.com:8883
remote_password zqsecret
topic robot/# out 1
topic orders in 1
"""
MEDIA = "rtspAddress: :8554\npaths:\n  front:\n    source: rtsp://zqsecret:zqsecret@camera.example.com/live\n"


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("mqtt.yaml", MQTT, [(6, "MQTT broker broker.example.com", "broker", False, True, ("/camera/faces", "/odom")),
                             (9, "MQTT broker broker.example.com", "broker", True, False, ("/orders",))]),
        ("domains.yml", DOMAINS, [(5, "ROS domain 5 (from 0)", "bridge", True, True, ("odom",)),
                                  (6, "ROS domain 6 (from 0)", "bridge", True, True, ("map",))]),
        ("fox.yaml", FOXGLOVE, [(3, "clients of foxglove_bridge", "bridge", True, True, ("/tf", ".*image.*"))]),
        ("rb.yaml", ROSBRIDGE, [(5, "clients of rosbridge on this machine", "bridge", True, True, ("/odom", "/map"))]),
        ("z.json5", ZENOH, [(3, "Zenoh hub.example.com", "bridge", True, True, ("/odom", "/cmd_vel"))]),
        ("router.json5", "{connect: {endpoints: ['tcp/10.0.0.2:7447']}}",
         [(1, "Zenoh 10.0.0.2", "bridge", True, True, (".*",))]),
        ("mosquitto.conf", MOSQUITTO,
         [(1, "MQTT broker (port 1883)", "broker", True, True, ()),
          (4, "MQTT broker cloud.example.com", "broker", True, True, ("robot/#", "orders"))]),
        ("mediamtx.yml", MEDIA, [(3, "MediaMTX", "bridge", True, True, ("front",)),
                                 (4, "stream of camera.example.com", "bridge", True, False, ("front",))]),
        ("fleet.yaml", MQTT.replace("orders", "uagv/v2/acme/7/order").replace("broker.example.com", "b"),
         [(6, "MQTT broker b", "broker", False, True, ("/camera/faces", "/odom")),
          (9, "MQTT broker b (fleet control, VDA 5050)", "broker", True, False, ("/uagv/v2/acme/7/order",))]),
        ("other.yaml", "node:\n  ros__parameters: {paths: [a]}\n", []),
        ("other.json5", "{a: 1}", []),
    ],
)  # fmt: skip
def test_what_goes_where(
    tmp_path: Path, name: str, text: str, expected: list[tuple[int, str, str, bool, bool, tuple[str, ...]]]
) -> None:
    (tmp_path / name).write_text(text, "utf-8")
    found = read_bridges(checkout_files(tmp_path))
    assert [
        (one.place.line, one.name, one.sort, one.incoming, one.outgoing, one.channels) for one in found.externals
    ] == expected
    assert all(one.stated for one in found.externals)
    assert found.gaps == ()
    assert "zqsecret" not in repr(found)


@pytest.mark.parametrize(("name", "text"), [("b.yaml", "ros2mqtt: [\n"), ("b.json5", "{a: zqsecret"), ("b.json5", "")])
def test_what_cannot_be_read_is_a_gap(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, "utf-8")
    found = read_bridges(checkout_files(tmp_path))
    assert ([gap.place.file for gap in found.gaps], found.externals) == ([name], ())
