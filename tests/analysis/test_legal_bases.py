"""Which legal bases an acceptance lacks: Articles 6, 9(2), 9(3), 10 and chapter V of the GDPR."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.legal import gaps, recognises
from rosprivacy.analysis.model import DISCLOSURE, THIRD_COUNTRY
from rosprivacy.ontology.vocabulary import load

SIX, NINE = "Article 6(1)", "Article 9(2)"


def lacks(bases: list[str], category: str, kind: str = DISCLOSURE) -> list[str]:
    law = {category: tuple((legal.name, legal.verdict) for legal in load().categories[category].law)}
    return [str(gap) for gap in gaps(bases, [(kind, category)], law)]


@pytest.mark.parametrize(
    ("bases", "category", "expected"),
    [
        (["6(1)(f)"], "LicencePlate", []),
        ([], "LicencePlate", [SIX]),
        (["6(4)"], "LicencePlate", [SIX]),
        (["6(1)(f)"], "FaceTemplate", [NINE]),
        (["9(2)(b)"], "FaceTemplate", [SIX]),
        (["6(1)(c)", "9(2)(b)"], "FaceTemplate", []),
        ([], "FaceTemplate", [SIX, NINE]),
        (["6(1)(f)"], "CommunicationContent", [NINE]),  # what may reveal such data
        (["6(1)(c)", "9(2)(h)"], "VitalSign", ["9(3)"]),
        (["6(1)(c)", "9(2)(h)", "9(3)"], "VitalSign", []),
        (["6(1)(f)"], "CriminalConviction", ["Article 10"]),
        (["6(1)(f)", "10"], "CriminalConviction", []),
    ],
)
def test_what_is_missing_is_said(bases: list[str], category: str, expected: list[str]) -> None:
    said = lacks(bases, category)
    assert len(said) == len(expected)
    assert all(what in line for what, line in zip(expected, said, strict=True))


def test_what_can_fall_under_article_9_and_what_may_reveal_it_are_told_apart() -> None:
    assert "FaceTemplate can fall under GDPR Art. 9(1) biometric data" in lacks(["6(1)(f)"], "FaceTemplate")[0]
    assert "Video may reveal what is named in GDPR Art. 9(1)" in lacks(["6(1)(f)"], "Video")[0]


@pytest.mark.parametrize("basis", ["45", "46(2)(c)", "46(3)", "47"])
def test_only_chapter_v_permits_a_transfer(basis: str) -> None:
    (line,) = lacks(["6(1)(f)"], "LicencePlate", THIRD_COUNTRY)
    assert line == (
        "is about a transfer out of the EEA and states no basis of chapter V (45, 46, 47 or 49), which Article 6 is not"
    )
    assert lacks(["6(1)(f)", basis], "LicencePlate", THIRD_COUNTRY) == []


def test_who_makes_what_article_5_of_the_ai_act_speaks_of_recognises_persons_and_of_article_50_not() -> None:
    """A node that understands spoken commands only tells persons that they deal with an AI system (Article 50(1))."""
    kinds = load().categories
    assert all(recognises(kinds[name]) for name in ("EmotionEstimate", "SkinTone", "WatchListMatch"))
    for name in ("VoiceCommand", "InteractionLog"):
        assert any(provision.startswith("AI Act Art. 50") for provision in kinds[name].look_at)
        assert not recognises(kinds[name])


def test_a_derogation_alone_is_asked_about() -> None:
    """Article 49 is for specific situations; recital 111."""
    (line,) = lacks(["6(1)(f)", "49(1)(b)"], "LicencePlate", THIRD_COUNTRY)
    assert line == "rests on a derogation (Article 49) for a transfer out of the EEA: is it occasional?"
    assert lacks(["6(1)(f)", "46(2)(c)", "49(1)(b)"], "LicencePlate", THIRD_COUNTRY) == []
    assert lacks(["6(1)(f)", "49(1)(b)"], "LicencePlate") == []
