"""Fleets in Neo4j: all robots are written, also those for which another one stood, and analysed there alike."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.answering import answer
from rosprivacy.ingest.neo4j_graph.fleet_rows import FleetRows
from rosprivacy.ingest.neo4j_graph.loading import load, unload
from rosprivacy.ingest.neo4j_graph.read_back import read_stored
from rosprivacy.ingest.neo4j_graph.write_back import write_back
from rosprivacy.question import question_of
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet
from rosprivacy.systems.stored_system import answer_stored
from tests.helpers.fleet_rows import VOCABULARY, rows
from tests.helpers.graphs import dump
from tests.helpers.paths import ROOT
from tests.helpers.random_fleets import Case, fleets, found_in
from tests.helpers.random_rows import VOCABULARY as SMALL

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

FLEET = str((ROOT / "examples") / "fleet" / "fleet.yaml")


def test_each_robot_has_its_rows() -> None:
    """40 robots, the base station, and the fleet for what is shared."""
    found = {one.robot: one for one in rows(FLEET)}
    assert len(found) == 42
    assert {name for name, one in found.items() if one.properties.get("shared")} == {"base", "hospital"}
    assert found["carrier_07"].properties["model"] == "carrier"
    same = [_renamed(found[f"carrier_{n:02}"]) for n in (1, 2, 23)]
    assert same[0] == same[1] == same[2]
    assert {row["properties"]["name"] for row in found["carrier_07"].foreign} == {
        "footage bucket", "fleet cloud", "/archive", "/episodes", "/review", "reviewer",
        "/commander", "/goal", "/screen_driver", "screen",
    }  # fmt: skip
    assert all(one.properties["verdict"] == "leak" for name, one in found.items())


def _renamed(one: RobotRows) -> Any:
    text = json.dumps([one.elements, one.flows, one.roles, one.memberships, one.enclaves])
    return text.replace(one.robot, "ROBOT")


@pytest.mark.slow
@pytest.mark.database
def test_the_answer_from_the_database_is_that_of_the_file(driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples")
    done = load(driver, rows("fleet/fleet.yaml"), VOCABULARY)
    assert (done.written, done.unchanged) == (42, 0)
    before = dump(driver, without=("digest", "version"))
    expected = rosprivacy.analyze_fleet("fleet/fleet.yaml", hangs_on=True).document()
    document = answer_stored(driver, Settings(hangs_on=True)).document()
    assert document["assumptions"].pop("database") == {"robots": 40}
    every, shown = ([row.pop("flows") for row in one["assumptions"]["globs"]] for one in (document, expected))
    assert (every, shown) == ([40], [7])  # from each robot, and from one for all that are alike
    for one in (document, expected):
        assert one["assumptions"].pop("taken_away_by") == Counter(row["by"] for row in one["taken_away"])
        one["reached"] = one["assumptions"].pop("standard_channels_reached")
    first = {robot: group["robot"] for group in expected["fleet"]["alike"] for robot in group["robots"]}
    for key in ONE_BY_ONE:
        rows_, shown = document.pop(key), expected.pop(key)
        assert len(rows_) > len(shown), key
        assert _of_shown(rows_, first) == shown, key
        assert all(_renamed_rows(rows_, robot, other) == _at(rows_, other) for robot, other in first.items()), key
    one_by_one, shown = ([_as_on_any(row) for row in one.pop("register")] for one in (document, expected))
    assert one_by_one == shown  # a row names each of the robots, or the first of those that are alike
    hinges = [{_statement(row): row for row in one.pop("hangs_on")} for one in (document, expected)]
    assert hinges[0].keys() == hinges[1].keys()  # the worst first, by how much it is: on more robots it is more
    for key, row in hinges[0].items():
        assert {name: _of_shown(row[name], first) for name in LISTS} == {name: hinges[1][key][name] for name in LISTS}
    fleets = document.pop("fleet"), expected.pop("fleet")
    assert document == expected
    for key in ("robots", "models", "patterns", "deviants"):
        assert fleets[0][key] == fleets[1][key], key
    after = dump(driver, without=("digest", "version"))
    assert [set(x) ^ set(y) for x, y in zip(after, before, strict=True)] == [set(), set()]


@pytest.mark.slow
@pytest.mark.database
def test_without_standard_channels_the_answer_about_a_fleet_is_the_same(driver: Driver) -> None:
    """Rule S13: on every robot, and most of the rows are gone."""
    whole = list(rows(FLEET))
    load(driver, whole, VOCABULARY)
    before = answer_stored(driver, Settings()).document()
    question = question_of(Settings())._replace(every=True)
    system = fleet_system(FLEET, question)
    smaller = list(rows_of_fleet(system, question, answer(system, question), without_standard=True))
    assert sum(len(robot.elements) for robot in smaller) < sum(len(robot.elements) for robot in whole) / 2
    load(driver, smaller, VOCABULARY)
    after = answer_stored(driver, Settings()).document()
    for part in ("verdict", "findings", "open", "doubts", "roles", "outside", "derivations"):
        assert after[part] == before[part], part
    assert after["fleet"] == before["fleet"]


ONE_BY_ONE = (  # told of every robot; of a fleet from files one robot stands for all that are alike
    "carries", "derivations", "outside", "processed_for", "processing", "reached", "roles", "sanitizers", "subjects",
    "taken_away", "unreached",
)  # fmt: skip
LISTS = ("elements", "to", "findings", "questions")  # of one statement: of every robot that it is about


def _of_shown(rows: list[Any], first: dict[str, str]) -> list[Any]:
    """What is about robots that stand for themselves and others, or about what all share."""
    return [row for row in rows if all(first.get(robot, robot) == robot for robot in _robots(row))]


def _at(rows: list[Any], robot: str) -> list[Any]:
    return [row for row in rows if (row.get("element") or row)["robot"] == robot]


def _renamed_rows(rows: list[Any], robot: str, other: str) -> Any:
    return json.loads(json.dumps(_at(rows, robot)).replace(json.dumps(robot), json.dumps(other)))


def _robots(row: Any) -> Iterator[str]:
    """The robots of the elements that a row names, at any depth."""
    if isinstance(row, dict):
        yield from [row["robot"]] if "robot" in row else []
        row = list(row.values())
    for item in row if isinstance(row, list) else ():
        yield from _robots(item)


def _statement(row: dict[str, Any]) -> str:
    return json.dumps({key: value for key, value in row.items() if key not in LISTS}, sort_keys=True)


@pytest.mark.slow
@pytest.mark.database
def test_a_changed_robot_is_written_anew_and_nothing_is_left_behind(driver: Driver, tmp_path: Path) -> None:
    for file in ((ROOT / "examples") / "fleet").iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    fleet = tmp_path / "fleet.yaml"
    text = fleet.read_text("utf-8")
    load(driver, rows(str(fleet)), VOCABULARY)
    before = dump(driver, without=("digest", "version", "assumptions"))
    fleet.write_text(text.replace('  - {from: "cleaner_*:/uploader", to: footage bucket}\n', ""), "utf-8")
    assert load(driver, rows(str(fleet)), VOCABULARY).written
    assert dump(driver, without=("digest", "version", "assumptions")) != before
    fleet.write_text(text, "utf-8")
    load(driver, rows(str(fleet)), VOCABULARY)
    assert dump(driver, without=("digest", "version", "assumptions")) == before
    assert len(unload(driver, [one.robot for one in rows(str(fleet))])) == 42
    assert driver.execute_query("MATCH (n:Element|Finding|Enclave|Robot) RETURN count(n)").records[0][0] == 0


@pytest.mark.slow
@pytest.mark.database
def test_on_random_fleets(driver: Driver, *, thorough: bool) -> None:
    """Every finding, with its pattern, on every robot; to analyse the stored fleet again changes nothing."""
    for case in random_fleets(12 if thorough else 4):
        found = found_in(case)
        assert found
        analysis, placed = found
        driver.execute_query("MATCH (n) DETACH DELETE n")
        load(driver, FleetRows(placed, analysis, SMALL, {}), SMALL)
        written = stored_findings(driver)
        assert {row[:6] for row in written} == expected_findings(case)
        stored = read_stored(driver, SMALL)
        write_back(driver, stored, analyse(stored.graph, stored.bound, SMALL.hierarchy), SMALL)
        assert stored_findings(driver) == written


def random_fleets(count: int) -> list[Case]:
    """The same each time."""
    from hypothesis import Phase, given, settings

    some: list[Case] = []

    @settings(max_examples=20 * count, derandomize=True, database=None, phases=[Phase.generate], deadline=None)
    @given(fleets())
    def take(case: Case) -> None:
        found = found_in(case)
        if found is not None and found[0].findings and found[1].likeness.second:
            some.append(case)

    take()
    assert len(some) >= count
    return some[:count]


def expected_findings(case: Case) -> set[tuple[Any, ...]]:
    brute, elements = case.brute()
    return {
        (kind, category, elements[a].robot, elements[a].name, elements[b].robot, elements[b].name)
        for kind, category, a, b, _ in brute.findings()
    }


def stored_findings(driver: Driver) -> set[tuple[Any, ...]]:
    query = (
        "MATCH (a)<-[:FROM]-(f:Finding)-[:TO]->(b) RETURN f.kind, f.category, a.robot, a.name, b.robot, b.name, "
        "f.pattern, f.pseudonymised, f.dismissed, f.reason, COUNT { (f)-[:ACROSS]->() } AS steps"
    )
    found = [tuple(record) for record in driver.execute_query(query).records]
    assert len(set(found)) == len(found)
    return set(found)


def _as_on_any(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row of the register without robots, and so without the ids that are made from them."""
    lists = ("places", "sources", "derivations", "measures")
    names = {key: sorted({str({**one, **_nameless(one)}) for one in row[key]}) for key in lists}
    return {**row, **names, "id": "", "findings": ""}


def _nameless(one: Mapping[str, Any]) -> dict[str, Any]:
    return {"robot": ""} if "robot" in one else {"element": {**one["element"], "robot": ""}}
