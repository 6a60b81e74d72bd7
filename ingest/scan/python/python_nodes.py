"""Python code of a checkout -> the nodes that it can create, with the ends of channels that each makes; nothing is run.

Each call that makes an end of a channel gives an end with a name, or a gap at its line. A helper class or function that
gets a node makes ends of that node; a base class of the checkout makes ends of each class that is derived of it. Where
it is not known of which node an end is, it stands with what makes it, and a gap says so.
"""

from __future__ import annotations

import ast
import os
from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.ingest.code.python_code import dotted
from rosprivacy.ingest.scan.python.python_calls import INIT, PythonCalls
from rosprivacy.ingest.scan.python.python_ends import (
    LAST_NAMES,
    OF_METHODS,
    OF_TRANSPORT,
    WRAPPERS,
    Ends,
    interface,
    is_node_class,
    of_library,
)
from rosprivacy.ingest.scan.python.python_owners import NO_NODES, NodeKey, PythonOwners, without_none
from rosprivacy.ingest.scan.python.python_returns import PythonReturns
from rosprivacy.ingest.scan.python.python_scopes import (
    COMPREHENSIONS,
    LOOPS,
    Checkout,
    CodeCall,
    PythonFile,
    Scope,
    branch,
    is_super,
)
from rosprivacy.ingest.scan.python.python_texts import MANY, literal
from rosprivacy.ingest.scan.python.python_value_types import (
    Frame,
    FunctionValue,
    Instance,
    Items,
    Library,
    Made,
    Open,
    Run,
    Setting,
    Value,
    Values,
    union,
    written,
)
from rosprivacy.ingest.scan.scan_facts import (
    CodeEndpoint,
    CodeFacts,
    CodeNode,
    CodePlace,
    CodeWrapper,
    Gap,
    Name,
    NamePiece,
    open_name,
    plain_text,
    sorted_names,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from rosprivacy.ingest.code.source_code import Code

OFTEN_WRONG = 2  # arguments that a call of rclpy has at least: a type and a name


def read_python_nodes(root: Path, codes: Sequence[Code], trees: Mapping[str, ast.Module]) -> CodeFacts:
    """Return the nodes that the Python code of a checkout can create.

    Parameters
    ----------
    root
        The checkout; places are relative to it.
    codes, trees
        As ``read_source_trees`` reads them; what has no tree is passed over.
    """
    return _Reader(root, Checkout(codes, trees)).facts()


def _relative(file: str, root: Path) -> str:
    return os.path.relpath(file, root).replace(os.sep, "/")


class _NodeParts:
    """What is found of one node, or of a piece of code whose node is not known."""

    def __init__(self) -> None:
        self.ends: dict[tuple[CodePlace, str, str, bool], dict[Name, None]] = defaultdict(dict)
        self.wrappers: dict[CodeWrapper, None] = {}
        self.settings: dict[str, Values] = {}


class _Reader:
    def __init__(self, root: Path, checkout: Checkout) -> None:
        self.root = root
        self.checkout = checkout
        self.calls = PythonCalls(checkout)
        self.values = self.calls.values
        self.nodes: dict[NodeKey, _NodeParts] = defaultdict(_NodeParts)
        self.gaps: dict[Gap, None] = {}
        self.homeless: dict[Scope, _NodeParts] = defaultdict(_NodeParts)
        self._settings_of_files: dict[tuple[str, str], Values] = {}
        self._settings_anywhere: dict[str, dict[Values, None]] = defaultdict(dict)
        self._declarations: dict[tuple[Scope, str], list[ast.Call]] = defaultdict(list)  # by literal name, or none
        self.returns = PythonReturns(checkout, self.values)
        self.owners = PythonOwners(self.calls, self.returns)
        self.returns.settings = self._setting

    def facts(self) -> CodeFacts:
        self._declare()
        for read in self.checkout.files.values():
            if _is_of_ros_1(read):
                self.gaps[
                    Gap(CodePlace(_relative(read.file, self.root), 1), "file", "code of ROS 1, which is not read")
                ] = None
                continue
            for cls in read.classes:
                if self.owners.is_node(cls) and cls in self.calls.derived(cls):
                    self.nodes[cls]  # a node without ends is one, too
            for one in read.calls:
                try:
                    self._site(one)
                except RecursionError:
                    self.values.forget()
                    self._gap(one.call, one.scope, "name", "code that is too deep to follow")
            for attribute, scope in read.passed_on:
                if attribute.attr in OF_METHODS and self._is_end(attribute.value, scope):
                    what = f"{attribute.attr} is handed on, and called where it is not seen with what name"
                    self._gap(attribute, scope, "name", what)
        for key in self.owners.runs:
            self.nodes[key]  # without ends, too
        nodes = [self._node(key, one) for key, one in self.nodes.items()]
        nodes += [self._without_node(scope, one) for scope, one in self.homeless.items()]
        return CodeFacts(tuple(sorted(nodes, key=lambda one: (one.place, one.name))), tuple(sorted(self.gaps)))

    def _node(self, key: NodeKey, parts: _NodeParts) -> CodeNode:
        if isinstance(key, ast.Call):
            runs = list(self.owners.runs[key])
            scope = runs[0].frame.scope
            library = next(
                (value.name for value in self.values.of(key.func, runs[0].frame) if isinstance(value, Library)), ""
            )
            names, spaces = self.owners.names((run, 0, library) for run in runs)
            place, name = self._place(key, scope), (scope.of_class or scope).name
            if library.rpartition(".")[2] in WRAPPERS:
                parts.wrappers[CodeWrapper(place, library.rpartition(".")[2])] = None
            makes = [key]
        else:
            scope = key.above or key
            made = [found for me in self.calls.instances(key) for found in self.owners.made_by(me)]
            names, spaces = self.owners.names(made)
            place, name = self._place(key.node, scope), key.name
            for run, _, library in made:
                if not library.startswith("rclpy"):
                    parts.wrappers[CodeWrapper(self._place(run.call, run.frame.scope), library.rpartition(".")[2])] = (
                        None
                    )
            makes = [run.call for run, _, _ in made]
        named = tuple(text for text in names if plain_text(text) != "")
        if not named or any(piece.text is None for text in named for piece in text):
            why = next(
                (piece.why for text in named for piece in text if piece.why),
                "a class or call that is not in the sources",
            )
            self.gaps[Gap(place, "node", f"the name of the node: it depends on {why}")] = None
        for call in makes:
            if any(given.arg == "cli_args" for given in call.keywords):
                self.gaps[Gap(place, "remap", "arguments for ROS that the code gives to the node itself")] = None
        defaults = ((setting, self.values.texts(values)) for setting, values in sorted(parts.settings.items()))
        settings = {
            setting: text for setting, texts in defaults for text in map(plain_text, texts[:1]) if text is not None
        }
        return CodeNode(
            place,
            name or "main",
            "python",
            named,
            spaces,
            "",
            _ends(parts),
            tuple(sorted(parts.wrappers)),
            parameters=settings,
        )

    def _without_node(self, scope: Scope, parts: _NodeParts) -> CodeNode:
        owner = scope.of_class or scope
        name = owner.name or owner.file.file.rpartition("/")[2]
        return CodeNode(self._place(owner.node, owner), name, "python", (), endpoints=_ends(parts))

    # parameters

    def _declare(self) -> None:
        """Read what nodes declare as parameters."""
        for name in ("declare_parameter", "declare_parameters"):
            for one in self.checkout.calls.get(name, ()):
                if isinstance(one.call.func, ast.Attribute):
                    self._declarations[one.scope, _literal_name(one.call)].append(one.call)
        for (scope, _), calls in list(self._declarations.items()):
            for call in calls:
                try:
                    self._declaration(call, scope)
                except RecursionError:
                    self._gap(call, scope, "parameter", "code that is too deep to follow")
                    self.values.forget()
        self.values.forget()

    def _declaration(self, call: ast.Call, scope: Scope) -> None:
        for frame in self._frames(call, scope):
            keys, _ = self.owners.keys(self.values.answer(call.func.value, frame), as_owner=True)  # type: ignore[attr-defined]
            for name, default in self._declared(call, frame):
                for key in keys:
                    before = self.nodes[key].settings.get(name, ())
                    self.nodes[key].settings[name] = union([*before, *default])
                at = (scope.file.file, name)
                self._settings_of_files[at] = union([*self._settings_of_files.get(at, ()), *default])
                self._settings_anywhere[name][default] = None

    def _declared(self, call: ast.Call, frame: Frame) -> Iterator[tuple[str, Values]]:
        """Names and defaults of the parameters that a call declares."""
        if call.func.attr == "declare_parameter":  # type: ignore[attr-defined]
            default = without_none(self.returns.argument(call, frame, 1, "value"))
            for name in self.values.plain_texts(self.returns.argument(call, frame, 0, "name")):
                yield name, default
            return
        spaces = self.values.plain_texts(self.returns.argument(call, frame, 0, "namespace")) or [""]
        for item in self.values.listed(self.returns.argument(call, frame, 1, "parameters")) or ():
            for pair in self.values.item(item):
                parts = pair.items if isinstance(pair, Items) else ()
                names = self.values.plain_texts(self.values.item(parts[0])) if parts else []
                default = without_none(self.values.item(parts[1])) if len(parts) > 1 else ()
                yield from ((f"{space}.{name}" if space else name, default) for space in spaces for name in names)

    def _setting(self, name: str, frame: Frame, me: Instance) -> Values:
        """A parameter with what it is by default, as the same function, the node, its file, or the one place says."""
        here = [
            default
            for key in ((frame.scope, name), (frame.scope, ""))
            for call in self._declarations.get(key, ())
            for own, default in self._declared(call, frame)
            if own == name and default
        ]
        if here:
            return (Setting(name, union(one for some in here for one in some)),)
        keys = self.calls.derived(me.scope) if isinstance(me.scope.node, ast.ClassDef) else []
        owned = [self.nodes[key].settings.get(name, ()) for key in (me.scope, *keys) if key in self.nodes]
        of_file = self._settings_of_files.get((frame.scope.file.file, name), ())
        anywhere = [one for one in self._settings_anywhere.get(name, ()) if one]
        default = union(one for some in owned for one in some) or of_file or (anywhere[0] if len(anywhere) == 1 else ())
        return (Setting(name, default),)

    # ends of channels

    def _site(self, site: CodeCall) -> None:
        call, scope = site
        func = call.func
        name = func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "")
        if isinstance(func, ast.Attribute) and name in OF_METHODS:
            if not self._overridden(func, scope):
                self._end(call, scope, OF_METHODS[name], func.value)
            return
        if isinstance(func, ast.Attribute) and name in OF_TRANSPORT:
            owners = self.values.of(func.value, self.values.frame_of(scope))
            if any(isinstance(value, Made) and value.name.endswith("ImageTransport") for value in owners):
                self._end(call, scope, OF_TRANSPORT[name], func.value)
            return
        if name == INIT and scope.of_class is not None and is_super(getattr(func, "value", None)):
            for library in self.values.line(scope.of_class)[1]:
                if ends := of_library(library):
                    self._end(call, scope, ends, None)
            return
        if not (name[:1].isupper() or name in LAST_NAMES or name == "create_node"):
            return
        functions = self.values.of(func, self.values.frame_of(scope))
        for library in (value.name for value in functions if isinstance(value, Library)):
            self._of_library(library, call, scope)

    def _of_library(self, library: str, call: ast.Call, scope: Scope) -> None:
        if ends := of_library(library):
            self._end(call, scope, ends, None)
        elif is_node_class(library):
            for frame in self._frames(call, scope):
                self.owners.runs[call][Run(call, frame)] = None
        elif library.partition(".")[0] not in NO_NODES and "." in library:
            self._wrapper(call, scope, library)

    def _wrapper(self, call: ast.Call, scope: Scope, library: str) -> None:
        """An object of another package that is given a node may make ends of channels for it."""
        given = [
            one
            for one in (*call.args, *(one.value for one in call.keywords))
            if isinstance(one, ast.Name | ast.Attribute)
        ]
        for frame in self._frames(call, scope) if given else ():
            for one in given:
                keys, _ = self.owners.keys(self.values.answer(one, frame))
                for key in keys:
                    wrapper = CodeWrapper(self._place(call, scope), library.rpartition(".")[2])
                    self.nodes[key].wrappers[wrapper] = None

    def _overridden(self, func: ast.Attribute, scope: Scope) -> bool:
        """Whether a call is one of a method that the checkout itself writes under that name."""
        if is_super(func.value):
            return False
        called = self.values.of(func, self.values.frame_of(scope))
        return bool(called) and all(isinstance(one, FunctionValue) for one in called)

    def _is_end(self, owner: ast.expr, scope: Scope) -> bool:
        return bool(self.owners.keys(self.values.of(owner, self.values.frame_of(scope)), as_owner=True)[0])

    def _frames(self, call: ast.AST, scope: Scope) -> list[Frame]:
        """For what a call runs: each caller, and each turn of the loops that it stands in."""
        loops: list[tuple[ast.AST, ast.expr]] = []
        for outer, field in branch(call, scope.file):
            if outer is scope.node:
                break
            if isinstance(outer, LOOPS) and field == "body":
                loops.insert(0, (outer, outer.iter))
            elif isinstance(outer, COMPREHENSIONS) and field != "generators":
                loops[:0] = [(one, one.iter) for one in outer.generators]
        frames: list[Frame] = []
        for frame in self.calls.frames(scope):
            turned = [frame]
            for loop in loops:
                further = [self.values.turns([loop], one) for one in turned]
                inside = [one for some in further if some for one in some]
                if inside and all(some is not None for some in further) and len(inside) <= MANY:
                    turned = inside
            frames += turned
        return frames if len(frames) <= MANY * MANY else [self.values.frame_of(scope)]

    def _end(self, call: ast.Call, scope: Scope, ends: Ends, owner: ast.expr | None) -> None:
        """Note the ends that a call makes, for each node and each name."""
        place = self._place(call, scope)
        noted = False
        for frame in self._frames(call, scope):
            nodes = self._owners(call, frame, ends, owner)
            types = self._types(call, frame, ends)
            keys, rest = self.owners.keys(nodes, as_owner=ends.node is None)
            if not keys and not self._may_be_end(call, rest, types, ends):
                continue
            noted = True
            names = [literal(one) for one in ends.fixed] or [*self._channel(call, frame, ends)]
            found: list[_NodeParts] = [self.nodes[key] for key in keys]
            if not keys or any(isinstance(one, Open) for one in rest):
                what = plain_text(names[0]) or ends.roles[0]
                why = next((one.why for one in rest if isinstance(one, Open)), "what it is given as a node")
                self._gap(call, scope, "node-of", f"of which node {what} is: it depends on {why}")
                found += [] if keys else [self.homeless[scope.of_class or scope]]
            for name in names:
                open_piece = next((one for one in name if one.text is None), None)
                if open_piece is not None:
                    self._gap(
                        call, scope, "name", f"the name of a channel ({ends.roles[0]}): it depends on {open_piece.why}"
                    )
                for one in found:
                    one.ends[
                        place, ends.roles[0], ends.fixed_type or (types[0] if len(types) == 1 else ""), ends.below
                    ][name] = None
        if not noted and not self.calls.frames(scope):
            self._gap(call, scope, "name", "a call that is not followed")

    def _owners(self, call: ast.Call, frame: Frame, ends: Ends, owner: ast.expr | None) -> Values:
        if ends.node is not None:
            return self.returns.argument(call, frame, *ends.node)
        if owner is not None and is_super(owner):
            return (frame.me,) if frame.me else ()
        return self.values.answer(owner, frame)

    def _may_be_end(self, call: ast.Call, owners: Sequence[Value], types: Sequence[str], ends: Ends) -> bool:
        """Whether a call on what is not known to be a node may make an end; not of a library of another sort."""
        if ends.node is not None or types:
            return True
        count = sum(OFTEN_WRONG if isinstance(one, ast.Starred) else 1 for one in call.args) + len(call.keywords)
        foreign = owners and all(
            isinstance(one, Made | Library) and one.name.partition(".")[0] != "rclpy" for one in owners
        )
        return count >= OFTEN_WRONG and not foreign

    def _channel(self, call: ast.Call, frame: Frame, ends: Ends) -> Iterator[Name]:
        values = without_none(self.returns.argument(call, frame, *ends.name))
        if not values:
            yield open_name("arguments that are not read")
        for name in dict.fromkeys(self.values.texts(values, _words(call, ends))):
            if plain_text(name) == "":
                setting = next((piece.parameter for piece in name if piece.parameter), "")
                yield (
                    NamePiece(
                        None,
                        "guessed",
                        setting,
                        f"parameter {setting}, which is empty by default" if setting else "an empty text",
                    ),
                )
            else:
                yield name

    def _types(self, call: ast.Call, frame: Frame, ends: Ends) -> list[str]:
        values = self.returns.argument(call, frame, *ends.type) if not ends.fixed_type else ()
        found: dict[str, None] = {}
        for one in values:
            if isinstance(one, Library | Made):
                found[interface(one.name)] = None
            else:
                found.update(
                    dict.fromkeys(text for text in self.values.plain_texts((one,)) if text.count("/") == OFTEN_WRONG)
                )
        return [one for one in found if one]

    def _place(self, node: ast.AST, scope: Scope) -> CodePlace:
        return CodePlace(_relative(scope.file.file, self.root), int(getattr(node, "lineno", 1)))

    def _gap(self, node: ast.AST, scope: Scope, sort: str, text: str) -> None:
        self.gaps[Gap(self._place(node, scope), sort, text)] = None


def _is_of_ros_1(read: PythonFile) -> bool:
    """Whether a file is written for ROS 1, and not for both."""
    first = {meant.partition(".")[0] for some in read.names.values() for meant in some}
    return "rospy" in first | {one.partition(".")[0] for one in read.all_of} and "rclpy" not in first


def _literal_name(call: ast.Call) -> str:
    """The name of the one parameter that a call declares; empty where it is no literal, or where there are several."""
    first = call.args[0] if call.args and call.func.attr == "declare_parameter" else None  # type: ignore[attr-defined]
    return first.value if isinstance(first, ast.Constant) and isinstance(first.value, str) else ""


def _words(call: ast.Call, ends: Ends) -> str:
    """What the argument that names a channel is, as it is written."""
    place, keyword = ends.name
    given = (
        call.args[place]
        if place < len(call.args)
        else next((one.value for one in call.keywords if one.arg == keyword), None)
    )
    return written(given) if given is not None else dotted(call.func)


def _ends(parts: _NodeParts) -> tuple[CodeEndpoint, ...]:
    ends = (CodeEndpoint(*key[:2], sorted_names(names), *key[2:]) for key, names in parts.ends.items())
    return tuple(sorted(ends, key=lambda end: (end.place, end.role, str(end.names))))
