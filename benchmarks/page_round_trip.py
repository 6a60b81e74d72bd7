"""The explorer's page: an answer is posted and the new page comes back, against a whole analysis.

All that the server does is counted: the edit and the analysis, what is left to decide, suggestions, the picture with
its layout by Graphviz, and the page as HTML. Only the sockets are left out: the application is called by its interface
(ASGI). Each round begins with a new session that has shown its first page; then the first question is answered, and
the next, as a person does. Two other sides: the command in a fresh process, which is what a person would run else, and
the same analysis by the public API, with its text, in a process that has all modules loaded.
"""

from __future__ import annotations

import gc
import os
import re
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from anyio.from_thread import start_blocking_portal
from httpx2 import ASGITransport, AsyncClient
from measure import Row, compared, processor, run
from round_trip import FIFTH, KINDS, large, turtlebot

import rosprivacy
from rosprivacy.explorer.session import Session
from rosprivacy.explorer.web.application import Site
from rosprivacy.explorer.web.guard import Door
from rosprivacy.report.words.words import Words
from rosprivacy.settings import Settings

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from anyio.from_thread import BlockingPortal
    from measure import Measured

PORT = 8700
HOST = f"http://127.0.0.1:{PORT}"
ANSWERS = 10  # of a round
FIELDS = re.compile(r'name="(element)" value="(\w+)"|data-version="(\d+)"|class="answer" name="role" value="(\w+)"')


class Browser:
    """A browser that opened the link of a new session."""

    def __init__(self, policy: str, labels: str, portal: BlockingPortal) -> None:
        settings = Settings()
        self._portal, door = portal, Door(PORT)
        self.session = Session.open([policy], [labels], settings)
        self.site = Site(self.session, settings, Words("en"), door)
        self._client = AsyncClient(
            transport=ASGITransport(self.site.application()), base_url=HOST, headers={"origin": HOST}
        )
        self._ask("GET", door.link)
        self.page = self._ask("GET", "/")

    def _ask(self, method: str, address: str, form: dict[str, str] | None = None) -> str:
        answer = self._portal.call(partial(self._client.request, method, address, data=form, follow_redirects=True))
        answer.raise_for_status()
        return str(answer.text)

    def answer(self) -> None:
        """Say of the element in hand that it passes data on, or of a channel that it may carry it; get the page."""
        found = list(FIELDS.finditer(self.page))
        element = next(one[2] for one in found if one[2])
        version = next(one[3] for one in found if one[3])
        roles = {one[4] for one in found if one[4]}
        role = "conduit" if "conduit" in roles else "sensitive"
        form = {"version": version, "element": element, "about": "*", "role": role}
        self.page = self._ask("POST", "/label", form)

    def answer_all(self) -> None:
        """Answer what a round answers."""
        for _ in range(ANSWERS):
            self.answer()

    def close(self) -> None:
        """End the process of Graphviz."""
        self.site.close()


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: TurtleBot3, and 2,000 elements with 5,000 flows and 24 kinds of data."""
    rounds = 3 if quick else 7
    with TemporaryDirectory() as name:
        for what, files in (
            ("TurtleBot3", turtlebot(Path(name))),
            (f"2,000 elements, {KINDS} kinds", large(Path(name), apart=True)),
            ("the same, every kind everywhere", large(Path(name), apart=False)),
        ):
            measure = partial(_measured, *files, rounds)
            yield Row(f"an answer and its page, {what}", "the command analyze", measure, FIFTH, goal=True)


def _measured(policy: str, labels: str, rounds: int) -> Measured:
    command = [sys.executable, "-m", "rosprivacy", "analyze", policy, "-l", labels, "--fail-on", "never"]
    answers, commands, calls = list[float](), list[float](), list[float]()
    with start_blocking_portal() as portal:
        for _ in range(rounds + 1):
            browser = Browser(policy, labels, portal)
            answers.append(_seconds(browser.answer_all) / ANSWERS)
            commands.append(_seconds(partial(run, *command)))
            calls.append(_seconds(partial(_call, policy, labels)))
            told = f"{len(browser.session.result.analysis.graph.elements):,} elements; {_memory()}"
            browser.close()
    answers, commands, calls = (some[1:] for some in (answers, commands, calls))  # the first round warms up
    within = compared((answers, calls))
    note = f"{told}; within a process, with its text, analyze takes {within.against}: {within.ratio:.2f} of that"
    return compared((answers, commands), note)


def _call(policy: str, labels: str) -> None:
    rosprivacy.analyze(policy, labels).to("text")


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


def _memory() -> str:
    """What this process and Graphviz hold now."""
    return f"{_held('self'):.0f} MB, and {sum(map(_held, _children())):.0f} MB of Graphviz"


def _held(process: int | str) -> float:
    pages = int(Path(f"/proc/{process}/statm").read_text("ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20
