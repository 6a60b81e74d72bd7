"""How boxes and lines look, and what a legend says of them; the same as a style sheet of the Neo4j Browser (GraSS).

The colours are those of Okabe and Ito, which people tell apart whatever their colour vision. None of them stands alone:
kinds have shapes, roles have outlines and words, lines have widths, dashes and heads. In the Browser every node is a
circle: a kind of element is the colour of the area, a role the outline, for there both views are one. Of several rules
that fit, the last one holds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.report.pictures.picture import DRAWN, GROUP, PRIVACY, RECORD, Picture

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

INK = "#000000"  # lines, outlines, and text on the paper
TEXT = "#111111"  # text on a filled box
PAPER = "#ffffff"
GRAY, PALE = "#d0d0d0", "#ffffff"
QUIET = "#767676"
ORANGE, SKY, GREEN, YELLOW = "#e69f00", "#56b4e9", "#009e73", "#f0e442"
RED, PURPLE, BLUE = "#d55e00", "#cc79a7", "#0072b2"


@dataclass(frozen=True, slots=True)
class Shape:
    """Of a kind of element.

    Attributes
    ----------
    graphviz
        Name of the shape, and of the style if it has one.
    mermaid
        What opens and closes the shape.
    """

    graphviz: tuple[str, str]
    mermaid: tuple[str, str]


@dataclass(frozen=True, slots=True)
class Look:
    """Of a box or a line.

    Attributes
    ----------
    words
        For the legend.
    colour
        Of the area of a box, or of a line.
    width
        Of the line or outline, in points.
    style
        ``solid``, ``dashed`` or ``dotted``.
    double
        Whether the outline is so.
    head
        Of a line.
    """

    words: str
    colour: str
    width: float = 1.0
    style: str = "solid"
    double: bool = False
    head: str = "normal"


SHAPES = {
    "node": Shape(("ellipse", ""), ("([", "])")),
    "topic": Shape(("box", ""), ("[", "]")),
    "service": Shape(("box", "rounded"), ("[[", "]]")),
    "action": Shape(("component", ""), ("{{", "}}")),
    "storage": Shape(("cylinder", ""), ("[(", ")]")),
    "external-system": Shape(("house", ""), (">", "]")),
    "shared-memory": Shape(("parallelogram", ""), ("[/", "/]")),
    "side-channel": Shape(("hexagon", ""), ("[\\", "\\]")),
    "device": Shape(("box3d", ""), ("[/", "\\]")),
    "display": Shape(("tab", ""), ("[\\", "/]")),
    "participant": Shape(("septagon", ""), ("{{", "}}")),
    "person": Shape(("octagon", ""), ("((", "))")),
    RECORD: Shape(("note", ""), ("[", "]")),
    GROUP: Shape(("folder", ""), ("[[", "]]")),
}

KIND_LOOKS = {
    "node": Look("node", GRAY),
    "topic": Look("topic", SKY),
    "service": Look("service", ORANGE),
    "action": Look("action", GREEN),
    "storage": Look("storage", YELLOW),
    "external-system": Look("external system", YELLOW),
    "shared-memory": Look("shared memory", YELLOW),
    "side-channel": Look("side channel", YELLOW),
    "device": Look("device", YELLOW),
    "display": Look("display", YELLOW),
    "participant": Look("participant", YELLOW),
    "person": Look("person", YELLOW),
    RECORD: Look("other node, with its labels", PALE),
    GROUP: Look("several elements drawn as one", PALE),
}

SOURCE, LEAK, DERIVATION, SANITIZER, END = "source", "leak", "derivation", "sanitizer", "end"
REVIEWED, OPEN, UNTOUCHED = "reviewed", "open", "untouched"
ROLE_LOOKS = {
    SOURCE: Look("source: brings data in", SKY, width=3.0),
    LEAK: Look("way out: lets data out", RED, width=1.5, double=True),
    DERIVATION: Look("makes one kind of data of another", PURPLE, width=1.5),
    SANITIZER: Look("cleans, but not all", GREEN, width=1.5),
    REVIEWED: Look("reviewed: passes on what it gets", GRAY),
    OPEN: Look("not reviewed yet", PALE, style="dashed"),
}
# The privacy view leaves out what ends all data, and what none gets to; a query can give the one, the explorer both.
DRAWN_ROLES = {
    **ROLE_LOOKS,
    END: Look("ends what comes to it", GREEN, width=1.5, double=True),
    UNTOUCHED: Look("carries none of it", PALE, width=0.8),
}

ALLOWED, MATCHES, DENIED = "allowed", "matches", "denied"
CLEANED, DATA, WAY, SHORTEST, OTHER = "cleaned", "data", "way", "shortest", "other"
BEYOND, ONWARD = "beyond", "onward"
QUESTIONED = "asked"
LINE_LOOKS = {
    ALLOWED: Look("allowed, in the direction of the data", INK),
    MATCHES: Look("the wildcard covers it", INK, style="dotted"),
    DENIED: Look("denied", QUIET, style="dashed", head="tee"),
    CLEANED: Look("data gets there, said to be cleaned there", INK, width=0.8, head="tee"),
    DATA: Look("data can go here", INK),
    WAY: Look("on a path to a way out", RED, width=2.2),
    SHORTEST: Look("on the shortest path to a way out", RED, width=4.5),
    BEYOND: Look("beyond the node's own profile: only its enclave allows it", PURPLE, 3.0, "dashed", head="vee"),
    ONWARD: Look("data can go here only then", PURPLE, width=1.5),
    QUESTIONED: Look("how data gets to what is asked about, step by step", BLUE, width=3.0),
    OTHER: Look("relationship of this type, no flow", QUIET, head="vee"),
}


@dataclass(frozen=True, slots=True)
class LegendEntry:
    """One line of a legend: how it looks, what it means; a box if it has a shape, else a line."""

    look: Look
    words: str
    shape: Shape | None = None


def box_look(view: str, look: str) -> Look:
    """Return how a box of a view looks."""
    return (DRAWN_ROLES if view == PRIVACY else KIND_LOOKS)[look]


def legend(picture: Picture) -> list[LegendEntry]:
    """Return what of a picture needs to be explained: no more than what is in it."""
    kinds = [kind for kind in DRAWN if any(box.kind == kind for box in picture.boxes)]
    entries = []
    if picture.view == PRIVACY:
        used = {box.look for box in picture.boxes} | ({OPEN} if any(box.open for box in picture.boxes) else set())
        roles = {name: look for name, look in DRAWN_ROLES.items() if name in used}
        entries += [
            LegendEntry(look, picture.say(f"picture.look.{name}"), SHAPES["node"]) for name, look in roles.items()
        ]
        blank = Look("", PALE)
        entries += [LegendEntry(blank, picture.say(f"picture.look.{kind}"), SHAPES[kind]) for kind in kinds]
    else:
        entries += [LegendEntry(KIND_LOOKS[kind], picture.say(f"picture.look.{kind}"), SHAPES[kind]) for kind in kinds]
    drawn = {line.look for line in picture.lines}
    entries += [
        LegendEntry(look, picture.say(f"picture.look.{name}")) for name, look in LINE_LOOKS.items() if name in drawn
    ]
    if any(line.pseudonymised for line in picture.lines):
        entries.append(LegendEntry(Look("", INK, style="dashed"), picture.say("picture.dashed")))
    return entries


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
