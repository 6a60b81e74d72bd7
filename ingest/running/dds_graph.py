"""What a DDS participant is told of a domain -> an observation (rule S16).

In: participants, their endpoints, and which nodes they say these are of. Out: ``Observation``. A participant speaks for
its own endpoints only: what it claims of another's is told, and believed of nobody.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.policies.observed_metadata import HIDDEN, REFUSED
from rosprivacy.ingest.running.observation import Observation, ObservedEndpoint, ObservedNode, Span
from rosprivacy.ingest.running.observed_names import NODES_TOPIC, ros_channel, ros_type

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.running.observation import Declared

DOOR = "dds"
PREFIX = 12
"""Bytes of a GUID that say which participant an entity is of (RTPS, clause 9.3.1)."""
SECURED = (
    "participants that show none of their endpoints: {number}; the domain looks secured, or they came just now; "
    "use `ros2 node info` in an enclave (--text), or analyse the policy"
)


@dataclass(frozen=True, slots=True)
class DdsEndpoint:
    """A writer or reader, as discovery tells it."""

    guid: bytes
    writes: bool
    topic: str
    type: str
    hash: str
    since: str

    @property
    def participant(self) -> bytes:
        """The part of the GUID that all of a participant's entities have."""
        return self.guid[:PREFIX]


@dataclass(frozen=True, slots=True)
class DdsParticipant:
    """A participant, with the enclave that it names; empty if it names none."""

    guid: bytes
    enclave: str
    since: str


@dataclass(frozen=True, slots=True)
class DdsNode:
    """A node that a participant says it has, with the GUIDs of its endpoints."""

    participant: bytes
    name: str
    guids: tuple[bytes, ...]
    since: str


@dataclass(slots=True)
class DdsGraph:
    """What is there now; entries come and go as discovery says.

    Attributes
    ----------
    participants, nodes
        By the first twelve bytes of the participant's GUID.
    endpoints
        By GUID.
    declared
        What nodes have said of themselves so far.
    """

    participants: dict[bytes, DdsParticipant] = field(default_factory=dict)
    endpoints: dict[bytes, DdsEndpoint] = field(default_factory=dict)
    nodes: dict[bytes, tuple[DdsNode, ...]] = field(default_factory=dict)
    declared: set[Declared] = field(default_factory=set)

    def without(self, participant: bytes) -> None:
        """Forget a participant that has left, with all that it had."""
        self.participants.pop(participant, None)
        self.nodes.pop(participant, None)
        for guid in [guid for guid in self.endpoints if guid[:PREFIX] == participant]:
            del self.endpoints[guid]


def observation(graph: DdsGraph, since: str, now: str, domain: int, patience: str = "") -> Observation:
    """Return what is there as an observation.

    Parameters
    ----------
    since, now
        When somebody began to look, and this moment.
    patience
        Endpoints of no node that came after this moment are not told yet: which node they are of is said later than
        that they are there. Empty: all are told.
    """
    nodes = [node for of in graph.nodes.values() for node in of]
    remarks: list[str] = []
    owned: dict[bytes, set[str]] = {}
    hidden: set[bytes] = set()
    for node in nodes:
        for guid in node.guids:
            if guid[:PREFIX] != node.participant:
                remarks.append(f"{shown(node.name)} claims an endpoint of another participant: not believed")
            elif guid not in graph.endpoints:
                hidden.add(node.participant)
            else:
                owned.setdefault(guid, set()).add(node.name)
    claims = len(remarks)
    hidden |= graph.participants.keys() - {endpoint.participant for endpoint in graph.endpoints.values()}
    strange = sorted({one.topic for one in graph.endpoints.values() if _is_strange(one)})
    remarks += [f"left out: the DDS topic {shown(repr(topic))} is no channel of ROS" for topic in strange]
    remarks += [SECURED.format(number=len(hidden))] if hidden else []
    return Observation(
        (DOOR,),
        Span(since, now),
        tuple(ObservedNode(node.name, Span(node.since, now), _enclave(graph, node)) for node in nodes),
        tuple(_endpoints(graph, owned, now, patience)),
        (domain,),
        {gap: number for gap, number in ((HIDDEN, len(hidden)), (REFUSED, claims + len(strange))) if number},
        tuple(sorted(set(remarks))),
        tuple(sorted(graph.declared)),
    )


def _is_strange(endpoint: DdsEndpoint) -> bool:
    return endpoint.topic != NODES_TOPIC and ros_channel(endpoint.topic, endpoint.writes) is None


def _enclave(graph: DdsGraph, node: DdsNode) -> str:
    participant = graph.participants.get(node.participant)
    return participant.enclave if participant else ""


def _endpoints(graph: DdsGraph, owned: dict[bytes, set[str]], now: str, patience: str) -> Iterator[ObservedEndpoint]:
    for guid, one in graph.endpoints.items():
        channel = ros_channel(one.topic, one.writes)
        if channel is None or (guid not in owned and patience and one.since > patience):
            continue
        kind = ros_type(one.type)
        for node in sorted(owned.get(guid, {""})):
            stranger = "" if node else one.participant.hex()
            yield ObservedEndpoint(
                node, *channel, Span(one.since, now), kind, one.hash if kind else "", guid.hex(), stranger, (DOOR,)
            )
