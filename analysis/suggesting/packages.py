"""Well-known packages: what a file says of their nodes, which nodes of a graph are theirs, and the evidence of that.

A package speaks of its own nodes only, and does not know who else writes to a channel. The rules (docs/packages.md): a
node is one of a package by its name, and a channel confirms an interface by the end of its name, in the same use,
unless its message types are known and the package's is not among them. What a policy grants by a wildcard confirms
nothing. The name and at least half of the interfaces are ``likely``; less is ``may``, and evidence of a name; nothing
is ever ``certain``, since anybody may call a node so. Where a node has no interfaces by which it could be known, and is
called as its package, what it lets out is ``likely`` by the name alone. A node of which all types are known, and that
has none of the interfaces, is another one: what it lets out is told, but for what it would bring in itself.
"""

from __future__ import annotations

from collections import defaultdict
from fnmatch import fnmatchcase
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import STATED, Confidence, Method
from rosprivacy.analysis.suggesting.evidence import LEAK, NAMED, NEVER, PACKAGE, SOURCE, Evidence, SuggestedLabel, whole

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import OpenQuestion
    from rosprivacy.analysis.model import Bound, FlowGraph, MessageType, Place
    from rosprivacy.analysis.suggesting.channels import Rules
    from rosprivacy.analysis.suggesting.evidence import Identity

USES = {  # what a node does with its interfaces, in the file -> (kind of channel, role of the grant)
    "publishes": ("topic", "publish"),
    "subscribes": ("topic", "subscribe"),
    "replies": ("service", "reply"),
    "requests": ("service", "request"),
    "executes": ("action", "execute"),
    "calls": ("action", "call"),
}
NOTHING = "nothing"  # besides the interfaces that a file states
MAKERS = {"topic": "publish", "service": "reply", "action": "execute"}  # whose type is that of the channel


class Interface(NamedTuple):
    """A channel of a node, as its documentation writes it.

    Attributes
    ----------
    use
        One of ``USES``.
    name
        Relative, private (``~/x``), from the namespace above (``../x``) or absolute; ``*`` stands for one segment, or
        for a part of one; where a parameter names it, for its value.
    type
        Such as ``sensor_msgs/msg/Image``; empty if the node takes any.
    parameter
        Whose value is the name where it is set, or the ``*`` in it; there a pattern of parameters, each names one.
    """

    use: str
    name: str
    type: str = ""
    parameter: str = ""


class Claim(NamedTuple):
    """What a package says that a node does with data of one kind.

    Attributes
    ----------
    role
        ``source``, ``leak``, ``derivation``, ``sanitizer`` or ``conduit``.
    kind
        Name of a category; empty of a conduit for all.
    confidence
        ``may`` where it depends on a setting or on what comes in, else ``likely``; never ``certain``.
    method, to, where
        Of a sanitizer; of a derivation the category that comes out; of a leak one of ``WHERE``.
    """

    role: str
    kind: str
    confidence: Confidence
    why: str
    place: Place
    method: Method | None = None
    to: str = ""
    where: str = ""


class PackageNode(NamedTuple):
    """A node of a package.

    Attributes
    ----------
    names
        By default, without namespace, which may end in ``*``; then its executables.
    interfaces
        By which it is recognised.
    further
        Further interfaces, such as those that only some versions or settings have.
    rest
        What its channels besides these depend on; ``NOTHING`` if there are none, empty if that is not known.
    makes
        Further nodes in its process, which the same file describes: their names, from its namespace.
    components
        Its classes, where it can be loaded into a container.
    """

    names: tuple[str, ...]
    interfaces: tuple[Interface, ...]
    claims: tuple[Claim, ...]
    further: tuple[Interface, ...] = ()
    rest: str = ""
    makes: tuple[str, ...] = ()
    components: tuple[str, ...] = ()


class Source(NamedTuple):
    """What an entry was read from: an address, the day, a version or a commit, and files."""

    at: str
    read: str
    version: str = ""
    commit: str = ""
    files: tuple[str, ...] = ()


class Package(NamedTuple):
    """What one file says of one package, or of a stack of them.

    Attributes
    ----------
    place, sha256
        Of the file.
    packages
        Those whose executables its nodes are, as launch files call them.
    """

    name: str
    about: str
    sources: tuple[Source, ...]
    nodes: tuple[PackageNode, ...]
    place: Place
    sha256: str = ""
    packages: tuple[str, ...] = ()

    @property
    def version(self) -> str:
        """The version of the first source, or the beginning of its commit."""
        return self.sources[0].version or self.sources[0].commit[:7]


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

    @property
    def agrees(self) -> str:
        """What of it agrees with the package."""
        some = f"{self.confirmed} of {len(self.node.interfaces)} of its interfaces"
        return f"its name, {some}" if self.confirmed else "its name alone"

    def is_exit(self, name: str) -> bool:
        """Whether it is ``likely`` what lets data out: by its interfaces, or called as a package that lists none."""
        return self.is_recognised or (not self.node.interfaces and name.rpartition("/")[2] == self.package.name)


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
    >>> graph, *_ = factory()
    >>> film = Claim("source", "Video", Confidence.LIKELY, "it films", Place("camera.yaml", 9))
    >>> node = PackageNode(("camera",), (Interface("publishes", "video"),), (film,))
    >>> camera = Package("camera", "", (Source("a page", "2026-11-23", "1.0"),), (node,), Place("camera.yaml", 1))
    >>> [(str(one.confidence), one.reason) for one in package_evidence(graph, nodes_of_packages(graph, {}, [camera]))]
    [('likely', 'package camera 1.0: it films (its name, 1 of 1 of its interfaces)')]
    """
    named = tuple(_of_name(graph, packages))
    channels = _channels(graph, types, {vertex for vertex, _, _ in named})
    found = []
    for vertex, package, node in named:
        base, own = graph.elements[vertex].name.rpartition("/")[2], channels.get(vertex, {})
        confirmed = sum(_is_confirmed(one, base, own) for one in node.interfaces)
        every = [some for of_use in own.values() for some in of_use.values()]
        found.append(NodeOfPackage(vertex, package, node, confirmed, bool(every) and all(every)))
    return tuple(found)


def _of_name(graph: FlowGraph, packages: Iterable[Package]) -> Iterator[tuple[int, Package, PackageNode]]:
    named: dict[str, list[tuple[Package, PackageNode]]] = defaultdict(list)
    patterns: list[tuple[str, tuple[Package, PackageNode]]] = []
    for package in packages:
        for node in package.nodes:
            for name in node.names:
                if "*" in name:
                    patterns.append((name, (package, node)))
                else:
                    named[name].append((package, node))
    of_name: dict[str, list[tuple[Package, PackageNode]]] = {}
    for vertex, element in enumerate(graph.elements):
        if element.is_node:
            base = element.name.rpartition("/")[2]
            if base not in of_name:  # robots have nodes of the same names
                more = [pair for name, pair in patterns if fnmatchcase(base, name)]
                of_name[base] = [*named.get(base, ()), *more]
            yield from ((vertex, package, node) for package, node in of_name[base])


_Channels = dict[tuple[str, str], dict[str, tuple[str, ...]]]  # by kind and role of a grant: names -> types


def _channels(graph: FlowGraph, types: Mapping[int, Sequence[MessageType]], vertices: set[int]) -> dict[int, _Channels]:
    """What the nodes that are looked at do with which channels; wildcards left out."""
    found: dict[int, _Channels] = {}
    for _, flow in parted(graph.flows)[0] if vertices else ():
        for vertex, channel in ((flow.source, flow.target), (flow.target, flow.source)):
            element = graph.elements[channel]
            if vertex in vertices and element.is_channel and not element.pattern:
                known = found.setdefault(vertex, {}).setdefault((element.kind, flow.role), {})
                names = tuple(one.name for one in types.get(channel, ()))
                known[element.name] = known.get(element.name, ()) + names
    return found


def _is_confirmed(interface: Interface, base: str, channels: _Channels) -> bool:
    return any(
        _is_called(interface, base, channel) and (not types or not interface.type or interface.type in types)
        for channel, types in channels.get(USES[interface.use], {}).items()
    )


def _is_called(interface: Interface, base: str, channel: str) -> bool:
    """Whether a channel of a node is called like an interface, by the end of its name.

    Parameters
    ----------
    base
        The name of the node without namespace.

    Examples
    --------
    >>> [_is_called(Interface("replies", "~/map"), "server", name) for name in ("/home/server/map", "/map")]
    [True, False]
    """
    parts = _parts(interface.name, base)
    last = tuple(channel.split("/")[1:][-len(parts) :])
    return last == parts or (len(last) == len(parts) and all(map(fnmatchcase, last, parts)))


@lru_cache(maxsize=2**14)
def _parts(name: str, base: str) -> tuple[str, ...]:
    name = name.removeprefix("../").removeprefix("/")
    return tuple((f"{base}/{name[2:]}" if name.startswith("~/") else name).split("/"))


def package_evidence(graph: FlowGraph, of_packages: Iterable[NodeOfPackage]) -> Iterator[Evidence]:
    """Yield what packages say of the nodes of a graph.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.packages import nodes_of_packages
    >>> from rosprivacy.analysis.suggesting.packages import Claim, Interface, Package, PackageNode, Source
    >>> graph, bound, _ = factory()
    >>> film = Claim("source", "Video", Confidence.LIKELY, "it films", Place("camera.yaml", 9))
    >>> node = PackageNode(("camera",), (Interface("publishes", "video"),), (film,))
    >>> camera = Package("camera", "", (Source("a page", "2026-11-23", "1.0"),), (node,), Place("camera.yaml", 1))
    >>> said = package_evidence(graph, nodes_of_packages(graph, {}, [camera]))
    >>> [(str(one.confidence), one.reason) for one in said]
    [('likely', 'package camera 1.0: it films (its name, 1 of 1 of its interfaces)')]
    """
    for one in of_packages:
        element, interfaces, package = whole(graph.elements[one.vertex]), len(one.node.interfaces), one.package
        another = interfaces and not one.confirmed and one.all_typed
        own = {claim.kind for claim in one.node.claims if claim.role == SOURCE}
        for claim in one.node.claims:
            if another and (claim.role != LEAK or claim.kind in own):
                continue
            label = SuggestedLabel(element, claim.role, claim.kind, claim.method, claim.to)
            matched = one.is_exit(element.name) if claim.role == LEAK else one.is_recognised
            where = f", to a {claim.where}" if claim.where else ""
            reason = f"package {package.name} {package.version}{where}: {claim.why} ({one.agrees})"
            ground, sure = (PACKAGE, claim.confidence) if matched else (NAMED, Confidence.MAY)
            yield Evidence(label, ground, sure, reason, claim.place, where=claim.where)


def by_package_types(
    questions: Iterable[OpenQuestion],
    graph: FlowGraph,
    bound: Bound,
    of_packages: Iterable[NodeOfPackage],
    rules: Rules,
) -> Iterator[Evidence]:
    """Yield for open channels the kinds that do not go through, by the types of packages: ``may``.

    All who write a topic, or who serve a service or an action, have to be recognised nodes of packages, and these have
    to name one type. Nothing is said where a type is known otherwise, where somebody can write by a wildcard, or where
    a person states that something else goes into the channel.

    >>> from rosprivacy.analysis.answer import OpenQuestion
    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.model import Place
    >>> from rosprivacy.analysis.suggesting.channels import Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.packages import nodes_of_packages
    >>> from rosprivacy.analysis.suggesting.packages import Interface, Package, PackageNode, Source
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
            if rules.no_leg_carries(kind, type_, of_legs):
                reason = f"package {package.name} {package.version}: {type_}, which is not made for {kind}"
                label = SuggestedLabel(whole(question.element), NEVER, kind)
                family = f"package {package.name}" if rules.suggests_nothing(kind, type_, of_legs) else ""
                yield Evidence(label, PACKAGE, Confidence.MAY, reason, package.place, family)


def _typed(
    graph: FlowGraph, bound: Bound, of_packages: Iterable[NodeOfPackage], legs: Mapping[Identity, Sequence[int]]
) -> dict[Identity, tuple[str, Package]]:
    """The type of channels and who says it, where all who make a channel one of a type are of packages, and agree."""
    recognised: dict[int, list[NodeOfPackage]] = defaultdict(list)
    for one in of_packages:
        if one.is_recognised:
            recognised[one.vertex].append(one)
    found = {}
    for identity, nodes in (_makers(graph, bound, legs) if recognised else {}).items():
        _, kind, name = identity
        each = [
            [
                (interface.type, one.package)
                for one in recognised.get(maker, ())
                for interface in one.node.interfaces
                if interface.type and USES[interface.use] == (kind, MAKERS[kind])
                if _is_called(interface, graph.elements[maker].name.rpartition("/")[2], name)
            ]
            for maker in nodes
        ]
        known = [one for some in each for one in some]
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
