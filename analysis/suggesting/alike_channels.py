"""Open channels that are made for other things than what reaches them, by the same rule: what makes them alike.

In: what is proposed of a channel. Out: a likeness. Of channels of the same likeness a person can say in one list that
nothing of it goes through (docs/suggestions.md). A name is no such rule, and neither are the neighbours: behind a
channel of which nobody knows the type, or whose type can carry anything, a leak could hide.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.evidence import NEVER

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.suggesting.evidence import Proposal

Alike = frozenset[str]  # families


def alike(kinds: Iterable[str], about: Sequence[Proposal]) -> Alike:
    """Return by which rules a channel is made for other things than any of the kinds; empty if it is not said of all.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Confidence, Element, Place
    >>> from rosprivacy.analysis.suggesting.evidence import Evidence, Label
    >>> from rosprivacy.analysis.suggesting.weighing import proposals
    >>> never = Label(Element("topic", "/spin"), "never", "Video")
    >>> reason = Evidence(never, "type", Confidence.MAY, "a reason", Place("types.yaml", 7), "types.yaml:7")
    >>> by_name = Evidence(never, "name", Confidence.MAY, "a word", Place("names.yaml", 2))
    >>> [sorted(alike(kinds, proposals([reason]))) for kinds in (["Video"], ["Video", "Voice"])]
    [['types.yaml:7'], []]
    >>> alike(["Video"], proposals([by_name]))
    frozenset()
    """
    if any(one.label.role != NEVER for one in about):
        return frozenset()
    families: set[str] = set()
    for kind in kinds:
        of_kind = {each.family for one in about if one.label.kind == kind for each in one.evidence if each.family}
        if not of_kind:
            return frozenset()
        families |= of_kind
    return frozenset(families)
