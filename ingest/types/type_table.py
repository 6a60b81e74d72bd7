"""The table of what message types cannot carry, and what they suggest (rule S15): the shipped one, or a user's.

In: ``ontology/types.yaml`` or a file of that format. Out: ``TypeTable``: for each type, or leg of one, the kinds that
it excludes, with all narrower ones of the shipped ontology, and the rules that suggest kinds. A kind of a user's own
is excluded only if the table names it, or if all of its broader kinds are excluded and the user's file states no other
form of data for it: what cannot be sent as a picture may be sent as a number.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, TypesError, shown
from rosprivacy.analysis.kernel.type_limits import TypeLimit, TypeLimits
from rosprivacy.analysis.model import Place, Suggestion, by_confidence, interface_of, kind_of_type
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_entries import LEGS, EntryReader
from rosprivacy.ingest.types.type_suggestions import read_suggestions
from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.vocabulary import FOLDER

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Category
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

PARTS = ("type_table", "version", "assumes", "cannot", "hashes", "suggests")
KEYS = ("types", "leg", "kinds", "why", "source")
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
    try:
        if file == TABLE:
            top, data = yaml_values.read_shipped(str(FOLDER / "types.yaml"), TypesError, file)
        else:
            top, data = yaml_values.read(file, partial(TypesError, file), bounds)
    except InputError as error:
        raise InputErrors([error]) from None
    reader = _Reader(file, error=TypesError, bounds=bounds)
    limits, hashes, suggestions = reader.document(top, vocabulary)
    if reader.problems:
        raise InputErrors(reader.problems)
    return TypeTable(TypeLimits(file, hashlib.sha256(data).hexdigest(), limits, hashes), suggestions)


def excluded(vocabulary: Vocabulary, named: frozenset[str]) -> frozenset[str]:
    """Return the kinds that a type cannot carry which cannot carry those that are named.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> sorted(excluded(load(), frozenset(["ContactData"])))
    ['ContactData', 'EmailAddress', 'PostalAddress', 'TelephoneNumber']
    """
    categories = vocabulary.categories
    known: dict[str, bool] = {}

    def holds(name: str) -> bool:
        if name not in known:
            known[name] = name in named  # also while what is broader is looked at
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


class _Reader(EntryReader):
    """One table."""

    def document(
        self, top: Value, vocabulary: Vocabulary
    ) -> tuple[dict[Key, TypeLimit], dict[str, frozenset[str]], dict[Key, Rules]]:
        if top.kind != "map":
            self.problem(top.line, f"a table of types is a map, not a {top.kind}", "begin with 'type_table: 1'")
            return {}, {}, {}
        self.version(top, "type_table", "table")
        said = {key: value for key, _, value in self.entries_of(top, PARTS)}
        limits = self._limits(self.list_of(said["cannot"], "cannot") if "cannot" in said else (), vocabulary)
        rules = self.list_of(said["suggests"], "suggests") if "suggests" in said else ()
        return limits, self._hashes(said.get("hashes")), read_suggestions(self, rules, vocabulary, limits)

    def _hashes(self, value: Value | None) -> dict[str, frozenset[str]]:
        found: dict[str, frozenset[str]] = {}
        for name, line, hashes in value.entries if value else ():
            if not kind_of_type(name):
                self.problem(line, f"{shown(name)!r} is not the name of a type", "write pkg/msg/Name: [RIHS01_…]")
            found[name] = frozenset(one.text for one in self.list_of(hashes, name))
        return found

    def _limits(self, items: Iterable[Value], vocabulary: Vocabulary) -> dict[Key, TypeLimit]:
        found: dict[Key, TypeLimit] = {}
        for item in items:
            entry = self.entry(item, KEYS, vocabulary)
            if entry is None:
                continue
            limit = TypeLimit(excluded(vocabulary, frozenset(entry.kinds)), Place(self.file, entry.line))
            for name, leg, _ in entry.types:
                if (name, leg) in found:
                    what = f"{name}{' ' if leg else ''}{leg} again, first in line {found[name, leg].place.line}"
                    self.problem(limit.place.line, what, "write all kinds in one entry")
                found.setdefault((name, leg), limit)
        return found
