"""What a decision was made about, and what of it has changed since (rule S10).

In: what a decisions file remembers of a finding or a pattern, and the same of today. Out: what differs. A decision that
remembers nothing is compared to nothing. That something has changed takes no decision away, but for robots: one that
was not there is not decided about.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

STATED = ("operator", "recipient", "contract", "country", "transfer", "encrypted")  # of a place
MOST_NAMED = 5  # robots in a message


@dataclass(frozen=True, slots=True)
class About:
    """What a decision was made about, or would be today; what is empty is not known.

    Attributes
    ----------
    view
        ``declared`` or ``enforced``.
    path
        Names of the elements of the witness, source first.
    disjoint_paths
        How many paths share no flow.
    robots
        Of a pattern on a fleet: its robots; where data gets from one robot to another, all of the fleet.
    from_robots
        Of a row where some data come from another robot: the robots where data begin; ``robots`` are those where it
        ends.
    findings, pseudonymised
        Of a row of the register: ids of its findings, those of data in this form only apart.
    stated
        Of a row: what was stated of its place, of ``stated_of``.
    """

    view: str = ""
    path: tuple[str, ...] = ()
    disjoint_paths: int = 0
    robots: frozenset[str] = frozenset()
    findings: frozenset[str] = frozenset()
    pseudonymised: frozenset[str] = frozenset()
    stated: tuple[str, ...] = ()
    from_robots: frozenset[str] = frozenset()

    @classmethod
    def of_row(
        cls, findings: Iterable[tuple[str, bool]], stated: tuple[str, ...], robots: Iterable[str] = (),
        from_robots: Iterable[str] = (),
    ) -> About:  # fmt: skip
        """Return what a decision about a row is made about: its findings, each with whether it is pseudonymised.

        Parameters
        ----------
        findings
            Ids; of a fleet those of patterns.
        """
        forms = dict(findings)
        plain, hidden = (frozenset(one for one, form in forms.items() if form is some) for some in (False, True))
        return cls(
            robots=frozenset(robots), findings=plain, pseudonymised=hidden, stated=stated,
            from_robots=frozenset(from_robots),
        )  # fmt: skip

    def knew(self, ends: tuple[str, str], ids: Collection[str] = (), *, hidden: bool = False) -> bool:
        """Whether the robots of two ends, and a finding, were there; where none are remembered, all were.

        Parameters
        ----------
        ends
            Names of robots where data begin and end; an end on none is empty.
        ids
            Of the finding; on a fleet that of its pattern, too.
        hidden
            Whether data get there in pseudonymised form only; what was known as it is was known in this form, too.
        """
        known = self.findings | self.pseudonymised if hidden else self.findings
        there = not known.isdisjoint(ids) or not (self.findings or self.pseudonymised)
        begins = self.from_robots or self.robots
        return there and (not self.robots or ({ends[0]} - {""} <= begins and {ends[1]} - {""} <= self.robots))


def stated_of(place: Mapping[str, object]) -> tuple[str, ...]:
    """Return what is stated of a place where data leave or rest, in texts to compare.

    >>> stated_of({"country": "TN", "recipient": "processor", "operator": "", "encrypted": False}), stated_of({})
    (('recipient: processor', 'country: TN', 'encrypted: False'), ('-',))
    """
    said = tuple(f"{key}: {place[key]}" for key in STATED if place.get(key) not in ("", None))
    return said or ("-",)


class ChangedAspect(NamedTuple):
    """What is not as it was when a decision was made: a field of ``About``, as text then and now."""

    aspect: str
    before: str
    now: str


def changes(before: About | None, now: About | None) -> tuple[ChangedAspect, ...]:
    """Return what has changed, of what is known of both.

    >>> before = About("declared", ("/camera", "/uplink"), 1)
    >>> [(c.aspect, c.before, c.now) for c in changes(before, About("declared", ("/camera", "/log", "/uplink"), 2))]
    [('path', '/camera -> /uplink', '/camera -> /log -> /uplink'), ('disjoint_paths', '1', '2')]
    >>> changes(None, before), changes(before, before)
    ((), ())
    """
    return tuple(_changes(before, now)) if before and now else ()


def first_changes(before: About | None, names: Iterable[str], now: Mapping[str, About]) -> tuple[ChangedAspect, ...]:
    """Return what has changed of the first of some, by name, that is not as it was.

    >>> now = {"a": About("declared"), "b": About("enforced")}
    >>> [change.now for change in first_changes(About("declared"), ["b", "a"], now)]
    ['enforced']
    """
    return next((found for name in sorted(names) if (found := changes(before, now.get(name)))), ())


def _changes(before: About, now: About) -> Iterator[ChangedAspect]:
    pairs = {
        "view": (before.view, now.view),
        "path": (" -> ".join(before.path), " -> ".join(now.path)),
        "disjoint_paths": (str(before.disjoint_paths or ""), str(now.disjoint_paths or "")),
        "stated": ("; ".join(before.stated), "; ".join(now.stated)),
    }
    yield from (
        ChangedAspect(aspect, then, today)
        for aspect, (then, today) in pairs.items()
        if then and today and then != today
    )
    then, today = (about.robots | about.from_robots for about in (before, now))
    if then and today and then != today:
        yield ChangedAspect("robots", str(len(then)), _counted(today, today - then))


def _counted(robots: frozenset[str], joined: frozenset[str]) -> str:
    """How many robots there are, and the first of those that joined."""
    named = [f"+{robot}" for robot in sorted(joined)]
    more = [f"+{len(named) - MOST_NAMED}"] if len(named) > MOST_NAMED else []
    return ", ".join([str(len(robots)), *named[:MOST_NAMED], *more])


def change_text(changes: Iterable[ChangedAspect]) -> str:
    """Return changes as one text.

    >>> change_text([ChangedAspect("disjoint_paths", "1", "2"), ChangedAspect("robots", "2", "3, +amr-3")])
    'disjoint paths: 1 then, 2 now; robots: 2 then, 3, +amr-3 now'
    """
    return "; ".join(f"{change.aspect.replace('_', ' ')}: {change.before} then, {change.now} now" for change in changes)


def as_written(about: About) -> Mapping[str, object]:
    """Return it as a decisions file holds it, without what is not known.

    >>> as_written(About("declared", disjoint_paths=2, robots=frozenset({"amr-2", "amr-1"})))
    {'view': 'declared', 'disjoint_paths': 2, 'robots': ['amr-1', 'amr-2']}
    """
    said = {
        "view": str(about.view),
        "path": list(about.path),
        "disjoint_paths": about.disjoint_paths,
        "robots": sorted(about.robots),
        "from_robots": sorted(about.from_robots),
        "findings": sorted(about.findings),
        "pseudonymised": sorted(about.pseudonymised),
        "stated": list(about.stated),
    }
    return {key: value for key, value in said.items() if value}
