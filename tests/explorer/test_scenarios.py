"""What is tried means what doing it would mean, and changes nothing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.mitigation.limits import CHANGES
from rosprivacy.analysis.mitigation.proposals import ProposedStep
from rosprivacy.analysis.model import Element
from rosprivacy.explorer.scenarios import WhatIf, summary_of
from rosprivacy.explorer.session import Session
from rosprivacy.mitigation import run_mitigation
from tests.helpers.factory import FACTORY
from tests.helpers.paths import ROOT

BEFORE, RUN2 = str(FACTORY / "before.policy.xml"), str(FACTORY / "run2.labels.yaml")
WILD = """\
<policy version="0.2.0"><enclaves>
<enclave path="/a"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>video</topic></topics></profile></profiles></enclave>
<enclave path="/b"><profiles><profile ns="/" node="cloud">
<topics subscribe="ALLOW"><topic>/*</topic></topics></profile></profiles></enclave>
</enclaves></policy>
"""
BLURRED = """\
<policy version="0.2.0"><enclaves><enclave path="/a"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>video</topic></topics></profile>
<profile ns="/" node="blur"><topics subscribe="ALLOW"><topic>video</topic></topics>
<topics publish="ALLOW"><topic>blurred</topic></topics></profile>
<profile ns="/" node="cloud"><topics subscribe="ALLOW"><topic>blurred</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
CARE = ROOT / "examples" / "care-home"


def facts(result: rosprivacy.Result) -> object:
    """What is found and what is open, wherever it is stated."""
    analysis = result.analysis
    found = [(f.id, f.dismissed, [e.identity for e in f.witness]) for f in analysis.findings]
    return str(analysis.verdict), found, [(q.element.shown_as, q.categories, q.frontier) for q in analysis.open]


@pytest.fixture
def session() -> Session:
    return Session.open([BEFORE], [RUN2])


def test_a_filter_means_a_line_under_flows(session: Session, tmp_path: Path) -> None:
    found = session.scenario("filter", WhatIf(filters=(("/robot_camera", "/robot_video", ("Video",)),)))
    text = Path(RUN2).read_text() + "flows:\n  - {from: /robot_camera, to: /robot_video, never: [Video]}\n"
    (tmp_path / "l.yaml").write_text(text)
    assert facts(found.result) == facts(rosprivacy.analyze(BEFORE, tmp_path / "l.yaml"))
    assert found.difference.closed
    assert not session.edits
    assert session.scenarios == {"filter": found}
    session.drop_scenario("filter")
    assert session.scenarios == {}


def test_a_cut_means_a_line_set_to_deny(session: Session, tmp_path: Path) -> None:
    step = session.findings[0].steps[0]
    place = step.grants[0].place
    found = session.scenario("cut", WhatIf(cut=((place.file, place.line),)))
    assert found.difference.closed == (session.findings[0].id,)
    shutil.copytree(FACTORY, tmp_path / "f")
    copy = tmp_path / "f" / "before.policy.xml"
    text = copy.read_text().splitlines()
    assert text[place.line].strip() == "</topics>"  # it stands alone
    text[place.line - 2] = text[place.line - 2].replace("ALLOW", "DENY")
    copy.write_text("\n".join(text))
    assert facts(found.result) == facts(rosprivacy.analyze(str(copy), RUN2))


def test_a_storage_means_an_element_with_its_flows(session: Session, tmp_path: Path) -> None:
    what = WhatIf(elements={"disk": {"kind": "storage"}}, flows=(("/robot_camera", "disk"),))
    found = session.scenario("disk", what)
    text = Path(RUN2).read_text() + "elements:\n  disk: {kind: storage}\nflows:\n  - {from: /robot_camera, to: disk}\n"
    (tmp_path / "l.yaml").write_text(text)
    assert facts(found.result) == facts(rosprivacy.analyze(BEFORE, tmp_path / "l.yaml"))
    assert len(found.difference.opened) == 1


def test_a_doubted_sanitizer_cleans_nothing() -> None:
    policy, labels = str(CARE / "care-home.policy.xml"), str(CARE / "care-home.labels.yaml")
    session = Session.open([policy], [labels])
    cleaning = [name for (_, name), entry in session.entries.items() if "sanitizer" in entry]
    for name in cleaning:
        found = session.scenario(name, WhatIf(doubted=(("node", name, ()),)))
        entry = dict(session.entries["nodes", name])
        entry.pop("sanitizer")
        by_label = rosprivacy.analyze(policy, labels).with_entry("nodes", name, entry or None)
        assert facts(found.result) == facts(by_label), name
    assert cleaning


def test_what_is_no_longer_pseudonymised_is_told(tmp_path: Path) -> None:
    """It is neither opened nor closed: the same finding was there, pseudonymised."""
    (tmp_path / "p.xml").write_text(BLURRED)
    (tmp_path / "l.yaml").write_text(
        "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /blur: {sanitizer: {Video: pseudonymise}}\n"
        "  /cloud: {leak: [Video]}\n"
    )
    session = Session.open([str(tmp_path / "p.xml")], [str(tmp_path / "l.yaml")])
    (finding,) = session.findings
    assert finding.pseudonymised
    found = session.scenario("doubt", WhatIf(doubted=(("node", "/blur", ()),))).difference
    assert (found.opened, found.closed, found.plainer) == ((), (), (finding.id,))
    assert session.label("/blur", conduit=True).plainer == (finding.id,)


@pytest.mark.parametrize(
    "what",
    [
        WhatIf(cut=(("nowhere.xml", 3),)),
        WhatIf(filters=(("/robot_camera", "/nope", ("Video",)),)),
        WhatIf(doubted=(("node", "/robot_camera", ()),)),
        WhatIf(doubted=(("nodule", "/robot_camera", ()),)),
        WhatIf(elements={"disk": {"kind": "storage", "retension": "P3D"}}),
    ],
)
def test_what_is_not_there_is_not_tried(session: Session, what: WhatIf) -> None:
    with pytest.raises(InputErrors):
        session.scenario("wrong", what)
    assert session.scenarios == {}
    assert summary_of(what)


@pytest.mark.parametrize("kinds", [CHANGES, ("filter",), ("deny",)])
def test_what_mitigate_proposes_means_what_it_proves(session: Session, kinds: tuple[str, ...]) -> None:
    """A trial of a proposal is a new analysis of policies and labels: it says what the proposal's own proof says."""
    proposals = run_mitigation(session.result, kinds=kinds).proposals
    for number, proposal in enumerate(proposals):
        found = session.scenario(str(number), WhatIf(steps=proposal.steps))
        assert proposal.proven
        assert str(found.difference.verdict) == str(proposal.verdict)
        assert set(found.difference.closed) == {finding.id for finding in proposal.removed}
        assert found.difference.opened == ()
    assert proposals
    assert len(session.findings) == 2


def test_a_filter_is_tried_with_what_gets_past_it_along_wildcards(tmp_path: Path) -> None:
    """Who reads every channel reads what the filter has not cleaned: a label at the flow would not say so."""
    policy, labels = tmp_path / "p.policy.xml", tmp_path / "l.yaml"
    policy.write_text(WILD, "utf-8")
    labels.write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /cloud: {leak: [Video]}\n", "utf-8")
    session = Session.open([str(policy)], [str(labels)])
    ends = {e.name: e for e in session.result.analysis.graph.elements}
    step = ProposedStep("filter", 0, ("Video",), between=((ends["/camera"], ends["/video"]),))
    assert len(session.findings) == 1
    assert session.scenario("filter", WhatIf(steps=(step,))).difference.closed == ()
    by_label = session.scenario("label", WhatIf(filters=(("/camera", "/video", ("Video",)),)))
    assert len(by_label.difference.closed) == 1


def test_a_step_that_is_not_there_any_more_is_told(session: Session) -> None:
    step = ProposedStep("filter", 0, ("Video",), between=((Element("node", "/a"), Element("topic", "/b")),))
    for gone in (step, ProposedStep("review", 0, ("Video",), channel=Element("topic", "/gone"))):
        with pytest.raises(InputErrors, match="there is nothing any more"):
            session.scenario("gone", WhatIf(steps=(gone,)))
