"""What an expression of Python code can be: the sorts of values that ``python_values.py`` tells apart."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.python_code import dotted
from rosprivacy.ingest.scan.python.python_texts import MANY, literal

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.ingest.scan.python.python_scopes import PythonFile, Scope
    from rosprivacy.ingest.scan.scan_facts import Name

LARGEST = 10**6  # of a number that is counted with


class Text(NamedTuple):
    """A string, with what is open in it."""

    pieces: Name


class Plain(NamedTuple):
    """A constant that is no string."""

    value: int | float | bool | None


class Items(NamedTuple):
    """A list, tuple or set; each item as it is written, or as its values."""

    items: tuple[Item, ...]


class Pairs(NamedTuple):
    """A dictionary."""

    pairs: tuple[tuple[Item, Item], ...]


class ClassValue(NamedTuple):
    """A class of the checkout."""

    scope: Scope


class FunctionValue(NamedTuple):
    """A function of the checkout, and the object whose method it is."""

    scope: Scope
    me: Instance | None = None


class ModuleValue(NamedTuple):
    """A file of the checkout."""

    file: PythonFile


class Instance(NamedTuple):
    """An object of a class of the checkout.

    Attributes
    ----------
    origin
        The call that makes it; None where any may be meant.
    """

    scope: Scope
    origin: Run | None = None


class Library(NamedTuple):
    """What a library that is not in the checkout calls so: ``rclpy.node.Node``."""

    name: str


class Inherited(NamedTuple):
    """An attribute that an object has of a library's class, such as a method of a node."""

    me: Instance
    name: str


class Made(NamedTuple):
    """What a call of a library returns."""

    name: str
    run: Run


class Setting(NamedTuple):
    """A parameter of a node.

    Attributes
    ----------
    values
        By default; empty where the code says none.
    """

    name: str
    values: Values


class Open(NamedTuple):
    """What the text does not fix, and what it depends on."""

    why: str


class Frame(NamedTuple):
    """Where an expression stands, and for what it is looked at.

    Attributes
    ----------
    me
        The object whose method it is.
    run
        The call by which the function runs; None where any may be meant.
    turns
        Of loops: the item that they are at.
    """

    scope: Scope
    me: Instance | None = None
    run: Run | None = None
    turns: tuple[tuple[ast.AST, Item], ...] = ()


class Run(NamedTuple):
    """A call, and where it stands."""

    call: ast.Call
    frame: Frame


class Place(NamedTuple):
    """An expression, and where it stands."""

    expression: ast.expr
    frame: Frame


Value = (
    Text
    | Plain
    | Items
    | Pairs
    | ClassValue
    | FunctionValue
    | ModuleValue
    | Instance
    | Library
    | Inherited
    | Made
    | Setting
    | Open
)
Values = tuple[Value, ...]
Item = Place | tuple["Value", ...]


def union(values: Iterable[Value]) -> Values:
    """Return values, each once; an open one where they are too many."""
    each = tuple(dict.fromkeys(values))
    return each if len(each) <= MANY else (Open(f"more than {MANY} values"),)


def constant(value: object) -> Value:
    """Return a constant as a value."""
    if isinstance(value, str):
        return Text(literal(value))
    if value is None or isinstance(value, int | float):
        return Plain(value)
    return Open("bytes")


def written(node: ast.AST) -> str:
    """Return an expression as it is written, as far as it is names and calls."""
    while isinstance(node, ast.Await | ast.Subscript):
        node = node.value
    if isinstance(node, ast.Call):
        name = dotted(node.func)
        return f"{name}()" if name else "a call"
    return dotted(node) or "an expression"


def number(value: Value) -> int | float | None:
    """Return the number that a value is; None for what is none."""
    counted = value.value if isinstance(value, Plain) else None
    return None if isinstance(counted, bool) else counted


def computed(operator: ast.operator, former: Value, latter: Value) -> Value:
    """Return what an operator makes of two numbers; open for anything else, and for large ones."""
    first, second = number(former), number(latter)
    if first is None or second is None or max(abs(first), abs(second)) > LARGEST:
        return Open("a number")
    if isinstance(operator, ast.Add):
        return Plain(first + second)
    if isinstance(operator, ast.Sub):
        return Plain(first - second)
    if isinstance(operator, ast.Mult):
        return Plain(first * second)
    if not second:
        return Open("a number")
    return Plain(first // second if isinstance(operator, ast.FloorDiv) else first % second)


def is_false(value: Value) -> bool:
    """Return whether a value is one that ``or`` passes over."""
    if isinstance(value, Plain):
        return not value.value
    return isinstance(value, Text) and all(piece.text == "" for piece in value.pieces)
