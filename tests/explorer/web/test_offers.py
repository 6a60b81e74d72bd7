"""Suggestions on the page: none that could close a known finding is taken by one key."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from lxml import html

from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.review_site import open_elements
from rosprivacy.report.catalogs.words import Words
from tests.helpers.explorers import Explorer, label, node
from tests.helpers.little_robots import policy_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from starlette.testclient import TestClient

    Explore = Callable[..., Explorer]

RIGHTS = {"camera": (["/battery_state"], []), "box": ([], ["/battery_state"])}
LABELS = "labels: 1\nnodes:\n  /camera: {source: [Video, Voice]}\n  /box: {leak: [Video]}\n"
WITHOUT_LEAK = LABELS.replace("leak: [Video]", "conduit: [Video, Voice]")
FINDING = "video of persons: {}/camera → {}/box"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Pictures and voices go through a channel of that name; the pictures go on to a leak."""
    (tmp_path / "robot.policy.xml").write_text(policy_of(RIGHTS), "utf-8")
    (tmp_path / "labels.yaml").write_text(LABELS, "utf-8")
    return tmp_path


def battery(client: TestClient, robot: str = "") -> html.HtmlElement:
    at = element_id((robot, "topic", "/battery_state"))
    return html.fromstring(client.get(f"/?at={at}").text)


def opened(explore: Explore, robot: Path, **how: object) -> Explorer:
    return explore(robot / "robot.policy.xml", robot / "labels.yaml", **how)


def test_what_could_close_a_finding_has_no_key_and_no_button(explore: Explore, robot: Path) -> None:
    page = battery(opened(explore, robot).client())
    by_hand = page.cssselect(".offer")[0]
    assert "carries nothing of video of persons (may)" in by_hand.text_content()
    assert [one.text_content() for one in by_hand.cssselect("li")] == [FINDING.format("", "")]
    assert not by_hand.cssselect("button, input")
    assert not page.cssselect("[data-key=a]")
    assert page.cssselect("#answers [data-key=m]")  # a person who knows can say so


def test_what_closes_none_keeps_its_key_and_says_that_it_takes_data_away(explore: Explore, robot: Path) -> None:
    (robot / "labels.yaml").write_text(WITHOUT_LEAK, "utf-8")
    explorer = opened(explore, robot)
    client = explorer.client()
    offer = next(form for form in battery(client).forms if form.get("class") == "offer")
    assert offer.cssselect("button[data-key=a]")
    assert Words("en")("explorer.offer.takes") in offer.text_content()
    assert client.post("/label", data=dict(offer.form_values())).status_code == 303
    assert explorer.session.version == 1


def test_what_adds_data_says_nothing_of_that(explore: Explore, robot: Path) -> None:
    (robot / "labels.yaml").write_text("labels: 1\n", "utf-8")
    page = html.fromstring(opened(explore, robot).client().get(f"/?at={node('/camera')}").text)
    assert page.cssselect("form.offer button[data-key=a]")
    assert Words("en")("explorer.offer.takes") not in page.text_content()


def test_a_review_names_the_findings_beside_the_guess(explore: Explore, robot: Path) -> None:
    page = battery(opened(explore, robot, review=True).client())
    assert Words("en")("review.guess.closes") in page.text_content()
    assert FINDING.format("", "") in page.text_content()
    (robot / "labels.yaml").write_text(WITHOUT_LEAK, "utf-8")
    page = battery(opened(explore, robot, review=True).client())
    assert Words("en")("review.guess.closes") not in page.text_content()
    assert Words("en")("explorer.offer.takes") in page.text_content()


def test_of_a_fleet_it_is_the_same(explore: Explore, robot: Path) -> None:
    fleet = robot / "fleet.yaml"
    fleet.write_text(
        "fleet: 1\nmodels:\n  m: {policies: [robot.policy.xml], labels: [labels.yaml]}\n"
        "robots:\n  m_1: {model: m}\n  m_2: {model: m}\n",
        "utf-8",
    )
    page = battery(explore(fleet, fleet, fleet=True).client(), "m_1")
    assert [one.text_content() for one in page.cssselect(".by-hand li")] == [FINDING.format("m_1:", "m_1:")]
    assert not page.cssselect("[data-key=a]")


def test_an_answer_about_every_kind_leaves_what_is_made_of_data(explore: Explore, robot: Path) -> None:
    said = LABELS.replace("leak: [Video]", "leak: [Video], derives: [{from: Video, to: FaceTemplate}]")
    (robot / "labels.yaml").write_text(said, "utf-8")
    explorer = opened(explore, robot)
    client = explorer.client()
    assert label(client, node("/box"), "conduit", about="*").status_code == 303
    box = next(one for one in explorer.session.result.analysis.graph.elements if one.name == "/box")
    assert explorer.session.entry_for(box)["derives"] == [{"from": "Video", "to": "FaceTemplate"}]
    gone = Words("en")("explorer.derives.gone", data="face template")
    assert gone not in client.get("/").text
    assert label(client, node("/box"), "absent", reason="only in tests").status_code == 303
    assert "derives" not in explorer.session.entry_for(box)
    assert gone in client.get("/").text


def rows_of(page: html.HtmlElement) -> list[tuple[str, str]]:
    """Name and what is told of each element that is suggested; the list is there whether it is folded or not."""
    found = page.xpath("//ol[@class='rows']/li/a[starts-with(@id, 'suggested-')]")
    return [(row.xpath("string(bdi)"), row.xpath("string(span)")) for row in found]


def folded(page: html.HtmlElement) -> bool:
    """Whether the list of what is suggested is folded."""
    return bool(page.xpath("//details[@id='g-suggested' and not(@open)]"))


def test_a_row_says_what_is_surest_and_a_list_with_a_likely_source_is_not_folded(
    explore: Explore, tmp_path: Path
) -> None:
    """The camera with its video before /amcl; body pose is never what its row says."""
    nodes = {
        "amcl": (["/particle_cloud"], ["/scan"]),
        "camera": (["/image", "/tf_static"], []),
        "mapper": (["/map"], []),
    }
    types = {"particle_cloud": "nav2_msgs/msg/ParticleCloud", "image": "sensor_msgs/msg/Image"}
    types |= {"tf_static": "tf2_msgs/msg/TFMessage", "map": "nav_msgs/msg/OccupancyGrid"}
    said = "".join(f"  /{name}: {{types: [{of}]}}\n" for name, of in types.items())
    (tmp_path / "robot.policy.xml").write_text(policy_of(nodes), "utf-8")
    (tmp_path / "labels.yaml").write_text(f"labels: 1\ntopics:\n{said}", "utf-8")
    explorer = opened(explore, tmp_path)
    client = explorer.client()
    page = html.fromstring(client.get("/").text)
    rows = rows_of(page)
    assert rows[0][0] == page.xpath("string(//h2[@id='h-element']/bdi)") == "/camera", "it is in hand first"
    assert rows[0][1].endswith("brings in video of persons (likely)")
    assert open_elements(explorer.site.standing)[0].element.name == "/camera", "a review begins with it, too"
    told = [one.xpath("string(.//p/b)") for one in page.cssselect(".offer")]
    assert told.index("brings in video of persons (likely)") == 0
    assert "brings in body pose (may)" in told[1:]
    assert label(client, node("/mapper"), "source", brings="HomeMap").status_code == 303
    assert not folded(html.fromstring(client.get("/").text)), "the camera is likely a source"
    assert label(client, node("/camera"), "source", brings="Video").status_code == 303
    left = html.fromstring(client.get("/").text)
    assert "/camera" in dict(rows_of(left)), "body pose is asked about"
    assert folded(left), "nothing is likely any more"


@pytest.mark.parametrize(("entry", "told"), [("", True), ("  /cloud_uploader: conduit\n", False)])
def test_that_a_node_lets_data_out_is_told_although_a_glob_calls_it_a_conduit(
    explore: Explore, tmp_path: Path, entry: str, *, told: bool
) -> None:
    """S11: a glob has not seen the node; a person's full name has."""
    nodes = {"camera": (["/image"], []), "cloud_uploader": ([], ["/image"]), "recorder": ([], ["/other"])}
    (tmp_path / "robot.policy.xml").write_text(policy_of(nodes), "utf-8")
    said = f'labels: 1\nnodes:\n  /camera: {{source: [Video]}}\n  "/*": conduit\n{entry}topics:\n  /image: sensitive\n'
    (tmp_path / "labels.yaml").write_text(said, "utf-8")
    page = html.fromstring(opened(explore, tmp_path).client().get("/").text)
    assert [name for name, _ in rows_of(page)] == (["/cloud_uploader"] if told else [])  # nothing gets to the recorder


CAMERA = {"camera": (["/camera/image_raw"], []), "box": ([], ["/camera/image_raw"])}
IN_FLEET = ("m_1", "node", "/camera")
TYPED = "labels: 1\ntopics: {/camera/image_raw: {types: [sensor_msgs/msg/Image]}}\n"


def ticks_of_camera(client: TestClient) -> html.FormElement:
    page = html.fromstring(client.get(f"/?at={element_id(IN_FLEET)}").text)
    (form,) = (form for form in page.forms if form.get("class") == "ticks")
    return form


@pytest.fixture
def camera(robot: Path) -> Path:
    (robot / "robot.policy.xml").write_text(policy_of(CAMERA), "utf-8")
    (robot / "labels.yaml").write_text(TYPED, "utf-8")
    said = "fleet: 1\nmodels:\n  m: {policies: [robot.policy.xml], labels: [labels.yaml]}\nrobots:\n  m_1: {model: m}\n"
    (robot / "fleet.yaml").write_text(said, "utf-8")
    return robot


def said_of_camera(explorer: Explorer) -> object:
    return explorer.session.entry_for(explorer.site.standing.elements[element_id(IN_FLEET)])


def test_what_is_ticked_is_taken_as_one_answer(explore: Explore, camera: Path) -> None:
    """Of a fleet, which has no screens: what is likely is ticked, the rest stays open, one undo takes it back."""
    explorer = explore(camera / "fleet.yaml", camera / "fleet.yaml", fleet=True)
    client = explorer.client()
    form = ticks_of_camera(client)
    boxes = {one.text_content().strip(): one.cssselect("input")[0] for one in form.cssselect("label")}
    ticked = [text for text, box in boxes.items() if box.get("checked") is not None]
    assert len(ticked) == 1 < len(boxes), boxes
    assert ticked[0].startswith("brings in video of persons")
    assert client.post("/offers", data=dict(form.form_values())).status_code == 303
    assert said_of_camera(explorer) == {"source": ["Video"]}
    assert explorer.session.version == 1
    assert explorer.session.undo()
    assert said_of_camera(explorer) is None


def test_several_ticks_are_one_label_and_none_can_hide_a_leak(explore: Explore, camera: Path) -> None:
    explorer = explore(camera / "fleet.yaml", camera / "fleet.yaml", fleet=True)
    client = explorer.client()
    form = ticks_of_camera(client)
    fields = {name: value for name, value in form.form_values() if name != "offer"}
    offers = [box.get("value") for box in form.cssselect("input[type=checkbox]")]
    assert client.post("/offers", data={**fields, "offer": offers}).status_code == 303
    roles = said_of_camera(explorer)
    assert isinstance(roles, dict)
    assert set(roles) <= {"source", "leak", "derives"}
    assert len(roles["source"]) > 1
    for wrong in ([], ["99"], ["x"]):
        fields["version"] = str(explorer.session.version)
        assert client.post("/offers", data={**fields, "offer": wrong}).status_code == 422
