"""The page in a real Chromium: the factory by keys alone, on a phone, for a screen reader; it asks nobody else."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from rosprivacy.cli import explore
from tests.helpers import browser as chrome
from tests.helpers import explorers
from tests.helpers.browser import PHONE, WIDTHS
from tests.helpers.explorers import BARE, FACTORY, FILTERED, copied, label
from tests.helpers.full_disk import full_disk
from tests.helpers.page_reader import SECONDS, Reader, meaning, served

if TYPE_CHECKING:
    from collections.abc import Callable

    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.explorers import Explorer

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]
BOTTOMS = """
return [...document.querySelectorAll('.hops li, .answers .answer')].map((e) => e.getBoundingClientRect().bottom)
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


def test_a_policy_that_somebody_changed_is_told_without_an_answer(browser: WebDriver, tmp_path: Path) -> None:
    from selenium.webdriver.support.ui import WebDriverWait

    copied(FACTORY / "node.xml", tmp_path)
    policy = copied(BARE, tmp_path)
    with served(browser, policy, copied(FACTORY / "run1.labels.yaml", tmp_path)) as explorer:
        reader = Reader(browser, explorer)
        reader.go("/navigator")
        policy.write_text(policy.read_text("utf-8") + "<!-- more -->", "utf-8")
        told = "return document.querySelector('#elsewhere').textContent"
        wanted = f"These files have changed since they were read: {policy}. "
        WebDriverWait(browser, SECONDS, 0.05).until(lambda b: wanted in b.execute_script(told))
        reader.press("c")
        assert wanted in reader.text("#inputs")
        assert reader.version == 1


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
        assert reader.faults() == []
        assert reader.text(".hops li") != ""


@pytest.mark.parametrize("width", WIDTHS)
def test_axe_finds_nothing_in_any_pane(browser: WebDriver, tmp_path: Path, width: int) -> None:
    file = copied(FACTORY / "run2.labels.yaml", tmp_path)
    with served(browser, BARE, file) as explorer:
        reader = Reader(browser, explorer, width)
        assert reader.faults() == []
        for name in ("/robot_camera", "/safety_video"):  # a source with nothing open, and a channel
            reader.go(name)
            assert reader.faults() == []
        reader.press("w", "1")  # the whole system, and a kind of data switched off
        assert reader.faults() == []
        browser.execute_script("document.querySelector('#help').showModal()")
        assert chrome.axe(browser) == []


@pytest.mark.parametrize("width", WIDTHS)
def test_axe_finds_nothing_in_what_the_page_tells(browser: WebDriver, tmp_path: Path, width: int) -> None:
    """The empty page, answers of an earlier session, a file that somebody else changed, and one that is only shown."""
    file = tmp_path / "new.labels.yaml"
    with served(browser, BARE, file, journal=tmp_path / "journal") as explorer:
        reader = Reader(browser, explorer, width)
        assert reader.faults() == []
        reader.answer("/robot_camera", "a")
        assert reader.faults() == []
        explorer.session.close()
    with served(browser, BARE, file, journal=tmp_path / "journal") as explorer:
        reader = Reader(browser, explorer, width)
        assert "earlier" in reader.text("#message")
        assert reader.faults() == []
        reader.focus("#message form button")
        reader.press("\n")
        file.write_text("labels: 1\nchannels:\n  /new_pose: mundane\n", "utf-8")
        browser.refresh()
        assert "+  /new_pose: mundane" in reader.text("#message")
        assert reader.faults() == []
    with served(browser, BARE, copied(FACTORY / "run2.labels.yaml", tmp_path), read_only=True) as explorer:
        reader = Reader(browser, explorer, width)
        assert "nothing can be changed" in reader.text("#head")
        assert reader.faults() == []


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


def test_two_explorers_stand_side_by_side_in_one_browser(browser: WebDriver, tmp_path: Path) -> None:
    """A browser keeps the cookies of all ports of a machine together: each explorer has one of its own name."""
    first = copied(FACTORY / "run1.labels.yaml", tmp_path)
    with served(browser, BARE, first) as one, served(browser, FILTERED, tmp_path / "other.labels.yaml") as other:
        reader = Reader(browser, one)
        Reader(browser, other).answer("/robot_camera", "a")
        browser.get(f"http://127.0.0.1:{one.door.port}/")
        reader.answer("/archive_server", "l")
        reader.save()
        browser.get(f"http://127.0.0.1:{other.door.port}/")
        reader.save()
        assert {cookie["name"] for cookie in browser.get_cookies()} >= {one.door.cookie, other.door.cookie}
    assert "/archive_server" in first.read_text("utf-8")
    assert other.labels.is_file()


def test_the_file_that_opens_the_page_opens_it(
    browser: WebDriver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From a file to the page and on: a browser keeps the cookie back (SameSite) until our own page asks."""
    from selenium.webdriver.support.wait import WebDriverWait

    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    monkeypatch.setenv("DISPLAY", ":9")
    monkeypatch.setattr(webbrowser, "open_new_tab", browser.get)
    with explorers.served(BARE, tmp_path / "new.labels.yaml") as explorer:
        assert explore._open(explorer.door.link)
        WebDriverWait(browser, SECONDS).until(lambda _: browser.find_elements("css selector", "#rows"))
        assert browser.current_url == f"http://127.0.0.1:{explorer.door.port}/"
        asked = {urlsplit(address).netloc for address in chrome.requests(browser)}
        assert asked >= {"", f"127.0.0.1:{explorer.door.port}"}  # the file, and the page


def test_a_full_disk_in_mid_session_loses_nothing_and_is_told(browser: WebDriver, tmp_path: Path) -> None:
    labels = copied(FACTORY / "run1.labels.yaml", tmp_path)
    before = labels.read_bytes()
    with served(browser, BARE, labels, journal=tmp_path / "journal") as explorer:
        reader = Reader(browser, explorer)
        with full_disk(100):
            reader.answer("/archive_server", "l")
            assert "edits are in this session only" in reader.text("#message")  # no journal can be written
            reader.press_save()
            assert "cannot be written" in reader.text("#message")
            assert reader.text("[data-key='Ctrl+S']") == "Save 1"
            reader.answer("/navigator", "c")  # it goes on
        assert labels.read_bytes() == before
        assert [file.name for file in tmp_path.glob("*.yaml*")] == [labels.name]  # and nothing is left beside it
        (refused,) = chrome.console(browser)  # Chromium tells of every 422
        assert "422" in refused["message"]
        assert reader.verdict == "leak"
        reader.save()
        assert explorer.session.unsaved == 0
    assert meaning(BARE, labels)["verdict"] == "leak"
