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
    from collections.abc import Iterable

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.suggesting.name_rules import Phrase
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

NAMES = "rosprivacy:names"  # the shipped file
UNPROMPTED = "unprompted"  # the section in which a rule may have no words
WITH_KINDS, WITHOUT_KINDS = ("carries", "brings_in", UNPROMPTED), ("nothing", "lets_out")
LISTS = (
    "silent",
    "neutral",
    "computed",
    "not_by_type",
    "entered",
    "wanted",
    "commanding",
    "reworked",
    "reworking",
    "simulated",
    "understood",
    "driving",
)
PARTS = ("name_rules", "version", *WITH_KINDS, *WITHOUT_KINDS, "becomes", *LISTS)
OF_KINDS = ("kinds", "instead_of", "any_type")  # for rules that name kinds
KEYS = ("words", "confidence", "why", "source", *OF_KINDS)
SURE = (Confidence.LIKELY, Confidence.MAY)  # a name proves nothing, so no rule about one is certain


@dataclass(frozen=True, slots=True)
class NameFile:
    """One file of rules.

    Attributes
    ----------
    sections
        By section the rules of each phrase; of ``becomes``, by category and what is made of it.
    """

    file: str
    sha256: str
    silent: frozenset[Phrase]
    neutral: frozenset[str]
    computed: frozenset[str]
    not_by_type: frozenset[str]
    entered: frozenset[str]
    wanted: frozenset[Phrase]
    commanding: frozenset[str]
    reworked: frozenset[str]
    reworking: frozenset[str]
    simulated: frozenset[str]
    understood: frozenset[str]
    driving: frozenset[str]
    sections: dict[str, dict[Phrase, NameRule]]


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
    joined = {
        name: {phrase: rule for one in read for phrase, rule in one.sections[name].items()}
        for name in (*WITH_KINDS, *WITHOUT_KINDS)
    }
    becomes: dict[str, dict[str, NameRule]] = {}
    for one in read:
        for (source, made), rule in one.sections["becomes"].items():
            becomes.setdefault(source, {})[made] = rule
    rules = NameRules(
        **joined,
        silent=_silent(read),
        neutral=frozenset().union(*(one.neutral for one in read)),
        becomes=becomes,
        computed=frozenset().union(*(one.computed for one in read)),
        not_by_type=frozenset().union(*(one.not_by_type for one in read)),
        entered=frozenset().union(*(one.entered for one in read)),
        wanted=frozenset().union(*(one.wanted for one in read)),
        commanding=frozenset().union(*(one.commanding for one in read)),
        reworked=frozenset().union(*(one.reworked for one in read)),
        reworking=frozenset().union(*(one.reworking for one in read)),
        simulated=frozenset().union(*(one.simulated for one in read)),
        understood=frozenset().union(*(one.understood for one in read)),
        driving=frozenset().union(*(one.driving for one in read)),
    )
    return rules, tuple((one.file, one.sha256) for one in read)


def _silent(read: list[NameFile]) -> frozenset[Phrase]:
    """The phrases of all files, but for those of which a user's file says what they carry."""
    every = frozenset(phrase for one in read for phrase in one.silent)
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
        default_factory=lambda: {name: {} for name in (*WITH_KINDS, *WITHOUT_KINDS, "becomes")}
    )

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
        for item in self.items(said, "becomes"):
            self._becomes(item)
        return NameFile(
            self.file,
            digest,
            silent=self._phrases(said, "silent"),
            neutral=self._words(said, "neutral"),
            computed=frozenset(self.kinds(said, "computed")),
            not_by_type=frozenset(self.kinds(said, "not_by_type")),
            entered=frozenset(self.kinds(said, "entered")),
            wanted=self._phrases(said, "wanted"),
            commanding=self._words(said, "commanding"),
            reworked=self._words(said, "reworked"),
            reworking=self._words(said, "reworking"),
            simulated=self._words(said, "simulated"),
            understood=self._words(said, "understood"),
            driving=self._words(said, "driving"),
            sections=self.sections,
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

    def _becomes(self, item: Value) -> None:
        said = self.rule(item, ("from", "to", "confidence", "why", "source"), ("from", "to", "why"))
        confidence, why = self._confidence(said), said["why"].text if "why" in said else ""
        source = self.kind(said["from"]) if "from" in said else ""
        for made in self.kinds(said, "to"):
            if source:
                self.sections["becomes"][source, made] = NameRule((made,), confidence, why, Place(self.file, item.line))

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
