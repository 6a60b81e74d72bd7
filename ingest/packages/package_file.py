"""A file of a package -> ``Package``: what its nodes are called, by what they are known, what they do with data.

In: YAML or JSON (``package: 1``), shipped in ``ontology/packages`` or by a vendor. Out: facts, each with its line. All
problems of a file are raised at once.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PackageError, shown
from rosprivacy.analysis.model import OF_KIND, Place, kind_of_type
from rosprivacy.analysis.suggesting.ros_package import USES, Interface, Package, PackageNode, Source
from rosprivacy.ingest.packages.claims import ClaimReader
from rosprivacy.ingest.reading import yaml_values

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

KEYS = ("package", "name", "about", "sources", "nodes")
NODE_KEYS = ("names", "executables", *USES, "says")
SOURCE_KEYS = ("at", "version", "commit", "files", "read")
PACKAGE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
NODE_NAME = re.compile(r"\*?[A-Za-z_][A-Za-z0-9_.]*\*?")
CHANNEL_NAME = re.compile(r"(~/|/)?[A-Za-z0-9_*]+(/[A-Za-z0-9_*]+)*")
DAY = re.compile(r"\d{4}-\d\d-\d\d")


def read_package(file: str, vocabulary: Vocabulary, bounds: Bounds = BOUNDS) -> Package:
    """Read a user's file of a package.

    Raises
    ------
    InputErrors
        With every problem of the file, each a ``PackageError`` of one line.
    """
    try:
        top, data = yaml_values.read(file, partial(PackageError, file), bounds)
    except InputError as error:
        raise InputErrors([error]) from None
    return _package(file, top, data, vocabulary, bounds)


def read_shipped(file: str, vocabulary: Vocabulary, name: str) -> Package:
    """Read a file of the shipped catalogue, which messages and reasons call by a name."""
    return _package(name, *yaml_values.read_shipped(file, PackageError, name), vocabulary, BOUNDS)


def _package(name: str, top: Value, data: bytes, vocabulary: Vocabulary, bounds: Bounds) -> Package:
    reader = _Reader(name, error=PackageError, bounds=bounds, vocabulary=vocabulary)
    package = reader.document(top)
    if reader.problems or package is None:
        raise InputErrors(reader.problems)
    return package._replace(sha256=hashlib.sha256(data).hexdigest())


@dataclass(kw_only=True, eq=False, repr=False)
class _Reader(ClaimReader):
    """One file of a package."""

    def document(self, top: Value) -> Package | None:
        if top.kind != "map":
            self.problem(top.line, f"a file of a package is a map, not a {top.kind}", "begin with 'package: 1'")
            return None
        self.version(top, "package", "package")
        said = {key: value for key, _, value in self.entries_of(top, KEYS)}
        for key in KEYS:
            if key not in said:
                self.problem(top.line, f"no {key!r}", f"a file of a package has {', '.join(KEYS)}")
        if said.keys() < set(KEYS):
            return None
        name, about = self.plain(said["name"], "name", PACKAGE_NAME), self.text(said["about"], "about")
        sources = tuple(self._sources(said["sources"]))
        nodes = tuple(self._nodes(said["nodes"]))
        return Package(name, about, sources, nodes, Place(self.file, top.line))

    def _sources(self, value: Value) -> Iterator[Source]:
        items = self.filled(value, "sources", "name at least one document or repository that was read")
        for item in items:
            said = {key: one for key, _, one in self.entries_of(item, SOURCE_KEYS)}
            if not {"at", "read"} <= said.keys() or not {"version", "commit"} & said.keys():
                self.problem(
                    item.line,
                    "a source that does not say where, when and which version",
                    "write {at: …, version: … or commit: …, read: 2026-11-23}",
                )
                continue
            at, version, commit = (self.text(said[key], key) if key in said else "" for key in SOURCE_KEYS[:3])
            files = self.list_of(said["files"], "files") if "files" in said else ()
            day = self.plain(said["read"], "read", DAY, "write the day as 2026-11-23")
            yield Source(at, day, version, commit, tuple(self.text(one, "files") for one in files))

    def _nodes(self, value: Value) -> Iterator[PackageNode]:
        for item in self.filled(value, "nodes", "describe at least one node"):
            said = {key: one for key, _, one in self.entries_of(item, NODE_KEYS)}
            if "names" not in said or "says" not in said:
                self.problem(item.line, "a node without names or without what it says", "write names: […], says: […]")
                continue
            named = self.filled(said["names"], "names", "write its default name")
            named += self.list_of(said["executables"], "executables") if "executables" in said else ()
            hint = "write a plain name without namespace, which may begin or end with *"
            names = tuple(dict.fromkeys(self.plain(one, "a node's name", NODE_NAME, hint) for one in named))
            interfaces = tuple(one for use in USES if use in said for one in self._interfaces(use, said[use]))
            yield PackageNode(names, interfaces, tuple(self.claims(said["says"])))

    def _interfaces(self, use: str, value: Value) -> Iterator[Interface]:
        if value.kind != "map":
            self.problem(value.line, f"{use} takes a map, not a {value.kind}", "write {name: pkg/msg/Name}")
        kind = USES[use][0]
        for name, line, child in value.entries:
            if len(name) > self.bounds.name or not CHANNEL_NAME.fullmatch(name):
                self.problem(line, f"{shown(name)!r} is not the name of a {kind}", "write it as the package does")
            elif child.kind != "empty" and kind_of_type(child.text) != kind:
                what = f"{shown(child.text or child.kind)!r} is not the type of a {kind}"
                self.problem(child.line, what, f"write pkg/{OF_KIND[kind]}/Name, or nothing if it takes any")
            else:
                yield Interface(use, name, child.text if child.kind == "text" else "")
