"""What a decision can be about. It stands apart from the decisions, since most runs know none of these (S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element


class Case(NamedTuple):
    """What a decision can be about: a finding, or one that may be made.

    Attributes
    ----------
    id
        Of the finding; empty where it stands for more than itself.
    pattern
        On a fleet, the id of the pattern that it belongs to.
    plain_also
        As of ``Finding``.
    row
        Of the register: the row that it ends in; on a fleet as decisions name it, on whichever robot.
    robots
        On a fleet, the robots that data begins on and gets to; an end that is on no robot is empty.
    """

    id: str
    kind: str
    category: str
    source: Element
    leak: Element
    pseudonymised: bool
    pattern: str = ""
    plain_also: bool = False
    row: str = ""
    robots: tuple[str, str] = ("", "")

    @property
    def across(self) -> bool:
        """Whether data gets from one robot to another."""
        source, leak = self.robots
        return bool(source and leak) and source != leak

    @classmethod
    def of(cls, finding: Finding) -> Case:
        """Return the case that a finding is."""
        ends = finding.source, finding.leak
        case = cls(finding.id, finding.kind, finding.category, *ends, finding.pseudonymised)
        return case._replace(plain_also=finding.plain_also).in_row()

    def in_row(self) -> Case:
        """Return the case with its row; of one robot that is made from the kind and the place alone."""
        from rosprivacy.analysis.model.register_row import row_id  # noqa: PLC0415 - light start

        return self._replace(row=row_id(self.category, [self.leak]))
