"""The edits of a session into the label file: only the lines that they are about, and only over what was read.

In: the file as it was read, with edits. Out: ``Saved``, or ``Conflict`` where somebody else changed the file meanwhile.
"""

from __future__ import annotations

import hashlib
from difflib import unified_diff
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import with_entries, without_places
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.report.atomic import write_texts
from rosprivacy.report.editing import editing

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.explorer.edits import Edit
    from rosprivacy.explorer.own_file import OwnFile
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.labels.label_writer import NewText


class Saved(NamedTuple):
    """What was written.

    Attributes
    ----------
    lines
        How many lines of the file are other ones than when it was read.
    digest
        SHA-256 of the file now.
    remarks
        What to tell a person.
    """

    file: str
    lines: int
    digest: str
    remarks: tuple[str, ...] = ()


class Conflict(NamedTuple):
    """Nothing was written, since the file is not what was read.

    Attributes
    ----------
    diff
        From what was read or last saved to what stands there now, as a unified diff.
    """

    file: str
    diff: str


def new_text(own: OwnFile, edits: Sequence[Edit]) -> NewText:
    """Return the text of the label file with edits; it means what the session says that it means.

    Raises
    ------
    InputError
        If there is no text, or it cannot be changed so.
    """
    if own.text is None:
        what = "are labels from memory, without a text"
        raise InputError(own.name, 0, what, "name a label file when the session begins")
    last = {(edit.section, edit.name): edit.said for edit in edits}
    said = [one for key, one in last.items() if one.value != own.says.get(key)]
    new = with_entries(own.name, own.text, said)
    try:
        means = parse_labels(new.text, own.how.vocabulary, name=own.how.file, bounds=own.how.bounds)
    except InputErrors as error:
        raise _by_hand(own, f"cannot be changed: {error.errors[0].problem}") from None
    if _facts(means) != _facts(own.with_edits(edits)):
        raise _by_hand(own, "cannot be changed without changing another entry")
    return new


def _by_hand(own: OwnFile, problem: str) -> LabelError:
    return LabelError(own.name, 0, problem, "write the labels by hand")


def _facts(labels: Labels) -> object:
    """What labels say, wherever it stands: the order of entries says nothing."""
    parts = (labels.entries, labels.elements, labels.flows, labels.limits)
    lists = [sorted(map(repr, map(without_places, part))) for part in parts]
    return lists, without_places(labels.surroundings), without_places(labels.processing)


def on_disk(file: str) -> bytes | None:
    """Return what a label file holds now; None if there is none.

    Raises
    ------
    LabelError
        If it cannot be read.
    """
    return read_regular(file, yaml_values.MAX_BYTES, partial(LabelError, file)) if Path(file).exists() else None


def digest_of(data: bytes | None) -> str:
    """Return the SHA-256 of what a file holds; empty where there is none."""
    return "" if data is None else hashlib.sha256(data).hexdigest()


def save(own: OwnFile, edits: Sequence[Edit], last: tuple[str, str]) -> Saved | Conflict:
    """Write the label file, if it is still what this session read or wrote.

    Parameters
    ----------
    last
        Digest and text of the file as this session knows it.

    Raises
    ------
    InputError
        If it cannot be written; then it is as it was.
    """
    if not own.file:
        raise InputError(own.name, 0, "have no file to be saved in", "name one: save_as('labels.yaml')")
    new = new_text(own, edits)
    file = Path(own.file)
    with one_run(), editing(file):  # each save reads what it replaces
        there = on_disk(own.file)
        if digest_of(there) != last[0]:
            return Conflict(own.file, difference(own.file, last[1], there))
        data = _bytes(own, new.text)
        if data != there:
            write_texts([(file, data)], edited=file)
    return Saved(own.file, new.lines, digest_of(data), new.remarks)


def save_as(own: OwnFile, edits: Sequence[Edit], file: str) -> Saved:
    """Write the label file with the edits under another name, where there is none yet.

    Raises
    ------
    InputError
        If it cannot be written, or there is a file of that name.
    """
    new = new_text(own, edits)
    with one_run(), editing(Path(file)):
        if Path(file).exists():
            raise InputError(file, 0, "is there already", "a label file is work: name another, or remove it")
        data = new.text.encode()
        write_texts([(Path(file), data)], edited=Path(file))
    return Saved(file, new.lines, digest_of(data), new.remarks)


def _bytes(own: OwnFile, text: str) -> bytes:
    """The text as the file has it: a mark at its beginning stays."""
    marked = own.digest and own.text is not None and digest_of(own.text.encode()) != own.digest
    return text.encode("utf-8-sig" if marked else "utf-8")


def difference(file: str, before: str, now: bytes | None) -> str:
    """Return what somebody else changed, as a unified diff."""
    text = "" if now is None else now.decode("utf-8-sig", "replace")
    name = shown(file)
    lines = unified_diff(
        before.splitlines(True), text.splitlines(True), f"{name} as it was read", f"{name} as it is now"
    )
    return "".join(line if line.endswith("\n") else f"{line}\n" for line in lines)
