"""``rosprivacy decide``: what is decided about findings, into the log of decisions."""

from __future__ import annotations

import os
import sys
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from rosprivacy.analysis.errors import DecisionError, InputErrors, shown
from rosprivacy.analysis.legal import LegalQuestion
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.analysis.written_names import is_glob
from rosprivacy.cli.inputs import takes_groups
from rosprivacy.cli.options import Ontologies, complete_category
from rosprivacy.cli.output import emit

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

PATTERN = "A pattern of findings"  # a panel of help
DOUBT = "A doubt"
TAKE_OVER = "rosprivacy decisions take-over"
SHORTEST = 4  # digits of an id, where the report says which are meant


class Decide(StrEnum):
    """What is decided."""

    accept = "accept"
    accept_on_condition = "accept-on-condition"
    mitigate = "mitigate"
    delegate = "delegate"
    avoid = "avoid"
    approve = "approve"
    reject = "reject"
    refer = "refer"
    confirm = "confirm"
    withdraw = "withdraw"


WRITTEN = {Decide.approve: Decide.accept, Decide.reject: Decide.mitigate, Decide.refer: Decide.delegate}
IN_A_LOG = (Decide.confirm, Decide.withdraw)  # both are about an earlier entry


class DecisionTarget(NamedTuple):
    """What is decided about, and in which file."""

    ids: Annotated[
        list[str] | None,
        typer.Argument(metavar="ID", help="Of findings; without one, a pattern.", show_default=False),
    ] = None
    decisions: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            show_default="decisions.jsonl",
            help="The log; made if it is not there. A decisions.yaml that is alone in the folder is written as before.",
        ),
    ] = None
    report: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            show_default=False,
            help="Of analyze --format json: ids are checked against it, and may be shortened.",
        ),
    ] = None


class DecisionFacts(NamedTuple):
    """What is said of the decision."""

    reason: Annotated[str | None, typer.Option(help="Why; an acceptance needs one.", show_default=False)] = None
    owner: Annotated[str | None, typer.Option(help="Who answers for it; the same.", show_default=False)] = None
    legal_basis: Annotated[
        list[str] | None,
        typer.Option(
            metavar="ARTICLE", help="Such as 6(1)(f), 9(2)(h), 46(2)(c); may be repeated.", show_default=False
        ),
    ] = None
    expires: Annotated[
        str | None, typer.Option(metavar="YYYY-MM-DD", help="The last day on which it is valid.", show_default=False)
    ] = None
    ticket: Annotated[str | None, typer.Option(help="Where the work is tracked.", show_default=False)] = None
    answer: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CODE=TEXT",
            help=f"To a legal question of the row: {', '.join(LegalQuestion)}; may be repeated.",
            show_default=False,
        ),
    ] = None
    condition: Annotated[
        str | None,
        typer.Option(help="What has to be so before accept-on-condition counts.", show_default=False),
    ] = None


class FindingPattern(NamedTuple):
    """Which findings are meant, where no id names them."""

    row: Annotated[
        str | None,
        typer.Option(
            metavar="ID",
            help="Of a row of the register: the findings that end there.",
            show_default=False,
            rich_help_panel=PATTERN,
        ),
    ] = None
    category: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            autocompletion=complete_category,
            help="Of a pattern: this category and narrower ones.",
            show_default=False,
            rich_help_panel=PATTERN,
        ),
    ] = None
    source: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Of a pattern: name or glob.", show_default=False, rich_help_panel=PATTERN),
    ] = None
    leak: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Of a pattern: name or glob.", show_default=False, rich_help_panel=PATTERN),
    ] = None
    robot: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Of a pattern or a row: robot of the leak, name or glob; names may be repeated.",
            show_default=False,
            rich_help_panel=PATTERN,
        ),
    ] = None
    from_robot: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Of a pattern: robot of the source; what goes from one robot to another needs it beside --robot.",
            show_default=False,
            rich_help_panel=PATTERN,
        ),
    ] = None


class DoubtPattern(NamedTuple):
    """Which doubts are meant."""

    doubt: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="Accept a sort of doubts, such as no-reader; needs --expires.",
            show_default=False,
            rich_help_panel=DOUBT,
        ),
    ] = None
    element: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Of an element: name or glob.", show_default=False, rich_help_panel=DOUBT),
    ] = None
    file: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Of a file: name or glob.", show_default=False, rich_help_panel=DOUBT),
    ] = None


@takes_groups
def decide(
    choice: Annotated[
        Decide,
        typer.Argument(
            metavar="DECISION",
            help="accept (or approve), accept-on-condition, mitigate (or reject), delegate (or refer), avoid; "
            "confirm a condition, or withdraw what was decided.",
        ),
    ],
    about: DecisionTarget,
    facts: DecisionFacts,
    findings_meant: FindingPattern,
    doubts_meant: DoubtPattern,
    ontology: Ontologies = None,
) -> None:
    """Decide about findings, a pattern of them, or doubts, in a file that analyze and mitigate take into account."""
    from rosprivacy.decision_record import parse_recorded, provenance, subject, with_recorded
    from rosprivacy.ingest.decisions.decision_log import is_log
    from rosprivacy.ingest.decisions.decision_writer import DOUBTS, FINDINGS, text_in
    from rosprivacy.ontology.vocabulary import load
    from rosprivacy.report.atomic import editing
    from rosprivacy.report.compare.earlier import read_earlier
    from rosprivacy.row_decision import check_foremost, made_about_row, row_target

    ids, decisions, report = about.ids, about.decisions or _default_log(), about.report
    choice = WRITTEN.get(choice, choice)
    pattern = _finding_pattern(findings_meant)
    in_doubt = {key: value for key, value in doubts_meant._asdict().items() if value}
    if in_doubt:
        pattern = _doubt_pattern(choice, in_doubt, pattern)
    _check_target(ids, pattern)
    _check_words(choice, facts, decisions)
    document = read_earlier(str(report)).document if report else None
    findings = _findings(document) if document else None
    doubts = _doubts(document) if document else {}
    row = _row(document, pattern["row"], str(report)) if document and "row" in pattern else None
    robots = pattern.pop("robots", ()) if row else ()
    pattern |= row_target(document, row, robots) if document and row else {}
    targets = _targets(ids, None if findings is None else findings | doubts, str(report)) if ids else [pattern]
    entry, vocabulary = _entry(choice, facts), load(ontologies=tuple(ontology or ()))
    names = "; ".join(", ".join(f"{key} {shown(str(value))}" for key, value in target.items()) for target in targets)
    answer = f"{shown(str(decisions))}: {choice.value} {names}\n"
    with editing(decisions):
        text, remarks = text_in(decisions), []
        for target in targets:
            finding = (findings or {}).get(target.get("id", ""))
            meant = [finding] if finding else _in_row(row, findings or {})
            rows = [row] if row else _rows_of(document or {}, meant)
            what = f"the acceptance of {target.get('id') or target.get('row', 'a pattern')}"
            remarks += [f"{what} {gap}" for gap in (*_gaps(choice, facts, meant), *_unanswered(choice, entry, rows))]
            made_about = made_about_row(document, row, robots) if document and row else _made_about(finding)
            whole = {**target, **entry, **({} if choice in IN_A_LOG else made_about)}
            section = DOUBTS if in_doubt or target.get("id") in doubts else FINDINGS
            remark = _remark(finding) or _doubt_remark(doubts.get(target.get("id", "")))
            facts_then = subject(document, finding=finding, row=row) if document and meant else None
            there = provenance(decisions.parent, facts_then)
            text = with_recorded(str(decisions), text, whole, remark, vocabulary, section, there)
            if row and choice not in IN_A_LOG:
                check_foremost(parse_recorded(str(decisions), text, vocabulary, ""), whole)
        if (ids or "row" in pattern) and not report:
            remarks.append("the ids were not checked; --report FILE checks them against an analysis")
        if not is_log(str(decisions)):
            remarks.append(f"{shown(str(decisions))} is no log, so that nobody sees who changes it: {TAKE_OVER}")
        print(*remarks, sep="\n", end="\n" if remarks else "", file=sys.stderr)  # before it is written
        emit(answer, None, {decisions: text or ""}, edited=decisions)  # the one file that is read and written


def _default_log() -> Path:
    """The log of the folder; a decisions file that nobody has taken over is what other commands are given."""
    log, former = Path("decisions.jsonl"), Path("decisions.yaml")
    return former if former.exists() and not log.exists() else log


def _gaps(choice: Decide, facts: DecisionFacts, findings: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """What an acceptance lacks, as far as the report tells what it is about."""
    from rosprivacy.ingest.reading.legal_basis import legal_basis
    from rosprivacy.report.finding_facts import gaps_of

    if choice not in (Decide.accept, Decide.accept_on_condition):
        return
    bases = [legal_basis(basis) or "" for basis in facts.legal_basis or ()]
    decision = {"legal_basis": bases, "expires": facts.expires}
    yield from map(str, gaps_of(decision, findings))


def _unanswered(choice: Decide, entry: Mapping[str, Any], rows: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """The legal questions of rows that an acceptance leaves open."""
    from rosprivacy.report.catalogs.words import Words
    from rosprivacy.report.page.to_confirm import question_key, unanswered

    if choice in (Decide.accept, Decide.accept_on_condition):
        for code in dict.fromkeys(code for row in rows for code in unanswered(row, entry.get("answers", ()))):
            yield f"leaves a question open: {Words('en')(question_key(code))} Answer with --answer {code}=TEXT"


def _rows_of(document: Mapping[str, Any], findings: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """The rows of the register of a report in which some findings end."""
    ids = {finding["id"] for finding in findings}
    return [row for row in document.get("register", ()) if ids.intersection(row["findings"])]


def _finding_pattern(options: FindingPattern) -> dict[str, Any]:
    """What a user names; several robots, and those of a row, are a list of names."""
    pattern = {key: value for key, value in options._asdict().items() if value}
    names = pattern.pop("robot", [])
    globs = [name for name in names if is_glob(name)]
    if len(names) > 1 and globs:
        raise typer.BadParameter(f"{globs[0]} is a glob: name robots, or one glob", param_hint="--robot")
    if len(names) > 1 or (names and "row" in pattern and not globs):
        return {**pattern, "robots": sorted(set(names))}
    return {**pattern, **({"robot": names[0]} if names else {})}


def _answers(written: Iterable[str]) -> dict[str, str]:
    """What a user answers, by the code of the question."""
    answers: dict[str, str] = {}
    for one in written:
        code, _, text = one.partition("=")
        if code not in set(LegalQuestion) or not text.strip():
            codes = ", ".join(LegalQuestion)
            raise typer.BadParameter(f"{one!r}: write CODE=TEXT with one of {codes}", param_hint="--answer")
        answers[code] = text.strip()
    return dict(sorted(answers.items()))


def _entry(choice: Decide, facts: DecisionFacts) -> dict[str, Any]:
    """What is written of a decision, whatever it is about."""
    from rosprivacy.clock import today

    entry = {
        "decision": choice.value,
        "reason": facts.reason,
        "answers": _answers(facts.answer or ()) or None,
        "condition": facts.condition,
        "owner": facts.owner,
        "legal_basis": list(facts.legal_basis) if facts.legal_basis else None,
        "date": date.fromisoformat(today(os.environ)),
        "expires": date.fromisoformat(facts.expires) if facts.expires else None,
        "ticket": facts.ticket,
    }
    return {key: value for key, value in entry.items() if value is not None}


def _doubt_pattern(choice: Decide, in_doubt: Mapping[str, str], pattern: Mapping[str, Any]) -> dict[str, Any]:
    """What an acceptance by the name of a doubt is about."""
    if "doubt" not in in_doubt:
        raise typer.BadParameter("--element and --file go with --doubt")
    if choice is not Decide.accept or pattern.keys() - {"robot"}:
        raise typer.BadParameter("--doubt is for accept, with --element, --file and --robot")
    return {**in_doubt, **pattern}


def _check_target(ids: list[str] | None, pattern: Mapping[str, Any]) -> None:
    if ids and pattern:
        raise typer.BadParameter("name findings by their ids, or a pattern of them, not both")
    if not ids and not pattern:
        raise typer.BadParameter("name an id, or a pattern: --row, --category, --source, --leak, --doubt")


def _check_words(choice: Decide, facts: DecisionFacts, decisions: Path) -> None:
    from rosprivacy.clock import today
    from rosprivacy.ingest.decisions.decision_log import is_log
    from rosprivacy.ingest.decisions.decisions_file import is_date

    expires = facts.expires
    if choice in IN_A_LOG and not is_log(str(decisions)):
        raise typer.BadParameter(f"{choice.value} is for a log: {TAKE_OVER} {shown(str(decisions))}")
    if facts.condition and choice is not Decide.accept_on_condition:
        raise typer.BadParameter("a condition goes with accept-on-condition", param_hint="--condition")

    if expires is not None and not is_date(expires):
        raise typer.BadParameter(f"{expires!r} is not a date: write YYYY-MM-DD", param_hint="--expires")
    if expires is not None and expires < today(os.environ):
        raise typer.BadParameter(f"{expires} is over: it would decide nothing", param_hint="--expires")


def _targets(ids: list[str], findings: dict[str, dict[str, Any]] | None, report: str) -> list[dict[str, Any]]:
    """The findings that are meant; without a report to look them up in, their ids have to be whole."""
    from rosprivacy.ingest.decisions.decisions_file import is_id

    if findings is not None:
        return [_chosen(findings, one, report) for one in ids]
    if short := [one for one in ids if not is_id(one)]:
        hint = "write its 16 digits and letters, or give --report, and its beginning will do"
        raise InputErrors([DecisionError("ID", 0, f"{shown(short[0])!r} is not the id of a finding", hint)])
    return [{"id": one} for one in ids]


def _findings(document: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The findings of a JSON report by id, those of a fleet by the ids of their patterns."""
    findings = {finding["id"]: {**finding, "view": document["view"]} for finding in document["findings"]}
    if "fleet" not in document:
        return findings
    robots = sorted({robot for alike in document["fleet"]["alike"] for robot in alike["robots"]})
    return {p["id"]: findings[p["finding"]] | _all_of(p, robots) for p in document["fleet"]["patterns"]}


def _doubts(document: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The doubts of a JSON report by id."""
    return {doubt["id"]: doubt for doubt in document.get("doubts", ())}


def _doubt_remark(doubt: Mapping[str, Any] | None) -> str:
    """What a person reads beside the id of a doubt."""
    if doubt is None:
        return ""
    return f"{doubt['doubt']}: {doubt['element']['name'] if doubt['element'] else doubt['file']}"


def _all_of(pattern: dict[str, Any], robots: list[str]) -> dict[str, Any]:
    """What holds for all findings of a pattern; what goes from one robot to another is about all of the fleet."""
    pseudonymised = pattern["pseudonymised"] == pattern["findings"]
    return {"pseudonymised": pseudonymised, "robots": robots if pattern["across"] else pattern["robots"]}


def _row(document: Mapping[str, Any], written: str, report: str) -> Mapping[str, Any]:
    """The row of the register that is meant by an id or its beginning; there has to be something to decide."""
    rows = {row["id"]: row for row in document.get("register", ()) if row["findings"]}
    names = {one: {one, row.get("fleet", {}).get("pattern", one)} for one, row in rows.items()}
    fitting = [one for one in rows if any(name.startswith(written) for name in names[one])]
    fitting = fitting if len(written) >= SHORTEST else []
    if len(fitting) != 1:
        which = f"begins {len(fitting)} ids of rows" if fitting else "is no row in which a finding ends"
        hint = f"copy one: {', '.join(list(rows)[:5])}" if rows else "the report has no finding"
        raise InputErrors([DecisionError(report, 0, f"{shown(written)!r} {which} of the report", hint)])
    return dict(rows[fitting[0]])


def _in_row(row: Mapping[str, Any] | None, findings: Mapping[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """The findings of a report that end in a row."""
    return [finding for finding in findings.values() if finding["id"] in row["findings"]] if row else []


def _made_about(finding: Mapping[str, Any] | None) -> dict[str, Any]:
    """What is there now, for later runs to compare to; nothing of a pattern by names, or without a report."""
    from rosprivacy.analysis.remembered import About, as_written

    if finding is None:
        return {}
    path = tuple(element["name"] for element in finding["witness"])
    robots = frozenset(finding.get("robots", ()))
    return {"made_about": as_written(About(finding["view"], path, finding["disjoint_paths"] or 0, robots))}


def _chosen(findings: dict[str, dict[str, Any]], written: str, report: str) -> dict[str, Any]:
    """The finding that is meant by an id or its beginning."""
    fitting = [one for one in findings if one.startswith(written)] if len(written) >= SHORTEST else []
    if len(fitting) != 1:
        which = f"begins {len(fitting)} ids" if fitting else "is no finding and no doubt"
        hint = f"copy one: {', '.join(list(findings)[:5])}" if findings else "the report has no finding"
        raise InputErrors([DecisionError(report, 0, f"{shown(written)!r} {which} of the report", hint)])
    (one,) = fitting
    return {"id": one, **({"pseudonymised": True} if findings[one].get("pseudonymised") is True else {})}


def _remark(finding: Mapping[str, Any] | None) -> str:
    """What a person reads beside an id."""
    if finding is None:
        return ""
    return f"{finding['category']}: {finding['source']['name']} -> {finding['leak']['name']}"
