"""Findings in the terminal: by the place where data gets out, the worst first; all have ids, a path stands once."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.finding_facts import in_order
from rosprivacy.report.naming import shown_name
from rosprivacy.report.text.finding_lines import details, overview
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

ID = re.compile(r"\[([0-9a-f]{16})\]")
NUMBER = re.compile(r" *(\d+)\. (.+?): ")
KINDS = ("BodyPose", "FaceImage", "GaitPattern", "Video", "Voice")
POLICY = """
<policy version="0.2.0"><enclaves><enclave path="/"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>image</topic></topics></profile>
<profile ns="/" node="mic"><topics publish="ALLOW"><topic>sound</topic></topics></profile>
<profile ns="/" node="uplink"><topics subscribe="ALLOW"><topic>image</topic><topic>sound</topic></topics></profile>
<profile ns="/" node="disk"><topics subscribe="ALLOW"><topic>sound</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""


def answer(folder: Path, *labels: str) -> dict[str, Any]:
    """What is answered for a camera and a microphone, an uplink that gets from both, and a disk."""
    (folder / "robot.policy.xml").write_text(POLICY)
    (folder / "robot.labels.yaml").write_text("\n".join(("labels: 1", *labels, "")))
    with chdir(folder):
        return rosprivacy.analyze("robot.policy.xml", "robot.labels.yaml").document()


@pytest.fixture
def home(tmp_path: Path) -> dict[str, Any]:
    return answer(
        tmp_path,
        "nodes:",
        f"  /camera: {{source: [{', '.join(KINDS)}]}}",
        "  /mic: {source: [Voice]}",
        f"  /uplink: {{leak: [{', '.join(KINDS)}]}}",
        "  /disk: {leak: [Voice]}",
    )


@pytest.fixture(scope="module")
def fleet() -> dict[str, Any]:
    with chdir(ROOT / "examples" / "fleet"):
        return rosprivacy.analyze_fleet("fleet.yaml").document()


def texts(lines: Iterable[tuple[str, str]]) -> list[str]:
    return [text for text, _ in lines]


def told(document: dict[str, Any]) -> tuple[list[str], list[str]]:
    """The list, and the details."""
    return texts(overview(document, IN_ENGLISH)), texts(details(document, document["findings"]))


def under(lines: Iterable[str]) -> Iterator[tuple[str, str]]:
    """(place, id) in the order of the lines."""
    place = ""
    for line in lines:
        if heading := NUMBER.match(line):
            place = heading[2]
        yield from ((place, id_) for id_ in ID.findall(line))


def test_each_finding_stands_once_with_its_id_under_the_place_where_it_gets_out(
    home: dict[str, Any], fleet: dict[str, Any]
) -> None:
    for document in (home, fleet):
        stand = sorted((shown_name(finding["leak"]), finding["id"]) for finding in document["findings"])
        for lines in told(document):
            assert sorted(under(lines)) == stand


def test_a_place_has_the_rank_of_the_worst_that_gets_there_and_one_number_in_the_list_and_the_details(
    home: dict[str, Any], fleet: dict[str, Any]
) -> None:
    for document in (home, fleet):
        places = dict.fromkeys(shown_name(f["leak"]) for f in in_order(document["findings"], document))
        numbered = [(str(number), place) for number, place in enumerate(places, 1)]
        for lines in told(document):
            assert [heading.groups() for heading in map(NUMBER.match, lines) if heading] == numbered


def test_kinds_that_come_along_one_path_are_together_and_the_path_stands_once(home: dict[str, Any]) -> None:
    lines = texts(details(home, home["findings"]))
    camera = [line for line in lines if line.startswith("   /camera ")]
    assert len(camera) == 1
    assert "all 5 kinds of data" in camera[0]
    assert any("/uplink" in line and "all 5 kinds of data" in line for line in lines if NUMBER.match(line))
    (title,) = (line for line in lines if line.endswith("from /camera"))
    findings = [finding for finding in home["findings"] if finding["source"]["name"] == "/camera"]
    assert {finding["category"] for finding in findings} == set(KINDS)
    assert all(f"{finding['category']} [{finding['id']}]" in title for finding in findings)


def test_what_holds_for_some_of_the_kinds_on_a_path_is_said_of_these(tmp_path: Path) -> None:
    document = answer(
        tmp_path,
        "nodes:",
        "  /camera: {source: [GaitPattern, Video]}",
        "  /uplink: {leak: [GaitPattern, Video]}",
        "channels:",
        "  /image: {sensitive: [Video]}",
    )
    (image,) = (line for line in texts(details(document, document["findings"])) if line.startswith("   /image "))
    assert image.endswith("not reviewed for GaitPattern)")
