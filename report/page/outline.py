"""A JSON document -> everything that a report for people tells, in its order; HTML and Markdown write it down.

In: a document of the contract, a language, and an earlier document to compare with. Out: an ``Outline`` of plain
texts. What the documents do not say, no report says.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import SPECIAL
from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.compare.changes import changes
from rosprivacy.report.document.ledger import by_globs
from rosprivacy.report.finding_facts import REVEALS, strength
from rosprivacy.report.naming import count_rows
from rosprivacy.report.page.assessment import Answers, Assessment, AssessmentCriterion, assessment, criteria
from rosprivacy.report.page.assumed import ResultGrounds, grounds
from rosprivacy.report.page.changed import Changed, changed
from rosprivacy.report.page.closing import BeyondEntry, ClosingEntry, beyond_entries, beyond_said, closing
from rosprivacy.report.page.elements import Inventory, inventory
from rosprivacy.report.page.finding_entries import DecisionText, PathEntry, finding_entries, orphans
from rosprivacy.report.page.fleet_section import FleetSection, fleet_told
from rosprivacy.report.page.flows import flows
from rosprivacy.report.page.index import Index, state
from rosprivacy.report.page.kinds import KindEntry, ProvisionList, entries_of, kinds, provisions
from rosprivacy.report.page.look_at import FurtherLaw, further_law
from rosprivacy.report.page.opening import OpeningSection, opening
from rosprivacy.report.page.persons import Concerned, concerned, signed
from rosprivacy.report.page.review import QuestionGroup, Sort, doubts, in_doubt, review
from rosprivacy.report.page.to_confirm import RowQuestions, row_questions
from rosprivacy.report.verdict import verdict_meaning, verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.compare.earlier import Earlier


DECIDE = "decide"  # its heading is what there is to decide
SECTIONS = (
    DECIDE, "closing", "changes", "fleet", "findings", "beyond", "doubts", "questions", "risks", "criteria", "sign",
    "confirm", "kinds", "hangs", "tables", "rights", "outside", "sanitizers", "types",
    "assumptions", "inventory", "method",
)  # fmt: skip
ONLY_WITH = {"wildcard": "pattern", "request": "leg"}  # words that come only where an element has it
LAST = "sign"  # of what is no appendix
SHOWN_AT_MOST = 3  # robots or policies in the title
PARAGRAPHS = 3  # of the method note
EXPLAINED = ("profile", "enclave", "label", "wildcard", "request")  # before they first come, beside the view


class Cover(NamedTuple):
    """What stands above a report.

    Attributes
    ----------
    title
        Of the system, as the user calls it, or the names of its policies.
    date
        Date; empty if none is to be told.
    law
        As of when the law is told.
    redacted
        Whether names were replaced.
    """

    title: str
    date: str
    version: str
    law: str
    redacted: bool


class Summary(NamedTuple):
    """The result on the whole.

    Attributes
    ----------
    code
        The verdict of the contract.
    verdict
        The same; or what it lacks, as ``verdict_meaning`` says.
    sentence
        The verdict with its doubts, as all outputs say it.
    means
        What else is to be known of it.
    numbers
        (number, what it counts).
    glossary
        (word, what it means), of words that come before the section on the method.
    """

    code: str
    verdict: str
    sentence: str
    means: tuple[str, ...]
    numbers: tuple[tuple[int, str], ...]
    glossary: tuple[tuple[str, str], ...]


class Outline(NamedTuple):
    """The whole report.

    Attributes
    ----------
    sections
        (anchor, heading), in order.
    opening
        What it begins with: what is to be decided.
    row_questions
        What is to be confirmed and to be known beside it.
    closing
        What closes these paths; None where there are none.
    """

    words: Words
    cover: Cover
    sections: tuple[tuple[str, str], ...]
    summary: Summary
    opening: OpeningSection
    row_questions: RowQuestions
    closing: ClosingEntry | None
    grounds: ResultGrounds
    fleet: FleetSection | None
    changes: Changed | None
    persons: Concerned
    kinds: tuple[KindEntry, ...]
    entries: tuple[PathEntry, ...]
    beyond: tuple[BeyondEntry, ...]
    beyond_said: tuple[str, ...]
    orphans: tuple[DecisionText, ...]
    further: FurtherLaw
    provisions: ProvisionList
    questions: tuple[QuestionGroup, ...]
    doubts: tuple[Sort, ...]
    criteria: tuple[AssessmentCriterion, ...]
    assessment: Assessment
    inventory: Inventory

    @property
    def appendix(self) -> str:
        """Where the appendix begins: what the sections before rest on."""
        anchors = [anchor for anchor, _ in self.sections]
        return anchors[anchors.index(LAST) + 1]

    @property
    def shared(self) -> dict[str, tuple[PathEntry, ...]]:
        """Notes that entries of several kinds of data have -> these; each stands once, before all kinds."""
        return {
            note: tuple(entries)
            for note, entries in entries_of(self.entries).items()
            if len({entry.category for entry in entries}) > 1
        }

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
    differ = changes(earlier.document, document) if earlier else None
    entries = finding_entries(index, differ.marks() if differ else None)
    decided = flows(index, entries)
    begins = opening(index, decided, entries, _verdict(index), tuple(in_doubt(index)))
    questions = row_questions(index, entries)
    of_kinds, further = kinds(index, entries), further_law(index)
    closes = closing(index, entries, proposals)
    sections = _sections(
        index, begins.headline, closes=bool(closes), changes=bool(differ), confirm=any(questions.remainder)
    )
    return Outline(
        words=index.words,
        cover=_cover(index, title, date, redacted=redacted),
        sections=sections,
        summary=_summary(index, entries, sections),
        opening=begins,
        row_questions=questions,
        closing=closes,
        grounds=grounds(index),
        fleet=fleet_told(index, entries),
        changes=changed(differ, earlier, entries, index) if differ and earlier else None,
        persons=concerned(index, entries),
        kinds=of_kinds,
        entries=entries,
        beyond=beyond_entries(index),
        beyond_said=beyond_said(index),
        orphans=orphans(index),
        further=further,
        provisions=provisions(of_kinds, further, index),
        questions=review(index),
        doubts=doubts(index),
        criteria=criteria(index),
        assessment=assessment(index.words, decided, answers or Answers(), signed(index)),
        inventory=inventory(index, entries),
    )


def _sections(
    index: Index, headline: str, *, closes: bool, changes: bool, confirm: bool
) -> tuple[tuple[str, str], ...]:
    """The sections that there are, in order: (anchor, heading)."""
    document = index.document
    there = {
        "closing": closes,
        "changes": changes,
        "confirm": confirm,
        "fleet": bool(index.alike),
        "types": bool(document.get("types")),
        "beyond": "enforced" in document,
        "doubts": bool(document.get("doubts")),
    }
    anchors = (anchor for anchor in SECTIONS if there.get(anchor, True))
    return tuple((one, headline if one == DECIDE else index.words(f"heading.{one}")) for one in anchors)


def _cover(index: Index, title: str, date: str, *, redacted: bool) -> Cover:
    assumptions, words = index.document["assumptions"], index.words
    law = _law(assumptions, words)
    return Cover(fit(title) if title else _title(index), words.date(date), assumptions["rosprivacy"], law, redacted)


def _summary(index: Index, entries: Sequence[PathEntry], sections: Iterable[tuple[str, str]]) -> Summary:
    document, words = index.document, index.words
    marks = {mark for element in index.elements.values() for mark in ("pattern", "leg") if element.get(mark)}
    explained = (document["view"], *(word for word in EXPLAINED if ONLY_WITH.get(word) in {None, *marks}))
    return Summary(
        code=document["verdict"],
        verdict=verdict_meaning(document),
        sentence=verdict_sentence(document, words),
        means=tuple(_means(index, [anchor for anchor, _ in sections], sum(not entry.detailed for entry in entries))),
        numbers=tuple(_numbers(index)),
        glossary=tuple((words(f"glossary.{word}"), words(f"glossary.{word}.means")) for word in explained),
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


def _verdict(index: Index) -> tuple[str, str]:
    """What the verdict is called, and what it means."""
    words, verdict = index.words, verdict_meaning(index.document)
    unreviewed = words.count(count_rows(index.document["open"]).elements, "element")
    return words(f"verdict.{verdict}"), words(f"verdict.{verdict}.means", open=unreviewed)


def _means(index: Index, sections: list[str], remaining: int) -> Iterator[str]:
    """What else is to be known of the result: what to ask of each path, and which are not to be decided now."""
    words = index.words
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
    words = index.words
    there = [finding for finding in index.findings if not finding["dismissed"] or finding.get("accepted")]
    accepted, dismissed = (
        sum(bool(finding.get(what)) for finding in index.findings) for what in ("accepted", "dismissed")
    )
    if index.alike:
        yield len(index.robots()), words("total.robots")
    yield len(there), words("total.ways")
    if accepted:
        yield accepted, words("total.accepted")
    strengths = Counter(map(strength, there))
    yield strengths[SPECIAL], words("total.special")
    yield strengths[REVEALS], words("total.reveals")
    yield len({tuple(finding["leak"].items()) for finding in there}), words("total.recipients")
    yield count_rows(index.document["open"]).elements, words("total.open")
    if globbed := count_rows(by_globs(index.document)).elements:
        yield globbed, words("total.glob")
    if dismissed:
        yield dismissed, words("total.dismissed")
