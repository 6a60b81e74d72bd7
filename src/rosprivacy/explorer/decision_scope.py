"""About which robots of a fleet a decision is made: exactly those, whoever joins later (rule S10).

In: findings, and which robots stand for which; the robots that a person names. Out: ``Scope``, what of it an entry of a
decisions file says, and the cases by which it is seen that the entry means no more and no less.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.decided import in_fleet

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.fleet.likeness import Likeness

ENDS = 2  # robots of one kind that are enough to see what holds between any two


class Scope(NamedTuple):
    """The robots that a decision is about; none where a finding is on no robot.

    Attributes
    ----------
    finding
        Of one of them: it stands for all.
    robots
        Where data begins; where that is on no robot, where it gets to.
    to_robots
        Where data gets to, if that is another robot; else empty.
    """

    finding: Finding
    robots: tuple[str, ...] = ()
    to_robots: tuple[str, ...] = ()

    @property
    def alone(self) -> Scope:
        """The same for the robot of the finding only."""
        source, leak = self.finding.source.robot, self.finding.leak.robot
        if self.to_robots:
            return self._replace(robots=(source,), to_robots=(leak,))
        return self._replace(robots=tuple(one for one in (source, leak) if one in self.robots)[:1])

    def chosen(self, robots: Collection[str] | None, to_robots: Collection[str] | None) -> Scope | None:
        """Return the same for some of them, None for all; None if others are named, or none."""
        some = self._replace(
            robots=_some(robots, self.robots), to_robots=_some(to_robots, self.to_robots),
        )  # fmt: skip
        named = (robots, some.robots), (to_robots, some.to_robots)
        return some if all(asked is None or (asked and set(asked) == set(found)) for asked, found in named) else None


def _some(asked: Collection[str] | None, there: tuple[str, ...]) -> tuple[str, ...]:
    return there if asked is None else tuple(one for one in there if one in asked)


def scopes(findings: Iterable[Finding], likeness: Likeness, finding: Finding) -> tuple[Scope, ...]:
    """Return what can be decided about at once: that finding with all that are alike, and each other of its pattern."""
    pattern = pattern_id(finding, likeness)
    like = [one for one in findings if (one.kind, one.category) == (finding.kind, finding.category)]
    same = [one for one in like if likeness.count(one) and pattern_id(one, likeness) == pattern]
    return tuple(_whole(one, likeness) for one in sorted(same, key=lambda one: one.id != finding.id))


def _whole(finding: Finding, likeness: Likeness) -> Scope:
    begins, ends = likeness.placed(finding.source.robot), likeness.placed(finding.leak.robot)
    return Scope(finding, begins, ends) if likeness.across(finding) else Scope(finding, begins or ends)


def scope_of(
    there: Sequence[Scope], file: str, robots: Collection[str] | None, to_robots: Collection[str] | None
) -> Scope:
    """Return the one that a person names; the first if no robots are named.

    Raises
    ------
    InputErrors
        If the robots that are named are not alike, or it is not on them.
    """
    found = [some for one in there if (some := one.chosen(robots, to_robots))]
    if len(found) == 1 or (found and found[0].finding is there[0].finding):
        return found[0]
    named = ", ".join(shown(one) for one in (*(robots or ()), *(to_robots or ()))) or "no robot"
    if found:
        what, hint = f"of {named} data gets to several kinds of robots", "name those that it gets to, too"
    else:
        what, hint = f"it is not on {named}, or they are not alike", "decide about robots that are alike at a time"
    raise InputErrors([DecisionError(file, 0, what, hint)])


def target(scope: Scope, likeness: Likeness) -> dict[str, Any]:
    """Return what an entry says that it is about: the pattern, and each robot by its name."""
    entry: dict[str, Any] = {"id": pattern_id(scope.finding, likeness)}
    if scope.robots:
        entry["robots"] = list(scope.to_robots or scope.robots)
    if scope.to_robots:
        entry["from_robots"] = list(scope.robots)
    return {**entry, "pseudonymised": True} if scope.finding.pseudonymised else entry


def cases(scope: Scope, likeness: Likeness, told_apart: Callable[[str], object]) -> Iterator[Case]:
    """Return what a decision is about, one case for those that entries do not tell apart."""
    whole = in_fleet(Case.of(scope.finding), likeness)
    begins, ends = _of_each_kind(scope.robots, told_apart), _of_each_kind(scope.to_robots, told_apart)
    pairs = [(one, other) for one in begins for other in ends if one != other]
    if not scope.to_robots:
        source, leak = whole.robots
        pairs = [(robot if source else "", robot if leak else "") for robot in begins] or [("", "")]
    for pair in pairs:
        source_end, leak_end = (
            replace(end, robot=robot) if robot else end
            for end, robot in zip((whole.source, whole.leak), pair, strict=True)
        )
        yield whole._replace(source=source_end, leak=leak_end, robots=pair)


def _of_each_kind(robots: Iterable[str], told_apart: Callable[[str], object]) -> list[str]:
    kinds: dict[object, list[str]] = defaultdict(list)
    for robot in robots:
        kinds[told_apart(robot)].append(robot)
    return [robot for kind in kinds.values() for robot in kind[:ENDS]]
