"""The page of a review (``--review``): the same session and guard as the explorer's page, one question at a time.

A person is asked in plain words; an answer needs a name, and some a reason. Works with forms alone: no script. First
whatever perhaps brings data in is asked about, since nothing is followed that nobody names; then what is open, in the
order of review (rule S11). What was left to the engineer is not asked again, and stays open. What is said of findings
and of law is what the report says.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, cast
from urllib.parse import parse_qs

from starlette.responses import HTMLResponse

from rosprivacy.analysis.errors import RosPrivacyError, shown
from rosprivacy.explorer.edits import ROLES, element_id
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.answered_entries import (
    bringing_nothing,
    brings_nothing,
    label_of,
    leaving,
    left_of,
    note_before,
    says_of_data,
)
from rosprivacy.explorer.web.application import PROBLEM, Outcome, Site
from rosprivacy.explorer.web.decision_form import NO_FIELDS
from rosprivacy.explorer.web.element_pane import element_pane
from rosprivacy.explorer.web.finding_pane import finding_pane
from rosprivacy.explorer.web.page import Message, template, verdict_of
from rosprivacy.explorer.web.panes import ROBOT, ROBOT_OR_MODEL, Pane, in_words, stands_for, titles_of
from rosprivacy.explorer.web.view import LONGEST, PageView
from rosprivacy.report.page.finding_entries import finding_entries
from rosprivacy.report.page.html import in_html
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.kinds import kinds
from rosprivacy.report.page.review import in_doubt

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from starlette.responses import Response

    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.web.forms import EditForm, FormAnswer
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words

SKIP, NONE = "skip", "none"  # ask the engineer; brings in nothing: both are notes, and say nothing of data
REASONED = (forms.SANITIZER, forms.ABSENT, forms.MUNDANE, NONE)
ROS_STEPS = ("publish", "subscribe", "matches")  # that have a sentence of their own; data goes along all others
BOUND = 40  # rows of what may bring data in; the others are found by name
LONGEST_SEARCH = 200  # letters of what is looked for
FIRST, SUMMARY = "/", "/?step=summary"
DECIDE = "decide"
STEPS = ("summary", "source", DECIDE)  # that are asked for by name
FIELDS = ("role", "note", "by", "method", "makes", "brings", "whose")


class AskedQuestion(NamedTuple):
    """An element that a person is asked about.

    Attributes
    ----------
    note
        What of it is left to the engineer; empty if nothing is.
    can_wait
        Whether nothing hangs on the answer now.
    beyond
        Whether no answer can be given here: no label file can speak of it.
    """

    id: str
    element: Element
    note: str
    can_wait: bool = False
    beyond: bool = False


def open_elements(standing: Standing) -> tuple[AskedQuestion, ...]:
    """Return everything that is open, in the order in which it is asked."""
    session, questions = standing.session, dict[str, AskedQuestion]()
    suggested = [proposals[0].label.element for proposals in standing.suggestions.of_role("source")]
    for element in sorted(suggested, key=lambda element: element.robot not in session.outliers):
        at, entries = element_id(element.identity), standing.entries_of(element)
        if at in standing.carried or any(map(says_of_data, entries)):
            continue
        if _engineers_note(entries) or not any(map(brings_nothing, entries)):
            questions[at] = AskedQuestion(at, element, _engineers_note(entries), beyond=not session.targets_of(element))
    for question in standing.questions:
        element, at = question.element, element_id(question.element.identity)
        left, beyond = _engineers_note(standing.entries_of(element)), not session.targets_of(element)
        questions[at] = AskedQuestion(at, element, left, question.can_wait, beyond)
    return tuple(questions.values())


def _engineers_note(entries: Sequence[Any]) -> str:
    return next(filter(None, map(left_of, entries)), "")


def progress(standing: Standing, questions: Sequence[AskedQuestion]) -> Pane:
    """Return how many elements are decided: data gets there, or somebody spoke of them, and nothing is open there."""
    decided = (standing.carried.keys() | standing.spoken) - {question.id for question in questions}
    return Pane(decided=len(decided), all=len(decided) + len(questions))


# --- a question -------------------------------------------------------------------------------------------------


def question_pane(standing: Standing, element: Element, words: Words) -> Pane:
    """Return what a person is asked about an element."""
    pane = element_pane(standing, element, PageView(), words)
    entries = standing.entries_of(element)
    reached = bool(standing.carried.get(pane.id))
    return Pane(
        pane=pane,
        text=_text(element, pane, words, reached=reached),
        ways=[Pane(title=way.title, sentences=tuple(_sentences(way.hops, words))) for way in pane.ways],
        roles=offered(element, reached=reached),
        reached=reached,
        left=_engineers_note(entries),
        said=shown(next(filter(None, map(note_before, entries)), "")),
        beyond=not standing.session.targets_of(element),
        robot=shown(element.robot),
    )


def _text(element: Element, pane: Pane, words: Words, *, reached: bool) -> str:
    name = name_and_kind(element, words)
    if not reached:
        return words("review.ask.untouched.channel" if element.is_channel else "review.ask.untouched", name=name)
    return words("review.ask.channel" if element.is_channel else "review.ask", name=name, data=pane.asked)


def _sentences(hops: Sequence[Pane], words: Words) -> Iterator[Pane]:
    """The steps of the way of data, with the policy lines that allow them; none if it begins there."""
    for hop, after in pairwise(hops):
        role = hop.role if hop.role in ROS_STEPS else "flow"
        ends = {"one": _element_names(hop.name, hop.of, words), "other": _element_names(after.name, after.of, words)}
        now = words("review.now", data=hop.data) if hop.data and hop is not hops[0] else ""
        text = " ".join(filter(None, [words(f"review.step.{role}", **ends), now]))
        yield Pane(told=text, lines=hop.lines, more=hop.more)


def name_and_kind(element: Element, words: Words) -> str:
    """Return the name of an element and what it is, in plain words.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.report.catalogs.words import IN_ENGLISH
    >>> name_and_kind(Element("topic", "/video"), IN_ENGLISH)
    '“/video” (channel)'
    """
    return _element_names(shown(element.full_name), element.kind, words)


def _element_names(name: str, kind: str, words: Words) -> str:
    return words(
        "review.named", name=name, kind=words.of_value(f"review.kind.{kind}", words.of_value(f"kind.{kind}", kind))
    )


def _named_with_robots(element: Element, standing: Standing, words: Words) -> str:
    """The same; of a fleet with how many robots it is asked about."""
    return words.row(filter(None, [name_and_kind(element, words), stands_for(standing, element, words)]))


# --- an answer --------------------------------------------------------------------------------------------------


class NotYet(forms.FormError):
    """What an answer lacks, in the reader's language."""


def offered(element: Element, *, reached: bool) -> tuple[str, ...]:
    """Return what can be answered of an element; where no data gets, it is asked only whether data comes in there."""
    if not reached and not element.is_channel:
        return (forms.SOURCE, NONE, *([forms.ABSENT] if element.is_node else []), SKIP)
    return (*(role for role in forms.roles_of(element) if role != forms.NOTHING), SKIP)


def answer_in_review(form: forms.EditForm, standing: Standing, words: Words) -> forms.FormAnswer:
    """Return what a form says of an element; its role may be ``SKIP`` or ``NONE``, too."""

    def need(field: str, *, is_there: object) -> None:
        if not is_there:
            raise NotYet(words(f"review.need.{field}"))

    at = form.value("element")
    need("element", is_there=at in standing.elements)
    element, reached = standing.elements[at], bool(standing.carried.get(at))
    need("role", is_there=form.value("role"))
    role = form.choice("role", offered(element, reached=reached))
    answer = forms.FormAnswer(element, role, note=form.words("note"), by=form.words("by"))
    need("by", is_there=answer.by)
    need("note", is_there=answer.note or role not in REASONED)
    detail = {forms.SANITIZER: "method", forms.DERIVES: "makes"}.get(role)
    need("how", is_there=detail is None or form.value(detail))
    if role in (SKIP, NONE, forms.ABSENT):
        return answer
    categories, about = standing.vocabulary.categories, form.several("about")
    if role != forms.SOURCE:  # all kinds that are asked about, unless a person chose some; never all that there are
        need("about", is_there=(about or not reached) and set(about) <= categories.keys())
    return forms.with_details(answer, form, categories, about)


# --- what may bring data in -------------------------------------------------------------------------------------


def sources_pane(standing: Standing, find: str, words: Words) -> Pane:
    """Return the elements that can be named: all but channels, what nobody spoke of first.

    Nothing is followed that nobody names (rule S11): so a review asks for it, instead of ending with nothing asked.
    """
    find = find[:LONGEST_SEARCH]
    first = {at for ids in standing.places.values() for at in ids}
    fitting = [
        (at, element)
        for at, element in standing.elements.items()
        if at in first and not element.is_channel and find.casefold() in element.full_name.casefold()
    ]
    fitting = [(at, element) for at, element in fitting if standing.session.targets_of(element)]
    fitting.sort(key=lambda item: item[0] in standing.spoken)
    rows = []
    for at, element in fitting[:BOUND]:
        entry = next(iter(standing.entries_of(element)), None) if at in standing.spoken else None
        note = shown(note_before(entry) or left_of(entry))
        rows.append(Pane(id=at, name=_named_with_robots(element, standing, words), said=note))
    return Pane(find=shown(find), rows=rows, more=len(fitting[BOUND:]), followed=bool(standing.analysis.emitted))


# --- the end ----------------------------------------------------------------------------------------------------


def summary_pane(standing: Standing, questions: Sequence[AskedQuestion], words: Words) -> Pane:
    """Return how a review stands: who decided what, what is open, where data gets out."""
    session, index = standing.session, Index(standing.session.result.document(), words)
    verdict = verdict_of(standing)
    decided, followed = tuple(_decided(standing, words)), bool(standing.analysis.emitted)
    return Pane(
        verdict=words.of_value(f"review.verdict.{verdict}", words.of_value(f"verdict.{verdict}", verdict)),
        end=(*_end(questions, words, decided=bool(decided), followed=followed), *in_doubt(index)),
        decided=decided,
        open=tuple(_open(question, standing, words) for question in questions),
        kinds=tuple(kind for kind in kinds(index, finding_entries(index)) if kind.entries),  # that get out
        followed=followed,
        answered=bool(session.answers),
    )


def _end(questions: Sequence[AskedQuestion], words: Words, *, decided: bool, followed: bool) -> Iterator[str]:
    """What has to be known of the answers, in sentences; that nothing was followed comes first."""
    if not followed:
        yield words("review.end.nothing")
    if questions:
        yield words.count(len(questions), "review.end.open")
    elif followed:
        yield words("review.end.none" if decided else "review.end.unasked")


def _open(question: AskedQuestion, standing: Standing, words: Words) -> Pane:
    name = _named_with_robots(question.element, standing, words)
    left, wait, beyond = shown(question.note), question.can_wait, question.beyond
    return Pane(id=question.id, name=name, left=left, can_wait=wait, beyond=beyond)


def _decided(standing: Standing, words: Words) -> Iterator[Pane]:
    """What somebody said of elements, why, and who."""
    titles, session = titles_of(standing.vocabulary, words), standing.session
    for entry in session.answers:
        roles = tuple(_roles(entry.value, titles, words))
        facts = entry.value if isinstance(entry.value, dict) else {}
        why = note_before(entry.value)
        if roles or why:
            whose = [in_words(entry.target, words)] if session.is_fleet else []
            name = words.row([shown(entry.name), *whose])
            yield Pane(name=name, said=roles, why=shown(why), by=shown(str(facts.get("author") or "")))


def _roles(entry: Any, titles: Mapping[str, str], words: Words) -> Iterator[str]:
    """What an entry of a label file says, in plain words."""
    if isinstance(entry, str):
        yield words.of_value(f"review.said.{entry}", shown(entry))
    for role in ROLES if isinstance(entry, dict) else ():
        if role in entry:
            what = _statement(entry[role], titles, words)
            text = words(f"review.said.{role}")
            yield words.pair(text, what) if what else text


def _statement(value: Any, titles: Mapping[str, str], words: Words) -> str:
    """The kinds of data, or the reason, that a role is said with."""
    if value is True or value is None:
        return ""
    if isinstance(value, dict):
        names = [name for name in value if name not in ("from", "to")]
        if not names:  # a derivation
            ends = {"data": value.get("from"), "to": value.get("to")}
            return words("review.made", **{key: _statement(end, titles, words) for key, end in ends.items()})
        return words.row(titles.get(kind, shown(str(kind))) for kind in names)
    if isinstance(value, list | tuple):
        return words.row(_statement(each, titles, words) for each in value)
    return titles.get(str(value), shown(str(value)))


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
            elif step == DECIDE and (finding := standing.findings.get(_value(query, "finding"))):
                text = template("review_decide").render(
                    d=finding_pane(standing, finding, PageView(), words), by=self._by,
                    action=f"?step={DECIDE}&finding={finding.id}",
                    filled=outcome.filled if outcome else NO_FIELDS, **shared,
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

    def _decide(self, form: EditForm) -> Outcome:
        outcome = super()._decide(form)
        self._next = SUMMARY
        return outcome

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
