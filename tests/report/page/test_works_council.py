"""One page for works councils: whose data can get where, how long kept, which measures; no more than the report."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from lxml import html as lxml_html

from rosprivacy.report.page.assessment import Answers
from rosprivacy.report.page.html import works_council
from tests.helpers.graphs import hospital
from tests.helpers.pages import LANGUAGES, told
from tests.helpers.reports import HOSTILE, care, hostile, with_outside

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_group_with_every_place_is_there_as_in_the_report(language: str) -> None:
    for document in (care(), with_outside(care()), dict(hospital().document())):
        report = told(document, language)
        text = lxml_html.document_fromstring(works_council(report)).text_content()
        for group in report.persons.rights:
            assert group.name in text
            for place in group.places:
                cells = (place.name, place.data, place.retention, place.recipient, *place.measures)
                assert all(cell in text for cell in cells)


def test_it_says_what_is_open_and_what_was_decided() -> None:
    report = told(care(), answers=Answers({"sign.measures": "the archive goes"}))
    text = lxml_html.document_fromstring(works_council(report)).text_content()
    assert "3 points have still to be decided." in text
    assert "the archive goes" in text
    assert "This report is no legal verdict" in text


def test_it_has_no_script_and_no_name_becomes_html(tmp_path: Path) -> None:
    report = told(hostile(tmp_path), title=HOSTILE[0])
    root = lxml_html.document_fromstring(works_council(report))
    assert not list(root.iter("script", "img", "a", "textarea"))
    assert not [name for node in root.iter() for name in node.attrib if name.startswith("on")]
