"""``rosprivacy law``: the provisions that findings point to, and how old and sure what is known of them is."""

from __future__ import annotations

import os
from typing import Annotated

import typer

from rosprivacy.cli.exit_code import UNDETERMINED
from rosprivacy.cli.options import Language, Output
from rosprivacy.cli.output import emit


def law(
    name: Annotated[
        str | None,
        typer.Argument(metavar="[NAME]", help="Only what is called so, such as 'AI Act Art. 27'."),
    ] = None,
    check: Annotated[
        bool,
        typer.Option(
            "--check",
            help="Print what was last looked at more than six months ago, and what is not confirmed; exit with 4 if "
            "there is any.",
        ),
    ] = False,
    lang: Annotated[Language, typer.Option(help="Language of names and texts.")] = Language.en,
    output: Output = None,
) -> None:
    """Print the provisions that findings point to, each with the day of our last look, and adequacy decisions."""
    from rosprivacy.analysis.errors import shown
    from rosprivacy.clock import today
    from rosprivacy.ingest.labels.countries import countries
    from rosprivacy.ontology.provisions import provisions, provisions_named
    from rosprivacy.report.text.categories import law_lines, old_lines, unconfirmed_lines

    known, adequacy = provisions_named(provisions(lang.value), name or ""), countries().as_of
    if not known:
        raise typer.BadParameter(f"no provision is called {shown(name or '')!r}; 'rosprivacy law' prints all")
    if not check:
        emit("".join(f"{line}\n" for line in law_lines(known, adequacy)), output)
        return
    doubtful = [*old_lines(known, adequacy, today(os.environ)), *unconfirmed_lines(known)]
    oldest = min([adequacy, *(provision.as_of for provision in known)])
    fine = f"each entry was looked at in the last six months, the oldest on {oldest}\n"
    emit("".join(f"{line}\n" for line in doubtful) or fine, output)
    if doubtful:
        raise typer.Exit(UNDETERMINED)
