"""Trials and decisions in a real Chromium, by keys alone, and for a screen reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers.browser import DESKTOP, PHONE
from tests.helpers.explorers import BARE, FACTORY, copied
from tests.helpers.page_reader import Reader, served

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.explorers import Explorer

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]


def test_a_finding_is_closed_on_trial_and_accepted_by_keys_alone(browser: WebDriver, tmp_path: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    decisions = tmp_path / "d.yaml"
    with served(browser, BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), decisions=decisions) as explorer:
        reader = Reader(browser, explorer)
        reader.press("o")
        assert "from /robot_camera" in reader.text("#h-element")
        reader.press("p")
        assert "With 3 changes" in reader.text("#hand")
        top = "return document.querySelector('#h-closes').getBoundingClientRect().top"
        assert 0 < browser.execute_script(top) < browser.execute_script("return innerHeight / 2")  # it is seen
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
def test_axe_finds_nothing_in_findings_decisions_and_trials(browser: WebDriver, tmp_path: Path, width: int) -> None:
    from selenium.webdriver.common.keys import Keys

    labels = copied(FACTORY / "run2.labels.yaml", tmp_path)
    with served(browser, BARE, labels, decisions=tmp_path / "d.yaml") as explorer:
        reader = Reader(browser, explorer, width)
        reader.press("t")
        assert "A storage is added here" in reader.text("#tries")
        for key in ("", "o", "p"):
            reader.press(*key)
            assert reader.faults() == []
        reader.pane("element")
        reader.focus(".proposal form button")
        reader.press(Keys.ENTER)
        assert "this is a trial" in reader.text("#trial")
        assert reader.faults() == []
        reader.press(Keys.ESCAPE)
        assert "Trial 1" in reader.text("#rows")
        assert reader.faults() == []  # the trial that is kept
        reader.press("o")
        reader.pane("element")
        reader.focus("#decide [name=reason]")
        reader.press(*"inside", Keys.TAB, *"A. Lee", Keys.ENTER)
        assert "Written to" in reader.text("#message")
        for key in ("", "o"):  # the message, and a finding beside what is accepted
            reader.press(*key)
            assert reader.faults() == []
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?finding={_accepted(explorer)}")
        assert reader.faults() == []


def _accepted(explorer: Explorer) -> str:
    """The finding that a decision is about."""
    return next(finding.id for finding in explorer.session.findings if not finding.stands)
