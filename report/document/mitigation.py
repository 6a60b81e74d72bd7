"""Proposals -> the JSON document ``rosprivacy.mitigation/1``.

In: proposals and the analysis document that they start from. Out: plain dicts and lists, sorted, with no time in them
(rule S14).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import DISCLOSURE
from rosprivacy.report.document.analysis import label_key
from rosprivacy.report.document.records import element_dict

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.mitigation.affected import Affected, Shown
    from rosprivacy.analysis.mitigation.channel_settings import LeftOut
    from rosprivacy.analysis.mitigation.limits import Limits
    from rosprivacy.analysis.mitigation.proposals import Proposal, ProposedStep, Protect
    from rosprivacy.analysis.model import Element, Grant
    from rosprivacy.report.schemas.analysis import AnalysisDocument
    from rosprivacy.report.schemas.mitigation import (
        AffectedEntry,
        ChangedGrant,
        LeftOutEntry,
        MarkedElement,
        Marks,
        MitigationDocument,
        NamedElement,
        ProposalEntry,
        ProposedStepEntry,
        ProtectEntry,
        StatementEntry,
    )

FORMAT = "rosprivacy.mitigation/1"


def mitigation_document(
    report: AnalysisDocument,
    analysis: Analysis,
    limits: Limits,
    proposals: Iterable[Proposal],
    patch: str,
    why_no_patch: str,
    unmatched: Iterable[str],
    notes: Iterable[str] = (),
    settings: Sequence[Sequence[LeftOut]] = (),
) -> MitigationDocument:
    """Return the proposals as one JSON object.

    Parameters
    ----------
    report
        The document of the analysis that they start from.
    unmatched
        Labels that name nothing any more once the patch is applied.
    settings
        By proposal, of bridges and recorders; none where there are none.
    """
    proposals = list(proposals)
    weights = limits.weights
    critical = {analysis.graph.elements[vertex] for vertex in limits.critical}
    return {
        "format": FORMAT,
        "verdict": report["verdict"],
        "doubts": report["doubts"],
        "view": report["view"],
        "proposals": [
            _proposal(proposal, rows, critical)
            for proposal, rows in zip(proposals, settings or [()] * len(proposals), strict=True)
        ],
        "patch": patch,
        "why_no_patch": why_no_patch,
        "labels_without_element": list(unmatched),
        "notes": list(notes),
        "diagnostics": report["diagnostics"],
        "assumptions": {
            **report["assumptions"],
            "kinds_of_change": sorted(limits.kinds),
            "weights": {
                "review": weights.review,
                "filter": weights.filter,
                "node": weights.node,
                "deny": weights.deny,
            },
            "time_critical": [element_dict(e) for e in sorted(critical, key=lambda e: e.sort_key())],
        },
    }


def _proposal(proposal: Proposal, settings: Iterable[LeftOut], critical: set[Element]) -> ProposalEntry:
    leaks = {finding.leak for finding in proposal.removed}

    def element(shown: Element) -> MarkedElement:
        leak: Marks = {"leak": True} if shown in leaks else {}
        time_critical: Marks = {"time_critical": True} if shown in critical else {}
        return {**element_dict(shown), **leak, **time_critical}

    return {
        "categories": list(proposal.categories),
        "removes": [finding.id for finding in proposal.removed],
        "keeps": [
            {
                "finding": kept.finding.id,
                "kind": kept.finding.kind,
                "category": kept.finding.category,
                "reason": kept.reason,
                "way": [element_dict(one) for one in kept.path],
            }
            for kept in proposal.remaining
        ],
        "settings": [_left_out(row, element) for row in settings],
        "steps": [_step(step, element) for step in proposal.steps],
        "statements": [_statement(f) for f in _findings(proposal) if f.kind != DISCLOSURE],
        "protect": [_protect(one) for one in proposal.protect],
        "cost": proposal.cost,
        "no_cheaper_than": proposal.lower,
        "cheapest": bool(proposal.steps) and proposal.cost == proposal.lower,
        "proven": proposal.proven,
        "verdict_then": str(proposal.verdict),
        "affected": [_affected(less, element) for less in proposal.affected],
    }


def _left_out(row: LeftOut, element: Callable[[Element], MarkedElement]) -> LeftOutEntry:
    """What a person would write so that a program leaves channels out."""
    program = row.recognised.program
    return {
        "node": element(row.element),
        "program": program.kind,
        "package": program.package,
        "confidence": str(row.recognised.confidence),
        "agrees": row.recognised.agrees,
        "channels": [element_dict(channel) for channel in row.channels],
        "write": [
            {
                "channels": one.setting.channels,
                "in": one.setting.where,
                "do": one.setting.action,
                "text": one.text,
                "note": one.setting.note,
            }
            for one in row.settings
        ],
        "sources": [
            {"at": source.at, "commit": source.commit, "files": list(source.files), "read": source.read}
            for source in program.sources
        ],
    }


def _findings(proposal: Proposal) -> tuple[Finding, ...]:
    return (*proposal.removed, *(kept.finding for kept in proposal.remaining))


def _statement(finding: Finding) -> StatementEntry:
    """What a person could state or arrange at the end of a path, so that no flow has to change (rule S10)."""
    return {
        "finding": finding.id,
        "kind": finding.kind,
        "element": element_dict(finding.leak),
        "category": finding.category,
        "reason": finding.reason,
    }


def _protect(line: Protect) -> ProtectEntry:
    """A line of a governance to change; the legs of a service are told apart."""
    cause, place = line.exposure
    return {
        "file": place.file,
        "line": place.line,
        "cause": cause,
        "channels": [element_dict(channel) for channel in line.channels],
        "findings": [finding.id for finding in line.findings],
    }


def _step(step: ProposedStep, element: Callable[[Element], MarkedElement]) -> ProposedStepEntry:
    return {
        "kind": step.kind,
        "cost": step.cost,
        "categories": list(step.categories),
        "between": [{"from": element(source), "to": element(target)} for source, target in step.between],
        "channel": element(step.channel) if step.channel else None,
        "label": _label(step),
        "policy": [_grant(grant) for grant in step.grants],
        "reaches": [element(one) for one in step.readers],
        "spares": [element(one) for one in step.spared],
    }


def _label(step: ProposedStep) -> dict[str, Any] | None:
    """The label that a review ends in, if the channel carries none."""
    if step.channel is None:
        return None
    key = label_key(step.channel)
    return {key["section"]: {key["name"]: {"never": list(step.categories)}}}


def _grant(grant: Grant) -> ChangedGrant:
    return {
        "file": grant.place.file, "line": grant.place.line, "enclave": grant.enclave, "profile": grant.node,
        "role": grant.role, "kind": grant.kind, "name": grant.name,
    }  # fmt: skip


def _affected(affected: Affected, element: Callable[[Element], MarkedElement]) -> AffectedEntry:
    return {
        "element": element(affected.element),
        "filtered": [{"from": _named_element(at), "categories": list(names)} for at, names in affected.filtered],
        "unread": [_named_element(at) for at in affected.unread],
        "unwritten": [_named_element(at) for at in affected.unwritten],
        "narrowed": [_named_element(at) for at in affected.narrowed],
    }


def _named_element(at: Shown) -> NamedElement:
    robot, kind, name, leg = at
    named: NamedElement = {"robot": robot, "kind": kind, "name": name}
    if leg:
        named["leg"] = leg
    return named
