"""The care home with its five kinds of data in a real Chromium, by keys alone, kind by kind with the switches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers.page_reader import MEANS, Reader, meaning, served
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from selenium.webdriver.chrome.webdriver import WebDriver

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.usefixtures("quiet")]
CARE = ROOT / "examples" / "care-home"
POLICY, BY_HAND = CARE / "care-home.policy.xml", CARE / "care-home.labels.yaml"
# What no page asks about: where the system works, whose data it is, and what a single flow carries.
BEGUN = """labels: 1
context: [care]
nodes:
  /camera: {subjects: [residents, staff, visitors]}
  /microphone: {subjects: [residents, staff]}
flows:
  - {from: /navigator, to: /go_to_person, never: [Location]}
"""
KINDS = ["face template", "location", "person track", "video of persons", "voice"]
SWITCHES = """
return [...document.querySelectorAll('.switch')].map((e) => [e.lastChild.textContent.trim(), !e.matches('.off')])
"""
CHOSEN = "#answers [name=about]:checked"


class Carer(Reader):
    """A person who labels the care home."""

    def choose(self, key: str, title: str) -> tuple[str, ...]:
        """Keys of an answer that asks which one: a kind of data, or how it is cleaned."""
        from selenium.webdriver.common.keys import Keys

        return (key, *title, Keys.TAB, Keys.ENTER)

    def say_of(self, name: str, data: str, *keys: str) -> None:
        """Answer about one kind of data that is not asked about there, whatever is chosen beforehand."""
        from selenium.webdriver.common.keys import Keys

        self.find(name)
        before = self.version
        while self.browser.execute_script(f"return document.querySelectorAll('{CHOSEN}').length"):
            self.tab_to(CHOSEN)
            self.press(Keys.SPACE)
        self.tab_to("#answers .other select")
        self.press(*data, Keys.ESCAPE, *keys)
        self.wait(before + 1)

    def only(self, *titles: str) -> None:
        """Leave these kinds of data switched on: the digits are the switches of the legend."""
        for number, (title, on) in enumerate(self.browser.execute_script(SWITCHES), 1):
            if on != (title in titles):
                self.press(str(number))
        assert [title for title, on in self.browser.execute_script(SWITCHES) if on] == sorted(titles)


def test_five_kinds_by_keys_alone(browser: WebDriver, tmp_path: Path) -> None:
    labels = tmp_path / "care.labels.yaml"
    labels.write_text(BEGUN, "utf-8")
    with served(browser, POLICY, labels) as explorer:
        carer = Carer(browser, explorer)
        _video(carer)
        _faces(carer)
        _voice(carer)
        _places(carer)
        assert [title for title, _ in browser.execute_script(SWITCHES)] == KINDS
        carer.save()
        assert carer.verdict == "leak"
        assert explorer.session.questions() == ()
    keys = [key for key in MEANS if key != "roles"]
    keys += ["subjects", "surroundings"]
    assert meaning(POLICY, labels, keys) == meaning(POLICY, BY_HAND, keys)
    assert _roles(labels) == _roles(BY_HAND)


def _video(carer: Carer) -> None:
    carer.say("/camera", *carer.choose("s", "video of"))
    carer.say("/uplink", *carer.choose("z", "sums"))
    carer.say("/face_recognizer", *carer.choose("z", "throws"))
    carer.say("/face_recognizer", *carer.choose("d", "face t"))
    carer.say("/blur", *carer.choose("z", "pseudo"))
    carer.say("/recorder", "l")
    for channel in ("/camera/image", "/camera/blurred", "/camera/*"):
        carer.say(channel, "0", "v")


def _faces(carer: Carer) -> None:
    carer.only("face template")
    for channel in ("/face_recognizer/faces", "/uplink/scene", "/go_to_person", "/notify_staff"):
        carer.say(channel, "0", "v")
    for node in ("/care_planner", "/navigator", "/base", "/display"):
        carer.say(node, "0", "c")
    carer.say_of("/uplink", "biometric", "l")
    carer.say("/cmd_vel", "0", "m")


def _voice(carer: Carer) -> None:
    carer.only("face template", "video of persons")
    carer.say("/microphone", *carer.choose("s", ""))  # as it is suggested
    carer.only("voice")
    carer.say("/audio", "0", "v")
    carer.say("/uplink", "l")


def _places(carer: Carer) -> None:
    carer.say("/lidar", *carer.choose("s", "location"))
    carer.only("location")
    carer.say("/scan", "0", "v")
    carer.say("/rosout", "m")  # no line of the log says where anybody is
    carer.say("/person_tracker", "c")
    carer.say("/person_tracker", *carer.choose("d", "person t"))
    carer.only("person track")
    carer.say("/person_tracker/tracks", "v")
    carer.only("location")  # of which a track is a narrower kind: what was said of that stays
    carer.say("/person_tracker/tracks", "m")
    carer.say_of("/uplink", "location", *carer.choose("z", "throws"))


def _roles(labels: Path) -> dict[tuple[str, str], list[str]]:
    """What each node does with each kind. A limit of a channel is answered as what it carries, and what it does not."""
    rows = [row for row in meaning(POLICY, labels, ["roles"])["roles"] if row["element"]["kind"] == "node"]
    return {(row["element"]["name"], row["category"]): sorted(row["roles"]) for row in rows}
