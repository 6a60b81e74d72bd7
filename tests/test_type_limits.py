"""What message types cannot carry, they do not (rule S15), case by case; on random systems in another file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
from rosprivacy.formats import FORMATS
from rosprivacy.ingest.neo4j_graph.loading import load as load_rows
from rosprivacy.ingest.policies.saved_graph import as_dict
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import excluded, read_table
from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.vocabulary import load
from rosprivacy.private_neo4j import connection
from rosprivacy.report.json_text import as_text
from rosprivacy.report.pictures import views
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.text.taken_away import lines as why_not_lines
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.fleet_files import policy

if TYPE_CHECKING:
    from rosprivacy.private_neo4j.connection import Connection
    from rosprivacy.result import Result

VOCABULARY = load()
CAMERA = "/cam>/a", "/door>/x</a", "/sink</x"
LABELS = """labels: 1
nodes: {{/cam: {{source: [Video]}}, /sink: {{leak: [Video]}}, /door: {door}}}
channels: {{/a: {a}, /x: sensitive}}
"""


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def told(a: str, door: str = "conduit", profiles: tuple[str, ...] = CAMERA, **more: Any) -> Result:
    Path("p.xml").write_text(policy(*profiles), "utf-8")
    Path("l.yaml").write_text(LABELS.format(a=a, door=door), "utf-8")
    return rosprivacy.analyze("p.xml", "l.yaml", **more)


BOOL = "{types: [std_msgs/msg/Bool]}"


def test_one_bit_carries_no_video_and_what_lies_behind_is_as_open_as_before() -> None:
    result = told(BOOL, door="")
    assert not result.findings
    assert [question.element.name for question in result.analysis.open] == ["/door", "/a"]
    said = result.document()["assumptions"]
    assert (said["type_limits"]["file"], said["type_limits"]["flows"]) == (TABLE, 1)
    assert said["type_limits_reached"][0]["categories"] == ["Video"]
    assert [row["leak"]["name"] for row in said["closed_by_types"]] == ["/sink"]
    assert str(result.analysis.verdict) == "undetermined"


def test_where_nothing_was_followed_but_into_types_nothing_is_said_to_be_found() -> None:
    """S11, S15: the source's data goes nowhere else, so the label or the type may be wrong."""
    result = told(BOOL)
    assert (result.analysis.lacking, str(result.analysis.verdict)) == ("goes-nowhere", "undetermined")
    result = told(BOOL.replace("{", "{only: [Presence], "))  # a person closes it too: that was looked at
    assert (result.analysis.lacking, str(result.analysis.verdict)) == ("", "no-leak-found")


@pytest.mark.parametrize(
    "a",
    [
        "{types: [std_msgs/msg/Bool, sensor_msgs/msg/Image]}",  # a second type
        "{types: [std_msgs/msg/String]}",  # text limits nothing
        "{types: [own_msgs/msg/Bool]}",  # what is not known limits nothing
        "{types: [std_msgs/msg/Bool], only: [Video]}",  # a label states it
        "{types: [std_msgs/msg/Bool], only: [FaceImage, PersonImage]}",
        "sensitive",
    ],
)
def test_what_is_not_certain_closes_nothing(a: str) -> None:
    assert told(a).findings


def test_what_a_source_names_the_channel_for_is_not_taken_away() -> None:
    text = LABELS.format(a=BOOL, door="conduit").replace("[Video]}, /sink", "{Video: [/a]}}, /sink")
    Path("named.yaml").write_text(text, "utf-8")
    told(BOOL)
    assert rosprivacy.analyze("p.xml", "named.yaml").findings


@pytest.mark.parametrize("written", ["/a", "/a*"])
def test_what_a_derivation_makes_is_not_taken_away_where_it_is_written(written: str) -> None:
    """S15: whoever says that a node makes video says that it goes out there, whatever the types of its channels."""
    Path("p.xml").write_text(policy("/cam>/x", f"/door>{written}</x", "/sink</a"), "utf-8")
    text = LABELS.format(a=BOOL, door="{derives: [{from: Location, to: Video}]}")
    text = text.replace("source: [Video]", "source: [Location]")
    Path("l.yaml").write_text(text, "utf-8")
    assert [f.category for f in rosprivacy.analyze("p.xml", "l.yaml").findings] == ["Video"]


def test_what_a_label_says_of_a_flow_there_is_not_taken_away() -> None:
    text = LABELS.format(a=BOOL, door="conduit") + "flows: [{from: /cam, to: /a, only: [Video]}]\n"
    Path("flow.yaml").write_text(text, "utf-8")
    told(BOOL)
    assert rosprivacy.analyze("p.xml", "flow.yaml").findings


@pytest.mark.parametrize("more", [{"view": "enforced"}, {"type_limits": None}])
def test_they_are_switched_off_and_hold_in_the_declared_view_only(more: Any) -> None:
    result = told(BOOL, **more)
    assert result.findings
    assert result.document()["assumptions"]["type_limits"] is None


SEEN = "types: 1\ntopics: {{/a: [{{type: std_msgs/msg/Bool, writers: [{writers}]}}]}}\n"


@pytest.mark.parametrize(
    ("profiles", "writers", "closes"),
    [
        (CAMERA, "/cam", True),
        (CAMERA, "", False),  # nobody was seen writing it
        (CAMERA, "/ghost", False),
        ((*CAMERA, "/more>/a"), "/cam", False),  # another writer, which was not seen
        ((*CAMERA, "/more>/a"), "/cam, /more", True),
        ((*CAMERA, "/more>/*"), "/cam, /more", False),  # what comes through a wildcard is not known
    ],
)
def test_what_was_seen_holds_where_every_writer_was(profiles: tuple[str, ...], writers: str, *, closes: bool) -> None:
    Path("t.yaml").write_text(SEEN.format(writers=writers), "utf-8")
    assert bool(told("", profiles=profiles, types="t.yaml").findings) != closes


def test_a_type_of_which_nobody_was_seen_writing_is_a_type_of_the_channel() -> None:
    text = SEEN.format(writers="/cam").replace("}]}", "}, {type: Plain::Data, readers: [/door]}]}")
    Path("t.yaml").write_text(text, "utf-8")
    assert told("", types="t.yaml").findings


SERVICE = policy("/cam", "/door", "/sink")
CALL = '<services {role}="ALLOW"><service>/call</service></services>'


@pytest.mark.parametrize(("camera", "closed"), [("request", True), ("reply", False)])
def test_legs_are_limited_by_themselves(camera: str, *, closed: bool) -> None:
    """The request of SetBool is one bit; its response has a text, which limits nothing."""
    other = {"request": "reply", "reply": "request"}[camera]
    text = SERVICE.replace('node="cam">', 'node="cam">' + CALL.format(role=camera))
    text = text.replace('node="sink">', 'node="sink">' + CALL.format(role=other))
    Path("p.xml").write_text(text, "utf-8")
    labels = "labels: 1\nnodes: {/cam: {source: [Video]}, /sink: {leak: [Video]}}\n"
    Path("l.yaml").write_text(labels + "services: {/call: {types: [std_srvs/srv/SetBool]}}\n", "utf-8")
    assert bool(rosprivacy.analyze("p.xml", "l.yaml").findings) != closed


OWN = f"""@prefix rp: <{STORED}> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix e: <urn:example:> .
e:Silhouette a skos:Concept ; rp:label "Silhouette" ; skos:prefLabel "Silhouette"@en ;
    skos:definition "The outline of a person."@en ; {{statements}} .
"""


@pytest.mark.parametrize(
    ("statements", "closed"),
    [
        ("skos:broader rp:Video", True),
        ('skos:broader rp:Video ; rp:dataType "video"', True),
        ('skos:broader rp:Video ; rp:dataType "number"', False),  # another form of data sets it apart
        ("skos:broader rp:Video , rp:Presence", False),  # so does a parent that the type can carry
    ],
)
def test_a_users_own_kind_is_excluded_only_where_nothing_sets_it_apart(statements: str, *, closed: bool) -> None:
    Path("own.ttl").write_text(OWN.format(statements=statements), "utf-8")
    vocabulary = load(ontologies=("own.ttl",))
    assert ("Silhouette" in excluded(vocabulary, frozenset(["PersonImage"]))) == closed
    assert "Silhouette" in excluded(vocabulary, frozenset(["Silhouette"]))


def test_a_shared_domain_knows_the_types_of_each_robot_by_itself() -> None:
    """What is stated of one robot says nothing of what another one writes to the channel that they share (S1)."""
    told(BOOL)
    Path("other.xml").write_text(policy("/more>/a"), "utf-8")
    Path("none.yaml").write_text("labels: 1\nnodes: {/more: }\n", "utf-8")
    robots = (
        "{r1: {policies: p.xml, labels: l.yaml, domain: d}, r2: {policies: other.xml, labels: none.yaml, domain: d}}"
    )
    Path("f.yaml").write_text(f"fleet: 1\nrobots: {robots}\n", "utf-8")
    assert rosprivacy.analyze_fleet("f.yaml").findings
    Path("f.yaml").write_text("fleet: 1\nrobots: {r1: {policies: p.xml, labels: l.yaml}}\n", "utf-8")
    result = rosprivacy.analyze_fleet("f.yaml")
    assert not result.findings
    assert len(result.analysis.closed.findings) == 1  # type: ignore[union-attr]
    Path("none.yaml").write_text("labels: 1\nchannels: {/a: {types: [std_msgs/msg/Bool]}}\n", "utf-8")
    Path("f.yaml").write_text(f"fleet: 1\nrobots: {robots}\n", "utf-8")
    assert not rosprivacy.analyze_fleet("f.yaml").findings


def test_a_table_of_ones_own_replaces_the_shipped_one() -> None:
    Path("table.yaml").write_text(
        "type_table: 1\ncannot: [{types: [a/msg/A], kinds: [PersonImage], why: a test, source: this file}]\n", "utf-8"
    )
    assert told(BOOL, type_limits="table.yaml").findings
    assert not told("{types: [a/msg/A]}", type_limits="table.yaml").findings


def test_a_table_that_cannot_be_read_is_refused_with_all_its_lines() -> None:
    Path("bad.yaml").write_text(
        "type_table: 1\nextra: 1\ncannot:\n  - {types: [Bool], kinds: [Vidoe], why: x, source: y}\n"
        "  - {types: [std_srvs/srv/Empty], kinds: [Video], why: x, source: y}\n"
        "  - {types: [a/msg/B], leg: request, kinds: [Video], why: x, source: y}\n"
        "  - {types: [a/msg/A], kinds: [Video], why: x}\n  - {types: [a/msg/A], kinds: [Voice], why: x, source: y}\n",
        "utf-8",
    )
    with pytest.raises(rosprivacy.InputErrors) as refused:
        read_table("bad.yaml", VOCABULARY)
    assert str(refused.value).splitlines() == [
        "bad.yaml:2: unknown key 'extra'; one of type_table, version, assumes, cannot, hashes, suggests",
        "bad.yaml:4: 'Bool' is not the name of a type; write pkg/msg/Name",
        "bad.yaml:4: unknown category 'Vidoe'; did you mean Video or Voice?",
        "bad.yaml:5: std_srvs/srv/Empty is the type of a service; write leg: request or response",
        "bad.yaml:6: a/msg/B is the type of a topic; remove its leg",
        "bad.yaml:7: an entry without source; write {types: […], kinds: […], why: …, source: …}",
        "bad.yaml:8: a/msg/A again, first in line 7; write all kinds in one entry",
    ]


STORES = ("ROS2_FOXY", "ROS2_HUMBLE", "ROS2_IRON", "ROS2_JAZZY", "ROS2_KILTED", "ROS2_LYRICAL")
FRAMES = {"frame_id", "child_frame_id", "body_frame_id", "reference_frame_id"}  # the table's one assumption
LISTS = {"tf2_msgs/msg/TFMessage", "nav_msgs/msg/Path", "geometry_msgs/msg/PoseArray"}  # of places and directions


def unbounded(definitions: Any, name: str) -> set[str]:
    """What of a type has no bound: text that names no frame, bytes, lists."""
    from rosbags.interfaces import Nodetype

    found = set()
    for field_name, (kind, described) in definitions.fielddefs[name][1]:
        inner, count = (kind, described), 0
        if kind in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            inner, count = described
            if kind == Nodetype.SEQUENCE and not count:
                found.add(f"list {field_name}")
        if inner[0] == Nodetype.NAME:
            found |= unbounded(definitions, inner[1])
        elif inner[1][0] in ("string", "wstring") and field_name not in FRAMES:
            found.add(f"text {field_name}")
        elif kind != Nodetype.BASE and inner[1][0] in ("uint8", "int8", "byte", "char", "octet"):
            found.add(f"bytes {field_name}")
    return found


def test_every_type_of_the_table_is_bounded_in_every_release_of_foreign_definitions() -> None:
    """Text, bytes and lists limit nothing (S15), but for lists of places; measured on the type stores of rosbags."""
    from rosbags.typesys import Stores, get_typestore

    limits = read_table(TABLE, VOCABULARY).limits
    looked = set()
    for store in STORES:
        definitions = get_typestore(Stores[store])
        for name, leg in limits.of:
            if leg or name not in definitions.fielddefs:
                continue
            looked.add(name)
            free = unbounded(definitions, name)
            assert not free or (name in LISTS and all(one.startswith("list ") for one in free)), (store, name, free)
    assert {name for name, leg in limits.of if not leg} == looked


def test_the_hashes_of_the_table_are_those_of_foreign_definitions() -> None:
    """Rule S15; of services there are no foreign ones here: each has one."""
    from rosbags.typesys import Stores, get_typestore

    limits = read_table(TABLE, VOCABULARY).limits
    stores = [get_typestore(store) for store in Stores if store.name.startswith("ROS2")]
    assert set(limits.hashes) == {name for name, _ in limits.of}
    for name, hashes in limits.hashes.items():
        found = {store.hash_rihs01(name) for store in stores if name in store.fielddefs}
        assert hashes == found if "/msg/" in name else len(hashes) == 1, name


BOOLS = next(iter(read_table(TABLE, VOCABULARY).limits.hashes["std_msgs/msg/Bool"]))
OTHER = f"RIHS01_{'1' * 64}"


@pytest.mark.parametrize(
    ("hashes", "elsewhere", "closes"),
    [
        ([""], "", True),
        ([BOOLS], "", True),
        ([BOOLS, BOOLS], BOOLS, True),
        ([OTHER], "", False),  # not the known definition
        ([BOOLS, OTHER], "", False),  # two
        ([""], OTHER, False),  # the same name on another channel
    ],
)
def test_a_type_that_is_defined_otherwise_excludes_nothing(hashes: list[str], elsewhere: str, closes: bool) -> None:  # noqa: FBT001
    """Rule S15."""
    seen = [{"type": "std_msgs/msg/Bool", "writers": ["/cam"], **({"hash": one} if one else {})} for one in hashes]
    other = [{"type": "std_msgs/msg/Bool", "writers": ["/door"], **({"hash": elsewhere} if elsewhere else {})}]
    Path("t.yaml").write_text(json.dumps({"types": 1, "topics": {"/a": seen, "/x": other}}), "utf-8")
    assert bool(told("", types="t.yaml").findings) != closes


def test_every_format_tells_of_the_table_and_none_breaks() -> None:
    """S15: how many flows it closes, and what only it closes, stand in the assumptions of every format that has any."""
    result = told(BOOL, door="")
    for name in FORMATS:
        text = result.to(name)
        if name in ("text", "markdown", "html", "json", "sarif"):
            assert TABLE in str(text), name
    text = str(result.to("text"))
    assert "1 finding is closed only by this: Video: /cam -> /sink" in text
    assert "taken away on the data's side: 1 channel by its message type" in text
    assert "its type cannot carry Video" in "\n".join(why_not_lines(result.why_not("/cam", "/sink", "Video")))


def test_pictures_have_types_where_one_points_at_a_channel() -> None:
    result = told("{types: [std_msgs/msg/String]}")
    for picture in (views.ros_view(result.analysis), views.privacy_view(PathsToLeaks(result.analysis))):
        assert "std_msgs/msg/String" in dot(picture)


@pytest.mark.slow
@pytest.mark.database
def test_the_database_gives_the_same_answer_and_keeps_no_limit_as_a_label(neo4j_server: Connection) -> None:
    """S15: limits follow from the types and the table each time; nobody said them."""
    for a in (BOOL, "{types: [std_msgs/msg/String]}"):
        result = told(a, door="")
        with connection.open_driver(neo4j_server) as driver:
            driver.execute_query("MATCH (n) DETACH DELETE n")
            load_rows(driver, [robot_of("r", result)], result.vocabulary)
            stored = answer_stored(driver, Settings()).document()
            assert stored["assumptions"].pop("database") == {"robots": 1}
            assert stored == result.document()
            open_there = answer_stored(driver, Settings(type_limits=None))
            assert open_there.findings


DEFINED = """types: 1
topics:
  /a:
    - {{type: own_msgs/msg/Level, writers: [/cam], definition: own_msgs/msg/Level.msg, fields: [{fields}]}}
"""
NUMBERS = "std_msgs/msg/Float32, geometry_msgs/msg/PoseArray"


@pytest.mark.parametrize(
    ("fields", "more", "a", "closes"),
    [
        (NUMBERS, "", "", True),
        (NUMBERS, "", "{types: [own_msgs/msg/Level]}", True),  # a person states what was read
        (NUMBERS, "", "{types: [own_msgs/msg/Other]}", False),
        ("", "", "", False),  # a field that can be anything
        (NUMBERS + ", other_msgs/msg/Unknown", "", "", False),
        (NUMBERS + ", std_msgs/msg/String", "", "", False),
        (NUMBERS, "  /x: [{type: own_msgs/msg/Level, hash: RIHS01_ab}]\n", "", False),  # of this definition?
        (NUMBERS, f"  /x: [{{type: std_msgs/msg/Float32, hash: {OTHER}}}]\n", "", False),  # a field is another type
        (NUMBERS, "    - {type: own_msgs/msg/Level, writers: [/cam]}\n", "", False),  # of another checkout
    ],
)
def test_a_type_of_ones_own_is_limited_by_its_definition(fields: str, more: str, a: str, *, closes: bool) -> None:
    """S15: its fields are as several types of the channel, which exclude only what all of them exclude."""
    Path("t.yaml").write_text(DEFINED.format(fields=fields) + more, "utf-8")
    result = told(a, types="t.yaml")
    assert bool(result.findings) != closes
    if closes:
        (why,) = result.why_not("/cam", "/sink", "Video")
        assert [str(place) for stop in why.obstacles for place in stop.places] == ["own_msgs/msg/Level.msg:1"]
        assert told(a, types="t.yaml", type_limits=None).findings


def test_a_definition_is_in_the_document_and_in_a_saved_graph() -> None:
    Path("t.yaml").write_text(DEFINED.format(fields=NUMBERS), "utf-8")
    result = told("", types="t.yaml")
    (entry,) = result.document()["types"][0]["types"]
    assert entry["definition"] == "own_msgs/msg/Level.msg"
    Path("g.json").write_text(as_text(as_dict(result.policies, result.diagnostics, result.types)), "utf-8")
    assert rosprivacy.analyze(labels="l.yaml", add="g.json").document() == result.document()
