"""A fleet in words: which robots a finding stands for, which robot for which.

In: a ``FleetView``. Out: sentences, so that nobody takes the robot that is shown for the only one.
"""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern
    from rosprivacy.report.schemas.analysis import FormEntry

SHOWN_AT_MOST = 30  # robots in a row
FORMS = {
    "dismissed": ("only through another leak", "by a path of its own"),
    "accepted": ("accepted", "not accepted"),
    "pseudonymised": ("pseudonymised", "unfiltered"),
}


def note(view: FleetView) -> str:
    """Return what a reader has to know who sees the robots that are shown only."""
    members = view.likeness.members
    standing = [f"{shown(robot)} for {len(robots):,}" for robot, robots in members.items() if len(robots) > 1]
    more = [f"and {len(standing) - SHOWN_AT_MOST:,} more"] if len(standing) > SHOWN_AT_MOST else []
    robots = counted(sum(map(len, members.values())), "robot")
    if not standing:
        return f"A fleet of {robots}"
    rows = ", ".join([*standing[:SHOWN_AT_MOST], *more])
    return f"A fleet of {robots}; of those that are alike one is named and counted: {rows}"


def form_rows(pattern: Pattern) -> list[FormEntry]:
    """Return the robots of a pattern by how their finding stands, as a document has them."""
    return [
        {
            "robots": list(robots),
            "dismissed": form.dismissed,
            "accepted": form.accepted,
            "pseudonymised": form.pseudonymised,
        }
        for form, robots in pattern.forms
    ]


def forms_in_words(
    forms: Iterable[Mapping[str, Any]], texts: Mapping[str, tuple[str, str]] = MappingProxyType(FORMS)
) -> list[tuple[Sequence[str], str]]:
    """Return the robots of a pattern, with how their finding stands; none where it stands alike on all.

    Parameters
    ----------
    forms
        Rows of a document.
    texts
        Key of such a row -> words where it holds, and where it does not.

    >>> lent = {"robots": ["b"], "dismissed": False, "accepted": False, "pseudonymised": False}
    >>> forms_in_words([lent, {**lent, "robots": ["a", "c"], "pseudonymised": True}])
    [(['b'], 'unfiltered'), (['a', 'c'], 'pseudonymised')]
    """
    rows = list(forms)
    differ = [key for key in FORMS if len({row[key] for row in rows}) > 1]
    return [(row["robots"], ", ".join(texts[key][not row[key]] for key in differ)) for row in rows if differ]


def on_robots(pattern: Pattern, view: FleetView) -> str:
    """Return on how many robots a pattern is, in a sentence."""
    if not pattern.robots:
        return "It begins and ends outside the robots."
    everybody = counted(sum(map(len, view.likeness.members.values())), "robot")
    across = f", from one to another, {pattern.count:,} times" if pattern.across else ""
    forms = forms_in_words(form_rows(pattern))
    more = "".join(f" {counted(len(robots), 'robot')}: {words}." for robots, words in forms)
    return f"On {len(pattern.robots):,} of {everybody}{across}.{more}"
