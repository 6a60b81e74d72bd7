"""``suggest --ask`` where several kinds of data get to an element: one question, lists of a kind at most, each kind."""

from __future__ import annotations

from string import ascii_uppercase
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.suggesting.label_questions import GOES_ON, GOES_THROUGH, LISTED, PASSES, LabelQuestion
from rosprivacy.labelling.asking import with_answer
from rosprivacy.labelling.conversation import EACH_KIND, FEWEST, OPEN, QUIT, SKIP, allowed
from rosprivacy.report.suggested_labels.question_lines import keys_line, question_lines
from rosprivacy.settings import Settings
from tests.helpers.asked_by_keys import Pressing, by_keys, conversation_in, pressing, robot_of, text_of
from tests.helpers.command import cli
from tests.helpers.little_robots import policy_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from tests.helpers.asked_by_keys import ByKeys
    from tests.helpers.little_robots import Nodes

__all__ = ["by_keys", "cli"]

CHANNELS = ("/a", "/b", "/c", "/d")
NODES: Nodes = {
    "one": (["/in"], []),
    "two": (["/in", "/seen"], []),
    "middle": (list(CHANNELS), ["/in"]),
    "here": ([], [*CHANNELS, "/seen"]),
}
HEAD = "labels: 1\nauthor: Ada\nnodes:\n  /one: {source: [Video]}\n  /two: {source: [Voice]}\n"
REVIEWED = HEAD + "  /middle: conduit\n  /here: conduit\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return robot_of(tmp_path, NODES, REVIEWED)


def found(folder: Path, file: str = "l.yaml") -> set[str]:
    analysis = rosprivacy.analyze(str(folder / "p.xml"), str(folder / file)).analysis
    return {one.id for one in analysis.findings}


def said(folder: Path, file: str) -> list[tuple[object, ...]]:
    """All statements about channels, without who said so and why."""
    bound = rosprivacy.analyze(str(folder / "p.xml"), str(folder / file)).bound
    return sorted(
        {
            (vertex, one.role, one.categories)
            for vertex, there in bound.elements.items()
            for one in there
            if one.role in ("sensitive", "only", "never") and not one.shipped
        }
    )


def test_channels_that_different_data_reach_are_one_question_and_each_row_names_its_own(robot: Path) -> None:
    person = pressing()
    conversation_in(robot, person).run()
    (question,) = person.asked
    assert {row.element.name: row.kinds for row in question.rows} == {
        "/in": ("Video", "Voice"), "/seen": ("Voice",), **dict.fromkeys(CHANNELS, ("Video", "Voice")),
    }  # fmt: skip


def test_a_digit_says_the_same_kind_of_each_row_and_nothing_of_a_row_that_only_one_kind_reaches(robot: Path) -> None:
    person = pressing()
    conversation_in(robot, person).run()
    for row in person.asked[0].rows:
        kinds = {one.key: one.label.roles["only"] for one in row.replies if "only" in one.label.roles}
        assert kinds == ({"1": ["Video"], "2": ["Voice"]} if len(row.kinds) > 1 else {})


class Listing:
    """Somebody who picks channels, presses a key that takes data away, and answers the list; all else comes later."""

    def __init__(self, names: Sequence[str], key: str, *last: str) -> None:
        self.names, self.digit, self.last = names, key, [*last]
        self.lists: list[LabelQuestion] = []
        self.remarks: list[str] = []

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str:
        if question.about == LISTED:
            self.lists.append(question)
            return self.last.pop(0) if self.last else str(len(question.rows))
        wanted = [
            at
            for at, row in enumerate(question.rows)
            if row.element.name in self.names and row.reply(self.digit) and question.about == GOES_THROUGH
        ]
        if len(wanted) < FEWEST or self.lists:
            return SKIP
        left = [at for at in wanted if at not in picked]
        return ascii_uppercase[left[0]] if left else self.digit

    def remark(self, remark: str) -> None:
        self.remarks.append(remark)


@pytest.mark.parametrize("wrong", ["", "2", "4", "y", "1", "33", QUIT])
def test_a_list_of_one_kind_at_most_is_confirmed_by_its_number_alone(robot: Path, wrong: str) -> None:
    conversation_in(robot, Listing(["/a", "/b", "/c"], "2", wrong, QUIT)).run()
    assert text_of(robot) == REVIEWED


def test_each_label_of_a_list_of_one_kind_at_most_tells_it(robot: Path) -> None:
    person = Listing(["/a", "/b", "/c"], "2")
    conversation_in(robot, person).run()
    assert sorted(row.element.name for row in person.lists[0].rows) == ["/a", "/b", "/c"]
    assert "Is it so that of Video and Voice only Voice goes through each of these?" in question_text(person.lists[0])
    assert keys_line(person.lists[0], (), ()).startswith("  3 and Enter for Voice at most in all 3, ")
    text = text_of(robot)
    for name in ("/a", "/b", "/c"):
        assert f'  {name}: {{only: [Voice], note: "answered by Ada on 2026-11-23 in a list of 3"}}' in text
    assert "/d:" not in text


def test_of_rows_that_nobody_picked_no_kind_is_said_together(robot: Path) -> None:
    person = pressing("1", QUIT)
    conversation_in(robot, person).run()
    assert person.remarks == ["'1' is no answer here"]
    assert text_of(robot) == REVIEWED


@pytest.mark.parametrize("keys", ["AB1", "AB12\n", "AB1\n2\n", "1", "AB0"])
def test_no_digit_of_a_file_of_keys_makes_such_a_list(robot: Path, by_keys: ByKeys, keys: str) -> None:
    assert "no more" in by_keys(robot, keys).stdout
    assert text_of(robot) == REVIEWED


def test_the_channel_by_which_alone_a_known_finding_is_left_is_asked_by_itself(robot: Path) -> None:
    """Voice gets to the leak by both: the list has one of them, and the other is asked with the finding."""
    robot_of(robot, NODES | {"out": ([], ["/b", "/c"])}, f"{REVIEWED}  /out: {{leak: [Voice]}}\n")
    before = found(robot)
    person = Listing(["/a", "/b", "/c"], "1")
    conversation_in(robot, person).run()
    assert {row.element.name for row in person.lists[0].rows} == {"/a", "/b"}
    assert person.remarks == ["topic /c: it could close a known finding, and is asked by itself"]
    shown = question_text(person.lists[0])
    assert "known findings, of which this list closes none:\n       Voice: /two -> /out [" in shown
    assert found(robot) == before


def question_text(question: LabelQuestion) -> str:
    return "\n".join(question_lines(question))


def test_each_kind_is_asked_by_itself_where_a_person_wants_it(robot: Path) -> None:
    """Of one row: one kind can go through, the other cannot; the others are asked as before."""
    name = "/a"
    first = pressing()
    conversation_in(robot, first).run()
    at = [row.element.name for row in first.asked[0].rows].index(name)
    person = pressing(ascii_uppercase[at], EACH_KIND)
    conversation_in(robot, person).run()
    rows = {row.kinds: row for row in person.asked[1].rows if row.element.name == name}
    assert list(rows) == [("Video",), ("Voice",)]
    assert [[one.label.roles for one in row.replies] for row in rows.values()] == [
        [{"sensitive": ["Video"]}, {"never": ["Video"]}], [{"sensitive": ["Voice"]}, {"never": ["Voice"]}],
    ]  # fmt: skip
    assert {row.kinds for row in person.asked[1].rows if row.element.name not in (name, "/seen")} == {
        ("Video", "Voice")
    }


def test_one_kind_may_be_let_out_and_the_other_passed_on(robot: Path, by_keys: ByKeys) -> None:
    (robot / "l.yaml").write_text(f"{HEAD}  /here: conduit\n", "utf-8")
    shown = by_keys(robot, "k A1 2 q").stdout
    assert "1 lets out (Video and Voice), 2 only passes on or drops (Video and Voice)" in shown
    text = text_of(robot)
    assert "/middle: {conduit: [Voice], leak: [Video], " in text


def test_a_question_mark_says_what_each_key_means_and_answers_nothing(robot: Path, by_keys: ByKeys) -> None:
    shown = by_keys(robot, "?q").stdout
    for line in (
        "  y  yes (such data as stand beside it)\n",
        "  0  none of it (such data as stand beside it): pick one row; or several, which are then shown",
        "  k  asks about each kind of data by itself\n",
        "  A-Z  picks a row, or puts it back",
    ):
        assert line in shown
    assert "0 answers in l.yaml" in shown


def test_a_leak_among_nodes_is_known_before_channels_are_asked_about(robot: Path) -> None:
    """Also of a node that data reach behind another open one: it is asked in the same question as that."""
    nodes: Nodes = NODES | {"behind": (["/e"], ["/d"]), "end": ([], ["/e"])}
    robot_of(robot, nodes, HEAD)
    first = pressing()
    conversation_in(robot, first).run()
    names = [row.element.name for row in first.asked[0].rows]
    assert sorted(names) == ["/behind", "/end", "/here", "/middle"]
    person = pressing(ascii_uppercase[names.index("/end")], "1", *"ABC", "2")
    conversation_in(robot, person).run()
    assert [one.about for one in person.asked] == [GOES_ON, GOES_ON, GOES_THROUGH]
    assert {one.partition(" [")[0].partition("-> ")[2] for one in person.asked[-1].rows[0].closes} == {"/end"}


def test_what_may_be_a_leak_comes_first_and_is_called_a_conduit_only_if_it_is_picked(robot: Path) -> None:
    """Something suggests it of the uploader, and nobody knows it of an end; the node between passes data on."""
    nodes: Nodes = {"one": (["/in"], []), "middle": (["/a"], ["/in"]), "end": ([], ["/a"]), "uploader": ([], ["/a"])}
    robot_of(robot, nodes, "labels: 1\nnodes:\n  /one: {source: [Video]}\n")
    person = pressing("2", "A", "1")
    conversation_in(robot, person).run()
    question = person.asked[0]
    assert [(row.element.name, row.doubtful) for row in question.rows] == [
        ("/uploader", True), ("/middle", False), ("/end", True),
    ]  # fmt: skip
    assert person.remarks == ["'2' is no answer here"]
    assert {picked: PASSES in allowed(question, picked) for picked in ((), (1,), (0, 2), (0, 1, 2))} == {
        (): False, (1,): True, (0, 2): True, (0, 1, 2): True,
    }  # fmt: skip
    assert PASSES in allowed(LabelQuestion(GOES_ON, (question.rows[1],)))
    text = text_of(robot)
    assert "/uploader: {leak: [Video], note: \"answered by Ada on 2026-11-23: 'uploader' in the name" in text


def test_a_leak_that_became_known_in_the_same_question_is_told_before_a_node_ends_such_data(robot: Path) -> None:
    nodes: Nodes = {"one": (["/image"], []), "counter": (["/joints"], ["/image"]), "end": ([], ["/joints"])}
    (robot / "p.xml").write_text(policy_of(nodes), "utf-8")
    types = "topics:\n  /image: {types: [sensor_msgs/msg/CompressedImage]}\n"
    types += "  /joints: {types: [sensor_msgs/msg/JointState]}\n"
    (robot / "l.yaml").write_text(f"labels: 1\nnodes:\n  /one: {{source: [Video]}}\n{types}", "utf-8")

    keys = ["B", "1"]
    person = Pressing(lambda question, _: SKIP if question.about != GOES_ON else keys.pop(0) if keys else QUIT)
    conversation_in(robot, person).run()
    first, *_, last = [one for one in person.asked if one.about == GOES_ON]
    assert [(row.element.name, row.closes) for row in first.rows] == [("/counter", ()), ("/end", ())]
    ((name, closes),) = [(row.element.name, row.closes) for row in last.rows]
    assert name == "/counter"
    assert [told.partition(" [")[0] for told in closes] == ["Video: /one -> /end"]


def test_a_finding_of_what_is_made_of_the_data_is_told_before_these_are_taken_away(robot: Path) -> None:
    nodes: Nodes = {"one": (["/in"], []), "worker": (["/made"], ["/in"]), "end": ([], ["/made"])}
    (robot / "p.xml").write_text(policy_of(nodes), "utf-8")
    made = "derives: [{from: Video, to: FaceTemplate}], sanitizer: {Video: drop}"
    text = f"labels: 1\nnodes:\n  /one: {{source: [Video]}}\n  /worker: {{{made}}}\n  /end: {{leak: [FaceTemplate]}}\n"
    (robot / "l.yaml").write_text(f"{text}topics:\n  /made: sensitive\n", "utf-8")
    person = pressing()
    conversation_in(robot, person).run()
    (row,) = person.asked[0].rows
    assert (row.element.name, row.kinds) == ("/in", ("Video",))
    assert [told.partition(" [")[0] for told in row.closes] == ["FaceTemplate: /one -> /end"]


def test_one_kind_at_most_is_not_said_of_a_channel_that_a_person_says_carries_another(robot: Path) -> None:
    """Both at once would be no label file (S7)."""
    (robot / "l.yaml").write_text(f"{REVIEWED}topics:\n  /a: {{sensitive: [Location]}}\n", "utf-8")
    person = pressing()
    conversation_in(robot, person).run()
    keys = {row.element.name: [one.key for one in row.replies] for row in person.asked[0].rows}
    assert (keys["/a"], keys["/b"]) == (["y", "0"], ["y", "1", "2", "0"])


def test_what_takes_data_away_of_a_topic_takes_none_of_a_service_of_its_name(robot: Path) -> None:
    """Where a line of channels speaks of both, the topic gets a line of its own."""
    (robot / "l.yaml").write_text(f"{REVIEWED}channels:\n  /a: {{sensitive: [Location]}}\n", "utf-8")
    first = pressing()
    conversation_in(robot, first).run()
    at = [row.element.name for row in first.asked[0].rows].index("/a")
    conversation_in(robot, pressing(ascii_uppercase[at], "0")).run()
    text = text_of(robot)
    assert "channels:\n  /a: {sensitive: [Location]}\ntopics:\n  /a: {never: [Video, Voice], note: " in text


def test_one_by_one_speaks_of_the_rows_that_are_picked(robot: Path) -> None:
    person = pressing("A", "B", OPEN)
    conversation_in(robot, person).run()
    rest = len(person.asked[0].rows) - 2
    person = pressing("A", "B", OPEN, "y", "y")
    conversation_in(robot, person).run()
    assert [len(one.rows) for one in person.asked] == [rest + 2, 1, 1, rest]


@pytest.mark.parametrize("keys", ["AB", "BC", "\x1b[A"])
def test_signs_that_come_at_once_pick_no_row(robot: Path, keys: str) -> None:
    """Who types A and B fast and then 0 wants a list, and does not say it of A alone."""
    person = pressing(keys, "0")
    conversation_in(robot, person).run()
    assert person.remarks == [f"{keys!r} is no answer here", "'0' is no answer here"]
    assert text_of(robot) == REVIEWED


def test_what_comes_later_is_not_asked_again_when_fewer_kinds_get_there(robot: Path) -> None:
    def later(_: LabelQuestion, __: frozenset[int]) -> str:
        (robot / "l.yaml").write_text(REVIEWED.replace("  /two: {source: [Voice]}\n", ""), "utf-8")
        return SKIP

    person = Pressing(later)
    assert conversation_in(robot, person).run()
    assert len(person.asked) == 1


def test_what_is_written_by_hand_meanwhile_is_read_after_later(robot: Path) -> None:
    keys = ["A", SKIP]

    def writing(_: LabelQuestion, __: frozenset[int]) -> str:
        (robot / "l.yaml").write_text(f"{REVIEWED}channels:\n  '/?': sensitive\n", "utf-8")
        return keys.pop(0) if keys else QUIT

    person = Pressing(writing)
    conversation_in(robot, person).run()
    names = [[row.element.name for row in one.rows] for one in person.asked]
    assert len(names[0]) == len(CHANNELS) + 2
    assert names[1:]
    assert not {*CHANNELS} & {*names[1]}


@pytest.mark.slow
@given(
    kinds=st.lists(st.sampled_from(["Video", "Voice", "Location"]), min_size=2, max_size=3, unique=True),
    middle=st.lists(st.sampled_from(CHANNELS), min_size=2, unique=True),
    second=st.lists(st.sampled_from(CHANNELS), unique=True),
    ends=st.lists(st.lists(st.sampled_from(CHANNELS), min_size=1, unique=True), min_size=1, max_size=3),
    picked=st.sets(st.sampled_from(CHANNELS), min_size=2),
    key=st.sampled_from("0123"),
    apart=st.booleans(),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_list_closes_no_known_finding_and_says_what_single_answers_say(
    tmp_path: Path,
    kinds: list[str],
    middle: list[str],
    second: list[str],
    ends: list[list[str]],
    picked: set[str],
    key: str,
    *,
    apart: bool,
) -> None:
    """Whatever is picked, and also where each kind is asked by itself."""
    nodes: Nodes = {f"source{at}": (["/in"], []) for at in range(len(kinds))}
    nodes |= {"middle": (middle, ["/in"]), "second": (second, [middle[0]])}
    nodes |= {f"end{at}": ([], channels) for at, channels in enumerate(ends)}
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    text = "labels: 1\nnodes:\n  /middle: conduit\n  /second: conduit\n"
    text += "".join(f"  /source{at}: {{source: [{kind}]}}\n" for at, kind in enumerate(kinds))
    text += "".join(f"  /end{at}: {{leak: [{kinds[at % len(kinds)]}]}}\n" for at in range(len(ends)))
    for file in ("l.yaml", "alone.yaml"):
        (tmp_path / file).write_text(text, "utf-8")
    before = found(tmp_path)
    person = EachKind(sorted(picked), key) if apart else Listing(sorted(picked), key)
    conversation_in(tmp_path, person).run()
    assert found(tmp_path) == before
    alone = tmp_path / "alone.yaml"
    for row in [row for one in person.lists[:1] for row in one.rows]:
        single = LabelQuestion(GOES_THROUGH, (row,))
        alone.write_text(with_answer(str(alone), single, key, "Ada", "2026-11-23", Settings()).text, "utf-8")
    assert said(tmp_path, "l.yaml") == said(tmp_path, "alone.yaml")


class EachKind(Listing):
    """The same, of each kind by itself: of every row that is about one kind."""

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str:
        if question.about == GOES_THROUGH and any(row.by_kind for row in question.rows):
            return EACH_KIND
        return super().key(question, picked)


class Anybody:
    """Somebody who presses what comes; but of one channel or node by itself he takes nothing away."""

    def __init__(self, draw: Callable[[Sequence[str]], str]) -> None:
        self.draw, self.left = draw, 40
        self.next: list[str] = []

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str:
        self.left -= 1
        if self.left < 0:
            return QUIT
        letters = ascii_uppercase[: len(question.rows)]
        if question.about == LISTED:
            self.next = []
            left = str(len(question.rows) - len(picked))
            return self.draw([left, left, *letters, OPEN, SKIP])
        if not self.next:
            rows = {at for at in range(len(letters)) if len(letters) > 1 and self.draw("yyn") == "y"}
            said = {reply.key for row in question.rows for reply in row.replies if reply.takes_away}
            keys = [key for key in allowed(question, rows) if len(rows or letters) > 1 or key not in said]
            taking = [key for key in keys if key in said]
            key = self.draw([*keys, *taking, *taking, *taking, "?"])
            self.next = [*(letters[at] for at in sorted(rows ^ picked)), key]
        return self.next.pop(0)

    def remark(self, remark: str) -> None:
        pass


@pytest.mark.slow
@given(
    data=st.data(),
    edges=st.lists(st.tuples(st.integers(1, 4), st.sampled_from(CHANNELS), st.integers(1, 4)), max_size=6),
    kinds=st.lists(st.sampled_from(["Video", "Voice", "Location"]), min_size=1, max_size=3),
    leaks=st.sets(st.integers(1, 4), min_size=1, max_size=2),
    reviewed=st.booleans(),
)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_is_pressed_no_known_finding_is_closed_but_by_what_is_said_of_one_element(
    tmp_path: Path,
    data: st.DataObject,
    edges: list[tuple[int, str, int]],
    kinds: list[str],
    leaks: set[int],
    *,
    reviewed: bool,
) -> None:
    """A leak nearer to the source may stand for one behind it: the data of that source are let out as before."""
    nodes: Nodes = {"first": ([*CHANNELS], ["/in"]), **{f"n{at}": ([], [CHANNELS[at - 1]]) for at in range(1, 5)}}
    nodes |= {f"source{at}": (["/in"], []) for at in range(len(kinds))}
    for start, channel, end in edges:
        nodes[f"n{start}"][0].append(channel)
        nodes[f"n{end}"][1].append(channel)
    (tmp_path / "p.xml").write_text(policy_of(nodes), "utf-8")
    text = "labels: 1\nnodes:\n"
    text += "".join(f"  /source{at}: {{source: [{kind}]}}\n" for at, kind in enumerate(kinds))
    text += "".join(f"  /n{at}: {{leak: [PersonalData]}}\n" for at in sorted(leaks))
    passing = ["first", *(f"n{at}" for at in range(1, 5) if at not in leaks)]
    text += "".join(f"  /{name}: conduit\n" for name in passing if reviewed)
    (tmp_path / "l.yaml").write_text(text, "utf-8")
    known = let_out(tmp_path)
    asking = conversation_in(tmp_path, Anybody(lambda keys: data.draw(st.sampled_from(keys))))
    keep = asking.keep

    def kept(question: LabelQuestion, key: str) -> tuple[str, ...]:
        nonlocal known
        remarks = keep(question, key)
        now = let_out(tmp_path)
        assert known <= now, (question, key)
        known = now
        return remarks

    asking.keep = kept
    asking.run()


def let_out(folder: Path) -> set[tuple[str, str]]:
    analysis = rosprivacy.analyze(str(folder / "p.xml"), str(folder / "l.yaml")).analysis
    return {(one.category, one.source.name) for one in analysis.findings}
