"""``rosprivacy why-not``: why data of one element does not get to another, and on whose word."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from rosprivacy.cli.options import (
    FleetFile,
    IncludeRoot,
    LabelFiles,
    MaxBytes,
    NoStandard,
    Ontologies,
    Output,
    Policies,
    SixLists,
    Standard,
    TextOrJson,
    View,
    ViewChosen,
)
from rosprivacy.cli.output import emit, progress_of

if TYPE_CHECKING:
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


def why_not(
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="Where data comes in: a name; of a fleet robot:name.")
    ],
    leak: Annotated[
        str, typer.Argument(metavar="LEAK", help="Where it should not get: a name; of a fleet robot:name.")
    ],
    policies: Policies = None,
    labels: LabelFiles = None,
    fleet: FleetFile = None,
    categories: Annotated[
        list[str] | None,
        typer.Option("--categories", "-c", metavar="NAME", show_default=False, help="Ask about this kind only."),
    ] = None,
    ontology: Ontologies = None,
    category: SixLists = "PersonalData",
    view: ViewChosen = View.declared,
    standard_channels: Standard = "rosprivacy:standard",
    no_standard_channels: NoStandard = False,
    include_root: IncludeRoot = None,
    max_bytes: MaxBytes = 64 * 2**20,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Tell why data of one element does not get to another: where its way ends, and on whose word."""
    from rosprivacy.report.document.analysis import as_text
    from rosprivacy.report.document.why_not import document
    from rosprivacy.report.terminal.why_not import lines
    from rosprivacy.settings import Settings

    settings = Settings(
        view=view.value,
        ontologies=tuple(ontology or ()),
        category=category,
        standard_channels=None if no_standard_channels else standard_channels,
        include_root=str(include_root) if include_root else None,
        max_bytes=max_bytes,
        progress=progress_of,
    )
    if bool(fleet) == bool(policies):
        raise typer.BadParameter("name policies, or a fleet with --fleet")
    result = _result(policies or [], labels or [], fleet, settings)
    answers = result.why_not(source, leak, *(categories or ()))
    text = as_text(document(answers)) if format is TextOrJson.json else "".join(f"{line}\n" for line in lines(answers))
    emit(text, output)


def _result(policies: list[str], labels: list[str], fleet: str | None, settings: Settings) -> Result:
    if fleet:
        from rosprivacy.fleets import run_fleet

        return run_fleet(fleet, settings)
    from rosprivacy.assembly import run

    return run(tuple(policies), tuple(labels), settings)
