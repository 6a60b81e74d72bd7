"""Questions in Cypher on the page of a database: posted forms in, out rows and what is drawn of them.

A question only reads, whoever asks and however the program was started: it is run as ``rosprivacy query`` runs it, in a
transaction for reading, after the server's own plan was looked at, with bounds on time, rows and size
(``queries/run.py``). So ``--read-only`` lets it pass. It is asked of the database as it is then, on a connection of its
own: a server that was lost and came back answers again, and a slow answer holds no other page up. What is cut from an
answer is told (rule S11).

The text of a query comes in a form only, never in an address. A question of the pack is named from a closed list; its
address can name an element or a finding of the session, whose names then stand in the fields, and nothing is asked.
"""

from __future__ import annotations

from threading import BoundedSemaphore
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import parse_qsl

from markupsafe import Markup
from starlette.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse
from starlette.routing import Route

from rosprivacy.analysis.errors import DatabaseError, QueryError, RosPrivacyError
from rosprivacy.analysis.text import printable, shortened
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.application import DONE, PROBLEM, READING, Site
from rosprivacy.explorer.web.forms import EditForm, FormError
from rosprivacy.explorer.web.page import Message, template
from rosprivacy.explorer.web.view import LONGEST, PageView
from rosprivacy.queries.graph_values import graph_values, nodes_in
from rosprivacy.queries.library import Query, pack
from rosprivacy.queries.run import as_cell
from rosprivacy.queries.saved import written_out
from rosprivacy.report.page.html import in_html
from rosprivacy.report.pictures.live_svg import Links
from rosprivacy.report.pictures.query_view import query_view
from rosprivacy.report.text.graph_words import GraphWords
from rosprivacy.systems.stored_system import STORED_NAMES, rows_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from contextlib import AbstractContextManager

    from neo4j import Driver
    from starlette.requests import Request
    from starlette.responses import Response

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element
    from rosprivacy.explorer.session import Session
    from rosprivacy.explorer.web.guard import RequestDoor
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.queries.graph_values import GraphValue
    from rosprivacy.queries.run import QueryRows
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.pictures.page_pictures import PagePicture
    from rosprivacy.report.pictures.phrases import Phrases
    from rosprivacy.report.pictures.picture import Picture
    from rosprivacy.settings import Settings

CYPHER = "/cypher"
SECONDS = 20.0  # that the server may take for one question
AT_ONCE = 4  # questions; others of the page's threads are left for its other pages
SHOWN_AT_MOST = 500  # elements that a field offers by name
ROOM = (900.0, 600.0)  # for a picture, in pixels
LONGEST_TITLE = 120
LONGEST_TEXT = 20_000  # letters of a question
FIELD = "p-"  # begins the names of the fields of parameters
ASK, EDIT = "ask", "edit"
OF_ELEMENT = ("element", "source", "leak", "from")  # parameters that are an element's name
ROWS = 200
LONGEST_CELL = 2_000  # letters
LETTERS = 500_000  # of a table
BOXES = 150  # of a picture, as of a whole system


class AskedQuery(NamedTuple):
    """A question.

    Attributes
    ----------
    query
        Of the pack; None for Cypher of a person's own.
    fields
        Values of its parameters, as they were typed.
    text
        What stands in the text area.
    at
        Id of the element that was in hand before; empty for none.
    """

    query: Query | None = None
    fields: Mapping[str, str] = {}
    text: str = ""
    at: str = ""

    @property
    def cypher(self) -> str:
        """What is to be run."""
        return self.query.text if self.query else self.text

    def values(self) -> dict[str, Any]:
        """Return the values of its parameters; what was left empty has its default."""
        return self.query.values({name: text for name, text in self.fields.items() if text}) if self.query else {}

    def to_edit(self) -> AskedQuery:
        """Return the same as Cypher in the text area, with the values that were typed and the defaults in it."""
        if not self.query:
            return self
        typed = {name: text for name, text in self.fields.items() if text}
        needed = (field.name for field in self.query.parameters if field.default is None)
        missing = {name: "" for name in needed if name not in typed}
        values = self.query.values({**missing, **typed})
        known = {name: value for name, value in values.items() if name not in missing}
        return AskedQuery(text=written_out(self.query, known), at=self.at)


def asked_in(form: EditForm) -> tuple[AskedQuery, str]:
    """Return what a form asks, and whether it is to be asked or to be edited."""
    do = form.choice("do", (ASK, EDIT)) if form.value("do") else ASK
    name, at = form.value("ask"), form.value("at")
    if name:
        if name not in pack():
            raise FormError("There is no such question; choose one of the list.")
        query = pack()[name]
        return AskedQuery(query, {field.name: form.value(FIELD + field.name) for field in query.parameters}, at=at), do
    text = form.value("text").replace("\r\n", "\n")
    if len(text) > LONGEST_TEXT:
        raise FormError(f"The text has at most {LONGEST_TEXT:,} letters; use rosprivacy query --file for a longer one.")
    if not text.strip():
        raise FormError("There is nothing to ask: choose a question, or write one.")
    return AskedQuery(text=text, at=at), do


def prefilled(query: Query, element: Element | None, finding: Finding | None) -> dict[str, str]:
    """Return values of parameters for what a person came from.

    >>> from rosprivacy.analysis.model import Element
    >>> from rosprivacy.queries.library import find
    >>> prefilled(find("sources-of-element"), Element("node", "/planner", "r1"), None)
    {'element': '/planner', 'robot': 'r1'}
    """
    known: dict[str, str] = {}
    if element:
        known |= {**dict.fromkeys(OF_ELEMENT, element.name), "robot": element.robot}
    if finding:
        known |= {"category": finding.category, "source": finding.source.name, "leak": finding.leak.name}
        known["robot"] = finding.source.robot
    return {field.name: known[field.name] for field in query.parameters if field.name in known}


# --- its answer -------------------------------------------------------------------------------------------------


class Column(NamedTuple):
    """A column; what it means is said by the header of a question of the pack, in English."""

    name: str
    meaning: str


class QueryTable(NamedTuple):
    """Rows to be shown.

    Attributes
    ----------
    is_cut
        Whether there are more rows than these.
    """

    columns: tuple[Column, ...]
    rows: tuple[tuple[str, ...], ...]
    is_cut: bool


def table_of(rows: QueryRows, query: Query | None, words: Words) -> QueryTable:
    """Return a table of at most ``ROWS`` rows and ``LETTERS`` letters."""
    meanings = {column.name: column.meaning for column in query.columns} if query else {}
    columns = tuple(Column(printable(name), meanings.get(name, "")) for name in rows.columns)
    told: list[tuple[str, ...]] = []
    letters = 0
    try:
        say = GraphWords.for_rows(STORED_NAMES, rows.rows, words).of
        for row in rows.rows[:ROWS]:
            cells = tuple(_cut(as_cell(value, name, say), words) for value, name in zip(row, rows.columns, strict=True))
            letters += sum(map(len, cells))
            if told and letters > LETTERS:
                break
            told.append(cells)
    except RecursionError:
        raise QueryError("the rows hold lists in lists that are too deep to be read; ask for less") from None
    return QueryTable(columns, tuple(told), rows.truncated or len(told) < len(rows.rows))


def _cut(text: str, words: Words) -> str:
    more = len(text) - LONGEST_CELL
    return (
        printable(text) if more <= 0 else f"{printable(text[:LONGEST_CELL])}… ({words.count(more, 'cypher.letters')})"
    )


def picture_of(rows: QueryRows, title: str, say: Phrases) -> Picture | None:
    """Return a picture of the nodes, relationships and paths of the first rows; None if there are none, or too many.

    Notes
    -----
    It has rows as long as there are no more than ``BOXES`` boxes; the note says how many.
    """
    values: list[GraphValue] = []
    nodes: set[str] = set()
    drawn = 0
    for row in rows.rows[:ROWS]:
        here = list(graph_values(row))
        nodes |= {node.id for value in here for node in nodes_in(value)}
        if len(nodes) > BOXES:
            break
        values += here
        drawn += 1
    if not values:
        return None
    every = drawn == len(rows.rows) and not rows.truncated
    note = say.words("cypher.drawn.all") if every else say.words("cypher.drawn.some", n=drawn)
    return query_view(values, STORED_NAMES, title, (note,), say)


# --- the pages --------------------------------------------------------------------------------------------------


class QueryAnswer(NamedTuple):
    """What a question gave.

    Attributes
    ----------
    picture
        None where the rows hold names only, or more than can be drawn.
    warning
        That robots were loaded by another version, in English; empty as a rule.
    """

    table: QueryTable
    picture: PagePicture | None
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
        self, session: Session, settings: Settings, words: Words, door: RequestDoor,
        opened: Callable[[], AbstractContextManager[Driver]], seconds: float = SECONDS,
    ) -> None:  # fmt: skip
        super().__init__(session, settings, words, door)
        self._opened, self._seconds, self._room = opened, seconds, BoundedSemaphore(AT_ONCE)

    def further_routes(self) -> list[Route]:
        """Return the page of questions."""
        return [Route(CYPHER, self._form), Route(CYPHER, self._question, methods=["POST"])]

    async def _form(self, request: Request) -> Response:
        return await run_in_threadpool(self._to_fill_in, request.url.query)

    async def _question(self, request: Request) -> Response:
        body = await request.body()
        return await run_in_threadpool(self._ask, body)

    def _to_fill_in(self, query: str) -> Response:
        """The page with a question of the pack, if the address names one; nothing is asked."""
        said = _summary(query)
        standing = self._now_standing()
        element, finding = standing.elements.get(said.get("at", "")), standing.findings.get(said.get("finding", ""))
        chosen = pack().get(said.get("ask", ""))
        at = said["at"] if element else element_id(finding.leak.identity) if finding else ""
        return self._page_of(AskedQuery(chosen, prefilled(chosen, element, finding) if chosen else {}, at=at), standing)

    def _ask(self, body: bytes) -> Response:
        """Ask what a form asks; what cannot be answered stays in its fields."""
        entered, standing = AskedQuery(), self._now_standing()
        try:
            form = EditForm(body)
            entered = AskedQuery(text=form.value("text"), at=form.value("at"))  # kept, whatever is wrong with the rest
            entered, do = asked_in(form)
            if do == EDIT:
                return self._page_of(entered.to_edit(), standing)
            if not self._room.acquire(blocking=False):
                return self._page_of(
                    entered, standing, Message(PROBLEM, self._words("cypher.busy", n=AT_ONCE)), status=429
                )
            try:
                answer = self._answer(entered, standing)
            finally:
                self._room.release()
        except (FormError, RosPrivacyError) as error:
            status = 503 if isinstance(error, DatabaseError) else 422
            message = Message(PROBLEM, self._words("cypher.refused"), detail=tuple(str(error).splitlines()))
            return self._page_of(entered, standing, message, status=status)
        warning = Message(DONE, self._words("cypher.warning"), detail=(answer.warning,)) if answer.warning else None
        return self._page_of(entered, standing, warning, answer)

    def _answer(self, entered: AskedQuery, standing: Standing) -> QueryAnswer:
        with self._opened() as driver:
            rows, warning = rows_of(
                driver, entered.cypher, entered.values(), limit=ROWS, timeout=self._seconds, query=entered.query,
                vocabulary=standing.vocabulary,
            )  # fmt: skip
        table = table_of(rows, entered.query, self._words)
        title = entered.query.description if entered.query else shortened(" ".join(entered.text.split()), LONGEST_TITLE)
        picture = picture_of(rows, title, self._phrases)
        return QueryAnswer(table, self._pictures.drawn(picture, _links(standing), ROOM) if picture else None, warning)

    def _now_standing(self) -> Standing:
        with self._lock:
            standing = self.standing
            _ = standing.elements, standing.findings  # made by one thread
            return standing

    def _page_of(
        self, entered: AskedQuery, standing: Standing, message: Message | None = None,
        answer: QueryAnswer | None = None, status: int = 200,
    ) -> Response:  # fmt: skip
        at = entered.at if entered.at in standing.elements else ""
        text = template("cypher").render(
            t=in_html(self._words), asked=entered, query=entered.query, message=message, answer=answer,
            svg=Markup(answer.picture.svg) if answer and answer.picture else "",  # noqa: S704 - names in it are escaped
            pack=pack().values(), at=at, back=PageView().to(at).address, seconds=self._seconds, most=ROWS,
            longest=LONGEST_TEXT, field=FIELD, offered=_offered(standing) if entered.query else {},
        )  # fmt: skip
        return HTMLResponse(text, status)


def _links(standing: Standing) -> Links:
    """Where boxes lead to: to elements that the session has. Where there is one robot only, it names none there."""
    alone = not any(element.robot for element in standing.elements.values())

    def name(key: tuple[str, str, str]) -> str:
        return element_id(("", *key[1:]) if alone else key)

    def address(key: tuple[str, str, str]) -> str:
        return PageView().to(name(key)).address if name(key) in standing.elements else ""

    return Links(name, address)


def _offered(standing: Standing) -> Mapping[str, tuple[str, ...]]:
    """Names for the fields of parameters, by type; a person may write others."""
    elements = list(standing.elements.values())
    names = sorted({element.name for element in elements}) if len(elements) <= SHOWN_AT_MOST else []
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


def _summary(query: str) -> dict[str, str]:
    try:
        return dict(parse_qsl(query[:LONGEST], errors="replace"))
    except ValueError:
        return {}
