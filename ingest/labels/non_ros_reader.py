"""The sections ``elements`` and ``limits`` of label and fleet files -> what lies outside ROS (rule S9).

In: values that know their line. Out: elements with the facts that are stated about them, and how long kinds of data
may be kept. What is not understood is handed to the reader as a problem.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from rosprivacy.analysis.durations import Duration, ordered
from rosprivacy.analysis.durations import parse as parse_duration
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import NO_BASIS, NON_ROS, NonRosFacts, Place
from rosprivacy.analysis.non_ros import EVERY, RECIPIENTS, TRANSFERS
from rosprivacy.analysis.written_names import GLOB_SIGNS, LITERAL
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ingest.labels.surroundings import read_country

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.model.recording import Bag
    from rosprivacy.ingest.labels.entries import End
    from rosprivacy.ingest.reading.yaml_values import Value

LONGEST = 200  # characters of a name
BAG = "bag"  # the recording that a storage is
CARRIERS = ("shared-memory", "side-channel")
FACTS = ("country", "operator", "recipient", "contract", "transfer")
OF_KIND = {"storage": ("retention", "backups", "encrypted", BAG), **dict.fromkeys(CARRIERS, ("between",))}
TRUE, FALSE = ("true", "yes", "on"), ("false", "no", "off")
Limit = tuple[str, Duration]  # category, how long it may be kept


class Reader(Protocol):
    """Who reads the file: it knows its name, gathers problems and finds categories."""

    file: str

    def problem(self, line: int, problem: str, hint: str) -> None:
        """Take a problem."""

    def entries_of(self, value: Value, known: tuple[str, ...]) -> Iterable[tuple[str, int, Value]]:
        """Return the entries of a map, those with unknown keys reported."""

    def end(self, value: Value) -> End:
        """Return an end of a flow; its name is empty, and there is a problem, if it is none."""

    def kind_of_data(self, written: str, line: int) -> str:
        """Return the name of a category; empty, and a problem, if there is none."""

    def bags_at(self, value: Value) -> tuple[Bag, ...]:
        """Return the bags that are named; none, and a problem, if they cannot be read."""


class Stated(NamedTuple):
    """A non-ROS element as a file states it.

    Attributes
    ----------
    outside
        Without limits.
    between
        The nodes, or channels, that it joins, in both directions.
    bags
        Of a storage: the recordings that it is.
    """

    kind: str
    name: str
    outside: NonRosFacts
    between: tuple[End, ...] = ()
    bags: tuple[Bag, ...] = ()

    @property
    def place(self) -> Place:
        """Where it is stated."""
        return self.outside.place


def is_non_ros(name: str) -> bool:
    """Return whether a name is one of a non-ROS element; names of ROS begin with ``/``, a glob sign or ``=``."""
    return not name.startswith(("/", LITERAL, *GLOB_SIGNS))


def read_element(reader: Reader, name: str, line: int, value: Value, labels: tuple[str, ...]) -> Stated | None:
    """Read one element; ``labels`` are keys that say what it does, read elsewhere."""
    if not is_non_ros(name) or ":" in name or len(name) > LONGEST or not name.isprintable() or name != name.strip():
        hint = f"a plain name of at most {LONGEST} characters, not beginning with / = * ? [, and without a colon"
        reader.problem(line, f"{shown(name)!r} cannot name an element outside ROS", hint)
        return None
    kind = value.get("kind") if value.kind == "map" else None
    if kind is None or kind.text not in NON_ROS:
        what = (
            f"element {shown(name)!r} of kind {shown(kind.text)!r}" if kind else f"element {shown(name)!r} has no kind"
        )
        reader.problem(line if kind is None else kind.line, what, f"write {{kind: …}}, one of {', '.join(NON_ROS)}")
        return None
    facts = _Facts(reader)
    known = ("kind", *FACTS, *OF_KIND.get(kind.text, ()), *labels)
    for key, at, fact in reader.entries_of(value, known):
        if key not in ("kind", *labels):
            facts.take(key, at, fact)
    return Stated(kind.text, name, facts.outside(Place(reader.file, line)), facts.between, facts.bags)


def read_limits(reader: Reader, line: int, value: Value) -> Iterator[Limit]:
    """Read how long kinds of data may be kept at most."""
    if value.kind not in ("map", "empty"):
        reader.problem(line, f"limits is a map, not a {value.kind}", "write {Video: P30D}")
    for written, at, duration in value.entries:
        category, limit = reader.kind_of_data(written, at), _duration(reader, at, duration)
        if category and limit:
            yield category, limit


class _Facts:
    """The facts of one element, one after the other."""

    def __init__(self, reader: Reader) -> None:
        self.between: tuple[End, ...] = ()
        self.bags: tuple[Bag, ...] = ()
        self._bag = ""
        self._reader = reader
        self._retention: list[Limit] = []
        self._texts: dict[str, str] = {}
        self._backups: Duration | bool | None = None
        self._encrypted: bool | None = None

    def outside(self, place: Place) -> NonRosFacts:
        retention = ordered(self._retention)
        facts = NonRosFacts(
            retention, (), self._backups, encrypted=self._encrypted, place=place, recording=None, **self._texts
        )
        if not self.bags:
            return facts
        from rosprivacy.analysis.model.recording import recording_of  # noqa: PLC0415 - light start

        return facts._replace(recording=recording_of(self._bag, self.bags))

    def take(self, key: str, line: int, value: Value) -> None:
        if key == "retention":
            self._take_retention(line, value)
        elif key == "backups":
            said = _flag(value)
            self._backups = _duration(self._reader, line, value, ", or true or false") if said is None else said
        elif key == "encrypted":
            self._encrypted = _flag(value)
            if self._encrypted is None:
                self._reader.problem(line, f"encrypted: {_written(value)}", "write true or false")
        elif key == "between":
            self._take_between(line, value)
        elif key == BAG:
            self._bag, self.bags = value.text, self._reader.bags_at(value)
        elif key == "country":
            self._take_country(value)
        else:
            self._take_text(key, value)

    def _take_retention(self, line: int, value: Value) -> None:
        pairs = value.entries if value.kind == "map" else ((EVERY, line, value),)
        if not pairs:
            self._reader.problem(line, "retention names no category", "write {Video: P30D}, or P30D for every one")
        for written, at, duration in pairs:
            category = self._reader.kind_of_data(written, at) if written else EVERY
            kept = _duration(self._reader, at, duration)
            if kept and (category or not written):
                self._retention.append((category, kept))

    def _take_between(self, line: int, value: Value) -> None:
        ends = tuple(self._reader.end(item) for item in value.items)
        if len(ends) < len(("one", "another")) or any(end.name and is_non_ros(end.name) for end in ends):
            self._reader.problem(line, "between names at least two nodes", "write [/one, /another]")
        else:
            self.between = ends

    def _take_country(self, value: Value) -> None:
        if code := read_country(self._reader, value):
            self._texts |= countries().place(code)

    def _take_text(self, key: str, value: Value) -> None:
        allowed = {"recipient": RECIPIENTS, "transfer": (*TRANSFERS, NO_BASIS)}.get(key)
        usable = value.kind == "text" and value.text.strip() and value.text.isprintable()
        if not usable or (allowed and value.text not in allowed):
            hint = f"one of {', '.join(allowed)}" if allowed else "write its name"
            self._reader.problem(value.line, f"{key}: {_written(value)}", hint)
        else:
            self._texts[key] = value.text


def _flag(value: Value) -> bool | None:
    text = value.text.casefold() if value.kind == "number" else ""
    return True if text in TRUE else False if text in FALSE else None


def _duration(reader: Reader, line: int, value: Value, more: str = "") -> Duration | None:
    try:
        return parse_duration(value.text)
    except ValueError as error:
        hint = f"write a duration of ISO 8601, such as P30D or P6M{more}"
        reader.problem(value.line if value.text else line, f"{_written(value)} is {error}", hint)
        return None


def _written(value: Value) -> str:
    return repr(shown(value.text)) if value.text else f"a {value.kind}" if value.kind != "empty" else "nothing"
