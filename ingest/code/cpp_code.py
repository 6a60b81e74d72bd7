"""C++ source -> what is read in it, by tree-sitter's grammar; no preprocessor, no recursion, nothing is built.

tree-sitter reads on behind code that it does not understand. What looks like an annotation there, or in a macro, is a
problem: whether it is a comment nobody can say. What is used are qualified names, types and functions, as far as the
file itself says what a name stands for: ``using cv::VideoCapture``, ``namespace c = cv`` and ``using namespace cv`` are
followed. Where several namespaces are used, a plain name may be of each: it is noted for each, and no rule speaks about
the wrong ones.

Source: the signatures of rclcpp, rclcpp_lifecycle, rclcpp_action and image_transport.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.code.annotation_text import looks_like_one
from rosprivacy.ingest.code.cpp_tree import (
    CLASSES,
    arguments_of,
    brief,
    end_of,
    last_of,
    line_of,
    literal_of,
    names_of,
    parts,
    path_of,
    text_of,
)
from rosprivacy.ingest.code.source_code import (
    FLEET_CONTROL,
    INTERFACES,
    LONGEST_USE,
    NODE,
    NODE_CLASSES,
    CallSite,
    Code,
    NameUse,
    NodeClass,
    OutOfTime,
    SourceComment,
    SourceLines,
    Where,
    class_owner,
    clock,
    in_time,
    is_fleet_topic,
    program,
    variable,
    walk,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from tree_sitter import Node, Tree

STEPS = 5  # of names that stand for names
STARTERS = ("system", "std::system", "popen", "execl", "execlp")
OPENERS = ("fopen", "std::fopen")
WRITING = frozenset("wa+")
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
ARGUMENTS = ("argument_list", "initializer_list")
TEXTS = ("string_literal", "raw_string_literal", "char_literal", "comment", "system_lib_string")
NAMES = ("qualified_identifier", "type_identifier")
NAMESPACES = 50  # that are used whole: each plain name of the file may be of each of them
FEWER = "name what is used of them"
PIECE = 512  # bytes that the library is given at once
SIGNS = "/*!< \t\r"  # of comments, at the beginning of a line
NO_COMMENT = "an annotation stands in a macro or in code that cannot be read"
QT = b"Q_OBJECT"  # in each class of which Qt's own compiler reads the words below; the grammar does not know them
QT_SECTION = re.compile(rb"\b(?:Q_SIGNALS|signals)(?=[ \t]*:(?!:))")
QT_WORD = re.compile(
    rb"\b(?:Q_(?:OBJECT|GADGET|INVOKABLE|SLOTS|EMIT)\b|slots(?=[ \t]*:(?!:))|emit(?=[ \t]+\w)"
    rb"|Q_(?:PROPERTY|ENUM|ENUMS|FLAG|DISABLE_COPY|CLASSINFO|PLUGIN_METADATA|INTERFACES)[ \t]*\([^()\n]*\))"
)
ALONE = "put it on a line of its own above the call or class, or correct the code"


class CppNames:
    """What the names of a file stand for, as far as it says so itself, and where each is used.

    Attributes
    ----------
    namespaces
        Of ``using namespace``.
    aliases
        A name -> what it stands for.
    """

    def __init__(self) -> None:
        self.namespaces: list[str] = []
        self.aliases: dict[str, str] = {}
        self._used: dict[tuple[str, str], int] = {}

    def declaration(self, node: Node) -> None:
        """Note one declaration of a name that stands for another."""
        names = [text_of(child) for child in node.named_children]
        if any(child.type == "namespace" for child in node.children) and node.type == "using_declaration":
            self.namespaces += names
        else:
            self.using(node.type, names)

    def using(self, kind: str, names: list[str]) -> None:
        """Note one ``using A::B;``, ``using B = A::C;`` or ``namespace b = a::c;``."""
        if kind == "using_declaration" and len(names) == 1:
            self.aliases[names[0].rpartition("::")[2].strip()] = names[0]
        elif kind != "using_declaration" and len(names) > 1:
            self.aliases[names[0]] = names[-1]

    def meaning(self, name: str) -> str:
        """What a name stands for, by what ``using`` says of its first part."""
        for _ in range(STEPS):
            head, colons, rest = name.partition("::")
            if head not in self.aliases or self.aliases[head] == name:
                break
            name = self.aliases[head] + colons + rest
        return name

    def message(self, written: str) -> str:
        """The type in ROS's spelling, ``sensor_msgs/msg/Image``; empty where the file does not say."""
        name = self.meaning(written.removeprefix("const ").strip())
        names = [part.strip() for part in name.replace("/", "::").split("::") if part.strip()]
        known = len(names) >= len(("package", "msg", "Name")) and names[1] in INTERFACES
        return "/".join(names[:3]) if known and all(part.isidentifier() for part in names[:3]) else ""

    def use(self, name: str, line: int, unit: str) -> None:
        """Note the first use of a name in a unit."""
        self._used.setdefault((unit, name), line)

    def uses(self) -> tuple[NameUse, ...]:
        """What is used, each name once in a unit, by line."""
        found: dict[tuple[str, str], int] = {}
        for (unit, name), line in self._used.items():
            known = self.meaning(name)
            plain = known == name and "::" not in name and name.isidentifier()
            for meant in [known, *(f"{space}::{name}" for space in dict.fromkeys(self.namespaces) if plain)]:
                found[unit, meant] = min(line, found.get((unit, meant), line))
        uses = (NameUse(name, line, unit) for (unit, name), line in found.items() if len(name) <= LONGEST_USE)
        return tuple(sorted(uses, key=lambda use: (use.line, use.name)))


def read_cpp(file: str, data: bytes) -> Code:
    """Read a file.

    Raises
    ------
    ImportError
        If there is no library to read it with.
    LabelError
        If its names can mean too much.
    OutOfTime
        If it takes too long.
    """
    late = clock()
    return cpp_code(file, data, walk(syntax_tree(data, late).root_node, Where(), parts, late), late)


def cpp_code(file: str, data: bytes, pieces: Iterable[tuple[Node, Where]], late: Callable[[], bool]) -> Code:
    """Return what the pieces of a file say, in the order of the text; raises what ``read_cpp`` raises."""
    return _CppReader(file, data).read(in_time(pieces, late))


def without_qt(data: bytes) -> bytes:
    """Return a file with blanks for what Qt adds to C++; all else stands where it stood.

    Source: Qt 6, *The Meta-Object System* and *Signals & Slots*: its keywords are macros that a compiler of C++ drops.

    >>> without_qt(b"class A : public QObject { Q_OBJECT public slots: void f(); signals: void g(); };")
    b'class A : public QObject {          public      : void f(); public : void g(); };'
    """
    if QT not in data:
        return data
    data = QT_SECTION.sub(lambda found: b"public".ljust(len(found[0])), data)
    return QT_WORD.sub(lambda found: b" " * len(found[0]), data)


def syntax_tree(data: bytes, late: Callable[[], bool]) -> Tree:
    """Return what the grammar makes of a file.

    Raises
    ------
    ImportError
        If there is no library to read it with.
    OutOfTime
        If it takes too long.
    """
    import tree_sitter  # noqa: PLC0415 - an extra, imported where it is used
    import tree_sitter_cpp  # noqa: PLC0415

    data = without_qt(data)
    parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))
    try:  # piece by piece: the library can be stopped only so
        return parser.parse(lambda at, _: data[at : at + PIECE], progress_callback=lambda _at, _broken: late())
    except ValueError:
        raise OutOfTime from None


class _CppReader:
    """Reads one file from its first to its last piece."""

    def __init__(self, file: str, data: bytes) -> None:
        self.file = file
        self.data = data
        self.names = CppNames()
        self.parts_of_names: set[int] = set()
        self.comments: list[SourceComment] = []
        self.classes: list[NodeClass] = []
        self.sites: list[CallSite] = []
        self.understood: list[tuple[int, int]] = []  # comments and strings, by byte

    def read(self, nodes: Iterable[tuple[Node, Where]]) -> Code:
        for node, where in nodes:
            kind = node.type
            if kind in TEXTS:
                self._written(node, where)
            if kind == "comment":
                self.comments += self._comment(node)
            elif kind in ("using_declaration", "alias_declaration", "namespace_alias_definition"):
                self.names.declaration(node)
            elif kind in CLASSES and node.child_by_field_name("body"):
                self._class(node, where)
            elif kind == "field_initializer":
                self._initializer(node, where)
            elif kind == "declaration":
                self._declared(node, where)
            elif kind == "call_expression":
                self._call(node, where)
                self._use_of_call(node, where)
            elif kind in NAMES:
                self._use_of_name(node, where)
        if len(set(self.names.namespaces)) > NAMESPACES:
            raise LabelError(self.file, 0, f"using namespace, of more than {NAMESPACES} namespaces", FEWER)
        sites = tuple(site._replace(type=self.names.message(site.type)) for site in self.sites)
        classes, lost = tuple(self.classes), tuple(self._lost())
        return Code(self.file, "c++", tuple(self.comments), classes, sites, lost, self.names.uses())

    def _written(self, node: Node, where: Where) -> None:
        """A comment or a text; what is in broken code is no text for sure."""
        if node.type == "comment" or not where.broken:
            self.understood.append((node.start_byte, node.end_byte))
        if node.type == "string_literal" and is_fleet_topic(literal_of(node) or ""):
            self.names.use(FLEET_CONTROL, line_of(node), where.of_class)

    def _comment(self, node: Node) -> Iterator[SourceComment]:
        before = self.data[self.data.rfind(b"\n", 0, node.start_byte) + 1 : node.start_byte]
        for at, line in enumerate(text_of(node).split("\n")):
            text = line.rstrip("\r \t\\").removesuffix("*/").strip(SIGNS)
            yield SourceComment(line_of(node) + at, text, at > 0 or not before.strip())

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

    def _class(self, node: Node, where: Where) -> None:
        name, body = node.child_by_field_name("name"), node.child_by_field_name("body")
        if name is None or body is None:
            return
        clause = next((child for child in node.children if child.type == "base_class_clause"), None)
        bases = tuple(
            last_of(child) for child in (clause.named_children if clause else ()) if "access" not in child.type
        )
        lines = SourceLines(where.first if where.templated else line_of(node), line_of(body))
        self.classes.append(NodeClass(last_of(name), bases, lines))
        self.sites.append(CallSite(NODE, None, lines, lines, class_owner(last_of(name)), head=True))

    def _initializer(self, node: Node, where: Where) -> None:
        """``: Node("camera")`` of a constructor; whether it is one of a node's class is known later."""
        arguments = next((child for child in node.children if child.type in ARGUMENTS), None)
        if arguments is not None and where.of_class:
            base = last_of(node.children[0])
            lines = SourceLines(where.first, end_of(node))
            self._node(arguments, lines, class_owner(where.of_class), SourceLines(line_of(node), end_of(node)), base)

    def _declared(self, declaration: Node, where: Where) -> None:
        """``rclcpp::Node node("camera")``."""
        type_name = declaration.child_by_field_name("type")
        if type_name is None or last_of(type_name) not in NODE_CLASSES:
            return
        lines = SourceLines(line_of(declaration), end_of(declaration))
        for node in declaration.children_by_field_name("declarator"):
            target, value = node.child_by_field_name("declarator"), node.child_by_field_name("value")
            if node.type == "init_declarator" and value and value.type in ARGUMENTS:
                self._node(value, lines, variable(brief(target), where) if target else "", lines, "")

    def _node(self, arguments: Node, statement: SourceLines, owner: str, lines: SourceLines, base: str) -> None:
        given = arguments_of(arguments)
        name = literal_of(given[0]) if given else None
        space = literal_of(given[1]) if len(given) > 1 and "literal" in given[1].type else ""
        self.sites.append(CallSite(NODE, name, lines, statement, owner, namespace=space, base=base))

    def _call(self, node: Node, where: Where) -> None:
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        if function is None or arguments is None:
            return
        path, template, receiver = path_of(function)
        lines = SourceLines(line_of(node), end_of(node))
        statement = where.statement or lines
        last, before = path[-1], path[-2] if len(path) > 1 else ""
        shared = last == "make_shared"
        if shared and ((template and last_of(template[0]) in NODE_CLASSES) or before in NODE_CLASSES):
            owner = variable(where.target, where) if where.target else ""
            self._node(arguments, statement, owner, lines, "")
        elif last in CALLS:
            self._endpoint(path, template, receiver, arguments_of(arguments), (lines, statement), where)

    def _use_of_name(self, node: Node, where: Where) -> None:
        """A name as a whole; its parts are noted, since asking each for its parent takes time for each level."""
        if node.id not in self.parts_of_names:
            self.names.use("::".join(names_of(node)), line_of(node), where.of_class)
        if node.type == "qualified_identifier":
            self.parts_of_names.update(child.id for child in node.named_children)

    def _use_of_call(self, node: Node, where: Where) -> None:
        """A call of a function by its plain name; the programs and the files that calls of C open."""
        function, arguments = node.child_by_field_name("function"), node.child_by_field_name("arguments")
        if function is None or arguments is None or function.type not in ("identifier", "qualified_identifier"):
            return
        texts = [literal_of(one) for one in arguments_of(arguments)]
        name, line, unit = "::".join(names_of(function)), line_of(node), where.of_class
        self.names.use(name, line, unit)
        if name in OPENERS and len(texts) > 1 and WRITING & set(texts[1] or ""):
            self.names.use(f"{name}(w)", line, unit)
        if name in STARTERS and texts and texts[0] and (started := program(texts[0].split())):
            self.names.use(started, line, unit)

    def _endpoint(
        self, path: list[str], template: list[Node], receiver: str, arguments: list[Node],
        at: tuple[SourceLines, SourceLines], where: Where,
    ) -> None:  # fmt: skip
        kind, role = CALLS[path[-1]]
        space = path[-2] if len(path) > 1 else ""
        found = brief(template[0]) if template else ""
        if space == ACTIONS and path[-1] == "create_client":
            kind, role = "action", "call"
        free = space in FREE and not (arguments and literal_of(arguments[0]) is not None)
        if free:
            receiver = brief(arguments[0]) if arguments else "?"
            arguments = arguments[1:]
        owner = class_owner(where.of_class) if receiver in ("", "this", "*this") else variable(receiver, where)
        name = literal_of(arguments[0]) if arguments else None
        if "generic" in path[-1]:
            found = (literal_of(arguments[1]) if len(arguments) > 1 else "") or ""
        images = space == IMAGES
        found = IMAGE if images else found
        more = images and role == "publish"
        self.sites.append(CallSite(kind, name, *at, owner, role, found, prefix=more))
