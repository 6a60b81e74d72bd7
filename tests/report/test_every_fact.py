"""Every fact of the JSON document that has a term in a format appears in it: from files to text (rules S9 to S12)."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import pytest

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.answering import answer
from rosprivacy.formats import FORMATS, Style, written
from rosprivacy.private_neo4j import connection
from rosprivacy.question import question_of
from rosprivacy.report.catalogs.words import Words
from rosprivacy.settings import Settings
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet
from tests.helpers.paths import ROOT
from tests.helpers.word import text_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from pathlib import Path

    from rosprivacy.private_neo4j.connection import Connection
    from rosprivacy.result import Result

    Document = Mapping[str, Any]
    Term = Callable[[str], str]

WORDS = Words("en")
FLEET = "examples/fleet/fleet.yaml"
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/"><profiles>
<profile ns="/" node="camera"><topics publish="ALLOW"><topic>raw</topic></topics></profile>
<profile ns="/" node="blur"><topics subscribe="ALLOW"><topic>raw</topic></topics>
<topics publish="ALLOW"><topic>blurred</topic></topics></profile>
<profile ns="/" node="uplink"><topics subscribe="ALLOW"><topic>blurred</topic><topic>voice</topic></topics></profile>
<profile ns="/" node="microphone"><topics publish="ALLOW"><topic>voice</topic></topics></profile>
<profile ns="/" node="logger"><topics subscribe="ALLOW"><topic>raw</topic><topic>voice</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
LABELS = """labels: 1
controller: Haven Home gGmbH
dpo: Ada Officer
purpose: help of residents
legal_basis: [6(1)(e), 9(2)(h)]
nodes:
  /camera: {source: [Video], subjects: [residents, visitors]}
  /microphone: {source: [Voice], subjects: [nurses]}
  /blur: {sanitizer: [Video]}
elements:
  archive disk: {kind: storage, country: IE, operator: Disk Keepers, contract: Article 28 of 2026,
    retention: {Video: P41D}, encrypted: true}
  cloud: {kind: external-system, country: US, operator: Cloud Movers, recipient: joint-controller, transfer: derogation}
limits: {Video: P30D}
flows:
  - {from: /logger, to: archive disk}
  - {from: /uplink, to: cloud}
"""
REASONS = "the residents asked for it", "a limit will be set"


def same(value: str) -> str:
    return value


def line_iri(place: str) -> str:
    file, _, line = place.rpartition(":")
    return f"line:{quote(file)}:{line}:"


def of_elements(*keys: str) -> Callable[[Document], list[str]]:
    return lambda document: [row[key] for row in document["outside"] for key in keys if row.get(key)]


def processed(*keys: str, leaving: bool = False) -> Callable[[Document], list[str]]:
    """What is stated of data where they begin and end; or only where they leave."""

    def said(document: Document) -> list[str]:
        leaks = [(finding["leak"]["name"], finding["category"]) for finding in document["findings"]]
        rows = [
            r
            for r in document.get("processed_for", ())
            if not leaving or (r["element"]["name"], r["category"]) in leaks
        ]
        return [one for row in rows for key in keys for one in row[key]]

    return said


def durations(document: Document) -> list[str]:
    return [one for row in document["outside"] for one in row.get("retention", {}).values()]


def decided(*keys: str, accepted: bool = False) -> Callable[[Document], list[str]]:
    def said(document: Document) -> list[str]:
        rows = [f["decision"] for f in document["findings"] if f.get("decision")]
        rows = [row for row in rows if row["choice"] == "accept"] if accepted else rows
        values = [row[key] for row in rows for key in keys]
        return [one for value in values for one in (value if isinstance(value, list) else [value])]

    return said


def lines(document: Document) -> list[str]:
    grants = [grant for f in document["findings"] for step in f["steps"] for grant in step["policy"]]
    return [f"{grant['file']}:{grant['line']}" for grant in grants]


def subjects(document: Document) -> list[str]:
    return [one for row in document["subjects"] for one in row["subjects"]]


SOME_ROWS = ("json", "article30-processors")  # the short form, and a record of some rows only


def pseudonymised(document: Document) -> list[str]:
    return ["pseudonymised"] if any(f["pseudonymised"] for f in document["findings"]) else []


def without_method(document: Document) -> list[str]:
    return [row["element"]["name"] for row in document["assumptions"]["sanitizers_without_method"]]


def no_retention(document: Document) -> list[str]:
    kept = [f for f in document["findings"] if f["leak"]["kind"] == "storage"]
    return [f["category"] for f in kept if f.get("reason", "").startswith("no retention")]


PAGE = ("html", "markdown", "docx")
RDF = ("turtle", "json-ld")
DECIDED = dict.fromkeys(("text", "sarif", "cnil-pia", *RDF, *PAGE), same)
MEASURE = {  # where a sanitizer states no method
    "text": lambda name: f"sanitizer {name} states no method",
    "cnil-pia": lambda name: f"{name}: pseudonymise (personal data for whoever can tell the persons), taken because",
    "turtle": lambda name: f'"pseudonymisation at {name}"@en ;',
    "article30": lambda name: f"{name} (video of persons): not stated: taken as pseudonymising",
}


@dataclass(frozen=True, slots=True)
class Fact:
    """Values of the document, and how each format that has a term for them writes one."""

    values: Callable[[Document], Iterable[str]]
    terms: Mapping[str, Term]


FACTS = {
    "retention": Fact(
        durations,
        dict.fromkeys(RDF, same) | dict.fromkeys(("cnil-pia", *PAGE, "article30"), WORDS.duration),
    ),
    "country": Fact(of_elements("country"), dict.fromkeys(("cnil-pia", *RDF, *PAGE), same)),
    "operator": Fact(of_elements("operator"), dict.fromkeys((*RDF, *PAGE), same)),
    "role": Fact(
        of_elements("recipient"),
        dict.fromkeys(RDF, same) | dict.fromkeys(PAGE, lambda role: WORDS(f"recipient.{role}")),
    ),
    "basis": Fact(of_elements("transfer"), dict.fromkeys(("cnil-pia", *RDF), same)),
    "contract": Fact(of_elements("contract"), dict.fromkeys((*RDF, *PAGE), same)),
    "controller and officer": Fact(
        processed("controllers", "officers"), dict.fromkeys((*PAGE, *RDF, "article30", "cnil-pia"), same)
    ),
    "purpose": Fact(processed("purposes"), dict.fromkeys((*PAGE, "cnil-pia"), same)),
    "purpose where data leave": Fact(
        processed("purposes", leaving=True), dict.fromkeys((*PAGE, *RDF, "article30", "cnil-pia"), same)
    ),
    "legal basis": Fact(processed("legal_bases"), dict.fromkeys((*PAGE, "cnil-pia"), WORDS.basis)),
    "legal basis where data leave": Fact(
        processed("legal_bases", leaving=True),
        dict.fromkeys((*PAGE, "article30", "cnil-pia"), WORDS.basis) | dict.fromkeys(RDF, same),
    ),
    "subjects": Fact(subjects, dict.fromkeys((*PAGE, "article30"), same)),
    "decision with reason and basis": Fact(decided("reason", "owner", "legal_basis", accepted=True), DECIDED),
    "decision that accepts nothing": Fact(decided("reason", "owner"), dict.fromkeys(("text", *PAGE), same)),
    "lines of the witness": Fact(
        lines,
        dict.fromkeys(("sarif", *PAGE), same)
        | dict.fromkeys(RDF, line_iri)
        | {"text": lambda place: f"  {place.removeprefix('examples/fleet/')}"},  # as seen from the policies' folder
    ),
    "pseudonymised": Fact(pseudonymised, dict.fromkeys((name for name in FORMATS if name not in SOME_ROWS), same)),
    "a method that is not stated": Fact(without_method, MEASURE),
    "a retention that is not stated": Fact(
        no_retention, {"turtle": lambda category: f"keeps {category}; for how long is not stated"}
    ),
}


def strings(value: Any) -> Iterable[str]:
    if isinstance(value, dict):
        for inner in value.values():
            yield from strings(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from strings(inner)
    else:
        yield str(value)


def places(value: Any) -> Iterable[str]:
    """``file:line`` of every location of SARIF."""
    if isinstance(value, dict):
        if "physicalLocation" in value:
            where = value["physicalLocation"]
            yield f"{where['artifactLocation']['uri']}:{where['region']['startLine']}"
        for inner in value.values():
            yield from places(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from places(inner)


def read_as(result: Result, name: str) -> str:
    """What a reader of a format sees."""
    text = written(result, name, Style(verbose=True))
    if isinstance(text, bytes):
        return text_of(text)
    if name == "cnil-pia":
        return "\n".join(strings(json.loads(text)))
    if name == "sarif":
        log = json.loads(text)
        return "\n".join([*strings(log["runs"][0]["results"]), *places(log)])
    return text


def decisions_about(result: Result, folder: Path) -> str:
    """A file that accepts the first finding, and wants something done about the last."""
    document = result.document()
    patterns = {p["finding"]: p["id"] for p in document.get("fleet", {}).get("patterns", ())}
    first, *_, last = [patterns.get(f["id"], f["id"]) for f in document["findings"] if not f["dismissed"]]
    said = [
        {
            "id": first, "decision": "accept", "reason": REASONS[0], "owner": "Ada Judge",
            "legal_basis": ["6(1)(a)"], "expires": "2099-01-01",
        },
        {"id": last, "decision": "mitigate", "reason": REASONS[1], "owner": "Bob Fixer"},
    ]  # fmt: skip
    (folder / "decisions.json").write_text(json.dumps({"decisions": 1, "findings": said}))
    return str(folder / "decisions.json")


def robot_in(folder: Path) -> Path:
    (folder / "p.policy.xml").write_text(POLICY)
    (folder / "l.yaml").write_text(LABELS)
    return folder


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Result:
    folder = robot_in(tmp_path_factory.mktemp("robot"))
    with chdir(folder):
        first = rosprivacy.analyze(["p.policy.xml"], ["l.yaml"])
        return rosprivacy.analyze(["p.policy.xml"], ["l.yaml"], decisions=decisions_about(first, folder))


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory) -> Result:
    folder = tmp_path_factory.mktemp("fleet")
    with chdir(ROOT):
        first = rosprivacy.analyze_fleet(FLEET)
        return rosprivacy.analyze_fleet(FLEET, decisions=decisions_about(first, folder))


@pytest.fixture(scope="module")
def stored(neo4j_server: Connection, tmp_path_factory: pytest.TempPathFactory) -> Result:
    from rosprivacy.ingest.neo4j_graph.loading import load
    from rosprivacy.systems.robot_system import robot_of
    from rosprivacy.systems.stored_system import answer_stored

    folder = robot_in(tmp_path_factory.mktemp("stored"))
    with chdir(folder), connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        first = rosprivacy.analyze(["p.policy.xml"], ["l.yaml"])
        load(driver, [robot_of("care", first)], first.vocabulary)
        first = answer_stored(driver, Settings())
        result = answer_stored(driver, Settings(decisions=decisions_about(first, folder)))
        driver.execute_query("MATCH (n) DETACH DELETE n")
    return result


@pytest.fixture(scope="module")
def on_spark() -> Result:
    pytest.importorskip("pyspark", reason="without the [spark] extra")
    from rosprivacy.parts.fleet_in_parts import run_on_spark

    with chdir(ROOT), pytest.MonkeyPatch.context() as patch:
        # Spark's Java lives as long as the process, with the environment of its start: workers find the tests, too.
        patch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), *sys.path]))
        return run_on_spark(FLEET, Settings())


SYSTEMS = [
    "robot",
    "fleet",
    pytest.param("stored", marks=pytest.mark.database),
    pytest.param("on_spark", marks=[pytest.mark.slow, pytest.mark.xdist_group("spark")]),
]


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("system", SYSTEMS)
def test_every_fact_that_has_a_term_is_told(system: str, name: str, request: pytest.FixtureRequest) -> None:
    result: Result = request.getfixturevalue(system)
    document = result.document()
    with chdir(ROOT):
        told = read_as(result, name)
    for what, fact in FACTS.items():
        term = fact.terms.get(name)
        for value in fact.values(document) if term else ():
            assert term
            assert term(value) in told, f"{what}: {value}"


def test_the_systems_have_every_fact(robot: Result, fleet: Result) -> None:
    """Else the test above could not fail."""
    known = {what for what, fact in FACTS.items() if list(fact.values(robot.document()))}
    assert known == set(FACTS)
    of_the_fleet = {what for what, fact in FACTS.items() if list(fact.values(fleet.document()))}
    assert of_the_fleet >= {"retention", "country", "operator", "role", "decision with reason and basis", "contract",
        "controller and officer", "purpose where data leave", "legal basis where data leave", "subjects"}  # fmt: skip


@pytest.mark.slow
def test_the_rows_for_the_database_have_every_fact_that_the_fleet_states() -> None:
    """What ``rosprivacy load`` writes of the robots and of what they share."""
    with chdir(ROOT):
        question = question_of(Settings())
        system = fleet_system(FLEET, question)
        result = answer(system, question)
        robots = list(rows_of_fleet(system, question, result))
    rows = [row for robot in robots for row in (robot.properties, *robot.elements)]
    written_as = "\n".join(strings(rows))
    document = result.document()
    stored = ("retention", "country", "operator", "role", "contract", "subjects", "controller and officer", "purpose")
    for what in stored:
        for value in FACTS[what].values(document):
            assert value in written_as, f"{what}: {value}"
    for basis in FACTS["legal basis"].values(document):
        assert basis in written_as
