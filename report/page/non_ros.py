"""What lies outside ROS, for a report: storages with their retention, external systems with country and recipient.

In: an ``Index``. Out: rows of plain texts; empty where nobody stated anything. What is not stated is a person's to
complete, so it is left empty and not guessed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import name

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.page.index import Index

STORAGE = "storage"
EVERY = "every"


@dataclass(frozen=True, slots=True)
class Outside:
    """One element outside ROS.

    Attributes
    ----------
    holds
        Kinds of data that get there.
    warnings
        What has to be known and is not stated.
    place
        The line that states it.
    """

    name: str
    kind: str
    storage: bool
    holds: str
    retention: str
    backups: str
    encrypted: str
    country: str
    operator: str
    recipient: str
    transfer: str
    contract: str
    warnings: tuple[str, ...]
    place: str


def outside(index: Index) -> tuple[Outside, ...]:
    """Return all of them, storages first."""
    rows = sorted(index.outside.values(), key=lambda row: row["element"]["kind"] != STORAGE)
    return tuple(_outside(row, index) for row in rows)


def _outside(row: Mapping[str, Any], index: Index) -> Outside:
    words, element = index.words, row["element"]
    warnings = [words(f"missing.{what}") for what in row.get("missing", ())]
    if row.get("without_limit"):
        warnings.append(words("outside.unlimited", data=index.all_data(row["without_limit"])))
    return Outside(
        name=name(element),
        kind=words.kind(element),
        storage=element["kind"] == STORAGE,
        holds=index.all_data(row["holds"]),
        retention=retention(row, index),
        backups=_backups(row.get("backups"), index),
        encrypted="" if "encrypted" not in row else words("yes" if row["encrypted"] else "no"),
        country=country(row, index),
        operator=fit(row.get("operator", "")),
        recipient=words.of_value(f"recipient.{row['recipient']}", row["recipient"]) if row.get("recipient") else "",
        transfer=words.of_value(f"transfer.{row['transfer']}", row["transfer"]) if row.get("transfer") else "",
        contract=fit(row.get("contract", "")),
        warnings=tuple(warnings),
        place=f"{fit(row['file'])}:{row['line']}" if row.get("file") else "",
    )


def country(row: Mapping[str, Any], index: Index) -> str:
    """Return where an element lies, and what holds there; empty if it is not stated."""
    area = index.words(f"area.{row['area']}") if row.get("area") else ""
    return fit(row.get("country", "")) + (f" ({area})" if area else "")


def retention(row: Mapping[str, Any], index: Index) -> str:
    """Return how long a storage keeps what."""
    words = index.words
    return "; ".join(
        words("outside.every", duration=words.duration(fit(duration)))
        if category == EVERY
        else words("outside.of", data=index.data(category), duration=words.duration(fit(duration)))
        for category, duration in row.get("retention", {}).items()
    )


def states_retention(row: Mapping[str, Any], category: str, index: Index) -> bool:
    """Return whether it is stated how long an element keeps a kind of data: of it, a broader one or all."""
    return any(kind in row.get("retention", ()) for kind in (*index.upwards(category), EVERY))


def retention_text(row: Mapping[str, Any], category: str, index: Index) -> str:
    """Return how long a storage keeps one kind of data, as stated of it or of the nearest broader one; with backups."""
    words, stated = index.words, row["retention"]
    nearest = next((kind for kind in index.upwards(category) if kind in stated), EVERY)
    duration = words.duration(fit(stated[nearest])) if nearest in stated else words("not.stated")
    backups = row.get("backups")
    if backups is True:
        return words("outside.kept.backups.unknown", duration=duration)
    return words("outside.kept.backups", duration=duration, more=_backups(backups, index)) if backups else duration


def _backups(value: Any, index: Index) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return index.words("outside.backups.unknown" if value else "no")
    return index.words.duration(fit(str(value)))
