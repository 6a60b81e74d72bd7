"""docs/linked-data.md says what is true: its queries and its shape are run, its answers and its words are those there.

``python -m tests.report.rdf.test_linked_data`` writes the answers in it anew.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pyshacl
import pytest
from rdflib import SH, Graph, Literal

import rosprivacy
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.formats import written
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.private_neo4j import connection
from rosprivacy.queries.library import find
from rosprivacy.queries.run import run
from rosprivacy.report.rdf.terms import RP
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.linked_data import MORE, PAGE, QUESTION, answered, questions
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from rdflib.term import Node

    from rosprivacy.private_neo4j.connection import Connection

CONDITION = (
    "biometric data count here only when they are processed to identify a person uniquely or to confirm who a person "
    "is (Article 4(14), recital 51); a template that is kept to recognise somebody again usually is"
)
CARE = "examples/care-home/care-home"


def findings() -> Graph:
    """The file of the page."""
    with chdir(ROOT):
        result = rosprivacy.analyze([f"{CARE}.policy.xml"], [f"{CARE}.labels.yaml"])
    return Graph().parse(data=written(result, "turtle"), format="turtle")


@pytest.fixture(scope="module")
def graph() -> Graph:
    return findings()


def table(graph: Graph, query: str) -> str:
    """The answer as it stands in the page."""
    names = [str(name) for name in graph.query(query).vars or ()]
    rows = [names, ["---"] * len(names), *answered(graph, query)]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def page(text: str) -> str:
    """The page with its answers anew."""
    graph = findings()
    return QUESTION.sub(lambda found: f"{found[1]}\n{table(graph, found[2])}\n", text)


def under_article_9(graph: Graph) -> set[tuple[str, ...]]:
    """By the second question of the page."""
    return set(answered(graph, questions()[1]))


def marked(graph: Graph) -> set[tuple[str, ...]]:
    """By the shape of the questions: what pyshacl marks, and what the marked value says."""
    (shape,) = re.findall(r"```turtle\n(.*?)```", MORE.read_text("utf-8"), re.DOTALL)
    _, report, _ = pyshacl.validate(graph, shacl_graph=Graph().parse(data=shape, format="turtle"))
    assert isinstance(report, Graph)
    return {row(graph, finding, law) for finding, law in results(report)}


def results(report: Graph) -> list[tuple[Node, Node]]:
    found = report.subjects(SH.resultSeverity, SH.Info)
    return [(report.value(r, SH.focusNode), report.value(r, SH.value)) for r in found]  # type: ignore[misc]


def row(graph: Graph, finding: Node, law: Node) -> tuple[str, ...]:
    """Category, source, leak, provision, verdict, condition, the category that it is stated of."""

    def value(node: Node | None, *way: Node) -> str:
        for step in way:
            node = graph.value(node, step)
        return "" if node is None else str(node)

    return (
        value(finding, RP.category).removeprefix(str(RP)),
        value(finding, RP.dataSource, RP.name),
        value(finding, RP.leak, RP.name),
        value(law, RP.provision, RP.identifier),
        value(law, RP.verdict),
        next((str(c) for c in graph.objects(law, RP.condition) if c.language == "en"), ""),  # type: ignore[attr-defined]
        value(law, RP.statedOf).removeprefix(str(RP)),
    )


def test_there_are_seven_questions_and_each_has_an_answer(graph: Graph) -> None:
    assert len(questions()) == 7
    assert all(answered(graph, query) for query in questions())


@pytest.mark.parametrize("file", [PAGE, MORE], ids=lambda file: str(file.name))
def test_the_answers_are_those_of_the_page(file: Path) -> None:
    text = file.read_text("utf-8")
    assert text == page(text), "python -m tests.report.rdf.test_linked_data"


def test_what_is_under_article_9_and_why() -> None:
    """A face template is, if it is used to identify; video, also pseudonymised, and voice may reveal such data."""
    face = (
        "FaceTemplate",
        "/camera",
        "/uplink",
        "GDPR Art. 9(1) biometric data",
        "conditional",
        CONDITION,
        "FaceTemplate",
    )
    told = under_article_9(findings())
    assert face in told
    assert {(*row[:5], row[-1]) for row in told - {face}} == {
        ("Video", "/camera", "/recorder", "GDPR Art. 9(1)", "may-reveal", "Video"),
        ("Voice", "/microphone", "/uplink", "GDPR Art. 9(1)", "may-reveal", "Voice"),
    }


def test_sparql_and_shacl_find_the_same_under_article_9(graph: Graph) -> None:
    assert marked(graph) == under_article_9(graph) != set()


def test_neither_counts_a_dismissed_finding(graph: Graph) -> None:
    changed = Graph() + graph
    for finding in list(graph.subjects(RP.fallsUnder, None)):
        changed.set((finding, RP.dismissed, Literal(lexical_or_value=True)))
    assert marked(changed) == under_article_9(changed) == set()


def test_an_article_whose_number_begins_alike_is_another(graph: Graph) -> None:
    changed = Graph() + graph
    for provision in list(graph.subjects(RP.identifier, None)):
        changed.set((provision, RP.identifier, Literal("GDPR Art. 90")))
    assert marked(changed) == under_article_9(changed) == set()


@pytest.mark.slow
@pytest.mark.database
def test_cypher_finds_the_same_under_article_9(graph: Graph, neo4j_server: Connection) -> None:
    with connection.open_driver(neo4j_server) as driver:
        driver.execute_query("MATCH (n) DETACH DELETE n")
        result = care_home()
        load(driver, [rows_of("care-home", result)], result.vocabulary)
        query = find("findings-under-article")
        answer = run(driver, query.text, query.values({}), limit=None)
    named = ["category", "source", "leak", "provision", "verdict", "condition", "stated_of"]
    columns = [answer.columns.index(name) for name in named]
    assert {tuple(str(row[i] or "") for i in columns) for row in answer.rows} == under_article_9(graph)


def test_the_words_of_the_page_are_those_of_the_shapes() -> None:
    """Every class and property of ours has a meaning there, and nothing else has."""
    shapes = (ROOT / "report" / "rdf" / "findings.shapes.ttl").read_text("utf-8")
    used = set(re.findall(r"sh:path rp:(\w+)|sh:class rp:(\w+)|sh:hasValue rp:(\w+)|sh:targetClass rp:(\w+)", shapes))
    own = {name for names in used for name in names if name}
    told = set(re.findall(r"`rp:(\w+)`", PAGE.read_text("utf-8").split("## Our own words")[1]))
    kinds = {"RosNode", "Topic", "Service", "Action", "ExternalSystem", "SharedMemory", "SideChannel", "Device"}
    assert told == own | kinds | {"Display", "Person", "Storage"}


if __name__ == "__main__":
    for file in (PAGE, MORE):
        file.write_text(page(file.read_text("utf-8")), "utf-8")
