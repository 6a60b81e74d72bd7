"""The table of what message types cannot carry, and what they suggest (rule S15): the shipped one, or a user's.

In: ``ontology/types.yaml`` or a file of that format. Out: ``TypeTable``: for each type, or leg of one, the kinds that
it excludes, with all narrower ones of the shipped ontology, and the rules that suggest kinds. A kind of a user's own is
excluded only if the table names it, or if all of its broader kinds are excluded and the user's file states no other
form of data for it: what cannot be sent as a picture may be sent as a number. A type that was looked at and suggests no
kind has no rule, one that was not looked at is absent. A rule that suggests what the table excludes is an error: one of
the two lines is wrong.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import TypesError, shown
from rosprivacy.analysis.kernel.type_limits import TypeLimit, TypeLimits
from rosprivacy.analysis.model import Confidence, Place, Suggestion, by_confidence, interface_of, kind_of_type
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader, read_values
from rosprivacy.ingest.types import TABLE
from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.vocabulary import FOLDER, remembered

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Category
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

PARTS = ("type_table", "version", "assumes", "cannot", "hashes", "suggests")
LIMIT_KEYS = ("types", "leg", "kinds", "why", "source")
RULE_KEYS = ("types", "leg", "kinds", "confidence", "why", "source")
REQUIRED_KEYS = ("types", "kinds", "why", "source")
LEGS = {"topic": ("",), "service": ("request", "response"), "action": ("request", "response")}
HINT = "write certain, likely or may"
Key = tuple[str, str]  # name of a type, leg
Rules = tuple[Suggestion, ...]


@dataclass(frozen=True, slots=True)
class TypeTable:
    """A table of types.

    Attributes
    ----------
    limits
        What types cannot carry.
    suggestions
        The rules that suggest kinds, by (name of a type, leg); none for a type that was looked at and suggests no kind.
    """

    limits: TypeLimits
    suggestions: Mapping[Key, Rules]

    def knows(self, name: str) -> bool:
        """Return whether the table's author looked at what a type suggests, recorded parts of services included."""
        return any(key in self.suggestions for key in _keys(name))

    def suggested(self, name: str) -> Rules:
        """Return what a type suggests, the surest first; of a service or an action, what both legs do.

        >>> from rosprivacy.ontology.vocabulary import load
        >>> [one.kinds for one in read_table(TABLE, load()).suggested("nav_msgs/srv/GetMap_Event")]
        [('HomeMap',)]
        """
        rules = dict.fromkeys(rule for key in _keys(name) for rule in self.suggestions.get(key, ()))
        return tuple(sorted(rules, key=by_confidence))


def _keys(name: str) -> list[Key]:
    of = interface_of(name)
    return [(of, leg) for leg in LEGS.get(kind_of_type(of), ())]


def read_table(file: str, vocabulary: Vocabulary, bounds: Bounds = BOUNDS) -> TypeTable:
    """Read a table of types.

    Parameters
    ----------
    file
        Path, or ``TABLE`` for the shipped one.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``TypesError`` of one line.

    Examples
    --------
    >>> from rosprivacy.ontology.vocabulary import load
    >>> table = read_table(TABLE, load())
    >>> twist = table.limits.of["geometry_msgs/msg/Twist", ""]
    >>> "Video" in twist.kinds, "FaceImage" in twist.kinds, "Location" in twist.kinds
    (True, True, False)
    >>> [(str(one.confidence), *one.kinds) for one in table.suggested("sensor_msgs/msg/Joy")]
    [('likely', 'OperatorInput')]
    """
    if file == TABLE:
        return _shipped(vocabulary, bounds)
    return _table(file, *read_values(file, partial(TypesError, file), bounds), vocabulary, bounds)


@remembered
def _shipped(vocabulary: Vocabulary, bounds: Bounds) -> TypeTable:
    top, data = yaml_values.read_shipped(str(FOLDER / "types.yaml"), TypesError, TABLE)
    return _table(TABLE, top, data, vocabulary, bounds)


def _table(file: str, top: Value, data: bytes, vocabulary: Vocabulary, bounds: Bounds) -> TypeTable:
    reader = _TypeTableReader(file, vocabulary, error=TypesError, bounds=bounds)
    limits, hashes, suggestions = reader.whole(reader.document(top))
    made_for = {key: frozenset(kind for rule in rules for kind in rule.kinds) for key, rules in suggestions.items()}
    return TypeTable(TypeLimits(file, hashlib.sha256(data).hexdigest(), limits, hashes, made_for), suggestions)


def excluded(vocabulary: Vocabulary, kinds: frozenset[str]) -> frozenset[str]:
    """Return the kinds that a type cannot carry which cannot carry those that are named.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> sorted(excluded(load(), frozenset(["ContactData"])))
    ['ContactData', 'EmailAddress', 'PostalAddress', 'TelephoneNumber']
    """
    categories = vocabulary.categories
    known: dict[str, bool] = {}

    def holds(name: str) -> bool:
        if name not in known:
            known[name] = name in kinds  # also while what is broader is looked at
            category = categories[name]
            if not known[name] and category.broader:
                known[name] = _follows(category, [holds(up) for up in category.broader], vocabulary)
        return known[name]

    return frozenset(name for name in categories if holds(name))


def _follows(category: Category, broader: list[bool], vocabulary: Vocabulary) -> bool:
    """Whether a kind is excluded since its broader ones are; another parent or form of data sets a user's apart."""
    if category.iri.startswith(STORED):
        return any(broader)
    forms = {form for up in category.broader for form in vocabulary.categories[up].data_types}
    return all(broader) and set(category.data_types) <= forms


@dataclass(frozen=True, slots=True)
class _Entry:
    """One entry: for which types, or a leg of them, it says something of which kinds, and its reason.

    Attributes
    ----------
    types
        (name of a type, leg as written, line).
    kinds
        Names of categories.
    entries
        All that it says, by key.
    """

    line: int
    types: tuple[tuple[str, str, int], ...]
    kinds: tuple[str, ...]
    entries: Mapping[str, Value]

    def text(self, key: str) -> str:
        """Return what it says under a key; empty for nothing."""
        return self.entries[key].text if key in self.entries else ""


@dataclass
class _TypeTableReader(FileReader):
    """One table."""

    vocabulary: Vocabulary

    def document(self, top: Value) -> tuple[dict[Key, TypeLimit], dict[str, frozenset[str]], dict[Key, Rules]]:
        if not self.is_format(top, "type_table", "a table of types", "table"):
            return {}, {}, {}
        parts = self.values_of(top, PARTS)
        limits = self._limits(self.list_of(parts["cannot"], "cannot") if "cannot" in parts else ())
        rules = self.list_of(parts["suggests"], "suggests") if "suggests" in parts else ()
        return limits, self._hashes(parts.get("hashes")), self._suggestions(rules, limits)

    def _hashes(self, value: Value | None) -> dict[str, frozenset[str]]:
        found: dict[str, frozenset[str]] = {}
        for name, line, hashes in value.entries if value else ():
            if not kind_of_type(name):
                self.problem(line, f"{shown(name)!r} is not the name of a type", "write pkg/msg/Name: [RIHS01_…]")
            found[name] = frozenset(one.text for one in self.list_of(hashes, name))
        return found

    def _limits(self, items: Iterable[Value]) -> dict[Key, TypeLimit]:
        found: dict[Key, TypeLimit] = {}
        for item in items:
            entry = self._entry(item, LIMIT_KEYS)
            if entry is None:
                continue
            limit = TypeLimit(excluded(self.vocabulary, frozenset(entry.kinds)), Place(self.file, entry.line))
            for name, leg, _ in entry.types:
                if (name, leg) in found:
                    what = f"{name}{' ' if leg else ''}{leg} again, first in line {found[name, leg].place.line}"
                    self.problem(limit.place.line, what, "write all kinds in one entry")
                found.setdefault((name, leg), limit)
        return found

    def _entry(self, item: Value, keys: tuple[str, ...], *, both_legs: bool = False) -> _Entry | None:
        """An entry; None if it does not say for which types or of which kinds.

        Parameters
        ----------
        both_legs
            Whether a type with two legs may stand without one.
        """
        said = self.values_of(item, keys)
        for key in REQUIRED_KEYS:
            if key not in said:
                self.problem(item.line, f"an entry without {key}", "write {types: […], kinds: […], why: …, source: …}")
        if not {"types", "kinds"} <= said.keys():
            return None
        kinds = tuple(self._kinds(said["kinds"]))
        leg = said["leg"].text if "leg" in said else ""
        return _Entry(item.line, tuple(self._types(said["types"], leg, both_legs=both_legs)), kinds, said)

    def _types(self, value: Value, leg: str, *, both_legs: bool) -> Iterator[tuple[str, str, int]]:
        for one in self.list_of(value, "types"):
            kind = kind_of_type(one.text)
            if not kind:
                self.problem(
                    one.line, f"{shown(one.text or one.kind)!r} is not the name of a type", "write pkg/msg/Name"
                )
            elif leg not in LEGS[kind] and not (both_legs and not leg):
                legs = " or ".join(LEGS[kind])
                hint = f"write leg: {legs}" if legs else "remove its leg"
                self.problem(one.line, f"{one.text} is the type of a {kind}", hint)
            else:
                yield one.text, leg, one.line

    def _kinds(self, value: Value) -> Iterator[str]:
        for item in self.list_of(value, "kinds"):
            category = self.vocabulary.find(item.text) if item.kind == "text" else None
            if category is None:
                self.problem(item.line, f"unknown category {shown(item.text)!r}", self.vocabulary.hint(item.text))
            else:
                yield category.name

    def _suggestions(self, items: Iterable[Value], limits: Mapping[Key, TypeLimit]) -> dict[Key, Rules]:
        found: dict[Key, Rules] = {}
        empty: dict[Key, int] = {}  # of those that suggest no kind, the line
        for item in items:
            entry = self._entry(item, RULE_KEYS, both_legs=True)
            if entry is None:
                continue
            confidence = self._confidence(entry)
            for name, leg, line in entry.types:
                keys = [(name, leg)] if leg else [(name, one) for one in LEGS[kind_of_type(name)]]
                self._contradicted(entry, line, [limits.get(key) for key in keys])
                for key in keys:
                    rules = found.setdefault(key, ())
                    if twice := _twice(entry, rules, empty.get(key)):
                        self.problem(line, f"{name} again, first in line {twice}", "say each kind once")
                        break
                    if not entry.kinds:
                        empty[key] = entry.line
                    elif confidence:
                        place = Place(self.file, entry.line)
                        said = (confidence, entry.text("why"), entry.text("source"))
                        found[key] = (*rules, Suggestion(name, entry.kinds, *said, place))
        return found

    def _confidence(self, entry: _Entry) -> Confidence | None:
        written = entry.text("confidence")
        if written in tuple(Confidence):
            if not entry.kinds:
                self.problem(entry.entries["confidence"].line, "a confidence, and no kind", "remove it, or name a kind")
            return Confidence(written)
        if "confidence" in entry.entries:
            self.problem(entry.entries["confidence"].line, f"confidence {shown(written)!r}", HINT)
        elif entry.kinds:
            self.problem(entry.line, "a suggestion without confidence", HINT)
        return None

    def _contradicted(self, entry: _Entry, line: int, limits: list[TypeLimit | None]) -> None:
        """Note what the table excludes of every leg that the rule is about."""
        for kind in entry.kinds:
            against = [one for one in limits if one and kind in one.kinds]
            if len(against) == len(limits):
                what = f"it suggests {kind}, which line {against[0].place.line} says it cannot carry"
                self.problem(line, what, "correct one of the two")


def _twice(entry: _Entry, rules: Rules, empty: int | None) -> int | None:
    """The line that says of a type what the entry says again, or denies."""
    if rules and not entry.kinds:
        return rules[0].place.line
    return empty or next((one.place.line for one in rules if not set(one.kinds).isdisjoint(entry.kinds)), None)
