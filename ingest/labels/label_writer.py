"""New lines into the text of a label file: what people wrote there, comments and order included, stays.

In: the text and lines. Out: the new text. What comes out is read anew, and given out only if every entry and every
comment that was there is still there, and nothing but the lines has come.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any

from ruamel.yaml.comments import CommentedMap
from ruamel.yaml.scalarstring import DoubleQuotedScalarString
from ruamel.yaml.tokens import CommentToken

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import Place
from rosprivacy.analysis.text import blanked
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_reader import SECTIONS
from rosprivacy.ingest.reading.kept_yaml import FAILURES, changed, keeps_comments

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ontology.vocabulary import Vocabulary

NEW = "labels: 1\n"
_NOWHERE = Place("", 0)


@dataclass(frozen=True, slots=True)
class NewLine:
    """A line for a section: the name as it is written there, what is said of it, and a remark for people."""

    section: str
    name: str
    remark: str = ""
    said: Any = None


def with_lines(file: str, text: str, lines: Sequence[NewLine], vocabulary: Vocabulary) -> str:
    """Return the text of a label file with lines added at the end of their sections.

    Parameters
    ----------
    file
        For messages.

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
    section[name] = line.said
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
