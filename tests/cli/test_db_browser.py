"""``db browser``: what it prints and writes, and that the Neo4j Browser takes it: a real server, a real Chromium."""

from __future__ import annotations

import io
import json
import re
import zipfile
from contextlib import suppress
from typing import TYPE_CHECKING

import pytest

from rosprivacy.private_neo4j import connection
from rosprivacy.private_neo4j.browser_files import DASHBOARD, QUERIES, STYLE
from rosprivacy.queries.library import pack
from rosprivacy.queries.run import run as ask
from rosprivacy.queries.saved import dashboard, saved
from rosprivacy.report.pictures.looks import GRAY, LINE_LOOKS, RED, ROLE_LOOKS, SKY
from tests.helpers import browser as chrome
from tests.helpers.command import run
from tests.helpers.daily import one_in
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli

HOME = ROOT / "examples" / "care-home"
MIDDLE = (700, 500)
SECONDS, TIMES = 120, 4
SAVED = "return localStorage.getItem('neo4j.documents') || ''"
CIRCLES = """
return Object.fromEntries([...document.querySelectorAll('g.node')].map((node) => {
  const circle = node.querySelector('circle.b-outline');
  const name = [...node.querySelectorAll('text')].map((text) => text.textContent).join('').replace(/\\s/g, '');
  return [name, [circle.getAttribute('fill'), circle.getAttribute('stroke')]];
}));
"""


@pytest.fixture
def loaded(private_neo4j: Connection) -> Connection:
    """The private server with the care home."""
    with connection.open_driver(private_neo4j) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
    policy, labels = HOME / "care-home.policy.xml", HOME / "care-home.labels.yaml"
    assert run("load", policy, "-l", labels, "--robot", "h1").returncode == 0
    return private_neo4j


@pytest.fixture
def page(tmp_path: Path) -> Iterator[WebDriver]:
    with chrome.chromium(tmp_path / "profile", chrome.HERE_ONLY) as found:
        yield found


@pytest.mark.slow
@pytest.mark.database
@pytest.mark.parametrize("folder", one_in(2, ["", "of my own"]))
def test_it_writes_the_files_and_says_where_everything_is(
    cli: Cli, loaded: Connection, tmp_path: Path, folder: str
) -> None:
    """The password is never printed, only where it is kept."""
    named = ("--files", tmp_path / folder) if folder else ()
    done = cli("db", "browser", *named, DISPLAY="", WAYLAND_DISPLAY="")
    assert done.returncode == 0
    assert done.stderr == "There is no desktop to open the page on; open its address yourself\n"
    assert cli("db", "browser", "--no-open", *named).stderr == ""
    status = connection.status()
    files = tmp_path / folder if folder else status.folder / "browser"
    assert f"Browser:   {status.browser}?dbms=bolt://neo4j@{loaded.uri.removeprefix('bolt://')}&" in done.stdout
    assert f"Password:  in {status.password_file}" in done.stdout
    assert f"Files:     {files}\n" in done.stdout
    assert loaded.password not in done.stdout
    assert sorted(file.name for file in files.iterdir()) == sorted([STYLE, QUERIES, DASHBOARD])
    with zipfile.ZipFile(io.BytesIO((files / QUERIES).read_bytes())) as archive:
        assert archive.namelist() == [f"rosprivacy/{name}.cypher" for name in pack()]


@pytest.mark.database
def test_a_folder_that_cannot_be_made_is_2_and_one_line(cli: Cli, private_neo4j: Connection, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    done = cli("db", "browser", "--no-open", "--files", tmp_path / "file" / "folder")
    assert private_neo4j
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert "name another with --files" in done.stderr


@pytest.mark.slow
@pytest.mark.database
def test_every_saved_query_runs_as_it_is_and_gives_what_the_pack_gives(loaded: Connection) -> None:
    """Defaults stand in the place of parameters; what has none is asked for by name in its first lines."""
    with connection.open_driver(loaded) as driver:
        for query in pack().values():
            open_ones = [field.name for field in query.parameters if field.default is None]
            text = saved(query)
            assert re.findall(r"^// first: :param (\w+) ", text, re.MULTILINE) == open_ones
            given = dict.fromkeys(open_ones, "/camera")
            assert ask(driver, text, given).rows == ask(driver, query.text, query.values(given)).rows, query.name


@pytest.mark.database
def test_every_table_of_the_dashboard_runs_and_is_the_answer_of_the_pack(loaded: Connection) -> None:
    """On a page no table lies on another, and each page says that this is no verdict of law."""
    whole = json.loads(dashboard(pack()))
    with connection.open_driver(loaded) as driver:
        for shown in whole["pages"]:
            about, *tables = shown["reports"]
            assert (about["type"], "no legal verdict" in about["query"]) == ("text", True)
            ends = [table["y"] + table["height"] for table in shown["reports"]]
            assert [table["y"] for table in tables] == ends[:-1]
            for table in tables:
                query = pack()[table["id"]]
                assert ask(driver, table["query"]).rows == ask(driver, query.text, query.values({})).rows, table["id"]


@pytest.mark.thorough  # Neo4j's own page, which changes with its version only
@pytest.mark.browser
@pytest.mark.database
def test_the_browser_takes_colours_and_questions(loaded: Connection, page: WebDriver, tmp_path: Path) -> None:
    """As a person does it: the printed address, the password, both files dropped, the query that is there run."""
    from selenium.common.exceptions import TimeoutException
    from selenium.webdriver.common.by import By
    from selenium.webdriver.support.ui import WebDriverWait

    wait = WebDriverWait(page, SECONDS)
    said = run("db", "browser", "--no-open", "--files", tmp_path / "files").stdout
    (address,) = re.findall(r"^Browser:   (.+)$", said, re.MULTILINE)
    chrome.open_page(page, address, width=1400)

    def there(selector: str) -> object:
        return wait.until(lambda browser: browser.find_elements(By.CSS_SELECTOR, selector))

    there("input[type=password]")
    assert page.find_element(By.CSS_SELECTOR, "[data-testid=username]").get_property("value") == "neo4j"
    page.find_element(By.CSS_SELECTOR, "input[type=password]").send_keys(loaded.password)
    page.find_element(By.CSS_SELECTOR, "[data-testid=connect]").click()
    wait.until(lambda browser: "neo4j$" in browser.find_element(By.TAG_NAME, "body").text, "not connected")
    chrome.drop(page, tmp_path / "files" / STYLE, MIDDLE)
    there("[data-testid=styleResetButton]")
    for _ in range(TIMES):  # a busy page can miss one, and a person drops it again
        chrome.drop(page, tmp_path / "files" / QUERIES, MIDDLE)
        with suppress(TimeoutException):
            WebDriverWait(page, SECONDS / TIMES).until(
                lambda browser: "leak-path-graph" in browser.execute_script(SAVED)
            )
            break
    wait.until(lambda browser: not browser.find_elements(By.CSS_SELECTOR, ".has-file-hovering"))

    page.find_element(By.CSS_SELECTOR, "[data-testid=editor-Run]").click()
    circles = wait.until(lambda browser: browser.execute_script(CIRCLES), "no graph is drawn")
    outlines = {role: ROLE_LOOKS[role].colour for role in ("source", "leak")}
    assert circles["/camera"] == [GRAY, outlines["source"]] == [GRAY, SKY]
    assert circles["/recorder"] == [GRAY, outlines["leak"]] == [GRAY, RED]
    assert circles["/scan"][0] == SKY
    chrome.screenshot(page, tmp_path / "graph.png", 1400)
    assert LINE_LOOKS["data"].colour in page.execute_script(
        "return [...document.querySelectorAll('g.relationship path')].map((path) => path.getAttribute('fill'))"
    )

    page.find_element(By.CSS_SELECTOR, "[data-testid=navigationFavorites]").click()
    there("[data-testid=expandFolder-rosprivacy]")
    page.find_element(By.CSS_SELECTOR, "[data-testid=expandFolder-rosprivacy]").click()
    there("[data-testid^=scriptTitle-]")
    listed = {title.text for title in page.find_elements(By.CSS_SELECTOR, "[data-testid^=scriptTitle-]")}
    assert listed == {f"{query.name}: {query.description}" for query in pack().values()}
    chrome.screenshot(page, tmp_path / "questions.png", 1400)
