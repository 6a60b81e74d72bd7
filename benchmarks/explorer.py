"""The explorer: an edit, a picture, and an answer with its whole new page, against a whole analysis; and memory.

A person who answers a question waits for the new page. All that the server does for it is counted: the edit and the
analysis, what is left to decide, suggestions, the picture with its layout by Graphviz, and the page as HTML. Only the
sockets are left out: the application is called by its interface (ASGI). Each round begins with a new session that has
shown its first page; then one question after the other is answered, as a person does. The other side is the command
in a fresh process, under the labels with which the session began.
"""

from __future__ import annotations

import gc
import os
import re
import sys
from dataclasses import replace
from functools import partial
from itertools import count, cycle, islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, NamedTuple

from anyio.from_thread import start_blocking_portal
from httpx2 import ASGITransport, AsyncClient
from labelled_systems import KINDS, large, turtlebot
from measure import Measured, Row, compared, processor, run, side_by_side

import rosprivacy
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.session import Session
from rosprivacy.explorer.web.application import Site
from rosprivacy.explorer.web.guard import RequestDoor
from rosprivacy.explorer.web.serving import collect_garbage
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.pictures.page_pictures import Pictures
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from anyio.from_thread import BlockingPortal

    from rosprivacy.analysis.answer import Analysis

PORT = 8700
HOST = f"http://127.0.0.1:{PORT}"
ANSWERS, PICTURES, EDITS = 10, 40, 5  # of a round
FIFTH = 0.2  # of a whole analysis
EDGE = 0.25  # of an answer that ends data: a fifth on some machines, and on others a little more
EARLY, LATE = 10, 200  # answers of one session after which its memory is looked at
GROWN = 1.5  # a count of bytes; in several runs it was 1.2
FIELDS = re.compile(r'name="element" value="(\w+)"|class="answer" name="role" value="(\w+)"')


class Deed(NamedTuple):
    """What a person does at the page, and what is done before and after it that is not counted."""

    timed: Callable[[Browser], None]
    before: Callable[[Browser], None] = lambda _: None
    after: Callable[[Browser], None] = lambda _: None


class System(NamedTuple):
    """A system with labels, and its name in the table."""

    name: str
    policy: str
    labels: str

    def analysed(self) -> None:
        """Run the command, in a fresh process."""
        run(sys.executable, "-m", "rosprivacy", "analyze", self.policy, "-l", self.labels, "--fail-on", "never")


class Browser:
    """A browser that opened the link of a new session."""

    def __init__(self, system: System, portal: BlockingPortal) -> None:
        settings = Settings()
        self._portal, door = portal, RequestDoor(PORT)
        self.session = Session.open([system.policy], [system.labels], settings)
        self.site = Site(self.session, settings, Words("en"), door)
        self._client = AsyncClient(
            transport=ASGITransport(self.site.application()), base_url=HOST, headers={"origin": HOST}
        )
        self._ask("GET", door.link)
        self.page = self._ask("GET", "/")
        self._numbers = count()

    def _ask(self, method: str, address: str, form: dict[str, str] | None = None) -> str:
        answer = self._portal.call(partial(self._client.request, method, address, data=form, follow_redirects=True))
        answer.raise_for_status()
        return str(answer.text)

    def pass_on(self) -> None:
        """Say of the element in hand that it passes data on, or of a channel that it may carry it; get the page."""
        found = list(FIELDS.finditer(self.page))
        element = next(one[1] for one in found if one[1])
        role = "conduit" if any(one[2] == "conduit" for one in found) else "sensitive"
        self._answer(element, {"role": role})

    def end(self) -> None:
        """Say of an open element that data ends there, each time of another one: data goes other ways; get the page."""
        questions = self.site.standing.questions
        element = questions[next(self._numbers) % len(questions)].element
        drop = {"role": "sanitizer", "method": "drop", "about": "PersonalData"}
        self._answer(element_id(element.identity), drop if element.is_node else {"role": "mundane"})

    def undo(self) -> None:
        """Take the last answer back; get the page."""
        self.page = self._ask("POST", "/undo", {"version": str(self.session.version)})

    def _answer(self, element: str, label: dict[str, str]) -> None:
        form = {"version": str(self.session.version), "element": element, "about": "*", **label}
        self.page = self._ask("POST", "/label", form)

    def close(self) -> None:
        """End the process of Graphviz."""
        self.site.close()


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: TurtleBot3, and 2,000 elements with 5,000 flows and 24 kinds of data."""
    rounds = 3 if quick else 7
    collect_garbage()  # as the server does
    with TemporaryDirectory() as name:
        usual = System(f"2,000 elements, {KINDS} kinds", *large(Path(name), apart=True))
        systems = (
            System("TurtleBot3", *turtlebot(Path(name))),
            usual,
            System("the same, every kind everywhere", *large(Path(name), apart=False)),
        )
        # first: what other rows have left in the process would hide what a session takes
        held = partial(_memory, usual)
        yield Row(f"memory after {LATE} answers, {usual.name}", f"after {EARLY}", held, GROWN, counts=True)
        for one in systems:
            everywhere = one is systems[-1]
            ends = Deed(Browser.end, after=Browser.undo)
            for what, deed, bound in (
                ("an answer and its page", Deed(Browser.pass_on), FIFTH),
                ("an answer that ends data, and its page", ends, FIFTH if everywhere else EDGE),
                ("taking it back, and its page", Deed(Browser.undo, before=Browser.end), FIFTH),
            ):
                measure = partial(_pages, one, rounds, deed)
                goal = everywhere and deed is ends
                yield Row(f"{what}, {one.name}", "the command analyze", measure, bound, goal)
            if not quick:
                edit = partial(_edits, one, rounds)
                yield Row(f"an edit and its effect, {one.name}", "the command analyze", edit, FIFTH)
                yield Row(f"a picture, {one.name}", "the command analyze", partial(_pictures, one, rounds), FIFTH)
                whole = partial(_pictures, one, rounds, everything=True)
                yield Row(f"a picture of all, {one.name}", "the command analyze", whole, FIFTH, goal=True)


def _often(times: int, answer: Callable[[Browser], None], browser: Browser) -> None:
    for _ in range(times):
        answer(browser)


def _pages(system: System, rounds: int, deed: Deed) -> Measured:
    answers, commands = list[float](), list[float]()
    with start_blocking_portal() as portal:
        for _ in range(rounds + 1):
            browser = Browser(system, portal)
            before = _seconds(system.analysed)
            answers.append(sum(_one(deed, browser) for _ in range(ANSWERS)) / ANSWERS)
            commands.append((before + _seconds(system.analysed)) / 2)  # a processor's speed goes up and down
            elements = len(browser.session.uncounted.analysis.graph.elements)
            browser.close()
    return compared((answers[1:], commands[1:]), f"{elements:,} elements")  # the first round warms up


def _one(deed: Deed, browser: Browser) -> float:
    """The processor's seconds of one deed, without what comes before and after it."""
    deed.before(browser)
    seconds = _seconds(partial(deed.timed, browser))
    deed.after(browser)
    return seconds


def _edits(system: System, rounds: int) -> Measured:
    """Label one element after the other in one session; no page is made."""
    session, number = Session.open([system.policy], [system.labels]), count()

    def edits() -> None:
        for _ in range(EDITS):
            # of what the labels say nothing: sources and leaks stay, and so do findings
            asked = [one for one in session.questions() if (one.section, one.name) not in session.entries]
            one = asked[next(number) % len(asked)]
            if one.section == "nodes":
                session.label(one.name, conduit=True)
            else:
                session.label(one.name, kind=one.section, sensitive=True)

    ours, other = side_by_side(rounds, edits, system.analysed)
    return compared(([one / EDITS for one in ours], other), f"{len(session.edits)} edits in one session")


def _pictures(system: System, rounds: int, *, everything: bool = False) -> Measured:
    """Draw pictures of one element after the other, each of an analysis that was not seen before."""
    analysis = rosprivacy.analyze(system.policy, system.labels).analysis
    ours, other = side_by_side(rounds, partial(_draw, analysis, everything=everything), system.analysed)
    note = f"of {len(analysis.open)} open elements {PICTURES} in turn, with the start of Graphviz"
    return compared(([seconds / PICTURES for seconds in ours], other), note)


def _draw(analysis: Analysis, *, everything: bool) -> None:
    with Pictures() as pictures:
        for question in islice(cycle(analysis.open), PICTURES):
            fresh = replace(analysis, lacking=analysis.lacking)
            pictures.of(fresh, question.element.identity, everything=everything)


def _memory(system: System) -> Measured:
    """What this process and Graphviz hold after some answers of a session, and after many."""
    with start_blocking_portal() as portal:
        browser = Browser(system, portal)
        _often(EARLY, Browser.pass_on, browser)
        early = _held()
        _often(LATE - EARLY, Browser.pass_on, browser)
        late = _held()
        browser.close()
    return Measured(f"{late:.0f} MB", f"{early:.0f} MB", late / early, "with Graphviz")


def _seconds(work: Callable[[], object]) -> float:
    """The processor's seconds of some work, with those of a child that goes on living: Graphviz."""
    gc.collect()
    begin = processor() + sum(map(_used, _children()))
    work()
    return processor() + sum(map(_used, _children())) - begin


def _children() -> list[int]:
    """The processes that this one has started and not ended."""
    return [int(one) for file in Path("/proc/self/task").glob("*/children") for one in file.read_text("ascii").split()]


def _used(process: int) -> float:
    """What a process has used so far; Linux counts in ticks of 10 ms, of which many answers have many."""
    fields = Path(f"/proc/{process}/stat").read_text("ascii").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _held() -> float:
    """The memory in MB of this process and of those that it has started."""
    pages = (Path(f"/proc/{one}/statm").read_text("ascii").split()[1] for one in ("self", *_children()))
    return sum(map(int, pages)) * os.sysconf("SC_PAGE_SIZE") / 2**20
