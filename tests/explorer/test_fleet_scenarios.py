"""What is tried on robots of a fleet means what doing it there would, is counted by robots, and changes nothing."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.mitigation.limits import FILTER
from rosprivacy.analysis.mitigation.proposals import ProposedStep
from rosprivacy.analysis.model import Element
from rosprivacy.explorer.scenarios import WhatIf, together
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.explorer.session import Session
    from rosprivacy.result import Result

LENT = ("carrier_lent",)
ALL = ("carrier_lent", *(f"carrier_{n:02}" for n in range(1, 24)))  # of its model
NOWHERE = ProposedStep(FILTER, 0, ("Video",), between=((Element("node", "/x", "carrier_01"), Element("node", "/y")),))
WILD = """\
<policy version="0.2.0"><enclaves>
<enclave path="/a"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>video</topic></topics></profile></profiles></enclave>
<enclave path="/b"><profiles><profile ns="/" node="cloud">
<topics subscribe="ALLOW"><topic>/*</topic></topics></profile></profiles></enclave>
</enclaves></policy>
"""


def begun(file: Path) -> Session:
    return rosprivacy.explore(fleet=file)


def facts(result: Result) -> object:
    """What is found on which robots and what is open, whichever robots stand for others."""
    assert result.fleet is not None
    likeness = result.fleet.likeness
    found = [
        (one.id, [[*form, sorted(robots)] for form, robots in one.forms], one.count) for one in result.fleet.patterns
    ]
    asked = {
        (likeness.alike(one.element).shown_as, one.categories, robot)
        for one in result.analysis.open
        for robot in likeness.placed(one.element.robot) or ("",)
    }
    return str(result.analysis.verdict), sorted(found), sorted(asked)


def done(file: Path) -> object:
    return facts(answer_fleet(str(file), Settings()))


@pytest.mark.parametrize("robots", [LENT, ALL], ids=["one", "model"])
def test_a_cut_means_a_policy_with_that_line_set_to_deny(hospital: Path, robots: tuple[str, ...]) -> None:
    session = begun(hospital)
    policy = hospital.parent / "carrier.policy.xml"
    lines = policy.read_text().splitlines()
    step = next(s for f in session.findings for s in f.steps if s.target.name == "/recorder" and s.grants)
    place = step.grants[0].place
    found = session.scenario("cut", WhatIf(cut=((place.file, place.line),), robots=robots))
    assert found.difference.closed
    assert {found.difference.robots["closed", one] for one in found.difference.closed} == {tuple(sorted(robots))}
    topic = lines[place.line - 1].strip()
    lines[place.line - 1] = f'</topics><topics subscribe="DENY">{topic}</topics><topics subscribe="ALLOW">'
    text = re.sub(r'<topics subscribe="ALLOW">\s*</topics>', "", "\n".join(lines))
    if robots == LENT:  # it gets a policy of its own
        policy = hospital.parent / "lent.policy.xml"
        own = "{policies: [lent.policy.xml], labels: [carrier.labels.yaml, carrier_lent.labels.yaml]}"
        fleet = hospital.read_text()
        hospital.write_text(fleet.replace("{model: carrier, labels: [carrier_lent.labels.yaml]}", own))
        labels = hospital.parent / "carrier.labels.yaml"
        labels.write_text(labels.read_text().replace("  /blur: {sanitizer: {Video: pseudonymise}}\n", ""))
        more = hospital.parent / "model.labels.yaml"
        more.write_text("labels: 1\nnodes:\n  /blur: {sanitizer: {Video: pseudonymise}}\n")
        text_of = hospital.read_text()
        hospital.write_text(
            text_of.replace("labels: [carrier.labels.yaml]}", "labels: [carrier.labels.yaml, model.labels.yaml]}")
        )
    policy.write_text(text)
    assert facts(found.result) == done(hospital)


def test_a_cut_on_one_robot_leaves_those_that_read_the_same_policy(hospital: Path) -> None:
    session = begun(hospital)
    step = next(s for f in session.findings for s in f.steps if s.target.name == "/recorder" and s.grants)
    place = step.grants[0].place
    before = session.result.to("json1")
    found = session.scenario("cut", WhatIf(cut=((place.file, place.line),), robots=("carrier_07",)))
    assert {on for one in found.difference.closed for on in found.difference.robots["closed", one]} == {"carrier_07"}
    assert not found.difference.opened
    assert session.result.to("json1") == before
    assert session.stands_for("carrier_01") == tuple(f"carrier_{n:02}" for n in range(1, 24))


@pytest.mark.parametrize("robots", [LENT, ALL], ids=["one", "model"])
def test_a_storage_means_an_element_in_the_label_file(hospital: Path, robots: tuple[str, ...]) -> None:
    session = begun(hospital)
    what = WhatIf(elements={"disk": {"kind": "storage"}}, flows=(("/camera_driver", "disk"),), robots=robots)
    found = session.scenario("disk", what)
    (opened,) = found.difference.opened
    assert found.difference.robots["opened", opened] == tuple(sorted(robots))
    file = hospital.parent / ("carrier_lent.labels.yaml" if robots == LENT else "carrier.labels.yaml")
    text = file.read_text()
    flow = "  - {from: /camera_driver, to: disk}\n"
    text = text.replace("elements:\n", "elements:\n  disk: {kind: storage}\n").replace("flows:\n", f"flows:\n{flow}")
    if robots == LENT:
        text += f"elements:\n  disk: {{kind: storage}}\nflows:\n{flow}"
    file.write_text(text)
    assert facts(found.result) == done(hospital)


def test_a_doubted_sanitizer_cleans_nothing_on_these_robots(hospital: Path) -> None:
    session = begun(hospital)
    what = WhatIf(doubted=(("node", "/blur", ()),), robots=session.robots_like("carrier_01"))
    found = session.scenario("blur", what)
    labels = hospital.parent / "carrier.labels.yaml"
    labels.write_text(
        labels.read_text().replace("/blur: {sanitizer: {Video: pseudonymise}}", "/blur: {note: not known}")
    )
    assert facts(found.result) == done(hospital)
    assert not session.edits
    assert not found.difference.opened  # these findings are there already, pseudonymised
    assert found.difference.plainer
    on = {found.difference.robots["plainer", one] for one in found.difference.plainer}
    assert on == {tuple(sorted(set(ALL) - set(LENT)))}


def test_a_filter_closes_what_a_line_under_flows_would(hospital: Path) -> None:
    session = begun(hospital)
    ends = Element("node", "/navigator", "carrier_01"), Element("topic", "/pose", "carrier_01")
    step = ProposedStep(FILTER, 0, ("Location",), between=(ends,))
    robots = session.robots_like("carrier_01")
    found = session.scenario("filter", WhatIf(steps=(step,), robots=robots))
    stated = session.scenario("said", WhatIf(filters=(("/navigator", "/pose", ("Location",)),), robots=robots))
    assert found.difference.closed
    assert facts(found.result) == facts(stated.result)
    labels = hospital.parent / "carrier.labels.yaml"
    text = labels.read_text().replace("flows:\n", "flows:\n  - {from: /navigator, to: /pose, never: [Location]}\n")
    labels.write_text(text)
    assert facts(found.result) == done(hospital)
    assert {len(found.difference.robots["closed", one]) for one in found.difference.closed} == {24}


def test_a_filter_on_a_robot_is_passed_by_its_own_wildcards_and_by_no_other_robots(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(WILD)
    (tmp_path / "l.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /cloud: {leak: [Video]}\n")
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text("fleet: 1\nmodels:\n  m: {policies: [p.xml], labels: [l.yaml]}\ngroups: [{robots: 3, model: m}]\n")
    session = begun(fleet)
    (finding,) = session.findings
    robot = finding.source.robot
    before_it = Element("node", "/camera", robot), Element("topic", "/video", robot)
    step = ProposedStep(FILTER, 0, ("Video",), between=(before_it,))
    found = session.scenario("filter", WhatIf(steps=(step,), robots=(robot,)))
    assert not found.difference.closed  # the wildcard reads what is not cleaned, as on one robot
    assert not found.difference.opened  # and nobody else's does
    alone = rosprivacy.explore(tmp_path / "p.xml", tmp_path / "l.yaml")
    here = ProposedStep(FILTER, 0, ("Video",), between=((Element("node", "/camera"), Element("topic", "/video")),))
    assert not alone.scenario("filter", WhatIf(steps=(here,))).difference.closed


@pytest.mark.slow
def test_a_trial_counts_on_the_edits_of_now_and_changes_nothing(hospital: Path) -> None:
    session = begun(hospital)
    session.label("carrier_01:/blur", conduit=True)
    before, files = session.result.to("json1"), {path: path.read_bytes() for path in hospital.parent.iterdir()}
    what = WhatIf(elements={"disk": {"kind": "storage"}}, flows=(("/blur", "disk"),), robots=("carrier_01",))
    found = session.scenario("disk", what)
    session.save()
    assert len(found.difference.opened) == 1
    again = begun(hospital).scenario("disk", what)
    assert facts(found.result) == facts(again.result)
    session.undo()
    session.save()
    assert {path: path.read_bytes() for path in hospital.parent.iterdir()} == files
    session.redo()
    assert [f["id"] for f in session.result.document()["findings"]] == [f.id for f in session.findings]
    assert before.count('"id"') == session.result.to("json1").count('"id"')


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "why"),
    [
        (WhatIf(doubted=(("node", "/blur", ()),)), "does not say on which robots"),
        (WhatIf(doubted=(("node", "/blur", ()),), robots=("carrier_99",)), "'carrier_99' is no robot of the fleet"),
        (WhatIf(doubted=(("node", "/base", ()),), robots=LENT), "'/base' is no sanitizer"),
        (WhatIf(cut=(("carrier.policy.xml", 1),), robots=LENT), "allows nothing"),
        (WhatIf(filters=(("/nope", "/pose", ("Video",)),), robots=LENT), "/nope"),
        (WhatIf(steps=(NOWHERE,), robots=LENT), "is on none of these robots"),
    ],
)  # fmt: skip
def test_what_is_not_there_is_refused_and_nothing_is_kept(hospital: Path, what: WhatIf, why: str) -> None:
    session = begun(hospital)
    with pytest.raises(InputErrors, match=why):
        session.scenario("x", what)
    assert session.scenarios == {}
    assert session.result.to("json1") == answer_fleet(str(hospital), Settings()).to("json1")


def test_two_trials_together_are_about_the_same_robots() -> None:
    disk = WhatIf(elements={"disk": {"kind": "storage"}}, flows=(("/blur", "disk"),), robots=LENT)
    doubt = WhatIf(doubted=(("node", "/blur", ()),), robots=LENT)
    assert together(disk, doubt).robots == LENT
    with pytest.raises(InputErrors, match="not about the same robots"):
        together(disk, doubt._replace(robots=("carrier_01",)))


def test_one_robot_has_no_robots_to_choose_from() -> None:
    session = rosprivacy.explore("examples/factory/before.policy.xml", "examples/factory/run2.labels.yaml")
    with pytest.raises(InputErrors, match="names robots, and this is one robot"):
        session.scenario("x", WhatIf(doubted=(("node", "/blur", ()),), robots=LENT))
