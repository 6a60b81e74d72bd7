"""Fleets of which each robot is wired at random, with the labels that cost most: what each robot costs, as they grow.

Each robot has nodes that read and write topics of its own choice, some by wildcards; sanitizers, derivations and
sources at nodes, and no label at most of them; and a cloud that hears from each robot and sends to each, so that data
of one gets to all others.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from fleet_robots import answered, everything
from measure import Row, calls_per_robot, per_robot, side_by_side
from turtlebot import chosen_categories

from rosprivacy.answering import answer
from rosprivacy.ingest.neo4j_graph.fleet_rows import MOST_ACROSS
from rosprivacy.ontology.vocabulary import load
from rosprivacy.systems.fleet_system import fleet_system, rows_of_fleet

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from measure import Measured

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows
    from rosprivacy.ontology.vocabulary import Vocabulary

BOUND = 1.3
SIZES, QUICK = (1_000, 100), (400, 100)  # robots
LARGE = (4_000, 1_000)
LOADED = (1_000, 200), (400, 150)  # of fewer, all pairs of robots are written
NODES, AREAS, PER_AREA = 24, 6, 8  # of a robot: nodes, and topics in areas, which wildcards name
LABELS = {
    "/camera": {"source": ["Video"]},
    "/microphone": {"source": ["Voice"]},
    "/base": {"source": ["Location"]},
    "/blur": {"sanitizer": {"Video": "anonymise"}},
    "/mask": {"sanitizer": {"Voice": "pseudonymise", "Location": "aggregate"}},
    "/faces": {"derives": [{"from": "Video", "to": "FaceTemplate"}]},
    "/words": {"derives": [{"from": "Voice", "to": "SpeechTranscript"}]},
    "/uplink": {"leak": ["Voice", "FaceTemplate"]},
    "/recorder": {"leak": ["Location"]},
    "/planner": "conduit",
}
SHARED = {
    "elements": {
        "cloud": {"kind": "external-system", "country": "US"},
        "archive": {"kind": "storage", "country": "DE", "retention": "P30D"},
    },
    "flows": [
        {"from": "*:/uplink", "to": "cloud"},
        {"from": "cloud", "to": "*:/planner"},
        {"from": "*:/recorder", "to": "archive"},
    ],
}


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    known, sizes = load(), QUICK if quick else SIZES
    with TemporaryDirectory() as name:
        folder = Path(name)

        def row(what: str, work: Callable[[str, Vocabulary], object], sizes: tuple[int, int], kinds: int = 3) -> Row:
            of_kinds = f", {kinds} kinds" if kinds > 3 else ""
            return Row(
                f"per robot, fleet file to {what}: {sizes[0]:,} wired at random{of_kinds}",
                f"{sizes[1]:,}",
                lambda: _measured(folder, lambda file: work(file, known), sizes, kinds, quick=quick),
                BOUND,
                counts=quick,
            )

        yield row("report", answered, sizes)
        yield row("rows of the database", rows_loaded, LOADED[quick])
        if not quick:
            yield row("page", page, sizes)
            yield row("report", answered, sizes, 24)
            yield row("report", answered, LARGE)


def _measured(
    folder: Path, work: Callable[[str], object], sizes: tuple[int, int], kinds: int, *, quick: bool
) -> Measured:
    large, small = (fleet(folder, robots, kinds) for robots in sizes)
    note = f"{NODES + AREAS * PER_AREA} elements each, few of them with a label, and a cloud that joins all"
    works = (lambda: work(large)), (lambda: work(small))
    if quick:
        return replace(calls_per_robot(*works, sizes), note=note)
    return per_robot(side_by_side(3, *works), sizes, note)


def page(file: str, known: Vocabulary) -> str:
    """Read a fleet, analyse it, and make the page for people."""
    question = everything(known)
    return answer(fleet_system(file, question), question).to("html")


def rows_loaded(file: str, known: Vocabulary) -> int:
    """Read a fleet, analyse it, and make all that ``load`` writes; return how many rows that is."""
    return sum(robot.size for robot in loaded(file, known))


def loaded(file: str, known: Vocabulary) -> Iterable[RobotRows]:
    """Read a fleet, analyse it, and return all that ``load`` writes."""
    question = everything(known)._replace(every=True, most_across=MOST_ACROSS)
    system = fleet_system(file, question)
    return rows_of_fleet(system, question, answer(system, question))


def fleet(folder: Path, robots: int, kinds: int = 3) -> str:
    """Write a fleet of so many robots, each with a policy of its own; return the name of its file."""
    labels = f"labels{kinds}.json"
    (folder / labels).write_text(json.dumps({"labels": 1, "nodes": labels_of(kinds)}), "utf-8")
    members = {}
    for number in range(robots):
        (folder / f"{number}.xml").write_text(policy(Random(number)), "utf-8")  # noqa: S311 - repeatable
        members[f"r{number:04}"] = {"policies": f"{number}.xml", "labels": labels}
    file = folder / f"{robots}of{kinds}.json"
    file.write_text(json.dumps({"fleet": 1, "robots": members, **SHARED}), "utf-8")
    return str(file)


def labels_of(kinds: int) -> dict[str, object]:
    """Return what is said of nodes; beyond three kinds, each is brought in by a node that had no label."""
    names, _ = chosen_categories(kinds + len(LABELS))
    known = json.dumps(LABELS)
    more = [name for name in names if f'"{name}"' not in known][: kinds - 3]
    brought: dict[str, list[str]] = {}
    for number, name in enumerate(more):
        brought.setdefault(f"/part{number % (NODES - len(LABELS))}", []).append(name)
    leaks = {"leak": ["Voice", "FaceTemplate", *more]}
    return {**LABELS, "/uplink": leaks, **{node: {"source": some} for node, some in brought.items()}}


def policy(random: Random) -> str:
    """Return the policy of a robot."""
    nodes = [*(name.strip("/") for name in LABELS), *(f"part{i}" for i in range(NODES - len(LABELS)))]
    profiles = "".join(_profile(node, random) for node in nodes)
    enclave = f'<enclave path="/robot"><profiles>{profiles}</profiles></enclave>'
    return f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>'


def _profile(node: str, random: Random) -> str:
    topics = [f"/area{area}/t{number}" for area in range(AREAS) for number in range(PER_AREA)]
    some = {
        "publish": random.sample(topics, random.randint(1, 3)),
        "subscribe": random.sample(topics, random.randint(2, 6)),
    }
    if random.random() < 1 / 8:
        some["subscribe"].append(f"/area{random.randrange(AREAS)}/*")
    if random.random() < 1 / 16:
        some["publish"].append(f"/*/t{random.randrange(PER_AREA)}")
    lines = (
        f'<topics {role}="ALLOW">{"".join(f"<topic>{name}</topic>" for name in names)}</topics>'
        for role, names in some.items()
    )
    return f'<profile ns="/" node="{node}">{"".join(lines)}</profile>'
