"""Pieces of C++ as tree-sitter gives them: their texts, their names, and where each stands; no recursion over code.

In: nodes of a syntax tree. Out: texts, names, lines, ``Where``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.code.source_code import SourceLines, Where

if TYPE_CHECKING:
    from tree_sitter import Node

STATEMENTS = ("expression_statement", "declaration", "field_declaration", "return_statement", "field_initializer")
CLASSES = ("class_specifier", "struct_specifier")
LONGEST = 1000  # bytes of a variable or type
FUNCTIONS = ("function_definition", "lambda_expression")
PLACES = frozenset(  # what says where its parts stand
    ["ERROR", "template_declaration", "init_declarator", "assignment_expression", "argument_list", "compound_statement",
     *STATEMENTS, *CLASSES, *FUNCTIONS]
)  # fmt: skip


def text_of(node: Node) -> str:
    """Return the text of a piece of code, as far as it is UTF-8."""
    return (node.text or b"").decode("utf-8", "replace")


def brief(node: Node) -> str:
    """Return the text of what may be a variable or a type; ``?`` for what is longer than any."""
    return text_of(node) if node.end_byte - node.start_byte <= LONGEST else "?"


def parts(node: Node, where: Where) -> list[tuple[Node, Where]]:
    """Return the parts of a node with a name, each with where it stands; asking each for its parent takes long."""
    children = node.named_children
    if not children:
        return []
    inside = _inside(node, where)
    return [(child, inside) for child in children]


def _inside(node: Node, where: Where) -> Where:
    """Where the parts of a node stand."""
    kind, templated = node.type, where.templated
    if kind not in PLACES and not templated:
        return where
    if templated:
        where = where._replace(templated=False)
    if kind == "ERROR":
        return where._replace(broken=True)
    if kind in CLASSES and (name := node.child_by_field_name("name")):
        where = Where(of_class=last_of(name), broken=where.broken)
    elif kind in FUNCTIONS:
        first = where.first if templated else line_of(node)
        of_class = scope_of(node) or where.of_class
        where = Where(of_class, str(node.start_byte), first, broken=where.broken)
    elif kind == "template_declaration":
        where = where._replace(first=line_of(node), templated=True)
    elif kind in STATEMENTS:
        where = where._replace(statement=SourceLines(line_of(node), end_of(node)), target="")
    elif kind in ("init_declarator", "assignment_expression"):
        target = node.child_by_field_name("declarator") or node.child_by_field_name("left")
        where = where._replace(target=brief(target) if target else "")
    elif kind in ("argument_list", "compound_statement"):
        where = where._replace(target="")
    return where


def scope_of(function: Node) -> str:
    """Return the class of ``void Camera::start() {…}`` outside of it; empty for none."""
    declarator = function.child_by_field_name("declarator")
    while declarator is not None and declarator.type != "qualified_identifier":
        declarator = declarator.child_by_field_name("declarator") or next(
            (child for child in declarator.named_children if child.type == "function_declarator"), None
        )
    path = names_of(declarator) if declarator is not None else []
    return path[-2] if len(path) > 1 else ""


def line_of(node: Node) -> int:
    """Return the first line of a piece of code."""
    return int(node.start_point[0]) + 1


def end_of(node: Node) -> int:
    """Return the last line of a piece of code."""
    return int(node.end_point[0]) + 1


def names_of(node: Node) -> list[str]:
    """Return the names of ``a::b<T>::c``, one after the other."""
    names: list[str] = []
    while node.type == "qualified_identifier":
        scope, name = node.child_by_field_name("scope"), node.child_by_field_name("name")
        names += [_plain(scope)] if scope is not None else []
        if name is None:
            return names or [""]
        node = name
    return [*names, _plain(node)]


def _plain(node: Node) -> str:
    """A name without its template arguments."""
    name = node.child_by_field_name("name")
    return text_of(name) if name is not None and "template" in node.type else text_of(node)


def last_of(node: Node) -> str:
    """Return the last of the names of ``a::b<T>::c``."""
    inner = node.child_by_field_name("type") if node.type == "type_descriptor" else None
    return names_of(inner or node)[-1]


def path_of(function: Node) -> tuple[list[str], list[Node], str]:
    """Return the names of what is called, its template arguments, and before ``.`` or ``->`` what it is called on."""
    receiver = ""
    if function.type == "field_expression":
        argument, field = function.child_by_field_name("argument"), function.child_by_field_name("field")
        receiver = brief(argument) if argument else "?"
        function = field or function
    node = function
    while node.type == "qualified_identifier" and (name := node.child_by_field_name("name")) is not None:
        node = name
    if node.type == "dependent_name":  # this->template create_publisher<T>(…)
        node = function = next((child for child in node.named_children), node)
    given = node.child_by_field_name("arguments") if "template" in node.type else None
    types = [child for child in (given.named_children if given else ()) if child.type == "type_descriptor"]
    return names_of(function), types, receiver


def arguments_of(node: Node) -> list[Node]:
    """Return the arguments of a list, without comments."""
    return [child for child in node.named_children if child.type != "comment"]


def literal_of(node: Node) -> str | None:
    """Return the text of a string without escapes; None for what is none."""
    if node.type == "concatenated_string":
        parts = [literal_of(child) for child in node.named_children if child.type != "comment"]
        return None if None in parts else "".join(part or "" for part in parts)
    if node.type not in ("string_literal", "raw_string_literal"):
        return None
    inside = [child for child in node.named_children if child.type != "raw_string_delimiter"]
    plain = all(child.type in ("string_content", "raw_string_content") for child in inside)
    return "".join(map(text_of, inside)) if plain and not node.has_error else None
