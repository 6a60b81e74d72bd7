"""Pieces of Python as its own parser gives them: the tree of a file, and what each piece is made of.

In: bytes. Out: text, tree, pieces; no recursion over code. Passed over are the signs of operators, and whether a name
is read or written: as pieces they say nothing, and they are a third of a tree.
"""

from __future__ import annotations

import ast
import io
import tokenize
import warnings
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

FAILURES = (SyntaxError, ValueError, RecursionError, MemoryError, tokenize.TokenError)
NO_CODE = frozenset(["ctx", "op", "ops", "id", "attr", "arg", "name", "kind", "level", "module", "type_comment"])
FIELDS = {  # by the sort of a piece: what can hold pieces
    kind: tuple(name for name in kind._fields if name not in NO_CODE)
    for kind in vars(ast).values()
    if isinstance(kind, type) and issubclass(kind, ast.AST)
}


def parse_python(data: bytes) -> tuple[str, ast.Module]:
    """Return the text of a file, with its lines ended as Python counts them, and its tree; raises ``FAILURES``."""
    encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
    text = data.decode(encoding).replace("\r\n", "\n").replace("\r", "\n")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what Python thinks of the code is its author's business
        return text, ast.parse(text)


def parts_of(node: ast.AST) -> list[ast.AST]:
    """Return what a piece of code is made of, from the first to the last."""
    found: list[ast.AST] = []
    for name in FIELDS[type(node)]:
        value = getattr(node, name)
        if type(value) is list:
            found += [one for one in value if isinstance(one, ast.AST)] if value else value
        elif isinstance(value, ast.AST):
            found.append(value)
    return found


def pieces_of(node: ast.AST) -> Iterator[ast.AST]:
    """Yield a piece of code and all that it is made of, from the outside to the inside."""
    waiting = deque([node])
    while waiting:
        piece = waiting.popleft()
        yield piece
        waiting += parts_of(piece)
