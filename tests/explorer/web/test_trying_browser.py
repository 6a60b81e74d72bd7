"""Trials and decisions in a real Chromium, by keys alone, and for a screen reader."""

from __future__ import annotations

import shutil
from contextlib import contextmanager
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.explorer.element_ids import element_id
from tests.helpers import browser as chrome
from tests.helpers import explorers
from tests.helpers.browser import DESKTOP, PHONE
from tests.helpers.explorers import BARE, FACTORY, copied
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.explorers import Explorer

pytestmark = [pytest.mark.browser, pytest.mark.slow]
SECONDS = 20
SETTLED = "return !document.body.hasAttribute('aria-busy')"
SMALL = """
return [...document.querySelectorAll('.way, #trial .button, .inline button, .decide button, #tries button')]
  .filter((e) => e.offsetParent && e.getBoundingClientRect().height < 44).map((e) => e.textContent);
"""


@contextmanager
def served(browser: WebDriver, labels: Path, **how: Any) -> Iterator[Explorer]:
    """The page on a server that ends after the page was left; the console stays silent."""
    with explorers.served(BARE, labels, **how) as explorer:
        yield explorer
        browser.get("about:blank")
    assert chrome.console(browser) == []


class Reader:
    """A person who has nothing but keys."""

    def __init__(self, browser: WebDriver, explorer: Explorer, width: int = DESKTOP) -> None:
        self.browser = browser
        chrome.open_page(browser, explorer.door.link, width=width)

    def press(self, *keys: str) -> None:
        """Press keys one after the other; after each, what it began is waited for."""
        from selenium.webdriver import ActionChains
        from selenium.webdriver.support.ui import WebDriverWait

        for key in keys:
            ActionChains(self.browser).send_keys(key).perform()
            WebDriverWait(self.browser, SECONDS, 0.02).until(lambda b: b.execute_script(SETTLED))

    def focus(self, selector: str) -> None:
        self.browser.execute_script("document.querySelector(arguments[0]).focus()", selector)

    def pane(self, name: str) -> None:
        self.browser.execute_script(f"document.querySelector('.tabs [data-pane={name}]').click()")

    @property
    def version(self) -> int:
        return int(self.browser.execute_script("return document.body.dataset.version"))

    def text(self, selector: str) -> str:
        return str(self.browser.execute_script("return document.querySelector(arguments[0]).textContent", selector))


def test_a_finding_is_closed_on_trial_and_accepted_by_keys_alone(browser: WebDriver, tmp_path: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    decisions = tmp_path / "d.yaml"
    with served(browser, copied(FACTORY / "run2.labels.yaml", tmp_path), decisions=decisions) as explorer:
        reader = Reader(browser, explorer)
        reader.press("o")
        assert "from /robot_camera" in reader.text("#h-element")
        reader.press("p")
        assert "With 3 changes" in reader.text("#hand")
        reader.focus(".proposal form button")
        reader.press(Keys.ENTER)
        assert "this is a trial" in reader.text("#trial")
        assert reader.text("#head h1").startswith("Trial: ")
        assert "this is a trial" in reader.text("#said")
        assert "2 paths to assess close" in reader.text("#hand")
        reader.press("u", "c", "l", "x")  # nothing can be answered
        assert reader.version == 0
        assert explorer.session.edits == ()
        reader.press(Keys.ESCAPE)
        assert reader.text("#trial").strip() == ""
        assert "Trial 1" in reader.text("#rows")
        reader.press("o")
        reader.focus("#decide [name=reason]")
        reader.press(*"inside", Keys.TAB, *"A. Lee", Keys.ENTER)
        assert reader.version == 1
        assert "Written to" in reader.text("#message")
        assert "decision: accept" in decisions.read_text("utf-8")


@pytest.mark.parametrize("width", [DESKTOP, PHONE])
def test_axe_finds_nothing_in_findings_and_trials(browser: WebDriver, tmp_path: Path, width: int) -> None:
    from selenium.webdriver.common.keys import Keys

    labels = copied(FACTORY / "run2.labels.yaml", tmp_path)
    with served(browser, labels, decisions=tmp_path / "d.yaml") as explorer:
        reader = Reader(browser, explorer, width)
        reader.press("t")
        reader.pane("element")
        assert "A storage is added here" in reader.text("#tries")
        for key in ("", "o", "p"):
            reader.press(*key)
            reader.pane("element")
            _accessible(browser, width)
        reader.focus(".proposal form button")
        reader.press(Keys.ENTER)
        assert "this is a trial" in reader.text("#trial")
        for pane in ("list", "picture", "element"):
            reader.pane(pane)
            _accessible(browser, width)


def _accessible(browser: WebDriver, width: int) -> None:
    """Axe finds nothing of WCAG 2.1 A and AA and of best practices; nothing is too wide or, on a phone, too small."""
    browser.execute_script(files("axe_core_python").joinpath("axe.min.js").read_text("utf-8"))
    found = browser.execute_async_script("axe.run(document, {resultTypes: ['violations']}).then(arguments[0])")
    assert [(one["id"], one["nodes"][0]["html"]) for one in found["violations"]] == []
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
    if width == PHONE:
        assert browser.execute_script(SMALL) == []
        assert chrome.wider(browser, "h1, h3, p:not(.unseen), .row, .way, .hops li, .said li, .try, .decide") == []


@pytest.mark.parametrize("width", [DESKTOP, PHONE])
def test_trials_of_a_fleet_fit_and_say_on_how_many_robots(browser: WebDriver, tmp_path: Path, width: int) -> None:
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    fleet = tmp_path / "fleet" / "fleet.yaml"
    blur = element_id(("carrier_01", "node", "/blur"))
    with explorers.served(fleet, fleet, fleet=True) as explorer:
        reader = Reader(browser, explorer, width)
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?at={blur}")
        reader.pane("element")
        browser.execute_script("document.getElementById('tries').open = true")
        _accessible(browser, width)
        chrome.screenshot(browser, tmp_path / f"offers-{width}.png", width)
        reader.focus("#try-storage-whose")
        reader.press("c")  # "carrier_01 only"
        assert reader.text("#try-storage-whose option:checked") == "carrier_01 only"
        browser.execute_script("document.getElementById('try-storage-whose').form.querySelector('button').focus()")
        reader.press("\ue007")
        assert "On 1 robot: carrier_01." in reader.text("#element")
        assert "1 path to assess opens" in reader.text("#element")
        reader.pane("element")
        _accessible(browser, width)
        chrome.screenshot(browser, tmp_path / f"trial-{width}.png", width)
        browser.get("about:blank")
    assert chrome.console(browser) == []
