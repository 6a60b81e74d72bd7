"""What nodes and channels are called when they run: namespaces, ``~``, parameters and remappings, as ROS applies them.

In: names as code writes them, and what a launch file says of the node. Out: fully qualified names, each with how it is
known; where a part is open, what it depends on. A part of a launch file that the sources do not fix stands in braces.

Source: ROS 2 design pages, *Topic and Service Names* and *Remapping Names*: the first rule that matches counts, a rule
``node:from`` holds for that node only, ``__node`` and ``__ns`` rename the node, and a rule's own names are expanded.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.policies.names import resolve
from rosprivacy.ingest.scan.scan_facts import BASES, LAUNCH, LITERAL

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.ingest.scan.scan_facts import Name

OPEN = re.compile(r"\{[^{}]*\}")  # in a launch file's value
SCHEMES = {"rostopic://": ("topic",), "rosservice://": ("service", "action")}  # of rules for one kind of channel


class RunningName(NamedTuple):
    """A name as it is when the node runs.

    Attributes
    ----------
    text
        Fully qualified; empty where a part of it is open.
    basis
        How it is known: one of ``BASES``.
    why
        Of an open name, what it depends on.
    """

    text: str
    basis: str = LITERAL
    why: str = ""


class RunningNode(NamedTuple):
    """What a node is called, and by which rules it renames channels.

    Attributes
    ----------
    plain
        Namespace and name that the code alone gives it.
    launch
        How it is known what the launch file changes: by its text, or by the default of an argument.
    """

    namespace: str
    base: str
    basis: str = LITERAL
    remaps: tuple[tuple[str, str], ...] = ()
    parameters: Mapping[str, str] = {}
    plain: tuple[str, str] = ("/", "")
    launch: str = LAUNCH

    @property
    def name(self) -> str:
        """Fully qualified."""
        return resolve(self.base, self.namespace, "")


def least_sure(*ways: str) -> str:
    """Return the least sure of some ways of knowing.

    >>> least_sure("literal", "default", "launch")
    'default'
    """
    return max(ways, key=BASES.index, default=LITERAL)


def is_open(value: str) -> bool:
    """Return whether a part of a launch file's value is not fixed."""
    return OPEN.search(value) is not None


def whole_namespace(namespace: str) -> str:
    """Return a namespace that begins with ``/`` and does not end with it.

    >>> whole_namespace("robot/"), whole_namespace("")
    ('/robot', '/')
    """
    return f"/{namespace.strip('/')}"


def written_name(name: Name, parameters: Mapping[str, str]) -> RunningName:
    """Return a name as the code writes it, with the parameters of a launch file; not yet expanded.

    >>> from rosprivacy.ingest.scan.scan_facts import NamePiece
    >>> written_name((NamePiece("image", "default", "topic"),), {"topic": "faces"})
    RunningName(text='faces', basis='launch', why='')
    """
    texts, ways = [], [LITERAL]
    for piece in name:
        if piece.parameter in parameters and piece.parameter:
            value, way = parameters[piece.parameter], LAUNCH
            if is_open(value):
                return RunningName("", way, f"the parameter {piece.parameter} is {value} in the launch file")
            texts.append(value)
            ways.append(way)
        elif piece.text is None:
            return RunningName("", piece.basis, piece.why or "a value that the sources do not fix")
        else:
            texts.append(piece.text)
            ways.append(piece.basis)
    return RunningName("".join(texts), least_sure(*ways))


def expanded(name: str, namespace: str, base: str) -> str:
    """Return the fully qualified form of a name that a node uses.

    >>> expanded("~/image", "/robot", "camera"), expanded("{node}/image", "/", "camera")
    ('/robot/camera/image', '/camera/image')
    """
    if "{" in name:
        name = name.replace("{node}", base).replace("{namespace}", namespace).replace("{ns}", namespace)
    return resolve(name, namespace, base)


def running_name(name: Name, kind: str, node: RunningNode) -> RunningName:
    """Return what a channel of a node is called when it runs.

    Parameters
    ----------
    kind
        ``topic``, ``service`` or ``action``.
    """
    written = written_name(name, node.parameters)
    if written.why:
        return written
    full = expanded(written.text, node.namespace, node.base)
    target = _remapped(full, kind, node)
    if is_open(target):
        return RunningName("", LAUNCH, f"{full} is renamed to {target} in the launch file")
    way = least_sure(written.basis, node.basis) if "~" in written.text or "{" in written.text else written.basis
    if target != expanded(written.text, *node.plain):
        way = least_sure(way, LAUNCH, node.launch)
    return RunningName(target, way)


def _remapped(name: str, kind: str, node: RunningNode) -> str:
    for rule, target in node.remaps:
        source = rule
        scheme = next((scheme for scheme in SCHEMES if rule.startswith(scheme)), "")
        if scheme:
            source = rule.removeprefix(scheme)
        elif ":" in rule:
            of_node, _, source = rule.partition(":")
            if of_node != node.base:
                continue
        if source.startswith("__") or (scheme and kind not in SCHEMES[scheme]):
            continue
        if expanded(source, node.namespace, node.base) == name:
            return expanded(target, node.namespace, node.base) if not is_open(target) else target
    return name
