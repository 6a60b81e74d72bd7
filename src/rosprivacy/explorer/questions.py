"""What is left to decide, in the order in which a person reviews it (rule S11).

In: a ``Result``. Out: ``RankedQuestion`` facts, the first one first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.findings.review_order import Behind
from rosprivacy.report.document.analysis import label_key

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.answer import OpenQuestion
    from rosprivacy.analysis.findings.review_order import Shown
    from rosprivacy.analysis.model import Category, Element
    from rosprivacy.result import Result

FIRST, AT_CHANNELS, BEHIND, WAITS, PROPOSED = "first", "channels", "behind", "waits", "proposed"
GROUPS = (FIRST, AT_CHANNELS, BEHIND, WAITS, PROPOSED)


class RankedQuestion(NamedTuple):
    """An element of which a person has to say what it does.

    Attributes
    ----------
    section, name
        Under which a label file speaks of it, and of nothing else: what ``Session.label`` takes.
    kinds
        Names of the kinds of data that are open there, sorted.
    steps
        From the nearest source.
    group
        ``FIRST``: a node that data reaches before any other open node; ``AT_CHANNELS``; ``BEHIND``: a node behind
        those; ``WAITS``: a channel past which data gets to no leak and no open node; ``PROPOSED``: a channel that the
        program's own file proposes to take as mundane.
    frontier
        As of ``OpenQuestion``.
    through
        The element that the data comes from; None where it begins.
    closes, leaks
        How many other open elements, and how many leaks, data gets to past this one only, at least.
    missing
        What has to be known of an element outside ROS and is not stated.
    """

    element: Element
    section: str
    name: str
    kinds: tuple[str, ...]
    steps: int
    group: str
    frontier: bool
    through: Element | None = None
    closes: int = 0
    leaks: int = 0
    missing: tuple[str, ...] = ()

    @property
    def can_wait(self) -> bool:
        """Whether nothing hangs on the answer now."""
        return self.group in (WAITS, PROPOSED)


def questions(
    result: Result, outliers: Collection[str] = (), order: Mapping[Shown, Behind] | None = None
) -> tuple[RankedQuestion, ...]:
    """Return what is left to decide: nodes that data reaches first, channels, what lies behind; what can wait last.

    Parameters
    ----------
    outliers
        Robots of a fleet of which is asked before others.
    order
        ``result.review_order``, by who has it already.
    """
    order = result.review_order if order is None else order
    rows = (_question(q, order.get(q.element.shown_as, Behind()), result.infrastructure) for q in result.shown.open)
    asked: dict[tuple[str, str, str], RankedQuestion] = {}
    categories = result.vocabulary.categories
    for question in sorted(rows, key=lambda question: _urgency(question, categories)):
        key = question.element.robot, question.section, question.name
        first = asked.setdefault(key, question)
        if first is not question:  # the other leg of a service or an action: one label answers for both
            kinds = tuple(sorted({*first.kinds, *question.kinds}))
            asked[key] = first._replace(kinds=kinds, steps=min(first.steps, question.steps))
    return tuple(sorted(asked.values(), key=lambda each: (each.can_wait, each.element.robot not in outliers)))


def _question(question: OpenQuestion, behind: Behind, proposed: Collection[tuple[str, str]]) -> RankedQuestion:
    element = question.element
    label = label_key(element)
    group = FIRST if question.frontier else BEHIND
    if element.is_channel:
        group = WAITS if behind.waits else AT_CHANNELS
    if (element.kind, element.name) in proposed:
        group = PROPOSED
    return RankedQuestion(
        element, label["section"], label["name"], question.categories, question.distance, group, question.frontier,
        behind.through, behind.closes, behind.leaks, question.missing,
    )  # fmt: skip


def _urgency(question: RankedQuestion, categories: Mapping[str, Category]) -> tuple[object, ...]:
    """What is reviewed first; of what is alike, what the heaviest kind of data reaches."""
    place = question.element.sort_key() if question.group == PROPOSED else ()  # others come in that order, by steps
    heaviest = min(categories[kind].weight for kind in question.kinds)
    return GROUPS.index(question.group), -question.leaks, -question.closes, question.steps, place or heaviest
