"""``rosprivacy report``: what was found, for the people who assess it: a page, Word, the record of Article 30."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from rosprivacy.analysis.errors import shown
from rosprivacy.cli.answer_command import Asked, Computed, Written, answer
from rosprivacy.cli.exit_code import FailOn
from rosprivacy.cli.inputs import Inputs, reads_system
from rosprivacy.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path


@reads_system()
def report(inputs: Inputs, question: Asked, computed: Computed, written: Written) -> None:
    """Write a report for people: a page that needs no network, a text, a Word document, or rows for the record.

    It ends with 0 when the report is written, whatever that says, unless --fail-on is given.
    """
    answer(inputs, question, computed, written, written.format or _by_ending(written.output), FailOn.never)


def _by_ending(output: Path | None) -> str:
    """The report that a file's name asks for; of those that end alike the first."""
    ending = output.suffix.lower() if output else ""
    reports = [known for known in FORMATS.values() if "title" in known.styles or known.suffix == ".csv"]
    endings = {known.suffix: known.name for known in reversed(reports)} | {"": "html"}
    if ending not in endings:
        listed = ", ".join(sorted(filter(None, endings)))
        raise typer.BadParameter(f"no report ends in {shown(ending)}; write one of {listed}, or --format")
    return endings[ending]
