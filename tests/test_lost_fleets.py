"""Leaks that a fleet lost in silence at b86d901, each by the command: what a reader sees, and the exit code.

The reproductions are those of a review; ``POLICY`` and ``LABELS`` are the system that it begins with.
"""

from __future__ import annotations

import json
from fnmatch import fnmatchcase
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.ingest.labels import read_labels
from rosprivacy.ingest.names import covers
from rosprivacy.ontology.vocabulary import load
from tests.test_fleet import policy, write

if TYPE_CHECKING:
    from tests.command import Cli, Done

CAMERA, UPLINK = policy("/camera>/video"), policy("/uplink</video")
POLICY = policy("/camera>/video", "/uplink</video")
LABELS = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write("p.xml", POLICY)
    write("l.yaml", LABELS)
    write("cam.xml", CAMERA)
    write("up.xml", UPLINK)
    write("cam.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}}\nchannels: {/video: sensitive}\n")
    write("up.yaml", "labels: 1\nnodes: {/uplink: {leak: [Video]}}\nchannels: {/video: sensitive}\n")


def analysed(cli: Cli, fleet: str, *options: str) -> Done:
    write("fleet.yaml", f"fleet: 1\n{fleet}")
    return cli("analyze", "--fleet", "fleet.yaml", *options)


def findings(cli: Cli, fleet: str) -> tuple[int, list[tuple[str, str]]]:
    """The exit code, and the ends of what is shown."""
    done = analysed(cli, fleet, "-f", "json")
    assert done.returncode in (0, 1, 4), done.stderr
    ends = [
        [f[end]["robot"] + ":" + f[end]["name"] for end in ("source", "leak")]
        for f in json.loads(done.stdout)["findings"]
    ]
    return done.returncode, sorted((source, leak) for source, leak in ends)


class TestAlikeAsRead:
    """Case 1, rule S10: robots are alike only if all that was read for them is equal, includes too, as read."""

    ROBOTS = "robots: {a: {policies: [a/p.xml], labels: [l.yaml]}, b: {policies: [b/p.xml], labels: [l.yaml]}}\n"
    INCLUDE = '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="f.xml" xpointer="xpointer(/profile/*)"/>'
    WITH = POLICY.replace('<topics subscribe="ALLOW"><topic>/video</topic></topics>', INCLUDE)

    def included(self, robot: str, topic: str) -> None:
        write(f"{robot}/f.xml", f'<profile><topics subscribe="ALLOW"><topic>{topic}</topic></topics></profile>')

    @pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-32"])
    def test_what_each_includes_is_read_whatever_the_encoding(self, cli: Cli, encoding: str) -> None:
        assert self.INCLUDE in self.WITH
        for robot, topic in (("a", "/other"), ("b", "/video")):
            self.included(robot, topic)
            text = f'<?xml version="1.0" encoding="{encoding}"?>{self.WITH}'
            Path(robot, "p.xml").write_bytes(text.encode(encoding))
        done = analysed(cli, self.ROBOTS)
        assert (done.returncode, "Video: b:/camera -> b:/uplink" in done.stdout) == (1, True)
        listed = cli("fleet", "fleet.yaml").stdout
        assert "\na  (1; no model)" in listed
        assert "\nb  (1; no model)" in listed

    def test_an_include_that_is_not_there_for_one(self, cli: Cli) -> None:
        """All that was read of the first is the policy itself; the second reads another file."""
        fallback = self.INCLUDE.replace("/>", "><xi:fallback/></xi:include>")
        for robot in ("a", "b"):
            write(f"{robot}/p.xml", self.WITH.replace(self.INCLUDE, fallback))
        self.included("b", "/video")
        assert analysed(cli, self.ROBOTS).returncode == 1

    def test_an_entity_hides_no_include(self, cli: Cli) -> None:
        for robot, topic in (("a", "/other"), ("b", "/video")):
            self.included(robot, topic)
            inside = f"<!DOCTYPE policy [<!ENTITY f '{self.INCLUDE.replace(chr(39), chr(34))}'>]>"
            write(f"{robot}/p.xml", inside + self.WITH.replace(self.INCLUDE, "&f;"))
        done = analysed(cli, self.ROBOTS)
        assert (done.returncode, done.stdout) == (2, "")
        assert {line.partition(":")[0] for line in done.stderr.splitlines()} == {"a/p.xml", "b/p.xml"}

    def test_links_to_one_file_from_two_folders(self, cli: Cli) -> None:
        write("common.xml", self.WITH)
        for robot, topic in (("a", "/other"), ("b", "/video")):
            self.included(robot, topic)
            Path(robot, "p.xml").symlink_to(Path("common.xml").absolute())
        assert analysed(cli, self.ROBOTS).returncode == 1

    def test_equal_policies_that_include_nothing_are_read_once(self, cli: Cli) -> None:
        for robot in ("a", "b"):
            Path(robot).mkdir()
            Path(robot, "p.xml").write_bytes(POLICY.encode("utf-16"))
        assert analysed(cli, self.ROBOTS).returncode == 1
        assert "a, b  (2; no model)" in cli("fleet", "fleet.yaml").stdout

    def test_a_file_that_changed_since_is_read_anew(self) -> None:
        """One process may analyse a fleet more than once."""
        for robot in ("a", "b"):
            write(f"{robot}/p.xml", CAMERA)
        write("fleet.yaml", "fleet: 1\n" + self.ROBOTS.replace(", labels: [l.yaml]", ""))
        counts = []
        for text in (CAMERA, POLICY):
            write("b/p.xml", text)
            found = rosprivacy.analyze_fleet("fleet.yaml").document()["fleet"]["alike"]
            counts.append([group["robots"] for group in found])
        assert counts == [[["a", "b"]], [["a"], ["b"]]]

    def test_a_file_that_has_the_name_of_one_that_comes_with_the_program(self, cli: Cli) -> None:
        """``rosprivacy:standard`` is the program's, whatever lies in the folder."""
        write("rosprivacy:standard", LABELS)
        robots = "robots: {a: {policies: p.xml, labels: 'rosprivacy:standard'}, b: {policies: p.xml, labels: l.yaml}}\n"
        code, found = findings(cli, robots)
        assert (code, found) == (1, [("b:/camera", "b:/uplink")])


class TestARobotsOwnGlob:
    """Case 2, rule S7: a robot's file outranks its model's only between names or between globs."""

    FLEET = "models: {m: {policies: p.xml, labels: l.yaml}}\nrobots: {a: {model: m, labels: own.yaml}}\n"

    @pytest.mark.parametrize("glob", ["/u*", "/*"])
    def test_it_takes_no_leak_or_source_that_the_model_names(self, cli: Cli, glob: str) -> None:
        write("own.yaml", f"labels: 1\nnodes: {{'{glob}': conduit}}\n")
        done = analysed(cli, self.FLEET)
        assert (done.returncode, "Video: a:/camera -> a:/uplink" in done.stdout) == (1, True)

    @pytest.mark.parametrize(
        ("model", "own", "carried"),
        [
            (
                "'/vid*': mundane",
                "'/v*': sensitive",
                ["/video"],
            ),  # the robot's glob, though the model's spells out more
            ("'/v*': sensitive", "'/*': mundane", []),
            ("/video: sensitive", "'/video*': mundane", ["/video"]),  # the model's name before the robot's glob
            ("/video: mundane", "/video: sensitive", ["/video"]),  # the robot's name before the model's
        ],
    )
    def test_glob_against_glob_and_name_against_name(self, cli: Cli, model: str, own: str, carried: list[str]) -> None:
        write("l.yaml", LABELS.replace("/video: sensitive", model))
        write("own.yaml", f"labels: 1\nchannels: {{{own}}}\n")
        done = analysed(cli, self.FLEET, "-f", "json")
        carries = json.loads(done.stdout)["carries"]
        assert [row["element"]["name"] for row in carries if row["element"]["kind"] == "topic"] == carried

    NAMES, GLOBS = ("/a/b", "/a/c"), ("/*", "/a/*", "/a/?", "/a/[a-c]", "/*b")

    @given(data=st.data())
    def test_of_a_models_and_a_robots_statements_the_right_one_wins(self, data: st.DataObject) -> None:
        """Against brute force: glob of the model < glob of the robot < name of the model < name of the robot."""
        lines = st.dictionaries(st.sampled_from(self.NAMES + self.GLOBS), st.sampled_from(("mundane", "sensitive")))
        said = {owner: data.draw(lines, label=owner) for owner in ("model", "robot")}
        files = []
        with TemporaryDirectory() as folder:
            for owner, entries in said.items():
                file = Path(folder, owner)
                file.write_text(json.dumps({"labels": 1, "topics": entries}), "utf-8")
                files.append(read_labels(str(file), load(), own=owner == "robot"))
        for name in self.NAMES:
            statements = [s for file in files for e in file.entries if covers(e.name, name) for s in e.statements]
            candidates: dict[tuple[bool, bool, int], set[str]] = {}
            for owner, entries in said.items():
                for written, choice in entries.items():
                    if fnmatchcase(name, written):
                        exact = written == name
                        spelt = len(written.replace("[a-c]", "").replace("*", "").replace("?", ""))
                        candidates.setdefault((exact, owner == "robot", 0 if exact else spelt), set()).add(choice)
            if not candidates:
                continue
            best = candidates[max(candidates)]
            assert {s.role for s in statements if s.rank == max(t.rank for t in statements)} == best


class TestDecisionsBetweenRobots:
    """Case 13 (a): ``robot`` is that of the leak; what goes from one robot to another needs ``from_robot`` too."""

    ROBOTS = (
        "robots:\n  a: {policies: [cam.xml], labels: [cam.yaml], domain: lab}\n"
        "  b: {policies: [up.xml], labels: [up.yaml], domain: lab}\n"
    )
    WARNING = "the decision to accept a pattern names no from_robot: 1 finding from one robot to another, "

    def decided(self, cli: Cli, entry: str, fleet: str = ROBOTS) -> Done:
        said = "decision: accept, reason: agreed, owner: me, legal_basis: [6(1)(a)]"
        write("d.yaml", f"decisions: 1\nfindings:\n  - {{{entry}, {said}}}\n")
        return analysed(cli, fleet, "--decisions", "d.yaml")

    @pytest.mark.parametrize("robot", ["a", "b", "'*'"])
    def test_one_robot_is_not_enough(self, cli: Cli, robot: str) -> None:
        done = self.decided(cli, f"leak: /uplink, robot: {robot}")
        assert (done.returncode, "Video: a:/camera -> b:/uplink" in done.stdout) == (1, True)
        (line,) = [line for line in done.stdout.splitlines() if self.WARNING in line]
        assert "d.yaml:3" in line
        assert line.endswith("accepted before, no longer; add it")
        assert "orphaned" not in done.stdout + done.stderr

    @pytest.mark.parametrize(
        ("entry", "code"),
        [
            ("leak: /uplink, robot: b, from_robot: a", 0),
            ("leak: /uplink, from_robot: a", 0),
            ("leak: /uplink", 0),
            ("leak: /uplink, robot: '*', from_robot: '*'", 0),
            ("leak: /uplink, robot: a, from_robot: b", 1),
            ("leak: /uplink, robot: b, from_robot: b", 1),
            ("leak: /uplink, from_robot: b", 1),
        ],
    )
    def test_both_are(self, cli: Cli, entry: str, code: int) -> None:
        done = self.decided(cli, entry)
        assert done.returncode == code
        assert "names no from_robot" not in done.stdout + done.stderr

    def test_of_robots_that_are_alike_only_those_that_it_names(self, cli: Cli) -> None:
        """Three cameras, three uplinks, one domain: nine findings, of which one is accepted."""
        fleet = "groups: [{robots: 3, model: m, id: r*}]\nmodels: {m: {policies: p.xml, labels: l.yaml, domain: lab}}\n"
        for entry, accepted in (("robot: r2, from_robot: r1", 1), ("robot: r2", 1), ("from_robot: r1", 3)):
            self.decided(cli, f"leak: /uplink, {entry}", fleet)
            done = cli("analyze", "--fleet", "fleet.yaml", "--decisions", "d.yaml", "-f", "json")
            patterns = json.loads(done.stdout)["fleet"]["patterns"]
            assert (done.returncode, sum(p["findings"] for p in patterns)) == (1, 9)
            assert sum(p["accepted"] for p in patterns) == accepted, entry

    def test_a_leak_that_is_on_no_robot_is_named_by_the_robot_of_the_source(self, cli: Cli) -> None:
        shared = (
            self.ROBOTS
            + "elements: {cloud: {kind: external-system, country: DE, leak: [Video]}}\n"
            + "flows: [{from: 'a:/camera', to: cloud}]\n"
        )
        for robot, code in (("a", 0), ("b", 1)):
            fleet = shared.replace("up.yaml", "none.yaml")
            write("none.yaml", "labels: 1\nnodes: {/uplink: conduit}\n")
            assert self.decided(cli, f"leak: cloud, robot: {robot}", fleet).returncode == code

    def test_decide_writes_it(self, cli: Cli) -> None:
        self.decided(cli, "leak: /nothing")
        said = ("--reason", "agreed", "--owner", "me", "--legal-basis", "6(1)(a)", "--decisions", "d.yaml")
        done = cli("decide", "accept", "--leak", "/uplink", "--robot", "b", "--from-robot", "a", *said)
        assert done.returncode == 0, done.stderr
        assert "accept leak /uplink, robot b, from_robot a" in done.stdout
        assert "from_robot: a\n" in Path("d.yaml").read_text("utf-8")
        assert cli("analyze", "--fleet", "fleet.yaml", "--decisions", "d.yaml").returncode == 0
