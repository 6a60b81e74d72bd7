"""Findings that differ only in the robot, counted together (rule S10): what every pattern is made with.

In: findings, or pairs of source and leak before any path is looked for, and for how many each stands. Out: groups,
which are patterns without a path, and how each robot takes part in them.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from operator import add
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.fleet.likeness import pattern_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Element


class Form(NamedTuple):
    """How a finding stands; of those of one pattern the least is shown."""

    dismissed: bool
    accepted: bool
    pseudonymised: bool


class Count(NamedTuple):
    """How many findings there are, and how many of them stand in which form."""

    all: int
    dismissed: int
    accepted: int
    pseudonymised: int

    @classmethod
    def of(cls, count: int, form: Form) -> Count:
        """Return the count of some that all stand alike."""
        return cls(count, *(count * flag for flag in form))


ZERO = Count(0, 0, 0, 0)


class Pair(NamedTuple):
    """What a finding is without its path."""

    kind: str
    category: str
    source: Element
    leak: Element
    plain_also: bool


@dataclass(frozen=True, slots=True)
class CountedPattern:
    """A pattern without a path: the pair that is shown of it, its id, what is counted, and the robots by form."""

    pair: Pair
    id: str
    count: Count
    robots: tuple[str, ...]
    across: bool
    forms: tuple[tuple[Form, tuple[str, ...]], ...] = ()


@dataclass(frozen=True, slots=True, order=True)
class Share:
    """How a robot takes part in a pattern.

    Attributes
    ----------
    pattern
        Id.
    ends
        Whether data gets to this robot, from another; else it begins here, or here and nowhere else.
    dismissed, pseudonymised, accepted
        The finding is.
    """

    pattern: str
    ends: bool
    dismissed: bool
    pseudonymised: bool
    accepted: bool = False


@dataclass(slots=True)
class _Tally:
    shown: Pair
    rank: tuple[object, ...]
    count: Count
    robots: set[str] = field(default_factory=set)


class Tallies:
    """Puts together what differs only in the robot.

    Attributes
    ----------
    shares
        How each robot takes part in patterns.
    """

    def __init__(self, likeness: Likeness) -> None:
        self._likeness = likeness
        self._tallies: dict[str, _Tally] = {}
        self.shares: dict[str, set[Share]] = defaultdict(set)

    def add(self, pair: Pair, form: Form, count: Count, robots: Iterable[str] = ()) -> str:
        """Count findings; return the id of their pattern.

        Parameters
        ----------
        pair, form
            What may be shown of them.
        robots
            Of the graph, where they begin or, if that is on no robot, where they end; by default those of the pair.
        """
        likeness = self._likeness
        key = pattern_of(pair.kind, pair.category, pair.source, pair.leak, likeness, plain_also=pair.plain_also)
        rank = (form, pair.source.sort_key(), pair.leak.sort_key())
        tally = self._tallies.setdefault(key, _Tally(pair, rank, ZERO))
        if rank < tally.rank:
            tally.shown, tally.rank = pair, rank
        tally.count = Count(*map(add, tally.count, count))
        here = pair.source.robot if likeness.is_robot(pair.source.robot) else pair.leak.robot
        tally.robots.update(*(likeness.placed(robot) for robot in robots or [here]))
        return key

    def share(self, key: str, begin: Collection[str], end: Collection[str], form: Form, *, across: bool) -> None:
        """Note on which robots of the graph findings of a pattern begin and end."""
        flags = form.dismissed, form.pseudonymised, form.accepted
        for robot in begin:
            self.shares[robot].add(Share(key, False, *flags))
        for robot in end:
            self.shares[self._likeness.second.get(robot, robot)].add(Share(key, across, *flags))

    def groups(self) -> tuple[CountedPattern, ...]:
        """Return the patterns, without a path."""
        forms = self._forms()
        return tuple(
            CountedPattern(
                tally.shown,
                key,
                tally.count,
                tuple(sorted(tally.robots)),
                self._likeness.apart(tally.shown.source, tally.shown.leak),
                tuple((form, tuple(sorted(robots))) for form, robots in sorted(forms[key].items())),
            )
            for key, tally in self._tallies.items()
        )

    def _forms(self) -> dict[str, dict[Form, set[str]]]:
        """Pattern -> the robots where its findings begin, each under the form that stands most."""
        least: dict[str, dict[str, Form]] = defaultdict(dict)
        for name, shares in self.shares.items():
            for share in shares:
                form = Form(share.dismissed, share.accepted, share.pseudonymised)
                for robot in () if share.ends else self._likeness.placed(name):
                    least[share.pattern][robot] = min(form, least[share.pattern].get(robot, form))
        forms: dict[str, dict[Form, set[str]]] = defaultdict(lambda: defaultdict(set))
        for pattern, robots in least.items():
            for robot, form in robots.items():
                forms[pattern][form].add(robot)
        return forms
