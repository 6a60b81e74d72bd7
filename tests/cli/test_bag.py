"""``rosprivacy bag``: what can be in a recording, what is not known of it, and the exit code that CI goes by."""

from __future__ import annotations

import csv
import io
import json
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

from rosprivacy.private_neo4j import connection
from tests.helpers.bags import IMAGE, ODOMETRY, mcap, rosbag2
from tests.helpers.command import Cli, refused
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection

SCHEMA = json.loads((ROOT / "docs" / "bags.schema.json").read_text("utf-8"))
Draft202012Validator.check_schema(SCHEMA)
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
<profile ns="/" node="cam"><topics publish="ALLOW"><topic>camera</topic></topics></profile>
<profile ns="/" node="nav"><topics publish="ALLOW"><topic>odom</topic></topics>
  <topics subscribe="ALLOW"><topic>camera</topic></topics>
  <actions execute="ALLOW"><action>spin</action></actions></profile>
<profile ns="/" node="log"><topics publish="ALLOW"><topic>log/*</topic></topics></profile>
<profile ns="/" node="end"><topics subscribe="ALLOW"><topic>odom</topic><topic>log/a</topic></topics></profile>
</profiles></enclave></enclaves></policy>"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    return rosbag2(tmp_path / "run")


def labels(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "labels.yaml"
    file.write_text(f"labels: 1\n{text}\n")
    return file


def document(cli: Cli, *arguments: str | Path, code: int) -> dict[str, Any]:
    done = cli("bag", *arguments, "--format", "json")
    assert done.returncode == code, done.stderr
    whole: dict[str, Any] = json.loads(done.stdout)
    Draft202012Validator(SCHEMA).validate(whole)
    return whole


def topics(whole: dict[str, Any]) -> dict[str, list[str] | str]:
    (bag,) = whole["bags"]
    return {one["topic"]: one["kinds"] or one.get("unknown", "") for one in bag["topics"]}


OPEN = "no label says what it carries"
ASKED = "no label of the topic itself, and its type suggests "
SEEN = "DepthImage, ThermalImage, Video"


@pytest.mark.parametrize(
    ("said", "code", "camera", "odom"),
    [
        ("", 4, OPEN, OPEN),
        ("channels: {/odom: mundane}", 4, OPEN, ""),
        ("channels: {/odom: mundane, /camera: sensitive}", 4, OPEN, ""),
        ("channels: {/odom: mundane, /camera: {never: [Video]}}", 4, OPEN, ""),
        ("channels: {/odom: mundane, /camera: mundane}", 0, "", ""),
        ("channels: {'*': mundane}", 0, "", ""),
        ("channels: {'*': mundane, /camera: sensitive}", 4, OPEN, ""),
        ("channels: {'*': mundane, /camera: {only: [Video]}}", 1, ["Video"], ""),
        ("channels: {/odom: {only: [Location, Video], never: [Biometric]}}", 1, OPEN, ["Location", "Video"]),
        ("nodes: {/cam: {source: {Video: [/camera]}}}", 1, ["Video"], OPEN),
        ("nodes: {/cam: {source: {Video: ['/cam*']}}}\nchannels: {'*': mundane}", 1, ["Video"], ""),
        ("nodes: {/cam: {source: [Video]}}", 4, OPEN, OPEN),
        ("nodes: {/cam: {source: {Video: [/camra]}}}\nchannels: {/odm: mundane}", 4, OPEN, OPEN),
    ],
)
def test_by_labels_alone(
    cli: Cli, tmp_path: Path, run: Path, said: str, code: int, camera: list[str] | str, odom: list[str] | str
) -> None:
    """S7, S11: what a label names is in it, `mundane` takes it out, and all else is open; a typo closes nothing."""
    assert topics(document(cli, run, "-l", labels(tmp_path, said), code=code)) == {"/camera": camera, "/odom": odom}


@pytest.mark.parametrize(
    ("said", "code", "camera", "odom"),
    [
        ("", 4, "no label names a source whose data goes anywhere", "no label names a source whose data goes anywhere"),
        ("nodes: {/cam: {source: [Video]}}", 1, ["Video"], ["Video"]),
        ("nodes: {/cam: {source: [Video]}, /nav: {sanitizer: {Video: drop}}}", 1, ["Video"], ASKED + "RobotPosition"),
        ("nodes: {/cam: {source: [Video]}}\nchannels: {/odom: mundane}", 1, ["Video"], ""),
        ("nodes: {/nav: {source: [Location]}}", 1, "no label says what /cam sends", ["Location"]),
        ("nodes: {/nav: {source: [Location]}, /cam: conduit}", 1, ASKED + SEEN, ["Location"]),
        ("nodes: {/nav: {source: [Location]}, /cam: conduit}\nchannels: {/camera: mundane}", 1, "", ["Location"]),
        ("nodes: {/nav: {source: {Location: [/odom]}}}\nchannels: {/camera: mundane, /odom: mundane}", 2, "", ""),
        ("nodes: {/log: {source: [Voice]}, /cam: conduit, /nav: conduit}", 4, ASKED + SEEN, ASKED + "RobotPosition"),
        ("nodes: {/log: {source: [Voice]}, /cam: conduit, /nav: conduit}\nchannels: {/camera: mundane, /odom: mundane}",
         0, "", ""),
        ("nodes: {/log: {source: [Voice]}, /cam: conduit, /nav: conduit}\nchannels: {/odom: {only: [Location]}}",
         1, ASKED + SEEN, ["Location"]),
    ],
)  # fmt: skip
def test_by_the_policies_of_the_system(
    cli: Cli, tmp_path: Path, run: Path, said: str, code: int, camera: list[str] | str, odom: list[str] | str
) -> None:
    policy = tmp_path / "a.policy.xml"
    policy.write_text(POLICY)
    if code == 2:
        refused(cli("bag", run, "--policy", policy, "-l", labels(tmp_path, said)))
        return
    whole = document(cli, run, "--policy", policy, "-l", labels(tmp_path, said), code=code)
    assert topics(whole) == {"/camera": camera, "/odom": odom}
    assert whole["assumptions"]["policies"][0]["file"] == str(policy)


def test_a_storage_of_which_nobody_says_what_is_in_it_is_not_known(cli: Cli, tmp_path: Path, run: Path) -> None:
    """S11: it plays back what no flow brings there; that it is taken as a conduit says nothing of its data."""
    policy = tmp_path / "a.policy.xml"
    policy.write_text(POLICY)
    nodes = "nodes: {/log: {source: [Voice]}, /cam: conduit, /nav: conduit}"
    more = "elements: {disk: {kind: storage, country: DE}}\nflows: [{from: disk, to: {topic: /odom}}]"
    assert topics(document(cli, run, "--policy", policy, "-l", labels(tmp_path, f"{nodes}\n{more}"), code=4)) == {
        "/camera": ASKED + SEEN,
        "/odom": "no label says what disk sends",
    }


def test_topics_that_belong_to_services_actions_and_wildcards(cli: Cli, tmp_path: Path) -> None:
    """S3, S4: what is recorded of an action is the action's; a name that only a wildcard covers is what it carries."""
    policy = tmp_path / "a.policy.xml"
    policy.write_text(POLICY)
    names = {"/log/b": (IMAGE, 1), "/new": (IMAGE, 1), "/rosout": (ODOMETRY, 1), "/log/*": (IMAGE, 1)}
    bag = rosbag2(tmp_path / "bag", "sqlite3", {**names, "/spin/_action/feedback": (ODOMETRY, 1)})
    said = labels(tmp_path, "nodes: {/log: {source: [Voice]}, /nav: {source: [Location]}}")
    assert topics(document(cli, bag, "--policy", policy, "-l", said, code=1)) == {
        "/log/*": "the policies do not name it",
        "/log/b": ["Voice"],
        "/new": "the policies do not name it",
        "/rosout": "the policies do not name it",
        "/spin/_action/feedback": ["Location"],
    }


LOG, CLOCK = "rcl_interfaces/msg/Log", "rosgraph_msgs/msg/Clock"


@pytest.mark.parametrize(
    ("said", "code", "kinds"),
    [
        ("", 4, {"/rosout": OPEN, "/clock": ""}),
        ("channels: {/rosout: mundane}", 0, {"/rosout": "", "/clock": ""}),
        ("channels: {'*': sensitive}", 4, {"/rosout": OPEN, "/clock": ""}),
        ("channels: {'*': mundane}", 0, {"/rosout": "", "/clock": ""}),
        ("channels: {/rosout: {only: [PersonName]}}", 1, {"/rosout": ["PersonName"], "/clock": ""}),
    ],
)
def test_a_log_that_is_shared_is_told_by_name(
    cli: Cli, tmp_path: Path, said: str, code: int, kinds: dict[str, list[str] | str]
) -> None:
    """S11, S13: in a shared bag the texts of nodes are open until a person's label speaks of them; a clock is not."""
    names = {"/rosout": (LOG, 1), "/clock": (CLOCK, 1)}
    found = topics(document(cli, rosbag2(tmp_path / "bag", topics=names), "-l", labels(tmp_path, said), code=code))
    assert found == kinds


def test_a_standard_channel_of_a_type_that_nobody_looked_at_is_open(cli: Cli, tmp_path: Path) -> None:
    bag = rosbag2(tmp_path / "bag", topics={"/clock": (CLOCK, 1)})
    table = tmp_path / "table.yaml"
    table.write_text("type_table: 1\n")
    said = topics(document(cli, bag, "--type-limits", table, code=4))
    shipped = "only the program's own labels say that it carries nothing"
    assert said == {"/clock": f"{shipped}, and the table of types does not know its type"}


def test_what_types_suggest_stands_beside_what_labels_say(cli: Cli, tmp_path: Path, run: Path) -> None:
    """S12, S15: a question with its reason and confidence in every format; no kind and no yes follows from it."""
    said = labels(tmp_path, "channels: {/camera: mundane, /odom: {only: [Location]}}")
    whole = document(cli, run, "-l", said, code=1)
    (bag,) = whole["bags"]
    assert bag["kinds"] == ["Location"]
    assert bag["suggested"] == [
        {"kind": "DepthImage", "confidence": "may"},
        {"kind": "RobotPosition", "confidence": "may"},
        {"kind": "ThermalImage", "confidence": "may"},
        {"kind": "Video", "confidence": "likely"},
    ]
    camera = bag["topics"][0]
    assert (camera["kinds"], "unknown" in camera) == ([], False)  # a person's word stands
    assert [(one["kinds"], one["confidence"], one["type"]) for one in camera["suggested"]] == [
        (["Video"], "likely", IMAGE),
        (["DepthImage", "ThermalImage"], "may", IMAGE),
    ]
    assert whole["assumptions"]["suggested_by"]["file"] == "rosprivacy:types"
    text = cli("bag", run, "-l", said).stdout
    assert f"{IMAGE} suggests Video (likely): " in text
    assert "DepthImage (may), RobotPosition (may)," in text
    (row,) = csv.DictReader(io.StringIO(cli("bag", run, "-l", said, "-f", "csv").stdout))
    assert row["suggested"] == "DepthImage (may); RobotPosition (may); ThermalImage (may); Video (likely)"


def test_events_of_services_and_parts_of_actions_suggest_what_these_do(cli: Cli, run: Path) -> None:
    """S3: what is recorded of a service or an action has a type of its own, made from its."""
    metadata = run / "metadata.yaml"
    text = metadata.read_text().replace("/camera", "/map/_service_event").replace("/odom", "/go/_action/feedback")
    text = text.replace(IMAGE, "nav_msgs/srv/GetMap_Event").replace(ODOMETRY, "hri_msgs/msg/IdsList")
    metadata.write_text(text)
    (run / "run.mcap").unlink()
    (bag,) = document(cli, run, code=4)["bags"]
    assert [one["kind"] for one in bag["suggested"]] == ["HomeMap", "PersonIdentifier"]


def test_a_table_of_ones_own_suggests_in_place_of_the_shipped_one(cli: Cli, tmp_path: Path, run: Path) -> None:
    table = tmp_path / "table.yaml"
    rule = "{types: [nav_msgs/msg/Odometry], kinds: [Voice], confidence: certain, why: a test, source: this}"
    table.write_text(f"type_table: 1\nsuggests: [{rule}]\n")
    (bag,) = document(cli, run, "--type-limits", table, code=4)["bags"]
    assert bag["suggested"] == [{"kind": "Voice", "confidence": "certain"}]


def test_nothing_recorded_is_nothing_in_it(cli: Cli, tmp_path: Path) -> None:
    bag = rosbag2(tmp_path / "bag", topics={"/camera": (IMAGE, 0), "/odom": (ODOMETRY, 1)})
    assert topics(document(cli, bag, "-l", labels(tmp_path, "channels: {/odom: mundane}"), code=0))["/camera"] == ""


@pytest.mark.parametrize("harm", ["cut", "attachment", "metadata", "custom"])
def test_what_is_not_known_is_never_a_yes(cli: Cli, tmp_path: Path, harm: str) -> None:
    """S11: all topics are mundane, and still nobody can say it."""
    bag = tmp_path / "a.mcap"
    if harm == "custom":
        bag = rosbag2(tmp_path / "run", custom="x")
    else:
        mcap(bag, attachment="note" if harm == "attachment" else "", metadata="note" if harm == "metadata" else "")
    if harm == "cut":
        bag.write_bytes(bag.read_bytes()[:-300])
    whole = document(cli, bag, "-l", labels(tmp_path, "channels: {'*': mundane}"), code=4)
    (entry,) = whole["bags"]
    assert entry["gaps"] if harm == "cut" else entry["beside"]
    assert whole["verdict"] == "undetermined"


def test_a_folder_as_text_and_as_a_table(cli: Cli, tmp_path: Path) -> None:
    rosbag2(tmp_path / "bags" / "=cmd()")
    rosbag2(tmp_path / "bags" / "b", "sqlite3")
    (tmp_path / "bags" / "c.mcap").write_bytes(b"broken")
    said = labels(tmp_path, "channels: {/camera: mundane, /odom: mundane}")
    done = cli("bag", tmp_path / "bags", "-l", said, "-f", "csv")
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    assert [row["verdict"] for row in rows] == ["nothing-found", "nothing-found", "undetermined"]
    assert rows[2]["not_known"].startswith("not an MCAP file")
    assert (rows[0]["messages"], rows[0]["complete"], rows[2]["complete"]) == ("6", "yes", "no")
    text = cli("bag", tmp_path / "bags", "-l", said)
    assert text.returncode == done.returncode == 4
    assert text.stdout.startswith("undetermined: ")
    assert text.stdout == cli("bag", tmp_path / "bags", "-l", said).stdout  # S14


def test_hostile_names_stay_names(cli: Cli, tmp_path: Path) -> None:
    name = "/a\x1b[2J\n\u202e::error::<b>" + "x" * 3000
    bag = rosbag2(tmp_path / "bag", "sqlite3", {name: (IMAGE, 1), "=1+1": (ODOMETRY, 1)})
    for form in ("text", "json", "csv"):
        done = cli("bag", bag, "-f", form)
        assert done.returncode == 4
        assert all(line.isprintable() for line in done.stdout.splitlines())
        assert "\x1b" not in done.stdout


@pytest.mark.parametrize("named", ["nix", "notes.txt", ""])
def test_what_is_no_bag_is_one_line(cli: Cli, tmp_path: Path, named: str) -> None:
    (tmp_path / "notes.txt").write_text("no bag")
    assert refused(cli("bag", named, cwd=tmp_path))


@pytest.mark.slow  # every day: tests/test_four_ways.py, tests/ingest/neo4j_graph/test_bag_loading.py
@pytest.mark.database
def test_a_storage_that_is_a_bag_comes_back_from_the_database(
    cli: Cli, tmp_path: Path, neo4j_server: Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was recorded, what is known of the bag, and that not all of it is: the verdict stays undetermined (S11)."""
    with connection.open_driver(neo4j_server) as driver:  # the one that commands use
        driver.execute_query("MATCH (n) DETACH DELETE n")
    rosbag2(tmp_path / "run", topics={"/camera": (IMAGE, 2), "/other": (ODOMETRY, 1)})
    (tmp_path / "a.policy.xml").write_text(POLICY)
    said = labels(
        tmp_path,
        "nodes: {/cam: {source: {Video: [/camera]}, leak: [Voice]}, /nav: conduit, /log: conduit, /end: conduit}\n"
        "channels: {/camera: sensitive, /odom: sensitive}\nlimits: {Video: P30D}\n"
        "elements: {run1: {kind: storage, bag: run, country: DE, retention: P20D, conduit: [Video]}}",
    )
    system = (tmp_path / "a.policy.xml", "-l", said)
    files = json.loads(cli("analyze", *system, "-f", "json").stdout)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    try:
        assert cli("load", *system, "--robot", "bagged").returncode == 0
        done = cli("analyze", "--from-database", "-f", "json")
        stored = json.loads(done.stdout)
    finally:
        cli("unload", "--robot", "bagged")
    assert (files["verdict"], stored["verdict"], done.returncode) == ("leak", "leak", 1)
    assert [one["because"] for one in stored["findings"]] == [one["because"] for one in files["findings"]]
    assert stored["findings"][0]["because"]["values"] == {"since": "2023-11-14", "kept": "P20D", "ended": "2023-12-04"}
    (row,) = [one for one in stored["outside"] if one["element"]["name"] == "run1"]
    assert row["holds"] == ["Video"]
    assert row["recording"] == {
        "bag": "run", "bytes": (tmp_path / "run" / "run.mcap").stat().st_size, "topics": 2, "messages": 3,
        "start": "2023-11-14T22:13:20Z", "end": "2023-11-14T22:13:22Z",
        "oldest": "2023-11-14T22:13:20Z",
    }  # fmt: skip
    assert row == next(one for one in files["outside"] if one["element"]["name"] == "run1") | {
        "element": row["element"]
    }
    known = ("bag-gap", "recording")
    told = [
        sorted(one["message"] for one in read["diagnostics"] if one.get("code") in known) for read in (files, stored)
    ]
    assert told[0] == told[1]
    assert len(told[0]) == len(known)
