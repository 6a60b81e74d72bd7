"""What stands in several parts of the documents: elements, lines of files, findings, doubts.

In: facts of the analysis. Out: the entries that the contract has for them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.legal import turned_special
from rosprivacy.analysis.model import GDPR_APPLIES

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Finding, Step
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.model import Doubt, Element, Grant, Legal, Place
    from rosprivacy.report.schemas.records import (
        DoubtEntry,
        ElementEntry,
        FindingEntry,
        FindingMore,
        GrantEntry,
        LawEntry,
        PlaceEntry,
        StepEntry,
    )


def element_dict(element: Element) -> ElementEntry:
    """Return E of the contract.

    >>> from rosprivacy.analysis.model import Element
    >>> element_dict(Element("service", "/add", leg="request"))
    {'robot': '', 'kind': 'service', 'name': '/add', 'leg': 'request'}
    """
    shown: ElementEntry = {"robot": element.robot, "kind": element.kind, "name": element.name}
    if element.leg:
        shown["leg"] = element.leg
    if element.pattern:
        shown["pattern"] = True
    return shown


def element_or_none(element: Element | None) -> ElementEntry | None:
    """Return an element, where there is one."""
    return element_dict(element) if element else None


def place_entries(places: Iterable[Place]) -> list[PlaceEntry]:
    """Return lines of files."""
    return [{"file": place.file, "line": place.line} for place in places]


def grant_entry(grant: Grant) -> GrantEntry:
    """Return a line that allows or denies something."""
    line: GrantEntry = {
        "file": grant.place.file,
        "line": grant.place.line,
        "enclave": grant.enclave,
        "profile": grant.node,
    }
    if grant.observation:
        line["seen"] = {
            "by": list(grant.observation.by),
            "first": grant.observation.first,
            "last": grant.observation.last,
        }
    if grant.basis:
        line["basis"] = grant.basis
    return line


def finding_entry(finding: Finding, contexts: Contexts) -> FindingEntry:
    """Return a finding; its data became a special category at ``special_from``, where that was none before."""
    categories = contexts.categories
    category, turned = categories[finding.category], turned_special(finding, categories)
    reason: FindingMore = {}
    if finding.why:
        reason = {"reason": finding.reason, "because": {"key": finding.why.key, "values": dict(finding.why.values)}}
    applies = contexts.scope(finding)
    scope: FindingMore = {} if applies == GDPR_APPLIES else {"gdpr": applies}
    plain: FindingMore = {"beside_pseudonymised": True} if finding.plain_also else {}
    shown: FindingEntry = {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "pseudonymised": finding.pseudonymised,
        "source": element_dict(finding.source),
        "leak": element_dict(finding.leak),
        "witness": [element_dict(element) for element in finding.witness],
        "steps": [_step(step) for step in finding.steps],
        "disjoint_paths": finding.number_of_paths,
        "through": [element_dict(element) for element in finding.through],
        "dismissed": finding.dismissed,
        "article9": contexts.article9(finding),
        "special_from": element_or_none(turned),
        "law": _law(category.law),
        "in_context": [
            {"context": legal.context, **entry} for legal in contexts.revealed(finding) for entry in _law((legal,))
        ],
        **scope,
        **reason,
        "accepted": finding.accepted,
        **plain,
    }
    if finding.paths:
        shown["paths"] = [[element_dict(element) for element in path] for path in finding.paths]
        shown["paths_bounded"] = finding.bounded
    return shown


def _law(law: Iterable[Legal]) -> list[LawEntry]:
    """Return what a person has to look up about a finding's data: no verdict on the system."""
    return [{"provision": legal.name, "verdict": legal.verdict, "condition": legal.condition} for legal in law]


def _step(step: Step) -> StepEntry:
    return {
        "role": step.role,
        "category": step.category,
        "pseudonymised": step.pseudonymised,
        "policy": [grant_entry(grant) for grant in step.grants],
    }


def doubt_entry(doubt: Doubt) -> DoubtEntry:
    """Return a row of ``doubts``."""
    row: DoubtEntry = {
        "id": doubt.id,
        "doubt": doubt.name,
        "rank": str(doubt.rank),
        "element": element_or_none(doubt.element),
        "categories": list(doubt.categories),
        "count": doubt.count,
        "file": doubt.place.file,
        "line": doubt.place.line,
        "message": doubt.message,
        "accepted": None,
    }
    if doubt.accepted:
        by = doubt.accepted
        row["accepted"] = {
            "reason": by.reason,
            "owner": by.owner,
            "expires": by.expires,
            "ticket": by.ticket,
            "file": by.place.file,
            "line": by.place.line,
        }
    return row
