"""The format of label files: YAML values -> entries, with every problem (rules S7, S8, S9).

In: the values of a file, each with its line. Out: a ``LabelReader`` with what it read. Fleet files have sections of the
same format, and read them with it. What a keyword means stands in ``keywords.py``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.kernel.ranks import NONE_OF
from rosprivacy.analysis.model import (
    GLOB,
    NAME,
    NON_ROS,
    TYPE_LINE,
    UNSTATED,
    Diagnostic,
    Method,
    NonRosFacts,
    Place,
    Processing,
    Severity,
    Statement,
    Surroundings,
)
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ingest.labels.entries import (
    EXACT,
    LONGEST_NAME,
    SECTIONS,
    SHIPPED,
    Entry,
    FlowEntry,
    Stated,
    is_log,
    is_non_ros,
    naming,
    specificity,
    without_text,
)
from rosprivacy.ingest.labels.keyword_readers import LONGEST_GROUP, read_duration
from rosprivacy.ingest.labels.keywords import (
    CHANNEL,
    FLOW,
    NO_KIND,
    NODE,
    keys_of,
    keywords_of,
    moves_data,
    words_of,
)
from rosprivacy.ingest.labels.name_reader import NameReader
from rosprivacy.ingest.labels.pins import (
    CODE,
    LINES,
    OF_OTHERS,
    PINS,
    CodePin,
    Pin,
    TypePin,
    read_code_pins,
    read_pins,
    read_type_pins,
)
from rosprivacy.ingest.labels.stated_facts import (
    OF_SYSTEM,
    SURROUNDINGS,
    check_types,
    processing_at,
    read_context_names,
    read_country_code,
    read_grounds,
    read_system,
    with_transfer,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.labels.entries import Limit
    from rosprivacy.ingest.reading.yaml_values import Value

SIX_LISTS = ("source", "leak", "conduit", "sanitizer", "sensitive", "mundane")
OUTSIDE = ("elements", "limits")
ENDS = ("from", "to")
TOP = ("labels", "author", *OF_SYSTEM, *SURROUNDINGS, *SECTIONS, *OUTSIDE, "flows", PINS)
NO_LABEL = {
    NODE: "write conduit, or {source: [Video]}, {leak: […]}, {sanitizer: {…}}, …",
    CHANNEL: "write mundane, sensitive, {sensitive: […]}, {only: […]}, {never: […]} or {types: […]}",
}


@dataclass(eq=False, repr=False)
class LabelReader(NameReader):
    """Walks the file once, from the outside in.

    Attributes
    ----------
    category
        What the paper's six lists are about.
    tier, above
        Of the ranks of its statements; ``above`` is added where the file is about one robot.
    author
        Who wrote the file, as its top says.
    """

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
    pins: tuple[Pin, ...] | None = None
    type_pins: tuple[TypePin, ...] | None = None
    code_pins: tuple[CodePin, ...] = ()

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
        for key, line, value in self.entries_of(top, TOP):
            if key in SURROUNDINGS:
                self.surroundings = self.surrounded(self.surroundings, key, value)
            elif key in ("flows", *OUTSIDE):
                self.outside(key, line, value)
            elif key in SECTIONS:
                self._section(key, line, value)
            elif key == PINS:
                lines, code = ((value.get(part) if value.kind == "map" else None) for part in (LINES, CODE))
                self.type_pins = None if lines is None else read_type_pins(self, lines)
                self.code_pins = () if code is None else read_code_pins(self, code)
                pins = read_pins(self, value)
                others_only = value.entries and {part for part, *_ in value.entries} <= {*OF_OTHERS}
                self.pins = None if others_only else pins

    def surrounded(self, surroundings: Surroundings, key: str, value: Value) -> Surroundings:
        """Return where a system works with what one more key says of it."""
        if key == "context":
            return surroundings._replace(contexts=read_context_names(self, value))
        if key == "gdpr":
            grounds = read_grounds(self, value)
            return surroundings._replace(established=grounds.get("established"), targeted=grounds.get("targeted"))
        code = read_country_code(self, value)
        return surroundings._replace(country=code, abroad=countries().is_abroad(code))

    def system(self, top: Value) -> None:
        """Read what the top says of the whole system; fleet files say it too."""
        if any(top.get(key) for key in OF_SYSTEM):
            self.processing = read_system(self, top)

    def outside(self, section: str, line: int, value: Value) -> None:
        """Read a section that fleet files have too."""
        if section == "flows":
            for item in self.list_of(value, "flows"):
                self._flow(item)
        elif value.kind not in ("map", "empty"):
            hint = "write 'name: {kind: storage}'" if section == "elements" else "write {Video: P30D}"
            self.problem(line, f"{section} is a map, not a {value.kind}", hint)
        elif section == "elements":
            for name, at, facts in value.entries:
                self._element(name, at, facts)
        else:
            for name, at, duration in value.entries:
                category, limit = self.kind_of_data(name, at), read_duration(self, at, duration)
                if category and limit:
                    self.limits.append((category, limit))

    def _section(self, section: str, line: int, value: Value) -> None:
        if value.kind not in ("map", "empty"):
            self.problem(line, f"{section} is a map from names to labels, not a {value.kind}", "write '/name: label'")
            return
        for name, at, label in value.entries:
            if is_non_ros(name):
                self.problem(at, f"name {shown(name)!r} is not absolute", "begin it with /")
            elif len(name) > self.bounds.name:
                self.problem(at, *self.bounds.refusal("name", len(name)))
            else:
                self._entry(section, name, Place(self.file, at), label)

    def _entry(self, section: str, name: str, place: Place, label: Value) -> None:
        where, rank = NODE if section == "nodes" else CHANNEL, (self.tier, specificity(name) + self.above)
        statements = self._statements(label, where, place, rank, naming(name))
        if self.tier == SHIPPED and is_log(name):
            kinds = without_text(self.vocabulary)
            statements = tuple(statement._replace(categories=kinds) for statement in statements if kinds)
        facts = self._facts(label, where)
        check_types(self, facts.get("types", ()), SECTIONS[section])
        processing = processing_at(place, label.entries, facts) if where == NODE else UNSTATED
        self.entries.append(_entry_of(SECTIONS[section], name, place, statements, rank, processing, facts))

    def _element(self, name: str, line: int, value: Value) -> None:
        """An element outside ROS: what is stated of it, and labels as of a node."""
        kind = self._kind_of(name, line, value)
        if not kind:
            return
        place, rank, of_kind = Place(self.file, line), (self.tier, EXACT + self.above), keywords_of(kind)
        outside: dict[str, Any] = {}
        for item in self.entries_of(value, ("kind", *of_kind, *keys_of(NODE))):
            keyword = of_kind.get(item[0])
            outside |= keyword.states(self, item) if keyword and keyword.states else {}
        label = value._replace(entries=tuple(item for item in value.entries if item[0] in keys_of(NODE)))
        statements = self._statements(label, NODE, place, rank)
        if kind == "device" and not any(key in moves_data(NODE) for key, *_ in label.entries):
            self.problem(line, f"device {shown(name)!r} does nothing", "say what comes from it: source: [Voice]")
        facts = self._facts(label, NODE)
        processing = processing_at(place, label.entries, facts)
        joins, bags = outside.pop("between", ()), outside.pop("bags", ())
        stated = with_transfer(self, value, NonRosFacts(place=place, **outside), processing.bases)
        self.elements.append(Stated(kind, name, stated, joins, bags))
        self.entries.append(_entry_of((kind,), name, place, statements, rank, processing, facts))

    def _kind_of(self, name: str, line: int, value: Value) -> str:
        """The kind of an element outside ROS; empty, and a problem, if it has no name or no kind."""
        unfit = ":" in name or len(name) > LONGEST_NAME or not name.isprintable() or name != name.strip()
        if unfit or not is_non_ros(name):
            hint = (
                f"a plain name of at most {LONGEST_NAME} characters, not beginning with / = * ? [, and without a colon"
            )
            self.problem(line, f"{shown(name)!r} cannot name an element outside ROS", hint)
            return ""
        kind = value.get("kind") if value.kind == "map" else None
        if kind is not None and kind.text in NON_ROS:
            return kind.text
        what = f"of kind {shown(kind.text)!r}" if kind else "has no kind"
        hint = f"write {{kind: …}}, one of {', '.join(NON_ROS)}"
        self.problem(kind.line if kind else line, f"element {shown(name)!r} {what}", hint)
        return ""

    def _facts(self, label: Value, where: str) -> dict[str, Any]:
        """What an entry states that moves no data, by field."""
        facts: dict[str, Any] = {}
        for item in label.entries:
            keyword = keywords_of(where).get(item[0])
            facts |= keyword.states(self, item) if keyword and keyword.states else {}
        return facts

    def _statements(
        self, label: Value, where: str, place: Place, rank: tuple[int, int], named_by: str = NAME
    ) -> tuple[Statement, ...]:
        """What an entry says that data does, with how it names, its reason, and its author, or the file's."""
        note = label.get("note")
        why = note.text.strip() if note and note.kind == "text" else ""
        author = self._author(label) or self.author
        statements = tuple(self._read(label, where, place, rank))
        named: set[str] = set()
        for statement in statements:
            if statement.role == TYPE_LINE and (where == FLOW or named_by != NAME or self.tier <= SHIPPED):
                of = "a flow" if where == FLOW else "a glob" if named_by != NAME else "a shipped file"
                hint = "write it of one channel by its full name, or write only: [Kinds]"
                self.problem(statement.place.line, f"only: by-type of {of}", hint)
            if statement.role in ("only", "never"):
                for name in sorted(named.intersection(statement.categories)):
                    what = f"{name} is under only and under never"
                    self.problem(statement.place.line, what, "name it under one of them")
                named.update(statement.categories)
        return tuple(s._replace(naming=named_by, why=s.why or why, author=author) for s in statements)

    def _author(self, label: Value) -> str:
        value = label.get("author")
        if value is None:
            return ""
        if value.kind != "text" or not value.text.strip() or len(value.text) > LONGEST_GROUP:
            what = f"author takes a name, not {shown(value.text) or f'a {value.kind}'!r}"
            self.problem(value.line, what, f"write who says it, in at most {LONGEST_GROUP} characters")
            return ""
        return value.text.strip()

    def _read(self, label: Value, where: str, place: Place, rank: tuple[int, int]) -> Iterator[Statement]:
        if label.kind == "empty":  # a line of --init that nobody has filled in yet
            return
        if label.kind == "text" and label.text in words_of(where):
            yield Statement(label.text, (), rank, place, shipped=self.tier <= SHIPPED)
            return
        if label.kind != "map":
            self.problem(place.line, f"label {shown(label.text or label.kind)!r} on a {where}", NO_LABEL[where])
            return
        for key, line, value in self.entries_of(label, (*(ENDS if where == FLOW else ()), *keys_of(where))):
            keyword = keywords_of(where).get(key)
            if keyword is None or keyword.says is None:
                continue
            blank = Statement(key, (), rank, Place(self.file, line))
            if key in NONE_OF and (value.text == NO_KIND or value.get(NO_KIND)):
                yield from self._takes_back(value, blank)
                value = value._replace(entries=tuple(item for item in value.entries if item[0] != NO_KIND))  # noqa: PLW2901
                if not value.entries:
                    continue
            statements = tuple(keyword.says(self, value, blank))
            others = [other for other, *_ in label.entries if other not in (key, "note", "author")]
            if keyword.alone and statements and others:
                self.problem(line, f"{key} beside {others[0]}", "a node that is not there does nothing: keep one")
            else:
                yield from statements

    def _takes_back(self, value: Value, blank: Statement) -> Iterator[Statement]:
        """What takes a source or a leak back: of all kinds, or of some."""
        back = blank._replace(role=NONE_OF[blank.role])
        if (kinds := value.get(NO_KIND)) is None:
            yield back
            return
        for name in self.categories_of(kinds, f"{blank.role}: none"):
            yield back._replace(categories=(name,))

    def _flow(self, item: Value) -> None:
        if item.kind != "map":
            self.problem(item.line, f"a flow is a map, not a {item.kind}", "write {from: /a, to: /b, never: [Video]}")
            return
        place = Place(self.file, item.line)
        ends = {key: self.end(value) for key, _, value in item.entries if key in ENDS}
        names = [end.name for end in ends.values()]
        rank = self.tier, sum(map(specificity, names)) + self.above
        named_by = GLOB if any(naming(name) != NAME for name in names) else NAME
        statements = self._statements(item, FLOW, place, rank, named_by)
        if len(ends) < len(ENDS):
            self.problem(item.line, "a flow needs from and to", "write {from: /a, to: /b, never: [Video]}")
            return
        stated = self.of_fleet or any(map(is_non_ros, names))  # others are in the policies
        if not stated and not (item.get("only") or item.get("never")):
            hint = "write {from: /a, to: /b, never: [Video]}; what policies do not know goes through an element"
            self.problem(item.line, "a flow between nodes and channels needs only or never", hint)
            return
        if statements or (stated and all(names)):
            source, target = ends["from"], ends["to"]
            self.flows.append(FlowEntry(source.name, target.name, place, statements, (source.kind, target.kind)))

    def _six_lists(self, top: Value) -> None:
        """The paper's JSON: six lists of names, one kind of data; there a sanitizer ends it (rule S8)."""
        name = self.kind_of_data(self.category, 0)
        for role, line, value in self.entries_of(top, SIX_LISTS):
            kinds = SECTIONS["channels" if role in ("sensitive", "mundane") else "nodes"]
            for item in self.list_of(value, role):
                element = self.absolute_name(item)
                place, rank = Place(self.file, item.line), (self.tier, specificity(element) + self.above)
                method = Method.ANONYMISE if role == "sanitizer" else None
                statement = Statement(role, (name,), rank, place, method, naming=naming(element))
                self.entries.append(Entry(kinds, element, place, (statement,)))
            if role == "sanitizer" and value.items:
                message = "a sanitizer of the paper's six lists ends the category; the method is not stated"
                self.diagnostics.append(Diagnostic(Place(self.file, line), Severity.NOTICE, message))


def _entry_of(
    kinds: tuple[str, ...], name: str, place: Place, statements: tuple[Statement, ...], rank: tuple[int, int],
    processing: Processing, facts: dict[str, Any],
) -> Entry:  # fmt: skip
    own = {key: value for key, value in facts.items() if key in Entry._fields}
    return Entry(kinds, name, place, statements, processing=processing, rank=rank, **own)


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
        for message_type in entry.types[:1]:
            reader.problem(
                message_type.place.line, f"types of {shown(entry.name)!r} in a file of standard channels", hint
            )
