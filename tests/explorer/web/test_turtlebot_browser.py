"""The paper's six rounds on TurtleBot3 in a real Chromium, by keys alone: the page says what the command says."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import rosprivacy
from tests.helpers.page_reader import Reader, meaning, served
from tests.helpers.papers_rounds import ROUNDS, labels_of, papers_round, said_first
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.corpus, pytest.mark.usefixtures("quiet")]
WAYS = "return [...document.querySelectorAll('#rows .way')].map((e) => e.textContent).length"
SHOWN = "return document.querySelector('#head .verdict p').textContent"


def keys(role: str) -> tuple[str, ...]:
    """The keys that say a role of laser scans; what passes data on, or channels carry, is said of all."""
    from selenium.webdriver.common.keys import Keys

    letters = {"leak": ("l",), "conduit": ("0", "c"), "sensitive": ("0", "v"), "mundane": ("0", "m")}
    return letters.get(role, ("s", *"laser", Keys.TAB, Keys.ENTER))


def test_the_six_rounds_by_keys_alone(browser: WebDriver, corpus: Path, tmp_path: Path) -> None:
    policy, by_hand, labels = corpus / TURTLEBOT3, tmp_path / "hand.labels.yaml", tmp_path / "new.labels.yaml"
    found = []
    with served(browser, policy, labels) as explorer:
        reader = Reader(browser, explorer)
        for number in range(ROUNDS):
            for role, name in said_first(corpus, number):
                reader.say(name, *keys(role))
            by_hand.write_text(labels_of(papers_round(corpus, number)), "utf-8")
            document = rosprivacy.analyze(policy, by_hand).document()
            standing = [finding for finding in document["findings"] if not finding["dismissed"]]
            left = {(asked["element"]["kind"], asked["element"]["name"]) for asked in document["open"]}
            exits = len({finding["leak"]["name"] for finding in standing})
            assert reader.verdict == document["verdict"]
            assert browser.execute_script(WAYS) == len(standing)
            told = browser.execute_script(SHOWN)
            assert told.startswith(f"{len(left)} elements are left to decide")
            assert (f"{exits} place" in told) == bool(exits)
            found.append(len(standing))
            reader.save()
            assert meaning(policy, labels) == meaning(policy, by_hand)
    assert found == [0, 1, 1, 1, 2, 4]
