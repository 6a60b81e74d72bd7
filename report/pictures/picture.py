"""A picture before it is drawn: boxes and lines, what they mean, nothing of colours, formats or places.

Made by ``views.py`` and ``query_view.py``, narrowed by ``narrow.py``, written by ``dot.py`` and
``exports.py``.
"""

from __future__ import annotations

from collections.abc import Iterable  # noqa: TC003 - of a default
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rosprivacy.analysis.model import CHANNELS, KINDS
from rosprivacy.report.catalogs.words import IN_ENGLISH, Words, plain

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.model import Element, Place

Key = tuple[str, str, str]  # robot, kind, name: the identity of an element, rule S1
ROS, PRIVACY = "ros", "privacy"
RECORD = "record"  # what a query gives from the database that is no element
GROUP = "group"  # several elements as one box
DRAWN = (*KINDS, RECORD, GROUP)
LEGIBLE = 40  # boxes of a picture that people read without being asked


def order(key: Key) -> tuple[int, str, str]:
    """Nodes first, then by robot and name: the order of all output (rule S14)."""
    return (DRAWN.index(key[1]), key[0], key[2])


@dataclass(frozen=True, slots=True)
class Box:
    """One element: a service or action whatever its legs, a wildcard with both its sides.

    Attributes
    ----------
    key
        Identity of the element; of the first one where several are drawn as one.
    names
        Full names, as they are in the input; several where channels with the same ends are drawn as one.
    look
        What it is coloured by: its kind in the ROS graph view, its role in the privacy view.
    words
        Short lines below the name: what labels say, what it carries.
    open
        Whether it is not reviewed, for one category at least (rule S11).
    group
        Name of what it is drawn inside of; empty for none.
    pattern
        Whether the name is a wildcard (rule S4).
    types
        Message types of a channel.
    """

    key: Key
    names: tuple[str, ...]
    look: str
    words: tuple[str, ...] = ()
    open: bool = False
    group: str = ""
    pattern: bool = False
    types: tuple[str, ...] = ()

    @classmethod
    def of(cls, element: Element, look: str) -> Box:
        """Draw an element."""
        return cls(element.identity, (element.name,), look, pattern=element.pattern)

    @property
    def robot(self) -> str:
        """Empty where there is only one."""
        return self.key[0]

    @property
    def kind(self) -> str:
        """One of ``DRAWN``."""
        return self.key[1]

    @property
    def is_channel(self) -> bool:
        """Whether this is a topic, service or action."""
        return self.key[1] in CHANNELS


@dataclass(frozen=True, slots=True)
class PictureLine:
    """All flows of one look from one box to another.

    Attributes
    ----------
    look
        ``allowed``, ``matches`` or ``denied``; in the privacy view ``data``, ``way`` (to a leak), ``shortest``
        or ``cleaned`` (it ends there, as a label says); ``other`` for what a query gives that is no flow; ``beyond``
        what no profile of its node allows, ``onward`` where data goes only then (rule S6).
    roles
        Of the flows, sorted.
    carries
        Categories that go along it, sorted; in the privacy view only.
    pseudonymised
        Whether all that goes along it is so.
    places
        The policy lines behind it, sorted.
    length
        Of the shortest way to a leak through it, in flows; 0 where it is on none.
    words
        What stands on it; empty where the legend says enough.
    """

    source: Key
    target: Key
    look: str
    roles: tuple[str, ...] = ()
    carries: tuple[str, ...] = ()
    pseudonymised: bool = False
    places: tuple[Place, ...] = ()
    length: int = 0
    words: str = ""

    def sort_key(self) -> tuple[object, ...]:
        """By its ends."""
        return (order(self.source), order(self.target), self.look, self.words)


@dataclass(frozen=True, slots=True)
class Picture:
    """What is drawn.

    Attributes
    ----------
    view
        ``ros`` or ``privacy``.
    title
        One sentence.
    notes
        What a reader has to know to read it: what was left out, what it rests on.
    ways
        The shortest ways to leaks in words, for readers who do not see the picture.
    core
        What lies on these ways: no smaller picture leaves it out.
    words
        Of the language in which it is told.
    """

    view: str
    title: str
    boxes: tuple[Box, ...]
    lines: tuple[PictureLine, ...]
    notes: tuple[str, ...] = ()
    ways: tuple[str, ...] = ()
    core: frozenset[Key] = frozenset()
    words: Words = IN_ENGLISH
    keys: Mapping[Key, str] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "keys", {box.key: f"n{number}" for number, box in enumerate(self.boxes)})

    def say(self, key: str, **values: object) -> str:
        """Return a sentence in the picture's language, with plain spaces."""
        return plain(self.words(key, **values))

    def count(self, number: int, noun: str) -> str:
        """Return how many of a thing there are, in the picture's language."""
        return plain(self.words.count(number, noun))

    def part(self, keys: Collection[Key], note: str = "") -> Picture:
        """Return the picture of some boxes and the lines between them."""
        boxes = tuple(box for box in self.boxes if box.key in keys)
        lines = tuple(line for line in self.lines if line.source in keys and line.target in keys)
        notes = (*self.notes, *([note] if note else []))
        return replace(self, boxes=boxes, lines=lines, notes=notes, core=self.core & {box.key for box in boxes})

    def noted(self, *notes: str) -> Picture:
        """Return the picture with something more to know."""
        return replace(self, notes=(*self.notes, *notes))


def sorted_boxes(boxes: Iterable[Box]) -> tuple[Box, ...]:
    """Sort as all output is."""
    return tuple(sorted(boxes, key=lambda box: order(box.key)))


def sorted_lines(lines: Iterable[PictureLine]) -> tuple[PictureLine, ...]:
    """Sort as all output is."""
    return tuple(sorted(lines, key=PictureLine.sort_key))
