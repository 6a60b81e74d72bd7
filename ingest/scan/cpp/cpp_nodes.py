"""Files of C++ -> the nodes that they make, each with its ends of channels, and what could not be resolved.

In: source code of a checkout. Out: ``CodeFacts``. For each call that makes an end of a channel there is an endpoint or
a gap at its line. A node is a class that is derived from one of ROS, or an object of ``rclcpp::Node`` where there is
none. An end of which nobody knows the node stands in a node without a name, with a gap.
"""

from __future__ import annotations

import re
from collections import defaultdict
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.cpp.cpp_ends import (
    NODE_BASES,
    NODE_SPACES,
    NODES,
    OF_NODES,
    THIS_OBJECT,
    UNNAMED_BASES,
    WRAPPERS,
    End,
    ends_of,
)
from rosprivacy.ingest.scan.cpp.cpp_expressions import Call, Construction, Expression, Text
from rosprivacy.ingest.scan.cpp.cpp_frames import Frame, Thing, TooManySteps, joined
from rosprivacy.ingest.scan.cpp.cpp_program import DECLARE, CppProgram
from rosprivacy.ingest.scan.cpp.cpp_units import valued
from rosprivacy.ingest.scan.cpp.cpp_values import ALTERNATIVES, AN_OBJECT, DEEP, Evaluator, solutions
from rosprivacy.ingest.scan.scan_facts import (
    GUESSED,
    LITERAL,
    NODE_NAME,
    CodeEndpoint,
    CodeFacts,
    CodeNode,
    CodePlace,
    CodeWrapper,
    Gap,
    NamePiece,
    name_order,
    open_name,
    plain_text,
    sorted_names,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.ingest.scan.cpp.cpp_units import CppClass, CppFile, Function
    from rosprivacy.ingest.scan.scan_facts import Name

    NodeKey = tuple[str, int, str]  # file, first byte or line, name

CPP = "c++"
ROS_1 = re.compile(rb'^[ \t]*#[ \t]*include[ \t]*[<"]ros/(?:ros|node_handle)\.h[>"]', re.MULTILINE)
COMPONENT = re.compile(r"\b(?:RCLCPP_COMPONENTS_REGISTER_NODE|CLASS_LOADER_REGISTER_CLASS)\s*\(\s*((?:\w|::)+)")
EXPORTED = re.compile(r"\bPLUGINLIB_EXPORT_CLASS\s*\(\s*((?:\w|::)+)\s*,")
MAKES_ENDS = re.compile(rf"\b(?P<name>{'|'.join(OF_NODES)})\b\s*[<(]")
OF_ROS = re.compile(rb"\brclcpp|\bimage_transport/image_transport.hpp|\bmessage_filters/subscriber.hpp")
UNREAD = "{0} stands in a macro, or in code that cannot be read"
BROKEN = "code that cannot be read begins here; there are {0} such places in this file"
TOO_MANY = "its name, or its node, is made in more ways than are followed"


def is_read(data: bytes) -> bool:
    """Return whether a file is read: code of ROS 1 is not."""
    return not ROS_1.search(data) or bool(OF_ROS.search(data))


def read_cpp_nodes(files: Sequence[CppFile], texts: Mapping[str, bytes]) -> CodeFacts:
    """Return the nodes that the C++ code of a checkout can make.

    Parameters
    ----------
    texts
        By file, what stands in it.
    """
    return _Nodes(files, texts).facts()


class _Node:
    """A node while its ends are gathered."""

    def __init__(self, place: CodePlace, name: str, plugin: str = "") -> None:
        self.place, self.name, self.plugin = place, name, plugin
        self.names: dict[Name, None] = {}
        self.namespaces: dict[Name, None] = {}
        self.ends: dict[tuple[CodePlace, str, str, bool, str], dict[Name, None]] = defaultdict(dict)
        self.wrappers: dict[CodeWrapper, None] = {}
        self.parameters: dict[str, str] = {}

    def facts(self) -> CodeNode:
        ends = tuple(
            CodeEndpoint(place, role, self._full_names(names), kind, below)
            for (place, role, kind, below, _), names in self.ends.items()
        )
        return CodeNode(
            self.place, self.name, CPP, sorted_names(self.names), sorted_names(self.namespaces), self.plugin,
            tuple(sorted(ends, key=lambda one: (one.place, one.role, one.type, name_order(one.names)))),
            tuple(sorted(self.wrappers)), parameters=dict(sorted(self.parameters.items())),
        )  # fmt: skip

    def _full_names(self, names: Iterable[Name]) -> tuple[Name, ...]:
        """Names, with that of the node itself put in."""
        result: dict[Name, None] = {}
        for name in names:
            if any(piece.parameter == NODE_NAME and piece.text is None for piece in name):
                owns = [text for own in self.names if (text := plain_text(own))]
                for own in owns:
                    pieces = (one._replace(text=own) if one.parameter == NODE_NAME else one for one in name)
                    result[joined(pieces)] = None
                if not owns:
                    why = "the name of the node"
                    pieces = (
                        NamePiece(None, GUESSED, NODE_NAME, why) if one.parameter == NODE_NAME else one for one in name
                    )
                    result[joined(pieces)] = None
            else:
                result[name] = None
        texts = [name for name in result if not any(piece.why.startswith(AN_OBJECT) for piece in name)]
        several = sorted_names(dict.fromkeys(map(_not_empty, texts or result)))
        return (
            several
            if len(several) <= ALTERNATIVES
            else (*several[:ALTERNATIVES], open_name(f"more than {ALTERNATIVES} names"))
        )


def _not_empty(name: Name) -> Name:
    """A name that is empty by default is one that a parameter has to give."""
    if plain_text(name) != "":
        return name
    return (NamePiece(None, GUESSED, name[0].parameter if name else "", "a name that is empty by default"),)


class _Nodes:
    """The nodes of a checkout."""

    def __init__(self, files: Sequence[CppFile], data: Mapping[str, bytes]) -> None:
        self.program = CppProgram(files)
        self.data = data
        self.nodes: dict[NodeKey, _Node] = {}
        self.gaps: dict[Gap, None] = {}
        self.lines: set[tuple[str, int, str]] = set()  # of calls that were looked at
        self.plugins = dict(self._exported())
        self._acting: dict[tuple[str, int], bool] = {}

    def facts(self) -> CodeFacts:
        for file in self.program.files.values():
            for one in file.classes:
                if self._is_node(one) and one in self.program.concrete(one):
                    self._of_class(one)
        for function in list(self.program.functions()):
            for call in self._calls(function):
                self._call(call, function)
        for file in self.program.files.values():
            self._unread(file)
        nodes = [one.facts() for one in self.nodes.values()]
        for key, node in self.nodes.items():
            if not node.names and not node.plugin and not key[2].startswith("?"):
                self.gaps[Gap(node.place, "node", f"what {node.name} is called as a node is not known")] = None
        return CodeFacts(tuple(sorted(nodes, key=lambda one: (one.place, one.name))), tuple(sorted(self.gaps)))

    def _calls(self, function: Function) -> Iterator[Call | Construction]:
        """The calls of a function, and the members and bases that its initialisers make."""
        yield from function.calls
        for one in function.initializers:
            made = Construction(self.program.field_type(function, one.name), one.arguments, one.line, one.start)
            if made.type and valued(made) is made:
                yield made

    def _call(self, call: Call | Construction, function: Function) -> None:
        place = CodePlace(function.file, call.line)
        if isinstance(call, Call):
            self.lines.add((function.file, call.line, call.last))
        ends = list(ends_of(self.program, call, function))
        for end in ends:
            try:
                self._end(end, function, place)
            except (TooManySteps, RecursionError):
                self.gaps[Gap(place, "name", TOO_MANY)] = None
        if not ends and isinstance(call, Construction):
            self._constructed(call, function, place)

    def _constructed(self, construction: Construction, function: Function, place: CodePlace) -> None:
        """Nodes that are objects of a class of ROS, and objects of other packages that make ends by themselves."""
        name = self.program.meaning(construction.type, function.file)[0]
        space, _, last = name.rpartition("::")
        if last in NODES and space in ("", *NODE_SPACES) and self.program.type_class(name, function.file) is None:
            if construction.arguments:
                self._object(construction, function)
        elif last in WRAPPERS and construction.arguments and self.program.type_class(name, function.file) is None:
            end = End("", None, Text(""), construction.line, construction.start)
            for node in self._homes(end, function, construction.arguments):
                node.wrappers[CodeWrapper(place, last)] = None

    def _homes(self, end: End, function: Function, arguments: tuple[Expression, ...]) -> list[_Node]:
        """The nodes that a wrapper is given, or whose class makes it."""
        found: dict[NodeKey, None] = {}
        for one in (*arguments, None):
            for thing in self._frames(function):
                try:
                    tasks = partial(self._nodes_of, end._replace(node=one), function, thing)
                    for keys in solutions(self.program, tasks):
                        found.update(dict.fromkeys(key for key in keys if not key[2].startswith("?")))
                except (TooManySteps, RecursionError):
                    continue
            if found:
                break
        return [self.nodes[key] for key in found]

    def _frames(self, function: Function) -> list[Thing | None]:
        """The objects whose method a function is: one of each class that an object can have."""
        owner = self.program.owner(function)
        if owner is None:
            return [None]
        return [Thing(one.name, (), ("this",), one) for one in self.program.concrete(owner)]

    def _frame(self, evaluator: Evaluator, function: Function, thing: Thing | None) -> Frame:
        return evaluator.method(thing, function) if thing else Frame(function, ("root",))

    def _end(self, end: End, function: Function, place: CodePlace) -> None:
        for thing in self._frames(function):

            def task(evaluator: Evaluator, thing: Thing | None = thing) -> tuple[list[NodeKey], list[Name], str]:
                frame = self._frame(evaluator, function, thing)
                keys = self._nodes_of(end, function, thing, evaluator)
                names = evaluator.names(end.name, frame, end.start)
                kind = end.type
                if not kind and end.written:
                    written, file = evaluator.type_of(end.written, frame)
                    kind = self.program.message(written, file)
                return keys, names, kind

            for keys, names, kind in solutions(self.program, task):
                for key in keys:
                    fixed = end.name.text if isinstance(end.name, Text) else ""
                    self.nodes[key].ends[place, end.role, kind, end.below, fixed].update(dict.fromkeys(names))
                    if key[2].startswith("?"):
                        what = f"of which node this is an end is not known: {self.nodes[key].name} gets it from outside"
                        self.gaps[Gap(place, "node-of", what)] = None

    def _nodes_of(self, end: End, function: Function, thing: Thing | None, evaluator: Evaluator) -> list[NodeKey]:
        frame = self._frame(evaluator, function, thing)
        if end.node is not None and end.node != THIS_OBJECT:
            keys = [
                key for one in evaluator.things(end.node, frame, end.start) for key in self._of_thing(one, evaluator)
            ]
            if keys:
                return list(dict.fromkeys(keys))
        owner = thing.of_class if thing else None
        implicit = end.node in (None, THIS_OBJECT)
        node = owner is not None and (self._is_node(owner) or (implicit and self._acts(owner)))
        if owner is not None and node and (implicit or end.own_node):
            return [self._of_class(owner)]
        if end.own_node or not end.role:
            around = self._around(frame, evaluator)
            if around:
                return around
        return [self._unknown(function, owner)]

    def _around(self, frame: Frame, evaluator: Evaluator) -> list[NodeKey]:
        """The nodes that make an object, or that the function makes in which it is made."""
        for _ in range(DEEP):
            owner = frame.object.of_class if frame.object else None
            if owner is not None and self._is_node(owner):
                return [self._of_class(one) for one in self.program.concrete(owner)]
            keys = [
                key
                for call in frame.function.calls
                if isinstance(call, Construction)
                for one in evaluator.things(call, frame, call.start)
                for key in self._of_thing(one, evaluator)
            ]
            if keys:
                return list(dict.fromkeys(keys))
            makers = [one for one in self.program.methods(owner) if one.name == owner.name] if owner else []
            inner = evaluator.method(frame.object, makers[0]) if makers and frame.object else frame
            binding = evaluator.binding(inner)
            if binding is None:
                return []
            frame = binding.frame
        return []

    def _of_thing(self, thing: Thing, evaluator: Evaluator, deep: int = 0) -> list[NodeKey]:
        """The nodes that an object is, or is made with."""
        owner = thing.of_class
        if owner is not None:
            if not self._is_node(owner) and not self._acts(owner):
                return []
            classes = self.program.concrete(owner) if thing.construction is None else [owner]
            return [self._of_class(one) for one in classes]
        space, _, last = thing.type.rpartition("::")
        if last in NODES and space in ("", *NODE_SPACES):
            made = thing.construction
            return (
                [self._object(made, thing.frame.function)]
                if made is not None and thing.frame and made.arguments
                else []
            )
        if thing.construction is not None and thing.frame is not None and deep < DEEP:
            return [
                key
                for given in thing.construction.arguments[:2]
                for one in evaluator.things(given, thing.frame, thing.construction.start)
                for key in self._of_thing(one, evaluator, deep + 1)
            ]
        return []

    # nodes

    def _is_node(self, cpp_class: CppClass) -> bool:
        return any(name.rpartition("::")[2] in NODE_BASES for name, _ in self.program.ancestors(cpp_class)[1])

    def _acts(self, cpp_class: CppClass) -> bool:
        """Whether a class is derived from one that is not in the checkout, and makes ends as a node does."""
        key = (cpp_class.file, cpp_class.line)
        if key not in self._acting:
            chain, outside = self.program.ancestors(cpp_class)
            self._acting[key] = bool(outside) and any(
                isinstance(call, Call) and call.last in OF_NODES and call.types and "::" not in call.name
                and call.of in (None, THIS_OBJECT) and not self.program.has_method(call.last, function, None)
                for other in chain
                for function in self.program.methods(other)
                for call in function.calls
            )  # fmt: skip
        return self._acting[key]

    def _of_class(self, cpp_class: CppClass) -> NodeKey:
        key = (cpp_class.file, cpp_class.line, cpp_class.name)
        if key not in self.nodes:
            node = self.nodes[key] = _Node(
                CodePlace(cpp_class.file, cpp_class.line),
                cpp_class.name,
                self.plugins.get((cpp_class.file, cpp_class.line), ""),
            )
            try:
                self._name(node, cpp_class)
            except (TooManySteps, RecursionError):
                self.gaps[Gap(node.place, "node", TOO_MANY)] = None
            self._parameters(node, cpp_class)
        return key

    def _name(self, node: _Node, cpp_class: CppClass) -> None:
        """What a class calls its nodes: what its constructors hand to that of ROS."""
        outside = self.program.ancestors(cpp_class)[1]
        thing = Thing(cpp_class.name, (), ("this",), cpp_class)
        for base, owner in outside:
            last = base.rpartition("::")[2]
            if last in UNNAMED_BASES or (last not in NODE_BASES and not self._acts(cpp_class)):
                continue
            calls = [
                (function, given.arguments, given.start)
                for function in self.program.methods(owner)
                for given in function.initializers
                if given.name == last
            ]
            for function, given, at in calls:
                for name, space in solutions(self.program, partial(self._name_arguments, function, thing, given, at)):
                    self._add(node, name, space, last)
            if not calls:  # with the constructors of its base
                for made in self.program.constructions(cpp_class):
                    task = partial(
                        self._name_arguments, made.function, None, made.construction.arguments, made.construction.start
                    )
                    for name, space in solutions(self.program, task):
                        self._add(node, name, space, last)

    def _add(self, node: _Node, names: Sequence[Name], spaces: Sequence[Name], base: str) -> None:
        known = base in NODE_BASES
        for name in names:
            if not known and plain_text(name) is None:
                continue
            pieces = name if known else tuple(one._replace(basis=GUESSED) for one in name)
            node.names[pieces] = None
        if known:  # what comes second for a base that is not there can be anything
            node.namespaces.update(dict.fromkeys(space for space in spaces if plain_text(space) not in (None, "")))

    def _name_arguments(
        self, function: Function, thing: Thing | None, arguments: tuple[Expression, ...], at: int, evaluator: Evaluator
    ) -> tuple[list[Name], list[Name]]:
        """Name and namespace among the arguments of a node's constructor."""
        frame = self._frame(evaluator, function, thing)
        if thing is None and (owner := self.program.owner(function)):
            frame = evaluator.method(Thing(owner.name, (), ("this",), owner), function)
        names = evaluator.names(arguments[0], frame, at) if arguments else []
        spaces = evaluator.names(arguments[1], frame, at) if len(arguments) > 1 else []
        return names, [
            space
            for space in spaces
            if plain_text(space) is not None and all(one.basis == LITERAL or one.parameter for one in space)
        ]

    def _object(self, construction: Construction, function: Function) -> NodeKey:
        name = function.of_class or function.name
        key = (function.file, construction.start, name)
        if key not in self.nodes:
            node = self.nodes[key] = _Node(CodePlace(function.file, construction.line), name)
            try:
                task = partial(self._name_arguments, function, None, construction.arguments, construction.start)
                for names, spaces in solutions(self.program, task):
                    self._add(node, names, spaces, NODES[0])
            except (TooManySteps, RecursionError):
                self.gaps[Gap(node.place, "node", TOO_MANY)] = None
        return key

    def _unknown(self, function: Function, owner: CppClass | None) -> NodeKey:
        name = owner.name if owner else function.name or function.file.rpartition("/")[2]
        place = CodePlace(owner.file, owner.line) if owner else CodePlace(function.file, function.line or 1)
        key = (place.file, place.line, f"?{name}")
        plugin = self.plugins.get((place.file, place.line), "") if owner else ""
        self.nodes.setdefault(key, _Node(place, name, plugin))
        return key

    def _parameters(self, node: _Node, cpp_class: CppClass) -> None:
        for other in self.program.ancestors(cpp_class)[0]:
            for function in self.program.methods(other):
                for call in function.calls:
                    if isinstance(call, Call) and call.last in DECLARE:
                        at = DECLARE[call.last]
                        pair = call.arguments[at : at + 2]
                        if len(pair) > 1 and isinstance(pair[0], Text):
                            self._parameter(node, cpp_class, function, (pair[0].text, pair[1], call.start))

    def _parameter(
        self, node: _Node, cpp_class: CppClass, function: Function, pair: tuple[str, Expression, int]
    ) -> None:
        def task(evaluator: Evaluator) -> list[Name]:
            return evaluator.names(
                pair[1], evaluator.method(Thing(cpp_class.name, (), ("this",), cpp_class), function), pair[2]
            )

        try:
            texts = [
                text
                for names in solutions(self.program, task)
                for name in names
                if (text := plain_text(name)) is not None
            ]
        except (TooManySteps, RecursionError):
            return
        if texts:
            node.parameters.setdefault(pair[0], texts[0])

    # what was not read

    def _exported(self) -> Iterator[tuple[tuple[str, int], str]]:
        """The classes that files export, and their names with namespaces."""
        for file, data in self.data.items():
            for name in self._outside_comments(file, data, (COMPONENT, EXPORTED)):
                one = self.program.type_class(name[1].rpartition("::")[2], file)
                if one is not None:
                    yield (one.file, one.line), name[1].removeprefix("::")

    def _outside_comments(self, file: str, data: bytes, patterns: Iterable[re.Pattern[str]]) -> Iterator[re.Match[str]]:
        text = data.decode("latin-1")  # one sign a byte
        quiet = iter(sorted(self.program.files[file].quiet))
        spans = list(quiet)
        for pattern in patterns:
            at = 0
            for match in pattern.finditer(text):
                while at < len(spans) and spans[at][1] <= match.start():
                    at += 1
                if at >= len(spans) or spans[at][0] > match.start():
                    yield match

    def _unread(self, file: CppFile) -> None:
        """Words that make ends, in macros and broken code; the first place that is broken."""
        data = self.data[file.file]
        line, at = 1, 0
        for match in self._outside_comments(file.file, data, (MAKES_ENDS,)):
            line += data.count(b"\n", at, match.start())
            at = match.start()
            near = any((file.file, line - back, match["name"]) in self.lines for back in range(6))
            if not near and (match["name"], line) not in file.declared:
                self.gaps[Gap(CodePlace(file.file, line), "name", UNREAD.format(match["name"]))] = None
        if file.broken and OF_ROS.search(data):
            text = BROKEN.format(len(file.broken))
            self.gaps[Gap(CodePlace(file.file, file.broken[0]), "file", text)] = None
