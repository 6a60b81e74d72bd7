"""The interfaces of the nodes of a public system, read from its Python sources -> a system file of the labelled set.

In: a folder with the sources at one commit. Out: nodes with a literal name, and those of their channels whose names are
literals, constants or defaults of parameters. Sources are parsed (``ast``), nothing is run, nothing of them is kept.
"""

from __future__ import annotations

import ast
import io
import re
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

from ruamel.yaml import YAML

from tests.labelled.labelled_set import HERE
from tests.labelled.literal_values import Values, name_of, type_of, types_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

WIDTH = 120
FEWEST, MOST = 4, 45  # nodes: fewer tell little of a robot, more are too much for a reader
OTHERS = frozenset(["build", "install", "log", "test", "tests", "venv", "site-packages", "node_modules"])
LEGS = ("publishes", "subscribes", "serves", "calls")
METHODS = {  # a method of a node -> leg, place of type and name among its arguments
    "create_publisher": ("publishes", 0, 1),
    "create_lifecycle_publisher": ("publishes", 0, 1),
    "create_subscription": ("subscribes", 0, 1),
    "create_service": ("serves", 0, 1),
    "create_client": ("calls", 0, 1),
}
CLASSES = {  # a class that takes a node first
    "ActionServer": ("serves", 1, 2),
    "ActionClient": ("calls", 1, 2),
    "Subscriber": ("subscribes", 1, 2),  # of message_filters
}
KEYWORDS = {"type": ("msg_type", "srv_type", "action_type"), "name": ("topic", "srv_name", "action_name", "topic_name")}
NODES = frozenset(["Node", "LifecycleNode"])
NAME = re.compile(r"~?/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")


class Read(NamedTuple):
    """One node: where its name is given, and its channels by leg and name, with their types."""

    name: str
    file: str
    channels: Mapping[str, Mapping[str, str]]


def collect(root: Path, batch: int, date: str) -> Mapping[str, str]:
    """Write the files of systems whose sources stand in a folder, each below its name; return what each gave.

    ``commits.txt`` in the folder names them, ``owner/name commit`` in each line. Not written is a system with too few
    or too many nodes, and one that carries a copy of a node of an earlier batch: what is held out was then seen.
    """
    files = [YAML(typ="safe", pure=True).load(file.read_text("utf-8")) for file in (HERE / "systems").glob("*.yaml")]
    earlier = [_as_told(name, told) for one in files if one["batch"] < batch for name, told in one["nodes"].items()]
    given = {}
    for line in (root / "commits.txt").read_text("utf-8").splitlines():
        repository, commit = line.split()
        name = repository.partition("/")[2]
        nodes = read_nodes(root / name)
        copied = [read.name for read in nodes.values() if _as_told(read.name, read.channels) in earlier]
        if copied or not FEWEST <= len(nodes) <= MOST:
            given[repository] = f"not taken: {len(nodes)} nodes, copied {copied}"
            continue
        head = {"system": name, "batch": batch, "repository": repository, "commit": commit, "read": date}
        _write(head, nodes)
        given[repository] = f"{len(nodes)} nodes"
    return given


def _as_told(name: str, told: Mapping[str, Any]) -> tuple[str, Mapping[str, Mapping[str, str]]]:
    return name, {leg: dict(told[leg]) for leg in LEGS if leg in told}


def _write(head: Mapping[str, Any], nodes: Mapping[str, Read]) -> None:
    top = {**head, "nodes": {node: {"file": read.file, **read.channels} for node, read in nodes.items()}}
    yaml, text = YAML(), io.StringIO()
    yaml.width = WIDTH
    yaml.dump(top, text)
    (HERE / "systems" / f"{head['system']}.yaml").write_text(text.getvalue(), "utf-8")


def read_nodes(sources: Path) -> Mapping[str, Read]:
    """Return the nodes below a folder, by name.

    A node without a channel tells nothing, and is left out. Of two of one name, the file that sorts first stands: the
    other is an older copy or another variant.
    """
    nodes: dict[str, Read] = {}
    for file in sorted(sources.rglob("*.py")):
        path = file.relative_to(sources)
        if (
            OTHERS.isdisjoint(path.parts[:-1])
            and not path.name.startswith("test_")
            and file.is_file()
            and not file.is_symlink()
        ):
            for read in _of_file(file, path.as_posix()):
                if read.channels:
                    nodes.setdefault(read.name, read)
    return dict(sorted(nodes.items()))


def _of_file(file: Path, path: str) -> Iterator[Read]:
    try:
        with warnings.catch_warnings(action="ignore"):
            module = ast.parse(file.read_text("utf-8", "replace"))
    except (SyntaxError, ValueError):
        return
    types = types_of(module)
    values = Values.of(module)
    for scope in ast.walk(module):
        if isinstance(scope, ast.ClassDef):
            name = _name_of_class(scope, values)
            if name:
                yield Read(name, path, _channels(scope, name, values, types, "self"))
        elif isinstance(scope, ast.FunctionDef | ast.Module):
            for variable, name in _made_nodes(scope, values):
                yield Read(name, path, _channels(scope, name, values, types, variable))


def _name_of_class(scope: ast.ClassDef, values: Values) -> str:
    """Return the name that a class of nodes gives itself: ``super().__init__("name")``."""
    if not any(name_of(base).rpartition(".")[2].endswith("Node") for base in scope.bases):
        return ""
    for call in _calls(scope):
        if isinstance(call.func, ast.Attribute) and call.func.attr == "__init__":
            of = call.func.value
            own = isinstance(of, ast.Call) and name_of(of.func) == "super"
            by_class = name_of(of).rpartition(".")[2].endswith("Node")
            at = 0 if own else 1
            if own or by_class:
                said = [word.value for word in call.keywords if word.arg == "node_name"] or call.args[at : at + 1]
                return _node_name(values.inside(scope, call).of_node(said[0]) if said else None)
    return ""


def _made_nodes(scope: ast.AST, values: Values) -> Iterator[tuple[str, str]]:
    """Return nodes that a function makes: ``node = rclpy.create_node("name")``, with the variable."""
    for own in getattr(scope, "body", ()):
        for made in ast.walk(own) if not isinstance(own, ast.ClassDef | ast.FunctionDef) else ():
            if isinstance(made, ast.Assign) and isinstance(made.value, ast.Call) and made.value.args:
                called = name_of(made.value.func)
                if called == "rclpy.create_node" or called.rpartition(".")[2] in {*NODES, "create_node"}:
                    name = _node_name(values.inside(scope, made.value).of_node(made.value.args[0]))
                    if name:
                        yield name_of(made.targets[0]), name


def _channels(
    scope: ast.AST, node: str, values: Values, types: Mapping[str, str], holder: str
) -> Mapping[str, Mapping[str, str]]:
    legs: dict[str, dict[str, str]] = {leg: {} for leg in LEGS}
    for call in _calls(scope):
        how = _how(call, holder)
        if how:
            leg, type_at, name_at = how
            name = values.inside(scope, call).of_node(_argument(call, name_at, KEYWORDS["name"]))
            if isinstance(name, str) and NAME.fullmatch(name):
                legs[leg][_full(name, node)] = type_of(_argument(call, type_at, KEYWORDS["type"]), types)
    return {leg: dict(sorted(channels.items())) for leg, channels in legs.items() if channels}


def _how(call: ast.Call, holder: str) -> tuple[str, int, int] | None:
    called = name_of(call.func)
    of, _, last = called.rpartition(".")
    if last in METHODS and of == holder:
        return METHODS[last]
    if last in CLASSES and call.args and name_of(call.args[0]) == holder:
        return CLASSES[last]
    return None


def _argument(call: ast.Call, place: int, keywords: tuple[str, ...]) -> ast.AST | None:
    named = [word.value for word in call.keywords if word.arg in keywords]
    return named[0] if named else call.args[place] if place < len(call.args) else None


def _calls(scope: ast.AST) -> Iterator[ast.Call]:
    return (one for one in ast.walk(scope) if isinstance(one, ast.Call))


def _node_name(value: object) -> str:
    return f"/{value.strip('/')}" if isinstance(value, str) and NAME.fullmatch(value) else ""


def _full(name: str, node: str) -> str:
    if name.startswith("~"):
        return f"{node}/{name[1:].strip('/')}"
    return name if name.startswith("/") else f"/{name}"
