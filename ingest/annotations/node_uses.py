"""What the code of each node uses, as far as the code says which node it is of; nothing is guessed.

In: files. Out: uses by the name of a node. If a file has one node, all that stands in the file is of that node. If it
has several, each has what stands in its class or function, and in what that uses. In both cases what they use of
modules that are there belongs to them, too; the class of another node does not, unless the one is derived of the other.
A file without a node that uses the node of one other file, and of no third one, runs it in its process (a server with a
page, a window): it belongs to that node, too; tests do not.

Launch files rename nodes: ``Node(package=…, executable=…, name=…)``, together with the entry points of ``setup.py``,
gives the one node of a module that name as well.
"""

from __future__ import annotations

from collections import defaultdict
from pathlib import PurePath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.library_rules import PYTHON
from rosprivacy.ingest.annotations.code_names import ROOT, CodeNames, is_ros_name
from rosprivacy.ingest.annotations.code_units import CodeUnits
from rosprivacy.ingest.annotations.source_code import NODE, class_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.suggesting.library_rules import NodeUse
    from rosprivacy.ingest.annotations.code_units import Local, Piece
    from rosprivacy.ingest.annotations.source_code import Code, Site

TESTS = frozenset(["test", "tests", "testing"])  # folders


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
    >>> from rosprivacy.ingest.annotations.python_code import read_python
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
    reached: set[Piece] = set()
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


def _own_name(site: Site) -> str:
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
        self.names: dict[Piece, set[str]] = defaultdict(set)
        self.files: dict[str, set[Piece]] = defaultdict(set)  # the nodes of each file
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

    def of_node(self, piece: Piece) -> set[Piece]:
        """Return all pieces of code that belong to a node."""
        files = [file for file, own in self.files.items() if own == {piece}]
        alone = {one for file in files for one in self.units.of_file(self._code[file])}
        return self._reached({piece, *alone, *self._runs.get(piece, ())})

    def _reached(self, starts: Iterable[Piece]) -> set[Piece]:
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

    def _running(self) -> Mapping[Piece, Sequence[Piece]]:
        """By node: the files that run it, and no other one."""
        found: dict[Piece, list[Piece]] = defaultdict(list)
        for code in self.codes:
            if code.language == PYTHON and code.file not in self.files and not _is_test(code.file):
                nodes = self._run_by(code.file)
                if len(nodes) == 1:
                    found[nodes[0]].extend(self.units.of_file(code))
        return found

    def _run_by(self, file: str) -> list[Piece]:
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
