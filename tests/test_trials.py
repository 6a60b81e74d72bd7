"""What a change of policies leaves, found without reading them anew: as if they had been written so (rules S5, S6)."""

from __future__ import annotations

from dataclasses import replace
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.beyond import DenyLine
from rosprivacy.analysis.modes import View
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.answering import answer
from rosprivacy.both_views import ChangeTrials, both_views
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, PolicyChange, changed, changed_graph
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ingest.policies.policy_xml import read_policy
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import system_reader
from tests.helpers.enclaves import PATHS, RIGHTS, Enclaves, systems, write

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Flow


@st.composite
def changes(draw: st.DrawFn, enclaves: Enclaves) -> PolicyChange:
    """Enclaves split, a profile moved, or DENY lines of what somebody grants."""
    profiles = [(path, node) for path, nodes in enclaves.items() for node in nodes]
    if draw(st.booleans()):
        return PolicyChange(split=frozenset(draw(st.sets(st.sampled_from(PATHS), min_size=1))))
    if draw(st.booleans()):
        return PolicyChange(move=frozenset({draw(st.sampled_from(profiles))}))
    lines = draw(st.sets(st.tuples(st.sampled_from(profiles), st.sampled_from(RIGHTS)), min_size=1, max_size=3))
    return PolicyChange(
        deny=frozenset(DenyLine("p.xml", *profile, role, kind, name) for profile, (role, kind, name, _) in lines)
    )


def _told(flows: list[Flow]) -> list[tuple[object, ...]]:
    return [(*flow[:3], sorted((grant.place.line, grant.node) for grant in flow.grants)) for flow in flows]


@given(systems(), st.data())
def test_the_graph_is_that_of_the_changed_policies(system: tuple[Enclaves, str], data: st.DataObject) -> None:
    with TemporaryDirectory() as folder, chdir(folder):
        write(*system)
        policies = [read_policy("p.xml")]
    change = data.draw(changes(system[0]))
    graph = changed_graph(build(policies, View.enforced), policies, change)
    anew = build(changed(policies, change), View.enforced)
    if graph is None:
        assert change.deny  # of wildcards, or of a new name
        return
    assert graph.elements == anew.elements
    assert _told(list(graph.flows)) == _told(list(anew.flows))


WRITERS: Enclaves = {
    "/e": {"/s": [("publish", "topic", "/a", "ALLOW")], "/t": [("publish", "topic", "/z", "ALLOW")]},
    "/f": {"/l": [("subscribe", "topic", "/a", "ALLOW")]},
}
NAMING = (
    "{/s: {source: {Voice: [/a]}}, /t: {source: [Video]}, /l: {leak: [Video]}}",
    "{/s: {source: [Voice]}, /t: {source: [Video]}, /l: {leak: [Video]}}\nflows: [{from: /s, to: /a, only: [Voice]}]",
)


@pytest.mark.parametrize("labels", NAMING)
def test_a_deny_of_what_labels_name_is_no_remedy_and_no_error(
    labels: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write(WRITERS, f"labels: 1\nnodes: {labels}\n")
    enforced = both_views(("p.xml",), ("l.yaml",), Settings()).enforced
    assert enforced is not None
    [added] = enforced.added
    assert (added.split, added.deny) == (("/e",), ())


def _shown(finding: Finding) -> tuple[object, ...]:
    return finding.id, finding.witness, finding.pseudonymised


@given(systems(), st.data())
def test_findings_stand_that_stand_in_the_whole_answer(system: tuple[Enclaves, str], data: st.DataObject) -> None:
    change = data.draw(changes(system[0]))
    question = question_of(replace(Settings(), view="enforced"))
    with TemporaryDirectory() as folder, chdir(folder):
        write(*system)
        read = system_reader(("p.xml",), ("l.yaml",), question)
        try:
            whole = read(NO_CHANGE)
            result = answer(whole, question)
            anew = answer(read(change), question)
        except InputErrors:  # labels that name what the change takes away, too
            assume(False)
            raise
        before = [finding for finding in result.analysis.findings if finding.stands]
        left = ChangeTrials(whole, result, read, question).still_open(change, before)
    wanted = {finding.id for finding in before}
    stands = [finding for finding in anew.analysis.findings if finding.stands and finding.id in wanted]
    assert sorted(map(_shown, left), key=str) == sorted(map(_shown, stands), key=str)
