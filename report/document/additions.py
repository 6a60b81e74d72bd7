"""What only some documents have: decisions, what the enforced view adds (rule S6), a fleet.

In: the document without them, and decisions joined to their findings; ``EnforcedFacts``; the document of the graph in
which a robot stands for all that are alike. Out: entries with ``decision`` on findings and ``decisions``; an
``EnforcedEntry``; the same with ``fleet``, and with counts of the whole fleet.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, cast

from rosprivacy.analysis.model import Element
from rosprivacy.report.document.records import element_dict, finding_entry, place_entries
from rosprivacy.report.robots import form_rows

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.decisions import Decided, Decision, State
    from rosprivacy.analysis.findings.beyond import Added, DenyLine, Right
    from rosprivacy.analysis.fleet.counts import Counts
    from rosprivacy.analysis.fleet.likeness import Likeness
    from rosprivacy.analysis.fleet.patterns import DeviantRobots, FleetView, Pattern, Share
    from rosprivacy.analysis.model.logged_step import LoggedStep
    from rosprivacy.report.document.contents import EnforcedFacts
    from rosprivacy.report.schemas.analysis import (
        AddedEntry,
        AnalysisDocument,
        DenyEntry,
        DeviantEntry,
        EnforcedEntry,
        FleetEntry,
        LostEntry,
        PatternEntry,
        ShareEntry,
        StandardFile,
    )
    from rosprivacy.report.schemas.records import (
        ChangedSince,
        DecisionEntry,
        FindingEntry,
        ListedDecision,
        LoggedEntry,
        Target,
    )


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
    if entry.condition:
        decision["condition"] = entry.condition
    if entry.answers:
        decision["answers"] = dict(entry.answers)
    if entry.history:
        decision["history"] = list(map(_logged, entry.history))
    return {**decision, "changed": changed} if changed else decision


def _logged(step: LoggedStep) -> LoggedEntry:
    logged: LoggedEntry = {
        "hash": step.hash,
        "when": step.when,
        "account": step.account,
        "decision": step.decision,
        "owner": step.owner,
        "reason": step.reason,
        "expires": step.expires or None,
    }
    return {**logged, "answers": dict(step.answers)} if step.answers else logged


def _target(entry: Decision) -> Target:
    """What an entry says that it is about."""
    keys = ("id", "row", "category", "source", "leak", "robot", "from_robot", "kind")
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


def fleet_document(document: AnalysisDocument, view: FleetView, counts: Counts) -> AnalysisDocument:
    """Return the document of a fleet; what the whole graph tells, it tells of one robot of those that are alike.

    Parameters
    ----------
    document
        Of the analysis as ``FleetView.shown`` gives it.
    """
    standard, likeness = document["assumptions"]["standard_channels"], view.likeness
    taken: StandardFile | None = {**standard, "taken": counts.standard_channels} if standard else None
    return {
        **document,
        "subjects": _without(document["subjects"], likeness),
        "surroundings": _without(document["surroundings"], likeness),
        "sanitizers": _without(document["sanitizers"], likeness),
        "derivations": _without(document["derivations"], likeness),
        "unreached": _without(document["unreached"], likeness),
        "elements": counts.elements,
        "flows": counts.flows,
        "denied_flows": counts.denied_flows,
        "standard_channels": counts.standard_channels,
        "assumptions": {**document["assumptions"], "standard_channels": taken},
        "fleet": _fleet(view),
    }


def _without(value: Any, likeness: Likeness) -> Any:
    """Rows without elements of robots that only stand beside others: what is true of them, the others tell."""
    if isinstance(value, list):
        return [_without(item, likeness) for item in value if not _second(item, likeness)]
    if isinstance(value, dict) and "robot" not in value:
        return {key: _without(item, likeness) for key, item in value.items()}
    return value


def _second(item: Any, likeness: Likeness) -> bool:
    element = item.get("element", item) if isinstance(item, dict) else {}
    return element.get("robot") in likeness.second


def _fleet(view: FleetView) -> FleetEntry:
    likeness = view.likeness
    models = Counter(dict.fromkeys(sorted(set(likeness.models.values())), 0))
    for robot, model in likeness.models.items():
        models[model] += likeness.weight(robot)
    return {
        "robots": sum(models.values()),
        "models": dict(models),
        "alike": [
            {"robot": robot, "model": likeness.models[robot], "robots": list(robots)}
            for robot, robots in sorted(likeness.members.items())
        ],
        "patterns": [_pattern(pattern) for pattern in view.patterns],
        "deviants": [_deviant(deviant) for deviant in view.deviants],
    }


def _pattern(pattern: Pattern) -> PatternEntry:
    return {
        "id": pattern.id,
        "finding": pattern.finding.id,
        "across": pattern.across,
        "findings": pattern.count,
        "dismissed": pattern.dismissed,
        "pseudonymised": pattern.pseudonymised,
        "accepted": pattern.accepted,
        "robots": list(pattern.robots),
        "forms": form_rows(pattern),
    }


def _deviant(deviant: DeviantRobots) -> DeviantEntry:
    return {
        "robots": list(deviant.robots),
        "model": deviant.model,
        "more": _shares(deviant.additional),
        "fewer": _shares(deviant.fewer),
        "more_open": [element_dict(element) for element in deviant.more_open],
        "fewer_open": [element_dict(element) for element in deviant.fewer_open],
    }


def _shares(shares: Iterable[Share]) -> list[ShareEntry]:
    return [
        {
            "pattern": s.pattern,
            "ends": s.ends,
            "dismissed": s.dismissed,
            "pseudonymised": s.pseudonymised,
            "accepted": s.accepted,
        }
        for s in shares
    ]
