"""``rosprivacy explore``: label elements and see the effect at once, on a page of this machine."""

from __future__ import annotations

import os
import sys
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import InputError
from rosprivacy.analysis.installing import command_for
from rosprivacy.analysis.text import counted
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Language

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable
    from contextlib import AbstractContextManager
    from pathlib import Path

    from neo4j import Driver
    from starlette.types import ASGIApp

    from rosprivacy.explorer.session import Session

    Opens = Callable[[], AbstractContextManager[Driver]]

NEEDS = ("starlette", "uvicorn")
DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY")


@reads_system(
    "the policies of one robot with label files, a fleet, or what is in a database",
)
def explore(
    inputs: Inputs,
    port: Annotated[
        int, typer.Option(min=0, max=65535, metavar="N", help="Port on this machine; 0 for one that is free.")
    ] = 0,
    open: Annotated[  # noqa: A002 - the option's name
        bool, typer.Option("--open/--no-open", help="Open the page in a browser, where there is a desktop.")
    ] = True,
    read_only: Annotated[bool, typer.Option("--read-only", help="Nothing can be changed on the page.")] = False,
    review: Annotated[
        bool, typer.Option("--review", help="Ask one question at a time, in plain words, and end with the report.")
    ] = False,
    lang: Annotated[Language, typer.Option(help="Language of the page.")] = Language.en,
) -> None:
    """Label elements and see the effect at once, on a local page: what is left to decide, why, and five answers.

    Edits go to the first label file (-l), when you save; it need not be there yet. Of a fleet they go to the label file
    of the robot's model, or to that one robot's. What is in a database is shown only, and asked in Cypher.
    Decisions go at once to the file of --decisions, which need not be there yet either. Ctrl+C ends the program.
    """
    missing = [name for name in NEEDS if find_spec(name) is None]
    if missing:
        raise InputError(", ".join(missing), 0, "not installed", command_for("explore"))
    from rosprivacy.explorer.journal import journal_folder
    from rosprivacy.explorer.web.application import Site
    from rosprivacy.explorer.web.guard import RequestDoor
    from rosprivacy.explorer.web.review_site import ReviewSite
    from rosprivacy.explorer.web.serving import bound_socket
    from rosprivacy.report.catalogs.words import Words

    if review and inputs.from_database:
        hint = "leave --review away, or review the policies and label files of a robot, or a fleet"
        raise InputError("--review", 0, "has no file for answers in a database", hint)
    if inputs.decisions and inputs.from_database:
        hint = "leave it away, and use 'rosprivacy decide'"
        raise InputError("--decisions", 0, "is for policies and fleets, and not for a database", hint)
    read_only = read_only or inputs.from_database
    settings = inputs.settings
    journal = None if read_only else journal_folder()
    session, ask = _session(inputs, journal)
    with bound_socket(port) as listening:
        door, words = RequestDoor(listening.getsockname()[1], read_only), Words(lang.value)
        if ask:
            from rosprivacy.explorer.web.cypher_site import StoredSite

            site: Site = StoredSite(session, settings, words, door, ask)
        else:
            site = (ReviewSite if review else Site)(session, settings, words, door)
        _tell(door.link, door.port)
        opened = _open(door.link) if open else None
        try:
            _serve(site.application(), listening)
        finally:
            if opened:
                opened.unlink(missing_ok=True)
            site.close()
            session.close()
    if session.unsaved:
        next_time = (
            "; it is kept, and the same command offers to take it up" if journal and not session.is_stored else ""
        )
        print(f"Not saved: what was said of {counted(session.unsaved, 'element')}{next_time}", file=sys.stderr)


def _session(inputs: Inputs, journal: Path | None) -> tuple[Session, Opens | None]:
    """Read what is named; for a database, also what opens a driver to it again, and starts no server."""
    from rosprivacy.explorer.session import Session

    if inputs.from_database:
        from rosprivacy.private_neo4j.connection import connection, open_driver

        opens = partial(open_driver, connection(inputs.neo4j))
        with opens() as driver:
            return Session.open_database(driver, inputs.settings), opens
    if inputs.fleet:
        return Session.open_fleet(inputs.fleet, inputs.settings, journal=journal), None
    return Session.open(inputs.required_policies, tuple(inputs.labels or ()), inputs.settings, journal=journal), None


def _tell(link: str, port: int) -> None:
    """Say where the page is; the link opens it once."""
    from rosprivacy.explorer.web.serving import tunnel

    print(f"The page is at {link}\nThe link opens it once, in one browser. Ctrl+C ends the program.", flush=True)
    line = tunnel(port)
    if line:
        print(f"From the machine that you came from by SSH, run this first: {line}", flush=True)


def _open(link: str) -> Path | None:
    """Open the page on a desktop, by a file that only its user can read: what a program is called with all can read.

    The file stands in the home folder, since a browser in a container (snap) sees no other, until the program ends.
    """
    import webbrowser
    from pathlib import Path
    from tempfile import mkstemp

    if not (sys.platform in ("win32", "darwin") or any(os.environ.get(name) for name in DISPLAYS)):
        return None  # a browser that takes over the terminal is none
    try:
        handle, name = mkstemp(prefix="rosprivacy-explore-", suffix=".html", dir=Path.home())
    except (OSError, RuntimeError):
        return None  # the link stands in the terminal
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(f"<!doctype html><meta http-equiv=refresh content='0;url={link}'><a href='{link}'>The page</a>\n")
    webbrowser.open_new_tab(Path(name).as_uri())
    return Path(name)


def _serve(app: ASGIApp, listening: socket.socket) -> None:
    from contextlib import suppress

    from rosprivacy.explorer.web.serving import collect_garbage, server

    collect_garbage()
    with suppress(KeyboardInterrupt):  # that is how it ends
        server(app).run(sockets=[listening])
