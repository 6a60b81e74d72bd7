"""``types`` of fleet files: files of observed types of a model and of a robot (rules S1, S10, S15)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.ingest.fleet.alike_robots import alike
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.settings import Settings
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.fleet_files import policy, read, write
from tests.helpers.fleet_rows import VOCABULARY, rows

if TYPE_CHECKING:
    from rosprivacy.private_neo4j.connection import Connection
    from tests.helpers.command import Cli

BOOL, IMAGE = "std_msgs/msg/Bool", "sensor_msgs/msg/Image"
MODEL = "models: {m: {policies: m.xml, labels: m.yaml, types: m.types.yaml}}\n"


def seen(name: str, type_name: str, *, channel: str = "/image", writer: str = "/camera") -> None:
    write(name, f"types: 1\ntopics: {{{channel}: [{{type: {type_name}, writers: [{writer}]}}]}}\n")


@pytest.fixture(autouse=True)
def a_model_that_leaks_where_types_do_not_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write("m.xml", policy("/camera>/image", "/uplink</image"))
    write("m.yaml", "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n")
    seen("m.types.yaml", BOOL)


def told(text: str, **more: Any) -> dict[str, Any]:
    write("f.yaml", f"fleet: 1\n{text}")
    return dict(rosprivacy.analyze_fleet("f.yaml", **more).document())


def types_of(document: dict[str, Any]) -> dict[str, list[str]]:
    return {row["element"]["robot"]: [one["type"] for one in row["types"]] for row in document["types"]}


def test_a_models_file_holds_for_its_robots_and_is_named_with_its_hash() -> None:
    document = told(f"{MODEL}robots: {{r1: {{model: m}}, r2: {{model: m}}}}\n")
    assert document["findings"] == []
    assert [row["leak"]["name"] for row in document["assumptions"]["closed_by_types"]] == ["/uplink"]
    (file,) = document["assumptions"]["types"]
    assert (Path(file["file"]).name, len(file["sha256"])) == ("m.types.yaml", 64)
    assert told(f"{MODEL}robots: {{r1: {{model: m}}}}\n", type_limits=None)["findings"]


@pytest.mark.parametrize("closed_on", [{"r1"}, {"r2"}, {"r3"}, {"r1", "r3"}, set()])
def test_what_types_close_on_some_robots_only_is_told_too(closed_on: set[str]) -> None:
    """S10, S15: the finding of the others is of the same pattern, and is no reason to be silent about these."""
    seen("r.types.yaml", IMAGE)
    robots = ", ".join(
        f"{name}: {{policies: m.xml, labels: m.yaml, types: {'m' if name in closed_on else 'r'}.types.yaml}}"
        for name in ("r1", "r2", "r3")
    )
    document = told(f"robots: {{{robots}}}\n")
    (pattern,) = document["fleet"]["patterns"]
    assert set(pattern["robots"]) == {"r1", "r2", "r3"} - closed_on
    closed = document["assumptions"].get("closed_by_types", [])
    assert [row["source"]["robot"] for row in closed] == sorted(closed_on)[:1]
    assert {row["element"]["robot"] for row in document["assumptions"].get("type_limits_reached", [])} <= closed_on


def test_what_a_robot_and_its_model_say_are_both_types_of_the_channel() -> None:
    """S15: several types exclude only what all of them exclude."""
    seen("r.types.yaml", IMAGE)
    document = told(f"{MODEL}robots: {{r1: {{model: m}}, r2: {{model: m, types: [r.types.yaml]}}}}\n")
    assert types_of(document) == {"r1": [BOOL], "r2": [IMAGE, BOOL]}
    assert [finding["source"]["robot"] for finding in document["findings"]] == ["r2"]
    seen("r.types.yaml", "std_msgs/msg/Empty")
    assert told(f"{MODEL}robots: {{r2: {{model: m, types: r.types.yaml}}}}\n")["findings"] == []


@pytest.mark.parametrize(("own", "closed"), [(IMAGE, False), ("std_msgs/msg/Empty", True)])
def test_so_are_those_that_label_files_of_both_state(own: str, *, closed: bool) -> None:
    for name, type_name in (("stated.yaml", BOOL), ("own.yaml", own)):
        write(name, f"labels: 1\ntopics: {{/image: {{types: [{type_name}]}}}}\n")
    models = "models: {m: {policies: m.xml, labels: [m.yaml, stated.yaml]}}\n"
    document = told(f"{models}robots: {{r1: {{model: m, labels: own.yaml}}}}\n")
    assert types_of(document) == {"r1": sorted([BOOL, own])}
    assert (document["findings"] == []) == closed


def test_robots_of_which_other_types_were_seen_are_not_alike() -> None:
    seen("same.types.yaml", BOOL)
    seen("r.types.yaml", IMAGE)
    models = "models: {m: {policies: m.xml, labels: m.yaml}}\n"
    robots = ", ".join(f"r{n}: {{model: m, types: {name}.types.yaml}}" for n, name in enumerate(("m", "same", "r")))
    groups = alike(read(f"fleet: 1\n{models}robots: {{{robots}, r3: {{model: m}}}}\n"))
    assert [[robot.id for robot in group.robots] for group in groups] == [["r0", "r1"], ["r2"], ["r3"]]


def test_in_a_group_the_star_is_the_robot() -> None:
    for robot, type_name in (("a", BOOL), ("b", IMAGE)):
        write(f"visitors/{robot}/policy.xml", Path("m.xml").read_text("utf-8"))
        seen(f"visitors/{robot}/types.yaml", type_name)
    document = told("groups: [{policies: visitors/*/policy.xml, labels: m.yaml, types: visitors/*/types.yaml}]\n")
    assert types_of(document) == {"a": [BOOL], "b": [IMAGE]}
    assert [finding["source"]["robot"] for finding in document["findings"]] == ["b"]


@pytest.mark.parametrize(
    ("channel", "writer", "closed"),
    [("/r1/image", "/r1/camera", True), ("/image", "/camera", False), ("/r1/image", "/camera", False)],
)
def test_of_a_robot_with_a_namespace_the_file_has_the_names_of_its_policies(
    channel: str, writer: str, *, closed: bool
) -> None:
    """S1: what the policies call ``/r1/image`` is told as ``/image``, and is not the topic ``/image`` of a file."""
    write("r1.xml", policy("/r1/camera>/r1/image", "/r1/uplink</r1/image"))
    seen("r1.types.yaml", BOOL, channel=channel, writer=writer)
    robot = "{policies: r1.xml, labels: m.yaml, types: r1.types.yaml, namespace: {strip: /r1}}"
    document = told(f"robots: {{r1: {robot}}}\n")
    assert (document["findings"] == []) == closed
    lost = [row["message"] for row in document["diagnostics"] if row.get("code") == "types-of-nothing"]
    assert bool(lost) != closed
    written = told("robots: {r1: {policies: m.xml, labels: m.yaml, types: m.types.yaml, namespace: {add: /r1}}}\n")
    assert written["findings"] == []


def test_in_a_shared_domain_a_file_speaks_for_the_writers_of_its_robot_only() -> None:
    write("more.xml", policy("/more>/image"))
    robots = "r1: {model: m, domain: d}, r2: {policies: more.xml, domain: d%s}"
    assert told(f"{MODEL}robots: {{{robots % ''}}}\n")["findings"]
    seen("more.types.yaml", BOOL, writer="/more")
    assert told(f"{MODEL}robots: {{{robots % ', types: more.types.yaml'}}}\n")["findings"] == []


def test_what_cannot_be_read_is_told_at_its_line() -> None:
    write("bad.types.yaml", "types: 1\nextra: 1\n")
    with pytest.raises(rosprivacy.InputErrors, match=r"bad\.types\.yaml:2: unknown key 'extra'"):
        told("robots: {r1: {policies: m.xml, types: bad.types.yaml}}\n")
    for wrong, why in (
        ("gone.yaml", "file not found"),
        ("../out.yaml", "leaves the folder"),
        ("rosprivacy:types", "not found"),
    ):
        with pytest.raises(rosprivacy.InputErrors, match=rf"f\.yaml:3: .*{why}"):
            told(f"robots:\n  r1: {{policies: m.xml, types: '{wrong}'}}\n")


def test_the_list_of_robots_names_them(cli: Cli) -> None:
    write("f.yaml", f"fleet: 1\n{MODEL}robots: {{r1: {{model: m}}}}\n")
    assert "    types: m.types.yaml" in cli("fleet", "f.yaml").stdout


@pytest.mark.database
def test_the_database_gives_the_same_answer(neo4j_server: Connection) -> None:
    seen("r.types.yaml", IMAGE)
    write("f.yaml", f"fleet: 1\n{MODEL}robots: {{r1: {{model: m}}, r2: {{model: m, types: r.types.yaml}}}}\n")
    expected = rosprivacy.analyze_fleet("f.yaml").document()
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load(driver, rows("f.yaml"), VOCABULARY)
        stored = answer_stored(driver, Settings()).document()
    for key in ("types", "findings", "open"):
        assert stored[key] == expected[key]
    assert stored["assumptions"]["types"] == expected["assumptions"]["types"]
