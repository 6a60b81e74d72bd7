"""Cypher and the analysis in memory agree: what the path queries find by walking the graph is what ``analyse`` finds.

The queries know nothing of the analysis' findings; they walk along what the flows carry.
"""

from __future__ import annotations

import json
from itertools import groupby
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import DISCLOSURE
from rosprivacy.ingest.database.fleet_rows import robot_rows
from rosprivacy.ingest.database.loading import load
from rosprivacy.ingest.policies.policy_xml import NotAPolicyError, read_policy
from rosprivacy.ontology.vocabulary import load as load_vocabulary
from rosprivacy.queries.library import find
from rosprivacy.queries.run import run
from tests.helpers.cases import CASES
from tests.helpers.daily import one_in
from tests.helpers.random_rows import VOCABULARY, random_systems
from tests.helpers.systems import PARENTS

if TYPE_CHECKING:
    from pathlib import Path

    from neo4j import Driver

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.ingest.database.rows import RobotRows

pytestmark = pytest.mark.database

Way = tuple[str, str, str, str]


def ways(analysis: Analysis, robot: str) -> dict[Way, int]:
    """(robot, category, source, leak) -> elements of the shortest way, of disclosures that are not dismissed."""
    return {
        (robot, f.category, f.source.name, f.leak.name): len(f.witness)
        for f in analysis.findings
        if f.kind == DISCLOSURE and not f.dismissed
    }


def found(driver: Driver, name: str, **values: str) -> dict[Way, list[str]]:
    query = find(name)
    rows = run(driver, query.text, query.values(values), limit=None).rows
    keys = [row[:4] for row in rows]
    assert len(set(keys)) == len(keys)
    assert keys == sorted(keys)
    return {row[:4]: row[4] for row in rows}


@pytest.mark.slow
def test_on_200_random_graphs(driver: Driver) -> None:
    """With derivations, pseudonymisation, restricted flows and channels, leaks behind leaks."""
    expected: dict[Way, int] = {}
    rows = []
    for number, system in enumerate(random_systems(200)):
        analysis, robot = system.analyse(), f"g{number:03}"
        rows.append(robot_rows(robot, analysis, system.bound(), VOCABULARY))
        expected |= ways(analysis, robot)
    load(driver, rows, VOCABULARY)
    assert len(expected) > 100
    got = found(driver, "leak-paths-of-category", category="Any")
    assert set(got) == set(expected)
    # Memory shows a way in the clear even where one on which the data is pseudonymised is shorter.
    assert all(len(got[way]) <= expected[way] for way in got)
    assert sum(len(got[way]) == expected[way] for way in got) > 0.9 * len(got)
    assert {way: len(path) for way, path in found(driver, "leak-paths").items()} == expected
    for name in PARENTS:
        of_category = {way for way in expected if name in VOCABULARY.hierarchy.overlaps[way[1]]}  # S7: or may be of it
        assert set(found(driver, "leak-paths-of-category", category=name)) == of_category


def made_up_labels(policy: Path) -> str:
    """A label for every node of a policy, by its place in the alphabet: all roles, three kinds of data."""
    roles = (
        "{source: [Video]}",
        "{leak: [Video]}",
        "{source: [Voice], leak: [Video]}",
        "{leak: [Voice], sanitizer: {Video: pseudonymise}}",
        "{derives: [{from: Video, to: FaceTemplate}], sanitizer: {Video: drop}}",
        "{leak: [Biometric]}",
        "conduit",
    )
    nodes = sorted({profile.node for profile in read_policy(str(policy)).profiles})
    lines = [f"  {json.dumps(node)}: {roles[i % len(roles)]}" for i, node in enumerate(nodes)]
    return "\n".join(["labels: 1", "nodes:", *lines, ""])


@pytest.mark.slow
@pytest.mark.corpus
def test_on_every_policy_of_the_corpus(driver: Driver, corpus: Path, tmp_path: Path) -> None:
    expected: dict[Way, int] = {}
    rows: list[RobotRows] = []
    for policy in sorted((corpus / "policies").rglob("*.xml")):
        try:
            text = made_up_labels(policy)
        except (InputErrors, NotAPolicyError):
            continue
        labels = tmp_path / "labels.yaml"
        labels.write_text(text, "utf-8")
        result = rosprivacy.analyze([str(policy)], [str(labels)])
        robot = f"p{len(rows):02}"
        rows.append(robot_rows(robot, result.analysis, result.bound, result.vocabulary))
        expected |= ways(result.analysis, robot)
    assert len(rows) == 24
    assert len(expected) > 100
    load(driver, rows, load_vocabulary())
    got = found(driver, "leak-paths-of-category", category="PersonalData")
    assert set(got) == set(expected)
    assert all(len(got[way]) <= expected[way] for way in got)


@pytest.mark.parametrize("case", one_in(4, CASES), ids=lambda path: str(path.name))
def test_on_the_examples(driver: Driver, case: Path, examples: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Shown way for way, but for the two sides of a wildcard, which are one element to the reader."""
    monkeypatch.chdir(examples)
    given = json.loads((case / "case.json").read_text("utf-8"))
    result = rosprivacy.analyze(given["policies"], given["labels"], **given.get("options", {}))
    load(driver, [robot_rows("r", result.analysis, result.bound, result.vocabulary)], result.vocabulary)
    shown = {
        ("r", f.category, f.source.name, f.leak.name): f
        for f in result.analysis.findings
        if f.kind == DISCLOSURE and not f.dismissed
    }
    got, stored = found(driver, "leak-paths-of-category", category="PersonalData"), found(driver, "leak-paths")
    assert set(got) == set(stored) == set(shown)
    for way, finding in shown.items():
        assert len([name for name, _ in groupby(got[way])]) == len(finding.witness)
        assert stored[way] == [element.name for element in finding.witness]
