"""The cells of a row of the register in words, for every view: the record, the notices, the works council's page.

In: a row of ``register`` and the words of a language. Out: texts. What is not stated is to be completed and never
taken as known.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.legal import transfer_of
from rosprivacy.analysis.model import NO_BASIS
from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.analysis.non_ros import ADEQUATE, INSIDE, PARTLY, THIRD
from rosprivacy.analysis.text import fit

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.catalogs.words import Words

    Row = Mapping[str, Any]  # of the register

ABROAD = (PARTLY, THIRD)  # areas to which a transfer needs a basis of its own, chapter V


def completed(texts: Iterable[str], row: Row, words: Words, *cells: Cell) -> str:
    """Return what a row holds, and that a person has to complete it where something is not known."""
    unknown = any(cell in row["to_complete"] for cell in cells)
    return "; ".join([*dict.fromkeys(texts), *([words("record.open")] if unknown else [])])


def of_all(rows: Sequence[Row], field: str, cell: Cell, words: Words) -> tuple[str, ...]:
    """Return what rows hold in a field, each once, and that a person has to complete it where one row lacks it."""
    stated = dict.fromkeys(fit(one) for row in rows for one in row[field])
    unknown = not rows or any(cell in row["to_complete"] for row in rows)
    return (*stated, *([words("record.open")] if unknown else []))


def recipient(row: Row, words: Words) -> Iterator[str]:
    """Yield who operates the place and as what, as people stated it."""
    role = words.of_value(f"recipient.{row['recipient']}", row["recipient"]) if row["recipient"] else ""
    if stated := [part for part in (fit(row["operator"]), role, fit(row["contract"])) if part]:
        yield ", ".join(stated)


def transfer(row: Row, words: Words) -> Iterator[str]:
    """Yield the safeguard of a transfer, that there is or is stated none; nothing where nothing leaves the EEA."""
    area, stated = row["area"], row["transfer"]
    stated = "" if area == ADEQUATE and stated == NO_BASIS else stated
    articles = {basis for basis in row["safeguards"] if transfer_of(basis) == stated}
    exact = f"transfer.{stated}.{'.'.join(articles)}"  # of clauses of one point of Article 46(2): there are two
    basis = words.of_value(exact, words.of_value(f"transfer.{stated}", stated)) if stated else ""
    if area in ABROAD and not basis:
        yield words(f"record.unbased.{area}", country=fit(row["country"]))
    elif area and area != INSIDE:
        yield words.pair(fit(row["country"]), basis or words("transfer.adequacy"))
    elif basis and not area:
        yield basis


def bases(row: Row, words: Words) -> Iterator[str]:
    """Yield legal bases; of the articles under which one is missing, that it is."""
    for cell, article in ((Cell.BASES, "6(1)"), (Cell.SPECIAL_BASES, "9(2)"), (Cell.CRIMINAL_BASES, "10")):
        yield from map(words.basis, row[cell])
        if cell in row["to_complete"]:
            yield words.pair(article, words("record.open"))
    yield from map(words.basis, row["safeguards"])


def retention(row: Row, words: Words) -> str:
    """Return how long a place keeps the kind, backups too; empty where nobody states it."""
    duration = ", ".join(words.duration(fit(one)) for one in row["retention"])
    return with_backups(duration, row["backups"], words) if duration else ""


def where(row: Row, words: Words) -> str:
    """Return the country of a place, and outside the EEA on which safeguard data get there, or that there is none."""
    return next(transfer(row, words), "") or country(row, words)


def country(row: Mapping[str, Any], words: Words) -> str:
    """Return where an element lies, and what holds there; empty if it is not stated."""
    area = words(f"area.{row['area']}") if row.get("area") else ""
    return fit(row.get("country", "")) + (f" ({area})" if area else "")


def with_backups(duration: str, backups: str | bool | None, words: Words) -> str:  # noqa: FBT001 - as documents have it
    """Return how long data are kept, with how long they stay in backups."""
    if backups is True:
        return words("outside.kept.backups.unknown", duration=duration)
    return words("outside.kept.backups", duration=duration, more=backups_text(backups, words)) if backups else duration


def backups_text(value: Any, words: Words) -> str:
    """Return how long data stay in backups, or whether they do; empty if it is not stated."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return words("outside.backups.unknown" if value else "no")
    return words.duration(fit(str(value)))
