"""Of how many robots an answer is said: a fleet's session and an element in, out come label files to choose from."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.label_targets import Target
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words

MODEL, ROBOT = "model", "robot"
WHOSE = ("", MODEL, ROBOT)  # what a form can say; the first where it says nothing


class Whose(NamedTuple):
    """A label file that an answer can go to.

    Attributes
    ----------
    value
        ``MODEL`` or ``ROBOT``.
    """

    value: str
    told: str
    chosen: bool


def whose(session: Session, element: Element, words: Words) -> tuple[Whose, ...]:
    """Return what can be chosen; nothing where a session edits one label file.

    The robot's own file is chosen first where it already speaks of the element: there it outranks that of the model.
    """
    targets = session.targets_of(element)
    alone = [one.alone for one in targets]
    own = alone == [True] or (True in alone and session.said_of(element, only_this_robot=True) is not None)
    return tuple(Whose(ROBOT if one.alone else MODEL, target_told(one, words), one.alone == own) for one in targets)


def target_told(target: Target, words: Words) -> str:
    """Return in words of which robots it is said what goes to a label file.

    >>> from rosprivacy.explorer.label_targets import Target
    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> target_told(Target("carrier.labels.yaml", ("carrier_1", "carrier_2"), ("carrier",), alone=False), IN_ENGLISH)
    'of model carrier: 2 robots'
    """
    n, robot = len(target.robots), shown(target.robots[0])
    told = words("x.whose.robot", robot=robot) if n == 1 else words("x.whose.robots", n=n)
    if target.models and not target.alone:
        return words("x.whose.model", models=words.row(map(shown, target.models)), robots=told)
    return told


def robots_told(session: Session, robots: Sequence[str], words: Words) -> str:
    """Return in words on which robots something is tried: those of one model, or one.

    >>> from rosprivacy.explorer.fleet_session import FleetSession
    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> session = FleetSession.open_fleet("examples/fleet/fleet.yaml")
    >>> robots_told(session, session.robots_like("guide_01"), IN_ENGLISH)
    'of model guide: 12 robots'
    """
    n = len(robots)
    if n == 1:
        return words("x.whose.robot", robot=shown(robots[0]))
    told = words("x.whose.robots", n=n)
    model = session.model_of(robots[0])
    return words("x.whose.model", models=shown(model), robots=told) if model else told


def stands_for(standing: Standing, element: Element, words: Words) -> str:
    """Return in words for how many robots one stands, and whether it is not as its model; empty for one like itself."""
    parts = []
    fleet = standing.result.fleet
    if element.robot in standing.session.outliers:
        parts.append(words("x.outlier"))
    if fleet and (n := len(fleet.likeness.placed(element.robot))) > 1:
        parts.append(words("x.stands", n=n))
    return words.row(parts)
