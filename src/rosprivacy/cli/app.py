"""The command line: options in, a ``System`` read and ``answer`` called, a report out, an exit code.

``exit_code.py`` has the table of exit codes. Heavy imports stand in the commands, so that ``--version`` and
completion are quick.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.analysis.files_read import one_run
from rosprivacy.cli.exit_code import OWN_ERROR
from rosprivacy.cli.help import ANALYSE, BEGIN, DECIDE, LABEL, MANY, OBSERVE, SEE, HelpGroup
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterator

COMMANDS = {  # name -> its group in help; each stands in the module of its name
    "try": BEGIN,
    "init": BEGIN,
    "help": BEGIN,
    "observe": OBSERVE,
    "scan": OBSERVE,
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
    "decisions": DECIDE,
    "mitigate": DECIDE,
    "fleet": MANY,
    "load": MANY,
    "unload": MANY,
    "query": MANY,
    "db": MANY,
}
GROUPS = {  # of commands that have commands
    "db": "The private Neo4j: start it, stop it, see where it is.",
    "decisions": "The log of decisions: show it, verify that nobody changed it, join two, take an old file over.",
}
PURPOSE = "Where personal data can go in a ROS 2 system, per kind of data."
NO_COMMAND = 2  # exit code: bad usage
FUNCTIONS = {
    "try": "try_out",
    "help": "help_topic",
    "decisions": "decision_commands",
}  # whose name Python or another module has


@cache
def program(command_name: str = "") -> typer.Typer:
    """Return the command line; with one of its commands where that is named, since the others need not be imported."""
    app = typer.Typer(
        name="rosprivacy",
        help=PURPOSE,
        cls=HelpGroup,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(root)
    for name, panel in COMMANDS.items():
        if command_name in ("", name):
            function = FUNCTIONS.get(name, name.replace("-", "_"))
            module = import_module(f"rosprivacy.cli.{function}")
            if name in GROUPS:
                app.add_typer(module.app, name=name, help=GROUPS[name], rich_help_panel=panel)
            else:
                app.command(name, rich_help_panel=panel)(getattr(module, function))
    return app


def root(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    """Where personal data can go in a ROS 2 system, per kind of data."""
    if version:
        print(f"rosprivacy {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        from rosprivacy.cli.folder_notice import folder_notice

        print(f"Begin here: {folder_notice(Path.cwd())}\n")
        print("\n".join(_commands_by_group()))
        raise typer.Exit(NO_COMMAND)


def _commands_by_group() -> Iterator[str]:
    """What the program does, and the names of its commands: short, for who has named none."""
    yield f"{PURPOSE} Commands:"
    for group in dict.fromkeys(COMMANDS.values()):
        yield f"  {group}: {', '.join(name for name, other in COMMANDS.items() if other == group)}"
    yield "What each does: rosprivacy --help"


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
            from rosprivacy.cli.own_error import confessed

            _end(confessed(error), OWN_ERROR)


def _end(lines: str, code: int) -> NoReturn:
    """End with some lines on standard error; that nobody reads them makes no other code."""
    try:
        print(lines, file=sys.stderr, flush=True)
    except OSError:
        from rosprivacy.cli.output import silence

        with suppress(OSError):
            silence(sys.stderr)
    sys.exit(code)
