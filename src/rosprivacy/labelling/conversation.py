"""Questions to a person, one at a time, until nothing is left to ask or the person stops (issue 21).

In: what is asked now, who answers, and what keeps an answer. Out: how it ended. It knows neither a terminal nor a file:
the command line and the tests put theirs in. Every answer is kept before the next question.

What takes data away is said of one row alone; or of a list of channels, by the number of its rows: of those that are
alike, or of those that the person has picked one by one before ``0``, or before the digit of a kind. There a letter
takes a row out, and ``o`` takes out all; what is taken out is asked as other channels are.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.question_rows import (
    BRINGS_IN,
    GOES_THROUGH,
    LISTED,
    MAKES,
    MOST_ROWS,
    NOTHING,
    YES,
    Question,
)
from rosprivacy.analysis.suggesting.written import WrittenLabel
from rosprivacy.analysis.text import counted
from rosprivacy.labelling.answer_keys import (
    EACH_KIND,
    EXACTLY,
    FEWEST,
    NO,
    OPEN,
    QUIT,
    SKIP,
    allowed,
    letter,
    takes_away_of_each,
)
from rosprivacy.labelling.question_order import STAGES, by_likeness, waits

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.suggesting.question_rows import Row

BY_ITSELF = "it could close a known finding, and is asked by itself"
CHANGED = "this list is not as it was any more: nothing is kept, and it is asked anew"
FOUND_SINCE = "a finding of such data has become known since: nothing is kept, and it is asked anew"
Identity = tuple[str, str, str]
Said = tuple[str, Identity, tuple[str, ...]]  # what a row asks, in this conversation


class Person(Protocol):
    """Who answers."""

    def key(self, question: Question, picked: frozenset[int]) -> str | WrittenLabel:
        """Return a key, of a list also a number, or a label in place of an answer; nothing if there is no more."""
        ...

    def told(self, remark: str) -> None:
        """Hear what became of the answer."""
        ...


@dataclass
class Conversation:
    """One conversation.

    Attributes
    ----------
    now
        What is asked under the labels as they are.
    keep
        Keeps what is said of all rows of a question by a key, before it returns; returns remarks if it could not.
    closing
        Which of some channels, each with the one reply that is said of it, would close a finding: no list has these.
    typed
        Keeps a label that was typed in place of an answer; returns remarks.
    lists
        How many rows each list had that was confirmed.
    """

    now: Callable[[], Iterable[Question]]
    keep: Callable[[Question, str], tuple[str, ...]]
    person: Person
    closing: Callable[[Sequence[Row]], Sequence[Row]] = lambda rows: rows
    typed: Callable[[WrittenLabel], tuple[str, ...]] = lambda _: ("no label is kept here",)
    answers: int = 0
    _later: dict[tuple[str, Identity], set[str]] = field(default_factory=lambda: defaultdict(set))
    lists: list[int] = field(default_factory=list)
    _alone: set[Said] = field(default_factory=set)
    _taken_out: set[Said] = field(default_factory=set)
    _kind_by_kind: set[tuple[str, Identity]] = field(default_factory=set)

    def run(self) -> bool:
        """Ask; return whether nothing is left to ask, and False if the person has stopped before."""
        while pending := deque(self._left()):
            if not self._round(pending):
                return False
        return True

    def _round(self, pending: deque[Question]) -> bool:
        """Ask until there is more to know of what is left; return False if the person stops."""
        answered: set[int] = set()
        while pending and not waits(pending[0], answered):
            question = pending.popleft()
            if question.about == LISTED:
                return self._listed(question)
            answer = self._answer(question)
            if answer is None:
                return False
            if isinstance(answer, WrittenLabel):
                self._typed(answer)
                return True
            key, rows = answer
            if len(rows) > 1 and takes_away_of_each(rows, key):
                return self._picked([row.saying(key) for row in rows])
            if key == OPEN:
                self._alone.update(_said(question, row) for row in rows)
            elif self._taken(question, rows, key):
                return True
            else:
                answered.add(STAGES[question.about])
            if rest := tuple(row for row in question.rows if row not in rows):
                pending.appendleft(Question(question.about, rest))
            if key == OPEN:
                pending.extendleft(Question(question.about, (row,)) for row in reversed(rows))
        return True

    def _would_close_untold(self, about: str, rows: Sequence[Row], key: str) -> bool:
        """Whether a key takes data away of which a finding is known that was not told: the file may have changed."""
        if not takes_away_of_each(rows, key):
            return False
        said = {(row.element.identity, kind) for row in rows for kind in row.kinds}
        still = (row for one in self._asked() if one.about == about for row in one.rows)
        near = (row for row in still if any((row.element.identity, kind) in said for kind in row.kinds))
        return not {one for row in near for one in row.closes} <= {one for row in rows for one in row.closes}

    def _taken(self, question: Question, rows: Sequence[Row], key: str) -> bool:
        """Take an answer; return whether what is left to ask may have changed by it."""
        if key == EACH_KIND:
            self._kind_by_kind.update((question.about, row.element.identity) for row in rows)
            return True
        if key == SKIP:
            self._postponed(question.about, rows)
            return True  # the person may have written a label by hand
        if self._would_close_untold(question.about, rows, key):
            self.person.told(FOUND_SINCE)
            return True
        if key == EXACTLY:
            self._kept(Question(question.about, tuple(row for row in question.rows if row not in rows)), NO)
            self.answers -= 1  # both are one answer
            self._kept(Question(question.about, tuple(rows)), YES)
            return True
        return self._kept(Question(question.about, tuple(rows)), key)

    def _postponed(self, about: str, rows: Iterable[Row]) -> None:
        for row in rows:
            self._later[about, row.element.identity].update(row.kinds)

    def _is_later(self, question: Question, row: Row) -> bool:
        """Whether the person wants to answer later; also if by now fewer kinds of data get there."""
        return self._later[question.about, row.element.identity].issuperset(row.kinds)

    def _left(self) -> Iterator[Question]:
        """What is asked now, without what the person wants to answer later; what was opened stands alone."""
        for question in self._asked():
            rows = [row for row in question.rows if not self._is_later(question, row)]
            listed = [row for row in rows if row.alike and _said(question, row) not in self._taken_out | self._alone]
            lists = [part for part in by_likeness(listed) if len(part) >= FEWEST]
            in_lists = [row for part in lists for row in part]
            yield from (Question(LISTED, tuple(row.saying(NOTHING) for row in part)) for part in lists)
            together = [row for row in rows if row not in in_lists and _said(question, row) not in self._alone]
            for at in range(0, len(together), MOST_ROWS):
                yield Question(question.about, tuple(together[at : at + MOST_ROWS]))
            yield from (Question(question.about, (row,)) for row in rows if row not in (*together, *in_lists))

    def _asked(self) -> Iterator[Question]:
        """What is asked now; where the person wants it, each kind of data by itself."""
        for question in self.now():
            apart = [
                row.each if (question.about, row.element.identity) in self._kind_by_kind and row.each else (row,)
                for row in question.rows
            ]
            yield Question(question.about, tuple(one for rows in apart for one in rows))

    def _picked(self, rows: Sequence[Row]) -> bool:
        """Ask about channels that the person has picked, as a list; return False if the person stops."""
        apart = self.closing(rows)
        for row in apart:
            self.person.told(f"{row.element.kind} {shown(row.element.name)}: {BY_ITSELF}")
        self._alone.update(map(_of_channel, apart))
        listed = tuple(row for row in rows if row not in apart)
        return len(listed) < FEWEST or self._listed(Question(LISTED, listed), by_hand=True)

    def _listed(self, question: Question, *, by_hand: bool = False) -> bool:
        """Ask about a list; return False if the person stops.

        Parameters
        ----------
        by_hand
            Whether the person has picked its rows.
        """
        out: set[int] = set()
        while True:
            key = self.person.key(question, frozenset(out))
            rows = tuple(row for at, row in enumerate(question.rows) if at not in out)
            if key in ("", QUIT):
                return False
            if isinstance(key, WrittenLabel):
                self._typed(key)
            elif 0 <= letter(key) < len(question.rows):
                out ^= {letter(key)}
                continue
            elif key == OPEN:
                out = set(range(len(question.rows)))
            elif key == SKIP:
                self._postponed(GOES_THROUGH, rows)
            elif key == str(len(rows)) and len(rows) >= FEWEST:
                self._confirmed(Question(LISTED, rows), by_hand=by_hand)
            else:
                self.person.told(f"{key!r} is no answer here; {counted(len(rows), 'row')} left")
                continue
            self._taken_out.update(_of_channel(question.rows[one]) for one in out)
            return True

    def _confirmed(self, question: Question, *, by_hand: bool) -> None:
        """Keep what is said of a list, if it would still be asked: the file may have changed meanwhile."""
        still = [row for one in self._asked() if one.about == GOES_THROUGH for row in one.rows]
        if by_hand:
            asked = {_of_channel(row) for row in still}
            same = all(_of_channel(row) in asked for row in question.rows) and not self.closing(question.rows)
        else:
            same = all(row in [one.saying(NOTHING) for one in still if one.alike] for row in question.rows)
        if not same:
            self.person.told(CHANGED)
            return
        remarks = self.keep(question, question.rows[0].replies[0].key)
        for remark in remarks:
            self.person.told(remark)
        if remarks:
            self._postponed(GOES_THROUGH, question.rows)
        self.answers += 1
        self.lists.append(len(question.rows))

    def _answer(self, question: Question) -> tuple[str, list[Row]] | WrittenLabel | None:
        """The key that is said of rows, and these, or a label in its place; None if the person stops."""
        picked: set[int] = set()
        while True:
            key = self.person.key(question, frozenset(picked))
            rows = [row for at, row in enumerate(question.rows) if at in picked or not picked]
            if key in ("", QUIT):
                return None
            if isinstance(key, WrittenLabel):
                return key
            at = letter(key)
            if 0 <= at < len(question.rows) and len(question.rows) > 1:
                picked ^= {at}
            elif key in allowed(question, picked):
                return key, rows
            else:
                self.person.told(f"{key!r} is no answer here")

    def _typed(self, label: WrittenLabel) -> None:
        for remark in self.typed(label):
            self.person.told(remark)
        self.answers += 1

    def _kept(self, question: Question, key: str) -> bool:
        """Keep an answer; return whether it changes what data get where."""
        remarks = self.keep(question, key)
        for remark in remarks:
            self.person.told(remark)
        if remarks:
            self._postponed(question.about, question.rows)
        self.answers += 1
        if key == NO:
            return False
        reply = question.rows[0].reply(key)
        return question.about in (BRINGS_IN, MAKES) or bool(reply and reply.takes_away)


def _of_channel(row: Row) -> Said:
    return GOES_THROUGH, row.element.identity, row.kinds


def _said(question: Question, row: Row) -> Said:
    return question.about, row.element.identity, row.kinds
