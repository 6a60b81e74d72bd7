"""Questions to a person, one at a time, until nothing is left to ask or the person stops; and which keys answer them.

In: what is asked now, who answers, and what keeps an answer. Out: how it ended. It knows neither a terminal nor a file:
the command line and the tests put theirs in. Every answer is kept before the next question.

A letter from A on picks a row, or puts it back; all other keys speak of the picked rows, or of all if none is picked.
``x`` says yes to the picked rows and no to the others; ``k`` asks about each kind of data by itself. What takes data
away is said of one row alone; or of a list of channels, by the number of its rows: of those that are alike, or of those
that the person has picked one by one before ``0``, or before the digit of a kind. There a letter takes a row out, and
``o`` takes out all; what is taken out is asked as other channels are.

A file of keys may have been made for other questions. There a line says what takes data away: it names each element and
what is written of it, and is an answer to the one question that offers it, word for word.
"""

from __future__ import annotations

from collections import defaultdict, deque
from dataclasses import dataclass, field
from string import ascii_uppercase
from typing import TYPE_CHECKING, Protocol

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.suggesting.evidence import WrittenLabel
from rosprivacy.analysis.suggesting.label_questions import (
    BRINGS_IN,
    GOES_ON,
    GOES_THROUGH,
    LETS_OUT,
    LISTED,
    MAKES,
    MOST_ROWS,
    NOTHING,
    PASSES,
    YES,
    LabelQuestion,
)
from rosprivacy.analysis.text import counted

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

    from rosprivacy.analysis.suggesting.evidence import Identity
    from rosprivacy.analysis.suggesting.label_questions import Alike, Reply, Row

    Said = tuple[str, Identity, tuple[str, ...]]  # what a row asks, in this conversation

NO, OPEN, SKIP, QUIT, EXACTLY, EACH_KIND, UNDO = "n", "o", "s", "q", "x", "k", "u"
FEWEST = 2  # rows of a list: one row is asked by itself
BEGINS, AND = "/", "; "  # a name begins so; between the rows of a list
STAGES = {
    BRINGS_IN: 0,
    LETS_OUT: 0,
    MAKES: 0,
    GOES_ON: 1,
    GOES_THROUGH: 2,
    LISTED: 2,
}  # a leak is known before the next
BY_ITSELF = "it could close a known finding, and is asked by itself"
CHANGED = "this list is not as it was any more: nothing is kept, and it is asked anew"
FOUND_SINCE = "a finding of such data has become known since: nothing is kept, and it is asked anew"


class Person(Protocol):
    """Who answers."""

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str | WrittenLabel:
        """Return a key, of a list also a number, or a label in place of an answer; nothing if there is no more."""
        ...

    def remark(self, remark: str) -> None:
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
    undo
        Takes so many changes back that ``keep`` and ``typed`` made last; returns why not, or nothing.
    lists
        How many rows each list had that was confirmed.
    """

    now: Callable[[], Iterable[LabelQuestion]]
    keep: Callable[[LabelQuestion, str], tuple[str, ...]]
    person: Person
    closing: Callable[[Sequence[Row]], Sequence[Row]] = lambda rows: rows
    typed: Callable[[WrittenLabel], tuple[str, ...]] = lambda _: ("no label is kept here",)
    undo: Callable[[int], str] = lambda _: "nothing is taken back here"
    answers: int = 0
    _later: dict[tuple[str, Identity], set[str]] = field(default_factory=lambda: defaultdict(set))
    lists: list[int] = field(default_factory=list)
    _alone: set[Said] = field(default_factory=set)
    _taken_out: set[Said] = field(default_factory=set)
    _kind_by_kind: set[tuple[str, Identity]] = field(default_factory=set)
    _changes: list[int] = field(default_factory=list)  # of each answer

    def run(self) -> bool:
        """Ask; return whether nothing is left to ask, and False if the person has stopped before."""
        while pending := deque(self._pending()):
            if not self._round(pending):
                return False
        return True

    def _round(self, pending: deque[LabelQuestion]) -> bool:
        """Ask until there is more to know of what is left; return False if the person stops."""
        answered: set[int] = set()
        while pending and not _waits(pending[0], answered):
            question = pending.popleft()
            if question.about == LISTED:
                return self._listed(question)
            answer = self._answer(question)
            if answer is None:
                return False
            if isinstance(answer, WrittenLabel) or answer[0] == UNDO:
                self._typed(answer) if isinstance(answer, WrittenLabel) else self._take_back()
                return True
            key, rows = answer
            if len(rows) > 1 and takes_away_of_each(rows, key):
                return self._picked([row.saying(key) for row in rows])
            if key == OPEN:
                self._alone.update(_row_key(question, row) for row in rows)
            elif self._take_answer(question, rows, key):
                return True
            else:
                answered.add(STAGES[question.about])
            if rest := tuple(row for row in question.rows if row not in rows):
                pending.appendleft(LabelQuestion(question.about, rest))
            if key == OPEN:
                pending.extendleft(LabelQuestion(question.about, (row,)) for row in reversed(rows))
        return True

    def _would_close_untold(self, about: str, rows: Sequence[Row], key: str) -> bool:
        """Whether a key takes data away of which a finding is known that was not told: the file may have changed."""
        if not takes_away_of_each(rows, key):
            return False
        said = {(row.element.identity, kind) for row in rows for kind in row.kinds}
        still = (row for one in self._questions_now() if one.about == about for row in one.rows)
        near = (row for row in still if any((row.element.identity, kind) in said for kind in row.kinds))
        return not {one for row in near for one in row.closes} <= {one for row in rows for one in row.closes}

    def _take_answer(self, question: LabelQuestion, rows: Sequence[Row], key: str) -> bool:
        """Take an answer; return whether what is left to ask may have changed by it."""
        if key == EACH_KIND:
            self._kind_by_kind.update((question.about, row.element.identity) for row in rows)
            return True
        if key == SKIP:
            self._postponed(question.about, rows)
            return True  # the person may have written a label by hand
        if self._would_close_untold(question.about, rows, key):
            self.person.remark(FOUND_SINCE)
            return True
        if key == EXACTLY:
            self._keep_answer(LabelQuestion(question.about, tuple(row for row in question.rows if row not in rows)), NO)
            self.answers -= 1  # both are one answer
            self._keep_answer(LabelQuestion(question.about, tuple(rows)), YES)
            self._changes[-2:] = [sum(self._changes[-2:])]
            return True
        return self._keep_answer(LabelQuestion(question.about, tuple(rows)), key)

    def _postponed(self, about: str, rows: Iterable[Row]) -> None:
        for row in rows:
            self._later[about, row.element.identity].update(row.kinds)

    def _is_later(self, question: LabelQuestion, row: Row) -> bool:
        """Whether the person wants to answer later; also if by now fewer kinds of data get there."""
        return self._later[question.about, row.element.identity].issuperset(row.kinds)

    def _pending(self) -> Iterator[LabelQuestion]:
        """What is asked now, without what the person wants to answer later; what was opened stands alone."""
        for question in self._questions_now():
            rows = [row for row in question.rows if not self._is_later(question, row)]
            listed = [row for row in rows if row.alike and _row_key(question, row) not in self._taken_out | self._alone]
            lists = [part for part in by_likeness(listed) if len(part) >= FEWEST]
            in_lists = [row for part in lists for row in part]
            yield from (LabelQuestion(LISTED, tuple(row.saying(NOTHING) for row in part)) for part in lists)
            together = [row for row in rows if row not in in_lists and _row_key(question, row) not in self._alone]
            for at in range(0, len(together), MOST_ROWS):
                yield LabelQuestion(question.about, tuple(together[at : at + MOST_ROWS]))
            yield from (LabelQuestion(question.about, (row,)) for row in rows if row not in (*together, *in_lists))

    def _questions_now(self) -> Iterator[LabelQuestion]:
        """What is asked now; where the person wants it, each kind of data by itself."""
        for question in self.now():
            apart = [
                row.by_kind if (question.about, row.element.identity) in self._kind_by_kind and row.by_kind else (row,)
                for row in question.rows
            ]
            yield LabelQuestion(question.about, tuple(one for rows in apart for one in rows))

    def _picked(self, rows: Sequence[Row]) -> bool:
        """Ask about channels that the person has picked, as a list; return False if the person stops."""
        apart = self.closing(rows)
        for row in apart:
            self.person.remark(f"{row.element.kind} {shown(row.element.name)}: {BY_ITSELF}")
        self._alone.update(map(_of_channel, apart))
        listed = tuple(row for row in rows if row not in apart)
        return len(listed) < FEWEST or self._listed(LabelQuestion(LISTED, listed), by_hand=True)

    def _listed(self, question: LabelQuestion, *, by_hand: bool = False) -> bool:
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
            elif key == UNDO:
                self._take_back()
            elif key == str(len(rows)) and len(rows) >= FEWEST:
                self._confirmed(LabelQuestion(LISTED, rows), by_hand=by_hand)
            else:
                self.person.remark(f"{key!r} is no answer here; {counted(len(rows), 'row')} left")
                continue
            self._taken_out.update(_of_channel(question.rows[one]) for one in out)
            return True

    def _confirmed(self, question: LabelQuestion, *, by_hand: bool) -> None:
        """Keep what is said of a list, if it would still be asked: the file may have changed meanwhile."""
        still = [row for one in self._questions_now() if one.about == GOES_THROUGH for row in one.rows]
        if by_hand:
            asked = {_of_channel(row) for row in still}
            same = all(_of_channel(row) in asked for row in question.rows) and not self.closing(question.rows)
        else:
            same = all(row in [one.saying(NOTHING) for one in still if one.alike] for row in question.rows)
        if not same:
            self.person.remark(CHANGED)
            return
        remarks = self.keep(question, question.rows[0].replies[0].key)
        for remark in remarks:
            self.person.remark(remark)
        if remarks:
            self._postponed(GOES_THROUGH, question.rows)
        self._count()
        self.lists.append(len(question.rows))

    def _answer(self, question: LabelQuestion) -> tuple[str, list[Row]] | WrittenLabel | None:
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
            elif key == UNDO or key in allowed(question, picked):
                return key, rows
            else:
                self.person.remark(f"{key!r} is no answer here")

    def _typed(self, label: WrittenLabel) -> None:
        for remark in self.typed(label):
            self.person.remark(remark)
        self._count()

    def _count(self) -> None:
        self.answers += 1
        self._changes.append(1)

    def _take_back(self) -> None:
        """Ask the last answer anew."""
        why = self.undo(self._changes[-1]) if self._changes else "there is no answer to take back"
        if why:
            self.person.remark(why)
            return
        self._changes.pop()
        self.answers -= 1

    def _keep_answer(self, question: LabelQuestion, key: str) -> bool:
        """Keep an answer; return whether it changes what data get where."""
        remarks = self.keep(question, key)
        for remark in remarks:
            self.person.remark(remark)
        if remarks:
            self._postponed(question.about, question.rows)
        self._count()
        if key == NO:
            return False
        reply = question.rows[0].reply(key)
        return question.about in (BRINGS_IN, MAKES) or bool(reply and reply.takes_away)


def _of_channel(row: Row) -> Said:
    return GOES_THROUGH, row.element.identity, row.kinds


def _row_key(question: LabelQuestion, row: Row) -> Said:
    return question.about, row.element.identity, row.kinds


def allowed(question: LabelQuestion, picked: Collection[int] = ()) -> tuple[str, ...]:
    """Return the keys that answer a question about the rows that are picked, or about all.

    What takes data away of several channels asks about them as a list, if they are picked.
    """
    rows = tuple(row for at, row in enumerate(question.rows) if at in picked or not picked)
    keys = LabelQuestion(question.about, rows).keys()
    if question.about == GOES_THROUGH and len(picked) >= FEWEST:
        keys += tuple(one.key for one in rows[0].replies if takes_away_of_each(rows, one.key))
    if len(rows) > 1 and not picked and any(row.doubtful for row in rows):
        keys = tuple(key for key in keys if key != PASSES)  # it may be a leak: look at each
    refuse = all(row.refused for row in question.rows)
    exactly = refuse and YES in keys and len(rows) < len(question.rows)
    by_kind = any(row.by_kind for row in rows)
    more = ((EXACTLY, exactly), (NO, refuse), (OPEN, len(rows) > 1), (EACH_KIND, by_kind), (SKIP, True))
    return (*keys, *(key for key, there in more if there))


def letter(key: str) -> int:
    """Return which row a key means; -1 if none. Several signs that come at once are no letter."""
    return ascii_uppercase.find(key) if len(key) == 1 else -1


def takes_away_of_each(rows: Sequence[Row], key: str) -> bool:
    """Return whether a key takes data away of each of some rows."""
    replies = [row.reply(key) for row in rows]
    return all(reply and reply.takes_away for reply in replies)


def _waits(question: LabelQuestion, answered: Collection[int]) -> bool:
    """Return whether what some stages were answered has to be worked out before a question can be asked."""
    stage = STAGES[question.about]
    return any(one < stage for one in answered) or (bool(answered) and _tells_findings(question))


def _tells_findings(question: LabelQuestion) -> bool:
    """Whether a question has to tell findings that an answer before it may have made known: a leak among nodes is one.

    No answer about a channel makes a finding known.
    """
    takes_away = any(reply.takes_away for row in question.rows for reply in row.replies)
    return takes_away and question.about != GOES_THROUGH


def by_likeness(rows: Iterable[Row]) -> tuple[tuple[Row, ...], ...]:
    """Return the rows that share what they are alike in, and their kinds, together; in their order."""
    parts: dict[tuple[Alike, tuple[str, ...]], list[Row]] = {}
    for row in rows:
        parts.setdefault((row.alike, row.kinds), []).append(row)
    return tuple(map(tuple, parts.values()))


def line_of(row: Row, reply: Reply) -> str:
    """Return the line that says a reply of a row."""
    ((role, value),) = reply.label.roles.items()
    kinds = [f"{kind} {method}" for kind, method in value.items()] if isinstance(value, dict) else value
    return " ".join([row.element.name, row.element.kind, role, *kinds])


def takes_away(question: LabelQuestion, key: str) -> bool:
    """Return whether a key of some row takes data away."""
    replies = [row.reply(key) for row in question.rows]
    return any(reply and reply.takes_away for reply in replies)


def lines_of(question: LabelQuestion, key: str) -> tuple[str, ...]:
    """Return the lines that say of each row what a key would; of what takes nothing away none.

    Parameters
    ----------
    key
        Of a list any digit.
    """
    whole = question.about == LISTED
    replies = [(row, reply) for row in question.rows for reply in row.replies if whole or reply.key == key]
    return tuple(line_of(row, reply) for row, reply in replies if reply.takes_away)


def keys_of(line: str, question: LabelQuestion, picked: Collection[int]) -> tuple[str, ...]:
    """Return the keys that a line comes to; none if the question does not offer what it says.

    Parameters
    ----------
    picked
        Rows that are picked; of a list those that are taken out.
    """
    wanted = line.strip().split(AND)
    offered = [
        (line_of(row, reply), at, reply.key)
        for at, row in enumerate(question.rows)
        for reply in row.replies
        if reply.takes_away
    ]
    found = {at: key for said, at, key in offered if said in wanted}
    if len(found) != len(wanted) or len(set(wanted)) != len(wanted):
        return ()
    if question.about == LISTED:
        out = set(range(len(question.rows))) - set(found)
        return (*_letters(out ^ set(picked)), str(len(found))) if len(found) >= FEWEST else ()
    if len(found) != 1:
        return ()
    ((at, key),) = found.items()
    return (*(_letters({at} ^ set(picked)) if len(question.rows) > 1 else ()), key)


def _letters(rows: Collection[int]) -> tuple[str, ...]:
    return tuple(ascii_uppercase[at] for at in sorted(rows))
