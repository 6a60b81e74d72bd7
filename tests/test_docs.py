"""The documentation says what is true: its commands run, its label files are read, its option tables are the code's.

``python -m tests.test_docs`` writes ``docs/command-line.md`` anew.
"""

from __future__ import annotations

import re
import subprocess
import sys
from enum import StrEnum
from pathlib import Path
from typing import Any

import pytest
import typer

from rosprivacy.cli import app
from rosprivacy.ingest.labels import read_labels
from rosprivacy.ontology.vocabulary import load

ROOT = Path(__file__).resolve().parent.parent
COMMAND_LINE = ROOT / "docs" / "command-line.md"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]

HEAD = """\
# The command line

Written by `python -m tests.test_docs` from the program; do not edit.

Exit codes: 0 no leak found, 1 leak, 2 bad input or usage, 3 database unreachable, 4 undetermined (only with
`--fail-on undetermined`). Shell completion: `rosprivacy --install-completion`.
"""


def command_line() -> str:
    """The options of every command, as the program knows them."""
    group: Any = typer.main.get_command(app)
    text = HEAD
    for name, command in sorted(group.commands.items()):
        text += f"\n## rosprivacy {name}\n\n{command.help}\n\n| option | default | meaning |\n| --- | --- | --- |\n"
        for parameter in command.params:
            names = ", ".join(f"`{option}`" for option in parameter.opts + parameter.secondary_opts)
            shown = f"`{parameter.metavar}`" if parameter.param_type_name == "argument" else names
            default = parameter.default
            if isinstance(default, bool) or default in (None, ()):
                default = ""
            values = f" One of {', '.join(type(default))}." if isinstance(default, StrEnum) else ""
            text += f"| {shown} | {default} | {getattr(parameter, 'help', '') or ''}{values} |\n"
    return text


def test_the_option_tables_are_those_of_the_program() -> None:
    assert COMMAND_LINE.read_text("utf-8") == command_line()


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text("utf-8"), re.DOTALL)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.name))
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text("utf-8")):
        assert target.startswith("http") or (page.parent / target).exists(), target


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "docs" / "labels.md"], ids=lambda page: str(page.name))
def test_the_label_files_that_are_shown_are_read(page: Path, tmp_path: Path) -> None:
    found = [block for block in blocks(page, "yaml") if block.startswith("labels:")]
    assert found
    for block in found:
        file = tmp_path / "labels.yaml"
        file.write_text(block)
        assert read_labels(str(file), load()).entries


def test_the_readmes_first_finding_is_what_is_printed() -> None:
    (command,) = [line for line in blocks(ROOT / "README.md", "console")[1].splitlines() if line]
    done = subprocess.run(
        [sys.executable, "-m", *command.split()], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    (shown,) = [block for block in blocks(ROOT / "README.md", "text") if block.startswith("leak:")]
    for line in shown.splitlines():
        assert line == "…" or line in done.stdout.splitlines(), line


def test_the_categories_that_are_named_are_those_of_the_ontology() -> None:
    text = (ROOT / "docs" / "labels.md").read_text("utf-8")
    listed = re.search(r"Names come from the ontology \((.*?)\)", text)
    assert listed
    assert set(re.findall(r"`(\w+)`", listed[1])) == set(load().categories)


def test_no_registry_is_named() -> None:
    """Mirrors are the user's own configuration."""
    for page in PAGES:
        assert not re.search(r"pypi\.org|pythonhosted|repo1?\.maven|registry\.npmjs", page.read_text("utf-8"))


if __name__ == "__main__":
    COMMAND_LINE.write_text(command_line(), "utf-8")
