"""The findings of an answer as a table: a sequence of ``Finding``, rows for data frames, HTML for notebooks.

In: findings, and who says what the verdict is. Out: plain dicts; HTML in which every text is escaped. What is shown
begins with the line of the verdict, so that a table without rows is never read as 'nothing to find' (rule S12).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, overload

from rosprivacy.analysis.text import fit

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Any

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.fleet.patterns import FleetView

COLUMNS = ("id", "kind", "category", "source", "leak", "pseudonymised", "dismissed", "accepted")
MOST = 60  # rows that a notebook shows


@dataclass(frozen=True, slots=True, repr=False)
class Findings(Sequence["Finding"]):
    """Findings in their order, dismissed and accepted ones too; of a fleet one of each pattern.

    Attributes
    ----------
    verdict
        Says the line of the verdict.
    """

    findings: tuple[Finding, ...]
    fleet: FleetView | None
    verdict: Callable[[], str]

    @overload
    def __getitem__(self, index: int) -> Finding: ...
    @overload
    def __getitem__(self, index: slice) -> Findings: ...
    def __getitem__(self, index: int | slice) -> Finding | Findings:
        found = self.findings[index]
        return Findings(found, self.fleet, self.verdict) if isinstance(found, tuple) else found

    def __len__(self) -> int:
        return len(self.findings)

    def __repr__(self) -> str:
        return f"<Findings: {len(self)}; {self.verdict()}>"

    def to_rows(self) -> list[dict[str, Any]]:
        """Return a plain dict for each finding, for ``pandas.DataFrame`` and ``polars.DataFrame``.

        Of a fleet each says for how many ``findings`` it stands, and on which ``robots``.
        """
        patterns = {pattern.finding.id: pattern for pattern in self.fleet.patterns} if self.fleet else {}
        rows = []
        for finding in self.findings:
            row = _row(finding)
            if self.fleet:
                pattern = patterns[finding.id]
                row |= {"findings": pattern.count, "robots": list(pattern.robots)}
            rows.append(row)
        return rows

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        rows = self.to_rows()
        columns = [*COLUMNS, *(["findings"] if self.fleet else [])]
        head = "".join(f"<th>{column}</th>" for column in columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{escape(_cell(row[column]))}</td>" for column in columns) + "</tr>"
            for row in rows[:MOST]
        )
        more = f"<p>{len(rows) - MOST} more findings</p>" if len(rows) > MOST else ""
        caption = f"<caption>{escape(self.verdict())}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _cell(value: object) -> str:
    return ("yes" if value else "") if isinstance(value, bool) else fit(str(value))


def _row(finding: Finding) -> dict[str, Any]:
    return {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "pseudonymised": finding.pseudonymised,
        "source": finding.source.full_name,
        "leak": finding.leak.full_name,
        "path": [element.full_name for element in finding.witness],
        "lines": [str(grant.place) for step in finding.steps for grant in step.grants],
        "disjoint_paths": finding.number_of_paths,
        "through": [element.full_name for element in finding.through],
        "dismissed": finding.dismissed,
        "accepted": finding.accepted,
        "reason": finding.reason,
    }
