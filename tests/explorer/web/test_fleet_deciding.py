"""Decisions from the page of a fleet: about the robots that are told and chosen, and no others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from lxml import html

import rosprivacy
from rosprivacy.explorer.web import finding_pane
from tests.helpers.explorers import Explorer, version
from tests.helpers.fleet_files import policy, write
from tests.helpers.full_disk import full_disk

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from starlette.testclient import TestClient

    from rosprivacy.analysis.answer import Finding

    Explore = Callable[..., Explorer]

SIGNED = {"choice": "accept", "reason": "within the building", "owner": "A. Lee", "expires": "2999-12-31"}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "d.yaml"


@pytest.fixture
def begun(explore: Explore, hospital: Path, file: Path) -> Explorer:
    return explore(hospital, hospital, fleet=True, decisions=file)


def on_every_robot(explorer: Explorer) -> Finding:
    """The finding that carriers, guides and cleaners have: where they are gets into a cloud out of the EEA."""
    fleet = explorer.session.uncounted.fleet
    assert fleet
    there = [one.finding for one in fleet.patterns if len(one.robots) == 40 and not one.across]
    return next(one for one in there if one.kind == "third-country-transfer")


def from_robot_to_robot(explorer: Explorer) -> Finding:
    fleet = explorer.session.uncounted.fleet
    assert fleet
    return next(one.finding for one in fleet.patterns if one.across)


def radios(client: TestClient, finding: Finding) -> dict[str, str]:
    """What can be chosen: the words -> the value."""
    form = html.fromstring(client.get(f"/?finding={finding.id}").text).get_element_by_id("decide")
    labels = form.cssselect(".whose label")
    return {label.text_content().strip(): str(label.cssselect("input")[0].get("value")) for label in labels}


def decide(client: TestClient, finding: Finding, /, **fields: Any) -> Any:
    """What a person decides, who says yes where the page asks again, as it does without a basis of chapter V."""
    said = {"version": version(client), "finding": finding.id, **fields}
    answer = client.post(f"/decide?finding={finding.id}", data=said)
    asked = html.fromstring(answer.text).xpath("//input[@name='lacks']") if answer.status_code == 409 else []
    confirmed = {**said, "lacks": asked[0].get("value")} if asked else {}
    return client.post(f"/decide?finding={finding.id}", data=confirmed) if confirmed else answer


def open_on(file: Path, hospital: Path, finding: Finding) -> set[str]:
    """The robots on which it still stands, by an analysis of its own."""
    fleet = rosprivacy.analyze_fleet(hospital, decisions=file).fleet
    assert fleet
    what = finding.kind, finding.category, finding.leak, finding.source.name
    said = {
        one: (one.finding.kind, one.finding.category, one.finding.leak, one.finding.source.name)
        for one in fleet.patterns
    }
    (found,) = (one for one in fleet.patterns if said[one] == what)
    return {robot for form, robots in found.forms if not form.accepted for robot in robots}


@pytest.mark.slow
def test_it_is_told_about_how_many_robots_and_which(begun: Explorer) -> None:
    client = begun.client()
    finding = on_every_robot(begun)
    assert list(radios(client, finding))[:2] == ["of model carrier: 23 robots", "carrier_01 only"]
    assert "of model guide: 12 robots" in radios(client, finding)
    assert "carrier_lent only" in radios(client, finding)
    form = html.fromstring(client.get(f"/?finding={finding.id}").text).get_element_by_id("decide")
    assert "carrier_22, carrier_23" in form.cssselect("details p")[0].text_content()
    assert "a robot that joins later" in form.text_content()
    assert form.cssselect(".whose input[checked]")[0].get("value") == finding.id


def test_of_what_gets_from_robot_to_robot_both_ends_are_told(begun: Explorer) -> None:
    there = radios(begun.client(), from_robot_to_robot(begun))
    assert list(there)[:2] == ["from 23 robots (carrier) to 12 robots (guide)", "from carrier_01 to guide_01"]


def test_a_form_that_is_not_the_one_on_the_page_is_told(begun: Explorer) -> None:
    there = radios(begun.client(), next(one for one in begun.session.findings if one.leak.name == "reviewer"))
    assert list(there)[:2] == ["carrier_lent only", "of model carrier: 23 robots – pseudonymised"]


def test_a_path_that_is_not_the_one_on_the_page_is_told(
    explore: Explore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    write("near.xml", policy("/camera>/image", "/uplink</image"))
    write("far.xml", policy("/camera>/image", "/relay>/copy</image", "/uplink</copy"))
    write("labels.yaml", "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /uplink: {leak: [Video]}\n")
    models = (
        "models: {near: {policies: near.xml, labels: labels.yaml}, far: {policies: far.xml, labels: labels.yaml}}\n"
    )
    write("fleet.yaml", f"fleet: 1\n{models}groups: [{{robots: 2, model: near}}, {{robots: 3, model: far}}]\n")
    explorer = explore(tmp_path / "fleet.yaml", tmp_path / "fleet.yaml", fleet=True, decisions=file)
    (finding,) = explorer.session.findings
    path = "on another path: /camera → /image → " + (
        "/uplink" if len(finding.witness) > 3 else "/relay → /copy → /uplink"
    )
    assert [path in told for told in radios(explorer.client(), finding)] == [False, False, True, True]


def test_a_row_is_decided_on_the_robots_that_are_chosen(begun: Explorer, hospital: Path, file: Path) -> None:
    client, finding = begun.client(), on_every_robot(begun)
    row = next(row for row in begun.session.result.document()["register"] if finding.id in row["findings"])
    guides = radios(client, finding)["of model guide: 12 robots"]
    answer = decide(client, finding, **SIGNED, whose=guides, about="row")
    assert answer.status_code == 303
    assert "of model guide: 12 robots" in client.get(answer.headers["location"]).text
    text = file.read_text("utf-8")
    assert f"row: {row['fleet']['pattern']}" in text
    assert "guide_12" in text
    left = open_on(file, hospital, finding)
    assert len(left) == 28
    assert not [robot for robot in left if robot.startswith("guide")]
    whole = rosprivacy.analyze_fleet(hospital, decisions=file)
    assert whole.to("json1") == begun.session.result.to("json1")


def test_what_is_chosen_is_decided_and_the_others_stay_open(begun: Explorer, hospital: Path, file: Path) -> None:
    client = begun.client()
    finding = on_every_robot(begun)
    guides = radios(client, finding)["of model guide: 12 robots"]
    answer = decide(client, finding, **SIGNED, whose=guides)
    assert answer.status_code == 303
    assert "accepted, of model guide: 12 robots" in client.get(answer.headers["location"]).text
    left = open_on(file, hospital, finding)
    assert len(left) == 28
    assert not [robot for robot in left if robot.startswith("guide")]
    alone = radios(client, on_every_robot(begun))["carrier_01 only"]
    assert decide(client, on_every_robot(begun), **SIGNED, whose=alone).status_code == 303
    assert open_on(file, hospital, finding) == left - {"carrier_01"}
    whole = rosprivacy.analyze_fleet(hospital, decisions=file)
    assert whole.to("json1") == begun.session.result.to("json1")


@pytest.mark.slow
def test_what_is_decided_already_is_told_and_what_is_not_comes_first(begun: Explorer) -> None:
    client = begun.client()
    first = on_every_robot(begun)
    assert decide(client, first, choice="mitigate", whose=first.id).status_code == 303
    there = radios(client, on_every_robot(begun))
    assert next(iter(there)) == "carrier_lent only"
    assert "of model carrier: 23 robots – to be mitigated" in there


@pytest.mark.slow
@pytest.mark.parametrize(
    "fields",
    [
        {"choice": "accept"},
        {**SIGNED, "expires": "2020-01-01"},
        {**SIGNED, "choice": "allow"},
        {**SIGNED, "legal_basis": "we want to"},
        {**SIGNED, "whose": ""},
        {**SIGNED, "whose": "carrier_01"},
        {**SIGNED, "whose": "0123456789abcdef"},
        {**SIGNED, "whose": "*"},
        {**SIGNED, "whose": ["a", "b"]},
        {**SIGNED, "finding": "0123456789abcdef"},
    ],
)
def test_what_cannot_be_decided_is_told_and_not_written(begun: Explorer, file: Path, fields: dict[str, Any]) -> None:
    client, finding = begun.client(), on_every_robot(begun)
    answer = decide(client, finding, **{"whose": finding.id, **fields})
    assert answer.status_code == 422
    assert "This cannot be said" in answer.text
    assert not file.exists()
    assert begun.session.version == 0


def test_robots_of_another_finding_are_refused(begun: Explorer, file: Path) -> None:
    client = begun.client()
    finding = on_every_robot(begun)
    other = next(one for one in begun.session.findings if one.id not in radios(client, finding).values())
    assert decide(client, finding, **SIGNED, whose=other.id).status_code == 422
    assert not file.exists()


@pytest.mark.slow
def test_a_window_that_shows_what_was_before_decides_nothing(begun: Explorer, file: Path) -> None:
    client, finding = begun.client(), on_every_robot(begun)
    stale = version(client)
    assert decide(client, finding, choice="delegate", whose=finding.id).status_code == 303
    before = file.read_bytes()
    assert decide(client, finding, **SIGNED, whose=finding.id, version=stale).status_code == 409
    assert file.read_bytes() == before


def test_a_page_to_read_decides_nothing(explore: Explore, hospital: Path, file: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True, decisions=file, read_only=True)
    client, finding = explorer.client(), on_every_robot(explorer)
    form = html.fromstring(client.get(f"/?finding={finding.id}").text).get_element_by_id("decide")
    assert form.cssselect("fieldset[disabled]")
    assert decide(client, finding, **SIGNED, whose=finding.id).status_code == 403
    assert not file.exists()


@pytest.mark.slow
def test_what_an_editor_wrote_meanwhile_stays(begun: Explorer, hospital: Path, file: Path) -> None:
    client, finding = begun.client(), on_every_robot(begun)
    assert decide(client, finding, choice="delegate", whose=finding.id).status_code == 303
    file.write_text(file.read_text("utf-8") + "# by hand\n- {leak: nowhere, decision: avoid}\n", "utf-8")
    alone = radios(client, on_every_robot(begun))["carrier_lent only"]
    assert decide(client, on_every_robot(begun), **SIGNED, whose=alone).status_code == 303
    text = file.read_text("utf-8")
    assert "# by hand\n- {leak: nowhere, decision: avoid}\n" in text
    assert "delegate" in text
    assert len(open_on(file, hospital, finding)) == 39


@pytest.mark.slow
def test_a_decision_on_a_full_disk_decides_nothing(begun: Explorer, file: Path) -> None:
    client, finding = begun.client(), on_every_robot(begun)
    before = begun.session.result.to("json1")
    with full_disk(10):
        refused = decide(client, finding, **SIGNED, whose=finding.id)
    assert refused.status_code == 422
    assert "cannot be written" in refused.text
    assert begun.session.result.to("json1") == before
    assert not file.exists()
    assert decide(client, finding, **SIGNED, whose=finding.id).status_code == 303


@pytest.mark.slow
def test_without_the_option_the_page_says_how_to_start(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True)
    client, finding = explorer.client(), on_every_robot(explorer)
    page = html.fromstring(client.get(f"/?finding={finding.id}").text)
    assert not page.xpath("//form[@id='decide']")
    assert "--decisions decisions.jsonl" in page.text_content()
    assert decide(client, finding, **SIGNED, whose=finding.id).status_code == 422


@pytest.mark.slow
def test_robots_that_the_page_does_not_offer_are_counted(begun: Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(finding_pane, "OFFERED", 3)
    client, finding = begun.client(), on_every_robot(begun)
    assert list(radios(client, finding)) == ["of model carrier: 23 robots", "carrier_01 only", "carrier_lent only"]
    assert "4 more can be chosen once some of these are decided" in client.get(f"/?finding={finding.id}").text
    assert decide(client, finding, choice="avoid", whose=finding.id).status_code == 303
    assert "of model cleaner: 4 robots" in radios(client, on_every_robot(begun))
