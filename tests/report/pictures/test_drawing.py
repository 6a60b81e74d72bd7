"""The picture of a page: no name gets into Graphviz, nothing in it can run or style, and it is the same each time."""

from __future__ import annotations

import re
from itertools import islice

import pytest
from lxml import etree

from rosprivacy.analysis.text import printable
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.pictures import page_pictures as module
from rosprivacy.report.pictures.live_svg import Links, unnamed_dot
from rosprivacy.report.pictures.looks import DRAWN_ROLES, LINE_LOOKS, PALE
from rosprivacy.report.pictures.page_pictures import Drawing, Pictures, legend, picture_alone, style_sheet
from rosprivacy.report.pictures.phrases import TEXTS, Phrases
from rosprivacy.report.pictures.scenes import Scene, Scenes
from tests.helpers.graphs import care_home, factory
from tests.helpers.pictures import HOSTILE, hostile

LINKS = Links(name=lambda key: printable(key[2]), address=lambda key: f"/?at={len(key[2])}")
SVG = "{http://www.w3.org/2000/svg}"
SHAPES = ["path", "polygon", "polyline", "ellipse", "circle"]
DRAWS = {f"{SVG}{name}" for name in ["svg", "g", "a", "title", "desc", "text", *SHAPES]}
SAYS = {
    "class", "width", "height", "viewBox", "role", "aria-labelledby", "aria-describedby", "aria-label", "aria-current",
    "aria-hidden", "id", "transform", "href", "data-element", "d", "points", "x", "y", "cx", "cy", "rx", "ry", "r",
}  # fmt: skip


@pytest.fixture
def scene() -> Scene:
    return Scenes(care_home().analysis).of(("", "node", "/uplink"))


def test_graphviz_gets_only_letters_and_ids_of_our_own() -> None:
    dot = unnamed_dot(Scenes(hostile()).of(("", "topic", HOSTILE[0]), limit=100))
    labels = re.findall(r'label="([^"]*)"', dot)
    assert labels
    assert all(set(label.replace("\\n", "")) == {"n"} for label in labels)
    assert all(name not in dot for name in HOSTILE)
    assert dot.isascii()


def test_hostile_names_stand_in_it_as_text_and_nothing_runs_or_styles() -> None:
    scene = Scenes(hostile()).of(("", "topic", HOSTILE[0]), limit=100)
    with Drawing() as drawing:
        root = etree.fromstring(drawing.svg(scene, LINKS).encode())
    assert {element.tag for element in root.iter()} <= DRAWS
    assert {name for element in root.iter() for name in element.attrib} <= SAYS
    named = {element.get("data-element") for element in root.iter(f"{SVG}a")}
    assert named == {printable(box.key[2]) for box in scene.picture.boxes}
    titles = "".join(title.text or "" for title in root.iter(f"{SVG}title"))
    assert printable(HOSTILE[0]) in titles


def test_the_same_is_drawn_each_time(scene: Scene) -> None:
    again = Scenes(care_home().analysis).of(("", "node", "/uplink"))
    with Drawing() as one, Drawing() as other:
        assert one.svg(scene, LINKS) == one.svg(scene, LINKS) == other.svg(again, LINKS)


def test_every_box_stands_in_it_once_and_the_one_in_hand_is_told(scene: Scene) -> None:
    with Drawing() as drawing:
        root = etree.fromstring(drawing.svg(scene, LINKS).encode())
    boxes = list(root.iter(f"{SVG}a"))
    assert sorted(str(box.get("data-element")) for box in boxes) == sorted(box.key[2] for box in scene.picture.boxes)
    assert [box.get("data-element") for box in boxes if box.get("aria-current")] == ["/uplink"]
    numbers = [group.findtext(f"{SVG}text") for group in root.iter(f"{SVG}g") if group.get("class") == "number"]
    assert sorted(map(str, numbers)) == [str(n + 1) for n in range(len(numbers))]
    assert numbers


def test_a_picture_that_takes_too_long_says_so_and_the_next_one_is_drawn(scene: Scene) -> None:
    drawing = Drawing(seconds=1e-9)
    assert "0 seconds" in drawing.svg(scene).replace("1e-09", "0")
    drawing.close()
    with Drawing() as other:
        assert "/uplink" in other.svg(scene)


def test_without_graphviz_it_says_so(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "available", lambda: False)
    assert "Graphviz is not installed" in Drawing().svg(scene)


def test_layouts_are_remembered_up_to_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "REMEMBERED", 3)
    scenes = Scenes(factory(2).analysis)
    with Drawing() as drawing:
        for element in islice(scenes.analysis.graph.elements, 4):
            drawing.svg(scenes.of(element.identity))
        assert len(drawing._layouts) == 3


def test_each_look_has_its_rule() -> None:
    sheet = style_sheet()
    assert all(f".look-{name}" in sheet for name, look in DRAWN_ROLES.items() if look.colour != PALE)
    assert all(f".look-{name}" in sheet for name in LINE_LOOKS)
    assert "url(" not in sheet


def test_the_legend_tells_what_is_in_the_picture(scene: Scene) -> None:
    told = legend(scene)
    assert {f"look-{box.look}" for box in scene.picture.boxes} <= set(re.findall(r"look-\w+", told))
    assert "style=" not in told


@pytest.mark.parametrize("language", ["de", "fr"])
def test_a_picture_speaks_the_language_of_its_reader(language: str) -> None:
    say = Phrases.of_report(Words(language), {})
    assert set(say.texts) == set(TEXTS)
    with Pictures(say) as pictures:
        shown = pictures.of(factory(1).analysis, ("", "node", "/archive_server"))
    assert {"de": "Wie ", "fr": "Comment "}[language] in shown.title
    assert "Not drawn" not in "".join(shown.notes)
    assert "to decide now" not in shown.svg


def test_a_picture_alone_carries_its_style() -> None:
    root = etree.fromstring(picture_alone(factory(2).analysis).svg.encode())
    assert root.findtext(f"{SVG}style") == style_sheet()
