"""Findings of a fleet -> patterns: findings that differ only in the robot; and the robots that differ (rule S10).

In: findings of a graph in which one robot stands for those that are alike, or pairs of source and leak before any path
is looked for, and for how many each stands. Out: groups, which are patterns without a path; patterns with how many
findings and which robots each has; and deviants: robots whose result is not that of most of their model.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field, replace
from operator import add
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.fleet.likeness import pattern_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
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
RobotsByForm = tuple[tuple[Form, tuple[str, ...]], ...]


class Pair(NamedTuple):
    """What a finding is without its path."""

    kind: str
    category: str
    source: Element
    leak: Element
    plain_also: bool


@dataclass(frozen=True, slots=True)
class CountedPattern:
    """A pattern without a path: the pair that is shown of it, its id, what is counted, and the robots by form.

    Attributes
    ----------
    forms, end_forms
        As of ``Pattern``.
    """

    pair: Pair
    id: str
    count: Count
    robots: tuple[str, ...]
    across: bool
    forms: RobotsByForm = ()
    end_forms: RobotsByForm = ()


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
        forms, end_forms = self._forms(ends=False), self._forms(ends=True)
        return tuple(
            CountedPattern(
                tally.shown,
                key,
                tally.count,
                tuple(sorted(tally.robots)),
                self._likeness.apart(tally.shown.source, tally.shown.leak),
                _in_rows(forms[key]),
                _in_rows(end_forms[key]),
            )
            for key, tally in self._tallies.items()
        )

    def _forms(self, *, ends: bool) -> dict[str, dict[Form, set[str]]]:
        """Pattern -> the robots as of ``Share.ends``, each under the form that stands most."""
        least: dict[str, dict[str, Form]] = defaultdict(dict)
        for name, shares in self.shares.items():
            for share in shares:
                form = Form(share.dismissed, share.accepted, share.pseudonymised)
                for robot in self._likeness.placed(name) if share.ends is ends else ():
                    least[share.pattern][robot] = min(form, least[share.pattern].get(robot, form))
        forms: dict[str, dict[Form, set[str]]] = defaultdict(lambda: defaultdict(set))
        for pattern, robots in least.items():
            for robot, form in robots.items():
                forms[pattern][form].add(robot)
        return forms


def _in_rows(forms: Mapping[Form, Collection[str]]) -> RobotsByForm:
    return tuple((form, tuple(sorted(robots))) for form, robots in sorted(forms.items()))


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
    end_forms
        Where data gets from one robot to another: the same of the robots that it gets to.
    """

    id: str
    finding: Finding
    count: int
    robots: tuple[str, ...]
    across: bool
    dismissed: int
    pseudonymised: int
    accepted: int = 0
    forms: RobotsByForm = ()
    end_forms: RobotsByForm = ()


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
            group.end_forms,
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
