"""How many decisions a person takes, and how many keys are typed, from a policy to what the truth comes to.

By hand, each line of the truth is a decision, and its signs are keys. With questions, each answer is a decision, each
key a key, and so is each line that is typed because nothing asks for it or no answer fits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.label_questions import BRINGS_IN
from rosprivacy.ingest.policies.names import covered
from rosprivacy.labelling.asking import asked_now, closing, with_answer
from rosprivacy.labelling.conversation import Conversation
from rosprivacy.labelling.suggesting import suggest_labels
from rosprivacy.settings import Settings
from rosprivacy.systems.robot_system import answer_robot
from tests.decisions.scripted_person import Knowledge, ScriptedPerson
from tests.decisions.truths import entries

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from rosprivacy.analysis.suggesting.label_questions import LabelQuestion, Row
    from rosprivacy.result import Result
    from tests.decisions.scripted_person import Identity
    from tests.decisions.truths import Entry, Truth

DAY, WHO = "2026-11-23", "Ada"
SECTION_KINDS = {
    "nodes": ("node",), "topics": ("topic",), "services": ("service",), "actions": ("action",),
    "channels": ("topic", "service", "action"),
}  # fmt: skip
ENDS = ("source", "leak", "derivation")


class Count(NamedTuple):
    """What it took.

    Attributes
    ----------
    decisions
        Answers, and lines that were typed.
    taking_away
        Those of them that take data away: each is for one element, by its name.
    typed
        Lines that were typed.
    keys
        Keys that answer, and signs of the lines; of a list the digits and Enter.
    lists
        How many rows each list had of which nothing was said to go through.
    rows
        How many rows were shown, of all questions.
    judged
        Of how many rows something was said, each time; a typed line is one.
    same
        Whether verdict and findings are those of the truth, and nothing is open that is not open there.
    """

    decisions: int
    taking_away: int
    typed: int
    keys: int
    same: bool
    lists: tuple[int, ...] = ()
    rows: int = 0
    judged: int = 0


def by_hand(truth: Truth) -> Count:
    """Count the lines of the truth."""
    lines = entries(truth.text)
    return Count(
        len(lines),
        sum(map(_takes_away, lines)),
        len(lines),
        sum(line.keys for line in lines),
        same=True,
        judged=len(lines),
    )


def asked(truth: Truth, file: Path) -> tuple[Count, ScriptedPerson]:
    """Answer what is asked of a system of which nothing is labelled; return what it took."""
    return _Session(truth, file).run()


class _Session:
    """One person, one file."""

    def __init__(self, truth: Truth, file: Path) -> None:
        self.truth, self.file, self.settings = truth, file, Settings()
        true = file.with_name(f"true-{file.name}")
        true.write_text(truth.text, "utf-8")
        self.goal = answer_robot((truth.policy,), (str(true), *truth.more), self.settings)
        self.left = entries(truth.text)
        self.typed: list[Entry] = []
        self.taking_away = self.judged = 0
        self.person = ScriptedPerson(Knowledge(self.goal), self.type_of)
        self.file.write_text("labels: 1\n", "utf-8")
        self.first = self._now()

    def run(self) -> tuple[Count, ScriptedPerson]:
        conversation = Conversation(self._now, self._keep, self.person, self._closing)
        for line in [*self.left]:
            if self._unasked(line):
                self._type(line)
        conversation.run()
        while not self._reached() and self.left:
            self._type(next((line for line in self.left if self._missing(line)), self.left[0]))
            again = Conversation(self._now, self._keep, self.person, self._closing)
            again.run()
            conversation.answers += again.answers
            conversation.lists += again.lists
        typed = len(self.typed)
        keys = len(self.person.keys) + sum(line.keys for line in self.typed)
        taking = self.taking_away + sum(map(_takes_away, self.typed))
        return Count(
            conversation.answers + typed,
            taking,
            typed,
            keys,
            self._reached(),
            tuple(conversation.lists),
            self.person.rows,
            self.judged + typed,
        ), self.person

    def _unasked(self, line: Entry) -> bool:
        """Whether no question will offer what a line says: what brings in, what is not there, what is outside ROS."""
        if line.section == "elements" or "absent:" in "".join(line.lines):
            return True
        asked = [row for one in self.first if one.about == BRINGS_IN for row in one.rows]
        offered = {(row.element.identity, kind) for row in asked for kind in row.kinds}
        return any(
            (identity, kind) not in offered
            for identity, said in self.person.knowledge.of.items()
            if _speaks_of(line, *identity[1:])
            for one in said
            if one.role == "source"
            for kind in one.categories
        )

    def type_of(self, elements: Iterable[Identity]) -> bool:
        """Type what the truth says of elements; return whether it says something that was not typed before."""
        lines = [one for _, kind, name in elements for one in self.left if _speaks_of(one, kind, name)]
        for line in lines:
            self._type(line)
        return bool(lines)

    def _missing(self, line: Entry) -> bool:
        """Whether what a line says is not said yet: of what is open, and of what brings in, lets out or makes data."""
        if line.section not in SECTION_KINDS:
            return True
        now = self._result()
        said = Knowledge(now).of
        opened = _state(now, "open") - _state(self.goal, "open")
        for identity, statements in self.person.knowledge.of.items():
            if _speaks_of(line, *identity[1:]):
                ends = {(one.role, one.categories) for one in statements if one.role in ENDS}
                if identity in opened or ends - {(one.role, one.categories) for one in said.get(identity, ())}:
                    return True
        return False

    def _type(self, line: Entry) -> None:
        """Put a line at the beginning of its section, in the words of the truth, in place of what answers have put."""
        self.left.remove(line)
        self.typed.append(line)
        text = [
            one
            for section, one in _with_sections(self.file.read_text("utf-8"))
            if not (one.startswith(f"  {line.name}:") and (section == "nodes") == (line.section == "nodes"))
        ]
        if f"{line.section}:" not in text:
            text += [f"{line.section}:"]
        at = text.index(f"{line.section}:") + 1
        self.file.write_text("\n".join([*text[:at], *line.lines, *text[at:], ""]), "utf-8")

    def _result(self) -> Result:
        return answer_robot((self.truth.policy,), (str(self.file), *self.truth.more), self.settings)

    def _reached(self) -> bool:
        return all(_state(self._result(), part) <= _state(self.goal, part) for part in ("open",)) and all(
            _state(self._result(), part) == _state(self.goal, part) for part in ("verdict", "findings")
        )

    def _now(self) -> tuple[LabelQuestion, ...]:
        if self._reached():
            return ()
        return asked_now(suggest_labels((self.truth.policy,), (str(self.file), *self.truth.more), self.settings))

    def _closing(self, rows: Sequence[Row]) -> Sequence[Row]:
        return closing(rows, self._result())

    def _keep(self, question: LabelQuestion, key: str) -> tuple[str, ...]:
        written = with_answer(str(self.file), question, key, WHO, DAY, self.settings)
        self.file.write_text(written.text, "utf-8")
        self.judged += len(question.rows)
        reply = question.rows[0].reply(key)
        self.taking_away += bool(reply and reply.takes_away)
        return written.remarks


def _with_sections(text: str) -> Iterator[tuple[str, str]]:
    section = ""
    for line in text.splitlines():
        section = section if line.startswith((" ", "#")) else line.partition(":")[0]
        yield section, line


def _state(result: Result, part: str) -> frozenset[object]:
    analysis = result.analysis
    if part == "verdict":
        return frozenset([str(analysis.verdict)])
    if part == "findings":
        return frozenset(one.id for one in analysis.findings)
    return frozenset(one.element.identity for one in analysis.open)


def _speaks_of(line: Entry, kind: str, name: str) -> bool:
    return kind in SECTION_KINDS.get(line.section, ()) and bool(covered(line.name, [name]))


def _takes_away(line: Entry) -> bool:
    text = "".join(line.lines)
    return any(word in text for word in ("mundane", "only:", "never:", "sanitizer:", "absent:"))
