"""Files of rules: ``ontology/names.yaml`` and ``ontology/libraries.yaml``, and users' files of these formats.

A file has sections, and a section has rules: which names they are about, and what these suggest. A phrase or a name of
a user's file stands for the same one of ours; of one file everything is said once in a section.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.evidence import ANYTHING, SORTS, WHERE
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, CPP, PROGRAM, PYTHON, LibraryRules, RulesByName
from rosprivacy.analysis.suggesting.name_rules import LONGEST_PHRASE, NameRule, NameRules, words
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader
from rosprivacy.ontology.vocabulary import FOLDER, remembered

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

    Files = tuple[tuple[str, str], ...]  # (file, SHA-256)
SHIPPED = "rosprivacy:"  # before the name of a shipped file
SURE = (Confidence.LIKELY, Confidence.MAY)  # a name proves nothing, and a call may never run: no rule is certain
MARKS = ("any_type", "alone", "by_itself")  # that are true, or left out
SILENT = "silent"


class Section(NamedTuple):
    """What rules of a section say: what each has to, and what it can."""

    required: tuple[str, ...]
    optional: tuple[str, ...] = ()


class RuleFormat(NamedTuple):
    """A format of rules: what they are about, the keys by which they name it, sections of rules, and lists."""

    about: str
    key: str
    named_by: tuple[str, ...]
    sections: Mapping[str, Section]
    phrases: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    kinds: tuple[str, ...] = ()

    @property
    def lists(self) -> tuple[str, ...]:
        """The names of lists of phrases, words and kinds."""
        return (*self.phrases, *self.words, *self.kinds)


_PAIR = Section(("from", "to", "why"))  # of one kind, what comes of it
NAMES = RuleFormat(
    "names",
    "name_rules",
    ("words",),
    {
        "carries": Section(("words", "why", "kinds"), ("instead_of", "any_type")),
        "brings_in": Section(("words", "why", "kinds"), ("instead_of", "any_type")),
        "unprompted": Section(("why", "kinds"), ("words",)),
        "nothing": Section(("words", "why")),
        "lets_out": Section(("words", "why"), ("where",)),
        "becomes": _PAIR,
        "tells": _PAIR,
    },
    (SILENT,),
    ("neutral", "simulated", "understood"),
    ("computed", "not_by_type"),
)
PROGRAMS, ADDRESSES = "programs", "addresses"
LANGUAGES = {PYTHON: (PYTHON,), CPP: (CPP,), PROGRAMS: (PYTHON, CPP), ADDRESSES: (PYTHON,)}  # of names, by key
SIGNS = {PROGRAMS: PROGRAM, ADDRESSES: ADDRESS}  # before names of these keys
SECTIONS = ("brings_in", "lets_out", "makes")
LIBRARIES = RuleFormat(
    "libraries",
    "library_rules",
    tuple(LANGUAGES),
    {
        "brings_in": Section(("kinds", "confidence", "why"), ("any_type", "alone")),
        "lets_out": Section(("where", "confidence", "why"), ("kinds", "sort")),
        "makes": Section(("kinds", "to", "confidence", "why"), ("any_type", "by_itself", "sort")),
        SILENT: Section((), ("why",)),
    },
)
NAME = re.compile(r"[A-Za-z_~][\w.:-]*(?: [\w-]+){0,2}(?:\((?:w|input|output)\)|\*)?", re.ASCII)
PART = re.compile(r"[a-z0-9:/][\w.:/-]{3,}", re.ASCII)  # of an address
HINT = "write names such as cv2.VideoCapture, cv::VideoCapture, curl_easy_*, open(w), or a program"
ADDRESS_HINT = "write a part of it, such as api.openai.com or rtsp://"
PHRASE_HINT = f"write words of letters with _ between them, at most {LONGEST_PHRASE}; quote no, on and yes"


def read_name_rules(files: Iterable[str], vocabulary: Vocabulary, bounds: Bounds = BOUNDS) -> tuple[NameRules, Files]:
    """Read the shipped rules and a user's; return them joined, and (file, SHA-256) of each.

    Raises
    ------
    InputErrors
        With every problem of the files, each of one line.

    Examples
    --------
    >>> from rosprivacy.ontology.vocabulary import load
    >>> rules, _ = read_name_rules((), load())
    >>> rules.carries["lidar",].kinds, ("camera", "info") in rules.silent
    (('LaserScan',), True)
    """
    readers, digests = _read_each(NAMES, files, vocabulary, bounds)
    fields: dict[str, Any] = dict(_joined(readers))
    for name in ("becomes", "tells"):
        pairs: dict[str, dict[str, NameRule]] = {}
        for (first, second), rule in fields[name].items():
            pairs.setdefault(first, {})[second] = rule
        fields[name] = pairs
    fields |= {name: frozenset().union(*(one.lists[name] for one in readers)) for name in NAMES.lists}
    fields[SILENT] -= {phrase for one in readers[1:] for phrase in one.sections["carries"]}  # a user says what it is
    return NameRules(**fields), digests


def read_library_rules(
    files: Iterable[str], vocabulary: Vocabulary, bounds: Bounds = BOUNDS
) -> tuple[LibraryRules, Files]:
    """Read the shipped rules and a user's; return them joined, and (file, SHA-256) of each.

    Raises
    ------
    InputErrors
        With every problem of the files, each of one line.

    Examples
    --------
    >>> from rosprivacy.ontology.vocabulary import load
    >>> rules, _ = read_library_rules((), load())
    >>> rules.brings_in["python"].of("cv2.VideoCapture")[1].kinds
    ('Video',)
    """
    readers, digests = _read_each(LIBRARIES, files, vocabulary, bounds)
    joined = _joined(readers)
    spoken = {key for one in readers[1:] for section in SECTIONS for key in one.sections[section]}
    silent = (readers[0].sections[SILENT].keys() - spoken).union(*(one.sections[SILENT] for one in readers[1:]))
    quiet = {language: frozenset(name for of, name in silent if of == language) for language in (PYTHON, CPP)}
    sections = {
        section: {
            language: RulesByName({name: rule for (of, name), rule in joined[section].items() if of == language})
            for language in (PYTHON, CPP)
        }
        for section in SECTIONS
    }
    return LibraryRules(**sections, silent=quiet), digests


def _joined(readers: Iterable[_RuleReader]) -> dict[str, dict[Any, NameRule]]:
    """The rules of all files, by section: those of later files stand for the same ones of earlier files."""
    joined: dict[str, dict[Any, NameRule]] = {}
    for reader in readers:
        for name, rules in reader.sections.items():
            joined.setdefault(name, {}).update(rules)
    return joined


def _read_each(
    format_: RuleFormat, files: Iterable[str], vocabulary: Vocabulary, bounds: Bounds
) -> tuple[list[_RuleReader], Files]:
    """What is read of the shipped file and of each file of a user, in their order, each once."""
    shipped = f"{SHIPPED}{format_.about}"
    readers, digests = [], []
    problems: list[InputError] = []
    for file in dict.fromkeys((shipped, *files)):
        try:
            if file == shipped:
                reader, data = _shipped(vocabulary, format_.about, bounds)
            else:
                reader = _RuleReader(file, format_, vocabulary, error=InputError, bounds=bounds)
                top, data = yaml_values.read(file, partial(InputError, file), bounds)
                reader.read(top)
            problems += reader.problems
        except InputErrors as error:
            problems += error.errors
            continue
        except InputError as error:
            problems.append(error)
            continue
        readers.append(reader)
        digests.append((file, hashlib.sha256(data).hexdigest()))
    if problems:
        raise InputErrors(problems)
    return readers, tuple(digests)


@remembered
def _shipped(vocabulary: Vocabulary, about: str, bounds: Bounds) -> tuple[_RuleReader, bytes]:
    """What is read of a shipped file; it is only read from."""
    file, (format_,) = f"{SHIPPED}{about}", (one for one in (NAMES, LIBRARIES) if one.about == about)
    reader = _RuleReader(file, format_, vocabulary, error=InputError, bounds=bounds)
    top, data = yaml_values.read_shipped(str(FOLDER / f"{about}.yaml"), InputError, file)
    reader.read(top)
    return reader, data


@dataclass(eq=False, repr=False)
class _RuleReader(FileReader):
    """Reads one file of rules: sections by name, and lists by name."""

    format: RuleFormat
    vocabulary: Vocabulary
    sections: dict[str, dict[Any, NameRule]] = field(default_factory=dict)
    lists: dict[str, frozenset[Any]] = field(default_factory=dict)

    def read(self, top: Value) -> None:
        """Read the file; note what is wrong."""
        form, about = self.format, self.format.about
        entries: dict[str, Value] = {}
        if top.kind == "map":
            self.version(top, form.key, "rules")
            entries = self.values_of(top, (form.key, "version", *form.sections, *form.lists))
        else:
            self.problem(top.line, f"rules about {about} are a map, not a {top.kind}", f"begin with '{form.key}: 1'")
        self.sections = {name: self._section(entries, name) for name in form.sections}
        for name in (*form.phrases, *form.words):
            phrases = [phrase for item in self._items(entries, name) for phrase in self._phrase(item)]
            self.lists[name] = frozenset(phrases)
            if name in form.words:
                self.lists[name] = frozenset(word for phrase in phrases for word in phrase)
        self.lists |= {name: frozenset(self._kinds(entries, name)) for name in form.kinds}

    def _section(self, entries: Mapping[str, Value], section: str) -> dict[Any, NameRule]:
        """The rules of a section, by each name that they are about, or by the two kinds that they join."""
        required, optional = self.format.sections[section]
        named_by = () if "from" in required else self.format.named_by
        keys = tuple(dict.fromkeys((*named_by, *required, *optional, "confidence", "source")))
        rules: dict[Any, NameRule] = {}
        for item in self._items(entries, section):
            entry = self.values_of(item, keys)
            for key in required:
                if key not in entry or not (entry[key].text or entry[key].items):
                    self.problem(item.line, f"a rule without {key}", f"write {', '.join(required)}")
            if self.format is LIBRARIES and not set(named_by) & set(entry):
                hint = f"write {', '.join(named_by)}, or one of them"
                self.problem(item.line, "a rule about no library", hint)
            rule = self._rule(entry, item.line)
            if "from" in entry:
                first = self._kind(entry["from"])
                rules |= {(first, to): rule for to in rule.to if first}
            elif section == "unprompted" and "words" not in entry:
                rules[()] = rule
            for key in named_by:
                for name in self._items(entry, key):
                    self._add_rule(rules, rule, name, self._phrase(name) if key == "words" else self._name(name, key))
        return rules

    def _add_rule(self, rules: dict[Any, NameRule], rule: NameRule, name: Value, keys: Sequence[Any]) -> None:
        """Put a rule beside the others of a section, by a name that it is about and that no other one is about."""
        if keys and keys[0] in rules:
            what = f"{shown(name.text)} again, first in line {rules[keys[0]].place.line}"
            self.problem(name.line, what, "say each once in a section")
        for one in keys:
            rules.setdefault(one, rule)

    def _rule(self, entry: Mapping[str, Value], line: int) -> NameRule:
        anything = (ANYTHING,) if self.format is LIBRARIES and "kinds" not in entry else ()
        return NameRule(
            self._kinds(entry, "kinds") or anything,
            Confidence(self._one_of(entry, "confidence", SURE) or Confidence.MAY),
            entry["why"].text if "why" in entry else "",
            Place(self.file, line),
            self._kinds(entry, "to"),
            self._kinds(entry, "instead_of"),
            self._one_of(entry, "where", WHERE),
            **{mark: self._is_true(entry, mark) for mark in MARKS},
            sort=self._one_of(entry, "sort", SORTS),
        )

    def _items(self, entries: Mapping[str, Value], key: str) -> tuple[Value, ...]:
        return self.list_of(entries[key], key) if key in entries else ()

    def _phrase(self, item: Value) -> tuple[tuple[str, ...], ...]:
        phrase = words(item.text) if item.kind == "text" else ()
        if not phrase or len(phrase) > LONGEST_PHRASE:
            self.problem(item.line, f"{shown(item.text or item.kind)!r} is no word of a name", PHRASE_HINT)
            return ()
        return (phrase,)

    def _name(self, item: Value, key: str) -> tuple[tuple[str, str], ...]:
        pattern, what, hint = NAME, "name of a library", HINT
        if key == ADDRESSES:
            pattern, what, hint = PART, "part of an address", ADDRESS_HINT
        if item.kind != "text" or not pattern.fullmatch(item.text):
            self.problem(item.line, f"{shown(item.text or item.kind)!r} is no {what}", hint)
            return ()
        return tuple((language, SIGNS.get(key, "") + item.text) for language in LANGUAGES[key])

    def _one_of(self, entry: Mapping[str, Value], key: str, words: tuple[str, ...]) -> str:
        if key not in entry or entry[key].text in words:
            return entry[key].text if key in entry else ""
        value = entry[key]
        hint = f"write {', '.join(words[:-1])} or {words[-1]}"
        self.problem(value.line, f"{key} {shown(value.text or value.kind)!r}", hint)
        return ""

    def _is_true(self, entry: Mapping[str, Value], key: str) -> bool:
        if key in entry and entry[key].text != "true":
            value = entry[key]
            self.problem(value.line, f"{key} {shown(value.text or value.kind)!r}", "write true or leave it out")
        return key in entry

    def _kinds(self, entry: Mapping[str, Value], key: str) -> tuple[str, ...]:
        return tuple(dict.fromkeys(kind for item in self._items(entry, key) if (kind := self._kind(item))))

    def _kind(self, item: Value) -> str:
        if item.kind != "text":
            self.problem(item.line, f"unknown category {item.kind!r}", self.vocabulary.hint(item.text))
            return ""
        return self.category_of_name(self.vocabulary, item.text, item.line)
