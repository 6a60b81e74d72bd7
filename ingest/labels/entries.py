"""What label files say, before it is joined to a graph: entries about elements and flows, and which of two outranks.

Made by ``label_reader.py``; ``binding.py`` and ``add_non_ros.py`` join it to the graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.durations import Duration
from rosprivacy.analysis.model import GLOB, NAME, SEGMENT, STANDARD, UNSTATED
from rosprivacy.analysis.written_names import GLOB_SIGNS, LITERAL, bare_name, is_glob
from rosprivacy.ingest.policies.names import covers, literals

if TYPE_CHECKING:
    from rosprivacy.analysis.model import MessageType, NonRosFacts, Place, Processing, Statement
    from rosprivacy.analysis.model.recording import Bag
    from rosprivacy.ontology.vocabulary import Vocabulary

SECTIONS = {
    "nodes": ("node",),
    "channels": ("topic", "service", "action"),
    "topics": ("topic",),
    "services": ("service",),
    "actions": ("action",),
}
END_KINDS = ("node", "topic", "service", "action")
BAG = "bag"  # the recording that a storage is
LONGEST_NAME = 200  # characters of the name of an element outside ROS
LOG = "rosout"  # the log of ROS holds text: it is no harmless channel of what can be said in words (rule S13)
TEXT = frozenset({"text", "identifier"})
Limit = tuple[str, Duration]  # category, how long it may be kept
EXACT = 1_000_000  # a name outranks every glob
PROPOSED, SHIPPED, OWN = -1, STANDARD, 1  # tiers: infrastructure, standard channels, a person's own word (rule S13)
ROBOT = EXACT // 2  # added for a robot of a fleet, which outranks its model between names or between globs (rule S7)
FORMER_ROBOT = 2 * EXACT  # what databases of earlier versions have added: there a robot's glob outranked a model's name


class Entry(NamedTuple):
    """What is said of the elements of some kinds that a name or glob covers.

    Attributes
    ----------
    subjects
        Of a source: whom its data are about, in a person's words.
    contexts
        Of a source: where it works, some of ``CONTEXTS``.
    processing
        What the data there are processed for, and on which basis.
    rank
        Of the name, as of the statements.
    types
        Of channels: their message types, as a person states them for all writers (rule S15).
    """

    kinds: tuple[str, ...]
    name: str
    place: Place
    statements: tuple[Statement, ...]
    subjects: tuple[str, ...] = ()
    processing: Processing = UNSTATED
    rank: tuple[int, int] = (0, 0)
    contexts: tuple[str, ...] = ()
    types: tuple[MessageType, ...] = ()


class End(NamedTuple):
    """An end of a flow: a name or a glob, and which kind of element it means, where that is said (rule S9)."""

    name: str
    kind: str = ""


class FlowEntry(NamedTuple):
    """What is said of the flows from one element to another, by names or globs.

    One with an end outside ROS is stated by it; others are in the policies.

    Attributes
    ----------
    kinds
        Of source and target, where the line says it; else empty.
    """

    source: str
    target: str
    place: Place
    statements: tuple[Statement, ...]
    kinds: tuple[str, str] = ("", "")

    @property
    def ends(self) -> tuple[End, End]:
        """Source and target."""
        return End(self.source, self.kinds[0]), End(self.target, self.kinds[1])


class Stated(NamedTuple):
    """An element outside ROS as a file states it.

    Attributes
    ----------
    outside
        Without limits.
    between
        The nodes, or channels, that it joins, in both directions.
    bags
        Of a storage: the recordings that it is.
    """

    kind: str
    name: str
    outside: NonRosFacts
    between: tuple[End, ...] = ()
    bags: tuple[Bag, ...] = ()

    @property
    def place(self) -> Place:
        """Where it is stated."""
        return self.outside.place


def is_non_ros(name: str) -> bool:
    """Return whether a name is one of an element outside ROS; names of ROS begin with ``/``, a glob sign or ``=``."""
    return not name.startswith(("/", LITERAL, *GLOB_SIGNS))


def specificity(name: str) -> int:
    """Return the rank of a name among those that cover an element: the more that is spelt out, the higher.

    >>> specificity("/robot/*") < specificity("/robot/cam*") < specificity("/a") == specificity("=/*")
    True
    """
    return literals(name) if is_glob(name) else EXACT


def as_ranked_now(stored: int) -> int:
    """Return the rank of a name as a database has it, which an earlier version may have written.

    >>> as_ranked_now(FORMER_ROBOT + 4) == ROBOT + 4, as_ranked_now(EXACT)
    (True, 1000000)
    """
    return stored - FORMER_ROBOT + ROBOT if stored >= FORMER_ROBOT else stored


def naming(name: str) -> str:
    """Return how a label names elements: by a full name, a glob with its last segment written out, or another glob.

    >>> naming("/camera/rosout"), naming("*/rosout"), naming("/camera/*"), naming("*rosout"), naming("=/camera/*")
    ('name', 'segment', 'glob', 'glob', 'name')
    """
    if not is_glob(name):
        return NAME
    _, slash, last = name.rpartition("/")
    return SEGMENT if slash and last and not is_glob(last) else GLOB


def is_log(name: str) -> bool:
    """Return whether a name or glob covers the log of some namespace.

    >>> [is_log(name) for name in ("*/rosout", "=/a/rosout", "/*", "/rosout_agg", "*/clock")]
    [True, True, True, False, False]
    """
    return covers(bare_name(name).rpartition("/")[2], LOG)


def without_text(vocabulary: Vocabulary) -> tuple[str, ...]:
    """Return the broadest kinds of which neither they nor a narrower one is text or an identifier.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> kinds = without_text(load())
    >>> [name in kinds for name in ("PersonImage", "SpeechTranscript", "Location", "PersonalData")]
    [True, False, False, False]
    """
    above = vocabulary.hierarchy.ancestors
    texts = {name for name, kind in vocabulary.categories.items() if TEXT.intersection(kind.data_types)}
    holds = {broader for name in texts for broader in above[name]}
    return tuple(sorted(name for name in above if name not in holds and holds.issuperset(above[name].keys() - {name})))
