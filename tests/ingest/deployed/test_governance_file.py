"""Governance as DDS-Security 1.1, 9.4.1.2 has it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import ACCESS_GAP
from rosprivacy.ingest.deployed.deployed_inputs import read_deployed
from rosprivacy.ingest.deployed.governance import Governance, governed, read_governance, ungoverned
from tests.helpers.keystores import governance, grant, joined, permissions, rule, topic_rule

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.analysis.model import Diagnostic
    from rosprivacy.ingest.deployed.security_xml import Domains


def read(text: str) -> Governance:
    return read_governance(text.encode(), "governance.xml")


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
    (rule,) = read(governance(topic_rule(reading="TRUE", writing="0"))).rules
    assert (rule.topics[0].reading, rule.topics[0].writing) == (True, False)


FROM_SEVEN = "<id_range><min>7</min></id_range>"
"""To Fast DDS and Cyclone DDS one domain, in the standard all from there on."""


def remarks(tmp_path: Path, of_governance: str, domains: str, domain: int | None = None) -> list[Diagnostic]:
    text = permissions(grant("/c", rule("allow", publish=("rt/a",), domains=domains)))
    for name, what in (("governance.xml", of_governance), ("permissions.xml", text)):
        (tmp_path / name).write_text(what)
    names = [str(tmp_path / name) for name in ("governance.xml", "permissions.xml")]
    return list(read_deployed(names, domain, "2026-11-22", allow_unsigned=True)[1])


def two_rules(first: str, second: str) -> str:
    """A governance whose rules ask for permissions, then do not."""
    return joined(governance(domains=first), governance(topic_rule(reading="false"), domains=second))


@pytest.mark.parametrize(
    ("first", "domain", "leaves_open"),
    [
        (FROM_SEVEN, 7, False),
        (FROM_SEVEN, 8, True),  # the first rule may not be about it, so it does not protect it
        (FROM_SEVEN, 6, True),
        ("<id_range><min>7</min><max>9</max></id_range>", 8, False),
        (f"{FROM_SEVEN}<id>8</id>", 8, False),
        ("<id_range><max>9</max></id_range>", 8, False),
    ],
)
def test_a_rule_that_is_perhaps_about_a_domain_hides_no_later_one(
    tmp_path: Path, first: str, domain: int, *, leaves_open: bool
) -> None:
    text = two_rules(first, "<id_range><min>0</min><max>230</max></id_range>")
    said = remarks(tmp_path, text, "<id_range><min>0</min><max>230</max></id_range>", domain)
    assert [one.code for one in said if "not asked" in one.message] == ([ACCESS_GAP] if leaves_open else [])
    assert any("<id_range> without <max>" in one.message for one in said) == (FROM_SEVEN in first and domain >= 7)


DOMAINS = st.integers(0, 4)
RANGES = st.one_of(
    DOMAINS.map(lambda at: f"<id>{at}</id>"),
    DOMAINS.map(lambda at: f"<id_range><min>{at}</min></id_range>"),
    DOMAINS.map(lambda at: f"<id_range><max>{at}</max></id_range>"),
    st.tuples(DOMAINS, DOMAINS).map(lambda ends: f"<id_range><min>{min(ends)}</min><max>{max(ends)}</max></id_range>"),
)


@given(st.lists(st.lists(RANGES, min_size=1, max_size=2).map("".join), min_size=1, max_size=4), DOMAINS)
def test_of_each_reading_the_rule_that_decides_is_among_those_that_may(written: list[str], domain: int) -> None:
    found = read(joined(*(governance(domains=domains) for domains in written)))
    may = [one.rule for one in governed(found, ((domain, domain),))]
    readings: tuple[Callable[[Domains], bool], ...] = (lambda one: domain in one, lambda one: one.surely(domain))
    for about in readings:
        decides = next((rule for rule in found.rules if about(rule.domains)), None)
        assert decides is None or decides in may
    surely = any(rule.domains.surely(domain) for rule in found.rules)
    assert surely == (ungoverned([found], ((domain, domain),)) == ())


def test_a_domain_of_which_no_rule_is_surely_about_is_a_gap(tmp_path: Path) -> None:
    only = governance(domains=FROM_SEVEN)
    assert [one.code for one in remarks(tmp_path, only, "<id>8</id>") if one.code] == [ACCESS_GAP]
    assert not [one for one in remarks(tmp_path, only, "<id>7</id>") if one.code]


def test_all_domains_of_permissions_count_not_the_first_of_a_range(tmp_path: Path) -> None:
    text = two_rules("<id>0</id>", "<id_range><min>1</min><max>9</max></id_range>")
    wide, first = "<id_range><min>0</min><max>9</max></id_range>", "<id>0</id>"
    assert any("not asked" in one.message for one in remarks(tmp_path, text, wide))
    assert not any("not asked" in one.message for one in remarks(tmp_path, text, first))
