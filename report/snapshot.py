"""A JSON document, and the policies behind it if they are at hand -> facts by key, to be compared with others.

In: a document of the contract, made now or saved before. Out: ``Snapshot``: robots, grants, elements, findings. Of a
fleet, elements are those of a model, and findings are patterns, so that it does not matter which robot is shown.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.comparison import Key, Record
    from rosprivacy.analysis.model import Policy

Facts = dict["Key", "Record"]


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The state of a system, as facts by key.

    Attributes
    ----------
    verdict
        As in the document.
    robots
        (id,) -> its model; empty for a single robot.
    grants
        (policy, enclave, node, role, kind, name) -> the rule; None where the policies are not at hand. The policy is
        named in a fleet only.
    elements
        (robot or model, kind, name, leg) -> what gets there, what labels say, what is stated about it. Elements that
        nothing gets to and nothing is said of are not listed.
    findings
        (kind, category, source, leak, whether it goes across robots) -> in which form, along which way, on which
        robots.
    """

    verdict: str
    robots: Facts
    grants: Facts | None
    elements: Facts
    findings: Facts


def snapshot(document: Mapping[str, Any], policies: Iterable[Policy] | None) -> Snapshot:
    """Take the facts out of a document."""
    fleet = document.get("fleet")
    models = {group["robot"]: group["model"] or group["robot"] for group in fleet["alike"]} if fleet else {}
    return Snapshot(
        document["verdict"],
        {(robot,): {"model": g["model"]} for g in (fleet["alike"] if fleet else ()) for robot in g["robots"]},
        None if policies is None else _grants(policies, named=bool(fleet)),
        _elements(document, models),
        _findings(document, models),
    )


def _grants(policies: Iterable[Policy], *, named: bool) -> Facts:
    rules: dict[Key, set[str]] = defaultdict(set)
    for policy in policies:
        for g in policy.grants:
            key = (policy.file if named else "", g.enclave, g.node, g.role, g.kind, g.name)
            rules[key].add("ALLOW" if g.allow else "DENY")
    return {key: {"rule": " and ".join(sorted(found))} for key, found in rules.items()}


def _elements(document: Mapping[str, Any], models: Mapping[str, str]) -> Facts:
    found: dict[Key, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for row in document["carries"]:
        found[_element(row["element"], models)]["carries"] |= set(row["categories"])
        found[_element(row["element"], models)]["pseudonymised"] |= set(row["pseudonymised"])
    for row in document["open"]:
        found[_element(row["element"], models)]["open"] |= set(row["categories"])
    for row in document["roles"]:
        said = {f"{role} of {row['category']}" for role in row["roles"]}
        found[_element(row["element"], models)]["labels"] |= said
    for row in document.get("outside", ()):
        facts = {key: value for key, value in row.items() if key not in ("element", "file", "line", "holds")}
        found[_element(row["element"], models)]["stated"] |= {f"{key}: {value}" for key, value in facts.items()}
    return {key: {what: sorted(values) for what, values in row.items() if values} for key, row in found.items()}


def _element(element: Mapping[str, Any], models: Mapping[str, str]) -> Key:
    robot = models.get(element["robot"], element["robot"])
    return (robot, element["kind"], element["name"], element.get("leg", ""))


def _findings(document: Mapping[str, Any], models: Mapping[str, str]) -> Facts:
    patterns = {p["finding"]: p for p in document["fleet"]["patterns"]} if document.get("fleet") else {}
    found: Facts = {}
    for finding in document["findings"]:
        pattern = patterns.get(finding["id"])
        ends = (_end(finding["source"], models), _end(finding["leak"], models))
        across = "across" if pattern and pattern["across"] else ""
        record: Record = {
            "dismissed": finding["dismissed"],
            "pseudonymised": finding["pseudonymised"],
            "way": [element["name"] for element in finding["witness"]],
            "reason": finding.get("reason", ""),
        }
        if pattern:
            record["robots"] = pattern["robots"]
            counts = {
                "findings": "findings",
                "dismissed": "of_them_dismissed",
                "pseudonymised": "of_them_pseudonymised",
            }
            record |= {name: pattern[key] for key, name in counts.items()}
        found[finding["kind"], finding["category"], *ends, across] = record
    return found


def _end(element: Mapping[str, Any], models: Mapping[str, str]) -> str:
    """A source or leak by name; with its robot where that is none, such as what is shared."""
    robot = "" if element["robot"] in models or not element["robot"] else f"{element['robot']}:"
    return f"{robot}{element['kind']} {element['name']}"
