"""The document along the EDPB's template has each question once, says what the register says, and hides nothing."""

from __future__ import annotations

import csv
import io
from io import BytesIO
from typing import TYPE_CHECKING, Any

import docx
import pytest
from docx.table import Table
from hypothesis import given, settings

import rosprivacy
from rosprivacy.documents import document_of
from rosprivacy.report.catalogs import LANGUAGES
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.page.article30 import RecordEntry, record
from rosprivacy.report.page.assessment import CRITERIA, GENERAL, RISK, Answers
from rosprivacy.report.page.edpb_dpia import OWN_COLUMNS, edpb_dpia
from rosprivacy.report.page.edpb_questions import QUESTIONS, SECTIONS, Fact, Origin, Question
from rosprivacy.report.page.word_document import word_document
from tests.helpers.answers import answer_of
from tests.helpers.concerned import VOCABULARY, Case, cases
from tests.helpers.graphs import care_home, hospital
from tests.helpers.reports import HOSTILE, care, decide, hostile, with_decisions
from tests.helpers.systems import analysed
from tests.helpers.word import text_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

REST: dict[str, Any] = {"rosprivacy": "1", "policies": [], "labels": [], "standard_channels": None}
EN = Words("en")
OPEN = EN("record.open")
Rows = list[list[str]]


def written(document: Any, language: str = "en", **options: Any) -> dict[str, tuple[list[str], Rows]]:
    """Heading of each question -> its paragraphs, and the rows of its table."""
    package = word_document(edpb_dpia(document, language, **options), "A", language, "2026-01-01")
    answers: dict[str, tuple[list[str], Rows]] = {}
    heading = ""
    for block in docx.Document(BytesIO(package)).iter_inner_content():
        if isinstance(block, Table):
            answers[heading][1].extend([cell.text for cell in row.cells] for row in block.rows)
        elif block.style and (block.style.name or "").startswith("Heading"):
            heading = block.text
            assert heading not in answers, "each stands once"
            answers[heading] = [], []
        elif block.text:
            answers[heading][0].append(block.text)
    return answers


def heading_of(question: Question, language: str = "en") -> str:
    return plain(f"{question.number} {Words(language)(question.words)}")


def table_of(words: str, answers: dict[str, tuple[list[str], Rows]]) -> Rows:
    (question,) = (one for one in QUESTIONS if one.words == words)
    return answers[heading_of(question)][1]


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_question_is_there_once_in_its_section(language: str) -> None:
    for document in (care(), dict(hospital().document())):
        headings = list(written(document, language))
        assert [one for one in headings if one[:1].isdigit() and not one[1:].startswith(". ")] == [
            heading_of(question, language) for question in QUESTIONS
        ]
        sections = [plain(Words(language)(words)) for words in SECTIONS]
        for number, section in enumerate(sections):
            after = headings[headings.index(section) + 1]
            assert after.startswith(str(number))


def test_the_table_of_questions_names_what_there_is() -> None:
    known = {*RecordEntry.__dataclass_fields__, *OWN_COLUMNS}
    for question in QUESTIONS:
        assert set(question.columns) <= known
        assert bool(question.columns) == (question.origin is Origin.REGISTER)
        assert bool(question.fact) == (question.origin is Origin.ANALYSIS)
    numbers = [question.number for question in QUESTIONS if question.number != "2.3"]  # that is about all of 2.3.a to e
    assert numbers == sorted(numbers)
    assert {question.fact for question in QUESTIONS if question.fact} == set(Fact)


def test_every_field_that_people_fill_in_has_its_question() -> None:
    answers = [question.answer for question in QUESTIONS if question.answer]
    assert sorted(answers) == sorted(f"sign.{field}" for field in GENERAL)
    assert sorted(field for question in QUESTIONS for field in question.risks) == sorted(RISK)
    assert CRITERIA == 9  # the rows of the question about the criteria


@given(cases())
@settings(deadline=None)
def test_each_column_of_a_question_has_the_cells_of_the_record(case: Case) -> None:
    """Row by row: the table of each question that names a column of the record of Article 30 has its cells."""
    analysis = analysed(case.system)
    if analysis is None:
        return
    document = json_document(document_of(answer_of(analysis, VOCABULARY, REST, bound=case.bound())))
    *entries, _ = csv.DictReader(io.StringIO(record(document, "en").removeprefix("\ufeff")))
    answers = written(document)
    for question in QUESTIONS:
        paragraphs, rows = answers[heading_of(question)]
        assert all(all(row) for row in rows), "no cell is empty"
        if not question.columns:
            continue
        by_number = {number: row[1:] for row in rows[1:] for number in row[0].split(", ")}
        if not question.special:
            assert sorted(map(int, by_number)) == list(range(1, len(entries) + 1))
        for number, cells in by_number.items():
            entry = entries[int(number) - 1]
            for column, cell in zip(question.columns, cells, strict=True):
                if column not in OWN_COLUMNS:
                    assert cell == " ".join(entry[EN(f"record.{column}")].split()) or (
                        not entry[EN(f"record.{column}")] and cell == EN("edpb.none.cell")
                    )
        assert rows or EN("edpb.none.rows") in paragraphs


@given(cases())
@settings(deadline=None)
def test_each_finding_that_stands_is_a_threat_with_the_measures_of_its_row(case: Case) -> None:
    analysis = analysed(case.system)
    if analysis is None:
        return
    document = json_document(document_of(answer_of(analysis, VOCABULARY, REST, bound=case.bound())))
    *entries, _ = csv.DictReader(io.StringIO(record(document, "en").removeprefix("\ufeff")))
    threats = table_of("edpb.threats", written(document))[1:]
    standing = [finding for finding in document["findings"] if not finding["dismissed"]]
    assert bool(threats) == bool(standing)
    for finding in standing:
        row = next(str(n) for n, one in enumerate(document["register"], 1) if finding["id"] in one["findings"])
        measures = entries[int(row) - 1][EN("record.measures")]
        ends = f"{finding['source']['name']} → {finding['leak']['name']}"
        assert [one for one in threats if ends in one[1] and row in one[4].split(", ") and measures in one[5]]


def test_what_nobody_says_is_left_to_people() -> None:
    answers = written(care())
    for question in QUESTIONS:
        paragraphs, _ = answers[heading_of(question)]
        assert paragraphs[0] == EN(f"edpb.origin.{question.origin}")
        assert (OPEN in paragraphs) == (
            question.origin is Origin.PEOPLE or question.fact in (Fact.PLAN, Fact.CONDITIONS)
        )


def test_answers_of_people_stand_at_their_question_and_what_matches_none_is_told() -> None:
    document = care()
    finding = document["findings"][0]["id"]
    given_answers = {f"sign.{field}": f"said of {field}" for field in GENERAL}
    given_answers |= {f"risk.{finding}.{field}": f"risk of {field}" for field in RISK}
    given_answers |= {"criterion.5": "3000 persons", "risk.0123456789abcdef.severity": "was low"}
    answers = written(document, answers=Answers(given_answers))
    for question in QUESTIONS:
        paragraphs, rows = answers[heading_of(question)]
        if question.answer:
            text = EN("edpb.said", text=f"said of {question.answer.removeprefix('sign.')}")
            assert text in paragraphs
            assert OPEN not in paragraphs
        for place, field in enumerate(question.risks, 1):
            assert f"risk of {field}" in [row[place] for row in rows]
    assert "3000 persons" in table_of("edpb.reasons.criteria", answers)[5]
    assert "was low" in " ".join(answers[EN("sign.unmatched")][0])


def test_decisions_stand_at_the_row_that_they_are_about() -> None:
    document = with_decisions(care())
    rows = table_of("edpb.decisions", written(document))[1:]
    assert len(rows) == len(document["register"])
    decided = {finding["id"]: finding["decision"] for finding in document["findings"] if finding.get("decision")}
    assert decided
    for row, entry in zip(rows, document["register"], strict=True):
        for finding in set(entry["findings"]) & decided.keys():
            assert EN(f"decision.{decided[finding]['choice']}") in row[4]
            assert decided[finding]["reason"] in row[4]


def test_a_condition_of_a_decision_stands_at_its_row() -> None:
    document = care()
    decide(document, 0, choice="accept-on-condition", condition="a sign at the door", reason="wanted", owner="board")
    answers = written(document)
    ((number, condition, state),) = table_of("edpb.conditions", answers)[1:]
    assert document["findings"][0]["id"] in document["register"][int(number) - 1]["findings"]
    assert (condition, state) == ("a sign at the door", EN("state.open"))
    assert "board" in table_of("edpb.plan", answers)[1][2]


def test_no_name_becomes_a_heading_or_a_link(tmp_path: Path) -> None:
    package = word_document(edpb_dpia(hostile(tmp_path), "en", title=HOSTILE[0]), "A", "en", "2026-01-01")
    read = docx.Document(BytesIO(package))
    headings = [one.text for one in read.paragraphs if one.style and (one.style.name or "").startswith("Heading")]
    assert len(headings) == 1 + len(SECTIONS) + len(QUESTIONS)
    assert not [relation for relation in read.part.rels.values() if relation.is_external]


def test_the_command_writes_the_same_bytes_twice_and_names_are_replaced_where_that_is_asked(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    care_files = ("examples/care-home/care-home.policy.xml", "-l", "examples/care-home/care-home.labels.yaml")
    for output in ("a.docx", "b.docx"):
        assert cli("report", *care_files, "-f", "edpb-dpia", "-o", tmp_path / output).returncode == 0
    first = (tmp_path / "a.docx").read_bytes()
    assert first == (tmp_path / "b.docx").read_bytes() == care_home().to("edpb-dpia")
    assert "/face_recognizer" in text_of(first)
    assert cli("report", *care_files, "-f", "edpb-dpia", "--redact", "-o", tmp_path / "c.docx").returncode == 0
    hidden = text_of((tmp_path / "c.docx").read_bytes())
    assert "/face_recognizer" not in hidden
    assert EN("redacted") in hidden


def test_without_a_label_it_says_that_nothing_is_known() -> None:
    result = rosprivacy.analyze("examples/care-home/care-home.policy.xml")
    answers = written(result.document())
    for question in QUESTIONS:
        if question.origin is Origin.REGISTER:
            assert EN("edpb.none.rows") in answers[heading_of(question)][0]
    assert EN("edpb.none.threats") in answers[heading_of(next(q for q in QUESTIONS if q.fact is Fact.THREATS))][0]
