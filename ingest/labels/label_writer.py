"""New lines, and entries said anew, into the text of a label file: what people wrote elsewhere in it stays.

In: the text, and lines or entries. Out: the new text. Of YAML, ruamel.yaml changes what has to change; what it would
write otherwise elsewhere stays as it was. Of JSON, which has no comments, the values are written anew with the indent
of the file. A text with new lines is read anew, and given out only if every entry and every comment is still there.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import dataclass, fields, is_dataclass, replace
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Any, NamedTuple

import yaml
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.scalarstring import DoubleQuotedScalarString
from ruamel.yaml.tokens import CommentToken

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import Place
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.ingest.labels.edited_entries import same_name
from rosprivacy.ingest.labels.entries import SECTIONS
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.pins import PINS
from rosprivacy.ingest.reading.kept_yaml import FAILURES, changed, comments, keeps_comments

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.ingest.labels.edited_entries import SaidOfElement
    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ontology.vocabulary import Vocabulary

NEW = "labels: 1\n"
_NOWHERE = Place("", 0)
_PLAIN = re.compile(r"[A-Za-z/=][\w/.~-]*")
_RESOLVER: Any = yaml.resolver.Resolver()


@dataclass(frozen=True, slots=True)
class NewLine:
    """A line for a section: the name as it is written there, what is said of it, and a remark for people."""

    section: str
    name: str
    remark: str = ""
    value: Any = None


def with_lines(file: str, text: str, lines: Sequence[NewLine], vocabulary: Vocabulary) -> str:
    """Return the text of a label file with lines added at the end of their sections.


    Raises
    ------
    InputErrors
        If the file is not a label file.
    LabelError
        If it cannot be written without losing something.
    """
    before = parse_labels(text, vocabulary, name=file).entries

    def change(top: Any) -> None:
        for line in lines:
            add_line(top, line)

    try:
        new = changed(text, change)
        after = parse_labels(new, vocabulary, name=file).entries
    except FAILURES as error:
        raise _by_hand(file, f"cannot be changed: {shown(str(error).splitlines()[0])}") from None
    wanted = Counter((*facts_of(before), *((SECTIONS[line.section], line.name) for line in lines)))
    found = Counter([*(f for f in facts_of(after) if f in wanted), *_names(after, lines)])
    if len(after) != len(before) + len(lines) or wanted - found:
        raise _by_hand(file, "cannot be changed without changing another entry")
    if not keeps_comments(text, new):
        raise _by_hand(file, "cannot be changed without losing a comment")
    return new


def _by_hand(file: str, problem: str) -> LabelError:
    return LabelError(file, 0, problem, "add the lines by hand")


def facts_of(entries: Iterable[Entry]) -> list[Any]:
    """Return entries as they are wherever they stand: two files that say the same have the same."""
    return [without_places(entry) for entry in entries]


def without_places(fact: Any) -> Any:
    """Return a fact with all that is in it, without the lines of the file."""
    if isinstance(fact, Place):
        return _NOWHERE
    if isinstance(fact, tuple):
        parts = map(without_places, fact)
        return fact._make(parts) if hasattr(fact, "_make") else tuple(parts)
    if is_dataclass(fact) and not isinstance(fact, type):
        return replace(fact, **{part.name: without_places(getattr(fact, part.name)) for part in fields(fact)})
    return fact


def _names(entries: Iterable[Entry], lines: Iterable[NewLine]) -> list[Any]:
    added = {(SECTIONS[line.section], line.name) for line in lines}
    return [(entry.kinds, entry.name) for entry in entries if (entry.kinds, entry.name) in added]


def add_line(top: Any, line: NewLine) -> None:
    """Add a line at the end of its section, in what ruamel.yaml has read."""
    section = top.get(line.section)
    if section is None:
        rest = top.ca.items.pop(line.section, None)  # comments after an empty section go with the key
        top[line.section] = section = CommentedMap()
        if rest is not None:
            top.ca.items[line.section] = rest
    name = line.name if line.name.startswith("/") else DoubleQuotedScalarString(line.name)
    last = next(reversed(section), None)
    section[name] = line.value
    if section.fa.flow_style() or top.fa.flow_style():
        return
    if line.remark:
        section.yaml_add_eol_comment(blanked(line.remark, "?"), name, column=0)
    _move_what_follows(section, last, name)


def _move_what_follows(section: Any, last: Any, name: str) -> None:
    """Blank lines and comments before the next section stand after the last line of this one."""
    before = section
    while last is not None and isinstance(before[last], CommentedMap) and not before[last].fa.flow_style():
        before = before[last]
        last = next(reversed(before), None)
    tokens = before.ca.items.get(last)
    token = tokens[2] if tokens and len(tokens) > 2 else None  # noqa: PLR2004 - where ruamel.yaml keeps it
    if token is None or "\n" not in token.value:
        return
    here, _, after = token.value.partition("\n")
    if not after:
        return
    token.value = f"{here}\n"
    mine = section.ca.items.setdefault(name, [None, None, None, None])
    if mine[2] is None:
        mine[2] = CommentToken("\n" + after, token.start_mark, None)
    else:
        mine[2].value = mine[2].value.rstrip("\n") + "\n" + after


class NewText(NamedTuple):
    """The text of a label file after a change.

    Attributes
    ----------
    lines
        How many lines are other ones than before.
    remarks
        What to tell a person.
    """

    text: str
    lines: int
    remarks: tuple[str, ...] = ()


def with_entries(file: str, text: str, entries: Sequence[SaidOfElement]) -> NewText:
    """Return the text of a label file in which some entries say something else.

    Whether it means what it should is for the caller to check, who knows what it should mean.

    Parameters
    ----------
    entries
        Of one name and section at most one; that of ``PINS`` is the whole section.

    Raises
    ------
    LabelError
        If it cannot be changed.
    """
    if not entries:
        return NewText(text, 0)
    try:
        if text.lstrip().startswith("{") and (value := _json(text)) is not None:
            return _comment(text, _as_json(text, value, entries), ())
        return _as_yaml(file, text, entries)
    except FAILURES as error:
        problem = f"cannot be changed: {shown((str(error).splitlines() or [''])[0])}"
        raise LabelError(file, 0, problem, "write the labels by hand") from None


def _comment(old: str, new: str, remarks: tuple[str, ...]) -> NewText:
    lines = old.splitlines(), new.splitlines()
    steps = SequenceMatcher(None, *lines, autojunk=False).get_opcodes()
    return NewText(new, sum(max(b - a, d - c) for what, a, b, c, d in steps if what != "equal"), remarks)


def _as_yaml(file: str, text: str, entries: Sequence[SaidOfElement]) -> NewText:
    def change(top: Any) -> None:
        for one in entries:
            _with_entry(top, one)

    written = changed(text, change)
    new = _only_these(text, changed(text, lambda _: None), written)
    remarks = () if new is not None else (f"{file}: other lines are written in another form, and say what they said",)
    new = written if new is None else new
    lost = Counter(comments(text)) - Counter(comments(new))
    if lost:
        new = _above(new, list(lost.elements()), entries)
        what = f"{counted(lost.total(), 'comment')} of lines that are gone stand above the entry"
        remarks = (*remarks, f"{file}: {what}")
    return _comment(text, new, remarks)


def _only_these(text: str, unchanged: str, new: str) -> str | None:
    """The old text with what differs between two texts of ruamel.yaml; None if lines of it are not those of one."""
    if unchanged == text:
        return new
    before, after, old = unchanged.splitlines(True), new.splitlines(True), text.splitlines(True)
    if len(before) != len(old):
        return None
    if old and not old[-1].endswith("\n"):
        old[-1] += "\n"
    merged: list[str] = []
    for what, a, b, c, d in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        merged += old[a:b] if what == "equal" else after[c:d]
    return "".join(merged)


def _above(text: str, lost: Sequence[str], entries: Sequence[SaidOfElement]) -> str:
    """Put comments above the first line that names one of the entries; at the end if there is none."""
    lines = text.splitlines(True)
    end = "\r\n" if "\r\n" in text else "\n"
    names = [one.name for one in entries]
    at = next((i for i, line in enumerate(lines) if any(_is_of(line, name) for name in names)), len(lines))
    first = lines[at] if at < len(lines) else ""
    indent = first[: len(first) - len(first.lstrip())]
    return "".join([*lines[:at], *(f"{indent}{one.strip()}{end}" for one in lost), *lines[at:]])


def _is_of(line: str, name: str) -> bool:
    return line.lstrip().lstrip("'\"").startswith((f"{name}:", f"{name}'", f'{name}"'))


def _with_entry(top: Any, entry: SaidOfElement) -> None:
    if entry.section == PINS:
        _put_pins(top, entry.value)
        return
    section, key = _place(top, entry)
    if entry.value is None:
        if key is None:
            return
        if entry.section == "elements":
            del section[key]
        else:
            section[key] = None
    elif key is None:
        add_line(top, NewLine(entry.section, entry.name, "", on_one_line(entry.value)))
    elif isinstance(section[key], CommentedMap) and isinstance(entry.value, dict) and not _in_flow(section[key]):
        _change(section[key], entry.value)
    else:
        section[key] = on_one_line(entry.value)


def _put_pins(top: Any, value: dict[str, Any] | None) -> None:
    """The section that ``labels --pin`` writes, whole: a line for each element and flow."""
    if value is None:
        top.pop(PINS, None)
        return
    top[PINS] = section = CommentedMap()
    for key, some in value.items():
        if isinstance(some, list):
            section[key] = CommentedSeq(map(on_one_line, some))
        else:
            section[key] = CommentedMap((on_one_line(name), on_one_line(kinds)) for name, kinds in some.items())


def _in_flow(value: Any) -> bool:
    return bool(value.fa.flow_style())


def _change(present: Any, value: dict[str, Any]) -> None:
    """Say an entry of several lines anew: lines that say the same stay."""
    for key in [key for key in present if key not in value]:
        del present[key]
    for key, one in value.items():
        if key not in present or present[key] != one:
            present[key] = on_one_line(one)


def _place(top: Any, entry: SaidOfElement) -> tuple[Any, Any]:
    """The section of an entry, and its key there; None where there is no such entry."""
    section = top.get(entry.section)
    return section, next((key for key in section or () if same_name(str(key), entry.name)), None)


def on_one_line(value: Any) -> Any:
    """Return a value as ruamel.yaml writes it on one line; text that other readers take for more is in quotes."""
    if isinstance(value, dict):
        made = CommentedMap((key, on_one_line(one)) for key, one in value.items())
        made.fa.set_flow_style()
        return made
    if isinstance(value, list | tuple):
        items = CommentedSeq(map(on_one_line, value))
        items.fa.set_flow_style()
        return items
    if isinstance(value, str) and not (_PLAIN.fullmatch(value) and _is_text(value)):
        return DoubleQuotedScalarString(value)
    return value


def _is_text(value: str) -> bool:
    return bool(_RESOLVER.resolve(yaml.ScalarNode, value, (True, False)) == "tag:yaml.org,2002:str")


def _json(text: str) -> Any:
    try:
        return json.loads(text)
    except ValueError:
        return None


def _as_json(text: str, top: Any, entries: Sequence[SaidOfElement]) -> str:
    for one in entries:
        if one.section == PINS:
            top.pop(PINS, None)
            top |= {} if one.value is None else {PINS: one.value}
            continue
        section, key = _place(top, one)
        if one.value is not None:
            if not section:
                top[one.section] = section = {}
            section[key or one.name] = one.value
        elif key is not None and one.section == "elements":
            del section[key]
        elif key is not None:
            section[key] = None
    new = _dumped(text, top)
    return _only_these(text, _dumped(text, json.loads(text)), new) or new


def _dumped(text: str, value: Any) -> str:
    """JSON with the indent of a text."""
    found = re.search(r"\n([ \t]+)\S", text)
    written = json.dumps(value, ensure_ascii=False, indent=found[1] if found else None)
    return written + ("\n" if text.endswith("\n") else "")
