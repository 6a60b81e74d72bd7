"""Which of the places that give a variable its value can have done so where the variable is used."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.python.python_scopes import (
    ADDED,
    COMPREHENSIONS,
    LOOPS,
    MEMBER,
    WHOLE,
    Binding,
    PythonFile,
    Scope,
    branch,
)

if TYPE_CHECKING:
    from collections.abc import Sequence


OFTEN = 500  # places that a variable gets its value at; more are not told apart


def reaching(every: Sequence[Binding], at: ast.AST | None, scope: Scope) -> tuple[list[tuple[Binding, bool]], bool]:
    """Return the places that can have given a variable its value where it is used, and whether none of them need have.

    In the order of the text, each with whether it takes place whenever the variable is used.

    Parameters
    ----------
    at
        None for any time after all of the scope.
    """
    if not every:
        return [], True
    if len(every) > OFTEN:
        return [(every[0]._replace(value=None, sort=WHOLE), False)], True
    if at is None:
        return [(one, one.sort == ADDED and scope.file.above[one.at][0] is scope.node) for one in every], True
    read = scope.file
    way: list[tuple[ast.AST, str]] = []
    inner: ast.AST = at
    for outer, field in branch(at, read):
        if isinstance(outer, COMPREHENSIONS):
            makers = [one for one in outer.generators if not (field == "generators" and _not_yet(one, inner, outer))]
            own = [one for one in every if one.at in makers]
            if own:
                return [(one, True) for one in own], False
        if isinstance(outer, LOOPS) and field == "body":
            own = [one for one in every if one.at is outer]
            if own:
                within = [one for one in every if one.at is not outer and _within(one.at, outer, read)]
                return [(one, False) for one in (*own, *within)], False
        way.append((outer, field))
        if outer is scope.node:
            break
        inner = outer
    return _before(every, at, way, read)


def _not_yet(generator: ast.comprehension, inner: ast.AST, outer: ast.AST) -> bool:
    """Whether a part of a comprehension gives its variable only after another part is looked at."""
    generators = getattr(outer, "generators", [])
    return inner in generators and generators.index(generator) >= generators.index(inner)


def _before(
    every: Sequence[Binding], at: ast.AST, way: Sequence[tuple[ast.AST, str]], read: PythonFile
) -> tuple[list[tuple[Binding, bool]], bool]:
    fields = dict(way)
    place = _position(at)
    selected: list[tuple[Binding, bool]] = []
    start = True
    for one in sorted(
        (one for one in every if not isinstance(one.at, ast.comprehension)), key=lambda one: _position(one.at)
    ):
        outer, field = read.above.get(one.at, (None, ""))
        own_block = outer is not None and fields.get(outer) == field
        with_itself = isinstance(one.at, ast.With | ast.AsyncWith | ast.ExceptHandler) and one.at in fields
        before = _position(one.at) < place and one.at not in fields
        certain = with_itself or (own_block and before)
        if certain and one.sort not in (ADDED, MEMBER):
            selected, start = [(one, True)], False
        elif one.sort == ADDED and before and _repeated(one.at, selected, read):
            selected.append((one._replace(value=None), False))  # nobody knows how often
        elif certain:
            selected.append((one, True))
        elif (before and not _exclusive(one.at, fields, read)) or (
            not before and (start or not _same_turn(selected, fields, read)) and _looped(one.at, fields, read)
        ):
            selected.append((one, False))
    return selected, start


def _exclusive(piece: ast.AST, fields: dict[ast.AST, str], read: PythonFile) -> bool:
    """Whether a piece stands in the other branch of an ``if`` than the use."""
    for outer, field in branch(piece, read):
        if outer in fields:
            return (
                isinstance(outer, ast.If | ast.IfExp)
                and fields[outer] != field
                and "test" not in (field, fields[outer])
            )
    return False


def _looped(piece: ast.AST, fields: dict[ast.AST, str], read: PythonFile) -> bool:
    """Whether a loop holds both a piece and the use."""
    return any(outer in fields and isinstance(outer, (*LOOPS, ast.While)) for outer, _ in branch(piece, read))


def _same_turn(selected: Sequence[tuple[Binding, bool]], fields: dict[ast.AST, str], read: PythonFile) -> bool:
    """Whether what certainly gives a value does so in each turn of the loop that the use stands in."""
    first = selected[0][0].at if selected else None
    return first is not None and _looped(first, fields, read)


def _repeated(piece: ast.AST, selected: Sequence[tuple[Binding, bool]], read: PythonFile) -> bool:
    """Whether a piece stands in a loop that does not begin anew with what gives the variable its value before."""
    loops = [outer for outer, _ in branch(piece, read) if isinstance(outer, (*LOOPS, ast.While))]
    first = selected[0][0].at if selected else None
    return any(first is None or not _within(first, loop, read) for loop in loops)


def _within(piece: ast.AST, outer: ast.AST, read: PythonFile) -> bool:
    return any(one is outer for one, _ in branch(piece, read))


def _position(node: ast.AST) -> tuple[int, int]:
    return getattr(node, "lineno", 0), getattr(node, "col_offset", 0)
