"""Governance as DDS-Security 1.1, 9.4.1.2 has it."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.keystore.governance_file import Governance, read_governance
from tests.helpers.keystores import governance, topic_rule


def read(text: str) -> Governance:
    return read_governance(text.encode(), "governance.xml")


def test_the_first_topic_rule_that_matches_decides() -> None:
    found = read(governance(topic_rule("rt/a*", reading="false"), topic_rule("*", data="NONE", metadata="NONE"))).of(0)
    assert found
    first, second = found.of("rt/ab"), found.of("rt/b")
    assert first
    assert second
    assert (first.reading, first.writing, second.reading) == (False, True, True)
    assert (found.encrypted(first), found.encrypted(second)) == (True, False)


def test_a_domain_and_a_topic_without_a_rule_have_none() -> None:
    only = read(governance(topic_rule("rt/a")))
    assert only.of(1) is None
    of_zero = only.of(0)
    assert of_zero
    assert of_zero.of("rt/b") is None


@pytest.mark.parametrize("part", ["rtps", "metadata", "data"])
def test_one_of_three_protections_encrypts_what_is_sent(part: str) -> None:
    kinds = {"rtps": "SIGN", "metadata": "SIGN", "data": "SIGN"} | {part: "ENCRYPT"}
    rule = read(governance(topic_rule(metadata=kinds["metadata"], data=kinds["data"]), rtps=kinds["rtps"])).of(0)
    assert rule
    assert rule.encrypted(rule.topics[0])


def test_a_signature_hides_nothing() -> None:
    rule = read(governance(topic_rule(metadata="SIGN", data="SIGN"), rtps="SIGN_WITH_ORIGIN_AUTHENTICATION")).of(0)
    assert rule
    assert not rule.encrypted(rule.topics[0])


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("<domains><id>0</id></domains>", "", "<domain_rule> without <domains>"),
        ("ENCRYPT</data", "SECRET</data", "'SECRET' in <data_protection_kind>"),
        ("ENCRYPT</data", "SIGN_WITH_ORIGIN_AUTHENTICATION</data", "'SIGN_WITH_ORIGIN_AUTHENTICATION' in <data_pro"),
        ("true</enable_read", "maybe</enable_read", "'maybe' in <enable_read_access_control>"),
        ("<topic_expression>*</topic_expression>", "<topic_expression></topic_expression>", "<topic_expression> is em"),
        ("</topic_rule>", "</topic_rule><x/>", "<x> in <topic_access_rules>"),
    ],
)
def test_what_is_wrong_is_told(old: str, new: str, problem: str) -> None:
    with pytest.raises(InputErrors) as caught:
        read(governance().replace(old, new))
    assert any(problem in str(error) for error in caught.value.errors)


def test_upper_case_is_read_as_the_middlewares_do() -> None:
    rule = read(governance(topic_rule(reading="TRUE", writing="0"))).of(0)
    assert rule
    assert (rule.topics[0].reading, rule.topics[0].writing) == (True, False)
