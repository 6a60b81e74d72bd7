"""Findings, open questions, doubts and what the enforced view adds, as SARIF ``results``, each at a line of a file.

In: an ``Analysis`` and where things stand. Out: plain dicts, what counts most first.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.answer import Verdict
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.legal import turned_special
from rosprivacy.analysis.model import CONCERNS, MAY_REVEAL, NO_LEAK_NAMED, Place, Rank
from rosprivacy.analysis.policy_lines import in_a_file
from rosprivacy.report.document.contents import required
from rosprivacy.report.finding_facts import making
from rosprivacy.report.places import NOWHERE, of_step, to_review
from rosprivacy.report.sarif.locations import element_name, flows_of, logical, prose, text, uri_of
from rosprivacy.report.sarif.rules import (
    BEYOND_PROFILE,
    NO_LEAK,
    NOTHING_FOLLOWED,
    UNREVIEWED,
    SarifRule,
    rule_of,
    rule_of_doubt,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.findings.beyond import Added
    from rosprivacy.analysis.model import Category, Doubt, Element, Flow, Legal, Pointer
    from rosprivacy.ontology.pointed import Pointed
    from rosprivacy.report.document.contents import EnforcedFacts
    from rosprivacy.report.places import PlaceIndex

ROOT = "%SRCROOT%"
LAW = "data-protection-law"
FINDING = "rosprivacyFinding/v1"  # fingerprint that is the finding's id
MAX_RELATED = 100
MISSING = {
    "country": "nobody states its country",
    "occasional": "the transfer rests on a derogation (Article 49): is it occasional?",
}


@dataclass(frozen=True, slots=True)
class Files:
    """File names as SARIF has them.

    ``artifacts`` and ``places`` save asking twice, and what many results say is in memory once.
    """

    root: Path
    artifacts: dict[str, dict[str, Any]] = field(default_factory=dict)
    places: dict[Place, dict[str, Any]] = field(default_factory=dict)

    def artifact(self, file: str) -> dict[str, Any]:
        """Return the ``artifactLocation`` of a file."""
        if file not in self.artifacts:
            uri, relative = uri_of(file, self.root)
            self.artifacts[file] = {"uri": uri, **({"uriBaseId": ROOT} if relative else {})}
        return self.artifacts[file]

    def physical(self, place: Place) -> dict[str, Any]:
        """Return the ``physicalLocation`` of a place; viewers want a line, so one that has none gets the first."""
        if place not in self.places:
            region = {"startLine": max(place.line, 1)}
            self.places[place] = {"artifactLocation": self.artifact(place.file), "region": region}
        return self.places[place]


@dataclass(frozen=True, slots=True)
class Results:
    """Makes results.

    Attributes
    ----------
    law
        Category -> the provisions that a person has to look at, what holds always first.
    taxa, rules
        Numbers of provisions by IRI, and of rules by id.
    between
        The flows behind the steps of further paths.
    accepted
        Id of a finding -> why a person accepted it.
    contexts
        Of the sources.
    pointed
        The provisions that a kind of finding is about.
    doubts
        Of the answer, with what is said of each.
    """

    analysis: Analysis
    places: PlaceIndex
    files: Files
    categories: Mapping[str, Category]
    law: Mapping[str, tuple[Legal, ...]]
    taxa: Mapping[str, int]
    rules: Mapping[str, int]
    between: Mapping[Any, Flow]
    accepted: Mapping[str, str]
    contexts: Contexts
    pointed: Pointed
    doubts: tuple[tuple[Doubt, str], ...] = ()

    def all(self) -> Iterator[dict[str, Any]]:
        """One result per finding, the dismissed ones last, then one per node to review next (rules S10, S11).

        What is undetermined has a result, so that an empty list never stands for it (S12), and so has each doubt.
        """
        for finding in sorted(self.analysis.findings, key=lambda f: f.dismissed):
            yield self._finding(finding)
        for question in to_review(self.analysis):
            yield self._question(question)
        if self.analysis.verdict is Verdict.UNDETERMINED and not self.analysis.open:
            if self.analysis.lacking == NO_LEAK_NAMED:
                yield self._rule_alone(NO_LEAK)
            elif self.analysis.lacking or not self.doubts:
                yield self._rule_alone(NOTHING_FOLLOWED)
        for doubt, message in self.doubts:
            yield self._doubt(doubt, message)

    def _finding(self, finding: Finding) -> dict[str, Any]:
        rule = rule_of(finding.kind)
        law = (*self.law.get(finding.category, ()), *self.contexts.revealed(finding))
        place = self.places.of_finding(finding)
        result: dict[str, Any] = {
            "ruleId": rule.id,
            "ruleIndex": self.rules[rule.id],
            "level": "note" if finding.dismissed else rule.level,
            "message": {"text": _message(finding, law, turned_special(finding, self.categories), place)},
            "locations": [self._location(finding.leak, place)],
            "codeFlows": flows_of(finding, self.between, self.places, self.files.physical),
            "partialFingerprints": _fingerprints(finding.id),
        }
        if related := self._related(finding, place):
            result["relatedLocations"] = related
        at_stake: list[Legal | Pointer] = [*law, *self.pointed.of_finding(finding.kind)]
        distinct = {one.iri: one for one in at_stake}.values()
        if distinct:
            result["taxa"] = [reference(legal, self.taxa[legal.iri]) for legal in distinct]
        if finding.id in self.accepted:
            why = prose(self.accepted[finding.id])
            result["suppressions"] = [{"kind": "external", "status": "accepted", "justification": why}]
        result["properties"] = {
            "category": shown(finding.category),
            "pseudonymised": finding.pseudonymised,
            "dismissed": finding.dismissed,
            "disjointPaths": finding.number_of_paths,
            "article9": self.contexts.article9(finding),
            "law": [{"provision": legal.name, "verdict": legal.verdict, "condition": legal.condition} for legal in law],
        }
        return result

    def _question(self, question: OpenQuestion) -> dict[str, Any]:
        element, rule = question.element, UNREVIEWED
        kinds = ", ".join(text(name) for name in question.categories)
        unknown = "whether it may carry that" if element.is_channel else "what it does with that"
        what = f"{element_name(element)} gets {kinds}, and no label says {unknown}."
        if question.missing:
            what = (
                f"{element_name(element)} gets {kinds}, and {' and '.join(MISSING[name] for name in question.missing)}"
            )
            what = what if what.endswith("?") else f"{what}."
        digest = hashlib.sha256("\0".join(("unreviewed", *element.shown_as)).encode()).hexdigest()[:16]
        return {
            "ruleId": rule.id,
            "ruleIndex": self.rules[rule.id],
            "kind": "review",
            "level": rule.level,
            "message": {"text": f"{what} The analysis lets it pass; a person has to look."},
            "locations": [self._location(element, self.places.of_question(question))],
            "partialFingerprints": _fingerprints(digest),
            "properties": {"categories": [shown(name) for name in question.categories], "distance": question.distance},
        }

    def _doubt(self, doubt: Doubt, message: str) -> dict[str, Any]:
        rule = rule_of_doubt(doubt.name, breaks=doubt.rank is Rank.BREAKS)
        place = doubt.place if in_a_file(doubt.place) else self.places.last_resort()
        where = {"physicalLocation": self.files.physical(place)}
        result = {
            "ruleId": rule.id,
            "ruleIndex": self.rules[rule.id],
            "level": rule.level,
            "message": {"text": prose(f"{message[:1].upper()}{message[1:]}.")},
            "locations": [self._location(doubt.element, place) if doubt.element else where],
            "partialFingerprints": _fingerprints(doubt.id),
            "properties": {"rank": str(doubt.rank), "categories": [shown(name) for name in doubt.categories]},
        }
        if doubt.accepted:
            why = prose(doubt.accepted.reason)
            result["suppressions"] = [{"kind": "external", "status": "accepted", "justification": why}]
        return result

    def _rule_alone(self, rule: SarifRule) -> dict[str, Any]:
        """A result about the whole system."""
        return {
            "ruleId": rule.id,
            "ruleIndex": self.rules[rule.id],
            "level": rule.level,
            "message": {"text": rule.short},
            "locations": [{"physicalLocation": self.files.physical(self.places.last_resort())}],
            "partialFingerprints": _fingerprints(rule.id),
        }

    def _location(self, element: Element, place: Place) -> dict[str, Any]:
        return {"physicalLocation": self.files.physical(place), "logicalLocations": [logical(element)]}

    def _related(self, finding: Finding, place: Place) -> list[dict[str, Any]]:
        """The labels at both ends, and further lines that allow the last step."""
        begins = finding.steps[0].category if finding.steps else finding.category
        said: list[tuple[Place | None, str]] = [
            (
                self.places.of_role(finding.source, "source", begins),
                f"{element_name(finding.source)} is labelled source here.",
            ),
            (
                self.places.of_role(finding.leak, "leak", finding.category),
                f"{element_name(finding.leak)} is labelled leak here.",
            ),
        ]
        said += [(where, "The governance leaves the channel open here.") for where in _governed(finding)]
        last = [other for step in finding.steps[-1:] for other in of_step(step) if other != place]
        found = [(where, what) for where, what in said if where] + [
            (other, "Allows the last step, too.") for other in last
        ]
        return [
            {"id": number, "physicalLocation": self.files.physical(where), "message": {"text": what}}
            for number, (where, what) in enumerate(found[:MAX_RELATED])
        ]


def reference(legal: Legal | Pointer, number: int) -> dict[str, Any]:
    """Return a provision as a reference to its taxon."""
    return {"id": legal.name, "index": number, "toolComponent": {"name": LAW, "index": 0}}


def _fingerprints(digest: str) -> dict[str, str]:
    """The first is the only one that GitHub looks at; by itself it would take the line, which many findings share."""
    return {"primaryLocationLineHash": f"{digest}:1", FINDING: digest}


def _message(finding: Finding, law: Sequence[Legal], turned: Element | None, place: Place) -> str:
    """What a viewer shows; some show the first sentence only."""
    category, source, leak = text(finding.category), element_name(finding.source), element_name(finding.leak)
    of, by = making(finding)
    said = [f"{category} can get from {source} to {leak}: a path to assess."]
    if made := ", ".join(map(element_name, by)):
        said = [f"{category}, made of {text(of)} of {source} at {made}, can get to {leak}: a path to assess."]
    if len(finding.witness) == 1:
        said = [f"{source} brings {category} in and lets it out itself: a path to assess."]
    if finding.reason:
        said.append(f"{leak}: {prose(finding.reason)}.")
    if finding.pseudonymised:
        said.append("It arrives pseudonymised, which is personal data for whoever can tell the persons.")
    if turned is not None:
        said.append(f"{element_name(turned)} makes such data of other data.")
    if finding.dismissed:
        through = ", ".join(element_name(element) for element in finding.through)
        said.append(f"Every path there goes through {through}, which has a finding of its own.")
    if (number := finding.number_of_paths or 1) > 1:
        said.append(f"{number} paths share no step.")
    said += _to_check(law)
    if place == NOWHERE:
        said.append("No file says so: it stands in the database.")
    return " ".join([*said, f"Finding {finding.id}."])


def _governed(finding: Finding) -> Iterator[Place]:
    """The lines of a governance by which others on the network can read a channel."""
    values = dict(finding.why.values) if finding.why else {}
    for of in ("", "joining_"):
        if f"{of}line" in values:
            yield Place(values[f"{of}file"], int(values[f"{of}line"]))


def _to_check(law: Sequence[Legal]) -> list[str]:
    """What a person has to look up; of what such data may only reveal, the names."""
    strong = [legal for legal in law if legal.verdict not in (MAY_REVEAL, CONCERNS)]
    weak = [text(legal.name) for legal in law if legal.verdict == MAY_REVEAL]
    concerning = [text(legal.name) for legal in law if legal.verdict == CONCERNS]
    said = []
    for legal in strong:
        condition = f": {legal.condition}" if legal.condition else ""
        said.append(f"To be checked: {text(legal.name)} ({text(legal.verdict)}{prose(condition)}).")
    said += [f"It may reveal what these speak of: {', '.join(dict.fromkeys(weak))}."] if weak else []
    return (
        [*said, f"Where it is brought in, these concern it: {', '.join(dict.fromkeys(concerning))}."]
        if concerning
        else said
    )


def added_results(enforced: EnforcedFacts, rule: int, files: Files) -> Iterator[dict[str, Any]]:
    """Yield a result for each finding that only the enforced view has, at the line of another's profile that it needs.

    Parameters
    ----------
    rule
        Number of ``BEYOND_PROFILE`` among the rules of the log.
    """
    places, between = required(enforced.positions)
    for one in enforced.added:
        finding = one.finding
        lines = [place for number in one.beyond for place in of_step(finding.steps[number])]
        place = files.physical(lines[0] if lines else places.of_finding(finding))
        digest = hashlib.sha256(f"enforced\0{finding.id}".encode()).hexdigest()[:16]
        yield {
            "ruleId": BEYOND_PROFILE.id,
            "ruleIndex": rule,
            "level": BEYOND_PROFILE.level,
            "message": {"text": " ".join(_beyond(one))},
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


def _beyond(added: Added) -> Iterator[str]:
    finding = added.finding
    ends = f"from {element_name(finding.source)} to {element_name(finding.leak)}"
    if added.beyond:
        yield f"Only if a node goes beyond its own profile: {text(finding.category)} can get {ends}."
    else:
        yield f"Only if a channel carries what its type cannot hold: {text(finding.category)} can get {ends}."
    if added.plain:
        yield "The declared view has it, too, but pseudonymised only: this is about the plain data."
    if added.robots:
        yield f"On {len(added.robots):,} {'robot' if len(added.robots) == 1 else 'robots'} of the fleet."
    if added.enclaves:
        yield f"Nodes share enclave {_row(added.enclaves)}."
    if added.opened:
        yield f"Permissions are not asked there: {_row(map(str, added.opened))}."
    if added.split:
        yield f"Gone if {_row(added.split)} is split into an enclave for each node."
    if added.move:
        yield f"Gone if only {text(added.move[1])} is moved from {text(added.move[0])} to an enclave of its own."
    if added.deny:
        lines = "; ".join(f"a DENY to {line.role} {text(line.name)} in {text(line.enclave)}" for line in added.deny)
        lost = "; ".join(f"{text(node[2])} {role} {text(channel[2])}" for node, role, channel in added.loses)
        yield f"Gone with {lines}, with which profiles would lose what they allow: {lost}."


def _row(names: Iterable[str]) -> str:
    return ", ".join(map(text, names))
