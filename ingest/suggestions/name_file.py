"""Rules about names of topics and nodes: ``ontology/names.yaml`` and users' files of that format -> ``NameRules``.

A phrase of a user's file stands for the same phrase of ours; of one file every phrase is said once.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.name_rules import LONGEST_PHRASE, NameRule, NameRules, words
from rosprivacy.ingest.suggestions.rule_reader import RuleReader, read_each
from rosprivacy.ingest.suggestions.rule_text import read_rule_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.suggesting.name_rules import Phrase
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

NAMES = "rosprivacy:names"  # the shipped file
UNPROMPTED = "unprompted"  # the section in which a rule may have no words
WITH_KINDS, WITHOUT_KINDS = ("carries", "brings_in", UNPROMPTED), ("nothing", "lets_out")
PAIRS = ("becomes", "tells")  # sections that say of one kind what comes of it
PHRASES = ("silent", "wanted")  # lists of words that follow each other
WORDS = ("neutral", "commanding", "reworked", "reworking", "simulated", "understood", "driving")
KINDS = ("computed", "not_by_type", "entered", "broadened")
PARTS = ("name_rules", "version", *WITH_KINDS, *WITHOUT_KINDS, *PAIRS, *PHRASES, *WORDS, *KINDS)
OF_KINDS = ("kinds", "instead_of", "any_type")  # for rules that name kinds
KEYS = ("words", "confidence", "why", "source", *OF_KINDS)
SURE = (Confidence.LIKELY, Confidence.MAY)  # a name proves nothing, so no rule about one is certain


@dataclass(frozen=True, slots=True)
class NameFile:
    """One file of rules.

    Attributes
    ----------
    sections
        By section the rules of each phrase.
    pairs
        By section the rules of each two categories.
    phrases, words, kinds
        By the name of the list.
    """

    file: str
    sha256: str
    sections: Mapping[str, Mapping[Phrase, NameRule]]
    pairs: Mapping[str, Mapping[tuple[str, str], NameRule]]
    phrases: Mapping[str, frozenset[Phrase]]
    words: Mapping[str, frozenset[str]]
    kinds: Mapping[str, frozenset[str]]


def read_name_rules(
    files: Iterable[str], vocabulary: Vocabulary, bounds: Bounds = BOUNDS
) -> tuple[NameRules, tuple[tuple[str, str], ...]]:
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
    read = read_each((NAMES, *files), lambda file: _read(file, vocabulary, bounds))

    def section(name: str) -> dict[Phrase, NameRule]:
        return {phrase: rule for one in read for phrase, rule in one.sections[name].items()}

    def words_of(name: str) -> frozenset[str]:
        return frozenset(word for one in read for word in one.words[name])

    def kinds_of(name: str) -> frozenset[str]:
        return frozenset(kind for one in read for kind in one.kinds[name])

    rules = NameRules(
        carries=section("carries"),
        nothing=section("nothing"),
        brings_in=section("brings_in"),
        lets_out=section("lets_out"),
        unprompted=section(UNPROMPTED),
        becomes=_by_first(one.pairs["becomes"] for one in read),
        tells=_by_first(one.pairs["tells"] for one in read),
        silent=_silent(read),
        wanted=frozenset(phrase for one in read for phrase in one.phrases["wanted"]),
        neutral=words_of("neutral"),
        commanding=words_of("commanding"),
        reworked=words_of("reworked"),
        reworking=words_of("reworking"),
        simulated=words_of("simulated"),
        understood=words_of("understood"),
        driving=words_of("driving"),
        computed=kinds_of("computed"),
        not_by_type=kinds_of("not_by_type"),
        entered=kinds_of("entered"),
        broadened=kinds_of("broadened"),
    )
    return rules, tuple((one.file, one.sha256) for one in read)


def _by_first(files: Iterable[Mapping[tuple[str, str], NameRule]]) -> dict[str, dict[str, NameRule]]:
    """The rules of pairs of all files, by the first kind and the second; the last file counts."""
    joined: dict[str, dict[str, NameRule]] = {}
    for pairs in files:
        for (first, second), rule in pairs.items():
            joined.setdefault(first, {})[second] = rule
    return joined


def _silent(read: list[NameFile]) -> frozenset[Phrase]:
    """The phrases of all files, but for those of which a user's file says what they carry."""
    every = frozenset(phrase for one in read for phrase in one.phrases["silent"])
    return every - {phrase for one in read[1:] for phrase in one.sections["carries"]}


def _read(file: str, vocabulary: Vocabulary, bounds: Bounds) -> NameFile:
    top, digest = read_rule_text(file, NAMES, "names.yaml", bounds)
    reader = _Reader(file, vocabulary, error=InputError, bounds=bounds)
    read = reader.document(top, digest)
    if reader.problems:
        raise InputErrors(reader.problems)
    return read


@dataclass(eq=False, repr=False)
class _Reader(RuleReader):
    """One file."""

    sections: dict[str, dict[Phrase, NameRule]] = field(
        default_factory=lambda: {name: {} for name in (*WITH_KINDS, *WITHOUT_KINDS)}
    )
    pairs: dict[str, dict[tuple[str, str], NameRule]] = field(default_factory=lambda: {name: {} for name in PAIRS})

    def document(self, top: Value, digest: str) -> NameFile:
        said: dict[str, Value] = {}
        if top.kind != "map":
            self.problem(top.line, f"rules about names are a map, not a {top.kind}", "begin with 'name_rules: 1'")
        else:
            self.version(top, "name_rules", "rules")
            said = {key: value for key, _, value in self.entries_of(top, PARTS)}
        for section in (*WITH_KINDS, *WITHOUT_KINDS):
            for item in self.items(said, section):
                self._rule(section, item)
        for section in PAIRS:
            for item in self.items(said, section):
                self._pair(section, item)
        return NameFile(
            self.file,
            digest,
            self.sections,
            self.pairs,
            phrases={name: self._phrases(said, name) for name in PHRASES},
            words={name: self._words(said, name) for name in WORDS},
            kinds={name: frozenset(self.kinds(said, name)) for name in KINDS},
        )

    def _phrases(self, said: dict[str, Value], key: str) -> frozenset[Phrase]:
        return frozenset(phrase for item in self.items(said, key) if (phrase := self._phrase(item)))

    def _words(self, said: dict[str, Value], key: str) -> frozenset[str]:
        return frozenset(word for item in self.items(said, key) for word in self._phrase(item))

    def _rule(self, section: str, item: Value) -> None:
        keys = KEYS if section in WITH_KINDS else tuple(key for key in KEYS if key not in OF_KINDS)
        words_too = ("words",) if section != UNPROMPTED else ()
        said = self.rule(item, keys, (*words_too, "why", *(("kinds",) if section in WITH_KINDS else ())))
        rule = NameRule(
            tuple(self.kinds(said, "kinds")),
            self._confidence(said),
            said["why"].text if "why" in said else "",
            Place(self.file, item.line),
            tuple(self.kinds(said, "instead_of")),
            self.is_true(said, "any_type"),
        )
        known = self.sections[section]
        if section == UNPROMPTED and "words" not in said:
            known[()] = rule
        for word in self.items(said, "words"):
            phrase = self._phrase(word)
            if phrase in known:
                what = f"{'_'.join(phrase)} again, first in line {known[phrase].place.line}"
                self.problem(word.line, what, "say each phrase once")
            elif phrase:
                known[phrase] = rule

    def _pair(self, section: str, item: Value) -> None:
        said = self.rule(item, ("from", "to", "confidence", "why", "source"), ("from", "to", "why"))
        confidence, why = self._confidence(said), said["why"].text if "why" in said else ""
        first = self.kind(said["from"]) if "from" in said else ""
        for second in self.kinds(said, "to"):
            if first:
                rule = NameRule((second,), confidence, why, Place(self.file, item.line))
                self.pairs[section][first, second] = rule

    def _phrase(self, item: Value) -> Phrase:
        phrase = words(item.text) if item.kind == "text" else ()
        if not phrase or len(phrase) > LONGEST_PHRASE:
            hint = f"write words of letters with _ between them, at most {LONGEST_PHRASE}; quote no, on and yes"
            self.problem(item.line, f"{shown(item.text or item.kind)!r} is no word of a name", hint)
            return ()
        return phrase

    def _confidence(self, said: dict[str, Value]) -> Confidence:
        if "confidence" not in said:
            return Confidence.MAY
        value = said["confidence"]
        if value.text not in SURE:
            hint = f"write {' or '.join(SURE)}: a name proves nothing"
            self.problem(value.line, f"confidence {shown(value.text or value.kind)!r}", hint)
            return Confidence.MAY
        return Confidence(value.text)
