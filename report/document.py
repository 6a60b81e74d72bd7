"""Analysis -> the JSON document ``rosprivacy.analysis/1``, a contract (``docs/analysis.schema.json``).

In: an ``Analysis`` and what it rests on. Out: plain dicts and lists, sorted, with no time in them (rule S14).
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Analysis, Category, Diagnostic, Element, Finding, Grant, Step

FORMAT = "rosprivacy.analysis/1"


def document(
    analysis: Analysis,
    categories: Mapping[str, Category],
    hierarchy: Hierarchy,
    diagnostics: Iterable[Diagnostic],
    assumptions: Mapping[str, Any],
) -> dict[str, Any]:
    """Return the analysis as one JSON object.

    Parameters
    ----------
    diagnostics
        Of the inputs; the analysis' own are added.
    assumptions
        What the answer rests on, made by the caller who knows the files.
    """
    graph = analysis.graph
    return {
        "format": FORMAT,
        "verdict": str(analysis.verdict),
        "view": graph.view,
        "categories": [_category(categories[name], hierarchy) for name in analysis.emitted],
        "findings": [_finding(finding) for finding in analysis.findings],
        "open": [
            {
                "element": element_dict(question.element),
                "categories": list(question.categories),
                "distance": question.distance,
                "frontier": question.frontier,
            }
            for question in analysis.open
        ],
        "carries": [
            {
                "element": element_dict(carried.element),
                "categories": list(carried.categories),
                "pseudonymised": list(carried.pseudonymised),
            }
            for carried in analysis.carried
        ],
        "roles": [
            {"element": element_dict(element), "category": category, "roles": list(roles)}
            for element, said in analysis.roles.items()
            for category, roles in sorted(said.items())
            if not element.is_channel
        ],
        "flows": len(graph.flows),
        "denied_flows": len(graph.denied),
        "elements": len({element.identity for element in graph.elements}),
        "standard_channels": analysis.standard_channels,
        "diagnostics": [_diagnostic(d) for d in (*diagnostics, *analysis.diagnostics)],
        "assumptions": {
            **assumptions,
            "sanitizers_without_method": [
                {"element": element_dict(element), "category": category, "taken_as": "pseudonymise"}
                for element, category in analysis.unstated
            ],
        },
    }


def as_text(value: Any) -> str:
    """Return JSON text that is the same for the same value, and ends with a newline.

    What UTF-8 cannot say (a file name that is none) is escaped.
    """
    text = json.dumps(value, indent=2, ensure_ascii=False) + "\n"
    return text.encode("utf-8", "backslashreplace").decode()


def element_dict(element: Element) -> dict[str, Any]:
    """Return E of the contract.

    >>> from rosprivacy.analysis.model import Element
    >>> element_dict(Element("service", "/add", leg="request"))
    {'robot': '', 'kind': 'service', 'name': '/add', 'leg': 'request'}
    """
    shown: dict[str, Any] = {"robot": element.robot, "kind": element.kind, "name": element.name}
    if element.leg:
        shown["leg"] = element.leg
    if element.pattern:
        shown["pattern"] = True
    return shown


def _category(category: Category, hierarchy: Hierarchy) -> dict[str, Any]:
    return {"name": category.name, "iri": category.iri, "broader": hierarchy.broader(category.name)}


def _finding(finding: Finding) -> dict[str, Any]:
    shown = {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "pseudonymised": finding.pseudonymised,
        "source": element_dict(finding.source),
        "leak": element_dict(finding.leak),
        "witness": [element_dict(element) for element in finding.witness],
        "steps": [_step(step) for step in finding.steps],
        "disjoint_paths": finding.disjoint_paths,
        "through": [element_dict(element) for element in finding.through],
        "dismissed": finding.dismissed,
        "accepted": finding.accepted,
    }
    if finding.paths:
        shown["paths"] = [[element_dict(element) for element in path] for path in finding.paths]
        shown["paths_bounded"] = finding.bounded
    return shown


def _step(step: Step) -> dict[str, Any]:
    return {
        "role": step.role,
        "category": step.category,
        "pseudonymised": step.pseudonymised,
        "policy": [_grant(grant) for grant in step.grants],
    }


def _grant(grant: Grant) -> dict[str, Any]:
    return {"file": grant.place.file, "line": grant.place.line, "enclave": grant.enclave, "profile": grant.node}


def _diagnostic(diagnostic: Diagnostic) -> dict[str, Any]:
    return {
        "file": diagnostic.place.file,
        "line": diagnostic.place.line,
        "severity": str(diagnostic.severity),
        "message": diagnostic.message,
    }
