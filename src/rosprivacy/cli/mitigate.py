"""``rosprivacy mitigate``: what to change so that findings go."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.cli.options import (
    DecisionsFile,
    Format,
    IncludeRoot,
    LabelFiles,
    MaxBytes,
    NoStandard,
    Output,
    Policies,
    SixLists,
    Standard,
    View,
    ViewChosen,
    complete_category,
)
from rosprivacy.cli.output import emit, on_console, progress_of


class By(StrEnum):
    """Kinds of change."""

    review = "review"
    filter = "filter"
    deny = "deny"


def mitigate(
    policies: Policies = None,
    labels: LabelFiles = None,
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
    format: Annotated[Format, typer.Option("--format", "-f", help="Of the answer.")] = Format.text,  # noqa: A002 - the option's name
    output: Output = None,
    categories: Annotated[
        list[str] | None,
        typer.Option(
            "--categories",
            "-c",
            metavar="NAME",
            autocompletion=complete_category,
            show_default=False,
            help="Remove the findings of this category, narrower, broader and overlapping ones only; may be repeated.",
        ),
    ] = None,
    category: SixLists = "PersonalData",
    decisions: DecisionsFile = None,
    view: ViewChosen = View.declared,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
) -> None:
    """Propose the cheapest changes that remove the open findings, proven by a new analysis.

    Ends with 1 if a finding stays that no change removes.
    """
    from rosprivacy.analysis.mitigation.limits import CHANGES
    from rosprivacy.assembly import run
    from rosprivacy.mitigation import run_mitigation
    from rosprivacy.report.document.analysis import as_text
    from rosprivacy.report.terminal.mitigation import print_mitigation
    from rosprivacy.settings import Settings

    if not policies:
        raise typer.BadParameter("name at least one policy: a file, a folder or a glob", param_hint="POLICY")
    settings = Settings(
        view=view.value,
        categories=tuple(categories or ()),
        category=category,
        standard_channels=None if no_standard_channels else standard_channels,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=progress_of,
        decisions=str(decisions) if decisions else None,
    )
    result = run(tuple(policies), tuple(labels or ()), settings)
    kinds = tuple(kind.value for kind in by) if by else CHANGES
    found = run_mitigation(result, str(limits) if limits else None, kinds)
    report = found.document()
    texts = {patch: found.patch.diff or None} if patch else {}
    if format is Format.json:
        emit(as_text(report), output, texts)
    else:
        emit(on_console(lambda console: print_mitigation(console, report), colour=output is None), output, texts)
    if patch and not found.patch.diff:
        print(f"{shown(str(patch))}: left as it is: there is no patch; the answer says why", file=sys.stderr)
    raise typer.Exit(0 if found.complete else 1)
