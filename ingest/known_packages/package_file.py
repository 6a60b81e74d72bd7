"""One file of a package: what its nodes are called, by which interfaces they are known, and what they do with data.

In: a file of the catalogue (``ontology/packages``), of a user or of a vendor. Out: ``Package``, or all problems of the
file with their lines. A package says ``likely`` of what its node does, and ``may`` of what depends on a setting or on
what comes in; it cannot be certain of somebody's node.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PackageError, shown
from rosprivacy.analysis.model import OF_KIND, Confidence, Method, Place, kind_of_type
from rosprivacy.analysis.suggesting.evidence import CONDUIT, DERIVATION, LEAK, SANITIZER, SOURCE, WHERE
from rosprivacy.analysis.suggesting.packages import USES, Claim, Interface, Package, PackageNode, Source
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.format_reader import FileReader

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

ROLES = {"source": SOURCE, "leak": LEAK, "derives": DERIVATION, "sanitizer": SANITIZER, "conduit": CONDUIT}
CLAIM_KEYS = (*ROLES, "to", "confidence", "why")
CONFIDENCES = (Confidence.LIKELY, Confidence.MAY)
METHODS = tuple(method for method in Method if method is not Method.ABSENT)
LONGEST = 500  # characters of a text
KEYS = ("package", "name", "about", "sources", "nodes")
NODE_KEYS = ("names", "executables", "components", *USES, "further", "parameters", "rest", "makes", "says")
SOURCE_KEYS = ("at", "version", "commit", "files", "read")
PACKAGE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
NODE_NAME = re.compile(r"\*?[A-Za-z_][A-Za-z0-9_.]*\*?")
CLASS = re.compile(r"[A-Za-z_]\w*(::[A-Za-z_]\w*)*", re.ASCII)
INNER_NAME = re.compile(r"[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)
PARAMETER = re.compile(r"[A-Za-z0-9_.*?-]+")  # or an option of the command line: -topic
CHANNEL_NAME = re.compile(r"(~/|/|\.\./)?[A-Za-z0-9_*]+(/[A-Za-z0-9_*]+)*")
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
    reader = _PackageReader(name, error=PackageError, bounds=bounds, vocabulary=vocabulary)
    package = reader.document(top)
    if reader.problems or package is None:
        raise InputErrors(reader.problems)
    return package._replace(sha256=hashlib.sha256(data).hexdigest())


@dataclass(kw_only=True, eq=False, repr=False)
class _PackageReader(FileReader):
    """One file of a package; the kinds of the vocabulary, a user's own too."""

    vocabulary: Vocabulary

    def document(self, top: Value) -> Package | None:
        if top.kind != "map":
            self.problem(top.line, f"a file of a package is a map, not a {top.kind}", "begin with 'package: 1'")
            return None
        self.version(top, "package", "package")
        said = {key: value for key, _, value in self.entries_of(top, (*KEYS, "packages"))}
        for key in KEYS:
            if key not in said:
                self.problem(top.line, f"no {key!r}", f"a file of a package has {', '.join(KEYS)}")
        if said.keys() < set(KEYS):
            return None
        name, about = self._plain(said["name"], "name", PACKAGE_NAME), self._text(said["about"], "about")
        sources = tuple(self._sources(said["sources"]))
        nodes = tuple(self._nodes(said["nodes"]))
        listed = self.list_of(said["packages"], "packages") if "packages" in said else ()
        packages = tuple(self._plain(one, "packages", PACKAGE_NAME) for one in listed)
        described = {name for node in nodes for name in node.names}
        for made in (made for node in nodes for made in node.makes if made.rpartition("/")[2] not in described):
            self.problem(said["nodes"].line, f"{made} is made and not described", "describe a node of this name")
        return Package(name, about, sources, nodes, Place(self.file, top.line), packages=packages)

    def _sources(self, value: Value) -> Iterator[Source]:
        items = self._filled(value, "sources", "name at least one document or repository that was read")
        for item in items:
            said = {key: one for key, _, one in self.entries_of(item, SOURCE_KEYS)}
            if not {"at", "read"} <= said.keys() or not {"version", "commit"} & said.keys():
                self.problem(
                    item.line,
                    "a source that does not say where, when and which version",
                    "write {at: …, version: … or commit: …, read: 2026-11-23}",
                )
                continue
            at, version, commit = (self._text(said[key], key) if key in said else "" for key in SOURCE_KEYS[:3])
            files = self.list_of(said["files"], "files") if "files" in said else ()
            day = self._plain(said["read"], "read", DAY, "write the day as 2026-11-23")
            yield Source(at, day, version, commit, tuple(self._text(one, "files") for one in files))

    def _nodes(self, value: Value) -> Iterator[PackageNode]:
        for item in self._filled(value, "nodes", "describe at least one node"):
            said = {key: one for key, _, one in self.entries_of(item, NODE_KEYS)}
            if "names" not in said or "says" not in said:
                self.problem(item.line, "a node without names or without what it says", "write names: […], says: […]")
                continue
            listed = {
                key: self.list_of(said[key], key) for key in ("executables", "components", "makes") if key in said
            }
            hint = "write a plain name without namespace, which may begin or end with *"
            named = self._filled(said["names"], "names", "write its default name")
            named += listed.get("executables", ())
            names = (self._plain(one, "a node's name", NODE_NAME, hint) for one in named)
            interfaces = self._of_uses(said)
            further = self._of_uses(self.values_of(said["further"], tuple(USES))) if "further" in said else []
            if "parameters" in said:
                interfaces, further = self._by_parameters(said["parameters"], interfaces, further)
            yield PackageNode(
                tuple(dict.fromkeys(names)),
                tuple(interfaces),
                tuple(self._claims(said["says"])),
                tuple(further),
                self._text(said["rest"], "rest") if "rest" in said else "",
                tuple(self._plain(one, "makes", INNER_NAME) for one in listed.get("makes", ())),
                tuple(self._plain(one, "a component", CLASS) for one in listed.get("components", ())),
            )

    def _of_uses(self, values: Mapping[str, Value]) -> list[Interface]:
        return [one for use in USES if use in values for one in self._interfaces(use, values[use])]

    def _by_parameters(
        self, value: Value, interfaces: list[Interface], further: list[Interface]
    ) -> tuple[list[Interface], list[Interface]]:
        """Interfaces with the parameters that name them; further ones where their values stand for *."""
        if value.kind != "map":
            self.problem(value.line, f"parameters takes a map, not a {value.kind}", "write {scan_topic: scan}")
        for key, line, child in value.entries:
            if len(key) > self.bounds.name or not PARAMETER.fullmatch(key):
                self.problem(line, f"{shown(key)!r} is not the name of a parameter", "write it as the package does")
            elif child.kind == "map":
                named = self._of_uses(self.values_of(child, tuple(USES)))
                further = [*further, *(one._replace(parameter=key) for one in named)]
            elif child.text not in {one.name for one in (*interfaces, *further)}:
                self.problem(child.line, f"{shown(child.text)!r} is no channel of the node", "name one that it has")
            else:
                interfaces, further = (
                    [one._replace(parameter=key) if one.name == child.text else one for one in group]
                    for group in (interfaces, further)
                )
        return interfaces, further

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

    def _claims(self, value: Value) -> Iterator[Claim]:
        """What stands under ``says``, one claim for each kind."""
        for item in self._filled(value, "says", "write what the node does with data, or leave it out"):
            said = {key: one for key, _, one in self.entries_of(item, CLAIM_KEYS)}
            roles = [key for key in ROLES if key in said]
            if len(roles) != 1 or "why" not in said:
                self.problem(
                    item.line,
                    "a statement that is not of one role, with its reason",
                    f"write one of {', '.join(ROLES)}, and why: …",
                )
                continue
            if ("to" in said) != (roles == ["leak"]):
                self.problem(item.line, "to belongs to a leak", f"say of each leak where it goes: {', '.join(WHERE)}")
                continue
            basis = Claim(
                ROLES[roles[0]],
                "",
                Confidence(self._one_of(said["confidence"], "confidence", CONFIDENCES))
                if "confidence" in said
                else CONFIDENCES[0],
                self._text(said["why"], "why"),
                Place(self.file, item.line),
                where=self._one_of(said["to"], "to", WHERE) if "to" in said else "",
            )
            yield from self._of_role(basis, said[roles[0]])

    def _of_role(self, basis: Claim, value: Value) -> Iterator[Claim]:
        if basis.role == DERIVATION:
            yield from self._derivations(basis, value)
        elif basis.role == SANITIZER:
            yield from self._sanitizers(basis, value)
        elif basis.role == CONDUIT and (value.kind, value.text) == ("text", "all"):
            yield basis
        else:
            for item in self._filled(value, basis.role, "write […]"):
                yield basis._replace(kind=self._kind(item))

    def _derivations(self, basis: Claim, value: Value) -> Iterator[Claim]:
        for item in self._filled(value, "derives", "write [{from: Video, to: FaceTemplate}]"):
            said = {key: one for key, _, one in self.entries_of(item, ("from", "to"))}
            if len(said) != 2:  # noqa: PLR2004 - from and to
                self.problem(item.line, "a derivation without from or to", "write {from: Video, to: FaceTemplate}")
            else:
                yield basis._replace(kind=self._kind(said["from"]), to=self._kind(said["to"]))

    def _sanitizers(self, basis: Claim, value: Value) -> Iterator[Claim]:
        if value.kind != "map" or not value.entries:
            self.problem(value.line, "a sanitizer states its method", "write {Video: anonymise}")
        for name, line, method in value.entries:
            kind = self._kind(method._replace(line=line, kind="text", text=name))
            yield basis._replace(kind=kind, method=Method(self._one_of(method, "a sanitizer's method", METHODS)))

    def _kind(self, value: Value) -> str:
        category = self.vocabulary.find(value.text) if value.kind == "text" else None
        if category is None:
            problem = f"unknown category {shown(value.text or value.kind)!r}"
            self.problem(value.line, problem, self.vocabulary.hint(value.text))
            return ""
        return category.name

    def _filled(self, value: Value, key: str, hint: str) -> tuple[Value, ...]:
        """The items of a list that is not empty."""
        items = self.list_of(value, key, hint)
        if value.kind in ("list", "empty") and not items:
            self.problem(value.line, f"{key} is empty", hint)
        return items

    def _text(self, value: Value, key: str) -> str:
        """A text of bounded length, on one line."""
        text = value.text.strip()
        if value.kind not in ("text", "number") or not text or len(text) > LONGEST or not text.isprintable():
            found = shown(text[:40]) or value.kind
            self.problem(
                value.line, f"{key} takes one line of at most {LONGEST} characters, not {found!r}", "correct it"
            )
            return ""
        return text

    def _plain(self, value: Value, key: str, form: re.Pattern[str], hint: str = "write a plain name") -> str:
        """A text of a form."""
        text = self._text(value, key)
        if text and not form.fullmatch(text):
            self.problem(value.line, f"{key} cannot be {shown(text[:40])!r}", hint)
        return text

    def _one_of(self, value: Value, key: str, words: tuple[str, ...]) -> str:
        """One word of a list; the last where another one stands."""
        if value.kind != "text" or value.text not in words:
            self.problem(value.line, f"{key} {shown(value.text or value.kind)!r}", f"write {' or '.join(words)}")
            return words[-1]
        return value.text
