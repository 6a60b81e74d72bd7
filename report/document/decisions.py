"""What people decided, and what the enforced view adds (rule S6): findings of both views with their decisions.

In: entries and decisions joined to their findings; ``EnforcedFacts``. Out: entries with ``decision`` on findings and
``decisions``; an ``EnforcedEntry``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from rosprivacy.analysis.model import Element
from rosprivacy.report.document.records import element_dict, finding_entry, place_entries

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.decisions import Decided, Decision, State
    from rosprivacy.analysis.findings.beyond import Added, DenyLine, Right
    from rosprivacy.report.document.contents import EnforcedFacts
    from rosprivacy.report.schemas.analysis import AddedEntry, AnalysisDocument, DenyEntry, EnforcedEntry, LostEntry
    from rosprivacy.report.schemas.records import ChangedSince, DecisionEntry, FindingEntry, ListedDecision, Target


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
        {"what": change.aspect, "before": change.before, "now": change.now} for change in decided.changed.get(entry, ())
    ]
    decision: DecisionEntry = {
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
    return {**decision, "changed": changed} if changed else decision


def _target(entry: Decision) -> Target:
    """What an entry says that it is about."""
    keys = ("id", "category", "source", "leak", "robot", "from_robot", "kind")
    target = cast("Target", {key: getattr(entry, key) for key in keys if getattr(entry, key)})
    if entry.robots:
        target["robots"] = list(entry.robots)
    if entry.from_robots:
        target["from_robots"] = list(entry.from_robots)
    if entry.pseudonymised is not None:
        target["pseudonymised"] = entry.pseudonymised
    return target


def enforced_document(enforced: EnforcedFacts) -> EnforcedEntry:
    """Return what the enforced view adds."""
    findings = [finding_entry(added.finding, enforced.contexts) for added in enforced.added]
    if enforced.decided:
        findings = decided_findings(findings, enforced.decided)
    return {
        "verdict": str(enforced.analysis.verdict),
        "unreviewed": len(enforced.open),
        "open": [element_dict(element) for element in enforced.open],
        "added": [_added(added, finding) for added, finding in zip(enforced.added, findings, strict=True)],
    }


def _added(added: Added, finding: FindingEntry) -> AddedEntry:
    entry: AddedEntry = {
        "finding": finding,
        "beyond": list(added.beyond),
        "enclaves": list(added.enclaves),
        "split": list(added.split),
        "move": {"enclave": added.move[0], "profile": added.move[1]} if added.move else None,
        "deny": [_deny(line) for line in added.deny],
        "loses": [_lost(right) for right in added.loses],
    }
    if added.robots:
        entry["robots"] = list(added.robots)
    if added.plain:
        entry["plain"] = True
    if added.opened:
        entry["opened_by"] = place_entries(added.opened)
    return entry


def _deny(line: DenyLine) -> DenyEntry:
    return {
        "file": line.policy,
        "enclave": line.enclave,
        "profile": line.node,
        "role": line.role,
        "channel": element_dict(Element(line.kind, line.name)),
    }


def _lost(right: Right) -> LostEntry:
    (robot, kind, name), role, channel = right
    return {
        "node": element_dict(Element(kind, name, robot)),
        "role": role,
        "channel": element_dict(Element(channel[1], channel[2], channel[0])),
    }
