"""A real Chromium for tests: Debian's, driven by selenium; pages come from files or from this machine."""

from __future__ import annotations

import base64
import json
import shutil
from contextlib import contextmanager
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

DESKTOP, PHONE = 1280, 390
# Of pages that are looked at in both widths CI takes the narrow one, in which less fits; each week takes both.
WIDTHS: list[Any] = [pytest.param(DESKTOP, marks=pytest.mark.thorough), PHONE]
PAPER = 672  # CSS pixels between the margins of an upright A4 page
PROGRAMS = ("chromium", "chromedriver")
HERE_ONLY = "host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1"  # no other host is there
A4 = (8.27, 11.69)  # inches
WIDER = """
return [...document.querySelectorAll(arguments[0])]
  .filter((node) => node.scrollWidth > node.clientWidth + 1 || node.getBoundingClientRect().right > innerWidth + 1)
  .map((node) => `${node.tagName}.${node.className}: ${node.textContent.slice(0, 60)}`);
"""


def missing() -> list[str]:
    """Programs that are not installed."""
    return [name for name in PROGRAMS if shutil.which(name) is None]


@contextmanager
def chromium(folder: Path, *more: str) -> Iterator[WebDriver]:
    """A browser with logs of the console and of all requests, and a profile of its own in a folder.

    ``more`` are further arguments, such as ``HERE_ONLY``. Where no browser is installed, the test is skipped.
    """
    if absent := missing():
        pytest.skip(f"NO BROWSER ({', '.join(absent)} missing): apt-get install chromium chromium-driver")
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    program, driver = (shutil.which(name) for name in PROGRAMS)
    options = webdriver.ChromeOptions()
    options.binary_location = str(program)
    arguments = ("headless=new", "no-sandbox", "disable-gpu", "disable-dev-shm-usage", "hide-scrollbars")
    quiet = ("disable-background-networking", "disable-component-update", "disable-sync", "no-first-run")
    for argument in (*arguments, *quiet, f"user-data-dir={folder}", *more):
        options.add_argument(f"--{argument}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(options=options, service=Service(str(driver)))
    try:
        yield browser
    finally:
        browser.quit()


def open_page(
    browser: WebDriver, address: str, *, width: int = DESKTOP, dark: bool = False, paper: bool = False
) -> list[str]:
    """Open a page; return the addresses that it asked for, itself first. What is in the page counts as no request."""
    from selenium.webdriver.support.wait import WebDriverWait

    shade(browser, dark=dark, paper=paper)
    size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < DESKTOP and not paper}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    browser.get("about:blank")
    browser.get_log("performance")  # type: ignore[no-untyped-call]
    browser.get_log("browser")  # type: ignore[no-untyped-call]
    browser.get(address)
    there = "return !location.pathname.startsWith('/enter') && document.readyState === 'complete'"
    WebDriverWait(browser, 30, 0.02).until(lambda b: b.execute_script(there))  # the link leads on to the page
    return requests(browser)


def shade(browser: WebDriver, *, dark: bool, paper: bool = False) -> None:
    """Show what is open as somebody sees it who likes it dark, or light; or as it is printed."""
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print" if paper else "", "features": [scheme]})


def requests(browser: WebDriver) -> list[str]:
    """Return the addresses that were asked for since the last look."""
    messages = [json.loads(row["message"])["message"] for row in browser.get_log("performance")]  # type: ignore[no-untyped-call]
    asked = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
    return [address for address in asked if not address.startswith(("data:", "chrome:", "about:"))]


def console(browser: WebDriver) -> list[Any]:
    """Return what the console said since the last look."""
    return list(browser.get_log("browser"))  # type: ignore[no-untyped-call]


def screenshot(browser: WebDriver, file: Path, width: int, highest: int = 16_000) -> None:
    """Save the whole page as a picture."""
    browser.execute_script("document.querySelectorAll('article').forEach((a) => a.style.contentVisibility = 'visible')")
    height = browser.execute_script("return document.documentElement.scrollHeight")
    clip = {"x": 0, "y": 0, "width": width, "height": min(height, highest), "scale": 1}
    shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
    file.write_bytes(base64.b64decode(shot["data"]))


def pdf(browser: WebDriver) -> bytes:
    """Return the page as it is printed."""
    told = {"printBackground": True, "preferCSSPageSize": True}
    return base64.b64decode(browser.execute_cdp_cmd("Page.printToPDF", told)["data"])


def wider(browser: WebDriver, selector: str) -> list[str]:
    """Return the elements that are wider than their box or the page."""
    return list(browser.execute_script(WIDER, selector))


def axe(browser: WebDriver) -> list[tuple[str, str]]:
    """Return what axe finds of WCAG 2.1 A and AA and of best practices: the rule, and the first element."""
    if not browser.execute_script("return window.axe !== undefined"):
        browser.execute_script(files("axe_core_python").joinpath("axe.min.js").read_text("utf-8"))
    found = browser.execute_async_script("axe.run(document, {resultTypes: ['violations']}).then(arguments[0])")
    return [(one["id"], one["nodes"][0]["html"]) for one in found["violations"]]


def drop(browser: WebDriver, file: Path, at: tuple[int, int]) -> None:
    """Drag a file onto the page and let it go, as the system tells the browser of it."""
    data = {"items": [], "files": [str(file)], "dragOperationsMask": 1}
    for what in ("dragEnter", "dragOver", "drop"):
        browser.execute_cdp_cmd("Input.dispatchDragEvent", {"type": what, "x": at[0], "y": at[1], "data": data})
