"""The persons: whose data there are, who gets them, what for and on which basis, and where their rights apply.

In: an ``Index`` and the entries of the report. Out: ``PageTable``s, cut into parts that are narrow enough for paper,
and rows of plain texts. In the tables every kind of data is a column and every recipient a row, also where nothing was
found: what is missing would look like an answer. What is not stated of all data of a kind is said to be completed. A
storage or recipient counts for a group of persons (Articles 15, 17, 20 and 21) if data that the group's sources bring
in, or that are made of these, can get there; how long it is kept is 'not known' where nobody states it.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.non_ros import RESTING
from rosprivacy.analysis.text import fit
from rosprivacy.report import row_texts
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import key
from rosprivacy.report.page.elements import STORAGE, protections
from rosprivacy.report.page.index import anchor, state

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.index import Index

COLUMNS = 6  # of one part, so that it fits a page upright


class Concerned(NamedTuple):
    """Whom the data are about and who gets them.

    Attributes
    ----------
    subjects, silent
        Whose data, by kind; sources of which nobody says whose.
    recipients
        Who can get data, by kind.
    processed
        What for, on which basis and by whom.
    rights
        Of each group of persons, where data about them can lie.
    """

    subjects: PageTable
    silent: tuple[str, ...]
    recipients: PageTable
    processed: tuple[PurposeRow, ...]
    rights: tuple[Persons, ...]

    @property
    def by_place(self) -> tuple[RightsPlace, ...]:
        """The places of all groups, each once."""
        return by_place(self.rights)


def concerned(index: Index, entries: Sequence[PathEntry]) -> Concerned:
    """Return the persons of a document."""
    links = TableLinks(entries)
    table, silent = subjects(index, links)
    return Concerned(table, silent, recipients(index, links), processed(index), rights(index))


NOTHING = "–"  # what an empty cell says in every language


class TableCell(NamedTuple):
    """What a table says at one place.

    Attributes
    ----------
    link
        Anchor of the first entry, empty if there is none.
    strong
        Whether there is something to assess.
    brief
        How much there is to assess, as a number.
    """

    text: str
    link: str = ""
    strong: bool = False
    brief: str = ""


class TableRow(NamedTuple):
    """One row."""

    name: str
    kind: str
    cells: tuple[TableCell, ...]

    @property
    def empty(self) -> bool:
        """Whether nothing stands in any of its cells."""
        return all(cell.text == NOTHING for cell in self.cells)


class TablePart(NamedTuple):
    """Some columns of a table, with all of its rows."""

    number: int
    parts: int
    columns: tuple[str, ...]
    rows: tuple[TableRow, ...]


@dataclass(frozen=True, slots=True)
class PageTable:
    """A table."""

    columns: tuple[str, ...]
    rows: tuple[TableRow, ...] = field(default=())

    def parts(self) -> Iterator[TablePart]:
        """Return the parts, each with at most ``COLUMNS`` columns; none of a table without rows."""
        begins = range(0, len(self.columns), COLUMNS) if self.rows else range(0)
        for number, begin in enumerate(begins, 1):
            end = begin + COLUMNS
            rows = tuple(TableRow(row.name, row.kind, row.cells[begin:end]) for row in self.rows)
            yield TablePart(number, len(begins), self.columns[begin:end], rows)


class TableLinks:
    """Where the entry of a finding stands: findings that differ only in the robot share one."""

    def __init__(self, entries: Iterable[Any]) -> None:
        self._first = {finding: entry.anchor for entry in entries for finding in (entry.id, *entry.alike)}

    def to(self, findings: Sequence[Mapping[str, Any]]) -> str:
        """Return the anchor of the first entry."""
        return self._first.get(findings[0]["id"], anchor(findings[0]["id"])) if findings else ""


def recipients(index: Index, links: TableLinks) -> PageTable:
    """Return who can get data: elements that let it out, keep it, or lie outside ROS."""
    found = {key(f["leak"]): f["leak"] for f in index.findings}
    found |= {element: index.elements[element] for element in index.of_role.get("leak", {})}
    found |= {k: row["element"] for k, row in index.outside.items() if row["element"]["kind"] in RESTING}
    findings: dict[tuple[Key, str], list[Mapping[str, Any]]] = defaultdict(list)
    for finding in index.findings:
        findings[key(finding["leak"]), finding["category"]].append(finding)
    ordered = sorted(found.values(), key=lambda e: (e["kind"] == "node", e["kind"], e["name"], e["robot"]))
    rows = []
    for group in grouped(ordered, lambda e: (e["kind"], e["name"])):
        cells = [_gets(group, category, findings, index, links) for category in index.categories]
        rows.append(TableRow(index.words.row(index.names(group)), index.words.kind(group[0]), tuple(cells)))
    return PageTable(_columns(index), tuple(rows))


def _columns(index: Index) -> tuple[str, ...]:
    return tuple(index.data(category) for category in index.categories)


def _gets(
    group: Sequence[Mapping[str, Any]], category: str, findings: Mapping[Any, list[Mapping[str, Any]]],
    index: Index, links: TableLinks,
) -> TableCell:  # fmt: skip
    here = [finding for element in group for finding in findings.get((key(element), category), ())]
    words = index.words
    for stands, said in (("open", ""), ("accepted", "cell.accepted"), ("dismissed", "cell.through")):
        some = [finding for finding in here if state(finding) == stands]
        if some:
            hidden = f", {words('cell.hidden')}" if all(finding["pseudonymised"] for finding in some) else ""
            text = words(said) if said else words.count(len(some), "way")
            brief = "" if said else words.number(len(some)) + hidden
            return TableCell(text + hidden, links.to(some), strong=stands == "open", brief=brief)
    if any(category in index.outside.get(key(element), {}).get("holds", ()) for element in group):
        return TableCell(words("cell.gets"))
    cleaned = [row for element in group if (row := index.cleaned.get((key(element), category)))]
    if cleaned and cleaned[0].get("recognises"):
        return TableCell(words("cell.gets"))
    return TableCell(_cleaned(cleaned[0], index) if cleaned else words("cell.none"))


def _cleaned(row: Mapping[str, Any], index: Index) -> str:
    """That data gets to an element and is said to be cleaned there: no path, on a label's word."""
    method = index.words(f"method.{row['method']}" if row["stated"] else "method.unstated")
    lines = index.words.row(f"{fit(place['file'])}:{place['line']}" for place in row.get("places", ()))
    return index.words("cell.cleaned", how=index.words.row(filter(None, (method, lines))))


def subjects(index: Index, links: TableLinks) -> tuple[PageTable, tuple[str, ...]]:
    """Return whose data by kind, and the names of sources of which labels do not say it."""
    sources = index.of_role.get("source", {})
    groups: dict[str, set[Key]] = defaultdict(set)
    silent = []
    for source in sources:
        for group in index.subjects.get(source, ()):
            groups[group].add(source)
        if source not in index.subjects:
            silent.append(source)
    rows: list[tuple[str | None, set[Key]]] = sorted(groups.items())
    rows += [(None, set(silent))] if silent else []
    findings: dict[tuple[Key, str], list[Mapping[str, Any]]] = defaultdict(list)
    for finding in index.findings:
        findings[key(finding["source"]), finding["category"]].append(finding)
    table = [
        TableRow(
            index.words("subject.unknown") if name is None else fit(name),
            "",
            tuple(_about(name, members, c, findings, index, links) for c in index.categories),
        )
        for name, members in rows
    ]
    return PageTable(_columns(index), tuple(table)), index.names([index.elements[s] for s in silent])


def _about(
    name: str | None, members: set[Key], category: str, findings: Mapping[Any, list[Mapping[str, Any]]],
    index: Index, links: TableLinks,
) -> TableCell:  # fmt: skip
    here = [finding for member in sorted(members) for finding in findings.get((member, category), ())]
    open_findings = [finding for finding in here if state(finding) == "open"]
    words = index.words
    if open_findings:
        number = len(open_findings)
        return TableCell(words.count(number, "way"), links.to(open_findings), strong=True, brief=words.number(number))
    if here:
        accepted = any(state(finding) == "accepted" for finding in here)
        return TableCell(words("cell.accepted" if accepted else "cell.through"), links.to(here))
    if any(category in index.of_role["source"][member] for member in members):
        return TableCell(words("cell.brought"))
    return TableCell(words("cell.made" if index.is_of(name, category) else "cell.none"))


PURPOSE, BASIS = "purpose", "legal_basis"  # as a document says that they are missing


class PurposeRow(NamedTuple):
    """A kind of data where it begins or ends."""

    data: str
    where: str
    purposes: str
    bases: str
    controllers: str


def processed(index: Index) -> tuple[PurposeRow, ...]:
    """Return the rows, by kind of data; those of robots that say the same as one."""
    rows = []
    for category in index.categories:
        here = [row for (_, of), row in index.processed_for.items() if of == category]
        for group in grouped(
            here, lambda row: (row["element"]["kind"], row["element"]["name"], str(_stated_purposes(row)))
        ):
            names = index.words.row(index.names([row["element"] for row in group]))
            texts = purposes(group, index), bases(group, index), controllers(group, index)
            rows.append(PurposeRow(index.data(category), names, *texts))
    return tuple(rows)


def _stated_purposes(row: Mapping[str, Any]) -> list[Any]:
    return [row[key] for key in ("purposes", "legal_bases", "controllers", "officers", "missing")]


def signed(index: Index) -> dict[str, str]:
    """Return what stands in fields of the report that people sign, as far as it is stated; other fields are empty."""
    rows = list(index.processed_for.values())
    found = {
        "controller": controllers(rows, index),
        "purpose": _by_kind(index, purposes),
        "basis": _by_kind(index, bases),
    }
    return {field: said for field, said in found.items() if rows and said}


def _by_kind(index: Index, statement: Callable[[Sequence[Mapping[str, Any]], Index], str]) -> str:
    rows = {
        category: [row for (_, of), row in index.processed_for.items() if of == category]
        for category in index.categories
    }
    texts = {category: statement(some, index) for category, some in rows.items() if some}
    if len(set(texts.values())) == 1:
        return next(iter(texts.values()))
    return "; ".join(
        index.words.pair(index.all_data(same), texts[same[0]]) for same in grouped(texts, texts.__getitem__)
    )


def purposes(rows: Sequence[Mapping[str, Any]], index: Index) -> str:
    """Return purposes; also that some are to be completed."""
    return _with_pending(rows, "purposes", PURPOSE, fit, index)


def bases(rows: Sequence[Mapping[str, Any]], index: Index) -> str:
    """Return legal bases; also that some are to be completed."""
    return _with_pending(rows, "legal_bases", BASIS, index.words.basis, index)


def controllers(rows: Iterable[Mapping[str, Any]], index: Index) -> str:
    """Return who is responsible, and the data-protection officers."""
    who = dict.fromkeys(fit(one) for row in rows for one in row["controllers"])
    officers = dict.fromkeys(fit(one) for row in rows for one in row["officers"])
    return "; ".join([*who, *(index.words("record.dpo", name=one) for one in officers)])


def _with_pending(
    rows: Sequence[Mapping[str, Any]], key: str, fact: str, text_of: Callable[[str], str], index: Index
) -> str:
    stated = dict.fromkeys(one for row in rows for one in row[key])
    lacking = not stated or any(fact in row["missing"] for row in rows)
    return "; ".join([*map(text_of, stated), *([index.words("record.open")] if lacking else [])])


class DataPlace(NamedTuple):
    """Where data of a group can lie: a storage, an external recipient, or an element that lets data out.

    Attributes
    ----------
    kinds
        The kinds of data; ``data`` has them in a row.
    recipient
        Who operates it, where, and on which safeguard data get there; or that nobody states it.
    measures
        What is seen to protect the data on their way there.
    stated
        Whether it lies outside ROS, where people state what there is to it.
    """

    name: str
    kind: str
    kinds: tuple[str, ...]
    data: str
    retention: str
    recipient: str
    measures: tuple[str, ...]
    stated: bool = False


class Persons(NamedTuple):
    """A group of persons, and the places; none where no path of their data was found to one."""

    name: str
    places: tuple[DataPlace, ...]


class Holding(NamedTuple):
    """Kinds of data at a place that are about the same persons and are kept for the same time."""

    kinds: tuple[str, ...]
    persons: tuple[str, ...]
    retention: str


class RightsPlace(NamedTuple):
    """A place once for all groups of persons.

    Attributes
    ----------
    stated
        Whether it lies outside ROS, so that the table of what people stated has who operates it.
    holdings
        Which data about whom it holds, and for how long.
    """

    name: str
    kind: str
    recipient: str
    stated: bool
    holdings: tuple[Holding, ...]


def by_place(groups: Iterable[Persons]) -> tuple[RightsPlace, ...]:
    """Return the places of all groups, each once, in the order in which the groups name them."""
    about: dict[tuple[str, str, str, bool], dict[tuple[str, str], list[str]]] = {}
    for group in groups:
        for place in group.places:
            persons_of = about.setdefault((place.name, place.kind, place.recipient, place.stated), {})
            for kind in place.kinds:
                names = persons_of.setdefault((kind, place.retention), [])
                if group.name not in names:
                    names.append(group.name)
    return tuple(RightsPlace(*place, tuple(_holdings(persons_of))) for place, persons_of in about.items())


def _holdings(persons_of: Mapping[tuple[str, str], Sequence[str]]) -> Iterator[Holding]:
    for same in grouped(persons_of, lambda at: (tuple(persons_of[at]), at[1])):
        yield Holding(tuple(kind for kind, _ in same), tuple(persons_of[same[0]]), same[0][1])


def rights(index: Index) -> tuple[Persons, ...]:
    """Return the groups that labels name, then the persons that they do not name: rows of the register."""
    names = sorted({group for row in index.register for group in row["subjects"]})
    groups = [(fit(name), _places([row for row in index.register if name in row["subjects"]], index)) for name in names]
    if silent := [row for row in index.register if Cell.SUBJECTS in row["to_complete"]]:
        groups.append((index.words("subject.unknown"), _places(silent, index)))
    return tuple(Persons(name, tuple(places)) for name, places in groups)


def _places(rows: Iterable[Mapping[str, Any]], index: Index) -> Iterator[DataPlace]:
    """Storages first, then who receives data; kinds of data of which all else is the same are one."""
    there = [row for row in rows if row["places"]]
    there.sort(key=lambda row: (row["places"][0]["kind"] != STORAGE, key(row["places"][0])))
    for same in grouped([_place(row, index) for row in there], lambda place: place._replace(kinds=(), data="")):
        kinds = tuple(dict.fromkeys(kind for place in same for kind in place.kinds))
        yield same[0]._replace(kinds=kinds, data=index.words.row(kinds))


def _place(row: Mapping[str, Any], index: Index) -> DataPlace:
    words, data = index.words, index.data(row["category"], pseudonymised=row["pseudonymised"])
    return DataPlace(
        name=words.row(index.names(row["places"])),
        kind=words.kind(row["places"][0]),
        kinds=(data,),
        data=data,
        retention=row_texts.retention(row, words) or words("rights.unknown"),
        recipient="; ".join(filter(None, (*row_texts.recipient(row, words), row_texts.where(row, words))))
        or words("rights.unknown"),
        measures=tuple(protections(row, index)),
        stated=key(row["places"][0]) in index.outside,
    )
