"""Rule S7: two kinds that share a narrower one meet, since data of both may be of that; each case by the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import cli, refused

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

WARD = """
@prefix : <urn:example:ward:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
:WardVideo a skos:Concept ; rp:label "WardVideo" ; skos:broader rp:Video , rp:Health ;
    skos:prefLabel "video of a ward"@en ; skos:definition "Video of patients in a ward."@en .
"""


def profile(node: str, **topics: str) -> str:
    rules = "".join(
        f'<topics {does}="ALLOW"><topic>/{name}</topic></topics>'
        for does, names in topics.items()
        for name in names.split()
    )
    return f'<enclave path="/{node}"><profiles><profile ns="/" node="{node}">{rules}</profile></profiles></enclave>'


@pytest.fixture(autouse=True)
def _camera_to_uplink(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    enclaves = [
        profile("camera", publish="video"),
        profile("planner", subscribe="video", publish="plan"),
        profile("uplink", subscribe="video plan"),
    ]
    Path("p.xml").write_text(f'<policy version="0.2.0"><enclaves>{"".join(enclaves)}</enclaves></policy>', "utf-8")


def labels(uplink: str, *, source: str = "ContactData", planner: str = "conduit", video: str = "sensitive") -> None:
    Path("l.yaml").write_text(
        f"labels: 1\nnodes:\n  /camera: {{source: [{source}]}}\n  /planner: {planner}\n  /uplink: {uplink}\n"
        f"channels: {{/video: {video}, /plan: sensitive}}\n",
        "utf-8",
    )


def found(cli: Cli, *options: str) -> tuple[int, set[tuple[str, str, str]]]:
    """Exit code, (kind of data, source, leak) of each finding."""
    done = cli("analyze", "p.xml", "-l", "l.yaml", *options, "-f", "json")
    rows = json.loads(done.stdout)["findings"]
    return done.returncode, {(f["category"], f["source"]["name"], f["leak"]["name"]) for f in rows}


DISCLOSED = (1, {("ContactData", "/camera", "/uplink")})


@pytest.mark.parametrize("leak", ["ContactData", "PostalAddress", "Location", "PersonalData"])
def test_to_widen_a_leak_loses_no_finding(cli: Cli, leak: str) -> None:
    labels(f"{{leak: [{leak}]}}")
    assert found(cli) == DISCLOSED


@pytest.mark.parametrize("leak", ["PostalAddress", "Location"])
@pytest.mark.parametrize("source", ["ContactData", "PostalAddress"])
def test_a_conduit_of_a_broader_or_an_overlapping_kind_takes_no_leak_away(cli: Cli, leak: str, source: str) -> None:
    labels(f"{{leak: [{leak}], conduit: [ContactData]}}", source=source)
    assert found(cli) == (1, {(source, "/camera", "/uplink")})


def test_neither_does_one_of_a_higher_rank(cli: Cli) -> None:
    labels("{conduit: [ContactData]}\n  /up*: {leak: [Location]}")
    assert found(cli) == DISCLOSED


def test_nor_one_of_a_narrower_kind_and_the_message_says_so(cli: Cli) -> None:
    """S7: a conduit says 'reviewed'; what does not get out is said by ``none``, or not named under leak."""
    labels("{leak: [Location], conduit: [PostalAddress]}", source="PostalAddress")
    assert found(cli) == (1, {("PostalAddress", "/camera", "/uplink")})
    assert "does not take away the leak of PostalAddress" in cli("analyze", "p.xml", "-l", "l.yaml").stdout
    labels(
        "{leak: {none: [PostalAddress]}, conduit: [PostalAddress]}\n  /up*: {leak: [Location]}", source="PostalAddress"
    )
    assert found(cli) == (0, set())
    labels("{leak: {none: [PostalAddress]}, conduit: [PostalAddress]}\n  /up*: {leak: [Location]}")
    assert found(cli) == DISCLOSED  # it may be another address


def test_kinds_that_share_none_do_not_meet(cli: Cli) -> None:
    labels("{leak: [Voice], conduit: [ContactData]}")
    assert found(cli) == (4, set())  # nobody says where ContactData gets out


def test_must_stays_must(cli: Cli) -> None:
    """What is cleaned or kept out of an overlapping kind is not all that the data may be."""
    labels("{leak: [ContactData], sanitizer: {Location: drop}}")
    assert found(cli) == DISCLOSED
    labels("{leak: [ContactData]}", video="{never: [Location]}")
    assert found(cli) == DISCLOSED


def test_what_derives_of_an_overlapping_kind_makes_it(cli: Cli) -> None:
    labels("{leak: [Activity], conduit: [ContactData]}", planner="{derives: [{from: Location, to: Activity}]}")
    assert found(cli) == (1, {("Activity", "/camera", "/uplink")})


def test_a_channel_with_only_an_overlapping_kind_lets_it_pass(cli: Cli) -> None:
    labels("{leak: [ContactData]}", video="{only: [Location]}")
    assert found(cli) == DISCLOSED
    labels("{leak: [ContactData]}", video="{only: [Voice]}")
    assert found(cli)[1] == set()


def test_what_ends_a_kind_and_makes_it_of_an_overlapping_one_is_refused(cli: Cli) -> None:
    labels("{leak: [Location]}", planner="{sanitizer: {Location: drop}, derives: [{from: ContactData, to: Location}]}")
    (line,) = refused(cli("analyze", "p.xml", "-l", "l.yaml"))
    assert "/planner is " in line


class TestAskedFor:
    """Rule S11: the answer covers what may be of the kind asked for, and says so."""

    def said(self, cli: Cli, *options: str) -> Any:
        done = cli("analyze", "p.xml", "-l", "l.yaml", *options, "-f", "json")
        return json.loads(done.stdout)["assumptions"]["may_be_asked"]

    @pytest.mark.parametrize("name", ["Location", "PostalAddress"])
    def test_an_overlapping_kind_is_followed_and_marked(self, cli: Cli, name: str) -> None:
        labels("{leak: [Location], conduit: [ContactData]}")
        assert found(cli, "-c", name) == DISCLOSED
        assert self.said(cli, "-c", name) == {"ContactData": [name]}
        lines = cli("analyze", "p.xml", "-l", "l.yaml", "-c", name).stdout.splitlines()
        assert any(line.startswith(f"1. ContactData (may be {name}): /camera -> /uplink   [") for line in lines)
        assert f"   and ContactData, since data of this kind may be {name}" in lines

    def test_one_that_shares_none_is_not(self, cli: Cli) -> None:
        labels("{leak: [Location]}")
        assert found(cli, "-c", "Voice")[1] == set()


def test_kinds_of_a_users_own_ontology_make_shipped_ones_overlap(cli: Cli) -> None:
    Path("ward.ttl").write_text(WARD, "utf-8")
    labels("{leak: [Health], conduit: [Video]}", source="Video")
    assert found(cli) == (4, set())  # nobody says where Video gets out
    assert found(cli, "--ontology", "ward.ttl") == (1, {("Video", "/camera", "/uplink")})
