"""What a person decides about a finding of a session, into the decisions file that the session was begun with.

In: a finding as it is found now, of a fleet with robots, and an entry. Out: the file with it. What others wrote
meanwhile stays: the file is read anew each time, and one writer works at a time. Nothing is written unless the file
then says of these robots what was decided, and the answer can be made of it.
"""

from __future__ import annotations

import os
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

from rosprivacy.analysis.decisions import State
from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.analysis.fleet.likeness import NO_ROBOTS
from rosprivacy.analysis.remembered import as_written
from rosprivacy.clock import judged_on, today
from rosprivacy.decided import about_today
from rosprivacy.explorer.decision_scope import cases, scope_of, scopes, target
from rosprivacy.ingest.decisions.decision_writer import text_in, with_decision
from rosprivacy.ingest.decisions.decisions_file import is_date, parse_decisions
from rosprivacy.report.atomic import write_texts
from rosprivacy.report.editing import editing

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.remembered import About
    from rosprivacy.explorer.decision_scope import Scope
    from rosprivacy.result import Result

LEAST = {"accept": ("reason", "owner")}  # what a person signs


class Ruling(NamedTuple):
    """What is decided about a finding, and on whose word; what is empty is not said.

    Attributes
    ----------
    choice
        ``accept``, ``mitigate``, ``delegate`` or ``avoid``.
    expires
        The last day on which it is valid, ``YYYY-MM-DD``.
    legal_basis
        Articles, such as ``6(1)(f)``.
    """

    choice: str
    reason: str = ""
    owner: str = ""
    expires: str = ""
    ticket: str = ""
    legal_basis: tuple[str, ...] = ()


class How(TypedDict, total=False):
    """The words of a decision, as of ``Ruling``."""

    reason: str
    owner: str
    expires: str
    ticket: str
    legal_basis: tuple[str, ...]


class Robots(NamedTuple):
    """The robots of a fleet that a decision names; None for all that are alike, as of ``Session.decide``."""

    robots: Collection[str] | None = None
    to_robots: Collection[str] | None = None


def record(
    file: str | None, result: Result, finding: str, said: Ruling, robots: Robots, judge: Callable[[Decisions], None]
) -> None:
    """Write a decision about a finding into the decisions file, which is made if it is not there.

    Parameters
    ----------
    judge
        Makes the answer under what the file will say, before it is written.

    Raises
    ------
    InputErrors
        If there is no file or no such finding, or the decision is none; nothing is written then.
    InputError
        If the file cannot be written; then it is as it was.
    """
    if file is None:
        raise _refused("", "there is no decisions file", "name one when the session begins")
    found = next((one for one in result.analysis.findings if one.id == finding), None)
    if found is None:
        raise _refused(file, f"{shown(finding)!r} is no finding", "take the id of one that is found now")
    _check(file, said)
    likeness = result.fleet.likeness if result.fleet else NO_ROBOTS
    scope = scope_of(scopes(result.analysis.findings, likeness, found), file, *robots)
    entry = {**target(scope, likeness), **_entry(said), "made_about": as_written(_about(result, scope.finding))}
    path = Path(file)
    with one_run(), editing(path):
        text = with_decision(file, text_in(path), entry, _remark(found), result.vocabulary)
        decisions = parse_decisions(file, text, result.vocabulary, judged_on(os.environ))
        _check_meaning(decisions, scope, likeness, entry)
        judge(decisions)
        write_texts([(path, text)], edited=path)


def _about(result: Result, finding: Finding) -> About:
    """What is there now; of a fleet without the number of paths, which changes with the robots that are alike."""
    about = about_today(result.analysis, None)[finding.id]
    return replace(about, disjoint_paths=0) if result.fleet else about


def _check_meaning(decisions: Decisions, scope: Scope, likeness: Likeness, entry: Mapping[str, Any]) -> None:
    """See that the entry decides what it was made about: no other decides it, too, and it is not over."""
    of = entry["id"], set(entry.get("robots", ())), set(entry.get("from_robots", ()))
    for case in cases(scope, likeness, decisions.told_apart):
        foremost = decisions.foremost(case)
        other = next((one for one in foremost if (one.id, set(one.robots), set(one.from_robots)) != of), None)
        if other or not foremost:
            where = f"line {other.place.line} decides it, too" if other else "the entry would not be about it"
            raise _refused(decisions.file, where, "change or remove that entry, and begin again")
        if decisions.state(foremost[0]) is State.EXPIRED:
            over = f"{foremost[0].expires} is over: it would decide nothing"
            raise _refused(decisions.file, over, "name a day to come")


def _check(file: str, said: Ruling) -> None:
    if said.expires and not is_date(said.expires):
        raise _refused(file, f"{shown(said.expires)!r} is not a date", "write YYYY-MM-DD")
    if said.expires and said.expires < today(os.environ):
        raise _refused(file, f"{said.expires} is over: it would decide nothing", "name a day to come")
    for name in LEAST.get(said.choice, ()):
        if not getattr(said, name):
            raise _refused(file, f"an acceptance without {name}", f"say the {name}: it is what a person signs")


def _entry(said: Ruling) -> dict[str, Any]:
    """As the file has it, in its order."""
    entry = {
        "decision": said.choice,
        "reason": said.reason,
        "owner": said.owner,
        "legal_basis": list(said.legal_basis),
        "date": date.fromisoformat(today(os.environ)),
        "expires": date.fromisoformat(said.expires) if said.expires else None,
        "ticket": said.ticket,
    }
    return {key: value for key, value in entry.items() if value}


def _remark(finding: Finding) -> str:
    """What a person reads beside an id."""
    return f"{finding.category}: {finding.source.name} -> {finding.leak.name}"


def _refused(file: str, problem: str, hint: str) -> InputErrors:
    return InputErrors([DecisionError(file or "the session", 0, problem, hint)])
