"""Which nodes of the code an executable runs: those of its files, and those of other files that its files create.

In: nodes of all code, executables of packages, the texts of files. Out: for a node that a launch file starts, the code
of it. Nothing is parsed here: what a file creates are the classes that it calls by name.
"""

from __future__ import annotations

import re
from collections import defaultdict
from functools import cache
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from rosprivacy.ingest.scan.scan_facts import CodeNode, Executable, StartedNode

HEADERS = (".h", ".h++", ".hh", ".hpp", ".hxx", ".inl", ".ipp", ".tpp")
CALL = re.compile(r"(?<!class )(?<!def )(?<!rclcpp::)\b([A-Za-z_]\w*)\s*[(>{]")
"""``Name(…)``, ``make_shared<Name>``, ``Name{…}``; but ``rclcpp::Node`` is none of the classes ``Node`` of the code."""


class CodeIndex:
    """Nodes of the code, by their files and classes, and executables by package and name."""

    def __init__(
        self,
        nodes: Iterable[CodeNode],
        executables: Iterable[Executable],
        text_of: Callable[[str], str | None],
        loose: Iterable[Executable] = (),
    ) -> None:
        self.nodes = tuple(nodes)
        self._calls_of = cache(lambda file: frozenset(CALL.findall(text_of(file) or "")))
        self._executables: dict[tuple[str, str], list[Executable]] = {}
        for executable in executables:
            for name in filter(None, (executable.name, executable.unit if "::" in executable.unit else "")):
                self._executables.setdefault((executable.package, name), []).append(executable)
        self._packages = {package for package, _ in self._executables}
        self._loose: dict[tuple[str, str], list[Executable]] = defaultdict(list)
        for one in loose:
            for name in dict.fromkeys((one.name, PurePosixPath(one.name).stem)):
                self._loose[one.package, name].append(one)
        self._by_file: dict[str, list[CodeNode]] = defaultdict(list)
        self._by_class: dict[str, list[CodeNode]] = defaultdict(list)
        self._by_plugin: dict[str, list[CodeNode]] = defaultdict(list)
        for node in self.nodes:
            for file in dict.fromkeys((node.place.file, *(end.place.file for end in node.endpoints))):
                self._by_file[file].append(node)
            self._by_class[node.name.rpartition("::")[2]].append(node)
            if node.plugin:
                self._by_plugin[node.plugin].append(node)

    def has_package(self, package: str) -> bool:
        """Return whether a package of the checkout runs anything."""
        return package in self._packages

    def executable_of(self, started: StartedNode) -> Executable | None:
        """Return what is run; of packages of one name, from the one nearest to the launch file."""
        several = self._executables.get((started.package, started.executable), ())
        return max(several, key=lambda one: _shared("".join(one.files[:1]), started.place.file), default=None)

    def code_of(self, started: StartedNode) -> tuple[CodeNode, ...]:
        """Return the nodes of the code that a started node is made of."""
        if started.executable in self._by_plugin:
            return tuple(self._by_plugin[started.executable])
        executable = self.executable_of(started)
        described = (f"{started.package}/{name}" for name in (started.executable, started.name))
        return (self.nodes_of(executable) if executable else ()) or next(
            (tuple(self._by_plugin[name]) for name in described if name in self._by_plugin), ()
        )

    def loose_code_of(self, started: StartedNode) -> tuple[tuple[CodeNode, ...], tuple[str, ...]]:
        """Return the nodes of files that are called as what is started, which nothing installs; and these files."""
        nodes: dict[int, CodeNode] = {}
        files: list[str] = []
        for one in self._loose.get((started.package, started.executable), ()):
            made = self.nodes_of(one)
            nodes |= {id(node): node for node in made}
            files += one.files if made else ()
        return tuple(nodes.values()), tuple(files)

    def nodes_of(self, executable: Executable) -> tuple[CodeNode, ...]:
        """Return the nodes that an executable runs."""
        files, plugin = executable.files, next((n for n in (executable.unit, executable.name) if "::" in n), "")
        if plugin in self._by_plugin:
            return tuple(self._by_plugin[plugin])
        own = [node for file in files for node in self._by_file.get(file, ()) if node.place.file in files]
        own = own or [node for file in files for node in self._by_file.get(file, ())]
        called = {name for file in files for name in self._calls_of(file)}
        if plugin:
            called.add(plugin.rpartition("::")[2])
        created = [node for node in own if node.name.rpartition("::")[2] in called]
        classes = {node.name.rpartition("::")[2] for node in own}
        others = [
            node
            for name in sorted(called)
            if name[:1].isupper()
            for node in self._nearest(name, files)
            if name not in classes or node.place.file.endswith(HEADERS)  # else another file has a class of that name
        ]
        in_files = {id(node) for node in own}
        elsewhere = (node for node in others if id(node) not in in_files)
        return tuple({id(node): node for node in (*(created or own), *elsewhere)}.values())

    def _nearest(self, name: str, files: Sequence[str]) -> list[CodeNode]:
        """Nodes of a class, of the folders nearest to some files where several have one of its name.

        A class that makes a second node stands with both: the class in its header, and what its ``.cpp`` makes.
        """
        nodes = self._by_class.get(name, [])
        if len(nodes) < 2:  # noqa: PLR2004 - one is it
            return nodes
        steps = [max((_shared(node.place.file, file) for file in files), default=0) for node in nodes]
        return [
            node
            for node, shared in zip(nodes, steps, strict=True)
            if shared == max(steps) or any(end.place.file in files for end in node.endpoints)
        ]


def _shared(file: str, other: str) -> int:
    """How many folders two files have in common, from the root."""
    number = 0
    for ours, theirs in zip(PurePosixPath(file).parts[:-1], PurePosixPath(other).parts[:-1], strict=False):
        if ours != theirs:
            break
        number += 1
    return number
