"""The report in a real Chromium: it asks nobody for anything, works, prints whole, and harms nobody by a name."""

from __future__ import annotations

import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from io import BytesIO
from itertools import combinations
from typing import TYPE_CHECKING, Any
from unicodedata import bidirectional, normalize

import pytest

from rosprivacy.documents import document_of
from rosprivacy.report.compare.earlier import Earlier
from rosprivacy.report.document.contents import PATHS
from rosprivacy.report.page.assessment import read_answers
from rosprivacy.report.page.figures import Figures, Wishes, figures
from rosprivacy.report.page.html import html
from rosprivacy.report.page.outline import outline
from tests.helpers import browser as chrome
from tests.helpers import pictures
from tests.helpers.browser import A4, DESKTOP, PAPER, PHONE
from tests.helpers.graphs import care_home, factory, hospital
from tests.helpers.reports import HOSTILE, care, fleet, hostile, run, with_decisions, with_outside

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow]
PAGES = ["care-en", "care-de", "all-en", "open-de", "fleet-en", "hospital-de", "none-en", "hostile-en", "hostile-de"]


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebDriver]:
    with chrome.chromium(tmp_path_factory.mktemp("profile")) as found:
        yield found


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Reports in files, with all that a report can tell."""
    folder = tmp_path_factory.mktemp("reports")
    old = Earlier(run(2), "old.json", "0" * 64)
    everything = with_decisions(with_outside(care()))
    harm = hostile(folder)
    evil = pictures.hostile()
    drawn = [*pictures.of_findings(evil), *pictures.of_findings(evil, Wishes(bound=100))]
    harmful = Figures({finding["id"]: one for finding, one in zip(harm["findings"], drawn * 9, strict=False) if one})
    all_told = outline(everything, "en", earlier=old)
    several = outline(hospital().document(), "de")
    open_told = outline(run(2), "de", earlier=Earlier(run(1), "old.json", "0" * 64))
    said = {
        "care-en": html(outline(care(), "en", date="2026-11-21")),
        "care-de": html(outline(care(), "de", date="2026-11-21")),
        "all-en": html(all_told, figures(document_of(care_home(), (PATHS,)), all_told)),
        "open-de": html(open_told, figures(document_of(factory(2), (PATHS,)), open_told)),
        "fleet-en": html(outline(fleet(care(), [f"robot{i:03}" for i in range(300)]), "en")),
        "hospital-de": html(several, figures(document_of(hospital(), (PATHS,)), several)),
        "none-en": html(outline(care() | {"findings": [], "verdict": "no-leak-found"}, "en")),
        "hostile-en": html(outline(harm, "en", title=HOSTILE[0], earlier=Earlier(harm, HOSTILE[1], "0" * 64)), harmful),
        "hostile-de": html(outline(harm, "de")),
    }
    for name, text in said.items():
        (folder / f"{name}.html").write_text(text, "utf-8")
    return {name: folder / f"{name}.html" for name in said}


@pytest.fixture(autouse=True)
def _quiet(browser: WebDriver) -> Iterator[None]:
    """Whatever a test does, the console stays silent."""
    yield
    assert chrome.console(browser) == []


@pytest.mark.parametrize("name", PAGES)
def test_it_asks_nobody_for_anything(browser: WebDriver, pages: dict[str, Path], name: str) -> None:
    address = pages[name].as_uri()
    assert chrome.open_page(browser, address) == [address]
    assert browser.title != "harmed"


def test_a_server_is_asked_for_the_page_and_nothing_else(browser: WebDriver, pages: dict[str, Path]) -> None:
    asked: list[str] = []

    class Handler(SimpleHTTPRequestHandler):
        def log_message(self, *_: Any) -> None:
            asked.append(self.path)

    folder = pages["all-en"].parent
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Handler, directory=folder)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        chrome.open_page(browser, f"http://127.0.0.1:{server.server_address[1]}/all-en.html")
        browser.execute_script("document.querySelector('.drawn').scrollIntoView()")
        server.shutdown()
    assert asked == ["/all-en.html"]


@pytest.mark.parametrize("width", [DESKTOP, PHONE])
@pytest.mark.parametrize("name", PAGES)
def test_nothing_is_wider_than_the_screen(
    browser: WebDriver, pages: dict[str, Path], name: str, width: int, tmp_path: Path
) -> None:
    chrome.open_page(browser, pages[name].as_uri(), width=width)
    chrome.screenshot(browser, tmp_path / f"{name}-{width}.png", width)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
    assert (
        chrome.wider(browser, "article.way > p, article.way li, h1, h2, h3, h4, main > section > p, .law, .verdict")
        == []
    )


@pytest.mark.parametrize(("width", "height"), [(DESKTOP, 900), (PHONE, 844)])
@pytest.mark.parametrize("name", ["care-en", "care-de", "all-en", "hospital-de"])
def test_the_first_decision_lies_within_the_first_screen(
    browser: WebDriver, pages: dict[str, Path], name: str, width: int, height: int
) -> None:
    """What is to be decided, about what and whose data, can be read without moving the page."""
    chrome.open_page(browser, pages[name].as_uri(), width=width)
    first = browser.execute_script("return document.querySelector('ol.decide > li').getBoundingClientRect().toJSON()")
    assert 0 < first["top"] < first["bottom"] <= height


@pytest.mark.parametrize("width", [DESKTOP, PHONE])
@pytest.mark.parametrize("name", ["all-en", "fleet-en", "hospital-de"])
def test_links_of_a_card_can_be_met_by_a_finger(
    browser: WebDriver, pages: dict[str, Path], name: str, width: int
) -> None:
    """Each takes 24 pixels each way, as WCAG 2.2 has it (2.5.8), and none lies on another."""
    chrome.open_page(browser, pages[name].as_uri(), width=width)
    boxes = browser.execute_script(
        "return [...document.querySelectorAll('ol.decide a')].map((link) => link.getBoundingClientRect().toJSON())"
    )
    assert boxes
    assert [box for box in boxes if min(box["width"], box["height"]) < 24] == []
    for one, other in combinations(boxes, 2):
        beside = one["right"] <= other["left"] or other["right"] <= one["left"]
        assert beside or one["bottom"] <= other["top"] or other["bottom"] <= one["top"]


@pytest.mark.parametrize("name", ["care-en", "all-en", "open-de", "hospital-de", "hostile-en"])
def test_every_link_leads_to_what_can_be_seen(browser: WebDriver, pages: dict[str, Path], name: str) -> None:
    address = pages[name].as_uri()
    chrome.open_page(browser, address)
    found = browser.execute_script("""
      return [...document.querySelectorAll("a")].map((link) => {
        link.click();
        const target = document.querySelector(":target");
        const box = target && target.getBoundingClientRect();
        return [link.getAttribute("href"), Boolean(box) && box.width > 0 && box.bottom > 0 && box.top < innerHeight];
      });
    """)
    assert len(found) > 12
    assert [link for link, seen in found if not seen] == []
    assert browser.execute_script("return location.pathname").endswith(f"/{name}.html")


def shown(browser: WebDriver) -> list[str]:
    """Ids of the entries that can be seen."""
    script = "return [...document.querySelectorAll('article.way')].filter((a) => a.offsetParent).map((a) => a.id)"
    return list(browser.execute_script(script))


def fill(browser: WebDriver, name: str, value: str) -> None:
    browser.execute_script(
        "const field = document.getElementById('filters').elements[arguments[0]]; field.value = arguments[1];"
        "field.dispatchEvent(new Event('input', {bubbles: true}))",
        name,
        value,
    )


def test_search_and_filters_find_what_they_should(browser: WebDriver, pages: dict[str, Path]) -> None:
    from selenium.webdriver.support.wait import WebDriverWait

    chrome.open_page(browser, pages["all-en"].as_uri())
    document = with_decisions(with_outside(care()))
    every = [f"way-{finding['id']}" for finding in document["findings"]]
    assert sorted(shown(browser)) == sorted(every)
    status = browser.find_element("id", "shown")
    assert status.text == "4 of 4 shown"
    search = browser.find_element("id", "by-words")
    search.send_keys("microphone POLICY.xml:97")  # all words, in any order, upper and lower case alike
    assert shown(browser) == [every[2]]
    assert status.text == "1 of 4 shown"
    search.clear()
    fill(browser, "words", "")
    for name, value, ids in (
        ("category", "Video", {every[1], every[3]}),
        ("article9", "conditional", {every[0]}),
        ("state", "accepted", {every[0]}),
        ("state", "decided", {every[1]}),
        ("kind", "storage-limitation", {every[3]}),
    ):
        fill(browser, name, value)
        assert set(shown(browser)) == ids, name
        fill(browser, name, "")
    fill(browser, "words", "nothing has this")
    assert shown(browser) == []
    browser.find_element("css selector", "#filters button").click()
    WebDriverWait(browser, 60).until(lambda _: len(shown(browser)) == 4)  # fields are empty after the event only


def test_a_link_to_what_is_filtered_away_shows_it_again(browser: WebDriver, pages: dict[str, Path]) -> None:
    chrome.open_page(browser, pages["care-en"].as_uri())
    fill(browser, "words", "microphone")
    assert len(shown(browser)) == 1
    way = f"way-{care()['findings'][0]['id']}"
    browser.execute_script("document.querySelector(`a[href='#${arguments[0]}']`).click()", way)
    browser.execute_async_script("setTimeout(arguments[0], 100)")
    assert len(shown(browser)) == 3
    assert (
        0
        <= browser.execute_script("return document.getElementById(arguments[0]).getBoundingClientRect().top", way)
        < 900
    )


def test_the_inventory_can_be_searched(browser: WebDriver, pages: dict[str, Path]) -> None:
    chrome.open_page(browser, pages["care-en"].as_uri())
    browser.find_element("id", "find-elements").send_keys("recorder")
    rows = browser.execute_script("""
      const rows = [...document.querySelectorAll("#elements tbody tr")];
      return rows.filter((row) => row.offsetParent).map((row) => row.textContent)
    """)
    assert rows
    assert all("recorder" in row for row in rows)


def test_answers_are_saved_to_a_file_that_the_next_report_reads(
    browser: WebDriver, pages: dict[str, Path], tmp_path: Path
) -> None:
    from selenium.webdriver.support.wait import WebDriverWait

    browser.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)})
    chrome.open_page(browser, pages["care-en"].as_uri())
    finding = care()["findings"][0]["id"]
    typed = {f"risk.{finding}.severity": "high\nfor residents", "sign.purpose": 'care </textarea> "at night"'}
    for key, text in typed.items():
        browser.find_element("css selector", f"textarea[data-field='{key}']").send_keys(text)
    browser.find_element("id", "save").click()
    file = tmp_path / "assessment.json"
    WebDriverWait(browser, 60).until(lambda _: file.is_file())
    answers = read_answers(str(file))
    assert answers.texts == typed
    again = tmp_path / "again.html"
    again.write_text(html(outline(care(), "en", answers=answers)), "utf-8")
    chrome.open_page(browser, again.as_uri())
    script = "return document.querySelector(`textarea[data-field='${arguments[0]}']`).value"
    assert {key: browser.execute_script(script, key) for key in typed} == typed


def test_what_was_typed_is_printed(browser: WebDriver, pages: dict[str, Path]) -> None:
    from pypdf import PdfReader

    chrome.open_page(browser, pages["care-en"].as_uri())
    browser.find_element("css selector", "textarea[data-field='sign.purpose']").send_keys("nightcare\n" * 30 + "theend")
    text = "".join("".join(page.extract_text().split()) for page in PdfReader(BytesIO(chrome.pdf(browser))).pages)
    assert text.count("nightcare") == 30  # all of it, and once
    assert "theend" in text


def test_without_javascript_everything_is_shown(browser: WebDriver, pages: dict[str, Path]) -> None:
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        chrome.open_page(browser, pages["care-en"].as_uri())
        assert not browser.find_element("id", "filters").is_displayed()
        assert all(way.is_displayed() for way in browser.find_elements("css selector", "article.way"))
    finally:
        browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})


def test_it_can_be_used_with_the_keyboard_alone(browser: WebDriver, pages: dict[str, Path]) -> None:
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.keys import Keys

    chrome.open_page(browser, pages["all-en"].as_uri())
    ActionChains(browser).send_keys(Keys.TAB).perform()
    assert browser.switch_to.active_element.get_attribute("class") == "skip"
    assert browser.switch_to.active_element.rect["x"] >= 0  # it comes into sight
    ActionChains(browser).send_keys(Keys.ENTER, Keys.TAB).perform()
    assert browser.execute_script("return document.activeElement.closest('main') !== null")
    reached = set()
    for _ in range(160):
        reached.add(browser.execute_script("return document.activeElement.id || document.activeElement.className"))
        ActionChains(browser).send_keys(Keys.TAB).perform()
    assert {"by-words", "by-category", "by-state", "find-elements", "scroll", "drawn", "long"} <= reached


LOOKED_AT = ["care-de", "all-en", "open-de", "fleet-en", "hospital-de", "none-en", "hostile-en"]
LOOKS = [(name, dark) for i, name in enumerate(LOOKED_AT) for dark in (i % 2 == 0, i % 2 == 1)]


@pytest.mark.parametrize(  # CI looks at each page once, by turns dark and light; each week at both
    ("name", "dark"),
    [pytest.param(*look, marks=pytest.mark.thorough if i % 2 else ()) for i, look in enumerate(LOOKS)],
)
def test_it_is_accessible(browser: WebDriver, pages: dict[str, Path], name: str, tmp_path: Path, *, dark: bool) -> None:
    """WCAG 2.1 A and AA and best practices, as axe checks them: contrast, headings, landmarks, names, tables."""
    chrome.open_page(browser, pages[name].as_uri(), dark=dark)
    if dark:
        chrome.screenshot(browser, tmp_path / f"{name}-dark.png", DESKTOP)
    background = browser.execute_script("return getComputedStyle(document.body).backgroundColor")
    assert (background == "rgb(255, 255, 255)") is not dark
    browser.execute_script("document.querySelectorAll('article').forEach((a) => a.style.contentVisibility = 'visible')")
    browser.execute_script(files("axe_core_python").joinpath("axe.min.js").read_text("utf-8"))
    result = browser.execute_async_script("axe.run(document, {resultTypes: ['violations']}).then(arguments[0])")
    faults = [(row["id"], [node["html"][:120] for node in row["nodes"][:3]]) for row in result["violations"]]
    assert faults == []
    assert len(result["passes"]) > 20


@pytest.mark.parametrize("name", PAGES)
def test_on_paper_nothing_is_cut_off(browser: WebDriver, pages: dict[str, Path], name: str) -> None:
    chrome.open_page(browser, pages[name].as_uri(), width=PAPER, paper=True)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= PAPER
    assert chrome.wider(browser, "main, main :not(svg *), header, nav") == []


@pytest.mark.parametrize("name", ["care-en", "all-en", "hostile-en"])
def test_it_prints_whole_on_a4(browser: WebDriver, pages: dict[str, Path], name: str, tmp_path: Path) -> None:
    from pypdf import PdfReader

    chrome.open_page(browser, pages[name].as_uri())
    fill(browser, "words", "nothing has this")  # what is filtered away on the screen is printed all the same
    data = chrome.pdf(browser)
    (tmp_path / f"{name}.pdf").write_bytes(data)
    reader = PdfReader(BytesIO(data))
    assert {(round(p.mediabox.width / 72, 1), round(p.mediabox.height / 72, 1)) for p in reader.pages} == {
        (round(A4[0], 1), round(A4[1], 1))
    }
    text = "".join("".join(normalize("NFKC", page.extract_text()).split()) for page in reader.pages)
    ids = browser.execute_script("return [...document.querySelectorAll('article .id .name')].map((n) => n.textContent)")
    assert len(ids) >= 3
    assert [finding for finding in ids if finding not in text] == []
    for section in browser.execute_script(
        "return [...document.querySelectorAll('h2, caption')].map((n) => n.textContent)"
    ):
        if not any(bidirectional(letter) in ("R", "AL") for letter in section):  # these come out in another order
            assert "".join(section.split()) in text, section
    assert f"1/{len(reader.pages)}" in text
    assert "nothinghasthis" not in text


PICTURE = """
const picture = document.querySelector("article figure.picture svg"); picture.scrollIntoView();
const box = picture.getBoundingClientRect(), frame = picture.parentElement.getBoundingClientRect();
const letters = [...picture.querySelectorAll("text")].map((text) => text.getBoundingClientRect().height);
return [box.width, box.right, frame.right, Math.min(...letters), picture.getAttribute("aria-label")];
"""


@pytest.mark.parametrize("name", ["all-en", "open-de"])
def test_a_picture_fits_the_page_and_can_be_read(browser: WebDriver, pages: dict[str, Path], name: str) -> None:
    for width, paper in ((DESKTOP, False), (PHONE, False), (PAPER, True)):
        chrome.open_page(browser, pages[name].as_uri(), width=width, paper=paper)
        wide, right, frame, letters, label = browser.execute_script(PICTURE)
        assert wide > 100
        assert frame <= width
        assert right <= width or width == PHONE  # what is wide is moved inside its frame
        assert letters >= 9
        assert label.startswith(("Picture of the path: /", "Bild des Weges: /"))


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_lines_and_letters_of_pictures_have_the_colour_of_the_page(
    browser: WebDriver, pages: dict[str, Path], *, dark: bool
) -> None:
    chrome.open_page(browser, pages["open-de"].as_uri(), dark=dark)
    shown = browser.execute_script("""
      const style = (node) => getComputedStyle(node);
      const boxes = [...document.querySelectorAll("figure.picture :is(ellipse, polygon)[stroke=currentColor]")];
      return [boxes.map((box) => style(box).stroke), style(document.body).color];
    """)
    assert len(shown[0]) > 3
    assert set(shown[0]) == {shown[1]}


@pytest.mark.parametrize("name", ["all-en", "hostile-en"])
def test_there_is_a_picture_of_each_way_or_a_word_how_to_get_it(
    browser: WebDriver, pages: dict[str, Path], name: str
) -> None:
    chrome.open_page(browser, pages[name].as_uri())
    without = browser.execute_script("""
      return [...document.querySelectorAll("article.way")].filter((way) => !way.querySelector("figure.picture svg"))
        .map((way) => way.textContent.includes(`rosprivacy graph … --finding ${way.id.replace("way-", "")}`));
    """)
    assert all(without)
    said = browser.execute_script("return document.querySelector('#findings').textContent")
    assert ("of the paths below have no picture" in said) == bool(without)
    assert browser.execute_script("return document.querySelectorAll('figure.picture svg').length") >= 2
