"""Findings of a fleet -> patterns: findings that differ only in the robot; and the robots that differ (rule S10).

In: findings of a graph in which one robot stands for those that are alike, and which stands for which. Out: patterns
with how many findings and which robots each has, and deviants: robots whose result is not that of most of their model.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.findings import finding_id

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
    from rosprivacy.analysis.model import Element


@dataclass(frozen=True, slots=True)
class Likeness:
    """Which robots of a graph stand for which robots of a fleet.

    Attributes
    ----------
    members
        A robot of the graph -> the robots that are alike, itself first; names that are no key are infrastructure and
        what is shared, which stand for themselves and count as no robot.
    second
        A second robot of the graph -> the first one, which it is like: needed to find what goes from one to another.
    models
        As ``members``; empty where there is no model.
    """

    members: Mapping[str, tuple[str, ...]]
    second: Mapping[str, str] = field(default_factory=dict)
    models: Mapping[str, str] = field(default_factory=dict)

    def is_robot(self, name: str) -> bool:
        """Return whether a name is that of a robot of the graph."""
        return name in self.members or name in self.second

    def weight(self, name: str) -> int:
        """Return for how many the robot of an element stands; what is no robot stands for itself."""
        return 0 if name in self.second else len(self.members.get(name, ("",)))

    def alike(self, element: Element) -> Element:
        """Return the element as it would be on any robot."""
        return replace(element, robot="") if self.is_robot(element.robot) else element

    def count(self, finding: Finding) -> int:
        """Return for how many findings of the fleet one of the graph stands; 0 if another does."""
        return self.between(finding.source.robot, finding.leak.robot)

    def between(self, source: str, leak: str) -> int:
        """Return the same for the robots of source and leak."""
        if source in self.second or self.second.get(leak, source) != source:
            return 0
        if leak in self.second:
            return self.weight(source) * (self.weight(source) - 1)
        return self.weight(source) * (1 if leak == source else self.weight(leak))

    def alone(self, source: Element, leak: Element) -> bool:
        """Return whether what begins and ends so stands for no other of its kind."""
        robots = {source.robot, leak.robot}
        return not robots & self.second.keys() and all(self.weight(robot) == 1 for robot in robots)

    def across(self, finding: Finding) -> bool:
        """Return whether data gets from one robot to another."""
        source, leak = finding.source.robot, finding.leak.robot
        return source != leak and self.is_robot(source) and self.is_robot(leak)

    def robots(self, finding: Finding) -> tuple[str, ...]:
        """Return the robots of the fleet from which a finding of the graph begins or, if from none, where it ends."""
        return self.members.get(finding.source.robot) or self.members.get(finding.leak.robot, ())


NO_ROBOTS = Likeness({})


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
    """

    id: str
    finding: Finding
    count: int
    robots: tuple[str, ...]
    across: bool
    dismissed: int
    pseudonymised: int
    accepted: int = 0


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


@dataclass(frozen=True, slots=True)
class Deviant:
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
    more: tuple[Share, ...]
    fewer: tuple[Share, ...]
    more_open: tuple[Element, ...]
    fewer_open: tuple[Element, ...]


@dataclass(frozen=True, slots=True)
class FleetView:
    """What a fleet's analysis says of its robots together."""

    likeness: Likeness
    patterns: tuple[Pattern, ...]
    deviants: tuple[Deviant, ...]

    @classmethod
    def of(cls, analysis: Analysis, likeness: Likeness) -> FleetView:
        """Put the findings of an analysis together."""
        return cls(
            likeness,
            patterns(analysis.findings, likeness),
            deviants(analysis.findings, analysis.open, likeness),
        )

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
            standard_unchanged=tuple(e for e in analysis.standard_unchanged if e.robot not in second),
            outside={element: facts for element, facts in analysis.outside.items() if element.robot not in second},
            unknown_ends=tuple(end for end in analysis.unknown_ends if end.element.robot not in second),
        )


def pattern_id(finding: Finding, likeness: Likeness) -> str:
    """Return the id of the pattern of a finding; without robots it is that of the finding."""
    return pattern_of(finding.kind, finding.category, finding.source, finding.leak, likeness, beside=finding.beside)


def pattern_of(
    kind: str, category: str, source: Element, leak: Element, likeness: Likeness, *, beside: bool = False
) -> str:
    """Return the id of the pattern of what would be a finding."""
    across = source.robot != leak.robot and likeness.is_robot(source.robot) and likeness.is_robot(leak.robot)
    kind = f"across {kind}" if across else kind
    return finding_id(category, likeness.alike(source), likeness.alike(leak), kind, beside=beside)


def patterns(findings: Iterable[Finding], likeness: Likeness) -> tuple[Pattern, ...]:
    """Put findings that differ only in the robot together, in the order of the first of each.

    Notes
    -----
    Linear in the findings and in the robots that are listed.
    """
    grouped: dict[str, list[Finding]] = defaultdict(list)
    for finding in findings:
        if likeness.count(finding):
            grouped[pattern_id(finding, likeness)].append(finding)
    return tuple(_pattern(key, found, likeness) for key, found in grouped.items())


def _pattern(key: str, found: list[Finding], likeness: Likeness) -> Pattern:
    counts = [likeness.count(finding) for finding in found]
    robots = sorted({robot for finding in found for robot in likeness.robots(finding)})
    return Pattern(
        key,
        min(found, key=lambda finding: (finding.dismissed, finding.accepted, finding.pseudonymised)),
        sum(counts),
        tuple(robots),
        likeness.across(found[0]),
        sum(count for count, finding in zip(counts, found, strict=True) if finding.dismissed),
        sum(count for count, finding in zip(counts, found, strict=True) if finding.pseudonymised),
        sum(count for count, finding in zip(counts, found, strict=True) if finding.accepted),
    )


Result = tuple[frozenset[Share], frozenset["Element"]]


def deviants(findings: Iterable[Finding], questions: Iterable[OpenQuestion], likeness: Likeness) -> tuple[Deviant, ...]:
    """Return the robots that differ from most of their model, by model and id; of equally many, the first are most."""
    return deviants_of(_shares(findings, likeness), questions, likeness)


def deviants_of(
    shares: Mapping[str, Collection[Share]], questions: Iterable[OpenQuestion], likeness: Likeness
) -> tuple[Deviant, ...]:
    """Return the same, when it is known how each robot of the graph takes part in patterns."""
    open_at: dict[str, set[Element]] = defaultdict(set)
    for question in questions:
        open_at[question.element.robot].add(likeness.alike(question.element))
    return different(shares, open_at, likeness)


def different(
    shares: Mapping[str, Collection[Share]], open_at: Mapping[str, Collection[Element]], likeness: Likeness
) -> tuple[Deviant, ...]:
    """Return the same, when it is also known what is open on each; without its robot."""
    results = {
        robot: (frozenset(shares.get(robot, ())), frozenset(open_at.get(robot, ()))) for robot in likeness.members
    }
    of_model: dict[str, list[str]] = defaultdict(list)
    for robot, model in sorted(likeness.models.items()):
        if model:
            of_model[model].append(robot)
    found = []
    for model, robots in sorted(of_model.items()):
        many: Counter[Result] = Counter()
        for robot in robots:
            many[results[robot]] += likeness.weight(robot)
        usual = max(many, key=lambda result: many[result])  # of equally many the first that was put in
        found += [
            _deviant(robot, model, results[robot], usual, likeness) for robot in robots if results[robot] != usual
        ]
    return tuple(found)


def _shares(findings: Iterable[Finding], likeness: Likeness) -> dict[str, set[Share]]:
    """How each robot that stands for itself and others takes part in patterns."""
    shares: dict[str, set[Share]] = defaultdict(set)
    for finding in findings:
        if not likeness.count(finding):
            continue
        key, source = pattern_id(finding, likeness), finding.source.robot
        leak = likeness.second.get(finding.leak.robot, finding.leak.robot)
        forms = finding.dismissed, finding.pseudonymised, finding.accepted
        shares[source].add(Share(key, False, *forms))
        shares[leak].add(Share(key, likeness.across(finding), *forms))
    return shares


def _deviant(robot: str, model: str, result: Result, usual: Result, likeness: Likeness) -> Deviant:
    return Deviant(
        likeness.members[robot],
        model,
        tuple(sorted(result[0] - usual[0])),
        tuple(sorted(usual[0] - result[0])),
        _in_order(result[1] - usual[1]),
        _in_order(usual[1] - result[1]),
    )


def _in_order(elements: Iterable[Element]) -> tuple[Element, ...]:
    return tuple(sorted(elements, key=lambda element: element.sort_key()))
