"""A row is decided in a real Chromium: on the page and in a review, in each language, for a screen reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.report.catalogs.words import Words
from tests.helpers import browser as chrome
from tests.helpers import explorers
from tests.helpers.browser import WIDTHS
from tests.helpers.page_reader import Reader, served
from tests.helpers.rows import ANSWERS, at, written

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow]
LANGUAGES = ("en", "de", "fr")
TOO_WIDE = "h1, h2, h3, p, li, dd, fieldset, button, label"


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    return written(tmp_path)


def fill(browser: WebDriver, fields: dict[str, str]) -> None:
    for name, text in fields.items():
        browser.find_element("css selector", f"#decide [name='{name}']").send_keys(text)


def push(browser: WebDriver, selector: str) -> None:
    """Click, and wait for the page that follows."""
    from selenium.webdriver.support.expected_conditions import staleness_of
    from selenium.webdriver.support.ui import WebDriverWait

    before = browser.find_element("css selector", "html")
    browser.find_element("css selector", selector).click()
    WebDriverWait(browser, 20, 0.02).until(staleness_of(before))


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_data_protection_officer_decides_a_row_in_a_review(
    browser: WebDriver, files: tuple[Path, Path], tmp_path: Path, language: str
) -> None:
    words, log = Words(language), tmp_path / "d.jsonl"
    with explorers.served(*files, review=True, language=language, decisions=log) as explorer:
        finding, other = at(explorer, "cabin")
        chrome.open_page(browser, explorer.door.link)
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?step=decide&finding={finding}")
        fill(browser, {"reason": "agreed", "owner": "A. Lee"})
        push(browser, "#decide button[value=accept]")
        (message,) = chrome.console(browser)  # Chromium tells of every 409
        assert "409" in message["message"]
        told = browser.find_element("css selector", ".message.problem").text
        assert words("confirm.occasional") in told
        assert not log.exists()
        browser.find_element("css selector", "[name=ground][value='6(1)(f)']").click()
        fill(browser, ANSWERS)
        push(browser, "#decide button[value=accept]")
        if browser.find_elements("css selector", "#decide"):  # what is missing now is less
            push(browser, "#decide button[value=accept]")
        assert browser.current_url.endswith("?step=summary")
        assert {one.id for one in explorer.session.findings if one.accepted} == {finding, other}
        browser.get("about:blank")


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("width", WIDTHS)
def test_the_row_of_a_finding_fits_and_axe_finds_nothing(
    browser: WebDriver, files: tuple[Path, Path], tmp_path: Path, width: int, language: str
) -> None:
    with served(browser, *files, language=language, decisions=tmp_path / "d.jsonl") as explorer:
        reader = Reader(browser, explorer, width)
        reader.press("o")
        assert reader.faults() == []
        assert chrome.wider(browser, "fieldset, .about label, .rows-of dd") == []
        reader.pane("element")
        reader.focus("#decide [name=reason]")
        chrome.screenshot(browser, tmp_path / f"row-{language}-{width}.png", width)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("width", WIDTHS)
def test_the_row_in_a_review_fits_and_axe_finds_nothing(
    browser: WebDriver, files: tuple[Path, Path], tmp_path: Path, width: int, language: str
) -> None:
    log = tmp_path / "d.jsonl"
    with explorers.served(*files, review=True, language=language, decisions=log) as explorer:
        chrome.open_page(browser, explorer.door.link, width=width)
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?step=decide&finding={at(explorer, 'archive')[0]}")
        for dark in (True, False):
            chrome.shade(browser, dark=dark)
            assert chrome.axe(browser) == []
        assert chrome.wider(browser, TOO_WIDE) == []
        assert browser.execute_script("return document.documentElement.scrollWidth") <= width
        chrome.screenshot(browser, tmp_path / f"review-{language}-{width}.png", width)
        browser.get("about:blank")
