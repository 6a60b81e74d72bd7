"""A person before the explorer's page in a real Chromium, who has nothing but keys; and what a saved file means."""

from __future__ import annotations

import json
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.explorer.web.guard import RequestDoor
from tests.helpers import browser as chrome
from tests.helpers import explorers
from tests.helpers.browser import DESKTOP, PHONE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

    from tests.helpers.explorers import Explorer

SECONDS = 90
MOST_TABS = 200
PANES = ("list", "picture", "element")
CURRENT = "const a = document.querySelector('#rows [aria-current] .name'); return a ? a.textContent : ''"
SETTLED = "return !document.body.hasAttribute('aria-busy')"
TOLD = "h1, h2:not(.unseen), h3, p:not(.unseen), .row, .way, .answers, .about label, .hops li, .said li, .try, .decide"
BUTTONS = ".answers, .tabs, .inline, .decide, #tries, .verbs"
SMALL = """
return [...document.querySelectorAll(`.row, .way, .answers summary, :is(${arguments[0]}) button`)]
  .filter((e) => e.offsetParent && e.getBoundingClientRect().height < 44).map((e) => e.textContent);
"""
OPENED = "for (const one of document.querySelectorAll('main details')) one.open = true"
MEANS = ("verdict", "findings", "open", "roles", "carries", "sanitizers", "derivations")


@contextmanager
def served(browser: WebDriver, policy: Path, labels: Path, **how: Any) -> Iterator[Explorer]:
    """The page on a server that ends after the page was left: it would be asked once more."""
    with explorers.served(policy, labels, **how) as explorer:
        yield explorer
        browser.get("about:blank")


class Reader:
    """A person who has nothing but keys, and has opened the link."""

    def __init__(self, browser: WebDriver, explorer: Explorer | RequestDoor, width: int = DESKTOP) -> None:
        self.browser, self.width = browser, width
        door = explorer if isinstance(explorer, RequestDoor) else explorer.door
        chrome.open_page(browser, door.link, width=width)

    def press(self, *keys: str) -> None:
        """Press keys one after the other; after each, what it began is waited for."""
        from selenium.webdriver import ActionChains
        from selenium.webdriver.support.ui import WebDriverWait

        for key in keys:
            ActionChains(self.browser).send_keys(key).perform()
            WebDriverWait(self.browser, SECONDS, 0.02).until(lambda b: b.execute_script(SETTLED))

    def accept(self) -> None:
        """Sign an acceptance without an end from its reason on, and say yes where the page asks again."""
        from selenium.webdriver.common.keys import Keys

        self.press(*"inside", Keys.TAB, *"A. Lee", Keys.ENTER)
        (message,) = chrome.console(self.browser)  # Chromium tells of every 409
        assert "409" in message["message"]
        self.focus("#decide [name=reason]")
        self.press(Keys.ENTER)

    def save(self) -> None:
        """Press Ctrl+S, and see that it was saved."""
        before = self.version
        self.press_save()
        self.wait(before + 1)

    def press_save(self) -> None:
        """Press Ctrl+S, whatever comes of it."""
        from selenium.webdriver import ActionChains
        from selenium.webdriver.common.keys import Keys

        ActionChains(self.browser).key_down(Keys.CONTROL).send_keys("s").key_up(Keys.CONTROL).perform()
        self.press()

    def wait(self, version: int) -> None:
        """Wait until a version of the session is on the page."""
        from selenium.webdriver.support.ui import WebDriverWait

        shown = f"return document.body.dataset.version === '{version}'"
        WebDriverWait(self.browser, SECONDS, 0.02).until(lambda b: b.execute_script(shown))

    def answer(self, name: str, *keys: str) -> None:
        """Go to an element of the list, answer, and see that the answer counts."""
        self.go(name)
        before = self.version
        self.press(*keys)
        self.wait(before + 1)

    def go(self, name: str) -> None:
        """Go to an element with ``j`` and ``k``, or, where nobody asks about it, by its name."""
        for key in ("k", "j"):
            at = None
            while self.current not in (name, at):
                at = self.current
                self.press(key)
        if self.current != name:
            self.find(name)
        assert self.current == name

    def find(self, name: str) -> None:
        """Go to an element by its name, with ``/``."""
        self.press("/", *name, "\n")
        assert self.current == name

    def say(self, name: str, *keys: str) -> None:
        """Answer as ``answer`` does, of an element that is found by its name."""
        self.find(name)
        before = self.version
        self.press(*keys)
        self.wait(before + 1)

    def tab_to(self, selector: str) -> None:
        """Press Tab until it leads to an element."""
        from selenium.webdriver.common.keys import Keys

        for _ in range(MOST_TABS):
            self.press(Keys.TAB)
            if self.browser.execute_script("return document.activeElement.matches(arguments[0])", selector):
                return
        raise AssertionError(f"no key leads to {selector}")

    def focus(self, selector: str) -> None:
        self.browser.execute_script("document.querySelector(arguments[0]).focus()", selector)

    def pane(self, name: str) -> None:
        """Show one pane, as a narrow screen does."""
        self.browser.execute_script(f"document.querySelector('.tabs [data-pane={name}]').click()")

    def faults(self) -> list[object]:
        """What is wrong with the panes as they stand, with all that can be opened: for axe, a thumb, the width."""
        found: list[object] = []
        narrow = self.width <= PHONE
        self.browser.execute_script(OPENED)
        for pane in PANES if narrow else ("all",):
            if narrow:
                self.pane(pane)
            for dark in (False, True):
                chrome.shade(self.browser, dark=dark)
                found += chrome.axe(self.browser)
            sideways = self.browser.execute_script("return document.documentElement.scrollWidth")
            found += [f"{pane} is {sideways} wide"] if sideways > self.width else []
            if narrow:
                found += [*self.browser.execute_script(SMALL, BUTTONS), *chrome.wider(self.browser, TOLD)]
        chrome.shade(self.browser, dark=False)
        return found

    @property
    def version(self) -> int:
        return int(self.browser.execute_script("return document.body.dataset.version"))

    @property
    def current(self) -> str:
        """The element that is chosen in the list; empty if none is."""
        return str(self.browser.execute_script(CURRENT))

    @property
    def verdict(self) -> str:
        return str(self.browser.execute_script("return document.querySelector('.verdict').classList[1]"))

    @property
    def focused(self) -> str:
        return str(self.browser.execute_script("return document.activeElement.className"))

    def text(self, selector: str) -> str:
        return str(self.browser.execute_script("return document.querySelector(arguments[0]).textContent", selector))


def meaning(policy: Path, labels: Path, keys: Iterable[str] = MEANS) -> Any:
    """What a label file means for a policy, without where it stands: what the document says under some keys."""
    document = rosprivacy.analyze(policy, labels).document()
    return json.loads(json.dumps({key: document[key] for key in keys}), object_hook=_without_place)


def _without_place(said: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in said.items() if key not in ("file", "line")}
