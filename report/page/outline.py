"""A JSON document -> everything that a report for people tells, in its order; HTML and Markdown write it down.

In: a document of the contract, a language, and an earlier document to compare with. Out: an ``Outline`` of plain
texts. What the documents do not say, no report says.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import SPECIAL
from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.compare.changes import QUESTION_KEYS, Changes, changes
from rosprivacy.report.document.ledger import by_globs
from rosprivacy.report.element_counts import count_rows
from rosprivacy.report.finding_order import REVEALS, strength
from rosprivacy.report.naming import name
from rosprivacy.report.page import assumed, elements, rights, sanitizers, tables
from rosprivacy.report.page.assessment import Assessment, assessment
from rosprivacy.report.page.assessment_file import Answers
from rosprivacy.report.page.beyond_entries import BeyondEntry, beyond_entries, beyond_said
from rosprivacy.report.page.closing import ClosingEntry, closing
from rosprivacy.report.page.criteria import AssessmentCriterion, criteria
from rosprivacy.report.page.decision_texts import DecisionText, orphans
from rosprivacy.report.page.doubts import Sort, doubts, in_doubt
from rosprivacy.report.page.entries_of_robots import grouped
from rosprivacy.report.page.finding_entries import Entry, finding_entries
from rosprivacy.report.page.fleet_section import FleetSection, fleet_told
from rosprivacy.report.page.index import Index, state
from rosprivacy.report.page.kinds import KindEntry, kinds
from rosprivacy.report.page.look_at import LookAt, at_work, further, national
from rosprivacy.report.page.non_ros import Outside, outside
from rosprivacy.report.page.opening import OpeningSection, flows, opening
from rosprivacy.report.page.purposes import PurposeRow, processed, signed
from rosprivacy.report.page.reliance import Hanging, hanging
from rosprivacy.report.page.review import Group, review
from rosprivacy.report.page.typed_channels import Typed, only_by_types, typed
from rosprivacy.report.verdict import verdict_meaning, verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.report.compare.earlier import Earlier


DECIDE = "decide"  # its heading is what there is to decide
SECTIONS = (
    DECIDE, "closing", "hangs", "changes", "fleet", "findings", "beyond", "doubts", "questions", "tables", "rights",
    "outside", "sanitizers", "types", "risks", "criteria", "sign", "kinds", "assumptions", "inventory", "method",
)  # fmt: skip
SHOWN_AT_MOST = 3  # robots or policies in the title
PARAGRAPHS = 10  # of the method note
EXPLAINED = ("profile", "enclave", "label", "wildcard", "request")  # before they first come, beside the view


@dataclass(frozen=True, slots=True)
class Changed:
    """What changed, in words.

    Attributes
    ----------
    sentences
        Verdict, files, kinds of data.
    scope
        What was asked or assumed otherwise.
    new, changed
        Entries; of a changed one also what changed.
    removed
        (kind of data, ends, id) as they were.
    """

    intro: str
    sentences: tuple[str, ...]
    scope: tuple[str, ...]
    new: tuple[Entry, ...]
    changed: tuple[tuple[Entry, str], ...]
    removed: tuple[tuple[str, str, str], ...]
    opened: tuple[str, ...]
    closed: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Outline:
    """The whole report.

    Attributes
    ----------
    title
        Of the system, as the user calls it, or the names of its policies.
    date
        Date; empty if none is to be told.
    sections
        (anchor, heading), in order.
    verdict
        Of the contract; or what it lacks, as ``verdict_meaning`` says.
    sentence
        The verdict with its doubts, as all outputs say it.
    opening
        What it begins with: what is to be decided.
    closing
        What closes these paths; None where there are none.
    numbers
        (number, what it counts).
    glossary
        (word, what it means), of words that come before the section on the method.
    """

    words: Words
    title: str
    date: str
    version: str
    law: str
    redacted: bool
    sections: tuple[tuple[str, str], ...]
    code: str
    verdict: str
    sentence: str
    opening: OpeningSection
    closing: ClosingEntry | None
    means: tuple[str, ...]
    numbers: tuple[tuple[int, str], ...]
    glossary: tuple[tuple[str, str], ...]
    assumptions: tuple[str, ...]
    files: tuple[assumed.File, ...]
    remarks: tuple[assumed.Remark, ...]
    closed: tuple[ClosedSection, ...]
    fleet: FleetSection | None
    changes: Changed | None
    subjects: tables.PageTable
    silent: tuple[str, ...]
    recipients: tables.PageTable
    processed: tuple[PurposeRow, ...]
    kinds: tuple[KindEntry, ...]
    entries: tuple[Entry, ...]
    beyond: tuple[BeyondEntry, ...]
    beyond_said: tuple[str, ...]
    orphans: tuple[DecisionText, ...]
    hanging: tuple[Hanging, ...] | None
    look_at: tuple[tuple[str, tuple[LookAt, ...]], ...]
    contexts: tuple[str, ...]
    at_work: tuple[LookAt, ...]
    national: tuple[str, ...]
    outside: tuple[Outside, ...]
    cleanings: tuple[sanitizers.CleaningEntry, ...]
    makings: tuple[sanitizers.MakingEntry, ...]
    typed: tuple[Typed, ...]
    only_by_types: tuple[tuple[str, str], ...]
    questions: tuple[Group, ...]
    doubts: tuple[Sort, ...]
    criteria: tuple[AssessmentCriterion, ...]
    rights: tuple[rights.Persons, ...]
    assessment: Assessment
    size: str
    denied: str
    items: tuple[elements.ElementItem, ...]
    rest: tuple[tuple[str, tuple[str, ...]], ...]
    enclaves: tuple[elements.Enclave, ...]

    def number(self, section: str) -> int:
        """Return the number of a section."""
        return [anchor for anchor, _ in self.sections].index(section) + 1


def outline(
    document: Mapping[str, Any],
    language: str,
    *,
    title: str = "",
    date: str = "",
    earlier: Earlier | None = None,
    redacted: bool = False,
    proposals: Mapping[str, Any] | str = "graph",
    answers: Answers | None = None,
) -> Outline:
    """Return the outline of a report.

    Parameters
    ----------
    language
        ``en``, ``de`` or ``fr``.
    title
        Of the system; by default the names of its policy files.
    date
        The date that the report tells, ``YYYY-MM-DD``; empty for none.
    redacted
        Whether names were replaced in the documents; the report then says so.
    proposals
        A mitigation document of the same system, or why there is none, see ``closing``.
    answers
        Of the person who assesses, as an earlier report saved them.

    Complexity: O(size of the documents), but for the cells of the tables: recipients x categories.
    """
    index = Index(document, Words(language))
    words = index.words
    differ = changes(earlier.document, document) if earlier else None
    entries = finding_entries(index, differ.marks() if differ else None)
    verdict = verdict_meaning(document)
    decided = flows(index, entries)
    begins = opening(index, decided, words(f"verdict.{verdict}"), _told_of(verdict, index), tuple(in_doubt(index)))
    links = tables.TableLinks(entries)
    subjects, silent = tables.subjects(index, links)
    closes = closing(index, entries, proposals)
    of_types = bool(document.get("types"))
    there = {
        "closing": bool(closes),
        "changes": bool(differ),
        "fleet": bool(index.alike),
        "types": of_types,
        "beyond": "enforced" in document,
        "doubts": bool(document.get("doubts")),
    }
    names = [name for name in SECTIONS if there.get(name, True)]
    return Outline(
        words=words,
        title=fit(title) if title else _title(index),
        date=words.date(date),
        version=document["assumptions"]["rosprivacy"],
        law=_law(document["assumptions"], words),
        redacted=redacted,
        sections=tuple(
            (anchor, begins.headline if anchor == DECIDE else words(f"heading.{anchor}")) for anchor in names
        ),
        code=document["verdict"],
        verdict=verdict,
        sentence=verdict_sentence(document, words),
        opening=begins,
        closing=closes,
        means=tuple(_means(index, names, sum(not entry.detailed for entry in entries))),
        numbers=tuple(_numbers(index)),
        glossary=tuple(
            (words(f"glossary.{word}"), words(f"glossary.{word}.means")) for word in (document["view"], *EXPLAINED)
        ),
        assumptions=tuple(assumed.assumed(index)),
        files=assumed.files(index),
        remarks=assumed.remarks(index),
        closed=closed(index),
        fleet=fleet_told(index, entries),
        changes=_changed(differ, earlier, entries, index) if differ and earlier else None,
        subjects=subjects,
        silent=silent,
        recipients=tables.recipients(index, links),
        processed=processed(index),
        kinds=kinds(index, entries),
        entries=entries,
        beyond=beyond_entries(index),
        beyond_said=beyond_said(index),
        orphans=orphans(index),
        hanging=hanging(index),
        look_at=further(index),
        contexts=tuple(context["name"] for context in document.get("contexts", ())),
        at_work=at_work(index),
        national=national(index),
        outside=outside(index),
        cleanings=sanitizers.cleanings(index, entries),
        makings=sanitizers.makings(index),
        typed=typed(index),
        only_by_types=only_by_types(index),
        questions=review(index),
        doubts=doubts(index),
        criteria=criteria(index),
        rights=rights.rights(index),
        assessment=assessment(words, decided, answers or Answers(), signed(index)),
        size=words(
            "inventory.intro",
            elements=words.count(document["elements"], "element"),
            flows=words.count(document["flows"], "flow"),
        ),
        denied=words("inventory.denied", flows=words.count(document["denied_flows"], "flow"))
        if document["denied_flows"]
        else "",
        items=elements.items(index),
        rest=elements.unreached_names(index),
        enclaves=elements.enclaves(index),
    )


def _title(index: Index) -> str:
    robots = [] if index.alike else index.robots()
    said = index.document["assumptions"]["fleet" if index.alike else "policies"]
    names = robots or list(dict.fromkeys(entry["file"].rsplit("/", 1)[-1] for entry in said))
    return title_of(names, index.words)


def title_of(names: Sequence[str], words: Words) -> str:
    """Return what a report is called by the names of its robots or policies; empty without any."""
    return words.row(words.first([fit(name) for name in names], SHOWN_AT_MOST))


def _law(assumptions: Mapping[str, Any], words: Words) -> str:
    """As of when the law is told, the adequacy decisions of chapter V too where a country is stated."""
    said = [words("law.date", date=words.date(assumptions["law_as_of"]))]
    if "countries_as_of" in assumptions:
        said.append(words("law.countries", date=words.date(assumptions["countries_as_of"])))
    return "; ".join(said)


def _told_of(verdict: str, index: Index) -> str:
    """What a verdict means."""
    words = index.words
    return words(f"verdict.{verdict}.means", open=words.count(count_rows(index.document["open"]).elements, "element"))


def _means(index: Index, sections: list[str], remaining: int) -> Iterator[str]:
    """What else is to be known of the result: what to ask of each path, and which are not to be decided now."""
    words = index.words
    if index.to_assess:
        yield words("opening.each")
    dismissed = sum(state(finding) == "dismissed" for finding in index.findings)
    if dismissed:
        yield words("opening.dismissed", ways=words.count(dismissed, "way"))
    accepted = sum(bool(finding.get("accepted")) for finding in index.findings)
    if accepted:
        yield words("verdict.accepted", ways=words.count(accepted, "way"), section=sections.index("findings") + 1)
    if remaining:
        yield words.count(remaining, "entry.left")
    yield words("not.legal")


def _numbers(index: Index) -> Iterator[tuple[int, str]]:
    words, to_assess = index.words, index.to_assess
    if index.alike:
        yield len(index.robots()), words("total.robots")
    yield len(to_assess), words("total.ways")
    strengths = Counter(map(strength, to_assess))
    yield strengths[SPECIAL], words("total.special")
    yield strengths[REVEALS], words("total.reveals")
    yield len({tuple(finding["leak"].items()) for finding in to_assess}), words("total.recipients")
    yield count_rows(index.document["open"]).elements, words("total.open")
    if globbed := count_rows(by_globs(index.document)).elements:
        yield globbed, words("total.glob")
    for what in ("accepted", "dismissed"):
        number = sum(bool(finding.get(what)) for finding in index.findings)
        if number:
            yield number, words(f"total.{what}")


def _changed(differ: Changes, earlier: Earlier, entries: tuple[Entry, ...], index: Index) -> Changed:
    words = index.words
    of_finding = {finding: entry for entry in entries for finding in (entry.id, *entry.alike)}
    old = Index(earlier.document, words)
    by_entry: dict[Entry, list[str]] = {}
    for finding, what in differ.changed.items():
        by_entry.setdefault(of_finding[finding], []).extend(what)
    return Changed(
        intro=words("changes.intro", file=fit(earlier.file), sha=earlier.sha256[:12]),
        sentences=tuple(_sentences(differ, index, old)),
        scope=tuple(_scope(differ, words)),
        new=tuple(dict.fromkeys(of_finding[finding] for finding in differ.new)),
        changed=tuple(
            (entry, words.row(words(f"changes.what.{w}") for w in dict.fromkeys(what)))
            for entry, what in by_entry.items()
        ),
        removed=tuple(
            (
                old.data(f["category"], pseudonymised=f["pseudonymised"]),
                words("entry.from.to", source=name(f["source"]), leak=name(f["leak"])),
                f["id"],
            )
            for f in differ.removed
        ),
        opened=index.names(differ.opened),
        closed=old.names(differ.closed),
    )


def _sentences(differ: Changes, index: Index, old: Index) -> Iterator[str]:
    """What changed on the whole: the verdict, the files, the kinds of data."""
    words = index.words
    same = "changes.verdict.same" if differ.before == differ.now else "changes.verdict"
    yield words(same, before=differ.before, now=differ.now)
    if differ.nothing:
        yield words("changes.none")
    yield (
        words("changes.files", names=words.row(map(fit, differ.files))) if differ.files else words("changes.files.same")
    )
    if differ.kinds_new:
        yield words("changes.kinds.new", names=index.all_data(differ.kinds_new))
    if differ.kinds_gone:
        yield words("changes.kinds.gone", names=old.all_data(differ.kinds_gone))


def _scope(differ: Changes, words: Words) -> Iterator[str]:
    plain = {
        "true": words("yes"),
        "false": words("no"),
        "null": words("none"),
        "": words("none"),
        "all": words("entry.all"),
    }
    for what, before, now in differ.scope:
        assert what in QUESTION_KEYS
        yield words(f"changes.scope.{what}", before=plain.get(before, before), now=plain.get(now, now))


@dataclass(frozen=True, slots=True)
class ClosedSection:
    """One row: where data ends, which data, on whose word, and where it would get to."""

    where: str
    data: str
    statement: str
    lines: tuple[str, ...]
    behind: str


def closed(index: Index) -> tuple[ClosedSection, ...]:
    """Return the rows that closed a path; older documents have none."""
    rows = [row for row in index.document.get("taken_away", ()) if row["leak"] or row["open"] or row["perhaps"]]
    rows.sort(key=lambda row: row["leak"] is None)
    return tuple(_closed(group, index) for group in grouped(rows, _normalised))


def _normalised(row: Mapping[str, Any]) -> Any:
    ends = [(row[end] or {}).get("name", "") for end in ("element", "to", "leak", "open")]
    places = tuple((place["file"], place["line"]) for place in row["places"])
    return row["by"], tuple(ends), tuple(row["categories"]), places, row["note"]


def _closed(rows: list[Mapping[str, Any]], index: Index) -> ClosedSection:
    words, row = index.words, rows[0]

    def of(end: str) -> str:
        elements = [row[end] for row in rows if row[end]]
        return words.row(index.names(elements)) if elements else ""

    behind = [words("closed.leak", element=of("leak"))] if row["leak"] else []
    behind += [words("closed.open", element=of("open"))] if row["open"] else []
    said = words(f"closed.{row['by']}")
    return ClosedSection(
        where=" → ".join(end for end in (of("element"), of("to")) if end),
        data=index.all_data(row["categories"]),
        statement=words("closed.glob", said=said) if row["glob"] else said,
        lines=tuple(f"{fit(place['file'])}:{place['line']}" for place in row["places"]),
        behind=words.row(behind) if behind else words("closed.perhaps"),
    )
