"""``rosprivacy diff``: what is new, gone and changed between two states, and the exit code that CI goes by."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.report.compare.matching import compare, normalised
from tests.helpers.command import run
from tests.helpers.fleet_files import policy, write

if TYPE_CHECKING:
    from tests.helpers.command import Cli, Done

Facts = dict[tuple[str, ...], dict[str, Any]]
SAVED = '"verdict": "leak", "findings": %s, "open": [], "carries": [], "roles": []}'
LABELS = "labels: 1\nnodes:\n  /camera: {source: [Video]}\n  /screen: {leak: [Video]}\n  /blur: {sanitizer: [Video]}\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    write("old.xml", policy("/camera>/image", "/blur>/clean</image", "/screen</clean"))
    write("new.xml", policy("/camera>/image", "/blur>/clean</image", "/screen</clean,/image", "/log</clean"))
    write("l.yaml", LABELS)
    return tmp_path


def parsed(done: Done) -> dict[str, Any]:
    return dict(json.loads(done.stdout))


def made_up(word: str) -> bool:
    address = len(word) >= 8 and set(word) <= set("0123456789abcdef") and any(map(str.isdigit, word))
    return address or (len(word) >= 3 and word.isdigit())


class TestNames:
    @pytest.mark.parametrize(
        ("name", "plain"),
        [
            ("/transform_listener_impl_5591c2d0", "/transform_listener_impl_*"),
            ("/transform_listener_impl_aaaac2d0f1e0/get_parameters", "/transform_listener_impl_*/get_parameters"),
            ("/rviz2_31337", "/rviz2_*"),
            ("/launch_ros_4711", "/launch_ros_*"),
            ("/moveit_1604932", "/moveit_*"),
            ("/talker_4711_1700000000000", "/talker_*"),
            ("/_ros2cli_12345", "/_ros2cli_*"),
            ("/camera_1", "/camera_1"),  # a second camera is no other run
            ("/camera_12", "/camera_12"),
            ("/arm_deadbeef", "/arm_deadbeef"),  # a word
            ("/image_raw", "/image_raw"),
            ("/scan_100hz", "/scan_100hz"),
        ],
    )
    def test_what_a_program_makes_up_is_left_out(self, name: str, plain: str) -> None:
        assert normalised(name) == plain

    def test_many_words_that_may_be_made_up_take_no_time(self) -> None:
        """30 such words were not done in a minute."""
        name = "/a" + "_00000000" * 30 + "x"
        policies = [policy(f"{name}>/{end}", f"/screen</{end}") for end in ("old", "new")]
        for state, text in zip(("old", "new"), policies, strict=True):
            write(f"{state}.xml", text)
        write("l.yaml", f"labels: 1\nnodes: {{{name}: {{source: [Video]}}, /screen: {{leak: [Video]}}}}\n")
        done = run("diff", "old.xml", "new.xml", "-l", "l.yaml", seconds=60)
        assert "verdict: leak" in done.stdout

    @given(st.from_regex(r"(/a)?(_[0af]{1,9}|_x|/){1,4}", fullmatch=True))
    def test_a_name_is_cut_as_its_words_say(self, name: str) -> None:
        """Of each part of a name the words at its end, word by word; written without a pattern for the whole."""
        parts = []
        for part in name.split("/"):
            first, *words = part.split("_")
            kept = len(words)
            while kept and made_up(words[kept - 1]):
                kept -= 1
            parts.append("_".join([first, *words[:kept], *(["*"] if kept < len(words) else [])]))
        assert normalised(name) == "/".join(parts)

    def test_the_very_same_name_counts_more(self) -> None:
        before: Facts = {("/robot_100",): {"x": 1}, ("/robot_200",): {"x": 2}}
        after: Facts = {("/robot_200",): {"x": 2}, ("/robot_300",): {"x": 1}}
        assert not compare(before, after)

    def test_what_has_no_counterpart_is_new_or_gone(self) -> None:
        found = compare({("/a_100",): {}, ("/a_200",): {}, ("/b",): {}}, {("/a_300",): {}, ("/c",): {}})
        assert [change.key for change in found.new] == [("/c",)]
        assert [change.key for change in found.removed] == [("/a_200",), ("/b",)]

    def test_names_inside_a_record_are_compared_without_it_too(self) -> None:
        before: Facts = {("/x",): {"way": ["/a_100", "/b"]}}
        assert not compare(before, {("/x",): {"way": ["/a_200", "/b"]}})
        assert compare(before, {("/x",): {"way": ["/c", "/b"]}}).changed


class TestPolicies:
    def test_what_is_new_gone_and_changed(self, cli: Cli) -> None:
        done = cli("diff", "old.xml", "new.xml", "-l", "l.yaml", "-f", "json")
        found = parsed(done)
        assert done.returncode == 1
        assert [row["name"] for row in found["grants"]["new"]] == ["/clean", "/image"]
        assert found["grants"]["gone"] == found["grants"]["changed"] == []
        assert [row["name"] for row in found["elements"]["new"]] == ["/log"]
        (changed,) = found["findings"]["changed"]
        assert (changed["source"], changed["leak"]) == ("node /camera", "node /screen")
        assert (changed["before"]["pseudonymised"], changed["after"]["pseudonymised"]) == (True, False)
        assert found["worse"]

    def test_the_other_way_round_nothing_is_worse(self, cli: Cli) -> None:
        done = cli("diff", "new.xml", "old.xml", "-l", "l.yaml")
        assert done.returncode == 0
        assert "  ~ Video: node /camera -> node /screen" in done.stdout.splitlines()
        assert "      pseudonymised: no before, yes now" in done.stdout.splitlines()
        assert "  - node /log" in done.stdout.splitlines()
        assert cli("diff", "new.xml", "old.xml", "-l", "l.yaml", "--fail-on", "any").returncode == 1

    def test_a_changed_rule(self, cli: Cli) -> None:
        write("new.xml", policy("/camera>/image", "/blur>/clean</image", "/screen<!/clean"))
        found = parsed(cli("diff", "old.xml", "new.xml", "-f", "json"))
        (changed,) = found["grants"]["changed"]
        assert (changed["before"], changed["after"]) == ({"rule": "ALLOW"}, {"rule": "DENY"})

    def test_the_same_is_the_same(self, cli: Cli) -> None:
        done = cli("diff", "old.xml", "old.xml", "-l", "l.yaml", "--fail-on", "any")
        assert done.returncode == 0
        assert done.stdout.splitlines()[::3] == ["verdict: leak", "nothing differs"]

    def test_other_lines_and_files_are_no_difference(self, cli: Cli) -> None:
        write("other.xml", "<!-- -->\n\n" + Path("old.xml").read_text("utf-8").replace("><", ">\n<"))
        assert "nothing differs" in cli("diff", "old.xml", "other.xml", "-l", "l.yaml").stdout

    def test_nodes_with_made_up_names_are_matched(self, cli: Cli) -> None:
        for state, number in (("old", "5591c2d0"), ("new", "5591c2ff")):
            node = f"/transform_listener_impl_{number}"
            write(f"{state}.xml", policy("/camera>/image", f"{node}>{node}/state</image", f"/screen<{node}/state"))
        labels = "labels: 1\nnodes: {/camera: {source: [Video]}, /screen: {leak: [Video]}}\n"
        write("l.yaml", labels)
        done = cli("diff", "old.xml", "new.xml", "-l", "l.yaml", "--fail-on", "any")
        assert done.returncode == 0
        assert done.stdout.splitlines()[::3] == ["verdict: leak", "nothing differs"]

    def test_other_labels_before(self, cli: Cli) -> None:
        write("before.yaml", LABELS.replace("  /screen: {leak: [Video]}\n", ""))
        found = parsed(cli("diff", "old.xml", "old.xml", "-l", "l.yaml", "--old-labels", "before.yaml", "-f", "json"))
        assert [row["leak"] for row in found["findings"]["new"]] == ["node /screen"]
        assert found["worse"]

    def test_a_finding_behind_a_leak_is_not_worse(self, cli: Cli) -> None:
        write("new.xml", policy("/camera>/image", "/blur>/clean</image", "/screen>/shown</clean", "/wall</shown"))
        write("l.yaml", LABELS + "  /wall: {leak: [Video]}\n")
        write("before.yaml", LABELS)
        done = cli("diff", "old.xml", "new.xml", "-l", "l.yaml", "--old-labels", "before.yaml", "-f", "json")
        assert [row["after"]["dismissed"] for row in parsed(done)["findings"]["new"]] == [True]
        assert done.returncode == 0

    def test_what_is_accepted_is_not_worse(self, cli: Cli) -> None:
        write("d.yaml", "decisions: 1\nfindings: [{leak: /screen, decision: accept, reason: r, owner: o}]\n")
        done = cli("diff", "old.xml", "new.xml", "-l", "l.yaml", "--decisions", "d.yaml", "-f", "json")
        (changed,) = parsed(done)["findings"]["changed"]
        assert (changed["after"]["pseudonymised"], changed["after"]["accepted"]) == (False, True)
        assert done.returncode == 0

    def test_what_was_accepted_and_is_no_longer_is_worse(self, cli: Cli) -> None:
        write("d.yaml", "decisions: 1\nfindings: [{leak: /screen, decision: accept, reason: r, owner: o}]\n")
        cli("analyze", "old.xml", "-l", "l.yaml", "--decisions", "d.yaml", "-f", "json", "-o", "old.json")
        done = cli("diff", "old.json", "old.xml", "-l", "l.yaml", "-f", "json")
        (changed,) = parsed(done)["findings"]["changed"]
        assert (changed["before"]["accepted"], changed["after"]["accepted"]) == (True, False)
        assert done.returncode == 1


class TestSaved:
    def test_what_was_asked_otherwise_is_told(self, cli: Cli) -> None:
        """Else what was not asked for would look as if it were gone."""
        cli("analyze", "new.xml", "-l", "l.yaml", "-f", "json", "-o", "all.json")
        cli("analyze", "new.xml", "-l", "l.yaml", "-f", "json", "-c", "Voice", "--view", "enforced", "-o", "voice.json")
        done = cli("diff", "all.json", "voice.json")
        lines = done.stdout.splitlines()
        assert "asked otherwise: view: declared before, enforced now" in lines
        assert "asked otherwise: categories_asked: all before, Voice now" in lines
        text = cli("diff", "all.json", "voice.json", "-f", "markdown").stdout
        assert "Asked otherwise: `categories_asked` was `all`, is `Voice`." in text

    def test_a_saved_analysis(self, cli: Cli) -> None:
        cli("analyze", "old.xml", "-l", "l.yaml", "-f", "json", "-o", "old.json")
        done = cli("diff", "old.json", "new.xml", "-l", "l.yaml")
        assert done.returncode == 1
        assert "grants: not compared, the policies of one side are not at hand" in done.stdout
        assert "  ~ Video: node /camera -> node /screen" in done.stdout.splitlines()
        assert "nothing differs" in cli("diff", "old.json", "old.xml", "-l", "l.yaml").stdout

    def test_a_saved_graph(self, cli: Cli) -> None:
        cli("analyze", "old.xml", "--save-graph", "old.json", "-q")
        done = cli("diff", "old.json", "new.xml", "-l", "l.yaml", "-f", "json")
        assert [row["name"] for row in parsed(done)["grants"]["new"]] == ["/clean", "/image"]

    @pytest.mark.parametrize(
        ("text", "problem"),
        [
            (
                '{"format": "rosprivacy.analysis/1"}',
                "old.json: damaged or changed: the document lacks verdict, view, categories, findings",
            ),
            ('{"format": "rosprivacy.analysis/1",', "old.json:1: not JSON, or not to its end: "),
            (
                '{"format": "rosprivacy.analysis/1", ' + SAVED % "[1]",
                "old.json: damaged or changed: findings[0] is a number, not an object",
            ),
            (
                '{"format": "rosprivacy.analysis/3", ' + SAVED % "[]",
                "old.json: is of the format rosprivacy.analysis/3, and this version reads rosprivacy.analysis/1 and ",
            ),
            ("fleet: 2", "old.json:1: fleet format '2'"),
        ],
    )
    def test_what_cannot_be_read(self, cli: Cli, text: str, problem: str) -> None:
        write("old.json", text)
        done = cli("diff", "old.json", "new.xml")
        assert done.returncode == 2
        assert done.stderr.startswith(problem)

    def test_a_file_that_is_not_there(self, cli: Cli) -> None:
        done = cli("diff", "no.xml", "new.xml")
        assert (done.returncode, done.stderr) == (2, "no.xml: file not found; correct the path\n")


FLEET = "fleet: 1\nmodels: {m: {policies: old.xml, labels: l.yaml}}\ngroups: [{robots: %s, model: m}]\n"


class TestFleets:
    def test_more_robots(self, cli: Cli) -> None:
        write("a.yaml", FLEET % 3)
        write("b.yaml", FLEET % 4)
        done = cli("diff", "a.yaml", "b.yaml", "-f", "json")
        found = parsed(done)
        assert [row["robot"] for row in found["robots"]["new"]] == ["m_4"]
        (changed,) = found["findings"]["changed"]
        assert (changed["before"]["findings"], changed["after"]["findings"]) == (3, 4)
        assert found["elements"] == {"new": [], "gone": [], "changed": []}
        assert done.returncode == 1
        assert cli("diff", "b.yaml", "a.yaml").returncode == 0

    def test_which_robot_is_shown_makes_no_difference(self, cli: Cli) -> None:
        write("a.yaml", FLEET % 3)
        write("own.yaml", "labels: 1\nnodes: {/blur: {sanitizer: {Video: drop}}}\n")
        write("b.yaml", FLEET.replace("groups", "robots: {a_1: {model: m, labels: own.yaml}}\ngroups") % 3)
        found = parsed(cli("diff", "a.yaml", "b.yaml", "-f", "json"))
        assert found["findings"] == {"new": [], "gone": [], "changed": []}
        assert [row["robot"] for row in found["robots"]["new"]] == ["a_1"]

    def test_one_robot_less_protected_is_worse(self, cli: Cli) -> None:
        write("own.yaml", "labels: 1\nnodes: {/blur: conduit}\n")
        write("a.yaml", FLEET.replace("groups", "robots: {x: {model: m}}\ngroups") % 3)
        write("b.yaml", FLEET.replace("groups", "robots: {x: {model: m, labels: own.yaml}}\ngroups") % 3)
        done = cli("diff", "a.yaml", "b.yaml")
        assert done.returncode == 1
        assert "      of_them_pseudonymised: 4 before, 3 now" in done.stdout.splitlines()
