"""Fleets of which each robot is wired at random, with the labels that cost most: what each robot costs, as they grow.

Each robot has nodes that read and write topics of its own choice, some by wildcards; sanitizers, derivations and
sources at nodes, and no label at most of them; and a cloud that hears from each robot and sends to each, so that data
of one gets to all others.
"""

from __future__ import annotations

import json
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from fleet_robots import each_of
from measure import Row

from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterator

    from measure import Measured

    from rosprivacy.ontology.vocabulary import Vocabulary

BOUND = 1.3
SIZES, QUICK = (1_000, 100), (400, 100)  # robots
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
    what = f"per robot, fleet file to report: {sizes[0]:,} wired at random"
    yield Row(what, f"{sizes[1]}", lambda: _measured(known, sizes, quick=quick), BOUND, counts=quick)


def _measured(known: Vocabulary, sizes: tuple[int, int], *, quick: bool) -> Measured:
    with TemporaryDirectory() as name:
        large, small = (fleet(Path(name), robots) for robots in sizes)
        note = f"{NODES + AREAS * PER_AREA} elements each, few of them with a label, and a cloud that joins all"
        return each_of((large, small), known, sizes, note, quick=quick)


def fleet(folder: Path, robots: int) -> str:
    """Write a fleet of so many robots, each with a policy of its own; return the name of its file."""
    (folder / "l.json").write_text(json.dumps({"labels": 1, "nodes": LABELS}), "utf-8")
    members = {}
    for number in range(robots):
        (folder / f"{number}.xml").write_text(policy(Random(number)), "utf-8")  # noqa: S311 - repeatable
        members[f"r{number:04}"] = {"policies": f"{number}.xml", "labels": "l.json"}
    file = folder / f"{robots}.json"
    file.write_text(json.dumps({"fleet": 1, "robots": members, **SHARED}), "utf-8")
    return str(file)


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
