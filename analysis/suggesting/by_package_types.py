"""Open channels of which well-known packages know the type, and that this type is not made for what reaches them.

In: open elements, a graph, its nodes of packages, the table of types. Out: evidence that such data never go through:
``may``.

A package speaks of its own nodes only, and does not know who else writes to a channel. So all who write a topic, or
who serve a service or an action, have to be nodes of packages by their names and at least half of their interfaces,
and these have to name one type. Nothing is said where a type is known otherwise, where somebody can write by a
wildcard, or where a person states that something else goes into the channel.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import STATED, Confidence, Method
from rosprivacy.analysis.suggesting.carried_kinds import no_leg_carries, suggests_nothing
from rosprivacy.analysis.suggesting.evidence import NEVER, PACKAGE, Evidence, Label, whole
from rosprivacy.analysis.suggesting.nodes_of_packages import is_called
from rosprivacy.analysis.suggesting.ros_package import USES

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import OpenQuestion
    from rosprivacy.analysis.model import Bound, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Rules
    from rosprivacy.analysis.suggesting.nodes_of_packages import NodeOfPackage
    from rosprivacy.analysis.suggesting.ros_package import Package

    Identity = tuple[str, str, str]
    Known = tuple[str, Package]  # a type, and who says it
MAKERS = {"topic": "publish", "service": "reply", "action": "execute"}  # whose type is that of the channel


def by_package_types(
    questions: Iterable[OpenQuestion],
    graph: FlowGraph,
    bound: Bound,
    of_packages: Iterable[NodeOfPackage],
    rules: Rules,
) -> Iterator[Evidence]:
    """Yield for open channels the kinds that do not go through, by the types of packages.

    >>> from rosprivacy.analysis.answer import OpenQuestion
    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.carried_kinds import Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.nodes_of_packages import nodes_of_packages
    >>> from rosprivacy.analysis.suggesting.ros_package import Interface, Package, PackageNode, Source
    >>> graph, bound, hierarchy = factory()
    >>> node = PackageNode(("camera",), (Interface("publishes", "video", "a/msg/Beep"),), ())
    >>> beeper = Package("beeper", "", (Source("a page", "2026-11-23", "1.0"),), (node,), Place("beeper.yaml", 1))
    >>> of_packages = nodes_of_packages(graph, {}, [beeper])
    >>> asked = [OpenQuestion(graph.elements[VIDEO], ("Voice",), 1, False)]
    >>> for table in ({("a/msg/Beep", ""): ()}, {}):
    ...     rules = Rules(table, {}, NAMES, hierarchy)
    ...     print([one.reason for one in by_package_types(asked, graph, bound, of_packages, rules)])
    ['package beeper 1.0: a/msg/Beep, which is not made for Voice']
    []
    """
    asked: dict[Identity, OpenQuestion] = {}
    for one in questions:
        if one.element.is_channel and not one.element.pattern:
            before = asked.get(one.element.identity)
            asked[one.element.identity] = one._replace(
                categories=(*one.categories, *(before.categories if before else ()))
            )
    legs: dict[Identity, list[int]] = defaultdict(list)
    for vertex, element in enumerate(graph.elements):
        if element.identity in asked:
            legs[element.identity].append(vertex)
    typed = _typed(graph, bound, of_packages, legs) if asked else {}
    for identity, (type_, package) in typed.items():
        question = asked[identity]
        of_legs = [graph.elements[vertex].leg for vertex in legs[identity]]
        for kind in dict.fromkeys(question.categories):
            if no_leg_carries(kind, type_, of_legs, rules):
                reason = f"package {package.name} {package.version}: {type_}, which is not made for {kind}"
                label = Label(whole(question.element), NEVER, kind)
                family = f"package {package.name}" if suggests_nothing(kind, type_, of_legs, rules) else ""
                yield Evidence(label, PACKAGE, Confidence.MAY, reason, package.place, family)


def _typed(
    graph: FlowGraph, bound: Bound, of_packages: Iterable[NodeOfPackage], legs: Mapping[Identity, Sequence[int]]
) -> dict[Identity, Known]:
    """The type of channels, where all who make it one of a type are nodes of packages, and agree."""
    recognised = [one for one in of_packages if one.is_recognised]
    if not recognised:
        return {}
    makers = _makers(graph, bound, legs)
    said: dict[tuple[int, Identity], set[Known]] = defaultdict(set)
    of_node: dict[int, list[Identity]] = defaultdict(list)
    for identity, nodes in makers.items():
        for maker in nodes:
            of_node[maker].append(identity)
    for vertex, package, node, *_ in recognised:
        base = graph.elements[vertex].name.rpartition("/")[2]
        for identity in of_node.get(vertex, ()):
            _, kind, name = identity
            for one in node.interfaces:
                if one.type and USES[one.use] == (kind, MAKERS[kind]) and is_called(one, base, name):
                    said[vertex, identity].add((one.type, package))
    found = {}
    for identity, nodes in makers.items():
        each = [said.get((maker, identity), set()) for maker in nodes]
        known = {one for some in each for one in some}
        if all(each) and len({type_ for type_, _ in known}) == 1:
            found[identity] = min(known, key=lambda one: one[1].name)
    return found


def _makers(graph: FlowGraph, bound: Bound, legs: Mapping[Identity, Sequence[int]]) -> dict[Identity, set[int]]:
    """By channel the nodes that write or serve it; none where others do, too, or where the type is known."""
    channel_of = {vertex: identity for identity, vertices in legs.items() for vertex in vertices}
    absent = {at for at, said in bound.elements.items() if any(one.method is Method.ABSENT for one in said)}
    flows, meetings = parted(graph.flows)
    unclear = {channel_of[at] for one in meetings for at in (*one.written, *one.read) if at in channel_of}
    unclear |= {channel_of[at] for at in bound.types if at in channel_of}
    makers: dict[Identity, set[int]] = defaultdict(set)
    wildcards: dict[int, set[Identity]] = defaultdict(set)
    written: set[int] = set()
    for _, flow in flows:
        source, target = graph.elements[flow.source], channel_of.get(flow.target)
        if source.is_node and flow.source not in absent:
            written.add(flow.target)
        if target is None:
            continue
        if source.is_channel:
            wildcards[flow.source].add(target)
        elif flow.role == STATED:
            unclear.add(target)
        elif flow.role == MAKERS[target[1]]:
            makers[target].add(flow.source)
    unclear |= {identity for wildcard in wildcards.keys() & written for identity in wildcards[wildcard]}
    return {identity: nodes for identity, nodes in makers.items() if identity not in unclear}
