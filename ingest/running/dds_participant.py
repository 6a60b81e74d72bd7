"""A participant of ours in a DDS domain: it reads what discovery tells, and writes nothing.

In: the domain. Out: a ``DdsGraph`` that is kept up to date. It reads the built-in topics, ``ros_discovery_info``, and
of all other topics only those on which nodes declare how they process personal data. In ``ros_discovery_info`` nodes
say which endpoints they have, by GIDs of 24 bytes up to Humble and of 16 from Iron on (rmw_dds_common 2.0.0). Read with
the wrong length, the list is empty without an error: both are read.

No future annotations here: Cyclone looks at the types of what it reads, which are values to it and no types to mypy.

Source: rmw_dds_common, ``ParticipantEntitiesInfo.msg``; bytes on the wire are those of ``uint8``.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Any

from cyclonedds.builtin import (
    BuiltinDataReader,
    BuiltinTopicDcpsParticipant,
    BuiltinTopicDcpsPublication,
    BuiltinTopicDcpsSubscription,
)
from cyclonedds.core import DDSException, Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, bounded_str, sequence, uint8
from cyclonedds.internal import load_cyclonedds
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from rosprivacy.analysis.errors import MiddlewareError
from rosprivacy.ingest.running.dds_graph import PREFIX, DdsEndpoint, DdsGraph, DdsNode, DdsParticipant
from rosprivacy.ingest.running.observation import DDS_TYPE, Declared
from rosprivacy.ingest.running.observed_names import NODES_TOPIC, ros_channel, user_data

GID_BYTES = (16, 24)
MOST_SAMPLES = 10_000
FATAL_AND_ERROR = 3
"""Of Cyclone's own messages on standard error; what was read with the wrong length is a warning for each sample."""
_LATE_JOINER_QOS = Qos(
    Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal, Policy.History.KeepAll
)


def participant_entities(gid_bytes: int) -> Any:
    """Return the class; 24 bytes up to Humble, 16 from Iron on."""

    @dataclass
    @final
    class Gid(IdlStruct, typename="rmw_dds_common::msg::dds_::Gid_"):
        data: array[uint8, gid_bytes]  # type: ignore[type-arg,valid-type]

    @dataclass
    @final
    class NodeEntities(IdlStruct, typename="rmw_dds_common::msg::dds_::NodeEntitiesInfo_"):
        node_namespace: bounded_str[256]  # type: ignore[type-arg,valid-type]
        node_name: bounded_str[256]  # type: ignore[type-arg,valid-type]
        reader_gid_seq: sequence[Gid]  # type: ignore[type-arg]
        writer_gid_seq: sequence[Gid]  # type: ignore[type-arg]

    @dataclass
    @final
    class ParticipantEntities(IdlStruct, typename="rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"):
        gid: Gid
        node_entities_info_seq: sequence[NodeEntities]  # type: ignore[type-arg]

    return ParticipantEntities


@dataclass
@final
class PersonalDataProcessor(IdlStruct, typename=DDS_TYPE):
    """What nodes declare of themselves."""

    data_source_node: str
    user_friendly_source_name: str
    data_purpose: str
    path: str


@dataclass(slots=True)
class Readers:
    """The readers of a participant of ours."""

    participant: DomainParticipant
    own: bytes
    participants: Any
    writers: Any
    readers: Any
    nodes: tuple[Any, ...]
    declarations: dict[str, Any] = field(default_factory=dict)

    def take(self, graph: DdsGraph, now: str) -> bool:
        """Bring a graph up to date; return whether anything changed."""
        changes = self._participants(graph, now), self._endpoints(graph, now), self._nodes(graph, now)
        return any([*chain(*changes), *self._declared(graph)])

    def _participants(self, graph: DdsGraph, now: str) -> Iterator[bool]:
        for sample in self.participants.take(N=MOST_SAMPLES):
            guid = sample.key.bytes
            if guid[:PREFIX] == self.own:
                continue
            if sample.sample_info.valid_data:
                enclave = user_data(_user_data(sample.qos)).get("enclave", "")
                graph.participants[guid[:PREFIX]] = DdsParticipant(guid, enclave, now)
            else:
                graph.without(guid[:PREFIX])
            yield True

    def _endpoints(self, graph: DdsGraph, now: str) -> Iterator[bool]:
        for reader, writes in ((self.writers, True), (self.readers, False)):
            for sample in reader.take(N=MOST_SAMPLES):
                guid = sample.key.bytes
                if guid[:PREFIX] == self.own:
                    continue
                if sample.sample_info.valid_data:
                    digest = user_data(_user_data(sample.qos)).get("typehash", "")
                    since = graph.endpoints[guid].since if guid in graph.endpoints else now
                    graph.endpoints[guid] = DdsEndpoint(
                        guid, writes, sample.topic_name, sample.type_name, digest, since
                    )
                else:
                    graph.endpoints.pop(guid, None)
                yield True

    def _nodes(self, graph: DdsGraph, now: str) -> Iterator[bool]:
        for reader in self.nodes:
            for sample in reader.take(N=MOST_SAMPLES):
                if not sample.sample_info.valid_data:
                    continue
                participant = bytes(sample.gid.data[:PREFIX])
                nodes = tuple(_node(participant, info, now) for info in sample.node_entities_info_seq)
                # Read with the wrong length, the list of nodes is empty.
                if nodes or participant not in graph.nodes:
                    graph.nodes[participant] = _since_before(nodes, graph.nodes.get(participant, ()))
                    yield True

    def _declared(self, graph: DdsGraph) -> Iterator[bool]:
        for one in graph.endpoints.values():
            channel = ros_channel(one.topic, one.writes) if one.type == DDS_TYPE and one.writes else None
            if channel and channel[1] not in self.declarations:
                topic = Topic(self.participant, one.topic, PersonalDataProcessor)
                self.declarations[channel[1]] = DataReader(self.participant, topic, qos=_LATE_JOINER_QOS)
        for name, reader in self.declarations.items():
            for sample in reader.take(N=MOST_SAMPLES):
                if sample.sample_info.valid_data:
                    texts = sample.data_source_node, sample.user_friendly_source_name, sample.data_purpose, sample.path
                    graph.declared.add(Declared(name, *texts))
                    yield True


def _node(participant: bytes, info: Any, now: str) -> DdsNode:
    gids = (*info.reader_gid_seq, *info.writer_gid_seq)
    name = f"{info.node_namespace.rstrip('/')}/{info.node_name}"
    return DdsNode(participant, name, tuple(bytes(gid.data[:16]) for gid in gids), now)


def _since_before(nodes: tuple[DdsNode, ...], before: tuple[DdsNode, ...]) -> tuple[DdsNode, ...]:
    """A participant tells all of its nodes again when one comes; the others were there before."""
    since = {node.name: node.since for node in before}
    return tuple(replace(node, since=since.get(node.name, node.since)) for node in nodes)


def _user_data(qos: Any) -> bytes:
    return bytes(qos[Policy.Userdata].data) if Policy.Userdata in qos else b""


@contextmanager
def joined(domain: int, settings: str) -> Iterator[Readers]:
    """Join a domain for a while; ``MiddlewareError`` if that fails."""
    try:
        load_cyclonedds().dds_set_log_mask(FATAL_AND_ERROR)
        configured = Domain(domain, settings)
        participant = DomainParticipant(domain)
        topics = [
            Topic(participant, NODES_TOPIC, participant_entities(length), qos=_LATE_JOINER_QOS) for length in GID_BYTES
        ]
        yield Readers(
            participant,
            participant.guid.bytes[:PREFIX],
            BuiltinDataReader(participant, BuiltinTopicDcpsParticipant),
            BuiltinDataReader(participant, BuiltinTopicDcpsPublication),
            BuiltinDataReader(participant, BuiltinTopicDcpsSubscription),
            tuple(DataReader(participant, topic, qos=_LATE_JOINER_QOS) for topic in topics),
        )
        del participant, configured
    except DDSException as error:
        raise MiddlewareError(f"DDS domain {domain} cannot be joined: {error}") from error
