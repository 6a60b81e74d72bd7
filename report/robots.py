"""A fleet in words: which robots a finding stands for, which robot for which.

In: a ``FleetView``. Out: sentences, so that nobody takes the robot that is shown for the only one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from rosprivacy.analysis.fleet.patterns import FleetView, Pattern

NAMED = 30  # robots in a row


def note(view: FleetView) -> str:
    """Return what a reader has to know who sees the robots that are shown only."""
    members = view.likeness.members
    standing = [f"{shown(robot)} for {len(robots):,}" for robot, robots in members.items() if len(robots) > 1]
    more = [f"and {len(standing) - NAMED:,} more"] if len(standing) > NAMED else []
    robots = counted(sum(map(len, members.values())), "robot")
    if not standing:
        return f"A fleet of {robots}"
    rows = ", ".join([*standing[:NAMED], *more])
    return f"A fleet of {robots}; of those that are alike one is named and counted: {rows}"


def on_robots(pattern: Pattern, view: FleetView) -> str:
    """Return on how many robots a pattern is, in a sentence."""
    if not pattern.robots:
        return "It begins and ends outside the robots."
    everybody = counted(sum(map(len, view.likeness.members.values())), "robot")
    across = f", from one to another, {pattern.count:,} times" if pattern.across else ""
    parts = [
        f"{number:,} {what}"
        for number, what in ((pattern.dismissed, "only through another leak"), (pattern.pseudonymised, "pseudonymised"))
        if 0 < number < pattern.count
    ]
    more = f" ({', '.join(parts)})" if parts else ""
    return f"On {len(pattern.robots):,} of {everybody}{across}{more}."
