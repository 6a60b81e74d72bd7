"""What the page's server answers: a session goes in, out comes an application (ASGI) behind its guard.

A GET changes nothing. A POST says which version of the session it saw; where another window was quicker, nothing is
done, and the answer is the page as it stands (409). What a form says wrong is told in a sentence (422).
"""

from __future__ import annotations

from contextlib import suppress
from importlib.resources import files
from itertools import count
from threading import RLock
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, cast

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse, JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.routing import Route

from rosprivacy.analysis.errors import RosPrivacyError, shown
from rosprivacy.explorer.edited_file import Conflict
from rosprivacy.explorer.suggestion_screens import SuggestionScreens
from rosprivacy.explorer.web import forms
from rosprivacy.explorer.web.answered_entries import label_of, limit_of, made_by
from rosprivacy.explorer.web.decision_form import NO_FIELDS, asked_again, posted_decision
from rosprivacy.explorer.web.element_pane import answer_of, tickable
from rosprivacy.explorer.web.finding_pane import finding_pane, scope_in, scope_in_words
from rosprivacy.explorer.web.guard import Guard
from rosprivacy.explorer.web.page import Message, draw_picture, page_of, render_page
from rosprivacy.explorer.web.panes import ROBOT, ROBOT_OR_MODEL, Pane, robots_in_words, title_of, titles_of
from rosprivacy.explorer.web.screen_pane import KEY_OF, screen_pane, told_of_key
from rosprivacy.explorer.web.standing import Standing
from rosprivacy.explorer.web.trial_forms import TOGETHER, KeptTrials, kept_trials, offers_at, trial_pane, tried_in
from rosprivacy.explorer.web.view import trial_in, view_of
from rosprivacy.labelling.knowledge import what_is_known
from rosprivacy.labelling.suggesting_on_demand import Suggester
from rosprivacy.report.pictures.page_pictures import Pictures, style_sheet
from rosprivacy.report.pictures.phrases import Phrases

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from starlette.requests import Request
    from starlette.types import ASGIApp

    from rosprivacy.explorer.edits import Label
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.forms import EditForm, FormAnswer
    from rosprivacy.explorer.web.guard import RequestDoor
    from rosprivacy.explorer.web.view import PageView
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.settings import Settings

STATIC = {
    "explore.css": "text/css",
    "explore.js": "text/javascript",
    "cypher.css": "text/css",
    "cypher.js": "text/javascript",
    "picture.css": "text/css",
    "review.css": "text/css",
}
PICTURE = "picture.css"  # of which the pictures themselves know what it says
MOST_NAMED = 5  # files in a message
DONE, PROBLEM = "done", "problem"
READING = ("/try", "/drop")  # what is tried is kept in memory only


class Outcome(NamedTuple):
    """What came of a request: a status of HTTP, what a person is told, and the trial that is looked at then.

    Attributes
    ----------
    filled
        Fields of a form that is asked again, as a person filled them in.
    """

    status: int
    message: Message | None = None
    trial: str = ""
    filled: Mapping[str, str] = NO_FIELDS


class Site:
    """The pages of one session. Every answer is made by one thread at a time, since analyses are.

    Parameters
    ----------
    settings
        With which the session was opened.
    words
        Of the reader's language.
    """

    asks: ClassVar[bool] = False  # whether there is a database that can be asked
    reading: ClassVar[tuple[str, ...]] = READING

    def __init__(self, session: Session, settings: Settings, words: Words, door: RequestDoor) -> None:
        self.session, self.door = session, door
        self._words = words
        self._lock = RLock()
        self._suggester = Suggester(what_is_known(session.uncounted.vocabulary, settings))
        self._standing = Standing(session, self._suggester)
        self._trials = KeptTrials(session, self._suggester)
        knowledge = self._suggester.knowledge
        self._screens = SuggestionScreens(session, knowledge, settings) if SuggestionScreens.fit(session) else None
        self._phrases = Phrases.of_report(words, titles_of(session.uncounted.vocabulary, words))
        self._pictures = Pictures(self._phrases)
        self._by = ""
        self._message: Message | None = None

    def application(self) -> ASGIApp:
        """Return what a server runs."""
        posts: dict[str, Callable[[EditForm], Outcome]] = {
            "/label": self._label, "/offers": self._take_offers, "/screen": self._press,
            "/undo": self._undo, "/redo": self._redo, "/save": self._save, "/merge": self._merge,
            "/resume": self._resume, "/forget": self._forget, "/try": self._try, "/drop": self._drop,
            "/decide": self._decide,
        }  # fmt: skip
        routes = [
            Route("/", self._get),
            Route("/now", self._now),
            Route("/report", self._report),
            Route("/static/{name}", _static),
            *(Route(path, self._post(work), methods=["POST"]) for path, work in posts.items()),
            *self.further_routes(),
        ]
        return Guard(Starlette(routes=routes), self.door, self.reading)

    def further_routes(self) -> list[Route]:
        """Return what else is answered: nothing for a session of files."""
        return []

    def close(self) -> None:
        """End what draws the pictures."""
        self._pictures.close()

    @property
    def standing(self) -> Standing:
        """The session as it stands."""
        if self._standing.version != self.session.version:
            self._standing = Standing(self.session, self._suggester)
        return self._standing

    # --- what is asked ------------------------------------------------------------------------------------------

    async def _get(self, request: Request) -> Response:
        return await run_in_threadpool(self._page, request.url.query)

    def _post(self, work: Callable[[EditForm], Outcome]) -> Callable[[Request], object]:
        async def handle(request: Request) -> Response:
            body = await request.body()
            return await run_in_threadpool(self._changed, work, body, request.url.query)

        return handle

    async def _now(self, _: Request) -> Response:
        """Tell the page whether another window, or somebody with an editor, was quicker."""
        return await run_in_threadpool(self._news)

    def _news(self) -> Response:
        try:
            changed = self.session.changed_on_disk() is not None
        except RosPrivacyError:  # it cannot be read now: saving will say why
            changed = True
        return JSONResponse({"version": self.session.version, "disk": changed, "inputs": self._changed_inputs()})

    async def _report(self, _: Request) -> Response:
        """Give the report of now as a file: a page of its own, with a style of its own, that is shown nowhere here."""
        return await run_in_threadpool(self._reported)

    def _reported(self) -> Response:
        with self._lock:
            text = self.session.result.to("html", language=self._words.language)
        said = {"content-disposition": 'attachment; filename="privacy-report.html"'}
        return Response(text, headers=said, media_type="application/octet-stream")

    # --- what is answered ---------------------------------------------------------------------------------------

    def _page(self, query: str, outcome: Outcome | None = None) -> Response:
        with self._lock:
            standing, view, problem = self._looked_at(query)
            screen, why_not = self._screen(view)
            view = view._replace(at=screen.at if screen else view.at, ask=screen is not None)
            page = page_of(standing, view, self._words)
            new = problem or why_not or self._message or self._changed_on_disk()
            message, self._message = outcome.message if outcome else new, None
            text = render_page(
                page,
                self._words,
                draw_picture(self._pictures, standing, page),
                self._side(standing, page, screen),
                read_only=self.door.read_only,
                message=message,
                left=self.session.history.unsaved_from_before,
                remarks=self.session.history.remarks,
                inputs=self._changed_inputs(),
                by=self._by,
                asks=self.asks,
                filled=outcome.filled if outcome else NO_FIELDS,
            )
        return HTMLResponse(text, outcome.status if outcome else 200)

    def _screen(self, view: PageView) -> tuple[Pane | None, Message | None]:
        """The screen about an element, where suggestions are gone through; why there is none."""
        if not view.ask or self._screens is None:
            return None, None
        try:
            return screen_pane(self._screens, self.standing, view, self._by, self._words), None
        except RosPrivacyError as error:  # of a file that somebody changed
            return None, self._refused(error)

    def _side(self, standing: Standing, page: Pane, screen: Pane | None) -> Pane:
        """What stands beside the system: the finding in hand, the trial that is looked at, what can be tried here."""
        view, words = page.view, self._words
        finding = standing.findings.get(view.finding)
        can_try = page.pane and not (finding or view.trial or self.session.is_stored)
        return Pane(
            screen=screen,
            has_screens=self._screens is not None and not view.trial,
            finding=finding_pane(standing, finding, view, words) if finding else None,
            trial=trial_pane(self.standing, self._trials, view, words) if view.trial else None,
            offers=offers_at(standing, standing.elements[page.pane.id], words) if can_try else None,
            kept=kept_trials(self._trials, view, words),
        )

    def _looked_at(self, query: str) -> tuple[Standing, PageView, Message | None]:
        """How it stands, or would stand under a trial; the view; why a trial cannot be looked at any more."""
        trial, problem = trial_in(query, self._trials.names), None
        standing = self.standing
        if trial:
            try:
                standing = self._trials.standing(trial)
            except RosPrivacyError as error:
                what = self._words("explorer.trial.gone", name=trial)
                problem = Message(PROBLEM, what, detail=tuple(str(error).splitlines()))
                trial = ""
        view = view_of(query, standing.elements, standing.vocabulary.categories, standing.findings, trial)
        return standing, view, problem

    def _changed_on_disk(self) -> Message | None:
        """What somebody else did to the label file, and that it can be taken in."""
        with suppress(RosPrivacyError):  # it cannot be read now: saving will say why
            changed = self.session.changed_on_disk()
            return Message(PROBLEM, self._words("explorer.disk"), diff=changed.diff) if changed else None
        return None

    def _changed_inputs(self) -> str:
        """What stands on the page as long as files are not what was read; empty if all are."""
        changed = [shown(file) for file in self.session.changed_inputs]
        if not changed:
            return ""
        return self._words("explorer.inputs", files=self._words.row(self._words.first(changed, MOST_NAMED)))

    def _changed(self, work: Callable[[EditForm], Outcome], body: bytes, query: str) -> Response:
        """Do what a form says; a page that is loaded again does it no second time."""
        with self._lock:
            try:
                form = forms.EditForm(body)
                stale = form.number("version") != self.session.version
                outcome = Outcome(409, Message(PROBLEM, self._words("explorer.stale"))) if stale else work(form)
            except (forms.FormError, RosPrivacyError) as error:
                outcome = Outcome(422, self._refused(error))
            if outcome.status != 200:  # noqa: PLR2004 - of HTTP
                return self._page(query, outcome)
            self._message = outcome.message
            address = self._address(query)
            if outcome.trial:
                address = self._looked_at(query)[1].to("")._replace(find="", trial=outcome.trial).address
        return RedirectResponse(address, 303)

    def _refused(self, error: Exception) -> Message:
        """Why nothing was done; what readers of files and forms say is in English."""
        return Message(PROBLEM, self._words("explorer.refused"), detail=tuple(str(error).splitlines()))

    def _address(self, query: str) -> str:
        """Where a window goes on after a change."""
        return self._looked_at(query)[1].address

    # --- what a form does ---------------------------------------------------------------------------------------

    def _label(self, form: EditForm) -> Outcome:
        standing = self.standing
        answer = forms.answer_in(form, standing.elements, standing.vocabulary.categories)
        alone = form.choice("whose", ROBOT_OR_MODEL) == ROBOT
        label, now = None, self.session.entry_for(answer.element, only_this_robot=alone)
        if answer.role != forms.NOTHING:
            label = cast("Label", label_of(answer, now))
        self.session.answer_for(answer.element, label, only_this_robot=alone)
        self._by = answer.by or self._by
        return Outcome(200, self._answered(answer, now, self._words(f"explorer.answer.{answer.role}")))

    def _take_offers(self, form: EditForm) -> Outcome:
        """Take the suggestions that are ticked, as one answer."""
        standing = self.standing
        element = forms.element_in(form, standing.elements)
        offers = tickable(standing.suggestions.of(element.identity))
        numbers = {str(number): offer for number, offer in enumerate(offers)}
        alone = form.choice("whose", ROBOT_OR_MODEL) == ROBOT
        label = self.session.entry_for(element, only_this_robot=alone)
        ticked = form.several("offer")
        if not ticked or not numbers.keys() >= set(ticked):
            raise forms.FormError("Tick what is so.")
        for number in ticked:
            label = label_of(answer_of(numbers[number], element), label)
        self.session.answer_for(element, cast("Label", label), only_this_robot=alone)
        what = self._words("explorer.offers.ticked")
        text = self._words("explorer.changed", what=f"{shown(element.full_name)} – {what}")
        return Outcome(200, Message(DONE, text))

    def _press(self, form: EditForm) -> Outcome:
        """Take a key on the screen about an element, as the terminal does; an answer is written at once."""
        screens = self._screens
        if screens is None:
            raise forms.FormError("There are no screens here.")
        if screens.waits:
            raise forms.FormError("Save first what was said elsewhere.")
        if form.number("turn") != screens.turn:
            return Outcome(409, Message(PROBLEM, self._words("explorer.stale")))
        if form.value("tick"):
            looked = screens.look()
            lines = [str(at) for at, _ in enumerate(looked.screen.lines, 1)] if looked else []
            screens.tick(int(form.choice("tick", lines)) - 1)
            return Outcome(200, told_of_key(screens, "", self._words, changed=False))
        key = KEY_OF[form.choice("key", KEY_OF)]
        self._by = form.words("by") or self._by
        changed = screens.press(key, self._by)
        return Outcome(200, told_of_key(screens, key, self._words, changed=changed))

    def _answered(self, answer: FormAnswer, before: Any, role: str) -> Message:
        """Tell what was answered, and what was said that it takes away: a limit, or derivations."""
        text = self._words("explorer.changed", what=f"{shown(answer.element.full_name)} – {role}")
        limit = limit_of(before) if answer.role == forms.SENSITIVE and not answer.kinds else ()
        made = made_by(before) if answer.role == forms.ABSENT else ()
        gone = (("explorer.limit.gone", limit), ("explorer.derives.gone", made))
        return Message(DONE, text, tuple(self._words(key, data=self._titles(kinds)) for key, kinds in gone if kinds))

    def _titles(self, kinds: Iterable[str]) -> str:
        vocabulary = self.standing.vocabulary
        known = filter(None, map(vocabulary.find, kinds))
        return self._words.row(title_of(kind.name, vocabulary, self._words) for kind in known)

    def _undo(self, _: EditForm) -> Outcome:
        return Outcome(200, Message(DONE, self._words("explorer.undone")) if self.session.undo() else None)

    def _redo(self, _: EditForm) -> Outcome:
        return Outcome(200, Message(DONE, self._words("explorer.redone")) if self.session.redo() else None)

    def _save(self, _: EditForm) -> Outcome:
        done = self.session.save()
        if isinstance(done, Conflict):
            text = self._words("explorer.conflict", file=shown(done.file))
            return Outcome(409, Message(PROBLEM, text, diff=done.diff))
        text = self._words(
            "explorer.saved_one" if done.lines == 1 else "explorer.saved_other", file=shown(done.file), n=done.lines
        )
        return Outcome(200, Message(DONE, text, detail=done.remarks))

    def _merge(self, _: EditForm) -> Outcome:
        both = self.session.merge()
        if both:
            names = tuple(f"{edit.section}: {shown(edit.name)}" for edit in both)
            return Outcome(200, Message(PROBLEM, self._words("explorer.merged.both"), names))
        return Outcome(200, Message(DONE, self._words("explorer.merged")))

    def _resume(self, _: EditForm) -> Outcome:
        left = self.session.history.unsaved_from_before
        refused = self.session.history.resume()
        text = self._words("explorer.resumed", n=len(left.edits) if left else 0)
        return Outcome(200, Message(PROBLEM if refused else DONE, text, detail=tuple(map(shown, refused))))

    def _forget(self, _: EditForm) -> Outcome:
        self.session.history.forget()
        return Outcome(200, Message(DONE, self._words("explorer.forgotten")))

    def _try(self, form: EditForm) -> Outcome:
        """Try something; nothing that is kept anywhere changes."""
        both = form.value("what") == TOGETHER
        tried = self._trials.together(form) if both else tried_in(form, self.standing, self._words)
        name = form.words("name") or self._new_name()
        self._trials.keep(name, tried)
        return Outcome(200, trial=name)

    def _new_name(self) -> str:
        numbers = (self._words("explorer.trial.name", n=number) for number in count(1))
        return next(name for name in numbers if name not in self._trials.names)

    def _drop(self, form: EditForm) -> Outcome:
        name = form.choice("name", self._trials.names)
        self._trials.drop(name)
        return Outcome(200, Message(DONE, self._words("explorer.trial.dropped", name=name)))

    def _decide(self, form: EditForm) -> Outcome:
        """Write a decision about a finding, or about its row, into the file that the command named."""
        document, words = self.standing.document, self._words
        posted = posted_decision(form, document, self.standing.findings)
        if self.session.decisions_file and (lacks := asked_again(form, posted, document, words)):
            again = Message(PROBLEM, words("explorer.decide.again"), lacks.notes)
            return Outcome(409, again, filled=lacks.fields)
        scope = scope_in(form, self.session, self.standing.findings[posted.finding])
        robots, to_robots = scope.robots or None, scope.to_robots or None
        whose = scope_in_words(self.session, scope, words)  # before it is decided, as it was chosen
        if posted.row and posted.whole:
            here = robots_in_words(self.session, to_robots or robots, words) if robots else ""
            whose = words.row(filter(None, (words.count(len(posted.about), "explorer.row.all"), here)))
            self.session.decide_row(posted.row["id"], posted.choice, robots=to_robots or robots, **posted.how)
        else:
            self.session.decide(scope.finding.id, posted.choice, robots=robots, to_robots=to_robots, **posted.how)
        self._by = posted.how["owner"] or self._by
        what = words.row(filter(None, (words(f"decision.{posted.choice}"), whose)))
        text = words("explorer.decided.to", file=shown(str(self.session.decisions_file)), what=what)
        return Outcome(200, Message(DONE, text))


async def _static(request: Request) -> Response:
    """Our own style and script, by their names; a path from a browser opens nothing."""
    name = request.path_params["name"]
    if name not in STATIC:
        return PlainTextResponse("There is no such file.", 404)
    if name == PICTURE:
        return Response(style_sheet(), media_type=STATIC[name])
    text = files("rosprivacy.explorer.web").joinpath("static").joinpath(name).read_text("utf-8")
    return Response(text, media_type=STATIC[name])
