"""The flow graph (rules S1 to S6): policies as lines of grants, graphs as sets of steps."""

from __future__ import annotations

from itertools import permutations, product

import pytest

from rosprivacy.analysis.model import Element, Flow, FlowGraph, Grant, Place, Policy, Profile
from rosprivacy.ingest.policies.flow_graph import build

KINDS = {"publish": "topic", "subscribe": "topic", "reply": "service", "request": "service"}
TALK = "/a publish /t\n/b subscribe /t"


def policy(text: str, file: str = "p.xml") -> Policy:
    """Lines as ``[enclave:]node [DENY] role name``; the enclave is ``/e`` if it is not written."""
    grants, profiles = [], []
    for line, written in enumerate(text.splitlines(), 1):
        owner, *denied, role, name = written.split()
        enclave, _, node = owner.rpartition(":")
        place = Place(file, line)
        kind = KINDS.get(role, "action")
        grants.append(Grant(not denied, role, kind, name, enclave or "/e", node, place))
        profiles.append(Profile(enclave or "/e", node, place))
    return Policy(file, ((file, "0"),), tuple(profiles), tuple(grants))


def graph(text: str, view: str = "declared") -> FlowGraph:
    return build([policy(text)], view)


def name(element: Element) -> str:
    parts = (element.name, element.leg, element.side, *(f"without {dds}" for dds in element.without))
    return " ".join(part for part in parts if part)


def ends(graph: FlowGraph, flow: Flow) -> tuple[str, str]:
    return name(graph.elements[flow.source]), name(graph.elements[flow.target])


def steps(graph: FlowGraph) -> set[tuple[str, str]]:
    return {ends(graph, flow) for flow in graph.flows}


def identities(graph: FlowGraph) -> set[tuple[str, str]]:
    assert all(element.identity[0] == "" for element in graph.elements)
    return {(element.kind, element.name) for element in graph.elements}


def reached(graph: FlowGraph, source: str) -> set[str]:
    edges = steps(graph)
    seen, waiting = {source}, [source]
    while waiting:
        here = waiting.pop()
        waiting += [b for a, b in edges if a == here and b not in seen]
        seen |= {b for a, b in edges if a == here}
    return seen


def test_a_publisher_reaches_a_subscriber_and_every_flow_keeps_its_line() -> None:
    result = graph(TALK)
    lines = {ends(result, flow): [str(grant.place) for grant in flow.grants] for flow in result.flows}
    assert lines == {("/a", "/t"): ["p.xml:1"], ("/t", "/b"): ["p.xml:2"]}


def test_a_node_and_a_topic_of_one_name_are_two_elements() -> None:
    """Rule S1."""
    assert identities(graph("/map publish /map")) == {("node", "/map"), ("topic", "/map")}


@pytest.mark.parametrize(("ask", "serve"), [("request", "reply"), ("call", "execute")])
def test_a_service_or_action_has_two_legs_and_nothing_goes_from_client_to_client(ask: str, serve: str) -> None:
    """Rule S2."""
    result = graph(f"/c1 {ask} /s\n/c2 {ask} /s\n/s1 {serve} /s\n/s2 {serve} /s")
    assert steps(result) == {
        ("/c1", "/s request"), ("/c2", "/s request"), ("/s request", "/s1"), ("/s request", "/s2"),
        ("/s1", "/s response"), ("/s2", "/s response"), ("/s response", "/c1"), ("/s response", "/c2"),
    }  # fmt: skip


def test_an_action_seen_through_its_parts_is_the_same_action() -> None:
    """Rule S3: what generate_policy writes meets what a person writes."""
    parts = "/s reply /go/_action/send_goal\n/s publish /go/_action/feedback"
    result = graph(f"/c call /go\n{parts}")
    assert identities(result) == {("node", "/c"), ("node", "/s"), ("action", "/go")}
    assert "/s" in reached(result, "/c")
    assert "/c" in reached(result, "/s")


ACTION = "/c call /go\n/s execute /go\n"
READ_ALL = "/r subscribe /*\n/r DENY subscribe /secret\n"


@pytest.mark.parametrize(
    ("text", "source", "target", "reaches"),
    [
        # S4: a wildcard reader gets what it matches and no more
        ("/a publish /x/1\n/b subscribe /x/*", "/a", "/b", True),
        ("/a publish /y\n/b subscribe /x/*", "/a", "/b", False),
        ("/a publish /a*\n/b subscribe /*b", "/a", "/b", True),
        ("/a publish /a*\n/b subscribe /b*", "/a", "/b", False),
        # … they match on DDS names: topic '*' covers an action's feedback, service '*' its requests
        (f"{ACTION}/spy subscribe /*", "/s", "/spy", True),
        (f"{ACTION}/spy subscribe /*", "/go request", "/spy", True),  # to the server, which publishes
        (f"{ACTION}/spy reply /*", "/c", "/spy", True),
        ("/a publish /*\n/b reply /*", "/a", "/b", False),
        # S5: a DENY takes a name out of a wildcard, for its own enclave only
        (f"{READ_ALL}f:/a publish /secret", "/a", "/r", False),
        (f"{READ_ALL}f:/b publish /open", "/b", "/r", True),
        (f"{READ_ALL}f:/q subscribe /*\nf:/a publish /secret", "/a", "/q", True),
        (f"{READ_ALL}f:/q subscribe /*\nf:/a publish /secret", "/a", "/r", False),
        ("/w publish /x*\nf:/r subscribe /*\nf:/r DENY subscribe /x*", "/w", "/r", False),
        # … one part of an action denied leaves status and result
        ("/s execute /go\n/s DENY publish /go/_action/feedback\nf:/c call /go", "/s", "/c", True),
    ],
)
def test_what_a_wildcard_reaches(text: str, source: str, target: str, *, reaches: bool) -> None:
    """Rules S4 and S5."""
    assert (target in reached(graph(text), source)) is reaches


def test_nothing_goes_from_one_name_to_another_through_a_wildcard() -> None:
    result = graph("/a publish /x/1\n/b subscribe /x/2\n/w publish /x/*\n/r subscribe /x/*")
    assert reached(result, "/a").isdisjoint({"/b", "/x/2"})
    assert "/r" in reached(result, "/a")
    assert "/b" in reached(result, "/w")


def test_the_goal_of_an_action_is_a_request_and_no_topic() -> None:
    assert ("/go request", "/* read") not in steps(graph(f"{ACTION}/spy subscribe /*"))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("/a publish /t\n/b DENY publish /t", set()),  # of another profile in the enclave too
        ("/a publish /x/1\n/a DENY publish /x/*", set()),
        ("/a subscribe /t\n/a DENY publish /t", {("/t", "/a")}),  # the other direction stays
        ("/a publish /t\nf:/a DENY publish /t", {("/a", "/t")}),  # and other enclaves
    ],
)
def test_deny_wins_over_allow_in_its_enclave(text: str, expected: set[tuple[str, str]]) -> None:
    """Rule S5."""
    assert steps(graph(text)) == expected


def test_a_denied_flow_names_both_lines() -> None:
    result = graph("/a publish /t\n/b DENY publish /t")
    (flow,) = result.denied
    assert ends(result, flow) == ("/a", "/t")
    assert [str(g.place) for g in (*flow.grants, *flow.denials)] == ["p.xml:1", "p.xml:2"]


def test_absent_means_not_granted_and_what_is_only_denied_is_there_to_be_seen() -> None:
    result = graph("/a DENY publish /t")
    assert (steps(result), result.denied) == (set(), ())
    assert ("topic", "/t") in identities(result)


class TestViews:
    """Rule S6."""

    TEXT = "/camera publish /video\n/uplink subscribe /blurred\n/blur subscribe /video\n/blur publish /blurred"

    def test_declared_holds_each_node_to_its_profile(self) -> None:
        assert ("/video", "/uplink") not in steps(graph(self.TEXT))

    def test_enforced_gives_each_node_what_its_enclave_may(self) -> None:
        pairs = set(product(["/camera", "/uplink", "/blur"], ["/video", "/blurred"]))
        assert steps(graph(self.TEXT, "enforced")) == pairs | {(topic, node) for node, topic in pairs}

    def test_enforced_contains_declared(self) -> None:
        text = f"{self.TEXT}\nf:/log subscribe /*\nf:/log DENY subscribe /video"
        assert steps(graph(text)) <= steps(graph(text, "enforced"))

    def test_a_node_alone_in_its_enclave_is_the_same_in_both(self) -> None:
        alone = "\n".join(f"{line.split()[0]}:{line}" for line in self.TEXT.splitlines())
        assert steps(graph(alone)) == steps(graph(alone, "enforced"))


def test_the_order_of_files_changes_nothing() -> None:
    """Rule S14."""
    texts = ("/a publish /t", "/b subscribe /*", "/c DENY subscribe /t\nf:/a request /s")
    files = [policy(text, f"{number}.xml") for number, text in enumerate(texts)]
    assert len({build(order) for order in permutations(files)}) == 1


@pytest.mark.parametrize("view", ["declared", "enforced"])
def test_reading_a_policy_twice_is_reading_it_once(view: str) -> None:
    assert build([policy(TALK)] * 2, view) == graph(TALK, view)
