"""Code, executables and what a launch file starts -> one system: nodes, what each writes and reads, what is not known.

In: facts of all readers. Out: ``ScannedSystem``, with final names: the launch file's name, namespace, parameters and
remappings are applied as ROS does. A node whose code is not there has the interface that the catalogue of packages
states. Values are unions: a name with several values is several names. What has no name is a gap at its line.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import unresolved, unresolved_rank
from rosprivacy.analysis.suggesting.packages import USES
from rosprivacy.ingest.running.observation import ROLES as KINDS
from rosprivacy.ingest.running.observed_names import is_name
from rosprivacy.ingest.scan.catalogued import EVERY_TOPIC, catalogued, channel_names
from rosprivacy.ingest.scan.final_names import (
    RunningName,
    RunningNode,
    is_open,
    least_sure,
    running_name,
    whole_namespace,
    written_name,
)
from rosprivacy.ingest.scan.launch.parameter_files import fits
from rosprivacy.ingest.scan.scan_facts import (
    BASES,
    DESCRIBED,
    GUESSED,
    LAUNCH,
    LITERAL,
    NODE_NAME,
    PACKAGE,
    CodePlace,
    Gap,
    NamePiece,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.suggesting.packages import Package, PackageNode
    from rosprivacy.ingest.scan.catalogued import Catalogued
    from rosprivacy.ingest.scan.scan_facts import (
        CodeFacts,
        CodeNode,
        External,
        LaunchedSystem,
        LogCall,
        Name,
        StartedNode,
    )
    from rosprivacy.ingest.scan.started_code import CodeIndex

OTHER_SIDE = {"publish": "subscribe", "subscribe": "publish"}
A = {"topic": "a topic", "service": "a service", "action": "an action"}
LOG = ("/rosout", "rcl_interfaces/msg/Log")
NO_NAME = (NamePiece(None, GUESSED),)
DESCRIPTION_ALONE = "only its description is known: not what it does outside ROS and logs, and what ROS adds"
CONTAINERS = "rclcpp_components"  # its executables hold nodes and exchange no data themselves


class ChannelEnd(NamedTuple):
    """What a node writes or reads, with its line of the code.

    Attributes
    ----------
    role
        What a policy would have to allow.
    basis
        How it is known: one of ``BASES``.
    """

    node: str
    role: str
    name: str
    type: str
    basis: str
    place: CodePlace

    @property
    def kind(self) -> str:
        """Of the channel."""
        return KINDS[self.role]


class SystemNode(NamedTuple):
    """A node of the system, with its code, if that is there."""

    name: str
    basis: str
    place: CodePlace
    code: CodeNode | None = None


class NodeExternal(NamedTuple):
    """What lies outside ROS, with the node that exchanges data with it."""

    node: str
    external: External


class NodeLog(NamedTuple):
    """A call of a logger in a node, with the channels whose data is logged."""

    node: str
    channels: tuple[str, ...]
    call: LogCall


class ScannedSystem(NamedTuple):
    """What a launch file starts, or all nodes of the code where there is none.

    Attributes
    ----------
    launch
        The launch file; empty where there is none.
    gaps
        What could not be resolved: first what could hide most.
    idle
        Nodes of the code that it does not start.
    besides
        Further launch files whose nodes are in it, where several folders are read as one.
    """

    launch: str
    nodes: tuple[SystemNode, ...]
    ends: tuple[ChannelEnd, ...]
    gaps: tuple[Gap, ...] = ()
    externals: tuple[NodeExternal, ...] = ()
    logs: tuple[NodeLog, ...] = ()
    idle: tuple[CodeNode, ...] = ()
    besides: tuple[str, ...] = ()


def launched_system(
    facts: CodeFacts, index: CodeIndex, launched: LaunchedSystem, packages: Sequence[Package] = ()
) -> ScannedSystem:
    """Return the system that a launch file starts.

    Parameters
    ----------
    packages
        The catalogue: what is known of nodes whose code is not there.
    """
    maker = _Maker()
    maker.gaps += launched.gaps
    for started in launched.started:
        maker.start(started, index, packages)
    idle = tuple(node for node in index.nodes if id(node) not in maker.used)
    return maker.system(launched.file, _of_started(facts.gaps, tuple(maker.used.values()), idle), idle)


def whole_system(facts: CodeFacts) -> ScannedSystem:
    """Return the system of all nodes of the code, of a checkout that has no launch file."""
    maker = _Maker()
    for code in facts.nodes:
        maker.add_code(code, None)
    return maker.system("", _but_names(facts.gaps, facts.nodes), ())


def with_more_code(system: ScannedSystem, nodes: Sequence[CodeNode], gaps: Iterable[Gap]) -> ScannedSystem:
    """Return a system with further nodes of the code, under the names that the code gives them.

    Parameters
    ----------
    gaps
        Of all code: those in files of these nodes are added.
    """
    maker = _Maker()
    for code in nodes:
        maker.add_code(code, None)
    files, added = _files(nodes), {id(node) for node in nodes}
    idle = tuple(node for node in system.idle if id(node) not in added)
    more = maker.system("", (gap for gap in _but_names(gaps, nodes) if gap.place.file in files), idle)
    return joined_systems([system, more])


def joined_systems(systems: Sequence[ScannedSystem]) -> ScannedSystem:
    """Return what several launch files start together, as one system, called after the first."""
    nodes = {node.name: node for system in reversed(systems) for node in system.nodes}
    nodes |= {node.name: node for system in reversed(systems) for node in system.nodes if node.code}
    first, *others = systems
    in_all = set.intersection(*({id(node) for node in system.idle} for system in systems))
    return first._replace(
        nodes=tuple(nodes[name] for name in sorted(nodes)),
        ends=tuple(sorted({end for system in systems for end in system.ends})),
        gaps=in_order(gap for system in systems for gap in system.gaps),
        externals=tuple(dict.fromkeys(one for system in systems for one in system.externals)),
        logs=tuple(dict.fromkeys(one for system in systems for one in system.logs)),
        idle=tuple(node for node in first.idle if id(node) in in_all),
        besides=tuple(dict.fromkeys((*first.besides, *(system.launch for system in others if system.launch)))),
    )


def _of_started(gaps: Iterable[Gap], used: tuple[CodeNode, ...], idle: tuple[CodeNode, ...]) -> Iterator[Gap]:
    """Gaps but those of files in which there are only nodes that are not started."""
    left = _files(idle) - _files(used)
    return _but_names((gap for gap in gaps if gap.place.file not in left), (*used, *idle))


def _but_names(gaps: Iterable[Gap], nodes: Iterable[CodeNode]) -> Iterator[Gap]:
    """Gaps but those of names of ends that the join speaks about: a launch file may have given the name."""
    ours = {end.place for node in nodes for end in node.endpoints if not end.names or any(map(_is_open, end.names))}
    return (gap for gap in gaps if gap.sort != "name" or gap.place not in ours)


def _is_open(name: Name) -> bool:
    return any(piece.text is None for piece in name)


def _files(nodes: Iterable[CodeNode]) -> set[str]:
    return {file for node in nodes for file in (node.place.file, *(end.place.file for end in node.endpoints))}


class _Maker:
    """Adds up nodes and their ends."""

    def __init__(self) -> None:
        self.nodes: dict[str, SystemNode] = {}
        self.ends: set[ChannelEnd] = set()
        self.spreading: set[ChannelEnd] = set()  # ends with channels below their name
        self.gaps: list[Gap] = []
        self.externals: dict[NodeExternal, None] = {}
        self.logs: dict[NodeLog, None] = {}
        self.used: dict[int, CodeNode] = {}  # by identity: they are not hashable

    def start(self, started: StartedNode, index: CodeIndex, packages: Sequence[Package]) -> None:
        """Add what a launch file starts."""
        for source, target in started.remaps:
            if is_open(source):
                self._gap(started.place, "remap", f"which name becomes {target} depends on {source}")
        codes = index.code_of(started)
        for code in codes:
            self.add_code(code, started)
        if codes:
            return
        what = f"{started.package or '?'}/{started.executable}"
        codes, files = index.loose_code_of(started)
        for code in codes:
            self.add_code(code, started, GUESSED)
        if codes:
            text = f"{what} is not what its package installs; it is taken to be {' or '.join(files)}"
            self._gap(started.place, "started", text)
            return
        entry = None if index.has_package(started.package) else catalogued(started, packages)
        self._add_without_code(started, entry)
        if started.package == CONTAINERS:
            return
        if entry:
            text = entry.beyond(what)
            if text:
                self._gap(started.place, "package", text)
            return
        if index.has_package(started.package):
            text = f"no node is found in the code of {what}: its channels are not known"
        else:
            text = f"the code of {what} is not here, and the catalogue does not state it: its channels are not known"
        self._gap(started.place, "started", text)

    def add_code(self, code: CodeNode, started: StartedNode | None, basis: str = LITERAL) -> None:
        """Add a node of the code, once under each name that it can have.

        Parameters
        ----------
        basis
            How it is known that it is this code.
        """
        self.used[id(code)] = code
        for node in self._running(code, started):
            if code.language == DESCRIBED:
                self._gap(code.place, "description", f"{node.name}: {DESCRIPTION_ALONE}")
            self._add_node(node._replace(basis=least_sure(basis, node.basis)), code.place, code)
            for place, kind, role, type_, name, below in _ends(code):
                final = running_name(name, kind, node)
                end = ChannelEnd(node.name, role, final.text, type_, least_sure(basis, final.basis), place)
                if self._add_end(end, final) and below:
                    self.spreading.add(end)
            for wrapper in code.wrappers:
                what = f"{node.name}: {wrapper.name} of another package makes channels by itself, which are not known"
                self._gap(wrapper.place, "wrapper", what)
            for external in code.externals:
                self.externals[NodeExternal(node.name, external)] = None
            for call in code.logs:
                channels = (running_name(name, "topic", node).text for name in call.channels)
                self.logs[NodeLog(node.name, tuple(sorted({*filter(None, channels)})), call)] = None

    def _running(self, code: CodeNode, started: StartedNode | None) -> Iterator[RunningNode]:
        """The names that a node of the code can have, with what the launch file says of it."""
        parameters = _parameters(started, "")
        own = [written_name(name, parameters) for name in code.names]
        own = self._resolved(own, code.place, f"the name of the node that {code.name} makes") or [
            RunningName(code.name.rpartition("::")[2], GUESSED)
        ]
        spaces = [written_name(name, parameters) for name in code.namespaces]
        spaces = self._resolved(spaces, code.place, f"the namespace of {code.name}") or [RunningName("/")]
        launch = _Renamed.of(started)
        for gap in launch.gaps:
            self._gap(*gap)
        for space in spaces if launch.namespace is None else [RunningName(launch.namespace, launch.basis)]:
            for base in own if launch.name is None else [RunningName(launch.name, launch.basis)]:
                plain = whole_namespace(spaces[0].text), own[0].text
                known = least_sure(space.basis, base.basis)
                node = RunningNode(
                    whole_namespace(space.text), base.text, known, launch.remaps, {}, plain, launch.basis
                )
                called = {} if launch.name is None else {NODE_NAME: launch.name}
                yield node._replace(parameters=_parameters(started, node.name) | called)

    def _resolved(self, names: list[RunningName], place: CodePlace, subject: str) -> list[RunningName]:
        """Those names that are not open; a gap for each that is."""
        for name in names:
            if name.why:
                self._gap(place, "node", f"{subject} is not known: {name.why}")
        return list(dict.fromkeys(name for name in names if not name.why))

    def _add_without_code(self, started: StartedNode, entry: Catalogued | None) -> None:
        """Add a node whose code is not there, with the interface that the catalogue states."""
        launch = _Renamed.of(started)
        for gap in launch.gaps:
            self._gap(*gap)
        usual = entry.usual_name if entry else ""
        base = launch.name or usual or started.executable.rpartition("::")[2].removesuffix(".py") or started.package
        known = launch.basis if launch.name else PACKAGE if usual else GUESSED
        if not launch.name and not usual:
            text = f"{started.package}/{started.executable} is started without a name: it is shown as {base}"
            self._gap(started.place, "node", text)
        node = RunningNode(whole_namespace(launch.namespace or ""), base, known, launch.remaps)
        self._add_catalogued(node, started, entry.node if entry else None)
        for name, made in entry.inner_nodes if entry else ():
            space, _, base = name.rpartition("/")
            inner = node._replace(namespace=whole_namespace(f"{node.namespace}/{space}"), base=base, basis=PACKAGE)
            self._add_catalogued(inner, started, made)

    def _add_catalogued(self, node: RunningNode, started: StartedNode, stated: PackageNode | None) -> None:
        """Add a node whose code is not there, with the channels that the catalogue states, if it does."""
        node = node._replace(parameters=_parameters(started, node.name))
        self._add_node(node, started.place, None)
        for interface, name in channel_names(stated, node, started.arguments) if stated else ():
            kind, role = USES[interface.use]
            final = running_name(name, kind, node)
            known = least_sure(PACKAGE, final.basis)
            self._add_end(ChannelEnd(node.name, role, final.text, interface.type, known, started.place), final)

    def _add_end(self, end: ChannelEnd, final: RunningName) -> bool:
        """Add an end; a gap where its name is open, or is none."""
        if not final.why and (is_name(final.text) or final.text == EVERY_TOPIC):
            self.ends.add(end)
            return True
        why = final.why or f"no {end.kind} of ROS can be called {final.text}"
        what = f"{A[end.kind]} ({end.role} {end.type})" if end.type else f"{A[end.kind]} ({end.role})"
        self._gap(end.place, "name", f"{end.node}: the name of {what} is not known: {why}")
        return False

    def _add_node(self, node: RunningNode, place: CodePlace, code: CodeNode | None) -> None:
        if not is_name(node.name):
            self._gap(place, "node", f"no node of ROS can be called {node.name}")
        before = self.nodes.get(node.name)
        if before is None or (before.code is None and code is not None):
            self.nodes[node.name] = SystemNode(node.name, node.basis, place, code)
        self.ends.add(ChannelEnd(node.name, "publish", *LOG, PACKAGE, place))

    def _gap(self, place: CodePlace, sort: str, text: str) -> None:
        self.gaps.append(Gap(place, sort, text))

    def system(self, launch: str, of_code: Iterable[Gap], idle: tuple[CodeNode, ...]) -> ScannedSystem:
        """Return what was added up; of what has no good name nothing."""
        names = {name for name in self.nodes if is_name(name)}
        ends = _surest(end for end in (*self.ends, *self._below()) if end.node in names)
        return ScannedSystem(
            launch,
            tuple(self.nodes[name] for name in sorted(names)),
            tuple(sorted(ends)),
            in_order((*self.gaps, *of_code)),
            tuple(external for external in self.externals if external.node in names),
            tuple(log for log in self.logs if log.node in names),
            idle,
        )

    def _below(self) -> Iterator[ChannelEnd]:
        """Ends at channels directly below that others use, such as ``/image/compressed``."""
        below: dict[tuple[str, str], set[str]] = defaultdict(set)
        for end in self.ends:
            below[end.role, end.name.rpartition("/")[0]].add(end.name)
        for end in self.spreading:
            for name in below.get((OTHER_SIDE.get(end.role, ""), end.name), ()):
                yield end._replace(name=name, type="")


class _Renamed(NamedTuple):
    """What a launch file says of a node's name; a part that is not fixed is as if it said nothing, and a gap."""

    name: str | None
    namespace: str | None
    basis: str
    remaps: tuple[tuple[str, str], ...]
    gaps: tuple[tuple[CodePlace, str, str], ...]

    @classmethod
    def of(cls, started: StartedNode | None) -> _Renamed:
        if started is None:
            return cls(None, None, LITERAL, (), ())
        rules = {
            source: target for source, target in reversed(started.remaps) if source in ("__node", "__name", "__ns")
        }
        name = rules.get("__node", rules.get("__name", started.name))
        space = rules.get("__ns", started.namespace)
        gaps = []
        if name and is_open(name):
            gaps.append((started.place, "node", f"the name of a node is {name} in the launch file"))
            name = None
        if space and is_open(space):
            gaps.append(
                (started.place, "node", f"the namespace of a node is {space} in the launch file; taken as none")
            )
            space = ""
        known = least_sure(LAUNCH if name or space else LITERAL, started.basis)
        remaps = tuple((source, target) for source, target in started.remaps if not is_open(source))
        return cls(name or None, space, known, remaps, tuple(gaps))


def _parameters(started: StartedNode | None, node: str) -> dict[str, str]:
    """What a launch file sets: of a node, also by the patterns of parameter files; what is open in braces."""
    if started is None:
        return {}
    values = {name: value for pattern, name, value in started.parameters_by_node if node and fits(pattern, node)}
    return values | dict(started.parameters) | {name: f"{{{name}}}" for name in started.open_parameters}


def _ends(code: CodeNode) -> Iterator[tuple[CodePlace, str, str, str, Name, bool]]:
    for end in code.endpoints:
        for name in end.names or (NO_NAME,):
            yield end.place, KINDS[end.role], end.role, end.type, name, end.below


def _surest(ends: Iterable[ChannelEnd]) -> Iterator[ChannelEnd]:
    """Each end of a line once, as it is known best; one with a type rather than one without."""
    best: dict[tuple[str, str, str, CodePlace], ChannelEnd] = {}
    for end in sorted(ends, key=lambda end: (BASES.index(end.basis), not end.type, end)):
        best.setdefault((end.node, end.role, end.name, end.place), end)
    return iter(best.values())


def in_order(gaps: Iterable[Gap]) -> tuple[Gap, ...]:
    """Return gaps by what they could hide, each once.

    >>> gaps = [Gap(CodePlace("a.py", 1), sort, "") for sort in ("file", "name")]
    >>> [gap.sort for gap in in_order(gaps)]
    ['name', 'file']
    """
    return tuple(sorted(set(gaps), key=lambda gap: (unresolved_rank(unresolved(gap.sort, "")), gap)))
