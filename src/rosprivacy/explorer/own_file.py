"""The label file that a session edits: its text as it was read, what it says, and what it means.

In: a path, or labels from memory. Out: ``OwnFile``, and what it means with edits, without a look at the disk.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, LabelError
from rosprivacy.ingest.labels.edited_entries import Written, edited, entries_of
from rosprivacy.ingest.labels.label_file import OURS, Labels, parse_labels, read_labels
from rosprivacy.ingest.labels.label_reader import SIX_LISTS
from rosprivacy.ingest.labels.label_writer import NEW
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_utf8

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.explorer.edits import Edit
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings

MEMORY = "labels of this session"


@dataclass(frozen=True, slots=True)
class OwnFile:
    """A label file as it was read.

    Attributes
    ----------
    file
        As it was named; empty for labels that have no file yet.
    text
        None for labels from memory, of which there is no text.
    digest
        SHA-256 of its bytes; empty where there is no file yet.
    says
        (section, name) -> what the entry says.
    """

    file: str
    text: str | None
    digest: str
    labels: Labels
    says: Mapping[tuple[str, str], Any]
    how: Written

    @property
    def name(self) -> str:
        """By which messages call it."""
        return self.file or self.labels.file

    def with_edits(self, edits: Sequence[Edit]) -> Labels:
        """Return what the file would mean after edits, the last of each entry.

        Raises
        ------
        InputErrors
            With every problem of what they say.
        """
        last = {(edit.section, edit.name): edit for edit in edits}
        there = {key: edit for key, edit in last.items() if edit.value != self.says.get(key)}
        return edited(self.labels, [edit.said for edit in there.values()], self.how)


def chosen(labels: Sequence[str | Labels]) -> int | None:
    """Return which of the label files a session edits: the first of a person's that has entries; None if there is none.

    The paper's six lists have none, and cannot say what an edit can.
    """
    for at, file in enumerate(labels):
        if isinstance(file, Labels):
            if not file.shipped:
                return at
        elif not file.startswith(OURS) and not (Path(file).is_file() and _has_six_lists(file)):
            return at
    return None


def _has_six_lists(file: str) -> bool:
    text, _ = read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))
    top = yaml_values.parse(text, partial(LabelError, file))
    return top.kind == "map" and top.get("labels") is None and any(top.get(key) for key in SIX_LISTS)


def read_own(file: str | Labels | None, vocabulary: Vocabulary, settings: Settings) -> OwnFile:
    """Read the label file that is edited; one that is not there is begun, in memory.

    Raises
    ------
    InputErrors
        With every problem of the file.
    """
    name = file if isinstance(file, str) else ""
    how = Written(name or MEMORY, vocabulary, settings.bounds, root=settings.include_root or "")
    if isinstance(file, Labels):
        lines = max((entry.place.line for entry in file.entries), default=0)
        return OwnFile("", None, "", file, {}, how._replace(file=file.file, lines=lines))
    if file is None or not Path(file).exists():
        labels = parse_labels(NEW, vocabulary, name=how.file, bounds=settings.bounds)
        return OwnFile(name, NEW, "", labels, {}, how._replace(lines=1))
    try:
        text, data = read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))
    except LabelError as error:
        raise InputErrors([error]) from None
    labels = read_labels(
        file, vocabulary, category=settings.category, bounds=settings.bounds, include_root=settings.include_root
    )
    digest = hashlib.sha256(data).hexdigest()
    if digest != labels.sha256:
        raise InputErrors([LabelError(file, 0, "was changed while it was read", "run the command again")])
    top = yaml_values.parse(text, partial(LabelError, file), settings.bounds)
    author = top.get("author")
    how = how._replace(author=author.text.strip() if author else "", lines=len(text.splitlines()))
    return OwnFile(file, text, digest, labels, entries_of(top), how)
