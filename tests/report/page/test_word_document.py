"""The Word document says what the Markdown says, all of it, whatever the names are."""

from __future__ import annotations

import re
from io import BytesIO
from typing import TYPE_CHECKING
from zipfile import ZipFile

import docx
import pytest
from docx.oxml.ns import qn
from hypothesis import given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.report.page.markdown import escaped
from rosprivacy.report.page.word_document import word_document
from tests.helpers.daily import one_in
from tests.helpers.paths import ROOT
from tests.helpers.word import text_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

CARE = ROOT / "examples" / "care-home"
POLICY, LABELS = CARE / "care-home.policy.xml", CARE / "care-home.labels.yaml"
FLEET = ROOT / "examples" / "fleet" / "fleet.yaml"


@pytest.fixture(scope="module")
def care() -> rosprivacy.Result:
    return rosprivacy.analyze(POLICY, LABELS)


def words(text: str) -> list[str]:
    return re.findall(r"\w+", text)


@pytest.mark.slow
@pytest.mark.parametrize("language", one_in(3, ["de", "en", "fr"]))
def test_every_word_of_the_markdown_stands_in_it(care: rosprivacy.Result, language: str) -> None:
    for result in (care, rosprivacy.analyze_fleet(FLEET)):
        told = result.to("markdown", language=language)
        plain = re.sub(r"&lt;|&gt;|&amp;", " ", told.replace("\\_", "_").replace("**", ""))  # signs, in Word
        numbered = re.sub(r"\d+\\?\. ", "", plain)  # every item of a list is written as 1
        written = re.sub(r"\d+\. ", "", text_of(result.to("docx", language=language)))
        assert words(written) == words(numbered)


@given(st.text(st.characters(codec="utf-8"), min_size=1, max_size=60))
@settings(max_examples=2 * settings().max_examples)
def test_any_name_stays_text(name: str) -> None:
    """A name can be no heading, no link and no control sign of the file."""
    named = name.replace("\0", "\ufffd")  # CommonMark, section 2.3
    shown = "".join(sign if sign.isprintable() else " " for sign in named)
    written = word_document(f"# A\n\nx{escaped(name)}x\n", "A", "en", "2026-01-01")
    assert "".join(text_of(written).split()) == "Ax" + "".join(shown.split()) + "x"


def test_a_block_that_is_not_known_is_never_left_out() -> None:
    with pytest.raises(NotImplementedError, match="blockquote"):
        word_document("> a warning\n", "A", "en", "2026-01-01")


@pytest.mark.slow
def test_the_same_input_gives_the_same_bytes(care: rosprivacy.Result, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1767225600")
    package = care.to("docx", title="Haus Sonnenhof", language="de")
    assert package == care.to("docx", title="Haus Sonnenhof", language="de")
    known = docx.Document(BytesIO(package)).core_properties
    assert (known.title, known.author, known.language) == ("Haus Sonnenhof", "rosprivacy", "de")
    assert known.created is not None
    assert known.created.date().isoformat() == "2026-01-01"
    with ZipFile(BytesIO(package)) as parts:
        assert 'w:lang w:val="de-DE"' in parts.read("word/styles.xml").decode()


@pytest.mark.slow
def test_each_page_says_of_what_and_which_of_how_many_it_is(care: rosprivacy.Result) -> None:
    written = docx.Document(BytesIO(care.to("docx", title="The home")))
    (section,) = written.sections
    footer = section.footer._element
    assert "The home" in section.footer.paragraphs[0].text
    assert [field.get(qn("w:instr")) for field in footer.iter(qn("w:fldSimple"))] == ["PAGE", "NUMPAGES"]


def test_headings_are_words_own_and_tables_repeat_their_head(care: rosprivacy.Result) -> None:
    document = docx.Document(BytesIO(care.to("docx")))
    headings = [p.text for p in document.paragraphs if p.style and p.style.name == "Heading 2"]
    titles = re.findall(r"(?m)^## (.*)$", care.to("markdown").replace("\\", ""))
    assert headings == titles
    assert document.tables
    assert all("w:tblHeader" in table.rows[0]._tr.xml for table in document.tables)


def test_the_command_writes_it(
    cli: Cli, care: rosprivacy.Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    output = tmp_path / "report.docx"
    assert cli("report", POLICY, "-l", LABELS, "-f", "docx", "-o", output).returncode == 0
    assert output.read_bytes() == care.to("docx")
