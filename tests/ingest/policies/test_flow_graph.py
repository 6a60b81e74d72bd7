"""The flow graph (rules S1 to S6): policies as rows of grants, graphs as sets of steps."""

from __future__ import annotations

from itertools import permutations

import pytest

from rosprivacy.analysis.model import Element, FlowGraph, Grant, Place, Policy, Profile
from rosprivacy.ingest.policies.flow_graph import build

KINDS = {"publish": "topic", "subscribe": "topic", "reply": "service", "request": "service"}
Row = tuple[str, str, str, str]  # enclave, node, role (DENY before it, if so), name


def policy(*rows: Row, file: str = "p.xml") -> Policy:
    grants, profiles = [], []
    for line, (enclave, node, role, name) in enumerate(rows, 1):
        verb = role.removeprefix("DENY ")
        kind = KINDS.get(verb, "action")
        place = Place(file, line)
        grants.append(Grant(not role.startswith("DENY"), verb, kind, name, enclave, node, place))
        profiles.append(Profile(enclave, node, place))
    return Policy(file, ((file, "0"),), tuple(profiles), tuple(grants))


def name(element: Element) -> str:
    parts = (element.name, element.leg, element.side, *(f"without {dds}" for dds in element.without))
    return " ".join(part for part in parts if part)


def steps(graph: FlowGraph) -> set[tuple[str, str]]:
    return {(name(graph.elements[f.source]), name(graph.elements[f.target])) for f in graph.flows}


def denied(graph: FlowGraph) -> set[tuple[str, str]]:
    return {(name(graph.elements[f.source]), name(graph.elements[f.target])) for f in graph.denied}


def reaches(graph: FlowGraph, source: str, target: str) -> bool:
    edges = steps(graph)
    seen, waiting = {source}, [source]
    while waiting:
        here = waiting.pop()
        waiting += [b for a, b in edges if a == here and b not in seen]
        seen |= {b for a, b in edges if a == here}
    return target in seen


def test_a_publisher_reaches_a_subscriber() -> None:
    graph = build([policy(("/e", "/a", "publish", "/t"), ("/e", "/b", "subscribe", "/t"))])
    assert steps(graph) == {("/a", "/t"), ("/t", "/b")}


def test_a_node_and_a_topic_of_one_name_are_two_elements() -> None:
    """Rule S1."""
    graph = build([policy(("/e", "/map", "publish", "/map"))])
    assert {e.identity for e in graph.elements} == {("", "node", "/map"), ("", "topic", "/map")}


def test_a_service_has_two_legs_and_nothing_goes_from_client_to_client() -> None:
    """Rule S2."""
    rows = [("/e", n, r, "/s") for n, r in (("/c1", "request"), ("/c2", "request"), ("/s1", "reply"), ("/s2", "reply"))]
    graph = build([policy(*rows)])
    assert steps(graph) == {
        ("/c1", "/s request"), ("/c2", "/s request"), ("/s request", "/s1"), ("/s request", "/s2"),
        ("/s1", "/s response"), ("/s2", "/s response"), ("/s response", "/c1"), ("/s response", "/c2"),
    }  # fmt: skip


def test_an_action_has_two_legs() -> None:
    graph = build([policy(("/e", "/c", "call", "/go"), ("/e", "/s", "execute", "/go"))])
    assert steps(graph) == {
        ("/c", "/go request"),
        ("/go request", "/s"),
        ("/s", "/go response"),
        ("/go response", "/c"),
    }


def test_an_action_seen_through_its_parts_is_the_same_action() -> None:
    """Rule S3: what generate_policy writes meets what a person writes."""
    rows: list[Row] = [
        ("/e", "/c", "call", "/go"),
        ("/e", "/s", "reply", "/go/_action/send_goal"),
        ("/e", "/s", "publish", "/go/_action/feedback"),
    ]
    graph = build([policy(*rows)])
    assert {e.identity for e in graph.elements} == {("", "node", "/c"), ("", "node", "/s"), ("", "action", "/go")}
    assert reaches(graph, "/c", "/s")
    assert reaches(graph, "/s", "/c")


def test_every_flow_keeps_its_line() -> None:
    graph = build([policy(("/e", "/a", "publish", "/t"), ("/e", "/b", "subscribe", "/t"))])
    assert [[str(g.place) for g in flow.grants] for flow in graph.flows] == [["p.xml:1"], ["p.xml:2"]]


class TestWildcards:
    """Rule S4."""

    def test_a_wildcard_reader_gets_what_it_matches_and_no_more(self) -> None:
        graph = build(
            [policy(("/e", "/a", "publish", "/x/1"), ("/e", "/a", "publish", "/y"), ("/e", "/b", "subscribe", "/x/*"))]
        )
        assert ("/x/1", "/x/* read") in steps(graph)
        assert ("/y", "/x/* read") not in steps(graph)

    def test_a_wildcard_writer_reaches_a_wildcard_reader(self) -> None:
        graph = build([policy(("/e", "/a", "publish", "/a*"), ("/e", "/b", "subscribe", "/*b"))])
        assert reaches(graph, "/a", "/b")
        graph = build([policy(("/e", "/a", "publish", "/a*"), ("/e", "/b", "subscribe", "/b*"))])
        assert not reaches(graph, "/a", "/b")

    def test_nothing_goes_from_one_name_to_another_through_a_wildcard(self) -> None:
        rows: list[Row] = [
            ("/e", "/a", "publish", "/x/1"),
            ("/e", "/b", "subscribe", "/x/2"),
            ("/e", "/w", "publish", "/x/*"),
            ("/e", "/r", "subscribe", "/x/*"),
        ]
        graph = build([policy(*rows)])
        assert not reaches(graph, "/a", "/b")
        assert reaches(graph, "/a", "/r")
        assert reaches(graph, "/w", "/b")

    def test_they_match_on_dds_names(self) -> None:
        """Topic '*' covers an action's feedback, service '*' its requests."""
        action: list[Row] = [("/e", "/c", "call", "/go"), ("/e", "/s", "execute", "/go")]
        graph = build([policy(*action, ("/e", "/spy", "subscribe", "/*"))])
        assert reaches(graph, "/s", "/spy")
        assert ("/go request", "/* read") not in steps(graph)  # the goal is a request, no topic
        graph = build([policy(*action, ("/e", "/spy", "reply", "/*"))])
        assert reaches(graph, "/c", "/spy")

    def test_topic_and_service_wildcards_do_not_meet(self) -> None:
        graph = build([policy(("/e", "/a", "publish", "/*"), ("/e", "/b", "reply", "/*"))])
        assert not reaches(graph, "/a", "/b")


class TestDeny:
    """Rule S5."""

    def test_it_wins_over_allow_of_another_profile_in_the_enclave_and_both_lines_are_named(self) -> None:
        graph = build([policy(("/e", "/a", "publish", "/t"), ("/e", "/b", "DENY publish", "/t"))])
        assert steps(graph) == set()
        assert denied(graph) == {("/a", "/t")}
        (flow,) = graph.denied
        assert [str(g.place) for g in (*flow.grants, *flow.denials)] == ["p.xml:1", "p.xml:2"]

    def test_it_leaves_the_other_direction(self) -> None:
        graph = build([policy(("/e", "/a", "subscribe", "/t"), ("/e", "/a", "DENY publish", "/t"))])
        assert steps(graph) == {("/t", "/a")}

    def test_it_does_not_reach_into_other_enclaves(self) -> None:
        graph = build([policy(("/e", "/a", "publish", "/t"), ("/f", "/a", "DENY publish", "/t"))])
        assert steps(graph) == {("/a", "/t")}

    def test_a_wildcard_denies_the_names_that_it_matches(self) -> None:
        graph = build([policy(("/e", "/a", "publish", "/x/1"), ("/e", "/a", "DENY publish", "/x/*"))])
        assert steps(graph) == set()

    def test_a_name_is_taken_out_of_a_wildcard(self) -> None:
        rows: list[Row] = [
            ("/e", "/r", "subscribe", "/*"),
            ("/e", "/r", "DENY subscribe", "/secret"),
            ("/f", "/a", "publish", "/secret"),
            ("/f", "/b", "publish", "/open"),
        ]
        graph = build([policy(*rows)])
        assert not reaches(graph, "/a", "/r")
        assert reaches(graph, "/b", "/r")

    def test_a_wildcard_is_taken_out_for_its_own_enclave_only(self) -> None:
        rows: list[Row] = [
            ("/e", "/r", "subscribe", "/*"),
            ("/e", "/r", "DENY subscribe", "/secret"),
            ("/f", "/q", "subscribe", "/*"),
            ("/f", "/a", "publish", "/secret"),
        ]
        graph = build([policy(*rows)])
        assert reaches(graph, "/a", "/q")
        assert not reaches(graph, "/a", "/r")

    def test_denied_wildcards_do_not_meet(self) -> None:
        rows: list[Row] = [
            ("/e", "/w", "publish", "/x*"),
            ("/f", "/r", "subscribe", "/*"),
            ("/f", "/r", "DENY subscribe", "/x*"),
        ]
        assert not reaches(build([policy(*rows)]), "/w", "/r")

    def test_one_part_of_an_action_denied_leaves_the_rest(self) -> None:
        rows: list[Row] = [
            ("/e", "/s", "execute", "/go"),
            ("/e", "/s", "DENY publish", "/go/_action/feedback"),
            ("/f", "/c", "call", "/go"),
        ]
        assert reaches(build([policy(*rows)]), "/s", "/c")  # status and result still go

    def test_absent_means_not_granted(self) -> None:
        graph = build([policy(("/e", "/a", "DENY publish", "/t"))])
        assert steps(graph) == set()
        assert denied(graph) == set()
        assert ("", "topic", "/t") in {e.identity for e in graph.elements}  # but it is there to be seen


class TestViews:
    """Rule S6."""

    ROWS: tuple[Row, ...] = (
        ("/e", "/camera", "publish", "/video"),
        ("/e", "/uplink", "subscribe", "/blurred"),
        ("/e", "/blur", "subscribe", "/video"),
        ("/e", "/blur", "publish", "/blurred"),
    )

    def test_declared_holds_each_node_to_its_profile(self) -> None:
        assert ("/video", "/uplink") not in steps(build([policy(*self.ROWS)]))

    def test_enforced_gives_each_node_what_its_enclave_may(self) -> None:
        graph = build([policy(*self.ROWS)], "enforced")
        nodes = {"/camera", "/uplink", "/blur"}
        expected = {(n, t) for n in nodes for t in ("/video", "/blurred")} | {
            (t, n) for n in nodes for t in ("/video", "/blurred")
        }
        assert steps(graph) == expected

    def test_enforced_is_the_union_over_profiles_and_contains_declared(self) -> None:
        rows = [*self.ROWS, ("/f", "/log", "subscribe", "/*"), ("/f", "/log", "DENY subscribe", "/video")]
        assert steps(build([policy(*rows)])) <= steps(build([policy(*rows)], "enforced"))

    def test_a_node_alone_in_its_enclave_is_the_same_in_both(self) -> None:
        rows = [(n, n, r, t) for _, n, r, t in self.ROWS]
        assert steps(build([policy(*rows)])) == steps(build([policy(*rows)], "enforced"))


def test_the_order_of_files_changes_nothing() -> None:
    """Rule S14."""
    files = [
        policy(("/e", "/a", "publish", "/t"), file="1.xml"),
        policy(("/e", "/b", "subscribe", "/*"), file="2.xml"),
        policy(("/e", "/c", "DENY subscribe", "/t"), ("/f", "/a", "request", "/s"), file="3.xml"),
    ]
    graphs = {build(order) for order in permutations(files)}
    assert len(graphs) == 1


@pytest.mark.parametrize("view", ["declared", "enforced"])
def test_reading_a_policy_twice_is_reading_it_once(view: str) -> None:
    one = policy(("/e", "/a", "publish", "/t"), ("/e", "/b", "subscribe", "/t"))
    assert build([one, one], view) == build([one], view)
