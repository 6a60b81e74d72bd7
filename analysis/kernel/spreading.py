"""Graph + labels -> what every element does with every category, and what arrives where (rules S7, S8).

In: a ``FlowGraph``, the statements bound to it, the hierarchy. Out: a ``Spread``: sets of bits per vertex, as Python
integers, which have as many bits as are needed (``bits.py``). Nothing takes away what a source sends through channels
that it names: statements that would close one to it do not count there, in neither leg of a service or action; a
user's full name that says so is an error.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.kernel.labelled_graph import LabelledGraph
from rosprivacy.analysis.kernel.least_solution import least_solution
from rosprivacy.analysis.kernel.overruled import overruled
from rosprivacy.analysis.kernel.ranks import applies, closes, in_words
from rosprivacy.analysis.kernel.roles import Facts, facts
from rosprivacy.analysis.kernel.search import searches_after
from rosprivacy.analysis.kernel.spread import Spread
from rosprivacy.analysis.many_flows import MATCHES, at_most, number, parted
from rosprivacy.analysis.model import CHANGED, STATED, Method

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Bound, FlowGraph, Place, Statement

    Meaning = dict[int, dict[str, Facts]]  # vertex or flow -> category -> what it does with it


def spread(graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, before: Spread | None = None) -> Spread:
    """Apply labels to a graph and carry every category to where it can get.

    Parameters
    ----------
    before
        The spread of an earlier answer: what was found of the same graph holds here, too, and where data goes the same
        ways what was found of that.

    Raises
    ------
    InputErrors
        If statements of equal rank contradict each other.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> carried = spread(*factory())
    >>> carried.planes(carried.arrives[ARCHIVE])  # as they are, pseudonymised
    (('FaceTemplate',), ('Video',))
    """
    result = meaning(graph, bound, hierarchy, emitted(bound.elements.values()), before=before)
    changed = None if before is None else result.otherwise(before)
    if before is not None and before.graph is graph:
        result.shape = before.shape
    if before is not None and changed is not None:
        searches_after(before, result, changed)
    if before is not None and changed == set():
        result.course = before.course
        result.arrives, result.leaves, result.sent = before.arrives, before.leaves, before.sent
    else:
        fill(result, *least_solution(LabelledGraph.of(result)))
    return result


class LeftOut(NamedTuple):
    """A statement that is left out of what a spread says: of what it does not apply to, all stays as it was."""

    spread: Spread
    statement: Statement


def meaning(
    graph: FlowGraph, bound: Bound, hierarchy: Hierarchy, categories: Iterable[str], left_out: LeftOut | None = None,
    before: Spread | None = None,
) -> Spread:  # fmt: skip
    """Apply labels to a graph, and carry nothing yet.

    Parameters
    ----------
    categories
        That have bits: those that are emitted, here or in the other parts of what this is a part of.
    left_out
        What was said before of the same elements and flows, but for this; no source names channels there.
    before
        As of ``spread``.

    Raises
    ------
    InputErrors
        If statements of equal rank contradict each other.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> labelled = meaning(*factory(), ["FaceTemplate", "Video"])
    >>> labelled.names(labelled.leaks[ARCHIVE]), labelled.arrives
    (('FaceTemplate', 'Video'), {})
    """
    spread = Spread(graph, tuple(sorted(categories)), hierarchy=hierarchy)
    problems = _decide(spread, bound, hierarchy, left_out, before)
    spread.overruled = overruled(spread.facts, graph.elements)
    problems += keep_named(spread.facts, spread.flow_facts, graph, bound, hierarchy)
    restricted = any(statement.through for said in bound.elements.values() for statement in said)
    stated = stated_flows(graph) if restricted else {}
    for category, _, vertex, _ in channels_of_sources(spread.facts, graph, bound):
        if category in spread.categories:
            spread.channel_sources[vertex] = spread.channel_sources.get(vertex, 0) | spread.forms_of(category)
    alike: dict[int, _Does] = {}
    for vertex in bound.elements:
        decided = spread.facts[vertex]
        if id(decided) not in alike:
            alike[id(decided)] = _Does.of(spread, decided)
        _set_vertex(spread, vertex, alike[id(decided)])
        _begin_through(spread, vertex, bound, stated)
    spread.absent_bits.update(_read_by_nobody(spread))
    for index, kept in spread.flow_facts.items():
        spread.flow_keeps[index] = _bits(spread, kept, lambda fact: fact.passes)
    if problems:
        raise InputErrors(problems)
    return spread


def _decide(
    spread: Spread, bound: Bound, hierarchy: Hierarchy, left_out: LeftOut | None, before: Spread | None
) -> list[InputError]:
    """Put in what each element and flow does with each category; return where statements contradict each other."""
    same = before is not None and (before.categories, before.hierarchy) == (spread.categories, hierarchy)
    decisions = before.decisions if before and same else {}
    elements, flows = spread.graph.elements, spread.graph.flows
    problems: list[InputError] = []
    alike: dict[tuple[int, ...], dict[str, Facts]] = {}  # globs say the same of many elements

    def decide(statements: tuple[Statement, ...], name: str, before: Mapping[str, Facts]) -> dict[str, Facts]:
        key = tuple(map(id, statements))
        if key in alike:
            return alike[key]
        if statements in decisions:
            spread.decisions[statements] = alike[key] = decisions[statements]
            return alike[key]
        mentioned = {category for statement in statements for category in statement.categories}
        result: dict[str, Facts] = {}
        known = len(problems)
        for category in sorted(mentioned.union(spread.categories) or hierarchy.ancestors):
            if left_out and category in before and not applies(left_out.statement, category, hierarchy):
                result[category] = before[category]
                continue
            try:
                result[category] = facts(name, statements, category, hierarchy)
            except InputError as error:
                problems.append(error)
        if len(problems) == known:
            alike[key] = result
            if not left_out:
                spread.decisions[statements] = result
        return result

    facts_before = left_out.spread.facts if left_out else {}
    flow_facts_before = left_out.spread.flow_facts if left_out else {}
    for vertex, said in bound.elements.items():
        spread.facts[vertex] = decide(said, elements[vertex].name, facts_before.get(vertex, {}))
    for index, said in bound.flows.items():
        source, target = elements[flows[index].source], elements[flows[index].target]
        name = f"the flow {source.name} -> {target.name}"
        spread.flow_facts[index] = decide(said, name, flow_facts_before.get(index, {}))
    return problems


def emitted(elements: Iterable[Iterable[Statement]]) -> set[str]:
    """Return the categories that a source names or a derivation makes: only these have bits (rule S7).

    >>> from rosprivacy.analysis.example import factory
    >>> _, bound, _ = factory()
    >>> sorted(emitted(bound.elements.values()))
    ['FaceTemplate', 'Video']
    """
    names: set[str] = set()
    for said in elements:
        for statement in said:
            if statement.role == "source":
                names.update(statement.categories)
            elif statement.role == "derivation":
                names.add(statement.to)
    return names


def _bits(spread: Spread, decided: Mapping[str, Facts], test: Callable[[Facts], bool]) -> int:
    """The bits, in both planes, of the emitted categories whose facts pass a test."""
    bits = 0
    for category, fact in decided.items():
        if test(fact):
            bits |= spread.forms_of(category)
    return bits


class _Does(NamedTuple):
    """What elements do of which the same is said; as of ``Spread``."""

    standard: bool
    limited: int
    absent_bits: int
    keeps: int
    leaks: int
    covered: int
    derives: tuple[tuple[int, int], ...]
    emits: int
    made_categories: frozenset[int]

    @classmethod
    def of(cls, spread: Spread, decided: Mapping[str, Facts]) -> _Does:
        keeps = covered = leaks = limited = gone = emits = 0
        pairs: set[tuple[int, int]] = set()
        made: set[int] = set()
        derives = {category: fact.derives for category, fact in decided.items() if fact.derives}
        closed = _closed(spread, derives) if derives else {}
        for category, fact in decided.items():
            both = spread.forms_of(category)
            keeps |= both if fact.passes else 0
            covered |= both if fact.covered else 0
            leaks |= both if fact.leaks else 0
            limited |= both if fact.limited else 0
            gone |= both if fact.method == Method.ABSENT else 0
            for made_here in (s.to for s in fact.reviewers if s.role == "derivation"):
                covered |= spread.forms_of(made_here)  # who makes it knows of it
            if both and (fact.emits or fact.pseudonymises or category in closed):
                i = spread.categories.index(category)
                plain, pseudonymised = spread.bits.forms(i)
                after = closed.get(category, set())
                for j in after:
                    pairs.update(zip((plain, pseudonymised), spread.bits.forms(j), strict=True))
                made.update(after)
                if fact.pseudonymises:
                    pairs.add((plain, pseudonymised))
                    keeps |= 1 << pseudonymised  # what is pseudonymised already goes on so (rule S8)
                if fact.emits:  # what a node makes of its own data leaves it like what it makes of others'
                    emits |= sum(1 << spread.bits.plain(j) for j in after)
                    emits |= 0 if fact.through else 1 << plain
        standard = any(fact.standard for fact in decided.values())
        return cls(standard, limited, gone, keeps, leaks, covered, tuple(sorted(pairs)), emits, frozenset(made))


def _set_vertex(spread: Spread, vertex: int, does: _Does) -> None:
    if does.standard:
        spread.standard.add(vertex)
    if does.limited:
        spread.limited[vertex] = does.limited
    if does.absent_bits:
        spread.absent_bits[vertex] = does.absent_bits
    if does.absent_bits == spread.all_bits != 0:
        spread.absent.add(vertex)
    spread.keeps[vertex] = does.keeps
    spread.leaks[vertex] = does.leaks
    spread.covered[vertex] = does.covered
    spread.derives[vertex] = does.derives
    spread.emits[vertex] = does.emits
    spread.made_categories.update(does.made_categories)


def _read_by_nobody(spread: Spread) -> dict[int, int]:
    """What is read from wildcards, with the bits for which nobody to whom that is granted is there."""
    own, meetings = parted(spread.graph.flows) if spread.absent_bits else ((), ())
    ends: list[tuple[tuple[int, ...], tuple[int, ...]]] = [((flow.source,), (flow.target,)) for _, flow in own]
    ends += [(meeting.written, meeting.read) for meeting in meetings if meeting.of_written]
    read: dict[int, int] = {}
    for channels, readers in ends:
        for vertex in (v for v in channels if spread.graph.elements[v].side == "read"):
            for reader in readers:
                read[vertex] = read.get(vertex, spread.all_bits) & spread.absent_bits.get(reader, 0)
    return {vertex: bits for vertex, bits in read.items() if bits}


def _begin_through(spread: Spread, vertex: int, bound: Bound, stated: Mapping[int, Collection[int]]) -> None:
    """Put in what an element emits along single flows only."""
    for category, fact in spread.facts[vertex].items():
        if fact.emits and fact.through and category in spread.categories:
            plain = 1 << spread.bits.plain(spread.categories.index(category))
            for flow in {*bound.through.get((vertex, fact.through), ()), *stated.get(vertex, ())}:
                spread.flow_emits[flow] = spread.flow_emits.get(flow, 0) | plain
                spread.flow_begins[vertex] = spread.flow_begins.get(vertex, 0) | plain


def _closed(spread: Spread, derives: Mapping[str, tuple[str, ...]]) -> dict[str, set[int]]:
    """Numbers of what is made of each category, and of that in turn; of those that are emitted."""
    made = {category: set(to) for category, to in derives.items() if spread.forms_of(category)}
    changed = True
    while changed:
        changed = False
        for after in made.values():
            more = {further for to in after for further in made.get(to, ())} - after
            after.update(more)
            changed = changed or bool(more)
    return {category: {*map(spread.categories.index, after - {category})} for category, after in made.items()}


def fill(spread: Spread, arrives: dict[int, int], leaves: dict[int, int]) -> None:
    """Put the fixpoint in: of elements, where there are any bits.

    >>> from rosprivacy.analysis.example import ROSOUT, factory
    >>> labelled = meaning(*factory(), ["FaceTemplate", "Video"])
    >>> fill(labelled, *least_solution(LabelledGraph.of(labelled)))
    >>> labelled.names(labelled.arrives[ROSOUT]), labelled.leaves.get(ROSOUT, 0)
    (('Video',), 0)
    """
    spread.arrives, spread.leaves = arrives, leaves
    spread.sent = dict(leaves)
    for vertex, bits in spread.flow_begins.items():  # through one channel only is still from here
        spread.leaves[vertex] = spread.leaves.get(vertex, 0) | bits


def stated_flows(graph: FlowGraph) -> dict[int, list[int]]:
    """Return vertex -> the flows out of it that a person states: channels that a source names do not restrict these.

    >>> from rosprivacy.analysis.example import NAMES, factory
    >>> graph, _, _ = factory()
    >>> {NAMES[vertex]: [NAMES[graph.flows[i].target] for i in flows] for vertex, flows in stated_flows(graph).items()}
    {'/archive': ['disk']}
    """
    stated: dict[int, list[int]] = defaultdict(list)
    for index, flow in parted(graph.flows)[0]:
        if flow.role == STATED:
            stated[flow.source].append(index)
    return dict(stated)


def keep_named(
    elements: Meaning, flows: Meaning, graph: FlowGraph, bound: Bound, hierarchy: Hierarchy
) -> Iterator[InputError]:
    """Let pass what sources name channels for, in place; yield where a user's full name closes one.

    Parameters
    ----------
    elements, flows
        What statements mean for each.

    Examples
    --------
    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.model import Bound, Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> source = Statement("source", ("Video",), (1, 1), Place("labels.yaml", 2), through=("/video",))
    >>> never = Statement("never", ("Video",), (1, 1), Place("labels.yaml", 9))
    >>> bound = Bound({CAMERA: (source,), VIDEO: (never,)}, through={(CAMERA, source.through): (2,)})
    >>> elements = {v: {"Video": facts("", said, "Video", hierarchy)} for v, said in bound.elements.items()}
    >>> print(*keep_named(elements, {}, graph, bound, hierarchy))
    labels.yaml:9: /video is never [Video] here, and the source at labels.yaml:2 names it for Video; keep one of them
    """
    told: set[tuple[Place, Place]] = set()
    for category, source, vertex, index in channels_of_sources(elements, graph, bound):
        for meaning, of, at in ((elements, bound.elements, vertex), (flows, bound.flows, index)):
            decided = meaning.get(at, {}).get(category)
            if decided is None or decided.passes:
                continue
            kept = [s for s in of[at] if s.by_name or not closes(s, category, hierarchy)]
            name = graph.elements[vertex].name
            now = facts(name, kept, category, hierarchy)
            meaning[at] = {**meaning[at], category: now}  # elements of which the same is said share the other one
            for closer in now.closers:
                if closer.rank[0] < CHANGED and (closer.place, source.place) not in told:
                    told.add((closer.place, source.place))
                    yield _contradiction(name, category, closer, source)


def channels_of_sources(
    elements: Mapping[int, Mapping[str, Facts]], graph: FlowGraph, bound: Bound
) -> list[tuple[str, Statement, int, int]]:
    """Return (category, statement of a source, channel that it names, flow to it), with what wildcards match there.

    With the leg of a service or an action that the source writes comes the other, to which it has no flow: -1.

    >>> from rosprivacy.analysis.example import CAMERA, NAMES, factory
    >>> from rosprivacy.analysis.model import Bound, Place, Statement
    >>> graph, _, hierarchy = factory()
    >>> source = Statement("source", ("Video",), (1, 1), Place("labels.yaml", 2), through=("/video",))
    >>> bound = Bound({CAMERA: (source,)}, through={(CAMERA, source.through): (2,)})
    >>> elements = {CAMERA: {"Video": facts("/camera", (source,), "Video", hierarchy)}}
    >>> [(category, NAMES[channel], flow) for category, _, channel, flow in channels_of_sources(elements, graph, bound)]
    [('Video', '/video', 2)]
    """
    rows: list[tuple[str, Statement, int, int]] = []
    if not bound.through:
        return rows
    matches: dict[int, list[int]] = defaultdict(list)
    met: dict[int, list[int]] = defaultdict(list)
    own, meetings = parted(graph.flows)
    for index, flow in own:
        if flow.role == MATCHES and graph.elements[flow.target].is_channel:  # past a proposed filter one ends at a node
            matches[flow.source].append(index)
    for meeting in (one for one in meetings if one.of_wildcards):
        for written in meeting.written:
            met[written] += meeting.read
    legs: dict[tuple[str, str, str], list[int]] = defaultdict(list)
    for vertex, element in enumerate(graph.elements):
        if element.leg:
            legs[element.identity].append(vertex)
    for vertex, decided in elements.items():
        for category, fact in decided.items():
            for source in fact.by_role("source")[:1]:
                indices = bound.through.get((vertex, source.through), ())
                ends = {graph.flows[i].target: i for i in _with_matches(indices, graph, matches, met)}
                both = {leg: -1 for end in ends for leg in legs.get(graph.elements[end].identity, ())}
                rows += [(category, source, end, index) for end, index in {**both, **ends}.items()]
    return rows


def _with_matches(
    indices: Iterable[int], graph: FlowGraph, matches: Mapping[int, list[int]], met: Mapping[int, list[int]]
) -> list[int]:
    """Flows, and those from the wildcards at their ends to the channels that these match or meet."""
    flows = list(indices)
    seen = set(flows)
    for index in flows:
        end = graph.flows[index].target
        every = sorted([*matches.get(end, ()), *(number(graph.flows, end, read) for read in met.get(end, ()))])
        at_most(graph.flows, len(flows) + len(every))
        new = [after for after in every if after not in seen]
        seen.update(new)
        flows += new
    return flows


def _contradiction(name: str, category: str, closer: Statement, source: Statement) -> LabelError:
    what = f"{shown(name)} is {in_words(closer)} here, and the source at {source.place} names it for {category}"
    return LabelError(closer.place.file, closer.place.line, what, "keep one of them")
