"""Permissions as DDS-Security 1.1, 9.4.1.3 has them: each row is one sentence of it, or of what a middleware does."""

from __future__ import annotations

import re
from datetime import datetime, timezone

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.deployed.permissions import Permissions, policy_of, read_permissions
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.names import DDS, dds_names, endpoints
from tests.helpers.keystores import grant, permissions, rule
from tests.helpers.permission_oracle import may

LINE = re.compile(r"[^;]+: .+; .+")  # file:line: what is wrong; what to do
NAMES = ("rt/a", "rt/ab", "rq/aRequest", "rr/aReply", "Square", "rt/a/_action/status")
EXPRESSIONS = (*NAMES, "*", "rt/*", "rt/a?", "rt/[ab]", "r?/a*", "rq/*Request")


def read(text: str) -> Permissions:
    return read_permissions(text.encode(), "permissions.xml")


def refused(text: str) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        read(text)
    assert all(LINE.fullmatch(line) for line in str(caught.value).split("\n"))
    return [error.problem for error in caught.value.errors]


def said(text: str, domain: int | None = None) -> list[str]:
    return [d.message for d in policy_of(read(text), domain, ()).diagnostics]


ALLOW = rule("allow", publish=("rt/a",))


def test_a_grant_has_subject_dates_rules_and_a_default() -> None:
    [one] = read(permissions(grant("/camera", rule("deny", subscribe=("rt/b",)), ALLOW, default="ALLOW"))).grants
    assert (one.subject, one.allow, [r.allow for r in one.rules]) == ("CN=/camera", True, [False, True])
    assert (one.not_before, one.not_after) == (
        datetime(2020, 1, 1, tzinfo=timezone.utc),
        datetime(2060, 1, 1, tzinfo=timezone.utc),
    )


@pytest.mark.parametrize(
    ("written", "moment"),
    [
        ("2026-01-31T00:00:00", datetime(2026, 1, 31, tzinfo=timezone.utc)),
        ("2026-01-31T01:00:00+01:00", datetime(2026, 1, 31, tzinfo=timezone.utc)),
        ("2035-06-27T03:13:14.908199+00:00", datetime(2035, 6, 27, 3, 13, 14, tzinfo=timezone.utc)),
        ("2026-01-31T00:00:00Z", datetime(2026, 1, 31, tzinfo=timezone.utc)),
    ],
)
def test_a_moment_without_a_zone_is_utc(written: str, moment: datetime) -> None:
    text = permissions(grant("/c", ALLOW)).replace("2060-01-01T00:00:00", written)
    assert read(text).grants[0].not_after == moment


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("<dds>", "<policy>", "not well-formed"),
        ("<permissions>", "<permissions><x/>", "<x> in <permissions>"),
        ("<subject_name>CN=/c</subject_name>", "", "<grant> without <subject_name>"),
        ("<default>DENY</default>", "<default>MAYBE</default>", "'MAYBE' in <default>"),
        ("<default>DENY</default>", "", "<grant> without <default>"),
        ("<id>0</id>", "<id>-1</id>", "'-1' in <id>"),
        ("<id>0</id>", "<id_range><min>5</min><max>2</max></id_range>", "<id_range> that holds no domain"),
        ("<id>0</id>", "", "<domains> is empty"),
        ("<topic>rt/a</topic>", "<topic></topic>", "<topic> without a name"),
        ("<topic>rt/a</topic>", "", "<topics> is empty"),
        ("2020-01-01T00:00:00", "yesterday", "'yesterday' in <not_before>"),
    ],
)
def test_what_is_wrong_is_told_at_its_line(old: str, new: str, problem: str) -> None:
    assert any(problem in one for one in refused(permissions(grant("/c", ALLOW)).replace(old, new, 1)))


def test_another_document_is_refused() -> None:
    assert refused("<policy/>") == ["the root element is <policy>, not <dds>"]
    assert "<domain_access_rules> in <dds>" in refused("<dds><domain_access_rules/></dds>")
    assert refused('<!DOCTYPE d [<!ENTITY x SYSTEM "file:///etc/passwd">]><dds>&x;</dds>')


def test_partitions_narrow_no_allow_and_make_a_deny_take_nothing() -> None:
    text = permissions(grant("/c", rule("deny", publish=("rt/b",)), rule("allow", publish=("*",))))
    text = text.replace("</topics>", "</topics><partitions><partition>p</partition></partitions>")
    [one] = read(text).grants
    assert may(one, 0, "publish", "rt/b")
    assert [message.split(";")[1] for message in said(text)] == [
        " it is taken to deny nothing",
        " it is taken to allow them there",
    ]


def test_data_tags_are_told_since_no_middleware_of_ros_looks_at_them() -> None:
    tags = "</topics><data_tags><tag><name>n</name><value>v</value></tag></data_tags>"
    text = permissions(grant("/c", ALLOW)).replace("</topics>", tags)
    [message] = said(text)
    assert message.startswith("<data_tags>: Fast DDS and Cyclone DDS do not look at them, so they allow more than")


def test_rules_for_several_domains_need_a_domain() -> None:
    text = permissions(grant("/c", ALLOW, rule("allow", publish=("rt/b",), domains="<id>7</id>")))
    with pytest.raises(InputErrors, match="say which with --domain N"):
        policy_of(read(text), None, ())
    assert [g.name for g in policy_of(read(text), 7, ()).grants] == ["rt/b"]
    assert said(text, 3) == ["grant of CN=/c has no rule for domain 3: it cannot join it"]


@pytest.mark.parametrize(("domain", "wins"), [(7, "deny"), (8, "allow")])
def test_a_range_without_an_end_allows_from_there_on_and_denies_its_first_domain_only(domain: int, wins: str) -> None:
    """The standard has it open-ended, Fast DDS and Cyclone DDS read one domain; in doubt it is allowed (S5, S11)."""
    domains = "<id_range><min>7</min></id_range>"
    names = rule("deny", publish=("rt/a",), domains=domains), rule("allow", publish=("rt/*",), domains=domains)
    text = permissions(grant("/c", *names))
    assert [g.allow for g in policy_of(read(text), domain, ()).grants] == ([False, True] if wins == "deny" else [True])
    taken = [message.split("; ")[1] for message in said(text, domain)]
    assert taken == ([] if wins == "deny" else ["it is taken to deny nothing there", "it is taken to allow there"])
    assert [g.allow for g in policy_of(read(text), None, ()).grants] == [False, True]  # both hold, or neither


@pytest.mark.parametrize(("domain", "allowed"), [(1, False), (2, True), (5, True), (6, False), (9, True)])
def test_a_rule_is_about_its_domains_and_ranges(domain: int, *, allowed: bool) -> None:
    domains = "<id>9</id><id_range><min>2</min><max>5</max></id_range>"
    [one] = read(permissions(grant("/c", rule("allow", publish=("rt/a",), domains=domains)))).grants
    assert (domain in one.rules[0].domains, one.rules[0].domains.surely(domain)) == (allowed, allowed)


def test_a_second_grant_of_a_subject_allows_and_denies_nothing() -> None:
    text = permissions(grant("/c", ALLOW), grant("/c", rule("deny", publish=("rt/a",))))
    policy = policy_of(read(text), None, ())
    assert [(g.allow, g.dead) for g in policy.grants] == [(True, False), (False, True)]
    assert "second grant for /c" in policy.diagnostics[0].message
    assert len(build([policy]).flows) == 1


rules = st.lists(
    st.builds(
        rule,
        st.sampled_from(("allow", "deny")),
        st.lists(st.sampled_from(EXPRESSIONS), max_size=3).map(tuple),
        st.lists(st.sampled_from(EXPRESSIONS), max_size=3).map(tuple),
    ),
    min_size=1,
    max_size=4,
)


@given(rules, st.sampled_from(("ALLOW", "DENY")))
def test_the_graph_says_of_each_topic_what_the_first_rule_says(rules: list[str], default: str) -> None:
    every = grant("/every", rule("allow", publish=NAMES, subscribe=NAMES))
    read_back = read(permissions(grant("/c", *rules, default=default), every))
    graph = build([policy_of(read_back, None, ())])
    ends = {(graph.elements[f.source], graph.elements[f.target]) for f in graph.flows}
    node = next(e for e in graph.elements if e.name == "/c")
    written = {b for a, b in ends if a == node} | {
        c for a, b in ends if a == node and b.pattern for d, c in ends if d == b
    }
    got = {a for a, b in ends if b == node} | {a for a, b in ends if b.pattern and (b, node) in ends}
    for name in NAMES:
        channel = _channel(name)
        for direction, reached in (("publish", written), ("subscribe", got)):
            allowed = any(may(read_back.grants[0], 0, direction, dds) for dds in dds_names(*channel))
            assert (channel in {(e.kind, e.name, e.leg) for e in reached if not e.pattern}) == allowed


def _channel(dds: str) -> tuple[str, str, str]:
    end = endpoints("publish", DDS, dds)[0]
    return (end.kind, end.name, end.leg)
