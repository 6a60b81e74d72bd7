"""Permissions and governance files of others: read, or refused with the cause; sros2's own give its policies' graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.deployed.deployed_inputs import read_deployed
from rosprivacy.ingest.deployed.differences import differences
from rosprivacy.ingest.deployed.governance import read_governance
from rosprivacy.ingest.deployed.permissions import read_permissions
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.model import Element, Policy

pytestmark = pytest.mark.corpus
SROS2 = "ros2__sros2/sros2/test/policies"
REFUSED = {
    "permissions_test_participant_01_ActionValidity.xml": "<validity> in <publish>",
    "governance_blank_topic_expression.xml": "<topic_expression> is empty",
    "example_governance.xml": "not well-formed XML",
}


def test_each_file_is_read_or_refused_with_its_cause(corpus: Path) -> None:
    refused = {}
    read = 0
    for file in sorted((corpus / "dds").rglob("*.xml")):
        data = file.read_bytes()
        try:
            (read_governance if b"domain_access_rules" in data else read_permissions)(data, file.name)
            read += 1
        except InputErrors as error:
            refused[file.name] = error.errors[0].problem
    assert read >= 20
    assert refused.keys() == REFUSED.keys()
    assert all(cause in refused[name] for name, cause in REFUSED.items())


@pytest.mark.parametrize("name", ["sample", "single_context", "minimal_action", "talker_listener", "add_two_ints"])
def test_the_permissions_that_sros2_makes_of_a_policy_give_the_same_graph_and_rights(corpus: Path, name: str) -> None:
    folder = corpus / "policies" / SROS2
    policy = read_policy(str(folder / f"{name}.policy.xml"), include_root=str(folder))
    file = corpus / "dds" / SROS2 / "permissions" / name / "permissions.xml"
    read, _ = read_deployed([str(file)], None, "2026-11-22", allow_unsigned=True)
    assert _flows([policy]) == _flows(list(read))
    assert differences([policy], read) == ()


def _flows(policies: list[Policy]) -> set[tuple[object, object]]:
    """Steps of the enforced view, with enclaves in place of nodes: permissions know no nodes."""
    graph = build(policies, "enforced")
    enclave = {profile.node: profile.enclave for profile in graph.profiles}

    def shown(element: Element) -> object:
        return enclave[element.name] if element.is_node else element

    return {(shown(graph.elements[f.source]), shown(graph.elements[f.target])) for f in graph.flows}
