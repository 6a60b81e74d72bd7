"""``only: by-type``: a channel carries only what its message type is made for (rules S7, S11, S15), case by case."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml

import rosprivacy
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.parts import distributed
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import robot_of
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.fleet_files import policy
from tests.helpers.label_files import validator

if TYPE_CHECKING:
    from neo4j import Driver

    from rosprivacy.result import Result
    from tests.helpers.command import Cli

WAY = "/camera>/image", "/planner>/cmd</image", "/relay>/out</cmd", "/uplink</out"
LABELS = """\
labels: 1
nodes:
  /camera: {source: [Video]}
  /planner: conduit
  /relay: conduit
  /uplink: {leak: [Video]}
channels:
  /image: sensitive
  /out: sensitive
  /cmd: {only: by-type}
"""
TWIST, IMAGE = "geometry_msgs/msg/Twist", "sensor_msgs/msg/Image"
PINNED = (
    LABELS + f"pins:\n  by-type:\n    topics:\n      /cmd:\n        types: [{TWIST}]\n        writers: [/planner]\n"
)


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def seen(type_name: str = TWIST, writers: str = "/planner", hashed: str = "") -> None:
    of = f", hash: {hashed}" if hashed else ""
    text = f"types: 1\ntopics: {{/cmd: [{{type: {type_name}, writers: [{writers}]{of}}}]}}\n"
    Path("t.yaml").write_text(text, "utf-8")


def answer(labels: str = LABELS, profiles: tuple[str, ...] = WAY, **more: Any) -> Result:
    Path("p.xml").write_text(policy(*profiles), "utf-8")
    Path("l.yaml").write_text(labels, "utf-8")
    if not Path("t.yaml").exists():
        seen()
    return rosprivacy.analyze("p.xml", "l.yaml", **{"types": "t.yaml", "type_limits": None, **more})


def doubts(result: Result) -> list[tuple[str, str]]:
    return [(one.name, one.element.name if one.element else one.message) for one in result.doubts]


def questions(result: Result) -> list[str]:
    return [question.element.name for question in result.analysis.open]


def test_what_the_type_is_not_made_for_ends_there_and_rides_in_the_sentence() -> None:
    result = answer(PINNED)
    assert (str(result.analysis.verdict), doubts(result)) == ("no-leak-found", [("by-type-closes", "/cmd")])
    assert "only the line 'only: by-type' of /cmd closes a way on" in result.document()["sentence"]
    assert not questions(result)  # a person has looked at the channel
    (doubt,) = result.doubts
    assert (str(doubt.rank), str(doubt.place), doubt.categories) == ("rides", "l.yaml:10", ("Video",))


def test_limits_of_types_neither_hide_the_doubt_nor_need_it() -> None:
    assert ("by-type-closes", "/cmd") in doubts(answer(PINNED, type_limits="rosprivacy:types"))


def test_what_the_type_is_made_for_goes_on_and_is_reviewed() -> None:
    seen("sensor_msgs/msg/LaserScan")
    labels = LABELS.replace("[Video]}\n  /planner", "[LaserScan]}\n  /planner").replace("{leak: [Video]}", "conduit")
    result = answer(labels)
    assert not questions(result)
    assert "by-type-closes" not in dict(doubts(result))
    assert "LaserScan" in next(c.categories for c in result.analysis.carried if c.element.name == "/out")


def test_a_text_can_hold_all_so_nothing_ends_there() -> None:
    seen("std_msgs/msg/String")
    assert answer().findings


def test_several_types_let_pass_what_any_of_them_is_made_for() -> None:
    text = f"types: 1\ntopics: {{/cmd: [{{type: {TWIST}, writers: [/planner]}}, {{type: {IMAGE}}}]}}\n"
    Path("t.yaml").write_text(text, "utf-8")
    assert answer().findings


@pytest.mark.parametrize(
    ("type_name", "writers", "profiles", "message"),
    [
        (TWIST, "", WAY, "the type of what /planner writes to /cmd is not known; observe it, or write only: [Kinds]"),
        (TWIST, "/planner", (*WAY, "/new>/cmd"), "the type of what /new writes to /cmd is not known; observe it, or"),
        (TWIST, "/planner", (*WAY, "/new>/c*"), "the type of what /c* writes to /cmd is not known; observe it, or"),
        ("own_msgs/msg/Drive", "/planner", WAY, "the table of types does not say what own_msgs/msg/Drive of /cmd is"),
    ],
)
def test_where_the_type_is_not_certain_the_channel_is_open_and_it_is_said(
    type_name: str, writers: str, profiles: tuple[str, ...], message: str
) -> None:
    seen(type_name, writers)
    result = answer(profiles=profiles)
    assert result.findings
    assert "/cmd" in questions(result)
    ((_, said),) = [one for one in doubts(result) if one[0] == "by-type-open"]
    assert said.startswith(message)


def test_without_any_type_the_line_says_what_to_do() -> None:
    result = answer(types=())
    (said,) = [one for one in result.diagnostics if one.code == "by-type-open"]
    assert str(said.place) == "l.yaml:10"
    assert said.message == "/cmd has no known type; observe it, or write only: [Kinds]"
    assert questions(result) == ["/cmd"]


def test_a_definition_that_the_table_does_not_know_lets_all_pass() -> None:
    seen(hashed=f"RIHS01_{'1' * 64}")
    result = answer()
    assert result.findings
    assert "is not the definition that the table of types speaks of" in dict(doubts(result))["by-type-open"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("/cmd: {only: by-type}", "/cmd: {only: by-type, sensitive: [Video]}"),
        ("/planner: conduit", "/planner: {conduit: [Video]}"),
        ("/relay: conduit", "/relay: {conduit: [Video]}"),
        ("/relay: conduit", "/relay: {leak: [Video]}"),
        ("/relay: conduit", "/relay: {leak: [PersonImage]}"),  # it may be of the kind
        ("/planner: conduit", "/planner: {source: [Video], conduit: [Voice]}"),
        ("/planner: conduit", "/planner: {source: {Video: [/cmd]}}"),
        ("/planner: conduit", "/planner: {derives: [{from: Voice, to: Video}]}"),
        ("/cmd: {only: by-type}", '/cmd: {only: by-type}\n  "/c*": {only: [Video]}'),
        ("/cmd: {only: by-type}", '/cmd: {only: by-type}\n  "*": sensitive'),
        ("pins:", "flows: [{from: /planner, to: /cmd, only: [Video]}]\npins:"),
    ],
)
def test_what_a_person_says_of_kinds_wins(old: str, new: str) -> None:
    """At the channel, at a flow there, at a node that writes or reads it; by a glob too."""
    assert old in PINNED
    result = answer(PINNED.replace(old, new))
    assert [finding for finding in result.findings if finding.category == "Video"]
    assert "by-type-closes" not in dict(doubts(result))


def test_it_takes_nothing_from_what_others_close() -> None:
    result = answer(PINNED.replace("/cmd: {only: by-type}", "/cmd: {only: by-type, never: [Video]}"))
    assert not result.findings
    assert doubts(result) == []  # a person closes the way


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda: seen(IMAGE), f"now type {IMAGE} and no more type {TWIST}"),
        (lambda: seen("geometry_msgs/msg/Pose"), f"now type geometry_msgs/msg/Pose and no more type {TWIST}"),
        (lambda: seen(hashed="RIHS01_1"), f"now hash {TWIST} RIHS01_1"),
    ],
)
def test_it_lapses_with_another_type_or_hash(change: Any, message: str) -> None:
    change()
    result = answer(PINNED)
    assert dict(doubts(result))["by-type-lapsed"].startswith(f"/cmd is open again: {message}; look at it")
    assert questions(result) == ["/cmd"]


@pytest.mark.parametrize(
    ("profiles", "message"),
    [
        ((*WAY, "/new>/cmd"), "now writer /new"),
        (("/camera>/image", "/planner</image", "/other>/cmd</image", *WAY[2:]), "no more writer /planner"),
    ],
)
def test_it_lapses_with_other_writers(profiles: tuple[str, ...], message: str) -> None:
    seen(writers="/planner, /new, /other")
    labels = PINNED.replace("/planner: conduit", '"/[pno]*": conduit')
    result = answer(labels, profiles)
    assert message in dict(doubts(result))["by-type-lapsed"]
    assert "/cmd" in questions(result)


def test_of_what_a_file_with_pins_does_not_pin_nobody_has_looked() -> None:
    result = answer(LABELS + "pins: {by-type: {}}\n")
    assert "nobody has looked at /cmd" in dict(doubts(result))["by-type-lapsed"]
    assert questions(result) == ["/cmd"]
    assert dict(doubts(answer()))["by-type-unpinned"].startswith("nobody has kept with which type and writers /cmd")


def test_pins_of_lines_say_nothing_of_globs_and_the_other_way_round() -> None:
    labels = PINNED.replace("/relay: conduit", '"/rel*": conduit')
    assert not questions(answer(labels))
    assert questions(answer(labels.replace("pins:\n", "pins:\n  nodes: {}\n"))) == []  # nothing gets past /cmd
    assert "by-globs" not in dict(doubts(answer(labels.replace("pins:\n", "pins:\n  nodes: {}\n"))))


def test_the_command_keeps_types_and_writers_and_the_next_one_what_is_new(cli: Cli) -> None:
    seen(hashed="RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a")
    answer()
    words = ("labels", "--pin", "p.xml", "-l", "l.yaml", "--types", "t.yaml")
    assert cli(*words).returncode == 0
    pins = yaml.safe_load(Path("l.yaml").read_text("utf-8"))["pins"]
    hashed = f"{TWIST} RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a"
    taken = {"types": [TWIST], "hashes": [hashed], "writers": ["/planner"]}
    assert pins == {"by-type": {"topics": {"/cmd": taken}}}
    assert validator().is_valid(yaml.safe_load(Path("l.yaml").read_text("utf-8")))
    again = rosprivacy.analyze("p.xml", "l.yaml", types="t.yaml", type_limits=None)
    assert doubts(again) == [("by-type-closes", "/cmd")]
    assert cli(*words).stderr == "l.yaml: 0 lines changed\n"
    seen(IMAGE)
    assert cli("analyze", "p.xml", "-l", "l.yaml", "--types", "t.yaml").returncode == 1
    assert cli(*words).returncode == 0
    assert yaml.safe_load(Path("l.yaml").read_text("utf-8"))["pins"]["by-type"]["topics"]["/cmd"]["types"] == [IMAGE]


def test_a_pin_of_a_channel_without_a_line_is_a_notice() -> None:
    result = answer(PINNED.replace("/cmd: {only: by-type}", "/cmd: sensitive"))
    (said,) = [one for one in result.diagnostics if one.code == "pin-of-nothing"]
    assert "a line only: by-type of this file speaks of" in said.message


def test_a_service_is_pinned_and_judged_by_its_legs(cli: Cli) -> None:
    """The request of SetBool is one bit; its response is a text, which nobody says to be made for anything."""
    call = '<services {}="ALLOW"><service>/call</service></services>'
    text = policy("/camera", "/uplink")
    text = text.replace('node="camera">', 'node="camera">' + call.format("request"))
    text = text.replace('node="uplink">', 'node="uplink">' + call.format("reply"))
    Path("s.xml").write_text(text, "utf-8")
    stated = "{only: by-type, types: [std_srvs/srv/Empty]}"
    labels = f"labels: 1\nnodes: {{/camera: {{source: [Voice]}}, /uplink: conduit}}\nservices: {{/call: {stated}}}\n"
    Path("l.yaml").write_text(labels, "utf-8")
    assert cli("labels", "--pin", "s.xml", "-l", "l.yaml").returncode == 0
    pins = yaml.safe_load(Path("l.yaml").read_text("utf-8"))["pins"]["by-type"]
    taken = {"types": ["std_srvs/srv/Empty"], "clients": ["/camera"], "servers": ["/uplink"]}
    assert pins == {"services": {"/call": taken}}
    assert not [one for one in rosprivacy.analyze("s.xml", "l.yaml").doubts if one.name != "by-type-closes"]
    Path("s.xml").write_text(text.replace('node="uplink">', 'node="uplink">' + call.format("request")), "utf-8")
    lapsed = dict(doubts(rosprivacy.analyze("s.xml", "l.yaml")))["by-type-lapsed"]
    assert "/call is open again: now client /uplink" in lapsed


@pytest.mark.parametrize(
    ("labels", "message"),
    [
        ('channels:\n  "/c*": {only: by-type}\n', "l.yaml:3: only: by-type of a glob; write it of one channel by its"),
        ("flows:\n  - {from: /a, to: /b, only: by-type}\n", "l.yaml:3: only: by-type of a flow; write it of one"),
        ("channels:\n  /cmd: {never: by-type}\n", "l.yaml:3: never takes a list, not a text"),
    ],
)
def test_where_it_has_no_meaning_it_is_refused(labels: str, message: str) -> None:
    with pytest.raises(rosprivacy.InputErrors) as refused:
        answer(f"labels: 1\n{labels}")
    assert str(refused.value).splitlines()[0].startswith(message)


def test_bad_pins_are_refused_with_their_lines() -> None:
    with pytest.raises(rosprivacy.InputErrors) as refused:
        answer(
            LABELS + "pins:\n  by-type:\n    topics:\n      /c*: {types: [a]}\n      /d: [a]\n      /e: {typ: [a]}\n"
        )
    assert [line.split("; ")[0] for line in str(refused.value).splitlines()] == [
        "l.yaml:14: '/c*' where an element is pinned",
        "l.yaml:15: the pin of /d is a map, not a list",
        "l.yaml:16: unknown key 'typ'",
    ]


def test_the_enforced_view_keeps_it_where_the_type_of_all_in_the_enclave_is_known() -> None:
    """Each node may write there what any profile of the enclave may (S6); the pin is of who writes by its own grant."""
    stated = PINNED.replace("{only: by-type}", f"{{only: by-type, types: [{TWIST}]}}")
    result = answer(stated, types=(), view="enforced")
    assert "by-type-lapsed" not in dict(doubts(result))
    assert "by-type-open" not in dict(doubts(result))
    assert "/cmd" not in questions(result)
    unseen = answer(PINNED, view="enforced")
    assert "by-type-open" in dict(doubts(unseen))


FLEET = """fleet: 1
robots:
  r1: {{policies: p.xml, labels: l.yaml, types: t.yaml{domain}}}
  r2: {{policies: q.xml{domain}}}
"""


def test_in_a_fleet_it_holds_on_the_robot_and_not_where_others_write_too() -> None:
    answer(PINNED)
    Path("q.xml").write_text(policy("/other>/cmd"), "utf-8")
    Path("f.yaml").write_text(FLEET.format(domain=""), "utf-8")
    result = rosprivacy.analyze_fleet("f.yaml", type_limits=None)
    assert (not result.findings, "by-type-closes" in dict(doubts(result))) == (True, True)
    Path("f.yaml").write_text(FLEET.format(domain=", domain: d"), "utf-8")
    result = rosprivacy.analyze_fleet("f.yaml", type_limits=None)
    assert result.findings
    assert {"by-type-lapsed", "by-type-open"} & {name for name, _ in doubts(result)}


def test_in_parts_it_closes_nothing_in_a_large_fleet_and_says_so(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    answer(PINNED)
    Path("q.xml").write_text(policy("/other>/cmd"), "utf-8")
    Path("f.yaml").write_text(FLEET.format(domain=""), "utf-8")
    in_parts = ["analyze", "--fleet", "f.yaml", "--engine", "parts", "-f", "json"]
    memory, parts = (json.loads(cli(*words).stdout) for words in (in_parts[:3] + in_parts[5:], in_parts))
    assert parts["assumptions"].pop("engine") == "parts"
    assert parts == memory
    monkeypatch.setattr(distributed, "MOST_WHOLE", 0)
    document = json.loads(cli(*in_parts).stdout)
    assert document["verdict"] == "leak"
    assert "/cmd: only: by-type does not hold in parts" in str(document["diagnostics"])


def test_a_fleet_makes_no_pin_of_it_and_keeps_those_that_are_there(cli: Cli) -> None:
    answer(LABELS)
    Path("q.xml").write_text(policy("/other>/cmd"), "utf-8")
    Path("f.yaml").write_text(FLEET.format(domain=""), "utf-8")
    done = cli("labels", "--pin", "--fleet", "f.yaml")
    assert done.returncode == 2
    assert "l.yaml:10: only: by-type of /cmd, which a fleet does not pin; name the policies of one robot" in done.stderr
    Path("l.yaml").write_text(PINNED, "utf-8")
    assert cli("labels", "--pin", "--fleet", "f.yaml").returncode == 0
    assert Path("l.yaml").read_text("utf-8") == PINNED


@pytest.mark.database
def test_a_database_keeps_the_line_with_its_pin_and_judges_it_anew(driver: Driver) -> None:
    result = answer(PINNED, type_limits="rosprivacy:types")
    load(driver, [robot_of("r", result)], load_vocabulary())
    stored = answer_stored(driver, Settings())
    document = stored.document()
    assert document["assumptions"].pop("database") == {"robots": 1}
    assert document == result.document()
    assert ("by-type-closes", "/cmd") in doubts(stored)
    driver.execute_query("MATCH (n {name: '/cmd'}) SET n.types = [$type], n.type_facts = null", type=IMAGE)
    changed = answer_stored(driver, Settings())
    assert "by-type-lapsed" in dict(doubts(changed))
    assert changed.findings


def test_what_a_line_and_a_shipped_file_close_one_after_the_other_is_told() -> None:
    """Neither alone closes the way: both are opened together."""
    profiles = "/camera>/image", "/planner>/cmd</image", "/relay>/tf_static</cmd", "/uplink</tf_static"
    Path("infra.yaml").write_text(PINNED.replace("  /out: sensitive\n", ""), "utf-8")
    answer(PINNED.replace("  /out: sensitive\n", ""), profiles)
    files = ["l.yaml", "rosprivacy:infrastructure"]
    result = rosprivacy.analyze("p.xml", files, types="t.yaml", type_limits=None)
    assert ("by-type-closes", "/cmd") in doubts(result)
    Path("p.xml").write_text(
        policy("/camera>/tf_static", "/planner>/cmd</tf_static", "/relay>/out</cmd", "/uplink</out"), "utf-8"
    )
    Path("l.yaml").write_text(PINNED.replace("  /image: sensitive\n", ""), "utf-8")
    assert ("by-type-closes", "/cmd") in doubts(rosprivacy.analyze("p.xml", files, types="t.yaml", type_limits=None))
