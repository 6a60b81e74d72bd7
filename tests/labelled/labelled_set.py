"""The labelled set: systems as facts, what two readers said of their nodes, and the split (protocol.md).

In: ``systems.jsonl``, ``reader_a.jsonl`` and ``reader_b.jsonl``, one system a line. Out: ``System`` and ``Judged`` of
each, and how far the readers agree.
"""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.suggesting.evidence import ANYTHING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

HERE = Path(__file__).parent
# KINDS: what the protocol lets a reader say.
READERS = ("reader_a", "reader_b")
TUNED = (1, 2, 3, 4, 5, 6, 7, 8, 9)  # batches that rules may be tuned on, whole; each was measured once before
SOURCE, DERIVES, LEAK = "source", "derives", "leak"
KINDS = frozenset([
    "PersonImage", "DepthImage", "PersonPointCloud", "ThermalImage", "Voice", "SpeechTranscript", "VoiceCommand",
    "ConversationWithModel", "BodyPose", "Gesture", "FaceTemplate", "FacialExpression", "EmotionEstimate",
    "PersonDetection", "PersonTrack", "PersonIdentifier", "PersonName", "GnssPosition", "HomeMap", "LaserScan",
    "RobotPosition", "Trajectory", "OperatorInput", "LicencePlate", "VitalSign", "DocumentImage", "DeliveryOrder",
    "DeviceIdentifier", "InteractionLog", "Presence", "HouseholdObject", "SmartHomeSensorData",
])  # fmt: skip


class Pair(NamedTuple):
    """One statement about one node; ``kind`` is empty of a leak."""

    system: str
    node: str
    role: str
    kind: str


class System(NamedTuple):
    """One public system: what its nodes write and read, by name and type.

    Attributes
    ----------
    batch
        Each was collected and labelled by itself.
    nodes
        Name -> ``publishes``, ``subscribes``, ``serves``, ``calls`` -> name -> type; ``uses``: names of libraries.
    """

    name: str
    repository: str
    batch: int
    nodes: Mapping[str, Mapping[str, Any]]


class Judged(NamedTuple):
    """What both readers say, and what one of them says alone; kinds that cover each other agree."""

    agreed: frozenset[Pair]
    disputed: frozenset[Pair]


def systems() -> tuple[Sequence[System], Sequence[System]]:
    """Return those that rules may be tuned on, and those held out; each by batch, then by hash."""
    every = _every()
    return [one for one in every if one.batch in TUNED], [one for one in every if one.batch not in TUNED]


def labelled(some: Iterable[System]) -> Sequence[System]:
    """Return those that both readers answered for; a batch that was collected and not read yet has no answers."""
    return [one for one in some if all(one.name in answers(reader) for reader in READERS)]


def said(reader: str, some: Iterable[System]) -> frozenset[Pair]:
    """Return what a reader says of some systems."""
    return frozenset(pair for one in some for pair in _pairs(one, answers(reader)[one.name]))


def judged(some: Iterable[System], overlaps: Mapping[str, Collection[str]]) -> Judged:
    """Return what both readers say of some systems.

    Parameters
    ----------
    overlaps
        By kind: those that are the same, broader or narrower.
    """
    some = tuple(some)
    one, other = (said(reader, some) for reader in READERS)
    agreed = {pair for pair in one if met(pair, other, overlaps)} | {pair for pair in other if met(pair, one, overlaps)}
    return Judged(frozenset(agreed), frozenset((one | other) - agreed))


def met(pair: Pair, others: Iterable[Pair], overlaps: Mapping[str, Collection[str]]) -> bool:
    """Return whether one of some statements says the same, a broader or a narrower kind; the broadest says nothing."""
    near = {pair.kind, *overlaps.get(pair.kind, ())} - {ANYTHING} if pair.kind != ANYTHING else ()
    return any(pair[:3] == other[:3] and other.kind in near for other in others)


def kappa(some: Iterable[System]) -> float:
    """Return Cohen's kappa of the readers, over all nodes and all statements that occur anywhere."""
    some = tuple(some)
    one, other = (said(reader, some) for reader in READERS)
    statements = {(pair.role, pair.kind) for pair in one | other}
    cells = len(statements) * sum(len(system.nodes) for system in some)
    equal = (cells - len(one ^ other)) / cells
    by_chance = (len(one) * len(other) + (cells - len(one)) * (cells - len(other))) / cells**2
    return (equal - by_chance) / (1 - by_chance)


def _every() -> Sequence[System]:
    every = [System(one["system"], one["repository"], one["batch"], one["nodes"]) for one in _lines("systems")]
    return sorted(every, key=lambda one: (one.batch, hashlib.sha256(one.repository.encode()).hexdigest()))


@cache
def answers(reader: str) -> Mapping[str, Mapping[str, Any]]:
    """Return what a reader answered, by system and node."""
    return {one["system"]: one["nodes"] for one in _lines(reader)}


def _pairs(system: System, of_nodes: Mapping[str, Any]) -> Iterable[Pair]:
    assert set(of_nodes) == set(system.nodes), system.name
    for node, answer in of_nodes.items():
        for role in (SOURCE, DERIVES):
            assert set(answer[role]) <= KINDS, (system.name, node)
            yield from (Pair(system.name, node, role, kind) for kind in answer[role])
        if answer["leak"]:
            yield Pair(system.name, node, LEAK, "")


def _lines(name: str) -> Sequence[Any]:
    return [json.loads(line) for line in (HERE / f"{name}.jsonl").read_text("utf-8").splitlines()]
