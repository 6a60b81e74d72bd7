"""The page in a real Chromium: the factory by keys alone, on a phone, for a screen reader; it asks nobody else."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

import pytest

from rosprivacy.reading.fleet_system import answer_fleet
from rosprivacy.settings import Settings
from tests.helpers import browser as chrome
from tests.helpers.browser import DESKTOP, PHONE
from tests.helpers.explorers import BARE, FACTORY, FILTERED, copied, label
from tests.helpers.page_reader import SECONDS, Reader, meaning, served
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.explorers import Explorer

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]
TEXTS = "h1, h2:not(.unseen), h3, p:not(.unseen), .row, .answers, .about label, .hops li"
BOTTOMS = """
return [...document.querySelectorAll('.hops li, .answers .answer')].map((e) => e.getBoundingClientRect().bottom)
"""
LAST_OF_WHOSE = "const all = document.querySelectorAll('.whose input'); all[all.length - 1].click()"
SMALL = """
return [...document.querySelectorAll('.answers button, .answers summary, .row, .tabs button')]
  .filter((e) => e.offsetParent && e.getBoundingClientRect().height < 48).map((e) => e.textContent);
"""


def test_the_five_runs_of_the_factory_by_keys_alone(browser: WebDriver, tmp_path: Path) -> None:
    """From the bare policy to 'no leak found'; each saved file means what the example's means."""
    from selenium.webdriver.common.keys import Keys

    enter = (Keys.TAB, Keys.ENTER)
    labels = tmp_path / "factory.labels.yaml"
    with served(browser, BARE, labels) as explorer:
        reader = Reader(browser, explorer)
        assert reader.verdict == "nothing"
        reader.answer("/robot_camera", "s", *enter)
        reader.answer("/safety_camera", "a")
        assert reader.verdict == "undetermined"
        assert "row" in reader.focused  # the next question has the focus
        reader.save()
        assert meaning(BARE, labels) == meaning(BARE, FACTORY / "run1.labels.yaml")
        reader.answer("/archive_server", "l")
        assert reader.verdict == "leak"
        reader.answer("/emergency_stop", "0", "c")
        reader.answer("/navigator", "0", "c")
        reader.answer("/robot_video", "0", "v")
        reader.answer("/safety_video", "0", "v")
        reader.save()
        assert meaning(BARE, labels) == meaning(BARE, FACTORY / "run2.labels.yaml")
        reader.answer("/new_pose", "0", "m")
        reader.answer("/stop_arm", "0", "m")
        reader.save()
        assert meaning(BARE, labels) == meaning(BARE, FACTORY / "run3.labels.yaml")
    with served(browser, FILTERED, labels) as explorer:
        reader = Reader(browser, explorer)
        reader.answer("/filter", "z", *enter)
        reader.answer("/filtered_safety_video", "0", "m")
        reader.save()
        assert meaning(FILTERED, labels) == meaning(FILTERED, FACTORY / "run4.labels.yaml")
        reader.answer("/save_footage", "0", "m")
        assert reader.verdict == "no-leak-found"
        reader.save()
        assert meaning(FILTERED, labels) == meaning(FILTERED, FACTORY / "run5.labels.yaml")


def test_undo_goes_back_to_the_start(browser: WebDriver, tmp_path: Path) -> None:
    with served(browser, BARE, tmp_path / "new.labels.yaml") as explorer:
        reader = Reader(browser, explorer)
        begun = reader.text("#rows")
        reader.answer("/robot_camera", "a")
        reader.answer("/archive_server", "l")
        after = reader.text("#rows")
        reader.press("u", "u", "u")
        assert (reader.verdict, reader.text("#rows")) == ("nothing", begun)
        reader.press("r", "r")
        assert (reader.verdict, reader.text("#rows")) == ("leak", after)


def test_no_key_does_anything_while_somebody_types(browser: WebDriver, tmp_path: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    with served(browser, BARE, copied(FACTORY / "run1.labels.yaml", tmp_path)) as explorer:
        reader = Reader(browser, explorer)
        reader.press("/", *"clsum")
        assert browser.execute_script("return document.querySelector('#find').value") == "clsum"
        assert reader.version == 0
        reader.press(Keys.ENTER)
        assert "No element has “clsum” in its name." in reader.text("#rows")
        reader.press("?", "c", Keys.ESCAPE)
        assert reader.version == 0


def test_a_second_window_is_told_and_a_stale_answer_does_nothing(browser: WebDriver, tmp_path: Path) -> None:
    from selenium.webdriver.support.ui import WebDriverWait

    with served(browser, BARE, copied(FACTORY / "run1.labels.yaml", tmp_path)) as explorer:
        reader = Reader(browser, explorer)
        reader.go("/navigator")
        explorer.session.label("/archive_server", leak="Video")
        told = "return document.querySelector('#elsewhere').hidden"
        WebDriverWait(browser, SECONDS, 0.05).until(lambda b: not b.execute_script(told))
        assert reader.version == 0
        reader.press("c")
        assert "Another window changed something" in reader.text("#message")
        assert (reader.version, len(explorer.session.edits)) == (1, 1)
        messages = chrome.console(browser)  # Chromium tells of every 409
        assert len(messages) == 1
        assert "409" in messages[0]["message"]


@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_a_phone_shows_everything_without_moving_sideways(browser: WebDriver, tmp_path: Path, language: str) -> None:
    with served(browser, BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), language=language) as explorer:
        reader = Reader(browser, explorer, PHONE)
        for number in range(3):
            browser.execute_script(f"document.querySelectorAll('.tabs button')[{number}].click()")
            assert browser.execute_script("return document.documentElement.scrollWidth") <= PHONE
            assert (
                chrome.wider(browser, "h1, h2:not(.unseen), h3, p:not(.unseen), .row, .answers, .about label, .hops li")
                == []
            )
            assert browser.execute_script(SMALL) == []
        assert reader.text(".hops li") != ""


@pytest.mark.parametrize("width", [DESKTOP, PHONE])
def test_axe_finds_nothing_in_any_pane(browser: WebDriver, tmp_path: Path, width: int) -> None:
    file = copied(FACTORY / "run2.labels.yaml", tmp_path)
    with served(browser, BARE, file) as explorer:
        Reader(browser, explorer, width)
        for pane in ("list", "picture", "element"):
            browser.execute_script(f"document.querySelector('.tabs [data-pane={pane}]').click()")
            for more in ("", "document.querySelectorAll('#hand details').forEach((d) => d.open = true)"):
                browser.execute_script(more)
                assert chrome.axe(browser) == []
        browser.execute_script("document.querySelector('#help').showModal()")
        assert chrome.axe(browser) == []


def test_the_first_question_its_path_and_the_answers_lie_within_the_first_screen(
    browser: WebDriver, tmp_path: Path
) -> None:
    with served(browser, BARE, copied(FACTORY / "run1.labels.yaml", tmp_path)) as explorer:
        Reader(browser, explorer)
        ends = browser.execute_script(BOTTOMS)
        assert len(ends) > 6
        assert max(ends) <= 900


def test_without_the_script_forms_and_links_work(explore: Callable[..., Explorer], tmp_path: Path) -> None:
    """Every form of the page is posted as a browser without scripts posts it."""
    from lxml import html

    opened = explore(BARE, tmp_path / "new.labels.yaml")
    client = opened.client()
    page = html.fromstring(client.get("/").text)
    offer = next(form for form in page.forms if form.get("class") == "offer")
    answer = client.post(str(offer.action), data=dict(offer.form_values()))
    assert answer.status_code == 303
    assert opened.session.version == 1
    rows = page.xpath("//a[@class='row']/@href")
    assert all(client.get(row).status_code == 200 for row in rows)
    assert label(client, "e0", "leak").status_code == 422


def test_a_fleet_is_decided_for_the_model_and_for_one_robot(browser: WebDriver, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "examples" / "fleet", tmp_path / "fleet")
    file = tmp_path / "fleet" / "fleet.yaml"
    model, own = file.parent / "carrier.labels.yaml", file.parent / "carrier_lent.labels.yaml"
    model.write_text(model.read_text().replace("  /recorder: conduit\n", ""))
    with served(browser, file, file, fleet=True) as explorer:
        reader = Reader(browser, explorer)
        assert reader.current == "carrier_lent:/recorder"
        browser.execute_script(LAST_OF_WHOSE)
        reader.answer("carrier_lent:/recorder", "c")
        assert "stands for 23 robots" in reader.text("#element .facts")
        for width in (DESKTOP, PHONE, DESKTOP):
            size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width == PHONE}
            browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
            assert chrome.wider(browser, "fieldset, .whose label, .row") == []
        reader.answer("carrier_01:/recorder", "c")
        reader.save()
        assert explorer.session.result.to("json") == answer_fleet(str(file), Settings()).to("json")
    for labels in (model, own):
        assert "  /recorder: {conduit: [Video]}" in labels.read_text()
