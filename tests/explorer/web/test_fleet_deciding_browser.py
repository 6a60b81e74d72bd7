"""A decision about robots of a fleet in a real Chromium, by keys alone, and for a screen reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from tests.helpers import browser as chrome
from tests.helpers.browser import WIDTHS
from tests.helpers.page_reader import Reader, served

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]


def accepted(hospital: Path, decisions: Path) -> int:
    fleet = rosprivacy.analyze_fleet(hospital, decisions=decisions).fleet
    assert fleet
    return sum(one.accepted for one in fleet.patterns)


def test_one_robot_is_accepted_and_then_those_that_are_alike(browser: WebDriver, hospital: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    decisions = hospital.with_name("d.yaml")
    with served(browser, hospital, hospital, fleet=True, decisions=decisions) as explorer:
        reader = Reader(browser, explorer)
        reader.press("o")
        reader.tab_to("#decide [name=whose]:checked")
        chosen = """return document.querySelector('#decide [name=whose]:checked')
          .parentNode.textContent.split('–')[0].trim()"""  # without what else is to be known
        choices = len(browser.find_elements("css selector", "#decide [name=whose]"))
        for _ in range(choices):  # the first is of all robots of a kind, be it one
            reader.press(Keys.ARROW_DOWN)
            if (one := str(browser.execute_script(chosen))).endswith(" only"):
                break
        assert one.endswith(" only")
        reader.tab_to("#decide [name=reason]")
        reader.accept()
        assert reader.version == 1
        assert f"accepted, {one}" in reader.text("#message")
        assert accepted(hospital, decisions) == 1
        robots = explorer.session.stands_for(one.removesuffix(" only"))
        assert len(robots) == 1
        assert decisions.read_text("utf-8").count(f"robots: [{robots[0]}]") == 1
        reader.press("o")
        reader.tab_to("#decide [name=reason]")  # of those that are chosen beforehand
        many = str(browser.execute_script(chosen))
        reader.accept()
        assert reader.version == 2
        assert f"accepted, {many}" in reader.text("#message")
        whole = rosprivacy.analyze_fleet(hospital, decisions=decisions)
        assert whole.to("json1") == explorer.session.result.to("json1")


@pytest.mark.parametrize("width", WIDTHS)
def test_axe_finds_nothing_in_a_decision_about_robots(
    browser: WebDriver, hospital: Path, tmp_path: Path, width: int
) -> None:
    with served(browser, hospital, hospital, fleet=True, decisions=hospital.with_name("d.yaml")) as explorer:
        reader = Reader(browser, explorer, width)
        reader.press("o")
        assert reader.faults() == []
        assert chrome.wider(browser, "fieldset, .whose label, .whose p") == []
        reader.pane("element")
        reader.focus("#decide [name=whose]:checked")
        chrome.screenshot(browser, tmp_path / f"decide-{width}.png", width)
