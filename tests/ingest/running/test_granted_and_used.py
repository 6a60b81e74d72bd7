"""What is granted against what was seen: on random systems, by the rules taken one by one (S3 to S6, S16)."""

from __future__ import annotations

from dataclasses import replace
from fnmatch import fnmatchcase

from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Grant, Place, Policy, Profile, Seen
from rosprivacy.ingest.mitigation.deny_lines import with_denied
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.names import is_pattern
from rosprivacy.ingest.running.granted_and_used import usage

NODES, NAMES = ("/a", "/b", "/c"), ("/x", "/y", "/x*", "/*", "/y/z")
HOMES = {"/a": "/one", "/b": "/one", "/c": "/two"}
LINES = st.tuples(
    st.booleans(), st.sampled_from(("publish", "subscribe")), st.sampled_from(NAMES), st.sampled_from(NODES)
)
Lines = list[tuple[bool, str, str, str]]
SEEN = Seen(("text",), "2026-11-22T10:00:00Z", "2026-11-22T10:00:00Z")


def policy(lines: Lines, file: str) -> Policy:
    place = [Place(file, number) for number in range(1, len(lines) + 1)]
    grants = tuple(
        Grant(allow, role, "topic", name, HOMES[node], node, at, file)
        for (allow, role, name, node), at in zip(lines, place, strict=True)
    )
    return Policy(file, (), tuple(Profile(HOMES[node], node, Place(file, 0)) for node in NODES), grants)


def observed(lines: Lines) -> Policy:
    seen = policy([line for line in lines if not is_pattern(line[2])], "seen.xml")
    return replace(
        seen, grants=tuple(grant._replace(allow=True, enclave=grant.node, observation=SEEN) for grant in seen.grants)
    )


def flows(granted: Policy) -> set[tuple[str, str, str]]:
    """(node, role, topic) of what the flow graph of a policy has on plain names, wildcards taken through matches."""
    plain = [(True, role, name, node) for role in ("publish", "subscribe") for name in NAMES for node in NODES]
    found = set()
    for _, role, name, node in plain:
        if is_pattern(name):
            continue
        for grant in granted.grants:
            if not grant.allow or grant.node != node or grant.role != role:
                continue
            as_plain = grant._replace(name=name)
            one = replace(granted, grants=(as_plain, *(line for line in granted.grants if not line.allow)))
            covers = grant.name == name or (is_pattern(grant.name) and _glob(grant.name, name))
            if covers and build([one]).flows:
                found.add((node, role, name))
    return found


def _glob(pattern: str, name: str) -> bool:
    return fnmatchcase(name, pattern)


@given(st.lists(LINES, max_size=8), st.lists(LINES, max_size=6))
def test_what_is_not_granted_is_what_the_flow_graph_of_the_policy_lacks(granted: Lines, seen: Lines) -> None:
    ours, theirs = policy(granted, "granted.xml"), observed(seen)
    has = flows(ours)
    missing = {(use.grant.node, use.grant.role, use.grant.name) for use in usage([ours], [theirs]).not_granted}
    assert missing == {(g.node, g.role, g.name) for g in theirs.grants} - has


@given(st.lists(LINES, max_size=8), st.lists(LINES, max_size=6))
def test_the_lines_to_deny_take_nothing_that_was_seen_and_no_line_of_others(granted: Lines, seen: Lines) -> None:
    ours, theirs = policy(granted, "granted.xml"), observed(seen)
    found = usage([ours], [theirs])
    changed = with_denied([ours], found.to_deny)
    assert usage(changed, [theirs]).not_granted == found.not_granted
    others = {grant for grant in ours.grants if grant.allow} - set(found.to_deny)
    before = {(g.node, g.role, g.name) for g in others if not is_pattern(g.name)} & flows(ours)
    assert before <= flows(changed[0])
