"""A path -> the bag there: a file of a recording, or its folder with ``metadata.yaml``.

In: a path. Out: ``Bag``. What ``metadata.yaml`` says is held against the files beside it, as far as these can be read;
what differs is a gap, since then neither tells all.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import BagError, InputError, reason, shown
from rosprivacy.analysis.model.recording import Bag
from rosprivacy.ingest.bags.bag_metadata import NAME, read_metadata
from rosprivacy.ingest.bags.mcap_file import MissingLibraryError, read_mcap
from rosprivacy.ingest.bags.recorded_file import Recorded, united
from rosprivacy.ingest.bags.sqlite_file import read_sqlite
from rosprivacy.ingest.reading.bounded_file import nearest_file
from rosprivacy.ingest.reading.confined import leaves

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from rosprivacy.analysis.model.recording import BagTopic

READERS: dict[str, Callable[[str], Recorded]] = {".mcap": read_mcap, ".db3": read_sqlite}
PACKED = (".zstd", ".zst", ".lz4")  # of whole files
ROS1 = ".bag"


def is_recording(name: str) -> bool:
    """Return whether a file is called as one of a bag.

    >>> [is_recording(name) for name in ("run.mcap", "run_0.db3.zstd", "RUN.MCAP", "run.bag", "run.txt")]
    [True, True, True, True, False]
    """
    return _ending(name) in (*READERS, ROS1)


def read_bag(path: str) -> Bag:
    """Read what a bag says of itself.

    Raises
    ------
    InputError
        If there is none, or it cannot be read at all.
    """
    try:
        there = Path(path)
        if not path or not there.exists():
            raise BagError(path, 0, "bag not found", nearest_file(there))
        if there.is_dir():
            return _folder(path)
    except (OSError, ValueError) as error:
        raise BagError(path, 0, f"cannot be read: {reason(error)}", "check the path and its permissions") from None
    if there.name == NAME:
        return _folder(str(there.parent), path)
    return _bag(path, _file(path), [path])


def _file(file: str) -> Recorded:
    ending = _ending(file)
    if ending == ROS1:
        raise BagError(file, 0, "a bag of ROS 1, which is not read", "convert it to rosbag2")
    if ending not in READERS:
        raise BagError(file, 0, "not called as a bag", "name a file .mcap or .db3, or the folder of a recording")
    if file.lower().endswith(PACKED):
        hint = f"unpack it, or name its folder if there is a {NAME}"
        raise BagError(file, 0, "compressed as a whole, which hides its topics", hint)
    return READERS[ending](file)


def _ending(name: str) -> str:
    path = Path(name.lower())
    return Path(path.stem).suffix if path.suffix in PACKED else path.suffix


def _bag(path: str, said: Recorded, files: Iterable[str], gaps: Sequence[str] = (), notes: Sequence[str] = ()) -> Bag:
    there = sorted(file for file in files if Path(file).is_file())
    size = sum(Path(file).stat().st_size for file in there)
    all_gaps = (*said.gaps, *gaps)
    facts = (said.start, said.end, said.distro, said.compression, all_gaps, said.beside, tuple(notes))
    return Bag(path, said.storage, said.topics, tuple(there), size, *facts)


def _folder(folder: str, metadata: str = "") -> Bag:
    """The folder of one recording."""
    file = metadata or str(Path(folder, NAME))
    if not Path(file).exists():
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
        elif not Path(path).is_file():
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
    more = [_beside(path, gaps, notes) for path in files]
    return _bag(metadata or folder, _compared(said.recorded, [one for one in more if one], gaps), files, gaps, notes)


def _beside(path: str, gaps: list[str], notes: list[str]) -> Recorded | None:
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
    beside = tuple(sorted({*metadata.beside, *(what for file in files for what in file.beside)}))
    packed = metadata.compression or ", ".join(sorted({file.compression for file in files if file.compression}))
    topics = united((*metadata.topics, *left_out))
    return Recorded(
        metadata.storage, topics, metadata.start, metadata.end, metadata.distro, packed, metadata.gaps, beside
    )
