"""The full page in a real Chromium whose scripts are switched off: answers, undo and saving are plain forms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers import browser as chrome
from tests.helpers import explorers
from tests.helpers.explorers import BARE, FACTORY, copied, node

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.explorers import Explorer

pytestmark = [pytest.mark.browser, pytest.mark.slow]
SECONDS = 90


@pytest.fixture
def plain(tmp_path: Path) -> Iterator[WebDriver]:
    """A browser that runs no script of a page."""
    with chrome.chromium(tmp_path / "profile", chrome.HERE_ONLY) as found:
        found.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        found.get("data:text/html,<title>off</title><script>document.title = 'on'</script>")
        assert found.title == "off"
        yield found


def pressed(browser: WebDriver, selector: str, explorer: Explorer) -> None:
    """Press a button, and wait for a page that shows the session as it is after that."""
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import WebDriverWait

    before = explorer.session.version
    browser.find_element(By.CSS_SELECTOR, selector).click()

    def shown(there: WebDriver) -> bool:
        version = there.find_element(By.CSS_SELECTOR, "[data-version]").get_attribute("data-version")
        return before != explorer.session.version == int(version or -1)

    WebDriverWait(browser, SECONDS, 0.05, [WebDriverException]).until(shown)


def test_an_answer_undo_and_save_work_without_scripts(plain: WebDriver, tmp_path: Path) -> None:
    labels = copied(FACTORY / "run2.labels.yaml", tmp_path)
    said = labels.read_text("utf-8")
    with explorers.served(BARE, labels) as explorer:
        chrome.open_page(plain, explorer.door.link)
        plain.get(f"http://127.0.0.1:{explorer.door.port}/?at={node('/navigator')}")
        answer, undo, save = "button[name=role][value=leak]", "[action^='/undo'] button", "[action^='/save'] button"
        pressed(plain, answer, explorer)
        assert [edit.name for edit in explorer.session.edits] == ["/navigator"]
        pressed(plain, undo, explorer)
        assert explorer.session.edits == ()
        plain.get(f"http://127.0.0.1:{explorer.door.port}/?at={node('/navigator')}")
        pressed(plain, answer, explorer)
        pressed(plain, save, explorer)
        assert explorer.session.unsaved == 0
        assert labels.read_text("utf-8") != said
        plain.get("about:blank")


def test_a_screen_is_answered_without_scripts(plain: WebDriver, tmp_path: Path) -> None:
    labels = tmp_path / "new.labels.yaml"
    with explorers.served(BARE, labels) as explorer:
        chrome.open_page(plain, explorer.door.link)
        plain.get(f"http://127.0.0.1:{explorer.door.port}/?ask=1")
        plain.find_element("css selector", "[name=by]").send_keys("Ada")
        pressed(plain, ".screen [data-key=n]", explorer)
        assert "# not: " in labels.read_text("utf-8")
        pressed(plain, ".screen [data-key=u]", explorer)
        assert "# not: " not in labels.read_text("utf-8")
        plain.get("about:blank")
