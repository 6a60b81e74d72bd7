"""Rule S7: two kinds that share a narrower one meet, since data of both may be of that; each case by the command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import refused
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from tests.helpers.command import Cli

WARD = """
@prefix : <urn:example:ward:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
:WardVideo a skos:Concept ; rp:label "WardVideo" ; skos:broader rp:Video , rp:Health ;
    skos:prefLabel "video of a ward"@en ; skos:definition "Video of patients in a ward."@en .
"""


@pytest.fixture(autouse=True)
def _camera_to_uplink(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("p.xml").write_text(policy("/camera>/video", "/planner>/plan</video", "/uplink</video,/plan"), "utf-8")


def labels(uplink: str, *, source: str = "ContactData", planner: str = "conduit", video: str = "sensitive") -> None:
    Path("l.yaml").write_text(
        f"labels: 1\nnodes:\n  /camera: {{source: [{source}]}}\n  /planner: {planner}\n  /uplink: {uplink}\n"
        f"channels: {{/video: {video}, /plan: sensitive}}\n",
        "utf-8",
    )


def disclosed(cli: Cli, *options: str) -> tuple[int, set[str]]:
    """Exit code, kinds of data that get from the camera to the uplink."""
    done = cli("analyze", "p.xml", "-l", "l.yaml", *options, "-f", "json")
    rows = json.loads(done.stdout)["findings"]
    assert {(f["source"]["name"], f["leak"]["name"]) for f in rows} <= {("/camera", "/uplink")}
    return done.returncode, {f["category"] for f in rows}


ADDRESS = {"source": "PostalAddress"}  # it is ContactData and a Location
NO_ADDRESS = "{leak: {none: [PostalAddress]}, conduit: [PostalAddress]}\n  /up*: {leak: [Location]}"


@pytest.mark.parametrize(
    ("uplink", "others", "expected"),
    [
        # to widen a leak loses no finding
        *((f"{{leak: [{kind}]}}", {}, "ContactData")
          for kind in ("ContactData", "PostalAddress", "Location", "PersonalData")),
        # a conduit of a broader or an overlapping kind takes no leak away, whatever its rank
        ("{leak: [PostalAddress], conduit: [ContactData]}", {}, "ContactData"),
        ("{leak: [PostalAddress], conduit: [ContactData]}", ADDRESS, "PostalAddress"),
        ("{leak: [Location], conduit: [ContactData]}", {}, "ContactData"),
        ("{leak: [Location], conduit: [ContactData]}", ADDRESS, "PostalAddress"),
        ("{conduit: [ContactData]}\n  /up*: {leak: [Location]}", {}, "ContactData"),
        # nor one of a narrower kind: what does not get out is said by `none`, or not named under leak
        ("{leak: [Location], conduit: [PostalAddress]}", ADDRESS, "PostalAddress"),
        (NO_ADDRESS, ADDRESS, "nothing"),
        (NO_ADDRESS, {}, "ContactData"),  # it may be another address
        # kinds that share none do not meet: nobody says where ContactData gets out
        ("{leak: [Voice], conduit: [ContactData]}", {}, "open"),
        # what is cleaned or kept out of an overlapping kind is not all that the data may be
        ("{leak: [ContactData], sanitizer: {Location: drop}}", {}, "ContactData"),
        ("{leak: [ContactData]}", {"video": "{never: [Location]}"}, "ContactData"),
        # what derives of an overlapping kind makes it
        (
            "{leak: [Activity], conduit: [ContactData]}",
            {"planner": "{derives: [{from: Location, to: Activity}]}"},
            "Activity",
        ),
        # a channel with only an overlapping kind lets it pass
        ("{leak: [ContactData]}", {"video": "{only: [Location]}"}, "ContactData"),
        ("{leak: [ContactData]}", {"video": "{only: [Voice]}"}, "nothing"),
    ],
)  # fmt: skip
def test_what_gets_out(cli: Cli, uplink: str, others: dict[str, str], expected: str) -> None:
    labels(uplink, **others)
    codes = {"nothing": 0, "open": 4}
    assert disclosed(cli) == (codes.get(expected, 1), {expected} - set(codes))


def test_what_ends_a_kind_and_makes_it_of_an_overlapping_one_is_refused(cli: Cli) -> None:
    labels("{leak: [Location]}", planner="{sanitizer: {Location: drop}, derives: [{from: ContactData, to: Location}]}")
    (line,) = refused(cli("analyze", "p.xml", "-l", "l.yaml"))
    assert "/planner is " in line


@pytest.mark.parametrize("name", ["Location", "PostalAddress"])
def test_an_overlapping_kind_is_followed_and_marked_where_the_other_is_asked_for(cli: Cli, name: str) -> None:
    """Rule S11: the answer covers what may be of the kind asked for, and says so."""
    labels("{leak: [Location], conduit: [ContactData]}")
    assert disclosed(cli, "-c", name) == (1, {"ContactData"})
    done = cli("analyze", "p.xml", "-l", "l.yaml", "-c", name, "-f", "json")
    assert json.loads(done.stdout)["assumptions"]["may_be_asked"] == {"ContactData": [name]}
    assert f"ContactData (may be {name}), from /camera" in cli("analyze", "p.xml", "-l", "l.yaml", "-c", name).stdout
    assert disclosed(cli, "-c", "Voice")[1] == set()  # shares none


def test_kinds_of_a_users_own_ontology_make_shipped_ones_overlap(cli: Cli) -> None:
    Path("ward.ttl").write_text(WARD, "utf-8")
    labels("{leak: [Health], conduit: [Video]}", source="Video")
    assert disclosed(cli) == (4, set())  # nobody says where Video gets out
    assert disclosed(cli, "--ontology", "ward.ttl") == (1, {"Video"})
