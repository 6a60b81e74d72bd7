"""What a bag (a recording of ROS messages) says of itself, and what is judged of it. No message is part of it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timezone
from typing import TYPE_CHECKING

from rosprivacy.analysis.model.suggestion import surest
from rosprivacy.analysis.python_311 import StrEnum

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.model.suggestion import Confidence, Suggestion


@dataclass(frozen=True, slots=True)
class BagTopic:
    """A topic of a bag.

    Attributes
    ----------
    types, hashes
        Of its messages, sorted; several where the bag names several.
    messages
        How many there are; None where the bag does not say.
    """

    name: str
    types: tuple[str, ...] = ()
    hashes: tuple[str, ...] = ()
    messages: int | None = None


@dataclass(frozen=True, slots=True)
class Bag:
    """A bag: a file, or the folder of a recording.

    Attributes
    ----------
    path
        As the user named it, or where it was found.
    storage
        ``mcap``, ``sqlite3``, or what the bag names; empty where nothing could be read.
    topics
        Sorted by name.
    files
        Those of its recording, sorted.
    size
        Bytes of these.
    start, end
        Nanoseconds since 1970; None where the bag does not say.
    compression
        As the bag names it, such as ``zstd (file)``; empty for none.
    gaps
        Why topics may be missing: what is broken, cut, too large or not to be read; one sentence each.
    extras
        What is in it beside the messages of its topics, such as attachments.
    notes
        What else a reader has to know.
    """

    path: str
    storage: str = ""
    topics: tuple[BagTopic, ...] = ()
    files: tuple[str, ...] = ()
    size: int = 0
    start: int | None = None
    end: int | None = None
    distro: str = ""
    compression: str = ""
    gaps: tuple[str, ...] = ()
    extras: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether all topics of the bag are known."""
        return not self.gaps

    @property
    def messages(self) -> int | None:
        """How many messages it has; None where the bag does not say it of every topic.

        >>> Bag("run1", topics=(BagTopic("/a", messages=2), BagTopic("/b", messages=3))).messages
        5
        """
        counts = [topic.messages for topic in self.topics]
        known = [count for count in counts if count is not None]
        return sum(known) if self.complete and len(known) == len(counts) else None


def iso(moment: int | None) -> str:
    """Return a time in nanoseconds since 1970 as ISO 8601, whole seconds in UTC; empty for None.

    >>> iso(1_700_000_000_500_000_000), iso(None)
    ('2023-11-14T22:13:20Z', '')
    """
    return f"{datetime.fromtimestamp(moment // 10**9, timezone.utc):%Y-%m-%dT%H:%M:%SZ}" if moment is not None else ""


@dataclass(frozen=True, slots=True)
class Recording:
    """The bags that a storage is, in numbers.

    Attributes
    ----------
    bag
        Where they are.
    size
        Bytes of their files.
    topics
        How many different ones.
    messages
        How many; None where a bag does not say.
    start, end
        Nanoseconds since 1970; None where a bag does not say.
    oldest
        The earliest time that any of the bags says, whatever the others do.
    """

    bag: str
    size: int
    topics: int
    messages: int | None = None
    start: int | None = None
    end: int | None = None
    oldest: int | None = None


def recording_of(path: str, bags: Sequence[Bag]) -> Recording:
    """Return the numbers of some bags together; what one of them does not say is not known.

    >>> recording_of("runs", (Bag("a", size=5, start=1, end=2), Bag("b", size=7, start=4, end=9)))
    Recording(bag='runs', size=12, topics=0, messages=0, start=1, end=9, oldest=1)
    """
    counts = [bag.messages for bag in bags if bag.messages is not None]
    starts = [bag.start for bag in bags if bag.start is not None]
    ends = [bag.end for bag in bags if bag.end is not None]
    return Recording(
        path,
        sum(bag.size for bag in bags),
        len({topic.name for bag in bags for topic in bag.topics}),
        sum(counts) if len(counts) == len(bags) else None,
        min(starts) if len(starts) == len(bags) and starts else None,
        max(ends) if len(ends) == len(bags) and ends else None,
        min(starts + ends, default=None),
    )


class BagVerdict(StrEnum):
    """Whether personal data are in a bag. Never 'safe': the labels are a person's word (S12)."""

    PERSONAL_DATA = "personal-data"
    UNDETERMINED = "undetermined"
    NOTHING_FOUND = "nothing-found"


@dataclass(frozen=True, slots=True)
class TopicKinds:
    """What can be in a topic of a bag.

    Attributes
    ----------
    kinds
        Names of categories, sorted.
    unknown
        Why nobody can say what is in it; empty where that is known.
    why
        What that rests on, in a few words.
    suggested
        What its types suggest, the surest first: questions, of which nothing follows but that they are open.
    bound
        The kinds that can be in it and no others, sorted; None where nobody says that there are no others.
    doubt
        Why others can be in it, where that has a name.
    labelled
        Whether a person's label says of the topic itself what is in it.
    """

    topic: BagTopic
    kinds: tuple[str, ...] = ()
    unknown: str = ""
    why: str = ""
    suggested: tuple[Suggestion, ...] = ()
    bound: tuple[str, ...] | None = None
    doubt: str = ""
    labelled: bool = False

    @property
    def surest(self) -> dict[str, Confidence]:
        """The kinds that its types suggest, sorted, each with the surest confidence."""
        return surest(self.suggested)


@dataclass(frozen=True, slots=True)
class JudgedBag:
    """A bag with what can be in it."""

    bag: Bag
    topics: tuple[TopicKinds, ...]

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of data that can be in it, sorted."""
        return tuple(sorted({kind for topic in self.topics for kind in topic.kinds}))

    @property
    def suggested(self) -> dict[str, Confidence]:
        """The kinds that its types suggest, sorted, each with the surest confidence."""
        return surest(rule for topic in self.topics for rule in topic.suggested)

    @property
    def open_topics(self) -> tuple[str, ...]:
        """The topics of which nobody can say what is in them."""
        return tuple(topic.topic.name for topic in self.topics if topic.unknown)

    @property
    def verdict(self) -> BagVerdict:
        """The answer to 'may I share it?' as far as there is one: what is not known is never left out (S11, S12).

        >>> topic = BagTopic("/camera")
        >>> [str(JudgedBag(Bag("a", gaps=gaps), (TopicKinds(topic),)).verdict) for gaps in ((), ("cut",))]
        ['nothing-found', 'undetermined']
        """
        if self.kinds:
            return BagVerdict.PERSONAL_DATA
        known = self.bag.complete and not self.open_topics and not self.bag.extras
        return BagVerdict.NOTHING_FOUND if known else BagVerdict.UNDETERMINED


@dataclass(frozen=True, slots=True)
class SharedTopic:
    """A topic of a bag, as it is kept in a copy that may be shared, or left out of it.

    Attributes
    ----------
    messages
        How many were copied, or left out; None where nobody counted them.
    reason
        Why it is kept, or left out, in a few words.
    """

    judged: TopicKinds
    messages: int | None
    reason: str


@dataclass(frozen=True, slots=True)
class SharedBag:
    """A bag with its copy that may be shared.

    Attributes
    ----------
    copy
        Where the copy is; empty where no topic could be copied, so that there is none.
    without
        Names of the categories that it is to be without; empty for all.
    topics, omitted
        What was copied, and what was left out; sorted by name.
    extras
        What was left out beside messages, such as attachments.
    """

    bag: str
    copy: str
    without: tuple[str, ...]
    topics: tuple[SharedTopic, ...]
    omitted: tuple[SharedTopic, ...]
    extras: tuple[str, ...]

    @property
    def messages(self) -> int:
        """How many messages are in the copy."""
        return sum(topic.messages or 0 for topic in self.topics)
