"""What people answered and decided, in the file for the CNIL's tool: gauges, measures, opinions; the rest is theirs."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.cnil.person_answers import SCALE, level_of
from rosprivacy.report.page.assessment import FORMAT
from tests.helpers.fleet_files import policy
from tests.helpers.graphs import hospital
from tests.helpers.office import DECISIONS, LANGUAGES, LONG, NO_PLACE, OF_ALL, OF_PATHS, answers_of, decided_office
from tests.helpers.pia_tool import GAUGE, LIST, Page, Tool, imported, seen

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result


def file_with(result: Result, answers: dict[str, str], folder: Path, language: str = "en") -> dict[str, Any]:
    saved = folder / "assessment.json"
    saved.write_text(json.dumps({"format": FORMAT, "answers": answers}), "utf-8")
    made: dict[str, Any] = json.loads(result.to("cnil-pia", language=language, assessment=str(saved)))
    return made


def contents(tool: Tool) -> dict[str, str]:
    return {measure["title"]: Page(measure["content"]).seen for measure in tool.measures.values()}


@pytest.fixture(scope="module")
def office(tmp_path_factory: pytest.TempPathFactory) -> Result:
    return decided_office(tmp_path_factory.mktemp("office"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_answer_is_in_the_file_or_named_as_having_no_place(office: Result, tmp_path: Path, language: str) -> None:
    given = answers_of(office, OF_PATHS)
    tool = imported(file_with(office, given, tmp_path, language))
    text = "\n".join([*(Page(one).seen for one in tool.shown_as_html()), *filter(None, map(str, tool.pia.values()))])
    for key, answer in given.items():
        if key not in NO_PLACE:
            assert all(line in text for line in answer.splitlines()), key
    left = "\n".join(comment["description"] for comment in tool.comments)
    assert all(key in left for key in NO_PLACE)
    assert not any(key in left for key in given if key not in NO_PLACE)
    assert "assessment.json (sha256" in seen(tool, 122)


def test_each_answer_stands_at_the_question_that_asks_for_it(office: Result, tmp_path: Path) -> None:
    tool = imported(file_with(office, answers_of(office, OF_PATHS), tmp_path))
    for number, key in ((112, "controller"), (211, "purpose"), (212, "basis"), (325, "risks"), (325, "residual")):
        assert OF_ALL[f"sign.{key}"] in seen(tool, number)
    assert OF_PATHS["likelihood"] in seen(tool, 326)
    assert OF_PATHS["whom"] in seen(tool, 325)
    assert tool.pia["dpo_opinion"] == "stop\nuntil blurred"
    assert tool.pia["concerned_people_opinion"] == OF_ALL["sign.views"]
    for what in ("dpo_status", "dpos_names", "concerned_people_status", "concerned_people_searched_opinion"):
        assert tool.pia[what] is None, what  # whether it may go on, and whether they were asked, is theirs to say
    named = contents(tool)["Measures that people named in the fields of a report"]
    assert "staff is trained" in named
    assert "a cover" in named


@pytest.mark.parametrize(
    ("severity", "level"),
    [
        (["Important"], 3), (["limited: few faces"], 2), (["4"], 4), (["Négligeable, car local"], 1),
        (["groß; Gesichter"], 4), (["high"], 0), (["quite limited"], 0), (["1. faces, 2. voices"], 0), (["5"], 0),
        (["not important"], 0), (["maximum?"], 0), (["important", "limited"], 0), (["important", ""], 0), ([], 0),
    ],
)  # fmt: skip
def test_a_gauge_shows_the_level_that_people_wrote_for_every_path_and_no_other(
    office: Result, tmp_path: Path, severity: list[str], level: int
) -> None:
    """A risk level is a person's: no other word is taken for one, and no path's level for that of another."""
    ids = [finding.id for finding in office.analysis.findings if not finding.dismissed]
    texts = [severity[min(n, len(severity) - 1)] if severity else "" for n in range(len(ids))]
    answers = {f"risk.{one}.severity": text for one, text in zip(ids, texts, strict=True)}
    tool = imported(file_with(office, answers, tmp_path))
    if any(texts):
        assert tool.answers[325]["gauge"] == level
    else:
        assert 325 not in tool.answers
    assert 326 not in tool.answers
    assert not {335, 336, 345, 346} & tool.answers.keys()


def test_of_a_fleet_an_answer_about_a_pattern_is_about_its_path(tmp_path: Path) -> None:
    document = hospital().document()
    patterns = {one["finding"]: one["id"] for one in document["fleet"]["patterns"]}
    found = [one["id"] for one in document["findings"] if not one["dismissed"]]
    answers = {f"risk.{patterns[one]}.likelihood": "negligible" for one in found}
    tool = imported(file_with(hospital(), answers, tmp_path))
    assert tool.answers[326]["gauge"] == 1
    # A disclosure that is a transfer too is one path: it is answered once.
    same = [one for one in document["findings"] if one["leak"]["name"] == "fleet cloud"]
    assert len(same) == 2
    del answers[f"risk.{patterns[same[0]['id']]}.likelihood"]
    assert imported(file_with(hospital(), answers, tmp_path)).answers[326]["gauge"] == 1


def test_a_level_is_known_in_each_language_of_the_tool_and_by_its_number() -> None:
    for level, names in SCALE.items():
        assert {level_of(text) for name in names for text in (name, name.capitalize(), f"{name}: x", str(level))} == {
            level
        }


def test_what_is_decided_and_still_to_be_done_is_a_planned_measure(office: Result, tmp_path: Path) -> None:
    tool = imported(file_with(office, {}, tmp_path))
    plan = contents(tool)["Measures that are decided and still to be done"]
    for entry in DECISIONS[:2]:
        told = [value for key, value in entry.items() if key in ("reason", "owner", "ticket", "condition")]
        assert all(str(one) in plan for one in told)
    assert Words("en").date("2099-05-06") in plan
    assert "Ada Judge" not in plan  # an acceptance leaves nothing to do
    ids = [f.id for f in office.analysis.findings if (f.category, f.leak.name) == ("Video", "cabin")]
    assert all(one in plan for one in ids)
    assert tool.evaluations == []  # the tool would take one as handed to the evaluator


def test_without_decisions_and_answers_nothing_is_planned_and_no_field_of_people_is_filled() -> None:
    tool = imported(json.loads(hospital().to("cnil-pia")))
    assert not any(title.startswith("Measures that") for title in contents(tool))
    assert not set(GAUGE) & tool.answers.keys()
    assert set(LIST) & tool.answers.keys() == {322, 324}
    assert tool.pia["dpo_opinion"] is None


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_left_to_people_is_said_beside_the_question(language: str) -> None:
    tool = imported(json.loads(hospital().to("cnil-pia", language=language)))
    said = {comment["reference_to"]: comment["description"] for comment in tool.comments}
    assert sorted(said) == [111, 321, 331, 341]
    assert not set(said) & tool.answers.keys()
    assert len(set(said.values())) == 3


# ---------------------------------------------------------------- sentences that must not come back


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_sentence_of_the_file_is_cut(office: Result, tmp_path: Path, language: str) -> None:
    """Of a threat, an acceptance and a plan the legal words at their end are what matters."""
    words = Words(language)
    tool = imported(file_with(office, answers_of(office, {"measures": LONG}), tmp_path, language))
    texts = [*(Page(one).seen for one in tool.shown_as_html()), *(one["description"] for one in tool.comments)]
    assert not [text for text in texts if "…" in text or "[...]" in text]
    threats = "\n".join(tool.answers[322]["list"])
    until = plain(words("cnil.until", date=words.date("2099-01-02")))
    for end in (LONG, "Ada Judge", words.basis("6(1)(a)"), words.basis("49(1)(a)"), until):
        assert plain(end).replace("'", "’") in threats


def test_the_verdict_is_told_with_all_its_doubts(tmp_path: Path) -> None:
    disks = [f"disk_{n}_{'x' * 70}" for n in range(3)]
    elements = ", ".join(f"{disk}: {{kind: storage, country: DE, retention: P3D}}" for disk in disks)
    flows = ", ".join(f"{{from: /teleop, to: {disk}}}" for disk in disks)
    (tmp_path / "p.xml").write_text(policy("camera>/image", "teleop</image"), "utf-8")
    nodes = "{/camera: {source: [Video]}, /teleop: conduit}"
    text = f"labels: 1\nnodes: {nodes}\nelements: {{{elements}}}\nflows: [{flows}]\n"
    (tmp_path / "l.yaml").write_text(text, "utf-8")
    result = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml")
    tool = imported(json.loads(result.to("cnil-pia")))
    sentence = str(result.to("text", quiet=True)).splitlines()[0]
    assert len(sentence) > 300
    assert all(sentence in seen(tool, number) for number in (121, 122, 123, 213, 215, 227))


def test_people_and_program_answer_for_what_is_theirs(office: Result, tmp_path: Path) -> None:
    tool = imported(file_with(office, answers_of(office, OF_PATHS), tmp_path))
    for number in (325, 326):
        assert "Filled in by rosprivacy" not in seen(tool, number)
        assert "assessment.json (sha256" in seen(tool, number)
    assert "Filled in by rosprivacy" in seen(tool, 112)
    assert "assessment.json (sha256" in seen(tool, 112)
    assert "assessment.json" not in seen(tool, 227)


@pytest.mark.parametrize(("language", "stated"), [("en", "stated"), ("de", "angegeben"), ("fr", "indiqué")])
def test_of_a_place_in_the_eea_no_transfer_is_stated_not_that_there_is_none(language: str, stated: str) -> None:
    """From a country nobody knows who reads there, and from where."""
    tool = imported(json.loads(hospital().to("cnil-pia", language=language)))
    rows = [row for row in tool.answers[227]["text"].split("<li>") if "IE" in row or "DE" in row]
    assert len(rows) == 3
    assert all(plain(Page(row.split("</li>")[0]).seen).endswith((stated, f"n'est {stated}")) for row in rows)


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_persons_of_face_templates_are_those_of_the_record(language: str) -> None:
    """Only the guides make them, whose camera sees visitors: not 'to be completed', and no patient."""
    tool = imported(json.loads(hospital().to("cnil-pia", language=language)))
    part = tool.answers[121]["text"].split("(FaceTemplate)")[1].split("</ul>")[0]
    assert f"{Words(language)('cnil.persons')}" in part
    assert "visitors" in part
    assert "patients" not in part
    record = [row for row in hospital().document()["register"] if row["category"] == "FaceTemplate"]
    assert {person for row in record for person in row["subjects"]} == {"visitors"}
