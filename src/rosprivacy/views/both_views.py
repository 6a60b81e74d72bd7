"""A system under both views (rule S6): the declared answer of record, and what the enforced view adds to it.

In: names of files and settings. Out: the declared ``Result``, with the findings that are there only because a node may
do what other profiles of its enclave may, the enclaves that make each possible, and what takes it away.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.findings.beyond import granted
from rosprivacy.analysis.fleet.likeness import pattern_id
from rosprivacy.analysis.model import NON_ROS
from rosprivacy.analysis.modes import View
from rosprivacy.answering import answer
from rosprivacy.ingest.policies.changed_policies import NO_CHANGE, Change
from rosprivacy.question import question_of
from rosprivacy.reading.robot_system import system_reader
from rosprivacy.report.answer import Enforced
from rosprivacy.views.remedies import Remedies
from rosprivacy.views.trials import Trials

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.model import Profile
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.question import Question
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings
    from rosprivacy.system import System

    Reader = Callable[[Change], System]


def both_views(policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings) -> Result:
    """Analyse policies under both views.

    Returns
    -------
    Result
        Of the declared view, with ``enforced``.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    return _both(settings, lambda question: system_reader(policies, labels, question))


def both_views_of_fleet(file: str, settings: Settings) -> Result:
    """Analyse a fleet under both views; the enforced one adds to a pattern where one of its robots did not have it.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    from rosprivacy.reading.fleet_system import fleet_reader  # noqa: PLC0415 - light start

    return _both(settings, lambda question: fleet_reader(file, question))


def _both(settings: Settings, reader: Callable[[Question], Reader]) -> Result:
    of_record = question_of(replace(settings, view=View.declared.value))
    question = question_of(replace(settings, view=View.enforced.value))._replace(every=True)
    declared, enforced = reader(of_record), reader(question)
    system = declared(NO_CHANGE)
    result = answer(system, of_record)
    every = answer(system, of_record._replace(every=True)) if system.is_fleet else result
    known = {finding.id: finding.pseudonymised for finding in every.analysis.findings if not finding.dismissed}
    whole = enforced(NO_CHANGE)
    found = answer(whole, question)
    remedies = Remedies(
        Trials(whole, found, enforced, question),
        declared,
        granted(system.graph),
        _enclaves(whole.graph.profiles),
        whole.likeness.second,
        {one for one, pseudonymised in known.items() if pseudonymised},
    )
    new = (one for one in found.analysis.findings if not one.dismissed and _is_new(one, known))  # accepted ones, too
    added = tuple(_added(new, remedies, whole.likeness))
    more = {shown for shown, _ in _open(found) - _open(every) if shown[0] not in whole.likeness.second}
    elements = {one.element.shown_as: one.element for one in found.analysis.open}
    outside_first = sorted((elements[shown] for shown in more), key=lambda e: (e.kind not in NON_ROS, e.sort_key()))
    return replace(result, enforced=Enforced(found, added, tuple(outside_first)))


def _is_new(finding: Finding, known: Mapping[str, bool]) -> bool:
    """Whether the declared view has it not, or only in pseudonymised form while plain data is in it now (rule S10)."""
    return finding.id not in known or (known[finding.id] and not finding.pseudonymised)


def _open(result: Result) -> set[tuple[tuple[str, str, str, str], str]]:
    """The open questions: what a reader sees of an element, and a category."""
    return {(one.element.shown_as, category) for one in result.analysis.open for category in one.categories}


def _added(findings: Iterable[Finding], remedies: Remedies, likeness: Likeness) -> Iterator[Added]:
    """Findings that differ only in the robot are told once, with the robots where they are added."""
    alike: dict[tuple[str, bool], list[Finding]] = {}
    for finding in findings:
        if likeness.count(finding) or not likeness.members:
            alike.setdefault((pattern_id(finding, likeness), finding.id in remedies.hidden), []).append(finding)
    for some in alike.values():
        robots = {name for one in some for name in likeness.placed(one.source.robot) or likeness.placed(one.leak.robot)}
        yield remedies.of(some, tuple(sorted(robots)))


def _enclaves(profiles: Iterable[Profile]) -> Mapping[str, frozenset[str]]:
    nodes: dict[str, set[str]] = {}
    for profile in profiles:
        nodes.setdefault(profile.enclave, set()).add(profile.node)
    return {enclave: frozenset(inside) for enclave, inside in nodes.items()}
