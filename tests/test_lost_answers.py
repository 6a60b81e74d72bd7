"""Answers that hid what is not known: each by the command, with exit code and the words that the reader sees.

Source: the review of commit b86d901, cases 10, 11, 13 to 15, and its defects D2, D4 and D7.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.command import cli

if TYPE_CHECKING:
    from tests.command import Cli

__all__ = ["cli"]

CAM = (
    '<enclave path="/cam"><profiles><profile ns="/" node="camera">'
    '<topics publish="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave>'
)
UP = (
    '<enclave path="/up"><profiles><profile ns="/" node="uplink">'
    '<topics subscribe="ALLOW"><topic>{topic}</topic></topics></profile></profiles></enclave>'
)


def policy(*enclaves: str) -> None:
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{"".join(enclaves)}</enclaves></policy>', "utf-8")


def labels(text: str) -> None:
    Path("l.yaml").write_text(f"labels: 1\n{text}", "utf-8")


def profile(node: str, *groups: tuple[str, str, str]) -> str:
    """A profile of (role, kind, name)."""
    rules = "".join(f'<{kind}s {role}="ALLOW"><{kind}>{name}</{kind}></{kind}s>' for role, kind, name in groups)
    return f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">{rules}</profile></profiles></enclave>'


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def ends(cli: Cli, *more: str) -> list[dict[str, Any]]:
    """The unknown ends of the JSON document."""
    document = json.loads(cli("analyze", "p.xml", "-l", "l.yaml", "--format", "json", *more).stdout)
    found: list[dict[str, Any]] = document["unknown_ends"]
    return found


class TestUnknownEnds:
    """Rule S11: what is not known is said (case 10)."""

    def test_a_channel_that_nobody_known_reads(self, cli: Cli) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        first, *_ = done.stdout.splitlines()
        assert first.startswith("no-leak-found: ")
        assert first.endswith("; 1 channel ends at no known reader")
        assert "   /video  (topic; Video)" in done.stdout.splitlines()
        assert (
            cli("analyze", "p.xml", "-l", "l.yaml", "-q").stdout.rstrip().endswith("1 channel ends at no known reader")
        )
        assert ends(cli) == [
            {
                "element": {"robot": "", "kind": "topic", "name": "/video"},
                "unknown": "reader",
                "categories": ["Video"],
            }
        ]

    def test_a_request_that_no_server_reads(self, cli: Cli) -> None:
        policy(profile("camera", ("request", "service", "/store")))
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/store: sensitive}\n")
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        assert "; 1 channel ends at no known reader" in done.stdout
        assert "   /store  (service request; Video)" in done.stdout.splitlines()

    def test_a_reply_that_no_client_reads(self, cli: Cli) -> None:
        policy(profile("camera", ("execute", "action", "/film")))
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/film: sensitive}\n")
        assert [end["element"]["leg"] for end in ends(cli)] == ["response"]

    @pytest.mark.parametrize("reads", ["/v*", "/video", "/vide?"])
    def test_who_reads_through_a_wildcard_is_a_known_reader(self, cli: Cli, reads: str) -> None:
        policy(CAM, UP.format(topic=reads))
        labels("nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {/v*: sensitive}\n")
        assert ends(cli) == []
        assert "no known reader" not in cli("analyze", "p.xml", "-l", "l.yaml").stdout

    def test_a_wildcard_that_nobody_known_reads(self, cli: Cli) -> None:
        policy(CAM.replace("/video", "/v*"), UP.format(topic="/other"))
        labels("nodes: {/camera: {source: [Video]}}\n")
        assert [end["element"]["name"] for end in ends(cli)] == ["/v*"]

    def test_who_is_denied_reads_nothing(self, cli: Cli) -> None:
        denied = UP.format(topic="/video").replace(
            "</profile>", '<topics subscribe="DENY"><topic>/video</topic></topics></profile>'
        )
        policy(CAM, denied)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
        assert [end["element"]["name"] for end in ends(cli)] == ["/video"]

    def test_a_channel_without_data_is_none(self, cli: Cli) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: mundane}\n")
        assert ends(cli) == []

    @pytest.mark.parametrize("flows", ["", "flows: [{from: cloud, to: /uplink}]\n"])
    def test_an_element_outside_ros_that_no_flow_reaches(self, cli: Cli, flows: str) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(
            "nodes: {/camera: {source: [Video]}, /uplink: conduit}\nchannels: {/video: sensitive}\n"
            f"elements: {{cloud: {{kind: external-system, country: US}}}}\n{flows}"
        )
        done = cli("analyze", "p.xml", "-l", "l.yaml")
        assert done.returncode == 0
        assert done.stdout.splitlines()[0].endswith("; 1 element outside ROS is reached by no flow")
        assert "   cloud  (external-system)" in done.stdout.splitlines()

    def test_a_device_that_data_begins_at_is_none(self, cli: Cli) -> None:
        policy(CAM, UP.format(topic="/video"))
        labels(
            "nodes: {/uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"
            "elements: {badge: {kind: device, source: [Video]}}\nflows: [{from: badge, to: /camera}]\n"
        )
        assert ends(cli) == []

    @pytest.mark.parametrize("form", ["html", "markdown"])
    def test_in_the_report(self, cli: Cli, form: str) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
        done = cli("report", "p.xml", "-l", "l.yaml", "--format", form)
        assert done.returncode == 0
        assert "Unknown ends (1 element): it is not known who reads or what flows in" in done.stdout
        assert "Channels with data that nobody known reads" in done.stdout

    def test_on_a_fleet_with_the_robot(self, cli: Cli) -> None:
        policy(CAM)
        labels("nodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
        fleet = (
            "fleet: 1\nrobots: {a: {policies: [p.xml], labels: [l.yaml]}, b: {policies: [p.xml], labels: [l.yaml]}}\n"
        )
        Path("f.yaml").write_text(fleet, "utf-8")
        done = cli("analyze", "--fleet", "f.yaml")
        assert done.returncode == 0
        assert done.stdout.splitlines()[0].endswith("; 2 channels end at no known reader")
        assert "   a:/video  (topic; Video)" in done.stdout.splitlines()
