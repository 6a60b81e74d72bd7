"""Pictures of the explorer in a real Chromium: text stands within its box and can be read; a strict policy is kept."""

from __future__ import annotations

import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.report.pictures.live_svg import SMALL, Links
from rosprivacy.report.pictures.page_pictures import Pictures, legend, style_sheet
from rosprivacy.report.pictures.scenes import Scenes
from tests.helpers import browser as chrome
from tests.helpers.graphs import care_home, factory, hospital
from tests.helpers.pictures import hostile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from rosprivacy.analysis.answer import Analysis

pytestmark = [pytest.mark.browser, pytest.mark.slow]
POLICY = "default-src 'none'; style-src 'self'; img-src data:"
PAGE = """<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Picture</title>
<meta http-equiv="Content-Security-Policy" content="{policy}"><link rel="icon" href="data:,">
<link rel="stylesheet" href="picture.css"></head><body><main><h1>Picture</h1>{svg}{legend}</main></body></html>"""
OUTSIDE = """
return [...document.querySelectorAll('.picture .box')].flatMap((box) => {
  const area = box.querySelector('.area').getBBox();
  return [...box.querySelectorAll('text')].filter((text) => {
    const at = text.getBBox();
    return at.x < area.x - 1 || at.x + at.width > area.x + area.width + 1
      || at.y < area.y - 1 || at.y + at.height > area.y + area.height + 1;
  }).map((text) => text.textContent);
});
"""
SIZES = """
return [...document.querySelectorAll('.picture text')].map((text) => {
  const seen = text.getScreenCTM().a;
  return parseFloat(getComputedStyle(text).fontSize) * seen;
});
"""
LINKS = Links(name=lambda key: key[2], address=lambda _: "/")


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebDriver]:
    with chrome.chromium(tmp_path_factory.mktemp("profile")) as found:
        yield found


class _Silent(SimpleHTTPRequestHandler):
    def log_message(self, *_: Any) -> None:
        """Say nothing."""


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Silent, directory=str(tmp_path)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/page.html"
    server.shutdown()
    server.server_close()


SYSTEMS: dict[str, Callable[[], Analysis]] = {
    "factory": lambda: factory(1).analysis,
    "care-home": lambda: care_home().analysis,
    "hospital": lambda: hospital().analysis,
    "hostile": hostile,
}


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("everything", [False, True])
def test_text_stands_within_its_box_and_can_be_read(
    browser: WebDriver, address: str, tmp_path: Path, system: str, *, everything: bool
) -> None:
    analysis = SYSTEMS[system]()
    focus = next((question.element.identity for question in analysis.open), None)
    with Pictures() as pictures:
        shown = pictures.of(analysis, focus, None, LINKS, everything=everything)
    page = PAGE.format(policy=POLICY, svg=shown.svg, legend=shown.legend)
    (tmp_path / "page.html").write_text(page, "utf-8")
    (tmp_path / "picture.css").write_text(style_sheet(), "utf-8")
    for width in (chrome.DESKTOP, chrome.PHONE):
        asked = chrome.open_page(browser, address, width=width, dark=width == chrome.PHONE)
        assert {one.rpartition("/")[2] for one in asked} <= {"page.html", "picture.css", "favicon.ico"}
        assert browser.execute_script(OUTSIDE) == []
        assert min(browser.execute_script(SIZES)) >= SMALL
        assert chrome.console(browser) == []


def test_every_box_is_reached_by_the_tab_key_in_reading_order(browser: WebDriver, address: str, tmp_path: Path) -> None:
    from selenium.webdriver.common.keys import Keys

    analysis = factory(1).analysis
    with Pictures() as pictures:
        shown = pictures.of(analysis, ("", "node", "/archive_server"), None, LINKS)
    (tmp_path / "page.html").write_text(PAGE.format(policy=POLICY, svg=shown.svg, legend=""), "utf-8")
    (tmp_path / "picture.css").write_text(style_sheet(), "utf-8")
    chrome.open_page(browser, address)
    reached = []
    scene = Scenes(analysis).of(("", "node", "/archive_server"))
    for _ in scene.picture.boxes:
        browser.switch_to.active_element.send_keys(Keys.TAB)
        reached.append(str(browser.switch_to.active_element.get_attribute("data-element")))
    assert sorted(reached) == sorted(box.key[2] for box in scene.picture.boxes)
    assert reached[:3] == ["/safety_camera", "/safety_video", "/archive_server"]
    assert "<li>" in legend(scene)
