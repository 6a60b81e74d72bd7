"""An answer under what types cannot carry, beside the one without: what they alone close, and what stays open (S15).

In: the two analyses of one system. Out: the first, with the open questions of the second, for a type reviews nothing:
what lies behind a limit is as open as before. Its verdict follows from that.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.answer import ClosedByTypes, Verdict
from rosprivacy.analysis.kernel.type_limits import closed

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis, Finding


def held_by_types(under: Analysis, without: Analysis, gone: tuple[Finding, ...]) -> Analysis:
    """Return an analysis under limits with what only these close.

    Parameters
    ----------
    gone
        The findings that only the limits close; of a fleet one of each pattern.

    Examples
    --------
    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> analysis = analyse(*factory())
    >>> held_by_types(analysis, analysis, ()).closed
    ClosedByTypes(flows=0, channels=(), findings=())
    """
    mask = sum(under.spread.both(category) for category in under.emitted)
    leak = any(finding.stands for finding in under.findings)
    return replace(
        under,
        open=without.open,
        verdict=Verdict.of(leak=leak, is_open=bool(without.open), known=not under.lacking),
        closed=ClosedByTypes(*closed(under.spread, mask), gone),
    )
