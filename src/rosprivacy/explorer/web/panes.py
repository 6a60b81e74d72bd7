"""What the parts of a page are made of: ``Pane``, and what several of them say of data and of robots."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.label_files import LabelTarget
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.catalogs.words import Words

MODEL, ROBOT = "model", "robot"
ROBOT_OR_MODEL = ("", MODEL, ROBOT)  # what a form can say; the first where it says nothing


class Pane(SimpleNamespace):
    """A part of a page, or of another pane: facts under the names by which its template reads them.

    All texts are plain; the templates escape them. Names of inputs are printable.
    """


def title_of(kind: str, vocabulary: Vocabulary, words: Words) -> str:
    """Return what a kind of data is called; empty for every kind."""
    if not kind:
        return words("explorer.every")
    category = vocabulary.categories[kind]
    return category.translations.get(words.language, {}).get("title") or category.title


def titles_of(vocabulary: Vocabulary, words: Words) -> dict[str, str]:
    """Return what every kind of data is called."""
    return {name: title_of(name, vocabulary, words) for name in vocabulary.categories}


def robot_or_model(session: Session, element: Element, words: Words) -> tuple[Pane, ...]:
    """Return the label files of a fleet that an answer can go to: nothing where a session edits one file.

    The robot's own file is chosen first where it already speaks of the element: there it outranks that of the model.
    """
    targets = session.targets_of(element) if session.is_fleet else ()
    alone = [target.alone for target in targets]
    own = alone == [True] or (True in alone and session.entry_for(element, only_this_robot=True) is not None)
    return tuple(
        Pane(value=ROBOT if target.alone else MODEL, told=in_words(target, words), chosen=target.alone == own)
        for target in targets
    )


def in_words(target: LabelTarget, words: Words) -> str:
    """Return of which robots it is said what goes to a label file.

    >>> from rosprivacy.explorer.label_files import LabelTarget
    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> in_words(LabelTarget("carrier.labels.yaml", ("carrier_1", "carrier_2"), ("carrier",), alone=False), IN_ENGLISH)
    'of model carrier: 2 robots'
    """
    models = () if target.alone else target.models
    return _robots(target.robots, words.row(map(shown, models)), words)


def robots_in_words(session: Session, robots: Sequence[str], words: Words) -> str:
    """Return on which robots something is tried: those of one model, or one.

    >>> from rosprivacy.explorer.session import Session
    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> session = Session.open_fleet("examples/fleet/fleet.yaml")
    >>> robots_in_words(session, session.robots_like("guide_01"), IN_ENGLISH)
    'of model guide: 12 robots'
    """
    return _robots(robots, shown(session.model_of(robots[0])) if len(robots) > 1 else "", words)


def _robots(robots: Sequence[str], models: str, words: Words) -> str:
    n = len(robots)
    counted = words("explorer.whose.robot", robot=shown(robots[0])) if n == 1 else words("explorer.whose.robots", n=n)
    return words("explorer.whose.model", models=models, robots=counted) if models else counted


def stands_for(standing: Standing, element: Element, words: Words) -> str:
    """Return for how many robots one stands, and whether it is not as its model; empty for one like itself."""
    parts = []
    fleet = standing.result.fleet
    if element.robot in standing.session.outliers:
        parts.append(words("explorer.outlier"))
    if fleet and (n := len(fleet.likeness.placed(element.robot))) > 1:
        parts.append(words("explorer.stands", n=n))
    return words.row(parts)
