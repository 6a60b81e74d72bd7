"""The types that are read: that of ``ros_discovery_info`` for both lengths of GIDs, and that of declarations.

In: the length. Out: a class that Cyclone reads samples into. No future annotations here: Cyclone looks at the types,
which are values to it and no types to mypy.

Source: rmw_dds_common, ``ParticipantEntitiesInfo.msg``; bytes on the wire are those of ``uint8``.
"""

from dataclasses import dataclass
from typing import Any

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import array, bounded_str, sequence, uint8

from rosprivacy.ingest.observe.declared import DDS_TYPE


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
