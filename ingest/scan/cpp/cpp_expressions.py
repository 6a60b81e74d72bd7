"""Expressions of C++ as plain data: what can be a name, a node or an object; all else is open, with its reason.

In: pieces of a syntax tree. Out: an ``Expression``, at most ``DEEP`` levels of it, and texts of types.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.cpp_tree import arguments_of, line_of, text_of

if TYPE_CHECKING:
    from tree_sitter import Node

DEEP = 12  # levels of an expression that are read
LONGEST = 300  # signs of what is shown of an expression
TYPE_NAME = re.compile(r"[A-Za-z_]\w*(?:\s*::\s*[A-Za-z_]\w*)*", re.ASCII)
POINTERS = ("shared_ptr", "unique_ptr", "weak_ptr", "optional", "RealtimeBuffer")
OF_POINTERS = ("SharedPtr", "ConstSharedPtr", "UniquePtr", "WeakPtr")
MAKERS = ("make_shared", "make_unique")
TRANSPARENT = frozenset(  # functions and methods that give on what they get
    """
    move forward unique_ptr shared_ptr SharedPtr UniquePtr string std::string String string_view c_str str
    data get lock shared_from_this static_pointer_cast dynamic_pointer_cast const_pointer_cast static_cast
    dynamic_cast reinterpret_cast const_cast ref cref value get_node_base_interface get_node_topics_interface
    get_node_services_interface get_node_parameters_interface get_node_timers_interface
    get_node_graph_interface get_node_clock_interface get_node_logging_interface get_node_waitables_interface
    get_rclcpp_node get_raw_node ParameterValue to_string as_string get_value value_to_string string_value
    toStdString get_parameter_value
    """.split()  # noqa: SIM905 - to be read as a text
)
ESCAPES = {"n": "\n", "t": "\t", '"': '"', "\\": "\\", "'": "'", "0": "\0"}


class Text(NamedTuple):
    """A literal."""

    text: str
    string: bool = True


class Ref(NamedTuple):
    """A plain name: a variable, a constant, ``this``."""

    name: str


class Member(NamedTuple):
    """``of.name``, ``of->name``."""

    of: Expression
    name: str


class Call(NamedTuple):
    """A call.

    Attributes
    ----------
    name
        As it is written, ``rclcpp_action::create_client``.
    types
        Template arguments.
    of
        What it is called on; None where nothing stands before it.
    start
        Byte that tells it from others of its file.
    """

    name: str
    types: tuple[str, ...]
    of: Expression | None
    arguments: tuple[Expression, ...]
    line: int
    start: int

    @property
    def last(self) -> str:
        """The name without its namespaces."""
        return self.name.rpartition("::")[2]


class Construction(NamedTuple):
    """An object that is made: ``std::make_shared<T>(…)``, ``new T(…)``, ``T name(…)``, ``name_(…)`` of a member."""

    type: str
    arguments: tuple[Expression, ...]
    line: int
    start: int


class Sum(NamedTuple):
    """One text after the other."""

    parts: tuple[Expression, ...]


class Choice(NamedTuple):
    """One of several."""

    parts: tuple[Expression, ...]


class Items(NamedTuple):
    """``{a, b}``."""

    parts: tuple[Expression, ...]


class Item(NamedTuple):
    """Any element of a container, or the one at a place of a pair."""

    of: Expression
    at: int | None = None


class Out(NamedTuple):
    """What a call gives to the variable that is its argument at a place, by reference."""

    call: Call
    at: int


class Open(NamedTuple):
    """What the sources do not fix."""

    why: str


Expression = Text | Ref | Member | Call | Construction | Sum | Choice | Items | Item | Out | Open
Path = tuple[str, ...]


def shown_code(node: Node) -> str:
    """Return what is shown of a piece of code, on one line."""
    text = " ".join(text_of(node).split())
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}…"


def expression(node: Node | None, deep: int = 0) -> Expression:  # noqa: PLR0911, PLR0912 - a table of kinds
    """Return what a piece of code is, as far as a name, a node or an object can be made of it."""
    while node is not None and node.type in ("parenthesized_expression", "pointer_expression", "condition_clause"):
        node = node.child_by_field_name("argument") or node.child_by_field_name("value") or _first(node)
    if node is None or deep > DEEP:
        return Open("an expression that is nested too deeply" if node else "nothing")
    kind, deeper = node.type, deep + 1
    if kind in ("string_literal", "raw_string_literal", "concatenated_string", "user_defined_literal"):
        return _literal(node, deeper)
    if kind in ("number_literal", "true", "false", "char_literal"):
        return Text(text_of(node).strip("'"), string=kind == "char_literal")
    if kind in ("identifier", "field_identifier", "this", "qualified_identifier", "namespace_identifier"):
        return Ref(_plain_name(node))
    if kind == "field_expression":
        field = node.child_by_field_name("field")
        of = expression(node.child_by_field_name("argument"), deeper)
        return Member(of, _plain_name(field)) if field is not None else Open(shown_code(node))
    if kind == "call_expression":
        return call(node, deeper)
    if kind in ("new_expression", "compound_literal_expression"):
        return _construction(node, deeper)
    if kind == "binary_expression":
        return _sum(node, deeper)
    if kind == "conditional_expression":
        fields = ("consequence", "alternative")
        return Choice(tuple(expression(node.child_by_field_name(name), deeper) for name in fields))
    if kind in ("initializer_list", "argument_list"):
        return Items(tuple(expression(child, deeper) for child in arguments_of(node)))
    if kind == "subscript_expression":
        return Item(expression(node.child_by_field_name("argument"), deeper))
    if kind in ("cast_expression", "assignment_expression"):
        return expression(node.child_by_field_name("value") or node.child_by_field_name("right"), deeper)
    return Open(shown_code(node))


def call(node: Node, deep: int = 0) -> Expression:
    """Return what a call is: of a function, or one that makes an object."""
    function, given = node.child_by_field_name("function"), node.child_by_field_name("arguments")
    if function is None or given is None:
        return Open(shown_code(node))
    of = None
    if function.type == "field_expression":
        of = expression(function.child_by_field_name("argument"), deep + 1)
        function = function.child_by_field_name("field") or function
    name, types = _callee(function)
    arguments = tuple(expression(child, deep + 1) for child in arguments_of(given))
    scope, _, last = name.rpartition("::")
    if last in MAKERS and (types or scope not in ("", "std", "boost")):
        kind = types[0] if types else scope
        return Construction(kind, arguments, line_of(node), node.start_byte)
    return Call(name, types, of, arguments, line_of(node), node.start_byte)


def _callee(function: Node) -> tuple[str, Path]:
    """The name and the template arguments of ``a::b<T>``; also of ``template b<T>``."""
    scopes: list[str] = []
    node = function
    for _ in range(DEEP):
        if node.type == "dependent_name":
            node = _first(node) or node
        elif node.type == "qualified_identifier" and (name := node.child_by_field_name("name")) is not None:
            scope = node.child_by_field_name("scope")
            scopes += [text_of(scope)] if scope is not None else []
            node = name
        else:
            break
    name, arguments = node.child_by_field_name("name"), node.child_by_field_name("arguments")
    types = tuple(text_of(child) for child in arguments_of(arguments)) if arguments is not None else ()
    return "::".join([*scopes, _plain_name(name if name is not None else node)]), types


def _construction(node: Node, deep: int) -> Expression:
    kind = node.child_by_field_name("type")
    given = node.child_by_field_name("arguments") or node.child_by_field_name("value")
    arguments = tuple(expression(child, deep) for child in arguments_of(given)) if given is not None else ()
    return Construction(text_of(kind) if kind is not None else "", arguments, line_of(node), node.start_byte)


def _sum(node: Node, deep: int) -> Expression:
    """``a + b + c``, which the grammar nests to the left, without a level for each."""
    parts: list[Expression] = []
    while node.type == "binary_expression":
        operator, right = node.child_by_field_name("operator"), node.child_by_field_name("right")
        left = node.child_by_field_name("left")
        if operator is None or text_of(operator) != "+" or left is None:
            return Open(shown_code(node))
        parts.append(expression(right, deep))
        node = left
    return Sum((expression(node, deep), *reversed(parts)))


def _literal(node: Node, deep: int) -> Expression:
    if node.type == "user_defined_literal":
        return expression(_first(node), deep)
    if node.type == "concatenated_string":
        return Sum(tuple(expression(child, deep) for child in arguments_of(node)))
    text = ""
    for child in node.named_children:
        if child.type == "escape_sequence":
            sign = ESCAPES.get(text_of(child)[1:])
            if sign is None:
                return Open(shown_code(node))
            text += sign
        elif child.type in ("string_content", "raw_string_content"):
            text += text_of(child)
    return Text(text)


def _first(node: Node) -> Node | None:
    return next((child for child in node.named_children if child.type != "comment"), None)


def _plain_name(node: Node) -> str:
    text = text_of(node)
    return "".join(text.split()) if len(text) <= LONGEST else "?"


def type_parts(written: str) -> tuple[str, Path]:
    """Return the name and the template arguments of a type, of a pointer those of what it points to.

    >>> type_parts("const std::shared_ptr<demo::Client<demo::srv::Go>> &")
    ('demo::Client', ('demo::srv::Go',))
    >>> type_parts("rclcpp::Node::SharedPtr"), type_parts("typename T::Goal")
    (('rclcpp::Node', ()), ('T::Goal', ()))
    """
    for _ in range(DEEP):
        match = TYPE_NAME.search(re.sub(r"\b(?:const|typename|mutable|static|class|struct)\b", " ", written[:2000]))
        if match is None:
            return "", ()
        plain = re.sub(r"\b(?:const|typename|mutable|static|class|struct)\b", " ", written[:2000])
        name, arguments, rest = "".join(match[0].split()), *_bracketed(plain[match.end() :])
        last = name.rpartition("::")[2]
        if last in POINTERS and arguments:
            written = arguments[0]
            continue
        if last in OF_POINTERS:
            name = name.rpartition("::")[0]
        elif arguments and rest.startswith("::") and rest[2:].strip(" &*") not in OF_POINTERS:
            name, arguments = name + rest, ()
        return name, arguments
    return "", ()


def _bracketed(text: str) -> tuple[Path, str]:
    """``<A, B<C>>::x`` -> its arguments, and what stands behind them."""
    text = text.strip()
    if not text.startswith("<"):
        return (), text
    arguments, level, begin = [], 0, 1
    for at, sign in enumerate(text):
        level += {"<": 1, ">": -1}.get(sign, 0)
        if (sign == "," and level == 1) or level == 0:
            arguments.append(text[begin:at].strip())
            begin = at + 1
        if level == 0:
            return tuple(argument for argument in arguments if argument), text[begin:].strip()
    return (), ""
