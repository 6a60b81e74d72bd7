"""The register of a hospital's office: each row tells of its own place and of its own ways (GDPR, Article 30)."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.example import CATEGORIES, DISK, factory
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.findings.processed import processed
from rosprivacy.analysis.findings.register import Statements, register
from rosprivacy.analysis.model import NonRosFacts, Processing
from rosprivacy.analysis.model.register_row import Cell
from tests.helpers.reports import policy

if TYPE_CHECKING:
    from pathlib import Path

NODES = {
    "guide_camera": (["guide_video"], []),
    "ward_camera": (["ward_video"], []),
    "greeter": (["faces"], ["guide_video"]),
    "judge": (["moods"], ["guide_video"]),
    "blur": (["blurred"], ["ward_video"]),
    "recorder": ([], ["faces", "moods", "guide_video"]),
    "trainer": ([], ["blurred", "guide_video"]),
    "teleop": ([], ["ward_video"]),
    "lights": ([], ["noise"]),
    "mic": (["noise"], []),
}
LABELS: dict[str, Any] = {
    "labels": 1,
    "context": ["workplace"],
    "country": "DE",
    "controller": "Example Klinik",
    "dpo": "B. Beispiel",
    "purpose": "greeting of visitors",
    "legal_basis": ["6(1)(f)"],
    "nodes": {
        "/guide_camera": {"source": ["Video"], "subjects": ["visitors"]},
        "/ward_camera": {"source": ["Video"], "subjects": ["patients"]},
        "/mic": {"source": ["Voice"], "subjects": ["staff"]},
        "/greeter": {"derives": [{"from": "Video", "to": "FaceTemplate"}]},
        "/judge": {"derives": [{"from": "Video", "to": "EmotionEstimate"}], "sanitizer": {"Video": "drop"}},
        "/blur": {"sanitizer": {"Video": "pseudonymise"}},
        "/recorder": "conduit",
        "/trainer": "conduit",
        "/teleop": "conduit",
        "/lights": "conduit",
    },
    "elements": {
        "archive": {
            "kind": "storage", "country": "US", "operator": "Example Cloud", "recipient": "processor",
            "contract": "Article 28, 2026-03-01", "retention": {"PersonalData": "P1Y", "Video": "P90D"},
            "encrypted": False, "transfer": "standard-clauses",
        },
        "training set": {
            "kind": "storage", "country": "BR", "operator": "Example IA", "recipient": "third-party", "encrypted": True,
        },
        "cabin": {"kind": "person", "country": "JP", "operator": "Example Teleop", "recipient": "processor"},
    },
    "flows": [
        {"from": "/recorder", "to": "archive"},
        {"from": "/trainer", "to": "training set"},
        {"from": "/teleop", "to": "cabin"},
    ],
}  # fmt: skip
Rows = dict[tuple[str, str], dict[str, Any]]


@pytest.fixture
def office(tmp_path: Path) -> dict[str, Any]:
    (tmp_path / "office.policy.xml").write_text(policy(NODES), "utf-8")
    (tmp_path / "office.labels.json").write_text(json.dumps(LABELS), "utf-8")
    files = [str(tmp_path / name) for name in ("office.policy.xml", "office.labels.json")]
    return rosprivacy.analyze(files[:1], files[1:]).document()


@pytest.fixture
def rows(office: dict[str, Any]) -> Rows:
    return {(row["category"], row["places"][0]["name"] if row["places"] else ""): row for row in office["register"]}


def names(entries: list[dict[str, Any]]) -> list[str]:
    return [(one.get("element") or one)["name"] for one in entries]


def test_a_time_limit_is_that_of_the_place_itself(rows: Rows) -> None:
    assert rows["Video", "archive"]["retention"] == ["P90D"]
    assert rows["FaceTemplate", "archive"]["retention"] == ["P1Y"]
    for place in ("training set", "cabin"):
        assert rows["Video", place]["retention"] == []
        assert "retention" in rows["Video", place]["to_complete"]


def test_a_measure_lies_on_the_way_and_who_judges_persons_is_none(rows: Rows) -> None:
    assert [(names([one]), one["everywhere"]) for one in rows["Video", "training set"]["measures"]] == [
        (["/blur"], False)  # the guide's video comes past it
    ]
    assert rows["Video", "cabin"]["measures"] == rows["Video", "archive"]["measures"] == []
    assert not any("/judge" in names(row["measures"]) for row in rows.values())
    assert (rows["Video", "archive"]["encrypted"], rows["Video", "training set"]["encrypted"]) == (False, True)


def test_persons_of_what_is_made_are_those_of_whom_it_is_made(rows: Rows) -> None:
    made = rows["FaceTemplate", "archive"]
    assert (names(made["sources"]), made["subjects"]) == (["/guide_camera"], ["visitors"])
    assert [(*names([one]), one["from"], one["to"]) for one in made["derivations"]] == [
        ("/greeter", "Video", "FaceTemplate")
    ]
    assert rows["Video", "cabin"]["subjects"] == ["patients"]
    assert rows["Video", "training set"]["subjects"] == ["patients", "visitors"]


def test_what_rests_or_leaves_nowhere_has_a_row_without_a_finding(rows: Rows) -> None:
    assert rows["EmotionEstimate", "archive"]["state"] == "no-finding"
    alone = rows["Voice", ""]
    assert (names(alone["sources"]), alone["subjects"], alone["findings"]) == (["/mic"], ["staff"], [])
    assert {kind for kind, _ in rows} == {"EmotionEstimate", "FaceTemplate", "Video", "Voice"}


def test_a_finding_stands_in_the_row_where_it_ends(office: dict[str, Any], rows: Rows) -> None:
    ids = sorted(one for row in rows.values() for one in row["findings"])
    assert ids == sorted(finding["id"] for finding in office["findings"])
    assert rows["Video", "cabin"]["state"] == "open"


def test_a_processor_without_a_contract_is_to_be_completed(rows: Rows) -> None:
    assert "contract" in rows["Video", "cabin"]["to_complete"]
    assert "contract" not in rows["Video", "archive"]["to_complete"]
    assert "contract" not in rows["Video", "training set"]["to_complete"]


def test_law_is_that_of_the_kind_and_of_where_the_sources_work(rows: Rows) -> None:
    emotion, voice = (set(rows[at]["look_at"]) for at in (("EmotionEstimate", "archive"), ("Voice", "")))
    assert "AI Act Annex III point 1" in emotion - voice  # of the kind
    assert "BDSG § 26 (Germany)" in emotion & voice  # of the workplace, in Germany
    assert not any("(France)" in name for name in emotion | voice)
    assert (rows["Voice", ""]["contexts"], rows["Voice", ""]["countries"]) == (["workplace"], ["DE"])


SAFE = NonRosFacts(country="DE", area="eea", operator="us", recipient="controller", encrypted=True)


@pytest.mark.parametrize(
    ("stated", "basis", "missing"),
    [
        ({}, "", []),
        ({"country": ""}, "", [Cell.SAFEGUARDS]),
        ({"country": "", "transfer": "standard-clauses"}, "", []),
        ({"country": "KR", "area": "adequate"}, "", []),
        ({"country": "IN", "area": "third"}, "", [Cell.SAFEGUARDS]),
        ({"country": "IN", "area": "third", "transfer": "none"}, "", [Cell.SAFEGUARDS]),
        ({"country": "IN", "area": "third", "transfer": "adequacy"}, "", [Cell.SAFEGUARDS]),
        ({"country": "IN", "area": "third", "transfer": "standard-clauses"}, "46(2)(c)", []),
        ({"country": "IN", "area": "third", "transfer": "derogation"}, "49(1)(a)", [Cell.SAFEGUARDS]),
        ({"country": "IN", "area": "third", "transfer": "occasional-derogation"}, "", [Cell.SAFEGUARDS]),
        ({"country": "IN", "area": "third", "transfer": "occasional-derogation"}, "49(1)(a)", []),
    ],
)
def test_a_safeguard_has_to_be_known_where_data_may_leave_the_eea(
    stated: dict[str, Any], basis: str, missing: list[Cell]
) -> None:
    """Article 30(1)(e): the country, and of a derogation which one; whether it is occasional is asked (Article 49)."""
    graph, bound, hierarchy = factory()
    said = Processing(bases=(("", (basis,)),)) if basis else Processing()
    bound = replace(bound, outside={DISK: SAFE._replace(**stated)}, of_robots={"": said})
    analysis = analyse(graph, bound, hierarchy)
    bases = processed(analysis, bound, hierarchy)
    for row in register(analysis, Statements(bound, bases, Contexts({}, CATEGORIES), hierarchy, lambda *_: ())):
        if row.places[0].name == "disk":
            assert [cell for cell in row.to_complete if cell is Cell.SAFEGUARDS] == missing
            assert row.safeguards == ((basis,) if basis else ())
