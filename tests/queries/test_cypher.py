"""What Cypher finds by walking the graph is what memory finds (rules S7, S8, S10).

Two ways to ask: the path queries of the pack, which show what is not dismissed; and the query that everybody writes
first, ``(:VideoSource)-[:CARRIES_VIDEO*1..]->(:VideoLeak)``, which shows every pair. What a node makes of other data
begins there, so its pairs are those of the findings once ``DERIVES_FROM`` says of which source it is made.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from itertools import groupby
from typing import TYPE_CHECKING

import pytest
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import DISCLOSURE
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.ingest.neo4j_graph.ids import carries
from rosprivacy.ingest.neo4j_graph.loading import load
from rosprivacy.ingest.policies.policy_xml import NotAPolicyError, read_policy
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.queries.library import find
from rosprivacy.queries.run import run
from tests.helpers.cases import CASES
from tests.helpers.daily import one_in
from tests.helpers.graphs import care_home, rows_of
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.paths import ROOT
from tests.helpers.random_rows import VOCABULARY, random_systems
from tests.helpers.systems import PARENTS, systems

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.ontology.vocabulary import Vocabulary

pytestmark = pytest.mark.database
Pair = tuple[str, str, str, str]  # robot, category, names of source and leak


@dataclass
class Disclosures:
    """What memory finds: every pair; and of what is not dismissed the shortest way."""

    pairs: set[Pair] = field(default_factory=set)
    ways: dict[Pair, list[str]] = field(default_factory=dict)

    def add(self, analysis: Analysis, robot: str) -> None:
        for finding in analysis.findings:
            if finding.kind == DISCLOSURE:
                pair = (robot, finding.category, finding.source.name, finding.leak.name)
                self.pairs.add(pair)
                if not finding.dismissed:
                    self.ways[pair] = names(element.name for element in finding.witness)


def names(of: Iterable[str]) -> list[str]:
    """The two sides of a wildcard are one element to the reader."""
    return [name for name, _ in groupby(of)]


def paths(driver: Driver, query: str, **values: str) -> dict[Pair, list[str]]:
    """What a query of the pack finds: each way once, in order."""
    asked = find(query)
    rows = run(driver, asked.text, asked.values(values), limit=None).rows
    keys = [row[:4] for row in rows]
    assert keys == sorted(set(keys))
    return {row[:4]: names(row[4]) for row in rows}


NAIVE = "MATCH (s:{0}Source)-[:{1}*1..]->(l:{0}Leak) RETURN DISTINCT s.robot, s.name, l.name"
BEGINS = "MATCH (n:Element) WHERE $category IN n.begins RETURN n.robot, n.name, [n.name]"
MADE = (
    "MATCH (n:Element)-[:DERIVES]->(:DataCategory {name: $category}) "
    "WHERE EXISTS { (n)-[:DERIVES_FROM {category: $category}]->() } OR $category IN n.carries "
    "RETURN DISTINCT n.robot, n.name, "
    "COLLECT { MATCH (n)-[:DERIVES_FROM {category: $category}]->(s:Element) RETURN s.name } AS sources"
)


def pairs(driver: Driver, vocabulary: Vocabulary) -> set[Pair]:
    """What the query finds that everybody writes first, for each kind of data."""
    shown: set[Pair] = set()
    for name, category in vocabulary.categories.items():
        origins: dict[tuple[str, str], set[str]] = {}
        for query in (BEGINS, MADE):
            for robot, element, sources in driver.execute_query(query, category=name).records:
                origins.setdefault((robot, element), set()).update(sources)
        query = NAIVE.format(category.label, carries(category.label))
        for robot, start, leak in driver.execute_query(query).records:
            sources = origins.get((robot, start), {f"nothing begins at {start}"})
            shown |= {(robot, name, source, leak) for source in sources}
    return shown


@pytest.mark.slow
def test_on_random_graphs(driver: Driver, *, thorough: bool) -> None:
    """With derivations, pseudonymisation, wildcards, sources of one channel, restricted flows, leaks behind leaks."""
    expected = Disclosures()
    rows = []
    for number, system in enumerate(
        random_systems(200 if thorough else 70, st.one_of(systems(), wildcards(), ranked()))
    ):
        analysis, robot = system.analyse(), f"g{number:03}"
        rows.append(robot_rows(robot, analysis, system.bound(), VOCABULARY))
        expected.add(analysis, robot)
    load(driver, rows, VOCABULARY)
    assert len(expected.pairs) > len(rows)
    assert sum(bool(one.intakes) for one in rows) > len(rows) / 20
    assert pairs(driver, VOCABULARY) == expected.pairs
    assert paths(driver, "leak-paths") == expected.ways
    # Memory shows a way in the clear even where one on which the data is pseudonymised is shorter.
    walked = paths(driver, "leak-paths-of-category", category="Any")
    assert walked.keys() == expected.ways.keys()
    assert all(len(walked[way]) <= len(expected.ways[way]) for way in walked)
    assert sum(len(walked[way]) == len(expected.ways[way]) for way in walked) > 0.9 * len(walked)
    for name in PARENTS:  # S7: what may be of a kind, too
        of_category = {way for way in expected.ways if name in VOCABULARY.hierarchy.overlaps[way[1]]}
        assert paths(driver, "leak-paths-of-category", category=name).keys() == of_category


@pytest.mark.slow
@pytest.mark.parametrize("case", one_in(4, CASES), ids=lambda path: str(path.name))
def test_on_the_examples(driver: Driver, case: Path, examples: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(examples)
    given = json.loads((case / "case.json").read_text("utf-8"))
    result = rosprivacy.analyze(given["policies"], given["labels"], **given.get("options", {}))
    load(driver, [robot_rows("r", result.analysis, result.bound, result.vocabulary)], result.vocabulary)
    expected = Disclosures()
    expected.add(result.analysis, "r")
    assert pairs(driver, result.vocabulary) == expected.pairs
    walked = paths(driver, "leak-paths-of-category", category="PersonalData")
    assert {way: len(path) for way, path in walked.items()} == {way: len(path) for way, path in expected.ways.items()}
    assert paths(driver, "leak-paths") == expected.ways


ROLES = (
    "{source: [Video]}",
    "{leak: [Video]}",
    "{source: [Voice], leak: [Video]}",
    "{leak: [Voice], sanitizer: {Video: pseudonymise}}",
    "{derives: [{from: Video, to: FaceTemplate}], sanitizer: {Video: drop}}",
    "{leak: [Biometric]}",
    "conduit",
)


def made_up_labels(policy: Path) -> str:
    """A label for every node of a policy, by its place in the alphabet: all roles, three kinds of data."""
    nodes = sorted({profile.node for profile in read_policy(str(policy)).profiles})
    lines = [f"  {json.dumps(node)}: {ROLES[i % len(ROLES)]}\n" for i, node in enumerate(nodes)]
    return "labels: 1\nnodes:\n" + "".join(lines)


@pytest.mark.slow
@pytest.mark.corpus
def test_on_every_policy_of_the_corpus(driver: Driver, corpus: Path, tmp_path: Path) -> None:
    expected = Disclosures()
    rows: list[RobotRows] = []
    labels = tmp_path / "labels.yaml"
    for policy in sorted((corpus / "policies").rglob("*.xml")):
        try:
            labels.write_text(made_up_labels(policy), "utf-8")
        except (InputErrors, NotAPolicyError):
            continue
        result = rosprivacy.analyze([str(policy)], [str(labels)])
        robot = f"p{len(rows):02}"
        rows.append(robot_rows(robot, result.analysis, result.bound, result.vocabulary))
        expected.add(result.analysis, robot)
    assert len(rows) == 24
    assert len(expected.pairs) > 100
    load(driver, rows, load_vocabulary())
    walked = paths(driver, "leak-paths-of-category", category="PersonalData")
    assert walked.keys() == expected.ways.keys()
    assert all(len(walked[way]) <= len(expected.ways[way]) for way in walked)


@pytest.mark.slow
def test_the_cypher_of_the_documentation(driver: Driver) -> None:
    """Each block of docs/database.md that only reads gives rows; those of video give the pairs of the findings."""
    result = care_home()
    load(driver, [rows_of("care-home", result)], result.vocabulary)
    expected = Disclosures()
    expected.add(result.analysis, "care-home")
    of_findings = {(source, leak) for _, kind, source, leak in expected.pairs if kind == "Video"}
    text = (ROOT / "docs" / "database.md").read_text("utf-8")
    blocks = [block for block in re.findall(r"```cypher\n(.*?)```", text, re.DOTALL) if "CREATE" not in block]
    answers = {block: run(driver, block).rows for block in blocks}
    of_video = [rows for block, rows in answers.items() if "CARRIES_VIDEO" in block]
    assert len(of_video) == 3
    for rows in of_video:
        ends = {(path.nodes[0].properties["name"], path.nodes[-1].properties["name"]) for (path,) in rows}
        assert ends == of_findings
