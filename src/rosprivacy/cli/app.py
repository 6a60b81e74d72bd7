"""The command line: options in, a ``System`` read and ``answer`` called, a report out, an exit code.

``exit_code.py`` has the table of exit codes. Heavy imports stand in the commands, so that ``--version`` and
completion are quick.
"""

from __future__ import annotations

import os
import sys
import tempfile
import traceback
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from rosprivacy.analysis.errors import RosPrivacyError, shown
from rosprivacy.analysis.files_read import names_read, one_run
from rosprivacy.analysis.text import counted
from rosprivacy.cli.exit_code import OWN_ERROR
from rosprivacy.cli.help import ANALYSE, DECIDE, LABEL, MANY, OBSERVE, SEE, Group
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator


COMMANDS = {  # name -> its group in help; each stands in the module of its name
    "observe": OBSERVE,
    "labels": LABEL,
    "explore": LABEL,
    "suggest": LABEL,
    "annotations": LABEL,
    "categories": LABEL,
    "law": LABEL,
    "analyze": ANALYSE,
    "show": ANALYSE,
    "why-not": ANALYSE,
    "diff": ANALYSE,
    "bag": ANALYSE,
    "lint": ANALYSE,
    "check": ANALYSE,
    "report": SEE,
    "graph": SEE,
    "decide": DECIDE,
    "mitigate": DECIDE,
    "fleet": MANY,
    "load": MANY,
    "unload": MANY,
    "query": MANY,
    "db": MANY,
}


@cache
def program(only: str = "") -> typer.Typer:
    """Return the command line; with one of its commands where that is named, since the others need not be imported."""
    app = typer.Typer(
        name="rosprivacy",
        help="Where personal data can go in a ROS 2 system, per kind of data.",
        cls=Group,
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(root)
    for name, panel in COMMANDS.items():
        if only in ("", name):
            module = import_module(f"rosprivacy.cli.{name.replace('-', '_')}")
            if name == "db":
                what = "The private Neo4j: start it, stop it, see where it is."
                app.add_typer(module.app, name=name, help=what, rich_help_panel=panel)
            else:
                app.command(name, rich_help_panel=panel)(getattr(module, name.replace("-", "_")))
    return app


def root(
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Where personal data can go in a ROS 2 system, per kind of data."""
    if version:
        print(f"rosprivacy {__version__}")
        raise typer.Exit


def main() -> None:
    """Run the command line; a problem that we raise is one line each on standard error, never a traceback.

    An error of our own is no finding: Python would end with 1, which says 'leak'.
    """
    named = "".join(sys.argv[1:2])
    with one_run():
        try:
            program(named if named in COMMANDS else "")()
        except RosPrivacyError as error:
            _end(str(error), error.exit_code)
        except Exception as error:  # noqa: BLE001 - whatever it is, it is an error of our own
            _end(confessed(error), OWN_ERROR)


def _end(said: str, code: int) -> NoReturn:
    """End with some lines on standard error; that nobody reads them makes no other code."""
    try:
        print(said, file=sys.stderr, flush=True)
    except OSError:  # else Python tries once more at its end, and ends with a code of its own
        with suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    sys.exit(code)


PACKAGE = Path(__file__).resolve().parent.parent
NAMED = 3  # files that are named


def confessed(error: BaseException) -> str:
    """Write down where the program failed; return the line that says so.

    Where no file can be written, the line alone has to do.
    """
    first = error.__cause__ or error
    what = f"rosprivacy: an error of the program itself, and no answer: {_kind(first)} in {_place(first)}"
    read = [shown(name) for name in names_read() if not _is_ours(Path(name))]
    more = f" and {counted(len(read) - NAMED, 'more file')}" if len(read) > NAMED else ""
    inputs = f", and, if you may, what was read: {', '.join(read[:NAMED])}{more}" if read else ""
    try:
        with tempfile.NamedTemporaryFile(
            "w", prefix="rosprivacy-error-", suffix=".txt", delete=False, encoding="utf-8"
        ) as file:
            file.write("".join(_lines(error)))
    except OSError:
        return f"{what}; please send us this line{inputs}"
    return f"{what}; please send us {shown(file.name)}, which has no text of your files{inputs}"


def _lines(error: BaseException) -> Iterator[str]:
    """A traceback without messages; what caused an error stands above it."""
    yield f"rosprivacy {__version__}, Python {sys.version.split()[0]}, {sys.platform}\n"
    for one in _chain(error):
        yield f"\n{_kind(one)}\n"
        yield from traceback.StackSummary.extract(traceback.walk_tb(one.__traceback__)).format()


def _chain(error: BaseException) -> list[BaseException]:
    """An error and its causes, the first cause first."""
    chain: list[BaseException] = []
    left: BaseException | None = error
    while left is not None and left not in chain:
        chain.append(left)
        left = left.__cause__ or left.__context__
    return chain[::-1]


def _kind(error: BaseException) -> str:
    kind = type(error)
    return kind.__name__ if kind.__module__ == "builtins" else f"{kind.__module__}.{kind.__name__}"


def _place(error: BaseException) -> str:
    """The innermost line of the program, as ``module.py:line``."""
    frames = [(Path(f.f_code.co_filename), line) for f, line in traceback.walk_tb(error.__traceback__)]
    ours = [(file, line) for file, line in frames if _is_ours(file)]
    file, line = (ours or frames or [(PACKAGE, 0)])[-1]
    return f"{file.parent.name}/{file.name}:{line}"


def _is_ours(file: Path) -> bool:
    """Whether a file came with the program; in a checkout the rooms are links."""
    rooms = {PACKAGE, *(room.resolve() for room in PACKAGE.iterdir() if room.is_symlink())}
    return bool(rooms & set(file.resolve().parents))
