"""What the enforced view adds to the declared one, in the JSON document (rule S6).

In: ``Enforced``. Out: an ``EnforcedEntry``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Element
from rosprivacy.report.document.analysis import finding_entry
from rosprivacy.report.document.decisions import decided_findings
from rosprivacy.report.document.element_entry import element_dict

if TYPE_CHECKING:
    from rosprivacy.analysis.findings.beyond import Added, DenyLine, Right
    from rosprivacy.report.answer import Enforced
    from rosprivacy.report.contract.analysis import AddedEntry, DenyEntry, EnforcedEntry, LostEntry
    from rosprivacy.report.contract.records import FindingEntry


def enforced_document(enforced: Enforced) -> EnforcedEntry:
    """Return what the enforced view adds."""
    answer = enforced.answer
    findings = [finding_entry(one.finding, answer.contexts) for one in enforced.added]
    if answer.decided:
        findings = decided_findings(findings, answer.decided)
    return {
        "verdict": str(answer.analysis.verdict),
        "unreviewed": len(enforced.open),
        "open": [element_dict(element) for element in enforced.open],
        "added": [_added(one, finding) for one, finding in zip(enforced.added, findings, strict=True)],
    }


def _added(one: Added, finding: FindingEntry) -> AddedEntry:
    entry: AddedEntry = {
        "finding": finding,
        "beyond": list(one.beyond),
        "enclaves": list(one.enclaves),
        "split": list(one.split),
        "move": {"enclave": one.move[0], "profile": one.move[1]} if one.move else None,
        "deny": [_deny(line) for line in one.deny],
        "loses": [_lost(right) for right in one.loses],
    }
    if one.robots:
        entry["robots"] = list(one.robots)
    if one.plain:
        entry["plain"] = True
    if one.opened:
        entry["opened_by"] = [{"file": place.file, "line": place.line} for place in one.opened]
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
