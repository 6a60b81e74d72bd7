"""Several policies: that they make one graph is said, and each can be analysed alone (rules S5, S11)."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest

from tests.helpers.fleet_files import policy
from tests.helpers.observed import node_info
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

APART = "what goes from the nodes of one to those of another is not looked at"
NODES = ("camera", "mapper", "uplink")
MERGED = "policies make one graph"
LABELS = """labels: 1
nodes: {/camera: {source: [Video], leak: none}, /uplink: {leak: [Video]}}
channels: {/video: sensitive}
"""


ONE_GRAPH = "notice: p/a.xml:1: 3 policies make one graph"
ALONE = "--per-policy analyses each alone"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A camera in one policy, what lets out in another: only together they leak."""
    (tmp_path / "p").mkdir()
    (tmp_path / "p" / "a.xml").write_text(policy("/camera>video"))
    (tmp_path / "p" / "b.xml").write_text(policy("/uplink<video"))
    (tmp_path / "l.yaml").write_text(LABELS)
    return tmp_path


@pytest.mark.parametrize(
    ("third", "notice"),
    [
        ((), ""),  # what belongs together
        (("/camera>video",), ""),  # the same is no other
        (("/arm>vid*",), ""),  # a wildcard joins them
        (("/camera>other",), ": node /camera is stated differently in p/a.xml and p/c.xml; "),
        (("/arm>joints,rosout",), " of 2 parts that share no node and no channel: p/a.xml and p/b.xml | p/c.xml; "),
    ],
    ids=["two", "the same", "wildcard", "another node", "nothing in common"],
)
def test_what_may_not_belong_together_is_named(cli: Cli, folder: Path, third: tuple[str, ...], notice: str) -> None:
    if third:
        (folder / "p" / "c.xml").write_text(policy(*third))
    lines = cli("analyze", "p", "-l", "l.yaml", cwd=folder).stdout.splitlines()
    told = [line for line in lines if MERGED in line]
    assert len(told) == bool(notice)
    assert all(line.startswith(ONE_GRAPH) and notice in line and line.endswith(ALONE) for line in told)


@pytest.mark.parametrize("observed", [False, True], ids=["policies", "observed"])
@pytest.mark.parametrize("joint", ["", "tf"], ids=["nothing in common", "a channel in common"])
def test_a_robot_beside_itself_below_a_namespace_is_told_of(
    cli: Cli, tmp_path: Path, joint: str, *, observed: bool
) -> None:
    """Whoever gives two robots at once has one graph; two observations of one robot are meant to be one."""
    robots = {}
    for name, below in (("a", ""), ("b", "/r1")):
        shared = [f"/{joint}: tf2_msgs/msg/TFMessage"] if joint else []
        nodes = [
            node_info(f"{below}/{node}", publishers="; ".join([f"{below}/{node}: t/msg/T", *shared])) for node in NODES
        ]
        (tmp_path / f"{name}.txt").write_text("".join(nodes))
        done = cli(
            "observe", "--text", f"{name}.txt", "-o", f"{name}.xml", "--at", "2026-11-22T10:00:00Z", cwd=tmp_path
        )
        assert done.returncode == 0, done.stderr
        text = (tmp_path / f"{name}.xml").read_text()
        robots[name] = text if observed else re.sub(r"<!--.*?-->", "", text, flags=re.DOTALL)
        (tmp_path / f"{name}.xml").write_text(robots[name])
    (tmp_path / "again.xml").write_text(robots["a"])
    (line,) = (line for line in cli("analyze", "a.xml", "b.xml", cwd=tmp_path).stdout.splitlines() if MERGED in line)
    assert line.startswith("notice: a.xml:")
    assert ("below /, /r1" in line) == bool(joint)
    assert line.endswith(ALONE)
    assert MERGED not in cli("analyze", "a.xml", "again.xml", cwd=tmp_path).stdout


def test_several_policies_of_one_robot_of_a_fleet_are_told_alike(cli: Cli, folder: Path) -> None:
    """What a robot runs makes one graph (S4); of what two robots run, each has its own."""
    (folder / "p" / "c.xml").write_text(policy("/camera>other", "/uplink<rosout"))
    fleet = "fleet: 1\nname: f\nrobots: {r: {policies: [%s], labels: l.yaml}, s: {policies: [%s], labels: l.yaml}}\n"
    (folder / "f.yaml").write_text(fleet % ("p/a.xml, p/b.xml, p/c.xml", "p/b.xml, p/a.xml"))
    done = cli("analyze", "--fleet", "f.yaml", cwd=folder)
    said = "notice: p/%s.xml:1: 3 policies make one graph, with what each of them allows: node %s is stated "
    said += "differently in p/%s.xml and p/c.xml; name for a robot of the fleet only what runs on it"
    assert [line for line in done.stdout.splitlines() if MERGED in line] == [
        said % ("a", "/camera", "a"),
        said % ("b", "/uplink", "b"),
    ]
    (folder / "f.yaml").write_text(fleet % ("p/a.xml, p/b.xml", "p/b.xml, p/a.xml"))
    done = cli("analyze", "--fleet", "f.yaml", cwd=folder)
    assert (done.returncode, MERGED in done.stdout) == (1, False)


def answers(cli: Cli, folder: Path, *options: str) -> Any:
    return json.loads(cli("analyze", "p", "-l", "l.yaml", "--per-policy", "-f", "json1", *options, cwd=folder).stdout)


def test_each_policy_alone_is_as_if_it_were_the_only_one(cli: Cli, folder: Path) -> None:
    (folder / "p" / "c.xml").write_text(policy("/camera>video", "/uplink<video"))
    document = answers(cli, folder)
    assert (document["format"], document["verdict"]) == ("rosprivacy.analyses/1", "leak")
    verdicts = {row["policy"]: row["analysis"]["verdict"] for row in document["policies"]}
    assert verdicts == {"p/a.xml": "no-leak-found", "p/b.xml": "undetermined", "p/c.xml": "leak"}
    alone = cli("analyze", "p/c.xml", "-l", "l.yaml", "-f", "json1", cwd=folder).stdout
    assert document["policies"][2]["analysis"] == json.loads(alone)
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text("utf-8"))
    for row in document["policies"]:
        jsonschema.validate(row["analysis"], schema)


def test_the_text_ends_with_a_summary_and_the_exit_code_is_the_worst(cli: Cli, folder: Path) -> None:
    command = ("analyze", "p", "-l", "l.yaml", "--per-policy")
    done = cli(*command, cwd=folder)
    assert done.returncode == 4  # b alone has no source
    assert [line.partition(": ")[0] for line in done.stdout.splitlines()[-3:]] == [
        "no-leak-found", "undetermined", "undetermined",
    ]  # fmt: skip
    assert done.stdout.endswith(f"the worst of 2 policies, each alone; {APART}\n")
    assert len(cli(*command, "-q", cwd=folder).stdout.splitlines()) == 3
    assert cli("analyze", "p", "-l", "l.yaml", cwd=folder).returncode == 1  # together they leak
    (folder / "p" / "c.xml").write_text(policy("/camera>video", "/uplink<video"))
    assert cli(*command, cwd=folder).returncode == 1
    assert cli(*command, "--fail-on", "never", cwd=folder).returncode == 0


def test_a_name_that_matches_in_no_policy_is_an_error(cli: Cli, folder: Path) -> None:
    (folder / "l.yaml").write_text(LABELS.replace("/uplink", "/uplnk"))
    done = cli("analyze", "p", "-l", "l.yaml", "--per-policy", cwd=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert "'/uplnk' matches no node of the policies; did you mean /uplink?" in done.stderr


def test_what_a_label_names_may_stand_in_one_of_them(cli: Cli, folder: Path) -> None:
    """The channels of a source, stated flows, and what joins two nodes."""
    more = "elements: {ring: {kind: shared-memory, between: [/camera, /uplink]}}\nflows: [{from: /uplink, to: ring}]\n"
    (folder / "l.yaml").write_text(LABELS.replace("source: [Video]", "source: {Video: [/video]}") + more)
    assert [row["analysis"]["verdict"] for row in answers(cli, folder)["policies"]] == ["no-leak-found", "undetermined"]


@pytest.mark.parametrize(
    "options", [("--fleet", "f.yaml"), ("--from-database",), ("p", "--add", "g.json"), ("p", "-f", "sarif")]
)
def test_what_makes_no_sense_beside_it_is_refused(cli: Cli, folder: Path, options: tuple[str, ...]) -> None:
    done = cli("analyze", "--per-policy", *options, cwd=folder)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--per-policy" in done.stderr
