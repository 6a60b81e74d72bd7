"""Screens on the page: the conversation of ``suggest --ask``, with the same order, ticks, keys and label file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
import yaml
from lxml import html

import rosprivacy
from rosprivacy.analysis.suggesting.evidence import HIDING
from rosprivacy.analysis.suggesting.screens import CHANNELS
from rosprivacy.labelling.screen_conversation import ALL, ENTER
from rosprivacy.report.catalogs.words import Words
from tests.helpers.asked_by_keys import DAY, robot_of, text_of
from tests.helpers.command import cli
from tests.helpers.explorers import Explorer, label, node
from tests.helpers.paths import ROOT
from tests.helpers.screens import entering, hurrying, observed_robot, refusing, screens_of

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tests.helpers.command import Cli
    from tests.helpers.little_robots import Nodes
    from tests.helpers.screens import Looking

    Explore = Callable[..., Explorer]

__all__ = ["cli"]

ROBOTS = {file.stem: file for file in sorted((ROOT / "tests" / "cases" / "try").glob("*.yaml"))}
HEAD = "labels: 1\nauthor: Ada\n"
IMAGE = "sensor_msgs/msg/Image"
NODES: Nodes = {"camera": (["/camera/image_raw"], []), "uplink": ([], ["/camera/image_raw"])}
TYPED = f"{HEAD}topics:\n  /camera/image_raw: {{types: [{IMAGE}]}}\n"
WORDS = Words("en")


@pytest.fixture(autouse=True)
def one_day(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", DAY)


class Screens:
    """A browser that goes through the screens by the forms of the page."""

    def __init__(self, explorer: Explorer) -> None:
        self.explorer, self.client = explorer, explorer.client()
        self.page: Any = html.fromstring(self.client.get("/?ask=1").text)

    def press(self, **field: str) -> int:
        (form,) = self.page.cssselect("form.screen")
        data = {name: value for name, value in form.form_values() if name not in ("key", "tick")}
        answer = self.client.post(form.get("action"), data={**data, **field})
        shown = self.client.get(answer.headers["location"]) if answer.status_code == 303 else answer
        self.page = html.fromstring(shown.text)
        return int(answer.status_code)

    def keys(self, *keys: str) -> None:
        for key in keys:
            assert self.press(key=key) == 303

    @property
    def name(self) -> str:
        """The element of the screen; empty where none is left."""
        return str(self.page.xpath("string(//form[@class='screen']//h2/bdi)"))

    @property
    def ticks(self) -> list[bool]:
        return [one.get("aria-checked") == "true" for one in self.page.cssselect(".screen [role=checkbox]")]

    @property
    def told(self) -> str:
        return str(self.page.xpath("string(//div[@id='message'])"))


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, TYPED)


def opened(explore: Explore, folder: Path, **how: Any) -> Screens:
    return Screens(explore(folder / "p.xml", folder / "l.yaml", **how))


def observed(cli: Cli, explore: Explore, folder: Path, name: str, labels: str = HEAD) -> Screens:
    observed_robot(cli, yaml.safe_load(ROBOTS[name].read_text("utf-8")), folder)
    (folder / "l.yaml").write_text(labels, "utf-8")
    policy, types = folder / "robot.policy.xml", folder / "robot.types.yaml"
    return Screens(explore(policy, folder / "l.yaml", types=types))


def in_the_terminal(folder: Path, person: Looking, labels: str = HEAD) -> str:
    """The label file after the conversation of the terminal with a person."""
    file = folder / "terminal.yaml"
    file.write_text(labels, "utf-8")
    screens_of(folder / "robot.policy.xml", file, person, [str(folder / "robot.types.yaml")]).run()
    return file.read_text("utf-8")


VALUE = {ENTER: "take", ALL: "all", "n": "no"}
PEOPLE: dict[str, Callable[[], Looking]] = {"enter": entering, "no": refusing, "all": hurrying}


@pytest.mark.parametrize("who", PEOPLE)
@pytest.mark.parametrize("name", ["telepresence", "turtlebot4"])
def test_the_same_answers_make_the_same_file(cli: Cli, explore: Explore, tmp_path: Path, name: str, who: str) -> None:
    """Byte for byte: the elements come in the same order with the same ticks, and what is written is the same."""
    screens = observed(cli, explore, tmp_path, name)
    person = PEOPLE[who]()
    written = in_the_terminal(tmp_path, person)
    shown = iter(person.shown)
    while screens.name:
        screen = next(shown)
        assert screens.name == screen.element.name
        assert screens.ticks == [line.ticked for line in screen.lines]
        hurried = screen.stage == CHANNELS and who == "all"
        screens.keys("all" if hurried else "no" if who == "no" else "take")
    assert next(shown, None) is None
    assert (tmp_path / "l.yaml").read_text("utf-8") == written != HEAD


def test_suggestions_that_stand_in_the_file_are_taken_out_as_in_the_terminal(
    cli: Cli, explore: Explore, tmp_path: Path
) -> None:
    observed_robot(cli, yaml.safe_load(ROBOTS["telepresence"].read_text("utf-8")), tmp_path)
    given = ("robot.policy.xml", "--types", "robot.types.yaml", "--into", "l.yaml")
    assert cli("suggest", *given, cwd=tmp_path).returncode == 0
    before = text_of(tmp_path)
    assert "# suggest: " in before
    screens = observed(cli, explore, tmp_path, "telepresence", before)
    screens.keys("take", "take")
    assert text_of(tmp_path).count("# suggest: ") < before.count("# suggest: ")


def test_a_screen_has_its_number_and_says_what_the_element_likely_does(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    said = screens.page.xpath("string(//form[@class='screen'])")
    assert said.split()[:3] == ["Screen", "1", "of"]
    assert WORDS("explorer.screen.likely", does=WORDS("explorer.screen.does.source")) in said
    screens.keys("take")
    assert screens.name == "/uplink"
    assert screens.page.xpath("string(//form[@class='screen'])").split()[:3] == ["Screen", "2", "of"]


def test_an_answer_is_in_the_file_at_once_and_what_follows_is_on_the_page(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    screens.keys("take")
    assert "/camera: {source: [Video], note: " in text_of(robot)
    assert screens.explorer.session.unsaved == 0
    assert WORDS("explorer.screen.written", file=str(robot / "l.yaml")) in screens.told
    everything(screens)
    screens.keys("take")
    assert {one.leak.name for one in screens.explorer.session.findings} == {"/uplink"}


def test_back_asks_the_screen_before_anew_with_the_ticks_of_then(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    assert screens.press(tick="2") == 303
    assert screens.ticks[:2] == [True, True]
    screens.keys("take", "back")
    assert (screens.name, screens.ticks[:2]) == ("/camera", [True, True])
    assert text_of(robot) == TYPED
    screens.keys("back")
    assert WORDS("explorer.screen.remark.first") in screens.told


def test_undo_goes_to_the_last_answer(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    screens.keys("take")
    for at, ticked in enumerate(screens.ticks, 1):
        if ticked:
            screens.press(tick=str(at))
    screens.keys("take")
    assert WORDS("explorer.screen.remark.open") in screens.told
    screens.keys("undo")
    assert screens.name == "/camera", "of the screen between nothing was written"
    assert text_of(robot) == TYPED
    screens.keys("undo")
    assert WORDS("explorer.screen.remark.no-answer") in screens.told


def test_a_no_is_remembered(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    lines = len(screens.ticks)
    screens.keys("no")
    assert text_of(robot).count("# not: ") == lines
    assert Screens(explore(robot / "p.xml", robot / "l.yaml")).name != "/camera"


def test_all_channels_are_one_answer_that_can_be_taken_back(cli: Cli, explore: Explore, tmp_path: Path) -> None:
    screens = observed(cli, explore, tmp_path, "turtlebot4")
    while not screens.page.cssselect(".screen [value=all]"):
        screens.keys("take")
    before, name = text_of(tmp_path), screens.name
    screens.keys("all")
    assert "topics:" in text_of(tmp_path)
    screens.keys("undo")
    assert (text_of(tmp_path), screens.name) == (before, name)


def test_what_could_hide_is_taken_for_one_channel_only(cli: Cli, explore: Explore, tmp_path: Path) -> None:
    screens = observed(cli, explore, tmp_path, "turtlebot4")
    while not screens.page.cssselect(".screen [value=all]"):
        screens.keys("take")
    before = text_of(tmp_path)
    looked = screens.explorer.site._screens.look()  # type: ignore[union-attr]
    roles = [line.role for line in looked.screen.lines]  # type: ignore[union-attr]
    for at, role in enumerate(roles, 1):
        if screens.ticks[at - 1] is not (role in HIDING):
            screens.press(tick=str(at))
    screens.keys("all")
    assert (text_of(tmp_path), any(role in HIDING for role in roles)) == (before, True)
    assert WORDS("explorer.screen.remark.one-by-one") in screens.told


@pytest.mark.parametrize("who", ["take", "all", "everything", "no"])
@pytest.mark.parametrize("name", ROBOTS)
def test_whoever_takes_or_refuses_everything_hides_no_planted_leak(
    cli: Cli, explore: Explore, tmp_path: Path, name: str, who: str
) -> None:
    """Planted in the labels, it is told after; and where nobody has said it, there is no all-clear."""
    kind, source, leak = yaml.safe_load(ROBOTS[name].read_text("utf-8"))["truth"][0]
    there = f'{HEAD}nodes:\n  "{source}": {{source: [{kind}]}}\n'
    for labels in (there, f'{there}  "{leak}": {{leak: [{kind}]}}\n'):
        screens = observed(cli, explore, tmp_path, name, labels)
        while screens.name:
            everything(screens) if who == "everything" else None
            key = who if who in ("take", "no") else "take"
            screens.keys("all" if who == "all" and screens.page.cssselect(".screen [value=all]") else key)
        result = rosprivacy.analyze(
            tmp_path / "robot.policy.xml", tmp_path / "l.yaml", types=[tmp_path / "robot.types.yaml"]
        )
        assert result.analysis.verdict == screens.explorer.session.verdict != "no-leak-found"
    assert (kind, source, leak) in {(one.category, one.source.name, one.leak.name) for one in result.findings}


def everything(screens: Screens) -> None:
    """Tick each line once that is not ticked."""
    for at in range(1, len(screens.ticks) + 1):
        if not screens.ticks[at - 1]:
            screens.press(tick=str(at))


def test_what_is_not_saved_elsewhere_waits(explore: Explore, robot: Path) -> None:
    """An answer is written on what the file says: what is said elsewhere would not be known there."""
    screens = opened(explore, robot)
    assert label(screens.client, node("/uplink"), "leak", about="Video").status_code == 303
    screens.page = html.fromstring(screens.client.get("/?ask=1").text)
    assert WORDS("explorer.screen.waits", file=str(robot / "l.yaml")) in screens.page.text_content()
    assert screens.press(key="take") == 422
    assert text_of(robot) == TYPED
    screens.explorer.session.save()
    screens.page = html.fromstring(screens.client.get("/?ask=1").text)
    assert screens.name == "/camera"
    screens.keys("take")
    assert "/uplink: {leak: [Video]}" in text_of(robot)
    assert "/camera: {source: [Video]" in text_of(robot)


def test_a_key_of_who_saw_another_screen_does_nothing(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    screens.press(tick="1")
    screens.keys("take")  # nothing is ticked: no version tells that it is another screen
    other, before = screens.page, text_of(robot)
    screens.keys("back")
    screens.page = other
    assert screens.press(key="no") == 409
    assert text_of(robot) == before


def test_what_somebody_else_writes_meanwhile_stays_and_is_not_taken_back(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot)
    screens.keys("take")
    theirs = text_of(robot).replace("nodes:", "nodes:\n  /uplink: {leak: [Video]}")
    (robot / "l.yaml").write_text(theirs, "utf-8")
    screens.keys("back")
    assert WORDS("explorer.screen.remark.changed") in screens.told
    assert text_of(robot) == theirs
    screens.keys("take")
    assert "/uplink: {leak: [Video" in text_of(robot)
    assert [one.leak.name for one in screens.explorer.session.findings] == ["/uplink"]


def test_somebody_has_to_say_who_answers(explore: Explore, robot: Path) -> None:
    (robot / "l.yaml").write_text(TYPED.replace("author: Ada\n", ""), "utf-8")
    screens = opened(explore, robot)
    assert screens.page.cssselect(".screen [name=by][required]")
    assert screens.press(key="take", by="") == 422
    assert "answered" not in text_of(robot)
    assert screens.press(key="take", by="Bo") == 303
    assert "answered by Bo on 2026-01-01" in text_of(robot)
    assert screens.page.cssselect(".screen [name=by]")[0].get("value") == "Bo"


@pytest.mark.parametrize("wrong", [{"key": "x"}, {"tick": "0"}, {"tick": "99"}, {"tick": "-1"}, {"key": "\n"}, {}])
def test_a_wrong_key_does_nothing(explore: Explore, robot: Path, wrong: dict[str, str]) -> None:
    screens = opened(explore, robot)
    name, ticks = screens.name, screens.ticks
    assert screens.press(**wrong) in (303, 422)
    screens.page = html.fromstring(screens.client.get("/?ask=1").text)
    assert (screens.name, screens.ticks, text_of(robot)) == (name, ticks, TYPED)


def test_where_nothing_may_be_changed_a_screen_is_shown_and_takes_no_key(explore: Explore, robot: Path) -> None:
    screens = opened(explore, robot, read_only=True)
    assert screens.page.cssselect(".screen fieldset[disabled]")
    assert screens.press(key="take") == 403
    assert text_of(robot) == TYPED


@pytest.fixture
def fleet(robot: Path) -> Path:
    said = "fleet: 1\nmodels:\n  m: {policies: [p.xml], labels: [l.yaml]}\nrobots:\n  m_1: {model: m}\n"
    (robot / "fleet.yaml").write_text(said, "utf-8")
    return robot / "fleet.yaml"


def test_a_fleet_has_no_screens_as_in_the_terminal(explore: Explore, fleet: Path) -> None:
    client = explore(fleet, fleet, fleet=True).client()
    page = html.fromstring(client.get("/?ask=1").text)
    assert not page.cssselect(".screen, [href*='ask=1']")
