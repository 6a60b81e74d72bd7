"""The pages of what is in a database: those of the explorer, which show it, and one for questions in Cypher.

A question only reads, whoever asks and however the program was started: it is run as ``rosprivacy query`` runs it, in a
transaction for reading, after the server's own plan was looked at, with bounds on time, rows and size
(``queries/run.py``). So ``--read-only`` lets it pass. It is asked of the database as it is then, on a connection of its
own: a server that was lost and came back answers again, and a slow answer holds no other page up.
"""

from __future__ import annotations

from functools import cache
from threading import BoundedSemaphore
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import parse_qsl

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from starlette.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse
from starlette.routing import Route

from rosprivacy.analysis.errors import DatabaseError, RosPrivacyError
from rosprivacy.analysis.text import shortened
from rosprivacy.explorer.element_ids import element_id
from rosprivacy.explorer.web.application import DONE, PROBLEM, READING, Site
from rosprivacy.explorer.web.cypher.cypher_answer import ROWS, picture_of, table_of
from rosprivacy.explorer.web.cypher.cypher_form import EDIT, FIELD, LONGEST_TEXT, Asked, asked_in, prefilled
from rosprivacy.explorer.web.forms import Form, FormError
from rosprivacy.explorer.web.rendering import Message
from rosprivacy.explorer.web.titles import titles_of
from rosprivacy.explorer.web.view import LONGEST, View
from rosprivacy.queries.library import pack
from rosprivacy.reading.stored_rows import rows_of
from rosprivacy.report.explorer.live_svg import Links
from rosprivacy.report.page.html import in_html
from rosprivacy.report.pictures.phrases import Phrases

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from contextlib import AbstractContextManager

    from jinja2 import Template
    from neo4j import Driver
    from starlette.requests import Request
    from starlette.responses import Response

    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.cypher.cypher_answer import Table
    from rosprivacy.explorer.web.guard import Door
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.explorer.pictures import Shown
    from rosprivacy.settings import Settings

CYPHER = "/cypher"
SECONDS = 20.0  # that the server may take for one question
AT_ONCE = 4  # questions; others of the page's threads are left for its other pages
NAMED = 500  # elements that a field offers by name
ROOM = (900.0, 600.0)  # for a picture, in pixels
LONGEST_TITLE = 120


class Answer(NamedTuple):
    """What a question gave.

    Attributes
    ----------
    picture
        None where the rows hold names only, or more than can be drawn.
    warning
        That robots were loaded by another version, in English; empty as a rule.
    """

    table: Table
    picture: Shown | None
    warning: str


class StoredSite(Site):
    """The pages of a database.

    Parameters
    ----------
    opened
        Opens a driver to the database, and sees that the server answers.
    seconds
        That a question may take.
    """

    asks = True
    reading = (*READING, CYPHER)

    def __init__(
        self, session: Session, settings: Settings, words: Words, door: Door,
        opened: Callable[[], AbstractContextManager[Driver]], seconds: float = SECONDS,
    ) -> None:  # fmt: skip
        super().__init__(session, settings, words, door)
        self._opened, self._seconds, self._room = opened, seconds, BoundedSemaphore(AT_ONCE)
        self._say = Phrases.told(words, titles_of(session.uncounted.vocabulary, words))

    def further_routes(self) -> list[Route]:
        """Return the page of questions."""
        return [Route(CYPHER, self._form), Route(CYPHER, self._question, methods=["POST"])]

    async def _form(self, request: Request) -> Response:
        return await run_in_threadpool(self._to_fill_in, request.url.query)

    async def _question(self, request: Request) -> Response:
        body = await request.body()
        return await run_in_threadpool(self._asked, body)

    def _to_fill_in(self, query: str) -> Response:
        """The page with a question of the pack, if the address names one; nothing is asked."""
        said = _said(query)
        standing = self._now_standing()
        element, finding = standing.elements.get(said.get("at", "")), standing.findings.get(said.get("finding", ""))
        chosen = pack().get(said.get("ask", ""))
        at = said["at"] if element else element_id(finding.leak.identity) if finding else ""
        return self._page_of(Asked(chosen, prefilled(chosen, element, finding) if chosen else {}, at=at), standing)

    def _asked(self, body: bytes) -> Response:
        """Ask what a form asks; what cannot be answered stays in its fields."""
        asked, standing = Asked(), self._now_standing()
        try:
            form = Form(body)
            asked = Asked(text=form.one("text"), at=form.one("at"))  # kept, whatever is wrong with the rest
            asked, do = asked_in(form)
            if do == EDIT:
                return self._page_of(asked.to_edit(), standing)
            if not self._room.acquire(blocking=False):
                return self._page_of(asked, standing, Message(PROBLEM, self._words("cy.busy", n=AT_ONCE)), status=429)
            try:
                answer = self._answer(asked, standing)
            finally:
                self._room.release()
        except (FormError, RosPrivacyError) as error:
            status = 503 if isinstance(error, DatabaseError) else 422
            message = Message(PROBLEM, self._words("cy.refused"), detail=tuple(str(error).splitlines()))
            return self._page_of(asked, standing, message, status=status)
        warning = Message(DONE, self._words("cy.warning"), detail=(answer.warning,)) if answer.warning else None
        return self._page_of(asked, standing, warning, answer)

    def _answer(self, asked: Asked, standing: Standing) -> Answer:
        with self._opened() as driver:
            rows, warning = rows_of(
                driver, asked.cypher, asked.values(), limit=ROWS, timeout=self._seconds, asked=asked.query,
                vocabulary=standing.vocabulary,
            )  # fmt: skip
        table = table_of(rows, asked.query, self._words)
        title = asked.query.description if asked.query else shortened(" ".join(asked.text.split()), LONGEST_TITLE)
        picture = picture_of(rows, title, self._say)
        return Answer(table, self._pictures.drawn(picture, _links(standing), ROOM) if picture else None, warning)

    def _now_standing(self) -> Standing:
        with self._lock:
            standing = self.standing
            _ = standing.elements, standing.findings  # made by one thread
            return standing

    def _page_of(
        self, asked: Asked, standing: Standing, message: Message | None = None, answer: Answer | None = None,
        status: int = 200,
    ) -> Response:  # fmt: skip
        at = asked.at if asked.at in standing.elements else ""
        text = _template().render(
            t=in_html(self._words), asked=asked, query=asked.query, message=message, answer=answer,
            svg=Markup(answer.picture.svg) if answer and answer.picture else "",  # noqa: S704 - names in it are escaped
            pack=pack().values(), at=at, back=View().to(at).address, seconds=self._seconds, most=ROWS,
            longest=LONGEST_TEXT, field=FIELD, offered=_offered(standing) if asked.query else {},
        )  # fmt: skip
        return HTMLResponse(text, status)


def _links(standing: Standing) -> Links:
    """Where boxes lead to: to elements that the session has. Where there is one robot only, it names none there."""
    alone = not any(element.robot for element in standing.elements.values())

    def name(key: tuple[str, str, str]) -> str:
        return element_id(("", *key[1:]) if alone else key)

    def address(key: tuple[str, str, str]) -> str:
        return View().to(name(key)).address if name(key) in standing.elements else ""

    return Links(name, address)


def _offered(standing: Standing) -> Mapping[str, tuple[str, ...]]:
    """Names for the fields of parameters, by type; a person may write others."""
    elements = list(standing.elements.values())
    names = sorted({element.name for element in elements}) if len(elements) <= NAMED else []
    found = {
        "category": sorted(standing.vocabulary.categories),
        "robot": sorted({element.robot for element in elements if element.robot}),
        "element": names,
        "data-type": sorted({one for kind in standing.vocabulary.categories.values() for one in kind.data_types}),
        "identity-factor": sorted(
            {one for kind in standing.vocabulary.categories.values() for one in kind.identity_factors}
        ),
    }
    return {type_: tuple(some) for type_, some in found.items()}


def _said(query: str) -> dict[str, str]:
    try:
        return dict(parse_qsl(query[:LONGEST], errors="replace"))
    except ValueError:
        return {}


@cache
def _template() -> Template:
    loader = PackageLoader("rosprivacy.explorer.web")
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template("cypher.html.j2")
