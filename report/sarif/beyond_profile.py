"""What a node could do beyond its own profile, as SARIF ``results`` of a rule of their own, which are notes (rule S6).

In: ``Enforced``. Out: plain dicts. A note fails no build: the answer of record is the declared one.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

from rosprivacy.report.places import Places, of_step
from rosprivacy.report.sarif.flows import flows_between, flows_of, logical, named, text
from rosprivacy.report.sarif.rules import BEYOND_PROFILE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.report.answer import Enforced
    from rosprivacy.report.sarif.results import Files


def added_results(enforced: Enforced, rule: int, files: Files) -> Iterator[dict[str, Any]]:
    """Yield a result for each finding that only the enforced view has, at the line of another's profile that it needs.

    Parameters
    ----------
    rule
        Number of ``BEYOND_PROFILE`` among the rules of the log.
    """
    answer = enforced.answer
    places, between = Places.of(answer.analysis, answer.assumptions), flows_between(answer.analysis)
    for one in enforced.added:
        finding = one.finding
        lines = [place for number in one.beyond for place in of_step(finding.steps[number])]
        place = files.physical(lines[0] if lines else places.of_finding(finding))
        digest = hashlib.sha256(f"enforced\0{finding.id}".encode()).hexdigest()[:16]
        yield {
            "ruleId": BEYOND_PROFILE.id,
            "ruleIndex": rule,
            "level": BEYOND_PROFILE.level,
            "message": {"text": " ".join(_said(one))},
            "locations": [{"physicalLocation": place, "logicalLocations": [logical(finding.leak)]}],
            "codeFlows": flows_of(finding, between, places, files.physical),
            "partialFingerprints": {"rosprivacyEnforced/v1": digest},
            **({"suppressions": [{"kind": "external", "status": "accepted"}]} if finding.accepted else {}),
            "properties": {
                "category": text(finding.category),
                "finding": finding.id,
                "enclaves": list(map(text, one.enclaves)),
                "split": list(map(text, one.split)),
                **({"robots": list(map(text, one.robots))} if one.robots else {}),
            },
        }


def _said(one: Added) -> Iterator[str]:
    finding = one.finding
    ends = f"from {named(finding.source)} to {named(finding.leak)}"
    if one.beyond:
        yield f"Only if a node goes beyond its own profile: {text(finding.category)} can get {ends}."
    else:
        yield f"Only if a channel carries what its type cannot hold: {text(finding.category)} can get {ends}."
    if one.plain:
        yield "The declared view has it, too, but pseudonymised only: this is about the plain data."
    if one.robots:
        yield f"On {len(one.robots):,} {'robot' if len(one.robots) == 1 else 'robots'} of the fleet."
    if one.enclaves:
        yield f"Nodes share enclave {_row(one.enclaves)}."
    if one.opened:
        yield f"Permissions are not asked there: {_row(map(str, one.opened))}."
    if one.split:
        yield f"Gone if {_row(one.split)} is split into an enclave for each node."
    if one.move:
        yield f"Gone if only {text(one.move[1])} is moved from {text(one.move[0])} to an enclave of its own."
    if one.deny:
        lines = "; ".join(f"a DENY to {line.role} {text(line.name)} in {text(line.enclave)}" for line in one.deny)
        lost = "; ".join(f"{text(node[2])} {role} {text(channel[2])}" for node, role, channel in one.loses)
        yield f"Gone with {lines}, with which profiles would lose what they allow: {lost}."


def _row(names: Iterable[str]) -> str:
    return ", ".join(map(text, names))
