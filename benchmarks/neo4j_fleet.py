"""A fleet for the database's benchmark: robots of a few models, 80 elements and 180 flows each, 24 kinds of data."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.findings import analyse
from rosprivacy.analysis.model import (
    Bound,
    Category,
    Element,
    Flow,
    FlowGraph,
    Grant,
    Legal,
    Method,
    Place,
    Profile,
    Statement,
)
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.ontology.vocabulary import Vocabulary

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

ROBOTS, MODELS, NODES, TOPICS, FLOWS, KINDS = 1000, 10, 30, 50, 180, 24
DERIVED = 8  # one in so many kinds is made into another somewhere
READ = 0.3  # of the other flows so many are written, the rest read
NAMES = tuple(f"Kind{number:02}" for number in range(KINDS))
BROADER = ("PersonalData", "Biometric", "Location")
LAW = (Legal("urn:bench:law", "GDPR Art. 9(1)", "some data are special", "2026-01-01", "conditional", "sometimes"),)
VOCABULARY = Vocabulary.of(
    [
        Category("PersonalData", "urn:bench:PersonalData", "PersonalData", "all", "all"),
        Category("Biometric", "urn:bench:Biometric", "Biometric", "some", "some", ("PersonalData",), law=LAW),
        Category("Location", "urn:bench:Location", "Location", "some", "some", ("PersonalData",)),
        *(
            Category(n, f"urn:bench:{n}", n, n, n, (BROADER[i % 3],), data_types=(("video", "audio")[i % 2],))
            for i, n in enumerate(NAMES)
        ),
    ]
)


def fleet(robots: int = ROBOTS) -> Iterator[RobotRows]:
    """The rows of some robots; each model is analysed once."""
    models = [model(number) for number in range(MODELS)]
    for number in range(robots):
        analysis, bound = models[number % MODELS]
        yield robot_rows(f"robot{number:04}", analysis, bound, VOCABULARY)


def model(number: int) -> tuple[Analysis, Bound]:
    """One robot: every kind has a source, a leak and a sanitizer, some are made into others."""
    some = random.Random(number)  # noqa: S311 - the same each time
    nodes = [Element("node", f"/part{i:02}/node_of_model_{number}") for i in range(NODES)]
    topics = [Element("topic", f"/part{i % NODES:02}/topic_{i:02}_of_model_{number}") for i in range(TOPICS)]
    elements = tuple(sorted([*nodes, *topics], key=Element.sort_key))
    index = {element: i for i, element in enumerate(elements)}
    ends: set[tuple[int, int]] = set()
    for topic in topics:  # each is written and read
        ends |= {(index[some.choice(nodes)], index[topic]), (index[topic], index[some.choice(nodes)])}
    while len(ends) < FLOWS:
        writer, written = index[some.choice(nodes)], index[some.choice(topics)]
        ends.add((writer, written) if some.random() < READ else (written, writer))
    flows = tuple(_flow(source, target, elements, line) for line, (source, target) in enumerate(sorted(ends)))
    profiles = tuple(
        Profile(f"/enclave{i % 6}", node.name, Place("fleet.policy.xml", i)) for i, node in enumerate(nodes)
    )
    said: dict[int, list[Statement]] = {}
    for i, name in enumerate(NAMES):
        four = some.sample(range(NODES), 4)
        method = (Method.ANONYMISE, Method.PSEUDONYMISE)[i % 2]
        statements = (
            Statement("source", (name,), (1, 9), Place("fleet.labels.yaml", i)),
            Statement("leak", (name,), (1, 9), Place("fleet.labels.yaml", i)),
            Statement("sanitizer", (name,), (1, 9), Place("fleet.labels.yaml", i), method),
            Statement("derivation", (name,), (1, 9), Place("fleet.labels.yaml", i), to=NAMES[i - 1]),
        )
        for node, statement in zip(four, statements if i % DERIVED == 0 else statements[:3], strict=False):
            said.setdefault(node, []).append(statement)
    bound = Bound({vertex: tuple(statements) for vertex, statements in sorted(said.items())})
    graph = FlowGraph(elements, flows, (), tuple(sorted(profiles, key=lambda p: (p.enclave, p.node))))
    return analyse(graph, bound, VOCABULARY.hierarchy), bound


def _flow(source: int, target: int, elements: tuple[Element, ...], line: int) -> Flow:
    role = "publish" if elements[source].is_node else "subscribe"
    node, topic = (source, target) if elements[source].is_node else (target, source)
    place = Place("fleet.policy.xml", line)
    names = elements[topic].name, elements[node].name
    grant = Grant(True, role, "topic", names[0], "/enclave", names[1], place)
    return Flow(source, target, role, (grant,))
