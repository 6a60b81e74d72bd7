"""What a language model answered -> evidence: only from the closed lists, and only with a quote of what was sent.

An answer is data of anybody. It can say one of the roles that were asked for, of an element that was sent, of a kind
that there is; whatever else it says is dropped and counted. All of it is ``may``, and it makes no other ground surer.
"""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.evidence import DERIVATION, MODEL, Evidence, Label

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from rosprivacy.analysis.suggesting.asked_elements import Asked

MOST = 5  # of one element: more than a person would read
KEYS = ("id", "role", "kind", "to", "quote")  # of one answer, each a text
NO_FORM, NO_ELEMENT, NO_ROLE = "not of the form asked for", "no element that was sent", "no role that was asked for"
NO_KIND, NO_QUOTE, TOO_MANY = "no kind that there is", "no evidence in the input", f"more than {MOST} of one element"
_SAYS_SOMETHING = re.compile(r"[^\W\d_]{2}")  # a placeholder of a masked name has one letter


class Judged(NamedTuple):
    """What is left of some answers.

    Attributes
    ----------
    dropped
        How many were dropped, by reason.
    """

    evidence: tuple[Evidence, ...]
    dropped: Counter[str]


def judged(
    answers: Iterable[Any],
    asked: Mapping[str, Asked],
    kinds: Collection[str],
    model: str,
    shown: Callable[[str], str] = str,
) -> Judged:
    """Return what a person may be asked of what a model answered.

    Parameters
    ----------
    answers
        Values of JSON, of any form.
    asked
        What was sent, by id.
    shown
        What gives back the names behind placeholders.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.analysis.suggesting.asked_elements import Asked
    >>> asked = {"n1": Asked(Element("node", "/eye"), "/eye", (), (), (), ())}
    >>> said = {"id": "n1", "role": "source", "kind": "Video", "to": "", "quote": "eye"}
    >>> done = judged([said, said | {"role": "never"}, said | {"quote": "camera"}], asked, ["Video"], "m")
    >>> done.evidence[0].label.role, done.evidence[0].reason, dict(done.dropped) == {NO_ROLE: 1, NO_QUOTE: 1}
    ('source', "language model m, by 'eye' in the name /eye", True)
    """
    evidence: dict[Evidence, None] = {}
    dropped: Counter[str] = Counter()
    of_elements: Counter[str] = Counter()
    for answer in answers:
        wrong = _wrong(answer, asked, kinds)
        quoted = None if wrong else _quoted(answer["quote"], asked[answer["id"]])
        if wrong or quoted is None:
            dropped[wrong or NO_QUOTE] += 1
            continue
        what, text = quoted
        reason = f"language model {model}, by {shown(answer['quote'])!r} in the {what} {shown(text)}"
        made = Evidence(_label(answer, asked[answer["id"]]), MODEL, Confidence.MAY, reason, Place(f"model:{model}", 0))
        if made in evidence:
            continue
        of_elements[answer["id"]] += 1
        if of_elements[answer["id"]] > MOST:
            dropped[TOO_MANY] += 1
        else:
            evidence[made] = None
    return Judged(tuple(evidence), dropped)


def _wrong(answer: Any, asked: Mapping[str, Asked], kinds: Collection[str]) -> str:
    """Why an answer is none of the closed lists; empty if it is."""
    if (
        not isinstance(answer, dict)
        or set(answer) != set(KEYS)
        or not all(isinstance(answer[key], str) for key in KEYS)
    ):
        return NO_FORM
    if answer["id"] not in asked:
        return NO_ELEMENT
    if answer["role"] not in asked[answer["id"]].roles:
        return NO_ROLE
    if answer["kind"] not in kinds:
        return NO_KIND
    if answer["role"] == DERIVATION and (answer["to"] not in kinds or answer["to"] == answer["kind"]):
        return NO_KIND
    return ""


def _quoted(quote: str, asked: Asked) -> tuple[str, str] | None:
    """What a quote was taken from, word for word; None if from nothing that was sent of the element."""
    if not _SAYS_SOMETHING.search(quote):
        return None
    return next(((what, text) for what, text in asked.texts() if quote in text), None)


def _label(answer: Mapping[str, str], asked: Asked) -> Label:
    to = answer["to"] if answer["role"] == DERIVATION else ""
    return Label(asked.element, answer["role"], answer["kind"], to=to)
