"""Decisions in what readers get: added to the JSON document.

In: a document and decisions joined to its findings. Out: the document with ``decision`` on findings and ``decisions``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.decisions import Decided, Decision, State
    from rosprivacy.report.contract.analysis import AnalysisDocument
    from rosprivacy.report.contract.records import ChangedSince, DecisionEntry, FindingEntry, ListedDecision, Target


def with_decisions(document: AnalysisDocument, decided: Decided) -> AnalysisDocument:
    """Return a document with what was decided about its findings."""
    decisions = decided.decisions
    findings = decided_findings(document["findings"], decided)
    entries: list[ListedDecision] = [
        {**_decision(entry, state, decided), "target": _target(entry), "findings": list(about)}
        for entry, about, state in zip(decisions.entries, decided.about, decided.states, strict=True)
    ]
    return {**document, "findings": findings, "decisions": entries}


def decided_findings(findings: Iterable[FindingEntry], decided: Decided) -> list[FindingEntry]:
    """Return findings with what was decided about each."""
    on = {key: _decision(entry, decided.decisions.state(entry), decided) for key, entry in decided.on.items()}
    return [{**finding, "decision": on.get(finding["id"])} for finding in findings]


def _decision(entry: Decision, state: State, decided: Decided) -> DecisionEntry:
    changed: list[ChangedSince] = [
        {"what": change.what, "before": change.before, "now": change.now} for change in decided.changed.get(entry, ())
    ]
    told: DecisionEntry = {
        "choice": str(entry.choice),
        "state": str(state),
        "reason": entry.reason,
        "owner": entry.owner,
        "legal_basis": list(entry.legal_basis),
        "date": entry.date or None,
        "expires": entry.expires or None,
        "ticket": entry.ticket or None,
        "file": entry.place.file,
        "line": entry.place.line,
    }
    return {**told, "changed": changed} if changed else told


def _target(entry: Decision) -> Target:
    """What an entry says that it is about."""
    keys = ("id", "category", "source", "leak", "robot", "from_robot", "kind")
    said = cast("Target", {key: getattr(entry, key) for key in keys if getattr(entry, key)})
    if entry.robots:
        said["robots"] = list(entry.robots)
    if entry.from_robots:
        said["from_robots"] = list(entry.from_robots)
    if entry.pseudonymised is not None:
        said["pseudonymised"] = entry.pseudonymised
    return said
