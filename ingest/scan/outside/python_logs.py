"""Python code -> calls of loggers and ``print`` with data of a channel, or with what was recognised; nothing is run.

Data is what a callback is given: of a subscription, a service or an action, of filters of messages, and what a client
gets back. What is recognised is what a library makes of pictures or speech, by ``ontology/libraries.yaml``. From there
it is followed through variables, attributes of ``self``, and functions of the same file. What only depends on it, such
as its length or whether it is equal to something, is not followed.

Source: the signatures of rclpy (``create_subscription``, ``create_service``, ``ActionServer``), of message_filters, and
of Python's ``logging``.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.python_tree import parts_of
from rosprivacy.ingest.scan.outside.value_flow import LIMIT, LoggedValue, Origin, ValueFlow

if TYPE_CHECKING:
    from collections.abc import Collection, Hashable, Iterator

    from rosprivacy.ingest.code.source_code import Code

Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
DEFINED = (ast.FunctionDef, ast.AsyncFunctionDef)
FUNCTIONS = (*DEFINED, ast.Lambda)
ASSIGNING = (ast.AnnAssign, ast.AugAssign, ast.NamedExpr)
LOOPS = (ast.For, ast.AsyncFor, ast.comprehension)
RETURNING = (ast.Return, ast.Yield)
PARTLY = (ast.Attribute, ast.Subscript, ast.Starred)  # of what a target is a part
PIECES = frozenset([ast.Call, ast.Assign, ast.withitem, *FUNCTIONS, *ASSIGNING, *LOOPS, *RETURNING])  # move values
Variable = tuple[object, str]  # (scope, name)
Atoms = dict[Variable, str]  # variables of an expression, each as it is written there
CALLBACKS = {  # call -> place and keyword of its callback, first parameter of that which is data
    "create_subscription": (2, "callback"),
    "create_service": (2, "callback"),
    "ActionServer": (3, "execute_callback"),
}
ALWAYS_DATA = ("feedback_callback", "goal_callback")  # keywords, wherever they stand
CLIENTS = ("create_client", "ActionClient", "Subscriber")
RECOGNISING = ("transcribe", "recognize", "PartialResult", "FinalResult")  # methods, whatever they are called on
BEGINNING = (*CALLBACKS, *ALWAYS_DATA, *CLIENTS, *RECOGNISING)  # words without which no data begins
LEVELS = frozenset(["debug", "info", "warn", "warning", "error", "fatal", "critical", "exception", "log"])
PRINTING = ("print", "pprint", "sys.stdout.write", "sys.stderr.write")
METADATA = ("header", "frame_id", "stamp", "child_frame_id")  # of messages: of nobody
MEASURES = frozenset(["len", "type", "isinstance", "bool", "hasattr", "id", "range", "callable"])


class _Scope(NamedTuple):
    """A function with the one around it, its class, and the names that it binds."""

    key: object
    above: _Scope | None
    of_class: str
    names: Collection[str]


def python_logs(text: str, tree: ast.Module, code: Code, recognised: Collection[int]) -> tuple[LoggedValue, ...]:
    """Return the log calls of one file; none where no data begins in it.

    Parameters
    ----------
    code
        What was read of it: its imports and units.
    recognised
        Lines with uses of libraries that recognise something.
    """
    begins = recognised or any(word in text for word in BEGINNING)
    return _PythonLogs(tree, code, recognised).logged() if begins else ()


class _PythonLogs:
    """Reads the log calls of one file."""

    def __init__(self, tree: ast.Module, code: Code, recognised: Collection[int]) -> None:
        self.flow = ValueFlow()
        self._recognised, self._units = recognised, code.units
        self._functions: dict[tuple[str, str], Function] = {}  # by class and name
        self._scopes: dict[int, _Scope] = {}
        self._bases: dict[str, str] = {}
        self._imported = {name for name, _ in code.imports}
        self._families: dict[str, str] = {}  # what is looked up is remembered
        self._sinks: list[tuple[int, Hashable, Atoms]] = []
        self._filters: list[int] = []  # lines of subscribers of message_filters
        self._clients: dict[Variable, set[int]] = defaultdict(set)  # clients: variable -> lines of their making
        pieces = [(node, scope) for node, scope in self._walk(tree) if type(node) in PIECES]
        for node, scope in pieces:
            self._note(node, scope)
        for node, scope in pieces:
            self._read(node, scope)

    def logged(self) -> tuple[LoggedValue, ...]:
        """Return the calls, by line."""
        origins = self.flow.origins()
        found = []
        for line, sink, atoms in self._sinks:
            if own := origins.get(sink):
                words = dict.fromkeys(text for variable, text in atoms.items() if variable in origins and text)
                unit = next((one.name for one in self._units if one.lines.first <= line <= one.lines.last), "")
                found.append(LoggedValue(unit, line, tuple(sorted(own)), ", ".join(words)))
        return tuple(sorted(found))

    def _walk(self, tree: ast.Module) -> Iterator[tuple[ast.AST, _Scope]]:
        """All pieces, each with the function that it stands in."""
        top = _Scope("", None, "", ())
        waiting: list[tuple[ast.AST, _Scope]] = [(tree, top)]
        while waiting:
            node, scope = waiting.pop()
            yield node, scope
            inside = scope
            if isinstance(node, FUNCTIONS):
                self._scopes[id(node)] = inside = _Scope(id(node), scope, scope.of_class, _bound(node))
            elif isinstance(node, ast.ClassDef):
                inside = scope._replace(of_class=node.name)
                base = next((base.id for base in node.bases if isinstance(base, ast.Name)), "")
                self._bases[node.name] = base
            waiting += [(child, inside) for child in parts_of(node)]

    def _family(self, name: str) -> str:
        """The class of this file that a class is derived from in the end: they share ``self``."""
        passed = [name]
        while passed[-1] not in self._families and (base := self._bases.get(passed[-1], "")) in self._bases:
            if base in passed[-1:] or len(passed) > LIMIT:
                break
            passed.append(base)
        root = self._families.get(passed[-1], passed[-1])
        self._families.update(dict.fromkeys(passed, root))
        return root

    def _note(self, node: ast.AST, scope: _Scope) -> None:
        """Note functions by name, and what clients are kept in."""
        if isinstance(node, DEFINED):
            self._functions[self._family(scope.of_class), node.name] = node
        elif isinstance(node, ast.Call) and _last(node.func) == "Subscriber":
            self._filters.append(node.lineno)
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and _last(node.value.func) in CLIENTS:
            for variable in (self._variable(target, scope) for target in node.targets):
                if variable is not None:
                    self._clients[variable].add(node.value.lineno)

    def _read(self, node: ast.AST, scope: _Scope) -> None:
        if isinstance(node, ast.Assign):
            for target in node.targets:
                self._assign(target, node.value, scope)
        elif isinstance(node, ASSIGNING):
            if node.value is not None:
                self._assign(node.target, node.value, scope)
        elif isinstance(node, LOOPS):
            self._assign(node.target, node.iter, scope)
        elif isinstance(node, ast.withitem):
            if node.optional_vars is not None:
                self._assign(node.optional_vars, node.context_expr, scope)
        elif isinstance(node, RETURNING):
            if node.value is not None:
                self._into(node.value, ("return", scope.key), scope)
        elif isinstance(node, ast.Lambda):
            inside = self._scopes[id(node)]
            self._into(node.body, ("return", inside.key), inside)
        elif isinstance(node, ast.Call):
            self._call(node, scope)

    def _assign(self, target: ast.expr, value: ast.expr, scope: _Scope) -> None:
        pairs = [(target, value)]
        while pairs:
            target, value = pairs.pop()
            if isinstance(target, ast.Tuple | ast.List):
                same = isinstance(value, ast.Tuple | ast.List) and len(value.elts) == len(target.elts)
                values = value.elts if same and isinstance(value, ast.Tuple | ast.List) else [value] * len(target.elts)
                pairs += zip(target.elts, values, strict=True)
            elif (variable := self._variable(target, scope)) is not None:
                self._into(value, variable, scope)

    def _into(self, value: ast.expr, target: Hashable, scope: _Scope) -> Atoms:
        atoms = self._atoms(value, scope)
        for variable in atoms:
            self.flow.step(variable, target)
        if value.lineno in self._recognised:
            self.flow.begin(target, Origin(value.lineno, recognised=True))
        return atoms

    def _variable(self, node: ast.AST, scope: _Scope) -> Variable | None:
        """What a target is a part of: a name, or an attribute of ``self``."""
        attribute = ""
        while isinstance(node, PARTLY):
            attribute = node.attr if isinstance(node, ast.Attribute) else attribute
            node = node.value
        if not isinstance(node, ast.Name):
            return None
        if node.id == "self" and scope.of_class:
            return f"class {self._family(scope.of_class)}", attribute
        return _owner(node.id, scope), node.id

    def _atoms(self, value: ast.expr, scope: _Scope) -> Atoms:
        """The variables, and returns of functions, that a value is made of."""
        found: Atoms = {}
        waiting: list[ast.AST] = [value]
        while waiting:
            node = waiting.pop()
            if isinstance(node, (ast.Compare, ast.Lambda, ast.Constant)):
                continue
            if isinstance(node, (ast.Attribute, ast.Name)):
                if any(part in METADATA for part in _dotted(node).split(".")[1:]):
                    continue
                if (variable := self._variable(node, scope)) is not None:
                    found.setdefault(variable, _dotted(node))
                elif isinstance(node, ast.Attribute):
                    waiting.append(node.value)
            elif isinstance(node, ast.Call):
                if _last(node.func) in MEASURES:
                    continue
                waiting += self._atoms_of_call(node, scope, found)
            elif isinstance(node, ast.IfExp):
                waiting += [node.body, node.orelse]
            else:
                waiting += parts_of(node)
        return found

    def _atoms_of_call(self, node: ast.Call, scope: _Scope, atoms: Atoms) -> list[ast.AST]:
        """Note where the result of a call comes from; return what else it is made of."""
        result = ("call", str(id(node)))
        last = _last(node.func)
        if node.lineno in self._recognised or last.startswith(RECOGNISING):
            self.flow.begin(result, Origin(node.lineno, recognised=True))
            atoms[result] = _dotted(node.func)
        function = self._function(node.func, scope)
        if function is not None:
            atoms["return", str(id(function))] = _dotted(node.func)
            self.flow.step(("return", id(function)), ("return", str(id(function))))
            return []
        receiver = node.func.value if isinstance(node.func, ast.Attribute) else None
        if receiver is not None and (variable := self._variable(receiver, scope)) in self._clients:
            for line in self._clients[variable] if variable else ():
                self.flow.begin(result, Origin(line))
            atoms[result] = _dotted(node.func)
            return []
        return [*([receiver] if receiver is not None else [node.func]), *node.args, *(k.value for k in node.keywords)]

    def _function(self, node: ast.AST, scope: _Scope) -> Function | None:
        """The function of this file that is meant: ``self.go``, ``go``, a lambda."""
        if isinstance(node, ast.Lambda):
            return node
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
            return self._functions.get((self._family(scope.of_class), node.attr))
        if isinstance(node, ast.Name):
            name = node.id
            return self._functions.get((self._family(scope.of_class), name)) or self._functions.get(("", name))
        return None

    def _call(self, node: ast.Call, scope: _Scope) -> None:
        last = _last(node.func)
        callback = CALLBACKS.get(last)
        if callback:
            self._callback(_argument(node, *callback), scope, [Origin(node.lineno)])
        for keyword in node.keywords:
            if keyword.arg in ALWAYS_DATA:
                self._callback(keyword.value, scope, [Origin(line) for line in self._lines(node, scope)])
        if last == "registerCallback" and node.args:
            self._callback(node.args[0], scope, [Origin(line) for line in self._filters], every=True)
        elif last == "add_done_callback" and node.args and isinstance(node.func, ast.Attribute):
            for parameter in self._parameters(node.args[0], scope)[:1]:
                self._into(node.func.value, parameter, scope)
        if _is_log(node):
            self._sink(node, scope)
        elif (function := self._function(node.func, scope)) is not None:
            self._pass(node, function, scope)
        elif isinstance(node.func, ast.Attribute):
            self._fill(node.func.value, node.args, scope)

    def _fill(self, receiver: ast.expr, values: Collection[ast.expr], scope: _Scope) -> None:
        """What a method of something is given may be kept in it; a module and the node itself keep nothing."""
        filled = self._variable(receiver, scope)
        if filled is not None and filled[1] and (filled[0] or filled[1] not in self._imported):
            for value in values:
                self._into(value, filled, scope)

    def _lines(self, node: ast.Call, scope: _Scope) -> Collection[int]:
        """Where the client that is called was made, or the call itself."""
        receiver = node.func.value if isinstance(node.func, ast.Attribute) else None
        variable = self._variable(receiver, scope) if receiver is not None else None
        return (self._clients.get(variable) if variable else None) or [node.lineno]

    def _sink(self, node: ast.Call, scope: _Scope) -> None:
        sink = ("log", id(node))
        atoms: Atoms = {}
        for value in (*node.args, *(keyword.value for keyword in node.keywords)):
            atoms |= self._into(value, sink, scope)
        self._sinks.append((node.lineno, sink, atoms))

    def _pass(self, node: ast.Call, function: Function, scope: _Scope) -> None:
        """Arguments of a call get into the parameters of the function, and back what it puts into a list."""
        inside = self._scopes[id(function)]
        pairs = [*zip(_parameters_of(function), node.args, strict=False)]
        pairs += [(keyword.arg, keyword.value) for keyword in node.keywords if keyword.arg]
        for name, value in pairs:
            self._into(value, (inside.key, name), scope)
            if isinstance(value, ast.Attribute | ast.Name) and (variable := self._variable(value, scope)) is not None:
                self.flow.step((inside.key, name), variable)

    def _callback(self, node: ast.expr | None, scope: _Scope, origins: list[Origin], *, every: bool = False) -> None:
        """The first parameter of a callback that is not bound before, or each, is data."""
        parameters = self._parameters(node, scope) if node is not None else []
        for parameter in parameters if every else parameters[:1]:
            for origin in origins:
                self.flow.begin(parameter, origin)

    def _parameters(self, node: ast.expr, scope: _Scope) -> list[Variable]:
        """The parameters of a callback that are given when it is called."""
        bound = 0
        if isinstance(node, ast.Call) and _last(node.func) == "partial" and node.args:
            bound = len(node.args) - 1
            node = node.args[0]
        function = self._function(node, scope)
        if function is None:
            return []
        return [(id(function), name) for name in _parameters_of(function)[bound:]]


def _bound(function: Function) -> Collection[str]:
    """The names that a function binds: parameters, and what is assigned in it."""
    every = function.args
    listed = [*every.posonlyargs, *every.args, *every.kwonlyargs, every.vararg, every.kwarg]
    names = {argument.arg for argument in listed if argument}
    body: list[ast.AST] = [] if isinstance(function, ast.Lambda) else list(function.body)
    elsewhere: set[str] = set()
    while body:
        node = body.pop()
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.Global | ast.Nonlocal):
            elsewhere.update(node.names)
        if not isinstance(node, (*FUNCTIONS, ast.ClassDef)):
            body += parts_of(node)
    return names - elsewhere


def _owner(name: str, scope: _Scope) -> object:
    """The key of the function that binds a name; of no function, that of the module."""
    here: _Scope | None = scope
    while here is not None and here.above is not None:
        if name in here.names:
            return here.key
        here = here.above
    return ""


def _parameters_of(function: Function) -> list[str]:
    names = [argument.arg for argument in (*function.args.posonlyargs, *function.args.args)]
    return names[1:] if names[:1] in (["self"], ["cls"]) else names


def _last(node: ast.AST) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _dotted(node: ast.AST) -> str:
    """``msg.data`` of what is written so; of a longer chain what is behind its last call."""
    parts = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    parts += [node.id] if isinstance(node, ast.Name) else []
    return ".".join(reversed(parts))


def _argument(call: ast.Call, place: int, name: str) -> ast.expr | None:
    if len(call.args) > place and not any(isinstance(one, ast.Starred) for one in call.args[: place + 1]):
        return call.args[place]
    return next((one.value for one in call.keywords if one.arg == name), None)


def _is_log(call: ast.Call) -> bool:
    """Whether a call writes into a log or on a terminal."""
    if _dotted(call.func) in PRINTING:
        return True
    if not isinstance(call.func, ast.Attribute) or call.func.attr not in LEVELS:
        return False
    receiver = call.func.value
    name = _last(receiver.func) if isinstance(receiver, ast.Call) else _last(receiver)
    return "log" in name.lower()
