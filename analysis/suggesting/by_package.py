"""Evidence of packages: nodes that are called like those of a well-known package, and have its interfaces.

In: a graph, its nodes of packages. Out: evidence. The rule (docs/packages.md): the name and at least half of the
interfaces are ``likely``; less is ``may``, and evidence of a name; nothing is ever ``certain``, since anybody may call
a node so. Where a node has no interfaces by which it could be known, and is called as its package, what it lets out is
``likely`` by the name alone. A node of which all types are known, and that has none of the interfaces, is another one:
to be on the safe side what it lets out is told all the same, but for what it would bring in itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.evidence import LEAK, NAMED, PACKAGE, SOURCE, Evidence, Label, whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.analysis.suggesting.nodes_of_packages import NodeOfPackage
    from rosprivacy.analysis.suggesting.ros_package import Claim, PackageNode


def package_evidence(graph: FlowGraph, of_packages: Iterable[NodeOfPackage]) -> Iterator[Evidence]:
    """Yield what packages say of the nodes of a graph.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.nodes_of_packages import nodes_of_packages
    >>> from rosprivacy.analysis.suggesting.ros_package import Claim, Interface, Package, PackageNode, Source
    >>> graph, bound, _ = factory()
    >>> film = Claim("source", "Video", Confidence.LIKELY, "it films", Place("camera.yaml", 9))
    >>> node = PackageNode(("camera",), (Interface("publishes", "video"),), (film,))
    >>> camera = Package("camera", "", (Source("a page", "2026-11-23", "1.0"),), (node,), Place("camera.yaml", 1))
    >>> said = package_evidence(graph, nodes_of_packages(graph, {}, [camera]))
    >>> [(str(one.confidence), one.reason) for one in said]
    [('likely', 'package camera 1.0: it films (its name, 1 of 1 of its interfaces)')]
    """
    for one in of_packages:
        yield from _of_node(graph, one)


def _of_node(graph: FlowGraph, one: NodeOfPackage) -> Iterator[Evidence]:
    element, interfaces = whole(graph.elements[one.vertex]), len(one.node.interfaces)
    by = f"its name, {one.confirmed} of {interfaces} of its interfaces" if one.confirmed else "its name alone"
    another = interfaces and not one.confirmed and one.all_typed
    bare = not interfaces and element.name.rpartition("/")[2] == one.package.name
    for claim in _leaks_of_others_data(one.node) if another else one.node.claims:
        label = Label(element, claim.role, claim.kind, claim.method, claim.to)
        matched = one.is_recognised or (bare and claim.role == LEAK)
        confidence = claim.confidence if matched else Confidence.MAY
        where = f", to a {claim.where}" if claim.where else ""
        reason = f"package {one.package.name} {one.package.version}{where}: {claim.why} ({by})"
        yield Evidence(label, PACKAGE if matched else NAMED, confidence, reason, claim.place)


def _leaks_of_others_data(node: PackageNode) -> list[Claim]:
    """What is told of a node that is probably another one of that name: what it lets out, if it gets it from others."""
    own = {claim.kind for claim in node.claims if claim.role == SOURCE}
    return [claim for claim in node.claims if claim.role == LEAK and claim.kind not in own]
