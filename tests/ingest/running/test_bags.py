"""Bags as others write, cut, pack and forge them: what is read of them, what is said, what it costs.

Rules S11 (what is not known is said) and S14; the promises of docs/security.md.
"""

from __future__ import annotations

import os
import shutil
import sqlite3
import struct
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
import yaml
import zstandard

from rosprivacy.analysis.errors import BagError, InputErrors
from rosprivacy.ingest.running import mcap_file, recorded_file
from rosprivacy.ingest.running.bag_folders import read_bag, read_bags
from tests.helpers.bags import IMAGE, ODOMETRY, SECRET, START, mcap, rosbag2

if TYPE_CHECKING:
    from rosprivacy.analysis.model.recording import Bag

ALL = {"/camera": ((IMAGE,), 5), "/odom": ((ODOMETRY,), 1)}
STORAGES = ["mcap", "sqlite3"]
ENDLESS = """CREATE VIEW topics AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)
SELECT x, x name, x type FROM n"""
COMPUTED = """CREATE TABLE topics(id INTEGER, name TEXT GENERATED ALWAYS AS (hex(zeroblob(1000000))), type TEXT);
INSERT INTO topics(id, type) VALUES (1, 'x')"""


def told(bag: Bag) -> dict[str, tuple[tuple[str, ...], int | None]]:
    return {topic.name: (topic.types, topic.messages) for topic in bag.topics}


@pytest.mark.parametrize("storage", STORAGES)
def test_a_recording_of_another_library(tmp_path: Path, storage: str) -> None:
    bag = read_bag(str(rosbag2(tmp_path / "run", storage)))
    assert told(bag) == ALL
    assert (bag.storage, bag.complete, bag.messages, bag.extras) == (storage, True, 6, ())
    assert (bag.start, bag.end, bag.distro) == (START, START + 5 * 10**9, "rosbags")
    assert all(topic.hashes[0].startswith("RIHS01_") for topic in bag.topics)
    assert bag.size == sum(Path(file).stat().st_size for file in bag.files)


@pytest.mark.parametrize("storage", STORAGES)
def test_a_file_alone_says_the_same_but_for_what_only_a_scan_would_tell(tmp_path: Path, storage: str) -> None:
    whole = read_bag(str(rosbag2(tmp_path / "run", storage)))
    (file,) = whole.files
    alone = read_bag(file)
    assert {name: types for name, (types, _) in told(alone).items()} == {
        name: types for name, (types, _) in ALL.items()
    }
    assert (alone.complete, alone.start, alone.end) == (True, whole.start, whole.end)
    assert alone.messages == (6 if storage == "mcap" else None)


@pytest.mark.parametrize("packed", ["NONE", "ZSTD", "LZ4"])
def test_chunks_that_are_packed(tmp_path: Path, packed: str) -> None:
    bag = read_bag(str(mcap(tmp_path / "a.mcap", packed)))
    assert told(bag) == {"/camera": ((IMAGE,), 50), "/odom": ((ODOMETRY,), 1)}
    assert bag.compression == ("" if packed == "NONE" else f"{packed.lower()} (chunks)")


@pytest.mark.parametrize("packed", ["NONE", "ZSTD", "LZ4"])
def test_a_cut_file_is_never_taken_for_whole(tmp_path: Path, packed: str) -> None:
    """At every length it is said to be incomplete, or refused; what is found is really in it."""
    data = mcap(tmp_path / "a.mcap", packed, messages=30).read_bytes()
    cut = tmp_path / "cut.mcap"
    found = set()
    for length in range(0, len(data), 7):
        cut.write_bytes(data[:length])
        if length < len(mcap_file.MAGIC):
            with pytest.raises(BagError, match="not an MCAP file"):
                read_bag(str(cut))
            continue
        bag = read_bag(str(cut))
        assert set(told(bag)) <= ALL.keys()
        assert "the file is cut" in bag.gaps[0]
        found.add(len(bag.topics))
    assert found == {0, 1, 2}


def test_a_cut_database_is_said(tmp_path: Path) -> None:
    (file,) = read_bag(str(rosbag2(tmp_path / "run", "sqlite3"))).files
    data = Path(file).read_bytes()
    cut = tmp_path / "cut.db3"
    for length in range(16, len(data), 509):
        cut.write_bytes(data[:length])
        assert read_bag(str(cut)).gaps[0] == "the file is cut; topics may be missing"


def test_a_log_beside_a_database_is_not_read_and_said(tmp_path: Path) -> None:
    """A recording that goes on: what SQLite has not written into the file may be topics."""
    file = tmp_path / "a.db3"
    writer = sqlite3.connect(file)
    writer.execute("PRAGMA journal_mode=WAL")
    writer.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT)")
    writer.commit()
    writer.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    writer.execute("INSERT INTO topics VALUES (1, '/camera', 'sensor_msgs/msg/Image')")
    writer.commit()
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir() if not path.name.endswith("-shm")}
    bag = read_bag(str(file))
    assert (bag.topics, bag.complete) == ((), False)
    assert "'a.db3-wal' beside it is not read" in bag.gaps[0]
    assert before == {path.name: path.read_bytes() for path in tmp_path.iterdir() if not path.name.endswith("-shm")}
    writer.close()


@pytest.mark.parametrize(
    ("made", "refused"),
    [
        (ENDLESS, True),
        (COMPUTED, False),
        ("CREATE VIRTUAL TABLE topics USING fts5(name, type)", True),
        ("CREATE TABLE other(name TEXT)", True),
        ("CREATE TABLE topics(id INTEGER)", False),
    ],
    ids=["a view without end", "a column that is computed", "a virtual table", "no table", "no names"],
)
def test_a_database_that_is_made_to_harm_is_refused_or_incomplete(tmp_path: Path, made: str, *, refused: bool) -> None:
    file = tmp_path / "a.db3"
    database = sqlite3.connect(file)
    database.executescript(made)
    database.commit()
    database.close()
    if refused:
        with pytest.raises(BagError, match="without the table 'topics'"):
            read_bag(str(file))
    else:
        assert read_bag(str(file)).gaps == ("the database is damaged; topics may be missing",)


def test_what_a_message_holds_cannot_be_asked_for(tmp_path: Path) -> None:
    from rosprivacy.ingest.running.sqlite_file import guard

    (file,) = read_bag(str(rosbag2(tmp_path / "run", "sqlite3"))).files
    with closing(sqlite3.connect(f"file:{file}?mode=ro&immutable=1", uri=True)) as database, database:
        assert database.execute("SELECT data FROM messages").fetchone() == (SECRET * 5,)
        guard(database)
        assert database.execute("SELECT timestamp FROM messages LIMIT 1").fetchone() == (START,)
        for asked in ("SELECT data FROM messages", "PRAGMA user_version", "ATTACH 'x' AS y", "DELETE FROM topics"):
            with pytest.raises(sqlite3.DatabaseError, match=r"not authorized|prohibited"):
                database.execute(asked)


def test_a_file_that_is_packed_as_a_whole(tmp_path: Path) -> None:
    folder = rosbag2(tmp_path / "run")
    (file,) = folder.glob("*.mcap")
    file.with_suffix(".mcap.zstd").write_bytes(zstandard.compress(file.read_bytes()))
    file.unlink()
    metadata = folder / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace(".mcap\n", ".mcap.zstd\n"))
    bag = read_bag(str(folder))
    assert (told(bag), bag.complete) == (ALL, True)
    assert "metadata.yaml alone tells what is in it" in bag.notes[0]
    with pytest.raises(BagError, match="compressed as a whole, which hides its topics; unpack it"):
        read_bag(str(file.with_suffix(".mcap.zstd")))


@pytest.mark.parametrize("mode", ["file", "message"])
def test_what_rosbags_packs(tmp_path: Path, mode: str) -> None:
    bag = read_bag(str(rosbag2(tmp_path / "run", "sqlite3", packed=mode)))
    assert (told(bag), bag.complete, bag.compression) == (ALL, True, f"zstd ({mode})")


@pytest.mark.parametrize("storage", STORAGES)
def test_metadata_that_leaves_out_a_topic_is_not_believed(tmp_path: Path, storage: str) -> None:
    folder = rosbag2(tmp_path / "run", storage)
    metadata = folder / "metadata.yaml"
    whole = yaml.safe_load(metadata.read_text())
    del whole["rosbag2_bagfile_information"]["topics_with_message_count"][0]
    metadata.write_text(yaml.safe_dump(whole))
    bag = read_bag(str(folder))
    assert set(told(bag)) == ALL.keys()
    assert bag.gaps == ("metadata.yaml does not name the topic /camera, which is in the files",)


def test_metadata_that_counts_no_message_is_held_against_the_file(tmp_path: Path) -> None:
    folder = rosbag2(tmp_path / "run")
    metadata = folder / "metadata.yaml"
    metadata.write_text(metadata.read_text().replace("message_count: 5", "message_count: 0"))
    assert read_bag(str(folder)).gaps == ("metadata.yaml counts fewer messages of /camera than its files",)


def test_files_that_are_missing_or_not_named_or_outside_are_told(tmp_path: Path) -> None:
    folder = rosbag2(tmp_path / "run")
    shutil.copy(mcap(tmp_path / "other.mcap"), folder / "more.mcap")
    metadata = folder / "metadata.yaml"
    text = metadata.read_text()
    metadata.write_text(text.replace("  - run.mcap\n", "  - gone.mcap\n  - ../other.mcap\n  - run.mcap\n"))
    assert set(read_bag(str(folder)).gaps) == {
        "metadata.yaml names '../other.mcap', which lies outside the folder and is not read",
        "metadata.yaml names 'gone.mcap', which is not there",
        "metadata.yaml does not name 'more.mcap'",
        "metadata.yaml counts fewer messages of /camera than its files",
        "metadata.yaml counts fewer messages of /odom than its files",
    }


def test_what_is_beside_messages_is_named(tmp_path: Path) -> None:
    bag = read_bag(str(mcap(tmp_path / "a.mcap", attachment="me\x1b[2J.png", metadata="drive")))
    assert bag.extras == ("attachment 'me\\\\x1b[2J.png'", "metadata 'drive'")
    custom = read_bag(str(rosbag2(tmp_path / "run", custom="A. Person")))
    assert custom.extras == ("custom data 'operator'",)


def test_a_crashed_recording_has_no_metadata(tmp_path: Path) -> None:
    folder = rosbag2(tmp_path / "run")
    (folder / "metadata.yaml").unlink()
    (bag,) = read_bags([str(folder)])  # a folder of bags then, and the file speaks for itself
    assert (bag.path, told(bag)) == (str(folder / "run.mcap"), ALL)


def test_a_folder_of_bags_keeps_what_cannot_be_read(tmp_path: Path) -> None:
    rosbag2(tmp_path / "day1" / "a")
    rosbag2(tmp_path / "day2" / "b", "sqlite3")
    (tmp_path / "day2" / "broken.MCAP").write_bytes(b"nothing")
    (tmp_path / "old.bag").write_bytes(b"#ROSBAG V2.0")
    (tmp_path / "gone.db3").symlink_to(tmp_path / "nowhere")
    (tmp_path / "day3").symlink_to(tmp_path / "day1")
    (tmp_path / "notes.txt").write_text("no bag")
    bags = {os.path.relpath(bag.path, tmp_path): bag for bag in read_bags([str(tmp_path)])}
    assert {name: bag.complete for name, bag in bags.items()} == {
        "day1/a": True, "day2/b": True, "day2/broken.MCAP": False, "gone.db3": False, "old.bag": False,
    }  # fmt: skip
    assert bags["old.bag"].gaps == ("a bag of ROS 1, which is not read; convert it to rosbag2",)
    with pytest.raises(InputErrors, match="not an MCAP file"):
        read_bags([str(tmp_path / "day2" / "broken.MCAP")])
    (tmp_path / "none").mkdir()
    with pytest.raises(InputErrors, match="a folder without a bag; name a bag"):
        read_bags([str(tmp_path / "none")])


@pytest.mark.slow
def test_a_thousand_bags_in_order(tmp_path: Path) -> None:
    one = rosbag2(tmp_path / "one")
    for number in range(1_000):
        folder = tmp_path / "all" / f"{number:04}"
        folder.mkdir(parents=True)
        for file in one.iterdir():
            os.link(file, folder / file.name)
    bags = read_bags([str(tmp_path / "all")])
    assert [Path(bag.path).name for bag in bags] == [f"{number:04}" for number in range(1_000)]
    assert {bag.messages for bag in bags} == {6}


def sparse(file: Path, size: int = 2**30) -> Path:
    """A file that is whole at both ends and a hole between them, as large as a recording."""
    data = mcap(file, "NONE").read_bytes()
    head, hole = data[:8], size - len(data)
    padding = struct.pack("<BQ", 0x80, hole - 9)  # a record of a kind that nobody knows, which readers pass over
    at = data.rindex(struct.pack("<BQ", 2, 20))
    summary, offsets = struct.unpack_from("<QQ", data, at + 9)
    footer = struct.pack("<BQQQI", 2, 20, summary + hole, offsets + hole, 0)
    with file.open("wb") as stream:
        stream.write(head + padding)
        stream.seek(hole + 8)
        stream.write(data[8:at] + footer + data[-8:])
    return file


def test_a_gigabyte_costs_what_its_summary_costs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a summary, and without one: the records are passed over from head to head."""
    file = sparse(tmp_path / "a.mcap")
    assert file.stat().st_size == 2**30
    monkeypatch.setattr(recorded_file, "MOST_READ", 10_000)  # a bound that only the summary keeps
    with recorded_file.bounded_stream(str(file), 100_000) as stream:
        assert mcap_file._summary(stream)
        assert 100_000 - stream.remaining < 10_000
    assert told(read_bag(str(file))) == {"/camera": ((IMAGE,), 50), "/odom": ((ODOMETRY,), 1)}
    with file.open("r+b") as stream_:
        stream_.truncate(2**30 - 10)
    bag = read_bag(str(file))
    assert set(told(bag)) == ALL.keys()


def test_lengths_that_lie_cost_nothing(tmp_path: Path) -> None:
    """Records of any kind that say they are as long as memory, or as nothing, a thousand times over."""
    file = tmp_path / "a.mcap"
    for code in range(16):
        for length in (0, 2**31, 2**63, 2**64 - 1):
            for tail in (b"", b"\xff" * 200, mcap_file.MAGIC):
                file.write_bytes(mcap_file.MAGIC + struct.pack("<BQ", code, length) * 3 + tail)
                assert not told(read_bag(str(file)))


def test_a_chunk_that_swells_is_not_unpacked_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bomb = zstandard.compress(bytes(50_000_000))
    chunk = struct.pack("<QQQI", 0, 0, 1, 0) + struct.pack("<I", 4) + b"zstd" + struct.pack("<Q", len(bomb)) + bomb
    file = tmp_path / "a.mcap"
    file.write_bytes(mcap_file.MAGIC + struct.pack("<BQ", 6, len(chunk)) + chunk)
    monkeypatch.setattr(mcap_file, "MOST_UNPACKED", 1_000_000)
    assert "more records than are followed" in read_bag(str(file)).gaps[0]


def test_without_the_library_the_extra_is_named(tmp_path: Path) -> None:
    """One line where MCAP alone would tell; a folder with its metadata is read, and the note says what was not."""
    folder = rosbag2(tmp_path / "run")
    code = (
        "import sys; sys.modules['mcap'] = None\n"
        "from rosprivacy.ingest.running.bag_folders import read_bag\n"
        f"print(read_bag({str(folder)!r}).notes[0])\n"
        f"try: read_bag({str(folder / 'run.mcap')!r})\nexcept Exception as error: print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    note, error = done.stdout.splitlines()
    assert note.startswith("run.mcap is not compared with metadata.yaml: MCAP needs a library")
    assert error.endswith("run.mcap: MCAP needs a library that is not installed; install the extra 'bags'")


@pytest.mark.parametrize("made", ["folder", "pipe", "empty", "metadata"])
def test_what_is_no_bag(tmp_path: Path, made: str) -> None:
    path = tmp_path / "a.mcap"
    if made == "pipe":
        os.mkfifo(path)
    elif made == "empty":
        path.write_bytes(b"")
    else:
        path.mkdir()
        if made == "metadata":
            (path / "metadata.yaml").write_text("secret: value\n")
    with pytest.raises(BagError, match=r"^[^;]+: .+; .+$") as refused:
        read_bag(str(path))
    assert "value" not in str(refused.value)
