"""The summary for works councils: whose data can get where, how long kept, which measures; no more than the report."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Any

import pytest
from lxml import html as lxml_html

from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.page.assessment import Answers
from rosprivacy.report.page.works_council import works_council
from tests.helpers import browser as chrome
from tests.helpers.graphs import analysed, hospital
from tests.helpers.pages import LANGUAGES, told
from tests.helpers.reports import HOSTILE, care, hostile, with_outside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

STATION = ("tests/cases/station-abroad/station.policy.xml", "tests/cases/station-abroad/station.labels.yaml")


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


def station() -> dict[str, Any]:
    return dict(analysed(*STATION).document())


def fleet() -> dict[str, Any]:
    return dict(hospital().document())


SYSTEMS: dict[str, Callable[[], dict[str, Any]]] = {"station": station, "care": care, "fleet": fleet}


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_place_stands_once_with_who_operates_it(language: str) -> None:
    report = told(station(), language)
    root = lxml_html.document_fromstring(works_council(report))
    places = {(place.name, place.kind, place.recipient) for group in report.persons.rights for place in group.places}
    headings = [plain(heading.text_content()) for heading in root.xpath("//tbody/tr/th[@scope='rowgroup']")]
    assert len(headings) == len(places)
    assert all(any(plain(recipient) in heading for heading in headings) for _, _, recipient in places)


@pytest.mark.parametrize("language", LANGUAGES)
def test_dates_of_provisions_are_all_there_and_what_is_not_confirmed_is_marked(language: str) -> None:
    report = told(station(), language)
    text = plain(lxml_html.document_fromstring(works_council(report)).text_content())
    for law in report.further.at_work:
        of_law = text.partition(plain(law.meaning))[2].partition("\n")[0][:80]
        assert plain(law.applies) in of_law
        read = text.partition(plain(report.words("works_council.reviewed", date="")))[2]
        assert plain(law.reviewed) in read
        assert read.startswith(plain(law.reviewed)) or plain(law.name) in read.partition("*")[0]
        assert ("*" in of_law.partition(")")[0]) == bool(law.unconfirmed)
        assert plain(law.unconfirmed) in text


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebDriver]:
    with chrome.chromium(tmp_path_factory.mktemp("profile")) as found:
        yield found


def printed(browser: WebDriver, page: str, file: Path) -> list[str]:
    """The text of each page on paper, without spaces."""
    from pypdf import PdfReader

    file.write_text(page, "utf-8")
    chrome.open_page(browser, file.as_uri())
    reader = PdfReader(BytesIO(chrome.pdf(browser)))
    sizes = {(round(p.mediabox.width / 72, 1), round(p.mediabox.height / 72, 1)) for p in reader.pages}
    assert sizes == {(round(chrome.A4[0], 1), round(chrome.A4[1], 1))}
    return ["".join(page.extract_text().split()) for page in reader.pages]


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", SYSTEMS)
def test_it_is_one_page_on_a4(browser: WebDriver, name: str, language: str, tmp_path: Path) -> None:
    report = told(SYSTEMS[name](), language, title=f"The robots of the {name}", date="2026-11-28")
    (page,) = printed(browser, works_council(report), tmp_path / "summary.html")
    assert "".join(report.words("not.legal").split()) in page  # its last words


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("language", LANGUAGES)
def test_of_many_places_the_first_page_has_what_matters(browser: WebDriver, language: str, tmp_path: Path) -> None:
    document = station()
    for number in range(60):
        rows = [row for row in document["register"] if row["places"]]
        place = {**rows[0]["places"][0], "name": f"disk {number}"}
        document["register"] = [*document["register"], {**rows[0], "id": f"{number:016x}", "places": [place]}]
    page = works_council(told(document, language))
    first, *others = printed(browser, page, tmp_path / "summary.html")
    words = Words(language)
    assert others
    for heading in ("works_council.recognised", "works_council.open", "works_council.where"):
        assert "".join(words(heading).split()) in first
    assert "/mood_reader" in first
    assert not [name for name in ("one page", "eine Seite", "une page") if name in page.casefold()]
