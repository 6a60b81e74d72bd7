"""What is read in one file of source code: comments, classes, calls that make a node or an end of a channel, and uses.

Made by ``python_code.py`` and ``cpp_code.py``, which walk over their trees with ``walk``. Nothing is run, built or
guessed: what is no literal has no name.
"""

from __future__ import annotations

import re
from itertools import takewhile
from time import thread_time
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from rosprivacy.analysis.suggesting.library_rules import PROGRAM

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from rosprivacy.analysis.errors import InputError

    Item = TypeVar("Item")
    Piece = TypeVar("Piece")
    Place = TypeVar("Place")

NODE = "node"
INTERFACES = ("msg", "srv", "action")
CLASS = "class "
NODE_CLASSES = ("Node", "LifecycleNode")  # of rclpy, rclcpp, rclcpp_lifecycle, nav2_util
SECONDS = 120.0  # of processor time for one file; the largest that is read takes a quarter of it
OFTEN = 100  # items between two looks at the clock
LONGEST_USE = 200  # signs of a name that is used: no library has a longer one
WRITES = ("publish", "reply", "request", "execute", "call")  # roles of what sends something into its channel
BEFORE = ("sudo", "exec", "nohup", "env")  # words before the program itself
WITH_COMMANDS = ("ros2", "rosbag", "git")  # programs of which the next words say what they do
LONGEST = 3  # words that are kept of these: ros2 bag record
FLEET_CONTROL = "vda5050"  # what code uses that names its topics
_FLEET_TOPIC = re.compile(  # interface/v2/manufacturer/serial number/order; instantActions is called so nowhere else
    r"(?:^|/)v[23](?:[._]\d+)*/[^/\s]+/[^/\s]+/"
    r"(?:order|instantActions|state|visualization|connection|factsheet|responses|zoneSet)$|^(?:\S*/)?instantActions$"
)
WORD = re.compile(r"[A-Za-z_][\w.-]*", re.ASCII)


class SourceLines(NamedTuple):
    """From one line of a file to another, both included."""

    first: int
    last: int


class SourceComment(NamedTuple):
    """One line of a comment.

    Attributes
    ----------
    text
        Without the signs that make it a comment.
    alone
        Whether no code stands before it on its line.
    """

    line: int
    text: str
    alone: bool


class NodeClass(NamedTuple):
    """A class.

    Attributes
    ----------
    bases
        Last names of the classes that it is derived from.
    """

    name: str
    bases: tuple[str, ...]
    lines: SourceLines


class CallSite(NamedTuple):
    """A class, or a call, that an annotation can stand beside.

    Attributes
    ----------
    kind
        ``node``, ``topic``, ``service`` or ``action``.
    written
        The name, if it is a literal.
    lines, statement
        Of the class's head or the call; of the whole statement that it is a part of.
    owner
        Of a channel: what makes it; of a node: what it is known by. A class, or a variable with where it is known.
    role
        Of a channel: ``publish``, ``subscribe``, ``reply``, ``request``, ``execute``, ``call``.
    type
        Of a channel: its message type, ``pkg/msg/Name``, where imports tell it.
    namespace
        Of a node: as it is written; None where it is no literal.
    base
        Of a node: the constructor that is called, where it is one of a class that may be no node.
    prefix
        Whether channels below this name are written with it, as image_transport does.
    head
        Whether it is the head of a class; its constructors name its nodes.
    """

    kind: str
    written: str | None
    lines: SourceLines
    statement: SourceLines
    owner: str
    role: str = ""
    type: str = ""
    namespace: str | None = ""
    base: str = ""
    prefix: bool = False
    head: bool = False


class NameUse(NamedTuple):
    """One name that code uses, as the imports of the file resolve it.

    Attributes
    ----------
    name
        ``cv2.VideoCapture``, ``cv::VideoCapture``, ``open(w)``; of a program that is started, ``$ espeak``; of what
        stands in the file itself or beside it, in Python, with a dot before it: ``.camera.Camera``.
    unit
        The class or function, at the top of the file, that it stands in; empty outside of all.
    """

    name: str
    line: int
    unit: str = ""


class SourceUnit(NamedTuple):
    """A class or function at the top of a file."""

    name: str
    lines: SourceLines


class Launch(NamedTuple):
    """What a launch file calls an executable: by literals; a name that is none is empty."""

    package: str
    executable: str
    name: str


class Script(NamedTuple):
    """An executable of a package, and the module that is run: ``talker = demo.talker:main``."""

    executable: str
    module: str


class Code(NamedTuple):
    """A file of source code.

    Attributes
    ----------
    language
        ``python`` or ``c++``; empty for what could not be read.
    uses
        What it uses of libraries, and of itself and its neighbours; each name once in a unit.
    imports
        Of Python: names, and what they stand for; ``*`` stands for all names of a module.
    """

    file: str
    language: str
    comments: tuple[SourceComment, ...] = ()
    classes: tuple[NodeClass, ...] = ()
    sites: tuple[CallSite, ...] = ()
    problems: tuple[InputError, ...] = ()
    uses: tuple[NameUse, ...] = ()
    units: tuple[SourceUnit, ...] = ()
    launches: tuple[Launch, ...] = ()
    scripts: tuple[Script, ...] = ()
    imports: tuple[tuple[str, str], ...] = ()


def class_owner(name: str) -> str:
    """Return what stands for the nodes of a class in ``CallSite.owner``; see ``class_of``.

    >>> class_owner("Camera"), class_of(class_owner("Camera")), class_of("/3:0:node")
    ('class Camera', 'Camera', '')
    """
    return f"{CLASS}{name}" if name else ""


def class_of(owner: str) -> str:
    """Return the name of a class whose nodes are meant; empty for a variable."""
    return owner.removeprefix(CLASS) if owner.startswith(CLASS) else ""


class Where(NamedTuple):
    """Where a piece of code stands.

    Attributes
    ----------
    of_class, function
        Name of the class; what tells the function from others.
    first
        Of C++: first line of the function, with its template parameters.
    statement
        Lines of the whole statement.
    target
        The variable that is given the value.
    broken, templated
        Of C++: whether it stands in what cannot be read; whether template parameters stand right before it.
    """

    of_class: str = ""
    function: str = ""
    first: int = 0
    statement: SourceLines | None = None
    target: str = ""
    broken: bool = False
    templated: bool = False


def walk(
    root: Piece, where: Place, parts: Callable[[Piece, Place], Sequence[tuple[Piece, Place]]], late: Callable[[], bool]
) -> list[tuple[Piece, Place]]:
    """Return all pieces of code in the order of the text, each with where it stands; no recursion over code.

    Parameters
    ----------
    where
        What is to be known of the root.
    parts
        What a piece is made of, from the first to the last; it is asked in the order of the text.

    Raises
    ------
    OutOfTime
        When it is late.
    """
    pieces: list[tuple[Piece, Place]] = []
    waiting = [(root, where)]
    while waiting:
        if len(pieces) % OFTEN == 0 and late():
            raise OutOfTime
        placed = waiting.pop()
        pieces.append(placed)
        waiting += reversed(parts(*placed))
    return pieces


def variable(name: str, where: Where) -> str:
    """Return what tells a variable from others of its name: its class and function."""
    return f"{where.of_class}/{where.function}:{name}"


def is_fleet_topic(text: str) -> bool:
    """Return whether a text is a topic by which VDA 5050, version 2 or 3, joins a robot to a fleet control.

    >>> is_fleet_topic("uagv/v2/maker/{}/order"), is_fleet_topic("/instantActions"), is_fleet_topic("robot/state")
    (True, True, False)
    """
    return len(text) <= LONGEST_USE and bool(_FLEET_TOPIC.search(text))


class OutOfTime(Exception):  # noqa: N818 - of the field
    """A file was not read to its end in ``SECONDS``: what it says is not known."""


def clock() -> Callable[[], bool]:
    """Return what tells whether the time for one file is over; processor time, so that a busy machine is no matter."""
    until = thread_time() + SECONDS
    return lambda: thread_time() > until


def in_time(items: Iterable[Item], late: Callable[[], bool]) -> Iterator[Item]:
    """Yield items as long as there is time.

    Raises
    ------
    OutOfTime
        When there is none left.
    """
    for number, item in enumerate(items):
        if number % OFTEN == 0 and late():
            raise OutOfTime
        yield item


def program(words: Iterable[str]) -> str:
    """Return what is started by the words of a command; empty if none is a program.

    >>> program(["sudo", "/usr/bin/arecord", "-d", "5"]), program("ros2 bag record -a".split()), program([])
    ('$ arecord', '$ ros2 bag record', '')
    """
    given = [*words][: LONGEST + 1]
    given = given[1:] if given and given[0] in BEFORE else given
    name = given[0].rpartition("/")[2] if given else ""
    if not WORD.fullmatch(name):
        return ""
    more = given[1:LONGEST] if name in WITH_COMMANDS else []
    return PROGRAM + " ".join([name, *takewhile(WORD.fullmatch, more)])
