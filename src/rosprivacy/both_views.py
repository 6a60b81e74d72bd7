"""A system under both views (rule S6): the declared answer of record, what the enforced view adds, and what ends that.

In: names of files and settings. Out: the declared ``Result``, with the findings that are there only because a node may
do what other profiles of its enclave may, the enclaves that make each possible, and what takes it away: splitting an
enclave is the first proposal; moving one profile to an enclave of its own is the smaller one, where that is enough; a
DENY has a price, since it holds for the whole enclave: who rightly has the grant loses it, too (rule S5). Each is
proven by a new analysis of what the findings hang on; where a change only takes flows away, nothing is read, bound or
spread anew.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.beyond import Added, DenyLine, beyond, enclaves_of, granted, rights
from rosprivacy.analysis.findings.findings import chosen_findings
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.kernel.spreading import spread
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.many_flows import parted
from rosprivacy.analysis.model import NON_ROS
from rosprivacy.analysis.modes import View
from rosprivacy.answer import Enforced
from rosprivacy.answering import answer
from rosprivacy.ingest.deployed.zenoh_grants import ANY_SESSION
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, PolicyChange, changed_graph
from rosprivacy.ingest.policies.names import DDS, is_pattern, writable
from rosprivacy.question import question_of
from rosprivacy.systems.robot_system import system_reader

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding, Step
    from rosprivacy.analysis.findings.beyond import Ends, Right
    from rosprivacy.analysis.findings.findings import Chosen
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Bound, Element, Place, Profile
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings
    from rosprivacy.system import System

    Reader = Callable[[PolicyChange], System]

TRIED = 20  # changes of each kind, each an analysis of its own


def both_views(policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings) -> Result:
    """Analyse policies under both views.

    Returns
    -------
    Result
        Of the declared view, with ``enforced``.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    return _both_views(settings, lambda question: system_reader(policies, labels, question))


def both_views_of_fleet(file: str, settings: Settings) -> Result:
    """Analyse a fleet under both views; the enforced one adds to a pattern where one of its robots did not have it.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    from rosprivacy.systems.fleet_system import fleet_reader  # noqa: PLC0415 - light start

    return _both_views(settings, lambda question: fleet_reader(file, question))


def _both_views(settings: Settings, reader: Callable[[Question], Reader]) -> Result:
    of_record = question_of(replace(settings, view=View.declared.value))
    question = question_of(replace(settings, view=View.enforced.value))._replace(every=True)
    declared, enforced = reader(of_record), reader(question)
    system = declared(NO_CHANGE)
    result = answer(system, of_record)
    every = answer(system, of_record._replace(every=True)) if system.is_fleet else result
    declared_ids = {finding.id: finding.pseudonymised for finding in every.analysis.findings if not finding.dismissed}
    whole = enforced(NO_CHANGE)
    found = answer(whole, question)
    remedies = Remedies(
        ChangeTrials(whole, found, enforced, question),
        declared,
        granted(system.graph),
        _enclaves(whole.graph.profiles),
        whole.likeness.second,
        {one for one, pseudonymised in declared_ids.items() if pseudonymised},
    )
    new = [  # accepted ones, too
        one for one in found.analysis.findings if not one.dismissed and _is_new(one, declared_ids)
    ]
    added = tuple(_added(new, remedies, whole.likeness))
    more = {shown for shown, _ in _open(found) - _open(every) if shown[0] not in whole.likeness.second}
    elements = {one.element.shown_as: one.element for one in found.analysis.open}
    outside_first = sorted((elements[shown] for shown in more), key=lambda e: (e.kind not in NON_ROS, e.sort_key()))
    return replace(result, enforced=Enforced(found, added, tuple(outside_first)))


def _is_new(finding: Finding, declared_ids: Mapping[str, bool]) -> bool:
    """Whether the declared view has it not, or only in pseudonymised form while plain data is in it now (rule S10)."""
    return finding.id not in declared_ids or (declared_ids[finding.id] and not finding.pseudonymised)


def _open(result: Result) -> set[tuple[tuple[str, str, str, str], str]]:
    """The open questions: what a reader sees of an element, and a category."""
    return {(one.element.shown_as, category) for one in result.analysis.open for category in one.categories}


def _added(findings: Iterable[Finding], remedies: Remedies, likeness: Likeness) -> Iterator[Added]:
    """Findings that differ only in the robot are told once, with the robots where they are added."""
    alike: dict[tuple[str, bool], list[Finding]] = {}
    for finding in findings:
        if likeness.count(finding) or not likeness.members:
            alike.setdefault((pattern_id(finding, likeness), finding.id in remedies.hidden), []).append(finding)
    for some in alike.values():
        robots = {name for one in some for name in likeness.placed(one.source.robot) or likeness.placed(one.leak.robot)}
        yield remedies.of(some, tuple(sorted(robots)))


def _enclaves(profiles: Iterable[Profile]) -> Mapping[str, frozenset[str]]:
    nodes: dict[str, set[str]] = {}
    for profile in profiles:
        nodes.setdefault(profile.enclave, set()).add(profile.node)
    return {enclave: frozenset(inside) for enclave, inside in nodes.items()}


@dataclass(frozen=True, slots=True)
class Remedies:
    """Looks for remedies; what was tried for one finding is not tried again for another.

    Attributes
    ----------
    trials
        Tell what a change leaves of findings under the enforced view.
    declared
        Reads the policies with a change.
    granted
        The flows that profiles allow.
    enclaves
        The nodes of each enclave.
    second
        Robots that only stand beside others like them.
    hidden
        Ids of the findings that the declared view has in pseudonymised form only: that form is left.
    """

    trials: ChangeTrials
    declared: Callable[[PolicyChange], System]
    granted: frozenset[Ends]
    enclaves: Mapping[str, frozenset[str]]
    second: Collection[str]
    hidden: Collection[str] = ()
    tried: set[PolicyChange] = field(default_factory=set)
    allowed: dict[PolicyChange, frozenset[Right]] = field(default_factory=dict)
    counts: dict[int, int] = field(default_factory=dict)

    def of(self, findings: Sequence[Finding], robots: tuple[str, ...] = ()) -> Added:
        """Return what ends some findings that differ only in the robot, of which the first is told."""
        steps = beyond(findings[0], self.granted)
        shared = self._shared(findings[0])
        enclaves = {path for one in findings for path in enclaves_of(one, self._shared(one))}
        deny = self._deny(findings)
        loses: frozenset[Right] = frozenset()
        if deny:
            try:
                loses = self._rights(NO_CHANGE) - self._rights(PolicyChange(deny=frozenset(deny)))
            except InputErrors:  # labels name what would be denied
                deny = ()
        return Added(
            findings[0],
            beyond=steps,
            enclaves=tuple(sorted(enclaves)),
            split=self._split(findings),
            move=self._move(findings[0], findings),
            deny=deny,
            loses=tuple(sorted(right for right in loses if right[0][0] not in self.second)),
            robots=robots,
            opened=_places(findings[0], set(steps) - set(shared)),
            findings=tuple(findings),
            plain=findings[0].id in self.hidden,
        )

    def _shared(self, finding: Finding) -> tuple[int, ...]:
        """The steps beyond a profile that an enclave of several nodes allows; others nobody asks permissions for."""
        steps = ((n, finding.steps[n]) for n in beyond(finding, self.granted))
        return tuple(
            n for n, step in steps
            if all(g.node != _ends(step)[0].name and len(self.enclaves.get(g.enclave, ())) > 1 for g in step.grants)
        )  # fmt: skip

    def _split(self, findings: Sequence[Finding]) -> tuple[str, ...]:
        enclaves: frozenset[str] = frozenset()
        left: Sequence[Finding] | None = findings
        while left:
            more = enclaves.union(*(enclaves_of(one, self._shared(one)) for one in left))
            if more == enclaves:
                return ()
            enclaves = more
            left = self._still_open(PolicyChange(split=enclaves), findings)
        return () if left is None else tuple(sorted(enclaves))

    def _move(self, finding: Finding, findings: Sequence[Finding]) -> tuple[str, str] | None:
        for enclave, node in dict.fromkeys(self._movable(finding)):
            if self._still_open(PolicyChange(move=frozenset({(enclave, node)})), findings) == []:
                return enclave, node
        return None

    def _movable(self, finding: Finding) -> Iterator[tuple[str, str]]:
        """Who goes beyond its profile, then whose grants it uses; in an enclave of two, moving is splitting.

        A session of Zenoh that says who it is stays among those that a list lets in whoever they are.
        """
        steps = [finding.steps[n] for n in beyond(finding, self.granted)]
        users = [(grant.enclave, _ends(step)[0].name) for step in steps for grant in step.grants]
        holders = [(grant.enclave, grant.node) for step in steps for grant in step.grants]
        for enclave, node in (*users, *sorted(holders)):
            nodes = self.enclaves.get(enclave, frozenset())
            if node in nodes and len(nodes) > 2 and enclave != ANY_SESSION:  # noqa: PLR2004 - see above
                yield enclave, node

    def _deny(self, findings: Sequence[Finding]) -> tuple[DenyLine, ...]:
        if self.trials.channels_between(findings[0]) > TRIED:  # each change is about one channel more
            return ()
        lines: frozenset[DenyLine] = frozenset()
        left: Sequence[Finding] | None = findings
        while left:
            more = self._next_lines(left[0], lines)
            if not more:
                return ()
            lines |= more
            left = self._still_open(PolicyChange(deny=lines), findings)
        return () if left is None else tuple(sorted(lines))

    def _next_lines(self, finding: Finding, lines: frozenset[DenyLine]) -> frozenset[DenyLine]:
        """The lines that deny one more step of a path: that which the fewest lines allow."""
        choices = [frozenset(_lines(finding, n)) - lines for n in beyond(finding, self.granted)]
        return min((choice for choice in choices if choice), key=lambda c: (len(c), sorted(c)), default=frozenset())

    def _still_open(self, change: PolicyChange, findings: Iterable[Finding]) -> list[Finding] | None:
        """Those of the findings that still stand after a change; None where too many changes were tried."""
        if change not in self.tried:
            kind = next(n for n, part in enumerate(change) if part)
            self.counts[kind] = self.counts.get(kind, 0) + 1
            if self.counts[kind] > TRIED:
                return None
            self.tried.add(change)
        left = self.trials.still_open(change, findings)
        return [one for one in left if not (one.pseudonymised and one.id in self.hidden)]

    def _rights(self, change: PolicyChange) -> frozenset[Right]:
        if change not in self.allowed:
            self.allowed[change] = rights(self.declared(change).graph)
        return self.allowed[change]


def _ends(step: Step) -> tuple[Element, Element]:
    """Node and channel of a step."""
    return (step.source, step.target) if step.target.is_channel else (step.target, step.source)


def _places(finding: Finding, steps: Iterable[int]) -> tuple[Place, ...]:
    return tuple(sorted({grant.place for n in steps for grant in finding.steps[n].grants}))


def _lines(finding: Finding, number: int) -> Iterator[DenyLine]:
    """The DENY lines that take a step of a path away, for each policy and enclave; none overrules what was seen.

    Permissions and access lists of Zenoh are no policies: no DENY of a profile stands there.
    """
    step = finding.steps[number]
    grants = [grant for grant in step.grants if not (grant.dead or grant.rank)]
    if len(grants) != len(step.grants) or any(grant.observation or grant.kind == DDS for grant in grants):
        return
    channel = _channel_of(finding, number)
    first = {(grant.policy, grant.enclave): grant for grant in reversed(grants)}
    for (policy, enclave), grant in first.items():
        for kind, name in writable(step.role, channel.kind, channel.name):
            yield DenyLine(policy, enclave, grant.node, step.role, kind, name)


def _channel_of(finding: Finding, number: int) -> Element:
    """The channel of a step; where it is a wildcard, the name that the data goes through, if that is none."""
    channel = _ends(finding.steps[number])[1]
    beside = number + 2 if finding.witness[number + 1] == channel else number - 1
    if channel.pattern and 0 <= beside < len(finding.witness):
        near = finding.witness[beside]
        return near if near.is_channel and not near.pattern else channel
    return channel


@dataclass(frozen=True)
class ChangeTrials:
    """Tries changes; what was made for one finding is not made again for another.

    Attributes
    ----------
    system, result
        Of the enforced view, without a change.
    read
        Makes the system of the policies with a change.
    question
        What was asked.
    """

    system: System
    result: Result
    read: Callable[[PolicyChange], System]
    question: Question
    nets: dict[PolicyChange, tuple[Net, Bound]] = field(default_factory=dict)
    answers: dict[PolicyChange, Mapping[str, Finding]] = field(default_factory=dict)

    @cached_property
    def vertices(self) -> Mapping[Element, int]:
        """The elements by number."""
        return _numbered(self.system.graph.elements)

    @cached_property
    def wildcards(self) -> frozenset[str]:
        """The enclaves in which somebody grants a wildcard."""
        grants = (grant for policy in self.system.policies for grant in policy.grants)
        return frozenset(grant.enclave for grant in grants if is_pattern(grant.name))

    @cached_property
    def leading_to(self) -> Mapping[int, Sequence[int]]:
        """Vertex -> those with a flow to it that everything may go along."""
        into: dict[int, list[int]] = defaultdict(list)
        spread = self.result.analysis.spread
        own, meetings = parted(spread.graph.flows, spread.told_apart)
        for index, flow in own:
            if index not in spread.flow_keeps:
                into[flow.target].append(flow.source)
        for meeting in meetings:
            for target in meeting.read:
                into[target] += meeting.written
        return into

    def channels_between(self, finding: Finding) -> int:
        """Return how many channels at least a DENY has to be about to end a finding: all that lie right between.

        Of a fleet, and where a wildcard that is denied could be about several, at least one.
        """
        nodes = {finding.source.name, finding.leak.name}
        enclaves = {profile.enclave for profile in self.system.graph.profiles if profile.node in nodes}
        if self.system.is_fleet or enclaves & self.wildcards:
            return 1
        spread, elements = self.result.analysis.spread, self.system.graph.elements
        source, bits = self.vertices[finding.source], spread.forms_of(finding.category)
        bits &= spread.emits.get(source, 0)
        return len(
            {
                (elements[vertex].kind, elements[vertex].name)
                for vertex in self.leading_to.get(self.vertices[finding.leak], ())
                if elements[vertex].is_channel
                and bits & spread.sent.get(vertex, 0) & spread.absorbed(vertex)
                and source in self.leading_to[vertex]
            }
        )

    def still_open(self, change: PolicyChange, findings: Iterable[Finding]) -> list[Finding]:
        """Return those of some findings that still stand after a change: all where labels do not fit what it leaves."""
        findings = tuple(findings)
        try:
            there = self._all_findings(change) if self.system.is_fleet else self._listed_only(change, findings)
        except InputErrors:  # such as a flow that a label names: nothing is proven then
            return list(findings)
        return [there[one.id] for one in findings if one.id in there]

    def _all_findings(self, change: PolicyChange) -> Mapping[str, Finding]:
        """All findings: robots of a fleet are put together first."""
        if change not in self.answers:
            found = answer(self.read(change), self.question).analysis.findings
            self.answers[change] = {one.id: one for one in found if not one.dismissed}
        return self.answers[change]

    def _listed_only(self, change: PolicyChange, findings: Sequence[Finding]) -> Mapping[str, Finding]:
        if change not in self.nets:
            self.nets[change] = self._net(change)
        net, bound = self.nets[change]
        elements, categories = net.spread.graph.elements, net.spread.categories
        vertices = self.vertices if elements is self.system.graph.elements else _numbered(elements)
        chosen: dict[int, set[Chosen]] = defaultdict(set)
        for one in findings:
            if {one.source, one.leak} <= vertices.keys():
                number = categories.index(one.category)
                chosen[vertices[one.source]].add((one.kind, vertices[one.leak], number, one.plain_also))
        options = self.result.options
        assert options is not None, "an answer that was worked out here"
        options = options._replace(count_paths=False)
        found = chosen_findings(net, bound, self.system.vocabulary.hierarchy, options, chosen)
        return {one.id: one for one in found if not one.dismissed}

    def _net(self, change: PolicyChange) -> tuple[Net, Bound]:
        bound = self.result.bound
        named = bound.through or (bound.flows and change.deny)  # flows that labels name: are they still there?
        graph = None if named else changed_graph(self.system.graph, self.system.policies, change)
        if graph is not None:
            return Net.of(self.result.analysis.spread.with_fewer_flows(graph)), bound
        system = self.read(change)
        return Net.of(spread(system.graph, system.bound, system.vocabulary.hierarchy)), system.bound


def _numbered(elements: Iterable[Element]) -> dict[Element, int]:
    return {element: vertex for vertex, element in enumerate(elements)}
