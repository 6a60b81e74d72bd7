"""Entries said anew into the text of a label file: only the lines that they are about change (issue 22).

In: the text and what entries are to say. Out: the new text. Of YAML, ruamel.yaml changes the entries; what it would
write otherwise elsewhere stays as it was. A comment of a line that goes stands above the entry then. Of JSON, which has
no comments, the values are written anew with the indent of the file.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, Any, NamedTuple

import yaml
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.labels.edited_entries import same_name
from rosprivacy.ingest.labels.label_writer import NewLine, add_line
from rosprivacy.ingest.labels.pins import PINS
from rosprivacy.ingest.reading.kept_yaml import FAILURES, changed, comments

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.labels.edited_entries import Said

_PLAIN = re.compile(r"[A-Za-z/=][\w/.~-]*")
_RESOLVER: Any = yaml.resolver.Resolver()


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


def with_entries(file: str, text: str, said: Sequence[Said]) -> NewText:
    """Return the text of a label file in which some entries say something else.

    Whether it means what it should is for the caller to check, who knows what it should mean.

    Parameters
    ----------
    file
        For messages.
    said
        Of one name and section at most one; that of ``PINS`` is the whole section.

    Raises
    ------
    LabelError
        If it cannot be changed.
    """
    if not said:
        return NewText(text, 0)
    try:
        if text.lstrip().startswith("{") and (value := _json(text)) is not None:
            return _told(text, _as_json(text, value, said), ())
        return _as_yaml(file, text, said)
    except FAILURES as error:
        problem = f"cannot be changed: {shown((str(error).splitlines() or [''])[0])}"
        raise LabelError(file, 0, problem, "write the labels by hand") from None


def _told(old: str, new: str, remarks: tuple[str, ...]) -> NewText:
    lines = old.splitlines(), new.splitlines()
    steps = SequenceMatcher(None, *lines, autojunk=False).get_opcodes()
    return NewText(new, sum(max(b - a, d - c) for what, a, b, c, d in steps if what != "equal"), remarks)


def _as_yaml(file: str, text: str, said: Sequence[Said]) -> NewText:
    def change(top: Any) -> None:
        for one in said:
            _put(top, one)

    written = changed(text, change)
    new = _only_these(text, changed(text, lambda _: None), written)
    remarks = () if new is not None else (f"{file}: other lines are written in another form, and say what they said",)
    new = written if new is None else new
    lost = Counter(comments(text)) - Counter(comments(new))
    if lost:
        new = _above(new, list(lost.elements()), said)
        what = f"{counted(lost.total(), 'comment')} of lines that are gone stand above the entry"
        remarks = (*remarks, f"{file}: {what}")
    return _told(text, new, remarks)


def _only_these(text: str, same: str, new: str) -> str | None:
    """The old text with what differs between two texts of ruamel.yaml; None if lines of it are not those of one."""
    if same == text:
        return new
    before, after, old = same.splitlines(True), new.splitlines(True), text.splitlines(True)
    if len(before) != len(old):
        return None
    if old and not old[-1].endswith("\n"):
        old[-1] += "\n"
    merged: list[str] = []
    for what, a, b, c, d in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        merged += old[a:b] if what == "equal" else after[c:d]
    return "".join(merged)


def _above(text: str, lost: Sequence[str], said: Sequence[Said]) -> str:
    """Put comments above the first line that names one of the entries; at the end if there is none."""
    lines = text.splitlines(True)
    end = "\r\n" if "\r\n" in text else "\n"
    names = [one.name for one in said]
    at = next((i for i, line in enumerate(lines) if any(_names(line, name) for name in names)), len(lines))
    first = lines[at] if at < len(lines) else ""
    indent = first[: len(first) - len(first.lstrip())]
    return "".join([*lines[:at], *(f"{indent}{one.strip()}{end}" for one in lost), *lines[at:]])


def _names(line: str, name: str) -> bool:
    return line.lstrip().lstrip("'\"").startswith((f"{name}:", f"{name}'", f'{name}"'))


def _put(top: Any, said: Said) -> None:
    if said.section == PINS:
        _put_pins(top, said.value)
        return
    section, key = _place(top, said)
    if said.value is None:
        if key is None:
            return
        if said.section == "elements":
            del section[key]
        else:
            section[key] = None
    elif key is None:
        add_line(top, NewLine(said.section, said.name, "", on_one_line(said.value)))
    elif isinstance(section[key], CommentedMap) and isinstance(said.value, dict) and not _in_flow(section[key]):
        _change(section[key], said.value)
    else:
        section[key] = on_one_line(said.value)


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


def _change(there: Any, value: dict[str, Any]) -> None:
    """Say an entry of several lines anew: lines that say the same stay."""
    for key in [key for key in there if key not in value]:
        del there[key]
    for key, one in value.items():
        if key not in there or there[key] != one:
            there[key] = on_one_line(one)


def _place(top: Any, said: Said) -> tuple[Any, Any]:
    """The section of an entry, and its key there; None where there is no such entry."""
    section = top.get(said.section)
    return section, next((key for key in section or () if same_name(str(key), said.name)), None)


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


def _as_json(text: str, top: Any, said: Sequence[Said]) -> str:
    for one in said:
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
