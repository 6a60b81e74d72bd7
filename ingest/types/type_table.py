"""The table of what message types cannot carry -> ``TypeLimits`` (rule S15): the shipped one, or a user's in its place.

In: ``ontology/types.yaml`` or a file of that format. Out: for each type, or leg of one, the kinds that it excludes,
with all narrower ones of the shipped ontology. A kind of a user's own is excluded only if the table names it, or if
all of its broader kinds are excluded and the user's file states no other form of data for it: what cannot be sent as a
picture may be sent as a number.
"""

from __future__ import annotations

import hashlib
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, TypesError, shown
from rosprivacy.analysis.kernel.type_limits import TypeLimit, TypeLimits
from rosprivacy.analysis.model import Place, kind_of_type
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader
from rosprivacy.ontology.iris import STORED
from rosprivacy.ontology.vocabulary import FOLDER

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Category
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

TABLE = "rosprivacy:types"  # the shipped one, as a report names it
KEYS = ("types", "leg", "kinds", "why", "source")
LEGS = {"topic": ("",), "service": ("request", "response"), "action": ("request", "response")}


def read_table(file: str, vocabulary: Vocabulary, bounds: Bounds = BOUNDS) -> TypeLimits:
    """Read a table of limits.

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
    >>> limits = read_table(TABLE, load())
    >>> twist = limits.of["geometry_msgs/msg/Twist", ""]
    >>> "Video" in twist.kinds, "FaceImage" in twist.kinds, "Location" in twist.kinds
    (True, True, False)
    """
    path = str(FOLDER / "types.yaml") if file == TABLE else file
    try:
        top, data = yaml_values.read(path, partial(TypesError, file), bounds)
    except InputError as error:
        raise InputErrors([error]) from None
    reader = _Reader(file, error=TypesError, bounds=bounds)
    found = reader.document(top, vocabulary)
    if reader.problems:
        raise InputErrors(reader.problems)
    return TypeLimits(file, hashlib.sha256(data).hexdigest(), found)


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


class _Reader(FileReader):
    """One table."""

    def document(self, top: Value, vocabulary: Vocabulary) -> dict[tuple[str, str], TypeLimit]:
        found: dict[tuple[str, str], TypeLimit] = {}
        if top.kind != "map":
            self.problem(top.line, f"a table of types is a map, not a {top.kind}", "begin with 'type_table: 1'")
            return found
        self.version(top, "type_table", "table")
        said = {key: value for key, _, value in self.entries_of(top, ("type_table", "version", "assumes", "cannot"))}
        for item in self.list_of(said["cannot"], "cannot") if "cannot" in said else ():
            for key, limit in self._entry(item, vocabulary):
                if key in found:
                    what = f"{' '.join(filter(None, key))} again, first in line {found[key].place.line}"
                    self.problem(limit.place.line, what, "write all kinds in one entry")
                found.setdefault(key, limit)
        return found

    def _entry(self, item: Value, vocabulary: Vocabulary) -> Iterator[tuple[tuple[str, str], TypeLimit]]:
        said = {key: value for key, _, value in self.entries_of(item, KEYS)}
        for key in ("types", "kinds", "why", "source"):
            if key not in said:
                self.problem(item.line, f"an entry without {key}", "write {types: […], kinds: […], why: …, source: …}")
        if not {"types", "kinds"} <= said.keys():
            return
        kinds = frozenset(self._kinds(said["kinds"], vocabulary))
        leg = said["leg"].text if "leg" in said else ""
        limit = TypeLimit(excluded(vocabulary, kinds), Place(self.file, item.line))
        for one in self.list_of(said["types"], "types"):
            kind = kind_of_type(one.text)
            if not kind:
                self.problem(
                    one.line, f"{shown(one.text or one.kind)!r} is not the name of a type", "write pkg/msg/Name"
                )
            elif leg not in LEGS[kind]:
                legs = " or ".join(LEGS[kind])
                hint = f"write leg: {legs}" if legs else "remove its leg"
                self.problem(one.line, f"{one.text} is the type of a {kind}", hint)
            else:
                yield (one.text, leg), limit

    def _kinds(self, value: Value, vocabulary: Vocabulary) -> Iterator[str]:
        for item in self.list_of(value, "kinds"):
            category = vocabulary.find(item.text) if item.kind == "text" else None
            if category is None:
                self.problem(item.line, f"unknown category {shown(item.text)!r}", vocabulary.hint(item.text))
            else:
                yield category.name
