"""What would close a finding: the proposals of ``mitigate`` that remove it, each proven by a new analysis.

In: a session as it stands and a finding. Out: ``Closes``. Each change, and all of a proposal together, can be tried.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.report.naming import name
from rosprivacy.report.page.closing import change_told, proposal_told

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from typing import Any

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.mitigation.proposals import ProposedStep
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.page.closing import Proposed
    from rosprivacy.report.page.index import Index


class Offered(NamedTuple):
    """A proposal.

    Attributes
    ----------
    number
        Of the proposal, for the form that tries it.
    said
        What it does, and that it is proven.
    changes
        Its changes, in its order.
    """

    number: int
    said: tuple[str, ...]
    changes: tuple[Proposed, ...]


class Closes(NamedTuple):
    """What would close a finding.

    Attributes
    ----------
    why
        Why nothing is proposed; empty where something is.
    instead
        What can be stated or arranged without a change of flows.
    """

    why: str
    offered: tuple[Offered, ...] = ()
    instead: tuple[str, ...] = ()


def closes_pane(standing: Standing, finding: Finding, index: Index) -> Closes:
    """Return what would close a finding.

    Parameters
    ----------
    index
        Of the document of the answer.
    """
    words, found = index.words, standing.mitigation
    if not finding.stands:
        return Closes(words("x.closes.stands"))
    if found is None:
        return Closes(words("z.none.many"))
    rows = found.document()["proposals"]
    offered: dict[tuple[ProposedStep, ...], Offered] = {}
    for number, (proposal, row) in enumerate(zip(found.proposals, rows, strict=True)):
        ends = [one.id for one in proposal.removed] + [one.id for line in proposal.protect for one in line.findings]
        if finding.id in ends and (proposal.proven or proposal.protect):
            changes = tuple(change_told(step, index) for step in row["steps"])
            offered.setdefault(proposal.steps, Offered(number, tuple(proposal_told(row, row["steps"], index)), changes))
    why = "" if offered else words("x.closes.none")
    return Closes(why, tuple(offered.values()), tuple(dict.fromkeys(_instead(rows, finding, index))))


def _instead(rows: list[Any], finding: Finding, index: Index) -> Iterator[str]:
    """What a label file can state of the place, if it is so."""
    for row in (row for proposal in rows for row in proposal["statements"]):
        if _is_of(row, finding):
            named = name(row["element"])
            yield index.words(f"z.state.{row['kind']}", element=named, data=index.data(row["category"]))


def _is_of(row: Mapping[str, Any], finding: Finding) -> bool:
    element = row["element"]
    same = (element["robot"], element["kind"], element["name"]) == finding.leak.identity
    return same and (row["kind"], row["category"]) == (finding.kind, finding.category)
