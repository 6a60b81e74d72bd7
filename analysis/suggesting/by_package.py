"""Evidence of packages: nodes that are called like those of a well-known package, and have its interfaces.

In: a graph, the message types of its channels, packages. Out: evidence. The rule (docs/packages.md): the name and at
least half of the interfaces are ``likely``; less is ``may``, and evidence of a name; nothing is ever ``certain``, since
anybody may call a node so. A channel confirms an interface by the end of its name, in the same use, unless its message
types are known and the package's is not among them. What a policy grants by a wildcard confirms nothing. A node of
which all types are known, and that has none of the interfaces, is another one: to be on the safe side what it lets out
is told all the same, but for what it would bring in itself.
"""

from __future__ import annotations

from collections import defaultdict
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import LEAK, NAMED, PACKAGE, SOURCE, Evidence, Label, whole
from rosprivacy.analysis.suggesting.ros_package import USES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.model import FlowGraph, MessageType
    from rosprivacy.analysis.suggesting.ros_package import Claim, Interface, Package, PackageNode

Use = tuple[str, str]  # kind of channel, role of a grant
Channels = dict[Use, dict[str, frozenset[str]]]  # names of channels by use, each with the names of its types


class _Match(NamedTuple):
    """A node that is called like one of a package."""

    vertex: int
    package: Package
    node: PackageNode


def package_evidence(
    graph: FlowGraph, types: Mapping[int, tuple[MessageType, ...]], packages: Sequence[Package]
) -> tuple[Evidence, ...]:
    """Return what packages say of the nodes of a graph.

    Parameters
    ----------
    types
        By vertex: the message types of a channel (rule S15), as far as they are known.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.ros_package import Claim, Interface, Package, PackageNode, Source
    >>> graph, bound, _ = factory()
    >>> film = Claim("source", "Video", Confidence.LIKELY, "it films", Place("camera.yaml", 9))
    >>> node = PackageNode(("camera",), (Interface("publishes", "video"),), (film,))
    >>> camera = Package("camera", "", (Source("a page", "2026-11-23", "1.0"),), (node,), Place("camera.yaml", 1))
    >>> [(str(one.confidence), one.reason) for one in package_evidence(graph, {}, [camera])]
    [('likely', 'package camera 1.0: it films (its name, 1 of 1 of its interfaces)')]
    """
    found = tuple(_matches(graph, packages))
    channels = _channels(graph, types, {match.vertex for match in found})
    return tuple(said for match in found for said in _evidence(graph, match, channels[match.vertex]))


def _matches(graph: FlowGraph, packages: Iterable[Package]) -> Iterator[_Match]:
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
                yield _Match(vertex, package, node)


def _channels(graph: FlowGraph, types: Mapping[int, tuple[MessageType, ...]], wanted: set[int]) -> dict[int, Channels]:
    """What the nodes that are looked at do with which channels; wildcards left out."""
    found: dict[int, Channels] = defaultdict(lambda: defaultdict(dict))
    if not wanted:
        return found
    flows, _ = parted(graph.flows)
    for _, flow in flows:
        for vertex, channel in ((flow.source, flow.target), (flow.target, flow.source)):
            if vertex not in wanted:
                continue
            element = graph.elements[channel]
            if element.is_channel and not element.pattern:
                known = found[vertex][element.kind, flow.role]
                seen = frozenset(one.name for one in types.get(channel, ()))
                known[element.name] = known.get(element.name, frozenset()) | seen
    return found


def _evidence(graph: FlowGraph, match: _Match, channels: Channels) -> Iterator[Evidence]:
    element = whole(graph.elements[match.vertex])
    base = element.name.rpartition("/")[2]
    interfaces = match.node.interfaces
    seen = sum(_confirmed(one, base, channels) for one in interfaces)
    matched = bool(interfaces) and 2 * seen >= len(interfaces)
    by = f"its name, {seen} of {len(interfaces)} of its interfaces" if seen else "its name alone"
    another = bool(interfaces) and not seen and _all_typed(channels)
    for claim in _leaks_of_others_data(match.node) if another else match.node.claims:
        label = Label(element, claim.role, claim.kind, claim.method, claim.to)
        confidence = claim.confidence if matched else Confidence.MAY
        where = f", to a {claim.where}" if claim.where else ""
        reason = f"package {match.package.name} {match.package.version}{where}: {claim.why} ({by})"
        yield Evidence(label, PACKAGE if matched else NAMED, confidence, reason, claim.place)


def _leaks_of_others_data(node: PackageNode) -> list[Claim]:
    """What is told of a node that is probably another one of that name: what it lets out, if it gets it from others."""
    own = {claim.kind for claim in node.claims if claim.role == SOURCE}
    return [claim for claim in node.claims if claim.role == LEAK and claim.kind not in own]


def _all_typed(channels: Channels) -> bool:
    """Whether a node has channels, and the types of all of them are known."""
    known = [types for named in channels.values() for types in named.values()]
    return bool(known) and all(known)


def _confirmed(interface: Interface, base: str, channels: Channels) -> bool:
    for channel, types in channels.get(USES[interface.use], {}).items():
        if is_called(interface, base, channel) and (not types or not interface.type or interface.type in types):
            return True
    return False


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
    name = interface.name.removeprefix("/")
    parts = (f"{base}/{name[2:]}" if name.startswith("~/") else name).split("/")
    last = channel.split("/")[1:][-len(parts) :]
    return last == parts or (len(last) == len(parts) and all(map(fnmatchcase, last, parts)))


def recognised(
    graph: FlowGraph, types: Mapping[int, tuple[MessageType, ...]], packages: Sequence[Package]
) -> Iterator[tuple[int, Package, PackageNode]]:
    """Yield the vertices of nodes that have the name of a package's node, and at least half of its interfaces.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.ros_package import Interface, Package, PackageNode, Source
    >>> graph, *_ = factory()
    >>> nodes = [PackageNode(("camera",), (Interface("publishes", name),), ()) for name in ("video", "sound")]
    >>> said = [(Source("a page", "2026-11-23", "1.0"),), Place("camera.yaml", 1)]
    >>> packages = [Package(f"a {node.interfaces[0].name}", "", said[0], (node,), said[1]) for node in nodes]
    >>> [(graph.elements[vertex].name, package.name) for vertex, package, _ in recognised(graph, {}, packages)]
    [('/camera', 'a video')]
    """
    found = tuple(_matches(graph, packages))
    channels = _channels(graph, types, {match.vertex for match in found})
    for match in found:
        base = graph.elements[match.vertex].name.rpartition("/")[2]
        seen = sum(_confirmed(one, base, channels[match.vertex]) for one in match.node.interfaces)
        if match.node.interfaces and 2 * seen >= len(match.node.interfaces):
            yield match.vertex, match.package, match.node
