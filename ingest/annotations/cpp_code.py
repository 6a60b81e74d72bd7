"""C++ source -> what is read in it, by tree-sitter's grammar; no preprocessor, no recursion, nothing is built.

tree-sitter reads on behind code that it does not understand. What looks like an annotation there, or in a macro, is a
problem: whether it is a comment nobody can say.

Source: the signatures of rclcpp, rclcpp_lifecycle, rclcpp_action and image_transport.
"""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.annotations.annotation_text import looks_like_one
from rosprivacy.ingest.annotations.cpp_types import TypeNames
from rosprivacy.ingest.annotations.cpp_uses import CppUses
from rosprivacy.ingest.annotations.source_code import (
    NODE,
    NODE_CLASSES,
    Code,
    Comment,
    Lines,
    NodeClass,
    Site,
    class_owner,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tree_sitter import Node

CALLS = {  # name -> kind, role
    "create_publisher": ("topic", "publish"),
    "create_generic_publisher": ("topic", "publish"),
    "create_subscription": ("topic", "subscribe"),
    "create_generic_subscription": ("topic", "subscribe"),
    "create_service": ("service", "reply"),
    "create_client": ("service", "request"),
    "create_server": ("action", "execute"),
    "create_camera_publisher": ("topic", "publish"),
    "create_camera_subscription": ("topic", "subscribe"),
}
ACTIONS, IMAGES = "rclcpp_action", "image_transport"
FREE = ("rclcpp", "rclcpp_lifecycle", ACTIONS, IMAGES)  # namespaces of functions that take the node first
IMAGE = "sensor_msgs/msg/Image"
STATEMENTS = ("expression_statement", "declaration", "field_declaration", "return_statement", "field_initializer")
CLASSES = ("class_specifier", "struct_specifier")
FUNCTIONS = ("function_definition", "lambda_expression")
ARGUMENTS = ("argument_list", "initializer_list")
TEXTS = ("string_literal", "raw_string_literal", "char_literal", "comment", "system_lib_string")
NAMES = ("qualified_identifier", "type_identifier")
SIGNS = "/*!< \t\r"  # of comments, at the beginning of a line
NO_COMMENT = "an annotation stands in a macro or in code that cannot be read"
ALONE = "put it on a line of its own above the call or class, or correct the code"


class _Where(NamedTuple):
    """Where a piece of code stands: class, function, its first line, the statement, and the variable that is set."""

    of_class: str = ""
    function: int = 0
    first: int = 0
    statement: Lines | None = None
    target: str = ""
    broken: bool = False


def read_cpp(file: str, data: bytes) -> Code:
    """Read a file.

    Parameters
    ----------
    file
        For messages.

    Raises
    ------
    ImportError
        If there is no library to read it with.
    """
    import tree_sitter  # noqa: PLC0415 - an extra, imported where it is used
    import tree_sitter_cpp  # noqa: PLC0415

    language = tree_sitter.Language(tree_sitter_cpp.language())
    return _Reader(file, data).read(tree_sitter.Parser(language).parse(data).root_node)


class _Reader:
    """Reads one file from its first to its last piece."""

    def __init__(self, file: str, data: bytes) -> None:
        self.file = file
        self.data = data
        self.types = TypeNames()
        self.used = CppUses(self.types)
        self.parts_of_names: set[int] = set()
        self.comments: list[Comment] = []
        self.classes: list[NodeClass] = []
        self.sites: list[Site] = []
        self.understood: list[tuple[int, int]] = []  # comments and strings, by byte

    def read(self, root: Node) -> Code:
        for node, where in _walk(root):
            kind = node.type
            if kind in TEXTS and not (where.broken and kind != "comment"):
                self.understood.append((node.start_byte, node.end_byte))
            if kind == "comment":
                self.comments += self._comment(node)
            elif kind in ("using_declaration", "alias_declaration", "namespace_alias_definition"):
                names = [text_of(child) for child in node.named_children]
                if any(child.type == "namespace" for child in node.children) and kind == "using_declaration":
                    self.used.namespaces += names
                else:
                    self.types.add(kind, names)
            elif kind in CLASSES and node.child_by_field_name("body"):
                self._class(node, where)
            elif kind == "field_initializer":
                self._initializer(node, where)
            elif kind == "init_declarator" and node.parent is not None and node.parent.type == "declaration":
                self._declared(node, node.parent, where)
            elif kind == "call_expression":
                self._call(node, where)
                self._use_of_call(node, where)
            elif kind in NAMES:
                self._use_of_name(node, where)
        sites = tuple(site._replace(type=self.types.message(site.type)) for site in self.sites)
        classes, lost = tuple(self.classes), tuple(self._lost())
        return Code(self.file, "c++", tuple(self.comments), classes, sites, lost, self.used.uses())

    def _comment(self, node: Node) -> Iterator[Comment]:
        before = self.data[: node.start_byte].rpartition(b"\n")[2]
        for at, line in enumerate(text_of(node).split("\n")):
            text = line.rstrip("\r \t\\").removesuffix("*/").strip(SIGNS)
            yield Comment(_line(node) + at, text, at > 0 or not before.strip())

    def _lost(self) -> Iterator[LabelError]:
        """Annotations that stand in no comment and no string."""
        spans = sorted(self.understood)
        begins = [begin for begin, _ in spans]
        at = 0
        for number, line in enumerate(self.data.split(b"\n"), 1):
            pieces, begin, end = [], at, at + len(line)
            for first, last in spans[max(0, bisect_right(begins, at) - 1) : bisect_right(begins, end)]:
                pieces.append(self.data[begin : max(begin, min(first, end))])
                begin = max(begin, min(last, end))
            left = b"\n".join([*pieces, self.data[begin:end]]).decode("utf-8", "replace")
            if "priv" in left.lower() and looks_like_one(left):
                yield LabelError(self.file, number, NO_COMMENT, ALONE)
            at = end + 1

    def _class(self, node: Node, where: _Where) -> None:
        name, body = node.child_by_field_name("name"), node.child_by_field_name("body")
        if name is None or body is None:
            return
        clause = next((child for child in node.children if child.type == "base_class_clause"), None)
        bases = tuple(_last(child) for child in (clause.named_children if clause else ()) if "access" not in child.type)
        lines = Lines(where.first if _templated(node) else _line(node), _line(body))
        self.classes.append(NodeClass(_last(name), bases, lines))
        self.sites.append(Site(NODE, None, lines, lines, class_owner(_last(name)), head=True))

    def _initializer(self, node: Node, where: _Where) -> None:
        """``: Node("camera")`` of a constructor; whether it is one of a node's class is known later."""
        arguments = next((child for child in node.children if child.type in ARGUMENTS), None)
        if arguments is not None and where.of_class:
            base = _last(node.children[0])
            lines = Lines(where.first, _end(node))
            self._node(arguments, lines, class_owner(where.of_class), Lines(_line(node), _end(node)), base)

    def _declared(self, node: Node, declaration: Node, where: _Where) -> None:
        """``rclcpp::Node node("camera")``."""
        type_name, value = declaration.child_by_field_name("type"), node.child_by_field_name("value")
        if type_name and value and _last(type_name) in NODE_CLASSES and value.type in ARGUMENTS:
            target = node.child_by_field_name("declarator")
            owner = _variable(text_of(target), where) if target else ""
            lines = Lines(_line(declaration), _end(declaration))
            self._node(value, lines, owner, lines, "")

    def _node(self, arguments: Node, statement: Lines, owner: str, lines: Lines, base: str) -> None:
        given = _arguments(arguments)
        name = _literal(given[0]) if given else None
        space = _literal(given[1]) if len(given) > 1 and "literal" in given[1].type else ""
        self.sites.append(Site(NODE, name, lines, statement, owner, namespace=space, base=base))

    def _call(self, node: Node, where: _Where) -> None:
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        if function is None or arguments is None:
            return
        path, template, receiver = _path(function)
        lines = Lines(_line(node), _end(node))
        statement = where.statement or lines
        last, before = path[-1], path[-2] if len(path) > 1 else ""
        shared = last == "make_shared"
        if shared and ((template and _last(template[0]) in NODE_CLASSES) or before in NODE_CLASSES):
            owner = _variable(where.target, where) if where.target else ""
            self._node(arguments, statement, owner, lines, "")
        elif last in CALLS:
            self._endpoint(path, template, receiver, _arguments(arguments), (lines, statement), where)

    def _use_of_name(self, node: Node, where: _Where) -> None:
        """A name as a whole; its parts are noted, since asking each for its parent takes time for each level."""
        if node.id not in self.parts_of_names:
            self.used.add("::".join(_names(node)), _line(node), where.of_class)
        if node.type == "qualified_identifier":
            self.parts_of_names.update(child.id for child in node.named_children)

    def _use_of_call(self, node: Node, where: _Where) -> None:
        """A call of a function by its plain name; the programs and the files that calls of C open."""
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        if function is None or arguments is None or function.type not in ("identifier", "qualified_identifier"):
            return
        texts = [_literal(one) for one in _arguments(arguments)]
        self.used.add_call("::".join(_names(function)), texts, _line(node), where.of_class)

    def _endpoint(
        self, path: list[str], template: list[Node], receiver: str, given: list[Node], at: tuple[Lines, Lines],
        where: _Where,
    ) -> None:  # fmt: skip
        kind, role = CALLS[path[-1]]
        space = path[-2] if len(path) > 1 else ""
        found = text_of(template[0]) if template else ""
        if space == ACTIONS and path[-1] == "create_client":
            kind, role = "action", "call"
        free = space in FREE and not (given and _literal(given[0]) is not None)
        if free:
            receiver = text_of(given[0]) if given else "?"
            given = given[1:]
        owner = class_owner(where.of_class) if receiver in ("", "this", "*this") else _variable(receiver, where)
        name = _literal(given[0]) if given else None
        if "generic" in path[-1]:
            found = (_literal(given[1]) if len(given) > 1 else "") or ""
        images = space == IMAGES
        found = IMAGE if images else found
        more = images and role == "publish"
        self.sites.append(Site(kind, name, *at, owner, role, found, more=more))


def text_of(node: Node) -> str:
    """Return the text of a piece of code, as far as it is UTF-8."""
    return (node.text or b"").decode("utf-8", "replace")


def _walk(root: Node) -> Iterator[tuple[Node, _Where]]:
    """All nodes in the order of the text, each with where it stands."""
    waiting = [(root, _Where())]
    while waiting:
        node, where = waiting.pop()
        yield node, where
        inside = _inside(node, where)
        waiting += [(child, inside) for child in reversed(node.children)]


def _inside(node: Node, where: _Where) -> _Where:
    """Where the parts of a node stand."""
    kind = node.type
    if kind == "ERROR":
        return where._replace(broken=True)
    if kind in CLASSES and (name := node.child_by_field_name("name")):
        where = _Where(of_class=_last(name), broken=where.broken)
    elif kind in FUNCTIONS:
        first = where.first if _templated(node) else _line(node)
        of_class = _scope(node) or where.of_class
        where = _Where(of_class, node.start_byte + 1, first, broken=where.broken)
    elif kind == "template_declaration":
        where = where._replace(first=_line(node))
    elif kind in STATEMENTS:
        where = where._replace(statement=Lines(_line(node), _end(node)), target="")
    elif kind in ("init_declarator", "assignment_expression"):
        target = node.child_by_field_name("declarator") or node.child_by_field_name("left")
        where = where._replace(target=text_of(target) if target else "")
    elif kind in ("argument_list", "compound_statement"):
        where = where._replace(target="")
    return where


def _scope(function: Node) -> str:
    """The class of ``void Camera::start() {…}`` outside of it."""
    declarator = function.child_by_field_name("declarator")
    while declarator is not None and declarator.type != "qualified_identifier":
        declarator = declarator.child_by_field_name("declarator") or next(
            (child for child in declarator.named_children if child.type == "function_declarator"), None
        )
    path = _names(declarator) if declarator is not None else []
    return path[-2] if len(path) > 1 else ""


def _templated(node: Node) -> bool:
    return node.parent is not None and node.parent.type == "template_declaration"


def _variable(name: str, where: _Where) -> str:
    return f"{where.of_class}/{where.function}:{name}"


def _line(node: Node) -> int:
    return int(node.start_point[0]) + 1


def _end(node: Node) -> int:
    return int(node.end_point[0]) + 1


def _names(node: Node) -> list[str]:
    """The names of ``a::b<T>::c``, one after the other."""
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


def _last(node: Node) -> str:
    inner = node.child_by_field_name("type") if node.type == "type_descriptor" else None
    return _names(inner or node)[-1]


def _path(function: Node) -> tuple[list[str], list[Node], str]:
    """The names of what is called, its template arguments, and before ``.`` or ``->`` what it is called on."""
    receiver = ""
    if function.type == "field_expression":
        argument, field = function.child_by_field_name("argument"), function.child_by_field_name("field")
        receiver = text_of(argument) if argument else "?"
        function = field or function
    node = function
    while node.type == "qualified_identifier" and (name := node.child_by_field_name("name")) is not None:
        node = name
    if node.type == "dependent_name":  # this->template create_publisher<T>(…)
        node = function = next((child for child in node.named_children), node)
    given = node.child_by_field_name("arguments") if "template" in node.type else None
    types = [child for child in (given.named_children if given else ()) if child.type == "type_descriptor"]
    return _names(function), types, receiver


def _arguments(node: Node) -> list[Node]:
    return [child for child in node.named_children if child.type != "comment"]


def _literal(node: Node) -> str | None:
    """The text of a string without escapes; None for what is none."""
    if node.type == "concatenated_string":
        parts = [_literal(child) for child in node.named_children if child.type != "comment"]
        return None if None in parts else "".join(part or "" for part in parts)
    if node.type not in ("string_literal", "raw_string_literal"):
        return None
    inside = [child for child in node.named_children if child.type != "raw_string_delimiter"]
    plain = all(child.type in ("string_content", "raw_string_content") for child in inside)
    return "".join(map(text_of, inside)) if plain and not node.has_error else None
