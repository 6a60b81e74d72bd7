"""A legend stands in a corner, lies on nothing, explains what is in its picture, and leaves nine tenths to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from rosprivacy.report.pictures.corner_legend import (
    APART,
    SHARE,
    SIZES,
    Box,
    DrawnBoxes,
    around,
    drawn_boxes,
    legend_place,
)
from rosprivacy.report.pictures.graphviz import DIRECTIONS, drawn
from rosprivacy.report.pictures.looks import KIND_LOOKS, LINE_LOOKS, SHAPES, LegendEntry, legend
from rosprivacy.report.pictures.picture import DRAWN
from tests.helpers.pictures import pictures

if TYPE_CHECKING:
    from rosprivacy.report.pictures.picture import Picture

SVG = "{http://www.w3.org/2000/svg}"
ENTRIES = [
    *(LegendEntry(KIND_LOOKS[kind], kind, SHAPES[kind]) for kind in DRAWN),
    *(LegendEntry(look, look.words) for look in LINE_LOOKS.values()),
]
SIDE = st.floats(1, 400)


@st.composite
def rectangles(draw: st.DrawFn) -> Box:
    west, south = draw(st.floats(0, 2000)), draw(st.floats(0, 1500))
    return Box(west, south, west + draw(SIDE), south + draw(SIDE))


BOXES = st.lists(rectangles(), min_size=1, max_size=12)


@given(BOXES, st.lists(st.sampled_from(ENTRIES), min_size=1, max_size=12))
def test_it_lies_on_nothing_and_is_as_large_as_a_tenth_allows(boxes: list[Box], entries: list[LegendEntry]) -> None:
    place = legend_place(entries, DrawnBoxes(tuple(boxes), ()))
    near = [box for box in boxes if place.box.meets(box._replace(west=box.west + 1e-6, east=box.east - 1e-6))]
    content = around(boxes)
    outside = place.box.north <= content.south - APART + 1e-6 or place.box.west >= content.east + APART - 1e-6
    assert outside or not near
    assert place.whole == around([content, place.box])
    assert place.shape.size == SIZES[-1] or place.box.area <= SHARE * place.whole.area


def test_a_free_corner_is_taken_and_the_picture_stays_as_large_as_it_is() -> None:
    everything = Box(0, 0, 2000, 1500)
    boxes = (Box(0, 1000, 2000, 1500), Box(0, 0, 900, 1000))
    place = legend_place(ENTRIES[:6], DrawnBoxes(boxes, ()))
    assert place.whole == everything
    assert (place.box.east, place.box.south) == (2000, 0)
    assert place.shape.size == SIZES[0]


def parts(svg: bytes) -> tuple[list[Box], list[Box], Box]:
    """What is drawn, the legend, and the whole, of a file."""
    root = etree.fromstring(svg)
    others: list[Box] = []
    samples: list[Box] = []
    for group in root.iter(f"{SVG}g"):
        if group.get("class") in ("node", "edge", "cluster"):
            wrapped = b'<svg xmlns="http://www.w3.org/2000/svg">%b</svg>' % etree.tostring(group, with_tail=False)
            here = samples if str(group.get("id"))[0] in "ltsk" else others
            here += drawn_boxes(wrapped).drawn
    _, _, width, height = map(float, root.get("viewBox", "").split())
    return others, samples, Box(0, 0, width, height)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("name", pictures())
def test_each_picture_has_its_legend_beside_what_is_drawn(name: str, direction: str) -> None:
    picture = pictures()[name]
    data = drawn(picture, "svg", direction=direction).data
    boxes, samples, whole = parts(data)
    strip = around(samples)
    inside = strip._replace(west=strip.west + 2, south=strip.south + 2, east=strip.east - 2, north=strip.north - 2)
    assert not [box for box in boxes if overlap(inside, box)]
    assert strip.area <= max(SHARE * whole.area, smallest(picture))
    words = [text.text for text in etree.fromstring(data).iter(f"{SVG}text")]
    for entry in legend(picture):
        assert words.count(entry.words.replace(" ", "\xa0")) + words.count(entry.words) >= 1


def overlap(one: Box, other: Box) -> bool:
    return one.west < other.east and other.west < one.east and one.south < other.north and other.south < one.north


def smallest(picture: Picture) -> float:
    """How much the legend takes in the smallest letters: what a very small picture has to bear."""
    (size,) = SIZES[-1:]
    return sum((len(entry.words) + 8) * size * size * 1.3 for entry in legend(picture))


def test_the_legend_of_an_example_takes_less_than_a_tenth() -> None:
    shares = {}
    for name, picture in pictures().items():
        _, samples, whole = parts(drawn(picture, "svg", direction="").data)
        shares[name] = around(samples).area / whole.area
    assert {name: share for name, share in shares.items() if share > SHARE} == {}
