"""Paths that a user names -> the bags there: each by itself, and of a folder all that lie in it, whatever their depth.

In: paths. Out: ``Bag`` of each, or every problem of what was named. Links to folders are followed, each folder is
entered once. A bag that lies in a folder and cannot be read is one of which nothing is known: it stays in the answer
(S11). A recording is a file, or a folder with ``metadata.yaml``. What that says is held against the files beside it, as
far as these can be read; what differs is a gap, since then neither tells all, and so is what it does not say.

Source: rosbag2, ``rosbag2_storage/yaml.hpp``, versions 1 to 9.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import BagError, InputError, InputErrors, reason, shown
from rosprivacy.analysis.model.recording import Bag, BagTopic
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import leaves, nearest_file
from rosprivacy.ingest.reading.file_kinds import RECORDED, kind_of_file
from rosprivacy.ingest.reading.path_kinds import exists, is_dir, is_file
from rosprivacy.ingest.running.recorded_file import Recorded, moment, united
from rosprivacy.ingest.running.sqlite_file import read_sqlite

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.ingest.reading.yaml_values import Value

TOP = "rosbag2_bagfile_information"
NAME = "metadata.yaml"
LARGEST = 2**63
MCAP, SQLITE = ".mcap", ".db3"
PACKED = (".zstd", ".zst", ".lz4")  # of whole files
ROS1 = ".bag"


@dataclass(frozen=True, slots=True)
class Metadata:
    """What it says, and the names of its files, relative to it."""

    recorded: Recorded
    files: tuple[str, ...]


def read_metadata(file: str) -> Metadata:
    """Read the ``metadata.yaml`` of a recording; ``InputError`` if it is none."""
    top, _ = yaml_values.read(file, partial(BagError, file))
    said = top.get(TOP) if top.kind == "map" else None
    if said is None or said.kind != "map":
        raise BagError(file, top.line, f"no {TOP!r}", "name the folder of a recording of rosbag2")
    start, duration = _number(said, "starting_time"), _number(said, "duration")
    span = (moment(start), moment(start + duration)) if start and duration is not None else (None, None)
    rows = said.get("topics_with_message_count")
    topics = [_topic(row) for row in rows.items] if rows else []
    gaps = [] if rows and all(topics) else ["metadata.yaml does not say which topics there are"]
    packed = [_text(said, key) for key in ("compression_format", "compression_mode")]
    recorded = Recorded(
        _text(said, "storage_identifier") or "unknown",
        united(topic for topic in topics if topic),
        *span,
        distro=_text(said, "ros_distro"),
        compression=f"{packed[0]} ({packed[1].lower()})" if all(packed) else packed[0],
        gaps=tuple(gaps),
        extras=tuple(_custom(said)),
    )
    names = said.get("relative_file_paths")
    return Metadata(recorded, tuple(sorted({item.text for item in names.items if item.text})) if names else ())


def _topic(row: Value) -> BagTopic | None:
    about = row.get("topic_metadata")
    name = _text(about, "name") if about else ""
    if about is None or not name:
        return None
    kind, digest = _text(about, "type"), _text(about, "type_description_hash")
    return BagTopic(name, (kind,) if kind else (), (digest,) if digest else (), _count(row.get("message_count")))


def _custom(value: Value) -> Iterator[str]:
    """Free text of the person who recorded."""
    custom = value.get("custom_data")
    for key, _, _ in custom.entries if custom else ():
        yield f"custom data {shown(key)!r}"


def _text(value: Value, key: str) -> str:
    found = value.get(key)
    return found.text if found and found.kind in ("text", "number") else ""


def _number(value: Value, key: str) -> int | None:
    """A time: a map of one number, ``nanoseconds`` or ``nanoseconds_since_epoch``."""
    found = value.get(key)
    return _count(found.entries[0][2]) if found and len(found.entries) == 1 else None


def _count(value: Value | None) -> int | None:
    digits = value.text if value else ""
    return int(digits) if digits.isdecimal() and digits.isascii() and int(digits[:20]) < LARGEST else None


class MissingLibraryError(BagError):
    """The extra 'bags' is not installed."""


def is_recording(name: str) -> bool:
    """Return whether a file is called as one of a bag.

    >>> [is_recording(name) for name in ("run.mcap", "run_0.db3.zstd", "RUN.MCAP", "run.bag", "run.txt")]
    [True, True, True, True, False]
    """
    return _ending(name) in (MCAP, SQLITE, ROS1)


def read_bag(path: str) -> Bag:
    """Read what a bag says of itself; ``InputError`` if there is none, or it cannot be read at all."""
    try:
        there = Path(path)
        if not path or not exists(there):
            raise BagError(path, 0, "bag not found", nearest_file(there))
        if is_dir(there):
            return _folder(path)
    except (OSError, ValueError) as error:
        raise BagError(path, 0, f"cannot be read: {reason(error)}", "check the path and its permissions") from None
    if there.name == NAME:
        return _folder(str(there.parent), path)
    return _bag(path, _file(path), [path])


def _no_bag(file: str) -> BagError:
    """What is wrong with a file that is not called as a bag: it may be something else by its content."""
    try:
        kind = kind_of_file(file)
    except (OSError, ValueError):
        kind = None
    if kind in (None, RECORDED):
        return BagError(file, 0, "not called as a bag", "name a file .mcap or .db3, or the folder of a recording")
    return BagError(file, 1, *kind.refused("a bag", file))


def _file(file: str) -> Recorded:
    ending = _ending(file)
    if ending == ROS1:
        raise BagError(file, 0, "a bag of ROS 1, which is not read", "convert it to rosbag2")
    if ending not in (MCAP, SQLITE):
        raise _no_bag(file)
    if file.lower().endswith(PACKED):
        hint = f"unpack it, or name its folder if there is a {NAME}"
        raise BagError(file, 0, "compressed as a whole, which hides its topics", hint)
    if ending == SQLITE:
        return read_sqlite(file)
    try:
        from rosprivacy.ingest.running.mcap_file import read_mcap  # noqa: PLC0415 - an extra
    except ImportError:
        what = "MCAP needs a library that is not installed"
        raise MissingLibraryError(file, 0, what, "install the extra 'bags'") from None
    return read_mcap(file)


def _ending(name: str) -> str:
    path = Path(name.lower())
    return Path(path.stem).suffix if path.suffix in PACKED else path.suffix


def _bag(
    path: str, recorded: Recorded, files: Iterable[str], gaps: Sequence[str] = (), notes: Sequence[str] = ()
) -> Bag:
    there = sorted(file for file in files if is_file(file))
    size = sum(Path(file).stat().st_size for file in there)
    all_gaps = (*recorded.gaps, *gaps)
    facts = (
        recorded.start,
        recorded.end,
        recorded.distro,
        recorded.compression,
        all_gaps,
        recorded.extras,
        tuple(notes),
    )
    return Bag(path, recorded.storage, recorded.topics, tuple(there), size, *facts)


def _folder(folder: str, metadata: str = "") -> Bag:
    """The folder of one recording."""
    file = metadata or str(Path(folder, NAME))
    if not exists(file):
        hint = "rosbag2 writes it at the end of a recording; name the files in the folder, or a folder of bags"
        raise BagError(folder, 0, f"no {NAME}", hint)
    said = read_metadata(file)
    gaps: list[str] = []
    notes: list[str] = []
    root = os.path.realpath(folder)
    named = {}
    for name in said.files:
        path = str(Path(folder, name))
        if leaves(path, root):
            gaps.append(f"{NAME} names {shown(name)!r}, which lies outside the folder and is not read")
        elif not is_file(path):
            gaps.append(f"{NAME} names {shown(name)!r}, which is not there")
        else:
            named[os.path.realpath(path)] = path
    if not said.files:
        gaps.append(f"{NAME} names no file")
    for entry in sorted(os.listdir(folder)):
        path = str(Path(folder, entry))
        if is_recording(entry) and os.path.realpath(path) not in named:
            gaps.append(f"{NAME} does not name {shown(entry)!r}")
            if not leaves(path, root):
                named[os.path.realpath(path)] = path
    files = sorted(named.values())
    more = [_from_file(path, gaps, notes) for path in files]
    return _bag(metadata or folder, _compared(said.recorded, [one for one in more if one], gaps), files, gaps, notes)


def _from_file(path: str, gaps: list[str], notes: list[str]) -> Recorded | None:
    """What a file of a recording says by itself; ``metadata.yaml`` alone tells of one that cannot be looked into."""
    name = shown(Path(path).name)
    if path.lower().endswith(PACKED):
        notes.append(f"{name} is compressed as a whole: {NAME} alone tells what is in it")
        return None
    try:
        said = _file(path)
    except MissingLibraryError as error:
        notes.append(f"{name} is not compared with {NAME}: {error.problem}; {error.hint}")
        return None
    except InputError as error:
        gaps.append(f"{name}: {error.problem}")
        return None
    gaps += [f"{name}: {gap}" for gap in said.gaps]
    return said


def _compared(metadata: Recorded, files: Sequence[Recorded], gaps: list[str]) -> Recorded:
    """What ``metadata.yaml`` says, with what only the files say; that makes a gap."""
    known = {topic.name for topic in metadata.topics}
    left_out: list[BagTopic] = [topic for file in files for topic in file.topics if topic.name not in known]
    names = sorted({topic.name for topic in left_out})
    gaps += [f"{NAME} does not name the topic {shown(name)}, which is in the files" for name in names]
    counted = {topic.name: topic.messages or 0 for topic in united(topic for file in files for topic in file.topics)}
    for topic in metadata.topics:
        if topic.messages is not None and counted.get(topic.name, 0) > topic.messages:
            gaps.append(f"{NAME} counts fewer messages of {shown(topic.name)} than its files")
    beside = tuple(sorted({*metadata.extras, *(what for file in files for what in file.extras)}))
    packed = metadata.compression or ", ".join(sorted({file.compression for file in files if file.compression}))
    topics = united((*metadata.topics, *left_out))
    return Recorded(
        metadata.storage, topics, metadata.start, metadata.end, metadata.distro, packed, metadata.gaps, beside
    )


def read_bags(
    paths: Iterable[str], progress: Callable[[Sequence[str]], Iterable[str]] = lambda files: files
) -> tuple[Bag, ...]:
    """Read the bags at some paths, sorted by where they are.

    Parameters
    ----------
    progress
        Wraps the list of bags, to show how far it is.

    Raises
    ------
    InputErrors
        With every problem of what is named.
    """
    problems: list[InputError] = []
    named = {path: path for path in paths if not is_dir(path) or is_file(Path(path, NAME))}
    found: dict[str, str] = dict.fromkeys(named, "")
    for folder in paths:
        if folder not in named:
            inside = list(_inside(folder, problems))
            found |= {path: why for path, why in inside if path not in found}
            if not inside and not problems:
                problems.append(BagError(folder, 0, "a folder without a bag", "name a bag: .mcap, .db3, or its folder"))
    bags = []
    for path in progress(sorted(found)):
        try:
            bags.append(Bag(path, gaps=(found[path],)) if found[path] else read_bag(path))
        except InputError as error:
            if path in named:
                problems.append(error)
            else:
                bags.append(Bag(path, gaps=(f"{error.problem}; {error.hint}",)))
    if problems:
        raise InputErrors(problems)
    return tuple(bags)


def _inside(top: str, problems: list[InputError]) -> Iterator[tuple[str, str]]:
    """The bags below a folder, and what is wrong with one that cannot be opened."""
    waiting = [top]
    links: list[str] = []
    entered: set[str] = set()
    while waiting or links:
        folder = waiting.pop() if waiting else links.pop(0)  # what only a link leads to, last
        real = os.path.realpath(folder)
        if real in entered:
            continue
        entered.add(real)
        try:
            entries = sorted(os.listdir(folder))
        except OSError as error:
            problems.append(BagError(folder, 0, f"cannot be read: {reason(error)}", "check its permissions"))
            continue
        whole = NAME in entries
        if whole:
            yield folder, ""
        for entry in entries:
            path = str(Path(folder, entry))
            if is_dir(path):
                (links if Path(path).is_symlink() else waiting).append(path)
            elif not whole and is_recording(entry):
                dangling = Path(path).is_symlink() and not exists(path)
                yield path, "a link to nothing; correct the link, or remove it" if dangling else ""
