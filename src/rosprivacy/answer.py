"""The answer: the analysis, what it rests on, and what else can be worked out of both.

In: what was found, and what it rests on. Out: ``Answer``, of which ``documents.py`` makes a ``Document``.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.findings.processed import processed
from rosprivacy.analysis.findings.review_order import Behind, review_order
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS
from rosprivacy.analysis.whatif.ledger import GlobUse, globs, ledger
from rosprivacy.analysis.whatif.reliance import Reliance, reliances
from rosprivacy.report.document.analysis import verdict_facts

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.case import Case
    from rosprivacy.analysis.decisions import Decided, Decision
    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern
    from rosprivacy.analysis.model import Bound, Diagnostic, Doubt, Element
    from rosprivacy.analysis.model.register_row import RegisterRow
    from rosprivacy.analysis.whatif.ledger import TakenAway
    from rosprivacy.ontology.vocabulary import Vocabulary


class Enforced(NamedTuple):
    """What the enforced view adds to the declared one, which is the answer of record (rule S6).

    Attributes
    ----------
    answer
        Under the enforced view.
    added
        The findings that only this view has, in its order; and those in which it alone has plain data.
    open
        The elements that are open in this view only, or for more categories: those outside ROS first.
    """

    answer: Answer
    added: tuple[Added, ...]
    open: tuple[Element, ...] = ()


@dataclass(frozen=True)
class Answer:
    """An analysis and what it rests on; what many formats ask of it is found once.

    Attributes
    ----------
    diagnostics
        Of the inputs; the analysis' own stand there.
    assumptions
        What the answer rests on, made by the caller who knows the files.
    decided
        What people decided about the findings; None where nobody decided anything.
    fleet
        Which robots of the graph stand for which, and what they have in common; None for a single robot.
    counts
        Of the whole fleet, where the graph does not hold all of it; None where it does.
    infrastructure
        (kind, name) of open channels that the program's own file proposes to take as mundane (rule S13).
    accepts
        As of ``Options``: whether a person has accepted what would be a finding.
    enforced
        What the enforced view adds to this one; None where nobody asked.
    doubts
        What is not known, or rests on more than a person's word (rule S11); the verdict takes them into account.
    hangs_on_asked
        Whether ``hangs_on`` is asked for: of a fleet it takes more than the analysis.
    hangs_on_named
        Whether a user asked for it by name, which a short document waits for.
    closes
        Proposes changes that remove the open findings; None where the policies are not at hand.
    beyond
        The elements of the graph from which data gets to robots that it does not hold.
    of_whole_fleet
        What the answer hangs on, where the graph does not hold the whole fleet; else None, and worked out where asked.
    """

    analysis: Analysis
    bound: Bound
    vocabulary: Vocabulary
    diagnostics: tuple[Diagnostic, ...]
    assumptions: dict[str, Any]
    decided: Decided | None = None
    fleet: FleetView | None = None
    counts: Counts | None = None
    infrastructure: frozenset[tuple[str, str]] = frozenset()
    accepts: Callable[[Case], bool] | None = field(default=None, repr=False, compare=False)
    enforced: Enforced | None = field(default=None, repr=False, compare=False)
    doubts: tuple[Doubt, ...] = ()
    hangs_on_asked: bool = field(default=True, repr=False, compare=False)
    hangs_on_named: bool = field(default=False, repr=False, compare=False)
    closes: Callable[[Any], Mapping[str, Any] | str] | None = field(default=None, repr=False, compare=False)
    beyond: frozenset[Element] = field(default=frozenset(), repr=False, compare=False)
    of_whole_fleet: tuple[Reliance, ...] | None = field(default=None, repr=False, compare=False)

    @property
    def shown(self) -> Analysis:
        """The analysis as readers get it: of a fleet one finding of each pattern, one robot of those that are alike."""
        return self.fleet.shown(self.analysis) if self.fleet else self.analysis

    @property
    def named_files(self) -> tuple[str, ...]:
        """The policy files that a user named, without what they include; none where that is not known."""
        return ()

    def verdict_facts(self) -> dict[str, Any]:
        """Return what the verdict's sentence is made of, without the rest of the document."""
        return verdict_facts(self.shown, self.doubts, self.assumptions)

    def proposals(self) -> Mapping[str, Any] | str:
        """Return what closes the open findings, a mitigation document; or why there is none, a word."""
        if self.fleet:
            return "fleet"
        return self.closes(self) if self.closes else "graph"

    def shows(self, robot: str) -> bool:
        """Return whether no other robot stands for a robot in what readers get."""
        return robot not in self._robots_not_shown

    @cached_property
    def taken_away(self) -> tuple[TakenAway, ...]:
        """The ledger: what was taken away on the data's side, and on whose word; of robots that are alike of one."""
        rows = ledger(self.analysis, self.bound, self.vocabulary.hierarchy, self.diagnostics, self.beyond)
        return tuple(row for row in rows if row.element is None or row.element.robot not in self._robots_not_shown)

    @cached_property
    def hangs_on(self) -> tuple[Reliance, ...] | None:
        """What the answer hangs on, statement by statement; of robots that are alike of one. None where not asked."""
        if not self.hangs_on_asked:
            return None
        rows = self.of_whole_fleet
        if rows is None:
            rows = reliances(self.analysis, self.bound, self.vocabulary.hierarchy, self.accepts)
        return tuple(row for row in map(self._of_shown_robots, rows) if row.hangs)

    def _of_shown_robots(self, row: Reliance) -> Reliance:
        if self.fleet is None:
            return row
        beside, between = self._robots_not_shown, self.fleet.likeness.between
        return row._replace(
            elements=tuple(e for e in row.elements if e.robot not in beside),
            to=tuple(e for e in row.to if e.robot not in beside),
            findings=tuple(f for f in row.findings if between(f.source.robot, f.leak.robot)),
            questions=tuple(q for q in row.questions if q[0].robot not in beside),
        )

    @cached_property
    def review_order(self) -> dict[tuple[str, str, str, str], Behind]:
        """Where data comes to each open element from, and what stands behind it."""
        return review_order(self.analysis)

    def globs(self, ledger_rows: Iterable[TakenAway]) -> tuple[GlobUse, ...]:
        """What each glob of the label files decides and closes, by the ledger; robots as there."""
        return globs(self.analysis, self.bound, ledger_rows, self._robots_not_shown)

    @property
    def _robots_not_shown(self) -> Collection[str]:
        """Robots of the graph for which another one stands in what readers get."""
        return self.fleet.likeness.second if self.fleet else ()

    @property
    def accepted(self) -> dict[str, str]:
        """The findings that a valid decision accepts: id -> reason, owner, legal basis, until when (rule S10)."""
        if self.decided is None:
            return {}
        held = ((f.id, self.decided.valid(f)) for f in self.analysis.findings if f.accepted)
        return {finding: _why(decision) for finding, decision in held if decision}

    @property
    def contexts(self) -> Contexts:
        """Where sources work, and what data may reveal there."""
        return Contexts.of(self.analysis.graph, self.bound, self.vocabulary.categories, together=self.fleet is not None)

    @property
    def processed(self) -> tuple[Processed, ...]:
        """What is stated of purposes and legal bases where data begin and end, by kind; of robots alike of one."""
        rows = processed(self.shown, self.bound, self.vocabulary.hierarchy)
        return tuple(row for row in rows if row.element.robot not in self._robots_not_shown)

    @cached_property
    def register(self) -> tuple[RegisterRow, ...]:
        """The register of processing; of robots that are alike of one.

        Where the graph does not hold the whole fleet, the persons of other robots are not known at what robots share,
        nor where data leave nowhere.
        """
        from rosprivacy.analysis.findings.register import Statements, register  # noqa: PLC0415 - light start

        likeness = self.fleet.likeness if self.fleet else NO_ROBOTS
        ends = self._row_ends
        shown = replace(self.shown, findings=tuple(finding for finding, _ in ends)) if ends else self.shown
        decided = (
            {}
            if self.decided is None
            else {
                finding.id: decision.legal_basis
                for finding in shown.findings
                if (decision := self.decided.valid(finding))
            }
        )
        stated = Statements(
            self.bound, self.processed, self.contexts, self.vocabulary.hierarchy, self._law, decided, likeness.second
        )
        rows = register(shown, stated)
        if self.counts is None:
            return _on_robots(rows, self.fleet, ends) if self.fleet else rows
        alone = (row.places and all(likeness.is_robot(place.robot) for place in row.places) for row in rows)
        return tuple(row if some else row.without_all_subjects() for row, some in zip(rows, alone, strict=True))

    @cached_property
    def _row_ends(self) -> tuple[tuple[Finding, Pattern], ...]:
        """What the rows of a fleet are made of, where the graph holds all of it."""
        if self.fleet is None or self.counts is not None:
            return ()
        from rosprivacy.analysis.fleet.robots_of_rows import row_ends  # noqa: PLC0415 - for fleets only

        return row_ends(self.fleet, self.analysis.findings if self.decided else ())

    def _law(
        self, category: str, contexts: Collection[str], countries: Collection[str], persons: Collection[str]
    ) -> tuple[str, ...]:
        """Return the provisions that a kind, a context or persons call for, of the Union and of some countries."""
        kind = self.vocabulary.categories[category]
        rows = self.vocabulary.pointed.rows([kind], contexts, {category: persons})
        return tuple(law.name for law, kinds, where in rows if (kinds or where) and law.country in ("", *countries))

    def fleet_counts(self, view: FleetView) -> Counts:
        """Return how many elements, flows and standard channels the fleet has, not its graph."""
        from rosprivacy.analysis.fleet.counts import counted  # noqa: PLC0415 - light start

        return self.counts or counted(self.analysis.graph, self.analysis.spread, view.likeness)


def _on_robots(
    rows: Iterable[RegisterRow], view: FleetView, ends: Iterable[tuple[Finding, Pattern]]
) -> tuple[RegisterRow, ...]:
    from rosprivacy.analysis.fleet.robots_of_rows import on_robots  # noqa: PLC0415 - for fleets only

    return on_robots(rows, view, ends)


def _why(decision: Decision) -> str:
    more = [decision.owner, *decision.legal_basis, f"until {decision.expires}" if decision.expires else ""]
    said = ", ".join(part for part in more if part)
    return f"{decision.reason} ({said})" if said else decision.reason
