"""How a picture of the explorer looks, as a style sheet, and what its looks mean, as a list that stands beside it.

In: a ``Scene``. Out: the list as HTML, with only what is in the picture. The style sheet has the colours and widths of
``report/pictures/looks.py`` and is the same for every picture. Ink and paper are those of the page (``--picture-ink``,
``--picture-paper``), or else those of the reader's system, so that it is dark where the page is. Nothing hangs on
colour alone: a role is also an outline and a word, a kind is a shape, a line has a width and a head.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from rosprivacy.report.pictures.live_svg import SIZE, SMALL
from rosprivacy.report.pictures.looks import BLUE, DRAWN_ROLES, INK, KIND_LOOKS, LINE_LOOKS, OPEN, PALE, TEXT
from rosprivacy.report.pictures.picture import DRAWN, PRIVACY

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.pictures.looks import Look
    from rosprivacy.report.pictures.scenes import Scene

NODE, TOPIC, SERVICE = "node", "topic", "service"
_BLOCK = '<polygon class="area" points="4,3 28,3 28,15 4,15"/>'
_OVAL = '<ellipse class="area" cx="16" cy="9" rx="12" ry="6"/>'
_FORMS = {
    NODE: _OVAL,
    TOPIC: _BLOCK,
    SERVICE: '<rect class="area" x="4" y="3" width="24" height="12" rx="5"/>',
}
_DOUBLE = '<ellipse class="outline" cx="16" cy="9" rx="15" ry="8.5"/>'
_ITEM = '<li><svg class="picture" width="32" height="18" aria-hidden="true"><g class="{classes}">{form}</g></svg> '
_LINE = '<path class="outline" d="M2,9 L24,9"/><polygon class="area" points="24,5 31,9 24,13"/>'
_ENDS = '<path class="outline" d="M2,9 L28,9 M28,4 L28,14"/>'


class Sign(NamedTuple):
    """One look and its meaning.

    Attributes
    ----------
    classes
        Of the style sheet.
    form
        Its shapes, as SVG of 32 to 18 pixels.
    words
        What it means.
    """

    classes: str
    form: str
    words: str


def signs(scene: Scene) -> tuple[Sign, ...]:
    """Return what of a picture needs to be explained: roles, then kinds of elements, then lines."""
    picture = scene.picture
    looks = {box.look for box in picture.boxes} | ({OPEN} if any(box.open for box in picture.boxes) else set())
    kinds, lines = {box.kind for box in picture.boxes}, {line.look for line in picture.lines}
    forms = _FORMS if picture.view == PRIVACY else {kind: _FORMS.get(kind, _BLOCK) for kind in DRAWN}
    found = [
        Sign(
            f"box look-{name}{' open' if name == OPEN else ''}",
            _OVAL + (_DOUBLE if look.double else ""),
            picture.say(f"picture.look.{name}"),
        )
        for name, look in DRAWN_ROLES.items()
        if name in looks
    ]
    for kind, form in forms.items():
        if kind in kinds:  # where there are no roles, kinds have colours
            coloured = f" look-{kind}" if kind in looks else ""
            found.append(Sign(f"box kind-{kind}{coloured}", form, picture.say(f"picture.look.{kind}")))
    found += [
        Sign(f"line look-{name}", _ENDS if look.head == "tee" else _LINE, picture.say(f"picture.look.{name}"))
        for name, look in LINE_LOOKS.items()
        if name in lines
    ]
    if any(line.pseudonymised for line in picture.lines):
        found.append(Sign("line hidden", _LINE, picture.say("picture.dashed")))
    return tuple(found)


def legend(scene: Scene) -> Markup:
    """Return the legend as a list of HTML.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.report.pictures.scenes import Scenes
    >>> "leak: lets data out" in legend(Scenes(analyse(*factory())).of())
    True
    """
    items = (Markup(_ITEM).format(classes=sign.classes, form=Markup(sign.form)) + sign.words for sign in signs(scene))  # noqa: S704 - forms of our own
    return Markup('<ul class="picture-legend">') + Markup("").join(items) + Markup("</ul>")


FONT = "system-ui, Helvetica, Arial, sans-serif"
DASHED, DOTTED = "6 3", "2 3"
_HEAD = f"""\
.picture {{ color: var(--picture-ink, CanvasText); font: {SIZE}px {FONT}; max-width: none; }}
.picture text {{ fill: currentColor; stroke: none; text-anchor: middle; }}
.picture .word {{ font-size: {SMALL}px; }}
.picture .area, .picture .outline {{ stroke: currentColor; stroke-width: 1; }}
.picture .outline {{ fill: none; }}
.picture .area {{ fill: var(--picture-paper, Canvas); }}
.picture .box {{ cursor: pointer; }}
.picture .box.open .area, .picture .box.open .outline {{ stroke-dasharray: {DASHED}; }}
.picture .box:focus {{ outline: none; }}
.picture .box:hover .area, .picture .box:focus .area {{ stroke: {BLUE}; stroke-width: 3; }}
.picture .box.focus .area {{ stroke: {BLUE}; stroke-width: 5; stroke-dasharray: none; }}
.picture .box.focus .name {{ font-weight: bold; }}
.picture .box:focus-visible {{ outline: 3px solid {BLUE}; outline-offset: 3px; }}
.picture-legend {{ list-style: none; margin: 0; padding: 0; display: flex; flex-wrap: wrap; gap: 0.2rem 1rem; }}
.picture-legend svg {{ vertical-align: middle; }}
.picture .line .area {{ fill: currentColor; }}
.picture .line.hidden .outline {{ stroke-dasharray: {DASHED}; }}
.picture .number circle {{ fill: {BLUE}; stroke: var(--picture-paper, Canvas); stroke-width: 1.5; }}
.picture .number text {{ fill: {PALE}; font-weight: bold; }}
"""


def style_sheet() -> str:
    """Return the style sheet.

    >>> "look-leak" in style_sheet()
    True
    """
    return "".join([_HEAD, *_boxes(), *_lines()])


def _boxes() -> Iterator[str]:
    for name, look in (*DRAWN_ROLES.items(), *KIND_LOOKS.items()):
        box = f".picture .box.look-{name}"
        if look.colour != PALE:
            yield f"{box} > .area {{ fill: {look.colour}; }}\n{box} text {{ fill: {TEXT}; }}\n"
        if look.width != 1:
            yield f"{box}:not(.focus) > .area {{ stroke-width: {look.width:g}; }}\n"


def _lines() -> Iterator[str]:
    for name, look in LINE_LOOKS.items():
        line = f".picture .line.look-{name}"
        colour = "currentColor" if look.colour == INK else look.colour
        yield f"{line} > .outline {{ stroke: {colour}; stroke-width: {look.width:g};{_dashes(look)} }}\n"
        yield f"{line} > .area {{ stroke: {colour}; fill: {colour}; }}\n"


def _dashes(look: Look) -> str:
    return {"dashed": f" stroke-dasharray: {DASHED};", "dotted": f" stroke-dasharray: {DOTTED};"}.get(look.style, "")
