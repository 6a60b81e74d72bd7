"""Files of rules: ``ontology/names.yaml`` and ``ontology/libraries.yaml``, and users' files of these formats.

A phrase or a name of a user's file stands for the same one of ours; of one file everything is said once in a section.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.evidence import ANYTHING
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, CPP, PROGRAM, PYTHON, LibraryRule, LibraryRules, Names
from rosprivacy.analysis.suggesting.name_rules import LONGEST_PHRASE, NameRule, NameRules, words
from rosprivacy.analysis.suggesting.packages import WHERE
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader
from rosprivacy.ontology.vocabulary import FOLDER

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.suggesting.name_rules import Phrase
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

    Files = tuple[tuple[str, str], ...]  # (file, SHA-256)
SHIPPED = "rosprivacy:"  # before the name of a shipped file
SURE = (Confidence.LIKELY, Confidence.MAY)  # a name proves nothing, and a call may never run: no rule is certain

# Rules about names: the sections of a file, by what stands in them.
NAMES = f"{SHIPPED}names"
UNPROMPTED = "unprompted"  # the section in which a rule may have no words
WITH_KINDS, WITHOUT_KINDS = ("carries", "brings_in", UNPROMPTED), ("nothing", "lets_out")
PAIRS = ("becomes", "tells")  # that say of one kind what comes of it
PHRASES = ("silent",)  # lists of words that follow each other
WORDS = ("neutral", "simulated", "understood")
KINDS = ("computed", "not_by_type")
NAME_PARTS = ("name_rules", "version", *WITH_KINDS, *WITHOUT_KINDS, *PAIRS, *PHRASES, *WORDS, *KINDS)
OF_KINDS = ("kinds", "instead_of", "any_type")  # for rules that name kinds
NAME_KEYS = ("words", "confidence", "why", "source", *OF_KINDS)

# Rules about libraries.
LIBRARIES = f"{SHIPPED}libraries"
BRINGS_IN, LETS_OUT, MAKES, SILENT = "brings_in", "lets_out", "makes", "silent"
SECTIONS = (BRINGS_IN, LETS_OUT, MAKES)
LIBRARY_PARTS = ("library_rules", "version", *SECTIONS, SILENT)
PROGRAMS, ADDRESSES = "programs", "addresses"
NAMED = {PYTHON: (PYTHON,), CPP: (CPP,), PROGRAMS: (PYTHON, CPP), ADDRESSES: (PYTHON,)}  # key -> languages of names
BEFORE = {PROGRAMS: PROGRAM, ADDRESSES: ADDRESS}  # signs before names of these keys
ALL = (*NAMED, "confidence", "why", "source")
LIBRARY_KEYS = {
    BRINGS_IN: (*ALL, "kinds", "any_type", "alone"),
    LETS_OUT: (*ALL, "kinds", "where", "writes"),
    MAKES: (*ALL, "kinds", "to", "any_type", "by_itself"),
    SILENT: (*NAMED, "why"),
}
NEEDED = {
    BRINGS_IN: ("kinds", "confidence", "why"),
    LETS_OUT: ("where", "confidence", "why"),
    MAKES: ("kinds", "to", "confidence", "why"),
    SILENT: (),
}
NAME = re.compile(r"[A-Za-z_~][\w.:-]*(?: [\w-]+){0,2}(?:\((?:w|input|output)\)|\*)?", re.ASCII)
PART = re.compile(r"[a-z0-9:/][\w.:/-]{3,}", re.ASCII)  # of an address
HINT = "write names such as cv2.VideoCapture, cv::VideoCapture, curl_easy_*, open(w), or a program"
ADDRESS_HINT = "write a part of it, such as api.openai.com or rtsp://"
Key = tuple[str, str]  # language, name
Read = TypeVar("Read")


class File(NamedTuple, Generic[Read]):
    """What one file of rules says."""

    name: str
    sha256: str
    rules: Read


class NameFile(NamedTuple):
    """Rules about names of one file: by section the rules of each phrase, and of each two categories; lists by name."""

    sections: Mapping[str, Mapping[Phrase, NameRule]]
    pairs: Mapping[str, Mapping[tuple[str, str], NameRule]]
    lists: Mapping[str, frozenset[str]]
    phrases: Mapping[str, frozenset[Phrase]]


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

    def read(file: str, top: Value) -> NameFile:
        reader = _NameReader(file, vocabulary, error=InputError, bounds=bounds)
        return reader.checked(reader.document(top))

    each = _read_each(NAMES, files, read, bounds)
    shipped, *own = (one.rules for one in each)
    every = (shipped, *own)
    sections = {
        name: {phrase: rule for one in every for phrase, rule in one.sections[name].items()}
        for name in (*WITH_KINDS, *WITHOUT_KINDS)
    }
    pairs: dict[str, dict[str, dict[str, NameRule]]] = {name: {} for name in PAIRS}
    for name, by_first in pairs.items():
        for (first, second), rule in (pair for one in every for pair in one.pairs[name].items()):
            by_first.setdefault(first, {})[second] = rule
    lists = {name: frozenset(item for one in every for item in one.lists[name]) for name in (*WORDS, *KINDS)}
    phrases = {name: frozenset(item for one in every for item in one.phrases[name]) for name in PHRASES}
    phrases[SILENT] -= {phrase for one in own for phrase in one.sections["carries"]}  # a user says what they carry
    fields: dict[str, Any] = {**sections, **pairs, **lists, **phrases}
    return NameRules(**fields), tuple((one.name, one.sha256) for one in each)


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

    def read(file: str, top: Value) -> Mapping[str, Mapping[Key, LibraryRule]]:
        reader = _LibraryReader(file, vocabulary, error=InputError, bounds=bounds)
        return reader.checked(reader.document(top))

    each = _read_each(LIBRARIES, files, read, bounds)
    shipped, *own = (one.rules for one in each)
    joined = {section: _by_language([shipped[section], *(one[section] for one in own)]) for section in SECTIONS}
    spoken = {key for one in own for section in SECTIONS for key in one[section]}
    silent = (shipped[SILENT].keys() - spoken).union(*(one[SILENT] for one in own))
    quiet = {language: frozenset(name for of, name in silent if of == language) for language in (PYTHON, CPP)}
    return LibraryRules(**joined, silent=quiet), tuple((one.name, one.sha256) for one in each)


def _by_language(files: Iterable[Mapping[Key, LibraryRule]]) -> dict[str, Names]:
    every = {key: rule for rules in files for key, rule in rules.items()}
    found = {}
    for language in (PYTHON, CPP):
        of_it = {name: rule for (of, name), rule in every.items() if of == language}
        starred = {name[:-1]: rule for name, rule in of_it.items() if name.endswith("*")}
        parts = {name.removeprefix(ADDRESS): rule for name, rule in of_it.items() if name.startswith(ADDRESS)}
        found[language] = Names(of_it, starred, parts)
    return found


def _read_each(
    shipped: str, files: Iterable[str], read: Callable[[str, Value], Read], bounds: Bounds
) -> list[File[Read]]:
    """What is read of the shipped file and of each file of a user, in their order, each once."""
    found: list[File[Read]] = []
    problems: list[InputError] = []
    for file in dict.fromkeys((shipped, *files)):
        try:
            if file == shipped:
                ours = FOLDER / f"{file.removeprefix(SHIPPED)}.yaml"
                top, data = yaml_values.read_shipped(str(ours), InputError, file)
            else:
                top, data = yaml_values.read(file, partial(InputError, file), bounds)
            found.append(File(file, hashlib.sha256(data).hexdigest(), read(file, top)))
        except InputErrors as error:
            problems += error.errors
        except InputError as error:
            problems.append(error)
    if problems:
        raise InputErrors(problems)
    return found


@dataclass(eq=False, repr=False)
class _RuleReader(FileReader):
    """Reads one file of rules: kinds of data, marks that are true, items."""

    vocabulary: Vocabulary

    def parts(self, top: Value, about: str, key: str, known: tuple[str, ...]) -> dict[str, Value]:
        """Return the sections of the file, by name."""
        if top.kind != "map":
            self.problem(top.line, f"rules about {about} are a map, not a {top.kind}", f"begin with '{key}: 1'")
            return {}
        self.version(top, key, "rules")
        return {name: value for name, _, value in self.entries_of(top, known)}

    def checked(self, rules: Read) -> Read:
        """Return what was read, if there is no problem."""
        if self.problems:
            raise InputErrors(self.problems)
        return rules

    def items(self, said: Mapping[str, Value], key: str) -> tuple[Value, ...]:
        """Return the items of a list; none where there is none."""
        return self.list_of(said[key], key) if key in said else ()

    def rule(self, item: Value, keys: tuple[str, ...], needed: tuple[str, ...]) -> dict[str, Value]:
        """Return what a rule says, by key; note what it lacks."""
        said = {key: value for key, _, value in self.entries_of(item, keys)}
        for key in needed:
            if key not in said or not (said[key].text or said[key].items):
                self.problem(item.line, f"a rule without {key}", f"write {', '.join(needed)}")
        return said

    def is_true(self, said: Mapping[str, Value], key: str) -> bool:
        """Return whether a mark is there; note one that says anything but true."""
        if key in said and said[key].text != "true":
            value = said[key]
            self.problem(value.line, f"{key} {shown(value.text or value.kind)!r}", "write true or leave it out")
        return key in said

    def kinds(self, said: Mapping[str, Value], key: str) -> tuple[str, ...]:
        """Return the kinds of data that a list names; note what is none."""
        return tuple(name for item in self.items(said, key) if (name := self.kind(item)))

    def kind(self, item: Value) -> str:
        """Return the kind of data that is named; empty, and noted, if there is none of that name."""
        category = self.vocabulary.find(item.text) if item.kind == "text" else None
        if category is None:
            hint = self.vocabulary.hint(item.text)
            self.problem(item.line, f"unknown category {shown(item.text or item.kind)!r}", hint)
            return ""
        return category.name

    def why(self, said: Mapping[str, Value]) -> str:
        """Return the reason."""
        return said["why"].text if "why" in said else ""


@dataclass(eq=False, repr=False)
class _NameReader(_RuleReader):
    """One file of rules about names."""

    def document(self, top: Value) -> NameFile:
        said = self.parts(top, "names", "name_rules", NAME_PARTS)
        read = NameFile(
            {name: self._section(said, name) for name in (*WITH_KINDS, *WITHOUT_KINDS)},
            {name: self._pairs(said, name) for name in PAIRS},
            {},
            {name: frozenset(self._phrases(said, name)) for name in PHRASES},
        )
        lists = {name: frozenset(word for phrase in self._phrases(said, name) for word in phrase) for name in WORDS}
        return read._replace(lists=lists | {name: frozenset(self.kinds(said, name)) for name in KINDS})

    def _section(self, parts: Mapping[str, Value], section: str) -> Mapping[Phrase, NameRule]:
        keys = NAME_KEYS if section in WITH_KINDS else tuple(key for key in NAME_KEYS if key not in OF_KINDS)
        needed = ("words",) if section != UNPROMPTED else ()
        needed = (*needed, "why", *(("kinds",) if section in WITH_KINDS else ()))
        known: dict[Phrase, NameRule] = {}
        for item in self.items(parts, section):
            said = self.rule(item, keys, needed)
            rule = NameRule(
                self.kinds(said, "kinds"),
                self._confidence(said),
                self.why(said),
                Place(self.file, item.line),
                self.kinds(said, "instead_of"),
                self.is_true(said, "any_type"),
            )
            if section == UNPROMPTED and "words" not in said:
                known[()] = rule
            for word in self.items(said, "words"):
                phrase = self._phrase(word)
                if phrase in known:
                    what = f"{'_'.join(phrase)} again, first in line {known[phrase].place.line}"
                    self.problem(word.line, what, "say each phrase once")
                elif phrase:
                    known[phrase] = rule
        return known

    def _pairs(self, parts: Mapping[str, Value], section: str) -> Mapping[tuple[str, str], NameRule]:
        found = {}
        for item in self.items(parts, section):
            said = self.rule(item, ("from", "to", "confidence", "why", "source"), ("from", "to", "why"))
            confidence = self._confidence(said)
            first = self.kind(said["from"]) if "from" in said else ""
            for second in self.kinds(said, "to"):
                if first:
                    place = Place(self.file, item.line)
                    found[first, second] = NameRule((second,), confidence, self.why(said), place)
        return found

    def _phrases(self, said: Mapping[str, Value], key: str) -> list[Phrase]:
        return [phrase for item in self.items(said, key) if (phrase := self._phrase(item))]

    def _phrase(self, item: Value) -> Phrase:
        phrase = words(item.text) if item.kind == "text" else ()
        if not phrase or len(phrase) > LONGEST_PHRASE:
            hint = f"write words of letters with _ between them, at most {LONGEST_PHRASE}; quote no, on and yes"
            self.problem(item.line, f"{shown(item.text or item.kind)!r} is no word of a name", hint)
            return ()
        return phrase

    def _confidence(self, said: Mapping[str, Value]) -> Confidence:
        if "confidence" in said and said["confidence"].text in SURE:
            return Confidence(said["confidence"].text)
        if "confidence" in said:
            value = said["confidence"]
            hint = f"write {' or '.join(SURE)}: a name proves nothing"
            self.problem(value.line, f"confidence {shown(value.text or value.kind)!r}", hint)
        return Confidence.MAY


@dataclass(eq=False, repr=False)
class _LibraryReader(_RuleReader):
    """One file of rules about libraries."""

    lines: dict[str, dict[Key, int]] = field(default_factory=lambda: {name: {} for name in (*SECTIONS, SILENT)})

    def document(self, top: Value) -> Mapping[str, Mapping[Key, LibraryRule]]:
        """Return by section the rules of each name; those of the silent names say nothing."""
        parts = self.parts(top, "libraries", "library_rules", LIBRARY_PARTS)
        sections: dict[str, dict[Key, LibraryRule]] = {name: {} for name in (*SECTIONS, SILENT)}
        for section, rules in sections.items():
            for item in self.items(parts, section):
                said = self.rule(item, LIBRARY_KEYS[section], NEEDED[section])
                if not set(said) & set(NAMED):
                    self.problem(item.line, "a rule about no library", f"write {', '.join(NAMED)}, or one of them")
                rule = self._rule(said, item.line)
                rules.update(dict.fromkeys(self._names(said, section), rule))
        return sections

    def _rule(self, said: Mapping[str, Value], line: int) -> LibraryRule:
        return LibraryRule(
            self._kinds(said, "kinds") if "kinds" in said else (ANYTHING,),
            Confidence(self._one_of(said, "confidence", SURE) or Confidence.MAY),
            self.why(said),
            Place(self.file, line),
            self._kinds(said, "to"),
            self._one_of(said, "where", WHERE),
            self.is_true(said, "any_type"),
            self.is_true(said, "by_itself"),
            self.is_true(said, "alone"),
            tuple(item.text for item in self._last_parts(said)),
        )

    def _names(self, said: Mapping[str, Value], section: str) -> Iterator[Key]:
        known = self.lines[section]
        for key, languages in NAMED.items():
            for item in self.items(said, key):
                if item.kind != "text" or not (PART if key == ADDRESSES else NAME).fullmatch(item.text):
                    hint, what = (
                        (ADDRESS_HINT, "part of an address") if key == ADDRESSES else (HINT, "name of a library")
                    )
                    self.problem(item.line, f"{shown(item.text or item.kind)!r} is no {what}", hint)
                    continue
                ones = [(of, BEFORE.get(key, "") + item.text) for of in languages]
                if ones[0] in known:
                    what = f"{shown(item.text)} again, first in line {known[ones[0]]}"
                    self.problem(item.line, what, f"say each name once in {section}")
                known |= {one: item.line for one in ones if one not in known}
                yield from ones

    def _last_parts(self, said: Mapping[str, Value]) -> Iterator[Value]:
        for item in self.items(said, "writes"):
            if item.kind == "text" and item.text.isidentifier():
                yield item
            else:
                what = f"{shown(item.text or item.kind)!r} is no last part of a name"
                self.problem(item.line, what, "write one such as commit")

    def _one_of(self, said: Mapping[str, Value], key: str, known: tuple[str, ...]) -> str:
        if key not in said or not said[key].text or said[key].text in known:
            return said[key].text if key in said else ""
        value = said[key]
        self.problem(value.line, f"{key} {shown(value.text)!r}", f"write {', '.join(known[:-1])} or {known[-1]}")
        return ""

    def _kinds(self, said: Mapping[str, Value], key: str) -> tuple[str, ...]:
        return tuple(dict.fromkeys(self.kinds(said, key)))
