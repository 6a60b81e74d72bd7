"""The page of questions in a real Chromium: by keys alone, on a phone, for a screen reader, and without its script."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from rosprivacy.explorer.session import Session
from rosprivacy.explorer.web.cypher_site import StoredSite
from rosprivacy.explorer.web.guard import RequestDoor
from rosprivacy.explorer.web.serving import bound_socket, server
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.report.catalogs.words import Words
from rosprivacy.settings import Settings
from tests.helpers import browser as chrome
from tests.helpers.browser import DESKTOP, WIDTHS, axe
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.page_reader import Reader

if TYPE_CHECKING:
    from collections.abc import Iterator

    from selenium.webdriver.chrome.webdriver import WebDriver

    from rosprivacy.private_neo4j.connection import Connection

pytestmark = [pytest.mark.browser, pytest.mark.database, pytest.mark.slow, pytest.mark.xdist_group("neo4j")]
SECONDS = 90
HOSTILE = "<img src=x onerror=alert(1)>\"'</textarea></svg><script>alert(1)</script>"
ROWS = "return document.querySelectorAll('tbody tr').length"
SMALL = """
return [...document.querySelectorAll('#questions a, .ask button, .ask summary, .ask input, header a.button')]
  .filter((e) => e.offsetParent && e.type !== 'hidden' && e.getBoundingClientRect().height < 44)
  .map((e) => e.outerHTML);
"""
FIRST = "return document.querySelector(arguments[0])?.textContent.trim() ?? ''"


@pytest.fixture(scope="module")
def loaded(neo4j_server: Connection) -> Connection:
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        result = care_home()
        load(driver, [rows_of("h1", result)], result.vocabulary)
    return neo4j_server


@contextmanager
def served(browser: WebDriver, to: Connection, language: str = "en") -> Iterator[RequestDoor]:
    """The page on a server that ends after the page was left; the console stays silent, and only it is asked."""
    opens = partial(connection.open_driver, to)
    with opens() as driver:
        session = Session.open_database(driver)
    with bound_socket(0) as listening:
        door = RequestDoor(listening.getsockname()[1], True)
        site = StoredSite(session, Settings(), Words(language), door, opens, 2.0)
        running = server(site.application())
        thread = threading.Thread(target=running.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            yield door
            assert [one["message"] for one in chrome.console(browser) if " 422 " not in one["message"]] == []
            assert {urlsplit(address).hostname for address in chrome.requests(browser)} <= {"127.0.0.1"}
            browser.get("about:blank")
        finally:
            running.should_exit = True
            thread.join()
            site.close()


def press(browser: WebDriver, *keys: str) -> None:
    from selenium.webdriver import ActionChains

    for key in keys:
        ActionChains(browser).send_keys(key).perform()


def until(browser: WebDriver, script: str) -> None:
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(browser, SECONDS, 0.05).until(lambda b: b.execute_script(f"return {script}"))


def test_by_keys_alone_to_a_question_its_rows_and_back(browser: WebDriver, loaded: Connection) -> None:
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.keys import Keys

    with served(browser, loaded) as door:
        chrome.open_page(browser, door.link)
        press(browser, "q")
        until(browser, "location.pathname === '/cypher'")
        until(browser, "document.readyState === 'complete'")
        press(browser, "j")
        while (
            browser.execute_script("return document.activeElement.querySelector('.name').textContent")
            != "leak-path-graph"
        ):
            press(browser, "j")
        press(browser, Keys.ENTER)
        until(browser, "document.activeElement?.value === 'ask'")  # the button has the focus: nothing is needed
        press(browser, Keys.ENTER)
        until(browser, "document.querySelector('#answer svg.picture a.box')")
        rows = browser.execute_script(ROWS)
        assert rows > 2
        until(browser, "document.activeElement?.id === 'answer'")
        press(browser, "e", *"RETURN jjq")
        failing = "document.querySelector('[role=alert]')"
        ActionChains(browser).key_down(Keys.CONTROL).send_keys(Keys.ENTER).key_up(Keys.CONTROL).perform()
        until(browser, failing)
        assert "Variable `jjq` not defined" in browser.execute_script(FIRST, "[role=alert] [lang=en]")
        assert browser.execute_script("return document.querySelector('#text').value") == "RETURN jjq"
        press(browser, "e", Keys.END, *" // no", Keys.ESCAPE)
        assert browser.execute_script("return document.activeElement === document.body")
        press(browser, Keys.ESCAPE)
        until(browser, "location.pathname === '/'")


def test_an_element_leads_to_its_question_and_a_box_to_its_element(browser: WebDriver, loaded: Connection) -> None:
    with served(browser, loaded) as door:
        chrome.open_page(browser, door.link)
        browser.execute_script("document.querySelector('#hand a[href^=\"/cypher?ask=sources\"]').click()")
        until(browser, "location.pathname === '/cypher' && document.readyState === 'complete'")
        name = browser.execute_script("return document.querySelector('[name=p-element]').value")
        browser.execute_script("document.querySelector('.ask button').click()")
        until(browser, "document.querySelector('#answer')")
        assert browser.execute_script(ROWS) > 0
        box = f"MATCH p = (n:Element {{name: '{name}'}})-[:FLOWS_TO]-(m) RETURN p"
        browser.execute_script("document.querySelector('#text').value = arguments[0]", box)
        browser.execute_script("document.querySelector('#text').form.querySelector('button').click()")
        until(browser, "document.querySelector('#answer a.box')")
        browser.execute_script("document.querySelector('#answer a.box').dispatchEvent(new MouseEvent('click'))")
        until(browser, "location.pathname === '/' && location.search.startsWith('?at=')")


def test_hostile_names_stand_on_it_as_text(browser: WebDriver, loaded: Connection) -> None:
    with served(browser, loaded) as door:
        chrome.open_page(browser, door.link)
        browser.get(f"http://127.0.0.1:{door.port}/cypher")
        with connection.open_driver(loaded) as driver:
            driver.execute_query("CREATE (:Robot {name: $name})-[:OWNS]->(:Robot {name: 'x'})", name=HOSTILE)
            try:
                text = f"MATCH p = (r:Robot)-[:OWNS]->() RETURN p, r.name AS n // {HOSTILE}"
                browser.execute_script("document.querySelector('#text').value = arguments[0]", text)
                browser.execute_script("document.querySelector('#text').form.querySelector('button').click()")
                until(browser, "document.querySelector('#answer svg.picture')")
            finally:
                driver.execute_query("MATCH (r:Robot)-[:OWNS]->(s) DETACH DELETE r, s")
        assert browser.execute_script("return document.querySelector('td:last-child').textContent") == HOSTILE
        assert browser.execute_script("return document.querySelector('#text').value") == text
        assert browser.execute_script("return document.querySelectorAll('img, textarea ~ script').length") == 0


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("language", ["en", "de", "fr"])
def test_axe_finds_nothing_and_nothing_is_wider_than_a_phone(
    browser: WebDriver, loaded: Connection, width: int, language: str
) -> None:
    with served(browser, loaded, language) as door:
        chrome.open_page(browser, door.link, width=width)
        for address in ("/cypher", "/cypher?ask=path-between", "/cypher?ask=leak-path-graph"):
            browser.get(f"http://127.0.0.1:{door.port}{address}")
            browser.execute_script("document.querySelectorAll('details').forEach((d) => d.open = true)")
            assert axe(browser) == []
            assert browser.execute_script("return document.documentElement.scrollWidth") <= width
            assert width == DESKTOP or browser.execute_script(SMALL) == []
        browser.execute_script("document.querySelector('.ask button').click()")
        until(browser, "document.querySelector('#answer svg.picture')")
        assert axe(browser) == []
        assert browser.execute_script("return document.documentElement.scrollWidth") <= width
        browser.execute_script("document.querySelector('#text').value = 'CREATE (n)'")
        browser.execute_script("document.querySelector('#text').form.querySelector('button').click()")
        until(browser, "document.querySelector('[role=alert]')")
        assert axe(browser) == []


@pytest.mark.parametrize("width", WIDTHS)
def test_axe_finds_nothing_in_any_pane_of_what_is_stored(browser: WebDriver, loaded: Connection, width: int) -> None:
    with served(browser, loaded) as door:
        reader = Reader(browser, door, width)
        assert "shown, and not changed" in reader.text("body")
        for key in ("", "o", "w"):  # an element, a finding, the whole system
            reader.press(*key)
            assert reader.faults() == []


def test_without_its_script_it_asks_as_well(browser: WebDriver, loaded: Connection) -> None:
    from selenium.webdriver.support.ui import WebDriverWait

    with served(browser, loaded) as door:
        chrome.open_page(browser, door.link)
        browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        try:
            browser.get(f"http://127.0.0.1:{door.port}/cypher?ask=findings")
            browser.find_element("css selector", ".ask button").click()
            wait = WebDriverWait(browser, SECONDS, 0.05)
            wait.until(lambda b: len(b.find_elements("css selector", "tbody tr")) > 2)
            browser.find_element("css selector", ".ask button[value=edit]").click()
            wait.until(lambda b: not b.find_elements("css selector", "[name^=p-]"))
            assert browser.find_element("css selector", "textarea").text.startswith("MATCH (c:DataCategory)")
        finally:
            browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})
