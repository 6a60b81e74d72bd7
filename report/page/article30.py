"""The record of processing activities (GDPR, Article 30(1)) as far as the analysis knows it, as CSV.

In: a document and a language. Out: one row per kind of data and place where it leaves; one without such a place where
none was found. What only a person can know is to be completed, and a column says which fields these are. A cell states
what lies on the ways of its own row: persons of the sources whose data get there as this kind, how long this very place
keeps them, what cleans them before. A node is no recipient (Article 4(9)), a lack no measure, and where no basis of a
transfer is stated, there is none.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, fields
from functools import partial
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.decisions import State
from rosprivacy.analysis.legal import transfer_of
from rosprivacy.analysis.model import NO_BASIS
from rosprivacy.analysis.non_ros import ADEQUATE, INSIDE, PARTLY, THIRD
from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import Words
from rosprivacy.report.naming import count_rows, key, name, without_leg
from rosprivacy.report.page import persons
from rosprivacy.report.page.elements import retention_text, states_retention
from rosprivacy.report.page.index import Index, grouped
from rosprivacy.report.page.kinds import provision
from rosprivacy.report.page.persons import OUTSIDE
from rosprivacy.report.spreadsheet import as_csv
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from rosprivacy.report.naming import Key

SEPARATORS = {"en": ",", "de": ";", "fr": ";"}  # as spreadsheets in that language expect
BOM = "\ufeff"  # without it Excel takes UTF-8 for something else
PROTECTION = ("category", "method", "stated", "everywhere")  # what tells protections of elements of one name apart
ABROAD = (PARTLY, THIRD)  # areas to which a transfer needs a basis of its own, chapter V


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


def record(document: Mapping[str, Any], language: str) -> str:
    """Return the record as CSV, lines ending as RFC 4180 says, with a byte order mark."""
    index = Index(document, Words(language))
    columns = [field.name for field in fields(RecordEntry)]
    head = [index.words(f"record.{column}") for column in columns]
    rows = ([getattr(entry, column) for column in columns] for entry in entries(index))
    last = {"activity": index.words("record.answer"), "note": verdict_sentence(document, index.words)}
    return BOM + as_csv(head, [*rows, [last.get(column, "") for column in columns]], separator=SEPARATORS[language])


def entries(index: Index) -> tuple[RecordEntry, ...]:
    """Return the rows, by kind of data and recipient."""
    facts = _Facts(index)
    return tuple(entry for category in index.categories for entry in _of_kind(category, facts))


def _of_kind(category: str, facts: _Facts) -> Iterator[RecordEntry]:
    groups = facts.recipients(category)
    for group in groups:
        yield _entry(category, group, facts)
    if not groups:
        yield _entry(category, [], facts)


class _Facts:
    """What the rows are made of, looked up once."""

    def __init__(self, index: Index) -> None:
        self.index = index
        self.findings: dict[tuple[str, Key], list[Mapping[str, Any]]] = defaultdict(list)
        for finding in index.findings:
            self.findings[finding["category"], key(finding["leak"])].append(finding)
        self._reached: dict[str, dict[Key, Mapping[str, Any]]] = defaultdict(dict)
        for (category, at), some in self.findings.items():
            self._reached[category][at] = some[0]["leak"]
        for at, row in index.outside.items():
            for category in row["holds"] if row["element"]["kind"] in OUTSIDE else ():
                self._reached[category][at] = row["element"]
        self.enclaves = index.words.count(len(index.document["enclaves"]), "enclave")

    def recipients(self, category: str) -> list[list[Mapping[str, Any]]]:
        """Who gets the kind of data; those that differ only in the robot together."""
        found = sorted(self._reached[category].values(), key=lambda e: (e["kind"], e["name"], e["robot"]))
        return grouped(found, lambda element: (element["kind"], element["name"]))

    def processed(self, category: str, group: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
        """What is stated of a kind of data where it leaves; where it does not, where it begins."""
        ends = {key(element) for element in group}
        rows = self.index.processed_for.items()
        return [row for (end, of), row in rows if of == category and (end in ends or not ends)]


def _entry(category: str, group: Sequence[Mapping[str, Any]], facts: _Facts) -> RecordEntry:
    index, words = facts.index, facts.index.words
    known = index.categories[category]
    findings = [finding for element in group for finding in facts.findings.get((category, key(element)), ())]
    stated = [index.outside[key(element)] for element in group if key(element) in index.outside]
    law = [provision(legal, category, index) for legal in known["law"]]
    rows = facts.processed(category, group)
    groups, unnamed = index.persons(category, group)
    kept_for, unlimited = _retention(category, group, index)
    values = {
        "activity": "",
        "controller": persons.controllers(rows, index) or words("record.open"),
        "purpose": persons.purposes(rows, index),
        "category": index.data(category),
        "article9": words(f"article9.{known['article9']}"),
        "provisions": "; ".join(words.pair(p.name, p.condition) if p.condition else p.name for p in law),
        "subjects": words.row([*groups, *([words("record.open")] if unnamed else [])]),
        "exit": words.row(index.names(group)) if group else words("record.norecipient"),
        "recipient": _statement(stated, _recipient, index),
        "country": _statement(stated, _country, index),
        "form": _form(category, group, index),
        "transfer": _statement(stated, partial(_transfer, rows), index),
        "basis": persons.bases(rows, _bases(findings), index),
        "retention": "; ".join([*kept_for, *([words("record.open")] if unlimited else [])]),
        "measures": "; ".join(_measures(category, group, facts)) or words("record.open"),
        "findings": words.row(finding["id"] for finding in findings),
        "note": "; ".join(_notes(category, stated, index)),
    }
    missing = {"g", *_not_stated(rows), *("c" if unnamed else ""), *("f" if unlimited else "")}
    if len(stated) < len(group) or any(not row.get("operator") or not row.get("recipient") for row in stated):
        missing.add("d")
    if len(stated) < len(group) or any(_transfer_unknown(row) for row in stated):
        missing.add("e")
    return RecordEntry(
        **values, complete=words.row(words("record.letter", letter=letter) for letter in sorted(missing))
    )


def _not_stated(rows: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """The letters of Article 30(1) for who is responsible and what for, where that is not stated of all data."""
    if not rows or not all(row["controllers"] and row["officers"] for row in rows):
        yield "a"
    if not rows or any(persons.PURPOSE in row["missing"] for row in rows):
        yield "b"


def _statement(
    stated: Sequence[Mapping[str, Any]], statement: Callable[[Mapping[str, Any], Index], str], index: Index
) -> str:
    return index.words.row(dict.fromkeys(filter(None, (statement(row, index) for row in stated))))


def _recipient(row: Mapping[str, Any], index: Index) -> str:
    """Who operates it and as what, as people stated it."""
    role = index.words.of_value(f"recipient.{row['recipient']}", row["recipient"]) if row.get("recipient") else ""
    return ", ".join(part for part in (fit(row.get("operator", "")), role, fit(row.get("contract", ""))) if part)


def _country(row: Mapping[str, Any], index: Index) -> str:
    if not row.get("country"):
        return ""
    return f"{fit(row['country'])} ({index.words('area.' + row['area'])})"


def _transfer(rows: Sequence[Mapping[str, Any]], row: Mapping[str, Any], index: Index) -> str:
    """The safeguard of a transfer, that there is none, or that none is stated; nothing where nothing leaves the EEA."""
    area, stated, words = row.get("area"), row.get("transfer", ""), index.words
    stated = "" if area == ADEQUATE and stated == NO_BASIS else stated
    articles = {basis for said in rows for basis in said["legal_bases"] if transfer_of(basis) == stated}
    exact = f"transfer.{stated}.{'.'.join(articles)}"  # of clauses of one point of Article 46(2): there are two
    basis = words.of_value(exact, words.of_value(f"transfer.{stated}", stated)) if stated else ""
    if not area or area == INSIDE:
        return basis if not area else ""
    if area in ABROAD and not basis:
        return words(f"record.unbased.{area}", country=fit(row["country"]))
    return words.pair(fit(row["country"]), basis or words("transfer.adequacy"))


def _transfer_unknown(row: Mapping[str, Any]) -> bool:
    """Whether a person has to say what data leaves the EEA on, or whether it does."""
    stated = row.get("transfer") and (row["transfer"] != NO_BASIS or row.get("area"))
    return not stated and row.get("area", ABROAD[-1]) in ABROAD


def _bases(findings: Sequence[Mapping[str, Any]]) -> Iterator[str]:
    """Legal bases that valid decisions record, each once."""
    decisions = [finding["decision"] for finding in findings if finding.get("decision")]
    yield from dict.fromkeys(basis for d in decisions if d["state"] == State.VALID for basis in d["legal_basis"])


def _form(category: str, group: Sequence[Mapping[str, Any]], index: Index) -> str:
    """In which form the data arrive: as they are, if any do."""
    if not group:
        return ""
    hidden = all(index.pseudonymised(element, category) for element in group)
    return index.words("record.hidden" if hidden else "record.as.is")


def _retention(category: str, group: Sequence[Mapping[str, Any]], index: Index) -> tuple[list[str], bool]:
    """How long the row's own places keep the kind, backups too; and whether more is to be completed."""
    words, lasting = index.words, dict[str, None]()
    unlimited = not group
    for element in group:
        row = index.outside.get(key(element), {})
        if states_retention(row, category, index):
            lasting[words("record.kept", element=name(element), duration=retention_text(row, category, index))] = None
            unlimited |= row.get("backups") is True
        else:
            unlimited = True
    return list(lasting), unlimited


def _measures(category: str, group: Sequence[Mapping[str, Any]], facts: _Facts) -> Iterator[str]:
    """Technical measures that are seen on the ways of the row; others are a person's to add.

    These are access control, what is cleaned before, and that the row's own places are encrypted.
    """
    index, words = facts.index, facts.index.words
    if index.document["enclaves"]:
        yield words("record.measure.enclaves", enclaves=facts.enclaves)
    rows = index.protections(category, group)
    for same in grouped(rows, lambda row: (without_leg(row["element"])[1:], *(str(row[of]) for of in PROTECTION))):
        row = same[0]
        method = words(f"method.{row['method']}" if row["stated"] else "method.unstated")
        names = words.row(index.names([one["element"] for one in same]))
        said = words("record.measure.cleans", element=names, data=index.data(row["category"]), method=method)
        yield said if row["everywhere"] else words("record.measure.past", measure=said)
    for element in group:
        if index.outside.get(key(element), {}).get("encrypted"):
            yield words("record.measure.encrypted", element=name(element))


def _notes(category: str, stated: Sequence[Mapping[str, Any]], index: Index) -> Iterator[str]:
    """What is no measure and no recipient, and has to be known: a place that is not encrypted, what is not reviewed."""
    words = index.words
    for row in stated:
        if row.get("encrypted") is False:
            yield words("record.note.unencrypted", element=name(row["element"]))
    unknown = count_rows(q for q in index.document["open"] if category in q["categories"]).elements
    if unknown:
        yield words("record.note.open", elements=words.count(unknown, "element"))
