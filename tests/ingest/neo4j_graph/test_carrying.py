"""A path over CARRIES_… from a source to a leak is there if, and only if, the data gets there (rules S7, S8, S10).

The naive query is walked here as Neo4j would: from each element with the label ``…Source``, along relationships of one
type, to each with the label ``…Leak``. ``tests/queries/test_cypher.py`` asks Neo4j itself.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.model import DISCLOSURE, Method
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.ingest.neo4j_graph.ids import carries, category_labels, element_id
from tests.helpers.more_systems import ranked, wildcards
from tests.helpers.random_rows import VOCABULARY
from tests.helpers.systems import System, statement, systems

if TYPE_CHECKING:
    from rosprivacy.analysis.model import Statement
    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

Pair = tuple[str, str, str]  # category, ids of source and leak
LABELS = category_labels(VOCABULARY)


def naive(rows: RobotRows, stem: str) -> set[tuple[str, str]]:
    """(s, l) of ``(s:…Source)-[:CARRIES_…*1..]->(l:…Leak)``."""
    labels = {row["id"]: row["labels"] for row in (*rows.elements, *rows.intakes)}
    after = defaultdict(set)
    for row in rows.carried:
        if carries(stem) in row["types"]:
            after[row["source"]].add(row["target"])
    pairs = set()
    for source in (key for key, said in labels.items() if f"{stem}Source" in said):
        reached, new = set[str](), set(after[source])
        while new:
            reached |= new
            new = {key for at in new for key in after[at]} - reached
        pairs |= {(source, key) for key in reached if f"{stem}Leak" in labels[key]}
    return pairs


def expanded(rows: RobotRows, name: str) -> set[Pair]:
    """The pairs of the naive query; for what a node makes, with the sources that it makes it of.

    Where a node makes what also arrives there ready-made from that source, no origin is told; the data is found as
    what arrives.
    """
    begins = {row["id"] for row in rows.elements if name in row["properties"]["begins"]}
    makes = {row["source"] for row in rows.flows if name in (row["properties"].get("made") or ())}
    derives = {
        row["source"] for row in rows.roles.get("derivation", ()) if row["target"] == VOCABULARY.categories[name].iri
    }
    makes |= derives & {
        row["source"] for row in rows.carried if row["source"] == row["target"]
    }  # it lets it out itself
    origins = defaultdict(set)
    for row in rows.derived:
        if row["properties"]["category"] == name:
            origins[row["source"]].add(row["target"])
    element = {row["id"]: row["id"].removesuffix("|intake") for row in (*rows.elements, *rows.intakes)}
    pairs = set()
    for start, leak in naive(rows, LABELS[name]):
        sources = origins[element[start]] | ({start} & begins)
        if not sources and element[start] not in makes:
            sources = {f"nothing begins at {start}"}
        pairs |= {(name, source, element[leak]) for source in sources}
    return pairs


def shown(system: System) -> tuple[set[Pair], RobotRows]:
    """What memory finds; the rows."""
    analysis = system.analyse()
    found = (f for f in analysis.findings if f.kind == DISCLOSURE)
    pairs = {(f.category, element_id("r", f.source), element_id("r", f.leak)) for f in found}
    return pairs, robot_rows("r", analysis, system.bound(), VOCABULARY)


@given(st.one_of(systems(), wildcards(), ranked()))
@settings(max_examples=settings().max_examples * 3 // 2)
def test_the_naive_query_finds_what_memory_finds(system: System) -> None:
    try:
        expected, rows = shown(system)
    except InputErrors:
        return
    assert {pair for name in VOCABULARY.categories for pair in expanded(rows, name)} == expected


def test_labels_that_contradict_each_other_make_no_leak_of_another_kind() -> None:
    """Of Track, that nobody brings in, a conduit and a sanitizer say different things; the leak is of Face."""
    said = [statement("leak", "Face"), statement("conduit", "Loc"), statement("sanitizer", "Bio", method=Method.DROP)]
    system = System(2, 0, [(0, 1)], {0: [statement("source", "Face")], 1: said}, {})
    _, rows = shown(system)
    assert [label for label in rows.elements[1]["labels"] if label.endswith("Leak")] == [
        "TestAnyLeak", "TestBioLeak", "TestFaceLeak",
    ]  # fmt: skip


SOURCE, LEAK = statement("source", "Face"), statement("leak", "Face")
ONE_CHANNEL = SOURCE._replace(through=("/t1",))
DROPS, MAKES = statement("sanitizer", "Face", method=Method.DROP), statement("derivation", "Loc", to="Face")
PLACE, LEAK_OF_BIO = statement("source", "Loc"), statement("leak", "Bio")


@pytest.mark.parametrize(
    ("middle", "last", "intake", "expected"),
    [
        # What comes to /n1 ends there, and it makes the same anew.
        ([DROPS, MAKES], [LEAK], {"Face": []}, {("Face", 0, 2)}),
        ([DROPS, MAKES, LEAK], [LEAK], {"Face": ["TestFaceLeak"]}, {("Face", 0, 1), ("Face", 3, 1), ("Face", 0, 2)}),
        # It brings in through one channel, and passes what comes through both.
        ([ONE_CHANNEL], [LEAK], {"Face": []}, {("Face", 3, 2)}),
        ([ONE_CHANNEL, LEAK], [LEAK], {"Face": ["TestFaceLeak"]}, {("Face", 1, 1), ("Face", 3, 1), ("Face", 3, 2)}),
        # It makes the same kind, too, and sends that everywhere.
        (
            [ONE_CHANNEL, MAKES, LEAK],
            [LEAK],
            {"Face": ["TestFaceSource", "TestFaceLeak"]},
            {("Face", 0, 1), ("Face", 1, 1), ("Face", 3, 1), ("Face", 0, 2), ("Face", 3, 2)},
        ),
        # It brings in a narrower kind than what it passes, and has the label of both.
        ([statement("source", "Track")], [LEAK_OF_BIO], {"Bio": []}, {("Track", 1, 2), ("Face", 3, 2), ("Bio", 4, 2)}),
    ],
)
def test_where_what_comes_goes_another_way_than_what_begins(
    middle: list[Statement], last: list[Statement], intake: dict[str, list[str]], expected: set[tuple[str, int, int]]
) -> None:
    """/n0 (place), /n3 (face) and /n4 (a broader kind) bring to /n1 what gets on to the leak /n2, not through /t1."""
    edges = [(0, 5), (5, 1), (1, 6), (1, 7), (7, 2), (3, 8), (8, 1), (4, 9), (9, 1)]
    said = {0: [PLACE], 1: middle, 2: last, 3: [SOURCE], 4: [statement("source", "Bio")] if "Bio" in intake else []}
    found, rows = shown(System(5, 5, edges, said, {}))
    kinds = {name for name in ("Face", "Track", "Bio") if name in {*intake, *(kind for kind, _, _ in expected)}}
    pairs = {(kind, f"r|node|/n{a}", f"r|node|/n{b}") for kind, a, b in expected}
    assert {pair for pair in found if pair[0] in kinds} == pairs
    assert {pair for name in VOCABULARY.categories for pair in expanded(rows, name)} == found
    labels = [label for said in intake.values() for label in said]
    assert [(row["id"], row["labels"]) for row in rows.intakes] == [("r|node|/n1|intake", ["Intake", *labels])]


def test_plain_nodes_have_no_intake() -> None:
    """A source that passes what others bring, and a sanitizer: an element is enough there."""
    edges = [(0, 3), (3, 1), (1, 4), (4, 2)]
    for middle in ([SOURCE], [SOURCE, LEAK], [DROPS], [MAKES]):
        _, rows = shown(System(3, 2, edges, {0: [SOURCE, PLACE], 1: middle, 2: [LEAK]}, {}))
        assert rows.intakes == []
