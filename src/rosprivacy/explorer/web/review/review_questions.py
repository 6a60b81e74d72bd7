"""A review as questions, one at a time: a session as it stands goes in, out comes what a person is asked, and how far.

First whatever perhaps brings data in, since nothing is followed that nobody names; then what is open, in the order of
review (rule S11). What was left to the engineer is not asked again, and stays open.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.explorer.element_ids import element_id
from rosprivacy.explorer.web.element_pane import pane_of
from rosprivacy.explorer.web.left_open import brings_nothing, left_of, note_before, says_of_data
from rosprivacy.explorer.web.review.review_answers import offered
from rosprivacy.explorer.web.view import View
from rosprivacy.explorer.web.whose import stands_for

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Any

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.web.element_pane import Hop, Line, Pane
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words

ROS_STEPS = ("publish", "subscribe", "matches")  # that have a sentence of their own; data goes along all others


class Asked(NamedTuple):
    """An element that a person is asked about.

    Attributes
    ----------
    left
        What of it is left to the engineer; empty if nothing is.
    can_wait
        Whether nothing hangs on the answer now.
    beyond
        Whether no answer can be given here: no label file can speak of it.
    """

    id: str
    element: Element
    left: str
    can_wait: bool = False
    beyond: bool = False


class Progress(NamedTuple):
    """How many of the elements that are in question are decided."""

    decided: int
    all: int


class Sentence(NamedTuple):
    """A step of the way of data, with the policy lines that allow it."""

    told: str
    lines: tuple[Line, ...]
    more: int


class Way(NamedTuple):
    """How a kind of data gets to an element; no sentences if it begins there."""

    title: str
    sentences: tuple[Sentence, ...]


class Question(NamedTuple):
    """What the page of one question shows.

    Attributes
    ----------
    reached
        Whether data gets to the element.
    beyond
        As of ``Asked``.
    robot
        Of the element; empty where there is one robot only.
    """

    pane: Pane
    text: str
    ways: tuple[Way, ...]
    roles: tuple[str, ...]
    reached: bool
    left: str
    said: str
    beyond: bool
    robot: str


def asked(standing: Standing) -> tuple[Asked, ...]:
    """Return everything that is open, in the order in which it is asked."""
    session, found = standing.session, dict[str, Asked]()
    suggested = [proposals[0].label.element for proposals in standing.suggestions.of_role("source")]
    for element in sorted(suggested, key=lambda one: one.robot not in session.outliers):
        at, said = element_id(element.identity), standing.said_of(element)
        if at in standing.carried or any(map(says_of_data, said)):
            continue
        if _left(said) or not any(map(brings_nothing, said)):
            found[at] = Asked(at, element, _left(said), beyond=not session.can_answer(element))
    for question in standing.questions:
        element, said = question.element, standing.said_of(question.element)
        at, beyond = element_id(element.identity), not session.can_answer(element)
        found[at] = Asked(at, element, _left(said), question.can_wait, beyond)
    return tuple(found.values())


def _left(said: Sequence[Any]) -> str:
    return next(filter(None, map(left_of, said)), "")


def progress(standing: Standing, questions: Sequence[Asked]) -> Progress:
    """Return how many elements are decided: data gets there, or somebody spoke of them, and nothing is open there."""
    decided = (standing.carried.keys() | standing.spoken) - {one.id for one in questions}
    return Progress(len(decided), len(decided) + len(questions))


def question_of(standing: Standing, element: Element, words: Words) -> Question:
    """Return what a person is asked about an element."""
    pane = pane_of(standing, element, View(), words)
    said = standing.said_of(element)
    reached = bool(standing.carried.get(pane.id))
    return Question(
        pane=pane,
        text=_text(element, pane, words, reached=reached),
        ways=tuple(Way(way.title, tuple(_sentences(way.hops, words))) for way in pane.ways),
        roles=offered(element, reached=reached),
        reached=reached,
        left=_left(said),
        said=shown(next(filter(None, map(note_before, said)), "")),
        beyond=not standing.session.can_answer(element),
        robot=shown(element.robot),
    )


def named_with_robots(element: Element, standing: Standing, words: Words) -> str:
    """Return the same as ``named``; of a fleet with how many robots it is asked about."""
    return words.row(filter(None, [named(element, words), stands_for(standing, element, words)]))


def named(element: Element, words: Words) -> str:
    """Return the name of an element and what it is, in plain words.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> named(Element("topic", "/video"), IN_ENGLISH)
    '“/video” (channel)'
    """
    return _named(shown(element.full_name), element.kind, words)


def _named(name: str, kind: str, words: Words) -> str:
    return words("rv.named", name=name, kind=words.known(f"rv.kind.{kind}", words.known(f"kind.{kind}", kind)))


def _text(element: Element, pane: Pane, words: Words, *, reached: bool) -> str:
    name = named(element, words)
    if not reached:
        return words("rv.ask.untouched.channel" if element.is_channel else "rv.ask.untouched", name=name)
    return words("rv.ask.channel" if element.is_channel else "rv.ask", name=name, data=pane.asked)


def _sentences(hops: Sequence[Hop], words: Words) -> Iterator[Sentence]:
    for hop, after in pairwise(hops):
        role = hop.role if hop.role in ROS_STEPS else "flow"
        ends = {"one": _named(hop.name, hop.of, words), "other": _named(after.name, after.of, words)}
        now = words("rv.now", data=hop.data) if hop.data and hop is not hops[0] else ""
        yield Sentence(" ".join(filter(None, [words(f"rv.step.{role}", **ends), now])), hop.lines, hop.more)
