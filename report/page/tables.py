"""The two tables of a report: whose data by kind, who can get data by kind.

In: an ``Index`` and the entries of the report. Out: ``PageTable``, cut into parts that are narrow enough for paper.
Every kind of data is a column and every recipient a row, also where nothing was found: what is missing would look like
an answer.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import key
from rosprivacy.report.page.entries_of_robots import grouped
from rosprivacy.report.page.index import anchor, state

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.index import Index

COLUMNS = 6  # of one part, so that it fits a page upright
OUTSIDE = ("storage", "external-system", "display", "participant", "person", "device")


@dataclass(frozen=True, slots=True)
class Cell:
    """What a table says at one place.

    Attributes
    ----------
    link
        Anchor of the first entry, empty if there is none.
    strong
        Whether there is something to assess.
    """

    text: str
    link: str = ""
    strong: bool = False


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row."""

    name: str
    kind: str
    cells: tuple[Cell, ...]


@dataclass(frozen=True, slots=True)
class TablePart:
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
    found |= {k: row["element"] for k, row in index.outside.items() if row["element"]["kind"] in OUTSIDE}
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
) -> Cell:  # fmt: skip
    here = [finding for element in group for finding in findings.get((key(element), category), ())]
    words = index.words
    for stands, said in (("open", ""), ("accepted", "cell.accepted"), ("dismissed", "cell.through")):
        some = [finding for finding in here if state(finding) == stands]
        if some:
            hidden = f", {words('cell.hidden')}" if all(finding["pseudonymised"] for finding in some) else ""
            text = words(said) if said else words.count(len(some), "way")
            return Cell(text + hidden, links.to(some), strong=stands == "open")
    if any(category in index.outside.get(key(element), {}).get("holds", ()) for element in group):
        return Cell(words("cell.gets"))
    cleaned = [row for element in group if (row := index.cleaned.get((key(element), category)))]
    if cleaned and cleaned[0].get("recognises"):
        return Cell(words("cell.gets"))
    return Cell(_cleaned(cleaned[0], index) if cleaned else words("cell.no"))


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
) -> Cell:  # fmt: skip
    here = [finding for member in sorted(members) for finding in findings.get((member, category), ())]
    open_findings = [finding for finding in here if state(finding) == "open"]
    words = index.words
    if open_findings:
        return Cell(words.count(len(open_findings), "way"), links.to(open_findings), strong=True)
    if here:
        accepted = any(state(finding) == "accepted" for finding in here)
        return Cell(words("cell.accepted" if accepted else "cell.through"), links.to(here))
    if any(category in index.of_role["source"][member] for member in members):
        return Cell(words("cell.brought"))
    return Cell(words("cell.made" if index.is_of(name, category) else "cell.none"))
