"""What takes away a finding that only the enforced view has, each proven by a new analysis (rules S5, S6).

In: findings, and what reads the same policies with a change. Out: ``Added``. Splitting an enclave is the first
proposal; moving one profile to an enclave of its own is the smaller one, where that is enough; a DENY has a price,
since it holds for the whole enclave: who rightly has the grant loses it, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.findings.beyond import Added, DenyLine, beyond, enclaves_of, rights
from rosprivacy.ingest.deployed.zenoh_grants import ANY_SESSION
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, Change
from rosprivacy.ingest.policies.names import DDS, writable

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding, Step
    from rosprivacy.analysis.findings.beyond import Ends, Right
    from rosprivacy.analysis.model import Element, Place
    from rosprivacy.system import System
    from rosprivacy.views.trials import Trials

TRIED = 20  # changes of each kind, each an analysis of its own


@dataclass(frozen=True, slots=True)
class Remedies:
    """Looks for remedies; what was tried for one finding is not tried again for another.

    Attributes
    ----------
    trials
        Tell what a change leaves of findings under the enforced view.
    declared
        Reads the policies with a change.
    known
        The flows that profiles allow.
    enclaves
        The nodes of each enclave.
    second
        Robots that only stand beside others like them.
    hidden
        Ids of the findings that the declared view has in pseudonymised form only: that form is left.
    """

    trials: Trials
    declared: Callable[[Change], System]
    known: frozenset[Ends]
    enclaves: Mapping[str, frozenset[str]]
    second: Collection[str]
    hidden: Collection[str] = ()
    tried: set[Change] = field(default_factory=set)
    allowed: dict[Change, frozenset[Right]] = field(default_factory=dict)
    counts: dict[int, int] = field(default_factory=dict)

    def of(self, findings: Sequence[Finding], robots: tuple[str, ...] = ()) -> Added:
        """Return what ends some findings that differ only in the robot, of which the first is told."""
        steps = beyond(findings[0], self.known)
        shared = self._shared(findings[0])
        enclaves = {path for one in findings for path in enclaves_of(one, self._shared(one))}
        deny = self._deny(findings)
        loses: frozenset[Right] = frozenset()
        if deny:
            try:
                loses = self._rights(NO_CHANGE) - self._rights(Change(deny=frozenset(deny)))
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
        steps = ((n, finding.steps[n]) for n in beyond(finding, self.known))
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
            left = self._left(Change(split=enclaves), findings)
        return () if left is None else tuple(sorted(enclaves))

    def _move(self, finding: Finding, findings: Sequence[Finding]) -> tuple[str, str] | None:
        for enclave, node in dict.fromkeys(self._movable(finding)):
            if self._left(Change(move=frozenset({(enclave, node)})), findings) == []:
                return enclave, node
        return None

    def _movable(self, finding: Finding) -> Iterator[tuple[str, str]]:
        """Who goes beyond its profile, then whose grants it uses; in an enclave of two, moving is splitting.

        A session of Zenoh that says who it is stays among those that a list lets in whoever they are.
        """
        steps = [finding.steps[n] for n in beyond(finding, self.known)]
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
            left = self._left(Change(deny=lines), findings)
        return () if left is None else tuple(sorted(lines))

    def _next_lines(self, finding: Finding, lines: frozenset[DenyLine]) -> frozenset[DenyLine]:
        """The lines that deny one more step of a path: that which the fewest lines allow."""
        choices = [frozenset(_lines(finding, n)) - lines for n in beyond(finding, self.known)]
        return min((choice for choice in choices if choice), key=lambda c: (len(c), sorted(c)), default=frozenset())

    def _left(self, change: Change, findings: Iterable[Finding]) -> list[Finding] | None:
        """Those of the findings that still stand after a change; None where too many changes were tried."""
        if change not in self.tried:
            kind = next(n for n, part in enumerate(change) if part)
            self.counts[kind] = self.counts.get(kind, 0) + 1
            if self.counts[kind] > TRIED:
                return None
            self.tried.add(change)
        left = self.trials.left(change, findings)
        return [one for one in left if not (one.pseudonymised and one.id in self.hidden)]

    def _rights(self, change: Change) -> frozenset[Right]:
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
    if len(grants) != len(step.grants) or any(grant.seen or grant.kind == DDS for grant in grants):
        return
    channel = _meant(finding, number)
    first = {(grant.policy, grant.enclave): grant for grant in reversed(grants)}
    for (policy, enclave), grant in first.items():
        for kind, name in writable(step.role, channel.kind, channel.name):
            yield DenyLine(policy, enclave, grant.node, step.role, kind, name)


def _meant(finding: Finding, number: int) -> Element:
    """The channel of a step; where it is a wildcard, the name that the data goes through, if that is none."""
    channel = _ends(finding.steps[number])[1]
    beside = number + 2 if finding.witness[number + 1] == channel else number - 1
    if channel.pattern and 0 <= beside < len(finding.witness):
        near = finding.witness[beside]
        return near if near.is_channel and not near.pattern else channel
    return channel
