"""What the code of each node uses, as far as the code says which node it is of; nothing is guessed.

In: files. Out: uses by the name of a node. If a file has one node, all that stands in the file is of that node. If it
has several, each has what stands in its class or function, and in what that uses. In both cases what they use of
modules that are there belongs to them, too; the class of another node does not, unless the one is derived of the other.
A file without a node that uses the node of one other file, and of no third one, runs it in its process (a server with a
page, a window): it belongs to that node, too; tests do not.

A piece is a class or function at the top of a Python file, or a class of a C++ package. In Python a link is a name of
the file itself, or of a module that it imports and that is there: beside it, above it, or in the one other package of
the sources that has it (``src/robot_llm/robot_llm/client.py`` for ``robot_llm.client``). A name that a module only
imports (``from .client import Client`` in an ``__init__.py``) is what it imports. In C++ it is the name of a class of
the same package, by the folders: what holds ``src`` or ``include``. What does not resolve is a use of a library.

Launch files rename nodes: ``Node(package=…, executable=…, name=…)``, together with the entry points of ``setup.py``,
gives the one node of a module that name as well.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from pathlib import PurePath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.suggesting.library_rules import CPP, PYTHON, NodeUse
from rosprivacy.ingest.code.code_names import ROOT, CodeNames, is_ros_name
from rosprivacy.ingest.code.source_code import NODE, class_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.ingest.code.source_code import CallSite, Code

INIT = "__init__.py"
FOLDERS = ("src", "include")  # of a package of C++
HANDED_ON = 4  # modules that a name is imported through, one from the other
ALL = "*"  # that is imported from a module
TESTS = frozenset(["test", "tests", "testing"])  # folders


class CodePiece(NamedTuple):
    """A class or function; an empty name is all else in a file.

    Attributes
    ----------
    of
        A file, or the folder of a package of C++.
    """

    of: str
    name: str


class Local(NamedTuple):
    """A use that is of these sources, by its name, and could be of a library of that name.

    Attributes
    ----------
    of
        The file, or the folder of a package of C++, that has it.
    """

    use: NodeUse
    of: str


class CodeModules:
    """The modules of some files of Python, by the names that they are imported by."""

    def __init__(self, codes: Sequence[Code]) -> None:
        self._python = {code.file: code for code in codes if code.language == PYTHON}
        self._modules = {part for file in self._python for part in (PurePath(file).stem, *PurePath(file).parent.parts)}
        self._packages: dict[str, set[PurePath]] = defaultdict(set)  # where each could be imported from
        for file in self._python:
            if PurePath(file).name == INIT:
                self._packages[PurePath(file).parent.name].add(PurePath(file).parent.parent)

    def module(self, folder: str, name: str) -> str:
        """Return the file of a module as code in a folder would import it; empty if it is not there."""
        found = self.begin_of(folder, name)
        return found[0] if found and not found[1] else ""

    def begin_of(self, folder: str, name: str) -> tuple[str, list[str]] | None:
        """Return a file, and what is left of a name that begins with a module: ``.helper.Camera``, ``demo.a.B``."""
        level = len(name) - len(name.lstrip("."))
        parts = name[level:].split(".")
        if parts[0] not in self._modules:
            return None
        found = self._longest(_bases(PurePath(folder), level), parts)
        if found or level:
            return found
        elsewhere = [self._longest([base], parts) for base in sorted(self._packages.get(parts[0], ()))]
        modules = [one for one in elsewhere if one and not one[0].endswith(INIT)] or [one for one in elsewhere if one]
        return modules[0] if len(modules) == 1 else None

    def _longest(self, bases: Sequence[PurePath], parts: list[str]) -> tuple[str, list[str]] | None:
        """The module with the longest name: a node is often called as the package that it stands in."""
        for count in range(len(parts), 0, -1):
            for base in bases:
                path = base.joinpath(*parts[:count])
                for file in (f"{path}.py", str(path / INIT)):
                    if file in self._python:
                        return file, parts[count:]
        return None


class CodeUnits(CodeModules):
    """The pieces of some files.

    Attributes
    ----------
    local
        Uses that no library is asked about, since something here has that name.
    """

    def __init__(self, codes: Sequence[Code]) -> None:
        super().__init__(codes)
        self._classes: dict[str, set[str]] = defaultdict(set)  # by package of C++
        self.bases: dict[CodePiece, set[str]] = defaultdict(set)
        for code in codes:
            for one in code.classes:
                self.bases[self.piece(code, one.name)].update(one.bases)
                if code.language == CPP:
                    self._classes[package_of(code.file)].add(one.name)
        self.uses: dict[CodePiece, list[NodeUse]] = defaultdict(list)
        self.links: dict[CodePiece, set[CodePiece]] = defaultdict(set)
        self.local: list[Local] = []
        self._code_units: dict[tuple[str, str], CodePiece | None] = {}
        for code in codes:
            for use in code.uses:
                piece = self.piece(code, use.unit)
                link = self._link(code, use.name)
                used = NodeUse(use.name, code.language, Place(code.file, use.line))
                if link:
                    self.links[piece].add(link)
                if not use.name.startswith("."):
                    self.uses[piece] += [] if link else [used]
                    self.local += [Local(used, link.of)] if link else []

    def piece(self, code: Code, name: str) -> CodePiece:
        """Return a piece of a file by its name."""
        return CodePiece(package_of(code.file) if code.language == CPP and name else code.file, name)

    def at(self, code: Code, line: int, of_class: str) -> CodePiece:
        """Return the piece that a line of a file stands in.

        Parameters
        ----------
        of_class
            Of C++: the class that it belongs to.
        """
        if code.language == CPP:
            return self.piece(code, of_class)
        name = next((one.name for one in code.units if one.lines.first <= line <= one.lines.last), "")
        return self.piece(code, name)

    def of_file(self, code: Code) -> tuple[CodePiece, ...]:
        """Return all pieces of a file; of C++ what is in no class, and the classes that it says something of."""
        if code.language == CPP:
            names = {"", *(use.unit for use in code.uses), *(one.name for one in code.classes)}
            return tuple(self.piece(code, name) for name in sorted(names))
        return tuple(self.piece(code, name) for name in ("", *(one.name for one in code.units)))

    def _link(self, code: Code, name: str) -> CodePiece | None:
        key = (str(PurePath(code.file).parent), name)
        if key not in self._code_units:
            self._code_units[key] = (self._cpp_link if code.language == CPP else self._python_link)(code, name)
        return self._code_units[key]

    def _cpp_link(self, code: Code, name: str) -> CodePiece | None:
        package, last = package_of(code.file), name.rpartition("::")[2]
        own = any(part in self._classes[package] for part in name.split("::")[-2:])
        if not own:
            return None
        return CodePiece(package, last if last in self._classes[package] else name.split("::")[-2])

    def _python_link(self, code: Code, name: str) -> CodePiece | None:
        found = self.begin_of(str(PurePath(code.file).parent), name)
        if found is None:
            return None
        file, rest = found
        for _ in range(HANDED_ON):
            if not rest or rest[0] in self._units(file) or (further := self._handed_on(file, rest)) is None:
                break
            file, rest = further
        return CodePiece(file, rest[0] if rest and rest[0] in self._units(file) else "")

    def _units(self, file: str) -> set[str]:
        return {one.name for one in self._python[file].units}

    def _handed_on(self, file: str, rest: list[str]) -> tuple[str, list[str]] | None:
        """Where a name comes from that a module imports; of all that it imports, the one module that has it."""
        folder, pairs = str(PurePath(file).parent), self._python[file].imports
        named = [".".join([meant, *rest[1:]]) for name, meant in pairs if name == rest[0]]
        found = [self.begin_of(folder, name) for name in named]
        whole = [self.begin_of(folder, meant.removesuffix(ALL) + rest[0]) for name, meant in pairs if name == ALL]
        found += [one for one in whole if one and one[1][:1] == rest[:1] and rest[0] in self._units(one[0])]
        known = [one for one in found if one and one[0] != file]
        return known[0] if len({one[0] for one in known}) == 1 else None


@cache
def package_of(file: str) -> str:
    """Return the folder of the package of a C++ file.

    >>> package_of("ws/src/camera/src/node.cpp"), package_of("ws/src/camera/include/camera/node.hpp")
    ('ws/src/camera', 'ws/src/camera')
    """
    folders = PurePath(file).parent
    for folder in (folders, *folders.parents):
        if folder.name in FOLDERS:
            return str(folder.parent)
    return str(folders)


@cache
def _bases(folder: PurePath, level: int) -> Sequence[PurePath]:
    """The folders that a name is looked for in: one for each dot up, or those that may be on Python's path."""
    above = (folder, *folder.parents)
    return above[level - 1 : level] if level else above


class CodeUses(NamedTuple):
    """What some files use.

    Attributes
    ----------
    of_nodes
        By full name of a node, sorted.
    without_node
        Of which nobody knows whose they are.
    local
        That are no uses of a library, since something in the files has that name.
    """

    of_nodes: Mapping[str, tuple[NodeUse, ...]]
    without_node: tuple[NodeUse, ...]
    local: tuple[Local, ...] = ()


def node_uses(codes: Sequence[Code], namespace: str = ROOT) -> CodeUses:
    """Return what nodes use.

    Parameters
    ----------
    namespace
        Of nodes that state none.

    Examples
    --------
    >>> from rosprivacy.ingest.code.python_code import read_python
    >>> code = b'''
    ... import cv2
    ... from rclpy.node import Node
    ... class Camera(Node):
    ...     def __init__(self):
    ...         super().__init__("camera")
    ...         self.film = cv2.VideoCapture(0)
    ... '''
    >>> [(name, use.name, str(use.place)) for name, own in node_uses([read_python("camera.py", code)]).of_nodes.items()
    ...     for use in own if use.name.startswith("cv2")]
    [('/camera', 'cv2.VideoCapture', 'camera.py:7')]
    """
    found = _Nodes(codes, namespace)
    own: dict[str, set[NodeUse]] = defaultdict(set)
    reached: set[CodePiece] = set()
    for piece, names in found.names.items():
        pieces = found.of_node(piece)
        for name in names:
            own[name].update(use for one in pieces for use in found.units.uses.get(one, ()))
        reached |= pieces if names else set()
    left = {use for piece, some in found.units.uses.items() if piece not in reached for use in some}
    of_nodes = {name: _sorted(some) for name, some in sorted(own.items())}
    return CodeUses(of_nodes, _sorted(left), tuple(found.units.local))


def _sorted(uses: Iterable[NodeUse]) -> tuple[NodeUse, ...]:
    return tuple(sorted(uses, key=lambda use: (use.place, use.name)))


def _own_name(site: CallSite) -> str:
    """The name of a node of which only the namespace is not known; policies have it in some namespace."""
    return f"{ROOT}{site.written}" if site.namespace is None and site.written and is_ros_name(site.written) else ""


def _is_test(file: str) -> bool:
    path = PurePath(file)
    return path.name.startswith(("test_", "conftest")) or not TESTS.isdisjoint(path.parts)


class _Nodes:
    """The pieces of code that are nodes, and what they are called.

    Attributes
    ----------
    names
        By piece: full names; none where the code does not say.
    """

    def __init__(self, codes: Sequence[Code], namespace: str) -> None:
        self.codes, self.namespace = codes, namespace
        self.units = CodeUnits(codes)
        self.names: dict[CodePiece, set[str]] = defaultdict(set)
        self.files: dict[str, set[CodePiece]] = defaultdict(set)  # the nodes of each file
        names = CodeNames(codes, namespace)
        for code in codes:
            for site in code.sites:
                if site.kind == NODE and names.is_node(code, site):
                    piece = self.units.at(code, site.lines.first, class_of(site.owner))
                    self.names[piece].update(filter(None, [names.name(code, site) or _own_name(site)]))
                    self.files[code.file].add(piece)
        self._code = {code.file: code for code in codes}
        self._runs = self._running()
        for file, name in self._launched():
            pieces = self._run_by(file)
            if len(pieces) == 1 and len(self.names[pieces[0]]) <= 1:
                self.names[pieces[0]].add(f"{namespace.rstrip('/')}/{name}")

    def of_node(self, piece: CodePiece) -> set[CodePiece]:
        """Return all pieces of code that belong to a node."""
        files = [file for file, own in self.files.items() if own == {piece}]
        alone = {one for file in files for one in self.units.of_file(self._code[file])}
        return self._reached({piece, *alone, *self._runs.get(piece, ())})

    def _reached(self, starts: Iterable[CodePiece]) -> set[CodePiece]:
        waiting = [*starts]
        reached = set(waiting)
        while waiting:
            piece = waiting.pop()
            for other in self.units.links.get(piece, ()):
                another_node = other in self.names and other.name not in self.units.bases.get(piece, ())
                if other not in reached and not another_node:
                    reached.add(other)
                    waiting.append(other)
        return reached

    def _running(self) -> Mapping[CodePiece, Sequence[CodePiece]]:
        """By node: the files that run it, and no other one."""
        found: dict[CodePiece, list[CodePiece]] = defaultdict(list)
        for code in self.codes:
            if code.language == PYTHON and code.file not in self.files and not _is_test(code.file):
                nodes = self._run_by(code.file)
                if len(nodes) == 1:
                    found[nodes[0]].extend(self.units.of_file(code))
        return found

    def _run_by(self, file: str) -> list[CodePiece]:
        """The nodes of a module that is run: its own, or those that it uses."""
        if own := self.files.get(file):
            return sorted(own)
        pieces = self.units.of_file(self._code[file])
        return sorted({other for piece in pieces for other in self.units.links.get(piece, ()) if other in self.names})

    def _launched(self) -> Iterator[tuple[str, str]]:
        """The files that launch files run, each with the name that they give to its node."""
        scripts: dict[tuple[str, str], set[str]] = defaultdict(set)
        for code in self.codes:
            folder = PurePath(code.file).parent
            for script in code.scripts:
                module = self.units.module(str(folder), script.module)
                for package in {folder.name, script.module.partition(".")[0]} if module else ():
                    scripts[package, script.executable].add(module)
        by_name: dict[str, list[str]] = defaultdict(list)
        for file in self._code:
            by_name[PurePath(file).name].append(file)
        for code in self.codes:
            for launch in code.launches:
                files = scripts.get((launch.package, launch.executable), set())
                named = [one for one in by_name.get(launch.executable, ()) if launch.package in PurePath(one).parts]
                every = files or set(named)
                if launch.name.isidentifier() and len(every) == 1:
                    yield next(iter(every)), launch.name
