"""The looks of pictures as a style sheet of the Neo4j Browser (GraSS), where every node is a circle.

In: which labels and types stand for what. Out: text. A kind of element is the colour of the area, a role the outline:
in the Browser both views are one. Of several rules that fit, the last one holds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.pictures.looks import (
    DATA,
    INK,
    KIND_LOOKS,
    LEAK,
    LINE_LOOKS,
    OTHER,
    PALE,
    ROLE_LOOKS,
    SANITIZER,
    SOURCE,
    TEXT,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

OUTLINED = (SANITIZER, SOURCE, LEAK)  # the one that counts most last, as on a box of a picture
DIAMETER = 60  # of a node, in pixels: a name has some room
CARRYING = 3  # pixels: the Browser draws where data goes beside the flow that allows it
TIMES = 2  # how much wider outlines are than on paper, where shapes tell more


def grass(
    kinds: Mapping[str, str],
    roles: Mapping[str, Iterable[str]],
    types: Mapping[str, str],
    captions: Mapping[str, str],
) -> str:
    """Return the style sheet.

    Parameters
    ----------
    kinds
        Label -> kind of element.
    roles
        ``source``, ``leak``, ``sanitizer`` -> the labels that say so.
    types
        Type of relationships -> look of a line.
    captions
        Label of what is no element -> the property that names it.
    """
    return "".join(_rules(kinds, roles, types, captions))


def _rules(
    kinds: Mapping[str, str], roles: Mapping[str, Iterable[str]], types: Mapping[str, str], captions: Mapping[str, str]
) -> Iterator[str]:
    text = {"text-color-internal": TEXT, "font-size": "10px"}
    yield _rule("node", diameter=f"{DIAMETER}px", **_area(PALE), **text, caption="'{name}'")
    line = {"padding": "3px", "font-size": "8px", "text-color-external": INK, "text-color-internal": PALE}
    yield _rule("relationship", **_line(LINE_LOOKS[OTHER].colour, 1), **line, caption="'<type>'")
    for label, name in captions.items():
        yield _rule(f"node.{label}", **_area(PALE), **text, caption=f"'{{{name}}}'")
    for label, kind in kinds.items():
        yield _rule(f"node.{label}", **_area(KIND_LOOKS[kind].colour), **text, caption="'{name}'")
    for role in OUTLINED:
        look = ROLE_LOOKS[role]
        for label in roles[role]:
            border = {"border-color": look.colour, "border-width": f"{max(look.width, 1 + TIMES) * TIMES:g}px"}
            yield _rule(f"node.{label}", **border)
    for type_, name in types.items():
        width = CARRYING if name == DATA else LINE_LOOKS[name].width
        yield _rule(f"relationship.{type_}", **_line(LINE_LOOKS[name].colour, width))


def _area(colour: str) -> dict[str, str]:
    return {"color": colour, "border-color": INK, "border-width": "1px"}


def _line(colour: str, width: float) -> dict[str, str]:
    return {"color": colour, "shaft-width": f"{width:g}px"}


def _rule(selector: str, **properties: str) -> str:
    lines = "".join(f"  {name.replace('_', '-')}: {value};\n" for name, value in properties.items())
    return f"{selector} {{\n{lines}}}\n"
