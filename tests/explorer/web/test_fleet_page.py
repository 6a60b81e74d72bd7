"""The page of a fleet: robots that are alike stand as one, and an answer is said of a model or of one robot."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING

import pytest
from lxml import html

from rosprivacy.explorer.edits import element_id
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.explorers import Explorer, label, version
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from starlette.testclient import TestClient

    Explore = Callable[..., Explorer]


@pytest.fixture
def hospital(tmp_path: Path) -> Path:
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    file = tmp_path / "fleet" / "fleet.yaml"
    labels = file.parent / "carrier.labels.yaml"
    labels.write_text(labels.read_text().replace("  /recorder: conduit\n", "").replace("  /uplink: conduit\n", ""))
    return file


def on(robot: str, name: str) -> str:
    return element_id((robot, "node", name))


def test_an_answer_is_of_the_model_or_of_one_robot(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True)
    client = explorer.client()
    page = html.fromstring(client.get(f"/?at={on('carrier_lent', '/recorder')}").text)
    told = [one.text_content().strip() for one in page.cssselect(".whose label")]
    assert told == ["of model carrier: 24 robots", "carrier_lent only"]
    assert page.cssselect(".whose input[checked]")[0].get("value") == "model"
    page = html.fromstring(client.get(f"/?at={on('carrier_lent', '/blur')}").text)
    assert page.cssselect(".whose input[checked]")[0].get("value") == "robot"  # it speaks of it already
    about = {"about": "*"}
    assert label(client, on("carrier_lent", "/recorder"), "conduit", whose="robot", **about).status_code == 303
    assert label(client, on("carrier_01", "/recorder"), "conduit", whose="model", **about).status_code == 303
    assert label(client, on("carrier_01", "/uplink"), "conduit", **about).status_code == 303
    assert client.post("/save", data={"version": version(client)}).status_code == 303
    own = (hospital.parent / "carrier_lent.labels.yaml").read_text()
    model = (hospital.parent / "carrier.labels.yaml").read_text()
    assert "  /recorder: conduit" in own
    assert "/uplink" not in own
    assert "  /recorder: conduit" in model
    assert "  /uplink: conduit" in model
    assert explorer.session.result.to("json1") == answer_fleet(str(hospital), Settings()).to("json1")


@pytest.mark.slow
def test_a_suggestion_is_taken_for_the_robots_that_are_chosen(explore: Explore, hospital: Path) -> None:
    own, model = (hospital.parent / f"{name}.labels.yaml" for name in ("carrier_lent", "carrier"))
    own.write_text(own.read_text().replace("nodes:\n", "nodes:\n  /person_detector: {note: another one}\n"))
    before = model.read_text()
    client = explore(hospital, hospital, fleet=True).client()
    page = html.fromstring(client.get(f"/?at={on('carrier_lent', '/person_detector')}").text)
    offer = next(form for form in page.forms if form.get("class") == "offer")
    assert "carrier_lent only" in offer.text_content()
    assert client.post("/label", data=dict(offer.form_values())).status_code == 303
    assert client.post("/save", data={"version": version(client)}).status_code == 303
    assert "source: [PersonTrack]" in own.read_text()
    assert model.read_text() == before


@pytest.mark.slow
def test_what_cannot_be_said_is_refused_in_words(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True)
    client = explorer.client()
    before = {path: path.read_bytes() for path in hospital.parent.iterdir()}
    refused = label(client, on("carrier_01", "/uplink"), "conduit", about="*", whose="robot")
    assert refused.status_code == 422
    assert "names no label file of its own: carrier_01" in refused.text
    shared = element_id(("hospital", "external-system", "fleet cloud"))
    assert "what the fleet file states is changed there" in label(client, shared, "conduit", about="*").text
    assert label(client, on("carrier_01", "/uplink"), "conduit", about="*", whose="/etc/passwd").status_code == 422
    assert client.get("/?draw=all").status_code == 200
    assert (explorer.session.unsaved, explorer.session.version) == (0, 0)
    assert before == {path: path.read_bytes() for path in hospital.parent.iterdir()}


def tried(client: TestClient, **said: str) -> str:
    """What the pane says of a trial."""
    answer = client.post("/try", data={"version": version(client), **said})
    assert answer.status_code == 303
    pane = html.fromstring(client.get(answer.headers["location"]).text).get_element_by_id("element")
    return " ".join(pane.text_content().split())


@pytest.mark.slow
def test_a_filter_or_a_cut_on_a_path_is_tried_on_the_robots_of_its_model(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True)
    client = explorer.client()
    before = explorer.session.result.to("json1")
    rows = html.fromstring(client.get("/").text).cssselect("a.way")
    way = next(one.get("href", "") for one in rows if "carrier_lent:/camera_driver" in one.text_content())
    page = html.fromstring(client.get(way).text)
    assert "which lets it out" in page.get_element_by_id("h-element").text_content()
    forms = [dict(form.form_values()) for form in page.forms if form.get("class") == "inline"]
    assert {form["what"] for form in forms} == {"filter", "cut"}
    assert not page.xpath("//form[starts-with(@action, '/decide')]")
    assert not page.xpath("//a[@data-key='p']")  # what closes it is asked of one robot
    for form in forms:
        said = tried(client, **{key: value for key, value in form.items() if key != "version"})
        assert re.search("of model (carrier: 24|guide: 12) robots|base only", said), said
    cut = next(form for form in forms if form["what"] == "cut")
    assert "On 24 robots: carrier_01, carrier_02, carrier_03, and 21 more." in tried(client, **{**cut, "name": "cut"})
    assert explorer.session.version == 0
    assert explorer.session.result.to("json1") == before


@pytest.mark.slow
def test_at_an_element_it_is_chosen_whether_the_model_or_one_robot_is_meant(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True, read_only=True)
    client = explorer.client()
    blur = on("carrier_01", "/blur")
    page = html.fromstring(client.get(f"/?at={blur}").text)
    (chosen,) = page.xpath("//select[@id='try-storage-whose']")
    assert [(one.get("value"), one.text) for one in chosen.xpath("option")] == [
        ("model", "of model carrier: 24 robots"), ("robot", "carrier_01 only"),
    ]  # fmt: skip
    of_model = tried(client, what="storage", element=blur, whose="model", name="all")
    assert "1 path to assess opens" in of_model
    assert "On 24 robots: carrier_01," in of_model
    alone = tried(client, what="storage", element=blur, whose="robot", name="one")
    assert "On 1 robot: carrier_01." in alone
    trial = html.fromstring(client.get("/?trial=one&find=/blur").text)
    rows = [
        " ".join(row.text_content().split()) for row in trial.cssselect("#rows .row") if ":/blur" in row.text_content()
    ]
    assert any(row.startswith("carrier_02:/blur") and "stands for 22 robots" in row for row in rows)
    assert not any("stands for 23" in row for row in rows)
    doubted = tried(client, what="doubt", element=blur, whose="robot", data="*", name="two")
    assert "On 1 robot: carrier_01." in doubted
    together = html.fromstring(client.get("/?trial=one").text).xpath("//select[@id='try-second']/option")
    assert [one.text for one in together] == ["two"]  # the other is about other robots
    refused = {"version": version(client), "what": "together", "first": "one", "second": "all"}
    assert client.post("/try", data=refused).status_code == 422
    assert "On 1 robot: carrier_01." in tried(client, what="together", first="one", second="two", name="both")


@pytest.mark.slow
def test_what_belongs_to_no_robot_is_told_as_such(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True)
    client = explorer.client()
    cloud = element_id(("hospital", "external-system", "fleet cloud"))
    page = html.fromstring(client.get(f"/?at={cloud}").text)
    assert "This belongs to no robot." in page.get_element_by_id("tries").text_content()
    assert not page.xpath("//select[contains(@id, '-whose')]")
    flows = {one.text: one.get("value") for one in page.xpath("//select[@id='try-flow']/option")}
    beside = next(value for told, value in flows.items() if told.startswith("carrier_01:/uplink"))
    assert "of model carrier: 24 robots" in tried(client, what="filter", flow=beside, data="*")
    for said in ({"what": "storage", "element": cloud}, {"what": "doubt", "element": cloud, "data": "*"}):
        assert client.post("/try", data={"version": version(client), **said}).status_code == 422


def test_what_is_about_one_robot_is_refused_of_a_fleet(explore: Explore, hospital: Path) -> None:
    explorer = explore(hospital, hospital, fleet=True)
    client = explorer.client()
    finding = explorer.session.findings[0]
    forms = (
        ("/try", {"what": "proposal", "proposal": "0", "step": ""}),
        ("/try", {"what": "storage", "element": on("carrier_01", "/blur"), "whose": "/etc/passwd"}),
        ("/try", {"what": "cut", "line": "l0000000000000000"}),
        ("/decide", {"finding": finding.id, "choice": "avoid"}),
    )
    for path, said in forms:
        assert client.post(path, data={"version": version(client), **said}).status_code == 422
    assert explorer.session.version == 0
    assert explorer.session.scenarios == {}
