"""What nodes declare of themselves, by the one ROS message for that, as it goes over the wire.

In: messages of type ``hri_privacy_msgs/msg/PersonalDataProcessor``. Out: ``Declared``.

Source: hri_privacy_msgs of ROS4HRI, four texts: ``data_source_node``, ``user_friendly_source_name``, ``data_purpose``,
``path``.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

TYPE = "hri_privacy_msgs/msg/PersonalDataProcessor"
DDS_TYPE = "hri_privacy_msgs::msg::dds_::PersonalDataProcessor_"
FIELDS = 4


@dataclass(frozen=True, slots=True, order=True)
class Declared:
    """One declaration.

    Attributes
    ----------
    topic
        On which it came.
    node, called
        From which the data stem, and how people are told of it.
    purpose, path
        What for, and the file in which they are kept; empty if it says none.
    """

    topic: str
    node: str
    called: str
    purpose: str
    path: str


def declared(topic: str, payload: bytes) -> Declared:
    r"""Read a message as it goes over the wire (CDR, OMG DDSI-RTPS clause 10).

    Raises
    ------
    ValueError
        If it is something else.

    >>> declared("/p", b"\0\1\0\0" + b"\3\0\0\0/a\0\0" + 3 * b"\1\0\0\0\0\0\0\0").node
    '/a'
    """
    order = {b"\0\0": ">", b"\0\1": "<"}.get(payload[:2])
    if order is None:
        raise ValueError("an encoding that is not plain CDR")
    body, at, texts = payload[4:], 0, []
    for _ in range(FIELDS):
        at += -at % 4
        if at + 4 > len(body):
            raise ValueError("cut off")
        (length,) = struct.unpack_from(f"{order}I", body, at)
        text = body[at + 4 : at + 4 + length]
        if length == 0 or len(text) < length or not text.endswith(b"\0"):
            raise ValueError("no text where one has to be")
        texts.append(text[:-1].decode(errors="replace"))
        at += 4 + length
    if len(body) - at >= FIELDS:
        raise ValueError("more than four texts")
    return Declared(topic, *texts)
