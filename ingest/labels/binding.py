"""Labels + graph -> ``Bound``: which statement is about which vertex or flow.

In: label files and a flow graph. Out: statements by index. A name that matches nothing is an error with the nearest
names that exist, never silence (rule S11).
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS, Tally
from rosprivacy.analysis.durations import ordered
from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.many_flows import at_most, leaving, parted
from rosprivacy.analysis.model import (
    NON_ROS,
    NOWHERE,
    PARTICIPANT,
    TYPE_LINE,
    Bound,
    Diagnostic,
    NonRosFacts,
    Severity,
    Surroundings,
)
from rosprivacy.analysis.non_ros import by_kind
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import A_LITTLE, FEW, bare_name, did_you_mean, is_glob, literal, nearest
from rosprivacy.ingest.labels.add_non_ros import recorded_types
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.labels.pins import Pinned, of_nothing, spot
from rosprivacy.ingest.labels.stated_facts import (
    everywhere,
    in_order,
    joined,
    of_no_channel,
    stated_at,
    two_of_one,
    united,
)
from rosprivacy.ingest.labels.strange_file import strange_files
from rosprivacy.ingest.policies.names import covered

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import FlowGraph, Place, Processing, Statement
    from rosprivacy.ingest.labels.entries import Entry, FlowEntry
    from rosprivacy.ingest.labels.label_file import Labels

NOT_STATED = Surroundings()
STEPS_OF_A_NAME = 4  # beside a glob
COMPARISONS = 50_000  # of names, in the search for the nearest; a label file of another system is refused soon
GLOB_LIKE_A_WILDCARD = "glob-like-a-wildcard"


class GraphNames:
    """The vertices of a graph by kind and name; what was matched once is known, whatever labels come after."""

    def __init__(self, graph: FlowGraph) -> None:
        self.graph = graph
        self.by_kind: dict[str, dict[str, list[int]]] = {}
        for vertex, element in enumerate(graph.elements):
            self.by_kind.setdefault(element.kind, {}).setdefault(element.name, []).append(vertex)
        self._matched: dict[tuple[str, tuple[str, ...]], tuple[int, ...]] = {}

    def matching(self, name: str, kinds: Iterable[str] | None = None) -> tuple[int, ...]:
        """Return the vertices of some kinds (of all by default) that a name or glob covers wholly, in order.

        >>> from rosprivacy.analysis.example import factory
        >>> GraphNames(factory()[0]).matching("/f*", ("node", "topic"))
        (2, 3, 5, 6)
        """
        asked = name, tuple(self.by_kind if kinds is None else kinds)
        if asked not in self._matched:
            known = [self.by_kind.get(kind, {}) for kind in asked[1]]
            self._matched[asked] = tuple(
                sorted(v for some in known for other in covered(name, some) for v in some[other])
            )
        return self._matched[asked]


class Unmatched:
    """The errors for names that match nothing, as long as looking for the nearest does not take too long."""

    def __init__(self, names: GraphNames) -> None:
        self._names, self._comparisons = names, 0

    def of_entry(self, entry: Entry) -> LabelError:
        """Return the error for a name that matches nothing, with the nearest names."""
        close = self._close(entry.name, entry.kinds)
        what = f"{shown(entry.name)!r} matches no {' or '.join(entry.kinds)} of the policies"
        name = bare_name(entry.name)
        elsewhere = [
            kind for kind in self._names.by_kind if kind not in entry.kinds and name in self._names.by_kind[kind]
        ]
        if elsewhere:
            hint = f"there is a {elsewhere[0]} of that name: move it to the section for it"
        else:
            hint = did_you_mean(close, "see the names with rosprivacy labels --init")
        return LabelError(entry.place.file, entry.place.line, what, hint)

    def of_flow(self, entry: FlowEntry) -> LabelError:
        """Return the error for a flow that is not there."""
        hints = []
        for end in (entry.source, entry.target):
            close = [] if self._names.matching(end) else self._close(end, self._names.by_kind)
            hints += [f"instead of {shown(end)} {did_you_mean(close)}"] if close else []
        what = f"no flow goes from {shown(entry.source)!r} to {shown(entry.target)!r}"
        hint = " ".join(hints) or "name two elements with a flow between them, in its direction"
        return LabelError(entry.place.file, entry.place.line, what, hint)

    def _close(self, name: str, kinds: Iterable[str]) -> list[str]:
        """The nearest names, as long as looking for them does not take too long."""
        known = [other for kind in kinds for other in self._names.by_kind.get(kind, {})]
        self._comparisons += len(known)
        if self._comparisons > COMPARISONS:
            return []
        return [literal(close) for close in nearest(bare_name(name), known, FEW, A_LITTLE)]


def misnamed(names: GraphNames, labels: Iterable[Labels]) -> list[LabelError]:
    """Return the errors for names of elements of ROS that match nothing, in files that could not be read whole.

    What lies outside ROS is stated by these files themselves.
    """
    unmatched = Unmatched(names)
    kinds = names.by_kind.keys() - set(NON_ROS)
    entries = (entry for file in labels if not file.shipped for entry in file.entries)
    of_ros = (entry for entry in entries if not kinds.isdisjoint(entry.kinds))
    return [unmatched.of_entry(entry) for entry in of_ros if not names.matching(entry.name, entry.kinds)]


def bind(
    graph: FlowGraph, labels: Sequence[Labels], bounds: Bounds = BOUNDS, system: Surroundings = NOT_STATED,
    names: GraphNames | None = None,
) -> Bound:  # fmt: skip
    """Join label files to a graph.

    Parameters
    ----------
    system
        Where it works, as a fleet file states it, beside what the label files say.
    names
        Those of the graph, by who has them already.

    Raises
    ------
    InputErrors
        With every name that matches nothing, but for shipped files; above a bound.
    """
    names = names or GraphNames(graph)
    bound, problems = join(graph, labels, bounds, system, names)
    if problems:
        raise InputErrors([*strange_files(labels, names.matching, names.by_kind), *problems])
    return bound


def join(
    graph: FlowGraph, labels: Sequence[Labels], bounds: Bounds = BOUNDS, system: Surroundings = NOT_STATED,
    names: GraphNames | None = None,
) -> tuple[Bound, list[InputError]]:  # fmt: skip
    """Join label files to a graph as far as its names go; return also what matches nothing."""
    names = names or GraphNames(graph)
    unmatched = Unmatched(names)
    _check_work(names, labels, bounds)
    elements: dict[int, list[Statement]] = defaultdict(list)
    flows: dict[int, list[Statement]] = defaultdict(list)
    through: dict[tuple[int, tuple[str, ...]], tuple[int, ...]] = {}
    subjects: dict[int, set[str]] = defaultdict(set)
    own: dict[int, Surroundings] = {}
    processing: dict[int, list[tuple[tuple[int, int], Processing]]] = defaultdict(list)
    types = recorded_types(graph, (stated for file in labels for stated in file.elements))
    flows_of = leaving(graph.flows)
    problems: list[InputError] = []
    for file in labels:
        pinned = Pinned(file.pins, file.type_pins)
        for entry in file.entries:
            vertices = names.matching(entry.name, entry.kinds)
            if not vertices and not file.shipped:
                problems.append(unmatched.of_entry(entry))
            for vertex in vertices:
                elements[vertex] += pinned.at(entry.statements, graph.elements[vertex])
                if entry.subjects:
                    subjects[vertex].update(entry.subjects)
                if entry.contexts:
                    own[vertex] = joined((own.get(vertex, NOT_STATED), Surroundings(entry.contexts)))
                if entry.processing:
                    processing[vertex].append((entry.rank, entry.processing))
            for vertex, one in stated_at(graph, entry, vertices):
                types[vertex].append(one)
            problems += of_no_channel(graph, entry, vertices)
            problems += _through(graph, flows_of, entry, vertices, through)
        for flow in file.flows:
            indices = _flows(graph, flows_of, names, flow)
            if not indices:
                problems.append(unmatched.of_flow(flow))
            for index in indices if flow.statements else ():
                ends = (graph.elements[end] for end in (graph.flows[index].source, graph.flows[index].target))
                flows[index] += pinned.at(flow.statements, *ends)
    outside = _outside(graph, labels)
    for vertex in (v for v in outside if by_kind(graph.elements[v])):
        elements[vertex] += by_kind(graph.elements[vertex])
    bound = Bound(
        {vertex: tuple(said) for vertex, said in sorted(elements.items())},
        {index: tuple(said) for index, said in sorted(flows.items())},
        through,
        outside,
        subjects={vertex: tuple(sorted(groups)) for vertex, groups in sorted(subjects.items())},
        surroundings=everywhere(graph, own, joined((system, *(file.surroundings for file in labels)))),
        processing={vertex: united(said) for vertex, said in sorted(processing.items())},
        of_robots={"": whole} if (whole := _of_system(labels, problems)) else {},
        types=in_order(types),
    )
    return bound, problems


def _of_system(labels: Iterable[Labels], problems: list[InputError]) -> Processing:
    """What the tops of label files say; two of one rank that name different controllers are a problem."""

    def differ(fact: str, first: Processing, other: Processing) -> None:
        problems.append(two_of_one(fact, first, other, LabelError))

    return united((((int(file.own), 0), file.processing) for file in labels), differ)


def _check_work(names: GraphNames, labels: Iterable[Labels], bounds: Bounds) -> None:
    """Globs times names grow faster than the files that state them."""
    work = Tally(bounds, "comparisons", LabelError)
    for file in labels:
        globs: list[tuple[str, Iterable[str], Place]] = []
        globs += [(entry.name, entry.kinds, entry.place) for entry in file.entries]
        globs += [(end.name, names.by_kind, flow.place) for flow in file.flows for end in flow.ends]
        for name, kinds, place in globs:
            if is_glob(name):
                work.add(STEPS_OF_A_NAME * sum(len(names.by_kind.get(kind, ())) for kind in kinds), place)


def remarks(graph: FlowGraph, labels: Iterable[Labels], names: GraphNames | None = None) -> Iterator[Diagnostic]:
    """Yield what a person has to know of names in label files, though they are no errors.

    A name in a user's own file of standard channels that matches nothing (rule S13); a glob that is written like the
    name of a wildcard, which means more than this one element; a pin that no glob speaks of (rule S11).

    Parameters
    ----------
    names
        As of ``bind``.
    """
    names = names or GraphNames(graph)
    for file in labels:
        if file.shipped and not file.file.startswith(OURS):
            yield from _unused(names, file)
        elif not file.shipped:
            yield from _like_a_wildcard(names, graph, file)
            yield from of_nothing(file.pins or (), _decided_by_globs(names, graph, file) if file.pins else ())
            lines = _taken_by_types(names, graph, file) if file.type_pins else ()
            yield from of_nothing(file.type_pins or (), lines, "a line only: by-type")
            nodes = _labelled_nodes(names, file) if file.code_pins else ()
            yield from of_nothing(file.code_pins, nodes, "a label", "--pin-code")


def _unused(names: GraphNames, file: Labels) -> Iterator[Diagnostic]:
    unmatched = Unmatched(names)
    for entry in file.entries:
        if not names.matching(entry.name, entry.kinds):
            error = unmatched.of_entry(entry)
            yield Diagnostic(entry.place, Severity.NOTICE, f"{error.problem}; {error.hint}")


def _decided_by_globs(names: GraphNames, graph: FlowGraph, file: Labels) -> Iterator[tuple[tuple[str, str], ...]]:
    """Elements and flows of which a glob says what a person has to have seen (rule S11)."""
    spots = list(map(spot, graph.elements))
    for entry in file.entries:
        if any(said.to_be_seen for said in entry.statements):
            yield from ((spots[vertex],) for vertex in names.matching(entry.name, entry.kinds))
    flows_of = leaving(graph.flows)
    for flow in file.flows:
        if any(said.to_be_seen for said in flow.statements):
            for index in _flows(graph, flows_of, names, flow):
                yield spots[graph.flows[index].source], spots[graph.flows[index].target]


def _labelled_nodes(names: GraphNames, file: Labels) -> Iterator[tuple[tuple[str, str], ...]]:
    """Nodes of which a label says what they do."""
    for entry in file.entries:
        if entry.statements and "node" in entry.kinds:
            yield from ((spot(names.graph.elements[vertex]),) for vertex in names.matching(entry.name, entry.kinds))


def _taken_by_types(names: GraphNames, graph: FlowGraph, file: Labels) -> Iterator[tuple[tuple[str, str], ...]]:
    """Channels of which a line says that they carry only what their types are made for."""
    for entry in file.entries:
        if any(said.role == TYPE_LINE for said in entry.statements):
            yield from ((spot(graph.elements[vertex]),) for vertex in names.matching(entry.name, entry.kinds))


def _like_a_wildcard(names: GraphNames, graph: FlowGraph, file: Labels) -> Iterator[Diagnostic]:
    told_apart = {entry.name for entry in file.entries}  # who labels the wildcard too knows of the difference
    for entry in file.entries:
        alone = literal(entry.name)
        if not entry.statements or not is_glob(entry.name) or alone in told_apart:
            continue
        if not names.matching(alone, entry.kinds):
            continue
        found = {graph.elements[vertex].identity for vertex in names.matching(entry.name, entry.kinds)}
        more = len(found) - sum(name == entry.name for _, _, name in found)
        if more:
            others = counted(more, "more element")
            what = f"{shown(entry.name)!r} is a glob: it means the wildcard of that name and {others}"
            hint = f'to label the wildcard alone, write "{shown(literal(entry.name))}"'
            yield Diagnostic(entry.place, Severity.WARNING, f"{what}; {hint}", GLOB_LIKE_A_WILDCARD)


def _outside(graph: FlowGraph, labels: Iterable[Labels]) -> dict[int, NonRosFacts]:
    """What is stated about the elements outside ROS, and how long they may keep what they hold."""
    files = list(labels)
    ranked = sorted(files, key=lambda file: file.own)
    stated = {(entry.kind, entry.name): entry.outside for file in ranked for entry in file.elements}
    limits = ordered({limit for file in files for limit in file.limits})
    found = _seen_participants(graph)
    for vertex, element in enumerate(graph.elements):
        if facts := stated.get((element.kind, element.name)):
            found[vertex] = facts._replace(limits=limits)
    return dict(sorted(found.items()))


def _seen_participants(graph: FlowGraph) -> dict[int, NonRosFacts]:
    """Participants that were seen and are of no node: they are there without a label (rule S16)."""
    seen = {vertex: NonRosFacts() for vertex, element in enumerate(graph.elements) if element.kind == PARTICIPANT}
    for flow in (*(flow for _, flow in parted(graph.flows)[0]), *graph.denied) if seen else ():
        for vertex in {flow.source, flow.target} & seen.keys():
            places = [seen[vertex].place, *(grant.place for grant in flow.grants)]
            first = min((at for at in places if at.file), key=lambda at: (at.file, at.line), default=NOWHERE)
            seen[vertex] = NonRosFacts(place=first)
    return seen


def _flows(graph: FlowGraph, flows_of: Mapping[int, range], names: GraphNames, entry: FlowEntry) -> list[int]:
    sources, targets = (names.matching(end.name, (end.kind,) if end.kind else None) for end in entry.ends)
    numbers = [flows_of[source] for source in sources if source in flows_of]
    flows, wanted = at_most(graph.flows, sum(map(len, numbers))), set(targets)
    return [index for some in numbers for index in some if flows[index].target in wanted]


def _through(
    graph: FlowGraph, flows_of: Mapping[int, range], entry: Entry, vertices: Sequence[int],
    through: dict[tuple[int, tuple[str, ...]], tuple[int, ...]],
) -> Iterable[InputError]:  # fmt: skip
    """Find the flows of a source that is one only through some channels; a channel it does not write is an error."""
    for expressions in {statement.through for statement in entry.statements if statement.through}:
        written: set[str] = set()
        for vertex in vertices:
            flows = {index: graph.elements[graph.flows[index].target].name for index in flows_of.get(vertex, ())}
            written.update(flows.values())
            chosen = {name for expression in expressions for name in covered(expression, set(flows.values()))}
            through[vertex, expressions] = tuple(index for index, name in flows.items() if name in chosen)
        for name in expressions:
            if vertices and not covered(name, written):
                close = [literal(one) for one in nearest(bare_name(name), sorted(written), FEW, A_LITTLE)]
                hint = did_you_mean(close, "name a channel that it writes to")
                what = f"{shown(entry.name)!r} writes to no channel {shown(name)!r}"
                yield LabelError(entry.place.file, entry.place.line, what, hint)
