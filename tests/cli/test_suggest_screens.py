"""``suggest --ask`` at a terminal: a screen for each element, ticked by confidence; Enter hides no leak."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.suggesting.evidence import CONDUIT, LEAK, NEVER, SENSITIVE, WrittenLabel
from rosprivacy.analysis.suggesting.label_questions import BRINGS_IN, YES
from rosprivacy.analysis.suggesting.screens import CHANNELS
from rosprivacy.labelling.asking import asked_now, with_answer, with_lines
from rosprivacy.labelling.conversation import FOUND_SINCE
from rosprivacy.labelling.screen_conversation import ENTER, LISTS, NO_ANSWER, NOTHING_BEFORE, OPPOSITE
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.report.suggested_labels.screen_lines import keys_lines, screen_lines, why_lines
from rosprivacy.settings import Settings
from tests.helpers.asked_by_keys import COMMAND, robot_of, text_of
from tests.helpers.command import cli
from tests.helpers.daily import one_in
from tests.helpers.little_robots import policy_of
from tests.helpers.paths import ROOT
from tests.helpers.planted_leaks import planted
from tests.helpers.screens import (
    Looking,
    entering,
    hurrying,
    looking,
    observed_robot,
    refusing,
    screens_of,
    ticking,
    transcript,
)
from tests.helpers.turtlebot import TURTLEBOT3

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from rosprivacy.analysis.suggesting.screens import Screen
    from rosprivacy.labelling.screen_conversation import ScreenConversation
    from tests.helpers.command import Cli
    from tests.helpers.little_robots import Nodes

__all__ = ["cli"]

ROBOTS = {file.stem: file for file in sorted((ROOT / "tests" / "cases" / "try").glob("*.yaml"))}
OTHERS = sorted((ROOT / "tests" / "cases" / "try" / "by_others").glob("*.yaml"))
TRANSCRIPT = ROOT / "tests" / "cases" / "try" / "telepresence.screens.txt"
OBSERVED = [*COMMAND[:4], "robot.policy.xml", "--types", "robot.types.yaml", *COMMAND[5:]]
MOST_KEYS, COLUMNS, LINES = 40, 80, 24
PEOPLE: dict[str, Callable[[], Looking]] = {"enter": entering, "tick": ticking, "no": refusing, "all": hurrying}
HEAD = "labels: 1\nauthor: Ada\n"
IMAGE, TWIST = "sensor_msgs/msg/Image", "geometry_msgs/msg/Twist"
NODES: Nodes = {
    "camera": (["/camera/image_raw"], []),
    "planner": (["/cmd_vel"], ["/camera/image_raw"]),
    "uplink": ([], ["/camera/image_raw"]),
    "unknown": ([], ["/cmd_vel"]),
}
TYPED = f"{HEAD}topics:\n  /camera/image_raw: {{types: [{IMAGE}]}}\n  /cmd_vel: {{types: [{TWIST}]}}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, TYPED)


def look(robot: Path, person: Looking) -> ScreenConversation:
    return screens_of(robot / "p.xml", robot / "l.yaml", person)


def stem(screen: Screen) -> str:
    return screen.element.name.rpartition("/")[2]


def read(name: str) -> dict[str, Any]:
    said: dict[str, Any] = yaml.safe_load(ROBOTS[name].read_text("utf-8"))
    return said


def observed(cli: Cli, name: str, folder: Path, person: Looking, labels: str = HEAD) -> ScreenConversation:
    observed_robot(cli, read(name), folder)
    (folder / "l.yaml").write_text(labels, "utf-8")
    types = [str(folder / "robot.types.yaml")]
    return screens_of(folder / "robot.policy.xml", folder / "l.yaml", person, types)


def answer(folder: Path) -> rosprivacy.Result:
    return rosprivacy.analyze(folder / "robot.policy.xml", folder / "l.yaml", types=[folder / "robot.types.yaml"])


def test_what_a_terminal_shows_of_one_robot(cli: Cli, tmp_path: Path) -> None:
    """By Enter, but for keys that look, go back, tick, and ask for the lists; a wrong key does nothing."""
    observed_robot(cli, read("telepresence"), tmp_path)
    shown = transcript(OBSERVED, tmp_path, "?2x\rb2\r\rnu\r\r\r\r\r\r\rl" + "q")
    assert shown.replace(str(tmp_path), "") + "\n" + text_of(tmp_path) == TRANSCRIPT.read_text("utf-8")


def test_at_most_forty_keys_go_through_a_robot_of_32_nodes(cli: Cli, tmp_path: Path) -> None:
    person = entering()
    observed(cli, "turtlebot4", tmp_path, person).run()
    assert len(person.keys) <= MOST_KEYS
    assert person.left_open == sum(not any(line.ticked for line in screen.lines) for screen in person.shown)
    assert {(one.category, one.source.name, one.leak.name) for one in answer(tmp_path).findings} >= {
        (kind, source, leak) for kind, source, leak in read("turtlebot4")["truth"] if leak != "/rosbag2_recorder"
    }


@pytest.mark.slow
@pytest.mark.parametrize("file", OTHERS, ids=lambda file: str(file.stem))
def test_at_most_forty_keys_where_all_channels_are_taken_at_once(cli: Cli, tmp_path: Path, file: Path) -> None:
    """What is written is what Enter writes on each screen."""
    said: dict[str, Any] = yaml.safe_load(file.read_text("utf-8"))
    written, keys = [], []
    for person in (entering(), hurrying()):
        observed_robot(cli, said, tmp_path)
        types = [str(tmp_path / "robot.types.yaml")]
        screens_of(tmp_path / "robot.policy.xml", tmp_path / "l.yaml", person, types).run()
        written.append(yaml.safe_load((tmp_path / "l.yaml").read_text("utf-8")))
        keys.append(len(person.keys))
    assert written[0] == written[1]
    assert keys[1] <= MOST_KEYS < keys[0]


def test_all_channels_are_one_answer_that_can_be_taken_back(cli: Cli, tmp_path: Path) -> None:
    observed_robot(cli, read("turtlebot4"), tmp_path)
    stages: list[int] = []

    def choose(screen: Screen, ticks: frozenset[int], first: int) -> str:
        del ticks, first
        stages.append(screen.stage)
        return ENTER if screen.stage != CHANNELS else "a" if stages.count(CHANNELS) == 1 else "u"

    person = Looking(choose, last="u")
    types = [str(tmp_path / "robot.types.yaml")]
    conversation = screens_of(tmp_path / "robot.policy.xml", tmp_path / "l.yaml", person, types)
    texts: list[str] = []
    back = conversation.undo

    def undone(number: int) -> str:
        texts.append((tmp_path / "l.yaml").read_text("utf-8"))
        why = back(number)
        texts.append((tmp_path / "l.yaml").read_text("utf-8"))
        person.choose, person.last = (lambda *_: "q"), "q"
        return why

    conversation.undo = undone
    conversation.run()
    assert "topics:" in texts[0]
    assert "topics:" not in texts[1]


@pytest.mark.parametrize("name", ROBOTS)
def test_a_screen_fits_a_terminal(cli: Cli, tmp_path: Path, name: str) -> None:
    person = entering()
    observed(cli, name, tmp_path, person).run()
    for screen in person.shown:
        for first in range(0, len(screen.lines), 9):
            lines = [*screen_lines(screen, frozenset(), first), *keys_lines(screen)]
            assert len(lines) < LINES
            assert max(map(len, lines)) <= COLUMNS
            why = [*why_lines(screen, first), *keys_lines(screen)]
            assert len(why) < LINES
            assert max(map(len, why)) <= COLUMNS


def test_each_element_is_one_screen_and_what_is_sure_is_ticked(cli: Cli, tmp_path: Path) -> None:
    person = entering()
    observed(cli, "turtlebot4", tmp_path, person).run()
    names = [screen.element.name for screen in person.shown]
    assert len(names) == len(set(names))
    for screen in person.shown:
        ticks = [line.ticked for line in screen.lines]
        assert ticks == sorted(ticks, reverse=True)
        for line in screen.lines:
            sure = str(line.confidence) in ("certain", "likely")
            assert line.ticked == (sure and line.role not in (CONDUIT, NEVER, "sanitizer"))
    camera = person.shown[0]
    assert camera.element.name == "/camera/camera"
    assert [line.kinds for line in camera.lines if line.ticked] == [("Video",), ("DepthImage",), ("PersonPointCloud",)]
    assert names[1:4] == ["/audio_capture", "/rplidar", "/joy_node"], "by weight, as everywhere"


def test_an_exit_of_anything_is_one_of_what_comes_later_too(cli: Cli, tmp_path: Path) -> None:
    """A bridge lets out whatever comes: its label names no kinds of today."""
    observed(cli, "turtlebot4", tmp_path, entering()).run()
    nodes = yaml.safe_load((tmp_path / "l.yaml").read_text("utf-8"))["nodes"]
    assert nodes["/rosbridge_websocket"]["leak"] == ["PersonalData"]


def test_an_exit_has_one_tick_for_all_kinds_that_get_there(cli: Cli, tmp_path: Path) -> None:
    person = entering()
    observed(cli, "turtlebot4", tmp_path, person).run()
    bridge = next(screen for screen in person.shown if screen.element.name == "/rosbridge_websocket")
    (leak,) = (line for line in bridge.lines if line.role == LEAK)
    assert leak.kinds == ("DepthImage", "PersonPointCloud", "Video", "Voice")
    page = (ROOT / "docs" / "suggestions.md").read_text("utf-8")
    assert "\n".join([*screen_lines(bridge, {0}), *keys_lines(bridge)]).strip() in page
    recorder = next(screen for screen in person.shown if screen.element.name == "/rosbag2_recorder")
    assert any("[ ] lets out all 7 kinds of data (may: " in line for line in screen_lines(recorder, ()))


def test_what_a_type_is_not_made_for_is_not_asked(robot: Path) -> None:
    person = ticking()
    look(robot, person).run()
    assert "/cmd_vel" not in {screen.element.name for screen in person.shown}
    assert "/camera/image_raw" in {screen.element.name for screen in person.shown}


def test_what_enter_takes_is_written_and_the_rest_is_not_stated(robot: Path) -> None:
    look(robot, looking(ENTER)).run()
    text = text_of(robot)
    assert "/camera: {source: [Video], note: " in text
    assert "DepthImage" not in text
    assert "# not:" not in text


def test_a_line_is_written_as_the_answer_to_a_question(robot: Path) -> None:
    """The same label, the same note."""
    person = looking()
    look(robot, person).run()
    file, nobody = str(robot / "l.yaml"), Settings()
    now = suggest_labels((str(robot / "p.xml"),), (file,), nobody)
    question = next(one for one in asked_now(now) if one.about == BRINGS_IN)
    rows = tuple(row for row in question.rows if row.kinds == ("Video",))
    asked = with_answer(file, question._replace(rows=rows), YES, "Ada", "2026-01-01", nobody)
    lines = [line for line in person.shown[0].lines if line.kinds == ("Video",)]
    assert with_lines(file, lines, "Ada", "2026-01-01", nobody).text == asked.text


def test_a_number_ticks_and_a_no_is_of_all_lines(robot: Path) -> None:
    look(robot, looking("1", ENTER)).run()
    assert "source" not in text_of(robot)
    look(robot, looking("n")).run()
    text = text_of(robot)
    assert text.count("# not: ") == len(look_once(robot, TYPED).lines)
    assert "/camera" not in {screen.element.name for screen in shown_by_enter(robot)}


def look_once(robot: Path, labels: str) -> Screen:
    """The first screen under some labels."""
    (robot / "other.yaml").write_text(labels, "utf-8")
    person = looking()
    screens_of(robot / "p.xml", robot / "other.yaml", person).run()
    return person.shown[0]


def shown_by_enter(robot: Path) -> list[Screen]:
    person = entering()
    look(robot, person).run()
    return person.shown


def test_back_takes_back_what_was_said_there_and_undo_goes_to_the_last_answer(robot: Path) -> None:
    person = looking(ENTER, "b", "1", ENTER, "b")
    look(robot, person).run()
    assert [stem(screen) for screen in person.shown][:3] == ["camera", "uplink", "camera"]
    assert text_of(robot) == TYPED
    first = looking(ENTER, ENTER, "u")
    look(robot, first).run()
    names = [stem(screen) for screen in first.shown]
    assert names[:2] == ["camera", "uplink"]
    assert names[-1] == "camera", "of the screen between nothing was kept"
    assert text_of(robot) == TYPED
    nothing = looking("b", "u")
    look(robot, nothing).run()
    assert nothing.remarks == [NOTHING_BEFORE, NO_ANSWER]


def test_where_a_person_comes_back_the_ticks_are_as_they_were(robot: Path) -> None:
    ticks: list[frozenset[int]] = []
    keys = ["2", ENTER, "b"]

    def choose(_: Screen, now: frozenset[int], __: int) -> str:
        ticks.append(now)
        return keys.pop(0) if keys else "q"

    look(robot, Looking(choose)).run()
    assert ticks[0] == {0}
    assert ticks[1] == ticks[-1] == {0, 1}


def test_lines_that_say_the_opposite_are_not_ticked_together(robot: Path) -> None:
    person = looking(ENTER, "2", "1", "2", ENTER)
    look(robot, person).run()
    uplink = person.shown[1]
    assert [line.role for line in uplink.lines] == [LEAK, CONDUIT]
    assert person.remarks == [OPPOSITE]
    assert "/uplink: {leak: [PersonalData]" in text_of(robot)
    assert "conduit" not in text_of(robot)


def test_a_label_is_typed_in_place_of_an_answer(robot: Path) -> None:
    written: list[WrittenLabel] = []
    label = WrittenLabel("nodes", "/camera", {"source": ["FaceImage"]})
    keys: list[str | WrittenLabel] = [label, "b", "q"]
    conversation = look(robot, Looking(lambda *_: keys.pop(0)))
    conversation.typed = lambda one: written.append(one) or ()  # type: ignore[func-returns-value]
    conversation.undo = lambda number: written.pop() and "" if number == 1 else "no"
    assert conversation.run() == "q"
    assert written == []


def test_many_lines_are_folded_and_a_key_turns_the_page(tmp_path: Path) -> None:
    names = [
        f"/{word}" for word in ("image", "audio", "scan", "faces", "map", "joy", "temperature", "depth", "gesture")
    ]
    channels = [*names, "/heart_rate", "/location", "/ir_image", "/pointcloud"]
    robot_of(tmp_path, {"robot": (channels, []), "end": ([], channels)}, HEAD)
    person = looking("+", "1", "+", ENTER)
    look(tmp_path, person).run()
    (screen,) = person.shown[:1]
    assert len(screen.lines) > 9
    assert f"  and {len(screen.lines) - 9} more: press +" in [*screen_lines(screen, ())]
    tenth = screen.lines[9]
    assert tenth.kinds[0] in text_of(tmp_path)


def test_what_could_hide_is_asked_anew_if_a_finding_became_known_since(robot: Path) -> None:
    labels = f"{TYPED}nodes:\n  /camera: {{source: [Video]}}\n  /uplink: {{leak: none}}\n"
    (robot / "l.yaml").write_text(labels, "utf-8")

    def late(screen: Screen, ticks: frozenset[int], _: int) -> str:
        if person.remarks or not screen.element.is_channel:
            return "q" if person.remarks else ENTER
        roles = [line.role for line in screen.lines]
        if roles.index(SENSITIVE) in ticks:
            return str(roles.index(SENSITIVE) + 1)
        if roles.index(NEVER) not in ticks:
            return str(roles.index(NEVER) + 1)
        (robot / "l.yaml").write_text(labels.replace("leak: none", "leak: [Video]"), "utf-8")
        return ENTER

    person = Looking(late)
    look(robot, person).run()
    assert person.remarks == [FOUND_SINCE]
    assert "never" not in text_of(robot)


@pytest.mark.parametrize("who", PEOPLE)
@pytest.mark.parametrize("name", ROBOTS)
def test_no_leak_of_a_robot_is_hidden_by_whoever_takes_or_refuses_everything(
    cli: Cli, tmp_path: Path, name: str, who: str
) -> None:
    """Planted in the labels, it is found after; and where nobody has said it, there is no all-clear."""
    truth = read(name)["truth"]
    for kind, source, leak in truth[:1]:
        planted_there = f'{HEAD}nodes:\n  "{source}": {{source: [{kind}]}}\n'
        whole = f'{planted_there}  "{leak}": {{leak: [{kind}]}}\n'
        observed(cli, name, tmp_path, PEOPLE[who](), whole).run()
        found = {(one.category, one.source.name, one.leak.name) for one in answer(tmp_path).findings}
        assert (kind, source, leak) in found
        observed(cli, name, tmp_path, PEOPLE[who](), planted_there).run()
        assert answer(tmp_path).analysis.verdict != "no-leak-found"


@pytest.mark.corpus
@pytest.mark.slow
@pytest.mark.parametrize("who", one_in(3, PEOPLE, in_ci=3))
def test_no_planted_leak_of_the_corpus_is_hidden(corpus: Path, tmp_path: Path, who: str) -> None:
    for file, path in planted(str(corpus / TURTLEBOT3), tmp_path, 20, 1):
        screens_of(corpus / TURTLEBOT3, file, PEOPLE[who]()).run()
        found = rosprivacy.analyze(str(corpus / TURTLEBOT3), str(file)).analysis
        assert path in {f"{one.source.name} -> {one.leak.name}" for one in found.findings}, path


KEYS = st.lists(st.sampled_from([ENTER, ENTER, "n", "b", "u", "+", *"123456789"]), max_size=30)
TYPES = st.sampled_from([IMAGE, TWIST, "std_msgs/msg/String", "sensor_msgs/msg/JointState"])


@given(keys=KEYS, types=st.lists(TYPES, min_size=2, max_size=2), leak=st.booleans())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_is_pressed_only_a_line_that_hides_can_hide(
    tmp_path: Path, keys: list[str], types: list[str], *, leak: bool
) -> None:
    """Keys of a person who ticks none that could hide a leak; what was there stays, and the file can be read."""
    (tmp_path / "p.xml").write_text(policy_of(NODES), "utf-8")
    there = f"{HEAD}nodes:\n  /camera: {{source: [Video]}}\n"
    there += "  /unknown: {leak: [Video]}\n" if leak else ""
    named = zip(("/camera/image_raw", "/cmd_vel"), types, strict=True)
    there += "topics:\n" + "".join(f"  {name}: {{types: [{said}]}}\n" for name, said in named)
    (tmp_path / "l.yaml").write_text(there, "utf-8")
    before = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml")
    left = iter(chain(keys, "q"))

    def choose(screen: Screen, _: frozenset[int], first: int) -> str:
        for key in left:
            at = first + int(key) - 1 if key.isdigit() else len(screen.lines)
            if at >= len(screen.lines) or not screen.lines[at].hides:
                return key
        return "q"

    look(tmp_path, Looking(choose)).run()
    after = rosprivacy.analyze(tmp_path / "p.xml", tmp_path / "l.yaml")
    assert {one.id for one in before.findings} <= {one.id for one in after.findings}
    assert after.analysis.verdict != "no-leak-found"


def test_where_no_element_has_a_screen_the_lists_come_at_once(tmp_path: Path) -> None:
    nodes: Nodes = {"eye": (["/a"], []), "middle": (["/b"], ["/a"]), "other": (["/c"], ["/b"]), "end": ([], ["/c"])}
    robot_of(tmp_path, nodes, f"{HEAD}nodes:\n  /eye: {{source: [Video]}}\n  /end: conduit\n")
    shown = transcript(COMMAND, tmp_path, "q")
    assert "What do these do with Video?" in shown
    assert "0 answers in l.yaml; the same command goes on from here" in shown


def test_lists_come_by_a_key_and_answers_of_both_are_counted(robot: Path) -> None:
    shown = transcript(COMMAND, robot, "\r" + LISTS + "s" + "q")
    assert "node /camera: likely brings data in" in shown
    assert "1 answer in l.yaml; the same command goes on from here" in shown
    assert "all: " in shown or "  y yes" in shown
    assert "/camera: {source: [Video]" in text_of(robot)
