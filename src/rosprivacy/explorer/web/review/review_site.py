"""The page of a review (``--review``): the same session and guard as the explorer's page, one question at a time.

A person is asked in plain words; an answer needs a name, and some a reason. Works with forms alone: no script.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, cast
from urllib.parse import parse_qs

from jinja2 import Environment, PackageLoader, StrictUndefined
from starlette.responses import HTMLResponse

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.application import PROBLEM, Site, Told
from rosprivacy.explorer.web.left_open import bringing_nothing, leaving, left_of, note_before
from rosprivacy.explorer.web.rendering import Message
from rosprivacy.explorer.web.review.review_answers import NONE, REASONED, SKIP, NotYet, answer_in_review
from rosprivacy.explorer.web.review.review_questions import asked, progress, question_of
from rosprivacy.explorer.web.review.review_sources import sources_of
from rosprivacy.explorer.web.review.review_summary import summary_of
from rosprivacy.explorer.web.saying import label_of
from rosprivacy.explorer.web.view import LONGEST
from rosprivacy.explorer.web.whose import ROBOT, WHOSE
from rosprivacy.report.page.html import in_html

if TYPE_CHECKING:
    from jinja2 import Template
    from starlette.responses import Response

    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.web.forms import Answer, Form

FIRST, SUMMARY = "/", "/?step=summary"
STEPS = ("summary", "source")  # that are asked for by name
FIELDS = ("role", "note", "by", "method", "makes", "brings", "whose")


class ReviewSite(Site):
    """A review of one session; see ``Site``."""

    _next = FIRST
    _entered: Form | None = None  # what was said last, while it cannot be taken

    def _page(self, query: str, told: Told | None = None) -> Response:
        with self._lock:
            standing, words = self.standing, self._words
            self._next = FIRST
            questions = asked(standing)
            element, step = standing.elements.get(_one(query, "at")), _one(query, "step")
            if element is None and step not in STEPS:
                element = next((one.element for one in questions if not (one.left or one.beyond)), None)
                step = "source" if not standing.analysis.emitted else step
            message, self._message = told.message if told else self._message or self._changed_on_disk(), None
            entered, self._entered = self._entered, None
            shared: dict[str, Any] = {
                "t": in_html(words), "version": standing.version, "message": message,
                "progress": progress(standing, questions), "unsaved": self.session.unsaved,
                "can_undo": self.session.can_undo, "read_only": self.door.read_only,
                "before": self.session.unsaved_from_before, "remarks": self.session.remarks,
                "inputs": self._changed_inputs(),
                "title": words("rv.title.fleet" if standing.result.fleet else "rv.title"),
            }  # fmt: skip
            if element is None and step == "source":
                sources = sources_of(standing, _one(query, "find"), words)
                text = _template("review_source").render(s=sources, **shared)
            elif element is None:
                text = _template("review_summary").render(s=summary_of(standing, questions, words), **shared)
            else:
                question = question_of(standing, element, words)
                chosen = [kind.name for kind in question.pane.about if kind.chosen]
                text = _template("review_question").render(
                    q=question, by=self._by, methods=forms.METHODS, reasoned=REASONED,
                    entered={name: _entered(entered, name) for name in FIELDS},
                    about=entered.several("about") if entered else chosen, **shared,
                )  # fmt: skip
        return HTMLResponse(text, told.status if told else 200)

    def _address(self, query: str) -> str:  # noqa: ARG002 - the next question, whatever was looked at
        address, self._next = self._next, FIRST
        return address

    def _label(self, form: Form) -> Told:
        standing = self.standing
        self._entered = form
        answer = answer_in_review(form, standing, self._words)
        alone = form.choice("whose", WHOSE) == ROBOT
        now = standing.entry(answer.element, only_this_robot=alone)
        said = cast("Label", self._said(answer, now))
        self.session.answer_for(answer.element, said, only_this_robot=alone)
        self._entered, self._by = None, answer.by
        return Told(200, self._answered(answer, now, self._words(f"rv.answer.{answer.role}")))

    def _said(self, answer: Answer, now: Any) -> dict[str, Any]:
        """What the label file then says; ``now`` is what it says now."""
        if answer.role == SKIP:
            return leaving(now, answer.by, answer.note, self._words)
        if answer.role == NONE:
            return bringing_nothing(now, answer.by, answer.note, self._words)
        label = label_of(answer, now)
        if left_of(now) and "note" not in label:  # there is an answer now
            label["note"] = note_before(now)
        return label

    def _undo(self, form: Form) -> Told:
        """Take the last answer back, and ask its question again."""
        last = self.session.edits[-1:]
        told = super()._undo(form)
        for edit in last:
            at = self.standing.place_of(edit)
            self._next = f"/?at={at}" if at else FIRST
        return told

    def _save(self, form: Form) -> Told:
        self._next = SUMMARY
        try:
            return super()._save(form)
        except RosPrivacyError as error:
            return Told(422, Message(PROBLEM, self._words("rv.refused.save"), detail=tuple(str(error).splitlines())))

    def _refused(self, error: Exception) -> Message:
        """What is missing, in the reader's language; else a plain sentence, with what the reader of labels says."""
        if isinstance(error, NotYet):
            return Message(PROBLEM, self._words("x.refused"), (str(error),))
        return super()._refused(error)._replace(text=self._words("rv.refused"))


def _entered(form: Form | None, name: str) -> str:
    return "".join(form.several(name)[:1]) if form else ""


def _one(query: str, name: str) -> str:
    try:
        return parse_qs(query[:LONGEST], errors="replace").get(name, [""])[0]
    except ValueError:
        return ""


@cache
def _environment() -> Environment:
    loader = PackageLoader("rosprivacy.explorer.web")
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)


def _template(name: str) -> Template:
    return _environment().get_template(f"{name}.html.j2")
