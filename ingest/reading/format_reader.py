"""What the readers of our YAML formats have in common: problems with their line, the version, unknown keys.

In: a file, or values that know their line (``yaml_values.py``). Out: what a format's reader makes of them; all problems
of a file at once.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.bounds import BOUNDS, Bounds
from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.written_names import did_you_mean, nearest
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.file_kinds import FileKind, kind_of_map, of_key

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

    Read = TypeVar("Read")

LEVELS = 3  # of maps below the outermost, in which a file of others shows what it is


def read_values(file: str, fail: Callable[[int, str, str], InputError], bounds: Bounds = BOUNDS) -> tuple[Value, bytes]:
    """Read the values and the bytes of a file; see ``yaml_values.read``.

    Raises
    ------
    InputErrors
        With the one problem that keeps it from being read.
    """
    try:
        return yaml_values.read(file, fail, bounds)
    except InputError as error:
        raise InputErrors([error]) from None


def _kind_of(top: Value) -> FileKind | None:
    """What a map is by its keys, and by those that stand a few levels below."""
    inner: set[str] = set()
    level = [value for _, _, value in top.entries]
    for _ in range(LEVELS):
        entries = [entry for value in level for each in (value, *value.items) for entry in each.entries]
        inner.update(key for key, _, _ in entries)
        level = [value for _, _, value in entries]
    form = top.get("format")
    return kind_of_map([key for key, _, _ in top.entries], inner, form.text if form else "")


@dataclass(kw_only=True, eq=False, repr=False)
class FileReader:
    """Walks one file once, from the outside in.

    Attributes
    ----------
    error
        Of this kind its problems are.
    """

    file: str = field(kw_only=False)
    error: type[InputError]
    problems: list[InputError] = field(default_factory=list)
    bounds: Bounds = BOUNDS

    def problem(self, line: int, problem: str, hint: str) -> None:
        """Note a problem; the file is read on."""
        self.problems.append(self.error(self.file, line, problem, hint))

    def whole(self, read: Read) -> Read:
        """Return what was read, if all of it was understood.

        Raises
        ------
        InputErrors
            With every problem of the file.
        """
        if self.problems:
            raise InputErrors(self.problems)
        return read

    def is_format(self, top: Value, key: str, a_file: str, name: str = "") -> bool:
        """Return whether a file is a map that says which format it is of; see ``version``."""
        if top.kind != "map":
            self.problem(top.line, f"{a_file} is a map, not a {top.kind}", f"begin with '{key}: 1'")
            return False
        self.version(top, key, name or key)
        return True

    def version(self, top: Value, key: str, name: str) -> None:
        """Check that a file says which format it is of: ``key: 1``.

        Raises
        ------
        InputErrors
            If it does not: then it may be anybody's, and no message repeats what stands in it.
        """
        version = top.get(key)
        if version is None:
            kind = _kind_of(top)
            if kind is not None and kind.key != key:
                self.problem(1, *kind.refused(of_key(key), self.file))
            else:
                self.problem(top.line, f"no '{key}: 1'", "say so on the first line: it is the format's version")
            raise InputErrors(self.problems)
        if (version.kind, version.text) != ("number", "1"):
            found = f"{name} format {shown(version.text or version.kind)!r}"
            self.problem(version.line, found, f"this reads '{key}: 1'")

    def entries_of(self, value: Value, keys: tuple[str, ...]) -> Iterable[tuple[str, int, Value]]:
        """Return the entries of a map, those with unknown keys reported."""
        for key, line, child in value.entries:
            if key in keys:
                yield key, line, child
            else:
                hint = did_you_mean([*map(repr, nearest(key, keys))], f"one of {', '.join(keys)}")
                self.problem(line, f"unknown key {shown(key)!r}", hint)

    def values_of(self, value: Value, keys: tuple[str, ...]) -> dict[str, Value]:
        """Return the values of a map by key; see ``entries_of``."""
        return {key: child for key, _, child in self.entries_of(value, keys)}

    def category_of_name(self, vocabulary: Vocabulary, written: str, line: int) -> str:
        """Return the kind of data of a name; empty, and a problem with the nearest names, if there is none (S11)."""
        category = vocabulary.find(written)
        if category is None:
            self.problem(line, f"unknown category {shown(written)!r}", vocabulary.hint(written))
            return ""
        return category.name

    def list_of(self, value: Value, key: str, hint: str = "write […]") -> tuple[Value, ...]:
        """Return the items of a list; nothing is an empty one."""
        if value.kind not in ("list", "empty"):
            self.problem(value.line, f"{key} takes a list, not a {value.kind}", hint)
        return value.items
