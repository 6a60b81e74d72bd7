"""What one file of a bag says: the part of a ``Bag`` that a reader of a storage makes, and how parts are put together.

In: parts. Out: topics with all that is said of each.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosprivacy.analysis.model.recording import BagTopic

if TYPE_CHECKING:
    from collections.abc import Iterable

LAST_TIME = 253_402_300_799 * 10**9  # of the year 9999, in nanoseconds


@dataclass(frozen=True, slots=True)
class Recorded:
    """What a file, or the ``metadata.yaml`` of a folder, says; see ``Bag``."""

    storage: str
    topics: tuple[BagTopic, ...] = ()
    start: int | None = None
    end: int | None = None
    distro: str = ""
    compression: str = ""
    gaps: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()


def united(topics: Iterable[BagTopic]) -> tuple[BagTopic, ...]:
    """Return topics by name, each once; a count that one of them does not say is not known.

    >>> [topic.messages for topic in united([BagTopic("/a", messages=1), BagTopic("/a", messages=2)])]
    [3]
    """
    by_name: dict[str, list[BagTopic]] = defaultdict(list)
    for topic in topics:
        by_name[topic.name].append(topic)
    return tuple(_one(name, same) for name, same in sorted(by_name.items()))


def _one(name: str, same: list[BagTopic]) -> BagTopic:
    types = tuple(sorted({kind for topic in same for kind in topic.types}))
    hashes = tuple(sorted({digest for topic in same for digest in topic.hashes}))
    counts = [topic.messages for topic in same if topic.messages is not None]
    return BagTopic(name, types, hashes, sum(counts) if len(counts) == len(same) else None)


def moment(nanoseconds: int) -> int | None:
    """Return a time; None for one that nothing can have been recorded at.

    >>> moment(5), moment(-1), moment(10**21)
    (5, None, None)
    """
    return nanoseconds if 0 < nanoseconds <= LAST_TIME else None
