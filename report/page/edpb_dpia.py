"""A document along the EDPB's template for an impact assessment: each question, and what the answer knows of it.

In: a JSON document, a language, and the answers that people saved in an earlier report. Out: Markdown, of which Word is
made. The questions stand in ``edpb_questions.py``. What the register knows is told by its rows, with the cells of the
record of Article 30, so that both agree; rows whose cells are the same are one line. What nobody knows is left to
people, never an empty cell; each flow that people have to assess is offered as a threat, with what the ways of its row
pass. No risk is rated and nothing is decided here.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import count_rows
from rosprivacy.report.page.article30 import entries
from rosprivacy.report.page.assessment import Answers, assessment, criteria
from rosprivacy.report.page.assumed import files
from rosprivacy.report.page.edpb_questions import QUESTIONS, READ, SECTIONS, Fact, Origin
from rosprivacy.report.page.elements import enclaves, items
from rosprivacy.report.page.finding_entries import decision_of, finding_entries
from rosprivacy.report.page.flows import flows
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.look_at import context_of
from rosprivacy.report.page.markdown import rendered
from rosprivacy.report.page.persons import rights
from rosprivacy.report.row_texts import completed
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.report.page.article30 import RecordEntry
    from rosprivacy.report.page.assessment import Assessment, Risk
    from rosprivacy.report.page.edpb_questions import Question
    from rosprivacy.report.page.finding_entries import DecisionText

    Row = Mapping[str, Any]  # of the register
    Table = tuple[tuple[str, ...], ...]  # its first row is its head
    Content = tuple[tuple[str, ...], Table]  # sentences, and a table


class QuestionAnswer(NamedTuple):
    """A question with its answer.

    Attributes
    ----------
    origin
        Where the answer comes from, in words.
    texts
        Sentences, and what people answered.
    table
        Empty if there is none.
    """

    number: str
    question: str
    origin: str
    texts: tuple[str, ...]
    table: Table

    def has(self, text: str) -> bool:
        """Return whether a text stands in the answer."""
        return any(text in part for part in (*self.texts, *(cell for row in self.table for cell in row)))


class TemplateSection(NamedTuple):
    """A section of the template."""

    heading: str
    answers: tuple[QuestionAnswer, ...]


def edpb_dpia(
    document: Mapping[str, Any],
    language: str,
    *,
    title: str = "",
    date: str = "",
    redacted: bool = False,
    answers: Answers | None = None,
) -> str:
    """Return the document as Markdown.

    Parameters
    ----------
    language
        ``en``, ``de`` or ``fr``.
    title
        Of the system.
    date
        On which it is made, ``YYYY-MM-DD``.
    redacted
        Whether names were replaced in the document.
    answers
        Of the person who assesses.

    Complexity: O(questions x (rows of the register + flows)).
    """
    index = Index(document, Words(language))
    facts = _Facts(index, date, answers or Answers())
    words, number = index.words, Counter(question.origin for question in QUESTIONS)
    sections = [
        TemplateSection(
            words(heading), tuple(facts.answer(one) for one in QUESTIONS if one.number.startswith(str(section)))
        )
        for section, heading in enumerate(SECTIONS)
    ]
    every = (answer for section in sections for answer in section.answers)
    unfinished = Counter(answer.origin for answer in every if answer.has(words("record.open")))
    return rendered(
        "edpb_dpia.md.j2",
        words,
        title=fit(title),
        read=READ,
        redacted=redacted,
        counts=[(words(f"edpb.origin.{one}"), number[one], unfinished[words(f"edpb.origin.{one}")]) for one in Origin],
        sections=sections,
        unmatched=facts.assessment.unmatched,
    )


def _stated(texts: Iterable[str], index: Index) -> str:
    return index.words.row(texts) or index.words("record.open")


def _derivations(row: Row, index: Index) -> str:
    words = index.words
    texts = [
        words("criterion.make", element=element, data=index.data(one["to"]), of=index.data(one["from"]))
        for one in row["derivations"]
        for element in index.names([one["element"]])
    ]
    return "; ".join(dict.fromkeys(texts))


OWN_COLUMNS: Mapping[str, Callable[[Row, Index], str]] = {
    "sources": lambda row, index: index.words.row(index.names(row["sources"])),
    "derivations": _derivations,
    "contexts": lambda row, index: _stated((context_of(one, index) for one in row["contexts"]), index),
    "countries": lambda row, index: _stated(map(fit, row["countries"]), index),
    "special_bases": lambda row, index: completed(
        map(index.words.basis, row["special_bases"]), row, index.words, Cell.SPECIAL_BASES
    ),
}  # of the register, beside those of the record
NEVER_WHOLE = {"measures", "recipient"}  # columns of which only people know all: other measures, sub-processors


class Threat(NamedTuple):
    """A flow to assess, offered as a threat.

    Attributes
    ----------
    cells
        What it is, by which way, what is decided, in which rows of the register, what the ways of these rows pass.
    """

    risk: Risk
    cells: tuple[str, ...]


@dataclass(frozen=True)
class _Facts:
    """What a document says, looked up for the questions."""

    index: Index
    date: str
    answers: Answers = field(repr=False)

    @cached_property
    def rows(self) -> list[tuple[Row, RecordEntry]]:
        return list(zip(self.index.register, entries(self.index), strict=True))

    @cached_property
    def row_numbers(self) -> dict[str, list[int]]:
        """Finding -> the rows that end in it."""
        numbers: dict[str, list[int]] = {}
        for number, (row, _) in enumerate(self.rows, 1):
            for finding in row["findings"]:
                numbers.setdefault(finding, []).append(number)
        return numbers

    @cached_property
    def assessment(self) -> Assessment:
        decided = flows(self.index, finding_entries(self.index))
        return assessment(self.index.words, decided, self.answers)

    @cached_property
    def by_people(self) -> dict[str, str]:
        """Field of the assessment -> what people answered."""
        return {one.key: one.text for one in (*self.assessment.general, *self.assessment.criteria)}

    @cached_property
    def threats(self) -> list[Threat]:
        return [self._threat(risk) for risk in self.assessment.risks]

    def answer(self, question: Question) -> QuestionAnswer:
        """Return a question with what is known of it, and what is to be completed."""
        words = self.index.words
        texts, table = FACTS[question.fact](self) if question.fact else ((), ())
        if question.columns:
            texts, table = self._of_register(question)
        elif question.risks:
            table = self._risks(question.risks)
        said = self.by_people.get(question.answer, "").splitlines()
        asked = question.origin is Origin.PEOPLE and not said
        return QuestionAnswer(
            number=question.number,
            question=words(question.words),
            origin=words(f"edpb.origin.{question.origin}"),
            texts=(
                *texts,
                *(words("edpb.said", text=line) for line in said),
                *([words("record.open")] if asked else []),
            ),
            table=table,
        )

    def _of_register(self, question: Question) -> tuple[tuple[str, ...], Table]:
        """The rows of the register; those whose cells are the same as one, with the numbers of all."""
        words = self.index.words
        asked = [
            (str(number), tuple(self._cell(column, row, entry) for column in question.columns))
            for number, (row, entry) in enumerate(self.rows, 1)
            if not question.special or _may_be_special(row)
        ]
        if not asked:
            return (words("edpb.none.rows"),), ()
        head = (words("edpb.column.rows"), *map(self._head, question.columns))
        alike = grouped(asked, lambda one: one[1])
        more = (words("edpb.more"),) if not NEVER_WHOLE.isdisjoint(question.columns) else ()
        return more, (head, *((words.row(number for number, _ in same), *same[0][1]) for same in alike))

    def _head(self, column: str) -> str:
        return self.index.words(f"edpb.column.{column}" if column in OWN_COLUMNS else f"record.{column}")

    def _cell(self, column: str, row: Row, entry: RecordEntry) -> str:
        """What a row says; where that is nothing, nothing is to be said: what is not known is in the cell."""
        own = OWN_COLUMNS.get(column)
        return (own(row, self.index) if own else str(getattr(entry, column))) or self.index.words("edpb.none.cell")

    def _threat(self, risk: Risk) -> Threat:
        flow, words = risk.flow, self.index.words
        ids = [one for entry in flow.entries for one in (entry.id, *entry.alike)]
        numbers = sorted({number for one in ids for number in self.row_numbers.get(one, ())})
        witness = self.index.by_id[flow.entries[0].id]["witness"]
        measures = "; ".join(dict.fromkeys(self.rows[number - 1][1].measures for number in numbers))
        cells = (
            f"{flow.content}: {flow.source} → {flow.leak} ({words.row(flow.kinds)})",
            " → ".join(self.index.names(witness)),
            dict(flow.facts)["state"],
            words.row(map(str, numbers)) or words("record.open"),
            measures or words("record.open"),
        )
        return Threat(risk, cells)

    def _risks(self, fields: Sequence[str]) -> Table:
        """What people say of each threat."""
        words = self.index.words
        head = (words("edpb.column.threat"), *(words(f"risk.{one}") for one in fields))
        endings = tuple(f".{one}" for one in fields)
        rows = (
            (str(n), *(one.line or words("record.open") for one in threat.risk.fields if one.key.endswith(endings)))
            for n, threat in enumerate(self.threats, 1)
        )
        return (head, *rows) if self.threats else ()


def _may_be_special(row: Row) -> bool:
    return row["article9"] != "no" or bool(row["special_bases"]) or Cell.SPECIAL_BASES in row["to_complete"]


def _creation(facts: _Facts) -> Content:
    words, assumptions = facts.index.words, facts.index.document["assumptions"]
    made = [words("made", date=words.date(facts.date), version=assumptions["rosprivacy"])] if facts.date else []
    law = [words("law.date", date=words.date(assumptions["law_as_of"]))] if "law_as_of" in assumptions else []
    return (*made, *law, words("edpb.more")), ()


def _files(facts: _Facts) -> Content:
    words = facts.index.words
    return (words("edpb.more"),), (_heads(words, "column.role", "column.file", "column.hash"), *files(facts.index))


def _criteria(facts: _Facts) -> Content:
    words = facts.index.words
    rows = (
        (f"{n}. {one.name}", one.shows or words("criterion.person"), said.line or words("record.open"))
        for n, (one, said) in enumerate(zip(criteria(facts.index), facts.assessment.criteria, strict=True), 1)
    )
    return (), (_heads(words, "column.criterion", "column.shows", "column.answer"), *rows)


def _verdict(facts: _Facts) -> Content:
    words, document = facts.index.words, facts.index.document
    unreviewed = count_rows(document["open"]).elements
    not_reviewed = [words("opening.open", open=words.count(unreviewed, "element"))] if unreviewed else []
    return (verdict_sentence(document, words), *not_reviewed, words("not.legal"), words("edpb.more")), ()


def _extent(facts: _Facts) -> Content:
    robots = facts.index.words.count(max(1, len(facts.index.robots())), "robot")
    return (facts.index.words("criterion.scale", robots=robots), facts.index.words("edpb.more")), ()


def _assets(facts: _Facts) -> Content:
    words = facts.index.words
    rows = [(f"{one.name} ({one.kind})", words.number(one.robots), one.data) for one in items(facts.index)]
    head = _heads(words, "column.element", "column.robots", "column.data")
    of_enclaves = (words("edpb.enclave", enclave=one.name, nodes=one.nodes) for one in enclaves(facts.index))
    return tuple(of_enclaves) if rows else (words("edpb.none.rows"),), (head, *rows) if rows else ()


def _rights(facts: _Facts) -> Content:
    words, groups = facts.index.words, rights(facts.index)
    head = _heads(words, "column.subject", "column.where", "column.data", "column.retention", "rights.who")
    rows = [
        (
            group.name,
            f"{place.name} ({place.kind})",
            place.data,
            place.retention,
            place.recipient or words("record.open"),
        )
        for group in groups
        for place in group.places
    ]
    nowhere = (words("rights.none", group=group.name) for group in groups if not group.places)
    texts = (*nowhere, words("rights.limits" if groups else "rights.nobody"))
    return texts, (head, *rows) if rows else ()


def _threats(facts: _Facts) -> Content:
    words = facts.index.words
    if not facts.threats:
        return (words("edpb.none.threats"),), ()
    columns = "edpb.column.threat", "edpb.column.flow", "edpb.column.way", "decision.state", "edpb.column.rows"
    rows = ((str(n), *threat.cells) for n, threat in enumerate(facts.threats, 1))
    unlisted = facts.assessment.unlisted
    texts = (words("edpb.threats.offered"), *([words.count(unlisted, "risk.left")] if unlisted else []))
    return texts, (_heads(words, *columns, "record.measures"), *rows)


def _plan(facts: _Facts) -> Content:
    """What decisions leave to do."""
    words = facts.index.words
    rows = dict.fromkeys(
        (str(n), entry.decision.decision, _rows_of(entry.decision, words))
        for n, threat in enumerate(facts.threats, 1)
        for entry in threat.risk.flow.entries
        if entry.decision and entry.state != "accepted"
    )
    head = _heads(words, "edpb.column.threat", "decision.decision", "edpb.column.details")
    return (words("edpb.more") if rows else words("record.open"),), (head, *rows) if rows else ()


def _decisions(facts: _Facts) -> Content:
    """What is decided, by row of the register."""
    words, index = facts.index.words, facts.index
    rows = []
    for n, (row, entry) in enumerate(facts.rows, 1):
        decided = [decision_of(index.by_id[one], index) for one in row["findings"]]
        texts = dict.fromkeys("; ".join((one.decision, _rows_of(one, words))) for one in decided if one)
        rows.append(
            (
                str(n),
                entry.category,
                entry.exit,
                words(f"state.{row['state']}"),
                " / ".join(texts) or words("decision.none"),
            )
        )
    columns = "edpb.column.rows", "record.category", "record.exit", "decision.state", "decision.decision"
    return (words("edpb.decisions.meaning"),), (_heads(words, *columns), *rows) if rows else ()


def _conditions(facts: _Facts) -> Content:
    """Conditions on which flows are accepted, with the state of their row now."""
    words, index = facts.index.words, facts.index
    rows = dict.fromkeys(
        (str(n), fit(condition), words(f"state.{row['state']}"))
        for n, (row, _) in enumerate(facts.rows, 1)
        for one in row["findings"]
        if (condition := (index.by_id[one].get("decision") or {}).get("condition"))
    )
    head = _heads(words, "edpb.column.rows", "decision.condition", "decision.state")
    return (words("edpb.more") if rows else words("record.open"),), (head, *rows) if rows else ()


def _rows_of(decision: DecisionText, words: Words) -> str:
    return "; ".join([*(words.pair(name, value) for name, value in decision.rows), *decision.flags])


def _heads(words: Words, *keys: str) -> tuple[str, ...]:
    return tuple(map(words, keys))


FACTS: Mapping[Fact, Callable[[_Facts], Content]] = {
    Fact.CREATION: _creation,
    Fact.FILES: _files,
    Fact.CRITERIA: _criteria,
    Fact.VERDICT: _verdict,
    Fact.EXTENT: _extent,
    Fact.ASSETS: _assets,
    Fact.RIGHTS: _rights,
    Fact.THREATS: _threats,
    Fact.PLAN: _plan,
    Fact.DECISIONS: _decisions,
    Fact.CONDITIONS: _conditions,
}
