"""Records, notice, works council's page, CNIL file and linked data say what the register says, cell by cell.

First on random systems, then on systems of which people state a lot.

What the register itself may say is held against all paths in ``tests/analysis/findings/test_register.py``.
"""

from __future__ import annotations

import csv
import html
import io
import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings

import rosprivacy
from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.documents import document_of
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.cnil.pia import METHODS, cnil_pia
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.page import article30, look_at, notice, persons
from rosprivacy.report.page.index import Index
from rosprivacy.report.rdf.findings import rdf_graph
from tests.helpers.answers import answer_of
from tests.helpers.concerned import VOCABULARY, Case, cases
from tests.helpers.linked_rows import comparable, rows_told
from tests.helpers.office import LABELS, POLICY
from tests.helpers.paths import ROOT
from tests.helpers.systems import analysed

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from rosprivacy.report.document.contents import Document
    from rosprivacy.result import Result

WORDS = Words("en")
OPEN = WORDS("record.open")
REST: dict[str, Any] = {"rosprivacy": "1", "policies": [], "labels": [], "standard_channels": None}
CLEANS = re.compile(r"(/?[\w/]+) \(([^)]+)\): ")
RECORD_HEADS = {name: f"record.{name}" for name in article30.RecordEntry.__dataclass_fields__}
NOTICED = {
    "persons": (Cell.SUBJECTS,),
    "purpose": (Cell.PURPOSES,),
    "basis": (Cell.BASES, Cell.SPECIAL_BASES, Cell.CRIMINAL_BASES),
    "recipient": (Cell.OPERATOR, Cell.RECIPIENT),
    "where": (Cell.COUNTRY, Cell.SAFEGUARDS),
    "retention": (Cell.RETENTION,),
}
COMPLETED = {
    "controller": (Cell.CONTROLLERS,),
    "purpose": (Cell.PURPOSES,),
    "subjects": (Cell.SUBJECTS,),
    "recipient": (Cell.OPERATOR, Cell.RECIPIENT),
    "country": (Cell.COUNTRY,),
    "transfer": (Cell.SAFEGUARDS,),
    "basis": (Cell.BASES, Cell.SPECIAL_BASES, Cell.CRIMINAL_BASES),
    "retention": (Cell.RETENTION,),
}
LETTERS = {"a": Cell.CONTROLLERS, "b": Cell.PURPOSES, "c": Cell.SUBJECTS, "e": Cell.SAFEGUARDS, "f": Cell.RETENTION}


@given(cases())
@settings(deadline=None)
def test_each_view_of_a_random_system_agrees_with_the_register(case: Case) -> None:
    analysis = analysed(case.system)
    if analysis is not None:
        check_views(document_of(answer_of(analysis, VOCABULARY, REST, bound=case.bound())))


def office(folder: Path) -> Result:
    (folder / "p.xml").write_text(POLICY, "utf-8")
    (folder / "l.yaml").write_text(LABELS, "utf-8")
    return rosprivacy.analyze(folder / "p.xml", folder / "l.yaml")


def test_each_view_of_a_system_with_many_statements_agrees_with_the_register(tmp_path: Path) -> None:
    document = document_of(office(tmp_path))
    assert {row.recipient for row in document.register or ()} >= {"processor", "third-party"}
    check_views(document)


@pytest.mark.parametrize(("policies", "labels"), [
    ("care-home/care-home.policy.xml", "care-home/care-home.labels.yaml"),
    ("factory/before.policy.xml", "factory/run3.labels.yaml"),
])  # fmt: skip
def test_each_view_of_a_shipped_system_agrees_with_the_register(policies: str, labels: str) -> None:
    document = document_of(rosprivacy.analyze(ROOT / "examples" / policies, ROOT / "examples" / labels))
    check_views(document)


def check_views(facts: Document) -> None:
    document = json_document(facts)
    rows = document["register"]
    for row, cells in zip(rows, csv_rows(article30.record(document, "en"), RECORD_HEADS), strict=True):
        check(row, cells)
    check_processors(document)
    check_notice(document)
    check_rights(document)
    check_law(document)
    assert rows_told(rdf_graph(facts)) == {row["id"]: comparable(row) for row in rows}
    file = cnil_pia(facts, "2026-01-01")
    check_kinds(document, file)
    check_places(document, file)


def csv_rows(text: str, heads: Mapping[str, str]) -> list[dict[str, str]]:
    """The rows by field; the last one tells the verdict and is left out."""
    columns = {WORDS(key): field for field, key in heads.items()}
    *rows, _ = csv.DictReader(io.StringIO(text.removeprefix("\ufeff")))
    return [{columns[column]: cell for column, cell in row.items()} for row in rows]


def check(row: Mapping[str, Any], cells: Mapping[str, str]) -> None:
    assert cells["category"] == title(row["category"])
    assert [place["name"] for place in row["places"]] == [cells["exit"]] or not row["places"]
    assert {*cells["subjects"].split("; ")} - {OPEN, ""} == set(row["subjects"])
    for column, fields in COMPLETED.items():
        assert (OPEN in cells[column]) == any(field in row["to_complete"] for field in fields), column
    for letter, field in LETTERS.items():
        assert (f"30(1)({letter})" in cells["complete"]) == (field in row["to_complete"]), letter
    for duration in row["retention"]:
        assert WORDS.duration(duration) in cells["retention"]
    assert bool(row["retention"] and row["places"]) == (cells["exit"] in cells["retention"])
    assert set(CLEANS.findall(cells["measures"])) == cleaned(row)
    assert cells["measures"].count(WORDS("record.measure.past", measure="")) == past(row)
    assert [one for one in cells["findings"].split(", ") if one] == row["findings"]


def check_processors(document: Mapping[str, Any]) -> None:
    told = csv_rows(article30.record_of_processors(document, "en"), article30.PROCESSOR_HEADS)
    rows = [row for row in document["register"] if row["recipient"] == "processor"]
    if not rows:
        assert [cells["note"] for cells in told] == [WORDS("processors.none")]
        return
    for row, cells in zip(rows, told, strict=True):
        assert cells["category"] == title(row["category"])
        assert [place["name"] for place in row["places"]] == [cells["exit"]]
        for column, field, cell in (("processor", "operator", Cell.OPERATOR), ("contract", "contract", Cell.CONTRACT)):
            assert cells[column] == (row[field] or OPEN)
            assert (OPEN in cells[column]) == (cell in row["to_complete"])
        assert (OPEN in cells["transfer"]) == (Cell.SAFEGUARDS in row["to_complete"])
        assert ("30(2)(c)" in cells["complete"]) == (Cell.SAFEGUARDS in row["to_complete"])
        assert ("30(2)(b)" in cells["complete"]) == (Cell.PURPOSES in row["to_complete"])
        assert set(row["purposes"]) <= {*cells["activity"].split("; ")}


def check_notice(document: Mapping[str, Any]) -> None:
    text = notice.notice(document, "en")
    told = [line.strip("| ").split(" | ") for line in text.split("\n") if line.startswith("| ") and "---" not in line]
    columns = notice.NoticeRow._fields
    cells = [dict(zip(columns, line, strict=True)) for line in told if line[0] != WORDS("notice.place")]
    for row, cell in zip(document["register"], cells, strict=True):
        assert all(place["name"].replace("_", "\\_") in cell["place"] for place in row["places"])
        assert (WORDS("record.hidden") in cell["place"]) == row["pseudonymised"]
        for column, field in (("persons", "subjects"), ("purpose", "purposes")):
            assert [one for one in cell[column].split("; ") if one != OPEN] == [*row[field]]
        for column, fields in NOTICED.items():
            if row["places"] or column not in ("recipient", "where"):
                assert (OPEN in cell[column]) == any(field in row["to_complete"] for field in fields), column
        assert all(WORDS.duration(duration) in cell["retention"] for duration in row["retention"])
        assert row["operator"] in cell["recipient"]


def check_rights(document: Mapping[str, Any]) -> None:
    """What the works council's page has a row for, see ``tests/report/page/test_works_council.py``."""
    index = Index(document, WORDS)
    told = {
        (group.name, data, place.name): place
        for group in persons.rights(index)
        for place in group.places
        for data in place.data.split(", ")
    }
    here = [row for row in document["register"] if row["places"]]
    assert told.keys() == {key for row in here for key in keys(row)}
    for row in here:
        for place in map(told.__getitem__, keys(row)):
            assert all(WORDS.duration(duration) in place.retention for duration in row["retention"])
            assert (place.retention == WORDS("rights.unknown")) == (not row["retention"])
            assert row["operator"] in place.recipient
            assert not unbased(row) or WORDS("transfer.none") in place.recipient
            measures = "; ".join(place.measures)
            assert set(CLEANS.findall(measures)) == cleaned(row)
            assert measures.count(WORDS("record.measure.past", measure="")) == past(row)


def check_law(document: Mapping[str, Any]) -> None:
    """What the works council's page points at is of the rows, and of the countries of their sources."""
    index, rows = Index(document, WORDS), document["register"]
    called = {name for row in rows for name in row["look_at"]}
    told = {law.name for law in look_at.at_work(index)}
    assert told <= called
    assert told >= {name for name in called if name.startswith(look_at.ABOUT_WORK)}
    countries = sorted({country for row in rows for country in row["countries"]})
    for country, sentence in zip(countries, look_at.national(index), strict=bool(countries)):
        assert country in sentence


def keys(row: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Each group of a row, the kind of data and the place, as the page names them."""
    unnamed = [WORDS("subject.unknown")] if Cell.SUBJECTS in row["to_complete"] else []
    data = title(row["category"])
    data = WORDS("entry.data", data=data) if row["pseudonymised"] else data
    return [(group, data, row["places"][0]["name"]) for group in (*row["subjects"], *unnamed)]


def unbased(row: Mapping[str, Any]) -> bool:
    return row["transfer"] == "none" and row["area"] not in ("eea", "adequate")


def title(category: str) -> str:
    return VOCABULARY.categories[category].title


def cleaned(row: Mapping[str, Any]) -> set[tuple[str, str]]:
    return {(one["element"]["name"], title(one["category"])) for one in row["measures"]}


def past(row: Mapping[str, Any]) -> int:
    return sum(not one["everywhere"] for one in row["measures"])


def check_kinds(document: Mapping[str, Any], file: Mapping[str, Any]) -> None:
    """What the CNIL file says of persons and measures."""
    answers = {one["reference_to"]: one["data"]["text"] for one in file["answers"]}
    for part in re.split(r"<p><strong>", answers[121])[1:]:
        name = html.unescape(re.search(r"\((\w+)\)", part)[1])  # type: ignore[index]
        groups = {group for row in document["register"] if row["category"] == name for group in row["subjects"]}
        told = re.findall(rf"{WORDS('cnil.persons')}: ([^<(]*)", part)
        assert {one.strip() for line in told for one in line.split(",") if one} == groups
    measures = {(one["element"]["name"], one["category"]) for row in document["register"] for one in row["measures"]}
    titles = {WORDS(f"cnil.title.{method}") for method in METHODS}
    content = "".join(one["content"] for one in file["measures"] if one["title"] in titles)
    assert set(re.findall(r"<li>(/?n?[\w/]+): (\w+)", content)) == measures


def check_places(document: Mapping[str, Any], file: Mapping[str, Any]) -> None:
    """What the CNIL file says of places, retention, processors, transfers and encryption."""
    answers = {one["reference_to"]: one["data"]["text"] or one["data"]["list"] for one in file["answers"]}
    for row in document["register"]:
        for place in (place["name"] for place in row["places"]):
            (transfer,) = lines(answers[227], place)
            assert (WORDS("cnil.inside") in transfer) == (row["area"] == "eea")
            assert not unbased(row) or WORDS("transfer.none") in transfer
            assert row["country"] in transfer
            if row["places"][0]["kind"] == "storage":
                kept = next(line for line in lines(answers[215], place) if row["category"] in line)
                assert all(WORDS.duration(duration) in kept for duration in row["retention"])
                assert kept.endswith(f": {WORDS('not.stated')}") == (not row["retention"])
            assert bool(lines(answers.get(226, ""), place)) == (row["recipient"] == "processor")
            unprotected = WORDS("cnil.threat.unencrypted", element=f"storage {place}")
            assert (unprotected in answers.get(322, ())) == (row["encrypted"] is False)
            encrypted = [one for one in file["measures"] if one["title"] == WORDS("cnil.title.encrypted")]
            assert any(lines(one["content"], place) for one in encrypted) == (row["encrypted"] is True)


def lines(text: str, place: str) -> list[str]:
    """The lines of a list of a place."""
    found = re.findall(r"<li>(.*?)</li>", text)
    return [line for line in found if re.match(rf"(\S+ )?{re.escape(place)}: ", line)]
