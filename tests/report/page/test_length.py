"""How long a report is: what a reader has to read is short, and what it rests on stands once, in an appendix."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING, Any

import pytest
from markdown_it import MarkdownIt

from rosprivacy.report.catalogs.words import plain, table
from rosprivacy.report.finding_facts import looked_at
from rosprivacy.report.naming import line, text
from rosprivacy.report.page.kinds import SIGNS
from rosprivacy.report.page.markdown import markdown
from tests.helpers.abroad import abroad, abroad_answer
from tests.helpers.graphs import hospital
from tests.helpers.pages import LANGUAGES, page, told
from tests.helpers.reports import care, office, run

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

MOST = 3_000  # words of the body, and of the appendix
LONG = 12  # words
WRITTEN = {"office": office, "abroad": abroad}


@pytest.fixture(params=["care", "fleet", "office", "abroad", "factory"])
def system(request: pytest.FixtureRequest, tmp_path: Path) -> dict[str, Any]:
    if request.param in WRITTEN:
        return WRITTEN[request.param](tmp_path)
    if request.param == "fleet":
        return dict(hospital().document())
    return care() if request.param == "care" else run(3)


def words(written: str) -> int:
    """How many words there are; bars and dashes of tables are none."""
    return sum(any(c.isalnum() for c in word) for word in written.split())


@pytest.mark.parametrize("language", LANGUAGES)
def test_body_and_appendix_are_short(system: dict[str, Any], language: str) -> None:
    body, _, appendix = markdown(told(system, language)).partition("\n# ")
    assert words(body) <= MOST
    assert words(appendix) <= MOST


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_closes_the_paths_fits_into_the_body(tmp_path: Path, language: str) -> None:
    written = str(abroad_answer(tmp_path).to("markdown", language=language))
    assert table(language)["heading.closing"] in written
    assert words(written.partition("\n# ")[0]) <= MOST


def test_every_id_policy_line_and_provision_is_there(system: dict[str, Any]) -> None:
    report = told(system)
    written = re.sub(r"\\(.)", r"\1", markdown(report))
    shown = {entry.id for entry in report.entries}
    findings = [finding for finding in system["findings"] if finding["id"] in shown]
    assert shown
    assert [finding["id"] for finding in findings if finding["id"] not in written] == []
    steps = [step for finding in findings for step in finding["steps"]]
    assert {line(grant) for step in steps for grant in step["policy"][:4] if line(grant) not in written} == set()
    stated = [row for kind in system["categories"] for row in (*kind["law"], *kind.get("in_context", ()))]
    provisions: list[Mapping[str, Any]] = [*stated, *looked_at(system)]
    assert {part for row in provisions for part in texts_of(row) if part not in written} == set()


NARROWER = "if the data are of a narrower kind"  # said in other words


def texts_of(row: Mapping[str, Any]) -> list[str]:
    """What a provision is called, what it is about, and when it applies to data."""
    of_data = "condition" in row and not row["condition"].startswith(NARROWER)
    fields = ("provision", *(["title"] if "title" in row else []), *(["condition"] if of_data else []))
    return [text(row, field, "en") for field in fields]


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_a_provision_is_about_stands_once(system: dict[str, Any], language: str) -> None:
    """Kinds of data, contexts and every system may point at it; the page has its whole meaning, once, too."""
    written = plain(re.sub(r"\\(.)", r"\1", markdown(told(system, language)))).replace("*", "")
    shown = plain(page(system, language).text_content())
    for row in looked_at(system):
        name, title, meaning = (plain(text(row, field, language)) for field in ("provision", "title", "meaning"))
        if title not in name:
            assert len(re.findall(rf"{re.escape(name)}[{SIGNS}]?\s?: {re.escape(title)}", written)) == 1
        assert shown.count(meaning) == 1


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_sentence_stands_once(system: dict[str, Any], language: str) -> None:
    """Names, lines of policies and tables come again where a path or a place does."""
    written = re.sub(r"\*\*.*?\*\*", "", markdown(told(system, language)))
    prose = [line for line in written.split("\n") if "`" not in line and line[:1] != "|"]
    sentences = [sentence for line in prose for sentence in re.split(r"(?<=[.?!;:]) ", line)]
    again = Counter(sentence for sentence in sentences if words(sentence) >= LONG)
    assert [sentence for sentence, times in again.items() if times > 1] == []


def test_what_a_context_brings_stands_once(system: dict[str, Any]) -> None:
    """Each path says its context, not why; of what only concerns the data there, none says it."""
    for language in LANGUAGES:
        written = plain(re.sub(r"\\(.)", r"\1", markdown(told(system, language))))
        rows = [row for kind in system["categories"] for row in kind.get("in_context", ())]
        for row in rows:
            assert written.count(plain(text(row, "condition", language))) == 1
        body = written.partition("\n# ")[0]
        concerning = {text(row, "provision", language) for row in rows if row["verdict"] == "concerns"}
        revealed = {text(row, "provision", language) for row in rows if row["verdict"] != "concerns"}
        assert not [name for name in concerning - revealed if name in body.partition("## 3")[2].partition("## 4")[0]]


def test_what_data_may_reveal_is_named(system: dict[str, Any]) -> None:
    """Not: it."""
    assert not re.search(r"\breveal (it|them|this)\b", markdown(told(system)))


def test_every_table_is_one(system: dict[str, Any]) -> None:
    blocks = MarkdownIt("commonmark").enable("table").parse(markdown(told(system)))
    assert [block.content for block in blocks if block.type == "inline" and block.content.startswith("|")] == []


def test_two_findings_along_one_path_tell_it_once() -> None:
    report = told(dict(hospital().document()))
    again = [entry for entry in report.entries if entry.same_way]
    assert again
    by_number = {entry.number: entry for entry in report.entries}
    for entry in again:
        assert entry.same_way
        first = by_number[entry.same_way[0]]
        assert (first.hops, first.same_way, first.anchor) == (entry.hops, None, entry.same_way[1])
