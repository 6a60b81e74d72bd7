"""What a person decides about a finding or a row of a session, into the decisions file that the session began with.

In: a finding as it is found now, of a fleet with robots, or a row of the register, and an entry. Out: the file with it.
What others wrote meanwhile stays: the file is read anew each time, and one writer works at a time. Nothing is written
unless the file then says of these robots, or of all that ends in the row, what was decided, and the answer can be made
of it. On a fleet a decision is about exactly the robots that are named, whoever joins later (rule S10).
"""

from __future__ import annotations

import os
from collections import defaultdict
from dataclasses import replace
from datetime import date
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.decisions import Choice, State
from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS, pattern_id
from rosprivacy.analysis.fleet.robots_of_rows import row_pattern
from rosprivacy.analysis.remembered import as_written
from rosprivacy.clock import judged_on, today
from rosprivacy.decided import about_today, in_fleet
from rosprivacy.decision_record import parse_recorded, provenance, subject, with_recorded
from rosprivacy.ingest.decisions.decision_log import is_log
from rosprivacy.ingest.decisions.decision_writer import text_in
from rosprivacy.ingest.decisions.decisions_file import LISTS, REQUIRED, is_date
from rosprivacy.report.atomic import editing, write_texts
from rosprivacy.row_decision import made_about_row, row_target

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.decisions import Decision, Decisions
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.result import Result

    RobotNames = Collection[str] | None  # robots, by id; None for all that are alike

CHANGE_IT = "change or remove that entry, and begin again"
ENDS = 2  # robots of one kind that are enough to see what holds between any two


class Ruling(NamedTuple):
    """What is decided about a finding, and on whose word; what is empty is not said.

    Attributes
    ----------
    choice
        A ``Choice``.
    condition
        What has to be so before an acceptance counts.
    expires
        The last day on which it is valid, ``YYYY-MM-DD``.
    legal_basis
        Articles, such as ``6(1)(f)``.
    answers
        ``LegalQuestion`` of the row -> what a person answers.
    """

    choice: str
    reason: str = ""
    owner: str = ""
    expires: str = ""
    ticket: str = ""
    legal_basis: tuple[str, ...] = ()
    condition: str = ""
    answers: Mapping[str, str] = MappingProxyType({})


class How(TypedDict, total=False):
    """The words of a decision, as of ``Ruling``."""

    reason: str
    owner: str
    expires: str
    ticket: str
    legal_basis: tuple[str, ...]
    condition: str
    answers: Mapping[str, str]


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
        return self._replace(robots=tuple(robot for robot in (source, leak) if robot in self.robots)[:1])

    def narrowed(self, robots: RobotNames, to_robots: RobotNames) -> Scope | None:
        """Return the same for some of them, None for all; None if others are named, or none."""
        ends = []
        for named, known in ((robots, self.robots), (to_robots, self.to_robots)):
            if named is not None and (not named or not set(named) <= set(known)):
                return None
            ends.append(known if named is None else tuple(robot for robot in known if robot in named))
        return self._replace(robots=ends[0], to_robots=ends[1])


def scopes(findings: Iterable[Finding], likeness: Likeness, finding: Finding) -> tuple[Scope, ...]:
    """Return what can be decided about at once: that finding with all that are alike, and each other of its pattern."""
    pattern = pattern_id(finding, likeness)
    like = [other for other in findings if (other.kind, other.category) == (finding.kind, finding.category)]
    same = [other for other in like if likeness.count(other) and pattern_id(other, likeness) == pattern]
    return tuple(_without_blanks(other, likeness) for other in sorted(same, key=lambda other: other.id != finding.id))


def _without_blanks(finding: Finding, likeness: Likeness) -> Scope:
    begins, ends = likeness.placed(finding.source.robot), likeness.placed(finding.leak.robot)
    return Scope(finding, begins, ends) if likeness.across(finding) else Scope(finding, begins or ends)


def record(
    file: str | None, result: Result, finding: str, ruling: Ruling, robots: tuple[RobotNames, RobotNames],
    judge: Callable[[Decisions], None],
) -> None:  # fmt: skip
    """Write a decision about a finding into the decisions file, which is made if it is not there.

    Parameters
    ----------
    robots
        Of a fleet, those that are named, and those that data gets to.
    judge
        Makes the answer under what the file will say, before it is written.
    """
    file = _checked(file, ruling)
    about = next((each for each in result.analysis.findings if each.id == finding), None)
    if about is None:
        raise _refused(file, f"{shown(finding)!r} is no finding", "take the id of one that is found now")
    likeness = result.fleet.likeness if result.fleet else NO_ROBOTS
    scope = _scope_of(scopes(result.analysis.findings, likeness, about), file, *robots)
    entry = {**_target(scope, likeness), **_entry(ruling), "made_about": _made_about(result, scope.finding)}
    remark = f"{about.category}: {about.source.name} -> {about.leak.name}"  # what a person reads beside an id

    def check(decisions: Decisions) -> None:
        _check_meaning(decisions, _cases(scope, likeness, decisions.told_apart), entry)
        judge(decisions)

    _write(file, result, entry, remark, lambda: _subject(result, scope.finding), check)


def record_row(
    file: str | None, result: Result, row: str, ruling: Ruling, robots: Collection[str],
    judge: Callable[[Decisions], None],
) -> None:  # fmt: skip
    """Write a decision about a row of the register: about the findings that end there now.

    Parameters
    ----------
    robots
        Of a fleet: some of the robots of the row; none for all of them.
    judge
        As of ``record``.
    """
    file = _checked(file, ruling)
    document = result.document()
    of_row = next((each for each in document["register"] if each["id"] == row and each["findings"]), None)
    if of_row is None:
        raise _refused(file, f"{shown(row)!r} is no row in which a finding ends", "take the id of one that there is")
    entry = {
        **row_target(document, of_row, robots), **_entry(ruling), **made_about_row(document, of_row, robots)
    }  # fmt: skip

    def check(decisions: Decisions) -> None:
        _check_meaning(decisions, _cases_in_row(result, of_row, entry, decisions.told_apart), entry)
        judge(decisions)

    _write(file, result, entry, "", lambda: subject(document, row=of_row), check)


def _cases_in_row(
    result: Result, row: Mapping[str, Any], entry: Mapping[str, Any], kind_of: Callable[[str], object]
) -> Iterator[Case]:
    """What an entry about a row is about: the findings that end there, of a fleet on the robots that it names."""
    if result.fleet is None:
        yield from (Case.of(finding) for finding in result.analysis.findings if finding.id in row["findings"])
        return
    likeness = result.fleet.likeness
    for finding in result.analysis.findings:
        if likeness.count(finding) and row_pattern(finding.category, finding.leak, likeness) == entry["row"]:
            whole = _without_blanks(finding, likeness)
            ends = whole.to_robots or whole.robots
            here = tuple(robot for robot in ends if robot in entry.get("robots", row["fleet"]["robots"]))
            scope = whole._replace(to_robots=here) if whole.to_robots else whole._replace(robots=here)
            if here or not (ends or "robots" in entry):
                yield from _cases(scope, likeness, kind_of)


def _write(
    file: str, result: Result, entry: Mapping[str, Any], remark: str, about: Callable[[], Mapping[str, str]],
    check: Callable[[Decisions], None],
) -> None:  # fmt: skip
    """Write an entry, if the file then says what it should."""
    path = Path(file)
    with one_run(), editing(path):
        facts = provenance(path.parent, about()) if is_log(file) else {}
        text = with_recorded(file, text_in(path), entry, remark, result.vocabulary, facts=facts)
        check(parse_recorded(file, text, result.vocabulary, judged_on(os.environ)))
        write_texts([(path, text)], edited=path)


def _checked(file: str | None, ruling: Ruling) -> str:
    """The decisions file, where there is one, and the decision can be one."""
    if file is None:
        raise _refused("", "there is no decisions file", "name one when the session begins")
    if ruling.expires and not is_date(ruling.expires):
        raise _refused(file, f"{shown(ruling.expires)!r} is not a date", "write YYYY-MM-DD")
    if ruling.expires and ruling.expires < today(os.environ):
        raise _refused(file, f"{ruling.expires} is over: it would decide nothing", "name a day to come")
    for name in REQUIRED.get(ruling.choice, ()):
        if not getattr(ruling, name):
            raise _refused(file, f"an acceptance without {name}", f"say the {name}: it is what a person signs")
    return file


def _scope_of(scopes: Sequence[Scope], file: str, robots: RobotNames, to_robots: RobotNames) -> Scope:
    """The scope that a person names; the first if no robots are named. Robots that are named have to be alike."""
    fitting = [narrowed for scope in scopes if (narrowed := scope.narrowed(robots, to_robots))]
    if len(fitting) == 1 or (fitting and fitting[0].finding is scopes[0].finding):
        return fitting[0]
    named = ", ".join(map(shown, (*(robots or ()), *(to_robots or ())))) or "no robot"
    if fitting:
        raise _refused(file, f"of {named} data gets to several kinds of robots", "name those that it gets to, too")
    raise _refused(file, f"it is not on {named}, or they are not alike", "decide about robots that are alike at a time")


def _target(scope: Scope, likeness: Likeness) -> dict[str, Any]:
    """What an entry says that it is about: the pattern, and each robot by its name."""
    entry: dict[str, Any] = {"id": pattern_id(scope.finding, likeness)}
    if scope.robots:
        entry["robots"] = list(scope.to_robots or scope.robots)
    if scope.to_robots:
        entry["from_robots"] = list(scope.robots)
    return {**entry, "pseudonymised": True} if scope.finding.pseudonymised else entry


def _entry(ruling: Ruling) -> dict[str, Any]:
    """As the file has it, in its order."""
    entry = {
        "decision": ruling.choice,
        "reason": ruling.reason,
        "answers": dict(ruling.answers),
        "condition": ruling.condition,
        "owner": ruling.owner,
        "legal_basis": list(ruling.legal_basis),
        "date": date.fromisoformat(today(os.environ)),
        "expires": date.fromisoformat(ruling.expires) if ruling.expires else None,
        "ticket": ruling.ticket,
    }
    return {key: value for key, value in entry.items() if value}


def _made_about(result: Result, finding: Finding) -> Mapping[str, object]:
    """What is so now; of a fleet without the number of paths, which changes with the robots that are alike."""
    about = about_today(result.analysis, None)[finding.id]
    return as_written(replace(about, disjoint_paths=0) if result.fleet else about)


def _subject(result: Result, finding: Finding) -> Mapping[str, str]:
    """What a log keeps of a finding; one that the document of a fleet shows on another robot is known by its id."""
    document = result.document()
    row = next((row for row in document["findings"] if row["id"] == finding.id), {"id": finding.id})
    return subject(document, finding=row)


def _check_meaning(decisions: Decisions, cases: Iterable[Case], entry: Mapping[str, Any]) -> None:
    """See that the entry decides what it was made about: none of the same sort decides it, too, and it is not over.

    An acceptance counts only where what names the row, and what names the finding, both accept.
    """
    for case in cases:
        foremost = decisions.foremost(case)
        if not foremost:
            raise _refused(decisions.file, "the entry would not be about it", CHANGE_IT)
        own = next((some for some in foremost if any(_is_written(each, entry) for each in some)), foremost[0])
        other = next((each for each in own if not _is_written(each, entry)), None)
        if not other and own[0].choice is Choice.ACCEPT:
            beside = (each for some in foremost if some is not own for each in some)
            other = next((each for each in beside if not decisions.lets_stay(each)), None)
        if other:
            raise _refused(decisions.file, f"line {other.place.line} decides it, too", CHANGE_IT)
        if decisions.state(own[0]) is State.EXPIRED:
            over = f"{own[0].expires} is over: it would decide nothing"
            raise _refused(decisions.file, over, "name a day to come")


def _is_written(decision: Decision, entry: Mapping[str, Any]) -> bool:
    names = decision.id == entry.get("id", "") and decision.row == entry.get("row", "")
    lists = ((set(getattr(decision, key)), set(entry.get(key, ()))) for key in LISTS)
    return names and all(has == said for has, said in lists)


def _cases(scope: Scope, likeness: Likeness, kind_of: Callable[[str], object]) -> Iterator[Case]:
    """What a decision is about: one case for those robots that entries do not tell apart."""
    whole = in_fleet(Case.of(scope.finding), likeness)
    begins, ends = _of_each_kind(scope.robots, kind_of), _of_each_kind(scope.to_robots, kind_of)
    pairs = [(begin, end) for begin in begins for end in ends if begin != end]
    if not scope.to_robots:
        source, leak = whole.robots
        pairs = [(robot if source else "", robot if leak else "") for robot in begins] or [("", "")]
    for pair in pairs:
        source_end, leak_end = (
            replace(end, robot=robot) if robot else end
            for end, robot in zip((whole.source, whole.leak), pair, strict=True)
        )
        yield whole._replace(source=source_end, leak=leak_end, robots=pair)


def _of_each_kind(robots: Iterable[str], kind_of: Callable[[str], object]) -> list[str]:
    kinds: dict[object, list[str]] = defaultdict(list)
    for robot in robots:
        kinds[kind_of(robot)].append(robot)
    return [robot for kind in kinds.values() for robot in kind[:ENDS]]


def _refused(file: str, problem: str, hint: str) -> InputErrors:
    return InputErrors([DecisionError(file or "the session", 0, problem, hint)])
