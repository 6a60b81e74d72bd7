"""Rules about libraries: ``ontology/libraries.yaml`` and users' files of that format -> ``LibraryRules``.

A name of a user's file stands for the same name of ours, in its section; of one file every name is said once in one.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING
from rosprivacy.analysis.suggesting.library_rules import (
    ADDRESS,
    CPP,
    PROGRAM,
    PYTHON,
    LibraryRule,
    LibraryRules,
    Names,
)
from rosprivacy.analysis.suggesting.ros_package import WHERE
from rosprivacy.ingest.suggestions.rule_reader import RuleReader, read_each
from rosprivacy.ingest.suggestions.rule_text import read_rule_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

LIBRARIES = "rosprivacy:libraries"  # the shipped file
BRINGS_IN, LETS_OUT, MAKES, SILENT = "brings_in", "lets_out", "makes", "silent"
SECTIONS = (BRINGS_IN, LETS_OUT, MAKES)
PARTS = ("library_rules", "version", *SECTIONS, SILENT)
PROGRAMS, ADDRESSES = "programs", "addresses"
NAMED = {PYTHON: (PYTHON,), CPP: (CPP,), PROGRAMS: (PYTHON, CPP), ADDRESSES: (PYTHON,)}  # key -> languages of names
BEFORE = {PROGRAMS: PROGRAM, ADDRESSES: ADDRESS}  # signs before names of these keys
ALL = (*NAMED, "confidence", "why", "source")
KEYS = {
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
SURE = (Confidence.LIKELY, Confidence.MAY)  # a call that stands in code may never run, so no rule is certain
NAME = re.compile(r"[A-Za-z_~][\w.:-]*(?: [\w-]+){0,2}(?:\((?:w|input|output)\)|\*)?", re.ASCII)
PART = re.compile(r"[a-z0-9:/][\w.:/-]{3,}", re.ASCII)  # of an address
Key = tuple[str, str]  # language, name


@dataclass(frozen=True, slots=True)
class LibraryFile:
    """One file of rules; by section and language the rule of each name."""

    file: str
    sha256: str
    sections: dict[str, dict[Key, LibraryRule]]
    silent: dict[Key, int]


def read_library_rules(
    files: Iterable[str], vocabulary: Vocabulary, bounds: Bounds = BOUNDS
) -> tuple[LibraryRules, tuple[tuple[str, str], ...]]:
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
    read = read_each((LIBRARIES, *files), lambda file: _read(file, vocabulary, bounds))
    joined = {section: _joined(one.sections[section] for one in read) for section in SECTIONS}
    spoken = {key for one in read[1:] for section in one.sections.values() for key in section}
    silent = (read[0].silent.keys() - spoken).union(*(one.silent for one in read[1:]))
    quiet = {language: frozenset(name for of, name in silent if of == language) for language in (PYTHON, CPP)}
    return LibraryRules(**joined, silent=quiet), tuple((one.file, one.sha256) for one in read)


def _joined(sections: Iterable[dict[Key, LibraryRule]]) -> dict[str, Names]:
    every = {key: rule for section in sections for key, rule in section.items()}
    languages = (PYTHON, CPP)
    return {one: _names({name: rule for (of, name), rule in every.items() if of == one}) for one in languages}


def _names(rules: dict[str, LibraryRule]) -> Names:
    starred = {name[:-1]: rule for name, rule in rules.items() if name.endswith("*")}
    parts = {name.removeprefix(ADDRESS): rule for name, rule in rules.items() if name.startswith(ADDRESS)}
    plain = {name: rule for name, rule in rules.items() if not (name.endswith("*") or name.startswith(ADDRESS))}
    return Names(plain, starred, parts)


def _read(file: str, vocabulary: Vocabulary, bounds: Bounds) -> LibraryFile:
    top, digest = read_rule_text(file, LIBRARIES, "libraries.yaml", bounds)
    reader = _Reader(file, vocabulary, error=InputError, bounds=bounds)
    read = reader.document(top, digest)
    if reader.problems:
        raise InputErrors(reader.problems)
    return read


@dataclass(eq=False, repr=False)
class _Reader(RuleReader):
    """One file."""

    lines: dict[str, dict[Key, int]] = field(default_factory=lambda: {name: {} for name in (*SECTIONS, SILENT)})

    def document(self, top: Value, digest: str) -> LibraryFile:
        sections: dict[str, dict[Key, LibraryRule]] = {name: {} for name in SECTIONS}
        said: dict[str, Value] = {}
        if top.kind != "map":
            self.problem(
                top.line, f"rules about libraries are a map, not a {top.kind}", "begin with 'library_rules: 1'"
            )
        else:
            self.version(top, "library_rules", "rules")
            said = {key: value for key, _, value in self.entries_of(top, PARTS)}
        for section in (*SECTIONS, SILENT):
            for item in self.items(said, section):
                entry = self._entry(item, section)
                rule = self._rule(entry, item.line)
                for key in self._names(entry, section):
                    if section != SILENT:
                        sections[section][key] = rule
        return LibraryFile(self.file, digest, sections, self.lines[SILENT])

    def _entry(self, item: Value, section: str) -> dict[str, Value]:
        said = self.rule(item, KEYS[section], NEEDED[section])
        if not set(said) & set(NAMED):
            self.problem(item.line, "a rule about no library", f"write {', '.join(NAMED)}, or one of them")
        return said

    def _rule(self, said: dict[str, Value], line: int) -> LibraryRule:
        return LibraryRule(
            self._kinds(said, "kinds") if "kinds" in said else (ANYTHING,),
            Confidence(self._one_of(said, "confidence", SURE) or Confidence.MAY),
            said["why"].text if "why" in said else "",
            Place(self.file, line),
            self._kinds(said, "to"),
            self._one_of(said, "where", WHERE),
            self.is_true(said, "any_type"),
            self.is_true(said, "by_itself"),
            self.is_true(said, "alone"),
            tuple(item.text for item in self._last_parts(said)),
        )

    def _names(self, said: dict[str, Value], section: str) -> Iterator[Key]:
        known = self.lines[section]
        for key, languages in NAMED.items():
            for item in self.items(said, key):
                if item.kind != "text" or not (PART if key == ADDRESSES else NAME).fullmatch(item.text):
                    hint = "write names such as cv2.VideoCapture, cv::VideoCapture, curl_easy_*, open(w), or a program"
                    hint = "write a part of it, such as api.openai.com or rtsp://" if key == ADDRESSES else hint
                    what = "part of an address" if key == ADDRESSES else "name of a library"
                    self.problem(item.line, f"{shown(item.text or item.kind)!r} is no {what}", hint)
                    continue
                ones = [(of, BEFORE.get(key, "") + item.text) for of in languages]
                if ones[0] in known:
                    what = f"{shown(item.text)} again, first in line {known[ones[0]]}"
                    self.problem(item.line, what, f"say each name once in {section}")
                known |= {one: item.line for one in ones if one not in known}
                yield from ones

    def _last_parts(self, said: dict[str, Value]) -> Iterator[Value]:
        for item in self.items(said, "writes"):
            if item.kind == "text" and item.text.isidentifier():
                yield item
            else:
                what = f"{shown(item.text or item.kind)!r} is no last part of a name"
                self.problem(item.line, what, "write one such as commit")

    def _one_of(self, said: dict[str, Value], key: str, known: tuple[str, ...]) -> str:
        if key not in said or not said[key].text or said[key].text in known:
            return said[key].text if key in said else ""
        value = said[key]
        self.problem(value.line, f"{key} {shown(value.text)!r}", f"write {', '.join(known[:-1])} or {known[-1]}")
        return ""

    def _kinds(self, said: dict[str, Value], key: str) -> tuple[str, ...]:
        return tuple(dict.fromkeys(self.kinds(said, key)))
