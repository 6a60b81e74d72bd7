"""The document of bags -> a table, one row a bag, as CSV for spreadsheets and databases."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable
from rosprivacy.report.spreadsheet import as_csv

if TYPE_CHECKING:
    from rosprivacy.report.contract.bags import BagEntry, BagsDocument

HEAD = (
    "bag", "verdict", "kinds", "open_topics", "complete", "storage", "distro", "compression", "bytes", "start", "end",
    "messages", "topics", "not_known", "suggested",
)  # fmt: skip


def bag_table(document: BagsDocument) -> str:
    """Return the table; several values in a cell are separated by spaces, sentences by semicolons."""
    return as_csv(HEAD, (_row(bag) for bag in document["bags"]))


def _row(bag: BagEntry) -> tuple[str | float, ...]:
    return (
        printable(bag["bag"]),
        bag["verdict"],
        " ".join(bag["kinds"]),
        " ".join(map(printable, bag["open_topics"])),
        "yes" if bag["complete"] else "no",
        printable(bag["storage"]),
        printable(bag["distro"]),
        bag["compression"],
        bag["bytes"],
        bag["start"] or "",
        bag["end"] or "",
        "" if bag["messages"] is None else bag["messages"],
        len(bag["topics"]),
        "; ".join([*bag["gaps"], *bag["beside"]]),
        "; ".join(f"{one['kind']} ({one['confidence']})" for one in bag["suggested"]),
    )
