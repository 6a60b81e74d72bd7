"""Findings in the report for the terminal: a list, the details hop by hop, and what the law says of each kind once.

In: a JSON document of the contract. Out: lines. What a person decides first stands first.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.report.document.decisions import decision_lines
from rosprivacy.report.finding_order import in_order
from rosprivacy.report.looked_at import looked_at
from rosprivacy.report.naming import key, kind_of, shown_name
from rosprivacy.report.terminal.fleet import on_robots, robots_of
from rosprivacy.report.terminal.restriction import may_be_asked

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

Line = tuple[str, str]  # text, style
MANY = 5  # findings; of more a list of one line each comes first
VERBS = {  # (role, whether data goes into a channel) -> what is between the two
    ("publish", True): "publishes",
    ("subscribe", False): "is read by",
    ("request", True): "asks",
    ("request", False): "answers",
    ("reply", False): "asks",
    ("reply", True): "answers",
    ("call", True): "sends a goal to",
    ("call", False): "reports to",
    ("execute", False): "sends a goal to",
    ("execute", True): "reports to",
}
OTHER_VERBS = {"matches": "wildcard covers", "flow": "goes to"}
MAY = {"always": "applies", "conditional": "can apply", "may-reveal": "may be revealed"}  # to the data, not the system
KINDS = {
    "disclosure": "",
    "storage-limitation": "kept without a stated end, or too long: ",
    "third-country-transfer": "leaves the EEA without a stated basis: ",
}


def overview(report: Mapping[str, Any]) -> Iterator[Line]:
    """Return one line for each finding where there are many."""
    if len(report["findings"]) <= MANY:
        return
    unreviewed = _unreviewed(report)
    yield "", ""
    yield f"Findings: {len(report['findings'])}", "bold"
    for number, finding in enumerate(in_order(report["findings"], report.get("fleet")), 1):
        hops = counted(len(finding["steps"]), "hop")
        met = {key(e) for e in finding["witness"]} & {element for element, _ in unreviewed}
        parts = [hops, *([f"{len(met)} not reviewed"] if met else []), *on_robots(report, finding), *_states(finding)]
        yield f"{number:>3}. {_title(report, finding)}, {', '.join(parts)}   [{finding['id']}]", _style(finding)


def details(report: Mapping[str, Any], findings: Sequence[Mapping[str, Any]]) -> Iterator[Line]:
    """Return the findings hop by hop."""
    roles = {(key(said["element"]), said["category"]): said["roles"] for said in report["roles"]}
    unreviewed, folder = _unreviewed(report), policies_in(report)
    if folder and any(finding["steps"] for finding in findings):
        yield f"lines are those of files in {shown(folder)}", "dim"
    for number, finding in enumerate(in_order(findings, report.get("fleet")), 1):
        yield "", ""
        yield f"{number}. {_title(report, finding)}   [{finding['id']}]", _style(finding)
        yield from robots_of(report, finding)
        if "reason" in finding:
            yield f"   {shown(finding['reason'])}", ""
        if finding["dismissed"]:
            through = ", ".join(shown_name(element) for element in finding["through"])
            past = "; past it, data gets there pseudonymised only" if finding.get("beside_pseudonymised") else ""
            yield f"   only through {through}, which has a finding of its own{past}", "dim"
        yield from decision_lines(finding)
        yield from _way(finding, roles, unreviewed, folder)
        yield from _paths(finding)
        if finding["special_from"]:
            yield f"   {shown_name(finding['special_from'])} makes such data of other data", ""


def law_lines(report: Mapping[str, Any], findings: Iterable[Mapping[str, Any]]) -> Iterator[Line]:
    """Return what a person has to look up about each kind of data that arrives somewhere, once for each kind."""
    told = in_order(findings)
    by_kind = {finding["category"]: finding for finding in told}
    findings_of = {kind: [finding for finding in told if finding["category"] == kind] for kind in by_kind}
    if not by_kind:
        return
    reasons = {category["name"]: category["reason"] for category in report["categories"]}
    yield "", ""
    yield "What the law says of these kinds of data", "bold"
    for category, finding in sorted(by_kind.items()):
        for legal in finding["law"]:
            condition = f": {blanked(legal['condition'])}" if legal["condition"] else ""
            yield f"   {category}: {shown(legal['provision'])}, {MAY[legal['verdict']]}{condition}", "magenta"
        yield from _context_lines(category, findings_of[category])
        if pointed := [one["provision"] for one in looked_at(report) if category in one["categories"]]:
            yield f"   {category}: look at {', '.join(map(shown, pointed))} too", "dim"
        if finding["article9"] == "unknown":
            yield f"   {category}: the ontology does not say whether Article 9 GDPR applies to such data", "yellow"
        if finding["article9"] == "no":
            yield f"   {category}: not Article 9 GDPR by itself: {blanked(reasons.get(category, ''))}", "dim"
    yield from _further_law(report)


def _context_lines(category: str, findings: Iterable[Mapping[str, Any]]) -> Iterator[Line]:
    """What data may reveal where they are brought in, once for each context, provision and source."""
    rows: dict[tuple[str, str, str], dict[str, None]] = {}
    for finding in findings:
        for said in finding.get("in_context", ()):
            of_source = rows.setdefault((said["context"], said["provision"], said["condition"]), {})
            of_source[shown_name(finding["source"])] = None
    for (context, provision, condition), sources in rows.items():
        who = f"{category} of {', '.join(sources)}"
        yield f"   {who}: may reveal in this context ({context}): {shown(provision)}: {blanked(condition)}", "magenta"


def _further_law(report: Mapping[str, Any]) -> Iterator[Line]:
    """Provisions that a context calls for; no verdict."""
    rows = looked_at(report)
    for context in report.get("contexts", ()):
        names = [row["provision"] for row in rows if context["name"] in row["contexts"]]
        if names:
            yield f"   in this context ({context['name']}): look at {', '.join(map(shown, names))} too", "dim"


def policies_in(report: Mapping[str, Any]) -> str:
    """Return the folder that all policies are in, empty if there is none that says anything."""
    files = [entry["file"] for entry in report["assumptions"].get("policies", ())]
    try:
        return os.path.commonpath([os.path.dirname(file) for file in files]) if files else ""  # noqa: PTH120 - text only
    except ValueError:  # some from the root, some not
        return ""


def _title(report: Mapping[str, Any], finding: Mapping[str, Any]) -> str:
    form = "pseudonymised " if finding["pseudonymised"] else ""
    what = f"{KINDS[finding['kind']]}{form}{finding['category']}{may_be_asked(report, finding['category'])}"
    return f"{what}: {shown_name(finding['source'])} -> {shown_name(finding['leak'])}"


def _states(finding: Mapping[str, Any]) -> list[str]:
    said = (("accepted", finding["accepted"]), ("only through another leak", finding["dismissed"]))
    return [word for word, holds in said if holds]


def _style(finding: Mapping[str, Any]) -> str:
    return "dim" if finding["dismissed"] or finding["accepted"] else "bold"


def _unreviewed(report: Mapping[str, Any]) -> set[Any]:
    return {(key(question["element"]), name) for question in report["open"] for name in question["categories"]}


def _way(
    finding: Mapping[str, Any], roles: Mapping[Any, Any], unreviewed: Collection[Any], folder: str
) -> Iterator[Line]:
    """The witness, hop by hop: element, what labels say of it, policy line."""
    witness, steps = finding["witness"], finding["steps"]
    data = [step["category"] for step in steps]
    for hop, element in enumerate(witness):
        # what is there: the data that arrives, at the source the data that leaves, at the leak what gets out too
        here = dict.fromkeys([*data[max(hop - 1, 0) : hop or 1], *([] if hop < len(steps) else [finding["category"]])])
        said = [(name, role) for name in here for role in roles.get((key(element), name), ())]
        notes = [f"{role} of {name}{_of_another(finding, hop, role, name)}" for name, role in said]
        notes += ["not reviewed" for name in here if (key(element), name) in unreviewed]
        style = "red" if any(role == "leak" for _, role in said) else ""
        yield f"   {shown_name(element)}  ({', '.join([kind_of(element), *notes])})", style
        if hop < len(steps):
            before = steps[hop - 1] if hop else steps[hop]
            yield f"     | {_step(steps[hop], before, witness[hop + 1], folder)}", "dim"


def _of_another(finding: Mapping[str, Any], hop: int, role: str, name: str) -> str:
    """Why a leak on the path does not dismiss a finding: it lets out what this one is not about (rule S10)."""
    between = role == "leak" and hop < len(finding["steps"]) and name != finding["category"]
    return ", which is a finding of its own" if between else ""


def _step(step: Mapping[str, Any], before: Mapping[str, Any], to: Mapping[str, Any], folder: str) -> str:
    """One hop: what the policy allows, where, and what the data has become."""
    places = [f"{shown(_within(folder, grant['file']))}:{grant['line']}" for grant in step["policy"]]
    more = f" and {len(places) - 1} more" if len(places) > 1 else ""
    into_channel = to["kind"] in ("topic", "service", "action")
    verb = VERBS.get((step["role"], into_channel)) or OTHER_VERBS[step["role"]]
    what = f"{verb}  {places[0]}{more}" if places else verb
    changed = (step["category"], step["pseudonymised"]) != (before["category"], before["pseudonymised"])
    form = "pseudonymised " if step["pseudonymised"] else ""
    return f"{what}   now {form}{step['category']}" if changed else what


def _within(folder: str, file: str) -> str:
    """A file's name as seen from a folder; as it is where it lies elsewhere."""
    inside = file.removeprefix(folder.rstrip("/") + "/") if folder else file
    return inside or file


def _paths(finding: Mapping[str, Any]) -> Iterator[Line]:
    if finding["disjoint_paths"] > 1:
        yield f"   {finding['disjoint_paths']} paths that share no flow", ""
    for path in finding.get("paths", ()):
        yield "   path: " + " -> ".join(shown_name(element) for element in path), ""
    if finding.get("paths_bounded"):
        yield f"   … there are more paths; the bound is {len(finding['paths'])} (--max-paths)", "yellow"
