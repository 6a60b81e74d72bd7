"""The records of processing (GDPR, Article 30(1) and (2)) as far as the analysis knows them, as CSV.

In: a document and a language. Out: a row for each row of its register, whose cells say what that row holds; what only a
person can know is to be completed, and a column says which fields these are. A node is no recipient (Article 4(9)), a
lack no measure, and where no basis of a transfer is stated, there is none. The record of processors has the rows of
places that a processor operates, as stated.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.text import fit
from rosprivacy.report import row_texts
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.naming import count_rows, name
from rosprivacy.report.page import persons
from rosprivacy.report.page.elements import protections
from rosprivacy.report.page.index import Index
from rosprivacy.report.page.kinds import provision
from rosprivacy.report.row_texts import completed, country
from rosprivacy.report.spreadsheet import as_csv
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    Row = Mapping[str, Any]  # of the register

SEPARATORS = {"en": ",", "de": ";", "fr": ";"}  # as spreadsheets in that language expect
BOM = "\ufeff"  # without it Excel takes UTF-8 for something else
LETTERS = {  # of Article 30(1), and the fields of a row that they speak of
    "a": (Cell.CONTROLLERS, Cell.OFFICERS),
    "b": (Cell.PURPOSES,),
    "c": (Cell.SUBJECTS,),
    "d": (Cell.OPERATOR, Cell.RECIPIENT),
    "e": (Cell.SAFEGUARDS,),
    "f": (Cell.RETENTION,),
}

PROCESSOR = "processor"
PROCESSOR_LETTERS = {  # of Article 30(2); of measures (d) no policy tells all
    "a": (Cell.OPERATOR, Cell.CONTROLLERS, Cell.OFFICERS),
    "b": (Cell.PURPOSES,),
    "c": (Cell.SAFEGUARDS,),
}


@dataclass(frozen=True, slots=True)
class RecordEntry:
    """One row of the record; the fields are its columns, in order."""

    activity: str
    controller: str
    purpose: str
    category: str
    article9: str
    provisions: str
    subjects: str
    exit: str
    recipient: str
    country: str
    form: str
    transfer: str
    basis: str
    retention: str
    measures: str
    findings: str
    note: str
    complete: str


@dataclass(frozen=True, slots=True)
class ProcessorEntry:
    """One row of the record of processors; the fields are its columns, in order."""

    processor: str
    controller: str
    activity: str
    category: str
    form: str
    exit: str
    country: str
    contract: str
    transfer: str
    measures: str
    findings: str
    note: str
    complete: str


PROCESSOR_HEADS = {
    "processor": "processors.processor",
    "controller": "processors.controller",
    "activity": "processors.activity",
    "category": "processors.category",
    "form": "record.form",
    "exit": "processors.exit",
    "country": "record.country",
    "contract": "processors.contract",
    "transfer": "processors.transfer",
    "measures": "processors.measures",
    "findings": "record.findings",
    "note": "record.note",
    "complete": "record.complete",
}


def record(document: Mapping[str, Any], language: str) -> str:
    """Return the record as CSV, lines ending as RFC 4180 says, with a byte order mark."""
    index = Index(document, Words(language))
    heads = {field.name: f"record.{field.name}" for field in fields(RecordEntry)}
    return _as_csv(heads, entries(index), "activity", index)


def record_of_processors(document: Mapping[str, Any], language: str) -> str:
    """Return the record of processors (Article 30(2)) in the same form."""
    index = Index(document, Words(language))
    none = ProcessorEntry(**dict.fromkeys(PROCESSOR_HEADS, "") | {"note": index.words("processors.none")})
    return _as_csv(PROCESSOR_HEADS, processor_entries(index) or [none], "processor", index)


def _as_csv(heads: Mapping[str, str], rows: Iterable[RecordEntry | ProcessorEntry], first: str, index: Index) -> str:
    """The table; its last row is the answer that it rests on."""
    last = {first: index.words("record.answer"), "note": verdict_sentence(index.document, index.words)}
    cells = ([getattr(row, column) for column in heads] for row in rows)
    answer = [last.get(column, "") for column in heads]
    separator = SEPARATORS[index.words.language]
    return BOM + as_csv(map(index.words, heads.values()), [*cells, answer], separator=separator)


def processor_entries(index: Index) -> tuple[ProcessorEntry, ...]:
    """Return the rows whose recipient is stated to be a processor, in the order of the register."""
    return tuple(_processor_entry(row, index) for row in index.register if row["recipient"] == PROCESSOR)


def _processor_entry(row: Row, index: Index) -> ProcessorEntry:
    words, same = index.words, _entry(row, index)
    letters = (letter for letter, cells in PROCESSOR_LETTERS.items() if any(c in row["to_complete"] for c in cells))
    return ProcessorEntry(
        processor=completed(filter(None, [fit(row["operator"])]), row, words, Cell.OPERATOR),
        controller=same.controller,
        activity=same.activity,
        category=same.category,
        form=same.form,
        exit=same.exit,
        country=same.country,
        contract=completed(filter(None, [fit(row["contract"])]), row, words, Cell.CONTRACT),
        transfer=same.transfer,
        measures=same.measures,
        findings=same.findings,
        note=same.note,
        complete=words.row(words("processors.letter", letter=letter) for letter in (*letters, "d")),
    )


def entries(index: Index) -> tuple[RecordEntry, ...]:
    """Return the rows, in the order of the register."""
    return tuple(_entry(row, index) for row in index.register)


def _entry(row: Row, index: Index) -> RecordEntry:
    words, known = index.words, index.categories[row["category"]]
    law = [provision(legal, row["category"], index) for legal in known["law"]]
    purposes = completed(map(fit, row["purposes"]), row, words, Cell.PURPOSES)
    return RecordEntry(
        activity=purposes,
        controller=completed(filter(None, [persons.controllers([row], index)]), row, words, Cell.CONTROLLERS),
        purpose=purposes,
        category=index.data(row["category"]),
        article9=words(f"article9.{row['article9']}"),
        provisions="; ".join(words.pair(p.name, p.condition) if p.condition else p.name for p in law),
        subjects=completed(map(fit, row["subjects"]), row, words, Cell.SUBJECTS),
        exit=words.row(index.names(row["places"])) if row["places"] else words("record.norecipient"),
        recipient=completed(row_texts.recipient(row, words), row, words, Cell.OPERATOR, Cell.RECIPIENT),
        country=completed(filter(None, [country(row, words)]), row, words, Cell.COUNTRY),
        form=words("record.hidden" if row["pseudonymised"] else "record.as.is") if row["places"] else "",
        transfer=completed(row_texts.transfer(row, words), row, words, Cell.SAFEGUARDS),
        basis="; ".join(row_texts.bases(row, words)),
        retention=completed(_retention(row, index), row, words, Cell.RETENTION),
        measures="; ".join(_measures(row, index)) or words("record.open"),
        findings=words.row(row["findings"]),
        note="; ".join(_notes(row, index)),
        complete=words.row(words("record.letter", letter=letter) for letter in _letters(row)),
    )


def _letters(row: Row) -> Iterator[str]:
    """What Article 30(1) asks for and is not known; of measures (g) no policy tells all."""
    yield from (letter for letter, cells in LETTERS.items() if any(cell in row["to_complete"] for cell in cells))
    yield "g"


def _retention(row: Row, index: Index) -> Iterator[str]:
    """How long the row's own places keep the kind, backups too."""
    for place in row["places"] if row["retention"] else ():
        yield index.words("record.kept", element=name(place), duration=row_texts.retention(row, index.words))


def _measures(row: Row, index: Index) -> Iterator[str]:
    """The measures that the policies are, and those on the ways of the row."""
    if enclaves := len(index.document["enclaves"]):
        yield index.words("record.measure.enclaves", enclaves=index.words.count(enclaves, "enclave"))
    yield from protections(row, index)


def _notes(row: Row, index: Index) -> Iterator[str]:
    """What is no measure and no recipient, and has to be known: what is not encrypted, on no contract, not reviewed."""
    words = index.words
    for place in row["places"] if row["encrypted"] is False else ():
        yield words("record.note.unencrypted", element=name(place))
    if Cell.CONTRACT in row["to_complete"]:
        role = words.of_value(f"recipient.{row['recipient']}", row["recipient"])
        yield words("record.note.contract", element=words.row(index.names(row["places"])), role=role)
    if note := not_reviewed(row["category"], index):
        yield note


def not_reviewed(category: str, index: Index) -> str:
    """Return that there may be more recipients of a kind of data; empty where all is reviewed."""
    unknown = count_rows(q for q in index.document["open"] if category in q["categories"]).elements
    return index.words("record.note.open", elements=index.words.count(unknown, "element")) if unknown else ""
