"""Rules S11 and S13: what a shipped file alone keeps from a leak breaks the verdict, rides on it, or is counted."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import cli

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

RULES = {
    "topic": ('<topics {0}="ALLOW"><topic>{1}</topic></topics>', "publish", "subscribe"),
    "service": ('<services {0}="ALLOW"><service>{1}</service></services>', "reply", "request"),
}
LABELS = """labels: 1
nodes: {/camera: {source: [Video]}, /uplink: UPLINK, /viewer: conduit}
channels: {/video: sensitive}
"""


def node(name: str, *rules: str) -> str:
    profile = f'<profile ns="/" node="{name}">{"".join(rules)}</profile>'
    return f'<enclave path="/{name}"><profiles>{profile}</profiles></enclave>'


def written(channel: str, *others: str, kind: str = "topic", uplink: str = "{leak: [Video]}") -> None:
    """/camera -> /video -> /viewer, reviewed; and the camera writes a channel that /uplink reads."""
    rule, writes, reads = RULES[kind]
    topic, publish, subscribe = RULES["topic"]
    nodes = [
        node("camera", topic.format(publish, "/video"), rule.format(writes, channel)),
        node("uplink", rule.format(reads, channel)),
        node("viewer", topic.format(subscribe, "/video")),
        *map(node, others),
    ]
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{"".join(nodes)}</enclaves></policy>', "utf-8")
    Path("l.yaml").write_text(LABELS.replace("UPLINK", uplink), "utf-8")


def told(cli: Cli, *options: str) -> tuple[int, str, list[tuple[str, str, str]], Any]:
    """Exit code, verdict, (doubt, rank, element) of each doubt, and what Assumed says of the channels."""
    done = cli("analyze", "p.xml", "-l", "l.yaml", *options, "-f", "json1")
    document = json.loads(done.stdout)
    rows = [(row["doubt"], row["rank"], (row["element"] or {}).get("name", "")) for row in document["doubts"]]
    closing = [row for row in document["assumptions"]["standard_channels_reached"] if "keeps_from" in row]
    kept = [(row["element"]["name"], row["keeps_from"]["name"]) for row in closing]
    return done.returncode, document["verdict"], [row for row in rows if row[0].endswith("-closes")], kept


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_outside_its_standard_place_it_breaks_the_verdict_in_its_place_it_is_counted(cli: Cli) -> None:
    """Which place is standard, ``in_its_place`` says; here the verdict, by the shipped file or one's own."""
    for kind, channel, others, outside in (
        ("topic", "/x/clock", (), True),
        ("topic", "/my/rosout", (), True),
        ("topic", "/a/parameter_events", (), True),
        ("service", "/cloud/get_parameters", (), True),
        ("service", "/cloud/describe_parameters", ("cloudy",), True),
        ("topic", "/clock", (), False),
        ("topic", "/rosout", (), False),
        ("topic", "/parameter_events", (), False),
        ("service", "/camera/get_parameters", (), False),
        ("service", "/cloud/get_parameters", ("cloud",), False),
    ):
        written(channel, *others, kind=kind)
        kept = [(channel, "/uplink")]
        breaks = (4, "undetermined", [("standard-closes", "breaks", channel)], kept)
        assert told(cli) == (breaks if outside else (0, "no-leak-found", [], kept)), channel
        text = cli("analyze", "p.xml", "-l", "l.yaml", *(["-q"] if outside else [])).stdout
        assert (
            channel if outside else f"at 1 of them nothing else keeps data from a leak: {channel} -> /uplink"
        ) in text
        if outside:
            Path("s.yaml").write_text(f'labels: 1\nchannels: {{"{channel}": mundane}}\n', "utf-8")
            assert told(cli, "--standard-channels", "s.yaml") == breaks
            assert channel in cli("analyze", "p.xml", "-l", "l.yaml", "--standard-channels", "s.yaml", "-q").stdout


def test_where_the_file_of_infrastructure_closes_it_it_rides(cli: Cli) -> None:
    written("/tf_static")
    assert told(cli, "-l", "rosprivacy:infrastructure") == (
        0, "no-leak-found", [("infrastructure-closes", "rides", "/tf_static")], [("/tf_static", "/uplink")]
    )  # fmt: skip


def test_a_storage_and_an_element_outside_ros_count_as_a_leak_does(cli: Cli) -> None:
    for kind, facts in (
        ("storage", "retention: P1D, backups: false, country: DE"),
        ("device", "source: [Voice], conduit: [Video]"),
        ("external-system", "country: DE"),
    ):
        written("/x/clock", uplink="conduit")
        more = f"elements: {{out: {{kind: {kind}, {facts}}}}}\nflows: [{{from: /uplink, to: out}}]\n"
        Path("l.yaml").write_text(Path("l.yaml").read_text("utf-8") + more, "utf-8")
        code, verdict, doubts, kept = told(cli)
        assert (code, verdict, kept) == (4, "undetermined", [("/x/clock", "out")])
        assert ("standard-closes", "breaks", "/x/clock") in doubts


def test_what_leads_to_no_leak_or_is_closed_by_a_person_too_is_no_doubt(cli: Cli) -> None:
    written("/x/clock", uplink="conduit")
    Path("l.yaml").write_text(Path("l.yaml").read_text("utf-8").replace("conduit}", "{leak: none}}"), "utf-8")
    assert told(cli)[2:] == ([], [])
    written("/x/clock")
    own = Path("l.yaml").read_text("utf-8").replace("/video: sensitive", "/video: sensitive, /x/clock: mundane")
    Path("l.yaml").write_text(own, "utf-8")
    assert told(cli) == (0, "no-leak-found", [], [])
    Path("l.yaml").write_text(own.replace("mundane", "sensitive"), "utf-8")
    assert told(cli)[:2] == (1, "leak")


def test_on_a_fleet_it_breaks_too(cli: Cli) -> None:
    written("/x/clock")
    robots = "{a: {policies: [p.xml], labels: [l.yaml]}, b: {policies: [p.xml], labels: [l.yaml]}}"
    Path("f.yaml").write_text(f"fleet: 1\nrobots: {robots}\n", "utf-8")
    done = cli("analyze", "--fleet", "f.yaml", "-f", "json")
    document = json.loads(done.stdout)
    assert (done.returncode, document["verdict"]) == (4, "undetermined")
    assert [(row["doubt"], row["count"]) for row in document["doubts"]] == [("standard-closes", 2)]
