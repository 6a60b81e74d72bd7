"""``CMakeLists.txt`` -> the executables, components and scripts of a package, with the sources of each.

In: text and the files that there are. Out: ``Target``s. Variables, lists, ``foreach`` over what can be told,
``file(GLOB …)``, functions and macros of the package are followed; of ``if`` all branches are, but those for tests.
What a function of another package makes is not seen.

Source: the reference of CMake (``add_executable``, ``file``, ``foreach``, ``install``), ``ament_cmake_auto`` and
``rclcpp_components``.
"""

from __future__ import annotations

import posixpath
import re
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

MOST_WORDS = 100_000  # of all commands of a package with their arguments: lists that double are no package's
DEEPEST = 20  # folders in folders, loops in loops
ROOT = "/checkout/"  # begins a path from the root of the checkout
SOURCE = (".c", ".cc", ".cpp", ".cxx", ".c++")
_TOKEN = re.compile(
    r'#\[(=*)\[.*?\]\1\]|#[^\n]*|\[(=*)\[.*?\]\2\]|"(?:[^"\\]|\\.)*"|[()]|\n|[^\s()#"]+|[^\S\n]+|.', re.DOTALL
)
_VARIABLE = re.compile(r"\$\{([\w.+/-]+)\}")
KEYWORDS = frozenset(
    [
        "ALL",
        "EXCLUDE_FROM_ALL",
        "INTERFACE",
        "MACOSX_BUNDLE",
        "MODULE",
        "OBJECT",
        "PRIVATE",
        "PUBLIC",
        "SHARED",
        "STATIC",
        "WIN32",
        "NO_TARGET_LINK_LIBRARIES",
    ]
)
SECTIONS = frozenset(
    [
        "BUNDLE",
        "COMPONENT",
        "CONFIGURATIONS",
        "DESTINATION",
        "OPTIONAL",
        "PERMISSIONS",
        "RENAME",
        "TYPE",
        "USE_SOURCE_PERMISSIONS",
        "FILES_MATCHING",
        "PATTERN",
        "REGEX",
        "EXCLUDE",
    ]
)


class Target(NamedTuple):
    """What a package builds or installs to be run.

    Attributes
    ----------
    name
        Of an executable, a component's class, or a script.
    files
        Relative to the root of the checkout, sorted.
    plugin
        Of an executable that is made for a component, its class.
    """

    name: str
    file: str
    line: int
    files: tuple[str, ...]
    plugin: str = ""


class _Command(NamedTuple):
    name: str
    line: int
    words: tuple[str, ...]


@dataclass(slots=True, eq=False, repr=False)
class _Made:
    """A target of CMake."""

    line: int
    file: str
    sources: list[str] = field(default_factory=list)
    linked: list[str] = field(default_factory=list)
    program: bool = False
    output: str = ""


class Registered(NamedTuple):
    """A description of a node that goes into the ament index; its package is named where it is another one."""

    name: str
    file: str
    package: str = ""


class Targets(NamedTuple):
    """What a package makes.

    Attributes
    ----------
    whole
        Whether all was followed; what grows without end is not.
    """

    targets: tuple[Target, ...]
    whole: bool
    registered: tuple[Registered, ...] = ()


def read_targets(folder: str, files: Sequence[str], text: Callable[[str], str | None]) -> Targets:
    """Return what the ``CMakeLists.txt`` of a package's folder makes.

    Parameters
    ----------
    files
        Of the package.
    text
        Of a file; None where it cannot be read.
    """
    reader = _Reader(files, text)
    reader.folder(folder, {}, 0)
    return Targets(tuple(reader.result()), reader.words <= MOST_WORDS, tuple(reader.registered))


class _Reader:
    def __init__(self, files: Sequence[str], text: Callable[[str], str | None]) -> None:
        self.files = files
        self.existing = frozenset(files)
        self.text = text
        self.targets: dict[str, _Made] = {}
        self.plugins: list[tuple[str, str, str, str, int]] = []  # target, class, executable, file, line
        self.scripts: list[Target] = []
        self.registered: list[Registered] = []
        self.macros: dict[str, tuple[tuple[str, ...], Sequence[_Command]]] = {}  # and functions: parameters, body
        self.words = 0

    def folder(self, folder: str, variables: dict[str, str], depth: int) -> None:
        file = posixpath.normpath(posixpath.join(folder, "CMakeLists.txt"))
        text = self.text(file) if file in self.existing and depth < DEEPEST else None
        if text is None:
            return
        variables.setdefault("CMAKE_SOURCE_DIR", ROOT + folder)
        variables.setdefault("PROJECT_SOURCE_DIR", ROOT + folder)
        variables["CMAKE_CURRENT_SOURCE_DIR"] = variables["CMAKE_CURRENT_LIST_DIR"] = ROOT + folder
        self.block(list(_commands(text)), file, folder, variables, depth)

    def block(
        self, commands: Sequence[_Command], file: str, folder: str, variables: dict[str, str], depth: int
    ) -> None:
        at = 0
        while at < len(commands) and self.words <= MOST_WORDS:
            self.words += 1
            command = commands[at]
            if command.name == "foreach":
                end = _end(commands, at, "foreach", "endforeach")
                self.loop(command, commands[at + 1 : end], file, folder, variables, depth)
                at = end
            elif command.name == "if" and "BUILD_TESTING" in command.words:
                at = _end(commands, at, "if", "endif")
            elif command.name in ("function", "macro"):
                end = _end(commands, at, command.name, f"end{command.name}")
                if command.words:
                    self.macros[command.words[0].lower()] = command.words[1:], commands[at + 1 : end]
                at = end
            else:
                self.command(command, file, folder, variables, depth)
            at += 1

    def loop(
        self, head: _Command, body: Sequence[_Command], file: str, folder: str, variables: dict[str, str], depth: int
    ) -> None:
        words = self.expanded(head.words, variables)
        if not words or depth > DEEPEST:
            return
        name, *rest = words
        if rest[:2] == ["IN", "LISTS"]:
            items = [item for one in rest[2:] for item in variables.get(one, "").split(";") if item]
        else:
            items = rest[2:] if rest[:2] == ["IN", "ITEMS"] else rest
        for item in items:
            if self.words > MOST_WORDS:
                return
            variables[name] = item
            self.block(body, file, folder, variables, depth + 1)

    def expanded(self, words: Sequence[str], variables: Mapping[str, str]) -> list[str]:
        made: list[str] = []
        for word in words:
            quoted = word.startswith('"')
            whole = word.strip('"') if quoted else word
            for _ in range(5):  # variables in variables
                if "${" not in whole or len(whole) > MOST_WORDS:
                    break
                whole = _VARIABLE.sub(lambda match: variables.get(match[1], ""), whole)
            made += [whole] if quoted else [part for part in whole.split(";") if part]
        self.words += len(made)
        return made if self.words <= MOST_WORDS else []

    def command(self, command: _Command, file: str, folder: str, variables: dict[str, str], depth: int) -> None:  # noqa: PLR0912 - one for each command
        words = self.expanded(command.words, variables)
        name = command.name
        if name in self.macros and depth < DEEPEST:
            parameters, body = self.macros[name]
            numbered = {f"ARGV{number}": word for number, word in enumerate(words)}
            passed = {"ARGV": ";".join(words), "ARGN": ";".join(words[len(parameters) :])}
            passed |= {**numbered, **dict(zip(parameters, words, strict=False))}
            self.block(body, file, folder, {**variables, **passed}, depth + 1)
            return
        if not words:
            return
        first, *rest = words
        if name == "include":
            inner = _path(folder, first)
            text = self.text(inner) if inner in self.existing and depth < DEEPEST else None
            if text is not None:
                self.block(list(_commands(text)), inner, folder, variables, depth + 1)
        elif name == "project":
            variables["PROJECT_NAME"] = variables["CMAKE_PROJECT_NAME"] = first
            variables["PROJECT_SOURCE_DIR"] = ROOT + folder
        elif name == "set":
            values = rest[: rest.index("CACHE")] if "CACHE" in rest else rest
            variables[first] = ";".join(one for one in values if one != "PARENT_SCOPE")[:MOST_WORDS]
        elif name == "list" and first in ("APPEND", "PREPEND") and rest:
            variables[rest[0]] = ";".join(filter(None, [variables.get(rest[0], ""), *rest[1:]]))[:MOST_WORDS]
        elif name == "file" and first.startswith("GLOB") and rest:
            inside = self.globbed(rest[1:], folder, deep=first == "GLOB_RECURSE")
            variables[rest[0]] = ";".join(ROOT + path for path in inside)
        elif name == "get_filename_component" and len(rest) > 1:
            variables[first] = _component(rest[0], rest[1])
        elif name in ("add_executable", "ament_auto_add_executable", "add_library", "ament_auto_add_library"):
            made = self.targets.setdefault(first, _Made(command.line, file))
            made.program = made.program or name.endswith("executable")
            made.sources += self.sources(rest, folder)
            if "auto" in name:  # links all libraries of the package that were made before
                made.linked += [other for other in self.targets if other != first]
        elif name == "target_sources" and first in self.targets:
            self.targets[first].sources += self.sources(rest, folder)
        elif name in ("target_link_libraries", "ament_target_dependencies") and first in self.targets:
            self.targets[first].linked += rest
        elif name == "set_target_properties" and "OUTPUT_NAME" in rest[:-1] and first in self.targets:
            self.targets[first].output = rest[rest.index("OUTPUT_NAME") + 1]
        elif "_register" in name:
            self.register(command._replace(words=tuple(words)), file, folder)
        elif name == "add_subdirectory":
            self.folder(_path(folder, first), dict(variables), depth + 1)
        elif name == "install" and first in ("PROGRAMS", "FILES", "DIRECTORY"):
            self.install(first, rest, command.line, file, folder)

    def register(self, command: _Command, file: str, folder: str) -> None:
        """Components, and descriptions of nodes."""
        first, *rest = command.words
        options = dict(zip(rest[::2], rest[1::2], strict=False))
        if command.name == "rclcpp_components_register_node":
            self.plugins.append((first, options.get("PLUGIN", ""), options.get("EXECUTABLE", ""), file, command.line))
        elif command.name == "rclcpp_components_register_nodes":
            self.plugins += [(first, one, "", file, command.line) for one in rest]
        elif command.name == "ament_nodl_register":
            described = _path(folder, options.get("FILE", ""))
            self.registered.append(Registered(first, described, options.get("PACKAGE", "")))

    def install(self, sort: str, words: list[str], line: int, file: str, folder: str) -> None:
        """Scripts are installed into ``lib/<package>``, where ``ros2 run`` looks."""
        end = next((at for at, word in enumerate(words) if word in SECTIONS), len(words))
        options = dict(zip(words[end:], words[end + 1 :], strict=False))
        if not (options.get("DESTINATION", "").startswith("lib") or sort == "PROGRAMS"):
            return
        for word in words[:end]:
            path = _path(folder, word)
            inside = [path] if sort != "DIRECTORY" else [one for one in self.files if posixpath.dirname(one) == path]
            for one in inside:
                if one in self.existing:
                    self.scripts.append(Target(options.get("RENAME") or posixpath.basename(one), file, line, (one,)))

    def sources(self, words: Sequence[str], folder: str) -> list[str]:
        if words[:1] == ["DIRECTORY"]:
            return self.globbed([f"{one}/*{end}" for one in words[1:] for end in SOURCE], folder, deep=False)
        return [_path(folder, word) for word in words if word not in KEYWORDS and "$<" not in word]

    def globbed(self, patterns: Sequence[str], folder: str, *, deep: bool) -> list[str]:
        made: list[str] = []
        for pattern in patterns:
            whole = _path(folder, pattern)
            head, _, last = whole.rpartition("/")
            for one in self.files if len(self.files) * len(patterns) < MOST_WORDS * 10 else ():
                above, _, name = one.rpartition("/")
                if fnmatchcase(name, last) and (fnmatchcase(above, head) or (deep and _below(above, head))):
                    made.append(one)
        return made

    def result(self) -> Iterator[Target]:
        for name, made in self.targets.items():
            if made.program:
                yield Target(made.output or name, made.file, made.line, self.whole(name))
        for target, plugin, executable, file, line in self.plugins:
            files = self.whole(target)
            if plugin:
                yield Target(plugin, file, line, files)
            if executable:
                yield Target(executable, file, line, files, plugin)
        yield from self.scripts

    def whole(self, name: str) -> tuple[str, ...]:
        """The sources of a target, with those of the libraries of the package that it links."""
        waiting, passed, files = [name], set[str](), set[str]()
        while waiting:
            one = waiting.pop()
            made = self.targets.get(one)
            if made is None or one in passed or (made.program and one != name):
                continue
            passed.add(one)
            files.update(source for source in made.sources if source in self.existing)
            waiting += made.linked
        return tuple(sorted(files))


def _end(commands: Sequence[_Command], at: int, begins: str, ends: str) -> int:
    open_blocks = 0
    for index in range(at, len(commands)):
        open_blocks += (commands[index].name == begins) - (commands[index].name == ends)
        if not open_blocks:
            return index
    return len(commands)


def _commands(text: str) -> Iterator[_Command]:
    """``name(words …)``, one after the other."""
    line, before, depth = 1, "", 0
    words: list[str] = []
    start = 1
    for token in _TOKEN.finditer(text):
        word = token[0]
        if word == "(":
            depth += 1
            if depth == 1:
                words, start = [], line
        elif word == ")" and depth:
            depth -= 1
            if not depth:
                yield _Command(before.lower(), start, tuple(words))
        elif word.strip() and not word.startswith("#"):
            if depth:
                words.append(word)
            else:
                before = word
        line += word.count("\n")


def _path(folder: str, word: str) -> str:
    return posixpath.normpath(word.removeprefix(ROOT) if word.startswith(ROOT) else posixpath.join(folder, word))


def _below(folder: str, above: str) -> bool:
    return above in ("", ".") or folder.startswith(f"{above}/")


def _component(path: str, part: str) -> str:
    name = posixpath.basename(path)
    if part in ("NAME_WE", "NAME_WLE"):
        return name.partition(".")[0] if part == "NAME_WE" else posixpath.splitext(name)[0]
    return {"NAME": name, "DIRECTORY": posixpath.dirname(path), "PATH": posixpath.dirname(path)}.get(part, path)
