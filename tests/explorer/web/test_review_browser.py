"""A review in a real Chromium: by keys alone to the report, on a phone, for a screen reader."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import pytest

from tests.helpers import browser as chrome
from tests.helpers import explorers
from tests.helpers.browser import WIDTHS
from tests.helpers.explorers import BARE, FACTORY, copied
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow]
SECONDS = 90
MOST = 40  # questions of the factory
ROLE = "return document.activeElement.name === 'role' ? document.activeElement.value : ''"
AT = "return document.activeElement.name || document.activeElement.tagName"
HEADING = "return document.querySelector('h1').textContent"


def press(browser: WebDriver, *keys: str) -> None:
    from selenium.webdriver import ActionChains

    for key in keys:
        ActionChains(browser).send_keys(key).perform()


def shown(browser: WebDriver, before: Any) -> None:
    """Wait for the page after this one."""
    from selenium.webdriver.support.expected_conditions import staleness_of
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(browser, SECONDS, 0.02).until(staleness_of(before))
    ready = "return document.readyState === 'complete'"
    WebDriverWait(browser, SECONDS, 0.02).until(lambda b: b.execute_script(ready))


def tab_to(browser: WebDriver, name: str) -> None:
    from selenium.webdriver.common.keys import Keys

    for _ in range(40):
        press(browser, Keys.TAB)
        if browser.execute_script(AT) == name:
            return
    raise AssertionError(f"no key leads to {name}")


def answer(browser: WebDriver, role: str) -> None:
    """Choose an answer with the arrows, write the reason, and the name where it is asked for; Enter."""
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait

    before = browser.find_element(By.TAG_NAME, "html")
    # What a screen reader begins with; the browser moves the focus there when it draws the page.
    WebDriverWait(browser, SECONDS, 0.02).until(lambda b: b.execute_script(AT) == "H1")
    tab_to(browser, "role")
    press(browser, Keys.SPACE)
    for _ in range(12):
        if browser.execute_script(ROLE) == role:
            break
        press(browser, Keys.ARROW_DOWN)
    assert browser.execute_script(ROLE) == role
    tab_to(browser, "note")
    press(browser, *"seen")
    if browser.execute_script("return !document.querySelector('[name=by]').value"):
        tab_to(browser, "by")
        press(browser, *"A. Lee")
    press(browser, Keys.ENTER)
    shown(browser, before)


def test_the_factory_by_keys_alone_to_the_report(browser: WebDriver, tmp_path: Path) -> None:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait

    told = {"behavior": "allow", "downloadPath": str(tmp_path)}
    browser.execute_cdp_cmd("Browser.setDownloadBehavior", told)
    with explorers.served(BARE, tmp_path / "new.labels.yaml", review=True) as explorer:
        chrome.open_page(browser, explorer.door.link)
        seen = []
        while browser.find_elements(By.NAME, "role"):
            seen.append(browser.execute_script(HEADING))
            assert len(seen) < MOST
            roles = browser.execute_script("return [...document.querySelectorAll('[name=role]')].map((e) => e.value)")
            leaks = "/archive_server" in seen[-1] and "leak" in roles
            wanted = ["leak"] if leaks else ["conduit", "sensitive", "source"]
            answer(browser, next(role for role in wanted if role in roles))
        assert "/archive_server" in " ".join(seen)
        assert "Personal data can reach" in browser.find_element(By.TAG_NAME, "main").text
        tab_to(browser, "A")
        link = "return document.activeElement.getAttribute('href')"
        while browser.execute_script(link) != "/report":
            press(browser, Keys.TAB)
        press(browser, Keys.ENTER)
        report = tmp_path / "privacy-report.html"
        WebDriverWait(browser, SECONDS * 3, 0.1).until(lambda _: report.is_file() and report.stat().st_size)
        before = browser.find_element(By.TAG_NAME, "html")
        browser.execute_script("document.querySelector('h1').focus()")
        browser.execute_script("document.querySelector(\"[action^='/save'] button\").focus()")
        press(browser, Keys.ENTER)
        shown(browser, before)
        assert "All answers are saved." in browser.find_element(By.TAG_NAME, "main").text
        assert "A. Lee" in explorer.labels.read_text("utf-8")
        asked = {urlsplit(address).netloc.partition(":")[0] for address in chrome.requests(browser)}
        assert asked <= {"127.0.0.1", ""}
        assert chrome.console(browser) == []
        chrome.open_page(browser, report.as_uri())
        assert "/archive_server" in browser.find_element(By.TAG_NAME, "body").text


@pytest.mark.parametrize("language", ["en", "de", "fr"])
@pytest.mark.parametrize("width", WIDTHS)
def test_question_and_summary_fit_and_axe_finds_nothing(
    browser: WebDriver, tmp_path: Path, width: int, language: str
) -> None:
    labels = copied(FACTORY / "run2.labels.yaml", tmp_path)
    with explorers.served(BARE, labels, review=True, language=language) as explorer:
        chrome.open_page(browser, explorer.door.link, width=width)
        origin = f"http://127.0.0.1:{explorer.door.port}"
        asked = f"/?at={explorers.node('/navigator')}", f"/?at={explorers.node('/robot_camera')}"
        for address in ("/", *asked, "/?step=source", "/?step=summary"):
            browser.get(origin + address)
            browser.execute_script("document.querySelectorAll('details').forEach((d) => d.open = true)")
            assert chrome.axe(browser) == []
            assert browser.execute_script("return document.documentElement.scrollWidth") <= width
            assert chrome.wider(browser, "h1, h2, p, li, fieldset, button, .pick, .field") == []
            name = address.strip("/?").partition("=")[2] or "question"
            chrome.screenshot(browser, tmp_path / f"{name}-{language}-{width}.png", width)
        browser.get("about:blank")


@pytest.mark.parametrize("width", WIDTHS)
def test_axe_finds_nothing_in_what_a_review_tells(browser: WebDriver, tmp_path: Path, width: int) -> None:
    """Nothing asked yet, an answer, answers of an earlier session, and a file that somebody else changed."""
    labels = tmp_path / "new.labels.yaml"
    with explorers.served(BARE, labels, review=True, journal=tmp_path / "journal") as explorer:
        chrome.open_page(browser, explorer.door.link, width=width)
        assert _faults(browser, width) == []
        answer(browser, "source")
        assert browser.execute_script("return document.querySelector('.message') !== null")
        assert _faults(browser, width) == []
        explorer.session.close()
    with explorers.served(BARE, labels, review=True, journal=tmp_path / "journal") as explorer:
        chrome.open_page(browser, explorer.door.link, width=width)
        assert browser.execute_script("return document.querySelector('[action=\"/resume\"]') !== null")
        assert _faults(browser, width) == []
        labels.write_text("labels: 1\nchannels:\n  /new_pose: mundane\n", "utf-8")
        browser.refresh()
        assert browser.execute_script("return document.querySelector('pre') !== null")
        assert _faults(browser, width) == []
        browser.get("about:blank")


def _faults(browser: WebDriver, width: int) -> list[object]:
    """What axe finds, light and dark, and what is too wide."""
    found: list[object] = []
    for dark in (True, False):
        chrome.shade(browser, dark=dark)
        found += chrome.axe(browser)
    found += chrome.wider(browser, "h1, h2, p, li, fieldset, button, .pick, .field")
    sideways = browser.execute_script("return document.documentElement.scrollWidth")
    return [*found, *([f"it is {sideways} wide"] if sideways > width else [])]


@pytest.mark.parametrize("width", WIDTHS)
def test_a_fleet_is_reviewed_by_keys_and_said_of_one_robot_or_of_its_model(
    browser: WebDriver, tmp_path: Path, width: int
) -> None:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys

    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    fleet, model, own = (
        tmp_path / "fleet" / name for name in ("fleet.yaml", "carrier.labels.yaml", "carrier_lent.labels.yaml")
    )
    model.write_text(model.read_text().replace("  /recorder: conduit\n", "").replace("  /uplink: conduit\n", ""))
    before = model.read_text()
    whose = "return document.activeElement.name === 'whose' ? document.activeElement.value : ''"
    with explorers.served(fleet, fleet, fleet=True, review=True) as explorer:
        chrome.open_page(browser, explorer.door.link, width=width)
        asked = []
        for robot in ("robot", "model"):
            asked.append(browser.execute_script(HEADING))
            assert chrome.axe(browser) == []
            assert browser.execute_script("return document.documentElement.scrollWidth") <= width
            assert chrome.wider(browser, "h1, h2, p, li, fieldset, button, .pick, .field") == []
            chrome.screenshot(browser, tmp_path / f"{robot}-{width}.png", width)
            tab_to(browser, "whose")
            while browser.execute_script(whose) != robot:
                press(browser, Keys.ARROW_DOWN)
            browser.execute_script("document.querySelector('h1').focus()")
            answer(browser, "conduit")
        assert [("carrier_lent" in one) for one in asked] == [True, True]  # it is not as its model
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?step=summary")
        assert chrome.axe(browser) == []
        assert chrome.wider(browser, "h1, h2, p, li, fieldset, button, .pick, .field") == []
        chrome.screenshot(browser, tmp_path / f"summary-{width}.png", width)
        assert "carrier_lent only" in browser.find_element(By.TAG_NAME, "main").text
        before_save = browser.find_element(By.TAG_NAME, "html")
        browser.execute_script("document.querySelector(\"[action^='/save'] button\").focus()")
        press(browser, Keys.ENTER)
        shown(browser, before_save)
        assert "All answers are saved." in browser.find_element(By.TAG_NAME, "main").text
    told = [name for name in ("/recorder", "/uplink") if f"  {name}:" in own.read_text()]
    assert len(told) == 1
    assert model.read_text() != before
    assert f"  {told[0]}:" not in model.read_text()
