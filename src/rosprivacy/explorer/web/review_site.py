"""The page of a review (``--review``): the same session and guard as the explorer's page, one question at a time.

A person is asked in plain words; an answer needs a name, and some a reason. Works with forms alone: no script.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast
from urllib.parse import parse_qs

from starlette.responses import HTMLResponse

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.answered_entries import bringing_nothing, label_of, leaving, left_of, note_before
from rosprivacy.explorer.web.application import PROBLEM, Outcome, Site
from rosprivacy.explorer.web.page import Message, template
from rosprivacy.explorer.web.panes import ROBOT, ROBOT_OR_MODEL
from rosprivacy.explorer.web.review_panes import (
    NONE,
    REASONED,
    SKIP,
    NotYet,
    answer_in_review,
    open_elements,
    progress,
    question_pane,
    sources_pane,
    summary_pane,
)
from rosprivacy.explorer.web.view import LONGEST
from rosprivacy.report.page.html import in_html

if TYPE_CHECKING:
    from starlette.responses import Response

    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.web.forms import EditForm, FormAnswer

FIRST, SUMMARY = "/", "/?step=summary"
STEPS = ("summary", "source")  # that are asked for by name
FIELDS = ("role", "note", "by", "method", "makes", "brings", "whose")


class ReviewSite(Site):
    """A review of one session; see ``Site``."""

    _next = FIRST
    _entered: EditForm | None = None  # what was said last, while it cannot be taken

    def _page(self, query: str, outcome: Outcome | None = None) -> Response:
        with self._lock:
            standing, words, history = self.standing, self._words, self.session.history
            self._next = FIRST
            questions = open_elements(standing)
            element, step = standing.elements.get(_value(query, "at")), _value(query, "step")
            if element is None and step not in STEPS:
                element = next((each.element for each in questions if not (each.note or each.beyond)), None)
                step = "source" if not standing.analysis.emitted else step
            message, self._message = outcome.message if outcome else self._message or self._changed_on_disk(), None
            entered, self._entered = self._entered, None
            shared: dict[str, Any] = {
                "t": in_html(words), "version": standing.version, "message": message,
                "progress": progress(standing, questions), "unsaved": history.unsaved, "can_undo": history.can_undo,
                "read_only": self.door.read_only, "before": history.unsaved_from_before, "remarks": history.remarks,
                "inputs": self._changed_inputs(),
                "title": words("review.title.fleet" if standing.result.fleet else "review.title"),
            }  # fmt: skip
            if element is not None:
                question = question_pane(standing, element, words)
                chosen = [kind.name for kind in question.pane.about if kind.chosen]
                text = template("review_question").render(
                    q=question, by=self._by, methods=forms.METHODS, reasoned=REASONED,
                    entered={name: "".join(entered.several(name)[:1]) if entered else "" for name in FIELDS},
                    about=entered.several("about") if entered else chosen, **shared,
                )  # fmt: skip
            elif step == "source":
                sources = sources_pane(standing, _value(query, "find"), words)
                text = template("review_source").render(s=sources, **shared)
            else:
                text = template("review_summary").render(s=summary_pane(standing, questions, words), **shared)
        return HTMLResponse(text, outcome.status if outcome else 200)

    def _address(self, _query: str) -> str:
        """The next question, whatever was looked at."""
        address, self._next = self._next, FIRST
        return address

    def _label(self, form: EditForm) -> Outcome:
        self._entered = form
        answer = answer_in_review(form, self.standing, self._words)
        alone = form.choice("whose", ROBOT_OR_MODEL) == ROBOT
        now = self.session.entry_for(answer.element, only_this_robot=alone)
        self.session.answer_for(answer.element, cast("Label", self._label_text(answer, now)), only_this_robot=alone)
        self._entered, self._by = None, answer.by
        return Outcome(200, self._answered(answer, now, self._words(f"review.answer.{answer.role}")))

    def _label_text(self, answer: FormAnswer, now: Any) -> dict[str, Any]:
        """What the label file then says; ``now`` is what it says now."""
        if answer.role == SKIP:
            return leaving(now, answer.by, answer.note, self._words)
        if answer.role == NONE:
            return bringing_nothing(now, answer.by, answer.note, self._words)
        label = label_of(answer, now)
        if left_of(now) and "note" not in label:  # there is an answer now
            label["note"] = note_before(now)
        return label

    def _undo(self, form: EditForm) -> Outcome:
        """Take the last answer back, and ask its question again."""
        last = self.session.edits[-1:]
        outcome = super()._undo(form)
        for edit in last:
            at = self.standing.place_of(edit)
            self._next = f"/?at={at}" if at else FIRST
        return outcome

    def _save(self, form: EditForm) -> Outcome:
        self._next = SUMMARY
        try:
            return super()._save(form)
        except RosPrivacyError as error:
            text = self._words("review.refused.save")
            return Outcome(422, Message(PROBLEM, text, detail=tuple(str(error).splitlines())))

    def _refused(self, error: Exception) -> Message:
        """What is missing, in the reader's language; else a plain sentence, with what the reader of labels says."""
        if isinstance(error, NotYet):
            return Message(PROBLEM, self._words("explorer.refused"), (str(error),))
        return super()._refused(error)._replace(text=self._words("review.refused"))


def _value(query: str, name: str) -> str:
    try:
        return parse_qs(query[:LONGEST], errors="replace").get(name, [""])[0]
    except ValueError:
        return ""
