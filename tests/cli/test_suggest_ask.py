"""``rosprivacy suggest --ask``: single keys answer, each is kept at once, and nothing is taken away in a group."""

from __future__ import annotations

import os
import pty
import subprocess
import time
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.suggesting.label_questions import GOES_THROUGH, LabelQuestion
from rosprivacy.labelling.asking import asked_now
from rosprivacy.labelling.conversation import FOUND_SINCE, Conversation
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from tests.helpers.asked_by_keys import COMMAND, Pressing, by_keys, robot_of, text_of, wait_for_keys
from tests.helpers.command import LINE, cli
from tests.helpers.little_robots import HOSTILE, policy_of

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.asked_by_keys import ByKeys
    from tests.helpers.command import Cli
    from tests.helpers.little_robots import Nodes

__all__ = ["by_keys", "cli"]

NODES = {
    "eye": (["/a"], []),
    "middle": (["/b", "/c"], ["/a"]),
    "customer_bridge": ([], ["/b"]),
    "unknown": ([], ["/c"]),
}
BRIDGE = "node /customer_bridge\n       'bridge' in the name of the node"
SOURCE = "labels: 1\nauthor: Ada\nnodes:\n  /eye: {source: [Video]}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, SOURCE)


def test_from_a_source_to_the_answer_by_single_keys(robot: Path, by_keys: ByKeys) -> None:
    """The bridge lets out; the node between passes on; the unknown end is a conduit; the channels may carry it."""
    done = by_keys(robot, "A1 AB2\ny")
    assert (done.returncode, done.stderr) == (0, "")
    assert "nothing is left to ask\nleak; 0 open elements" in done.stdout
    text = text_of(robot)
    assert text.startswith(SOURCE)
    for line in (
        "  /customer_bridge: {leak: [Video], note: \"answered by Ada on 2026-01-01: 'bridge' in the name",
        '  /middle: {conduit: [Video], note: "answered by Ada on 2026-01-01: it gets Video, which can go on',
        '  /unknown: {conduit: [Video], note: "answered by Ada on 2026-01-01"}',
        "  /b: {sensitive: [Video], note: ",
    ):
        assert line in text
    found = rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml")).analysis.findings
    assert [(one.source.name, one.leak.name) for one in found] == [("/eye", "/customer_bridge")]


def test_a_limit_on_the_way_of_a_source_that_gets_a_yes_is_told(robot: Path, by_keys: ByKeys) -> None:
    """Also where it takes the same data of another source away already; and never where nothing gets to it."""
    told = "\nl.yaml:7: never of topic /a takes Video away, which is accepted now; see whether it is still so\n"
    limited = f"{SOURCE}topics:\n  /a: {{never: [Video]}}\n"
    for writes, there in (("/a", 1), ("/other", 0)):
        robot_of(robot, {**NODES, "second_camera": ([writes], [])}, limited)
        done = by_keys(robot, "y")
        assert "/second_camera: {source: [Video]" in text_of(robot)
        assert done.stdout.count(told) == there
        (robot / "l.yaml").write_text(limited, "utf-8")
        assert told not in by_keys(robot, "n").stdout


def test_whether_a_node_lets_data_out_is_asked_although_a_glob_calls_it_a_conduit(robot: Path, by_keys: ByKeys) -> None:
    """S11: it is asked of the data that get there; a no is kept, and ends it."""
    (robot / "l.yaml").write_text(f'{SOURCE}  "/*": conduit\ntopics:\n  "/*": sensitive\n', "utf-8")
    asked = by_keys(robot, "n")
    assert (
        "node /customer_bridge: Video\n       your glob at l.yaml:5 calls /customer_bridge a conduit\n" in asked.stdout
    )
    assert "'bridge' in the name of the node" in asked.stdout
    assert "customer_bridge: " not in by_keys(robot, "").stdout


def test_a_no_is_kept_with_who_and_when_and_not_asked_again(cli: Cli, robot: Path, by_keys: ByKeys) -> None:
    first = by_keys(robot, "Anq", "--by", "Bo")
    assert f"A  {BRIDGE}" in first.stdout
    conduit, leak = (
        f'# not: {{"nodes": {{"/customer_bridge": {{"{role}": ["Video"]}}}}}} by Bo on 2026-01-01\n'
        for role in ("conduit", "leak")
    )
    assert text_of(robot) == f"{SOURCE}{conduit}{leak}"
    assert "node /customer_bridge" not in by_keys(robot, "q").stdout
    assert "leak PersonalData" not in cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    (robot / "l.yaml").write_text(f"{SOURCE}{leak}", "utf-8")
    asked = by_keys(robot, "q").stdout
    assert "node /customer_bridge\n       it gets Video, and no policy lets it go on" in asked  # an end as any other
    (robot / "l.yaml").write_text(SOURCE, "utf-8")
    assert BRIDGE in by_keys(robot, "q").stdout


def test_a_no_to_one_kind_silences_no_other(cli: Cli, robot: Path, by_keys: ByKeys) -> None:
    """The suggestion is of a leak of everything; what was asked about is the pictures."""
    by_keys(robot, "Anq")
    later = text_of(robot).replace("[Video]}\n", "[Video]}\n  /middle: {source: [Voice]}\n", 1)
    (robot / "l.yaml").write_text(later, "utf-8")
    assert "leak PersonalData" in cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout
    again = by_keys(robot, "Anq").stdout
    assert "node /customer_bridge: Voice\n" in again
    assert "leak PersonalData" not in cli("suggest", "p.xml", "-l", "l.yaml", cwd=robot).stdout


def test_a_no_to_a_kind_is_one_to_narrower_kinds(robot: Path, by_keys: ByKeys) -> None:
    no = '# not: {"nodes": {"/customer_bridge": {"leak": ["PersonalData"]}}} by Bo on 2026-01-01\n'
    (robot / "l.yaml").write_text(f"{SOURCE}{no}", "utf-8")
    assert "'bridge' in the name" not in by_keys(robot, "q").stdout


LEAKING = "labels: 1\nauthor: Ada\nnodes:\n  /eye: {source: [Video]}\n  /two: {source: [Voice]}\n  /box: {leak: none}\n"
TWO_KINDS: Nodes = {"eye": (["/front"], []), "two": (["/front"], []), "box": ([], ["/front"])}


@pytest.mark.parametrize("keys", ["10\n", "1", "0", "2", "9", "3\n", "/front 0", "/rear topic never Video and Voice\n"])
def test_keys_of_a_file_that_are_out_of_step_take_nothing_away(tmp_path: Path, by_keys: ByKeys, keys: str) -> None:
    """The ``1`` of ``10`` says *Video at most* of a channel of two kinds, and ``0`` none of it."""
    robot_of(tmp_path, TWO_KINDS, LEAKING)
    done = by_keys(tmp_path, f"{keys}q")
    assert "Can Video and Voice go through?" in done.stdout
    assert "no more are read" in done.stdout or "no more keys are read" in done.stdout
    assert text_of(tmp_path) == LEAKING


@pytest.mark.parametrize(
    ("line", "label"),
    [
        ("/front topic never Video Voice\n", "/front: {never: [Video, Voice], note: "),
        ("/front topic only Video\r\n", "/front: {only: [Video], note: "),
    ],
)
def test_a_line_of_a_file_says_of_its_element_what_is_taken_away(
    tmp_path: Path, by_keys: ByKeys, line: str, label: str
) -> None:
    robot_of(tmp_path, TWO_KINDS, LEAKING)
    told = by_keys(tmp_path, "1").stdout
    assert "'1' takes data away; where no terminal is, a line says it, and no more keys are read: " in told
    assert "/front topic only Video\n" in told
    done = by_keys(tmp_path, line)
    assert "1 answer in l.yaml" in done.stdout
    assert label in text_of(tmp_path)


def test_a_line_that_ends_data_says_the_node_and_the_method(tmp_path: Path, by_keys: ByKeys) -> None:
    nodes = {"eye": (["/a/image"], []), "face_detector": (["/faces"], ["/a/image"]), "box": ([], ["/faces"])}
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    types = "topics:\n  /a/image: {types: [sensor_msgs/msg/Image]}\n  /faces: {types: [hri_msgs/msg/IdsList]}\n"
    (tmp_path / "l.yaml").write_text(SOURCE + types, "utf-8")
    by_keys(tmp_path, "nnq")
    assert "0 ends Video (drop)" in by_keys(tmp_path, "Aq").stdout
    before = text_of(tmp_path)
    for wrong in ("0", "/face_detector node sanitizer Video anonymise\n", "/box node sanitizer Video drop\n"):
        by_keys(tmp_path, f"{wrong}q")
        assert text_of(tmp_path) == before
    done = by_keys(tmp_path, "/face_detector node sanitizer Video drop\nq")
    assert "1 answer in l.yaml" in done.stdout
    assert "/face_detector: {sanitizer: {Video: drop}, note: " in text_of(tmp_path)


@pytest.mark.slow
def test_nothing_is_taken_away_in_a_group(robot: Path, by_keys: ByKeys) -> None:
    """It is said of one row, which a line picks; or it was opened before."""
    through = "s"
    group = by_keys(robot, f"{through} 0 q")
    assert "topic /a" in group.stdout
    assert "'0' is no answer here" in group.stdout
    two = by_keys(robot, f"{through} /a topic never Video; /b topic never Video\n")
    assert "is no answer here" in two.stdout
    assert text_of(robot) == SOURCE
    picked = by_keys(robot, f"{through} A /b topic never Video\nq")
    assert "B: " in picked.stdout
    assert "  A: " in picked.stdout
    text = text_of(robot)
    assert '  /b: {never: [Video], note: "answered by Ada on 2026-01-01"}' in text
    assert "/a:" not in text
    (robot / "l.yaml").write_text(SOURCE, "utf-8")
    by_keys(robot, f"{through} o y s /c topic never Video\nq")
    text = text_of(robot)
    assert "/a: {sensitive: [Video]" in text
    assert "/b:" not in text
    assert "/c: {never: [Video]" in text


@pytest.mark.parametrize(("keys", "kept"), [("AB0", []), ("B0", ["/b 0"])])
def test_at_a_terminal_a_key_takes_away_of_one_row(robot: Path, keys: str, kept: list[str]) -> None:
    """Who presses it sees the question."""
    question = next(one for one in asked_of(robot) if one.about == GOES_THROUGH)
    answered: list[str] = []

    def keep(now: LabelQuestion, key: str) -> tuple[str, ...]:
        answered.append(f"{now.rows[0].element.name} {key}")
        return ()

    left = [*keys, "q"]
    person = Pressing(lambda now, _: left.pop(0) if now == question else "s")
    Conversation(lambda: [question] if not answered else [], keep, person).run()
    assert answered == kept
    assert bool(person.remarks) is not bool(kept)


def test_what_takes_data_away_is_asked_anew_if_a_finding_became_known_since(robot: Path) -> None:
    """Somebody writes a leak into the file while the question stands there; a single key closed the finding untold."""
    left = ["0", "q"]

    def late(_: LabelQuestion, __: frozenset[int]) -> str:
        (robot / "l.yaml").write_text(f"{SOURCE}  /customer_bridge: {{leak: [Video]}}\n", "utf-8")
        return left.pop(0)

    def now() -> list[LabelQuestion]:
        channels = [one for one in asked_of(robot) if one.about == GOES_THROUGH]
        return [
            LabelQuestion(GOES_THROUGH, tuple(row for one in channels for row in one.rows if row.element.name == "/b"))
        ]

    def keep(question: LabelQuestion, key: str) -> tuple[str, ...]:
        raise AssertionError((question, key))

    person = Pressing(late)
    assert not Conversation(now, keep, person).run()
    assert person.remarks == [FOUND_SINCE]


def asked_of(robot: Path) -> tuple[LabelQuestion, ...]:
    return asked_now(suggest_labels((str(robot / "p.xml"),), (str(robot / "l.yaml"),), Settings()))


def test_the_finding_that_may_hang_on_an_answer_is_told_before(robot: Path, by_keys: ByKeys) -> None:
    (robot / "l.yaml").write_text(f"{SOURCE}  /customer_bridge: {{leak: [Video]}}\n", "utf-8")
    shown = by_keys(robot, "s s q").stdout
    assert "known findings, which may hang on this:\n       Video: /eye -> /customer_bridge [" in shown


def test_yes_to_everything_hides_neither_a_leak_nor_an_end(robot: Path, by_keys: ByKeys) -> None:
    """A leak or a conduit is no question of yes, and what may be a leak is called a conduit only if it is picked."""
    for more, verdict in (("  /customer_bridge: {leak: [Video]}\n", "leak"), ("", "undetermined")):
        for keys in ("y" * 50, "2" * 50, "s2" * 50):
            (robot / "l.yaml").write_text(SOURCE + more, "utf-8")
            by_keys(robot, keys)
            analysis = rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml")).analysis
            assert analysis.verdict == verdict
            left = {one.element.name for one in analysis.open}
            assert {"/unknown", "/customer_bridge" if not more else "/unknown"} <= left


@pytest.mark.parametrize("keys", ["", "q", "1", "11", "x", "?!\x1b[A\u202e 1 q", "Z A A o n s"])
def test_whenever_it_ends_what_was_answered_is_there(robot: Path, by_keys: ByKeys, keys: str) -> None:
    done = by_keys(robot, keys)
    assert done.returncode == 0
    assert all(sign.isprintable() or sign == "\n" for sign in done.stdout)
    text = text_of(robot)
    assert text.startswith(SOURCE)
    assert ("/customer_bridge" in text) == ("1" in keys or "n" in keys)
    rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml"))


@pytest.mark.slow
def test_a_process_that_is_killed_loses_the_key_in_hand_at_most(robot: Path) -> None:
    with subprocess.Popen(COMMAND, cwd=robot, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL) as process:
        assert process.stdin is not None
        process.stdin.write(b"1")
        process.stdin.flush()
        ends = time.monotonic() + 60
        while "/customer_bridge" not in text_of(robot) and time.monotonic() < ends:
            time.sleep(0.05)
        process.kill()
    assert "/customer_bridge: {leak: [Video]" in text_of(robot)
    rosprivacy.analyze(str(robot / "p.xml"), str(robot / "l.yaml"))


@pytest.mark.slow
def test_at_a_terminal_a_key_needs_no_enter(robot: Path) -> None:
    """After the key that asks about what is left as lists."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(COMMAND, cwd=robot, stdin=theirs, stdout=subprocess.PIPE, bufsize=0) as process:
        assert process.stdout is not None
        shown = b""
        for key in (b"l", b"1", b"q"):
            while not shown.endswith(b"> ") and (more := process.stdout.read(1)):
                shown += more
            wait_for_keys(theirs)
            os.write(ours, key)
            shown += process.stdout.read(1)
        shown += process.stdout.read()
    os.close(ours)
    os.close(theirs)
    assert process.returncode == 0
    assert b"1 answer in l.yaml; the same command goes on from here" in shown
    assert "/customer_bridge: {leak: [Video]" in text_of(robot)


@pytest.mark.parametrize(
    ("text", "more", "message"),
    [
        ("labels: 1\n", [], "l.yaml: nobody says who answers; add --by NAME"),
        ("labels: 1\nauthor: A\nnodes: {/nobody: conduit}\n", [], "l.yaml:3: '/nobody' matches no node"),
    ],
)
def test_bad_input_is_one_line(robot: Path, by_keys: ByKeys, text: str, more: list[str], message: str) -> None:
    (robot / "l.yaml").write_text(text, "utf-8")
    done = by_keys(robot, "y", *more)
    assert done.returncode == 2
    assert done.stderr.startswith(message)
    assert all(LINE.match(line) for line in done.stderr.splitlines())
    assert text_of(robot) == text


@pytest.mark.slow
@pytest.mark.parametrize("keys", [b"\xff\xfe", b"y\xff", b"\0q"])
def test_keys_that_are_no_text_end_it(robot: Path, keys: bytes) -> None:
    done = subprocess.run(COMMAND, cwd=robot, input=keys, capture_output=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
    assert text_of(robot).startswith(SOURCE)


@pytest.mark.parametrize("key", ["1", "n", "/eye node source Voice"])
def test_json_has_no_room_for_answers(robot: Path, by_keys: ByKeys, key: str) -> None:
    text = '{"labels": 1, "author": "A", "nodes": {"/eye": {"source": ["Video"]}}}'
    (robot / "l.yaml").write_text(text, "utf-8")
    done = by_keys(robot, key)
    assert (done.returncode, done.stderr.partition(";")[0]) == (2, "l.yaml: has no room for comments at its end")
    assert text_of(robot) == text


@pytest.mark.parametrize("more", [["--ask"], ["--ask", "--into", "l.yaml", "-f", "json"], ["--by", "Ada"]])
def test_options_that_do_not_go_together(cli: Cli, robot: Path, more: list[str]) -> None:
    assert cli("suggest", "p.xml", *more, cwd=robot).returncode == 2


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_name_gets_into_neither_the_file_nor_the_terminal(
    cli: Cli, tmp_path: Path, by_keys: ByKeys, name: str
) -> None:
    (tmp_path / "p.xml").write_text(policy_of({"camera": ([name], []), "up": ([], [name])}), "utf-8")
    if cli("analyze", "p.xml", cwd=tmp_path).returncode == 2:
        pytest.skip("the policy's reader refuses such a name")
    done = by_keys(tmp_path, "y1ynyy", "--by", 'A"\n- x: y\n# not: z\u202e')
    assert done.returncode == 0
    assert all(sign.isprintable() or sign == "\n" for sign in done.stdout)
    said = rosprivacy.analyze(str(tmp_path / "p.xml"), str(tmp_path / "l.yaml")).document()
    assert {one["element"]["name"] for one in said["roles"]} <= {"/camera", "/up"}


def test_the_last_answer_is_taken_back_and_asked_anew(robot: Path, by_keys: ByKeys) -> None:
    by_keys(robot, "A1 q")
    once = text_of(robot)
    robot_of(robot, NODES, SOURCE)
    done = by_keys(robot, "A1 AB2 u q")
    assert text_of(robot) == once
    assert "1 answer in" in done.stdout
    robot_of(robot, NODES, SOURCE)
    done = by_keys(robot, "A1 u u q")
    assert text_of(robot) == SOURCE
    assert "there is no answer to take back" in done.stdout
    assert "0 answers in" in done.stdout


def test_what_somebody_has_written_since_is_never_taken_back(
    robot: Path, by_keys: ByKeys, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The file is changed between the answer and the key."""
    taking_back = Conversation._take_back

    def edited(conversation: Conversation) -> None:
        with (robot / "l.yaml").open("a") as file:
            file.write("# mine\n")
        taking_back(conversation)

    monkeypatch.setattr(Conversation, "_take_back", edited)
    done = by_keys(robot, "A1 u q")
    assert "somebody has changed the file since: nothing is taken back" in done.stdout
    assert text_of(robot).endswith("# mine\n")
    assert "/customer_bridge" in text_of(robot)


@pytest.mark.parametrize(
    ("reads", "said", "named"),
    [
        ([], "", True),
        (["/rosout", "/parameter_events"], "", True),  # as every node does
        (["/other"], "", False),
        (["/cmd_vel"], "topics: {/cmd_vel: {types: [geometry_msgs/msg/Twist]}}\n", False),  # that carries nothing
        ([], "  /log_shipper: {leak: [PersonalData]}\n", False),
    ],
    ids=["none", "standard channels", "a channel of its own", "one of a type", "somebody has said what it is"],
)
def test_a_node_without_a_channel_of_its_own_is_named_at_the_end(
    by_keys: ByKeys, tmp_path: Path, reads: list[str], said: str, *, named: bool
) -> None:
    """What it does with data it does outside ROS, as who reads log files: no question can be asked about it."""
    nodes: Nodes = {"camera": (["/image"], []), "log_shipper": ([], reads)}
    robot_of(tmp_path, nodes, f"labels: 1\nnodes:\n  /camera: {{source: [Video]}}\n{said}")
    lines = by_keys(tmp_path, "q", "--by", "Ada").stdout.splitlines()
    told = [line for line in lines if line.startswith("not asked about")]
    assert len(told) == named
    assert all(line.endswith(": /log_shipper") for line in told)


@pytest.mark.parametrize(("keys", "named"), [("q", True), ("y", False), ("n", False)])
def test_what_perhaps_brings_data_in_and_nobody_has_answered_is_named_at_the_end(
    by_keys: ByKeys, tmp_path: Path, keys: str, *, named: bool
) -> None:
    """An answer counts a source that is stated only: what is left out of it is told."""
    nodes: Nodes = {"driver": (["/image_raw"], []), "recorder": ([], ["/image_raw"])}
    robot_of(tmp_path, nodes, "labels: 1\nnodes: {/recorder: {leak: [PersonalData]}}\n")
    lines = by_keys(tmp_path, keys * 9, "--by", "Ada").stdout.splitlines()
    told = [line for line in lines if line.startswith("not in this answer")]
    assert told == (["not in this answer: data that perhaps comes from /driver"] if named else [])
