"""What nodes declare of themselves, by the one ROS message for that -> a label file, as their own word.

In: messages of type ``hri_privacy_msgs/msg/PersonalDataProcessor``. Out: YAML. A declaration names a node from which
personal data stem, what for, and perhaps the file that they are kept in; it names no kind of data, so the source is one
of ``PersonalData``. It is read only where ``--labels`` names it: a person takes it over, or does not.

Source: hri_privacy_msgs of ROS4HRI, four texts: ``data_source_node``, ``user_friendly_source_name``, ``data_purpose``,
``path``.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from io import StringIO
from typing import TYPE_CHECKING

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap

from rosprivacy.ingest.labels.non_ros_reader import LONGEST
from rosprivacy.ingest.observe.observed_names import is_name

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ingest.observe.observation import Span

TYPE = "hri_privacy_msgs/msg/PersonalDataProcessor"
DDS_TYPE = "hri_privacy_msgs::msg::dds_::PersonalDataProcessor_"
FIELDS = 4
ANY_KIND = "PersonalData"
HEAD = """\
# What nodes declared of themselves ({type}), seen from {first} to {last}.
# It is their own word: nobody has checked it, and it names no kind of data. Review it, name the kinds, give it with -l.
"""


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


def declared_labels(several: Iterable[Declared], seen: Span) -> str:
    """Return a label file; empty if nothing that is declared can be said in one."""
    nodes: dict[str, CommentedMap] = {}
    elements: dict[str, CommentedMap] = {}
    flows: set[tuple[str, str]] = set()
    for one in sorted(set(several)):
        if not is_name(one.node):
            continue
        facts = nodes.setdefault(one.node, CommentedMap(source=[ANY_KIND], author=f"{one.node} itself"))
        called, purpose = _plain(one.called), _plain(one.purpose)
        _say(facts, "note", f"declared on {one.topic}" + (f": {called}" if called else ""))
        if purpose:
            purposes = facts.setdefault("purpose", [])
            purposes += [purpose] if purpose not in purposes else []
        if one.path:
            name = _element(one.path)
            elements.setdefault(name, CommentedMap(kind="storage", author=f"{one.node} itself"))
            flows.add((one.node, name))
    if not nodes:
        return ""
    document = CommentedMap(labels=1, nodes=CommentedMap(sorted(nodes.items())))
    if elements:
        document["elements"] = CommentedMap(sorted(elements.items()))
        document["flows"] = [{"from": node, "to": name} for node, name in sorted(flows)]
    text = StringIO()
    writer = YAML()
    writer.width = 1_000_000
    writer.dump(document, text)
    return HEAD.format(type=TYPE, first=seen.first, last=seen.last) + text.getvalue()


def _say(facts: CommentedMap, key: str, text: str) -> None:
    known = facts.get(key)
    facts[key] = text if known is None or known == text else f"{known}; {text}"


def _element(path: str) -> str:
    """A name that no element of ROS has, without what the label file's grammar forbids."""
    return f"file {_plain(path).lstrip('/').replace(':', '_')}"[:LONGEST].strip()


def _plain(text: str) -> str:
    return " ".join("".join(sign if sign.isprintable() else " " for sign in text).split())[:LONGEST]
