"""What the looks of a picture mean: only what is in it, as a list that stands beside it in a page.

In: a ``Scene``. Out: ``Sign`` facts, or the list as HTML, which looks as the picture does (``style_sheet.py``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from markupsafe import Markup

from rosprivacy.report.pictures.looks import DRAWN_ROLES, LINE_LOOKS, OPEN
from rosprivacy.report.pictures.picture import DRAWN, PRIVACY

if TYPE_CHECKING:
    from rosprivacy.report.explorer.scenes import Scene

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
            picture.say(f"pic.look.{name}"),
        )
        for name, look in DRAWN_ROLES.items()
        if name in looks
    ]
    for kind, form in forms.items():
        if kind in kinds:  # where there are no roles, kinds have colours
            coloured = f" look-{kind}" if kind in looks else ""
            found.append(Sign(f"box kind-{kind}{coloured}", form, picture.say(f"pic.look.{kind}")))
    found += [
        Sign(f"line look-{name}", _ENDS if look.head == "tee" else _LINE, picture.say(f"pic.look.{name}"))
        for name, look in LINE_LOOKS.items()
        if name in lines
    ]
    if any(line.pseudonymised for line in picture.lines):
        found.append(Sign("line hidden", _LINE, picture.say("pic.dashed")))
    return tuple(found)


def legend(scene: Scene) -> Markup:
    """Return the legend as a list of HTML.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.report.explorer.scenes import Scenes
    >>> "leak: lets data out" in legend(Scenes(analyse(*factory())).of())
    True
    """
    items = (Markup(_ITEM).format(classes=sign.classes, form=Markup(sign.form)) + sign.words for sign in signs(scene))  # noqa: S704 - forms of our own
    return Markup('<ul class="picture-legend">') + Markup("").join(items) + Markup("</ul>")
