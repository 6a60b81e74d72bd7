"""A JSON document, and the policies behind it if they are at hand -> facts by key, to be compared with others.

In: a document of the contract, made now or saved before. Out: ``Snapshot``: robots, grants, elements, findings. Of a
fleet, elements are those of a model, and findings are patterns, so that it does not matter which robot is shown.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import NOTHING_ENFORCED, SCAN_GAP
from rosprivacy.report.compare.matching import Identity

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from rosprivacy.analysis.model import Policy
    from rosprivacy.report.compare.matching import Key, Record

Facts = dict["Key", "Record"]
OF_SOURCES = (SCAN_GAP, NOTHING_ENFORCED)  # of source code each of these holds once; its gaps are compared themselves


class CodeState(NamedTuple):
    """What source code says beyond its policy, by what it is about and not by its lines.

    Attributes
    ----------
    ways_out
        (sort, node, name, channel) -> at how many lines data can get out of ROS that way.
    gaps
        (sort, file, what is not known) -> how often, and what it depends on.
    places
        Key of one of these -> its lines, as ``file:line``; they may move, and are not compared.
    """

    ways_out: Facts
    gaps: Facts
    places: Mapping[Key, list[str]]


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
        (kind, category, source, leak, whether it goes across robots) -> in which form, along which path, on which
        robots.
    lines
        Key of a finding -> the policy line that lets the data in, as ``file:line``; it may move, and is not compared.
    assumptions
        As in the document.
    doubts
        (sort of doubt, robot or model, kind, name, leg, file, message) -> its rank; those that nobody has accepted.
        None of a document of an earlier version, which has no list of them.
    followed
        Whether any data was followed.
    sentence
        Of the verdict, with its doubts; the verdict alone of a document of an earlier version.
    code
        What source code says beyond its policy; None of what is no source code.
    """

    verdict: str
    robots: Facts
    grants: Facts | None
    elements: Facts
    findings: Facts
    lines: Mapping[Key, str]
    assumptions: Mapping[str, Any]
    doubts: Facts | None
    followed: bool
    sentence: str
    code: CodeState | None


def snapshot(document: Mapping[str, Any], policies: Iterable[Policy] | None, code: CodeState | None = None) -> Snapshot:
    """Take the facts out of a document."""
    fleet = document.get("fleet")
    identity = Identity.of(document)
    return Snapshot(
        document["verdict"],
        {(robot,): {"model": g["model"]} for g in (fleet["alike"] if fleet else ()) for robot in g["robots"]},
        None if policies is None else _grants(policies, by_name=bool(fleet)),
        _elements(document, identity),
        _findings(document, identity),
        dict(_lines(document, identity)),
        document["assumptions"],
        _doubts(document, identity, of_code=code is not None) if "doubts" in document else None,
        bool(document["carries"]),
        document.get("sentence", document["verdict"]),
        code,
    )


def _grants(policies: Iterable[Policy], *, by_name: bool) -> Facts:
    rules: dict[Key, set[str]] = defaultdict(set)
    for policy in policies:
        for g in policy.grants:
            key = (policy.file if by_name else "", g.enclave, g.node, g.role, g.kind, g.name)
            rules[key].add("ALLOW" if g.allow else "dead DENY" if g.dead else "DENY")
    return {key: {"rule": " and ".join(sorted(found))} for key, found in rules.items()}


def _doubts(document: Mapping[str, Any], identity: Identity, *, of_code: bool) -> Facts:
    """A line may move, nor is the name of the only policy compared; what is wrong with a file is."""
    rows = (row for row in document["doubts"] if not row["accepted"])
    policies = {row["file"] for row in document["assumptions"]["policies"]}
    alone = policies if len(policies) == 1 and "fleet" not in document else set()
    once = OF_SOURCES if of_code else ()
    return {
        (row["doubt"], *(("",) * 6 if row["doubt"] in once else _about(row, identity, alone))): {"rank": row["rank"]}
        for row in rows
    }


def _about(row: Mapping[str, Any], identity: Identity, unnamed: Collection[str]) -> Key:
    if row["element"]:
        return (*identity.element(row["element"]), "", "")
    return ("", "", "", "", "" if row["file"] in unnamed else row["file"], row["message"])


def _elements(document: Mapping[str, Any], identity: Identity) -> Facts:
    found: dict[Key, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for row in document["carries"]:
        found[identity.element(row["element"])]["carries"] |= set(row["categories"])
        found[identity.element(row["element"])]["pseudonymised"] |= set(row["pseudonymised"])
    for row in document["open"]:
        found[identity.element(row["element"])]["open"] |= set(row["categories"])
    for row in document.get("roles", ()):
        said = {f"{role} of {row['category']}" for role in row["roles"]}
        found[identity.element(row["element"])]["labels"] |= said
    for row in document.get("outside", ()):
        facts = {key: value for key, value in row.items() if key not in ("element", "file", "line", "holds")}
        found[identity.element(row["element"])]["stated"] |= {f"{key}: {value}" for key, value in facts.items()}
    return {key: {what: sorted(values) for what, values in row.items() if values} for key, row in found.items()}


def _findings(document: Mapping[str, Any], identity: Identity) -> Facts:
    found: Facts = {}
    for finding in document["findings"]:
        pattern = identity.patterns.get(finding["id"])
        record: Record = {
            "dismissed": finding["dismissed"],
            "pseudonymised": finding["pseudonymised"],
            "accepted": finding.get("accepted", False),
            "way": [element["name"] for element in finding["witness"]],
            "reason": finding.get("reason", ""),
        }
        if pattern:
            record["robots"] = pattern["robots"]
            counts = {
                "findings": "findings",
                "dismissed": "of_them_dismissed",
                "pseudonymised": "of_them_pseudonymised",
                "accepted": "of_them_accepted",
            }
            record |= {name: pattern.get(key, 0) for key, name in counts.items()}
        found[identity.finding(finding)] = record
    return found


def _lines(document: Mapping[str, Any], identity: Identity) -> Iterator[tuple[Key, str]]:
    for finding in document["findings"]:
        for line in [line for step in finding.get("steps", ())[-1:] for line in step["policy"]][:1]:
            yield identity.finding(finding), f"{line['file']}:{line['line']}"
