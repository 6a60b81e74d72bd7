"""What a report begins with: what a person has to decide, place by place, the worst first; a flow is decided once.

In: an ``Index`` and the entries of the report, in the order of ``finding_order``. Out: ``OpeningSection``, in plain
texts. What nobody has reviewed is told beside it: that little is listed never means that little can happen (rule S11).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.legal import Lack
from rosprivacy.analysis.model.register_row import Cell
from rosprivacy.report.catalogs.words import first_of
from rosprivacy.report.finding_facts import gaps_of
from rosprivacy.report.naming import count_rows
from rosprivacy.report.page.exits import exit_cards, is_owned, kinds_in_words
from rosprivacy.report.page.flows import TO_DECIDE, first_names
from rosprivacy.report.row_texts import of_all

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.report.page.exits import ExitCard
    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.flows import ToDecide
    from rosprivacy.report.page.index import Index

BOUND = 12  # cards; the others are told by their number
LACKING = {  # key of words -> what an acceptance lacks; None: it was changed since
    "opening.but.article_9": Lack.ARTICLE_9,
    "opening.but.article_10": Lack.ARTICLE_10,
    "opening.but.chapter_v": Lack.CHAPTER_V,
    "opening.but.changed": None,
    "opening.but.no_end": Lack.NO_END,
}
STATED = 3  # controllers, and purposes, that are named
PLACES = 3  # groups of places that the first sentence names


@dataclass(frozen=True, slots=True)
class OpeningSection:
    """The beginning of a report.

    Attributes
    ----------
    frame
        (what, value): who is responsible, and what for; what is not stated is to be completed, who decides too.
    headline
        How many things wait for a decision; without any, the verdict.
    sentences
        What else is decided, and what is not known.
    gist
        Which data can get where, in one sentence, for a page without the cards.
    cards
        The places of exit; ``remainder`` tells how many others there are than those that are shown.
    count
        How many flows are to be decided.
    """

    frame: tuple[tuple[str, str], ...]
    headline: str
    sentences: tuple[str, ...]
    cards: tuple[ExitCard, ...] = ()
    count: int = 0
    remainder: str = ""
    gist: str = ""

    @property
    def shown(self) -> tuple[ExitCard, ...]:
        """The cards that the page shows."""
        return first_of(self.cards, BOUND)[0]

    @property
    def rows(self) -> tuple[ToDecide, ...]:
        """The flows to decide, in the order of the cards."""
        return tuple(flow for card in self.cards for flow in card.flows)


def opening(
    index: Index,
    flows: Sequence[ToDecide],
    entries: Iterable[PathEntry],
    verdict: tuple[str, str],
    doubts: tuple[str, ...] = (),
) -> OpeningSection:
    """Return what a report begins with.

    Parameters
    ----------
    flows
        All of them, see ``flows``.
    entries
        All entries of the report.
    verdict
        Its verdict, and what that means, in words: of a report without anything to decide.
    doubts
        What is in doubt, in sentences.

    Complexity: O(flows).
    """
    words = index.words
    rows = [flow for flow in flows if flow.entries[0].state in TO_DECIDE]
    frame = tuple(_frame(rows, index))
    waiting = sum(row.waits for row in rows)
    cards = exit_cards(index, flows, entries)
    unfounded = tuple(_unfounded(index, flows))
    _, left = first_of(cards, BOUND)
    more = words.count(left, "opening.more") if left else ""
    if not rows:
        headline, means = verdict
        sentences = (means, *unfounded, *doubts, *_first_to_review(index))
        return OpeningSection(frame, headline, sentences, cards, remainder=more)
    headline = words.count(waiting, "opening.decide") if waiting else words.count(len(rows), "opening.carry")
    decided = [words.count(len(rows) - waiting, "opening.decided")] if 0 < waiting < len(rows) else []
    sentences = (*decided, *unfounded, *_unreviewed(index), *doubts)
    return OpeningSection(frame, headline, sentences, cards, len(rows), more, gist=_gist(rows, index))


def _frame(rows: Sequence[ToDecide], index: Index) -> Iterator[tuple[str, str]]:
    """The controller and the purposes (Article 30(1)(a) and (b)), as the register has them; that nobody decides."""
    words = index.words
    for title, field, cell in (
        ("column.controllers", "controllers", Cell.CONTROLLERS),
        ("opening.purpose", "purposes", Cell.PURPOSES),
    ):
        yield words(title), "; ".join(words.first(of_all(index.register, field, cell, words), STATED))
    if rows and not is_owned(rows):
        yield words("opening.owner"), words("record.open")


def _unfounded(index: Index, flows: Sequence[ToDecide]) -> Iterator[str]:
    """What is accepted and lacks a ground or an end, or is not what it was: data goes there all the same."""
    accepted = [
        [index.by_id[entry.id] for entry in flow.entries] for flow in flows if flow.entries[0].state == "accepted"
    ]
    counts = dict.fromkeys(LACKING, 0)
    for findings in accepted:
        decisions = [finding["decision"] for finding in findings if finding.get("decision")]
        lacks = {gap.lack for decision in decisions for gap in gaps_of(decision, findings)}
        for key, lack in LACKING.items():
            changed = lack is None and any(decision.get("changed") for decision in decisions)
            counts[key] += changed or lack in lacks
    parts = [index.words.count(count, key) for key, count in counts.items() if count]
    if parts:
        yield index.words("opening.but", what="; ".join(parts))


def _gist(rows: Sequence[ToDecide], index: Index) -> str:
    """What is there: which data can get to whom."""
    words = index.words
    at: dict[str, list[PathEntry]] = {}
    for row in rows:
        at.setdefault(row.leak, []).extend(row.entries)
    every = {entry.category for row in rows for entry in row.entries}
    places: dict[str, list[str]] = {}
    for leak, entries in at.items():
        places.setdefault(kinds_in_words(entries, every, index), []).append(leak)
    first, left = first_of(tuple(places.items()), PLACES)
    said = [words("opening.can", data=data, leak=first_names(leaks, index)) for data, leaks in first]
    rest = sum(len(leaks) for leaks in list(places.values())[-left:]) if left else 0
    said += [words.count(rest, "opening.places")] if rest else []
    sentence = "; ".join(said)
    return f"{sentence[:1].upper()}{sentence[1:]}."


def _unreviewed(index: Index) -> Iterator[str]:
    if index.document["open"]:
        count = count_rows(index.document["open"]).elements
        yield index.words("opening.open", open=index.words.count(count, "element"))


def _first_to_review(index: Index) -> Iterator[str]:
    first = [row["element"] for row in index.document["open"] if row["frontier"]]
    if first:
        yield index.words("opening.review", names=first_names(index.names(first), index))
