"""How a picture of the explorer looks: the colours and widths of ``report/pictures/looks.py`` as a style sheet.

Out: CSS, the same for every picture. Ink and paper are those of the page (``--picture-ink``, ``--picture-paper``), or
else those of the reader's system, so that it is dark where the page is. Nothing hangs on colour alone: a role is also
an outline and a word, a kind is a shape, a line has a width and a head.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.report.explorer.unnamed_dot import SIZE, SMALL
from rosprivacy.report.pictures.looks import BLUE, DRAWN_ROLES, INK, KIND_LOOKS, LINE_LOOKS, PALE, TEXT

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.report.pictures.looks import Look

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
