"""Entries of label files said anew, in memory: what the files would mean if somebody wrote them so (rule S7).

In: label files as they were read, and what some entries are to say. Out: the same labels with these entries in the
place of those of the same name; their name and hash say that they are not what stands on the disk (rule S12). Nothing
is read from there.
"""

from __future__ import annotations

import hashlib
import json
from collections import defaultdict
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import NON_ROS
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import bare_name, is_glob
from rosprivacy.ingest.labels.entries import OWN, ROBOT, SECTIONS
from rosprivacy.ingest.labels.label_file import LabelErrors, Labels, parse_labels
from rosprivacy.ingest.labels.label_reader import LabelReader
from rosprivacy.ingest.reading.yaml_values import Value

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.labels.entries import Entry, Stated
    from rosprivacy.ontology.vocabulary import Vocabulary

KINDS = {**SECTIONS, "elements": NON_ROS}
Spot = tuple[str | tuple[str, ...], bool, str]
_WORDS = {"yes": "true", "on": "true", "no": "false", "off": "false"} | {word: word for word in ("true", "false")}


class SaidOfElement(NamedTuple):
    """What an entry of a label file says.

    Attributes
    ----------
    section
        One of ``KINDS``.
    name
        As the file writes it: a glob stands for the entry of that glob.
    value
        As in a label file; None for nothing: of an element outside ROS the entry is taken away, of others an entry that
        is there stays without a word, as ``labels --init`` writes it.
    """

    section: str
    name: str
    value: Any


class WrittenEntries(NamedTuple):
    """How a label file is read.

    Attributes
    ----------
    lines
        How many lines it has.
    author
        Who wrote the file, as its top says.
    root
        Folder that the bags which it names may not leave; empty for its own.
    own
        It is about one robot of a fleet, and outranks what its model's files say.
    """

    file: str
    vocabulary: Vocabulary
    bounds: Bounds
    lines: int = 0
    author: str = ""
    root: str = ""
    own: bool = False


def same_name(first: str, second: str) -> bool:
    """Return whether two names of entries mean the same.

    >>> same_name("/a", "=/a"), same_name("/*", "=/*")
    (True, False)
    """
    return first == second or (not is_glob(first) and not is_glob(second) and bare_name(first) == bare_name(second))


def edited(labels: Labels, edits: Sequence[SaidOfElement], how: WrittenEntries) -> Labels:
    """Return labels with entries said anew, each at the line of the one that it replaces, new ones below the last line.

    The file's name and hash say that it is not what stands on the disk (rule S12).

    Parameters
    ----------
    edits
        Of one name and section at most one.

    Raises
    ------
    LabelErrors
        With every problem of the new entries, and what could be read of them.
    """
    if not edits:
        return labels
    entries: dict[int, Sequence[Entry]] = {at: (entry,) for at, entry in enumerate(labels.entries)}
    elements = list(labels.elements)
    places: dict[Spot, list[int]] = defaultdict(list)
    for at, entry in enumerate(labels.entries):
        places[_spot(entry.kinds, entry.name)].append(at)
    problems: list[LabelError] = []
    diagnostics = list(labels.diagnostics)
    below = how.lines + 1
    for one in edits:
        spot = places[_spot(KINDS[one.section], one.name)]
        there = [at for at in spot if entries[at]]
        if one.value is None and not there:
            continue
        line = entries[there[0]][0].place.line if there else below
        below += not there
        reader = read_entry(one, line, how)
        problems += (LabelError(e.file, e.line, e.problem, e.hint) for e in reader.problems)
        gone = {entry.place for at in there for entry in entries[at]}
        diagnostics = [told for told in diagnostics if told.place not in gone]
        diagnostics += reader.diagnostics
        entries |= dict.fromkeys(there, ())
        if not there:
            spot.append(len(entries))
        entries[there[0] if there else len(entries)] = reader.entries
        elements = _elements(elements, one, reader.elements)
    read = tuple(entry for some in entries.values() for entry in some)
    if problems:
        raise LabelErrors(problems, (replace(labels, entries=read, elements=tuple(elements)),))
    digest = hashlib.sha256(json.dumps([labels.sha256, edits], sort_keys=True, default=str).encode()).hexdigest()
    return replace(
        labels,
        file=f"{labels.file} with {counted(len(edits), 'edit')} that {'is' if len(edits) == 1 else 'are'} not saved",
        sha256=digest,
        entries=read,
        elements=tuple(elements),
        diagnostics=tuple(diagnostics),
    )


def _spot(kinds: tuple[str, ...], name: str) -> Spot:
    """Two entries of one spot speak of the same: as ``same_name``, in one section."""
    outside = kinds[0] in NON_ROS
    return "elements" if outside else kinds, is_glob(name), name if is_glob(name) else bare_name(name)


def _elements(elements: Iterable[Stated], entry: SaidOfElement, new: Iterable[Stated]) -> list[Stated]:
    if entry.section != "elements":
        return list(elements)
    return [*(one for one in elements if one.name != entry.name), *new]


def read_entry(entry: SaidOfElement, line: int, how: WrittenEntries) -> LabelReader:
    """Read one entry as if it stood in a file; the reader has every problem of it."""
    reader = LabelReader(how.file, how.vocabulary, "", OWN, ROBOT if how.own else 0, bounds=how.bounds, root=how.root)
    if entry.value is None and entry.section == "elements":
        return reader
    content = Value(line, "map", entries=((entry.name, line, value_of(entry.value, line)),))
    top = [("labels", line, Value(line, "number", "1")), (entry.section, line, content)]
    if how.author:
        top.insert(1, ("author", line, Value(line, "text", how.author)))
    reader.document(Value(line, "map", entries=tuple(top)))
    return reader


def value_of(value: Any, line: int) -> Value:
    """Return what Python says as if it was read from a line of a file.

    >>> value_of({"source": ["Video"]}, 3).get("source").items[0].text
    'Video'
    """
    if value is None:
        return Value(line, "empty")
    if isinstance(value, dict):
        return Value(line, "map", entries=tuple((str(key), line, value_of(one, line)) for key, one in value.items()))
    if isinstance(value, list | tuple):
        return Value(line, "list", items=tuple(value_of(one, line) for one in value))
    if isinstance(value, str):
        return Value(line, "text", value)
    return Value(line, "number", json.dumps(value, default=str))


def plain(value: Value) -> Any:
    """Return what was read as Python says it: the reverse of ``value_of``.

    >>> plain(value_of({"source": ["Video"], "encrypted": True}, 3))
    {'source': ['Video'], 'encrypted': True}
    """
    if value.kind == "map":
        return {key: plain(one) for key, _, one in value.entries}
    if value.kind == "list":
        return [plain(one) for one in value.items]
    if value.kind == "number":
        with suppress(ValueError):
            return json.loads(_WORDS.get(value.text.lower(), value.text))
    return None if value.kind == "empty" else value.text


def entries_of(top: Value) -> Mapping[tuple[str, str], Any]:
    """Return what the entries of a label file say, by section and name."""
    return {
        (section, name): plain(value)
        for section, _, content in top.entries
        if section in KINDS and content.kind == "map"
        for name, _, value in content.entries
    }


def with_entry(
    files: Iterable[Labels], section: str, name: str, content: object, vocabulary: Vocabulary
) -> tuple[Labels, ...]:
    """Return label files with one entry in place of all that they say of a name; shipped files stay.

    Parameters
    ----------
    section
        One of ``KINDS``.
    name
        As the files write it: a glob stands for the entry of that glob.
    content
        The entry as in a label file; None to say nothing of it.

    Raises
    ------
    InputErrors
        If the section or the entry is wrong, or a file says the same of more kinds of elements than the section has.
    """
    if section not in KINDS:
        raise InputErrors(
            [LabelError("labels", 0, f"unknown section {shown(section)!r}", f"one of {', '.join(KINDS)}")]
        )
    entry = parse_labels({"labels": 1, section: {name: content}}, vocabulary, name=f"{section} {name}")
    return (*(file if file.shipped else _without(file, section, name) for file in files), entry)


def _without(labels: Labels, section: str, name: str) -> Labels:
    """The labels without the entries of a section for a name."""
    kinds = set(KINDS[section])
    gone = [entry for entry in labels.entries if entry.name == name and kinds.intersection(entry.kinds)]
    for entry in gone:
        if not kinds.issuperset(entry.kinds):
            what = f"{shown(name)!r} is labelled for more than {section}"
            raise InputErrors([LabelError(entry.place.file, entry.place.line, what, "replace it under channels")])
    if not gone:
        return labels
    file = f"{labels.file} without {section} {name}"
    return replace(
        labels,
        file=file,
        sha256=hashlib.sha256(f"{labels.sha256} {file}".encode("utf-8", "surrogatepass")).hexdigest(),
        entries=tuple(entry for entry in labels.entries if entry not in gone),
        elements=tuple(one for one in labels.elements if one.name != name or one.kind not in kinds),
    )
