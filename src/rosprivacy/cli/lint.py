"""``rosprivacy lint``: what is wrong with how policies are written."""

from __future__ import annotations

from typing import Annotated

import typer

from rosprivacy.analysis.model import Severity
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.exit_code import LEAK
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Output
from rosprivacy.cli.output import emit


class LintFormat(StrEnum):
    """For people, for programs, or for code scanning."""

    text = "text"
    json = "json"
    sarif = "sarif"


@reads_system(
    "policies, and label files",
    without=(
        "fleet", "from_database", "neo4j", "add", "types", "type_limits", "categories", "view",
        "decisions",
    ),
)  # fmt: skip
def lint(
    inputs: Inputs,
    select: Annotated[
        list[str] | None,
        typer.Option(metavar="RULE", help="Look at this rule only; may be repeated.", show_default=False),
    ] = None,
    ignore: Annotated[
        list[str] | None,
        typer.Option(metavar="RULE", help="Do not look at this rule; may be repeated.", show_default=False),
    ] = None,
    format: Annotated[LintFormat, typer.Option("--format", "-f", help="Of the answer.")] = LintFormat.text,  # noqa: A002 - the option's name
    output: Output = None,
) -> None:
    """Look for what is wrong with how policies are written: lines that grant nothing, or more than somebody meant.

    Ends with 1 if a rule is broken that is no mere notice. With labels it also tells of enclaves that mix sources and
    leaks.
    """
    from rosprivacy.linting import lint_policies
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.lint import lint_document, lint_lines
    from rosprivacy.version import __version__

    found = lint_policies(
        inputs.required_policies, tuple(map(str, inputs.labels or ())), inputs.settings, select or (), ignore or ()
    )
    if format is LintFormat.sarif:
        from rosprivacy.report.lint import lint_sarif
        from rosprivacy.report.sarif.locations import repository_root

        root = repository_root(file for file, _ in found.files)
        emit(as_text(lint_sarif(found.breaches, found.rules, found.files, __version__, root)), output)
    else:
        document = lint_document(found.breaches, found.files, found.unseen, __version__)
        lines = "".join(f"{line}\n" for line in lint_lines(document))
        emit(as_text(document) if format is LintFormat.json else lines, output)
    if any(breach.rule.severity is not Severity.NOTICE for breach in found.breaches):
        raise typer.Exit(LEAK)
