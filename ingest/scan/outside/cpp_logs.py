"""C++ code -> calls of loggers, streams and ``printf`` with data of a channel, or with what was recognised.

Data is what a callback is given, of a subscription, a service or an action, whether it is bound (``std::bind``), a
lambda or a function. It is followed through variables, members of the class, and functions of the same file, by their
names alone: tree-sitter's tree has no types. No recursion over code, nothing is built.

Source: ``rclcpp/logging.hpp`` (the macros), the signatures of rclcpp and rclcpp_action; the headers of spdlog and glog.
"""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.cpp_tree import arguments_of, brief, last_of, line_of, names_of, path_of
from rosprivacy.ingest.scan.outside.value_flow import LoggedValue, Origin, ValueFlow

if TYPE_CHECKING:
    from collections.abc import Collection, Hashable, Iterable, Iterator

    from tree_sitter import Node

    from rosprivacy.ingest.code.source_code import Where

MACRO = re.compile(r"(?:RCLCPP|RCUTILS_LOG|ROS)_(?:DEBUG|INFO|WARN|ERROR|FATAL)\w*|SPDLOG_\w+|P?LOG\w*")
PRINTING = frozenset(["printf", "fprintf", "puts", "fputs", "println", "print"])
LEVELS = frozenset(["trace", "debug", "info", "warn", "error", "critical"])
STREAMS = frozenset(["cout", "cerr", "clog", "LOG"])
MAKERS = {"create_subscription": -1, "create_service": -1, "create_server": -1, "create_generic_subscription": -1}
FUNCTIONS = ("function_definition", "lambda_expression")
KINDS = frozenset(  # of pieces that say something
    ["declaration", "for_range_loop", "init_declarator", "assignment_expression", "return_statement", "call_expression",
     "expression_statement", *FUNCTIONS]
)  # fmt: skip
METADATA = re.compile(r"\W(?:header|stamp|frame_id|child_frame_id)\b")  # of messages: of nobody
MEASURES = frozenset(["size", "length", "empty", "sizeof", "use_count"])
COMPARING = frozenset(["==", "!=", "<", ">", "<=", ">=", "&&", "||"])
Variable = tuple[object, str]


class _Function(NamedTuple):
    """A function or lambda: its key, its class, and its parameters in their order."""

    key: int
    of_class: str
    parameters: tuple[str, ...]


def cpp_logs(data: bytes, pieces: Iterable[tuple[Node, Where]], recognised: Collection[int]) -> tuple[LoggedValue, ...]:
    """Return the log calls of one file; none where no data begins in it.

    Parameters
    ----------
    pieces
        In the order of the text.
    recognised
        Lines with uses of libraries that recognise something.
    """
    begins = recognised or any(name.encode() in data for name in MAKERS)
    return _CppLogs(pieces, recognised).logged() if begins else ()


class _CppLogs:
    """Reads the log calls of one file."""

    def __init__(self, pieces: Iterable[tuple[Node, Where]], recognised: Collection[int]) -> None:
        self.flow = ValueFlow()
        self._recognised = recognised
        self._functions: dict[str, list[_Function]] = defaultdict(list)  # by name
        self._lambdas: dict[int, _Function] = {}
        self._local: dict[int, set[str]] = defaultdict(set)  # by function: what is declared in it
        self._sinks: list[tuple[str, int, Hashable, dict[Variable, str]]] = []
        self._outer: dict[int, tuple[int, ...]] = {}  # functions around each
        placed = list(self._placed(pieces))
        for node, where, around in placed:
            self._declare(node, where, around)
        for node, where, around in placed:
            self._read(node, where, around)

    def logged(self) -> tuple[LoggedValue, ...]:
        """Return the calls, by line."""
        origins = self.flow.origins()
        found = set()
        for unit, line, sink, atoms in self._sinks:
            if own := origins.get(sink):
                words = dict.fromkeys(text for variable, text in atoms.items() if variable in origins)
                found.add(LoggedValue(unit, line, tuple(sorted(own)), ", ".join(words)))
        return tuple(sorted(found))

    def _placed(self, pieces: Iterable[tuple[Node, Where]]) -> Iterator[tuple[Node, Where, int]]:
        """The pieces that say something, each with the function that it stands in; 0 for none."""
        functions: list[tuple[int, int]] = []  # around the piece: where each ends
        for node, where in pieces:
            kind = node.type
            if kind not in KINDS:
                continue
            while functions and functions[-1][1] <= node.start_byte:
                functions.pop()
            around = functions[-1][0] if functions else 0
            yield node, where, around
            if kind in FUNCTIONS:
                functions.append((node.id, node.end_byte))
                self._outer[node.id] = (around, *self._outer.get(around, ())[:8]) if around else ()

    def _declare(self, node: Node, where: Where, around: int) -> None:
        if node.type in FUNCTIONS:
            declarator = _function_declarator(node)
            listed = declarator.child_by_field_name("parameters") if declarator else None
            names = tuple(_declared(one) for one in (arguments_of(listed) if listed else ()))
            called = declarator.child_by_field_name("declarator") if declarator else None
            path = names_of(called) if called is not None else [""]
            of_class = path[-2] if len(path) > 1 else where.of_class
            function = _Function(node.id, of_class, names)
            self._local[node.id].update(names)
            if node.type == "lambda_expression":
                self._lambdas[node.id] = function
            else:
                self._functions[path[-1]].append(function)
        elif node.type == "declaration" and around:
            for one in node.children_by_field_name("declarator"):
                self._local[around].add(_declared(one))
        elif node.type == "for_range_loop" and around and (ranged := node.child_by_field_name("declarator")):
            self._local[around].add(_declared(ranged))

    def _read(self, node: Node, where: Where, around: int) -> None:
        kind = node.type
        if kind == "init_declarator":
            self._assign(node.child_by_field_name("declarator"), node.child_by_field_name("value"), where, around)
        elif kind == "assignment_expression":
            self._assign(node.child_by_field_name("left"), node.child_by_field_name("right"), where, around)
        elif kind == "for_range_loop":
            self._assign(node.child_by_field_name("declarator"), node.child_by_field_name("right"), where, around)
        elif kind == "return_statement" and around:
            for value in node.named_children:
                self._into(value, ("return", around), where, around)
        elif kind == "call_expression":
            self._call(node, where, around)
        elif kind == "expression_statement":
            self._stream(node, where, around)

    def _assign(self, target: Node | None, value: Node | None, where: Where, around: int) -> None:
        name = _base(target) if target is not None else ""
        if name and value is not None:
            self._into(value, self._variable(name, where, around), where, around)

    def _variable(self, name: str, where: Where, around: int) -> Variable:
        """The variable of a name: of the function, or lambda, that declares it, or else a member of the class."""
        for function in (around, *self._outer.get(around, ())):
            if name in self._local.get(function, ()):
                return function, name
        return f"class {where.of_class}", name

    def _into(self, value: Node, target: Hashable, where: Where, around: int) -> dict[Variable, str]:
        atoms = self._atoms(value, where, around)
        for variable in atoms:
            self.flow.step(variable, target)
        return atoms

    def _atoms(self, value: Node, where: Where, around: int) -> dict[Variable, str]:
        """The variables, and returns of functions, that a value is made of."""
        found: dict[Variable, str] = {}
        waiting = [value]
        while waiting:
            node = waiting.pop()
            kind = node.type
            if kind == "lambda_expression" or kind.endswith(("_literal", "type_descriptor")):
                continue
            if kind == "identifier":
                name = brief(node)
                found.setdefault(self._variable(name, where, around), name)
            elif kind == "field_expression":
                base = _base(node)
                if METADATA.search(brief(node)):
                    continue
                if base:
                    found.setdefault(self._variable(base, where, around), brief(node).replace("->", "."))
                elif (inner := node.child_by_field_name("argument")) is not None:
                    waiting.append(inner)
            elif kind == "binary_expression" and _operator(node) in COMPARING:
                continue
            elif kind == "call_expression":
                waiting += self._atoms_of_call(node, found)
            else:
                waiting += node.named_children
        return found

    def _atoms_of_call(self, node: Node, atoms: dict[Variable, str]) -> list[Node]:
        """Note where the result of a call comes from; return what else it is made of."""
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        if function is None:
            return []
        last = path_of(function)[0][-1]
        if last in MEASURES:
            return []
        if line_of(node) in self._recognised:
            result = ("call", str(node.id))
            self.flow.begin(result, Origin(line_of(node), recognised=True))
            atoms[result] = last
        for one in self._functions.get(last, ()):
            result = ("return", str(one.key))
            self.flow.step(("return", one.key), result)
            atoms[result] = last
        receiver = function.child_by_field_name("argument") if function.type == "field_expression" else None
        return [*([receiver] if receiver is not None else []), *(arguments_of(arguments) if arguments else [])]

    def _call(self, node: Node, where: Where, around: int) -> None:
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        if function is None or arguments is None:
            return
        path, _, _ = path_of(function)
        last, listed = path[-1], arguments_of(arguments)
        if last in MAKERS:
            for one in listed:
                self._callback(one, Origin(line_of(node)))
        elif MACRO.fullmatch(last) or last in PRINTING or (last in LEVELS and "spdlog" in path) or _of_logger(function):
            self._sink(node, listed, where, around)
        else:
            for own in self._functions.get(last, ()):
                for name, value in zip(own.parameters, listed, strict=False):
                    self._into(value, (own.key, name), where, around)
            self._fill(function, listed, where, around)

    def _fill(self, function: Node, values: list[Node], where: Where, around: int) -> None:
        """What a method is given may be kept in its object; what a function is given, in what it is given as well."""
        base = _base(function) if function.type == "field_expression" else ""
        outs = {_base(value) for value in values if value.type == "pointer_expression"}
        if function.type == "qualified_identifier":
            outs |= {brief(value) for value in values if value.type == "identifier"}
        for name in {base, *outs} - {""}:
            for value in values:
                self._into(value, self._variable(name, where, around), where, around)
        for name in outs - {""} if base else ():
            self.flow.step(self._variable(base, where, around), self._variable(name, where, around))

    def _callback(self, node: Node, origin: Origin) -> None:
        """All parameters of a function that is bound, or of a lambda, that stand among the arguments are data."""
        waiting = [node]
        functions: list[_Function] = []
        while waiting:
            one = waiting.pop()
            if one.type == "lambda_expression":
                functions += [self._lambdas[one.id]] if one.id in self._lambdas else []
            elif one.type in ("qualified_identifier", "identifier"):
                functions += self._functions.get(last_of(one), [])
            else:
                waiting += one.named_children
        for function in functions:
            for name in function.parameters:
                self.flow.begin((function.key, name), origin)

    def _sink(self, node: Node, values: list[Node], where: Where, around: int) -> None:
        sink = ("log", node.id)
        atoms: dict[Variable, str] = {}
        for value in values:
            atoms |= self._into(value, sink, where, around)
        self._sinks.append((where.of_class, line_of(node), sink, atoms))

    def _stream(self, node: Node, where: Where, around: int) -> None:
        """``std::cout << a << b``, from its outside: the name of the stream stands leftmost."""
        top = next(iter(node.named_children), None)
        values: list[Node] = []
        here: Node | None = top
        while here is not None and here.type == "binary_expression" and _operator(here) == "<<":
            right = here.child_by_field_name("right")
            values += [right] if right is not None else []
            here = here.child_by_field_name("left")
        if here is None or not values:
            return
        name = here.child_by_field_name("function") if here.type == "call_expression" else here
        if name is not None and name.type in ("identifier", "qualified_identifier") and last_of(name) in STREAMS:
            self._sink(node, values, where, around)


def _function_declarator(node: Node) -> Node | None:
    """The part of a function with its parameters."""
    here = node.child_by_field_name("declarator")
    while here is not None and here.child_by_field_name("parameters") is None:
        inside = here.child_by_field_name("declarator")
        here = inside or next((child for child in here.named_children if child.type == "function_declarator"), None)
    return here


def _declared(node: Node) -> str:
    """The name that a parameter or declaration declares; empty where it has none."""
    here: Node | None = node
    while here is not None and here.type not in ("identifier", "field_identifier"):
        here = here.child_by_field_name("declarator") or next(
            (child for child in here.named_children if child.type in DECLARATORS), None
        )
    return brief(here) if here is not None else ""


DECLARATORS = (
    "identifier", "reference_declarator", "pointer_declarator", "init_declarator", "array_declarator",
    "function_declarator",
)  # fmt: skip


def _base(node: Node) -> str:
    """The variable that ``a->b.c[0]``, ``*a`` or ``this->a`` is a part of; empty where it begins with a call."""
    here: Node | None = node
    field = ""
    while here is not None:
        if here.type in ("identifier", "field_identifier"):
            return brief(here)
        if here.type == "this":
            return field
        if here.type == "field_expression":
            inside = here.child_by_field_name("field")
            field = brief(inside) if inside is not None else ""
        if here.type == "call_expression":
            return ""
        here = here.child_by_field_name("argument") or next(iter(here.named_children), None)
    return ""


def _operator(node: Node) -> str:
    sign = node.child_by_field_name("operator")
    return sign.type if sign is not None else ""


def _of_logger(function: Node) -> bool:
    """``logger->info(…)`` of spdlog."""
    if function.type != "field_expression":
        return False
    field, argument = function.child_by_field_name("field"), function.child_by_field_name("argument")
    return bool(field and argument and brief(field) in LEVELS and "log" in brief(argument).lower())
