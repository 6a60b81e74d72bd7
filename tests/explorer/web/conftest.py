"""What tests of the page share."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import pytest

from tests.helpers import browser as chrome
from tests.helpers.explorers import Explorer

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from selenium.webdriver.chrome.webdriver import WebDriver


@pytest.fixture
def explore() -> Iterator[Callable[..., Explorer]]:
    """Opens explorers, and closes what draws their pictures."""
    with ExitStack() as opened:

        def made(*files: Any, **how: Any) -> Explorer:
            explorer = Explorer(*files, **how)
            opened.callback(explorer.site.close)
            opened.callback(explorer.session.close)
            return explorer

        yield made


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[WebDriver]:
    """A Chromium that reaches this machine only."""
    with chrome.chromium(tmp_path_factory.mktemp("profile"), chrome.HERE_ONLY) as found:
        yield found


@pytest.fixture
def quiet(browser: WebDriver) -> Iterator[None]:
    """Whatever a test does, the console stays silent, and only our own server is asked."""
    yield
    assert chrome.console(browser) == []
    asked = {urlsplit(address).netloc for address in chrome.requests(browser)}
    assert {host.partition(":")[0] for host in asked} <= {"127.0.0.1"}
