"""Where a system or a source works: ``context`` and ``country`` of label and fleet files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from pathlib import Path

POLICY = policy("/cam>/a<", "/keys>/a<", "/sink><a".replace("<a", "</a"))
LABELS = """labels: 1
{top}
nodes:
  /cam: {{source: [Video]{own}}}
  /keys: {{source: [OperatorInput]}}
  /sink: {{leak: [Video, OperatorInput]}}
"""


def told(folder: Path, top: str = "", own: str = "", **more: object) -> dict[str, object]:
    (folder / "p.xml").write_text(POLICY, "utf-8")
    (folder / "l.yaml").write_text(LABELS.format(top=top, own=own), "utf-8")
    return rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml"), **more).document()  # type: ignore[arg-type]


def contexts(document: dict[str, object]) -> dict[str, set[str]]:
    rows: list[dict[str, object]] = document["findings"]  # type: ignore[assignment]
    return {str(f["category"]): {one["context"] for one in f["in_context"]} for f in rows}  # type: ignore[attr-defined]


def test_of_the_system_it_holds_for_every_source(tmp_path: Path) -> None:
    document = told(tmp_path, top="context: care\ncountry: DE")
    assert contexts(document) == {"Video": {"care"}, "OperatorInput": {"care"}}
    assert [(row["contexts"], row["country"]) for row in document["surroundings"]] == [(["care"], "DE")] * 2  # type: ignore[attr-defined]


def test_of_a_source_it_holds_there_beside_that_of_the_system(tmp_path: Path) -> None:
    assert contexts(told(tmp_path, top="context: [union]", own=", context: [school]")) == {
        "Video": {"school", "union"},
        "OperatorInput": {"union"},
    }


def test_without_one_nothing_is_said(tmp_path: Path) -> None:
    document = told(tmp_path)
    assert contexts(document) == {"Video": set(), "OperatorInput": set()}
    assert document["contexts"] == []


def test_article_9_asks_for_what_may_reveal_where_the_system_works(tmp_path: Path) -> None:
    """A wrong 'nothing found' is the worst: the filter takes the context into account."""
    assert [f["category"] for f in told(tmp_path, article9=True)["findings"]] == ["Video"]  # type: ignore[attr-defined]
    found = told(tmp_path, top="context: care", article9=True)["findings"]
    assert [(f["category"], f["article9"]) for f in found] == [  # type: ignore[attr-defined]
        ("OperatorInput", "may-reveal"),
        ("Video", "may-reveal"),
    ]


def test_a_fleet_file_states_it_of_all_of_a_model_and_of_a_robot(tmp_path: Path) -> None:
    """Robots that work elsewhere are not alike, and what is said of each survives (rule S10)."""
    told(tmp_path)
    (tmp_path / "f.yaml").write_text(
        "fleet: 1\ncontext: workplace\ncountry: FR\nmodels:\n  m: {policies: p.xml, labels: l.yaml, context: [care]}\n"
        "robots:\n  a: {model: m}\n  b: {model: m, context: school, country: DE}\n"
        "  c: {policies: p.xml, labels: l.yaml}\n"
        "elements:\n  mic: {kind: device, source: [Voice], subjects: [guests], context: [worship]}\n"
        "flows:\n  - {from: mic, to: 'a:/sink'}\n",
        "utf-8",
    )
    document = rosprivacy.analyze_fleet(str(tmp_path / "f.yaml")).document()
    found = {
        (row["element"]["robot"], row["element"]["name"]): (row["contexts"], row.get("country"))
        for row in document["surroundings"]
    }
    assert found["a", "/cam"] == (["care", "workplace"], "FR")
    assert found["b", "/cam"] == (["care", "school", "workplace"], "DE")
    assert found["c", "/cam"] == (["workplace"], "FR")
    assert found["shared", "mic"] == (["workplace", "worship"], None)
    assert [row["subjects"] for row in document["subjects"]] == [["guests"]]
    videos = [f for f in document["findings"] if f["category"] == "Video"]
    (video,) = {tuple(sorted(one["context"] for one in f["in_context"])) for f in videos}
    assert video == ("care", "school", "workplace")  # of the robots that the pattern stands for


GROUNDS = [
    ("", None),
    ("country: NO", None),
    ("country: US", "open"),
    ("country: US\ngdpr: {established: no}", "open"),
    ("country: CH\ngdpr: {targeted: false}", "open"),
    ("country: US\ngdpr: {established: no, targeted: no}", "denied"),
    ("country: US\ngdpr: {established: no, targeted: yes}", None),
    ("country: US\ngdpr: {established: yes}", None),
    ("country: FR\ngdpr: {established: no, targeted: no}", None),
]


@pytest.mark.parametrize(("top", "scope"), GROUNDS)
def test_outside_the_eea_whether_the_gdpr_applies_is_a_question(tmp_path: Path, top: str, scope: str | None) -> None:
    """GDPR, Article 3: one of two grounds affirms it; only both denied deny it. Findings keep their kinds and ids."""
    document, plain = told(tmp_path, top=top), told(tmp_path)
    rows: list[dict[str, object]] = document["findings"]  # type: ignore[assignment]
    assert {row.get("gdpr") for row in rows} == {scope}
    assert {row.get("gdpr") for row in document["surroundings"]} <= {scope}  # type: ignore[attr-defined]
    assert [(row["id"], row["kind"]) for row in rows] == [(f["id"], f["kind"]) for f in plain["findings"]]  # type: ignore[attr-defined]
    assert document["verdict"] == plain["verdict"]


def test_of_robots_of_one_finding_the_plainest_answer_counts(tmp_path: Path) -> None:
    """A finding of a fleet stands for all its robots: nothing is denied of it that holds of one of them."""
    told(tmp_path)
    fleet = "fleet: 1\ngdpr: {{established: no, targeted: no}}\nmodels: {{m: {{policies: p.xml, labels: l.yaml}}}}\n"
    fleet += "robots:\n  a: {{model: m, country: US}}\n  b: {{model: m, country: {country}}}\n"
    scopes = {}
    for country, more in (("BR", ""), ("DE", ""), ("JP", "  c: {model: m, country: CA, gdpr: {targeted: yes}}\n")):
        (tmp_path / "f.yaml").write_text(fleet.format(country=country) + more, "utf-8")
        document = rosprivacy.analyze_fleet(str(tmp_path / "f.yaml")).document()
        scopes[country] = {f.get("gdpr") for f in document["findings"]}
    assert scopes == {"BR": {"denied"}, "DE": {None}, "JP": {None}}


def test_strange_grounds_are_problems(tmp_path: Path) -> None:
    with pytest.raises(InputErrors) as problems:
        told(tmp_path, top="gdpr: {established: perhaps, targetted: yes}")
    assert [error.line for error in problems.value.errors] == [2, 2]
    with pytest.raises(InputErrors):
        told(tmp_path, top="gdpr: no")
