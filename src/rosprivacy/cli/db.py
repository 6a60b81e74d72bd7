"""``rosprivacy db``: the private Neo4j, started, stopped and asked after.

The password is never printed, only where it is kept: what a terminal shows is seen, recorded and pasted.
"""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.analysis.errors import InputError, reason
from rosprivacy.cli.help import HelpGroup
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.private_neo4j.connection import Connection, Status

DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY")
CLIPBOARDS = {"wl-copy": "", "xclip": " -selection clipboard", "xsel": " -ib", "pbcopy": ""}
app = typer.Typer(cls=HelpGroup, no_args_is_help=True)


@app.command()
def start() -> None:
    """Start the private Neo4j if it does not run, and say where it is; fetch it the first time (155 MB)."""
    from rosprivacy.private_neo4j import connection

    connection.start()
    _print(_described(connection.status()))


@app.command()
def stop() -> None:
    """Stop the private Neo4j; its data stay."""
    from rosprivacy.private_neo4j import connection

    _print("Neo4j was running and is stopped" if connection.stop() else "Neo4j was not running")


@app.command()
def status() -> None:
    """Say whether the private Neo4j runs, and where."""
    from rosprivacy.private_neo4j import connection

    _print(_described(connection.status()))


@app.command()
def path() -> None:
    """Print the folder that holds the private Neo4j's data, settings, logs and password."""
    from rosprivacy.private_neo4j import connection

    _print(str(connection.state_folder()))


@app.command()
def browser(
    files: Annotated[
        Path | None,
        typer.Option(
            metavar="FOLDER",
            show_default=False,
            help="Where the files go that the page is given; by default beside the private server's data.",
        ),
    ] = None,
    open_page: Annotated[
        bool, typer.Option("--open/--no-open", help="Open the page in the browser of this desktop, if there is one.")
    ] = True,
) -> None:
    """Open the Neo4j Browser on the private Neo4j, with the program's colours and its questions as files to drop."""
    from rosprivacy.private_neo4j import connection
    from rosprivacy.private_neo4j.browser_files import DASHBOARD, QUERIES, STYLE, address
    from rosprivacy.private_neo4j.state import keep_private

    made = _browser_files(connection.start())
    found = connection.status()
    folder = files or connection.state_folder() / "browser"
    _write(folder, made)
    if files is None:
        keep_private(folder)  # as all that is kept beside the server's data
    page = address(str(found.browser), str(found.uri), connection.USER)
    lines = [
        f"Browser:   {page}",
        f"User name: {connection.USER}",
        f"Password:  in {found.password_file}{_copied_by(found.password_file)}",
        f"Files:     {folder}",
        "Once in the page, drag these two files onto it:",
        f"    {STYLE}: the colours of the program's pictures",
        f"    {QUERIES}: the program's questions, in the side bar under the star",
        f"{DASHBOARD} there is a dashboard for NeoDash",
    ]
    _print("\n".join(lines))
    if open_page:
        _open(page)


def _browser_files(to: Connection) -> Mapping[str, str | bytes]:
    """Make the files, for the categories of the program and of what is loaded."""
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.private_neo4j.browser_files import CATEGORIES, browser_files
    from rosprivacy.private_neo4j.connection import open_driver
    from rosprivacy.queries.run import run

    known = {category.label: not category.broader for category in load().categories.values()}
    with open_driver(to) as driver:
        known |= {str(label): bool(top) for label, top in run(driver, CATEGORIES, limit=None).rows}
    return browser_files(known, [label for label, top in known.items() if top])


def _write(folder: Path, files: Mapping[str, str | bytes]) -> None:
    from rosprivacy.report.atomic import write_texts

    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(str(folder), 0, f"cannot be made: {reason(error)}", "name another with --files") from None
    write_texts((folder / name, text) for name, text in files.items())


def _copied_by(file: Path) -> str:
    """How to get the password to the page without showing it to whoever looks at the terminal."""
    program = next((name for name in CLIPBOARDS if shutil.which(name)), "")
    return f"; copy it with: {program}{CLIPBOARDS[program]} < {shlex.quote(str(file))}" if program else ""


def _open(page: str) -> None:
    """Open the page on a desktop; a browser that takes over the terminal is none."""
    import webbrowser

    desktop = sys.platform in ("win32", "darwin") or any(os.environ.get(name) for name in DISPLAYS)
    if not desktop or not webbrowser.open_new_tab(page):
        print("There is no desktop to open the page on; open its address yourself", file=sys.stderr)


def _described(server: Status) -> str:
    from rosprivacy.private_neo4j.connection import USER

    if server.running:
        lines = [
            f"Neo4j {server.version} is running",
            f"Bolt:      {server.uri}",
            f"Browser:   {server.browser}",
            f"User name: {USER}",
            f"Password:  in {server.password_file}",
        ]
    else:
        lines = [f"Neo4j {server.version} is stopped; start it with: rosprivacy db start"]
    lines.append(f"Files:     {server.folder}")
    if os.environ.get("NEO4J_URI"):
        lines.append("Note:      NEO4J_URI is set, so the other commands use the server that it names")
    return "\n".join(lines)


def _print(text: str) -> None:
    emit(f"{text}\n", None)
