"""A bag, and kinds of data that nobody else is to get -> the copy that may be shared, with what is in it and what not.

In: the path of a bag, names of categories, policies, label files. Out: one MCAP file, whole or not at all, and
``SharedAnswer``. Only topics are copied of which people said what can be in them, and of which that cannot be one of
the kinds: neither narrower nor broader nor overlapping (S7, S11). All else is left out by name. Messages are passed on
as they lie in the bag, never decoded; what was written is read again before it gets its name.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, cast

from rosprivacy.analysis.errors import BagError, InputError, InputErrors, OntologyError, shown
from rosprivacy.analysis.model.recording import BagTopic, SharedBag, SharedTopic, TopicKinds
from rosprivacy.bags import NO_MESSAGE, answer_bags
from rosprivacy.ingest.policies.names import EVENTS
from rosprivacy.ingest.running.bag_folders import MCAP, NAME, PACKED, MissingLibraryError
from rosprivacy.ingest.running.bag_messages import messages_of
from rosprivacy.question import question_of
from rosprivacy.report.atomic import check_outputs, write_texts
from rosprivacy.report.shared_bag import shared_bag_document
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model.recording import Bag, JudgedBag
    from rosprivacy.ingest.running.recorded_file import RecordedChannel, RecordedMessage, RecordedSchema
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.schemas.bags import SharedBagDocument
    from rosprivacy.settings import Settings

ALL = "all"
OF_NODES = ("/rosout", "/parameter_events", EVENTS)  # how topics end that tell what nodes say, hold or are asked
ZSTANDARD = b"\x28\xb5\x2f\xfd"  # how data begin that are compressed; CDR begins with 0
CDR = "cdr"
MOST_CHANNELS = 65_000  # MCAP numbers them with 16 bits
PROFILE = "ros2"


@dataclass(frozen=True, slots=True)
class SharedAnswer:
    """A bag with its copy.

    Attributes
    ----------
    assumptions
        What it rests on (S12).
    """

    shared: SharedBag
    assumptions: Mapping[str, Any]

    def document(self) -> SharedBagDocument:
        """Return the document ``rosprivacy.shared-bag/1``."""
        return shared_bag_document(self.shared, self.assumptions)


def share_bag(
    bag: str,
    without: Sequence[str],
    output: Path,
    policies: tuple[str, ...],
    labels: tuple[str, ...],
    settings: Settings,
) -> SharedAnswer:
    """Write the copy of a bag without some kinds of data; where no topic can be copied, nothing is written.

    Parameters
    ----------
    without
        Names of categories, or ``all``.

    Raises
    ------
    InputErrors, InputError
        With every problem of what is named; a bag that is not whole is one. What was at ``output`` is then untouched.
    """
    _check_library(output)
    vocabulary = question_of(settings).vocabulary
    kinds = _kinds(without, vocabulary)
    answer = answer_bags([bag], policies, labels, settings)
    if len(answer.bags) != 1:
        raise BagError(bag, 0, f"a folder of {len(answer.bags)} bags", "name one of them")
    (judged,) = answer.bags
    _check_whole(judged.bag)
    _check_output(output, judged.bag)
    reasons = {topic.topic.name: reason_against(topic, kinds, vocabulary.hierarchy) for topic in judged.topics}
    counts: Counter[str] = Counter()
    extras: set[str] = set(judged.bag.extras)
    topics = {name for name, reason in reasons.items() if not reason}
    written = _write(judged.bag, topics, output, counts, extras)
    shared = _summary(judged, kinds, reasons, counts, str(output) if written else "", extras)
    return SharedAnswer(shared, answer.assumptions)


def _kinds(names: Sequence[str], vocabulary: Vocabulary) -> tuple[str, ...]:
    """The categories of some names; none for all kinds."""
    found = {name: vocabulary.find(name) for name in names if name != ALL}
    problems = [
        OntologyError("--without", 0, f"unknown category {shown(name)!r}", vocabulary.hint(name))
        for name, category in found.items()
        if category is None
    ]
    if problems:
        raise InputErrors(problems)
    return () if ALL in names else tuple(sorted({category.name for category in found.values() if category}))


def _check_library(output: Path) -> None:
    if not (find_spec("mcap") and find_spec("zstandard")):
        what = "the copy is an MCAP file, which needs a library that is not installed"
        raise MissingLibraryError(str(output), 0, what, "install the extra 'bags'")


def _check_whole(bag: Bag) -> None:
    """Refuse a bag of which something is missing, or whose messages another program could not read in the copy."""
    hint = "a copy needs the whole of it: repair it first (`ros2 bag reindex`, `mcap recover`)"
    problems: list[InputError] = [BagError(bag.path, 0, f"not complete: {gap}", hint) for gap in bag.gaps]
    problems += [
        BagError(file, 0, "compressed as a whole", "unpack it first")
        for file in bag.files
        if file.lower().endswith(PACKED)
    ]
    if bag.compression.endswith("(message)"):
        problems.append(_packed(bag.path))
    if problems:
        raise InputErrors(problems)


def _packed(path: str) -> BagError:
    what = "its messages are compressed one by one, which an MCAP file cannot say"
    return BagError(path, 0, what, "convert it first (`ros2 bag convert`)")


def _check_output(output: Path, bag: Bag) -> None:
    if output.suffix.lower() != MCAP:
        raise InputError(
            str(output), 0, "the copy is an MCAP file", f"call it so: {shown(output.stem or 'shared')}{MCAP}"
        )
    (target,) = check_outputs([output])
    if target.stream:
        raise InputError(str(output), 0, "no regular file", "name a file, since what is written is read again")
    path = Path(bag.path)
    folder = path.parent if path.name == NAME else path
    if folder.is_dir() and target.file.parent == folder.resolve():
        raise InputError(str(output), 0, "lies in the recording that is copied", "name a file outside of it")


def reason_against(judged: TopicKinds, kinds: Collection[str], hierarchy: Hierarchy) -> str:
    """Return why a topic is not known to be without some kinds of data; empty if it is known.

    Parameters
    ----------
    kinds
        Names of categories; none for all kinds.

    Examples
    --------
    >>> from rosprivacy.ontology.vocabulary import load
    >>> topic, hierarchy = BagTopic("/scan", messages=1), load().hierarchy
    >>> reason_against(TopicKinds(topic, ("Location",), bound=("Location",)), ["Video"], hierarchy)
    ''
    >>> reason_against(TopicKinds(topic, ("Location",)), ["Video"], hierarchy)
    'nobody says that it carries nothing but Location'
    """
    return next(_reasons(judged, kinds, hierarchy), "")


def _reasons(judged: TopicKinds, kinds: Collection[str], hierarchy: Hierarchy) -> Iterator[str]:
    """All that keeps a topic out of a copy, the plainest first."""
    if judged.topic.messages == 0:
        yield NO_MESSAGE
    if judged.unknown:
        yield judged.unknown
    carried = _overlapping({*judged.kinds, *(judged.bound or ())}, kinds, hierarchy)
    if carried:
        yield f"{', '.join(carried)} can be in it: {judged.why}"
    if judged.bound is None:
        yield judged.doubt or f"nobody says that it carries nothing but {', '.join(judged.kinds) or 'that'}"
    if not judged.labelled:
        suggested = _overlapping(judged.surest, kinds, hierarchy)
        if suggested:
            yield f"no label of the topic itself, and its type suggests {', '.join(suggested)}"
        if f"/{judged.topic.name}".endswith(OF_NODES):
            yield "it tells what nodes say, hold or are asked, and no label of the topic itself speaks of it"


def _overlapping(names: Iterable[str], kinds: Collection[str], hierarchy: Hierarchy) -> list[str]:
    """Those of some categories whose data can be of the kinds."""
    return sorted(
        name for name in names if not kinds or any(hierarchy.overlap(name, kind) is not None for kind in kinds)
    )


def _write(bag: Bag, topics: Collection[str], output: Path, counts: Counter[str], extras: set[str]) -> bool:
    """Write the messages of some topics; whether there was one. All messages are counted, by topic."""
    files = sorted(bag.files, key=lambda file: (len(file), file))  # run_2 before run_10
    messages = _copied(bag.path, messages_of(files, extras), topics, counts)
    first = next(messages, None)
    if first is None:
        return False
    pieces = _pieces(bag.path, chain([first], messages))
    write_texts([(output, pieces)], check=lambda file: _check_copy(file, output, topics, counts))
    return True


def _copied(
    path: str, messages: Iterable[RecordedMessage], topics: Collection[str], counts: Counter[str]
) -> Iterator[RecordedMessage]:
    for message in messages:
        topic = message.channel.topic
        counts[topic] += 1
        if topic in topics:
            if message.channel.encoding == CDR and message.data.startswith(ZSTANDARD):
                raise _packed(path)
            yield message


class _Buffer:
    """What the writer of MCAP takes for a file: bytes that are handed on as soon as they are there."""

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self._size = 0

    def write(self, data: bytes) -> int:
        """Take bytes."""
        self._pieces.append(data)
        self._size += len(data)
        return len(data)

    def tell(self) -> int:
        """Return how many bytes were written."""
        return self._size

    def pieces(self) -> list[bytes]:
        """Return what came since the last time."""
        pieces, self._pieces = self._pieces, []
        return pieces


def _pieces(path: str, messages: Iterable[RecordedMessage]) -> Iterator[bytes]:
    """The bytes of an MCAP file with some messages."""
    from mcap.writer import Writer  # noqa: PLC0415 - an extra

    buffer = _Buffer()
    writer = Writer(cast("IO[bytes]", buffer))
    writer.start(PROFILE, f"rosprivacy {__version__}")
    schemas: dict[RecordedSchema | None, int] = {None: 0}
    channels: dict[RecordedChannel, int] = {}
    for message in messages:
        channel = message.channel
        if channel not in channels:
            if len(channels) > MOST_CHANNELS:
                raise BagError(path, 0, f"more than {MOST_CHANNELS:,} channels", "split it first")
            schema = channel.schema
            if schema and schema not in schemas:
                schemas[schema] = writer.register_schema(*schema)
            facts = (channel.topic, channel.encoding, schemas[schema], dict(channel.metadata))
            channels[channel] = writer.register_channel(*facts)
        times = (message.log_time, message.data, message.publish_time, message.sequence)
        writer.add_message(channels[channel], *times)
        yield from buffer.pieces()
    writer.finish()  # type: ignore[no-untyped-call] # it has no types
    yield from buffer.pieces()


def _check_copy(file: Path, output: Path, topics: Collection[str], counts: Counter[str]) -> None:
    """Hold what was written against what was to be written, before it gets its name."""
    from rosprivacy.ingest.running.mcap_messages import mcap_messages  # noqa: PLC0415 - an extra

    extras: set[str] = set()
    copied = Counter(message.channel.topic for message in mcap_messages(str(file), extras))
    if extras or copied != {topic: count for topic, count in counts.items() if topic in topics}:
        what = "read again, it has other topics or messages than were to be written, so it is not kept"
        raise InputError(str(output), 0, what, "check the disk, and run the command again")


def _summary(
    judged: JudgedBag,
    kinds: tuple[str, ...],
    reasons: Mapping[str, str],
    counts: Mapping[str, int],
    copy: str,
    extras: Collection[str],
) -> SharedBag:
    topics, omitted = [], []
    known = {topic.topic.name for topic in judged.topics}
    for topic in judged.topics:
        name, count = topic.topic.name, counts.get(topic.topic.name, 0)
        if count and not reasons[name]:
            topics.append(SharedTopic(topic, count, _rests_on(topic)))
        else:
            omitted.append(SharedTopic(topic, count, reasons[name] or NO_MESSAGE))
    for name in sorted(counts.keys() - known):
        what = "what the bag says of itself does not name it"
        omitted.append(SharedTopic(TopicKinds(BagTopic(name)), counts[name], what))
    omitted.sort(key=lambda topic: topic.judged.topic.name)
    return SharedBag(judged.bag.path, copy, kinds, tuple(topics), tuple(omitted), tuple(sorted(extras)))


def _rests_on(judged: TopicKinds) -> str:
    """Why a topic is in the copy: what can be in it, and what its types suggest although a person's label stands."""
    kinds = f"{', '.join(judged.bound)}; " if judged.bound else ""
    questions = ", ".join(f"{kind} ({sure})" for kind, sure in judged.surest.items())
    return f"{kinds}{judged.why}" + (f"; its type suggests {questions}" if questions else "")
