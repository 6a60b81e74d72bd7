"""The record of processing (Article 30 GDPR)."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report.page import article30
from rosprivacy.report.page.words import Words
from rosprivacy.report.spreadsheet import FORMULA
from tests.helpers.reports import care, hostile, run, with_outside

if TYPE_CHECKING:
    from pathlib import Path
from tests.helpers.pages import LANGUAGES


def record(document: dict[str, Any], language: str = "en") -> list[dict[str, str]]:
    text = article30.record(document, language)
    assert text.startswith("\ufeff")
    rows = csv.DictReader(io.StringIO(text.removeprefix("\ufeff")), delimiter=article30.SEPARATORS[language])
    short = {Words(language)(f"r.{field}"): field for field in article30.Entry.__dataclass_fields__}
    return [{short[column]: cell for column, cell in row.items()} for row in rows]


def test_one_row_for_each_kind_and_recipient() -> None:
    assert [(row["category"], row["recipient"], row["form"]) for row in record(care())] == [
        ("face template", "/uplink", "as it is"),
        ("location", "no recipient found under the labels given", ""),
        ("person track", "no recipient found under the labels given", ""),
        ("video of persons", "/recorder", "pseudonymised"),
        ("voice", "/uplink", "as it is"),
    ]


def test_what_only_a_person_can_know_is_empty_and_marked() -> None:
    for row in record(care()):
        assert row["controller"] == row["purpose"] == ""
        assert row["complete"].startswith("30(1)(a), 30(1)(b)")
        assert ("30(1)(c)" in row["complete"]) == (row["subjects"] == "")


def test_storages_and_recipients_fill_their_fields() -> None:
    rows = {(row["category"], row["recipient"]): row for row in record(with_outside(care()))}
    speech = rows["voice", "speech service"]
    assert speech["role"] == "processor"
    assert speech["transfer"].startswith("US, adequacy decision for some recipients, standard contractual clauses")
    assert rows["video of persons", "archive"]["retention"] == "archive: video of persons: 30 days; everything: 1 year"
    assert "archive: not encrypted at rest" in rows["video of persons", "archive"]["measures"]


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
