"""What data are processed for, on which basis and by whom, as people state it: for a report and its fields to sign.

In: an ``Index``. Out: rows of plain texts; what is not stated of all data of a kind is said to be completed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.page.entries_of_robots import grouped

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from rosprivacy.report.page.index import Index

PURPOSE, BASIS = "purpose", "legal_basis"  # as a document says that they are missing


@dataclass(frozen=True, slots=True)
class PurposeRow:
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
            texts = purposes(group, index), bases(group, (), index), controllers(group, index)
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
        "basis": _by_kind(index, _bases),
    }
    return {field: said for field, said in found.items() if rows and said}


def _by_kind(index: Index, statement: Callable[[Sequence[Mapping[str, Any]], Index], str]) -> str:
    rows = {
        category: [row for (_, of), row in index.processed_for.items() if of == category]
        for category in index.categories
    }
    return "; ".join(
        index.words.pair(index.data(category), statement(some, index)) for category, some in rows.items() if some
    )


def purposes(rows: Sequence[Mapping[str, Any]], index: Index) -> str:
    """Return purposes; also that some are to be completed."""
    return _with_pending(rows, "purposes", PURPOSE, fit, index)


def bases(rows: Sequence[Mapping[str, Any]], decided: Iterable[str], index: Index) -> str:
    """Return legal bases, those that decisions record too; also that some are to be completed."""
    return _with_pending(rows, "legal_bases", BASIS, index.words.basis, index, decided)


def _bases(rows: Sequence[Mapping[str, Any]], index: Index) -> str:
    return bases(rows, (), index)


def controllers(rows: Iterable[Mapping[str, Any]], index: Index) -> str:
    """Return who is responsible, and the data-protection officers."""
    who = dict.fromkeys(fit(one) for row in rows for one in row["controllers"])
    officers = dict.fromkeys(fit(one) for row in rows for one in row["officers"])
    return "; ".join([*who, *(index.words("record.dpo", name=one) for one in officers)])


def _with_pending(
    rows: Sequence[Mapping[str, Any]], key: str, fact: str, text_of: Callable[[str], str], index: Index,
    decided: Iterable[str] = (),
) -> str:  # fmt: skip
    stated = dict.fromkeys([*(one for row in rows for one in row[key]), *decided])
    lacking = not stated or any(fact in row["missing"] for row in rows)
    return "; ".join([*map(text_of, stated), *([index.words("record.open")] if lacking else [])])
