"""The document of proposals -> a table for the terminal: one proposal a line, its reasons under it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.report.contract.suggested import ProposalEntry, SuggestionsDocument

NONE = "nothing to suggest: no rule speaks of what nobody has labelled"
BY_HAND = ", and it would close a finding: only by hand"
WIDEST = 50  # signs of a column


def suggestion_lines(document: SuggestionsDocument) -> Iterator[str]:
    """Yield open elements first, then sources and leaks, then the others; at last how many, and what to do."""
    rows = document["suggestions"]
    if not rows:
        yield NONE
        return
    first = [row for row in rows if row["open"]]
    rest = [row for row in rows if not row["open"]]
    ends = [row for row in rest if row["role"] in ("source", "leak")]
    others = [row for row in rest if row["role"] not in ("source", "leak")]
    for title, group in (
        ("Open elements, in review order:", first),
        ("Sources and leaks that no label names:", ends),
        ("Other elements:", others),
    ):
        if group:
            yield title
            yield from _table(group)
            yield ""
    times = Counter(row["confidence"] for row in rows)
    counts = ", ".join(f"{times[sure]} {sure}" for sure in Confidence if times[sure])
    yield f"{counted(len(rows), 'suggestion')} ({counts}): questions, no facts; nothing is applied that nobody accepts."
    yield f"Write them into a label file with --into labels.yaml, then: rosprivacy labels --accept {_what(rows)}"


def _what(rows: Sequence[ProposalEntry]) -> str:
    """What can be accepted, in the words of the command line: what is sure together, else an element by its name."""
    sure = any(row["confidence"] != Confidence.MAY and not row["hides"] for row in rows)
    return f"{Confidence.LIKELY if sure else 'NAME'} --by 'YOUR NAME' -l labels.yaml"


def _table(rows: Sequence[ProposalEntry]) -> Iterator[str]:
    cells = [(shown(row["name"]), said_of(row), row["confidence"]) for row in rows]
    widths = [min(WIDEST, max(len(row[at]) for row in cells)) for at in (0, 1)]
    for row, (name, said, sure) in zip(rows, cells, strict=True):
        kind = row["section"].removesuffix("s")
        yield f"  {kind:7} {name:{widths[0]}}  {said:{widths[1]}}  {sure}{BY_HAND if row['by_hand'] else ''}"
        yield from (f"            {shown(reason)}" for reason in _reasons(row))


def said_of(row: ProposalEntry) -> str:
    """What a proposal says, in a few words.

    >>> said_of({"role": "sanitizer", "label": {"sanitizer": {"Video": "drop"}}, "kind": "Video"})
    'sanitizer of Video (drop)'
    """
    if row["role"] == "derivation":
        (made,) = row["label"]["derives"]
        return f"derives {made['to']} from {made['from']}"
    if row["role"] == "sanitizer":
        ((kind, method),) = row["label"]["sanitizer"].items()
        return f"sanitizer of {kind} ({method})"
    ((word, kinds),) = row["label"].items()
    return f"{word} {', '.join(kinds)}"


def _reasons(row: ProposalEntry) -> Iterable[str]:
    return dict.fromkeys(reason["reason"] for reason in row["evidence"])
