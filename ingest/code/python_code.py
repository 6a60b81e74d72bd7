"""Python source -> what is read in it, by Python's own parser and tokenizer; no recursion, nothing is run.

Of launch files and ``setup.py`` it is what they say of names: ``Node(package=…, executable=…, name=…)`` and entry
points. Only literals are read.

Source: the signatures of rclpy (``Node``, ``create_node``, ``create_publisher`` …, ``rclpy.action``), of
``launch_ros.actions.Node``, and setuptools' ``console_scripts``.
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.ingest.code.python_tree import FAILURES, parse_python, pieces_of
from rosprivacy.ingest.code.python_uses import read_uses
from rosprivacy.ingest.code.source_code import (
    INTERFACES,
    NODE,
    NODE_CLASSES,
    CallSite,
    Code,
    Launch,
    NodeClass,
    Script,
    SourceComment,
    SourceLines,
    Where,
    class_owner,
    clock,
    in_time,
    variable,
    walk,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

VERSION = ".".join(map(str, sys.version_info[:2]))
CORRECT = "correct it, or name the other files; newer syntax needs a newer Python"
BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")  # of statements: where further statements stand
LAUNCHED = ("Node", "LifecycleNode", "ComposableNode")
ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*\w+\s*")


class _Call(NamedTuple):
    """How a call names its channel: kind, role, and the places of name, type and node among its arguments."""

    kind: str
    role: str
    name: tuple[int, str]
    type: tuple[int, str]
    node: tuple[int, str] | None = None


METHODS = {
    "create_publisher": _Call("topic", "publish", (1, "topic"), (0, "msg_type")),
    "create_subscription": _Call("topic", "subscribe", (1, "topic"), (0, "msg_type")),
    "create_service": _Call("service", "reply", (1, "srv_name"), (0, "srv_type")),
    "create_client": _Call("service", "request", (1, "srv_name"), (0, "srv_type")),
}
ACTIONS = {
    "ActionServer": _Call("action", "execute", (2, "action_name"), (1, "action_type"), (0, "node")),
    "ActionClient": _Call("action", "call", (2, "action_name"), (1, "action_type"), (0, "node")),
}


def read_python(file: str, data: bytes) -> Code:
    """Read a file.

    Raises
    ------
    OutOfTime
        If it takes too long; Python's own parser, which nothing can stop, takes a time in proportion to the file.
    """
    late = clock()
    try:
        text, tree = parse_python(data)
        comments = tuple(in_time(_comments(text), late))
    except FAILURES as error:
        return not_python(file, error)
    code = read_uses(file, tree, late)
    imports = dict(code.imports)
    classes, sites = [], []
    root: ast.AST = tree
    for node, where in in_time(walk(root, Where(), _parts, late), late):
        if isinstance(node, ast.ClassDef):
            classes.append(_class(node, imports))
            lines = classes[-1].lines
            sites.append(CallSite(NODE, None, lines, lines, class_owner(node.name), head=True))
        elif isinstance(node, ast.Call) and (site := _site(node, where, imports)):
            sites.append(site)
    launches, scripts = launched(tree)
    return code._replace(
        comments=comments, classes=tuple(classes), sites=tuple(sites), launches=launches, scripts=scripts
    )


def not_python(file: str, error: Exception) -> Code:
    """Return what is known of a file that the parser refuses."""
    line = (isinstance(error, SyntaxError) and error.lineno) or 1
    what = error.msg if isinstance(error, SyntaxError) else str(error) or type(error).__name__
    return Code(file, "python", problems=(LabelError(file, line, f"not Python {VERSION}: {shown(what)}", CORRECT),))


def _comments(text: str) -> Iterator[SourceComment]:
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            alone = not token.line[: token.start[1]].strip()
            yield SourceComment(token.start[0], token.string.lstrip("#!: ").rstrip(), alone)


def _parts(node: ast.AST, where: Where) -> list[tuple[ast.AST, Where]]:
    return [(child, _inside(node, child, where)) for child in ast.iter_child_nodes(node)]


def _inside(node: ast.AST, child: ast.AST, where: Where) -> Where:
    if isinstance(node, ast.ClassDef) and isinstance(child, ast.stmt):
        where = Where(of_class=node.name)
    elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
        where = where._replace(function=f"{node.lineno}:{node.col_offset}", target="")
    if isinstance(child, ast.stmt):
        whole = None if hasattr(child, "body") or isinstance(child, ast.Match) else _lines(child)
        return where._replace(statement=whole, target="")
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    named = dotted(targets[0]) if len(targets) == 1 and child is getattr(node, "value", None) else ""
    return where._replace(target=named)


def _lines(node: ast.AST) -> SourceLines:
    first = int(getattr(node, "lineno", 1))
    return SourceLines(first, int(getattr(node, "end_lineno", None) or first))


def classes_of(tree: ast.Module, imports: Mapping[str, str]) -> tuple[NodeClass, ...]:
    """Return the classes of a file, from the first to the last; expressions, which hold none, are not gone through."""
    found: list[ast.ClassDef] = []
    waiting: list[Any] = [tree]
    while waiting:
        piece = waiting.pop()
        if isinstance(piece, ast.ClassDef):
            found.append(piece)
        waiting += (inner for block in BLOCKS for inner in getattr(piece, block, ()) if isinstance(inner, ast.AST))
    return tuple(_class(node, imports) for node in sorted(found, key=lambda node: (node.lineno, node.col_offset)))


def _class(node: ast.ClassDef, imports: Mapping[str, str]) -> NodeClass:
    """A class with its bases, by the names that they were imported from (``Node as RclNode``)."""
    head = [*node.bases, *node.keywords]
    first = min([node.lineno, *(_lines(one).first for one in node.decorator_list)])
    last = max([node.lineno, *(_lines(one).last for one in head)])
    named = [name for name in map(dotted, node.bases) if name]
    bases = tuple((_whole(name, imports) or name).rpartition(".")[2] for name in named)
    return NodeClass(node.name, bases, SourceLines(first, last))


def dotted(node: ast.AST) -> str:
    """Return a name as it is written, ``self.node``; empty for what is none."""
    parts = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    return ".".join([node.id, *reversed(parts)]) if isinstance(node, ast.Name) else ""


def _site(call: ast.Call, where: Where, imports: Mapping[str, str]) -> CallSite | None:
    function = dotted(call.func)
    last = call.func.attr if isinstance(call.func, ast.Attribute) else function
    lines = _lines(call)
    at = lines, where.statement or lines
    if last == "__init__" and where.of_class:
        return _own_constructor(call, where, at)
    if last == "create_node" or (last in NODE_CLASSES and _whole(function, imports).startswith("rclpy.")):
        owner = _variable(where.target, where) if where.target else ""
        name, space = _text(_argument(call, 0, "node_name")), _namespace(call)
        return CallSite(NODE, name, *at, owner, namespace=space)
    how = METHODS.get(last) if isinstance(call.func, ast.Attribute) else None
    how = how or ACTIONS.get(last)
    if how is None:
        return None
    node = _argument(call, *how.node) if how.node else getattr(call.func, "value", None)
    owner = _variable(dotted(node), where) if node is not None else ""
    found = _message_type(dotted(_argument(call, *how.type) or ast.Constant(None)), imports)
    return CallSite(how.kind, _text(_argument(call, *how.name)), *at, owner, how.role, found)


def _own_constructor(call: ast.Call, where: Where, at: tuple[SourceLines, SourceLines]) -> CallSite | None:
    """``super().__init__('camera')`` or ``Node.__init__(self, 'camera')``."""
    before = call.func.value if isinstance(call.func, ast.Attribute) else None
    if isinstance(before, ast.Call) and dotted(before.func) == "super":
        place, base = 0, ""
    elif before is not None and call.args and dotted(call.args[0]) == "self":
        place, base = 1, dotted(before).rpartition(".")[2]
    else:
        return None
    name = _text(_argument(call, place, "node_name"))
    return CallSite(NODE, name, *at, class_owner(where.of_class), namespace=_namespace(call), base=base)


def _namespace(call: ast.Call) -> str | None:
    given = next((one.value for one in call.keywords if one.arg == "namespace"), None)
    if given is None or (isinstance(given, ast.Constant) and given.value is None):
        return ""
    return _text(given)


def _argument(call: ast.Call, place: int, name: str) -> ast.expr | None:
    if len(call.args) > place:
        before = call.args[: place + 1]
        return None if any(isinstance(one, ast.Starred) for one in before) else call.args[place]
    return next((one.value for one in call.keywords if one.arg == name), None)


def _text(node: ast.AST | None) -> str | None:
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def _variable(name: str, where: Where) -> str:
    """What a variable is known by: ``self`` is the class, ``self.x`` is of the class, others of their function."""
    if name == "self":
        return class_owner(where.of_class)
    if name.startswith("self."):
        return f"{where.of_class}:{name}"
    return variable(name, where) if name else ""


def _whole(name: str, imports: Mapping[str, str]) -> str:
    head, dot, rest = name.partition(".")
    return imports.get(head, "") + dot + rest


def _message_type(name: str, imports: Mapping[str, str]) -> str:
    """``sensor_msgs/msg/Image`` of a name that is imported."""
    parts = _whole(name, imports).split(".")
    known = len(parts) >= len(("package", "msg", "Name")) and parts[1] in INTERFACES and all(parts)
    return f"{parts[0]}/{parts[1]}/{parts[-1]}" if known else ""


def launched(tree: ast.Module) -> tuple[tuple[Launch, ...], tuple[Script, ...]]:
    """Return what a file says of executables; nothing unless it is a launch file or sets a package up."""
    calls = [node for node in pieces_of(tree) if isinstance(node, ast.Call)]
    return tuple(one for call in calls for one in _launch(call)), tuple(one for call in calls for one in _scripts(call))


def _launch(call: ast.Call) -> Iterator[Launch]:
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    given = {one.arg: _text(one.value) or "" for one in call.keywords if one.arg}
    executable = given.get("executable") or given.get("node_executable", "")
    if name in LAUNCHED and given.get("package") and executable:
        yield Launch(given["package"], executable, given.get("name") or given.get("node_name", ""))


def _scripts(call: ast.Call) -> Iterator[Script]:
    """The scripts of ``setup(entry_points={"console_scripts": ["talker = demo.talker:main"]})``."""
    for given in call.keywords:
        if given.arg == "entry_points" and isinstance(given.value, ast.Dict):
            for node in ast.walk(given.value):
                found = ENTRY.fullmatch(_text(node) or "")
                if found:
                    yield Script(found[1], found[2])
