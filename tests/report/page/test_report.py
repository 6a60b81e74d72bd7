"""The report for people: its words, and what it tells."""

from __future__ import annotations

import re
from typing import Any

import pytest

from rosprivacy.report.catalogs.words import table
from rosprivacy.report.page.index import node_of_service
from tests.helpers.pages import LANGUAGES, texts, told
from tests.helpers.reports import care, run

# what a report never says: verdicts of law, promises
FORBIDDEN = re.compile(
    r"\b(violat\w*|illegal\w*|unlawful\w*|breach\w*|complian\w*|comply|safe|harmless|"
    r"versto\w*|verletz\w*|illegal\w*|rechtswidrig\w*|unzulässig\w*|\w*konform\w*|sicher|unbedenklich|datenpanne|"
    r"viol\w*|enfrein\w*|illégal\w*|illicit\w*|conform\w*|infraction\w*|manquement\w*|sans danger|fuites?)\b",
    re.IGNORECASE,
)


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_word_is_a_verdict_of_law_or_a_promise(language: str) -> None:
    for key, text in table(language).items():
        assert not FORBIDDEN.search(text), (key, text)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("document", [care(), run(3), run(5)], ids=["care", "run3", "run5"])
def test_no_report_gives_a_verdict_of_law_or_a_promise(document: dict[str, Any], language: str) -> None:
    for text in texts(document, language):
        assert not FORBIDDEN.search(text), FORBIDDEN.search(text)


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_finding_is_told_with_its_way_lines_and_law(language: str) -> None:
    document = care()
    for text in texts(document, language):
        for finding in document["findings"]:
            assert finding["id"] in text
            for element in finding["witness"]:
                assert element["name"] in text
            for step in finding["steps"]:
                for grant in step["policy"]:
                    assert f"{grant['file']}:{grant['line']}" in text
                    assert grant["enclave"] in text
        for category in document["categories"]:
            said = category["translations"].get(language, category)
            assert said["title"] in text
            assert said["definition"] in text
            for legal in category["law"]:
                law = {**legal, **legal["translations"].get(language, {})}
                assert law["provision"] in text
                assert law["condition"] in text or law["condition"].startswith("⊇")


def test_each_assumption_is_told() -> None:
    document = care()
    document["assumptions"] |= {"categories_asked": ["Video"], "article9_only": True, "data_types_asked": ["video"]}
    document["assumptions"]["identity_factors_asked"] = ["economic"]
    document["assumptions"]["sanitizers_without_method"] = [
        {"element": document["findings"][0]["source"], "category": "Video", "taken_as": "pseudonymise"}
    ]
    for text in texts(document):
        for file in (*document["assumptions"]["policies"], *document["assumptions"]["labels"]):
            assert file["file"] in text
            assert file["sha256"] in text
        assert "each node does what its own profile in the policy says" in text
        assert "75 standard ROS channels taken to carry no personal data" in text
        assert "only about these kinds of data and narrower ones: Video. Others were not looked at" in text
        assert "only about data of these types: video" in text
        assert "or of which that is not stated: economic" in text
        assert "only about data that can fall under Article 9(1)" in text
        assert "no label states how. It was taken as pseudonymisation" in text
        assert "followed into paths, as the program's ontology has it, reviewed on 2026-11-21" in text


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ({}, "You have to decide 3 things"),
        (
            {"verdict": "undetermined", "findings": [], "open": "some"},
            "Not determined: what data can pass is not reviewed",
        ),
        ({"verdict": "no-leak-found", "findings": []}, "No path to a recipient was found under the labels given"),
        ({"verdict": "undetermined", "findings": [], "open": []}, "no source was named, so no data was followed"),
        ({"verdict": "undetermined", "findings": [], "categories": []}, "no source was named, so no data was followed"),
    ],
)
def test_the_verdict_says_what_was_found_and_what_it_does_not_mean(change: dict[str, Any], verdict: str) -> None:
    document = care() | change
    if document["open"] == "some":
        where = document["carries"][0]["element"]
        document["open"] = [{"element": where, "categories": ["Video"], "distance": 1, "frontier": True}]
    if not document["categories"]:
        document |= {"roles": [], "derivations": [], "sanitizers": [], "carries": [], "subjects": []}
    for text in texts(document):
        assert verdict in text
        assert "This report is no legal verdict" in text


def test_open_elements_are_told_in_the_order_of_review() -> None:
    document = run(2)
    names = [row["element"]["name"] for row in document["open"]]
    assert [(group.key, [question.name for question in group.questions]) for group in told(document).questions] == [
        ("question.first", ["/robot_arm_control"]),
        ("question.channels", [name for name in names if name != "/robot_arm_control"]),
    ]


def test_what_passes_beside_a_sanitizer_is_told() -> None:
    (row,) = told(run(5)).inventory.cleanings
    assert (row.name, row.other_readers) == ("/filter", ("/emergency_stop",))


def test_a_way_that_does_not_lead_through_a_sanitizer_is_named_beside_it() -> None:
    document = run(3)
    document["sanitizers"] = [
        {
            "element": {"robot": "", "kind": "node", "name": "/filter"}, "category": "Video", "method": "drop",
            "stated": True, "reached": True, "leaves": [], "leaves_pseudonymised": [], "beside": [],
        }
    ]  # fmt: skip
    report = told(document)
    assert [number for _, number in report.inventory.cleanings[0].past] == [entry.number for entry in report.entries]


def test_the_elements_that_nothing_reaches_are_told_too() -> None:
    document = care()
    for text in texts(document):
        named = (node_of_service(element) or (element["robot"], element["name"]) for element in document["unreached"])
        assert all(name in text for _, name in named)  # all parameter services of a node are one
        assert all(row["element"]["name"] in text for row in document["carries"])
        assert all(row["enclave"] in text for row in document["enclaves"])
