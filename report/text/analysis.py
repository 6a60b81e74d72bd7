"""Analysis -> a report for the terminal: verdict, findings hop by hop, what to review next, what was assumed.

In: a JSON document of the contract, so that no reader is told anything that another is not. Out: text; or lines on a
rich console, whose business colours are. Names come from anybody's files, so they are made printable.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ASSUMED, MERGED
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words
from rosprivacy.report.naming import count_rows, legs, names_shown, shown_name
from rosprivacy.report.observed_lines import observed_lines
from rosprivacy.report.review_groups import SHOWN
from rosprivacy.report.text.finding_lines import MANY, details, enforced_lines, overview
from rosprivacy.report.text.fleet import fleet_lines
from rosprivacy.report.text.law_lines import law_lines
from rosprivacy.report.text.line_parts import place, wrapped
from rosprivacy.report.text.review import doubt_lines, next_lines, review_lines
from rosprivacy.report.text.taken_away import (
    absent_lines,
    denied_lines,
    glob_lines,
    glob_warnings,
    hanging_lines,
    ledger_lines,
    overruled_lines,
    reliance_lines,
    standard_lines,
    taken_away_lines,
    type_lines,
)
from rosprivacy.report.verdict import ALL, asked_factors, asked_level, asked_types, verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rich.console import Console

    from rosprivacy.report.text.line_parts import Line

STYLES = {"leak": "bold red", "undetermined": "bold yellow", "no-leak-found": "bold green"}


def print_report(
    console: Console,
    report: Mapping[str, Any],
    words: Words = IN_ENGLISH,
    *,
    verbose: bool = False,
    quiet: bool = False,
    width: int | None = None,
) -> None:
    """Print a document.

    Parameters
    ----------
    words
        Of the reader's language; messages about files stay in English.
    verbose
        All open elements and notices.
    quiet
        The verdict only.
    width
        Of the terminal; None for a file or a pipe, where lines are not broken.
    """
    from rich.text import Text  # noqa: PLC0415 - only for a terminal

    for text, style in wrapped(_lines(report, words, verbose=verbose, quiet=quiet), width):
        console.print(Text(text, style), soft_wrap=True)


def report_text(
    report: Mapping[str, Any], words: Words = IN_ENGLISH, *, verbose: bool = False, quiet: bool = False
) -> str:
    """Return a document as text for a file or a pipe: ``print_report`` without colours and without broken lines."""
    return "".join(f"{text}\n" for text, _ in _lines(report, words, verbose=verbose, quiet=quiet))


def verdict_line(report: Mapping[str, Any], words: Words = IN_ENGLISH) -> Line:
    """Return the line that says the verdict, what it leaves open, and what was not asked for (rules S11, S12)."""
    accepted = any(finding["accepted"] for finding in report["findings"]) and report["verdict"] != "leak"
    return verdict_sentence(report, words), STYLES["undetermined" if accepted else report["verdict"]]


def _lines(report: Mapping[str, Any], words: Words, *, verbose: bool, quiet: bool) -> Iterator[Line]:
    yield verdict_line(report, words)
    if quiet:
        return
    most = None if verbose else SHOWN
    yield _summary(report, words), ""
    yield from fleet_lines(report, words)
    yield from _findings(report, words, verbose=verbose)
    yield from enforced_lines(report, words)
    yield from review_lines(report, words, verbose=verbose)
    yield from doubt_lines(report, most, words)
    yield from denied_lines(report, words, limit=most)
    yield from reliance_lines(report, words, verbose=verbose)
    if verbose:
        yield from ledger_lines(report, words)
        yield from glob_lines(report, words)
    yield from _assumed(report, words, most)
    yield from _diagnostics(report, words, verbose=verbose)
    yield "", ""
    yield verdict_line(report, words)
    yield from next_lines(report, words)


def _summary(report: Mapping[str, Any], words: Words) -> str:
    findings = [finding for finding in report["findings"] if not finding["dismissed"]]
    dismissed = len(report["findings"]) - len(findings)
    accepted = sum(finding["accepted"] for finding in findings)
    elements, flows = words.count(report["elements"], "element"), words.count(report["flows"], "flow")
    parts = [
        words.count(len(findings), "terminal.finding"),
        *([words("terminal.of.them.accepted", n=accepted)] if accepted else []),
        *([words("terminal.dismissed.more", n=dismissed)] if dismissed else []),
        _to_review(report, words),
        words("terminal.in.all", elements=elements, flows=flows),
    ]
    return ", ".join(parts)


def _to_review(report: Mapping[str, Any], words: Words) -> str:
    """How many elements are open, and how many where the legs of services and actions are counted by themselves."""
    count = count_rows(report["open"])
    return words("terminal.to.review", elements=words.count(count.elements, "element"), more=legs(count, words))


def _findings(report: Mapping[str, Any], words: Words, *, verbose: bool) -> Iterator[Line]:
    """Details of each finding; a list of one line each where there are many, and nobody asked for more."""
    yield from overview(report, words)
    if verbose or len(report["findings"]) <= MANY:
        yield from details(report, report["findings"], words)
    elif report["findings"]:
        yield "", ""
        yield words("terminal.details"), "dim"
    yield from law_lines(report, report["findings"], words)


def _assumed(report: Mapping[str, Any], words: Words, limit: int | None) -> Iterator[Line]:
    assumptions = report["assumptions"]
    yield "", ""
    yield words("terminal.assumed"), "bold"
    view = report["view"]
    yield f"   {words(f'terminal.view.{view}')}", ""
    yield from ((f"   {line}", "yellow") for line in observed_lines(report, words))
    yield from standard_lines(report, limit, words)
    yield from type_lines(report, limit, words)
    yield from taken_away_lines(report, words)
    yield from hanging_lines(report, limit, words)
    yield from glob_warnings(report, words)
    if "database" in assumptions:
        robots = words.count(assumptions["database"]["robots"], "robot")
        yield f"   {words('terminal.database', robots=robots)}", ""
    for kind in ("project", "fleet"):
        yield from _files(assumptions.get(kind, ()), kind, words)
    yield from _files(assumptions["labels"], "labels", words)
    if not assumptions["labels"]:
        yield f"   {words('terminal.no.labels')}", ""
    if "decisions" in assumptions:
        taken = assumptions["decisions"]
        date = words.date(taken["today"])
        yield (
            f"   {words('terminal.file.decisions', file=shown(taken['file']), sha=taken['sha256'][:12], date=date)}",
            "",
        )
        head = taken.get("head", "")
        yield f"   {words('terminal.decisions.head', head=head) if head else words('terminal.decisions.file')}", ""
    yield from _question(report, words)
    yield from _files(assumptions["ontologies"], "ontologies", words)
    yield f"   {words('terminal.law', date=words.date(assumptions['law_as_of']))}", ""
    yield from _assumed_outside(report, words)
    for taken in assumptions["sanitizers_without_method"]:
        yield (
            f"   {words('terminal.no.method', element=shown_name(taken['element']), kind=taken['category'])}",
            "yellow",
        )
    yield from absent_lines(report, words)
    yield from overruled_lines(report, words)
    yield f"   {words('terminal.word')}", "dim"


def _question(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """What the answer is restricted to (rule S11)."""
    assumed = report["assumptions"]
    if assumed["categories_asked"] != ALL:
        yield f"   {words('terminal.only.categories', kinds=', '.join(map(shown, assumed['categories_asked'])))}", ""
    if assumed["data_types_asked"] != ALL:
        yield f"   {words('terminal.only', what=asked_types(assumed, words))}", ""
    if "identity_factors_asked" in assumed:
        yield f"   {words('terminal.only.stated', what=asked_factors(assumed, words))}", ""
    if assumed["article9_only"]:
        yield f"   {words('terminal.only.known', what=asked_level(assumed, words))}", ""
    for category, kinds in assumed.get("may_be_asked", {}).items():
        yield f"   {words('terminal.also', kind=category, kinds=names_shown(kinds, words))}", ""


def _files(files: Iterable[Mapping[str, Any]], role: str, words: Words) -> Iterator[Line]:
    for file in files:
        yield f"   {words(f'terminal.file.{role}', file=shown(file['file']), sha=file['sha256'][:12])}", ""


def _assumed_outside(report: Mapping[str, Any], words: Words) -> Iterator[Line]:
    """What was taken of elements outside ROS (rule S9)."""
    assumptions = report["assumptions"]
    for kind, role in assumptions["taken_by_kind"].items():
        yield f"   {words(f'terminal.taken.{role}', kind=words.of_value(f'terminal.kind.of.{kind}', kind))}", ""
    if "countries_as_of" in assumptions:
        yield f"   {words('terminal.countries', date=words.date(assumptions['countries_as_of']))}", ""
    for row in report["outside"]:
        if "without_limit" in row:
            kinds = ", ".join(row["without_limit"])
            yield f"   {words('terminal.limit', element=shown_name(row['element']), kinds=kinds)}", "yellow"


def _diagnostics(report: Mapping[str, Any], words: Words, *, verbose: bool) -> Iterator[Line]:
    """Messages about files: they are in English, as other tools read them."""
    listed = {doubt["doubt"] for doubt in report["doubts"]}
    messages = [d for d in report["diagnostics"] if d.get("code") not in (*ASSUMED, *listed)]
    notices = [d for d in messages if d["severity"] == "notice" and d.get("code") != MERGED]
    for diagnostic in messages:
        if verbose or diagnostic not in notices:
            severity = words(f"severity.{diagnostic['severity']}")
            at = place(diagnostic) if diagnostic["line"] else shown(diagnostic["file"])
            yield f"{severity}: {at}: {diagnostic['message']}", "yellow"
    if notices and not verbose:
        yield words.count(len(notices), "terminal.notice"), "dim"
