"""Pins in the label files of a fleet: a file holds for all robots that read it (rule S11)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

import rosprivacy
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from tests.helpers.fleet_files import folder, policy, write

if TYPE_CHECKING:
    from rosprivacy.result import Result
    from tests.helpers.command import Cli

__all__ = ["folder"]
GLOBS = (
    "labels: 1\nnodes:\n  {source}/uplink: {{leak: [Video, Voice]}}\n  '/*': conduit\nchannels: {{'/*': sensitive}}\n"
)
EYE, EAR = (
    GLOBS.format(source=f"/{node}: {{source: [{kind}]}}\n  ") for node, kind in (("camera", "Video"), ("mic", "Voice"))
)


def pins_in(file: str) -> Any:
    return yaml.safe_load(Path(file).read_text("utf-8")).get("pins")


def analysed(text: str) -> Result:
    write("f.yaml", text)
    return rosprivacy.analyze_fleet("f.yaml")


def questions(result: Result) -> set[tuple[str, str, tuple[str, ...]]]:
    return {(q.element.robot, q.element.name, q.categories) for q in result.analysis.open}


def answer(result: Result) -> object:
    findings = {(f.id, f.dismissed) for f in result.analysis.findings}
    return findings, questions(result), result.analysis.verdict


def test_a_models_file_has_what_reached_any_of_its_robots(cli: Cli) -> None:
    """One robot reads a second policy, by which more gets to the nodes of its model's file."""
    write("eye.xml", policy("/camera>/image", "/show</image", "/mic", "/uplink</image"))
    write("ear.xml", policy("/camera", "/mic>/sound", "/show</sound", "/uplink</image"))
    write("eye.yaml", EYE.replace("/uplink", "/mic: {source: [Voice]}\n  /uplink"))
    fleet = (
        "fleet: 1\nrobots:\n  a: {policies: eye.xml, labels: eye.yaml}\n  b: {policies: ear.xml, labels: eye.yaml}\n"
    )
    write("eye.yaml", Path("eye.yaml").read_text().replace("channels: {'/*': sensitive}", "topics: {'/*': sensitive}"))
    before = analysed(fleet)
    done = cli("labels", "--pin", "--fleet", "f.yaml")
    assert (done.returncode, done.stdout) == (0, "")
    assert pins_in("eye.yaml") == {
        "nodes": {"/show": ["Video", "Voice"]},
        "topics": {"/image": ["Video"], "/sound": ["Voice"]},
    }
    after = rosprivacy.analyze_fleet("f.yaml")
    assert answer(after) == answer(before)
    assert not [d for d in after.diagnostics if d.code == PIN_OF_NOTHING]  # /sound is there on b
    assert cli("labels", "--pin", "--fleet", "f.yaml").stderr == "eye.yaml: 0 lines changed\n"


def test_robots_of_one_domain(cli: Cli) -> None:
    """What is shared is in the file of each robot, and what another robot sends is pinned, too."""
    write("eye.xml", policy("/camera>/image", "/show</image"))
    write("ear.xml", policy("/mic>/sound", "/listen</image,/sound"))
    write("eye.yaml", EYE.replace("  /uplink: {leak: [Video, Voice]}\n", ""))
    write("ear.yaml", EAR.replace("  /uplink: {leak: [Video, Voice]}\n", ""))
    robot = "  {}: {{policies: {}.xml, labels: {}.yaml, domain: hall}}\n"
    before = analysed("fleet: 1\nrobots:\n" + robot.format("a", "eye", "eye") + robot.format("b", "ear", "ear"))
    assert cli("labels", "--pin", "--fleet", "f.yaml").returncode == 0
    assert pins_in("eye.yaml") == {"nodes": {"/show": ["Video"]}, "topics": {"/image": ["Video"]}}
    assert pins_in("ear.yaml") == {
        "nodes": {"/listen": ["Video", "Voice"]},
        "topics": {"/image": ["Video"], "/sound": ["Voice"]},
    }
    assert answer(rosprivacy.analyze_fleet("f.yaml")) == answer(before)


def test_robots_that_are_alike_by_what_their_files_hold_get_the_same(cli: Cli) -> None:
    write("eye.xml", policy("/camera>/image", "/show</image"))
    text = EYE.replace("  /uplink: {leak: [Video, Voice]}\n", "")
    for name in ("a.yaml", "b.yaml"):
        write(name, text)
    analysed("fleet: 1\nrobots:\n  a: {policies: eye.xml, labels: a.yaml}\n  b: {policies: eye.xml, labels: b.yaml}\n")
    assert cli("labels", "--pin", "--fleet", "f.yaml").returncode == 0
    assert Path("a.yaml").read_text() == Path("b.yaml").read_text() != text


def test_a_new_node_of_one_robot_is_open_there(cli: Cli) -> None:
    write("eye.xml", policy("/camera>/image", "/show</image"))
    write("more.xml", policy("/camera>/image", "/show</image", "/new</image"))
    write("eye.yaml", EYE.replace("  /uplink: {leak: [Video, Voice]}\n", ""))
    robot = "  {}: {{policies: {}.xml, labels: eye.yaml}}\n"
    analysed("fleet: 1\nrobots:\n" + robot.format("a", "eye") + robot.format("b", "eye"))
    assert cli("labels", "--pin", "--fleet", "f.yaml").returncode == 0
    result = analysed("fleet: 1\nrobots:\n" + robot.format("a", "eye") + robot.format("b", "more"))
    assert questions(result) == {("b", "/new", ("Video",))}


def test_names_in_pins_are_without_the_robots_namespace(cli: Cli) -> None:
    write("eye.xml", policy("/camera>image", "/show<image", "/up>/all<image"))
    write("eye.yaml", EYE.replace("  /uplink: {leak: [Video, Voice]}\n", ""))
    robot = "  {0}: {{policies: eye.xml, labels: eye.yaml, domain: hall, namespace: {{add: /{0}}}}}\n"
    before = analysed("fleet: 1\nrobots:\n" + robot.format("a") + robot.format("b"))
    assert cli("labels", "--pin", "--fleet", "f.yaml").returncode == 0
    assert pins_in("eye.yaml") == {
        "nodes": {"/show": ["Video"], "/up": ["Video"]},
        "topics": {"/all": ["Video"], "/image": ["Video"]},
    }
    assert answer(rosprivacy.analyze_fleet("f.yaml")) == answer(before)
