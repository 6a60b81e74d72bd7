"""Whether rights of an enclave are told once or for each of its nodes, every answer is the same (rules S5, S6, S10).

The brute force is the plain union: each node by itself, with every grant of its enclaves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.many_flows import Flows
from rosprivacy.analysis.modes import View
from rosprivacy.api import analyze
from rosprivacy.ingest.policies import enclave_rights, flow_graph
from rosprivacy.ingest.policies.policy_xml import read_policy
from tests.helpers.enclaves import each_alone, systems, write
from tests.helpers.written_systems import every_answer

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from tests.helpers.enclaves import Enclaves

FORMATS = ("json", "text", "sarif", "turtle", "cnil-pia", "html")
EVERYTHING, NOTHING = 0, 10**9  # of groups of nodes and channels is stored for each node


def told(stored: int, *, alone: bool = False) -> list[str]:
    """All that is told of a system, or why nothing is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(enclave_rights, "STORED", stored)
        if alone:
            patch.setattr(flow_graph, "alike", each_alone)
        answers = every_answer(FORMATS, view="enforced")
        counted = [] if len(answers) == 1 else [str(analyze("p.xml", labels="l.yaml", view="enforced").to("json1"))]
        return [*answers, *counted]


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
