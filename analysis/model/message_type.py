"""Message types of channels: what is observed or stated of what is sent through them (rule S15)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model.diagnostic import Place
    from rosprivacy.analysis.model.element import Element

OF_KIND = {"topic": "msg", "service": "srv", "action": "action"}  # the middle of the name of a type, by kind of channel
TYPE, HASH = "type", "hash"  # first words of the texts that a pin keeps
WRITERS = {"": "writer", "request": "client", "response": "server"}  # who writes a topic, or a leg
PARAMETER_SERVICES = {  # that each node of ROS 2 has: the last part of the name -> the type
    "describe_parameters": "rcl_interfaces/srv/DescribeParameters",
    "get_parameter_types": "rcl_interfaces/srv/GetParameterTypes",
    "get_parameters": "rcl_interfaces/srv/GetParameters",
    "list_parameters": "rcl_interfaces/srv/ListParameters",
    "set_parameters": "rcl_interfaces/srv/SetParameters",
    "set_parameters_atomically": "rcl_interfaces/srv/SetParametersAtomically",
}
_NAME = re.compile(rf"[A-Za-z][A-Za-z0-9_]*/({'|'.join(OF_KIND.values())})/[A-Za-z][A-Za-z0-9_]*")


class MessageType(NamedTuple):
    """One type of what goes through a channel, or through a leg of one.

    Attributes
    ----------
    name
        ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``; what was observed stands here as it was seen.
    place
        Where it is stated.
    stated
        Whether a person states it for all writers of the channel.
    hash
        Of the type, such as ``RIHS01_…``; empty where it is not known.
    writers, readers
        Names of nodes that were seen with it, sorted; of a service who writes a leg is its client or its server.
    first, last
        When it was seen; empty where it is not known.
    robot
        Whose writers and readers these are.
    definition
        The file that defines it, where one was read.
    fields
        The known types that the fields of that definition are; none where a field can be anything.
    """

    name: str
    place: Place
    stated: bool = False
    hash: str = ""
    writers: tuple[str, ...] = ()
    readers: tuple[str, ...] = ()
    first: str = ""
    last: str = ""
    robot: str = ""
    definition: str = ""
    fields: tuple[str, ...] = ()

    def written_by(self, element: Element) -> bool:
        """Whether what an element of the graph sends to the channel is known to be of this type."""
        if element.robot != self.robot:
            return False
        return self.stated or (not element.is_channel and element.name in self.writers)


def kind_of_type(name: str) -> str:
    """Return the kind of channel that a type is for; empty if it is not the name of a type.

    >>> kind_of_type("sensor_msgs/msg/Image"), kind_of_type("std_srvs/srv/SetBool"), kind_of_type("Image")
    ('topic', 'service', '')
    """
    match = _NAME.fullmatch(name)
    return next(kind for kind, part in OF_KIND.items() if part == match[1]) if match else ""


def taken_with(types: Iterable[MessageType], writers: Iterable[str], leg: str) -> tuple[str, ...]:
    """Return types and writers of a channel, or of a leg of one, as the texts that a pin keeps, sorted.

    >>> from rosprivacy.analysis.model import Place
    >>> taken_with([MessageType("a/srv/A", Place("", 0), hash="RIHS01_1")], ["/a"], "request")
    ('client /a', 'hash a/srv/A RIHS01_1', 'type a/srv/A')
    """
    known = list(types)
    texts = {f"{TYPE} {one.name}" for one in known} | {f"{HASH} {one.name} {one.hash}" for one in known if one.hash}
    return tuple(sorted(texts | {f"{WRITERS[leg]} {name}" for name in writers}))
