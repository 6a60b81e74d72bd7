"""What the law says of categories, closed over the hierarchy; where data become a special category on the way."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.legal import turned_special
from rosprivacy.analysis.model import Category, Legal
from rosprivacy.ontology.vocabulary import Vocabulary, load
from tests.helpers.graphs import care_home

BIOMETRIC = "GDPR Art. 9(1) biometric data"
HEALTH = "GDPR Art. 9(1) data concerning health"
WHOLE = "GDPR Art. 9(1)"


def law(name: str, verdict: str = "always", condition: str = "") -> Legal:
    return Legal(f"urn:test:{name}", name, "meaning", "2026-01-01", verdict, condition)


def vocabulary(**rows: tuple[tuple[str, ...], tuple[Legal, ...], str]) -> Vocabulary:
    """Name -> (broader, law, reason)."""
    return Vocabulary.of(
        Category(name, f"urn:test:{name}", name, name.lower(), name, up, law=said, reason=reason)
        for name, (up, said, reason) in rows.items()
    )


def said(found: Vocabulary, name: str) -> set[tuple[str, str, str]]:
    return {(legal.name, legal.verdict, legal.stated_of) for legal in found.categories[name].law}


class TestClosure:
    def test_what_states_nothing_takes_what_is_stated_of_the_nearest_broader(self) -> None:
        found = vocabulary(
            A=((), (law(WHOLE, "may-reveal"),), ""),
            B=(("A",), (law(BIOMETRIC),), ""),
            C=(("B",), (), ""),
            D=(("C",), (), ""),
        )
        assert said(found, "D") == {(BIOMETRIC, "always", "B")}
        assert found.categories["D"].article9 == "always"

    def test_what_states_something_takes_nothing(self) -> None:
        found = vocabulary(A=((), (law(BIOMETRIC),), ""), B=(("A",), (), "not processed for it"))
        assert said(found, "B") == set()
        assert found.categories["B"].article9 == "no"

    def test_of_two_broader_ones_both_are_taken(self) -> None:
        found = vocabulary(
            A=((), (law(BIOMETRIC),), ""), B=((), (law(HEALTH, "conditional", "c"),), ""), C=(("A", "B"), (), "")
        )  # fmt: skip
        assert said(found, "C") == {(BIOMETRIC, "always", "A"), (HEALTH, "conditional", "B")}
        assert found.categories["C"].article9 == "always"

    def test_a_broad_kind_may_be_its_narrower_one(self) -> None:
        """Rule S7: what is called a location may be a room number in a hospital."""
        found = vocabulary(A=((), (), "no"), B=(("A",), (law(HEALTH),), ""), C=(("B",), (), ""))
        assert said(found, "A") == {(HEALTH, "may-reveal", "B, C")}
        assert found.categories["A"].article9 == "may-reveal"
        assert found.categories["A"].law[0].condition == "if the data are of a narrower kind: b, c"

    def test_what_is_stated_of_the_whole_article_is_not_said_again_item_by_item(self) -> None:
        found = vocabulary(A=((), (law(WHOLE, "may-reveal"),), ""), B=(("A",), (law(HEALTH), law("GDPR Art. 10")), ""))
        assert said(found, "A") == {(WHOLE, "may-reveal", "A"), ("GDPR Art. 10", "may-reveal", "B")}

    def test_nothing_stated_anywhere_is_not_known_and_not_no(self) -> None:
        found = vocabulary(A=((), (), ""), B=(("A",), (), ""))
        assert found.categories["B"].article9 == "unknown"

    def test_closing_twice_changes_nothing(self) -> None:
        small = vocabulary(
            A=((), (law(HEALTH),), ""), B=(("A",), (), "why not"), C=(("B",), (), ""), D=(("A",), (), "")
        )
        for once in (load(), small):
            assert Vocabulary.of(once.categories.values()).categories == once.categories


@pytest.fixture(scope="module")
def found() -> dict[str, str | None]:
    result = care_home()
    known = result.vocabulary.categories
    turned = {f.category: turned_special(f, known) for f in result.analysis.findings}
    return {category: element.name if element else None for category, element in turned.items()}


class TestTurnedSpecial:
    def test_the_recogniser_makes_face_templates_of_video(self, found: dict[str, str | None]) -> None:
        assert found["FaceTemplate"] == "/face_recognizer"

    def test_video_of_persons_and_voice_are_not_turned(self, found: dict[str, str | None]) -> None:
        assert (found["Video"], found["Voice"]) == (None, None)
