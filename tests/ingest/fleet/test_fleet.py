"""Fleet files: their format, what robots of a fleet share and what not (rule S1), and what is refused."""

from __future__ import annotations

import copy
import json
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

import rosprivacy
from rosprivacy.analysis.errors import FleetError, InputErrors
from rosprivacy.answering import answer
from rosprivacy.ingest.fleet.alike_robots import alike
from rosprivacy.ingest.fleet.fleet_schema import fleet_schema
from rosprivacy.ontology.vocabulary import load
from rosprivacy.question import Question
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import answer_fleet, fleet_system
from tests.helpers.fleet_files import MODELS, folder, policy, read, write
from tests.helpers.paths import ROOT
from tests.helpers.schema_places import places

if TYPE_CHECKING:
    from rosprivacy.result import Result

__all__ = ["folder"]

EXAMPLES = ROOT / "examples"


INCLUDE = '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="f.xml"><xi:fallback/></xi:include>'


BUCKET = (
    "elements: {bucket: {kind: storage, country: DE, retention: P1D}}\n"
    "flows: [{from: 'eye_*:/uplink', to: bucket}, {from: bucket, to: 'wall_*:/receiver'%s}]\n"
)


def run(text: str, **options: Any) -> Result:
    write("f.yaml", "fleet: 1\n" + MODELS + text)
    return answer_fleet("f.yaml", Settings(**options))


def found(text: str, **options: Any) -> dict[str, int]:
    """``source -> leak`` without robots -> how many."""
    view = run(text, **options).fleet
    assert view
    return {
        f"{p.finding.source.name} -> {p.finding.leak.name}" + (" across" if p.across else ""): p.count
        for p in view.patterns
    }


def test_a_document_names_one_robot_for_those_that_are_alike() -> None:
    """Two stand for all where they are joined; the second is in no list."""
    document = rosprivacy.analyze_fleet(str(EXAMPLES / "fleet" / "fleet.yaml")).document()
    shown = {alike["robot"] for alike in document["fleet"]["alike"]}
    every = {robot for alike in document["fleet"]["alike"] for robot in alike["robots"]}
    for key in ("carries", "roles", "open", "sanitizers", "derivations", "subjects", "outside"):
        assert not {row["element"]["robot"] for row in document[key]} & (every - shown), key
    assert not {element["robot"] for element in document["unreached"]} & (every - shown)
    assert not {e["robot"] for row in document["sanitizers"] for e in row["beside"]} & (every - shown)
    assert all(document[key] for key in ("carries", "roles", "sanitizers", "derivations", "outside", "unreached"))


def refused(text: str) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        answer_fleet(_written(text), Settings())
    lines = str(caught.value).splitlines()
    assert all(re.fullmatch(r"\S+: .+; .+", line) for line in lines)
    assert all(isinstance(error, FleetError) for error in caught.value.errors)
    return [line.removeprefix("f.yaml:") for line in lines]


def _written(text: str) -> str:
    write("f.yaml", text)
    return "f.yaml"


class TestRobots:
    def test_one_by_one(self) -> None:
        fleet = read("fleet: 1\n" + MODELS + "robots: {b: {model: eye}, a: {policies: [wall.xml], domain: 7}}\n")
        assert [(r.id, r.model, r.policies, r.labels, r.domain) for r in fleet.robots] == [
            ("a", "", ("wall.xml",), (), "7"),
            ("b", "eye", ("eye.xml",), ("eye.yaml",), ""),
        ]

    def test_by_number(self) -> None:
        fleet = read("fleet: 1\n" + MODELS + "groups: [{robots: 12, model: eye}, {robots: 1, model: wall, id: w*x}]\n")
        assert [r.id for r in fleet.robots] == [*(f"eye_{n:02}" for n in range(1, 13)), "w1x"]

    def test_by_glob_the_star_is_the_robots_id(self) -> None:
        for robot in ("r1", "r2"):
            write(f"robots/{robot}/policy.xml", policy("/a>/b"))
            write(f"robots/{robot}/labels.yaml", "labels: 1\n")
        fleet = read(
            "fleet: 1\ngroups:\n"
            "  - {policies: robots/*/policy.xml, labels: [robots/*/labels.yaml], namespace: {strip: /*}}\n"
        )
        assert [(r.id, r.policies, r.own, r.strip) for r in fleet.robots] == [
            (f"r{n}", (f"robots/r{n}/policy.xml",), (f"robots/r{n}/labels.yaml",), f"/r{n}") for n in (1, 2)
        ]

    def test_files_are_looked_for_beside_the_fleet_file(self) -> None:
        write("site/f.yaml", "fleet: 1\nrobots: {a: {policies: ../eye.xml}}\n")
        settings = Settings(include_root=".")
        assert [p.file for p in answer_fleet("site/f.yaml", settings).policies] == ["site/../eye.xml"]

    def test_includes_are_one_with_the_file(self) -> None:
        write("site/models.yaml", "fleet: 1\nmodels: {eye: {policies: ../eye.xml}}\nlimits: {Video: P1D}\n")
        write("site/robots.yaml", "fleet: 1\ninclude: models.yaml\nrobots: {a: {model: eye}}\n")
        fleet = read("fleet: 1\ninclude: [site/robots.yaml, site/models.yaml]\nrobots: {b: {model: eye}}\n")
        assert [(r.id, r.policies) for r in fleet.robots] == [("a", ("site/../eye.xml",)), ("b", ("site/../eye.xml",))]
        assert [file for file, _ in fleet.sources] == ["f.yaml", "site/models.yaml", "site/robots.yaml"]
        assert len(fleet.limits) == 1

    def test_a_robots_own_labels_outrank_its_models(self) -> None:
        cloud = "elements: {{cloud: {{kind: external-system, {}}}}}\n".format
        nodes = "nodes: {/camera: {source: [Video], leak: [Video]}, /uplink: {leak: [Video]}}\n"
        write("eye.yaml", f"labels: 1\n{nodes}{cloud('leak: [Video]')}flows: [{{from: /camera, to: cloud}}]\n")
        write("own.yaml", "labels: 1\nnodes: {/uplink: {leak: none, conduit: [Video]}}\n" + cloud("leak: none"))
        write("f.yaml", f"fleet: 1\n{MODELS}robots: {{a: {{model: eye}}, b: {{model: eye, labels: own.yaml}}}}\n")
        question = Question(Settings(), load(), None, None, "", every=True)
        result = answer(fleet_system("f.yaml", question), question)
        assert [(f.leak.robot, f.leak.name) for f in result.analysis.findings] == [
            ("a", "/camera"), ("a", "/uplink"), ("a", "cloud"), ("b", "/camera"),
        ]  # fmt: skip

    def test_a_robots_own_facts_take_the_place_of_its_models(self) -> None:
        disk = "elements: {disk: {kind: storage, country: DE, retention: %s}}\nflows: [{from: /uplink, to: disk}]\n"
        write("eye.yaml", Path("eye.yaml").read_text("utf-8") + disk % "P30D" + "limits: {Video: P30D}\n")
        write("own.yaml", "labels: 1\n" + (disk % "P90D").partition("\n")[0] + "\n")
        result = run("robots: {a: {model: eye}, b: {model: eye, labels: own.yaml}}\n")
        assert [(f.kind, f.leak.robot) for f in result.analysis.findings] == [("storage-limitation", "b")]
        assert result.fleet
        assert [(d.robots, d.model) for d in result.fleet.deviants] == [(("b",), "eye")]


class TestAlike:
    def test_equal_files_and_equal_flows_are_read_once(self) -> None:
        write("copy.xml", Path("eye.xml").read_text("utf-8"))
        fleet = read(
            f"fleet: 1\n{MODELS}"
            "groups: [{robots: 5, model: eye}]\nrobots: {x: {model: eye}, y: {model: wall}}\n"
            "elements: {bucket: {kind: storage}}\n"
            "flows: [{from: '*:/uplink', to: bucket}, {from: 'eye_2:/camera', to: bucket}]\n"
        )
        assert [[r.id for r in group.robots] for group in alike(fleet)] == [
            ["eye_1", "eye_3", "eye_4", "eye_5", "x"],
            ["eye_2"],
            ["y"],
        ]

    def test_copies_of_a_file_are_equal_unless_they_include_others(self) -> None:
        for robot in ("a", "b"):
            write(f"p/{robot}.xml", Path("eye.xml").read_text("utf-8"))
            write(f"q/{robot}.xml", Path("eye.xml").read_text("utf-8").replace("<topics", INCLUDE + "<topics", 1))
            write(f"r/{robot}.xml", Path("eye.xml").read_text("utf-8") + "<!-- include -->")
        for robots in ("p", "r"):
            assert len(alike(read(f"fleet: 1\ngroups: [{{policies: {robots}/*.xml}}]\n"))) == 1
        assert len(alike(read("fleet: 1\ngroups: [{policies: q/*.xml}]\n"))) == 2

    def test_a_robot_that_nothing_joins_is_placed_once(self) -> None:
        fleet = read("fleet: 1\n" + MODELS + "groups: [{robots: 9, model: eye}]\n")
        assert [len(group.placed) for group in alike(fleet)] == [1]


class TestSharing:
    SCREEN = "labels: 1\nnodes: {/screen: {leak: [Video]}}\n"
    CAMERA = "labels: 1\nnodes: {/camera: {source: [Video]}}\n"
    TWO = "robots: {a: {model: eye, domain: %s}, b: {model: wall, domain: %s}}\n"
    GROUPS = "groups: [{robots: 3, model: eye}, {robots: 2, model: wall}]\n"

    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            # of their own domains they share nothing (rule S1): as if each was analysed by itself
            ("robots: {a: {policies: [eye.xml, wall.xml], labels: [eye.yaml, wall.yaml]}, b: {model: wall}}\n", {}),
            # a storage joins them
            (GROUPS + BUCKET % "", {"/camera -> /screen across": 6}),
            (GROUPS + BUCKET % ", never: [Video]", {}),
            # a flow goes from robot to robot
            (GROUPS + "flows: [{from: 'eye_2:/uplink', to: '*:/receiver'}]\n", {"/camera -> /screen across": 2}),
        ],
    )
    def test_what_a_fleet_file_states_joins_robots(self, text: str, expected: dict[str, int]) -> None:
        assert found(text) == expected

    def test_robots_of_one_domain_share_channels_by_name(self) -> None:
        write("wall.xml", policy("/screen</image"))
        write("wall.yaml", self.SCREEN)
        groups = "groups: [{robots: 3, model: eye, domain: hall}, {robots: 2, model: wall, domain: hall}]\n"
        assert found(groups) == {"/camera -> /screen across": 6}
        result = run(groups)
        channels = {(e.robot, e.name) for e in result.analysis.graph.elements if e.is_channel}
        assert channels == {("domain hall", "/image")}
        assert result.document()["elements"] == 3 * 2 + 2 + 1

    @pytest.mark.parametrize(
        ("files", "options", "expected"),
        [
            # what labels say of a shared channel holds for all
            ({"wall.yaml": SCREEN + "channels: {/image: {never: [Video]}}\n"}, {}, {}),
            # rule S4: a wildcard reaches the other robots of the domain
            ({"wall.xml": policy("/screen</im*")}, {}, {"/camera -> /screen across": 1}),
            # rule S5: a DENY holds for its own robot; both enclaves have one path
            (
                {
                    "eye.xml": policy("/camera>/image,!/image"),
                    "wall.xml": policy("/mirror>/image<x", "/screen</image"),
                    "wall.yaml": "labels: 1\nnodes: {/mirror: {source: [Voice]}, /screen: {leak: [Voice, Video]}}\n",
                },
                {},
                {"/mirror -> /screen": 1},
            ),
            # rule S6: the enforced view takes enclaves of two robots for two
            ({"eye.xml": policy("/camera>/image"), "wall.xml": policy("/screen</picture")}, {"view": "enforced"}, {}),
        ],
    )
    def test_what_robots_of_one_domain_say(
        self, files: dict[str, str], options: dict[str, str], expected: dict[str, int]
    ) -> None:
        base = {"eye.yaml": self.CAMERA, "wall.xml": policy("/screen</image"), "wall.yaml": self.SCREEN}
        for name, text in (base | files).items():
            write(name, text)
        assert found(self.TWO % (1, 1), **options) == expected
        assert "/camera -> /screen across" not in found(self.TWO % (1, 2), **options)

    @pytest.mark.parametrize(("key", "space"), [("strip", "/{}/"), ("add", "")])
    def test_a_namespace_keeps_the_channels_of_robots_apart(self, key: str, space: str) -> None:
        """The policy has it (strip) or lacks it (add); names are shown without, so one label file does for all."""
        for robot in ("a", "b"):
            at = space.format(robot)
            node = at or "/"
            write(f"p/{robot}.xml", policy(f"{node}camera>{at}image", f"{node}screen<{at}image,/map"))
        write("l.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}, /screen: {leak: [Video]}}\n")
        group = f"groups: [{{policies: p/*.xml, labels: l.yaml, domain: 1, namespace: {{{key}: /*}}}}]\n"
        assert found(group) == {"/camera -> /screen": 2}
        names = {(e.robot, e.name) for e in run(group).analysis.graph.elements if e.is_channel}
        assert names == {("a", "/image"), ("b", "/image"), ("domain 1", "/map")}

    def test_lines_stand_as_a_policy_writes_them_also_at_the_second_of_robots_that_are_alike(self) -> None:
        """Both are of one policy, under the namespace of the first (rule S1)."""
        result = run(
            "groups: [{robots: 3, model: eye, namespace: {add: /*}}]\nflows: [{from: '*:/uplink', to: '*:/camera'}]\n"
        )
        grants = [grant for flow in result.analysis.graph.flows for grant in flow.grants if grant.node]
        assert {element.robot for element in result.analysis.graph.elements} == {"eye_1", "eye_2"}
        assert grants
        assert not [grant for grant in grants if grant.node.startswith("/eye_")]

    def test_another_robot_may_name_a_channel_by_its_namespace(self) -> None:
        write("a.xml", policy("/a/camera>/a/image"))
        write("b.xml", policy("/b/screen</a/image"))
        write("a.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}}\n")
        write("b.yaml", "labels: 1\nnodes: {/screen: {leak: [Video]}}\nchannels: {/a/image: sensitive}\n")
        text = (
            "robots:\n  a: {policies: a.xml, labels: a.yaml, domain: 1, namespace: {strip: /a}}\n"
            "  b: {policies: b.xml, labels: b.yaml, domain: 1, namespace: {strip: /b}}\n"
        )
        assert found(text) == {"/camera -> /screen across": 1}

    def test_a_name_that_would_be_there_twice_keeps_its_namespace(self) -> None:
        write("a.xml", policy("/a/camera>/a/image,/image"))
        result = run("robots: {a: {policies: a.xml, namespace: {strip: /a}}}\n")
        assert {e.name for e in result.analysis.graph.elements} == {"/camera", "/image", "/a/image"}

    def test_limits_of_every_robot_hold_for_what_is_shared(self) -> None:
        write("eye.yaml", Path("eye.yaml").read_text("utf-8") + "limits: {Video: P7D}\n")
        text = (
            "robots: {a: {model: eye}, b: {model: wall}}\n"
            "elements: {bucket: {kind: storage, country: DE, retention: P30D}}\n"
            "flows: [{from: 'a:/uplink', to: bucket}]\n"
        )
        (finding,) = run(text).analysis.findings
        assert finding.reason == "kept for P30D, which can be longer than the P7D that Video may be kept"

    def test_infrastructure_is_no_robot(self) -> None:
        text = (
            "groups: [{robots: 3, model: eye}]\ninfrastructure: {base: {model: wall}}\n"
            "flows: [{from: '*:/uplink', to: 'base:/receiver'}]\n"
        )
        result = run(text)
        assert found(text) == {"/camera -> /screen": 3}
        assert result.document()["fleet"]["robots"] == 3
        assert [p.robots for p in result.fleet.patterns] == [("eye_1", "eye_2", "eye_3")] if result.fleet else False


class TestOneByOne:
    def test_a_fleet_that_shares_nothing_is_its_robots_one_by_one(self) -> None:
        """Findings, open elements, what is carried, counts."""
        systems = {
            "care": ([EXAMPLES / "care-home/care-home.policy.xml"], [EXAMPLES / "care-home/care-home.labels.yaml"]),
            "work2": ([EXAMPLES / "factory/before.policy.xml"], [EXAMPLES / "factory/run2.labels.yaml"]),
            "work5": ([EXAMPLES / "factory/after.policy.xml"], [EXAMPLES / "factory/run5.labels.yaml"]),
        }
        spec = {
            name: {"policies": [str(p) for p in ps], "labels": [str(x) for x in ls]}
            for name, (ps, ls) in systems.items()
        }
        robots = {**spec, "work1": spec["work2"]}
        whole = run(f"robots: {json.dumps(robots)}\n", include_root="/").document()
        rows: dict[str, Any] = {"findings": [], "open": [], "carries": []}
        counts = dict.fromkeys(("elements", "flows", "denied_flows", "standard_channels"), 0)
        stands_for = {"care": 1, "work1": 2, "work5": 1}
        for robot, many in stands_for.items():
            ps, ls = robots[robot]["policies"], robots[robot]["labels"]
            alone = rosprivacy.analyze(ps, ls).document()
            for key in rows:
                rows[key] += [json.dumps(_on(row, robot), sort_keys=True) for row in alone[key]]
            for key in counts:
                counts[key] += many * alone[key]
        for key, expected in rows.items():
            got = [json.dumps(_on(row, ""), sort_keys=True) for row in whole[key]]
            assert sorted(got) == sorted(expected), key
        assert counts == {key: whole[key] for key in counts}
        assert whole["fleet"]["robots"] == 4


def _on(row: Any, robot: str) -> Any:
    """A row with the robot's name put in where there is none, and without ids, which are made from it."""
    if isinstance(row, dict):
        named = {"robot": row["robot"] or robot} if "robot" in row else {}
        return {key: _on(value, robot) for key, value in row.items() if key != "id"} | named
    return [_on(item, robot) for item in row] if isinstance(row, list) else row


class TestRefusals:
    ROBOT = "fleet: 1\n" + MODELS + "robots: {a: {model: eye}}\n"

    @pytest.mark.parametrize(
        ("text", "problem"),
        [
            ("robots: {a: {policies: eye.xml}}\n", "1: no 'fleet: 1'"),
            ("fleet: 2\nrobots: {a: {policies: eye.xml}}\n", "1: fleet format '2'"),
            ("", "1: the file is empty"),
            ("fleet: 1\n", "1: a fleet without robots"),
            ("fleet: 1\nrobos: {}\n", "2: unknown key 'robos'; did you mean 'robots'?"),
            ("fleet: 1\nrobots: {a: {}}\n", "2: robot 'a' has no policies"),
            ("fleet: 1\nrobots: {a: {policies: no.xml}}\n", "2: no.xml: file not found"),
            ("fleet: 1\nrobots: {a: {policies: eye.xml, labels: no.yaml}}\n", "2: no.yaml: file not found"),
            ("fleet: 1\nmodels: {m: {policies: no.xml}}\nrobots: {a: {model: m}}\n", "2: no.xml: file not found"),
            ("fleet: 1\nrobots: {a: {model: m}}\n", "2: unknown model 'm'; models: there is none"),
            ("fleet: 1\nrobots: {a b: {policies: eye.xml}}\n", "2: 'a b' cannot name a robot or model"),
            ("fleet: 1\nrobots: {shared: {policies: eye.xml}}\n", "2: robot 'shared' has the name of what is shared"),
            ("fleet: 1\nname: a\nrobots: {a: {policies: eye.xml}}\n", "3: robot 'a' has the name of what is shared"),
            ("fleet: 1\nrobots: [a]\n", "2: robots is a map, not a list"),
            ("fleet: 1\nrobots: {a: {policies: eye.xml, domain: 'x y'}}\n", "2: 'x y' cannot be a domain"),
            ("fleet: 1\nrobots: {a: {policies: eye.xml, namespace: /a}}\n", "2: namespace takes strip or add"),
            ("fleet: 1\nrobots: {a: {policies: eye.xml, namespace: {strip: a}}}\n", "2: 'a' cannot be a namespace"),
            ("fleet: 1\nrobots:\n  a: {policies: eye.xml}\n  a: {}\n", "4: 'a' again, first in line 3"),
        ],
    )
    def test_each_is_a_line(self, text: str, problem: str) -> None:
        (line,) = refused(text)
        assert line.startswith(problem)

    @pytest.mark.parametrize(
        ("more", "problem"),
        [
            # the same robot twice
            ("groups:\n" + "  - {robots: 1, model: eye, id: 'a*'}\n" * 2, "6: robot 'a1' again"),
            ("infrastructure: {a: {model: eye}}\n", "4: robot 'a' again, first at f.yaml:3"),
            ("models_again: {}\n", "4: unknown key 'models_again'"),
            # groups
            ("groups: [{robots: 0, model: eye}]\n", "4: robots: '0'; write a whole number above 0"),
            ("groups: [{robots: many, model: eye}]\n", "4: robots: 'many'"),
            ("groups: [{robots: 2, model: eye, id: x}]\n", "4: 'x' cannot be the ids of a group"),
            ("groups: [{model: eye}]\n", "4: a group takes either a number of robots or policies with a *"),
            ("groups: [{robots: 2, policies: '*.xml'}]\n", "4: a group takes either a number of robots or"),
            ("groups: [{policies: 'no/*.xml'}]\n", "4: 'no/*.xml' matches no file"),
            ("groups: [{policies: '*/*.xml'}]\n", "4: '*/*.xml' has more than one *"),
            ("groups: {}\n", "4: groups is a list, not a map"),
            # includes
            ("include: no.yaml\n", "4: no.yaml: file not found"),
            ("include: f.yaml\n", "4: f.yaml includes itself, on a ring"),
            ("include: [1]\n", "4: include: a number"),
            ("include: ring.yaml\n", "ring2.yaml:3: ring.yaml includes itself, on a ring"),
            ("include: a.yaml\n", "a.yaml:3: robot 'a' again, first at f.yaml:3"),
            # elements
            ("elements: {b: {kind: storage, retention: 1 month}}\n", "4: '1 month' is not an ISO 8601 duration"),
            ("elements: {b: {kind: storage, country: Germany}}\n", "4: 'Germany' is not an ISO 3166-1 country code"),
            ("limits: {Video: x}\n", "4: 'x' is not an ISO 8601 duration"),
            # flows
            ("flows: [{from: 'b:/uplink', to: 'a:/camera'}]\n", "4: a flow names the robot 'b', which is not there"),
            ("flows: [{from: 'b*:/uplink', to: 'a:/camera'}]\n", "4: a flow names the robot 'b*', which is not"),
            ("flows: [{from: 'a:/uplnk', to: 'a:/camera'}]\n", "4: a flow names '/uplnk', which is not there"),
            ("flows: [{from: /uplink, to: 'a:/camera'}]\n", "4: a flow names '/uplink' and does not say on which"),
            ("flows: [{from: 'a:/uplink', to: bucket}]\n", "4: a flow names 'bucket', which is not there"),
            ("flows: [{from: 'a:/uplink'}]\n", "4: a flow needs from and to"),
        ],
    )
    def test_each_beside_a_robot(self, more: str, problem: str) -> None:
        write("ring.yaml", "fleet: 1\ninclude: ring2.yaml\n")
        write("ring2.yaml", "fleet: 1\n\ninclude: ring.yaml\n")
        write("a.yaml", "fleet: 1\n\nrobots: {a: {policies: wall.xml}}\n")
        (line,) = refused(self.ROBOT + more)
        assert line.startswith(problem)

    def test_an_element_twice_with_different_facts(self) -> None:
        write("g.yaml", "fleet: 1\nelements: {b: {kind: storage, country: DE}}\n")
        text = self.ROBOT + "include: g.yaml\nelements: {b: {kind: storage, country: FR}}\n"
        (line,) = refused(text)
        assert line.startswith("g.yaml:2: element 'b' again, with other facts than at f.yaml:5")
        write("g.yaml", "fleet: 1\nelements: {b: {kind: storage, country: FR}}\n")
        assert answer_fleet(_written(text), Settings())

    def test_all_problems_of_all_files_at_once(self) -> None:
        write("g.yaml", "fleet: 1\nlimits: {Video: x}\n")
        lines = refused("fleet: 1\ninclude: [g.yaml, no.yaml]\nrobots: {a: {model: m}, b: {}}\nflows: [{from: a}]\n")
        assert [line[:7] for line in lines] == ["2: no.y", "3: robo", "3: unkn", "4: a fl", "g.yaml:"]

    def test_problems_of_labels_and_policies_are_told_as_theirs(self) -> None:
        write("eye.yaml", "labels: 1\nnodes: {/camra: {source: [Video]}}\n")
        write("wall.xml", "<policy/>")
        with pytest.raises(InputErrors) as caught:
            run("robots: {a: {model: eye}, b: {model: wall}, c: {model: eye, domain: 1}}\n")
        places = [line.partition(": ")[0] for line in str(caught.value).splitlines()]
        assert places == ["eye.yaml:2", "wall.xml:1", "wall.xml:1"]


FULL: dict[str, Any] = {
    "fleet": 1,
    "name": "site",
    "include": ["g.yaml"],
    "models": {"eye": {"policies": ["eye.xml"], "labels": "eye.yaml", "domain": "x", "namespace": {"add": "/*"}}},
    "robots": {"a": {"model": "eye", "policies": "wall.xml", "labels": [], "domain": 7, "note": "x"}},
    "infrastructure": {"base": {"policies": ["eye.xml"], "namespace": {"strip": "/base"}}},
    "groups": [{"robots": 2, "id": "c*", "model": "eye", "note": "x"}, {"policies": "robots/*.xml"}],
    "elements": {"bucket": {"kind": "storage"}},
    "limits": {"Video": "P1D"},
    "flows": [{"from": "a:/uplink", "to": "bucket"}],
    "note": "x",
}
OTHERS: tuple[Any, ...] = (
    None, 0, 1, 1.5, True, "", "x", "/x", "eye", [], {}, [None], [1], [[]], [{}], ["eye.xml"], {"x": None}, {"x": 1},
)  # fmt: skip


@cache
def validator() -> Any:
    schema = fleet_schema(load().categories.values())
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


class TestSchema:
    def test_it_accepts_what_uses_every_key(self) -> None:
        self.files()
        read(json.dumps(FULL))
        assert validator().is_valid(FULL)

    def files(self) -> None:
        write("g.yaml", "fleet: 1\n")
        write("robots/r.xml", policy("/a>/b"))

    @pytest.mark.slow
    @pytest.mark.parametrize("way", list(places(FULL)), ids=lambda way: ".".join(map(str, way)))
    def test_what_is_read_is_valid(self, way: tuple[Any, ...]) -> None:
        """And what is not valid is refused; what is refused may be valid, for a schema knows no other files."""
        self.files()
        for other in OTHERS:
            document = copy.deepcopy(FULL)
            inside: Any = document
            for key in way[:-1]:
                inside = inside[key]
            inside[way[-1]] = other
            try:
                read(json.dumps(document))
            except InputErrors:
                continue
            assert validator().is_valid(document), f"read, but not valid: {way} = {json.dumps(other)}"
