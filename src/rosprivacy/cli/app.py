"""The command line: options in, a ``System`` read and ``answer`` called, a report out, an exit code.

``exit_code.py`` has the table of exit codes. Heavy imports stand in the commands, so that ``--version`` and
completion are quick.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import Annotated, NoReturn

import typer

from rosprivacy.analysis.errors import RosPrivacyError
from rosprivacy.analysis.files_read import one_run
from rosprivacy.cli import (
    analyze,
    bag,
    categories,
    db,
    decide,
    diff,
    fleet,
    graph,
    labels,
    law,
    load,
    mitigate,
    observe,
    query,
    report,
    show,
    unload,
    why_not,
)
from rosprivacy.cli.exit_code import OWN_ERROR
from rosprivacy.cli.help import ANALYSE, DECIDE, LABEL, MANY, OBSERVE, SEE, Group
from rosprivacy.version import __version__

app = typer.Typer(
    name="rosprivacy",
    help="Where personal data can go in a ROS 2 system, per kind of data.",
    cls=Group,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command(rich_help_panel=OBSERVE)(observe.observe)
app.command(rich_help_panel=LABEL)(labels.labels)
app.command(rich_help_panel=LABEL)(categories.categories)
app.command(rich_help_panel=LABEL)(law.law)
app.command(rich_help_panel=ANALYSE)(analyze.analyze)
app.command(rich_help_panel=ANALYSE)(show.show)
app.command("why-not", rich_help_panel=ANALYSE)(why_not.why_not)
app.command(rich_help_panel=ANALYSE)(diff.diff)
app.command(rich_help_panel=ANALYSE)(bag.bag)
app.command(rich_help_panel=SEE)(report.report)
app.command(rich_help_panel=SEE)(graph.graph)
app.command(rich_help_panel=DECIDE)(decide.decide)
app.command(rich_help_panel=DECIDE)(mitigate.mitigate)
app.command(rich_help_panel=MANY)(fleet.fleet)
app.command(rich_help_panel=MANY)(load.load)
app.command(rich_help_panel=MANY)(unload.unload)
app.command(rich_help_panel=MANY)(query.query)
app.add_typer(db.app, name="db", help="The private Neo4j: start it, stop it, see where it is.", rich_help_panel=MANY)


@app.callback(invoke_without_command=True)
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
    with one_run():
        try:
            app()
        except RosPrivacyError as error:
            _end(str(error), error.exit_code)
        except Exception as error:  # noqa: BLE001 - whatever it is, it is an error of our own
            from rosprivacy.cli.own_error import confessed

            _end(confessed(error), OWN_ERROR)


def _end(said: str, code: int) -> NoReturn:
    """End with some lines on standard error; that nobody reads them makes no other code."""
    with suppress(OSError):
        print(said, file=sys.stderr, flush=True)
    sys.exit(code)
