"""What two readers found in public systems (protocol.md): what both say is true, what one says alone is disputed.

In: ``systems.jsonl`` and, for each system, a file of each reader. Out: ``Truth`` of a system.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    Item = Mapping[str, Any]

HERE = Path(__file__).parent
READERS = ("reader_a", "reader_b")
WRITTEN = {  # what a reader calls an end of a channel -> its role in a policy
    "publishes": "publish",
    "subscribes": "subscribe",
    "serves": "reply",
    "calls": "request",
    "serves_action": "execute",
    "calls_action": "call",
}
RUNTIME = "runtime"  # the sources do not fix the name


class System(NamedTuple):
    """A public system at one commit; ``half`` is ``open`` or ``sealed``."""

    system: str
    repository: str
    commit: str
    half: str


class End(NamedTuple):
    """An end of a channel where the code makes it; ``name`` is absolute, as it is without a launch file."""

    file: str
    line: int
    role: str
    name: str


class Start(NamedTuple):
    """A node that a launch file starts."""

    file: str
    line: int
    package: str
    executable: str
    name: str
    namespace: str
    remaps: tuple[tuple[str, str], ...]


class Outside(NamedTuple):
    """Something outside ROS, by the file and its sort; several of one sort in one file count once."""

    file: str
    sort: str


class Truth(NamedTuple):
    """What both readers say without a doubt.

    Attributes
    ----------
    ends, runtime
        Ends of channels whose name the sources fix, and (file, line, role) of those whose name they do not fix.
    disputed
        What one of the readers says alone, or with a doubt; counted neither as found nor as wrong.
    """

    ends: frozenset[End]
    runtime: frozenset[tuple[str, int, str]]
    started: frozenset[Start]
    outside: frozenset[Outside]
    logs: frozenset[tuple[str, int]]
    disputed: frozenset[tuple[Any, ...]]


def systems() -> Sequence[System]:
    """Return the systems that were read, sorted."""
    return [System(**json.loads(line)) for line in (HERE / "systems.jsonl").read_text("utf-8").splitlines()]


def truth(system: str, folder: Path = HERE) -> Truth:
    """Return what both readers say of a system.

    Parameters
    ----------
    folder
        With a folder for each reader; of the sealed half, wherever it was opened.
    """
    answers = [_items(folder / reader / f"{system}.jsonl") for reader in READERS]
    ends, not_ends = _agreed(answers, _end)
    runtime, not_runtime = _agreed(answers, _runtime)
    started, not_started = _agreed(answers, _start)
    outside, not_outside = _agreed(answers, _outside)
    logs, not_logs = _agreed(answers, _log)
    return Truth(
        ends, runtime, started, outside, logs, frozenset(not_ends | not_runtime | not_started | not_outside | not_logs)
    )


def _agreed(
    answers: Sequence[Sequence[Item]], key: Callable[[Item], Any]
) -> tuple[frozenset[Any], frozenset[tuple[Any, ...]]]:
    """What both readers say without a doubt, and all else of this sort that one of them says."""
    sure = [{key(item) for item in items if not item.get("unsure")} - {None} for items in answers]
    every = {key(item) for items in answers for item in items} - {None}
    both = frozenset(sure[0] & sure[1])
    return both, frozenset(every - both)


def _end(item: Item) -> End | None:
    if item["item"] != "endpoint" or item["known"] == RUNTIME or item["role"] not in WRITTEN:
        return None
    return End(item["file"], item["line"], WRITTEN[item["role"]], item["name"])


def _runtime(item: Item) -> tuple[str, int, str] | None:
    if item["item"] != "endpoint" or item["known"] != RUNTIME or item["role"] not in WRITTEN:
        return None
    return item["file"], item["line"], WRITTEN[item["role"]]


def _start(item: Item) -> Start | None:
    if item["item"] != "started":
        return None
    remaps = tuple(sorted((str(one), str(other)) for one, other in item.get("remaps", ())))
    name = item.get("name") or ""
    return Start(
        item["launch"], item["line"], item["package"], item["executable"],
        name.rpartition("/")[2], _namespace(item.get("namespace") or ""), remaps,
    )  # fmt: skip


def _namespace(written: str) -> str:
    """A namespace without a slash at its ends: readers write the root as ``/`` or as nothing."""
    return written.strip("/")


def _outside(item: Item) -> Outside | None:
    return Outside(item["file"], item["kind"]) if item["item"] == "external" and item["kind"] != "device" else None


def _log(item: Item) -> tuple[str, int] | None:
    return (item["file"], item["line"]) if item["item"] == "log" else None


def _items(file: Path) -> Sequence[Item]:
    return [json.loads(line) for line in file.read_text("utf-8").splitlines()]


def channels(ends: Iterable[End]) -> Mapping[tuple[str, str], tuple[frozenset[End], frozenset[End]]]:
    """Return the channels of some ends: (sort, name) -> what writes or serves, what reads or calls."""
    sides: dict[tuple[str, str], tuple[set[End], set[End]]] = {}
    for end in ends:
        sort = {"publish": "topic", "subscribe": "topic", "reply": "service", "request": "service"}.get(
            end.role, "action"
        )
        first, second = sides.setdefault((sort, end.name), (set(), set()))
        (first if end.role in ("publish", "reply", "execute") else second).add(end)
    return {channel: (frozenset(first), frozenset(second)) for channel, (first, second) in sides.items()}
