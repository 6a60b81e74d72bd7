"""What is to be confirmed and to be known: a question per row of the register, if a finding speaks of it or not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain, table
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.to_confirm import BOUND, RowQuestion
from tests.helpers.pages import LANGUAGES, page, told
from tests.helpers.reports import care, decide, office

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path


@pytest.fixture
def system(tmp_path: Path) -> dict[str, Any]:
    return office(tmp_path)


def places(questions: Iterable[RowQuestion]) -> dict[str, list[str]]:
    return {question.key: [place.place for place in question.places] for question in questions}


def test_a_row_is_asked_about_its_transfer_its_contract_and_its_protection(system: dict[str, Any]) -> None:
    confirm = places(told(system).row_questions.confirm)
    assert confirm["confirm.assessment"] == ["archive"]  # no finding speaks of it
    assert confirm["confirm.unencrypted"] == ["archive"]
    assert confirm["confirm.occasional"] == ["help desk"]
    assert confirm["confirm.processor"] == ["help desk"]
    assert confirm["confirm.joint"] == ["partner"]
    assert confirm["confirm.criminal"] == ["archive"]
    assert set(confirm["confirm.special"]) == {"archive", "help desk", "partner", "/camera"}


def test_what_is_stated_is_not_asked(system: dict[str, Any]) -> None:
    for row in system["register"]:
        row |= {"area": "eea", "to_complete": [], "encrypted": True}
    assert told(system).row_questions.confirm == ()


def test_prohibited_practices_and_article_10_come_first_where_nothing_leaks(system: dict[str, Any]) -> None:
    assert not {f["category"] for f in system["findings"]} & {"EmotionEstimate", "WatchListMatch"}
    lists = told(system).row_questions
    know = (*lists.foremost, *lists.know)
    assert [question.key for question in know] == ["know.prohibited", "know.criminal", "know.rests"]
    practices = {data: place.remark for place in know[0].places for data, _ in place.kinds}
    assert "AI Act Art. 5(1)(f)" in practices["emotion estimate"]
    assert not any("Art. 50" in remark for remark in practices.values())  # no prohibited practice
    assert [place.remark for place in know[2].places] == ["1 year"]


def test_they_stand_before_the_first_decision(system: dict[str, Any]) -> None:
    (decide_first,) = page(system).xpath("//section[@id='decide']")
    before = decide_first.xpath("./*[following-sibling::ol[@class='decide']]//text()")
    assert IN_ENGLISH("know.prohibited") in before


def test_the_heaviest_row_comes_first(system: dict[str, Any]) -> None:
    (archive,) = told(system).row_questions.know[0].places
    assert [data for data, _ in archive.kinds] == ["watch-list match", "emotion estimate"]


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_list_stands_on_page_one_with_its_places(system: dict[str, Any], language: str) -> None:
    lists = told(system, language).row_questions
    in_page = page(system, language).xpath("//section[@id='decide']")[0].text_content()
    in_text = "".join(markdown(told(system, language)).partition("\n## 2")[0].split("\\"))
    for text in map(plain, (in_page, in_text)):
        for question in (*lists.foremost, *lists.confirm, *lists.know):
            assert plain(question.text) in text
            assert all(place.place in text for place in question.places)


def test_an_acceptance_without_ground_or_end_is_asked_about_and_still_counts() -> None:
    document = care()
    before = {number for number, what in told(document).summary.numbers if "to assess or accepted" in what}
    document["findings"][0]["accepted"] = True
    decide(document, 0, legal_basis=["6(1)(f)"], owner="me", reason="ok")
    report = told(document)
    (first, *_) = report.row_questions.confirm
    assert first.key == "confirm.accepted"
    (place,) = first.places
    assert place.entries[0].id == document["findings"][0]["id"]
    assert "Article 9(2)" in place.remark
    assert table("en")["decision.gap.no_end"] in place.remark
    numbers = {what: number for number, what in report.summary.numbers}
    assert {numbers["paths to assess or accepted"]} == before
    assert numbers["of them accepted by decision"] == 1
    assert numbers[table("en")["total.special"]] == 1


def test_page_one_has_the_first_and_the_others_by_number_with_a_link(system: dict[str, Any]) -> None:
    (like,) = [row for row in system["register"] if row["category"] == "EmotionEstimate" and row["places"]]
    for number in range(BOUND + 2):
        place = {**like["places"][0], "name": f"disk {number}"}
        system["register"].append({**like, "id": f"{number:016x}", "places": [place]})
    report = told(system)
    shown, every = report.row_questions.shown, report.row_questions
    assert sum(len(question.places) for question in shown.confirm) == BOUND
    assert all(every.remainder[1:])
    assert page(system).xpath("//section[@id='decide']//a[@href='#confirm']")
    every_place = page(system).xpath("//section[@id='confirm']")[0].text_content()
    assert all(f"disk {number}" in every_place for number in range(BOUND + 2))


def test_one_or_two_that_are_left_are_named(system: dict[str, Any]) -> None:
    """'and 1 more' names nothing: of places, and of the paths that end at one."""
    (like,) = [row for row in system["register"] if row["category"] == "EmotionEstimate" and row["places"]]
    for number in range(BOUND + 1):
        place = {**like["places"][0], "name": f"disk {number}"}
        system["register"].append({**like, "id": f"{number:016x}", "places": [place]})
    lists = told(system).row_questions
    assert len(lists.shown.know[0].places) == BOUND + 2
    assert lists.remainder[2] == 0
    for language in LANGUAGES:
        text = markdown(told(care(), language))
        assert not [n for n in (1, 2) if plain(Words(language)("more", n=n)) in plain(text)]


def test_a_recipient_is_asked_for_its_contract_whatever_the_data(system: dict[str, Any]) -> None:
    (question,) = [one for one in told(system).row_questions.confirm if one.key == "confirm.processor"]
    assert [(place.place, place.kinds, place.entries) for place in question.places] == [("help desk", (), ())]
    assert question.places[0].rows


def test_health_data_are_asked_for_professional_secrecy_where_the_exception_is_stated(system: dict[str, Any]) -> None:
    """Article 9(3): that no exception is stated would be false."""
    for row in system["register"]:
        row["special_bases"] = ["9(2)(h)"] if "special_bases" in row["to_complete"] else row["special_bases"]
    keys = {question.key for question in told(system).row_questions.confirm}
    assert "confirm.secrecy" in keys
    assert "confirm.special" not in keys


def test_whether_the_gdpr_applies_is_asked_first() -> None:
    document = care()
    document["surroundings"] = [
        {"element": document["findings"][0]["source"], "contexts": [], "country": "US", "gdpr": "open"}
    ]
    (first, *_) = told(document).row_questions.confirm
    assert (first.key, first.places) == ("scope", ())
    assert "US" in first.text
