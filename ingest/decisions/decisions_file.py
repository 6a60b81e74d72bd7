"""Decisions files -> ``Decisions``: what people have decided about findings, on whose word, until when.

In: YAML or JSON in the format of ``docs/decisions.md``. Out: entries in the order of the file, each with its line. All
problems of a file are raised at once. What an entry means for findings is ``analysis/decisions.py``.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field
from datetime import date
from functools import partial
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.decisions import Choice, Decision, Decisions
from rosprivacy.analysis.errors import DecisionError, InputError, shown
from rosprivacy.analysis.legal import LegalQuestion
from rosprivacy.analysis.model import Acceptance, Place
from rosprivacy.analysis.remembered import About
from rosprivacy.analysis.written_names import did_you_mean, nearest
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader, read_values
from rosprivacy.ingest.reading.legal_basis import read_bases

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

TOP = ("decisions", "findings", "doubts", "note")
NAMES = ("id", "row", "category", "source", "leak", "robot", "from_robot", "kind")
IDS = (("id", "a finding"), ("row", "a row of the register"))
LISTS = ("robots", "from_robots")  # of robots, by their full names
TARGET = (*NAMES, *LISTS, "pseudonymised")
TEXTS = ("reason", "owner", "ticket")
CONDITION, ANSWERS = "condition", "answers"
OF_DOUBTS = ("id", "doubt", "element", "robot", "file")
DOUBT_KEYS = (*OF_DOUBTS, "decision", *TEXTS, "date", "expires", "note", "history")
KEYS = (
    *TARGET,
    "decision",
    *TEXTS,
    CONDITION,
    ANSWERS,
    "legal_basis",
    "date",
    "expires",
    "note",
    "history",
    "made_about",
)
REMEMBERED = ("view", "disjoint_paths", "path", "stated", "robots", "from_robots", "findings", "pseudonymised")
IN_ORDER = ("path", "stated")
REMEMBERED_LISTS = REMEMBERED[2:]
REQUIRED: Mapping[str, tuple[str, ...]] = {  # what a person signs
    Choice.ACCEPT: ("reason", "owner"),
    Choice.CONDITIONAL: ("reason", "owner", CONDITION),
}
CODES = tuple(map(str, LegalQuestion))
LONGEST = 10_000  # characters of a text
_ID = re.compile(r"[0-9a-f]{16}")
_DATE = re.compile(r"\d{4}-\d\d-\d\d", re.ASCII)
_COUNT = re.compile(r"[1-9]\d{0,8}", re.ASCII)


def read_decisions(file: str, vocabulary: Vocabulary, day: str, bounds: Bounds = BOUNDS) -> Decisions:
    """Read one decisions file.

    Parameters
    ----------
    day
        ISO date on which decisions are valid or expired.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``DecisionError`` of one line.
    """

    def fail(line: int, problem: str, hint: str) -> InputError:
        return DecisionError(file, line, problem, hint.replace("labels: 1", "decisions: 1"))

    top, data = read_values(file, fail, bounds)
    return _decisions(file, top, data, vocabulary, day)


def parse_decisions(file: str, text: str, vocabulary: Vocabulary, day: str) -> Decisions:
    """Read the text of a decisions file; see ``read_decisions``."""
    top = yaml_values.parse(text, partial(DecisionError, file))
    return _decisions(file, top, text.encode(), vocabulary, day)


def _decisions(file: str, top: Value, data: bytes, vocabulary: Vocabulary, day: str) -> Decisions:
    reader = DecisionsReader(file, vocabulary)
    entries, doubts = tuple(reader.document(top)), tuple(reader.doubts(top))
    digest = hashlib.sha256(data).hexdigest()
    return reader.whole(Decisions(file, digest, day, entries, vocabulary.hierarchy, doubts=doubts))


def is_id(written: str) -> bool:
    """Whether a text is the whole id of a finding."""
    return bool(_ID.fullmatch(written))


def is_date(written: str) -> bool:
    """Whether a text is an ISO date, ``YYYY-MM-DD``."""
    try:
        return bool(_DATE.fullmatch(written)) and bool(date.fromisoformat(written))
    except ValueError:
        return False


@dataclass
class DecisionsReader(FileReader):
    """Reads one decisions file, or what a log says in the same words."""

    vocabulary: Vocabulary
    error: type[InputError] = field(default=DecisionError, kw_only=True)
    ids: dict[tuple[object, ...], int] = field(default_factory=dict)

    def document(self, top: Value) -> Iterator[Decision]:
        """The decisions about findings."""
        if not self.is_format(top, "decisions", "a decisions file"):
            return
        findings = self.values_of(top, TOP).get("findings")
        for item in self.list_of(findings, "findings", "write '- id: …' lines") if findings else ():
            if item.kind != "map":
                self.problem(item.line, f"a decision is a map, not a {item.kind}", "write id: … and decision: …")
            else:
                yield self._decision(item)

    def doubts(self, top: Value) -> Iterator[Acceptance]:
        """What is accepted of the list of doubts; problems of the whole file are reported with the findings."""
        listed = top.get("doubts")
        for item in self.list_of(listed, "doubts", "write '- id: …' lines") if listed else ():
            if item.kind != "map":
                self.problem(item.line, f"a decision is a map, not a {item.kind}", "write id: … and decision: accept")
            else:
                yield self._acceptance(item)

    def _acceptance(self, item: Value) -> Acceptance:
        stated = self.values_of(item, DOUBT_KEYS)
        texts = {key: self._text(stated[key], key) for key in (*OF_DOUBTS, *TEXTS) if key in stated}
        choice = stated.get("decision")
        if choice is None or choice.text != Choice.ACCEPT:
            self.problem(choice.line if choice else item.line, "a doubt is accepted or not", "write decision: accept")
        if not texts.get("id") and not texts.get("doubt"):
            self.problem(item.line, "an acceptance of every doubt", "name the id or the name of a doubt")
        if texts.get("id") and not is_id(texts["id"]):
            self.problem(stated["id"].line, f"id {shown(texts['id'])!r}", "copy the 16 digits and letters of a doubt")
        for key in ("date", "expires"):
            if key in stated:
                texts[key] = self._date(stated[key], key)
        for key in ("reason", "owner", "expires"):
            if not texts.get(key, "").strip():
                self.problem(item.line, f"an accepted doubt without {key}", f"add {key}: it is what a person signs")
        return Acceptance(Place(self.file, item.line), name=texts.pop("doubt", ""), **texts)

    def _decision(self, item: Value) -> Decision:
        before = len(self.problems)
        said = self.values_of(item, KEYS)
        texts: dict[str, Any] = {key: self._text(said[key], key) for key in (*NAMES, *TEXTS, CONDITION) if key in said}
        texts |= {key: tuple(self._names(said[key], key)) for key in LISTS if key in said}
        choice = self._choice(item, said.get("decision"))
        self._target(item, said, texts)
        for key in ("date", "expires"):
            if key in said:
                texts[key] = self._date(said[key], key)
        if "pseudonymised" in said:
            texts["pseudonymised"] = self._flag(said["pseudonymised"])
        if len(self.problems) == before:
            for key in REQUIRED.get(choice, ()):
                if not texts.get(key, "").strip():
                    self.problem(item.line, f"an acceptance without {key}", f"add {key}: it is what a person signs")
        for earlier in said["history"].items if "history" in said else ():
            if earlier.kind != "map":
                self.problem(earlier.line, f"what was decided before is a map, not a {earlier.kind}", "remove it")
        basis = tuple(read_bases(self, said["legal_basis"])) if "legal_basis" in said else ()
        about = self._made_about(said) if "made_about" in said else None
        if ANSWERS in said:
            texts[ANSWERS] = tuple(self._answers(said[ANSWERS]))
        return Decision(choice, Place(self.file, item.line), legal_basis=basis, made_about=about, **texts)

    def _answers(self, value: Value) -> Iterator[tuple[str, str]]:
        """What a person answers to the questions of a row, by code."""
        if value.kind != "map":
            self.problem(value.line, f"answers are a map, not {_a(value)}", f"write {CODES[0]}: …, or remove the key")
            return
        yield from sorted((code, self._text(text, code)) for code, _, text in self.entries_of(value, CODES))

    def _made_about(self, entries: dict[str, Value]) -> About | None:
        """What was there when it was decided; ``rosprivacy decide --report`` writes it."""
        value = entries["made_about"]
        if not entries.keys() & {"id", "row"}:
            self.problem(
                value.line, "made_about without an id or a row", "remove it: names and globs are about what there is"
            )
        elif value.kind != "map":
            self.problem(value.line, f"made_about is a map, not a {value.kind}", "remove it, or decide anew")
        else:
            known = self.values_of(value, REMEMBERED)
            lists = {key: tuple(self._names(known[key], key)) for key in REMEMBERED_LISTS if key in known}
            view = self._text(known["view"], "view") if "view" in known else ""
            count = self._count(known["disjoint_paths"]) if "disjoint_paths" in known else 0
            sets = {key: frozenset(names) for key, names in lists.items() if key not in IN_ORDER}
            return About(view, lists.get("path", ()), count, stated=lists.get("stated", ()), **sets)
        return None

    def _names(self, value: Value, key: str) -> Iterator[str]:
        yield from (self._text(item, key) for item in self.list_of(value, key, "decide anew"))
        if not value.items:
            self.problem(value.line, f"{key} of a decision names nothing", "remove it, or decide anew")

    def _count(self, value: Value) -> int:
        if value.kind != "number" or not _COUNT.fullmatch(value.text):
            self.problem(value.line, f"disjoint_paths takes a number, not {_a(value)}", "remove it, or decide anew")
            return 0
        return int(value.text)

    def _choice(self, item: Value, value: Value | None) -> Choice:
        choices = ", ".join(Choice)
        if value is None:
            self.problem(item.line, "no decision", f"add decision: one of {choices}")
        elif value.kind == "text" and value.text in set(Choice):
            return Choice(value.text)
        else:
            hint = did_you_mean(nearest(value.text, list(Choice)), f"one of {choices}")
            self.problem(value.line, f"decision {shown(value.text or value.kind)!r}", hint)
        return Choice.MITIGATE

    def _target(self, item: Value, entries: dict[str, Value], texts: dict[str, Any]) -> None:
        if not any(texts.get(key) for key in ("id", "row", "category", "source", "leak")):
            self.problem(item.line, "a decision about everything", "name an id, a row, a category, a source or a leak")
        exact = {key: entries[key].line for key, _ in IDS if texts.get(key)}
        for key, thing in IDS:
            if key in exact and not is_id(texts[key]):
                self.problem(exact[key], f"{key} {shown(texts[key])!r}", f"copy the 16 digits and letters of {thing}")
        if exact:
            line, names = max(exact.values()), " ".join(texts[key] for key in exact)
            form = entries["pseudonymised"].text if "pseudonymised" in entries else ""
            robots = (frozenset(texts.get(key, ())) for key in LISTS)
            first = self.ids.setdefault((*exact, names, form, *robots), line)
            if first != line:
                self.problem(line, f"{names} again, first in line {first}", "keep one")
        for one, several in (("robot", "robots"), ("from_robot", "from_robots")):
            if one in entries and several in entries:
                self.problem(entries[several].line, f"{one} and {several}", "keep one of the two")
        if texts.get("category"):
            texts["category"] = self.category_of_name(self.vocabulary, texts["category"], entries["category"].line)

    def _text(self, value: Value, key: str) -> str:
        if value.kind == "number" and key in ("id", "row", "ticket"):  # 1234567812345678 is an id too
            return value.text
        if value.kind != "text" or not value.text.strip():
            self.problem(value.line, f"{key} takes text, not {_a(value)}", "write it, or remove the key")
        elif len(value.text) > LONGEST:
            self.problem(value.line, f"{key} of {len(value.text)} characters", f"no more than {LONGEST} are read")
            return ""
        return value.text

    def _date(self, value: Value, key: str) -> str:
        if not is_date(value.text):
            self.problem(value.line, f"{key} {shown(value.text or value.kind)!r} is not a date", "write YYYY-MM-DD")
            return ""
        return value.text

    def _flag(self, value: Value) -> bool:
        if value.text.lower() not in ("true", "false"):
            self.problem(value.line, f"pseudonymised takes true or false, not {_a(value)}", "write one of the two")
        return value.text.lower() == "true"


def _a(value: Value) -> str:
    return {"empty": "nothing", "text": "empty text"}.get(value.kind, f"a {value.kind}")
