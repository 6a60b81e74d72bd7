"""The report as text in German and French: no English but names, codes, and messages about files."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.formats import Style, written
from tests.helpers.graphs import care_home, factory
from tests.helpers.languages import OTHERS, english_in, names_in
from tests.helpers.languages import SYSTEMS as EVERY
from tests.helpers.paths import ROOT
from tests.helpers.turtlebot import COSTMAP, MEMORY, TURTLEBOT3

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.result import Result
    from tests.helpers.command import Cli

SYSTEMS: dict[str, Callable[[], Result]] = {
    **EVERY,
    **{f"run{number}": partial(factory, number) for number in (2, 4, 5)},
}
CODES = re.compile(
    r"no-leak-found|storage-limitation|-l rosprivacy:\S+|rosprivacy [\w-]+(?: --?[\w-]+)*|nodes: \{.*?\}\}\}?"
)
MESSAGE = re.compile(r"(Fehler|Warnung|Hinweis|erreur|avertissement|remarque) ?: \S+\.\w+:")  # about a file


def users_words(result: Result) -> list[str]:
    """Names and files, and notes in the words of who wrote the labels."""
    return [*names_in(result), *({row.statement.why for row in result.hangs_on or ()} - {""})]


def text_of(result: Result, language: str, *, verbose: bool = True) -> str:
    """The report without what stays English: messages about files, which begin with their severity."""
    lines = written(result, "text", Style(verbose=verbose, language=language))
    assert isinstance(lines, str)
    plain = lines.replace("\u00a0", " ").replace("\u202f", " ")
    kept = [line for line in plain.splitlines() if not MESSAGE.match(line)]
    return "\n".join(kept)


@pytest.mark.parametrize("language", OTHERS)
@pytest.mark.parametrize("system", SYSTEMS)
def test_no_line_is_english(language: str, system: str) -> None:
    result = SYSTEMS[system]()
    for verbose in (True, False):
        text = CODES.sub("…", text_of(result, language, verbose=verbose))
        assert english_in(text, language, users_words(result)) == []
        assert "\\xa0" not in text


@pytest.mark.parametrize("language", OTHERS)
def test_no_line_about_turtlebot3_is_english(language: str, corpus: Path, tmp_path: Path) -> None:
    (tmp_path / "tb3.labels.yaml").write_text(COSTMAP + MEMORY, "utf-8")
    result = rosprivacy.analyze([str(corpus / TURTLEBOT3)], [str(tmp_path / "tb3.labels.yaml")])
    text = CODES.sub("…", text_of(result, language))
    assert english_in(text, language, users_words(result)) == []


def test_every_language_has_as_many_lines() -> None:
    """Nothing is told in one language only."""
    for build in SYSTEMS.values():
        result = build()
        texts = {written(result, "text", Style(verbose=True, language=language)) for language in ("en", *OTHERS)}
        assert len({len(str(text).splitlines()) for text in texts}) == 1


def test_json_takes_no_language(cli: Cli) -> None:
    care = ROOT / "examples" / "care-home"
    done = cli(
        "analyze", care / "care-home.policy.xml", "-l", care / "care-home.labels.yaml", "--lang", "fr", "-f", "json"
    )
    assert (done.returncode, done.stdout) == (2, "")


def test_the_look_finds_english() -> None:
    """A test that cannot fail shows nothing."""
    for language in OTHERS:
        assert len(english_in(text_of(care_home(), "en"), language)) > 20
