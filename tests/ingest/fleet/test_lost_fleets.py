"""Leaks that a fleet lost in silence in an earlier version, each by the command: what a reader sees, and the exit code.

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
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ingest.policies.names import covers
from rosprivacy.ontology.vocabulary import load
from tests.helpers.command import refused
from tests.helpers.fleet_files import policy, write
from tests.helpers.parts import in_list

if TYPE_CHECKING:
    from tests.helpers.command import Cli, Done

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
    """Rule S10: robots are alike only if all that was read for them is equal, includes too, as read."""

    ROBOTS = "robots: {a: {policies: [a/p.xml], labels: [l.yaml]}, b: {policies: [b/p.xml], labels: [l.yaml]}}\n"
    INCLUDE = '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="f.xml" xpointer="xpointer(/profile/*)"/>'
    WITH = POLICY.replace('<topics subscribe="ALLOW"><topic>/video</topic></topics>', INCLUDE)
    FALLBACK = WITH.replace(INCLUDE, INCLUDE.replace("/>", "><xi:fallback/></xi:include>"))

    @pytest.mark.parametrize("written", ["utf-16", "utf-32", "utf-8", "a link", "a fallback"])
    def test_what_each_includes_is_read_however_it_is_written(self, cli: Cli, written: str) -> None:
        write("common.xml", self.WITH)
        for robot, name in (("a", "/other"), ("b", "/video")):
            if (robot, written) != ("a", "a fallback"):  # of the first, nothing but the policy itself is there
                write(f"{robot}/f.xml", f'<profile><topics subscribe="ALLOW"><topic>{name}</topic></topics></profile>')
            if written == "a link":
                Path(robot, "p.xml").symlink_to(Path("common.xml").absolute())
            elif written == "a fallback":
                write(f"{robot}/p.xml", self.FALLBACK)
            else:
                text = f'<?xml version="1.0" encoding="{written}"?>{self.WITH}'
                Path(robot, "p.xml").write_bytes(text.encode(written))
        assert findings(cli, self.ROBOTS) == (1, [("b:/camera", "b:/uplink")])
        listed = cli("fleet", "fleet.yaml").stdout
        assert "\na  (1; no model)" in listed
        assert "\nb  (1; no model)" in listed

    def test_an_entity_hides_no_include(self, cli: Cli) -> None:
        for robot in ("a", "b"):
            inside = f"<!DOCTYPE policy [<!ENTITY f '{self.INCLUDE.replace(chr(39), chr(34))}'>]>"
            write(f"{robot}/p.xml", inside + self.WITH.replace(self.INCLUDE, "&f;"))
        lines = refused(analysed(cli, self.ROBOTS))
        assert {line.partition(":")[0] for line in lines} == {"a/p.xml", "b/p.xml"}

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
            groups = rosprivacy.analyze_fleet("fleet.yaml").document()["fleet"]["alike"]
            counts.append([group["robots"] for group in groups])
        assert counts == [[["a", "b"]], [["a"], ["b"]]]

    def test_a_file_that_has_the_name_of_one_that_comes_with_the_program(self, cli: Cli) -> None:
        """``rosprivacy:standard`` is the program's, whatever lies in the folder."""
        write("rosprivacy:standard", LABELS)
        robots = "robots: {a: {policies: p.xml, labels: 'rosprivacy:standard'}, b: {policies: p.xml, labels: l.yaml}}\n"
        assert findings(cli, robots) == (1, [("b:/camera", "b:/uplink")])


class TestARobotsOwnGlob:
    """Rule S7: a robot's file outranks its model's only between names or between globs."""

    FLEET = "models: {m: {policies: p.xml, labels: l.yaml}}\nrobots: {a: {model: m, labels: own.yaml}}\n"

    @pytest.mark.parametrize("glob", ["/u*", "/*"])
    def test_it_takes_no_leak_or_source_that_the_model_names(self, cli: Cli, glob: str) -> None:
        write("own.yaml", f"labels: 1\nnodes: {{'{glob}': conduit}}\n")
        assert findings(cli, self.FLEET) == (1, [("a:/camera", "a:/uplink")])

    @pytest.mark.parametrize(
        ("model", "own", "carried"),
        [
            ("'/vid*': mundane", "'/v*': sensitive", ["/video"]),  # the robot's, though the model's spells out more
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
    """``robot`` is that of the leak; what goes from one robot to another needs ``from_robot`` too."""

    ROBOTS = (
        "robots:\n  a: {policies: [cam.xml], labels: [cam.yaml], domain: lab}\n"
        "  b: {policies: [up.xml], labels: [up.yaml], domain: lab}\n"
    )

    def decided(self, cli: Cli, entry: str, fleet: str = ROBOTS) -> Done:
        said = "decision: accept, reason: agreed, owner: me, legal_basis: [6(1)(a)]"
        write("d.yaml", f"decisions: 1\nfindings:\n  - {{{entry}, {said}}}\n")
        return analysed(cli, fleet, "--decisions", "d.yaml")

    @pytest.mark.parametrize(
        ("entry", "code"),
        [
            ("robot: a", 1),  # one robot is not enough
            ("robot: b", 1),
            ("robot: '*'", 1),
            ("robot: b, from_robot: a", 0),
            ("from_robot: a", 0),
            ("note: of all", 0),
            ("robot: '*', from_robot: '*'", 0),
            ("robot: a, from_robot: b", 1),
            ("robot: b, from_robot: b", 1),
            ("from_robot: b", 1),
        ],
    )
    def test_both_are_named_or_none(self, cli: Cli, entry: str, code: int) -> None:
        done = self.decided(cli, f"leak: /uplink, {entry}".replace(", note: of all", ""))
        assert done.returncode == code
        warned = [line for line in done.stdout.splitlines() if "names no from_robot" in line]
        assert ["d.yaml:3" in line for line in warned] == [True] * ("from_robot" not in entry and "robot" in entry)
        assert not warned or "orphaned" not in done.stdout + done.stderr

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
        write("up.yaml", "labels: 1\nnodes: {/uplink: conduit}\n")
        for robot, code in (("a", 0), ("b", 1)):
            assert self.decided(cli, f"leak: cloud, robot: {robot}", shared).returncode == code

    def test_decide_writes_it(self, cli: Cli) -> None:
        self.decided(cli, "leak: /nothing")
        said = ("--reason", "agreed", "--owner", "me", "--legal-basis", "6(1)(a)", "--decisions", "d.yaml")
        done = cli("decide", "accept", "--leak", "/uplink", "--robot", "b", "--from-robot", "a", *said)
        assert done.returncode == 0, done.stderr
        assert "from_robot: a\n" in Path("d.yaml").read_text("utf-8")
        assert cli("analyze", "--fleet", "fleet.yaml", "--decisions", "d.yaml").returncode == 0


class TestANameWrittenAbsolute:
    """Rule S1: a pushed namespace goes before nodes, relative and ``~`` names; an absolute name stays."""

    FLEET = (
        "robots:\n  a: {policies: [cam.xml], labels: [cam.yaml], domain: lab, namespace: {add: /r1}}\n"
        "  b: {policies: [up.xml], labels: [up.yaml], domain: lab}\n"
    )

    MODEL = "models: {m: {policies: p.xml, labels: l.yaml, namespace: {add: '/*'}}}\n"

    @pytest.mark.parametrize(
        ("camera", "uplink", "code"),
        [
            ("/video", "/video", 1),
            ("video", "/r1/video", 1),
            ("video", "/video", 0),
            ("~video", "/r1/camera/video", 1),
            ("/video", "/*", 1),
            ("/vid*", "/video", 1),
            ("video", "/r1/*", 1),
            ("vid*", "/video", 0),
        ],
    )
    def test_it_is_the_same_channel_for_another_robot(self, cli: Cli, camera: str, uplink: str, code: int) -> None:
        write("cam.xml", policy(f"/camera>{camera}").replace("~video", "~/video"))
        write("up.xml", policy(f"/uplink<{uplink}"))
        for side in ("cam", "up"):
            labels = Path(f"{side}.yaml").read_text("utf-8").partition("channels")[0]
            write(f"{side}.yaml", labels + "channels: {'/*': sensitive, '*': sensitive}\n")
        done = analysed(cli, self.FLEET, "-v")
        assert done.returncode == code
        assert ("b:/uplink: Video, from a:/camera" in done.stdout) is bool(code)
        told = "robot a: 1 name is written absolute and stays outside the namespace that is pushed: "
        assert (told in done.stdout) is camera.startswith("/")

    def test_services_and_actions_too(self, cli: Cli) -> None:
        for kind, asks, answers in (("service", "request", "reply"), ("action", "call", "execute")):
            for file, node, role in (("cam", "camera", asks), ("up", "uplink", answers)):
                group = f'<{kind}s {role}="ALLOW"><{kind}>/ask</{kind}></{kind}s>'
                write(f"{file}.xml", policy(f"/{node}").replace("</profile>", f"{group}</profile>"))
                labels = Path(f"{file}.yaml").read_text("utf-8").partition("channels")[0]
                write(f"{file}.yaml", labels)
            assert findings(cli, self.FLEET) == (1, [("a:/camera", "b:/uplink")])

    def test_a_deny_takes_out_what_it_is_written_for(self, cli: Cli) -> None:
        """An absolute DENY cuts no relative ALLOW, and a relative one no absolute."""
        own = "robots:\n  a: {policies: [p.xml], labels: [l.yaml], namespace: {add: /r1}}\n"
        write("l.yaml", LABELS.partition("channels")[0])
        for written, denied, code in (("video", "/video", 1), ("/video", "video", 1), ("/video", "/video", 0)):
            write("p.xml", policy(f"/camera>{written},!{denied}", f"/uplink<{written}"))
            assert analysed(cli, own).returncode == code, (written, denied)

    def test_robots_whose_names_lie_in_their_namespace_are_not_alike(self, cli: Cli) -> None:
        """The uplink reads /r2/video in full: on r2 that is the camera's, on r1 it is not; /health is nobody's."""
        write("p.xml", policy("/camera>video,/health", "/uplink</r2/video"))
        write("l.yaml", LABELS.partition("channels")[0])
        fleet = f"{self.MODEL}groups: [{{robots: 2, model: m, id: r*}}]\n"
        assert findings(cli, fleet) == (1, [("r2:/camera", "r2:/uplink")])

    def test_one_name_in_both_ways_is_two_channels(self, cli: Cli) -> None:
        write("p.xml", policy("/camera>video", "/uplink</video"))
        own = "robots:\n  a: {policies: [p.xml], labels: [l.yaml], namespace: {add: /r1}}\n"
        done = analysed(cli, own)
        assert "robot a: /video written absolute and relative, under the namespace that is pushed two" in done.stdout
        assert "a:/r1/video" in done.stdout

    def test_many_robots_that_are_alike_are_still_read_once(self, cli: Cli) -> None:
        fleet = f"{self.MODEL}groups: [{{robots: 9, model: m}}]\n"
        done = analysed(cli, fleet, "-v")
        assert "on 9 of 9 robots" in done.stdout
        assert done.stdout.count("model m: 1 name is written absolute and stays") == 1
        assert "(9; model m)" in cli("fleet", "fleet.yaml").stdout

    def test_a_saved_graph_keeps_how_names_are_written(self, cli: Cli) -> None:
        """One of an earlier version does not: that is told, and its names are taken as they stand."""
        assert cli("analyze", "p.xml", "-l", "l.yaml", "--save-graph", "g.json").returncode == 1
        saved = json.loads(Path("g.json").read_text("utf-8"))
        assert [grant["absolute"] for policy in saved["policies"] for grant in policy["grants"]] == [True, True]
        write("up.xml", policy("/screen</video"))
        assert "earlier version" not in cli("analyze", "up.xml", "--add", "g.json", "-l", "l.yaml").stdout
        for policy_ in saved["policies"]:
            for grant in policy_["grants"]:
                del grant["absolute"]
        write("g.json", json.dumps(saved))
        done = cli("analyze", "up.xml", "--add", "g.json", "-l", "l.yaml")
        assert done.returncode == 1
        assert "saved by an earlier version, which did not keep which names a policy writes absolute" in done.stdout


WRITTEN = ("x", "/x", "~/x", "/r1/x", "*", "/*", "/r1/*", "/*x")


@st.composite
def namespaced(draw: st.DrawFn) -> dict[str, tuple[str, list[tuple[str, str, str]]]]:
    """Robots: the namespace that is pushed, and (node, role, name); a name that begins with ! is denied."""
    written = st.sampled_from(WRITTEN)
    name = st.builds("{}{}".format, st.sampled_from(("", "", "!")), written)
    roles = [("cam", "publish"), ("up", "subscribe"), ("mid", "publish"), ("mid", "subscribe")]
    grant = st.builds(lambda role, name: (*role, name), st.sampled_from(roles), name)
    robots = {}
    for robot in ("b0", "b1"):
        always = [("cam", "publish", draw(written)), ("up", "subscribe", draw(written))]
        robots[robot] = (draw(st.sampled_from(("/r1", "", "/r2"))), always + draw(st.lists(grant, max_size=3)))
    return robots


def enclave(robot: str, space: str, grants: list[tuple[str, str, str]]) -> str:
    """A policy's enclave, for a robot whose nodes run in a namespace."""
    profiles = ""
    for node in ("cam", "mid", "up"):
        mine = [(role, name) for who, role, name in grants if who == node]
        rules = "".join(
            f'<topics {role}="{"DENY" if name[0] == "!" else "ALLOW"}"><topic>{name.strip("!")}</topic></topics>'
            for role, name in mine
        )
        profiles += f'<profile ns="{space or "/"}" node="{robot}_{node}">{rules}</profile>'
    return f'<enclave path="/{robot}"><profiles>{profiles}</profiles></enclave>'


def whole(*enclaves: str) -> str:
    return f'<policy version="0.2.0"><enclaves>{"".join(enclaves)}</enclaves></policy>'


def labelled(robots: dict[str, str]) -> str:
    nodes: dict[str, object] = {}
    for robot, space in robots.items():
        nodes |= {f"{space}/{robot}_cam": {"source": ["Video"]}, f"{space}/{robot}_up": {"leak": ["Video"]}}
    return json.dumps({"labels": 1, "nodes": nodes})


@pytest.mark.parametrize("domain", ["", "lab"])
@given(robots=namespaced())
def test_a_pushed_namespace_is_as_if_each_profile_had_it(
    domain: str, robots: dict[str, tuple[str, list[tuple[str, str, str]]]]
) -> None:
    """Against all robots of a domain in one policy, in which the profiles' ns is the namespace (rules S1, S4, S5)."""
    with TemporaryDirectory() as at:
        spec: dict[str, dict[str, object]] = {}
        for robot, (space, grants) in robots.items():
            write(f"{at}/{robot}.xml", whole(enclave(robot, "", grants)))
            write(f"{at}/{robot}.json", labelled({robot: ""}))
            spec[robot] = {"policies": f"{robot}.xml", "labels": f"{robot}.json"}
            spec[robot] |= {"namespace": {"add": space}} if space else {}
            spec[robot] |= {"domain": domain} if domain else {}
        write(f"{at}/fleet.json", json.dumps({"fleet": 1, "robots": spec}))
        found = rosprivacy.analyze_fleet(f"{at}/fleet.json").document()
        got = {tuple(f[end]["name"].lstrip("/") for end in ("source", "leak")) for f in found["findings"]}
        expected = set()
        together = [list(robots)] if domain else [[robot] for robot in robots]
        for some in together:
            write(f"{at}/all.xml", whole(*(enclave(robot, *robots[robot]) for robot in some)))
            write(f"{at}/all.json", labelled({robot: robots[robot][0] for robot in some}))
            one = rosprivacy.analyze([f"{at}/all.xml"], [f"{at}/all.json"]).document()
            expected |= {
                tuple(f[end]["name"].rpartition("/")[2] for end in ("source", "leak")) for f in one["findings"]
            }
    assert got == expected


class TestWhatJoinsNothing:
    """Rule S11: a domain or an infrastructure that joins nothing is told by name; one that lets data out breaks."""

    ROBOT = "robots: {a: {policies: [cam.xml], labels: [cam.yaml]%s}}\n"
    BASE = "infrastructure: {base: {policies: [up.xml], labels: [%s]%s}}\n"
    LAB = ROBOT % ", domain: lab"
    LEAKS, ALONE = ("leak-joins-nothing", "infrastructure base"), ("joins-nothing", "infrastructure base")
    LAB_ALONE = ("joins-nothing", "domain lab joins nothing: a is alone in it")

    @pytest.fixture(autouse=True)
    def reviewed(self, folder: None) -> None:
        """A camera whose data all gets to what is reviewed, so that nothing is open."""
        del folder
        write("cam.xml", policy("/camera>/video", "/view</video"))
        text = "nodes: {/camera: {source: [Video]}, /view: {conduit: [Video], leak: none}}"
        write("cam.yaml", f"labels: 1\n{text}\nchannels: {{/video: sensitive}}\n")
        write("none.yaml", "labels: 1\nnodes: {/uplink: conduit}\n")
        write("kept.yaml", "labels: 1\nelements: {disk: {kind: storage}}\nflows: [{from: /uplink, to: disk}]\n")
        write("shown.yaml", "labels: 1\nelements: {lcd: {kind: display}}\nflows: [{from: /uplink, to: lcd}]\n")

    @pytest.mark.parametrize(
        ("fleet", "doubts"),
        [
            (LAB + BASE % ("up.yaml", ""), [LAB_ALONE, LEAKS]),
            (LAB + BASE % ("kept.yaml", ""), [LAB_ALONE, LEAKS]),
            (LAB + BASE % ("shown.yaml", ""), [LAB_ALONE, LEAKS]),
            (LAB + BASE % ("none.yaml", ""), [LAB_ALONE, ALONE]),
            (
                LAB + BASE % ("up.yaml", ", domain: lav"),
                [("joins-nothing", "did you mean lav?"), ("leak-joins-nothing", "did you mean lab?")],
            ),
            (
                "robots: {a: {policies: cam.xml, labels: cam.yaml}, b: {policies: up.xml, labels: up.yaml}}\n",
                [("own-domains", "domain 0: a, b")],
            ),
            (
                "models: {m: {policies: cam.xml, labels: cam.yaml}}\ngroups: [{robots: 12, model: m, id: r*}]\n",
                [("own-domains", "r09, r10 and 2 more")],
            ),
            (  # a flow within one robot
                ROBOT % "" + BASE % ("up.yaml", "") + "flows: [{from: 'a:/view', to: 'a:/view'}]\n",
                [LEAKS, ("own-domains", "domain 0: a")],
            ),
            (  # the glob means base too, which has no such node
                ROBOT % "" + BASE % ("none.yaml", "")
                + "elements: {s: {kind: storage}}\nflows: [{from: '*:/camera', to: s}]\n",
                [ALONE, ("own-domains", "domain 0: a")],
            ),
            (LAB + BASE % ("up.yaml", "") + "flows: [{from: 'a:/view', to: 'base:/uplink'}]\n", [LAB_ALONE]),
            (LAB + BASE % ("up.yaml", ", domain: lab"), []),
            (ROBOT % "", []),  # a fleet of one
        ],
    )  # fmt: skip
    def test_each_is_told_in_memory_and_in_parts(self, cli: Cli, fleet: str, doubts: list[tuple[str, str]]) -> None:
        done = analysed(cli, fleet, "-f", "json")
        document = json.loads(done.stdout)
        ours = [d for d in document["diagnostics"] if "domain" in d["message"]]
        assert [d["code"] for d in ours] == [code for code, _ in doubts]
        for diagnostic, (code, words) in zip(ours, doubts, strict=True):
            assert words in diagnostic["message"]
            assert diagnostic["file"] == "fleet.yaml"
            assert diagnostic["severity"] == ("notice" if code == "own-domains" else "warning")
        in_parts = in_list("fleet.yaml").document()
        assert [d for d in in_parts["diagnostics"] if "domain" in d["message"]] == ours
        assert in_parts["verdict"] == document["verdict"]
        breaks = "leak-joins-nothing" in dict(doubts)
        if document["verdict"] != "leak" and "storage" not in fleet:
            assert (document["verdict"], done.returncode) == (("undetermined", 4) if breaks else ("no-leak-found", 0))
            assert ("lets data out" in analysed(cli, fleet).stdout.partition("\n")[0]) == breaks

    @pytest.mark.parametrize(("one", "other"), [("Lab", "lab"), ("01", "1"), ("LAB_2", "lab_2")])
    def test_domains_that_look_alike_are_an_error_with_both_lines(self, cli: Cli, one: str, other: str) -> None:
        """Data would go from neither to the other, and nobody sees why."""
        fleet = "infrastructure:\n  base: {policies: up.xml, domain: %s}\nrobots:\n  a:\n    policies: cam.xml\n"
        fleet += "    domain: %s\n"
        (line,) = refused(analysed(cli, fleet % (one, other)))
        assert line.startswith("fleet.yaml:")
        assert f"domain {other!r}" in line or f"domain {one!r}" in line
        assert "fleet.yaml:3" in line
        assert "fleet.yaml:7" in line
        assert analysed(cli, fleet % (one, one)).returncode == 4

    def test_a_folder_of_a_group_without_its_policy_is_told(self, cli: Cli) -> None:
        """Rule S11: a robot that is not there for the sake of a file's name."""
        for robot, name in (("a", "policy.xml"), ("b", "policy.XML"), ("c", "other.xml"), (".d", "x.xml")):
            write(f"v/{robot}/{name}", Path("cam.xml").read_text("utf-8"))
        write("v/policy.xml", Path("cam.xml").read_text("utf-8"))
        fleet = "groups: [{policies: 'v/*/policy.xml', labels: cam.yaml}]\n"
        document = json.loads(analysed(cli, fleet, "-f", "json").stdout)
        (diagnostic,) = document["diagnostics"]
        assert (diagnostic["code"], diagnostic["file"], diagnostic["line"]) == ("no-robot", "fleet.yaml", 2)
        assert diagnostic["message"].endswith("so no robot: v/b, v/c")
        assert document["verdict"] == "no-leak-found"
        assert in_list("fleet.yaml").document()["diagnostics"][0] == diagnostic
        files = json.loads(analysed(cli, fleet.replace("v/*/policy.xml", "v/a/*.xml"), "-f", "json").stdout)
        assert not files["diagnostics"]
