"""The query pack: for every question a case with rows and one without, on systems that are loaded from files.

``cases/queries/<name>.json``: ``hits`` and ``clean``, each with ``load`` (robot -> system of
``cases/queries/systems/systems.json``), ``parameters`` and all ``rows``; a path of the graph is told in words. Rows
were judged by hand from the rules. Where ``load`` is a list, these are loads one after the other, one a day, which the
database remembers.
"""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import Category, Confidence, Element, Flow, FlowGraph, Legal, Place, Suggestion
from rosprivacy.analysis.model.recording import Bag, BagTopic, JudgedBag, TopicKinds
from rosprivacy.both_views import both_views
from rosprivacy.ingest.labels.binding import bind
from rosprivacy.ingest.labels.label_file import STANDARD, read_labels
from rosprivacy.ingest.neo4j_graph.bag_rows import bag_rows, load_bags
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.ingest.neo4j_graph.loading import Run, load
from rosprivacy.ingest.neo4j_graph.schema import CARRIES, FLOWS_TO, KIND_LABELS
from rosprivacy.ingest.policies.flow_graph import build
from rosprivacy.ontology.vocabulary import Vocabulary
from rosprivacy.private_neo4j import connection
from rosprivacy.queries.graph_values import Path
from rosprivacy.queries.library import COLUMN_TYPES, find, pack
from rosprivacy.queries.run import run
from rosprivacy.report.stored import StoredNames
from rosprivacy.report.text.graph_words import GraphWords
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import beyond_of, read_system
from tests.helpers.daily import one_in
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from neo4j import Driver

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.private_neo4j.connection import Connection

FOLDER = ROOT / "tests" / "cases" / "queries"
SYSTEMS = json.loads((FOLDER / "systems" / "systems.json").read_text("utf-8"))
QUERIES = pack()
CASES = {path.stem: json.loads(path.read_text("utf-8")) for path in sorted(FOLDER.glob("*.json"))}
PARENTS = {
    "PersonalData": (),
    "Video": ("PersonalData",),
    "Voice": ("PersonalData",),
    "Biometric": ("PersonalData",),
    "FaceTemplate": ("Biometric",),
    "VoicePrint": ("Biometric",),
    "Location": ("PersonalData",),
    "PersonTrack": ("Location",),
}


FACTORS = {"Video": ("physical",), "FaceTemplate": ("physical", "physiological")}  # Voice: not stated
TYPES = {"Video": ("video",), "Voice": ("audio",), "FaceTemplate": ("template",), "Location": ("position",)}


def under(name: str, verdict: str, condition: str = "") -> tuple[Legal, ...]:
    return (Legal(f"urn:test:{name}", name, name, "2026-01-01", verdict, condition),)


# Of the test's own, so that a change of the ontology changes no rows; what is said of Voice and Video is made up.
LAW = {
    "Biometric": under("GDPR Art. 9(1) biometric data", "conditional", "if it is to identify a person"),
    "Voice": under("GDPR Art. 10", "may-reveal"),
    "Video": under("GDPR Art. 90", "always"),
}
VOCABULARY = Vocabulary.of(
    Category(
        name,
        f"urn:test:{name}",
        name,
        name,
        name,
        up,
        law=LAW.get(name, ()),
        data_types=TYPES.get(name, ()),
        identity_factors=FACTORS.get(name, ()),
    )
    for name, up in PARENTS.items()
)


def system(robot: str, name: str) -> RobotRows:
    """The rows of a system of ``systems.json``; its paths are relative to the repository."""
    given = SYSTEMS[name]
    graph = build(read_system(tuple(given["policies"]), Settings(), [])[0])
    graph = with_storages(graph, given.get("storages", {}))
    labels = [read_labels(STANDARD, VOCABULARY), *(read_labels(file, VOCABULARY) for file in given["labels"])]
    bound = bind(graph, labels)
    beyond = None
    if given.get("view") == "both":
        beyond = beyond_of(both_views(tuple(given["policies"]), tuple(given["labels"]), Settings()))
    return robot_rows(robot, analyse(graph, bound, VOCABULARY.hierarchy), bound, VOCABULARY, beyond=beyond)


def with_storages(graph: FlowGraph, storages: Mapping[str, Any]) -> FlowGraph:
    """The graph with storages, which no policy speaks of (rule S9)."""
    elements = tuple(sorted({*graph.elements, *(Element("storage", name) for name in storages)}, key=Element.sort_key))
    number = {element: i for i, element in enumerate(elements)}

    def moved(flows: Sequence[Flow]) -> list[Flow]:
        ends = graph.elements
        return [f._replace(source=number[ends[f.source]], target=number[ends[f.target]]) for f in flows]

    new = [
        Flow(number[source], number[target], "flow")
        for name, ends in storages.items()
        for source, target in [
            *((Element("node", n), Element("storage", name)) for n in ends["from"]),
            *((Element("storage", name), Element("node", n)) for n in ends["to"]),
        ]
    ]
    flows = sorted([*moved(graph.flows), *new], key=lambda f: (f.source, f.target, f.role))
    return replace(graph, elements=elements, flows=tuple(flows), denied=tuple(moved(graph.denied)))


@pytest.fixture(scope="module")
def driver(neo4j_server: Connection) -> Iterator[Driver]:
    with connection.open_driver(neo4j_server) as opened:
        yield opened


def fill(driver: Driver, loads: Mapping[str, str] | list[dict[str, str]]) -> None:
    """Wipe the database and load what a case asks for; bags under the paths where they are."""
    driver.execute_query("MATCH (n) DETACH DELETE n")
    if isinstance(loads, list):
        for day, robots in enumerate(loads, 1):
            rows = [system(robot, name) for robot, name in robots.items()]
            load(driver, rows, VOCABULARY, run_of=Run(f"2026-01-{day:02}T08:00:00Z", "1.0", str(day)))
        return
    bags = {path: SYSTEMS[name]["bag"] for path, name in loads.items() if "bag" in SYSTEMS[name]}
    load(driver, [system(robot, name) for robot, name in loads.items() if robot not in bags], VOCABULARY)
    for path, given in bags.items():
        load_bags(
            driver,
            [bag_rows(recorded(path, given["topics"], given.get("gaps", ())), given["robot"], {})],
            given["robot"],
            VOCABULARY,
        )


def recorded(path: str, topics: Mapping[str, Any], gaps: Sequence[str]) -> JudgedBag:
    """A bag of ``systems.json``."""
    at = Place("table", 1)
    judged = [
        TopicKinds(
            BagTopic(name, messages=1),
            tuple(said.get("kinds", ())),
            said.get("unknown", ""),
            suggested=tuple(
                Suggestion("a/msg/A", (kind,), Confidence(sure), "", "", at)
                for kind, sure in said.get("suggested", {}).items()
            ),
        )
        for name, said in topics.items()
    ]
    return JudgedBag(Bag(path, topics=tuple(one.topic for one in judged), gaps=tuple(gaps)), tuple(judged))


def ask(driver: Driver, name: str, parameters: Mapping[str, str]) -> tuple[tuple[str, ...], list[list[Any]]]:
    query = find(name)
    rows = run(driver, query.text, query.values(parameters), limit=None)
    words = GraphWords(StoredNames({label: kind for kind, label in KIND_LABELS.items()}, FLOWS_TO.type, CARRIES), False)
    return rows.columns, [[words.of(v) if isinstance(v, Path) else v for v in row] for row in rows.rows]


def by_load() -> list[tuple[str, list[tuple[str, str]]]]:
    """What is loaded, as JSON, with the (query, case) that ask it: each load is done once, that of most cases first."""
    groups: dict[str, list[tuple[str, str]]] = {}
    for name, cases in CASES.items():
        for which, case in cases.items():
            groups.setdefault(json.dumps(case["load"]), []).append((name, which))
    return sorted(groups.items(), key=lambda group: (-len(group[1]), group[0]))


def test_every_query_has_a_case_and_every_case_a_query() -> None:
    assert len(QUERIES) >= 20
    assert sorted(CASES) == sorted(QUERIES)
    assert all({"hits", "clean"} <= set(cases) for cases in CASES.values())
    assert all(cases["hits"]["rows"] for cases in CASES.values())


@pytest.mark.slow
@pytest.mark.database
def test_on_an_empty_database_there_are_no_rows(driver: Driver) -> None:
    fill(driver, {})
    for name, query in QUERIES.items():
        required = {field.name: "x" for field in query.parameters if field.default is None}
        columns, rows = ask(driver, name, required)
        assert list(columns) == [field.name for field in query.columns]
        assert rows == [], name


@pytest.mark.database
@pytest.mark.parametrize("robots", one_in(6, [robots for robots, _ in by_load()][::-1]))
def test_rows(robots: str, driver: Driver, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    fill(driver, json.loads(robots))
    wrong = {}
    for name, which in dict(by_load())[robots]:
        case = CASES[name][which]
        columns, rows = ask(driver, name, case["parameters"])
        assert list(columns) == [field.name for field in QUERIES[name].columns]
        in_words = {**COLUMN_TYPES, "graph path": str}
        types = [in_words[field.type] for field in QUERIES[name].columns]
        assert all(type(v) is t for row in rows for v, t in zip(row, types, strict=True) if v is not None), name
        if rows != case["rows"]:
            wrong[name, which] = rows
    assert not wrong
