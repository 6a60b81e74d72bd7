"""The record of processing (Article 30 GDPR)."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.page import article30
from rosprivacy.report.spreadsheet import FORMULA
from tests.helpers.reports import care, hostile, run, with_outside

if TYPE_CHECKING:
    from pathlib import Path
from tests.helpers.pages import LANGUAGES


def record(document: dict[str, Any], language: str = "en") -> list[dict[str, str]]:
    text = article30.record(document, language)
    assert text.startswith("\ufeff")
    rows = csv.DictReader(io.StringIO(text.removeprefix("\ufeff")), delimiter=article30.SEPARATORS[language])
    short = {Words(language)(f"record.{field}"): field for field in article30.RecordEntry.__dataclass_fields__}
    *found, answer = ({short[column]: cell for column, cell in row.items()} for row in rows)
    assert answer["note"].startswith(document["verdict"])  # the answer that the record rests on stands last
    return found


def test_one_row_for_each_kind_and_recipient() -> None:
    assert [(row["category"], row["exit"], row["form"]) for row in record(care())] == [
        ("face template", "/uplink", "as it is"),
        ("location", "no exit found under the labels given", ""),
        ("person track", "no exit found under the labels given", ""),
        ("video of persons", "/recorder", "pseudonymised"),
        ("voice", "/uplink", "as it is"),
    ]


def test_what_nobody_stated_is_to_be_completed_and_marked() -> None:
    for row in record(care()):
        assert row["controller"] == row["purpose"] == row["activity"] == "to be completed"
        assert row["basis"].startswith("6(1): to be completed")
        assert row["complete"].startswith("30(1)(a), 30(1)(b)")
        assert ("30(1)(c)" in row["complete"]) == ("to be completed" in row["subjects"])
        assert ("30(1)(f)" in row["complete"]) == ("to be completed" in row["retention"])


def test_a_node_is_no_recipient() -> None:
    """Article 4(9): who receives the data is a person or a body, to be named by a person."""
    for row in record(care()):
        to_name = not row["exit"].startswith("no exit")
        assert row["recipient"] == ("to be completed" if to_name else "")
        assert ("30(1)(d)" in row["complete"]) == to_name


def test_storages_and_recipients_fill_their_fields() -> None:
    rows = {(row["category"], row["exit"]): row for row in record(with_outside(care()))}
    speech = rows["voice", "speech service"]
    assert speech["recipient"].endswith("processor")
    assert speech["country"] == "US (adequacy decision for some recipients)"
    assert speech["transfer"] == "US: standard contractual clauses (Article 46(2)(c) or (d))"
    assert rows["video of persons", "archive"]["retention"].startswith("archive: 30 days, in backups")


def abroad(area: str, **facts: Any) -> dict[str, str]:
    """The row of a recipient of voice of which something is stated."""
    document = with_outside(care())
    (row,) = rows_at("speech service", document)
    row |= {"country": "DE" if area == "eea" else "US", "area": area, "transfer": "", **facts}
    return next(row for row in record(document) if row["exit"] == "speech service")


def rows_at(name: str, document: dict[str, Any]) -> list[dict[str, Any]]:
    return [row for row in document["register"] if [place["name"] for place in row["places"]] == [name]]


@pytest.mark.parametrize(
    ("area", "basis", "transfer"),
    [
        ("eea", "", ""),
        ("partly", "", "US: no basis is stated (the adequacy decision covers some recipients only)"),
        ("third", "", "US: no basis is stated (no adequacy decision is known)"),
        ("adequate", "", "US: adequacy decision (Article 45)"),
        ("third", "derogation", "US: derogation (Article 49)"),
    ],
)
def test_a_safeguard_is_named_only_where_one_is_stated(area: str, basis: str, transfer: str) -> None:
    """Article 30(1)(e) is about third countries, and about the documentation of safeguards that there are."""
    row = abroad(area, transfer=basis)
    assert row["transfer"] == transfer
    assert "30(1)(e)" not in row["complete"]
    row = abroad(area, transfer=basis, to_complete=["safeguards"])
    assert row["transfer"].endswith("to be completed")
    assert "30(1)(e)" in row["complete"]


def test_a_lack_is_no_measure() -> None:
    for row in record(with_outside(care())):
        assert "not encrypted" not in row["measures"]
        assert "whether it is enforced: to be completed" in row["measures"]
        assert ("archive: not encrypted" in row["note"]) == (row["exit"] == "archive")


def test_backups_are_part_of_the_time_limit() -> None:
    document = with_outside(care())
    for row in rows_at("archive", document):
        row["backups"] = "P7D"
    rows = {(row["category"], row["exit"]): row["retention"] for row in record(document)}
    assert rows["video of persons", "archive"] == "archive: 30 days, in backups 7 days more"


def test_of_a_basis_that_is_missing_the_article_is_named() -> None:
    document = care()
    row = document["register"][0]
    row |= {"bases": ["6(1)(c)"], "to_complete": ["special_bases"]}
    assert record(document)[0]["basis"] == "6(1)(c); 9(2): to be completed"


def test_recipients_that_nobody_reviewed_may_be_missing_and_the_row_says_so() -> None:
    (row, *_) = record(run(2))
    assert "there may be more recipients" in row["note"]


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_cell_is_a_formula(tmp_path: Path, language: str) -> None:
    document = hostile(tmp_path)
    for finding, begin in zip(document["findings"], ("=", "+", "-", "@", "\t=", " =", "＝"), strict=False):
        finding["leak"]["name"] = f"{begin}cmd|' /C calc'!A0"
    document["categories"][0]["title"] = "=1+1"
    document["categories"][0]["translations"] = {}
    rows = record(document, language)
    assert rows[0]["category"] == "'=1+1"
    assert len(rows) == len(document["findings"]) + 1  # and the storage
    for row in rows:
        assert not [cell for cell in row.values() if cell.lstrip().startswith(FORMULA)]
