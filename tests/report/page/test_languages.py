"""A report in German or French has no English but names, codes, what people wrote, and messages that are marked so."""

from __future__ import annotations

import csv
import io
import json
import os
from pathlib import Path
from typing import Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.model import REASONS
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.report.catalogs.words import Words, table
from rosprivacy.report.page.article30 import record, record_of_processors
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.notice import notice
from tests.helpers.fleet_files import policy
from tests.helpers.graphs import care_home, hospital
from tests.helpers.languages import OTHERS, english_in, users_texts
from tests.helpers.pages import earlier, page, told
from tests.helpers.paths import ROOT
from tests.helpers.reports import care, run, with_decisions, with_outside
from tests.helpers.turtlebot import COSTMAP, MEMORY, TURTLEBOT3

SYSTEM = """labels: 1
elements:
  nas: {kind: storage, country: US, retention: P30D, backups: P7D}
  disk: {kind: storage, country: CN, retention: {Voice: P1D}}
  tape: {kind: storage, country: DE, backups: true, retention: P1Y}
  cloud: {kind: external-system, country: GB, transfer: adequacy}
  lab: {kind: external-system, country: JP}
  far: {kind: external-system, country: KZ, transfer: adequacy}
  old: {kind: storage, country: DE, retention: P60D}
limits: {Video: P30D}
nodes:
  /camera: {source: [Video], subjects: [visitors]}
  /uplink: conduit
flows:
  - {from: /uplink, to: nas}
  - {from: /uplink, to: disk}
  - {from: /uplink, to: tape}
  - {from: /uplink, to: cloud}
  - {from: /uplink, to: lab}
  - {from: /uplink, to: far}
  - {from: /uplink, to: old}
"""
POLICY = policy("/camera>/image", "/uplink</image")


def reasons(folder: Path, today: str = "") -> dict[str, Any]:
    """A system with every reason why data may not be where they get to."""
    (folder / "r.policy.xml").write_text(POLICY, "utf-8")
    (folder / "r.labels.yaml").write_text(SYSTEM, "utf-8")
    files = [str(folder / "r.policy.xml")], [str(folder / "r.labels.yaml")]
    done = rosprivacy.analyze(*files, today=today) if today else rosprivacy.analyze(*files)
    return done.document()


def prose(document: dict[str, Any], language: str, **options: Any) -> str:
    """What a reader of the page reads, without names and what is marked as English."""
    whole = page(document, language, **options)
    for other in whole.xpath("//script | //style | //bdi | //span[@lang='en']"):
        other.drop_tree()
    marks = whole.xpath("//@aria-label | //@placeholder | //@title | //@data-said")
    return "\n".join((whole.text_content(), *marks))


def turtlebot(folder: Path) -> dict[str, Any]:
    (folder / "tb3.labels.yaml").write_text(COSTMAP + MEMORY, "utf-8")
    corpus = os.environ.get("ROSPRIVACY_CORPUS")
    if not corpus:
        pytest.skip("no corpus: set ROSPRIVACY_CORPUS")
    return rosprivacy.analyze([str(Path(corpus, TURTLEBOT3))], [str(folder / "tb3.labels.yaml")]).document()


@pytest.mark.parametrize("language", OTHERS)
def test_no_page_has_english(language: str, tmp_path: Path) -> None:
    for document in (
        care_home().document(),
        hospital().document(),
        reasons(tmp_path),
        with_decisions(with_outside(care())),
        *map(run, (1, 3, 5)),
    ):
        assert english_in(prose(document, language), language, users_texts(document)) == []


@pytest.mark.parametrize("language", OTHERS)
def test_no_page_of_turtlebot3_has_english(language: str, tmp_path: Path) -> None:
    document = turtlebot(tmp_path)
    assert english_in(prose(document, language), language, users_texts(document)) == []


@pytest.mark.parametrize("language", OTHERS)
def test_no_page_that_tells_changes_has_english(language: str) -> None:
    document = run(5)
    text = prose(document, language, earlier=earlier(run(3)))
    assert english_in(text, language, users_texts(document)) == []


@pytest.mark.parametrize("language", OTHERS)
def test_no_record_and_no_notice_has_english(language: str, tmp_path: Path) -> None:
    for document in (hospital().document(), reasons(tmp_path), with_decisions(with_outside(care()))):
        records = record(document, language) + record_of_processors(document, language)
        rows = csv.reader(io.StringIO(records), delimiter=";")
        text = "\n".join(cell for row in rows for cell in row)
        text += notice(document, language).replace("\\", "")
        assert english_in(text, language, [*users_texts(document), "residents", "staff", "visitors"]) == []


@pytest.mark.parametrize("language", ["en", *OTHERS])
def test_every_reason_is_told_in_the_readers_language(language: str, tmp_path: Path) -> None:
    document = reasons(tmp_path)
    text = prose(document, language)
    told = {
        "en": (
            "kept for 60 days",
            "in US, whose",
            "in CN, for which",
            "in backups 7 days more",
            "no retention is stated",
        ),
        "de": (
            "Aufbewahrungsdauer 60 Tage",
            "Land: US",
            "Land: CN",
            "7 Tage länger",
            "keine Speicherdauer angegeben für",
        ),
        "fr": ("conservées 60 jours", "pays : US", "pays : CN", "et 7 jours de plus", "durée de conservation n'est"),
    }
    plain = text.replace("\u00a0", " ").replace("\u202f", " ")
    for part in told[language]:
        assert part in plain
    assert "P60D" not in text


def test_the_key_of_a_reason_says_what_the_english_sentence_says(tmp_path: Path) -> None:
    days = ("", "2032-01-01")  # on the second one decision has ended
    findings = [finding for day in days for finding in reasons(tmp_path, day)["findings"]]
    found = {finding["because"]["key"] for finding in findings if "because" in finding}
    assert found == {
        "kept-longer", "kept-longer-in-backups", "no-retention-for", "endless-backups", "partly-adequate",
        "not-adequate", "stated-not-adequate", "stated-no-longer-adequate",
    }  # fmt: skip


@pytest.mark.parametrize("language", OTHERS)
def test_whom_a_partial_decision_covers_has_words(language: str) -> None:
    for code in countries().partly:
        assert f"adequacy.{code}" in table(language)


def test_french_spaces_keep_to_their_marks() -> None:
    document = care()
    for text in (prose(document, "fr"), markdown(told(document, "fr"))):
        assert "\u00a0:" in text
        assert "\\xa0" not in text
        assert "\\u202f" not in text
        assert text.count(":** ") == text.count("\u00a0:** ")
    assert Words("fr").number(12345) == "12\u202f345"


def test_the_published_schema_names_every_reason() -> None:
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text("utf-8"))
    assert set(schema["$defs"]["WhyEntry"]["properties"]["key"]["enum"]) == REASONS.keys()


def test_an_unknown_language_is_refused() -> None:
    with pytest.raises(InputError, match="unknown language 'xx'; one of en, de, fr"):
        care_home().to("html", language="xx")
