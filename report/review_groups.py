"""Open elements as a person reviews them, for every report: in groups, what closes most first (rule S11).

In: a JSON document of the contract. Out: groups of its rows, apart from what can wait and what a file of the program
proposes to take as mundane.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import CHANNELS
from rosprivacy.report.finding_facts import weights
from rosprivacy.report.naming import key

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.model import Weight

    Question = Mapping[str, Any]

SHOWN = 12  # open elements of a group that a person looks at next
FIRST, AT_CHANNELS, BEHIND = "first", "channels", "behind"


class ReviewGroup(NamedTuple):
    """Open elements of one urgency.

    Attributes
    ----------
    key
        ``FIRST``: nodes that data reaches before any other open node; ``AT_CHANNELS``; ``BEHIND``: nodes behind those.
    questions
        All of them, rows of the document.
    """

    key: str
    questions: tuple[Question, ...]

    @property
    def now(self) -> tuple[Question, ...]:
        """Those that neither wait nor are proposed as mundane."""
        return tuple(q for q in self.questions if not (q.get("infrastructure") or q.get("waits")))

    @property
    def waiting(self) -> tuple[Question, ...]:
        """Channels from which data gets to no leak and no node that is not reviewed."""
        return tuple(q for q in self.questions if q.get("waits") and not q.get("infrastructure"))

    @property
    def proposed(self) -> tuple[Question, ...]:
        """Channels that the infrastructure file proposes to take as mundane."""
        return tuple(q for q in self.questions if q.get("infrastructure"))


def review_groups(report: Mapping[str, Any]) -> tuple[ReviewGroup, ReviewGroup, ReviewGroup]:
    """Return nodes on the frontier, channels, and what lies behind; of what is alike, the heaviest kinds first."""
    kinds = weights(report)

    def urgency(q: Question) -> tuple[int, int, int, Weight]:
        return -q.get("leaks", 0), -q.get("closes", 0), q["distance"], min(kinds[one] for one in q["categories"])

    rows = sorted(report["open"], key=urgency)
    nodes = [q for q in rows if q["element"]["kind"] not in CHANNELS]
    return (
        ReviewGroup(FIRST, tuple(q for q in nodes if q["frontier"])),
        ReviewGroup(AT_CHANNELS, tuple(q for q in rows if q["element"]["kind"] in CHANNELS)),
        ReviewGroup(BEHIND, tuple(q for q in nodes if not q["frontier"])),
    )


def next_round(report: Mapping[str, Any]) -> Sequence[Question]:
    """Return what to review next: nodes that data reaches first, and channels; at last what could wait."""
    first, channels, behind = review_groups(report)
    now = [*first.questions[:SHOWN], *channels.now[:SHOWN]]
    return now or [*behind.questions, *channels.questions][:SHOWN]


def sources_of(report: Mapping[str, Any]) -> Mapping[Any, Sequence[str]]:
    """Return which kinds of data each source brings in."""
    brings: dict[Any, list[str]] = defaultdict(list)
    for said in report["roles"]:
        if "source" in said["roles"]:
            brings[key(said["element"])].append(said["category"])
    return brings
