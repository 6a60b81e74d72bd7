"""A label file that a session edits: its text, what it says and means with edits, and the file written.

In: a path, or labels from memory; edits. Out: ``Labels`` without a look at the disk; ``SavedFile``, with only those
lines changed that edits are about, or ``Conflict`` where somebody else changed the file meanwhile.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from difflib import unified_diff
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, LabelError, shown
from rosprivacy.analysis.files_read import one_run
from rosprivacy.explorer.edits import Edit, differences
from rosprivacy.ingest.labels.edited_entries import WrittenEntries, edited, entries_of
from rosprivacy.ingest.labels.label_file import OURS, Labels, parse_labels, read_labels
from rosprivacy.ingest.labels.label_reader import SIX_LISTS
from rosprivacy.ingest.labels.label_writer import NEW, with_entries, without_places
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_regular, read_utf8
from rosprivacy.ingest.reading.path_kinds import exists, is_file
from rosprivacy.report.atomic import editing, write_texts

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from rosprivacy.explorer.edits import Entries
    from rosprivacy.ingest.labels.label_writer import NewText
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings

    Key = tuple[str, bool]  # name of the file, and whether a robot of a fleet reads it as its own

MEMORY = "labels of this session"


class SavedFile(NamedTuple):
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
    """Nothing was written, since the file is not what was read; ``diff`` is from that to what stands there now."""

    file: str
    diff: str


@dataclass(frozen=True, slots=True)
class FileText:
    """A label file as it was read.

    Attributes
    ----------
    file
        As it was named; empty for labels that have no file yet.
    text
        None for labels from memory, of which there is no text.
    digest
        SHA-256 of its bytes; empty where there is no file yet.
    """

    file: str
    text: str | None
    digest: str
    labels: Labels
    says: Entries
    how: WrittenEntries

    @property
    def name(self) -> str:
        """By which messages call it."""
        return self.file or self.labels.file

    def with_edits(self, edits: Sequence[Edit]) -> Labels:
        """Return what the file would mean after edits, the last of each entry; or raise ``InputErrors``."""
        return edited(self.labels, self.new_entries(edits), self.how)

    def new_entries(self, edits: Sequence[Edit]) -> list[Any]:
        """Return the last word on each entry that edits change."""
        last = {(edit.section, edit.name): edit for edit in edits}
        return [edit.statement for place, edit in last.items() if edit.value != self.says.get(place)]

    def new_text(self, edits: Sequence[Edit]) -> NewText:
        """Return the text of the file with edits; it means what the session says that it means."""
        if self.text is None:
            what = "are labels from memory, without a text"
            raise InputError(self.name, 0, what, "name a label file when the session begins")
        new = with_entries(self.name, self.text, self.new_entries(edits))
        try:
            means = parse_labels(new.text, self.how.vocabulary, name=self.how.file, bounds=self.how.bounds)
        except InputErrors as error:
            raise self._by_hand(f"cannot be changed: {error.errors[0].problem}") from None
        if _facts(means) != _facts(self.with_edits(edits)):
            raise self._by_hand("cannot be changed without changing another entry")
        return new

    def _by_hand(self, problem: str) -> LabelError:
        return LabelError(self.name, 0, problem, "write the labels by hand")

    def encoded(self, text: str) -> bytes:
        """Return a text as the file has it: a mark at its beginning stays."""
        marked = self.digest and self.text is not None and digest_of(self.text.encode()) != self.digest
        return text.encode("utf-8-sig" if marked else "utf-8")


def _facts(labels: Labels) -> object:
    """What labels say, wherever it stands: the order of entries says nothing."""
    parts = (labels.entries, labels.elements, labels.flows, labels.limits)
    lists = [sorted(map(repr, map(without_places, part))) for part in parts]
    return lists, without_places(labels.surroundings), without_places(labels.processing)


@dataclass(frozen=True, slots=True)
class EditedFile:
    """A label file, as a session knows it.

    Attributes
    ----------
    own
        As it was read.
    readings
        The same for each way in which robots of a fleet read it; of one robot there is one.
    last
        Digest and text of the file on the disk, as the session read or wrote it.
    says
        What stands in the file, as the session knows it.
    written
        What the file means since it was saved here, with its lines; empty before.
    """

    own: FileText
    readings: Mapping[Key, FileText]
    last: tuple[str, str]
    says: Entries
    written: Mapping[Key, Labels] = field(default_factory=dict)

    @classmethod
    def of(cls, own: FileText, readings: Mapping[Key, FileText] | None = None) -> EditedFile:
        """Return a file that was just read."""
        return cls(own, readings or {(own.file, False): own}, (own.digest, own.text or ""), own.says)

    def entries(self, edits: Sequence[Edit]) -> dict[tuple[str, str], Any]:
        """Return what it says with edits: (section, name) -> entry."""
        return {**self.own.says, **{(edit.section, edit.name): edit.value for edit in edits}}

    def unsaved(self, edits: Sequence[Edit]) -> list[Edit]:
        """Return what the file on the disk does not say, as the session knows it."""
        return differences(self.says, self.entries(edits))

    def labels(self, edits: Sequence[Edit]) -> dict[Key, Labels]:
        """Return what it means with edits; or raise ``InputErrors``."""
        if self.written and not self.unsaved(edits):
            return dict(self.written)
        return {key: reading.with_edits(edits) for key, reading in self.readings.items()}

    def changed_on_disk(self) -> Conflict | None:
        """Return how the file differs from what the session read or wrote; None if it does not."""
        if not self.own.file:
            return None
        data = _on_disk(self.own.file)
        if digest_of(data) == self.last[0]:  # also of a file that is not there yet
            return None
        diff = _difference(self.own.file, self.last[1], data)
        return Conflict(self.own.file, diff) if diff else None

    def saved(self, edits: Sequence[Edit], read: Callable[[], EditedFile]) -> tuple[EditedFile, SavedFile | Conflict]:
        """Write edits into the file, if it is still what the session knows; return also how it is known then.

        Parameters
        ----------
        read
            Reads the file anew, so that lines and hash of what it means are those of the file.
        """
        own = self.own
        if not own.file:
            raise InputError(own.name, 0, "have no file to be saved in", "name one: save_as('labels.yaml')")
        new, file = own.new_text(edits), Path(own.file)
        with one_run(), editing(file):  # each save reads what it replaces
            before = _on_disk(own.file)
            if digest_of(before) != self.last[0]:
                return self, Conflict(own.file, _difference(own.file, self.last[1], before))
            data = own.encoded(new.text)
            if data != before:
                write_texts([(file, data)], edited=file)
        done = SavedFile(own.file, new.lines, digest_of(data), new.remarks)
        return self._after_write(done, edits, read()), done

    def saved_as(
        self, edits: Sequence[Edit], file: str, read: Callable[[], EditedFile]
    ) -> tuple[EditedFile, SavedFile]:
        """Write it under another name, where there is none; labels that had no file have this one then."""
        new = self.own.new_text(edits)
        with one_run(), editing(Path(file)):
            if exists(file):
                raise InputError(file, 0, "is there already", "a label file is work: name another, or remove it")
            data = new.text.encode()
            write_texts([(Path(file), data)], edited=Path(file))
        done = SavedFile(file, new.lines, digest_of(data), new.remarks)
        if self.own.file:
            return self, done
        own = replace(self.own, file=file, how=self.own.how._replace(file=file))
        named = replace(self, own=own, readings={(file, False): own})
        return named._after_write(done, edits, read()), done  # noqa: SLF001 - of its own class

    def _after_write(self, saved: SavedFile, edits: Sequence[Edit], now: EditedFile) -> EditedFile:
        """The file as it was written; where somebody else was quicker since, nothing is known of its text."""
        last = now.last if now.own.digest == saved.digest else (saved.digest, "")
        written = {key: reading.labels for key, reading in now.readings.items()}
        return replace(self, last=last, says=self.entries(edits), written=written)

    def merged(self, now: EditedFile, edits: Sequence[Edit]) -> tuple[list[Edit], tuple[Edit, ...]]:
        """Hold edits against what the file says now: what was saved here before gives way to what others say later.

        Returns
        -------
        list of Edit, tuple of Edit
            The edits that are left, and what the file now says of elements of which the session says something else
            that is not saved.
        """
        mine = self.entries(edits)
        theirs = [edit for edit in differences(self.says, now.says) if mine.get(edit[:2]) != edit.value]
        saved = {edit[:2] for edit in theirs if mine.get(edit[:2]) == self.says.get(edit[:2])}
        left = [edit for edit in edits if edit[:2] not in saved]
        return left, tuple(edit for edit in theirs if edit[:2] not in saved)


def _on_disk(file: str) -> bytes | None:
    """What a label file holds now; None if there is none."""
    return read_regular(file, yaml_values.MAX_BYTES, partial(LabelError, file)) if exists(file) else None


def digest_of(data: bytes | None) -> str:
    """Return the SHA-256 of what a file holds; empty where there is none."""
    return "" if data is None else hashlib.sha256(data).hexdigest()


def _difference(file: str, before: str, now: bytes | None) -> str:
    """What somebody else changed, as a unified diff."""
    text = "" if now is None else now.decode("utf-8-sig", "replace")
    name = shown(file)
    lines = unified_diff(
        before.splitlines(True), text.splitlines(True), f"{name} as it was read", f"{name} as it is now"
    )
    return "".join(line if line.endswith("\n") else f"{line}\n" for line in lines)


def chosen(labels: Sequence[str | Labels]) -> int | None:
    """Return which of the label files a session edits: the first of a person's that has entries; None if there is none.

    The paper's six lists have none, and cannot say what an edit can.
    """
    for at, file in enumerate(labels):
        if isinstance(file, Labels):
            if not file.shipped:
                return at
        elif not file.startswith(OURS) and not (is_file(file) and _has_six_lists(file)):
            return at
    return None


def _has_six_lists(file: str) -> bool:
    text, _ = read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))
    top = yaml_values.parse(text, partial(LabelError, file))
    return top.kind == "map" and top.get("labels") is None and any(top.get(key) for key in SIX_LISTS)


def read_file(
    file: str | Labels | None, vocabulary: Vocabulary, settings: Settings, *, alone: bool = False
) -> FileText:
    """Read the label file that is edited; one that is not there is begun, in memory.

    Parameters
    ----------
    alone
        Whether a robot of a fleet reads it as its own: then it outranks what its model's files say.
    """
    name = file if isinstance(file, str) else ""
    how = WrittenEntries(name or MEMORY, vocabulary, settings.bounds, root=settings.include_root or "", own=alone)
    if isinstance(file, Labels):
        lines = max((entry.place.line for entry in file.entries), default=0)
        return FileText("", None, "", file, {}, how._replace(file=file.file, lines=lines))
    if file is None or not exists(file):
        labels = parse_labels(NEW, vocabulary, name=how.file, bounds=settings.bounds)
        return FileText(name, NEW, "", labels, {}, how._replace(lines=1))
    try:
        text, data = read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))
    except LabelError as error:
        raise InputErrors([error]) from None
    labels = read_labels(
        file, vocabulary, category=settings.category, own=alone, bounds=settings.bounds,
        include_root=settings.include_root,
    )  # fmt: skip
    digest = digest_of(data)
    if digest != labels.sha256:
        raise InputErrors([LabelError(file, 0, "was changed while it was read", "run the command again")])
    top = yaml_values.parse(text, partial(LabelError, file), settings.bounds)
    author = top.get("author")
    how = how._replace(author=author.text.strip() if author else "", lines=len(text.splitlines()))
    return FileText(file, text, digest, labels, entries_of(top), how)
