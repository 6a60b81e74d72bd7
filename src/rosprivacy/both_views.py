"""Policies under both views (rule S6): the declared answer of record, and what the enforced view adds to it.

In: names of files and settings. Out: the declared ``Result``, and a document of the findings that are there only
because a node may do what other profiles of its enclave may; with the enclaves that make each possible, and which of
them have to be split to end it, proven by a new analysis.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.modes import View
from rosprivacy.answering import answer
from rosprivacy.question import question_of
from rosprivacy.report.document.enforced import enforced_document
from rosprivacy.report.document.whole import document
from rosprivacy.robot_system import system_reader

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

TRIED = 20  # sets of enclaves that are split, each an analysis of its own


def both_views(
    policies: tuple[str, ...], labels: tuple[str | Labels, ...], settings: Settings
) -> tuple[Result, Mapping[str, Any]]:
    """Analyse policies under both views.

    Returns
    -------
    Result
        Of the declared view.
    dict
        What the enforced view adds, as it stands in the JSON document.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    of_record = question_of(replace(settings, view=View.declared.value))
    declared = answer(system_reader(policies, labels, of_record)(()), of_record)
    question = question_of(replace(settings, view=View.enforced.value))
    read = system_reader(policies, labels, question)
    enforced = answer(read(()), question)
    known = {finding.id for finding in declared.analysis.findings if finding.stands}
    added = [finding for finding in enforced.analysis.findings if finding.stands and finding.id not in known]
    tried: dict[frozenset[str], Analysis] = {}

    def without(enclaves: frozenset[str]) -> Analysis | None:
        if enclaves not in tried:
            if len(tried) == TRIED:
                return None
            tried[enclaves] = answer(read(enclaves), question).analysis
        return tried[enclaves]

    told = {finding.id: (enclaves_of(finding), splitting(finding, without)) for finding in added}
    return declared, enforced_document(document(enforced), told)


def enclaves_of(finding: Finding) -> tuple[str, ...]:
    """Return the enclaves that let a node on the way do what only another profile of it may, sorted."""
    found = set()
    for step in finding.steps:
        node = step.source.name if step.source.is_node else step.target.name
        if step.grants and all(grant.node != node for grant in step.grants):
            found |= {grant.enclave for grant in step.grants}
    return tuple(sorted(found))


def splitting(finding: Finding, without: Callable[[frozenset[str]], Analysis | None]) -> tuple[str, ...]:
    """Return enclaves of which splitting ends a finding; empty if none was found.

    Parameters
    ----------
    without
        The analysis with some enclaves split; None where too many were tried.
    """
    enclaves = frozenset(enclaves_of(finding))
    while enclaves:
        analysis = without(enclaves)
        if analysis is None:
            return ()
        left = next((one for one in analysis.findings if one.id == finding.id and one.stands), None)
        if left is None:
            return tuple(sorted(enclaves))
        more = enclaves | set(enclaves_of(left))
        if more == enclaves:
            return ()
        enclaves = more
    return ()
