"""Contexts make what data may reveal more exact, and never weaker (Article 9(1), C-184/20)."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.contexts import article9_in, revealed
from rosprivacy.analysis.model import ARTICLE_9_VERDICTS, CONTEXTS
from rosprivacy.ontology.vocabulary import load

PROVISION = {
    "care": "GDPR Art. 9(1) data concerning health",
    "worship": "GDPR Art. 9(1) religious or philosophical beliefs",
    "union": "GDPR Art. 9(1) trade union membership",
    "school": "GDPR Recital 38",
    "workplace": "GDPR Art. 88",
    "public-space": "GDPR Art. 35(3)(c)",
}


def test_the_closed_list_is_that_of_the_ontology() -> None:
    situations = {one.name for one in load().pointed.situations}
    assert situations == {"", *CONTEXTS}
    assert set(PROVISION) == set(CONTEXTS)


@pytest.mark.parametrize("context", CONTEXTS)
@pytest.mark.parametrize("kind", ["Video", "Voice", "PersonTrack", "Presence", "LaserScan", "EyeGaze", "HomeMap"])
def test_each_context_says_what_raw_data_may_reveal_there(kind: str, context: str) -> None:
    """What names no kind of data (Articles 35(3)(c) and 88, recital 38) can be revealed by none: it concerns them."""
    (said,) = revealed(load().categories[kind], [context])
    verdict = "may-reveal" if context in ("care", "worship", "union") else "concerns"
    assert (said.name, said.verdict, said.context) == (PROVISION[context], verdict, context)
    assert said.condition
    assert said.sources
    assert {"de", "fr"} <= set(said.translations)


@pytest.mark.parametrize("context", CONTEXTS)
def test_no_context_weakens_a_verdict(context: str) -> None:
    strength = ARTICLE_9_VERDICTS.index
    for category in load().categories.values():
        assert strength(article9_in(category, [context])) <= strength(category.article9) or category.article9 == "no"
        assert article9_in(category, ()) == category.article9


def test_a_kind_that_is_free_of_article_9_may_reveal_in_care() -> None:
    """What an operator types is no special category; beside a patient's bed it may tell of care."""
    category = load().categories["OperatorInput"]
    assert category.article9 == "no"
    assert article9_in(category, ["care"]) == "may-reveal"
    assert article9_in(category, ["school", "workplace", "public-space"]) == "no"


def test_what_is_special_anyway_is_not_said_again() -> None:
    assert [legal.name for legal in revealed(load().categories["Health"], CONTEXTS)] == []


def test_pointers_hold_of_narrower_kinds_and_not_of_broader_ones() -> None:
    """Law that is pointed at."""
    categories = load().categories
    assert "AI Act Art. 5(1)(f)" in categories["EmotionEstimate"].look_at
    assert "AI Act Annex III point 1" in categories["FaceTemplate"].look_at  # of Biometric
    assert "GDPR Art. 8" in categories["Age"].look_at
    assert "GDPR Art. 87" in categories["OfficialIdentifier"].look_at
    assert categories["PersonalData"].look_at == ()
