"""What Python code uses: names of libraries, as its imports resolve them, where they are used; nothing is run.

``import cv2 as cv`` and ``cv.VideoCapture(0)`` give ``cv2.VideoCapture``; ``from x import y`` gives ``x.y`` where ``y``
is used. What a variable is that was made by such a call, or stands for a library, is known as far as all its values are
the same: ``self.client = mqtt.Client()`` and ``self.client.publish(…)``. That it is None at first says nothing against
it. An address that stands in the code, ``https://…``, is a use, too, without what follows a question mark, and with
``{}`` for what is filled in. No recursion: code may be nested as deep as it likes.
"""

from __future__ import annotations

import ast
import builtins
from bisect import bisect_right
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.library_rules import ADDRESS
from rosprivacy.ingest.code.python_tree import pieces_of
from rosprivacy.ingest.code.source_code import (
    FLEET_CONTROL,
    LONGEST_USE,
    Code,
    NameUse,
    SourceLines,
    SourceUnit,
    in_time,
    is_fleet_topic,
    program,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

LONGEST = 32  # names and calls of a chain: what is longer is nobody's
BUILT_IN = ("open", "input", "__import__", "exec", "eval")
BUILT_INS = frozenset(dir(builtins))
ALL = "*"  # that is imported from a module
CALLED_WITH = ("input", "output")  # keywords that say whether a stream of sound comes in or goes out
STARTERS = (  # what starts a program, and what looks for one that is started then
    "subprocess.", "os.system", "os.popen", "os.exec", "os.spawn", "asyncio.create_subprocess_", "shutil.which",
    "pexpect.", "launch.actions.ExecuteProcess",
)  # fmt: skip
COMMANDS = ("args", "cmd")  # keywords
SCHEMES = (
    "http://", "https://", "ws://", "wss://", "mqtt://", "mqtts://", "rtsp://", "rtmp://", "stun:", "turn:", "turns:",
)  # fmt: skip
MODE_SIGNS, WRITING = frozenset("rwaxbtU+"), frozenset("wax+")
FILE_METHODS = {  # of what is not known, by names that only such have -> what it is then
    "write_text": "pathlib.Path.write_text", "write_bytes": "pathlib.Path.write_bytes",
    "to_csv": "pandas.DataFrame.to_csv", "to_excel": "pandas.DataFrame.to_excel",
    "to_parquet": "pandas.DataFrame.to_parquet",
}  # fmt: skip
PATH_OPEN = "pathlib.Path.open"
MAKING = frozenset([ast.Assign, ast.AnnAssign, ast.NamedExpr, ast.With, ast.AsyncWith])  # give a variable its value
PIECES = (ast.Call, ast.Attribute, ast.Name, ast.Constant, ast.JoinedStr)  # code that may say what is used
DEFINITIONS = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def imported(pieces: Iterable[ast.AST]) -> Iterator[tuple[str, str]]:
    """Yield names and what they stand for; what is imported from beside the file begins with a dot."""
    for node in pieces:
        if isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
            dot = "" if module.endswith(".") else "."
            yield from ((alias.asname or alias.name, f"{module}{dot}{alias.name}") for alias in node.names)
        elif isinstance(node, ast.Import):
            for alias in node.names:
                name = alias.name if alias.asname else alias.name.partition(".")[0]
                yield alias.asname or name, name


def read_uses(file: str, tree: ast.Module, late: Callable[[], bool]) -> Code:
    """Return what a file imports and uses, and its units.

    Raises
    ------
    OutOfTime
        When it is late.
    """
    pieces = list(pieces_of(tree))
    imports = tuple(imported(pieces))
    used = _PythonUses(tree, file, pieces, imports)
    return Code(file, "python", uses=used.uses(late), units=used.units, imports=imports)


class _PythonUses:
    """Reads the uses of one file.

    Attributes
    ----------
    units
        Classes and functions at the top of the file.
    """

    def __init__(
        self, tree: ast.Module, file: str, pieces: Sequence[ast.AST], imports: Iterable[tuple[str, str]]
    ) -> None:
        self._pieces = pieces
        self.units = tuple(
            SourceUnit(one.name, SourceLines(_first(one), one.end_lineno or one.lineno))
            for one in tree.body
            if isinstance(one, DEFINITIONS)
        )
        self._begins = [one.lines.first for one in self.units]
        own = {one.name: f".{Path(file).stem}.{one.name}" for one in self.units}
        self._known_names = own | dict(imports)
        self._all_of = self._known_names.pop(ALL, "").removesuffix(
            f".{ALL}"
        )  # the last module of which all is imported
        self._own = set(_named_here(pieces)) if self._all_of else set()
        self._built: dict[tuple[str, str], set[str]] = defaultdict(set)  # by unit and variable: what makes its values
        self._commands: dict[tuple[str, str], list[ast.expr]] = defaultdict(list)  # lists and texts that variables are

    def uses(self, late: Callable[[], bool]) -> tuple[NameUse, ...]:
        """Return what is used, each name once in a unit, in the order of the text."""
        for node in in_time(self._pieces, late):
            if type(node) in MAKING:
                self._note(node)
        found: dict[tuple[str, str], NameUse] = {}
        inside: set[int] = set()  # parts of what has been looked at as a whole
        for node in in_time(self._pieces, late):
            if not isinstance(node, PIECES) or id(node) in inside:
                continue
            unit = self._unit(node.lineno)
            of_text = isinstance(node, ast.Constant | ast.JoinedStr)
            for name in _addresses(node, inside) if of_text else self._names(node, unit, inside):
                one = NameUse(name, node.lineno, unit)
                first = found.setdefault((unit, name), one)
                found[unit, name] = min(first, one, key=lambda use: use.line)
        return tuple(sorted(found.values(), key=lambda use: (use.line, use.name)))

    def _unit(self, line: int) -> str:
        """The class or function at the top of the file that a line stands in; empty outside of all."""
        at = bisect_right(self._begins, line) - 1
        return self.units[at].name if at >= 0 and line <= self.units[at].lines.last else ""

    def _note(self, node: ast.AST) -> None:
        """Note what a variable is made by."""
        pairs: list[tuple[ast.expr | None, ast.expr | None]] = []
        if isinstance(node, ast.Assign):
            pairs = [(target, node.value) for target in node.targets]
        elif isinstance(node, ast.AnnAssign | ast.NamedExpr):
            pairs = [(node.target, node.value)]
        elif isinstance(node, ast.With | ast.AsyncWith):
            pairs = [(item.optional_vars, item.context_expr) for item in node.items]
        for target, value in pairs:
            if target is not None and (name := _variable(target)):
                unit = self._unit(target.lineno)
                if isinstance(value, ast.List | ast.Tuple | ast.Constant | ast.JoinedStr):
                    self._commands[unit, name].append(value)
                if value is not None and not _is_none(value):
                    self._built[unit, name].add(self._value(value, unit))

    def _value(self, value: ast.expr, unit: str) -> str:
        """What makes a value: a call, or a library that it stands for (``self.sr = speech_recognition``)."""
        alias = isinstance(value, ast.Name) and value.id in self._known_names
        return self._chain(value, unit, set()) if alias or isinstance(value, ast.Call | ast.Await) else ""

    def _names(self, node: ast.expr, unit: str, inside: set[int]) -> Iterator[str]:
        """The names that one piece of code uses, from the outside: ``a.b().c`` is looked at once."""
        name = self._chain(node, unit, inside) or _by_method(node)
        if not name or len(name) > LONGEST_USE or not isinstance(getattr(node, "ctx", ast.Load()), ast.Load):
            return
        if not isinstance(node, ast.Call):
            if name not in BUILT_IN:
                yield name
            return
        hints = _hints(node, name)
        yield from (f"{name}({hint})" for hint in hints)
        if not hints:
            yield name
        command = _started(node) if name.startswith(STARTERS) else None
        if command:
            own = self._commands.get((unit, _variable(command)), ())
            yield from filter(None, dict.fromkeys(program(_command(first)) for first in (command, *own)))

    def _chain(self, node: ast.expr, unit: str, inside: set[int]) -> str:
        """``cv2.VideoCapture`` of a chain of names and calls; empty for what begins with anything else."""
        parts: list[str] = []
        for _ in range(LONGEST):
            made = self._by_variable(node, unit) if parts else ""
            if made:
                return ".".join([made, *reversed(parts)])
            if isinstance(node, ast.Attribute):
                parts.append(node.attr)
                node = node.value
            elif isinstance(node, ast.Call):
                node = node.func
            elif isinstance(node, ast.Await):
                node = node.value
            else:
                break
            if not isinstance(node, ast.Call):  # a call is looked at by itself, too: its arguments may say more
                inside.add(id(node))
        if not isinstance(node, ast.Name):
            return ""
        head = self._known_names.get(node.id) or (node.id if node.id in BUILT_IN else self._of_all(node.id))
        return ".".join([head, *reversed(parts)]) if head else ""

    def _of_all(self, name: str) -> str:
        """``tkinter.Tk`` of ``Tk`` after ``from tkinter import *``, where the file itself names nothing so."""
        known = name in self._own or name in BUILT_INS
        return f"{self._all_of}.{name}" if self._all_of and not known else ""

    def _by_variable(self, node: ast.expr, unit: str) -> str:
        """What a variable is made by, if all its values are made by one."""
        name = _variable(node)
        made = (self._built.get((unit, name)) or self._built.get(("", name), set())) if name else set()
        return next(iter(made)) if len(made) == 1 else ""


def _named_here(pieces: Iterable[ast.AST]) -> Iterator[str]:
    """All names that a file gives."""
    for node in pieces:
        if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load):
            yield node.id
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, DEFINITIONS) or (isinstance(node, ast.ExceptHandler) and node.name):
            yield node.name or ""


def _addresses(node: ast.expr, inside: set[int]) -> Iterator[str]:
    """The address that a text is, or the fleet control of which it is a topic."""
    parts = node.values if isinstance(node, ast.JoinedStr) else [node]
    inside.update(map(id, parts))
    first = parts[0].value if parts and isinstance(parts[0], ast.Constant) else None
    text = "".join(str(one.value) if isinstance(one, ast.Constant) else "{}" for one in parts)
    if is_fleet_topic(text):
        yield FLEET_CONTROL
    if isinstance(first, str) and first.startswith(SCHEMES):
        address, *_ = text.partition("?")[0].split()
        yield f"{ADDRESS}{address[: LONGEST_USE - len(ADDRESS)]}"


def _is_none(value: ast.expr) -> bool:
    return isinstance(value, ast.Constant) and value.value is None


def _by_method(node: ast.expr) -> str:
    """What is called, by its last name alone: ``path.open("a")`` and ``table.to_csv(…)``."""
    if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Attribute):
        return ""
    if node.func.attr == "open" and _hints(node, PATH_OPEN):
        return PATH_OPEN
    return FILE_METHODS.get(node.func.attr, "")


def _variable(node: ast.expr) -> str:
    """``x`` or ``self.x``; empty for anything else."""
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        return f"{node.value.id}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else ""


def _first(node: ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    return min([node.lineno, *(one.lineno for one in node.decorator_list)])


def _hints(call: ast.Call, name: str) -> list[str]:
    """What the arguments say of how it is used."""
    hints = [one.arg for one in call.keywords if one.arg in CALLED_WITH and _is_true(one.value)]
    if name.rpartition(".")[2] == "open":
        place = 0 if name.endswith("Path.open") else 1
        given = [*call.args[place : place + 1], *(one.value for one in call.keywords if one.arg == "mode")]
        texts = [one.value for one in given if isinstance(one, ast.Constant) and isinstance(one.value, str)]
        hints += ["w" for text in texts if text and set(text) <= MODE_SIGNS and WRITING & set(text)][:1]
    return hints


def _is_true(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is True


def _started(call: ast.Call) -> ast.expr | None:
    """The argument that is the command."""
    given = (one.value for one in call.keywords if one.arg in COMMANDS)
    return call.args[0] if call.args else next(given, None)


def _command(first: ast.expr) -> list[str]:
    """The words of a command, as far as they are literals."""
    if isinstance(first, ast.JoinedStr) and first.values:
        first = first.values[0]
    if isinstance(first, ast.List | ast.Tuple):
        words = []
        for one in first.elts:
            if not (isinstance(one, ast.Constant) and isinstance(one.value, str)):
                break
            words.append(one.value)
        return words
    return first.value.split() if isinstance(first, ast.Constant) and isinstance(first.value, str) else []
