"""Findings of a fleet -> patterns: findings that differ only in the robot; and the robots that differ (rule S10).

In: findings of a graph in which one robot stands for those that are alike, and which stands for which. Out: patterns
with how many findings and which robots each has, and deviants: robots whose result is not that of most of their model.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.fleet.tallies import Count, Form, Pair, Share, Tallies

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.tallies import CountedPattern
    from rosprivacy.analysis.model import Element


@dataclass(frozen=True, slots=True)
class Pattern:
    """Findings that differ only in the robot.

    Attributes
    ----------
    id
        16 hexadecimal digits made from kind, category, source and leak without their robots, whether it goes across
        robots, and whether it stands beside pseudonymised findings.
    finding
        The one that is shown: if there is such a one not dismissed, accepted or pseudonymised; of the first robot.
    count
        How many findings there are.
    robots
        Where they begin, or where they end if that is on no robot; sorted.
    across
        Whether data gets from one robot to another.
    dismissed, pseudonymised, accepted
        How many of the findings are.
    forms
        The robots by how their finding stands: each under the form that stands most, these forms first.
    """

    id: str
    finding: Finding
    count: int
    robots: tuple[str, ...]
    across: bool
    dismissed: int
    pseudonymised: int
    accepted: int = 0
    forms: tuple[tuple[Form, tuple[str, ...]], ...] = ()


@dataclass(frozen=True, slots=True)
class DeviantRobots:
    """Robots whose result differs from that of most robots of their model.

    Attributes
    ----------
    more, fewer
        What they have and most do not, and the other way round; sorted.
    more_open, fewer_open
        The same of open elements; without their robot.
    """

    robots: tuple[str, ...]
    model: str
    additional: tuple[Share, ...]
    fewer: tuple[Share, ...]
    more_open: tuple[Element, ...]
    fewer_open: tuple[Element, ...]


@dataclass(frozen=True, slots=True)
class FleetView:
    """What a fleet's analysis says of its robots together."""

    likeness: Likeness
    patterns: tuple[Pattern, ...]
    deviants: tuple[DeviantRobots, ...]

    @classmethod
    def of(cls, analysis: Analysis, likeness: Likeness) -> FleetView:
        """Put the findings of an analysis together."""
        return cls.counted(tallied(analysis.findings, likeness), analysis, likeness)

    @classmethod
    def counted(cls, tallies: Tallies, analysis: Analysis, likeness: Likeness) -> FleetView:
        """Return the same when its findings are counted already."""
        patterns = patterns_of(tallies.groups(), analysis.findings)
        return cls(likeness, patterns, _deviants_of(tallies.shares, analysis.open, likeness))

    def shown(self, analysis: Analysis) -> Analysis:
        """Return the analysis with one finding of each pattern, and without robots that only stand beside others."""
        second = self.likeness.second
        return replace(
            analysis,
            findings=tuple(pattern.finding for pattern in self.patterns),
            open=tuple(question for question in analysis.open if question.element.robot not in second),
            carried=tuple(carried for carried in analysis.carried if carried.element.robot not in second),
            roles={element: said for element, said in analysis.roles.items() if element.robot not in second},
            unstated=tuple((element, name) for element, name in analysis.unstated if element.robot not in second),
            standard_reached=tuple(row for row in analysis.standard_reached if row[0].robot not in second),
            closed_by_shipped=tuple(row for row in analysis.closed_by_shipped if row.channel.robot not in second),
            standard_unchanged=tuple(e for e in analysis.standard_unchanged if e.robot not in second),
            outside={element: facts for element, facts in analysis.outside.items() if element.robot not in second},
            unknown_ends=tuple(end for end in analysis.unknown_ends if end.element.robot not in second),
        )


def tallied(findings: Iterable[Finding], likeness: Likeness) -> Tallies:
    """Count the findings that differ only in the robot together; linear in the findings and the robots listed.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> likeness = Likeness({"amr-1": ("amr-1", "amr-2")})
    >>> groups = tallied(analyse(*factory("amr-1")).findings, likeness).groups()
    >>> [(group.pair.category, group.count.all, group.robots) for group in groups if group.pair.leak.name == "/archive"]
    [('FaceTemplate', 2, ('amr-1', 'amr-2')), ('Video', 2, ('amr-1', 'amr-2'))]
    """
    tallies = Tallies(likeness)
    for finding in findings:
        if count := likeness.count(finding):
            form = Form(finding.dismissed, finding.accepted, finding.pseudonymised)
            pair = Pair(finding.kind, finding.category, finding.source, finding.leak, finding.plain_also)
            key = tallies.add(pair, form, Count.of(count, form))
            tallies.share(key, (finding.source.robot,), (finding.leak.robot,), form, across=likeness.across(finding))
    return tallies


def patterns_of(groups: Iterable[CountedPattern], findings: Iterable[Finding]) -> tuple[Pattern, ...]:
    """Return the patterns, each with the finding that was made of what it shows, in the order of these.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> findings = analyse(*factory("amr-1")).findings
    >>> groups = tallied(findings, Likeness({"amr-1": ("amr-1", "amr-2")})).groups()
    >>> [(pattern.finding.category, pattern.count) for pattern in patterns_of(groups, findings)]
    [('FaceTemplate', 2), ('FaceTemplate', 2), ('Video', 2), ('Video', 2)]
    """
    order = {(f.kind, f.category, f.source, f.leak, f.plain_also): (n, f) for n, f in enumerate(findings)}
    return tuple(
        Pattern(
            group.id,
            order[group.pair][1],
            group.count.all,
            group.robots,
            group.across,
            group.count.dismissed,
            group.count.pseudonymised,
            group.count.accepted,
            group.forms,
        )
        for group in sorted(groups, key=lambda group: order[group.pair][0])
    )


Result = tuple[frozenset[Share], frozenset["Element"]]


def _deviants_of(
    shares: Mapping[str, Collection[Share]], questions: Iterable[OpenQuestion], likeness: Likeness
) -> tuple[DeviantRobots, ...]:
    """Return the robots that differ from most of their model, by model and id; of equally many, the first are most.

    Parameters
    ----------
    shares
        How each robot of the graph takes part in patterns.
    """
    of_model = Counter(likeness.models.values())
    compared = {robot for robot, model in likeness.models.items() if of_model[model] > 1}
    open_at: dict[str, set[Element]] = defaultdict(set)
    for question in questions:
        if question.element.robot in compared:
            open_at[question.element.robot].add(likeness.alike(question.element))
    return different(shares, open_at, likeness)


def different(
    shares: Mapping[str, Collection[Share]], open_at: Mapping[str, Collection[Element]], likeness: Likeness
) -> tuple[DeviantRobots, ...]:
    """Return the same, when it is also known what is open on each; without its robot.

    >>> from rosprivacy.analysis.fleet.likeness import Likeness
    >>> robots = ("amr-1", "amr-2", "amr-3")
    >>> likeness = Likeness({name: (name,) for name in robots}, models=dict.fromkeys(robots, "amr"))
    >>> shares = {"amr-3": [Share("1158fa035bd7d664", False, False, False)]}
    >>> [(row.robots, [share.pattern for share in row.additional]) for row in different(shares, {}, likeness)]
    [(('amr-3',), ['1158fa035bd7d664'])]
    """
    results = {
        robot: (frozenset(shares.get(robot, ())), frozenset(open_at.get(robot, ()))) for robot in likeness.members
    }
    of_model: dict[str, list[str]] = defaultdict(list)
    for robot, model in sorted(likeness.models.items()):
        if model:
            of_model[model].append(robot)
    deviants = []
    for model, robots in sorted(of_model.items()):
        many: Counter[Result] = Counter()
        for robot in robots:
            many[results[robot]] += likeness.weight(robot)
        usual = max(many, key=lambda result: many[result])  # of equally many the first that was put in
        deviants += [
            _deviant(robot, model, results[robot], usual, likeness) for robot in robots if results[robot] != usual
        ]
    return tuple(deviants)


def _deviant(robot: str, model: str, result: Result, usual: Result, likeness: Likeness) -> DeviantRobots:
    return DeviantRobots(
        likeness.members[robot],
        model,
        tuple(sorted(result[0] - usual[0])),
        tuple(sorted(usual[0] - result[0])),
        _in_order(result[1] - usual[1]),
        _in_order(usual[1] - result[1]),
    )


def _in_order(elements: Iterable[Element]) -> tuple[Element, ...]:
    return tuple(sorted(elements, key=lambda element: element.sort_key()))
