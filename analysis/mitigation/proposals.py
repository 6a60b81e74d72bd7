"""What is proposed to remove findings: steps, what they leave, whom they reach.

Made by ``propose.py``; nothing here decides anything.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Finding, Verdict
    from rosprivacy.analysis.mitigation.affected import Affected
    from rosprivacy.analysis.model import Element, Exposure, Grant

ITSELF, NOT_ALLOWED = "itself", "not-allowed"


@dataclass(frozen=True, slots=True)
class ProposedStep:
    """One change of a proposal.

    Attributes
    ----------
    kind
        ``review``, ``filter`` or ``deny``.
    cost
        By the limits.
    categories
        That a filter has to end, or that a review has to find are not carried; empty for a DENY, which ends all.
    between
        (from, to) of a filter; several under the enforced view, where a right is the enclave's.
    channel
        To review.
    grants
        The lines behind the flows that are filtered, or to be set to DENY.
    readers
        Who gets filtered data, or loses data, directly.
    spared
        Of a filter behind a channel: who else reads the channel, and would get filtered data from a filter before it.
    """

    kind: str
    cost: int
    categories: tuple[str, ...] = ()
    between: tuple[tuple[Element, Element], ...] = ()
    channel: Element | None = None
    grants: tuple[Grant, ...] = ()
    readers: tuple[Element, ...] = ()
    spared: tuple[Element, ...] = ()


class Protect(NamedTuple):
    """A line of a governance by which others on the network can read channels, and what changes with it.

    Attributes
    ----------
    exposure
        What the line leaves open: to be encrypted, or to be closed to those without a certificate.
    channels
        That findings are about, as shown, in the order of the graph.
    findings
        That end when all lines of the proposal are changed.
    """

    exposure: Exposure
    channels: tuple[Element, ...]
    findings: tuple[Finding, ...]


@dataclass(frozen=True, slots=True)
class Kept:
    """A finding that no allowed change removes.

    Attributes
    ----------
    reason
        ``itself``: the source is the leak, only another role helps. ``not-allowed``: a path has no place for a change.
    path
        That path.
    """

    finding: Finding
    reason: str
    path: tuple[Element, ...]


@dataclass(frozen=True, slots=True)
class Proposal:
    """The cheapest changes that remove the open findings of some categories.

    Attributes
    ----------
    categories
        Names.
    removed
        Findings that the steps remove.
    remaining
        Findings that stay.
    steps
        Reviews, filters, DENY lines; empty if nothing can be removed, or if no proposal could be proven.
    lower
        No set of such changes that removes them costs less; the steps are the cheapest if they cost as much.
    proven
        Whether a new analysis with the steps applied has no open finding of the categories but those kept.
    verdict
        Of that analysis, which is about all categories that were asked for.
    affected
        Who gets less than before, once the reviews are done.
    protect
        The lines of governances to change: findings of unprotected channels end with them, and with no change of flows.
    """

    categories: tuple[str, ...]
    removed: tuple[Finding, ...]
    remaining: tuple[Kept, ...]
    steps: tuple[ProposedStep, ...]
    lower: int
    proven: bool
    verdict: Verdict
    affected: tuple[Affected, ...] = ()
    protect: tuple[Protect, ...] = ()

    @property
    def cost(self) -> int:
        """The costs of all steps."""
        return sum(step.cost for step in self.steps)
