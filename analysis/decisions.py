"""What people have decided about findings: which decision holds for which, until when, and what is missing (S10, S12).

In: decisions as a file states them, findings. Out: per finding the decision that holds, per decision what it is about.
A decision about a finding, or about the row of the register where it ends, outranks one about a pattern; where there
are both, both have to accept. Of two patterns the one that spells out more counts. An expired decision decides nothing,
and nor does what it outranks: a person has to look again.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.errors import DecisionError
from rosprivacy.analysis.expressions import regex
from rosprivacy.analysis.legal import acceptance_gaps
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.analysis.model.register_row import row_id
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.analysis.remembered import change_text, first_changes
from rosprivacy.analysis.written_names import bare_name, is_glob

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.legal import Verdicts
    from rosprivacy.analysis.model import Acceptance, Doubt
    from rosprivacy.analysis.model.logged_step import LoggedStep
    from rosprivacy.analysis.remembered import About, ChangedAspect

FARTHEST = 1_000_000


class Choice(StrEnum):
    """What is decided. All but the first leave something to do."""

    ACCEPT = "accept"
    CONDITIONAL = "accept-on-condition"  # open until a person confirms that the condition is met
    MITIGATE = "mitigate"
    DELEGATE = "delegate"
    AVOID = "avoid"


class State(StrEnum):
    """Of a decision."""

    VALID = "valid"
    EXPIRED = "expired"
    ORPHANED = "orphaned"  # no finding is as it says


@dataclass(frozen=True, slots=True)
class Decision:
    """One entry of a decisions file.

    Attributes
    ----------
    id
        Of a finding, or of a pattern of findings on a fleet; empty where names and globs say what it is about.
    row
        Id of a row of the register: it is about the findings that end there.
    category
        A name; it stands for the narrower ones too.
    source, leak
        Names or globs; after ``=`` a name with glob signs.
    robot
        Name or glob: of the robot of the leak, or of the source where the leak is on none.
    from_robot
        Name or glob: of the robot of the source.
    robots, from_robots
        The same as lists of full names, one of which it is: these robots and no others, whoever joins later.
    kind
        Of findings.
    pseudonymised
        Whether it is about data in this form only; None for any form.
    legal_basis
        Such as ``6(1)(f)`` and ``9(2)(h)``, in order.
    date, expires
        ISO dates, or empty; it is valid to the end of the day on which it expires.
    made_about
        What was there when it was made; None where nobody wrote it down. It is about no robot that was not there.
    condition
        What has to be so before an acceptance counts, or had to be.
    answers
        (``LegalQuestion`` of the row, what a person answers), by code.
    history
        Of a log: what was decided about the same target, this decision last, or its confirmation.
    """

    choice: Choice
    place: Place
    id: str = ""
    row: str = ""
    category: str = ""
    source: str = ""
    leak: str = ""
    robot: str = ""
    from_robot: str = ""
    robots: tuple[str, ...] = ()
    from_robots: tuple[str, ...] = ()
    kind: str = ""
    pseudonymised: bool | None = None
    reason: str = ""
    owner: str = ""
    legal_basis: tuple[str, ...] = ()
    date: str = ""
    expires: str = ""
    ticket: str = ""
    made_about: About | None = None
    condition: str = ""
    answers: tuple[tuple[str, str], ...] = ()
    history: tuple[LoggedStep, ...] = ()

    def about(self, case: Case, hierarchy: Hierarchy) -> bool:
        """Whether it is about a case.

        One that names a robot says nothing of what comes from another robot, unless it names that too, or a row: that
        is all that ends at a place.
        """
        alone = not case.robots[1] and self._is_on(case.source.robot)
        names_robots, names_sources = self.robot or self.robots, self.from_robot or self.from_robots
        return (
            self._names(case, hierarchy)
            and (alone or self._is_on(case.leak.robot))
            and self._is_from(case.source.robot)
            and not (names_robots and case.across and not names_sources and not self.row)
            and self._knew(case)
        )

    def _knew(self, case: Case) -> bool:
        """Whether a case was there when it was made."""
        ids = (case.id, case.pattern)
        return self.made_about is None or self.made_about.knew(case.robots, ids, hidden=case.pseudonymised)

    def _is_on(self, robot: str) -> bool:
        return _covers(self.robot, robot) and (not self.robots or robot in self.robots)

    def _is_from(self, robot: str) -> bool:
        return _covers(self.from_robot, robot) and (not self.from_robots or robot in self.from_robots)

    def was_about(self, case: Case, hierarchy: Hierarchy) -> bool:
        """Whether it was about a case when one of two robots was enough, and is no longer."""
        either = (
            bool(self.robot)
            and not self.row
            and any(_covers(self.robot, end.robot) for end in (case.source, case.leak))
        )
        return self._names(case, hierarchy) and either and not self.from_robot and not self.about(case, hierarchy)

    def _names(self, case: Case, hierarchy: Hierarchy) -> bool:
        """Whether all that it names but robots is as in a case."""
        return (
            self.id in ("", case.id, case.pattern)
            and self.row in ("", case.row)
            and self.kind in ("", case.kind)
            and (not self.category or hierarchy.distance(case.category, self.category) is not None)
            and _covers(self.source, case.source.name)
            and _covers(self.leak, case.leak.name)
            and self.pseudonymised in (None, case.pseudonymised)
        )

    def rank(self, case: Case, hierarchy: Hierarchy) -> tuple[int, ...]:
        """How closely it speaks of a case; the higher counts."""
        names = [name for name in (self.source, self.leak, self.robot, self.from_robot) if name]
        listed = [names for names in (self.robots, self.from_robots) if names]
        exact = sum(not is_glob(name) for name in names) + len(listed)
        spelt = sum(sum(char not in "*?[]" for char in name) for name in names if is_glob(name))
        distance = hierarchy.distance(case.category, self.category) if self.category else FARTHEST
        form, kind = self.pseudonymised is not None, bool(self.kind)
        return (bool(self.id), exact, spelt, -(distance or 0), form, kind, -sum(map(len, listed)))


def _covers(written: str, name: str) -> bool:
    """Nothing written covers every name."""
    if is_glob(written):
        return regex(written).match(name) is not None
    return not written or bare_name(written) == name


def _is_about(entry: Acceptance, doubt: Doubt) -> bool:
    """Whether an entry is about a doubt: all that it names must hold."""
    name, robot = (doubt.element.name, doubt.element.robot) if doubt.element else ("", "")
    return (
        entry.id in ("", doubt.id)
        and entry.name in ("", doubt.name)
        and _covers(entry.element, name)
        and _covers(entry.robot, robot)
        and _covers(entry.file, doubt.place.file)
    )


@dataclass(frozen=True)
class Decisions:
    """A decisions file on a day.

    Attributes
    ----------
    today
        ISO date.
    instead_of
        An earlier date that was asked for, by which fewer decisions have expired; empty if there is none.
    doubts
        What people accepted of the list of doubts.
    head
        Of a log: the hash of its last entry, which stands for all of it; empty for a file that has no chain.
    """

    file: str
    sha256: str
    today: str
    entries: tuple[Decision, ...]
    hierarchy: Hierarchy = field(repr=False)
    instead_of: str = ""
    doubts: tuple[Acceptance, ...] = ()
    head: str = ""

    def on_doubts(
        self, doubts: Iterable[Doubt], *, everything: bool
    ) -> tuple[tuple[Doubt, ...], tuple[Diagnostic, ...]]:
        """Return doubts with what is accepted of them, and what is to be said of such entries.

        Parameters
        ----------
        everything
            Whether these are all doubts that there are: else no entry is called orphaned.
        """
        used: set[Acceptance] = set()
        decided = []
        for doubt in doubts:
            about = [entry for entry in self.doubts if _is_about(entry, doubt)]
            used.update(about)
            valid = next((entry for entry in about if self.state(entry) is State.VALID), None)
            decided.append(replace(doubt, accepted=valid))
        return tuple(decided), tuple(self._of_doubts(used, everything=everything))

    def _of_doubts(self, used: Collection[Acceptance], *, everything: bool) -> Iterator[Diagnostic]:
        for entry in self.doubts:
            what = f"the acceptance of the doubt {entry.id or entry.name}"
            if self.state(entry) is State.EXPIRED:
                message = f"{what} expired on {entry.expires} and no longer counts; decide anew"
                yield Diagnostic(entry.place, Severity.WARNING, message)
            elif everything and entry not in used:
                yield Diagnostic(entry.place, Severity.WARNING, f"{what} is about no doubt: it is orphaned; remove it")

    def state(self, decision: Decision | Acceptance) -> State:
        """Whether a decision is still valid."""
        return State.EXPIRED if decision.expires and decision.expires < self.today else State.VALID

    @cached_property
    def _by_id(self) -> dict[str, list[int]]:
        """Id of a finding or row that entries name, empty for patterns -> their numbers."""
        found: dict[str, list[int]] = {}
        for number, entry in enumerate(self.entries):
            found.setdefault(entry.id or entry.row, []).append(number)
        return found

    def near(self, case: Case) -> list[tuple[int, Decision]]:
        """The entries that name no id, or one of a case's, with their numbers: no other can be about it."""
        numbers = {number for name in ("", case.id, case.pattern, case.row) for number in self._by_id.get(name, ())}
        return [(number, self.entries[number]) for number in sorted(numbers)]

    def foremost(self, case: Case) -> tuple[list[Decision], ...]:
        """The decisions of the highest rank about a case, in the order of the file: those by a row apart."""
        about = [entry for _, entry in self.near(case) if entry.about(case, self.hierarchy)]
        by_row = [entry for entry in about if entry.row]
        others = [entry for entry in about if not entry.row and (entry.id or not by_row)]
        return tuple(self._highest(some, case) for some in (others, by_row) if some)

    def _highest(self, about: Iterable[Decision], case: Case) -> list[Decision]:
        ranked = [(entry.rank(case, self.hierarchy), entry) for entry in about]
        highest = max(rank for rank, _ in ranked)
        return [entry for rank, entry in ranked if rank == highest]

    def on(self, case: Case) -> Decision | None:
        """The decision about a case, valid or not; None if there is none, or several of one rank that differ."""
        foremost = self.foremost(case)
        if not foremost or any(len({entry.choice for entry in some}) > 1 for some in foremost):
            return None
        return next((some[0] for some in foremost if not self.lets_stay(some[0])), foremost[0][0])

    def lets_stay(self, decision: Decision) -> bool:
        """Whether a decision is an acceptance, and valid."""
        return decision.choice is Choice.ACCEPT and self.state(decision) is State.VALID

    def told_apart(self, robot: str) -> tuple[bool, ...]:
        """Return which entries that name robots mean this one: robots are alike only if all do so alike."""
        names = (name for entry in self.entries for name in (entry.robot, entry.from_robot) if name)
        lists = [robots for entry in self.entries for robots in (entry.robots, entry.from_robots)]
        remembered = [entry.made_about for entry in self.entries if entry.made_about]
        lists += [tuple(robots) for about in remembered for robots in (about.robots, about.from_robots)]
        return (*(_covers(name, robot) for name in names), *(robot in robots for robots in lists if robots))

    def accepts(self, case: Case) -> bool:
        """Whether a valid decision accepts a case (rule S10)."""
        decision = self.on(case)
        return decision is not None and self.lets_stay(decision)


@dataclass(frozen=True, slots=True)
class Decided:
    """Decisions joined to findings.

    Attributes
    ----------
    on
        Finding's id -> the decision about it, valid or expired.
    about
        By entry: the ids of the findings that it is about, sorted.
    states
        By entry.
    changed
        Of entries of which something is not as it was when they were made: what.
    """

    decisions: Decisions
    on: Mapping[str, Decision]
    about: tuple[tuple[str, ...], ...]
    states: tuple[State, ...]
    diagnostics: tuple[Diagnostic, ...]
    changed: Mapping[Decision, tuple[ChangedAspect, ...]] = field(default_factory=dict)

    def valid(self, finding: Finding) -> Decision | None:
        """The decision about a finding, if it is valid."""
        decision = self.on.get(finding.id)
        return decision if decision and self.decisions.state(decision) is State.VALID else None


def decided(
    decisions: Decisions,
    findings: Iterable[Finding],
    law: Mapping[str, Verdicts],
    *,
    everything: bool,
    case_of: Callable[[Finding], Case] = Case.of,
    now: Mapping[str, About] | None = None,
) -> Decided:
    """Join decisions to findings.

    Parameters
    ----------
    law
        Category -> what can apply to data of it.
    everything
        Whether the findings are all there are: else no decision is called orphaned.
    case_of
        What a decision can be about, of a finding.
    now
        Id of a finding or pattern -> what a decision about it would be made about today.

    Raises
    ------
    DecisionError
        If two decisions of one rank differ; the message names both lines.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> graph, bound, hierarchy = factory()
    >>> entry = Decision(Choice.ACCEPT, Place("decisions.yaml", 2), category="Biometric", expires="2026-12-31")
    >>> decisions = Decisions("decisions.yaml", "", "2027-01-01", (entry,), hierarchy)
    >>> joined = decided(decisions, analyse(graph, bound, hierarchy).findings, {}, everything=True)
    >>> len(joined.about[0]), str(joined.states[0]), joined.diagnostics[0].message
    (2, 'expired', 'the decision to accept a pattern expired on 2026-12-31 and no longer counts; decide anew')
    """
    cases = [(finding, case_of(finding)) for finding in findings]
    on: dict[str, Decision] = {}
    for finding, case in cases:
        for first, *more in decisions.foremost(case):
            if other := next((entry for entry in more if entry.choice != first.choice), None):
                what = f"to {other.choice} {finding.id} contradicts line {first.place.line}: to {first.choice}"
                raise DecisionError(other.place.file, other.place.line, what, "make one more specific, or remove it")
        if decision := decisions.on(case):
            on[finding.id] = decision
    ids: list[set[str]] = [set() for _ in decisions.entries]
    for finding, case in cases:
        for number, entry in decisions.near(case):
            if entry.about(case, decisions.hierarchy):
                ids[number].add(finding.id)
    about = tuple(tuple(sorted(some)) for some in ids)
    states = tuple(
        State.ORPHANED if everything and not some else decisions.state(entry)
        for entry, some in zip(decisions.entries, about, strict=True)
    )
    by_id = {finding.id: finding for finding, _ in cases}
    changed = {
        entry: _changed(entry, [by_id[one] for one in some], now or {})
        for entry, some in zip(decisions.entries, about, strict=True)
    }
    result = Decided(decisions, on, about, states, (), {entry: found for entry, found in changed.items() if found})
    said = tuple(_diagnostics(result, by_id, law, _former(result, cases)))
    return replace(result, diagnostics=said)


def _changed(entry: Decision, findings: Iterable[Finding], now: Mapping[str, About]) -> tuple[ChangedAspect, ...]:
    """What is not as it was; of an entry that lists robots, on one of these."""
    before = entry.made_about
    if entry.robots and before:
        before = replace(before, robots=frozenset(), from_robots=frozenset())
    named = (entry.id or entry.row,)
    if entry.row:
        places = dict.fromkeys(row_id(finding.category, [finding.leak]) for finding in findings)
        return (*first_changes(before, named, now), *first_changes(before, places.keys() - {*named}, now))
    return first_changes(before, (finding.id for finding in findings) if entry.robots else named, now)


def _former(joined: Decided, cases: Iterable[tuple[Finding, Case]]) -> list[int]:
    """Return per entry how many findings it decided when one of two robots was enough."""
    decisions = joined.decisions
    former = [0] * len(decisions.entries)
    for case in (case for finding, case in cases if finding.id not in joined.on):
        for number, entry in decisions.near(case):
            former[number] += entry.was_about(case, decisions.hierarchy)
    return former


def _diagnostics(
    joined: Decided, findings: Mapping[str, Finding], law: Mapping[str, Verdicts], former: Iterable[int]
) -> Iterator[Diagnostic]:
    """What a reader has to know: expired and orphaned decisions, what one no longer decides, missing legal bases."""
    asked, today = joined.decisions.instead_of, joined.decisions.today
    if asked:
        message = f"by its day, {asked}, fewer decisions have expired than today, {today}; the later day counts"
        yield Diagnostic(Place("SOURCE_DATE_EPOCH", 0), Severity.WARNING, message)
    for entry, ids, state, lost in zip(joined.decisions.entries, joined.about, joined.states, former, strict=True):
        what = f"the decision to {entry.choice} {entry.id or entry.row or 'a pattern'}"
        if lost:
            count = "1 finding" if lost == 1 else f"{lost} findings"
            did = "accepted before" if entry.choice is Choice.ACCEPT else "decided before"
            message = f"{what} names no from_robot: {count} from one robot to another, {did}, no longer; add it"
            yield Diagnostic(entry.place, Severity.WARNING, message)
        elif state is State.ORPHANED:
            yield Diagnostic(entry.place, Severity.WARNING, f"{what} is about no finding: it is orphaned; remove it")
        if changed := joined.changed.get(entry):
            message = f"changed since {what} was made: {change_text(changed)}; decide anew"
            yield Diagnostic(entry.place, Severity.WARNING, message)
        if joined.decisions.state(entry) is State.EXPIRED:
            message = f"{what} expired on {entry.expires} and no longer counts; decide anew"
            yield Diagnostic(entry.place, Severity.WARNING, message)
        if entry.choice is Choice.ACCEPT and state is State.VALID:
            held = [(f.kind, f.category) for f in (findings[one] for one in ids if joined.on.get(one) is entry)]
            yield from (
                Diagnostic(entry.place, Severity.WARNING, f"{what} {gap}")
                for gap in acceptance_gaps(entry.legal_basis, entry.expires, held, law)
            )
