"""Which channels others on the network can read, by a governance (rule S10; DDS-Security 1.1, 9.4.1.2)."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Exposure, Grant, Place, Policy, Profile, Protection, TopicProtection
from rosprivacy.ingest.deployed.exposures import exposed_channels
from rosprivacy.ingest.deployed.governance import protection, read_governance
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.names import DDS
from tests.helpers.keystores import governance, topic_rule

ENDS = {"publish": "/a", "subscribe": "/b"}


def policy(rules: Protection, *rights: tuple[str, str], file: str = "p.p7s", denied: tuple[str, ...] = ()) -> Policy:
    """Permissions of one enclave for each direction: (role, name of a DDS topic)."""
    profiles = tuple(Profile(node, node, Place(file, 1)) for node in ENDS.values())
    grants = [Grant(True, role, DDS, name, ENDS[role], ENDS[role], Place(file, 2), file, absolute=True, rank=2)
              for role, name in rights]  # fmt: skip
    grants += [Grant(False, "publish", DDS, name, "/a", "/a", Place(file, 3), file, absolute=True, rank=1)
               for name in denied]  # fmt: skip
    return Policy(file, (), profiles, tuple(grants), protections=(rules,))


def exposed(*policies: Policy) -> dict[str, list[str]]:
    """Channel, with its leg -> cause and line of each exposure."""
    graph = build(policies, "declared")
    found = exposed_channels(graph, policies)
    return {
        " ".join(filter(None, (graph.elements[v].name, graph.elements[v].leg))): [
            f"{e.cause} {e.place.line}" for e in e_s
        ]
        for v, e_s in found.items()
    }


def of(*topics: str, **domain: str) -> Protection:
    """What a governance says of its domain."""
    [rule] = read_governance(governance(*topics, **domain).encode(), "g.xml").rules
    return protection(rule)


def rules(*topics: tuple[str, bool], strangers: bool = False) -> Protection:
    said = (TopicProtection(name, encrypted, Place("g", line)) for line, (name, encrypted) in enumerate(topics, 10))
    return Protection(tuple(said), Place("g", 5) if strangers else None)


@pytest.mark.parametrize(
    ("rtps", "metadata", "data", "readable"),
    [
        ("NONE", "NONE", "NONE", True),
        ("SIGN", "SIGN", "SIGN", True),
        ("SIGN_WITH_ORIGIN_AUTHENTICATION", "SIGN_WITH_ORIGIN_AUTHENTICATION", "SIGN", True),
        ("ENCRYPT", "NONE", "NONE", False),
        ("ENCRYPT_WITH_ORIGIN_AUTHENTICATION", "NONE", "NONE", False),
        ("NONE", "ENCRYPT", "NONE", False),
        ("NONE", "ENCRYPT_WITH_ORIGIN_AUTHENTICATION", "SIGN", False),
        ("NONE", "NONE", "ENCRYPT", False),
    ],
)
def test_only_what_is_encrypted_is_hidden(rtps: str, metadata: str, data: str, *, readable: bool) -> None:
    said = of(topic_rule(metadata=metadata, data=data), rtps=rtps)
    assert bool(exposed(policy(said, ("publish", "rt/video")))) == readable


def test_what_sros2_makes_by_default_is_protected() -> None:
    """Its governance signs all and encrypts messages and data."""
    assert not exposed(policy(of(), ("publish", "rt/video"), ("subscribe", "rt/video")))


def test_rules_are_about_dds_topics_so_each_leg_of_a_service_has_its_own() -> None:
    said = rules(("rq/*", False), ("*", True))
    rights = ("publish", "rq/addRequest"), ("subscribe", "rr/addReply")
    assert exposed(policy(said, *rights)) == {"/add request": ["not-encrypted 10"]}


def test_a_part_of_an_action_counts_if_it_is_granted() -> None:
    said = rules(("rt/*/_action/feedback", False), ("*", True))
    status, feedback = ("publish", "rt/spin/_action/status"), ("publish", "rt/spin/_action/feedback")
    assert not exposed(policy(said, status))
    assert exposed(policy(said, status, feedback)) == {"/spin response": ["not-encrypted 10"]}


def test_a_wildcard_is_told_where_it_is_written_if_some_name_of_it_may_be_read() -> None:
    said = rules(("rt/a/*", False), ("*", True))
    both = policy(said, ("publish", "rt/*"), ("subscribe", "rt/*"))
    assert exposed(both) == {"/*": ["not-encrypted 10"]}
    assert not exposed(policy(said, ("publish", "rt/b*")))
    assert not exposed(policy(said, ("publish", "rt/*"), denied=("rt/a/*",)))


def test_what_one_of_several_governances_leaves_open_is_open() -> None:
    safe = policy(rules(("*", True)), ("subscribe", "rt/video"), ("publish", "rt/map"), file="b.p7s")
    assert list(exposed(policy(rules(("*", False)), ("publish", "rt/video")), safe)) == ["/video"]


def test_a_policy_without_a_governance_says_nothing_of_it() -> None:
    plain = policy(Protection(), ("publish", "rt/video"))
    assert not exposed(Policy(plain.file, (), plain.profiles, plain.grants))


names = st.text("ab", min_size=1, max_size=3).map(lambda name: f"rt/{name}")
expressions = st.one_of(names, st.text("ab*?", min_size=1, max_size=3).map(lambda name: f"rt/{name}"), st.just("*"))


@given(
    topics=st.lists(st.tuples(expressions, st.booleans()), min_size=1, max_size=4),
    plain=st.sets(names, min_size=1),
    patterns=st.sets(st.sampled_from(["rt/a*", "rt/*b", "rt/?", "rt/*"])),
    strangers=st.booleans(),
)
def test_equals_the_rules_asked_for_each_name(
    topics: list[tuple[str, bool]], plain: set[str], patterns: set[str], *, strangers: bool
) -> None:
    """Of plain names exactly; a wildcard is told if it is open for one of all short names, and not more than may be."""
    said = rules(*topics, strangers=strangers)

    def expected(name: str) -> set[Exposure]:
        first = next((rule for rule in said.topics if fnmatchcase(name, rule.expression)), None)
        if first is None:
            return set()
        found = {Exposure("strangers", said.strangers)} if said.strangers else set()
        return found | (set() if first.encrypted else {Exposure("not-encrypted", first.place)})

    one = policy(said, *(("publish", name) for name in sorted(plain | patterns)))
    graph = build([one], "declared")
    found = exposed_channels(graph, [one])
    short = [f"rt/{a}{b}{c}" for a in "ab" for b in ("", "a", "b") for c in ("", "a", "b")]
    for vertex, element in enumerate(graph.elements):
        if element.is_channel and not element.pattern:
            assert set(found.get(vertex, ())) == expected(f"rt{element.name}")
        elif element.is_channel and element.side == "write":
            inside = [expected(name) for name in short if fnmatchcase(name, f"rt{element.name}")]
            assert set().union(*inside) <= set(found.get(vertex, ()))
