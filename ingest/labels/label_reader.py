"""The format of label files: YAML values -> entries, with every problem (rules S7, S8, S9).

In: the values of a file, each with its line. Out: a ``LabelReader`` with what it read. Fleet files have sections of the
same format, and read them with it.

Source: the paper, section II-A, for the roles and the six lists.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.analysis.kernel.ranks import NONE_OF
from rosprivacy.analysis.model import (
    CLEANS,
    GLOB,
    NAME,
    UNSTATED,
    Diagnostic,
    Method,
    Place,
    Processing,
    Severity,
    Statement,
    Surroundings,
)
from rosprivacy.ingest.labels.bag_storages import bags_of
from rosprivacy.ingest.labels.entries import EXACT, SHIPPED, Entry, FlowEntry, naming, specificity
from rosprivacy.ingest.labels.log_text import is_log, without_text
from rosprivacy.ingest.labels.name_reader import NameReader
from rosprivacy.ingest.labels.non_ros_reader import is_non_ros, read_element, read_limits
from rosprivacy.ingest.labels.pins import PINS, Pin, read_pins
from rosprivacy.ingest.labels.stated_processing import (
    OF_ELEMENT,
    OF_SYSTEM,
    read_processing,
    read_system,
    with_transfer,
)
from rosprivacy.ingest.labels.stated_types import read_types
from rosprivacy.ingest.labels.surroundings import read_contexts, read_country

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model.recording import Bag
    from rosprivacy.ingest.labels.non_ros_reader import Limit, Stated
    from rosprivacy.ingest.reading.yaml_values import Value

SECTIONS = {
    "nodes": ("node",),
    "channels": ("topic", "service", "action"),
    "topics": ("topic",),
    "services": ("service",),
    "actions": ("action",),
}
SIX_LISTS = ("source", "leak", "conduit", "sanitizer", "sensitive", "mundane")
NODE_KEYS = (
    "source",
    "leak",
    "sanitizer",
    "conduit",
    "derives",
    "subjects",
    "context",
    *OF_ELEMENT,
    "absent",
    "note",
    "author",
)
SAYS_NOTHING = ("subjects", "context", *OF_ELEMENT, "note", "author")  # of what data does
CHANNEL_KEYS = ("sensitive", "only", "never", "types", "note", "author")
FLOW_KEYS = ("from", "to", "only", "never", "note", "author")
OUTSIDE = ("elements", "limits")
SURROUNDINGS = ("context", "country")  # of a system
SYSTEM = (*OF_SYSTEM, *SURROUNDINGS)
NONE = "none"  # in place of categories: takes back what labels of lower rank say (rule S7)
LONGEST_GROUP = 100  # characters of a group of persons, or of the name of an author


@dataclass(eq=False, repr=False)
class LabelReader(NameReader):
    """Walks the file once, from the outside in."""

    category: str
    tier: int
    above: int = 0
    author: str = ""
    entries: list[Entry] = field(default_factory=list)
    flows: list[FlowEntry] = field(default_factory=list)
    elements: list[Stated] = field(default_factory=list)
    limits: list[Limit] = field(default_factory=list)
    surroundings: Surroundings = field(default_factory=Surroundings)
    processing: Processing = UNSTATED
    root: str = ""
    pins: tuple[Pin, ...] | None = None

    def bags_at(self, value: Value) -> tuple[Bag, ...]:
        """Return the bags that a storage names, relative to this file; none, and a problem, if they cannot be read."""
        try:
            return bags_of(self.file, self.root, value)
        except InputError as error:
            self.problem(value.line, error.problem, error.hint)
        return ()

    def rank(self, specific: int) -> tuple[int, int]:
        """Return the rank of a statement."""
        return (self.tier, specific + self.above)

    def document(self, top: Value) -> None:
        """Read a label file."""
        if top.kind != "map":
            self.problem(top.line, f"a label file is a map, not a {top.kind}", "begin with 'labels: 1'")
        elif top.get("labels") is None and any(top.get(key) for key in SIX_LISTS):
            self._six_lists(top)
        else:
            self._labels(top)

    def _labels(self, top: Value) -> None:
        self.version(top, "labels", "label")
        self.system(top)
        self.author = self._author(top)
        for key, line, value in self.entries_of(top, ("labels", "author", *SYSTEM, *SECTIONS, *OUTSIDE, "flows", PINS)):
            if key in SURROUNDINGS:
                self.surroundings = self.surrounded(self.surroundings, key, value)
            elif key in ("flows", *OUTSIDE):
                self.outside(key, line, value)
            elif key in SECTIONS:
                self._section(key, line, value)
            elif key == PINS:
                self.pins = read_pins(self, value)

    def surrounded(self, known: Surroundings, key: str, value: Value) -> Surroundings:
        """Return where a system works with what one more key says of it."""
        if key == "context":
            return known._replace(contexts=read_contexts(self, value))
        return known._replace(country=read_country(self, value))

    def system(self, top: Value) -> None:
        """Read what the top says of the whole system; fleet files say it too."""
        lines = [line for key, line, _ in top.entries if key in OF_SYSTEM]
        if lines:
            self.processing = read_system(self, top, Place(self.file, lines[0]))

    def outside(self, section: str, line: int, value: Value) -> None:
        """Read a section that fleet files have too."""
        if section == "limits":
            self.limits += read_limits(self, line, value)
        elif section == "flows":
            for item in self.list_of(value, "flows"):
                self._flow(item)
        elif value.kind not in ("map", "empty"):
            self.problem(line, f"elements is a map, not a {value.kind}", "write 'name: {kind: storage}'")
        for name, at, facts in value.entries if section == "elements" else ():
            self._element(name, at, facts)

    def _element(self, name: str, line: int, value: Value) -> None:
        stated = read_element(self, name, line, value, NODE_KEYS)
        if stated is None:
            return
        labels = value._replace(entries=tuple(entry for entry in value.entries if entry[0] in NODE_KEYS))
        statements = self._said(labels, self._node(labels, stated.place, self.rank(EXACT)))
        if stated.kind == "device" and all(key in SAYS_NOTHING for key, *_ in labels.entries):
            self.problem(line, f"device {shown(name)!r} does nothing", "say what comes from it: source: [Voice]")
        processing = self._processing(labels, stated.place)
        facts = with_transfer(self, value, stated.outside, processing.bases)
        self.elements.append(stated._replace(outside=facts))
        about = self._subjects(labels), processing, self.rank(EXACT), self._contexts(labels)
        self.entries.append(Entry((stated.kind,), name, stated.place, statements, *about))

    def _section(self, section: str, line: int, value: Value) -> None:
        if value.kind == "empty":
            return
        if value.kind != "map":
            self.problem(line, f"{section} is a map from names to labels, not a {value.kind}", "write '/name: label'")
        for name, at, label in value.entries:
            if is_non_ros(name):
                self.problem(at, f"name {shown(name)!r} is not absolute", "begin it with /")
                continue
            if len(name) > self.bounds.name:
                self.problem(at, *self.bounds.refusal("name", len(name)))
                continue
            rank = self.rank(specificity(name))
            read = self._node if section == "nodes" else self._channel
            statements = self._said(label, read(label, Place(self.file, at), rank), naming(name))
            if self.tier == SHIPPED and is_log(name):
                kinds = without_text(self.vocabulary)
                statements = tuple(one._replace(categories=kinds) for one in statements if kinds)
            place, of_node = Place(self.file, at), section == "nodes"
            subjects = self._subjects(label) if of_node else ()
            processing = self._processing(label, place) if of_node else UNSTATED
            contexts = self._contexts(label) if of_node else ()
            types = () if of_node else read_types(self, label, SECTIONS[section])
            about = subjects, processing, rank, contexts, types
            self.entries.append(Entry(SECTIONS[section], name, place, statements, *about))

    def _said(self, label: Value, statements: Iterable[Statement], how: str = NAME) -> tuple[Statement, ...]:
        """Statements of one entry, with how it names, its reason, and who says it: its author, or the file's."""
        note = label.get("note")
        why = note.text.strip() if note and note.kind == "text" else ""
        author = self._author(label) or self.author
        return tuple(s._replace(naming=how, why=s.why or why, author=author) for s in statements)

    def _author(self, label: Value) -> str:
        value = label.get("author")
        if value is None:
            return ""
        if value.kind != "text" or not value.text.strip() or len(value.text) > LONGEST_GROUP:
            what = f"author takes a name, not {shown(value.text) or f'a {value.kind}'!r}"
            self.problem(value.line, what, f"write who says it, in at most {LONGEST_GROUP} characters")
            return ""
        return value.text.strip()

    def _node(self, label: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        if label.kind == "empty":  # a line of --init that nobody has filled in yet
            return
        if label.kind == "text" and label.text == "conduit":
            yield Statement("conduit", (), rank, place)
            return
        if label.kind != "map":
            what = f"label {shown(label.text or label.kind)!r} on a node"
            self.problem(place.line, what, "write conduit, or {source: [Video]}, {leak: […]}, {sanitizer: {…}}, …")
            return
        for key, line, value in self.entries_of(label, NODE_KEYS):
            at = Place(self.file, line)
            if key in NONE_OF and (value.text == NONE or value.get(NONE)):
                yield from self._none(key, value, at, rank)
                value = value._replace(entries=tuple(one for one in value.entries if one[0] != NONE))  # noqa: PLW2901
                if not value.entries:
                    continue
            if key == "source":
                yield from self._source(value, at, rank)
            elif key in ("leak", "conduit"):
                for name in self.categories_of(value, key):
                    yield Statement(key, (name,), rank, at)
            elif key == "sanitizer":
                yield from self._sanitizer(value, at, rank)
            elif key == "derives":
                yield from self._derives(value, at, rank)
            elif key == "absent":
                yield from self._absent(label, value, at, rank)

    def _none(self, key: str, value: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        """What takes a source or a leak back: of all kinds, or of some."""
        if (kinds := value.get(NONE)) is None:
            yield Statement(NONE_OF[key], (), rank, place)
            return
        for name in self.categories_of(kinds, f"{key}: none"):
            yield Statement(NONE_OF[key], (name,), rank, place)

    def _source(self, value: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        if value.kind != "map":
            for name in self.categories_of(value, "source"):
                yield Statement("source", (name,), rank, place)
            return
        self.not_empty(value, "source")
        for written, line, channels in value.entries:
            name = self.kind_of_data(written, line)
            through = tuple(
                sorted({self.absolute_name(item) for item in self.list_of(channels, f"source of {shown(written)}")})
            )
            if not through:
                self.problem(line, f"source of {shown(written)} names no channel", "name them: [/topic]")
            yield Statement("source", (name,), rank, place, through=through)

    def _sanitizer(self, value: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        if value.kind != "map":
            for name in self.categories_of(value, "sanitizer"):
                yield Statement("sanitizer", (name,), rank, place, Method.PSEUDONYMISE, stated=False)
            return
        self.not_empty(value, "sanitizer")
        for written, line, method in value.entries:
            name = self.kind_of_data(written, line)
            if method.kind == "empty":
                yield Statement("sanitizer", (name,), rank, place, Method.PSEUDONYMISE, stated=False)
            elif method.kind == "text" and method.text in CLEANS:
                yield Statement("sanitizer", (name,), rank, place, Method(method.text))
            else:
                what = f"sanitizer method {shown(method.text or method.kind)!r}"
                self.problem(method.line, what, f"one of {', '.join(CLEANS)}")

    def _derives(self, value: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        if value.kind == "empty":
            self.problem(value.line, "derives takes a list, not nothing", "write [{from: Video, to: FaceTemplate}]")
        for item in self.list_of(value, "derives"):
            if item.kind != "map":
                self.problem(
                    item.line, f"a derivation is a map, not a {item.kind}", "write {from: Video, to: FaceTemplate}"
                )
                continue
            ends = {key: self.category_of(end) for key, _, end in self.entries_of(item, ("from", "to"))}
            if len(ends) < len(("from", "to")):
                self.problem(item.line, "a derivation needs from and to", "write {from: Video, to: FaceTemplate}")
            elif all(ends.values()):
                yield Statement("derivation", (ends["from"],), rank, place, to=ends["to"])

    def _absent(self, label: Value, why: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        """A node that has a profile and is not on the robot: nothing gets there, and nothing comes from it."""
        beside = [key for key, *_ in label.entries if key not in ("absent", "note", "author")]
        if why.kind != "text" or not why.text.strip():
            self.problem(place.line, "absent without a reason", "write why it is not there: {absent: a test tool}")
        elif beside:
            self.problem(place.line, f"absent beside {beside[0]}", "a node that is not there does nothing: keep one")
        else:
            yield Statement("sanitizer", (), rank, place, Method.ABSENT, why=why.text.strip())

    def _subjects(self, label: Value) -> tuple[str, ...]:
        """Whom the data of a source are about: groups of persons, as a person calls them."""
        value = label.get("subjects")
        if value is None:
            return ()
        if not value.items:
            self.problem(value.line, "subjects names nobody", "write [residents, staff], or remove it")
        for item in value.items:
            if item.kind != "text" or not item.text.strip() or len(item.text) > LONGEST_GROUP:
                what = f"{shown(item.text) or f'a {item.kind}'!r} where a group of persons is named"
                self.problem(item.line, what, f"write a word or two, at most {LONGEST_GROUP} characters")
        return tuple(sorted({item.text.strip() for item in value.items}))

    def _contexts(self, label: Value) -> tuple[str, ...]:
        """Where a source works, beside what is said of its system."""
        value = label.get("context")
        return () if value is None else read_contexts(self, value)

    def _processing(self, label: Value, place: Place) -> Processing:
        """What data there are processed for, and on which basis."""
        return read_processing(self, label.entries, place, OF_ELEMENT)

    def _channel(self, label: Value, place: Place, rank: tuple[int, int]) -> Iterable[Statement]:
        if label.kind == "empty":
            return
        if label.kind == "text" and label.text in ("mundane", "sensitive"):
            yield Statement(label.text, (), rank, place, shipped=self.tier <= SHIPPED)
            return
        if label.kind != "map":
            what = f"label {shown(label.text or label.kind)!r} on a channel"
            hint = "write mundane, sensitive, {sensitive: […]}, {only: […]}, {never: […]} or {types: […]}"
            self.problem(place.line, what, hint)
            return
        yield from self._restrictions(label, CHANNEL_KEYS, rank)

    def _restrictions(self, label: Value, keys: tuple[str, ...], rank: tuple[int, int]) -> Iterable[Statement]:
        """``only`` and ``never`` of a channel or flow, and for which kinds a channel is reviewed."""
        named: set[str] = set()
        for key, line, value in self.entries_of(label, keys):
            if key == "sensitive":
                reviewed = tuple(self.categories_of(value, key))
                if reviewed:
                    yield Statement(key, reviewed, rank, Place(self.file, line))
            elif key in ("only", "never"):
                names = tuple(self.categories_of(value, key))
                for name in sorted(named.intersection(names)):
                    self.problem(line, f"{name} is under only and under never", "name it under one of them")
                named.update(names)
                if names:
                    yield Statement(key, names, rank, Place(self.file, line))

    def _flow(self, item: Value) -> None:
        if item.kind != "map":
            self.problem(item.line, f"a flow is a map, not a {item.kind}", "write {from: /a, to: /b, never: [Video]}")
            return
        place = Place(self.file, item.line)
        ends = {key: self.end(value) for key, _, value in item.entries if key in ("from", "to")}
        names = [end.name for end in ends.values()]
        rank = self.rank(sum(map(specificity, names)))
        how = GLOB if any(naming(name) != NAME for name in names) else NAME
        statements = self._said(item, self._restrictions(item, FLOW_KEYS, rank), how)
        if len(ends) < len(("from", "to")):
            self.problem(item.line, "a flow needs from and to", "write {from: /a, to: /b, never: [Video]}")
            return
        stated = self.states(names)
        if not stated and not (item.get("only") or item.get("never")):
            hint = "write {from: /a, to: /b, never: [Video]}; what policies do not know goes through an element"
            self.problem(item.line, "a flow between nodes and channels needs only or never", hint)
            return
        if statements or (stated and all(names)):
            source, target = ends["from"], ends["to"]
            self.flows.append(FlowEntry(source.name, target.name, place, statements, (source.kind, target.kind)))

    def states(self, ends: Iterable[str]) -> bool:
        """Return whether a line about a flow states it; flows between nodes and channels are in the policies."""
        return any(map(is_non_ros, ends))

    def _six_lists(self, top: Value) -> None:
        """The paper's JSON: six lists of names, one kind of data; there a sanitizer ends it (rule S8)."""
        name = self.kind_of_data(self.category, 0)
        for role, line, value in self.entries_of(top, SIX_LISTS):
            kinds = SECTIONS["channels" if role in ("sensitive", "mundane") else "nodes"]
            for item in self.list_of(value, role):
                element = self.absolute_name(item)
                place, rank = Place(self.file, item.line), self.rank(specificity(element))
                method = Method.ANONYMISE if role == "sanitizer" else None
                statement = Statement(role, (name,), rank, place, method, naming=naming(element))
                self.entries.append(Entry(kinds, element, place, (statement,)))
            if role == "sanitizer" and value.items:
                message = "a sanitizer of the paper's six lists ends the category; the method is not stated"
                self.diagnostics.append(Diagnostic(Place(self.file, line), Severity.NOTICE, message))


def check_mundane(reader: LabelReader, top: Value) -> None:
    """Refuse what a file of standard channels says beside that channels are mundane (rule S13)."""
    hint = "write channels: {/name: mundane} only; other labels go into a file for --labels"
    for key, line, _ in top.entries if top.kind == "map" else ():
        if key in ("nodes", "flows", *OF_SYSTEM, *OUTSIDE, *SIX_LISTS, PINS):
            reader.problem(line, f"{key} in a file of standard channels", hint)
    for entry in reader.entries:
        for statement in entry.statements if "node" not in entry.kinds else ():
            if statement.role != "mundane":
                what = f"{shown(entry.name)!r} is {statement.role} in a file of standard channels"
                reader.problem(statement.place.line, what, hint)
        for one in entry.types[:1]:
            reader.problem(one.place.line, f"types of {shown(entry.name)!r} in a file of standard channels", hint)
