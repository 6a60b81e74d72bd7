"""A review of a fleet: of robots that are alike one is asked about, others first; it ends with the fleet's report."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Any

import pytest
from lxml import html

from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.answered_entries import left_of
from rosprivacy.explorer.web.review_site import open_elements
from rosprivacy.report.catalogs.words import Words
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet
from tests.helpers.languages import english_in
from tests.helpers.paths import ROOT
from tests.helpers.reviews import NAME, answer, heading, insiders_in, page, to_the_end

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.helpers.explorers import Explorer

    Explore = Callable[..., Explorer]

LANGUAGES = ("en", "de", "fr")
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>/image</topic></topics></profile>
<profile ns="/" node="recorder"><topics subscribe="ALLOW"><topic>/image</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""


@pytest.fixture
def hospital(tmp_path: Path) -> Path:
    """The example, with what is said of the nodes of carriers left away."""
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    for name in ("carrier", "carrier_lent"):
        labels = tmp_path / "fleet" / f"{name}.labels.yaml"
        labels.write_text(f"{labels.read_text().partition('nodes:')[0]}nodes: {{}}\n")
    return tmp_path / "fleet" / "fleet.yaml"


def reviewed(explore: Explore, fleet: Path, **how: Any) -> Explorer:
    return explore(fleet, fleet, fleet=True, review=True, **how)


def on(robot: str, name: str) -> str:
    return element_id((robot, "node", name))


def robots_asked(explorer: Explorer) -> list[str]:
    return [one.element.robot for one in open_elements(explorer.site.standing) if not one.note]


@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_review_goes_from_the_first_question_to_the_fleets_report(
    explore: Explore, hospital: Path, language: str
) -> None:
    explorer = reviewed(explore, hospital, language=language)
    client, words = explorer.client(), Words(language)
    seen = to_the_end(client)
    assert len(seen) > 8
    for text in seen:
        assert insiders_in(text, language) == []
        for wrong in ("carrier_02:", "carrier_23:", "guide_02:"):  # they are alike to the first of them
            assert wrong not in text
    last = html.fromstring(seen[-1])
    assert heading(last) == words("review.heading.summary")
    assert words("review.title.fleet") in last.xpath("string(//title)")
    assert words("review.end.none") in seen[-1].replace("&#39;", "'")
    assert client.post("/save", data={"version": last.xpath("string(//body/@data-version)")}).status_code == 303
    assert NAME in (hospital.parent / "carrier.labels.yaml").read_text("utf-8")
    fresh = answer_fleet(str(hospital), Settings())
    assert client.get("/report").text == fresh.to("html", language=language)


def test_robots_that_are_not_as_their_model_are_asked_about_first(explore: Explore, hospital: Path) -> None:
    explorer = reviewed(explore, hospital)
    client = explorer.client()
    assert "carrier_lent" in heading(page(client))
    assert "carrier_lent: not as its model." in page(client).text_content()
    to_the_end_of_sources(client)
    rows = [one.element for one in open_elements(explorer.site.standing) if not one.note]
    rows = [element for element in rows if element.name != "/rosout"]  # a log that nobody reads waits for all others
    of_carriers = [element.robot for element in rows if element.robot.startswith("carrier")]
    assert of_carriers
    assert of_carriers == sorted(of_carriers, key=lambda robot: robot != "carrier_lent")
    told = page(client, f"/?at={on('carrier_01', '/recorder')}").text_content()
    assert "carrier_01: stands for 23 robots." in told


def to_the_end_of_sources(client: Any) -> None:
    """Say of the camera that it brings video in, of all carriers."""
    said = answer(client, "source", f"/?at={on('carrier_01', '/camera_driver')}", brings="Video", whose="model")
    assert said.status_code == 303


def test_an_answer_is_of_the_model_or_of_one_robot_as_a_person_chooses(explore: Explore, hospital: Path) -> None:
    explorer = reviewed(explore, hospital)
    client = explorer.client()
    to_the_end_of_sources(client)
    whole = page(client, f"/?at={on('carrier_lent', '/recorder')}")
    chosen = whole.xpath("//input[@name='whose']")
    assert [one.getparent().text_content().strip() for one in chosen] == [
        "of model carrier: 24 robots", "carrier_lent only",
    ]  # fmt: skip
    assert [one.get("value") for one in chosen if one.get("checked")] == ["model"]
    recorder = f"/?at={on('carrier_lent', '/recorder')}"
    assert answer(client, "leak", recorder, whose="robot").status_code == 303
    assert on("carrier_01", "/recorder") in {one.id for one in open_elements(explorer.site.standing)}
    assert answer(client, "conduit", f"/?at={on('carrier_01', '/recorder')}", whose="model").status_code == 303
    client.post("/save", data={"version": str(explorer.session.version)})
    model, own = ((hospital.parent / f"{name}.labels.yaml").read_text() for name in ("carrier", "carrier_lent"))
    assert "leak: [Video]" in own
    assert "/camera_driver" not in own
    assert "leak" not in model
    summary = page(client, "/?step=summary").text_content()
    assert "/recorder, of model carrier: 24 robots: passes on" in summary
    assert "/recorder, carrier_lent only: lets out: video of persons" in summary
    assert "can get from carrier_lent:/camera_driver to carrier_lent:/recorder, which lets it out." in summary


@pytest.mark.slow
def test_what_is_left_to_the_engineer_is_left_of_every_robot_that_reads_the_file(
    explore: Explore, hospital: Path
) -> None:
    explorer = reviewed(explore, hospital)
    client = explorer.client()
    to_the_end_of_sources(client)
    recorder = f"/?at={on('carrier_01', '/recorder')}"
    assert answer(client, "skip", recorder, whose="model", note="does it keep them?").status_code == 303
    left = {one.element.full_name for one in open_elements(explorer.site.standing) if one.note}
    assert left == {"carrier_01:/recorder", "carrier_lent:/recorder"}
    assert "does it keep them?" in page(client, "/?step=summary").text_content()
    back = client.post("/undo", data={"version": str(explorer.session.version)})
    assert "/recorder" in heading(page(client, back.headers["location"]))
    assert not any(left_of(entry.value) for entry in explorer.session.answers)


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_no_file_can_answer_is_told_as_open_and_never_asked(
    explore: Explore, tmp_path: Path, language: str
) -> None:
    """A robot without a label file shares a domain with one that has one: its recorder gets the pictures."""
    (tmp_path / "p.xml").write_text(POLICY)
    (tmp_path / "a.yaml").write_text("labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /recorder: conduit\n")
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(
        "fleet: 1\nrobots:\n  told: {policies: [p.xml], labels: [a.yaml], domain: lab}\n"
        "  bare: {policies: [p.xml], domain: lab}\n"
    )
    explorer = reviewed(explore, fleet, language=language)
    client, words = explorer.client(), Words(language)
    to_the_end(client)
    open_now = {one.element.full_name for one in open_elements(explorer.site.standing)}
    assert "bare:/recorder" in open_now
    summary = page(client, "/?step=summary")
    assert words("review.beyond") in summary.text_content()
    assert words.count(len(open_now), "review.end.open") in summary.text_content()
    whole = page(client, f"/?at={on('bare', '/recorder')}")
    assert words("review.beyond") in whole.text_content()
    assert not whole.xpath("//form[starts-with(@action, '/label')]")
    sent = {"version": str(explorer.session.version), "element": on("bare", "/recorder"), "role": "conduit", "by": "x"}
    assert client.post("/label", data={**sent, "about": "Video"}).status_code == 422
    for text in (client.get("/?step=summary").text, client.get(f"/?at={on('bare', '/recorder')}").text):
        if language != "en":
            shown = html.fromstring(text)
            for names in shown.xpath("//code | //option | //*[@lang='en'] | //b"):
                names.drop_tree()
            assert english_in(shown.text_content(), language) == []


def test_a_form_that_was_changed_is_refused_and_nothing_is_written(explore: Explore, hospital: Path) -> None:
    explorer = reviewed(explore, hospital)
    client = explorer.client()
    before = {path: path.read_bytes() for path in hospital.parent.iterdir()}
    at = f"/?at={on('carrier_lent', '/camera_driver')}"
    assert answer(client, "source", at, brings="Video", whose="/etc/passwd").status_code == 422
    one = on("carrier_01", "/camera_driver")
    sent = {"version": "0", "element": one, "role": "source", "brings": "Video", "by": NAME, "whose": "robot"}
    assert client.post("/label", data=sent).status_code == 422  # it has no file of its own
    assert explorer.session.version == 0
    assert before == {path: path.read_bytes() for path in hospital.parent.iterdir()}
