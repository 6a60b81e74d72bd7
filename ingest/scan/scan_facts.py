"""What a checkout says of nodes, channels, launch files and the world outside ROS, each fact with its place.

Made by the readers of Python, C++, launch files, packages, descriptions and configurations; joined into systems by
``systems.py``. Nothing is run: a name is what the text fixes, and what it leaves open is said.
"""

from __future__ import annotations

import posixpath
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

LITERAL, DEFAULT, LAUNCH, DESCRIPTION, PACKAGE, GUESSED = (
    "literal",
    "default",
    "launch",
    "description",
    "package",
    "guessed",
)
BASES = (LITERAL, DESCRIPTION, LAUNCH, DEFAULT, PACKAGE, GUESSED)  # how a fact is known, from the surest
DESCRIBED = "nodl"  # the language of a node that only a description speaks of
ROLES = ("publish", "subscribe", "reply", "request", "execute", "call")
NODE_NAME, NODE_SPACE = "__node", "__ns"  # what a node is called, and where: set as parameters are


class CodePlace(NamedTuple):
    """A line of a file of the checkout; the file relative to its root, with ``/``."""

    file: str
    line: int

    def below(self, folder: str) -> CodePlace:
        """Return the same with a folder before the file."""
        return self._replace(file=posixpath.normpath(posixpath.join(folder, self.file)))


class NamePiece(NamedTuple):
    """A part of a name.

    Attributes
    ----------
    text
        What stands there: of a parameter its default; None where the sources do not say.
    basis
        How: one of ``BASES``; of an open piece ``guessed``.
    parameter
        Of the node, whose value stands there; a launch file can set it.
    why
        Of an open piece, what it depends on, for people.
    """

    text: str | None
    basis: str = LITERAL
    parameter: str = ""
    why: str = ""


Name = tuple[NamePiece, ...]  # one after the other; as the code writes it, relative or with ~


def open_name(why: str) -> Name:
    """Return a name of which nothing is known but what it depends on."""
    return (NamePiece(None, GUESSED, "", why),)


def plain_text(name: Name) -> str | None:
    """Return the text of a name; None if a piece is open."""
    texts = [piece.text for piece in name if piece.text is not None]
    return "".join(texts) if len(texts) == len(name) else None


def as_default(name: Name) -> Name:
    """Return a name that holds unless something else is given."""
    return tuple(piece._replace(basis=DEFAULT) if piece.basis == LITERAL else piece for piece in name)


def name_order(names: Iterable[Name]) -> list[list[tuple[str, str, str, str]]]:
    """Return what names are sorted by; the same each time."""
    return [[(piece.text or "", piece.basis, piece.parameter, piece.why) for piece in name] for name in names]


def sorted_names(names: Iterable[Name]) -> tuple[Name, ...]:
    """Return names in an order that is the same each time."""
    return tuple(sorted(names, key=lambda name: name_order([name])))


class CodeEndpoint(NamedTuple):
    """A call in the code that makes an end of a channel.

    Attributes
    ----------
    role
        One of ``ROLES``: what a policy would have to allow.
    names
        What the channel may be called, each alternative once, sorted; one with an open piece is a gap.
    type
        ``pkg/msg/Name``; empty where the sources do not say.
    below
        Whether channels below the name belong to it, as image_transport makes them.
    """

    place: CodePlace
    role: str
    names: tuple[Name, ...]
    type: str = ""
    below: bool = False


class CodeWrapper(NamedTuple):
    """An object of a class of another package that makes ends of channels by itself, such as ``BasicNavigator``."""

    place: CodePlace
    name: str


class External(NamedTuple):
    """What lies outside ROS and with which code exchanges data.

    Attributes
    ----------
    name, sort
        Such as ``twilio`` and ``cloud``; sorts: cloud, language-model, speech, vision, broker, database, file, socket,
        web-server, http, screen, loudspeaker, process, compose, bridge.
    incoming, outgoing
        Seen from the robot.
    stated
        Whether a file states it (compose, a bridge's configuration); otherwise the use of a library suggests it.
    channels
        Of a bridge or broker, what goes there by its configuration, as it is written: names, or patterns of them.
    """

    place: CodePlace
    name: str
    sort: str
    incoming: bool = False
    outgoing: bool = True
    stated: bool = False
    channels: tuple[str, ...] = ()


class LogCall(NamedTuple):
    """A call of a logger with a value that is a message's field, or made of one.

    Attributes
    ----------
    channels
        Names, as in ``CodeEndpoint.names``, of the subscriptions whose data is logged.
    words
        The value as it is written in the code, without literals.
    """

    place: CodePlace
    channels: tuple[Name, ...]
    words: str


class CodeNode(NamedTuple):
    """A class or function that makes one node, with what its base classes and helpers in the checkout make for it.

    Attributes
    ----------
    name
        Of the class, or of the function where there is none.
    language
        ``python`` or ``c++``; ``nodl`` of a node that only a description speaks of.
    plugin
        Of a C++ component, the class with its namespace: ``demo::Talker``. Of a description, ``package/executable``.
    names, namespaces
        What the code calls the node, and where it puts it; empty where it says nothing.
    parameters
        Name -> default as text, of those that the code declares with one.
    described
        By which descriptions, beside the code.
    """

    place: CodePlace
    name: str
    language: str
    names: tuple[Name, ...]
    namespaces: tuple[Name, ...] = ()
    plugin: str = ""
    endpoints: tuple[CodeEndpoint, ...] = ()
    wrappers: tuple[CodeWrapper, ...] = ()
    externals: tuple[External, ...] = ()
    logs: tuple[LogCall, ...] = ()
    parameters: Mapping[str, str] = {}
    described: tuple[CodePlace, ...] = ()


class Gap(NamedTuple):
    """What a scan could not resolve.

    Attributes
    ----------
    sort
        ``name`` (of a channel), ``node`` (its name), ``node-of`` (of which node an end is), ``file`` (unreadable,
        in another language, a link that leads out), ``include`` (of what is not there or cannot be told),
        ``started`` (a node whose code and interface are not known), ``outside`` (what is exchanged with the world),
        ``system`` (code that the launch file does not start), ``description`` (only that is known of a node),
        ``wrapper``, ``remap``, ``parameter``.
    text
        For people: what is not known, and what it depends on.
    """

    place: CodePlace
    sort: str
    text: str


class CodeFacts(NamedTuple):
    """What the sources of one language say."""

    nodes: tuple[CodeNode, ...] = ()
    gaps: tuple[Gap, ...] = ()


class Executable(NamedTuple):
    """What a package runs under a name.

    Attributes
    ----------
    name
        Of an executable; of a component the class with its namespace (``demo::Talker``).
    files
        The sources that it is made of, relative to the root; of Python the module with ``main``.
    unit
        The function that is called (``main``), where the package says it; of an executable that CMake makes for a
        component, its class.
    """

    package: str
    name: str
    files: tuple[str, ...]
    unit: str = ""


class StartedNode(NamedTuple):
    """A node that a launch file starts, with one of the values that its arguments and conditions allow.

    Attributes
    ----------
    package, executable
        Of a component, the class with its namespace is the executable.
    name, namespace
        None where the launch file gives none. The namespace is whole, pushed ones before it.
    remaps
        (from, to), as they are written, in order.
    parameters
        Name -> value as text, from the launch file and the parameter files that it names.
    conditional
        Whether it starts only under a condition that can be false.
    basis
        ``literal`` or ``default`` (of a launch argument).
    open_parameters
        Names of those that are set to what the sources do not say: the default in the code is not their value.
    parameters_by_node
        (pattern of full names, parameter, value) of parameter files, where the launch file does not name the node;
        see ``parameter_files.fits``.
    arguments
        What else stands on its command line.

    What the sources leave open of a text stands in braces, and is a gap.
    """

    place: CodePlace
    package: str
    executable: str
    name: str | None = None
    namespace: str | None = None
    remaps: tuple[tuple[str, str], ...] = ()
    parameters: tuple[tuple[str, str], ...] = ()
    conditional: bool = False
    basis: str = LITERAL
    open_parameters: tuple[str, ...] = ()
    parameters_by_node: tuple[tuple[str, str, str], ...] = ()
    arguments: tuple[str, ...] = ()


class LaunchedSystem(NamedTuple):
    """What a top-level launch file starts, with all that it includes.

    Attributes
    ----------
    file
        The launch file, relative to the root.
    started
        In the order of the text; every alternative.
    included
        Launch files of the checkout that were read for it.
    gaps
        Includes, names and values that could not be resolved.
    """

    file: str
    started: tuple[StartedNode, ...]
    included: tuple[str, ...] = ()
    gaps: tuple[Gap, ...] = ()
