"""Settings of bridges and recorders by which a person leaves a channel out: what to write where, and how sure it is.

In: an analysis, findings that a proposal removes, nodes that are recognised as well-known programs. Out:
``LeftOut``, bridges first. Nothing is decided by them: a program keeps to its settings, and DDS security knows nothing
of that, so the analysis stays as it is.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.many_flows import MATCHES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Confidence, Element

BRIDGE, RECORDER = "bridge", "recorder"
PROGRAMS = (BRIDGE, RECORDER)  # in the order in which they are told
LEFT_OUT, OTHERS = "left out", "others"
SET, TAKE_OUT = "set", "take out"
SERVED = "request"  # leg by which data gets to a node that serves: no setting is about that
PARAMETER, FILE, COMMAND = "parameter", "configuration file", "command line"


class ChannelSetting(NamedTuple):
    """One setting of a program, by which it leaves channels out.

    Attributes
    ----------
    channels
        Of this kind.
    where
        A parameter, a configuration file or a command line.
    action
        ``SET`` it so, or ``TAKE_OUT`` what is written.
    text
        What to write, with ``{names}`` for names of channels.
    names
        Which: those that are ``LEFT_OUT``, or the ``OTHERS`` of the node.
    name_form
        How a name is written, with ``{name}`` for it.
    between
        What stands between two names.
    from_root
        Whether a name is written with its first slash.
    note
        What else to know of it.
    """

    channels: str
    where: str
    action: str
    text: str
    names: str
    name_form: str
    between: str
    from_root: bool
    note: str

    def written(self, left_out: Iterable[str], used: Iterable[str]) -> str:
        """Return what to write.

        >>> setting = ChannelSetting("topic", PARAMETER, SET, "deny: [{names}]", LEFT_OUT, '"{name}"', ", ", True, "")
        >>> setting.written(["/video", "/voice"], [])
        'deny: ["/video", "/voice"]'
        """
        names = [*(left_out if self.names == LEFT_OUT else used)]
        written = (
            self.name_form.replace("{name}", name if self.from_root else name.removeprefix("/")) for name in names
        )
        return self.text.replace("{names}", self.between.join(written))


class SettingSource(NamedTuple):
    """What a setting was read in: an address, a commit, files, the day."""

    at: str
    commit: str
    files: tuple[str, ...]
    read: str


class Program(NamedTuple):
    """A well-known bridge or recorder: its package, its node as the catalogue of packages calls it, its settings."""

    package: str
    node: str
    kind: str
    settings: tuple[ChannelSetting, ...]
    sources: tuple[SettingSource, ...]


class RecognisedProgram(NamedTuple):
    """A node of a graph that is called like a program: how sure that is, and what of it agrees."""

    vertex: int
    program: Program
    confidence: Confidence
    agrees: str


class WrittenSetting(NamedTuple):
    """A setting with its names."""

    setting: ChannelSetting
    text: str


class LeftOut(NamedTuple):
    """How a person makes a program leave channels out.

    Attributes
    ----------
    element
        The node.
    channels
        Through which the data of the findings gets to it, in the order of the graph: those that a setting is about, and
        whose names can be written into it. Of services and actions those that it calls.
    settings
        For these channels, the first one first.
    """

    element: Element
    recognised: RecognisedProgram
    channels: tuple[Element, ...]
    settings: tuple[WrittenSetting, ...]


def left_out(
    analysis: Analysis, findings: Iterable[Finding], recognised: Iterable[RecognisedProgram]
) -> tuple[LeftOut, ...]:
    """Return the settings by which programs leave out what some findings are about; O(flows).

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.model import Confidence
    >>> analysis = analyse(*factory())
    >>> topics = ChannelSetting("topic", PARAMETER, SET, "topics: [{names}]", OTHERS, "{name}", ", ", True, "")
    >>> program = Program("archive", "archive", BRIDGE, (topics,), ())
    >>> at = [element.name for element in analysis.graph.elements].index("/archive")
    >>> archive = RecognisedProgram(at, program, Confidence.MAY, "its name alone")
    >>> for row in left_out(analysis, analysis.findings, [archive]):
    ...     print([channel.name for channel in row.channels], [one.text for one in row.settings])
    ['/faces', '/filtered'] ['topics: []']
    """
    by_vertex = {one.vertex: one for one in recognised}
    if not by_vertex:
        return ()
    ends = _ends(analysis, findings, set(by_vertex))
    reads, writes = _channels(analysis, set(ends))
    rows = []
    for vertex in sorted(ends, key=lambda v: (PROGRAMS.index(by_vertex[v].program.kind), v)):
        carried, elements = _arriving(analysis.spread, vertex, ends[vertex]), analysis.graph.elements
        channels = [c for c, bits in sorted(reads[vertex].items()) if bits & carried and elements[c].leg != SERVED]
        row = _row(analysis, by_vertex[vertex], channels, {*reads[vertex], *writes[vertex]})
        if row.settings:
            rows.append(row)
    return tuple(rows)


def _ends(analysis: Analysis, findings: Iterable[Finding], programs: set[int]) -> dict[int, int]:
    """The programs at the ends of findings, with the bits of these: leaks, and what writes into a storage."""
    number = {element: vertex for vertex, element in enumerate(analysis.graph.elements)}
    ends: dict[int, int] = defaultdict(int)
    beyond: dict[int, int] = defaultdict(int)
    for finding in findings:
        vertex, bits = number[finding.leak], analysis.spread.forms_of(finding.category)
        if vertex in programs:
            ends[vertex] |= bits
        elif not (finding.leak.is_node or finding.leak.is_channel):
            beyond[vertex] |= bits
    for index, flow in enumerate(analysis.graph.flows) if beyond else ():
        if flow.source in programs and flow.target in beyond and analysis.spread.along(index) & beyond[flow.target]:
            ends[flow.source] |= beyond[flow.target]
    return dict(ends)


Read = dict[int, dict[int, int]]  # vertex of a node -> channels -> the bits that they bring
Written = dict[int, set[int]]  # vertex of a node -> channels


def _channels(analysis: Analysis, nodes: set[int]) -> tuple[Read, Written]:
    """What nodes read and write, wildcards by the channels that they take in."""
    elements, flows = analysis.graph.elements, analysis.graph.flows
    reads: Read = {node: {} for node in nodes}
    writes: Written = {node: set() for node in nodes}
    of_pattern: dict[int, list[int]] = defaultdict(list)
    for index, flow in enumerate(flows) if nodes else ():
        node, channel = (flow.target, flow.source) if flow.target in nodes else (flow.source, flow.target)
        if node not in nodes or not elements[channel].is_channel:
            continue
        if elements[channel].pattern:
            of_pattern[channel].append(node)
        elif node == flow.target:
            reads[node][channel] = reads[node].get(channel, 0) | analysis.spread.along(index)
        else:
            writes[node].add(channel)
    for index, flow in enumerate(flows) if of_pattern else ():
        if flow.role == MATCHES and not elements[flow.source].pattern:
            for node in of_pattern.get(flow.target, ()):
                reads[node][flow.source] = reads[node].get(flow.source, 0) | analysis.spread.along(index)
        elif flow.role == MATCHES and not elements[flow.target].pattern:
            for node in of_pattern.get(flow.source, ()):
                writes[node].add(flow.target)
    return reads, writes


def _arriving(spread: Spread, vertex: int, bits: int) -> int:
    """The bits of which an element makes some, and these."""
    before = 0
    while before != bits:
        before = bits
        for arrives, leaves in spread.derives.get(vertex, ()):
            bits |= arrives if leaves & bits else 0
    return bits


def _row(analysis: Analysis, node: RecognisedProgram, channels: Iterable[int], every: Iterable[int]) -> LeftOut:
    """The settings of one program, of the kinds of its channels; legs of a service are one name."""
    elements = analysis.graph.elements
    kinds = {setting.channels for setting in node.program.settings}
    closed = [c for c in channels if elements[c].kind in kinds and is_plain(elements[c].name)]
    names, others = _names(elements, closed), _names(elements, sorted(every))
    settings = tuple(
        WrittenSetting(setting, setting.written(mine, [name for name in others[setting.channels] if name not in mine]))
        for setting in node.program.settings
        if (mine := names[setting.channels])
    )
    return LeftOut(elements[node.vertex], node, tuple(elements[c] for c in closed), settings)


def _names(elements: Sequence[Element], vertices: Iterable[int]) -> Mapping[str, list[str]]:
    """The names of channels by their kind, each once, sorted."""
    names: dict[str, set[str]] = defaultdict(set)
    for vertex in vertices:
        if is_plain(elements[vertex].name):
            names[elements[vertex].kind].add(elements[vertex].name)
    return defaultdict(list, {kind: sorted(some) for kind, some in names.items()})


def is_plain(name: str) -> bool:
    """Return whether a name means itself in every list, as names of ROS do.

    >>> is_plain("/camera/image_raw"), is_plain("/a*"), is_plain("/it's")
    (True, False, False)
    """
    return name.isascii() and all(letter.isalnum() or letter in "/_" for letter in name)
