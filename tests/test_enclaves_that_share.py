"""Whether rights of an enclave are told once or for each of its nodes, every answer is the same (rules S5, S6, S10).

The brute force is the plain union: each node by itself, with every grant of its enclaves.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.analysis.many_flows import Flows
from rosprivacy.analysis.modes import View
from rosprivacy.api import analyze
from rosprivacy.ingest.policies import enclave_rights, flow_graph
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.enclaves import each_alone, policy_of
from tests.helpers.written_systems import ROLES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.helpers.enclaves import Enclaves

NODES = tuple(f"/n{i}" for i in range(5))
PATHS = ("/e", "/f")
TOPICS = ("/a", "/b", "/c/_action/feedback", "/a*", "/*", "/parameter_events")
RIGHTS = tuple(
    [(role, "topic", name, "ALLOW") for role in ("publish", "subscribe") for name in TOPICS]
    + [(role, "service", name, "ALLOW") for role in ("request", "reply") for name in ("/s", "/c/_action/send_goal")]
    + [(role, "action", "/c", "ALLOW") for role in ("call", "execute")]
    + [("publish", "topic", "/b", "DENY"), ("subscribe", "topic", "/a*", "DENY"), ("request", "service", "/s", "DENY")]
)
ALWAYS = {"/n0": RIGHTS[:1], "/n1": [("subscribe", "topic", "/b", "ALLOW")]}  # labels name these
CHANNEL = ("mundane", "sensitive", "{only: [Video]}", "{never: [Voice]}")
SOURCES = (ROLES[0], "{source: {Video: [/a]}}", "{source: {Video: [/a], Voice: ['/*']}}")
FORMATS = ("json", "text", "sarif", "turtle", "cnil-pia", "html")
EVERYTHING, NOTHING = 0, 10**9  # of groups of nodes and channels is stored for each node


@st.composite
def systems(draw: st.DrawFn) -> tuple[Enclaves, str]:
    """Enclaves, some nodes of which stand in both; and the text of a label file."""
    enclaves: Enclaves = {}
    for node in NODES:
        for path in draw(st.sampled_from((PATHS[:1], PATHS[:1], PATHS[1:], PATHS))):
            some = draw(st.lists(st.sampled_from(RIGHTS), max_size=4, unique=True))
            enclaves.setdefault(path, {})[node] = [*ALWAYS.get(node, ()), *some]
    roles = {node: draw(st.sampled_from(ROLES)) for node in NODES[1:]}
    roles["/n0"] = draw(st.sampled_from(SOURCES))
    used = sorted({name for some in enclaves.values() for of in some.values() for _, _, name, _ in of})
    plain = [name for name in used if name in ("/a", "/b", "/s")]
    channels = {name: draw(st.sampled_from(CHANNEL)) for name in plain if draw(st.integers(0, 3)) == 0}
    lines = ["labels: 1", "nodes:", *(f"  {name}: {said}" for name, said in sorted(roles.items()))]
    lines += ["channels:", *(f'  "={name}": {said}' for name, said in channels.items())] if channels else []
    lines += ["elements:", "  disk: {kind: storage, country: US, retention: P3D}"]
    lines += ["flows:", f"  - {{from: {draw(st.sampled_from(NODES))}, to: disk}}"]
    limit = draw(
        st.sampled_from(("", "", '{from: "*", to: {topic: /a}, never: [Voice]}', "{from: /b, to: /n1, only: [Voice]}"))
    )
    return enclaves, "\n".join([*lines, *([f"  - {limit}"] if limit else []), ""])


def told(stored: int, *, alone: bool = False) -> list[str]:
    """All that is told of a system, or why nothing is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(enclave_rights, "STORED", stored)
        if alone:
            patch.setattr(flow_graph, "alike", each_alone)
        try:
            result = analyze("p.xml", labels="l.yaml", paths="disjoint", view="enforced")
            counted = analyze("p.xml", labels="l.yaml", view="enforced")
        except RosPrivacyError as error:
            return [str(error)]
        try:
            proposals = json.dumps(result.proposals())
        except RosPrivacyError as error:
            proposals = str(error)
        why = [repr(result.why_not("/n0", node)) for node in NODES[1:3]]
        return [*(str(result.to(name)) for name in FORMATS), str(counted.to("json")), proposals, *why]


def write(enclaves: Enclaves, labels: str = "") -> None:
    Path("p.xml").write_text(policy_of(enclaves), "utf-8")
    Path("l.yaml").write_text(labels, "utf-8")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(system=systems())
def test_every_answer_is_that_of_the_union_written_out(
    system: tuple[Enclaves, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    write(*system)
    assert told(EVERYTHING) == told(NOTHING, alone=True)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(system=systems(), stored=st.sampled_from((0, 1, 10**9)))
def test_the_graph_is_that_of_the_union_written_out(
    system: tuple[Enclaves, str], stored: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write(*system)
    policies = [read_policy("p.xml")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(enclave_rights, "STORED", stored)
        shared = flow_graph.build(policies, View.enforced)
        patch.setattr(flow_graph, "alike", each_alone)
        union = flow_graph.build(policies, View.enforced)
    assert not isinstance(union.flows, Flows)
    assert list(shared.flows) == list(union.flows)
    assert [shared.flows[at] for at in range(len(shared.flows))] == list(union.flows)
    assert (shared.elements, shared.denied, shared.denied_matches) == (
        union.elements,
        union.denied,
        union.denied_matches,
    )


def _enclave(nodes: int) -> Enclaves:
    """One enclave whose nodes each write a topic of their own, which the next one reads."""

    def rights(i: int) -> Sequence[tuple[str, str, str, str]]:
        return [("publish", "topic", f"/t{i}", "ALLOW"), ("subscribe", "topic", f"/t{(i + 1) % nodes}", "ALLOW")]

    return {"/e": {f"/n{i}": list(rights(i)) for i in range(nodes)}}


def test_grants_of_an_enclave_are_stored_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write(_enclave(100))
    graph = flow_graph.build([read_policy("p.xml")], View.enforced)
    assert isinstance(graph.flows, Flows)
    assert len(graph.flows) == 100 * 200
    assert not graph.flows.stored
    assert sum(len(meeting.written) + len(meeting.read) for meeting in graph.flows.meetings) == 2 * 200
