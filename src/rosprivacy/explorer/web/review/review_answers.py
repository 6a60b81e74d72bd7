"""An answer of a review: a posted form goes in, out comes an ``Answer``, or one sentence in the reader's language."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.explorer.web import forms

if TYPE_CHECKING:
    from collections.abc import Collection

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words


class NotYet(forms.FormError):
    """What an answer lacks, in the reader's language."""


SKIP, NONE = "skip", "none"  # ask the engineer; brings in nothing: both are notes, and say nothing of data
REASONED = (forms.SANITIZER, forms.ABSENT, forms.MUNDANE, NONE)


def offered(element: Element, *, reached: bool) -> tuple[str, ...]:
    """Return what can be answered of an element.

    Parameters
    ----------
    reached
        Whether data gets there; else it is asked only whether data comes in there.
    """
    if not reached and not element.is_channel:
        return (forms.SOURCE, NONE, *([forms.ABSENT] if element.is_node else []), SKIP)
    return (*(role for role in forms.roles_of(element) if role != forms.NOTHING), SKIP)


def answer_in_review(form: forms.Form, standing: Standing, words: Words) -> forms.Answer:
    """Return what a form says of an element; its role may be ``SKIP`` or ``NONE``, too.

    Raises
    ------
    NotYet
        If something is missing.
    FormError
        If nothing can be said so.
    """
    at = form.one("element")
    if at not in standing.elements:
        raise NotYet(words("rv.need.element"))
    element, reached = standing.elements[at], bool(standing.carried.get(at))
    kinds = standing.vocabulary.categories
    if not form.one("role"):
        raise NotYet(words("rv.need.role"))
    role = form.choice("role", offered(element, reached=reached))
    said = forms.Answer(element, role, note=form.words("note"), by=form.words("by"))
    if not said.by:
        raise NotYet(words("rv.need.by"))
    if role in REASONED and not said.note:
        raise NotYet(words("rv.need.note"))
    if (role == forms.SANITIZER and not form.one("method")) or (role == forms.DERIVES and not form.one("makes")):
        raise NotYet(words("rv.need.how"))
    if role == forms.SOURCE:
        return said._replace(kinds=(form.choice("brings", kinds),))
    if role in (SKIP, NONE, forms.ABSENT):
        return said
    said = said._replace(kinds=_about(form, kinds, words, asked=reached))
    if role == forms.SANITIZER:
        return said._replace(method=form.choice("method", forms.METHODS))
    return said._replace(to=form.choice("makes", kinds)) if role == forms.DERIVES else said


def _about(form: forms.Form, kinds: Collection[str], words: Words, *, asked: bool) -> tuple[str, ...]:
    """The kinds that an answer is about: all that are asked about, unless a person chose some. Never all there are."""
    about = form.several("about")
    if (asked and not about) or not set(about).issubset(kinds):
        raise NotYet(words("rv.need.about"))
    return about
