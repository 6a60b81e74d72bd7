"""What several reasons for one label come to (docs/suggestions.md)."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.model import Confidence, Element, Method, Place
from rosprivacy.analysis.suggesting.evidence import (
    CODE,
    CONDUIT,
    DATA_FLOW,
    DERIVATION,
    GROUNDS,
    HIDING,
    LEAK,
    NAMED,
    NEIGHBOUR,
    PACKAGE,
    ROLES,
    SANITIZER,
    SOURCE,
    TYPE,
    Evidence,
    SuggestedLabel,
)
from rosprivacy.analysis.suggesting.weighing import proposals

CERTAIN, LIKELY, MAY = Confidence
NODE = Element("node", "/n")
RULE = Place("rules.yaml", 1)


def said(role: str, *grounds: tuple[str, Confidence], kind: str = "Video") -> list[Evidence]:
    label = SuggestedLabel(NODE, role, kind, Method.DROP if role == SANITIZER else None)
    return [Evidence(label, ground, sure, f"its {ground}", RULE) for ground, sure in grounds]


def weighed(*evidence: Evidence, known: tuple[str, ...] = ()) -> Confidence:
    (one,) = proposals(evidence, known)
    return one.confidence


def test_the_surest_evidence_counts_and_stands_first() -> None:
    (one,) = proposals(said(SOURCE, (NAMED, MAY), (TYPE, CERTAIN), (PACKAGE, LIKELY)))
    assert one.confidence is CERTAIN
    assert [reason.ground for reason in one.evidence] == [TYPE, PACKAGE, NAMED]


@pytest.mark.parametrize(
    ("grounds", "expected"),
    [
        ([NAMED, TYPE], LIKELY),
        ([CODE, NAMED], LIKELY),
        ([NAMED], MAY),
        ([TYPE, DATA_FLOW], MAY),  # drawn from the types themselves
        ([NAMED, NEIGHBOUR], MAY),
    ],
)
def test_two_independent_grounds_that_agree_are_likely(grounds: list[str], expected: Confidence) -> None:
    assert weighed(*said(SOURCE, *((ground, MAY) for ground in grounds))) is expected


def test_two_reasons_of_one_ground_do_not_agree_with_each_other() -> None:
    one, other = said(SOURCE, (NAMED, MAY), (NAMED, MAY))
    assert weighed(one, other._replace(reason="another word of it")) is MAY


@pytest.mark.parametrize("role", [LEAK, DERIVATION])
def test_of_what_goes_out_and_of_what_is_made_nothing_agrees(role: str) -> None:
    """Two ways out are two; a package and the library that it stands on are one."""
    assert weighed(*said(role, (CODE, MAY), (NAMED, MAY))) is MAY


def test_agreement_never_makes_anything_certain() -> None:
    assert weighed(*said(SOURCE, *((ground, LIKELY) for ground in GROUNDS))) is LIKELY


@pytest.mark.parametrize("role", sorted(HIDING))
def test_what_could_hide_a_leak_is_may_unless_the_catalogue_says_so(role: str) -> None:
    others = [(ground, CERTAIN) for ground in GROUNDS if ground != PACKAGE]
    assert weighed(*said(role, *others)) is MAY
    assert weighed(*said(role, *others, (PACKAGE, MAY))) is MAY
    assert weighed(*said(role, *others, (PACKAGE, CERTAIN))) is LIKELY


@pytest.mark.parametrize("role", sorted(HIDING))
def test_what_takes_data_of_a_finding_away_is_may_whoever_says_so(role: str) -> None:
    catalogue = said(role, (PACKAGE, LIKELY))
    assert weighed(*catalogue, known=("Video",)) is (LIKELY if role == CONDUIT else MAY)
    assert weighed(*catalogue, known=("Voice",)) is LIKELY
    assert weighed(*said(role, (PACKAGE, LIKELY), kind=""), known=("Voice",)) is (LIKELY if role == CONDUIT else MAY)


def test_proposals_are_sorted_and_of_each_label_there_is_one() -> None:
    evidence = [*said(CONDUIT, (DATA_FLOW, MAY)), *said(SOURCE, (NAMED, MAY)), *said(SOURCE, (NAMED, MAY))]
    told = proposals(evidence)
    assert [one.label.role for one in told] == [SOURCE, CONDUIT]
    assert told == proposals(reversed(evidence))
    assert [len(one.evidence) for one in told] == [1, 1]
    assert set(ROLES) >= HIDING
