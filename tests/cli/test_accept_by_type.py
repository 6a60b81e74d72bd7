"""``labels --accept by-type``: one key for all channels at which such lines close no way (rules S11, S15)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml

import rosprivacy
from rosprivacy.analysis.model import BY_TYPE_CLOSES
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from tests.helpers.command import Cli

WAY = "/lidar>/scan", "/projector>/cloud</scan", "/mapper>/map</cloud", "/base>/wheels</map"
NODES = "nodes: {/lidar: {source: [LaserScan]}, /projector: conduit, /mapper: conduit, /base: conduit"
TYPES = """types: 1
topics:
  /scan: [{type: sensor_msgs/msg/LaserScan, writers: [/lidar]}]
  /cloud: [{type: sensor_msgs/msg/PointCloud2, writers: [/projector]}]
  /map: [{type: nav_msgs/msg/OccupancyGrid, writers: [/mapper]}]
  /wheels: [{type: geometry_msgs/msg/Twist, writers: [/base]}]
"""
COMMAND = ("labels", "--accept", "by-type", "p.xml", "-l", "l.yaml", "--types", "t.yaml", "--by", "Ada")


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("t.yaml").write_text(TYPES, "utf-8")


def lines(cli: Cli, labels: str, *profiles: str) -> set[str]:
    """Accept all such lines; return the channels that have one then."""
    Path("p.xml").write_text(policy(*profiles), "utf-8")
    Path("l.yaml").write_text(f"labels: 1\n{labels}", "utf-8")
    done = cli(*COMMAND)
    assert done.returncode == 0, done.stderr
    topics = yaml.safe_load(Path("l.yaml").read_text("utf-8")).get("topics", {})
    return {name for name, said in topics.items() if said["only"] == "by-type"}


def test_where_nothing_gets_out_all_are_taken_with_their_pins(cli: Cli) -> None:
    assert lines(cli, f"{NODES}}}\n", *WAY) == {"/scan", "/cloud", "/map", "/wheels"}
    written = yaml.safe_load(Path("l.yaml").read_text("utf-8"))
    assert written["pins"]["by-type"]["topics"]["/scan"] == {
        "types": ["sensor_msgs/msg/LaserScan"],
        "writers": ["/lidar"],
    }
    assert written["topics"]["/scan"]["note"].startswith("accepted by Ada on ")
    result = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml")
    assert not result.doubts
    assert cli(*COMMAND).stderr.endswith("l.yaml: 0 suggestions accepted\n")


def test_a_way_to_a_stated_leak_is_not_closed(cli: Cli) -> None:
    """A point cloud, of a type that is not made for a scan, between a scan and a leak."""
    labels = f"{NODES}, /uplink: {{leak: [LaserScan]}}}}\n"
    assert lines(cli, labels, *WAY, "/uplink</wheels") == {"/scan", "/wheels"}  # the leak names the kind
    result = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits=None)
    assert result.findings
    assert BY_TYPE_CLOSES not in {one.name for one in result.doubts}


def test_a_way_to_what_is_only_suggested_to_let_data_out_is_not_closed(cli: Cli) -> None:
    """By its name, ``/uplink`` is suggested as a leak; by its type, ``/camera`` as a source."""
    assert lines(cli, f"{NODES}}}\n", *WAY, "/uplink</cloud,/wheels") == {"/scan"}


def test_a_way_to_an_element_outside_ros_is_not_closed(cli: Cli) -> None:
    outside = "elements: {disk: {kind: storage, country: DE, retention: P1D, backups: false}}\n"
    flow = "flows: [{from: /base, to: disk}]\n"
    assert lines(cli, f"{NODES}}}\n{outside}{flow}", *WAY) == {"/scan", "/wheels"}


def test_policies_are_needed_and_nothing_else_is_accepted_with_it(cli: Cli) -> None:
    Path("l.yaml").write_text("labels: 1\n", "utf-8")
    done = cli("labels", "--accept", "by-type", "-l", "l.yaml")
    assert (done.returncode, done.stderr) == (
        2,
        "--accept: by-type without policies; name the policies, and --types where types were seen\n",
    )
    done = cli(*COMMAND, "--accept", "certain")
    assert done.returncode == 2


def test_suggest_says_how_many_and_not_those_on_a_way_out(cli: Cli) -> None:
    assert lines(cli, f"{NODES}}}\n", *WAY, "/uplink</cloud,/wheels") == {"/scan"}
    Path("l.yaml").write_text(f"labels: 1\n{NODES}}}\n", "utf-8")
    said = cli("suggest", "p.xml", "-l", "l.yaml", "--types", "t.yaml").stdout
    assert "1 channel could be taken by type: /scan; see docs/labels.md, then run rosprivacy labels --accept" in said
