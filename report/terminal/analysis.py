"""Analysis -> a report for the terminal: verdict, findings hop by hop, what to review next, what was assumed.

In: a JSON document of the contract, so that no reader is told anything that another is not. Out: lines on a rich
console; colours are the console's business. Names come from anybody's files, so they are made printable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.text import Text

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import GOES_NOWHERE, MERGED, NO_LEAK_NAMED
from rosprivacy.analysis.text import counted
from rosprivacy.report.document.analysis import files_not_read, lacking
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.naming import shown_name
from rosprivacy.report.review_groups import SHOWN
from rosprivacy.report.terminal.denied import denied_lines
from rosprivacy.report.terminal.finding_lines import MANY, details, law_lines, overview
from rosprivacy.report.terminal.fleet import fleet_lines
from rosprivacy.report.terminal.globs import glob_lines, glob_warnings
from rosprivacy.report.terminal.labels import absent_lines, overruled_lines, standard_lines
from rosprivacy.report.terminal.ledger import hanging_lines, ledger_lines, taken_away_lines
from rosprivacy.report.terminal.next_step import next_lines
from rosprivacy.report.terminal.reliance import reliance_lines
from rosprivacy.report.terminal.restriction import asked_at_verdict, asked_lines
from rosprivacy.report.terminal.review import review_lines
from rosprivacy.report.terminal.unknown_ends import end_lines, ends_at_verdict
from rosprivacy.report.terminal.wrapped import wrapped

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

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
TAKEN = {"conduit": "passes on all that gets there", "leak": "lets out all that gets there"}
UNREAD = "no leak reached, but policy files with grants were not read"
LACKING = {
    GOES_NOWHERE: "no data was followed, it goes nowhere but to standard channels",
    NO_LEAK_NAMED: "no label says where data gets out, so nothing that it gets to could be a leak",
    "": "no data was followed",
}
Line = tuple[str, str]  # text, style


def print_report(
    console: Console, report: Mapping[str, Any], *, verbose: bool = False, quiet: bool = False, width: int | None = None
) -> None:
    """Print a document.

    Parameters
    ----------
    verbose
        All open elements and notices.
    quiet
        The verdict only.
    width
        Of the terminal; None for a file or a pipe, where lines are not broken.
    """
    for text, style in wrapped(_lines(report, verbose=verbose, quiet=quiet), width):
        console.print(Text(text, style), soft_wrap=True)


def verdict_line(report: Mapping[str, Any]) -> Line:
    """Return the line that says the verdict, what it leaves open, and what was not asked for (rules S11, S12)."""
    style, meaning = VERDICTS[report["verdict"]]
    if not any(report["categories"]) or (report["verdict"] == "undetermined" and not report["open"]):
        meaning = UNREAD if files_not_read(report) and any(report["categories"]) else LACKING[lacking(report)]
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
    yield from _findings(report, verbose=verbose)
    yield from review_lines(report, verbose=verbose)
    yield from end_lines(report, most=None if verbose else SHOWN)
    yield from denied_lines(report, most=None if verbose else SHOWN)
    yield from reliance_lines(report, verbose=verbose)
    if verbose:
        yield from ledger_lines(report)
        yield from glob_lines(report)
    yield from _assumed(report, verbose=verbose)
    yield from _diagnostics(report, verbose=verbose)
    yield "", ""
    yield verdict_line(report)
    yield from next_lines(report)


def _summary(report: Mapping[str, Any]) -> str:
    findings = [finding for finding in report["findings"] if not finding["dismissed"]]
    dismissed = len(report["findings"]) - len(findings)
    accepted = sum(finding["accepted"] for finding in findings)
    parts = [
        counted(len(findings), "finding"),
        *([f"{accepted} of them accepted"] if accepted else []),
        *([f"{dismissed} more only through another leak"] if dismissed else []),
        _to_review(report),
        f"{counted(report['elements'], 'element')} and {counted(report['flows'], 'flow')} in all",
    ]
    return ", ".join(parts)


def _to_review(report: Mapping[str, Any]) -> str:
    """How many elements are open, and how many where the legs of services and actions are counted by themselves."""
    count = count_rows(report["open"])
    return f"{counted(count.elements, 'element')} to review{count.more}"


def _findings(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    """Details of each finding; a list of one line each where there are many, and nobody asked for more."""
    yield from overview(report)
    if verbose or len(report["findings"]) <= MANY:
        yield from details(report, report["findings"])
    elif report["findings"]:
        yield "", ""
        yield "Details of one: rosprivacy show ID, with the same policies and labels; of all: -v", "dim"
    yield from law_lines(report, report["findings"])


def _assumed(report: Mapping[str, Any], *, verbose: bool) -> Iterator[Line]:
    assumptions = report["assumptions"]
    yield "", ""
    yield "Assumed", "bold"
    view = {"declared": "each node does what its own profile says", "enforced": "each node may do what its enclave may"}
    yield f"   view {report['view']}: {view[report['view']]}", ""
    yield from standard_lines(report, None if verbose else SHOWN)
    yield from taken_away_lines(report)
    yield from hanging_lines(report, None if verbose else SHOWN)
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
