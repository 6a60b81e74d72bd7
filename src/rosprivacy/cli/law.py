"""``rosprivacy law``: the provisions that findings point to, and how old what the program knows of them is."""

from __future__ import annotations

import os
from typing import Annotated

import typer

from rosprivacy.cli.exit_code import UNDETERMINED
from rosprivacy.cli.options import Language, Output
from rosprivacy.cli.output import emit


def law(
    check: Annotated[
        bool, typer.Option("--check", help="Print what was read more than six months ago; exit with 4 if there is any.")
    ] = False,
    lang: Annotated[Language, typer.Option(help="Language of names and texts.")] = Language.en,
    output: Output = None,
) -> None:
    """Print the provisions that findings point to, each with the date of the law, and that of adequacy decisions."""
    from rosprivacy.clock import today
    from rosprivacy.ingest.labels.countries import countries
    from rosprivacy.ontology.provisions import provisions
    from rosprivacy.report.terminal.law import law_lines, old_lines

    known, adequacy = provisions(lang.value), countries().as_of
    if not check:
        emit("".join(f"{line}\n" for line in law_lines(known, adequacy)), output)
        return
    old = old_lines(known, adequacy, today(os.environ))
    oldest = min([adequacy, *(provision.as_of for provision in known)])
    emit(
        "".join(f"{line}\n" for line in old) or f"nothing is older than six months; the oldest is of {oldest}\n", output
    )
    if old:
        raise typer.Exit(UNDETERMINED)
