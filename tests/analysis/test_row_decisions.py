"""A decision about a row of the register (S10): a finding is accepted only where its row is, and it is (properties).

Random systems and entries, against the rule on the rows of the register itself, by lists of findings.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from hypothesis import given, settings
from hypothesis import strategies as st

from rosprivacy.analysis.contexts import Contexts
from rosprivacy.analysis.decisions import Choice, Decision, Decisions, decided
from rosprivacy.analysis.errors import DecisionError, InputErrors
from rosprivacy.analysis.findings.findings import Options
from rosprivacy.analysis.findings.register import Statements, register
from rosprivacy.analysis.model import Place
from rosprivacy.analysis.remembered import About
from tests.helpers.concerned import VOCABULARY, cases
from tests.helpers.systems import analysed

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from tests.helpers.concerned import Case as System

TODAY, OVER = "2026-11-20", "2026-11-19"


@dataclass(frozen=True)
class Entry:
    """What a person writes: ``known`` are the findings that were there then; none where nobody wrote them down."""

    choice: Choice
    id: str = ""
    row: str = ""
    category: str = ""
    expires: str = ""
    known: frozenset[str] = frozenset()

    def decision(self, line: int) -> Decision:
        about = About(findings=self.known) if self.known else None
        more: dict[str, Any] = {"id": self.id, "row": self.row, "category": self.category, "expires": self.expires}
        return Decision(self.choice, Place("d.yaml", line), made_about=about, **more)

    def speaks_of(self, finding: Finding, row: str) -> bool:
        above = VOCABULARY.hierarchy.ancestors[finding.category]
        return (
            self.id in ("", finding.id)
            and self.row in ("", row)
            and (not self.category or self.category in above)
            and (not self.known or finding.id in self.known)
        )


class ContradictionError(Exception):
    """Two entries about the same thing differ."""


def is_accepted(finding: Finding, row: str, entries: Iterable[Entry]) -> bool:
    """The rule: what names the finding, and what names its row, has to accept it; a pattern counts if nothing does."""
    about = [entry for entry in entries if entry.speaks_of(finding, row)]
    of_row = [entry for entry in about if entry.row]
    of_both = [entry for entry in of_row if entry.id]
    of_id = [entry for entry in about if entry.id and not entry.row]
    patterns = [entry for entry in about if not entry.id and not entry.row]
    held = [some for some in (of_both or of_row, of_id) if some] or ([nearest(patterns, finding)] if patterns else [])
    if any(len({entry.choice for entry in some}) > 1 for some in held):
        raise ContradictionError
    return bool(held) and all(some[0].choice is Choice.ACCEPT and some[0].expires != OVER for some in held)


def nearest(patterns: Sequence[Entry], finding: Finding) -> list[Entry]:
    far = [VOCABULARY.hierarchy.distance(finding.category, entry.category) for entry in patterns]
    return [entry for entry, distance in zip(patterns, far, strict=True) if distance == min(d or 0 for d in far)]


def rows_of(system: System, analysis: Analysis) -> dict[str, str]:
    """Finding -> the row of the register that lists it; each stands in one."""
    contexts = Contexts({}, VOCABULARY.categories)
    stated = Statements(system.bound(), (), contexts, VOCABULARY.hierarchy, lambda *_: ())
    pairs = [(finding, row.id) for row in register(analysis, stated) for finding in row.findings]
    assert len(pairs) == len(dict(pairs)) == len(analysis.findings)
    return dict(pairs)


def on_file(written: Iterable[Entry]) -> Decisions:
    some = tuple(entry.decision(line) for line, entry in enumerate(written))
    return Decisions("d.yaml", "", TODAY, some, VOCABULARY.hierarchy)


def answer(system: System, decisions: Decisions) -> Analysis:
    return system.system.analyse(Options(accepts=lambda case: decisions.accepts(case.in_row())))


@st.composite
def entries(draw: st.DrawFn, rows: dict[str, str]) -> list[Entry]:
    findings = sorted(rows)
    some = st.sampled_from(findings)
    more: dict[str, Any] = {
        "choice": st.sampled_from([Choice.ACCEPT, Choice.ACCEPT, Choice.MITIGATE]),
        "expires": st.sampled_from(["", "", OVER, TODAY]),
    }
    known = st.frozensets(some)
    of_row = some.map(rows.__getitem__)
    kinds = st.sampled_from(["PersonalData", "Biometric", "Video"])
    return draw(
        st.lists(
            st.builds(Entry, id=some, **more)
            | st.builds(Entry, row=of_row, known=known, **more)
            | st.builds(Entry, id=some, row=of_row, **more)
            | st.builds(Entry, category=kinds, **more),
            min_size=1,
            max_size=5,
        )
    )


@given(cases(), st.data())
@settings(deadline=None, max_examples=120)
def test_a_finding_is_accepted_only_where_its_row_is(system: System, data: st.DataObject) -> None:
    before = analysed(system.system)
    if before is None or not before.findings:
        return
    written = data.draw(entries(rows_of(system, before)))
    decisions = on_file(written)
    analysis = answer(system, decisions)
    rows = rows_of(system, analysis)
    try:
        expected = {finding.id: is_accepted(finding, rows[finding.id], written) for finding in analysis.findings}
    except ContradictionError:
        expected = None
    try:
        joined = decided(decisions, analysis.findings, {}, everything=True)
    except (DecisionError, InputErrors):
        assert expected is None
        return
    assert expected is not None
    assert {finding.id: finding.accepted for finding in analysis.findings} == expected
    for finding in analysis.findings:
        entry = joined.valid(finding)
        assert (entry is not None and entry.choice is Choice.ACCEPT) == expected[finding.id]
    about = {(line, finding.id) for finding in analysis.findings for line, entry in enumerate(written)
             if entry.speaks_of(finding, rows[finding.id])}  # fmt: skip
    assert {(line, one) for line, ids in enumerate(joined.about) for one in ids} == about


@given(cases(), st.data())
@settings(deadline=None, max_examples=40)
def test_a_row_is_accepted_as_all_of_its_findings_one_by_one(system: System, data: st.DataObject) -> None:
    before = analysed(system.system)
    if before is None or not before.findings:
        return
    rows = rows_of(system, before)
    row = data.draw(st.sampled_from(sorted(rows.values())))
    of_row = tuple(finding for finding in sorted(rows) if rows[finding] == row)
    by_row = [Entry(Choice.ACCEPT, row=row, known=frozenset(of_row))]
    one_by_one = [Entry(Choice.ACCEPT, id=finding) for finding in of_row]
    assert answer(system, on_file(by_row)).findings == answer(system, on_file(one_by_one)).findings
