"""A person who knows the truth and says nothing else: answers what it says, and types the line where no answer fits."""

from __future__ import annotations

from collections import defaultdict
from string import ascii_uppercase
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import GLOB
from rosprivacy.analysis.suggesting.label_questions import (
    BRINGS_IN,
    GOES_THROUGH,
    LETS_OUT,
    LISTED,
    MAKES,
    YES,
    LabelQuestion,
)
from rosprivacy.labelling.conversation import EACH_KIND, EXACTLY, FEWEST, NO, OPEN, SKIP, allowed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import Statement
    from rosprivacy.analysis.suggesting.label_questions import Reply, Row
    from rosprivacy.result import Result

    Identity = tuple[str, str, str]
ENTER = "\n"
ENDS = {BRINGS_IN: "source", LETS_OUT: "leak", MAKES: "derivation"}


class Knowledge:
    """What the truth says of elements."""

    def __init__(self, result: Result) -> None:
        self.hierarchy: Hierarchy = result.vocabulary.hierarchy
        self.of: dict[Identity, list[Statement]] = defaultdict(list)
        for vertex, said in result.bound.elements.items():
            self.of[result.analysis.graph.elements[vertex].identity] += [one for one in said if not one.shipped]

    def key(self, question: LabelQuestion, row: Row) -> str:
        """The key that says of a row what is true, and nothing else; ``SKIP`` if none does."""
        said = self.of.get(row.element.identity, [])
        if any(one.naming == GLOB for one in said):
            return SKIP  # one line says it of many
        for reply in row.replies:
            if self._true(reply, row, said):
                return reply.key
        role = ENDS.get(question.about)
        if role and not any(one.role == role and self._near(one, row.kinds) for one in said):
            return NO
        by_kind = [self.key(question, one) for one in row.by_kind]
        return EACH_KIND if by_kind and SKIP not in by_kind else SKIP

    def _near(self, one: Statement, kinds: Iterable[str]) -> bool:
        return any(self.hierarchy.overlap(kind, other) is not None for kind in kinds for other in one.categories)

    def _covers(self, one: Statement, kind: str) -> bool:
        return not one.categories or any(other in self.hierarchy.ancestors[kind] for other in one.categories)

    def _true(self, reply: Reply, row: Row, said: Sequence[Statement]) -> bool:
        ((role, value),) = reply.label.roles.items()
        if role in ("sensitive", "only", "never"):
            return bool(said) and self._goes_through(role, value, row.kinds, said)
        if role == "derives":
            return all(
                any(s.role == "derivation" and (s.categories, s.to) == ((one["from"],), one["to"]) for s in said)
                for one in value
            )
        if role == "sanitizer":
            return all(
                any(s.role == role and str(s.method) == method and self._covers(s, kind) for s in said)
                for kind, method in value.items()
            )
        if role == "source":
            return all(
                any(s.role == role and s.categories == (kind,) and not s.through for s in said) for kind in value
            )
        return all(any(s.role == role and self._covers(s, kind) for s in said) for kind in value)

    def _goes_through(self, role: str, value: Any, kinds: Sequence[str], said: Sequence[Statement]) -> bool:
        """Whether of the kinds that are asked about just those can go through that the reply lets through."""
        can = {kind for kind in kinds if self._can(kind, said)}
        return can == (set(value) if role != "never" else set())

    def _can(self, kind: str, said: Sequence[Statement]) -> bool:
        if any(one.role in ("mundane", "never") and self._covers(one, kind) for one in said):
            return False
        only = [one for one in said if one.role == "only"]
        return any(self._covers(one, kind) for one in only) if only else True


class ScriptedPerson:
    """Answers questions; the rows that no answer fits are typed by hand.

    Attributes
    ----------
    typed
        Called with elements of which the truth may say something that no answer says; returns whether it does.
    keys
        All that were pressed.
    rows
        How many rows of questions were shown.
    """

    def __init__(self, knowledge: Knowledge, typed: Callable[[Iterable[Identity]], bool]) -> None:
        self.knowledge, self.typed = knowledge, typed
        self.keys: list[str] = []
        self.remarks: list[str] = []
        self.rows = 0
        self._shown: LabelQuestion | None = None
        self._next: Iterator[str] = iter(())

    def key(self, question: LabelQuestion, picked: frozenset[int]) -> str:
        """Give the smaller parts of a question their answers, one key after the other; the largest part comes last."""
        del picked
        self.rows += len(question.rows) if question != self._shown else 0
        self._shown = question
        key = next(self._next, "")
        if not key:
            self._next = self._answer(question)
            key = next(self._next)
        self.keys += [*key, ENTER] if question.about == LISTED and key.isdigit() else [key]
        return key

    def remark(self, remark: str) -> None:
        """Keep what is said."""
        self.remarks.append(remark)

    def _answer(self, question: LabelQuestion) -> Iterator[str]:
        if question.about == LISTED:
            out = [at for at, row in enumerate(question.rows) if not row.reply(self.knowledge.key(question, row))]
            left = len(question.rows) - len(out)
            if left >= FEWEST:
                yield from (ascii_uppercase[at] for at in out)
            yield str(left) if left >= FEWEST else OPEN
            return
        parts: dict[tuple[str, int], list[int]] = defaultdict(list)
        for at, row in enumerate(question.rows):
            key = self.knowledge.key(question, row)
            alone = _takes_away(row, key) and question.about != GOES_THROUGH
            parts[key, at if alone else -1].append(at)
        if {key for key, _ in parts} == {YES, NO}:
            yield from (ascii_uppercase[at] for at in parts[YES, -1])
            yield EXACTLY
            return
        unsaid = parts.get((SKIP, -1), [])
        by_hand = [at for at in unsaid if self.typed([question.rows[at].element.identity])]
        if by_hand:
            key, rows = SKIP, by_hand
        else:
            said = {part: rows for part, rows in parts.items() if part[0] != SKIP}
            (key, _), rows = min((said or parts).items(), key=lambda part: len(part[1]))
        if len(rows) < len(question.rows) or key not in allowed(question):
            yield from (ascii_uppercase[at] for at in rows)
        yield key


def _takes_away(row: Row, key: str) -> bool:
    reply = row.reply(key)
    return bool(reply and reply.takes_away)
