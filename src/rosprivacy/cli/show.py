"""``rosprivacy show``: one finding, or a few, hop by hop."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.written_names import did_you_mean, nearest
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.cli.options import Language, Output, TextOrJson
from rosprivacy.cli.output import emit, on_console
from rosprivacy.terminal_width import terminal_width

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

SHORTEST = 4  # digits of an id


@reads_system()
def show(
    finding: Annotated[str, typer.Argument(metavar="ID", help="Of a finding or a pattern, or how it begins.")],
    inputs: Inputs,
    format: Annotated[TextOrJson, typer.Option("--format", "-f", help="Of the answer.")] = TextOrJson.text,  # noqa: A002 - the option's name
    output: Output = None,
    lang: Annotated[Language, typer.Option(help="Language of the text.")] = Language.en,
) -> None:
    """Show one finding hop by hop: which policy line allows each step, and what the law says of such data."""
    from rich.text import Text

    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.json_text import as_text
    from rosprivacy.report.text.finding_lines import details
    from rosprivacy.report.text.law_lines import law_lines
    from rosprivacy.report.text.line_parts import wrapped

    report = inputs.result(inputs.settings).document()
    chosen = _chosen(report, finding)
    if format is TextOrJson.json:
        emit(as_text(chosen), output)
        return
    words = Words(lang.value)
    lines = [*details(report, chosen, words), *law_lines(report, chosen, words)]
    width = None if output else terminal_width()

    def write(console: Any) -> None:
        for text, style in wrapped(lines, width):
            console.print(Text(text, style), soft_wrap=True)

    emit(on_console(write, colour=output is None), output)


def _chosen(report: Mapping[str, Any], written: str) -> Sequence[Mapping[str, Any]]:
    findings = {finding["id"]: finding for finding in report["findings"]}
    patterns = report.get("fleet", {}).get("patterns", ())
    known = findings | {pattern["id"]: findings[pattern["finding"]] for pattern in patterns}
    fitting = [one for one in known if one.startswith(written)] if len(written) >= SHORTEST else []
    if fitting:
        return list({known[one]["id"]: known[one] for one in fitting}.values())
    hint = did_you_mean(nearest(written, known), f"such as {next(iter(known))}" if known else "there is no finding")
    raise InputErrors([InputError("ID", 0, f"{shown(written)!r} is not the id of a finding, nor how one begins", hint)])
