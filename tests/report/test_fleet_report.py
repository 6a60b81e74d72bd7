"""Fleets in reports, pictures and other tools' formats: one robot for all that are alike, and numbers of the fleet."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
import rdflib

from rosprivacy.analysis.fleet.likeness import Likeness
from rosprivacy.documents import document_of
from rosprivacy.formats import written
from rosprivacy.report.document.contents import PATHS
from rosprivacy.report.page.figures import figures
from rosprivacy.report.page.html import html
from rosprivacy.report.page.markdown import markdown
from rosprivacy.report.page.outline import Outline, outline
from rosprivacy.report.pictures.dot import dot
from rosprivacy.report.pictures.narrow import label, represented
from rosprivacy.report.pictures.picture import PRIVACY, Box, Picture, PictureLine
from rosprivacy.report.redact import redacted
from rosprivacy.report.robots import note
from tests.helpers.answers import as_json
from tests.helpers.graphs import hospital
from tests.helpers.linked_data import problems
from tests.helpers.paths import ROOT
from tests.helpers.pictures import fleet_privacy

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.result import Result
    from tests.helpers.command import Cli

FLEET = str(ROOT / "examples" / "fleet" / "fleet.yaml")


@cache
def found() -> Result:
    return hospital()


@cache
def document() -> dict[str, Any]:
    return found().document()


def likeness() -> Likeness:
    view = found().fleet
    assert view
    return view.likeness


def told(language: str = "en") -> Outline:
    return outline(document(), language)


def named(value: Any) -> set[str]:
    """All robots that elements of a document are at."""
    if isinstance(value, list):
        return set().union(*map(named, value)) if value else set()
    if isinstance(value, dict):
        own = {value["robot"]} if {"robot", "kind", "name"} <= set(value) else set()
        return own.union(*map(named, value.values())) if value else own
    return set()


def test_robots_that_stand_beside_others_are_in_no_row_of_the_document() -> None:
    """Otherwise the second carrier's camera would be listed as one that no data gets to."""
    assert named(document()) == {"carrier_01", "carrier_lent", "cleaner_1", "guide_01", "base", "hospital"}
    unreached = {(e["robot"], e["name"]) for e in document()["unreached"]}
    carried = {(row["element"]["robot"], row["element"]["name"]) for row in document()["carries"]}
    assert not unreached & carried
    assert ("carrier_01", "/camera_driver") in carried


def test_each_way_says_on_how_many_robots_it_is_and_lists_them() -> None:
    patterns = {pattern["finding"]: pattern for pattern in document()["fleet"]["patterns"]}
    for entry in told().entries:
        assert list(entry.robots) == patterns[entry.id]["robots"]
        assert entry.spread[0] == f"On {len(entry.robots)} of 40 robots."
        across = "From one robot to another; 468 such paths in the fleet."
        assert (across in entry.spread) == patterns[entry.id]["across"]
    (video,) = (entry for entry in told().entries if entry.leak == "base:reviewer")
    assert video.spread == ("On 24 of 40 robots.", "1 robot (carrier_lent): unfiltered.", "23 robots: pseudonymised.")
    assert video.where == (
        ("1 robot, unfiltered", ("carrier_lent",)),
        ("23 robots, pseudonymised", ("carrier_01 (23 robots)",)),  # they are named once, in the table of the fleet
    )
    assert len(told().entries) == len(document()["findings"]) == 6  # patterns, not put together a second time


def test_names_count_the_robots_of_the_fleet_not_those_that_are_shown() -> None:
    report = told()
    origins = {kind.name: [name for name, _ in kind.origins] for kind in report.kinds}
    assert origins["Location"] == ["/navigator (40 robots)"]
    assert origins["Video"] == ["/camera_driver (24 robots)", "/camera (12 robots)"]
    items = {(item.name, item.data): item.robots for item in report.inventory.items if item.kind == "node"}
    assert items["/uplink", "location"] == 40
    assert items["/camera_driver", "video of persons"] == 24
    (scale,) = (criterion.shows for criterion in report.criteria if criterion.name == "Large scale")
    assert scale.startswith("40 robots analysed")
    assert (40, "robots in the fleet") in report.summary.numbers


@pytest.mark.parametrize("language", ["en", "de"])
def test_deviants_stand_by_themselves_with_links_to_the_ways(language: str) -> None:
    fleet = told(language).fleet
    assert fleet
    (deviant,) = fleet.deviants
    assert (deviant.robots, deviant.model) == (("carrier_lent",), "carrier")
    assert [(d.extra, d.ends) for d in deviant.differences] == [
        (True, ("/camera_driver", "base:reviewer")),
        (True, ("/camera_driver", "hospital:footage bucket")),
        (False, ("/camera_driver", "base:reviewer")),
        (False, ("/camera_driver", "hospital:footage bucket")),
    ]
    assert [(row.shown, len(row.robots)) for row in fleet.alike] == [
        ("carrier_01", 23), ("carrier_lent", 1), ("cleaner_1", 4), ("guide_01", 12),
    ]  # fmt: skip
    page = html(told(language), figures(document_of(found(), (PATHS,)), told(language)))
    text = markdown(told(language))
    for shown in (page, text):
        assert "carrier_lent" in shown.replace("\\", "")
        assert all(robot in shown.replace("\\", "") for row in fleet.alike for robot in row.robots)
    assert page.count("<figure") == 6 + 1  # and one of all that is to be decided


def test_a_redacted_report_of_a_fleet_names_no_robot_and_no_model() -> None:
    (copy,) = redacted([document()])
    text = json.dumps({key: value for key, value in copy.items() if key != "categories"})  # these are the ontology's
    for name in ("carrier", "guide", "cleaner", "hospital", "reviewer", "fleet.yaml"):
        assert name not in text, name
    before, after = document()["fleet"], copy["fleet"]
    assert [len(group["robots"]) for group in after["alike"]] == [len(group["robots"]) for group in before["alike"]]
    assert sorted(after["models"].values()) == sorted(before["models"].values())
    assert len(outline(copy, "en").entries) == 6
    assert outline(copy, "en").fleet


# ---------------------------------------------------------------- pictures


def test_one_robot_is_drawn_for_all_that_are_alike_and_says_for_how_many() -> None:
    picture = fleet_privacy()
    assert {box.robot for box in picture.boxes} == {
        "carrier_01 and 22 alike", "carrier_lent", "cleaner_1 and 3 alike", "guide_01 and 11 alike", "base", "hospital",
    }  # fmt: skip
    assert "A fleet of 40 robots; 3 robots drawn for all that are alike" in picture.notes
    assert len({box.key for box in picture.boxes}) == len(picture.boxes)
    assert len({(line.source, line.target, line.look) for line in picture.lines}) == len(picture.lines)
    looks = {(line.source, line.target): line.look for line in picture.lines}
    assert len(looks) == len(picture.lines)  # one line where before there was that of a way and that of the shortest


def test_what_is_counted_as_not_drawn_is_that_of_the_robots_that_are_drawn() -> None:
    drawn = {(box.key[1], name) for box in fleet_privacy().boxes for name in box.names}
    (note,) = (note for note in fleet_privacy().notes if note.startswith("Not drawn"))
    names = {e.identity for e in found().analysis.graph.elements if e.robot not in likeness().second}
    assert note == f"Not drawn: {len(names) - len(fleet_privacy().boxes)} elements that carry none of it"
    assert ("node", "/camera_driver") in drawn


def test_a_way_from_one_robot_to_another_like_it_is_drawn_from_it_to_itself() -> None:
    keys = [(robot, "node", name) for robot, name in (("carrier_01", "/a"), ("carrier_02", "/b"), ("carrier_01", "/b"))]
    boxes = tuple(Box(key, (key[2],), look) for key, look in zip(keys, ("source", "leak", "reviewed"), strict=True))
    lines = (PictureLine(keys[0], keys[1], "shortest", length=1), PictureLine(keys[0], keys[2], "data"))
    picture = represented(Picture(PRIVACY, "", boxes, lines), likeness())
    assert [(box.key[2], box.look) for box in picture.boxes] == [("/a", "source"), ("/b", "leak")]
    assert [(line.source[2], line.target[2], line.look) for line in picture.lines] == [("/a", "/b", "shortest")]


def test_no_line_of_a_label_is_empty() -> None:
    """For such a line Graphviz 14 frees what it has not set, and ends in one of three runs."""
    text = dot(fleet_privacy())
    labels = [label.split("\\n") for label in re.findall(r'(?<!graph \[)label="((?:[^"\\]|\\.)*)"', text)]
    assert any(lines[0] == " " for lines in labels)  # under the lid of a storage that is a place to assess
    assert all(line for lines in labels for line in lines)


def test_any_robot_of_the_fleet_can_be_asked_for() -> None:
    assert label("carrier_17", likeness()) == label("carrier_01", likeness()) == "carrier_01 and 22 alike"
    assert label("carrier_lent", likeness()) == "carrier_lent"
    assert label("base", likeness()) == "base"


def test_enclaves_of_a_robot_are_its_own(cli: Cli) -> None:
    done = cli("graph", "--fleet", FLEET, "--cluster", "enclave", "--format", "dot")
    groups = set(re.findall(r'label="(robot [^"]*)"', done.stdout))
    assert "robot carrier_01 and 22 alike, enclave /carrier/driving" in groups
    assert not [group for group in groups if " and /" in group]


# ---------------------------------------------------------------- the command line


def test_the_command_line_reports_on_a_fleet(cli: Cli, tmp_path: Path) -> None:
    page = tmp_path / "report.html"
    done = cli("report", "--fleet", FLEET, "--output", str(page))
    assert (done.returncode, done.stderr) == (0, "")
    assert "On 24 of 40 robots." in page.read_text("utf-8")
    for command in (["report"], ["graph"]):
        refused = cli(*command, "--fleet", FLEET, str(ROOT / "examples" / "fleet" / "base.policy.xml"))
        assert refused.returncode == 2
        assert "--fleet takes what the fleet file names" in " ".join(refused.stderr.split())


def test_a_decision_about_one_robot_says_so(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "decisions.yaml"
    file.write_text(
        "decisions: 1\nfindings:\n  - {robot: carrier_07, leak: fleet cloud, kind: disclosure, decision: accept,"
        " reason: the contract is on its way, owner: me, legal_basis: [6(1)(b)]}\n",
        "utf-8",
    )
    text = cli("report", "--fleet", FLEET, "--decisions", str(file), "--format", "markdown").stdout
    assert "39 robots: not accepted. 1 robot (carrier\\_07): accepted by a decision." in text
    assert "data begins there, accepted by a decision, not pseudonymised" in text


# ---------------------------------------------------------------- other people's tools


def test_sarif_tells_on_how_many_robots_each_finding_is() -> None:
    (run,) = as_json(found(), "sarif")["runs"]
    said = {result["partialFingerprints"]["rosprivacyFinding/v1"]: result for result in run["results"]}
    assert len(said) == 6
    view = found().fleet
    assert view
    for pattern in view.patterns:
        result = said[pattern.finding.id]
        assert f"On {len(pattern.robots)} of 40 robots" in result["message"]["text"]
        assert result["properties"]["robots"] == list(pattern.robots)
        assert result["properties"]["findings"] == pattern.count
    assert run["properties"]["standardChannels"] == document()["standard_channels"]
    assert run["properties"]["robots"] == 40
    notices = [row["message"]["text"] for row in run["invocations"][0]["toolExecutionNotifications"]]
    assert any("carrier_01 for 23, cleaner_1 for 4, guide_01 for 12" in text for text in notices)
    targets = {row["location"].get("uri") for row in run["artifacts"]}
    assert "examples/fleet/fleet.yaml" in targets


def test_the_file_of_the_pia_tool_names_one_of_those_that_are_alike_and_says_so() -> None:
    made = as_json(found(), "cnil-pia")
    text = json.dumps(made)
    assert not [robot for robot in ("carrier_02", "cleaner_2", "guide_02") if robot in text]
    for answer in made["answers"]:
        assert answer["data"]["list"] or "carrier_01 for 23" in answer["data"]["text"]
    assert "25 profiles in 10 enclaves" in text


@pytest.mark.slow
def test_linked_data_names_the_robots_of_each_finding_and_fits_its_shapes() -> None:
    graph = rdflib.Graph().parse(data=written(found(), "turtle"), format="turtle")
    rp = rdflib.Namespace("https://w3id.org/rosprivacy#")
    view = found().fleet
    assert view
    for pattern in view.patterns:
        (iri,) = graph.subjects(rp.id, rdflib.Literal(pattern.finding.id))
        assert sorted(map(str, graph.objects(iri, rp.onRobot))) == list(pattern.robots)
        assert [int(str(n)) for n in graph.objects(iri, rp.findings)] == [pattern.count]
    assert problems(graph) == ""


@pytest.mark.parametrize("form", ["html", "markdown", "article30"])
def test_a_report_to_be_shown_to_others_names_no_robot(cli: Cli, form: str) -> None:
    done = cli("report", "--fleet", FLEET, "--format", form, "--redact")
    assert (done.returncode, done.stderr) == (0, "")
    assert not [robot for robot in ("carrier_", "cleaner_", "guide_") if robot in done.stdout]


def test_a_fleet_of_one_robot_each_says_nothing_of_others_like_it() -> None:
    result = found()
    assert result.fleet
    alone = replace(result.fleet, likeness=Likeness({"carrier_lent": ("carrier_lent",)}, {}, {"carrier_lent": "m"}))
    assert note(alone) == "A fleet of 1 robot"
