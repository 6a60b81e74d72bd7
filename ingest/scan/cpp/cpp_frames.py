"""What a value of C++ can be, and what a function runs with: plain data, and how names are put together.

Made by ``cpp_values.py``, and read by ``cpp_nodes.py``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.scan.scan_facts import LITERAL, Name, NamePiece

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.ingest.scan.cpp.cpp_expressions import Construction, Expression
    from rosprivacy.ingest.scan.cpp.cpp_units import CppClass, Function


class Binding(NamedTuple):
    """What a function is called with.

    Attributes
    ----------
    at
        Byte of the call.
    """

    arguments: tuple[Expression, ...]
    types: tuple[str, ...]
    frame: Frame
    at: int


class Frame(NamedTuple):
    """A function while it runs.

    Attributes
    ----------
    key
        What tells it from others of one solution.
    object
        Whose method it is.
    binding
        What it is called with; None where that is not settled yet.
    """

    function: Function
    key: tuple[object, ...]
    object: Thing | None = None
    binding: Binding | None = None
    depth: int = 0


class Thing(NamedTuple):
    """An object.

    Attributes
    ----------
    type
        Of the checkout the name of its class, of others the whole name.
    of_class
        Of the checkout.
    construction, frame
        Where it is made, as far as it is settled.
    """

    type: str
    types: tuple[str, ...]
    key: tuple[object, ...]
    of_class: CppClass | None = None
    construction: Construction | None = None
    frame: Frame | None = None


class Elements(NamedTuple):
    """A container with what its elements can be."""

    of: tuple[tuple[Value, ...], ...]


Value = Name | Thing | Elements


class Unsettled(Exception):  # noqa: N818 - of the field
    """What the answer hangs on: one of several callers, or makers."""

    def __init__(self, key: tuple[object, ...], options: Sequence[Binding | None]) -> None:
        super().__init__()
        self.key, self.options = key, options


class TooManySteps(Exception):  # noqa: N818 - of the field
    """A value is made in more steps than are followed."""


def text_name(text: str) -> Name:
    """Return a name that the code fixes."""
    return (NamePiece(text),)


def joined(pieces: Iterable[NamePiece]) -> Name:
    """Return a name with literal pieces that stand side by side made one."""
    result: list[NamePiece] = []
    for piece in pieces:
        last = result[-1] if result else None
        if last and last.basis == piece.basis == LITERAL and last.text is not None and piece.text is not None:
            result[-1] = NamePiece(last.text + piece.text)
        elif piece.text != "" or piece.parameter:
            result.append(piece)
    return tuple(result) or text_name("")


def unique(values: Iterable[Value]) -> list[Value]:
    """Return values, names once each."""
    result: list[Value] = []
    names: set[Name] = set()
    for one in values:
        if isinstance(one, Thing | Elements):
            result.append(one)
        elif one not in names:
            names.add(one)
            result.append(one)
    return result
