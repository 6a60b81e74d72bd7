"""One file of C++ -> its classes, functions and constants as plain data, for values and nodes that are made of them.

In: bytes, the syntax tree of ``ingest/code``. Out: ``CppFile``. No preprocessor: all branches of ``#if`` are read. A
lambda belongs to the function around it; one that a variable holds is a function of its own inside that.
"""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.cpp_code import CppNames
from rosprivacy.ingest.code.cpp_tree import CLASSES, arguments_of, brief, line_of, names_of, text_of
from rosprivacy.ingest.code.source_code import walk
from rosprivacy.ingest.scan.cpp.cpp_expressions import (
    Call,
    Construction,
    Expression,
    Item,
    Items,
    Member,
    Open,
    Ref,
    Text,
    call,
    expression,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from tree_sitter import Node

PARAMETERS = ("parameter_declaration", "optional_parameter_declaration")
BRANCHES = frozenset(
    ["if_statement", "else_clause", "for_statement", "for_range_loop", "while_statement", "do_statement",
     "case_statement", "catch_clause"]
)  # fmt: skip
LONGEST = 1000  # bytes of a parameter
GETTERS = ("get_parameter", "get_parameter_or")
ADDERS = ("push_back", "emplace_back", "insert", "emplace", "push")
COUNTED = 32  # steps of a loop over numbers
SIMPLE = re.compile(
    r"\b(?:string|string_view|char|int|double|float|bool|size_t|auto|\w+_ptr|SharedPtr|ParameterValue|int\d+_t)\b"
)
LONGEST_LOOP = 200  # signs of the head of a loop over numbers
COUNTING_LOOP = re.compile(r"(\w+)\s*[={]\s*(\d{1,4})\}?\s*;?\s*\1\s*(<=?)\s*(\d{1,4})u?\s*$")
DEFINED = re.compile(r'(?:u8)?"([^"\\]*)"')
END = 1 << 62


class Parameter(NamedTuple):
    """A parameter of a function."""

    name: str
    type: str
    default: Expression | None = None


class Assigned(NamedTuple):
    """A value that a variable gets.

    Attributes
    ----------
    start
        Byte of the place.
    branch
        First and last byte of the branch in which it happens: outside of it, it may not have happened.
    appended
        Whether it is put behind what the variable held.
    """

    value: Expression
    start: int
    branch: tuple[int, int] = (0, END)
    appended: bool = False


class Initializer(NamedTuple):
    """``name(…)`` of a constructor: a member, a base class, or another constructor."""

    name: str
    arguments: tuple[Expression, ...]
    line: int
    start: int


class Function(NamedTuple):
    """A function with its body; of a class without a name, the default values of its members.

    Attributes
    ----------
    of_class
        Name of its class; empty if it has none.
    outer
        Of a lambda that a variable holds: first byte of the function around it.
    """

    file: str
    start: int
    line: int
    of_class: str
    name: str
    templates: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    calls: tuple[Call | Construction, ...]
    assigned: Mapping[str, tuple[Assigned, ...]]
    types: Mapping[str, str]
    results: tuple[Expression, ...]
    initializers: tuple[Initializer, ...]
    outer: int | None = None

    @property
    def key(self) -> tuple[str, int]:
        """What tells it from others."""
        return self.file, self.start


class CppClass(NamedTuple):
    """A class.

    Attributes
    ----------
    bases
        Types that it is derived from.
    fields
        Members: type, and default value.
    defaults
        Name of a method, number of its parameters -> parameters of its declaration.
    """

    file: str
    line: int
    name: str
    templates: tuple[str, ...]
    bases: tuple[str, ...]
    fields: Mapping[str, tuple[str, Expression | None]]
    defaults: Mapping[tuple[str, int], tuple[Parameter, ...]]


class CppFile(NamedTuple):
    """What one file says.

    Attributes
    ----------
    constants
        Of namespaces, and macros that stand for texts.
    broken
        Lines at which something begins that cannot be read.
    declared
        Lines at which functions are declared, by their names.
    quiet
        First and last byte of comments and strings.
    spaces
        Namespaces in which something of it stands.
    """

    file: str
    names: CppNames
    classes: tuple[CppClass, ...]
    functions: tuple[Function, ...]
    constants: Mapping[str, tuple[Assigned, ...]]
    types: Mapping[str, str]
    broken: tuple[int, ...]
    declared: frozenset[tuple[str, int]]
    quiet: tuple[tuple[int, int], ...]
    spaces: tuple[str, ...] = ()


class _Building:
    """A function, a class or a namespace while it is read."""

    def __init__(self, name: str = "", of_class: str = "", templates: tuple[str, ...] = ()) -> None:
        self.name, self.of_class, self.templates = name, of_class, templates
        self.start = self.line = 0
        self.outer: int | None = None
        self.parameters: tuple[Parameter, ...] = ()
        self.calls: list[Call | Construction] = []
        self.assigned: dict[str, list[Assigned]] = defaultdict(list)
        self.types: dict[str, str] = {}
        self.results: list[Expression] = []
        self.initializers: list[Initializer] = []
        self.bases: tuple[str, ...] = ()
        self.defaults: dict[tuple[str, int], tuple[Parameter, ...]] = {}

    def values(self) -> Mapping[str, tuple[Assigned, ...]]:
        return {name: tuple(values) for name, values in self.assigned.items()}

    def function(self, file: str) -> Function:
        return Function(
            file, self.start, self.line, self.of_class, self.name, self.templates, self.parameters, tuple(self.calls),
            self.values(), self.types, tuple(self.results), tuple(self.initializers), self.outer,
        )  # fmt: skip


class _Place(NamedTuple):
    """Where a piece stands: in which class and function, below which template, in which branch."""

    in_class: _Building | None
    function: _Building | None
    templates: tuple[str, ...] = ()
    branch: tuple[int, int] = (0, END)


def read_cpp_file(file: str, root: Node, late: Callable[[], bool]) -> CppFile:
    """Read a file by its syntax tree.

    Raises
    ------
    OutOfTime
        When it is late.
    """
    reader = _FileReader(file)
    walk(root, _Place(None, None), reader.parts, late)
    return reader.result()


class _FileReader:
    """Reads the pieces of one file, in the order of the text."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.names = CppNames()
        self.top = _Building()
        self.classes: list[tuple[_Building, _Building]] = []  # a class, and the default values of its members
        self.functions: list[_Building] = []
        self.broken: set[int] = set()
        self.declared: set[tuple[str, int]] = set()
        self.quiet: list[tuple[int, int]] = []
        self.lambdas: dict[int, str] = {}
        self.spaces: list[str] = []

    def result(self) -> CppFile:
        functions = [one.function(self.file) for one in self.functions]
        classes = []
        for building, members in self.classes:
            fields: dict[str, tuple[str, Expression | None]] = {
                name: (kind, members.assigned[name][0].value if name in members.assigned else None)
                for name, kind in members.types.items()
            }
            head = (self.file, building.line, building.name, building.templates, building.bases)
            one = CppClass(*head, fields, building.defaults)
            classes.append(one)
            functions += [members.function(self.file)] if members.calls else []
        if self.top.calls:
            functions.append(self.top.function(self.file))
        return CppFile(
            self.file, self.names, tuple(classes), tuple(functions), self.top.values(), self.top.types,
            tuple(sorted(self.broken)), frozenset(self.declared), tuple(self.quiet), tuple(dict.fromkeys(self.spaces)),
        )  # fmt: skip

    def parts(self, node: Node, place: _Place) -> list[tuple[Node, _Place]]:
        """Read a piece, and return what it is made of."""
        inside = self._read(node, place)
        return [(child, inside) for child in node.named_children]

    def _read(self, node: Node, place: _Place) -> _Place:
        kind = node.type
        if kind in BRANCHES or (kind == "compound_statement" and place.branch[1] != END):
            place = place._replace(branch=(node.start_byte, node.end_byte))
        if node.is_missing or kind == "ERROR":
            self.broken.add(line_of(node))
        method = READERS.get(kind)
        return (method(self, node, place) if method else None) or place

    def _owner(self, place: _Place) -> _Building:
        if place.function is not None:
            return place.function
        return place.in_class if place.in_class is not None else self.top

    def _comment(self, node: Node, _place: _Place) -> None:
        self.quiet.append((node.start_byte, node.end_byte))

    _string_literal = _raw_string_literal = _comment

    def _namespace_definition(self, node: Node, _place: _Place) -> None:
        name = node.child_by_field_name("name")
        self.spaces += ["".join(text_of(name).split())] if name is not None else []

    def _using_declaration(self, node: Node, _place: _Place) -> None:
        self.names.declaration(node)

    _alias_declaration = _namespace_alias_definition = _using_declaration

    def _type_definition(self, node: Node, _place: _Place) -> None:
        kind, name = node.child_by_field_name("type"), node.child_by_field_name("declarator")
        if kind is not None and name is not None and kind.type not in CLASSES:
            self.names.using("alias_declaration", [text_of(name), text_of(kind)])

    def _preproc_def(self, node: Node, _place: _Place) -> None:
        name, value = node.child_by_field_name("name"), node.child_by_field_name("value")
        text = text_of(value).split("//")[0] if value is not None else ""
        if name is not None and text.strip():
            parts = DEFINED.findall(text)
            whole = parts and not DEFINED.sub("", text).strip()
            meant = Text("".join(parts)) if whole else Ref(text.strip()) if text.strip().isidentifier() else None
            if meant:
                self.top.assigned[text_of(name)].append(Assigned(meant, node.start_byte))

    def _template_declaration(self, node: Node, place: _Place) -> _Place:
        listed = node.child_by_field_name("parameters")
        names = [text_of(child).split("=")[0].split() for child in (arguments_of(listed) if listed is not None else ())]
        return place._replace(templates=tuple(words[-1] for words in names if words))

    def _class_specifier(self, node: Node, place: _Place) -> _Place:
        name, body = node.child_by_field_name("name"), node.child_by_field_name("body")
        if name is None or body is None:
            return place
        building = _Building(names_of(name)[-1], templates=place.templates)
        building.line, building.start = line_of(node), node.start_byte
        clause = next((child for child in node.children if child.type == "base_class_clause"), None)
        listed = clause.named_children if clause is not None else []
        building.bases = tuple(text_of(child) for child in listed if "type" in child.type or "ident" in child.type)
        members = _Building("", building.name, place.templates)
        members.start, members.line, members.defaults = node.start_byte, building.line, building.defaults
        self.classes.append((building, members))
        return _Place(members, None)

    _struct_specifier = _class_specifier

    def _function_definition(self, node: Node, place: _Place) -> _Place:
        head = _head(node.child_by_field_name("declarator"))
        if head is None:
            return place
        target = head.child_by_field_name("declarator")
        path = names_of(target) if target is not None else [""]
        self.declared.add((path[-1], line_of(head)))
        of_class = path[-2] if len(path) > 1 else place.in_class.of_class if place.in_class else ""
        building = _Building(path[-1], of_class, place.templates)
        building.start, building.line = node.start_byte, line_of(node)
        building.parameters = _parameters(head)
        building.types = {one.name: one.type for one in building.parameters}
        if len(path) > 1 and target is not None and "template_type" in [child.type for child in target.named_children]:
            scope = target.child_by_field_name("scope")
            arguments = scope.child_by_field_name("arguments") if scope is not None else None
            building.templates += tuple(map(text_of, arguments_of(arguments))) if arguments is not None else ()
        self.functions.append(building)
        return _Place(place.in_class, building)

    def _lambda_expression(self, node: Node, place: _Place) -> _Place:
        around = place.function
        head = node.child_by_field_name("declarator")
        name = self.lambdas.get(node.id, "")
        if around is None or not name:
            for one in _parameters(head) if head is not None else ():
                self._owner(place).types.setdefault(one.name, one.type)
            return place._replace(branch=(node.start_byte, node.end_byte))
        building = _Building(name, around.of_class, around.templates)
        building.start, building.line, building.outer = node.start_byte, line_of(node), around.start
        building.parameters = _parameters(head) if head is not None else ()
        building.types = {one.name: one.type for one in building.parameters}
        self.functions.append(building)
        return place._replace(function=building)

    def _field_initializer(self, node: Node, place: _Place) -> None:
        given = next((child for child in node.children if child.type in ("argument_list", "initializer_list")), None)
        if place.function is not None and given is not None:
            name = node.named_children[0]
            arguments = tuple(expression(child) for child in arguments_of(given))
            plain = name.child_by_field_name("name") if "template" in name.type else name
            last = names_of(plain)[-1] if plain is not None else ""
            place.function.initializers.append(Initializer(last, arguments, line_of(node), node.start_byte))

    def _field_declaration(self, node: Node, place: _Place) -> None:
        if place.in_class is None or place.function is not None:
            return
        kind = node.child_by_field_name("type")
        for declarator in node.children_by_field_name("declarator"):
            head = _head(declarator)
            name = _declared_name(declarator)
            if head is not None:
                listed = _parameters(head)
                self.declared.add((name, line_of(head)))
                place.in_class.defaults[name, len(listed)] = listed
            elif name and kind is not None:
                place.in_class.types[name] = _type_text(node, kind)
                default = node.child_by_field_name("default_value")
                if default is not None:
                    self._initial(place.in_class, name, place.in_class.types[name], default, node, place)

    def _declaration(self, node: Node, place: _Place) -> None:
        kind = node.child_by_field_name("type")
        owner = self._owner(place)
        for declarator in node.children_by_field_name("declarator"):
            target = (
                declarator.child_by_field_name("declarator") if declarator.type == "init_declarator" else declarator
            )
            name, head = _declared_name(declarator), _head(declarator)
            if kind is None and head is not None and place.in_class is not None:  # a constructor
                place.in_class.defaults[name, len(_parameters(head))] = _parameters(head)
            if not name or kind is None or target is None:
                continue
            written = _type_text(node, kind)
            if head is not None and declarator.type != "init_declarator":
                given = _read_as_arguments(head) if place.function is not None else None
                if given is None:
                    self.declared.add((name, line_of(head)))
                    continue
                owner.types[name] = written
                self._construct(owner, name, Construction(written, given, line_of(node), node.start_byte), place)
                continue
            owner.types[name] = written
            value = declarator.child_by_field_name("value")
            if value is not None:
                self._initial(owner, name, written, value, node, place)

    def _initial(self, owner: _Building, name: str, kind: str, value: Node, node: Node, place: _Place) -> None:
        if value.type == "lambda_expression":
            self.lambdas[value.id] = name
            return
        given = arguments_of(value)
        if value.type == "initializer_list" and "auto" in kind and len(given) == 1:
            owner.assigned[name].append(Assigned(expression(given[0]), node.start_byte, place.branch))
        elif value.type in ("argument_list", "initializer_list") and "auto" not in kind:
            arguments = tuple(expression(child) for child in given)
            made = Construction(kind, arguments, line_of(node), node.start_byte)
            self._construct(owner, name, made, place, listed=value.type == "initializer_list")
        else:
            owner.assigned[name].append(Assigned(expression(value), node.start_byte, place.branch))

    def _construct(
        self, owner: _Building, name: str, construction: Construction, place: _Place, *, listed: bool = False
    ) -> None:
        """``T name(a, b)``; of one argument the value, too, since texts and pointers are made so; ``T name{…}``."""
        value = valued(construction, listed=listed)
        owner.calls += [construction] if value is construction else []
        owner.assigned[name].append(Assigned(value, construction.start, place.branch))

    def _assignment_expression(self, node: Node, place: _Place) -> None:
        target, value = node.child_by_field_name("left"), node.child_by_field_name("right")
        operator = node.child_by_field_name("operator")
        if target is None or value is None or place.function is None:
            return
        signs = text_of(operator) if operator is not None else "="
        name = assigned_name(expression(target))
        if value.type == "lambda_expression":
            self.lambdas[value.id] = name
        elif name and signs in ("=", "+="):
            given = Assigned(expression(value), node.start_byte, place.branch, signs == "+=")
            place.function.assigned[name].append(given)

    def _call_expression(self, node: Node, place: _Place) -> None:
        made = call(node)
        if not isinstance(made, Call | Construction):
            return
        owner = self._owner(place)
        owner.calls.append(made)
        if isinstance(made, Construction):
            return
        given = made.arguments
        if made.last in GETTERS and len(given) > 1 and (name := assigned_name(given[1])):
            owner.assigned[name].append(Assigned(made, made.start, place.branch))
        elif made.of is not None and made.last in ADDERS and given and (name := assigned_name(made.of)):
            held = Item(given[0]) if made.last == "insert" and isinstance(given[0], Items) else given[-1]
            owner.assigned[name].append(Assigned(Items((held,)), made.start, (made.start, made.start)))
        elif made.of is not None and made.last == "reset" and given and (name := assigned_name(made.of)):
            owner.assigned[name].append(Assigned(given[0], made.start, place.branch))

    def _new_expression(self, node: Node, place: _Place) -> None:
        made = expression(node)
        if isinstance(made, Construction):
            self._owner(place).calls.append(made)

    _compound_literal_expression = _new_expression

    def _return_statement(self, node: Node, place: _Place) -> None:
        value = next((child for child in node.named_children if child.type != "comment"), None)
        if place.function is not None and value is not None:
            place.function.results.append(expression(value))

    def _for_range_loop(self, node: Node, place: _Place) -> None:
        target, over = node.child_by_field_name("declarator"), node.child_by_field_name("right")
        if target is None or over is None or place.function is None:
            return
        source = Item(expression(over))
        names = _bound_names(target)
        for at, name in enumerate(names):
            value = source if len(names) == 1 else Item(source, at)
            place.function.assigned[name].append(Assigned(value, node.start_byte, place.branch))
            kind = node.child_by_field_name("type")
            place.function.types.setdefault(name, text_of(kind) if kind is not None else "auto")

    def _for_statement(self, node: Node, place: _Place) -> None:
        """``for (int i = 0; i < 4; ++i)``, over numbers that stand there."""
        start, condition = node.child_by_field_name("initializer"), node.child_by_field_name("condition")
        written = f"{text_of(start) if start else ''} {text_of(condition) if condition else ''}"
        match = COUNTING_LOOP.search(written[-LONGEST_LOOP:])
        if match and condition is not None and place.function is not None:
            steps = range(int(match[2]), int(match[4]) + (match[3] == "<="))
            if 0 < len(steps) <= COUNTED:
                numbers = Items(tuple(Text(str(number), string=False) for number in steps))
                place.function.assigned[match[1]].append(Assigned(Item(numbers), condition.start_byte, place.branch))


# By the sort of a piece, the method that reads it.
READERS = {name.removeprefix("_"): method for name, method in vars(_FileReader).items() if callable(method)}


def valued(construction: Construction, *, listed: bool = False) -> Expression:
    """Return what a variable is that is made so: an object, or what its one argument is.

    Parameters
    ----------
    listed
        Whether its arguments stand in braces, which are the elements of a container.
    """
    plain = construction.type.replace("std::", "").replace("char[]", "char")
    if re.search(r"\b(?:vector|array|list|set|map|unordered_map|initializer_list|pair)\b", plain) or plain.endswith(
        "]"
    ):
        return Items(construction.arguments) if listed or not construction.arguments else Open(f"a {plain}")
    simple = SIMPLE.search(plain)
    if simple and len(construction.arguments) <= 1:
        return construction.arguments[0] if construction.arguments else Text("")
    return construction


def assigned_name(target: Expression) -> str:
    """Return by which name a variable is looked up: ``topic_`` of ``this->topic_``, ``config.topic`` of a member's."""
    if isinstance(target, Item) and target.at is None:
        return assigned_name(target.of)
    if isinstance(target, Ref):
        return target.name.rpartition("::")[2]
    if isinstance(target, Member):
        before = assigned_name(target.of)
        return target.name if before == "this" else f"{before}.{target.name}" if before else ""
    return ""


def _head(declarator: Node | None) -> Node | None:
    """The part of a declarator that has the parameters of a function; None if it is none."""
    for _ in range(8):
        if declarator is None or declarator.type == "function_declarator":
            break
        inner = declarator.child_by_field_name("declarator")
        if inner is None and declarator.type in ("reference_declarator", "pointer_declarator"):
            inner = next(iter(declarator.named_children), None)
        declarator = inner
    if declarator is not None and declarator.type == "function_declarator":
        inner = declarator.child_by_field_name("declarator")
        return None if inner is not None and inner.type == "parenthesized_declarator" else declarator
    return None


def _declared_name(declarator: Node) -> str:
    node: Node | None = declarator
    for _ in range(8):
        if node is None or node.type in ("identifier", "field_identifier", "qualified_identifier", "destructor_name"):
            break
        inner = node.child_by_field_name("declarator")
        node = inner if inner is not None else next((one for one in node.named_children if "ident" in one.type), None)
    return names_of(node)[-1] if node is not None else ""


def _bound_names(target: Node) -> list[str]:
    node = target
    if node.type == "reference_declarator":
        node = next(iter(node.named_children), node)
    if node.type == "structured_binding_declarator":
        return [text_of(child) for child in node.named_children]
    name = _declared_name(target)
    return [name] if name else []


def _parameters(head: Node) -> tuple[Parameter, ...]:
    listed = head.child_by_field_name("parameters")
    found = []
    for child in listed.named_children if listed is not None else ():
        if child.type not in PARAMETERS:
            continue
        kind, name = child.child_by_field_name("type"), child.child_by_field_name("declarator")
        default = child.child_by_field_name("default_value")
        if kind is not None and text_of(kind) == "void" and name is None:
            continue
        written = text_of(child).split("=")[0] if child.end_byte - child.start_byte < LONGEST else "?"
        value = expression(default) if default is not None else None
        found.append(Parameter(_declared_name(name) if name is not None else "", written, value))
    return tuple(found)


def _read_as_arguments(head: Node) -> tuple[Expression, ...] | None:
    """The arguments of ``T name(a, b());``, which the grammar takes for a function; None where it is one."""
    listed = head.child_by_field_name("parameters")
    given = listed.named_children if listed is not None else []
    kinds = [child.child_by_field_name("type") for child in given]
    heads = [child.child_by_field_name("declarator") for child in given]
    plain = all(head is None or text_of(head) == "()" for head in heads)
    if not given or not plain or any(one is None or "primitive" in one.type for one in kinds):
        return None
    return tuple(
        Ref(brief(one)) if head is None else Call(brief(one), (), None, (), line_of(one), one.start_byte)
        for one, head in zip(kinds, heads, strict=True)
        if one is not None
    )


def _type_text(node: Node, kind: Node) -> str:
    array = any(child.type == "array_declarator" for child in node.children_by_field_name("declarator"))
    return brief(kind) + ("[]" if array else "")
