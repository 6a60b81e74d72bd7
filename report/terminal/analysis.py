"""Analysis -> a report for the terminal: verdict, findings hop by hop, what to review next, what was assumed.

In: a JSON document of the contract, so that no reader is told anything that another is not. Out: lines on a rich
console; colours are the console's business. Names come from anybody's files, so they are made printable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.text import Text

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import MERGED
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.report.document.analysis import files_not_read
from rosprivacy.report.document.decisions import decision_lines
from rosprivacy.report.naming import key, kind_of, shown_name
from rosprivacy.report.terminal.denied import denied_lines
from rosprivacy.report.terminal.fleet import fleet_lines, robots_of
from rosprivacy.report.terminal.globs import glob_lines, glob_warnings
from rosprivacy.report.terminal.labels import absent_lines, overruled_lines, standard_lines
from rosprivacy.report.terminal.ledger import ledger_lines, taken_away_lines
from rosprivacy.report.terminal.next_step import next_lines
from rosprivacy.report.terminal.restriction import asked_at_verdict, asked_lines, may_be_asked
from rosprivacy.report.terminal.review import SHOWN, review_lines
from rosprivacy.report.terminal.unknown_ends import end_lines, ends_at_verdict

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rich.console import Console

VERDICTS = {
    "leak": ("bold red", "data can reach a leak"),
    "undetermined": ("bold yellow", "no leak reached, but not everything on the way is reviewed"),
    "no-leak-found": ("bold green", "no way to a leak, everything on the way is reviewed"),
}
ACCEPTED = {  # the same where a decision accepts a finding
    "undetermined": "no leak reached but what is accepted, and not everything on the way is reviewed",
    "no-leak-found": "no way to a leak but what is accepted, everything on the way is reviewed",
}
VERBS = {
    "publish": "publishes", "subscribe": "is read by", "request": "request", "reply": "reply",
    "call": "call", "execute": "execute", "matches": "wildcard covers", "flow": "goes to",
}  # fmt: skip
MAY = {"always": "applies", "conditional": "can apply", "may-reveal": "may be revealed"}  # to the data, not the system
KINDS = {
    "disclosure": "",
    "storage-limitation": "kept without a stated end, or too long: ",
    "third-country-transfer": "leaves the EEA without a stated basis: ",
}
TAKEN = {"conduit": "passes on all that gets there", "leak": "lets out all that gets there"}
UNREAD = "no leak reached, but policy files with grants were not read"
Line = tuple[str, str]  # text, style


def print_report(console: Console, report: Mapping[str, Any], *, verbose: bool = False, quiet: bool = False) -> None:
    """Print a document.

    Parameters
    ----------
    verbose
        All open elements and notices.
    quiet
        The verdict only.
    """
    for text, style in _lines(report, verbose=verbose, quiet=quiet):
        console.print(Text(text, style), soft_wrap=True)


def verdict_line(report: Mapping[str, Any]) -> Line:
    """Return the line that says the verdict, what it leaves open, and what was not asked for (rules S11, S12)."""
    style, meaning = VERDICTS[report["verdict"]]
    if not any(report["categories"]) or (report["verdict"] == "undetermined" and not report["open"]):
        meaning = UNREAD if files_not_read(report) and any(report["categories"]) else "no data was followed"
    accepted = sum(finding["accepted"] for finding in report["findings"])
    if accepted and report["verdict"] != "leak":
        style, meaning = "bold yellow", ACCEPTED[report["verdict"]]
    meaning += f"; {counted(accepted, 'finding')} accepted" if accepted else ""
    meaning += "".join(f"; {end}" for end in ends_at_verdict(report)) + asked_at_verdict(report)
    return f"{report['verdict']}: {meaning}", style


def _lines(report: Mapping[str, Any], *, verbose: bool, quiet: bool) -> Iterator[Line]:
    yield verdict_line(report)
    if quiet:
        return
    yield _summary(report), ""
    yield from fleet_lines(report)
    yield from _findings(report)
    yield from review_lines(report, verbose=verbose)
    yield from end_lines(report, most=None if verbose else SHOWN)
    yield from denied_lines(report, most=None if verbose else SHOWN)
    if verbose:
        yield from ledger_lines(report)
        yield from glob_lines(report)
    yield from _assumed(report, verbose=verbose)
    yield from _diagnostics(report, verbose=verbose)
    yield from next_lines(report)


def _summary(report: Mapping[str, Any]) -> str:
    findings = [finding for finding in report["findings"] if not finding["dismissed"]]
    dismissed = len(report["findings"]) - len(findings)
    accepted = sum(finding["accepted"] for finding in findings)
    parts = [
        counted(len(findings), "finding"),
        *([f"{accepted} of them accepted"] if accepted else []),
        *([f"{dismissed} more only through another leak"] if dismissed else []),
        f"{counted(len(report['open']), 'element')} to review",
        f"{counted(report['elements'], 'element')} and {counted(report['flows'], 'flow')} in all",
    ]
    return ", ".join(parts)


def _findings(report: Mapping[str, Any]) -> Iterator[Line]:
    roles = {(key(said["element"]), said["category"]): said["roles"] for said in report["roles"]}
    unreviewed = {(key(question["element"]), name) for question in report["open"] for name in question["categories"]}
    for number, finding in enumerate(report["findings"], 1):
        source, leak = finding["source"], finding["leak"]
        form = "pseudonymised " if finding["pseudonymised"] else ""
        style = "dim" if finding["dismissed"] or finding["accepted"] else "bold"
        yield "", ""
        what = f"{KINDS[finding['kind']]}{form}{finding['category']}{may_be_asked(report, finding['category'])}"
        yield f"{number}. {what}: {shown_name(source)} -> {shown_name(leak)}   [{finding['id']}]", style
        yield from robots_of(report, finding)
        if "reason" in finding:
            yield f"   {shown(finding['reason'])}", ""
        if finding["dismissed"]:
            through = ", ".join(shown_name(element) for element in finding["through"])
            past = "; past it, data gets there pseudonymised only" if finding.get("beside_pseudonymised") else ""
            yield f"   only through {through}, which has a finding of its own{past}", "dim"
        yield from decision_lines(finding)
        yield from _way(finding, roles, unreviewed)
        yield from _paths(finding)
        yield from _law(finding, report)


def _way(finding: Mapping[str, Any], roles: Mapping[Any, Any], unreviewed: Collection[Any]) -> Iterator[Line]:
    """The witness, hop by hop: element, what labels say of it, policy line."""
    witness, steps = finding["witness"], finding["steps"]
    data = [step["category"] for step in steps]
    for hop, element in enumerate(witness):
        # what is there: the data that arrives, at the source the data that leaves, at the leak what gets out too
        here = dict.fromkeys([*data[max(hop - 1, 0) : hop or 1], *([] if hop < len(steps) else [finding["category"]])])
        said = [(name, role) for name in here for role in roles.get((key(element), name), ())]
        notes = [f"{role} of {name}" for name, role in said]
        notes += ["not reviewed" for name in here if (key(element), name) in unreviewed]
        style = "red" if any(role == "leak" for _, role in said) else ""
        yield f"   {shown_name(element)}  ({', '.join([kind_of(element), *notes])})", style
        if hop < len(steps):
            before = steps[hop - 1] if hop else steps[hop]
            yield f"     | {_step(steps[hop], before)}", "dim"


def _step(step: Mapping[str, Any], before: Mapping[str, Any]) -> str:
    """One hop: what the policy allows, where, and what the data has become."""
    places = [f"{shown(grant['file'])}:{grant['line']}" for grant in step["policy"]]
    more = f" and {len(places) - 1} more" if len(places) > 1 else ""
    what = f"{VERBS[step['role']]}  {places[0]}{more}" if places else VERBS[step["role"]]
    changed = (step["category"], step["pseudonymised"]) != (before["category"], before["pseudonymised"])
    form = "pseudonymised " if step["pseudonymised"] else ""
    return f"{what}   now {form}{step['category']}" if changed else what


def _paths(finding: Mapping[str, Any]) -> Iterator[Line]:
    if finding["disjoint_paths"] > 1:
        yield f"   {finding['disjoint_paths']} ways that share no flow", ""
    for path in finding.get("paths", ()):
        yield "   way: " + " -> ".join(shown_name(element) for element in path), ""
    if finding.get("paths_bounded"):
        yield f"   … there are more ways; the bound is {len(finding['paths'])} (--max-paths)", "yellow"


def _law(finding: Mapping[str, Any], report: Mapping[str, Any]) -> Iterator[Line]:
    """What a person has to look up about the data that arrives; where it became what it is."""
    if finding["special_from"]:
        yield f"   {shown_name(finding['special_from'])} makes such data of other data", ""
    for legal in finding["law"]:
        condition = f": {blanked(legal['condition'])}" if legal["condition"] else ""
        yield f"   {shown(legal['provision'])}, {MAY[legal['verdict']]}{condition}", "magenta"
    if finding["article9"] == "unknown":
        yield "   the ontology does not say whether Article 9 GDPR applies to such data", "yellow"
    if finding["article9"] == "no":
        reasons = {category["name"]: category["reason"] for category in report["categories"]}
        yield f"   not Article 9 GDPR by itself: {blanked(reasons.get(finding['category'], ''))}", "dim"


def _assumed(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    assumptions = report["assumptions"]
    yield "", ""
    yield "Assumed", "bold"
    view = {"declared": "each node does what its own profile says", "enforced": "each node may do what its enclave may"}
    yield f"   view {report['view']}: {view[report['view']]}", ""
    yield from standard_lines(report, None if verbose else SHOWN)
    yield from taken_away_lines(report)
    yield from glob_warnings(report)
    if "database" in assumptions:
        robots = counted(assumptions["database"]["robots"], "robot")
        yield f"   {robots} in the database, as loaded from these files and changed there since", ""
    for file in assumptions.get("fleet", ()):
        yield f"   fleet {shown(file['file'])} (sha256 {file['sha256'][:12]})", ""
    for file in assumptions["labels"]:
        yield f"   labels {shown(file['file'])} (sha256 {file['sha256'][:12]})", ""
    if not assumptions["labels"]:
        yield "   no labels", ""
    if "decisions" in assumptions:
        taken = assumptions["decisions"]
        yield f"   decisions {shown(taken['file'])} (sha256 {taken['sha256'][:12]}), as of {taken['today']}", ""
    yield from asked_lines(report)
    for file in assumptions["ontologies"]:
        yield f"   more categories of {shown(file['file'])} (sha256 {file['sha256'][:12]})", ""
    yield f"   law as of {assumptions['law_as_of']}", ""
    yield from _assumed_outside(report)
    for taken in assumptions["sanitizers_without_method"]:
        method = f"sanitizer {shown_name(taken['element'])} states no method for {taken['category']}"
        yield f"   {method}: taken as pseudonymise, the data is still personal", "yellow"
    yield from absent_lines(report)
    yield from overruled_lines(report)
    yield "   labels are a person's word; this is no legal verdict", "dim"


def _assumed_outside(report: Mapping[str, Any]) -> Iterator[Line]:
    """What was taken of elements outside ROS (rule S9)."""
    assumptions = report["assumptions"]
    for kind, role in assumptions["taken_by_kind"].items():
        yield f"   {kind}: {TAKEN[role]} ({role}), unless a label says otherwise", ""
    if taken := assumptions["backups_taken_as_none"]:
        yield f"   backups are not stated, taken to have none: {', '.join(map(shown_name, taken))}", "yellow"
    if "countries_as_of" in assumptions:
        yield f"   EEA and adequacy decisions as of {assumptions['countries_as_of']}: check them", ""
    for row in report["outside"]:
        if "without_limit" in row:
            what = f"how long {shown_name(row['element'])} keeps {', '.join(row['without_limit'])} was not judged"
            yield f"   {what}: no label file states a limit", "yellow"


def _diagnostics(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    notices = [d for d in report["diagnostics"] if d["severity"] == "notice" and d.get("code") != MERGED]
    for diagnostic in report["diagnostics"]:
        if verbose or diagnostic not in notices:
            line = f":{diagnostic['line']}" if diagnostic["line"] else ""
            place = f"{shown(diagnostic['file'])}{line}"
            yield f"{diagnostic['severity']}: {place}: {diagnostic['message']}", "yellow"
    if notices and not verbose:
        yield f"{counted(len(notices), 'notice')} (-v shows them)", "dim"
