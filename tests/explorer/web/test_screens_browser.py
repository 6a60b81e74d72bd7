"""Screens on the page in a real Chromium, by keys alone: the file is that of the terminal, byte for byte."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml

from rosprivacy.report.catalogs.words import Words
from tests.helpers import browser as chrome
from tests.helpers.asked_by_keys import COMMAND, DAY, text_of
from tests.helpers.browser import PHONE, WIDTHS
from tests.helpers.command import cli
from tests.helpers.page_reader import Reader, served
from tests.helpers.paths import ROOT
from tests.helpers.screens import observed_robot, transcript

if TYPE_CHECKING:
    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.command import Cli

__all__ = ["cli"]
pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]

CASES = ROOT / "tests" / "cases" / "try"
OBSERVED = [*COMMAND[:4], "robot.policy.xml", "--types", "robot.types.yaml", *COMMAND[5:]]
POLICY, LABELS, TYPES = Path("robot.policy.xml"), Path("l.yaml"), Path("robot.types.yaml")
# Enter, ticks, back, no, undo; the terminal is left by q, on the page nothing is to be done for that
KEYS = {
    "telepresence": "2\rb2\r\rnu" + "\r" * 7,
    "turtlebot4": "\r\r\r\r\r\r\r\r\r\r\r\r\r\r\rub\r\r",
}
NUMBER = ".screen .facts"


@pytest.fixture
def robot(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Path:
    """A robot as it was observed, in the working folder, on one day."""
    said = yaml.safe_load((CASES / f"{request.param}.yaml").read_text("utf-8"))
    observed_robot(cli, said, tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", DAY)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def press(reader: Reader, keys: str) -> None:
    """Press keys as at the terminal; Enter is a line end there."""
    from selenium.webdriver.common.keys import Keys

    reader.press(*(Keys.ENTER if key == "\r" else key for key in keys))


@pytest.mark.parametrize("robot", KEYS, indirect=True)
def test_the_same_keys_write_the_same_file_as_in_the_terminal(
    browser: WebDriver, robot: Path, request: pytest.FixtureRequest
) -> None:
    keys = KEYS[request.node.callspec.params["robot"]]
    begun = text_of(robot)
    transcript(OBSERVED, robot, keys + "q")
    written = text_of(robot)
    (robot / "l.yaml").write_text(begun, "utf-8")
    with served(browser, POLICY, LABELS, types=TYPES) as explorer:
        reader = Reader(browser, explorer)
        press(reader, f"y{keys}")
        assert explorer.session.unsaved == 0
    assert text_of(robot) == written != begun


@pytest.mark.parametrize("robot", ["telepresence"], indirect=True)
def test_from_the_first_screen_to_the_last_and_back_by_keys_alone(browser: WebDriver, robot: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    with served(browser, POLICY, LABELS, types=TYPES) as explorer:
        reader = Reader(browser, explorer)
        reader.press("y")
        assert reader.text(NUMBER).startswith("Screen 1 of ")
        assert reader.text("#h-element") == "/usb_cam"
        assert reader.text("#reasons summary").startswith("?")
        reader.press("2")
        line = "return document.querySelectorAll('.statement')[1].getAttribute('aria-checked')"
        assert browser.execute_script(line) == "true"
        reader.focus(".statement[data-key='2']")
        reader.press(Keys.SPACE)
        assert browser.execute_script(line) == "false", "a line has the focus still, and Enter takes what is ticked"
        assert browser.execute_script("return document.activeElement.dataset.key") == "2"
        reader.press("?")
        assert browser.execute_script("return document.querySelector('#reasons').open")
        for number in range(1, 40):
            if not browser.execute_script("return !!document.querySelector('.screen .statement')"):
                break
            assert reader.text(NUMBER).startswith(f"Screen {number} of ")
            reader.press(Keys.ENTER)
        whole = text_of(robot)
        assert Words("en")("explorer.screen.none") in reader.text(".screen")
        for _ in range(number):
            reader.press("b")
        assert (reader.text("#h-element"), text_of(robot)) == ("/usb_cam", "labels: 1\nauthor: Ada\n")
        for _ in range(number - 1):
            reader.press(Keys.ENTER)
        assert text_of(robot) == whole
        reader.press("u")
        assert text_of(robot) != whole
        name = reader.text("#h-element")
        reader.press(Keys.ESCAPE)
        assert reader.text("#h-element") == name
        assert not browser.execute_script("return document.querySelector('.screen')")


@pytest.mark.parametrize("robot", ["turtlebot4"], indirect=True)
def test_all_channels_are_taken_by_one_key(browser: WebDriver, robot: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    with served(browser, POLICY, LABELS, types=TYPES) as explorer:
        reader = Reader(browser, explorer)
        reader.press("y")
        while not browser.execute_script("return !!document.querySelector('.screen [data-key=a]')"):
            reader.press(Keys.ENTER)
        before = text_of(robot)
        assert "topics:" not in before
        reader.press("a")
        assert "topics:" in text_of(robot)
        reader.press("u")
        assert text_of(robot) == before


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("robot", ["turtlebot4"], indirect=True)
def test_a_screen_fits_can_be_tapped_and_read_aloud(browser: WebDriver, robot: Path, width: int) -> None:
    from selenium.webdriver.common.keys import Keys

    with served(browser, POLICY, LABELS, types=TYPES) as explorer:
        reader = Reader(browser, explorer, width)
        reader.press("y")
        for number in range(9):
            assert reader.faults() == []
            if width == PHONE:
                reader.pane("element")
                assert small(browser) == []
            chrome.screenshot(browser, robot / f"screen-{width}-{number}.png", width)
            reader.press(Keys.ENTER)
        if width == PHONE:
            assert browser.execute_script("return document.body.dataset.pane") == "element"


def small(browser: WebDriver) -> list[str]:
    """What a thumb cannot hit on a screen."""
    said = """
    return [...document.querySelectorAll('#element button, #element .button, #element summary')]
      .filter((e) => e.offsetParent && e.getBoundingClientRect().height < 44).map((e) => e.textContent)
    """
    return list(browser.execute_script(said))
