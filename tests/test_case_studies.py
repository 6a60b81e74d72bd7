"""The case studies can be repeated: commands are run and lines typed in order, and what it counts is right."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from tests.helpers.console import check, commands
from tests.helpers.daily import one_in
from tests.helpers.typist import FILE, POLICIES, STUDIES, Typist

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli


@pytest.mark.corpus
@pytest.mark.slow
@pytest.mark.parametrize("name", one_in(len(STUDIES), STUDIES))
def test_a_reader_gets_from_nothing_to_the_report(name: str, cli: Cli, corpus: Path, tmp_path: Path) -> None:
    typist = Typist(tmp_path / FILE)
    runs, rounds = 0, 0
    for language, block in re.findall(r"```(yaml|console)\n(.*?)```", STUDIES[name], re.DOTALL):
        if language == "yaml":
            typist.types(block)
            continue
        for command, lines, code in commands(block):
            before = typist.file.read_text("utf-8") if typist.file.exists() else ""
            for variable, policy in POLICIES.items():
                command = command.replace(variable, str(corpus / policy))  # noqa: PLW2901 - as a shell does
            check(cli, command, lines, code, tmp_path)
            runs += 1
            rounds += "--next" in command and typist.file.read_text("utf-8") != before
    told = [f"{runs} commands", f"{rounds} rounds", *(f"{n} {what}" for what, n in typist.counts.items() if n)]
    assert f"In all: {', '.join(told)}." in STUDIES[name], told
    assert (tmp_path / "report.html").stat().st_size > 10_000


def test_both_studies_are_there() -> None:
    assert list(STUDIES) == ["RMF office", "TurtleBot3"]


def test_a_name_is_filled_in_changed_or_typed(tmp_path: Path) -> None:
    file = tmp_path / FILE
    file.write_text("labels: 1\nnodes:\n  /a: # why\n  /b: conduit\ntopics:\n  /a:\n")
    typist = Typist(file)
    typist.types("nodes:\n  /a: conduit\n  /b: {leak: [Video]}\n  /c: conduit\nservices:\n  /s: mundane\n")
    assert file.read_text() == (
        "labels: 1\nnodes:\n  /a: conduit\n  /b: {leak: [Video]}\n  /c: conduit\ntopics:\n  /a:\n"
        "services:\n  /s: mundane\n"
    )
    assert typist.counts == {"lines typed": 3, "empty lines filled in": 1, "lines changed": 1}
