"""Descriptions of nodes (NoDL) -> the ends of channels that they state, joined to the code that they speak of.

In: the files of a checkout and its packages: documents by their ending, and those of an ament index. Out:
``Description``, nodes and gaps. A document of version 2 names no node: its name is that under which its package
registers it, or that of its file. What it includes is a part of it.

Source: ros-tooling/nodl (2026-08-21): ``nodl.schema.yaml``, ``loader.py``, ``ament_nodl_register.cmake``;
ubuntu-robotics/nodl: ``v1.xsd``.
"""

from __future__ import annotations

import posixpath
from collections import defaultdict
from functools import partial
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, shown
from rosprivacy.ingest.policies.xinclude import parsed
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import leaves
from rosprivacy.ingest.reading.file_kinds import DESCRIPTIONS
from rosprivacy.ingest.running.observed_names import whole_type
from rosprivacy.ingest.scan.code_roots import in_ament_index
from rosprivacy.ingest.scan.packages import text_in
from rosprivacy.ingest.scan.scan_facts import (
    DESCRIBED,
    DESCRIPTION,
    CodeEndpoint,
    CodeNode,
    CodePlace,
    Executable,
    Gap,
    NamePiece,
    plain_text,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from lxml import etree

    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ingest.scan.packages import Packages
    from rosprivacy.ingest.scan.started_code import CodeIndex

SECTIONS = {
    "publishers": ("publish", "msg"),
    "subscriptions": ("subscribe", "msg"),
    "service_servers": ("reply", "srv"),
    "service_clients": ("request", "srv"),
    "action_servers": ("execute", "action"),
    "action_clients": ("call", "action"),
}
OTHER_KEYS = ("nodl_version", "description", "codegen", "include", "parameters")
INDEX, LOCAL = "nodl://", "local://"
XML = ".nodl.xml"  # version 1
FIRST_VERSION = {
    "topic": ("msg", {"publisher": ("publish",), "subscription": ("subscribe",), "both": ("publish", "subscribe")}),
    "service": ("srv", {"server": ("reply",), "client": ("request",), "both": ("reply", "request")}),
    "action": ("action", {"server": ("execute",), "client": ("call",), "both": ("execute", "call")}),
}
MOST_INCLUDED = 200_000  # documents and channels, of all that is included
Key = tuple[str, str]  # a package, and the name of a description in it


class Description(NamedTuple):
    """What a document says of one node.

    Attributes
    ----------
    package, name
        The package, empty where none is known; the executable that it speaks of, or what the document is called.
    node
        The name of the node, in version 1; else empty.
    files
        Of which it is made.
    """

    place: CodePlace
    package: str
    name: str
    node: str
    files: tuple[str, ...]
    endpoints: tuple[CodeEndpoint, ...]

    @property
    def without_code(self) -> CodeNode:
        """The node, of which nothing else is known."""
        names = ((NamePiece(self.node, DESCRIPTION),),) if self.node else ()
        started = f"{self.package}/{self.name}"
        return CodeNode(self.place, self.name, DESCRIBED, names, plugin=started, endpoints=self.endpoints)

    def elsewhere(self, folder: str) -> Description:
        """Return the same with a folder before its files."""
        return self._replace(
            place=self.place.below(folder),
            files=tuple(posixpath.join(folder, file) for file in self.files),
            endpoints=tuple(end._replace(place=end.place.below(folder)) for end in self.endpoints),
        )


class _Document(NamedTuple):
    """A document of version 2, without what it includes."""

    ends: tuple[CodeEndpoint, ...] = ()
    includes: tuple[tuple[str, int], ...] = ()  # reference, line


class Descriptions:
    """The descriptions of a checkout.

    Attributes
    ----------
    gaps
        What could not be read or found.
    """

    def __init__(self, root: Path, packages: Packages) -> None:
        self.root = root
        self.gaps: set[Gap] = set()
        self._packages, self._remaining = packages, MOST_INCLUDED
        self._first_version = [file for file in packages.files if file.endswith(XML)]
        self._keys = _keys(root, packages)
        self._files = {key: file for file, key in reversed(self._keys.items())}
        self._documents = {file: document for file in self._keys if (document := self._read(file)) is not None}

    @property
    def files(self) -> tuple[str, ...]:
        """All documents."""
        return (*self._keys, *self._first_version)

    def nodes(self) -> tuple[Description, ...]:
        """Return all but documents that others include and nothing is called by: these are parts."""
        includes = [(file, one) for file, document in self._documents.items() for one in document.includes]
        parts = {target for file, one in includes if (target := self._target(file, *one)) != file}
        runs = {(one.package, one.name) for one in self._packages.executables}
        parts = {file for file in parts if self._keys.get(file) not in runs}
        described = [one for file in self.files if file not in parts for one in self.of_file(file)]
        reached = {file for one in described for file in one.files}
        for file in self._documents:  # of a circle, in which each is a part of another, the first
            if file not in reached:
                described += self.of_file(file)
                reached.update(described[-1].files)
        for file in parts - {one.place.file for one in described} - {""}:
            self._gap(
                file, 1, "description", "a part of descriptions that include it: it is shown as no node of its own"
            )
        return tuple(described)

    def of_file(self, file: str) -> tuple[Description, ...]:
        """Return what one file describes: one node, or several in version 1; none where it cannot be read."""
        if file in self._first_version:
            return tuple(self._of_first_version(file))
        if file not in self._documents:
            return ()
        files = self._included(file)
        ends = dict.fromkeys(end for one in files for end in self._documents[one].ends)
        return (Description(CodePlace(file, 1), *self._keys[file], "", files, tuple(ends)),)

    def _included(self, file: str) -> tuple[str, ...]:
        """A document and all that it includes, each once; a circle is a gap."""
        reached, open_files = {file: None}, {file}
        way = [(file, iter(self._documents[file].includes))]
        while way:
            here, includes = way[-1]
            reference, line = next(includes, ("", 0))
            if not line:
                open_files.discard(way.pop()[0])
                continue
            target = self._target(here, reference, line)
            if target in open_files:
                self._gap(here, line, "include", f"a description that includes itself: {shown(reference)}")
            elif target and target not in reached:
                self._remaining -= 1 + len(self._documents[target].ends)
                if self._remaining < 0:
                    text = f"descriptions include more than is read: {shown(reference)} is left out"
                    self._gap(here, line, "include", text)
                    continue
                reached[target] = None
                open_files.add(target)
                way.append((target, iter(self._documents[target].includes)))
        return tuple(reached)

    def _target(self, file: str, reference: str, line: int) -> str:
        """The document that a reference names; empty, and a gap, if it is not here."""
        scheme = next((one for one in (INDEX, LOCAL) if reference.startswith(one)), "")
        body = reference.removeprefix(scheme)
        if scheme == INDEX:
            package, _, name = body.partition("/")
            target = self._files.get((package, name), "")
        else:
            target = posixpath.normpath(posixpath.join(posixpath.dirname(file), body)) if scheme else ""
        if target in self._documents:
            return target
        if scheme == LOCAL and leaves(self.root / target, self.root):
            what = "leads out of the folder and is not followed"
        else:
            what = "is not here, or cannot be read" if scheme else "is of a sort that is not known"
        text = f"the description {shown(reference)} {what}: the channels that it states are not known"
        self._gap(file, line, "include", text)
        return ""

    def _gap(self, file: str, line: int, sort: str, text: str) -> None:
        self.gaps.add(Gap(CodePlace(file, line), sort, text))

    def _read(self, file: str) -> _Document | None:
        text = text_in(str(self.root), file)
        if text is None:
            self._gap(file, 0, "file", "a description that cannot be read")
            return None
        try:
            top = yaml_values.parse(text, partial(InputError, file))
        except InputError as error:
            self._gap(file, error.line, "file", f"a description that cannot be read: {error.problem}")
            return None
        version = top.get("nodl_version")
        if version is None or (version.kind, version.text) != ("number", "2"):
            self._gap(file, version.line if version else 1, "file", "a description of another version than 2")
            return None
        ends: list[CodeEndpoint] = []
        includes: list[tuple[str, int]] = []
        for key, line, value in top.entries:
            if key in SECTIONS or key == "include":
                if value.kind != "list":
                    self._gap(file, line, "file", f"{key} of a description is no list, and is not read")
                for item in value.items:
                    if key == "include":
                        includes += self._reference(file, item)
                    else:
                        ends += self._end(file, item, *SECTIONS[key])
            elif key not in OTHER_KEYS:
                self._gap(file, line, "file", f"{shown(key)} of a description is not known, and is not read")
        return _Document(tuple(ends), tuple(includes))

    def _reference(self, file: str, item: Value) -> Iterator[tuple[str, int]]:
        reference = item.get("ref")
        if reference and reference.kind == "text":
            yield reference.text, reference.line
        else:
            self._gap(file, item.line, "include", "a description is included that has no name (ref)")

    def _end(self, file: str, item: Value, role: str, sort: str) -> Iterator[CodeEndpoint]:
        name, type_ = item.get("name"), item.get("type")
        yield from self._stated(file, item.line, name.text if name else "", type_.text if type_ else "", role, sort)

    def _stated(self, file: str, line: int, name: str, type_: str, role: str, sort: str) -> Iterator[CodeEndpoint]:
        if not name:
            self._gap(file, line, "name", f"a channel of a description ({role}) has no name")
            return
        whole = whole_type(type_, sort)
        if not whole:
            self._gap(file, line, "file", f"{shown(type_ or 'nothing')} is no type of {shown(name)} ({sort})")
        yield CodeEndpoint(CodePlace(file, line), role, ((NamePiece(name, DESCRIPTION),),), whole)

    def _of_first_version(self, file: str) -> Iterator[Description]:
        try:
            top = parsed((text_in(str(self.root), file) or "").encode(), file)
        except InputError as error:
            self._gap(file, error.line, "file", f"a description that cannot be read: {error.problem}")
            return
        if top.tag != "interface" or top.get("version") != "1":
            self._gap(file, 1, "file", "a description of another version than 1, in XML")
            return
        for node in top.iter("node"):
            line = node.sourceline or 1
            ends = tuple(end for child in node for end in self._first_version_end(file, child))
            name, executable = node.get("name", ""), node.get("executable", "")
            package = _package_of(file, self._packages)
            yield Description(CodePlace(file, line), package, executable or name, name, (file,), ends)

    def _first_version_end(self, file: str, child: etree._Element) -> Iterator[CodeEndpoint]:
        if child.tag == "parameter":
            return
        line = child.sourceline or 1
        sort, roles = FIRST_VERSION.get(str(child.tag), ("", {}))
        if child.get("role") not in roles:
            self._gap(file, line, "file", f"{shown(str(child.tag))} of a description is not understood")
        for role in roles.get(child.get("role", ""), ()):
            yield from self._stated(file, line, child.get("name", ""), child.get("type", ""), role, sort)


def with_descriptions(
    nodes: Sequence[CodeNode], descriptions: Iterable[Description], index: CodeIndex, executables: Iterable[Executable]
) -> tuple[tuple[CodeNode, ...], tuple[Gap, ...]]:
    """Return nodes with what descriptions say of them, and those that only a description speaks of."""
    runs: dict[Key, Executable] = {}
    for executable in executables:
        runs.setdefault((executable.package, executable.name), executable)
        runs.setdefault(("", executable.name), executable)
    more: dict[int, list[Description]] = defaultdict(list)
    others, gaps = [], []
    for one in descriptions:
        executable_of = runs.get((one.package, one.name))
        codes = index.nodes_of(executable_of) if executable_of else _of_name(nodes, one.node or one.name)
        codes = codes if len(codes) < 2 else _of_name(codes, one.node or one.name) or codes  # noqa: PLR2004 - several
        if len(codes) == 1:
            more[id(codes[0])].append(one)
            continue
        if codes:
            text = f"which of {len(codes)} nodes of the code it describes is not known: it is shown as one more"
            gaps.append(Gap(one.place, "node", text))
        others.append(one.without_code)
    extended = (_extended(node, more[id(node)]) if id(node) in more else node for node in nodes)
    return (*extended, *others), tuple(gaps)


def _extended(node: CodeNode, descriptions: Iterable[Description]) -> CodeNode:
    ends = (end for one in descriptions for end in one.endpoints)
    return node._replace(endpoints=(*node.endpoints, *ends), described=tuple(one.place for one in descriptions))


def _of_name(nodes: Iterable[CodeNode], name: str) -> tuple[CodeNode, ...]:
    return tuple(node for node in nodes if name in {plain_text(one) for one in node.names})


def _keys(root: Path, packages: Packages) -> dict[str, Key]:
    """The documents of version 2, each with its package and name; a copy of one of the index is left out."""
    keys: dict[str, Key] = {}
    copies: set[tuple[str, str | None]] = set()
    for file in packages.files:
        if in_ament_index(f"{root}/{file}"):
            package, _, name = posixpath.basename(file).partition("__")
            keys[file] = package, name
            copies.add((package, text_in(str(root), file)))
    for file in packages.files:
        if file not in keys and file.endswith(DESCRIPTIONS) and not file.endswith(XML):
            installed = PurePosixPath(root, file).parent  # share/PACKAGE/nodl
            if copies and (installed.parent.name, text_in(str(root), file)) in copies:
                continue
            stem = posixpath.basename(file).rpartition(".nodl.")[0]
            keys[file] = packages.registered.get(file) or (_package_of(file, packages), stem)
    return dict(sorted(keys.items()))


def _package_of(file: str, packages: Packages) -> str:
    """The package in whose folder a file lies, the innermost."""
    around = [one for one in packages.packages if not one.folder or file.startswith(f"{one.folder}/")]
    return max(around, key=lambda one: len(one.folder)).name if around else ""
