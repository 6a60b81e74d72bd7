"""Trials and decisions in a real Chromium, by keys alone, and for a screen reader."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from rosprivacy.explorer.edits import element_id
from tests.helpers import browser as chrome
from tests.helpers.browser import WIDTHS
from tests.helpers.explorers import BARE, FACTORY, copied
from tests.helpers.page_reader import Reader, served
from tests.helpers.paths import ROOT

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
        reader.accept()
        assert reader.version == 1
        assert "Written to" in reader.text("#message")
        assert "decision: accept" in decisions.read_text("utf-8")


@pytest.mark.parametrize("width", WIDTHS)
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
        reader.accept()
        assert "Written to" in reader.text("#message")
        for key in ("", "o"):  # the message, and a finding beside what is accepted
            reader.press(*key)
            assert reader.faults() == []
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?finding={_accepted(explorer)}")
        assert reader.faults() == []


def _accepted(explorer: Explorer) -> str:
    """The finding that a decision is about."""
    return next(finding.id for finding in explorer.session.findings if not finding.stands)


@pytest.mark.parametrize("width", WIDTHS)
def test_trials_of_a_fleet_fit_and_say_on_how_many_robots(browser: WebDriver, tmp_path: Path, width: int) -> None:
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    fleet = tmp_path / "fleet" / "fleet.yaml"
    with served(browser, fleet, fleet, fleet=True) as explorer:
        reader = Reader(browser, explorer, width)
        blur = element_id(("carrier_01", "node", "/blur"))
        browser.get(f"http://127.0.0.1:{explorer.door.port}/?at={blur}")
        assert reader.faults() == []
        chrome.screenshot(browser, tmp_path / f"offers-{width}.png", width)
        reader.pane("element")
        reader.focus("#try-storage-whose")
        reader.press("c")  # "carrier_01 only"
        assert reader.text("#try-storage-whose option:checked") == "carrier_01 only"
        browser.execute_script("document.getElementById('try-storage-whose').form.querySelector('button').focus()")
        reader.press("\ue007")
        assert "On 1 robot: carrier_01." in reader.text("#element")
        assert "1 path to assess opens" in reader.text("#element")
        assert reader.faults() == []
        chrome.screenshot(browser, tmp_path / f"trial-{width}.png", width)
