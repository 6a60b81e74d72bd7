"""The Python code of a checkout: modules, classes and functions, the names that each gives, and all calls.

Only what the text says is read here; what an expression can be is the matter of ``python_values.py``. No recursion:
code may be nested as deep as it likes.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.node_uses import CodeModules
from rosprivacy.ingest.code.python_tree import FIELDS
from rosprivacy.ingest.code.python_uses import ALL

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.ingest.code.source_code import Code

WHOLE, ITEM, ADDED, MEMBER = "whole", "item", "added", "member"  # how a variable has its value of an expression
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
LOOPS = (ast.For, ast.AsyncFor)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
RETURNING = (ast.Return, ast.Yield, ast.YieldFrom)
OPENING = frozenset([ast.ClassDef, *FUNCTIONS])  # code with a scope of its own
NAMING = frozenset(  # code that says something of names
    [ast.Call, ast.Attribute, ast.Assign, ast.AnnAssign, ast.NamedExpr, ast.AugAssign, ast.For, ast.AsyncFor,
     ast.comprehension, ast.With, ast.AsyncWith, ast.ExceptHandler, ast.MatchAs, ast.MatchStar, *RETURNING]
)  # fmt: skip
DEEP = 3  # objects, each made by the one before, that are told apart
LONGEST_LINE = 64  # of bases, one derived of the other


class Binding(NamedTuple):
    """A place where a variable gets a value.

    Attributes
    ----------
    value
        None where it is not an expression: an exception, a part of a pattern.
    sort
        ``WHOLE``: it is the value; ``ITEM``: it goes over it; ``ADDED``: ``+=``; ``MEMBER``: ``.append``.
    path
        Places in the tuples that it is taken apart by.
    at
        The statement or comprehension.
    """

    value: ast.expr | None
    sort: str
    path: tuple[int, ...]
    at: ast.AST
    scope: Scope


@dataclass(eq=False)
class Scope:
    """A module, class or function.

    Attributes
    ----------
    of_class
        Of a function: the class whose method it is, or stands in.
    bindings, attributes
        By the name of a variable, and by that of an attribute of the first argument of a method (``self.x``).
    inner
        Classes and functions by name; the last one counts.
    """

    file: PythonFile
    node: ast.AST
    name: str
    above: Scope | None = None
    of_class: Scope | None = None
    bindings: dict[str, list[Binding]] = field(default_factory=lambda: defaultdict(list))
    attributes: dict[str, list[Binding]] = field(default_factory=lambda: defaultdict(list))
    inner: dict[str, Scope] = field(default_factory=dict)
    returns: list[ast.expr] = field(default_factory=list)

    @property
    def arguments(self) -> ast.arguments | None:
        """Of a function: its arguments."""
        return self.node.args if isinstance(self.node, FUNCTIONS) else None

    @property
    def is_method(self) -> bool:
        """Whether it is a function that stands in a class directly."""
        return self.of_class is not None and self.above is self.of_class and isinstance(self.node, FUNCTIONS)

    @property
    def decorators(self) -> frozenset[str]:
        """Last names of what it is decorated with."""
        listed = getattr(self.node, "decorator_list", [])
        return frozenset(getattr(one, "attr", getattr(one, "id", "")) for one in listed)

    @property
    def own_name(self) -> str:
        """Of a method: the name of its first argument, for the object that it is called on; empty if there is none."""
        given = self.arguments
        if not self.is_method or given is None or "staticmethod" in self.decorators:
            return ""
        listed = [*given.posonlyargs, *given.args]
        return listed[0].arg if listed else ""


class CodeCall(NamedTuple):
    """A call, and where it stands."""

    call: ast.Call
    scope: Scope


@dataclass(eq=False)
class PythonFile:
    """A file.

    Attributes
    ----------
    names
        What its imports stand for.
    all_of
        Modules of which all names are imported.
    above
        By a piece of code the piece that it is part of, and as which field.
    """

    file: str
    tree: ast.Module
    names: Mapping[str, tuple[str, ...]]
    all_of: tuple[str, ...]
    scope: Scope = field(init=False)
    above: dict[ast.AST, tuple[ast.AST, str]] = field(default_factory=dict)
    calls: list[CodeCall] = field(default_factory=list)
    classes: list[Scope] = field(default_factory=list)
    lambdas: dict[ast.Lambda, Scope] = field(default_factory=dict)
    passed_on: list[tuple[ast.Attribute, Scope]] = field(default_factory=list)  # attributes that are not called


def read_scopes(code: Code, tree: ast.Module) -> PythonFile:
    """Return what a file says of names."""
    names: dict[str, list[str]] = defaultdict(list)
    for name, meant in code.imports:
        names[name].append(meant)
    whole = tuple(one.removesuffix(f".{ALL}") if one.strip(".*") else one[:-1] for one in names.pop(ALL, []))
    read = PythonFile(code.file, tree, {name: tuple(dict.fromkeys(some)) for name, some in names.items()}, whole)
    read.scope = Scope(read, tree, "")
    waiting: list[tuple[ast.AST, Scope]] = [(tree, read.scope)]
    while waiting:
        node, scope = waiting.pop()
        inside = _opened(node, scope) if type(node) in OPENING else scope
        if type(node) in NAMING:
            _note(node, scope, read)
        parts: list[tuple[ast.AST, Scope]] = []
        for name in FIELDS[type(node)]:
            value = getattr(node, name)
            of = inside if name == "body" else scope
            place = (node, name)
            for child in value if isinstance(value, list) else (value,):
                if isinstance(child, ast.AST):
                    read.above[child] = place
                    parts.append((child, of))
        waiting += reversed(parts)
    return read


def _opened(node: ast.AST, scope: Scope) -> Scope:
    """The scope of the body of a piece of code."""
    if isinstance(node, ast.ClassDef):
        inside = Scope(scope.file, node, node.name, scope, None)
        scope.file.classes.append(inside)
    else:
        of_class = scope if isinstance(scope.node, ast.ClassDef) else scope.of_class
        inside = Scope(scope.file, node, getattr(node, "name", "lambda"), scope, of_class)
        if isinstance(node, ast.Lambda):
            inside.returns.append(node.body)
            scope.file.lambdas[node] = inside
    if not isinstance(node, ast.Lambda):
        scope.inner[inside.name] = inside
    return inside


def _note(node: ast.AST, scope: Scope, read: PythonFile) -> None:
    """Note what a piece of code says of names."""
    if isinstance(node, ast.Call):
        read.calls.append(CodeCall(node, scope))
        _note_member(node, scope)
    elif isinstance(node, ast.Attribute):
        if isinstance(node.ctx, ast.Load) and read.above[node][1] != "func":
            read.passed_on.append((node, scope))
    elif isinstance(node, RETURNING):
        if node.value is not None:
            scope.returns.append(node.value)
    else:
        for target, value, sort in _targets(node):
            _bind(target, Binding(value, sort, (), node, scope))


def _targets(node: ast.AST) -> Iterator[tuple[ast.AST, ast.expr | None, str]]:
    if isinstance(node, ast.Assign):
        yield from ((target, node.value, WHOLE) for target in node.targets)
    elif isinstance(node, ast.AnnAssign | ast.NamedExpr):
        if node.value is not None:
            yield node.target, node.value, WHOLE
    elif isinstance(node, ast.AugAssign):
        yield node.target, node.value if isinstance(node.op, ast.Add) else None, ADDED
    elif isinstance(node, ast.For | ast.AsyncFor | ast.comprehension):
        yield node.target, node.iter, ITEM
    elif isinstance(node, ast.With | ast.AsyncWith):
        yield from ((one.optional_vars, one.context_expr, WHOLE) for one in node.items if one.optional_vars)
    elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and node.name:
        yield ast.Name(node.name), None, WHOLE


def _bind(target: ast.AST, binding: Binding) -> None:
    waiting = [(target, binding.path)]
    while waiting:
        part, path = waiting.pop()
        if isinstance(part, ast.Name):
            binding.scope.bindings[part.id].append(binding._replace(path=path))
        elif isinstance(part, ast.Attribute):
            owner = _owner(part, binding.scope)
            if owner is not None:
                owner.attributes[part.attr].append(binding._replace(path=path))
        elif isinstance(part, ast.Tuple | ast.List):
            starred = any(isinstance(one, ast.Starred) for one in part.elts)
            waiting += [(one, (*path, -1 if starred else at)) for at, one in enumerate(part.elts)]
        elif isinstance(part, ast.Starred):
            waiting.append((part.value, path))


def _note_member(call: ast.Call, scope: Scope) -> None:
    """``topics.append("/a")`` gives a list a member."""
    func = call.func
    if isinstance(func, ast.Attribute) and func.attr in ("append", "add") and len(call.args) == 1:
        _bind(func.value, Binding(call.args[0], MEMBER, (), call, scope))


def _owner(part: ast.Attribute, scope: Scope | None) -> Scope | None:
    """The class whose attribute ``self.x`` is."""
    name = part.value.id if isinstance(part.value, ast.Name) else ""
    while name and scope is not None:
        if scope.own_name == name:
            return scope.of_class
        scope = scope.above if isinstance(scope.node, FUNCTIONS) else None
    return None


class Checkout:
    """All Python files of a checkout.

    Attributes
    ----------
    files
        By the names of ``codes``.
    calls
        By the last name of what is called, and by what else the same module calls that by an ``import … as``.
    """

    def __init__(self, codes: Sequence[Code], trees: Mapping[str, ast.Module]) -> None:
        of_python = [code for code in codes if code.file in trees]
        self._names = CodeModules(of_python)
        self.files = {code.file: read_scopes(code, trees[code.file]) for code in of_python}
        self.calls: dict[str, list[CodeCall]] = defaultdict(list)
        self.methods: dict[str, list[Scope]] = defaultdict(list)  # all of one name
        self._modules: dict[tuple[str, str], tuple[str, tuple[str, ...]] | None] = {}
        for read in self.files.values():
            renamed = {name: some[-1].rpartition(".")[2] for name, some in read.names.items()}
            for one in read.calls:
                func = one.call.func
                name = func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "")
                for key in dict.fromkeys([name, renamed.get(name, name)]):
                    self.calls[key].append(one)
            for cls in read.classes:
                for name, inner in cls.inner.items():
                    self.methods[name].append(inner)

    def module(self, read: PythonFile, name: str) -> tuple[PythonFile, tuple[str, ...]] | None:
        """Return the module that a dotted name begins with, as a file imports it, and the rest of the name."""
        folder = str(PurePath(read.file).parent)
        key = (folder, name)
        if key not in self._modules:
            found = self._names.begin_of(folder, name)
            self._modules[key] = (found[0], tuple(found[1])) if found else None
        place = self._modules[key]
        return (self.files[place[0]], place[1]) if place and place[0] in self.files else None


def branch(piece: ast.AST, read: PythonFile) -> Iterator[tuple[ast.AST, str]]:
    """Yield what a piece of code is part of, from the nearest, each with the field that it stands in."""
    while piece in read.above:
        outer = read.above[piece]
        yield outer
        piece = outer[0]


def is_super(node: ast.AST | None) -> bool:
    """Return whether an expression is ``super()``."""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "super"


def self_of(scope: Scope | None) -> str:
    """Return the name of the object whose method a function is, or stands in."""
    while scope is not None and isinstance(scope.node, FUNCTIONS):
        if scope.own_name:
            return scope.own_name
        scope = scope.above
    return ""
