"""Nodes that are called like those of a well-known package, and which of the package's interfaces they have.

In: a graph, the message types of its channels, packages. Out: ``NodeOfPackage``, found once for all who speak of
packages. The rule (docs/packages.md): a channel confirms an interface by the end of its name, in the same use, unless
its message types are known and the package's is not among them. What a policy grants by a wildcard confirms nothing.
"""

from __future__ import annotations

from collections import defaultdict
from fnmatch import fnmatchcase
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.suggesting.ros_package import USES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import FlowGraph, MessageType
    from rosprivacy.analysis.suggesting.ros_package import Interface, Package, PackageNode

Types = tuple[str, ...]  # names of the types of a channel
Channels = dict[tuple[str, str], dict[str, Types]]  # by kind of channel and role of a grant: names of channels
_Named = tuple[int, "Package", "PackageNode"]


class NodeOfPackage(NamedTuple):
    """A node that is called like one of a package.

    Attributes
    ----------
    vertex
        Of the node in the graph.
    confirmed
        How many interfaces of the package's node it has.
    all_typed
        Whether it has channels, and the types of all of them are known.
    """

    vertex: int
    package: Package
    node: PackageNode
    confirmed: int
    all_typed: bool

    @property
    def is_recognised(self) -> bool:
        """Whether it has at least half of the interfaces."""
        return bool(self.node.interfaces) and 2 * self.confirmed >= len(self.node.interfaces)


def nodes_of_packages(
    graph: FlowGraph, types: Mapping[int, Sequence[MessageType]], packages: Sequence[Package]
) -> tuple[NodeOfPackage, ...]:
    """Return the nodes of a graph that are called like nodes of packages, in the order of the graph.

    Parameters
    ----------
    types
        By vertex: the message types of a channel (rule S15), as far as they are known.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.ros_package import Interface, Package, PackageNode, Source
    >>> graph, *_ = factory()
    >>> nodes = [PackageNode(("camera",), (Interface("publishes", name),), ()) for name in ("video", "sound")]
    >>> said = [(Source("a page", "2026-11-23", "1.0"),), Place("camera.yaml", 1)]
    >>> packages = [Package(f"a {node.interfaces[0].name}", "", said[0], (node,), said[1]) for node in nodes]
    >>> [(one.package.name, one.is_recognised) for one in nodes_of_packages(graph, {}, packages)]
    [('a video', True), ('a sound', False)]
    """
    named = tuple(_named(graph, packages))
    channels = _channels(graph, types, {vertex for vertex, _, _ in named})
    return tuple(_looked_at(graph, one, channels.get(one[0], {})) for one in named)


def is_called(interface: Interface, base: str, channel: str) -> bool:
    """Return whether a channel of a node is called like an interface, by the end of its name.

    Parameters
    ----------
    base
        The name of the node without namespace.

    Examples
    --------
    >>> from rosprivacy.analysis.suggesting.ros_package import Interface
    >>> [is_called(Interface("replies", "~/map"), "server", name) for name in ("/home/server/map", "/map")]
    [True, False]
    """
    parts = _parts(interface.name, base)
    last = tuple(channel.split("/")[1:][-len(parts) :])
    return last == parts or (len(last) == len(parts) and all(map(fnmatchcase, last, parts)))


@lru_cache(maxsize=2**14)
def _parts(name: str, base: str) -> tuple[str, ...]:
    name = name.removeprefix("/")
    return tuple((f"{base}/{name[2:]}" if name.startswith("~/") else name).split("/"))


def _named(graph: FlowGraph, packages: Iterable[Package]) -> Iterator[_Named]:
    named: dict[str, list[tuple[Package, PackageNode]]] = defaultdict(list)
    made_up: list[tuple[str, tuple[Package, PackageNode]]] = []
    for package in packages:
        for node in package.nodes:
            for name in node.names:
                if "*" in name:
                    made_up.append((name, (package, node)))
                else:
                    named[name].append((package, node))
    of_name: dict[str, list[tuple[Package, PackageNode]]] = {}
    for vertex, element in enumerate(graph.elements):
        if element.is_node:
            base = element.name.rpartition("/")[2]
            if base not in of_name:  # robots have nodes of the same names
                more = [pair for name, pair in made_up if fnmatchcase(base, name)]
                of_name[base] = [*named.get(base, ()), *more]
            for package, node in of_name[base]:
                yield vertex, package, node


def _channels(graph: FlowGraph, types: Mapping[int, Sequence[MessageType]], wanted: set[int]) -> dict[int, Channels]:
    """What the nodes that are looked at do with which channels; wildcards left out."""
    found: dict[int, Channels] = {}
    if not wanted:
        return found
    elements = graph.elements
    for _, flow in parted(graph.flows)[0]:
        for vertex, channel in ((flow.source, flow.target), (flow.target, flow.source)):
            if vertex not in wanted:
                continue
            element = elements[channel]
            if element.is_channel and not element.pattern:
                known = found.setdefault(vertex, {}).setdefault((element.kind, flow.role), {})
                seen = tuple(one.name for one in types.get(channel, ()))
                known[element.name] = known.get(element.name, ()) + seen
    return found


def _looked_at(graph: FlowGraph, named: _Named, channels: Channels) -> NodeOfPackage:
    vertex, _, node = named
    base = graph.elements[vertex].name.rpartition("/")[2]
    confirmed = sum(_is_confirmed(one, base, channels) for one in node.interfaces)
    types = [types for of_use in channels.values() for types in of_use.values()]
    return NodeOfPackage(*named, confirmed, bool(types) and all(types))


def _is_confirmed(interface: Interface, base: str, channels: Channels) -> bool:
    for channel, types in channels.get(USES[interface.use], {}).items():
        if is_called(interface, base, channel) and (not types or not interface.type or interface.type in types):
            return True
    return False
