"""The cards of a report: one for each place where data gets out, what is the same once, what is not stated in one line.

The property: on random systems each finding stands on one card, and a card has nothing that the document has not.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.documents import document_of
from rosprivacy.ontology.vocabulary import load
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.document.analysis import json_document
from rosprivacy.report.document.contents import IN_JSON, RELIANCE
from rosprivacy.report.finding_facts import strength
from rosprivacy.report.page.exits import exit_cards
from rosprivacy.report.page.finding_entries import finding_entries
from rosprivacy.report.page.flows import flows
from rosprivacy.report.page.html import html
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.markdown import markdown
from tests.helpers.abroad import abroad
from tests.helpers.answers import answer_of
from tests.helpers.graphs import hospital
from tests.helpers.pages import LANGUAGES, page, texts_of, told
from tests.helpers.reports import care, decide, fleet, hostile, run, with_decisions, with_outside
from tests.helpers.systems import analysed, systems

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.report.page.exits import ExitCard
    from tests.helpers.systems import System

VOCABULARY = load()
KINDS = ("PersonalData", "Biometric", "FaceTemplate", "Video", "Voice")
REST: dict[str, Any] = {
    "rosprivacy": "1",
    "policies": [],
    "labels": [],
    "standard_channels": None,
    "law_as_of": "2026-01-01",
}
STATES = ("accept", "mitigate", "")
CHOICES = st.lists(st.sampled_from(STATES), min_size=1, max_size=6)
FACTS: dict[str, Any] = {"operator": "Speech Inc.", "recipient": "processor", "country": "US", "contract": "of May"}


def ids(card: ExitCard) -> list[str]:
    return [finding for entry in card.entries for finding in (entry.id, *entry.alike)]


def check(document: dict[str, Any]) -> tuple[ExitCard, ...]:
    """Each finding is on one card; all that a card has is of findings of its place."""
    words = Words("en")
    index = Index(document, words)
    entries = finding_entries(index)
    cards = exit_cards(index, flows(index, entries), entries)
    on_cards = [finding for card in cards for finding in ids(card)]
    assert sorted(on_cards) == sorted(finding["id"] for finding in document["findings"])
    for card in cards:
        findings = [index.by_id[finding] for finding in ids(card)]
        leaks = {(finding["leak"]["kind"], finding["leak"]["name"]) for finding in findings}
        assert len(leaks) == 1
        assert card.place == words.row(index.names([finding["leak"] for finding in findings]))
        listed = {entry.id for line in card.lines for entry in line.entries}
        listed |= {entry.id for line in card.settled for entry in line.entries}
        assert listed <= {entry.id for entry in card.entries}
        remain = [*(line.remainder for line in card.lines), *(line.remainder for line in card.settled)]
        assert any(remain) or listed == {entry.id for entry in card.entries}
        for line in card.lines:
            here = [index.by_id[entry.id] for entry in line.entries]
            kinds = {index.data(f["category"], pseudonymised=f["pseudonymised"]) for f in here}
            assert any(kind in line.data for kind in kinds)
            assert {finding["article9"] for finding in here} == {line.article9}
        rank = [(not flow.waits) for flow in card.flows]
        assert rank == sorted(rank)
    waits = [card.waits for card in cards]
    assert waits == sorted(waits, reverse=True)
    return cards


@given(systems(KINDS), CHOICES)
@settings(max_examples=25, deadline=None)
def test_every_finding_stands_on_one_card_and_a_card_has_nothing_else(system: System, choices: list[str]) -> None:
    analysis = analysed(replace(system, hierarchy=VOCABULARY.hierarchy))
    if analysis is None:
        return
    document: dict[str, Any] = dict(
        json_document(document_of(answer_of(analysis, VOCABULARY, REST), (*IN_JSON, RELIANCE)))
    )
    for number, finding in enumerate(document["findings"]):
        if choice := choices[number % len(choices)]:
            decide(document, number, choice=choice, owner="somebody")
            finding["accepted"] = choice == "accept"
    check(document)


def test_it_holds_for_fleets_for_decisions_and_for_hostile_names(tmp_path: Path) -> None:
    documents = (care(), with_outside(care()), with_decisions(care()), dict(hospital().document()), run(1), run(2))
    for document in (*documents, fleet(care(), ["a", "b"]), hostile(tmp_path)):
        assert bool(check(document)) == bool(document["findings"])


def test_what_is_special_stands_first_and_data_as_it_is_before_what_is_pseudonymised() -> None:
    cards = told(care()).opening.cards
    by_id = {finding["id"]: finding for finding in care()["findings"]}
    ranks = [[strength(by_id[entry.id]) for entry in card.entries] for card in cards]
    assert ranks[0][0] == ("always", "conditional")
    assert [any(entry.pseudonymised for entry in card.entries) for card in cards] == [False, True]


def test_what_all_flows_of_a_place_have_in_common_stands_once() -> None:
    uplink = told(care()).opening.cards[0]
    assert uplink.place == "/uplink"
    assert [line.sources for line in uplink.lines] == [("/camera",), ("/microphone",)]
    assert {what for what, _ in uplink.facts} <= {"Provisions"}  # that it is to assess goes without saying
    assert [dict(line.facts)["Whose data"] for line in uplink.lines] == [
        "residents, staff, visitors",
        "residents, staff",
    ]


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_is_not_stated_is_gathered_in_one_line_of_a_card(language: str) -> None:
    report = told(care(), language)
    words = report.words
    for card in report.opening.cards:
        for what in ("recipient", "country", "contract", "retention", "basis"):
            assert words(f"opening.unstated.{what}") in card.unstated
        assert words("opening.unstated.owner") not in card.unstated  # nobody is named for any: told once, before
        assert not [value for _, value in card.facts if value in ("", words("not.stated"))]
    assert (words("opening.owner"), words("record.open")) in report.opening.frame
    for text in texts_of(report):
        first = text.partition(plain(words("not.legal")))[0]
        for card in report.opening.cards:
            assert plain(card.unstated) in first
        assert plain(words("not.stated")) not in first


def test_what_is_stated_of_a_place_is_on_its_card_and_not_in_that_line() -> None:
    document = care()
    (leak,) = {finding["leak"]["name"]: finding["leak"] for finding in document["findings"][:1]}.values()
    document["outside"] = [{"element": leak, "file": "l.yaml", "line": 1, "area": "partly", "holds": [], **FACTS}]
    uplink = told(document).opening.cards[0]
    facts = dict(uplink.facts)
    assert facts["Recipient"] == "Speech Inc., processor"
    assert facts["Country"].startswith("US")
    assert facts["Contract"] == "of May"
    assert uplink.unstated == "Not stated: legal basis"


def test_who_decides_is_asked_of_each_where_it_is_stated_of_some() -> None:
    document = care()
    decide(document, 0, choice="mitigate", owner="robot team")
    opening = told(document).opening
    assert "Who decides" not in dict(opening.frame)
    unstated = {card.place: card.unstated for card in opening.cards}
    assert "who decides (of voice)" in unstated["/uplink"]
    assert unstated["/recorder"].endswith("who decides")


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_line_says_why_it_is_asked(language: str, tmp_path: Path) -> None:
    """By what makes it a finding: a time that is too long, a decision on adequacy, a way out that somebody named."""
    for document in (care(), with_outside(care()), dict(hospital().document()), abroad(tmp_path), run(2)):
        report = told(document, language)
        index = Index(document, report.words)
        for line in (line for card in report.opening.cards for line in card.lines):
            kinds = dict.fromkeys(entry.kind for entry in line.entries)
            assert len(line.asks) == len(kinds)
            for ask, kind in zip(line.asks, kinds, strict=True):
                question, _, reason = ask.partition("?")
                assert report.words(f"ask.{kind}").startswith(question)
                assert len(reason.split()) in range(3, 25)
            findings = [index.by_id[entry.id] for entry in line.entries]
            limits = {value for f in findings for value in f.get("because", {}).get("values", {}).values()}
            durations = {
                report.words.duration(value) for value in limits if value.startswith("P") and value[1:2].isdigit()
            }
            assert all(any(duration in ask for ask in line.asks) for duration in durations)
        for text in texts_of(report):
            assert all(plain(ask) in text for card in report.opening.shown for line in card.lines for ask in line.asks)


def test_what_is_not_stated_of_some_data_only_names_them() -> None:
    document = care()
    document["subjects"] = [row for row in document["subjects"] if row["element"]["name"] != "/microphone"]
    uplink = told(document).opening.cards[0]
    assert uplink.unstated.endswith("whose data (of voice)")


def test_what_is_stated_of_one_robot_only_says_of_which_it_is_not() -> None:
    document = fleet(care(), ["a", "b"])
    leak = next(f["leak"] for f in document["findings"] if f["leak"]["name"] == "/uplink" and f["leak"]["robot"] == "b")
    document["outside"] = [{"element": leak, "file": "l.yaml", "line": 1, "holds": [], **FACTS}]
    uplink = told(document).opening.cards[0]
    assert uplink.place == "/uplink (2 robots)"
    assert dict(uplink.facts)["Recipient"] == "Speech Inc., processor"
    assert "recipient (of a:/uplink)" in uplink.unstated


def test_two_places_of_one_name_about_which_other_things_are_stated_are_two_cards() -> None:
    document = dict(hospital().document())
    rows = {row["element"]["name"]: row for row in document["outside"]}
    cloud = rows["fleet cloud"]["element"]
    one, other = (finding for finding in document["findings"] if finding["leak"] == cloud)
    assert [card.place for card in told(document).opening.cards].count("hospital:fleet cloud") == 1
    elsewhere = {**cloud, "robot": "base"}
    moved = {**other, "leak": elsewhere, "witness": [*other["witness"][:-1], elsewhere]}
    document["findings"] = [moved if finding is other else finding for finding in document["findings"]]
    document["outside"] = [
        *document["outside"],
        {**rows["fleet cloud"], "element": elsewhere, "operator": "Other Inc."},
    ]
    cards = {card.place: dict(card.facts) for card in told(document).opening.cards}
    assert cards["hospital:fleet cloud"]["Recipient"].startswith("Example Robotics Inc.")
    assert cards["base:fleet cloud"]["Recipient"].startswith("Other Inc.")
    assert one


def many_kinds(number: int) -> dict[str, Any]:
    """A document with as many kinds of data to one place."""
    document = care()
    template, category = document["findings"][2], document["categories"][-1]
    document["findings"] = []
    for count in range(number):
        name = f"Kind{count}"
        document["categories"].append({**category, "name": name, "title": f"kind {count}", "translations": {}})
        step = {**template["steps"][0], "category": name}
        more = {"id": f"{count:016x}", "category": name, "steps": [step for _ in template["steps"]]}
        document["findings"].append({**template, **more})
    return document


def test_all_kinds_are_said_in_three_words_and_few_by_their_names() -> None:
    (few,), (every,) = (told(many_kinds(number)).opening.cards for number in (3, 9))
    assert few.data == "kind 0, kind 1, kind 2"
    assert every.data == "all 9 kinds of data"
    assert told(many_kinds(9)).opening.gist.startswith("All 9 kinds of data can get to /uplink.")
    assert every.lines[0].data == ", ".join(f"kind {number}" for number in range(9))  # they go together
    assert len(every.lines) == 1


def test_a_kind_with_all_narrower_ones_is_said_by_its_name() -> None:
    document = many_kinds(5)
    for category in document["categories"]:
        if category["name"] in ("Kind1", "Kind2"):
            category["broader"] = ["Kind0", "PersonalData"]
    elsewhere = next(finding["leak"] for finding in care()["findings"] if finding["leak"]["name"] == "/recorder")
    document["findings"][4] = {**document["findings"][4], "leak": elsewhere}
    data = [card.data for card in told(document).opening.cards]
    assert data == ["kind 0 with all narrower kinds, kind 3", "kind 4"]


@pytest.mark.parametrize("language", LANGUAGES)
def test_all_forms_tell_the_same_cards(language: str) -> None:
    for document in (with_decisions(with_outside(care())), dict(hospital().document())):
        report = told(document, language)
        cards = report.opening.shown
        headings = [heading.text_content() for heading in page(document, language).xpath("//ol[@class='decide']/li/h3")]
        assert len(headings) == len(cards)
        text = re.sub(r"\\(.)", r"\1", markdown(report))
        for card, heading in zip(cards, headings, strict=True):
            assert card.place in heading
            assert card.data in heading
            assert f"`{card.place}` ({card.kind})" in text
            for _, value in card.facts:
                assert plain(value) in plain(text)


def test_a_place_where_all_is_settled_says_why_and_where() -> None:
    document = care()
    for number, finding in enumerate(document["findings"]):
        decide(document, number, owner="somebody")
        finding["accepted"] = True
    opening = told(document).opening
    assert opening.count == 0
    assert [line.why for card in opening.cards for line in card.settled] == ["accepted", "accepted"]
    assert 'class="decide"' in html(told(document))
