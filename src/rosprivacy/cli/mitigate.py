"""``rosprivacy mitigate``: what to change so that findings go."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Output, TextOrJson
from rosprivacy.cli.output import emit, on_console


class By(StrEnum):
    """Kinds of change."""

    review = "review"
    filter = "filter"
    deny = "deny"


@reads_system("the policies of one robot", without=("fleet", "from_database", "neo4j"))
def mitigate(
    inputs: Inputs,
    limits: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="What may be changed, where, and at what cost.", show_default=False),
    ] = None,
    by: Annotated[
        list[By] | None,
        typer.Option(help="Propose this kind of change only; may be repeated.", show_default=False),
    ] = None,
    patch: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the lines to be set to DENY as a unified diff.", show_default=False),
    ] = None,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", "-v", help="Of text: every way to set a program, and all that gets less.")
    ] = False,
) -> None:
    """Propose the cheapest changes that remove the open findings, proven by a new analysis.

    Ends with 1 if a finding stays that no change removes.
    """
    from rosprivacy.analysis.mitigation.limits import CHANGES
    from rosprivacy.mitigation import run_mitigation
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.text.mitigation import print_mitigation

    settings = inputs.settings
    result = inputs.result(settings)
    kinds = tuple(kind.value for kind in by) if by else CHANGES
    found = run_mitigation(result, str(limits) if limits else None, kinds, settings.bounds)
    report = found.document()
    texts = {patch: found.patch.diff or None} if patch else {}
    if format is TextOrJson.json:
        emit(as_text(report), output, texts)
    else:

        def write(console: Any) -> None:
            print_mitigation(console, report, verbose=verbose)

        emit(on_console(write, colour=output is None), output, texts)
    if patch and not found.patch.diff:
        print(f"{shown(str(patch))}: left as it is: there is no patch; the answer says why", file=sys.stderr)
    raise typer.Exit(0 if found.complete else 1)
