"""Damages of files: of their bytes, and of the JSON that they hold. The same seed makes the same damage."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from tests.helpers.command import refused

if TYPE_CHECKING:
    from collections.abc import Iterator
    from random import Random

    from tests.helpers.command import Done

LONGEST_LINE = 1_000

EXTREMES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 1.5, 2**31, 2**63, 10**400, -(10**30), "", "x", "/", "*", "\ud800", "\x00", "\u202e",
    "x" * 5000, "file:///etc/passwd", [], [[]], ["x"], [None], {}, {"": ""}, {"robot": 1, "kind": [], "name": {}},
)  # fmt: skip
WORDS = ("NaN", "Infinity", "1e999", "1" * 5000, '{"a": 1, "a": 2}', "[" * 5000, "[" * 200 + "]" * 200)


def damaged_bytes(random: Random, data: bytes) -> bytes:
    """A file with other bytes, without some, with more, or cut off."""
    at, end = sorted(random.randrange(len(data) + 1) for _ in range(2))
    end = min(end, at + random.choice((1, 8, 400)))
    return random.choice((
        data[:at] + bytes([random.randrange(256)]) + data[at + 1 :],
        data[:at] + random.randbytes(end - at) + data[end:],
        data[:at] + data[end:],
        data[:at] + data[at:end] + data[at:],
        data[:at],
    ))  # fmt: skip


def places(value: Any, way: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where there is something in a document; the whole first."""
    yield way
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inside:
        yield from places(item, (*way, key))


def damaged_document(random: Random, text: str) -> str:
    """A document in which one place is another one: gone, of another kind, an extreme, one that stands elsewhere."""
    document = json.loads(text)
    ways = list(places(document))[1:]
    depth = random.randrange(max(map(len, ways))) + 1
    way = random.choice([one for one in ways if len(one) >= depth] or ways)[:depth]
    inside = document
    for key in way[:-1]:
        inside = inside[key]
    key, mark = way[-1], "@@damage@@"
    what = random.randrange(6)
    if what == 0:
        del inside[key]
    elif what == 1:
        inside[key] = random.choice(EXTREMES)
    elif what == 2:
        inside[key] = mark
    elif what == 3 and isinstance(inside, list):
        inside.append(inside[key])
    elif what == 3:
        inside[f"{key}s"] = inside.pop(key)
    else:
        other: Any = document
        for step in random.choice(ways):
            other = other[step]
        inside[key] = json.loads(json.dumps(other))
    return json.dumps(document).replace(f'"{mark}"', random.choice(WORDS))


def damaged(random: Random, data: bytes) -> bytes:
    """A JSON file with one damage or several."""
    for _ in range(random.choice((1, 1, 1, 2))):
        try:
            if random.random() < 0.8:
                data = damaged_document(random, data.decode()).encode("utf-8", "surrogatepass")
            else:
                data = damaged_bytes(random, data)
        except (ValueError, RecursionError, IndexError):  # damaged enough to be no document any more
            return data
    return data


def one_line_each(done: Done, codes: set[int]) -> None:
    """A run ends as documented; what it refuses, it refuses in lines, and it writes nothing but its answer."""
    assert done.returncode in codes, done.stderr
    assert "Traceback" not in done.stderr
    if done.returncode == 2:
        assert all(len(line) < LONGEST_LINE for line in refused(done)), done.stderr
