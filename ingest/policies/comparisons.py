"""The work of comparing wildcards: which pairs are worth it, how much it is in all, and what was too much to follow.

In: expressions as DDS reads them. Out: what ``names.py`` and ``common_names.py`` say of them, counted. A step is a
quarter of a microsecond or so; pairs times their length grow faster than the policy, so the steps are bounded.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import Tally
from rosprivacy.analysis.errors import PolicyError
from rosprivacy.analysis.model import CAREFUL_DENY, Diagnostic, Place, Severity
from rosprivacy.ingest.policies.names import covers, is_pattern, matcher, overlaps

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Element, Grant
    from rosprivacy.ingest.policies.name_index import PlainNames

STEPS_OF_A_PAIR = 4  # beside those for its length
CELLS_OF_A_STEP = 512  # of a name beside an expression that are read in one step


class Comparisons:
    """Compares expressions, counts the steps, and notes DENY lines that were too much to follow.

    Attributes
    ----------
    at
        The line for which it is done, for the message.
    careful
        DENY lines that were taken to leave a name, since it takes too long to tell.
    """

    def __init__(self, bounds: Bounds) -> None:
        self.at = Place("", 0)
        self.careful: set[Place] = set()
        self._steps = Tally(bounds, "comparisons", PolicyError)

    def meet(self, ours: str, theirs: str) -> bool:
        """Whether some name is covered by both."""
        self._steps.add(STEPS_OF_A_PAIR + len(ours), self.at)
        return overlaps(ours, theirs)

    def hold(self, ours: str, theirs: str) -> bool:
        """Whether one covers a name, or all that the other covers."""
        self._steps.add(STEPS_OF_A_PAIR + len(ours), self.at)
        return covers(ours, theirs)

    def placed(self, groups: int) -> None:
        """Count that an expression was put into groups of those that begin and end alike."""
        self._steps.add(STEPS_OF_A_PAIR * groups, self.at)

    def covered(self, expression: str, plain: PlainNames) -> Iterator[tuple[str, Element]]:
        """Those of the channels, each with its DDS name, that an expression covers."""
        matches = matcher(expression)
        for dds, channel in plain.near(expression):
            self._steps.add(STEPS_OF_A_PAIR + len(expression) * len(dds) // CELLS_OF_A_STEP, self.at)
            if matches(dds):
                yield dds, channel

    def name_left(self, matching: tuple[str, ...], rules: Iterable[tuple[str, Grant]]) -> bool:
        """Whether a name is left that all of some expressions match and no rule takes out."""
        from rosprivacy.ingest.policies.common_names import name_left  # noqa: PLC0415 - light start

        rules = list(rules)
        found = name_left(matching, tuple(sorted({dds for dds, _ in rules})))
        self._steps.add(found.steps, self.at)
        if found.careful:
            self.careful.update(line.place for _, line in rules)
        return found.exists


def apart(rules: Iterable[tuple[str, Grant]]) -> tuple[dict[str, list[Grant]], list[tuple[str, Grant]]]:
    """Return rules of plain names by name, and those with wildcards."""
    plain: dict[str, list[Grant]] = defaultdict(list)
    patterns = []
    for dds, line in rules:
        if is_pattern(dds):
            patterns.append((dds, line))
        else:
            plain[dds].append(line)
    return plain, patterns


def careful_warnings(places: Iterable[Place]) -> tuple[Diagnostic, ...]:
    """Return what is to be said of DENY lines that were too much to follow (rules S4, S11)."""
    what = "takes names out of wildcards, and with the other DENYs there it takes too long to tell whether one is left"
    return tuple(
        Diagnostic(place, Severity.WARNING, f"this DENY {what}: it is taken that one is", CAREFUL_DENY)
        for place in sorted(places, key=lambda place: (place.file, place.line))
    )
