"""The Cypher that everybody writes first gives the pairs of the JSON, dismissed ones included (rules S7, S8, S10).

``(:VideoSource)-[:CARRIES_VIDEO*1..]->(:VideoLeak)``: what a node makes of other data begins there, so these pairs are
those of the findings once ``DERIVES_FROM`` says of which source it is made.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

import pytest
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.model import DISCLOSURE
from rosprivacy.ingest.database.fleet_rows import robot_rows
from rosprivacy.ingest.database.ids import carries
from rosprivacy.ingest.database.loading import load
from rosprivacy.queries.run import run
from tests.helpers.cases import CASES
from tests.helpers.daily import one_in
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.paths import ROOT
from tests.helpers.random_rows import VOCABULARY, random_systems
from tests.helpers.systems import systems

if TYPE_CHECKING:
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.ontology.vocabulary import Vocabulary

pytestmark = pytest.mark.database
Pair = tuple[str, str, str, str]  # robot, category, names of source and leak

NAIVE = "MATCH (s:{0}Source)-[:{1}*1..]->(l:{0}Leak) RETURN DISTINCT s.robot, s.name, l.name"
BEGINS = "MATCH (n:Element) WHERE $category IN n.begins RETURN n.robot, n.name, [n.name]"
MADE = (
    "MATCH (n:Element)-[:DERIVES]->(:DataCategory {name: $category}) "
    "WHERE EXISTS { (n)-[:DERIVES_FROM {category: $category}]->() } OR $category IN n.carries "
    "RETURN DISTINCT n.robot, n.name, "
    "COLLECT { MATCH (n)-[:DERIVES_FROM {category: $category}]->(s:Element) RETURN s.name } AS sources"
)


def asked(driver: Driver, vocabulary: Vocabulary) -> set[Pair]:
    """The pairs that Neo4j gives, for each kind of data."""
    pairs: set[Pair] = set()
    for name, category in vocabulary.categories.items():
        made: dict[tuple[str, str], set[str]] = {}
        for query in (BEGINS, MADE):
            for robot, element, sources in driver.execute_query(query, category=name).records:
                made.setdefault((robot, element), set()).update(sources)
        query = NAIVE.format(category.label, carries(category.label))
        for robot, start, leak in driver.execute_query(query).records:
            sources = made.get((robot, start), {f"nothing begins at {start}"})
            pairs |= {(robot, name, source, leak) for source in sources}
    return pairs


@pytest.mark.slow
def test_on_200_random_graphs(driver: Driver) -> None:
    """With derivations, pseudonymisation, wildcards, sources of one channel, restricted flows, leaks behind leaks."""
    expected: set[Pair] = set()
    rows = []
    for number, system in enumerate(random_systems(200, st.one_of(systems(), wildcards(), ranked()))):
        analysis, robot = system.analyse(), f"g{number:03}"
        rows.append(robot_rows(robot, analysis, system.bound(), VOCABULARY))
        found = (f for f in analysis.findings if f.kind == DISCLOSURE)
        expected |= {(robot, f.category, f.source.name, f.leak.name) for f in found}
    load(driver, rows, VOCABULARY)
    assert len(expected) > 200
    assert sum(bool(one.intakes) for one in rows) > 10
    assert asked(driver, VOCABULARY) == expected


@pytest.mark.parametrize("case", one_in(len(CASES), CASES[::-1]), ids=lambda path: str(path.name))
def test_on_the_examples(driver: Driver, case: Path, examples: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against the findings of the JSON."""
    monkeypatch.chdir(examples)
    given = json.loads((case / "case.json").read_text("utf-8"))
    result = rosprivacy.analyze(given["policies"], given["labels"], **given.get("options", {}))
    load(driver, [robot_rows("r", result.analysis, result.bound, result.vocabulary)], result.vocabulary)
    found = [row for row in result.document()["findings"] if row["kind"] == DISCLOSURE]
    expected = {("r", row["category"], row["source"]["name"], row["leak"]["name"]) for row in found}
    assert asked(driver, result.vocabulary) == expected


def test_the_cypher_of_the_documentation(driver: Driver) -> None:
    """Each block of docs/database.md that only reads gives rows; those of video give the pairs of the findings."""
    result = care_home()
    load(driver, [rows_of("care-home", result)], result.vocabulary)
    found = [row for row in result.document()["findings"] if (row["kind"], row["category"]) == (DISCLOSURE, "Video")]
    text = (ROOT / "docs" / "database.md").read_text("utf-8")
    blocks = re.findall(r"```cypher\n(.*?)```", text, re.DOTALL)
    reading = [block for block in blocks if "CREATE" not in block]
    paths = [run(driver, block).rows for block in reading if "CARRIES_VIDEO" in block]
    assert len(paths) == 3
    for rows in paths:
        ends = {(path.nodes[0].properties["name"], path.nodes[-1].properties["name"]) for (path,) in rows}
        assert ends == {(row["source"]["name"], row["leak"]["name"]) for row in found}
    for block in reading:
        run(driver, block)
