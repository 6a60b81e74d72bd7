"""Every command that a page names is one of the program, with options that it has.

``test_docs_runs.py`` runs the lines that a reader can type, and has the table of how.
"""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers import reference
from tests.helpers.docs import hand_written
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *sorted(page for page in (ROOT / "docs").rglob("*.md") if not page.is_relative_to(reference.FOLDER)),
]
LINE = re.compile(r"^(?:\$ )?rosprivacy (.+)$", re.MULTILINE)
IN_TEXT = re.compile(r"`rosprivacy ([^`]+)`")


def command_lines(text: str) -> Iterator[list[str]]:
    """The words behind ``rosprivacy`` of each line of a block, and of each piece of code in the text."""
    for block in re.findall(r"```(?:console|bash|sh)?\n(.*?)```", text, re.DOTALL):
        yield from (shlex.split(line, comments=True) for line in LINE.findall(block.replace("\\\n", " ")))
    without = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    yield from (line.split() for line in IN_TEXT.findall(without))


def unknown(words: list[str]) -> list[str]:
    """The words of a line that are no command and no option of it."""
    command: Any = None
    inner = reference.command_group()
    while words and words[0] in inner:
        command, *words = inner[words[0]], *words[1:]
        inner = getattr(command, "commands", {})
    if command is None:
        return [] if words[0].startswith(("-", "…")) else words[:1]
    known = {"--help", *(name for one in command.params for name in (*one.opts, *one.secondary_opts))}
    options = [re.split(r"[=\[]", word)[0] for word in words if re.match(r"--?[a-z]", word)]
    return [option for option in options if option not in known]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.name))
def test_each_command_and_option_is_there(page: Path) -> None:
    wrong = {" ".join(words): unknown(words) for words in command_lines(hand_written(page.read_text("utf-8")))}
    assert {line: words for line, words in wrong.items() if words} == {}


def test_what_is_no_command_or_option_is_seen() -> None:
    assert unknown(["analize", "x"]) == ["analize"]
    assert unknown(["analyze", "x", "--lables", "l.yaml", "-l", "m.yaml"]) == ["--lables"]
    assert unknown(["db", "browser", "--no-open"]) == []
    assert list(command_lines("```console\n$ rosprivacy db stop  # why\n```\n`rosprivacy law`")) == [
        ["db", "stop"],
        ["law"],
    ]


def test_the_figures_of_speed_name_scripts_that_are_there() -> None:
    text = (ROOT / "docs" / "performance.md").read_text("utf-8")
    named = {name for line in re.findall(r"benchmarks/all\.py([a-z_ -]*)", text) for name in line.split()}
    scripts = {name for name in named if not name.startswith("-")}
    assert len(scripts) > 10
    assert all((ROOT / "benchmarks" / f"{name}.py").is_file() for name in scripts)
