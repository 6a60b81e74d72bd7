"""Names and types in Python code that stand there literally: constants, defaults of parameters, imports of interfaces.

In: a parsed module. Out: ``Values``, and the interface types that its names mean. Nothing is run.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

INTERFACES = ("msg", "srv", "action")
DEEPEST = 8  # values that name values: a cycle ends here
READS = frozenset(["get_parameter", "declare_parameter"])
OF_A_VALUE = frozenset(["value", "string_value", "get_parameter_value"])


class Values(NamedTuple):
    """What names mean.

    Attributes
    ----------
    names
        Of the module, of a class (``self.x`` and ``Class.x``), of a function; a name that is given two different values
        means neither.
    parameters
        Of the module: name -> default.
    module
        The whole, to find what surrounds a call.
    """

    names: Mapping[str, ast.expr]
    parameters: Mapping[str, ast.expr]
    module: ast.Module

    @classmethod
    def of(cls, module: ast.Module) -> Values:
        """Return the values of a module: its own constants, and its parameters."""
        return cls(_assigned(module.body), dict(_parameters(module)), module)

    def inside(self, scope: ast.AST, call: ast.AST) -> Values:
        """Return what names mean where a call stands in a scope."""
        names = dict(self.names)
        if isinstance(scope, ast.ClassDef):
            own = _assigned(scope.body)
            names |= own | {f"self.{name}": value for name, value in own.items()}
            names |= {f"{scope.name}.{name}": value for name, value in own.items()}
            for function in ast.walk(scope):
                if isinstance(function, ast.FunctionDef):
                    given = _assigned(function.body)
                    names |= {name: value for name, value in given.items() if name.startswith("self.")}
        for function in ast.walk(scope):
            if isinstance(function, ast.FunctionDef) and any(one is call for one in ast.walk(function)):
                names |= _defaults(function) | _assigned(function.body)
        return self._replace(names=names)

    def of_node(self, node: ast.AST | None, depth: int = 0) -> str | None:
        """Return the text that an expression means, or None where it is not literal."""
        if node is None or depth > DEEPEST:
            return None
        name = name_of(node)
        text = None
        if name in self.names:
            return self.of_node(self.names[name], depth + 1)
        match node:
            case ast.Constant(value=str() | int() as value):
                text = str(value)
            case ast.JoinedStr(values=parts):
                text = self._joined(parts, depth)
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                text = self._joined([left, right], depth)
            case ast.Call():
                text = self._called(node, depth)
            case ast.FormattedValue(value=inner):
                text = self.of_node(inner, depth + 1)
            case ast.Attribute(value=inner, attr=last) if last in OF_A_VALUE:
                text = self.of_node(inner, depth + 1)
        return text

    def _called(self, call: ast.Call, depth: int) -> str | None:
        last = name_of(call.func).rpartition(".")[2] or getattr(call.func, "attr", "")
        if last in READS and call.args:
            parameter = self.of_node(call.args[0], depth + 1)
            return self.of_node(self.parameters.get(parameter or ""), depth + 1)
        if last in OF_A_VALUE and isinstance(call.func, ast.Attribute):
            return self.of_node(call.func.value, depth + 1)
        return self.of_node(call.args[0], depth + 1) if last == "str" and call.args else None

    def _joined(self, parts: list[ast.expr], depth: int) -> str | None:
        texts = [self.of_node(part, depth + 1) for part in parts]
        known = [text for text in texts if text is not None]
        return "".join(known) if len(known) == len(texts) else None


def name_of(node: ast.AST) -> str:
    """Return the dotted name that an expression is, or nothing.

    Examples
    --------
    >>> name_of(ast.parse("a.b", mode="eval").body)
    'a.b'
    >>> name_of(ast.parse("a().b", mode="eval").body)
    ''
    """
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        of = name_of(node.value)
        return f"{of}.{node.attr}" if of else ""
    return ""


def types_of(module: ast.Module) -> Mapping[str, str]:
    """Return what interface the imported names of a module mean.

    Examples
    --------
    >>> types_of(ast.parse("from sensor_msgs.msg import Image as Picture"))
    {'Picture': 'sensor_msgs/msg/Image'}
    """
    types: dict[str, str] = {}
    for node in ast.walk(module):
        if isinstance(node, ast.ImportFrom) and node.module:
            package, _, kind = node.module.partition(".")
            kind = kind.partition(".")[0]
            for one in node.names:
                if kind in INTERFACES:
                    types[one.asname or one.name] = f"{package}/{kind}/{one.name}"
                elif one.name in INTERFACES and not kind:
                    types[f"{one.asname or one.name}."] = f"{package}/{one.name}/"
        elif isinstance(node, ast.Import):
            for one in node.names:
                package, _, kind = one.name.partition(".")
                if kind in INTERFACES:
                    types[f"{one.asname or one.name}."] = f"{package}/{kind}/"
    return types


def type_of(node: ast.AST | None, types: Mapping[str, str]) -> str:
    """Return the interface type that an expression names, or nothing."""
    name = name_of(node) if node else ""
    of, _, last = name.rpartition(".")
    return types.get(name) or (types[f"{of}."] + last if f"{of}." in types else "")


def _parameters(module: ast.Module) -> Iterator[tuple[str, ast.expr]]:
    for call in ast.walk(module):
        last = getattr(call.func, "attr", "") if isinstance(call, ast.Call) else ""
        pair = call.args if isinstance(call, ast.Call) else []
        if last == "declare_parameter" and len(pair) > 1 and isinstance(pair[0], ast.Constant):
            yield str(pair[0].value), pair[1]
        elif last == "declare_parameters" and isinstance(call, ast.Call):
            lists = [*pair, *(word.value for word in call.keywords)]
            for several in (one for one in lists if isinstance(one, ast.List | ast.Tuple)):
                for each in several.elts:
                    match each:
                        case ast.Tuple(elts=[ast.Constant(value=name), default, *_]):
                            yield str(name), default


def _assigned(body: list[ast.stmt]) -> dict[str, ast.expr]:
    values: dict[str, ast.expr] = {}
    unclear = set()
    for node in _statements(body):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if node.value else []
        for target in targets:
            name = name_of(target)
            if name and node.value is not None:
                if name in values and ast.dump(values[name]) != ast.dump(node.value):
                    unclear.add(name)
                values[name] = node.value
    return {name: value for name, value in values.items() if name not in unclear}


def _statements(body: list[ast.stmt]) -> Iterator[ast.Assign | ast.AnnAssign]:
    """Return assignments, those in ``if`` and ``try`` too, those of functions and classes not."""
    for node in body:
        if isinstance(node, ast.Assign | ast.AnnAssign):
            yield node
        elif not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            inner = [one for one in ast.iter_child_nodes(node) if isinstance(one, ast.stmt | ast.ExceptHandler)]
            for one in inner:
                yield from _statements(one.body if isinstance(one, ast.ExceptHandler) else [one])


def _defaults(function: ast.FunctionDef) -> dict[str, ast.expr]:
    some = function.args
    late = some.args[len(some.args) - len(some.defaults) :]
    named = {one.arg: default for one, default in zip(late, some.defaults, strict=True)}
    return named | {one.arg: default for one, default in zip(some.kwonlyargs, some.kw_defaults, strict=True) if default}
