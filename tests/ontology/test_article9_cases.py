"""For each item of Article 9(1) a small system: one finding under it, and a near miss that is not.

``cases/article9``: one policy for all, a label file for each item, and what is to be found with the law that applies.
"""

from __future__ import annotations

import json
from typing import Any

import pytest

import rosprivacy
from rosprivacy.ontology.vocabulary import load
from tests.helpers.paths import TESTS

FOLDER = TESTS / "cases" / "article9"
ITEMS = sorted(path.stem for path in FOLDER.glob("*.json"))


def expected(item: str) -> dict[str, Any]:
    document: dict[str, Any] = json.loads((FOLDER / f"{item}.json").read_text("utf-8"))
    return document


def test_there_is_a_system_for_each_item() -> None:
    provisions = {legal.name for category in load().categories.values() for legal in category.law}
    assert {expected(item)["item"] for item in ITEMS} == {
        name for name in provisions if name.startswith("GDPR Art. 9(1) ")
    }


@pytest.mark.parametrize("item", ITEMS)
def test_the_finding_is_under_the_item_and_the_near_miss_is_not(item: str) -> None:
    under = {
        finding["category"]: [
            legal["verdict"] for legal in finding["law"] if legal["provision"] == expected(item)["item"]
        ]
        for finding in expected(item)["findings"]
    }
    hits = [finding["category"] for finding in expected(item)["findings"] if finding["under_the_item"]]
    assert len(hits) == 1
    assert len(under) > 1
    for category, verdicts in under.items():
        assert verdicts in ([["always"], ["conditional"]] if category in hits else [[], ["may-reveal"]])


@pytest.mark.parametrize("item", ITEMS)
def test_the_ontology_says_so(item: str) -> None:
    for finding in expected(item)["findings"]:
        category = load().categories[finding["category"]]
        stated = [{"provision": legal.name, "verdict": legal.verdict} for legal in category.law]
        assert stated == finding["law"]
        assert all(bool(legal.condition) == (legal.verdict != "always") for legal in category.law)


@pytest.mark.parametrize("item", ITEMS)
def test_the_analysis_finds_both(item: str) -> None:
    result = rosprivacy.analyze([str(FOLDER / "system.policy.xml")], [str(FOLDER / f"{item}.labels.yaml")])
    document = result.document()
    assert [finding["category"] for finding in document["findings"]] == [
        f["category"] for f in expected(item)["findings"]
    ]
    assert document["open"] == []
    shown = [[{k: legal[k] for k in ("provision", "verdict")} for legal in f["law"]] for f in document["findings"]]
    assert shown == [f["law"] for f in expected(item)["findings"]]
    turned = {f["category"]: bool(f["special_from"]) for f in document["findings"]}
    made_there = {c for c, special in turned.items() if special}
    assert made_there <= {f["category"] for f in expected(item)["findings"] if f["under_the_item"]}
