"""``suggest --ask``: channels that are alike in one list, confirmed by its number; it closes no known finding."""

from __future__ import annotations

import os
import pty
import select
import subprocess
import time
from string import ascii_uppercase
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.suggesting.label_questions import GOES_THROUGH, LISTED, NOTHING
from rosprivacy.labelling.asking import asked_now
from rosprivacy.labelling.conversation import QUIT, SKIP, allowed
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.asked_by_keys import (
    COMMAND,
    Pressing,
    by_keys,
    conversation,
    conversation_in,
    robot_of,
    text_of,
    wait_for_keys,
)
from tests.helpers.command import cli
from tests.helpers.daily import one_in
from tests.helpers.little_robots import policy_of
from tests.helpers.planted_leaks import planted
from tests.helpers.turtlebot import TURTLEBOT3
from tests.helpers.typist import POLICIES

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion
    from tests.helpers.asked_by_keys import ByKeys
    from tests.helpers.little_robots import Nodes

__all__ = ["by_keys", "cli"]

TEXT = "std_msgs/msg/String"
JOINTS, BATTERY = "sensor_msgs/msg/JointState", "sensor_msgs/msg/BatteryState"  # one family of the table
TYPES = {
    "joints": JOINTS,
    "battery": BATTERY,
    "arm": JOINTS,
    "text": TEXT,
    "grid": "nav_msgs/msg/OccupancyGrid",
}
NODES: Nodes = {
    "eye": (["/a"], []),
    "middle": (["/joints", "/battery", "/arm", "/text", "/grid", "/plain"], ["/a"]),
    "here": ([], ["/joints", "/battery", "/arm", "/text", "/grid", "/plain"]),
}
HEAD = "labels: 1\nauthor: Ada\nnodes:\n  /eye: {source: [Video]}\n  /middle: conduit\n"
HEADING = "Is it so that no Video goes through any of these?"


def labels_of(types: dict[str, str], more: str = "") -> str:
    return f"{HEAD}{more}topics:\n" + "".join(f"  /{name}: {{types: [{said}]}}\n" for name, said in types.items())


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, labels_of(TYPES))


def list_shown(text: str) -> list[str]:
    """The channels of the last list that was shown."""
    lines = text.rpartition(HEADING)[2].partition("\n> ")[0].splitlines()
    return [line.split()[2] for line in lines if " topic " in line]


BEFORE = "s"  # the end of the data


def test_only_what_a_type_says_is_in_a_list_and_all_of_it_is_shown(robot: Path, by_keys: ByKeys) -> None:
    """Not a text, not a map (which is made of what sensors see), and not what nobody knows the type of."""
    shown = by_keys(robot, f"{BEFORE}q").stdout
    assert sorted(list_shown(shown)) == ["/arm", "/battery", "/joints"]
    for name, said in (("arm", JOINTS), ("battery", BATTERY), ("joints", JOINTS)):
        assert f"type {said} of /{name} is not made for Video" in shown
    assert "  3 and Enter for none of it in all 3, A-Z take out or put back, o not as a list" in shown


def line(*names: str) -> str:
    """What a file of keys says of a list."""
    return "; ".join(f"/{name} topic never Video" for name in names) + "\n"


def test_a_list_is_confirmed_by_its_number_and_each_note_says_so(robot: Path) -> None:
    conversation_in(robot, careless()).run()
    text = text_of(robot)
    for name in ("arm", "battery", "joints"):
        assert f"  /{name}: {{never: [Video], " in text
    assert text.count("answered by Ada on 2026-11-23 in a list of 3: type sensor_msgs/msg/") == 3


def test_a_label_that_is_typed_in_its_place_does_not_confirm_it(robot: Path, by_keys: ByKeys) -> None:
    """The list comes again; what was taken out before stays out."""
    shown = by_keys(robot, f"{BEFORE}A/eye node leak Biometric\n").stdout
    text = text_of(robot)
    assert "  /eye: {leak: [Biometric], source: [Video], note: " in text
    assert "never" not in text
    assert shown.count(HEADING) == 2
    assert sorted(list_shown(shown)) == ["/battery", "/joints"]


@pytest.mark.parametrize("number", ["", "0", "1", "2", "4", "33", "3x", "03"])
def test_no_other_number_confirms_it(robot: Path, number: str) -> None:
    before = text_of(robot)
    keys = [number, QUIT]
    person = Pressing(lambda question, _: keys.pop(0) if question.about == LISTED else SKIP)
    conversation_in(robot, person).run()
    assert person.remarks == ([f"{number!r} is no answer here; 3 rows left"] if number else [])
    assert text_of(robot) == before


@pytest.mark.parametrize(
    "keys",
    one_in(
        5,
        [
            *("y", "0", "0\n", "1\n", "2\n", "3\n", "4\n", "33\n", "3", "3x", "3 \n", "x", "n", "Z", "\n\n", "A2\n"),
            *(line("arm"), line("arm", "text"), line("arm", "arm"), line("arm", "joints").replace("Video", "Voice")),
        ],
        in_ci=1,
    ),
)
def test_a_file_of_keys_that_does_not_name_the_rows_confirms_nothing(robot: Path, by_keys: ByKeys, keys: str) -> None:
    """Three others may be in the list than those that it was made for."""
    before = text_of(robot)
    done = by_keys(robot, f"{BEFORE}{keys}")
    assert done.returncode == 0
    assert text_of(robot) == before


def test_a_file_of_keys_confirms_the_rows_that_it_names(robot: Path, by_keys: ByKeys) -> None:
    told = by_keys(robot, f"{BEFORE}3\n").stdout
    whole = line("arm", "battery", "joints")
    assert f"'3' takes data away; where no terminal is, a line says it, and no more keys are read: {whole}" in told
    done = by_keys(robot, f"{BEFORE}A{line('battery', 'joints')}q")
    assert "1 answer in l.yaml" in done.stdout
    text = text_of(robot)
    assert text.count("never: [Video]") == text.count("in a list of 2: ") == 2
    assert "/arm: {types" in text


@pytest.mark.slow
def test_rows_are_taken_out_and_asked_by_themselves(robot: Path, by_keys: ByKeys) -> None:
    by_keys(robot, f"{BEFORE}{line('battery', 'joints')}q")
    out = list_shown(by_keys(robot, "sssq").stdout)
    assert out == []  # one channel makes no list
    (robot / "l.yaml").write_text(labels_of(TYPES), "utf-8")
    assert "Can Video go through these?" in by_keys(robot, f"{BEFORE}oq").stdout


def test_a_known_finding_is_asked_by_itself_also_where_only_all_together_would_close_it(
    robot: Path, by_keys: ByKeys
) -> None:
    """The data get to the leak by two of three channels: neither closes the finding, both do."""
    nodes: Nodes = NODES | {"out": ([], ["/joints", "/arm"])}
    robot_of(robot, nodes, labels_of(TYPES, "  /out: {leak: [Video]}\n"))
    shown = by_keys(robot, "sssssq").stdout
    assert HEADING not in shown
    assert "known findings, which may hang on this:\n       Video: /eye -> /out [" in shown
    (robot / "p.xml").write_text(policy_of(NODES | {"out": ([], ["/joints"])}), "utf-8")
    shown = by_keys(robot, "sssq").stdout
    assert sorted(list_shown(shown)) == ["/arm", "/battery"]


def test_a_leak_that_becomes_known_while_a_list_is_shown_is_not_closed_by_it(robot: Path) -> None:
    """Somebody else writes the leak into the file between the question and its answer."""
    (robot / "p.xml").write_text(policy_of(NODES | {"out": ([], ["/joints"])}), "utf-8")
    lists = 0

    def late(question: LabelQuestion, _: frozenset[int]) -> str:
        nonlocal lists
        if question.about != LISTED:
            return QUIT if lists else SKIP
        lists += 1
        (robot / "l.yaml").write_text(labels_of(TYPES, "  /out: {leak: [Video]}\n"), "utf-8")
        return str(len(question.rows)) if lists == 1 else QUIT

    person = Pressing(late)
    conversation_in(robot, person).run()
    assert person.remarks == ["this list is not as it was any more: nothing is kept, and it is asked anew"]
    assert "never" not in text_of(robot)


def careless() -> Pressing:
    """Somebody who confirms every list as it is, and answers nothing else."""
    return Pressing(lambda question, _: str(len(question.rows)) if question.about == LISTED else SKIP)


def picking(last: str = "") -> Pressing:
    """Somebody who picks all channels that are asked about together, says that nothing goes through, and confirms."""

    def key(question: LabelQuestion, picked: frozenset[int]) -> str:
        if question.about == LISTED:
            return last or str(len(question.rows))
        if question.about != GOES_THROUGH or len(question.rows) == 1:
            return SKIP
        left = [at for at in range(len(question.rows)) if at not in picked]
        return ascii_uppercase[left[0]] if left else NOTHING

    return Pressing(key)


def listed(person: Pressing) -> list[tuple[str, ...]]:
    """The channels of each list that was shown."""
    return [tuple(row.element.name for row in one.rows) for one in person.asked if one.about == LISTED]


def test_channels_that_a_person_picks_are_asked_as_a_list(robot: Path) -> None:
    """Also those of which nobody knows the type: each was picked by its letter, and is shown again."""
    (robot / "l.yaml").write_text(HEAD + "  /here: conduit\n", "utf-8")
    stopped = picking(QUIT)
    conversation_in(robot, stopped).run()
    assert listed(stopped) == [("/a", "/arm", "/battery", "/grid", "/joints", "/plain", "/text")]
    assert "never" not in text_of(robot)
    conversation_in(robot, picking()).run()
    text = text_of(robot)
    assert text.count('never: [Video], note: "answered by Ada on 2026-11-23 in a list of 7"') == 7


def test_a_picked_channel_that_would_close_a_finding_is_asked_by_itself(robot: Path) -> None:
    nodes: Nodes = NODES | {"out": ([], ["/joints"])}
    robot_of(robot, nodes, f"{HEAD}  /here: conduit\n  /out: {{leak: [Video]}}\n")
    before = found(robot / "p.xml", robot / "l.yaml")
    person = picking()
    conversation_in(robot, person).run()
    assert listed(person) == [("/arm", "/battery", "/grid", "/plain", "/text")]
    told = "it could close a known finding, and is asked by itself"
    assert person.remarks == [f"topic /a: {told}", f"topic /joints: {told}"]
    assert found(robot / "p.xml", robot / "l.yaml") == before


def test_of_rows_that_nobody_picked_nothing_is_said_together(robot: Path) -> None:
    (robot / "l.yaml").write_text(HEAD + "  /here: conduit\n", "utf-8")
    question = next(one for one in asked_of(robot) if one.about == GOES_THROUGH)
    assert NOTHING not in allowed(question)
    assert NOTHING in allowed(question, {0, 1})


def asked_of(robot: Path) -> tuple[LabelQuestion, ...]:
    return asked_now(suggest_labels((str(robot / "p.xml"),), (str(robot / "l.yaml"),), Settings()))


CHANNELS = ("joints", "battery", "arm", "text", "plain")


@pytest.mark.slow
@given(
    middle=st.lists(st.sampled_from(CHANNELS), min_size=2, unique=True),
    second=st.lists(st.sampled_from(CHANNELS), unique=True),
    ends=st.lists(st.lists(st.sampled_from(CHANNELS), min_size=1, unique=True), min_size=1, max_size=3),
    leaks=st.integers(0, 3),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_an_accepted_list_closes_no_known_finding(
    tmp_path: Path, middle: list[str], second: list[str], ends: list[list[str]], leaks: int
) -> None:
    nodes: Nodes = {
        "eye": (["/a"], []),
        "middle": ([f"/{one}" for one in middle], ["/a"]),
        "second": ([f"/{one}" for one in second], [f"/{middle[0]}"]),
    }
    nodes |= {f"end{at}": ([], [f"/{one}" for one in channels]) for at, channels in enumerate(ends)}
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    out = "".join(f"  /end{at}: {{leak: [Video]}}\n" for at in range(min(leaks, len(ends))))
    used = {*middle, *second, *(one for channels in ends for one in channels)}
    types = {name: said for name, said in TYPES.items() if name in used}
    (tmp_path / "l.yaml").write_text(labels_of(types, out + "  /second: conduit\n"), "utf-8")
    policy, file = tmp_path / "p.xml", tmp_path / "l.yaml"
    before = found(policy, file)
    conversation(policy, file, careless()).run()
    assert found(policy, file) == before
    picked = tmp_path / "picked.yaml"
    picked.write_text(file.read_text("utf-8"), "utf-8")
    conversation(policy, picked, picking()).run()
    assert found(policy, picked) == before
    text = text_of(tmp_path)
    assert not any(f"  /{name}: {{never" in text for name in ("text", "plain", "a"))


@pytest.mark.corpus
@pytest.mark.slow
def test_lists_of_packages_close_no_planted_leak(corpus: Path, tmp_path: Path) -> None:
    lists = 0
    for policy in (corpus / TURTLEBOT3, corpus / POLICIES["$RMF"]):
        for file, path in planted(str(policy), tmp_path, 6, 1):
            before = found(policy, file)
            person = careless()
            conversation(policy, file, person).run()
            lists += len(listed(person))
            assert found(policy, file) == before, path
    assert lists


def found(policy: Path, file: Path) -> set[str]:
    analysis = rosprivacy.analyze(str(policy), str(file)).analysis
    return {one.id for one in analysis.findings}


def test_what_only_code_says_of_a_type_makes_no_list(by_keys: ByKeys, tmp_path: Path) -> None:
    """A test writes a flag where the camera has its pictures: nobody else says a type."""
    nodes: Nodes = {"camera": (["/front", "/rear"], []), "box": ([], ["/front", "/rear"])}
    robot_of(tmp_path, nodes, "labels: 1\nauthor: Ada\nnodes:\n  /camera: {source: [Video]}\n")
    (tmp_path / "test_box.py").write_text(
        "from rclpy.node import Node\nfrom std_msgs.msg import Bool\n\n\nclass Tester(Node):\n"
        "    def __init__(self):\n        super().__init__('tester')\n"
        "        self.create_publisher(Bool, '/front', 1)\n        self.create_publisher(Bool, '/rear', 1)\n",
        "utf-8",
    )
    shown = by_keys(tmp_path, "2q", "--source", "test_box.py").stdout
    assert "type std_msgs/msg/Bool of /front is not made for Video" in shown
    assert HEADING not in shown


BEEPER = """package: 1
name: beeper
about: It beeps.
sources:
  - {at: https://example.org/beeper, version: "1.0", read: 2026-11-23}
nodes:
  - names: [beeper]
    publishes: {beep: std_msgs/msg/Bool, tone: std_msgs/msg/Bool}
    says:
      - {conduit: [PersonalData], why: it beeps}
"""


@pytest.mark.parametrize("stated", [True, False])
def test_where_a_label_states_that_something_else_goes_in_no_package_knows_the_type(
    by_keys: ByKeys, tmp_path: Path, *, stated: bool
) -> None:
    nodes: Nodes = {"eye": (["/a"], []), "beeper": (["/beep", "/tone"], ["/a"]), "box": ([], ["/beep", "/tone"])}
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    (tmp_path / "beeper.yaml").write_text(BEEPER, "utf-8")
    more = (
        "  /eye: {source: [Video]}\n  /beeper: conduit\n  /box: conduit\n"
        "elements:\n  disk: {kind: storage, retention: P1D, country: DE}\n"
        "flows:\n  - {from: /eye, to: disk}\n"
    )
    into = "  - {from: disk, to: {topic: /beep}}\n  - {from: disk, to: {topic: /tone}}\n" if stated else ""
    (tmp_path / "l.yaml").write_text(f"labels: 1\nauthor: Ada\nnodes:\n{more}{into}", "utf-8")
    shown = by_keys(tmp_path, "ssq", "--packages", "beeper.yaml").stdout
    assert "topic /beep" in shown
    assert (HEADING in shown) is not stated


@pytest.mark.slow
def test_a_process_that_is_killed_in_a_number_keeps_nothing_of_the_list(robot: Path) -> None:
    before = text_of(robot)
    with subprocess.Popen(COMMAND, cwd=robot, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(b"ss3")
        shown = b""
        while HEADING.encode() not in shown and (more := process.stdout.read(1)):
            shown += more
        time.sleep(0.5)
        process.kill()
    assert HEADING.encode() in shown
    assert text_of(robot) == before


@pytest.mark.slow
def test_two_digits_that_come_at_once_confirm_no_list_without_enter(robot: Path) -> None:
    names = [f"/arm{at}" for at in range(10)]
    nodes: Nodes = {"eye": (["/a"], []), "middle": (names, ["/a"]), "here": ([], names)}
    robot_of(robot, nodes, labels_of({name[1:]: JOINTS for name in names}, "  /here: conduit\n"))
    before = text_of(robot)
    ours, theirs = pty.openpty()
    with subprocess.Popen(COMMAND, cwd=robot, stdin=theirs, stdout=subprocess.PIPE, bufsize=0) as process:
        assert process.stdout is not None
        shown = b""
        while not shown.endswith(b"> ") and (more := process.stdout.read(1)):
            shown += more
        wait_for_keys(theirs)
        os.write(ours, b"10")
        while not select.select([process.stdout], [], [], 0.1)[0]:
            os.write(ours, b"q")  # again: what is typed before the terminal waits for a key is no answer
        while b"rows left" not in shown and (more := process.stdout.read(1)):
            shown += more
        os.close(ours)
        shown += process.stdout.read()
    os.close(theirs)
    assert b"10 and Enter for none of it in all 10" in shown
    assert b"'10q' is no answer here; 10 rows left" in shown
    assert text_of(robot) == before


@pytest.mark.slow
def test_a_number_and_enter_may_come_at_once(robot: Path) -> None:
    """As over a slow line, or pasted."""
    names = [f"/joints_{number}" for number in range(10)]
    nodes: Nodes = {"eye": (["/a"], []), "middle": (names, ["/a"]), "here": ([], names)}
    robot_of(robot, nodes, labels_of({name[1:]: JOINTS for name in names}, "  /here: conduit\n"))
    ours, theirs = pty.openpty()
    with subprocess.Popen(COMMAND, cwd=robot, stdin=theirs, stdout=subprocess.PIPE, bufsize=0) as process:
        assert process.stdout is not None
        shown = b""
        while not shown.endswith(b"> ") and (more := process.stdout.read(1)):
            shown += more
        wait_for_keys(theirs)
        os.write(ours, b"10\r")
        while (
            (more := process.stdout.read(1)) and b"nothing is left" not in shown and not shown.endswith(b"? help\n> ")
        ):
            shown += more
        os.close(ours)
        shown += process.stdout.read()
    os.close(theirs)
    assert b"no answer here" not in shown
    assert text_of(robot).count("never: ") >= 10
