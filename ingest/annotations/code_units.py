"""Which pieces of code use which: classes and functions at the top of Python files, and classes of C++ packages.

In: files. Out: the uses of libraries of each piece, and its links to others. In Python a link is a name of the file
itself, or of a module that it imports and that is there: beside it, above it, or in the one other package of the
sources that has it (``src/robot_llm/robot_llm/client.py`` for ``robot_llm.client``). A name that a module only imports
(``from .client import Client`` in an ``__init__.py``) is what it imports. In C++ it is the name of a class of the same
package, by the folders: what holds ``src`` or ``include``. What does not resolve is a use of a library.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from pathlib import PurePath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.suggesting.library_rules import CPP, PYTHON, NodeUse

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.annotations.source_code import Code

INIT = "__init__.py"
FOLDERS = ("src", "include")  # of a package of C++
HANDED_ON = 4  # modules that a name is imported through, one from the other
ALL = "*"  # that is imported from a module


class Piece(NamedTuple):
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


class CodeUnits:
    """The pieces of some files.

    Attributes
    ----------
    local
        Uses that no library is asked about, since something here has that name.
    """

    def __init__(self, codes: Sequence[Code]) -> None:
        self._python = {code.file: code for code in codes if code.language == PYTHON}
        self._modules = {part for file in self._python for part in (PurePath(file).stem, *PurePath(file).parent.parts)}
        self._classes: dict[str, set[str]] = defaultdict(set)  # by package of C++
        self._packages: dict[str, set[PurePath]] = defaultdict(set)  # of Python: where each could be imported from
        for file in self._python:
            if PurePath(file).name == INIT:
                self._packages[PurePath(file).parent.name].add(PurePath(file).parent.parent)
        self.bases: dict[Piece, set[str]] = defaultdict(set)
        for code in codes:
            for one in code.classes:
                self.bases[self.piece(code, one.name)].update(one.bases)
                if code.language == CPP:
                    self._classes[package_of(code.file)].add(one.name)
        self.uses: dict[Piece, list[NodeUse]] = defaultdict(list)
        self.links: dict[Piece, set[Piece]] = defaultdict(set)
        self.local: list[Local] = []
        self._known: dict[tuple[str, str], Piece | None] = {}
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

    def piece(self, code: Code, name: str) -> Piece:
        """Return a piece of a file by its name."""
        return Piece(package_of(code.file) if code.language == CPP and name else code.file, name)

    def at(self, code: Code, line: int, of_class: str) -> Piece:
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

    def of_file(self, code: Code) -> tuple[Piece, ...]:
        """Return all pieces of a file; of C++ what is in no class, and the classes that it says something of."""
        if code.language == CPP:
            names = {"", *(use.unit for use in code.uses), *(one.name for one in code.classes)}
            return tuple(self.piece(code, name) for name in sorted(names))
        return tuple(self.piece(code, name) for name in ("", *(one.name for one in code.units)))

    def module(self, folder: str, name: str) -> str:
        """Return the file of a module as code in a folder would import it; empty if it is not there."""
        found = self._module(folder, name)
        return found[0] if found and not found[1] else ""

    def _link(self, code: Code, name: str) -> Piece | None:
        key = (str(PurePath(code.file).parent), name)
        if key not in self._known:
            self._known[key] = (self._cpp_link if code.language == CPP else self._python_link)(code, name)
        return self._known[key]

    def _cpp_link(self, code: Code, name: str) -> Piece | None:
        package, last = package_of(code.file), name.rpartition("::")[2]
        own = any(part in self._classes[package] for part in name.split("::")[-2:])
        if not own:
            return None
        return Piece(package, last if last in self._classes[package] else name.split("::")[-2])

    def _python_link(self, code: Code, name: str) -> Piece | None:
        found = self._module(str(PurePath(code.file).parent), name)
        if found is None:
            return None
        file, rest = found
        for _ in range(HANDED_ON):
            if not rest or rest[0] in self._units(file) or (further := self._handed_on(file, rest)) is None:
                break
            file, rest = further
        return Piece(file, rest[0] if rest and rest[0] in self._units(file) else "")

    def _units(self, file: str) -> set[str]:
        return {one.name for one in self._python[file].units}

    def _handed_on(self, file: str, rest: list[str]) -> tuple[str, list[str]] | None:
        """Where a name comes from that a module imports; of all that it imports, the one module that has it."""
        folder, pairs = str(PurePath(file).parent), self._python[file].imports
        named = [".".join([meant, *rest[1:]]) for name, meant in pairs if name == rest[0]]
        found = [self._module(folder, name) for name in named]
        whole = [self._module(folder, meant.removesuffix(ALL) + rest[0]) for name, meant in pairs if name == ALL]
        found += [one for one in whole if one and one[1][:1] == rest[:1] and rest[0] in self._units(one[0])]
        known = [one for one in found if one and one[0] != file]
        return known[0] if len({one[0] for one in known}) == 1 else None

    def _module(self, folder: str, name: str) -> tuple[str, list[str]] | None:
        """A file, and what is left of a name that begins with a module: ``.helper.Camera``, ``demo.helper.Camera``."""
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
