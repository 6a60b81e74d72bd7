"""What documents say of transfers, contracts and cleaning: a patrol robot in Germany, its data in five countries.

Emotion estimates and a watch list are no finding there: they rest in a storage for which everything is stated.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.report.catalogs.words import Words, plain, table
from rosprivacy.report.page.outline import outline
from tests.helpers.pages import LANGUAGES, record_rows, seen
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from rosprivacy.report.page.exits import ExitCard
    from rosprivacy.report.page.outline import Outline
    from rosprivacy.result import Result

STATION = ROOT / "tests" / "cases" / "station-abroad"
RECOGNISERS = ("/mood_reader", "/gate_list")
PROTECTION = {"en": "protect", "de": r"[sS]chutz|[sS]chütz", "fr": "protection|protég|protèg"}
PERSONAL = {  # as pseudonymised data are said to be
    "en": "(still|are) personal|personal data for",
    "de": r"(weiter|bleib\w+|sind sie) personenbezogen|personenbezogen für",
    "fr": r"(restent|sont|toujours|:) (des )?(données )?à caractère personnel",
}
FOR_WHOM = {
    "en": "for whoever|recipient who",
    "de": "jeden|Empfänger, der",
    "fr": "pour qui|quiconque|destinataire qui",
}
OUTPUTS = ("text", "markdown", "article30", "works-council", "cnil-pia", "notice")


@cache
def station() -> Result:
    return rosprivacy.analyze(STATION / "station.policy.xml", STATION / "station.labels.yaml")


def restated(folder: Path, *changes: tuple[str, str]) -> Result:
    """The station, of which the labels state something else."""
    labels = (STATION / "station.labels.yaml").read_text("utf-8")
    for old, new in changes:
        assert old in labels
        labels = labels.replace(old, new)
    (folder / "labels.yaml").write_text(labels, "utf-8")
    return rosprivacy.analyze(STATION / "station.policy.xml", folder / "labels.yaml")


def told(result: Result, language: str = "en") -> Outline:
    return outline(result.document(), language)


def card(report: Outline, place: str) -> ExitCard:
    return next(card for card in report.opening.cards if card.place == place)


def provisions(report: Outline, place: str, words: Words) -> set[str]:
    """Provisions that the card of a place names."""
    shown = card(report, place)
    facts = [*shown.facts, *(fact for line in shown.lines for fact in line.facts)]
    return {name for title, value in facts if title == words("opening.law") for name in value.split("; ")}


def asked(report: Outline) -> dict[str, set[str]]:
    return {question.key: {place.place for place in question.places} for question in report.row_questions.confirm}


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_prohibited_and_what_falls_under_article_10_comes_first_though_no_finding_speaks_of_it(
    language: str,
) -> None:
    assert not {f.category for f in station().findings} & {"EmotionEstimate", "WatchListMatch"}
    first = told(station(), language).row_questions.foremost
    assert [question.key for question in first] == ["know.prohibited", "know.criminal"]
    assert {place.place for question in first for place in question.places} == {"vault"}
    page = seen(station(), "html", language)
    assert page.index(plain(first[0].text)) < page.index(plain(card(told(station(), language), "remote driver").data))


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_derogation_is_a_transfer_and_whether_it_is_occasional_is_asked_where_it_is_decided(language: str) -> None:
    words, report = Words(language), told(station(), language)
    assert words("opening.law.third-country-transfer") in provisions(report, "call centre", words)
    assert words("opening.unstated.occasional") in card(report, "call centre").unstated
    assert asked(report)["confirm.occasional"] == {"call centre"}
    (open_row,) = station().document()["open"]
    assert open_row["element"]["name"] == "call centre"
    page = seen(station(), "markdown", language)
    assert plain(words("missing.occasional")) in page.partition(plain(words("heading.questions")))[2]


def test_a_derogation_that_is_stated_to_be_occasional_is_asked_about_no_more(tmp_path: Path) -> None:
    result = restated(tmp_path, ("transfer: derogation", "transfer: occasional-derogation"))
    report = told(result)
    assert "confirm.occasional" not in asked(report)
    assert table("en")["opening.unstated.occasional"] not in card(report, "call centre").unstated
    assert result.document()["open"] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_card_names_the_provisions_on_who_gets_the_data_and_on_what_a_transfer_rests(language: str) -> None:
    words, report = Words(language), told(station(), language)
    chapter_v, processor, joint = (
        words(f"opening.law.{what}") for what in ("third-country-transfer", "processor", "joint-controller")
    )
    named = {place: provisions(report, place, words) & {chapter_v, processor, joint} for place in places(report)}
    assert named == {
        "remote driver": {chapter_v, joint},
        "mirror": {chapter_v, processor},
        "vault": {chapter_v, processor},  # kept too long there, and no transfer without a basis
        "call centre": {chapter_v, processor},
        "model store": set(),  # a third party in a country with an adequacy decision
    }


def places(report: Outline) -> list[str]:
    return [card.place for card in report.opening.cards]


def test_a_transfer_within_the_eea_is_none(tmp_path: Path) -> None:
    report = told(restated(tmp_path, ("country: US", "country: IE")))
    assert table("en")["opening.law.third-country-transfer"] not in provisions(report, "vault", Words("en"))


def test_contracts_that_nobody_states_are_asked_for_on_page_one() -> None:
    report = told(station())
    assert asked(report)["confirm.processor"] == {"mirror", "call centre"}
    assert asked(report)["confirm.joint"] == {"remote driver"}
    lacking = {
        place for place in places(report) if table("en")["opening.unstated.contract"] in card(report, place).unstated
    }
    assert lacking == {"mirror", "call centre", "remote driver"}


def test_safeguards_that_are_missing_or_to_be_documented_are_to_be_completed() -> None:
    """Article 30(1)(e), with the second subparagraph of Article 49(1)."""
    rows = record_rows(station())
    incomplete = {exit_ for (_, exit_), row in rows.items() if "30(1)(e)" in row["complete"]}
    assert incomplete == {"mirror", "call centre", "remote driver"}


def test_a_processing_without_a_stated_purpose_has_no_name_and_says_so(tmp_path: Path) -> None:
    rows = record_rows(restated(tmp_path, ("purpose: order in the hall\n", "")))
    assert len(rows) > 6
    for row in (row for (kind, _), row in rows.items() if kind):  # without that of the answer itself
        assert row["activity"] == table("en")["record.open"]
        assert "30(1)(b)" in row["complete"]


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_drops_data_and_recognises_persons_is_nowhere_said_to_protect(language: str) -> None:
    _, _, denied = plain(table(language)["sanitizer.recognises"]).rpartition("}")
    for output in ("text", "markdown", "article30", "cnil-pia"):
        for line in seen(station(), output, language).split("\n"):
            if any(name in line for name in RECOGNISERS):
                assert not re.search(PROTECTION[language], line.replace(denied, "")), line


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_text_about_cleaning_calls_it_a_protection(language: str) -> None:
    """Whether what cleans protects anybody, a person has to judge; what makes other data of it protects nobody."""
    texts = {key: text for key, text in table(language).items() if "sanitizer" in key or "cleaning" in key}
    del texts["sanitizer.recognises"]  # that it is none
    assert len(texts) > 10
    assert [key for key, text in texts.items() if re.search(PROTECTION[language], text)] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_pseudonymised_data_are_personal_for_those_who_can_tell_the_persons(language: str) -> None:
    """Recital 26, and CJEU C-413/23 P: a recipient who cannot tell them may hold no personal data."""
    said = [
        sentence for output in OUTPUTS for sentence in of_pseudonymised(seen(station(), output, language), language)
    ]
    assert said
    assert [sentence for sentence in said if not re.search(FOR_WHOM[language], sentence)] == []
    assert "CJEU C-413/23 P" in {row["provision"] for row in station().document()["look_at"]}


def of_pseudonymised(text: str, language: str) -> Iterator[str]:
    """Paragraphs, cells and items that say of pseudonymised data that they are personal."""
    for sentence in re.split(r"\n|\||\",\"|</li>", text):
        if "pseudonymis" in sentence.lower() and re.search(PERSONAL[language], sentence):
            yield sentence


def test_sarif_says_for_whom_pseudonymised_data_are_personal() -> None:
    text: Any = seen(station(), "sarif")
    assert "It arrives pseudonymised" in text
    assert all("whoever" in part.partition(".")[0] for part in text.split("It arrives pseudonymised")[1:])
