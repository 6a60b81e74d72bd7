"""The row of a finding on the page: what is stated before anything is asked, what is asked, and a decision about it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest
from lxml import html

from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.page.to_confirm import question_key
from tests.helpers.explorers import Explorer, version
from tests.helpers.rows import ANSWERS, at, written

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from starlette.testclient import TestClient

    Explore = Callable[..., Explorer]

SIGNED = {"choice": "accept", "reason": "agreed", "owner": "A. Lee", "expires": "2999-12-31", "about": "row"}
GROUND = {"ground": "6(1)(f)"}


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    return written(tmp_path)


@pytest.fixture
def begun(explore: Explore, files: tuple[Path, Path], tmp_path: Path) -> Explorer:
    return explore(*files, decisions=tmp_path / "d.jsonl")


@pytest.fixture
def client(begun: Explorer) -> TestClient:
    return begun.client()


def decide(client: TestClient, finding: str, /, **fields: Any) -> Any:
    said = {"version": version(client), "finding": finding, **fields}
    return client.post(f"/decide?finding={finding}", data=said)


def page(client: TestClient, finding: str) -> html.HtmlElement:
    return html.fromstring(client.get(f"/?finding={finding}").text)


def test_what_is_stated_stands_before_what_is_asked(begun: Explorer, client: TestClient) -> None:
    words, shown = Words("en"), page(client, at(begun, "cabin")[0])
    facts = shown.xpath("//h3[@id='h-row']/following-sibling::dl[1]")[0]
    names, values = ([one.text_content() for one in facts.findall(tag)] for tag in ("dt", "dd"))
    stated = dict(zip(names, values, strict=True))
    assert stated[words("opening.whose")] == "staff; visitors"
    assert "Example Teleop" in stated[words("opening.recipient")]
    assert stated[words("opening.contract")] == words("record.open")
    assert words("transfer.derogation") in stated[words("opening.transfer")]
    form = shown.get_element_by_id("decide")
    in_order = list(shown.iter())
    assert in_order.index(facts) < in_order.index(form)
    asked = {field.get("name") for field in form.xpath(".//input[starts-with(@name, 'answer-')]")}
    assert asked == {*ANSWERS, "answer-special"}


def test_grounds_of_article_9_are_offered_where_data_may_need_one(begun: Explorer, client: TestClient) -> None:
    for place, special in (("cabin", True), ("archive", True), ("/scanner", False)):
        (finding, *_) = at(begun, place)
        ticked = page(client, finding).xpath("//input[@name='ground']/@value")
        assert "6(1)(f)" in ticked
        assert ("9(2)(a)" in ticked) == special


def test_a_row_is_decided_with_all_that_ends_there_and_the_answers_are_kept(
    begun: Explorer, client: TestClient, tmp_path: Path
) -> None:
    finding, other = at(begun, "cabin")
    assert decide(client, finding, **SIGNED, **GROUND, **ANSWERS).status_code == 303
    (line,) = (tmp_path / "d.jsonl").read_text("utf-8").splitlines()
    decision = json.loads(line)["decision"]
    assert decision["legal_basis"] == ["6(1)(f)"]
    assert decision["answers"] == {"occasional": "once a year", "processor": "DMS 12"}
    assert decision["reason"] == SIGNED["reason"]
    assert sorted(decision["made_about"]["findings"]) == sorted([finding, other])
    accepted = {one.id for one in begun.session.findings if one.accepted}
    assert accepted == {finding, other}
    assert page(client, other).xpath("//input[@name='about'][@checked]/@value") == ["row"]


def test_a_question_without_an_answer_is_told_before_anything_is_written(
    begun: Explorer, client: TestClient, tmp_path: Path
) -> None:
    finding, _ = at(begun, "cabin")
    said = {**SIGNED, **GROUND, "answer-processor": "DMS 12"}
    answer = decide(client, finding, **said)
    assert (answer.status_code, (tmp_path / "d.jsonl").exists()) == (409, False)
    told = html.fromstring(answer.text)
    assert Words("en")("confirm.occasional") in told.get_element_by_id("message").text_content()
    form = told.get_element_by_id("decide")
    kept = {field.get("name"): field.get("value") for field in form.xpath(".//input[@name and not(@type)]")}
    assert kept["answer-processor"] == "DMS 12"
    assert form.xpath(".//input[@name='ground'][@checked]/@value") == ["6(1)(f)"]
    (lacks,) = form.xpath(".//input[@name='lacks']/@value")
    assert decide(client, finding, **said, lacks=lacks).status_code == 303


def test_one_path_can_be_decided_alone(begun: Explorer, client: TestClient) -> None:
    finding, other = at(begun, "cabin")
    said = {**SIGNED, **GROUND, **ANSWERS, "about": "finding"}
    assert decide(client, finding, **said).status_code == 303
    assert {one.id for one in begun.session.findings if one.accepted} == {finding}
    assert decide(client, other, **{**SIGNED, "choice": "mitigate"}).status_code == 303  # the row: neither is accepted
    assert not [one for one in begun.session.findings if one.accepted]


def test_what_was_rejected_by_itself_is_not_accepted_with_its_row(
    begun: Explorer, client: TestClient, tmp_path: Path
) -> None:
    finding, other = at(begun, "cabin")
    assert decide(client, finding, **{**SIGNED, "choice": "mitigate", "about": "finding"}).status_code == 303
    before = (tmp_path / "d.jsonl").read_bytes()
    answer = decide(client, other, **SIGNED, **GROUND, **ANSWERS)
    assert answer.status_code == 422
    assert "line 1 decides it, too" in answer.text
    assert (tmp_path / "d.jsonl").read_bytes() == before


@pytest.mark.parametrize("fields", [{"about": "robot"}, {"ground": "6(1)(z)"}, {"answer-processor": "x" * 301}])
def test_what_no_form_says_is_refused(
    begun: Explorer, client: TestClient, tmp_path: Path, fields: dict[str, str]
) -> None:
    finding, _ = at(begun, "cabin")
    assert decide(client, finding, **{**SIGNED, **GROUND, **ANSWERS, **fields}).status_code == 422
    assert not (tmp_path / "d.jsonl").exists()


@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_a_review_decides_rows_too(explore: Explore, files: tuple[Path, Path], tmp_path: Path, language: str) -> None:
    begun, words = explore(*files, decisions=tmp_path / "d.jsonl", review=True, language=language), Words(language)
    client, (finding, other) = begun.client(), at(begun, "cabin")
    summary = html.fromstring(client.get("/?step=summary").text)
    (link,) = summary.xpath(f"//a[contains(@href, 'finding={finding}')]/@href")
    shown = html.fromstring(client.get(link).text)
    assert "Example Teleop" in shown.text_content()
    form = shown.get_element_by_id("decide")
    asked = [
        words(question_key(name.removeprefix("answer-")))
        for name in form.xpath(".//input/@name")
        if name.startswith("answer-")
    ]
    assert asked
    assert all(question in form.text_content() for question in asked)
    said = {"version": form.xpath(".//input[@name='version']/@value")[0], "finding": finding, **SIGNED, **GROUND}
    again = client.post(form.get("action", ""), data=said)
    assert again.status_code == 409
    assert words("explorer.decide.again") in html.fromstring(again.text).text_content()
    assert html.fromstring(again.text).get_element_by_id("decide").get("action") == form.get("action")
    done = client.post(form.get("action", ""), data={**said, **ANSWERS})
    assert (done.status_code, done.headers["location"]) == (303, "/?step=summary")
    assert {one.id for one in begun.session.findings if one.accepted} == {finding, other}
    assert words("state.accepted") in html.fromstring(client.get("/?step=summary").text).text_content()


def test_a_review_without_a_file_of_decisions_says_how_to_name_one(explore: Explore, files: tuple[Path, Path]) -> None:
    begun = explore(*files, review=True)
    shown = html.fromstring(begun.client().get(f"/?step=decide&finding={at(begun, 'cabin')[0]}").text)
    assert not shown.xpath("//form[@id='decide']")
    assert "--decisions" in shown.text_content()
