"""XML from anybody -> elements with their file and line, includes expanded, nothing else ever read.

In: a path. Out: ``Item``s: an element and the file that it stands in. The hardening of the parser is libxml2's own
(no entities, no DTD, no network, its limits on depth and size); what it has no switch for stands here: includes stay
inside one folder tree, are bounded in depth and in bytes, and bring elements only, never text.

Sources: XInclude 1.0 (both namespaces that sros2's files use); ``xpointer(/a/b/*)``, the only form in them.
"""

from __future__ import annotations

import hashlib
import os
import re
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote

from lxml import etree

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PolicyError, reason, shown
from rosprivacy.analysis.model import EMPTY_INCLUDE, FALLBACK_TAKEN, Diagnostic, Place, Severity
from rosprivacy.ingest.reading.bounded_file import WIDEN, contents, leaves, nearest_file, what_leaves

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.bounds import Bounds

NAMESPACES = ("http://www.w3.org/2001/XInclude", "http://www.w3.org/2003/XInclude")
XML_BASE = "{http://www.w3.org/XML/1998/namespace}base"
DEPTH = 32

_XPOINTER = re.compile(r"\s*xpointer\(\s*((?:/(?:\*|[\w.-]+))+)\s*\)\s*")
_POSITION = re.compile(r", line \d+, column \d+$")


@dataclass(slots=True, eq=False, repr=False)  # one for every element: a frozen one takes three times as long to make
class Item:
    """An element, the file that it stands in (as shown to the user), and the includes that led to it.

    Attributes
    ----------
    tag, namespace
        The name without its namespace, and the URI of that, empty if it has none.
    """

    element: etree._Element
    tag: str
    namespace: str
    file: str
    chain: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, element: etree._Element, file: str, chain: tuple[tuple[str, str], ...]) -> Item:
        """Read the name of an element."""
        name = str(element.tag)
        if name[0] != "{":
            return cls(element, name, "", file, chain)
        namespace, _, tag = name[1:].rpartition("}")
        return cls(element, tag, namespace, file, chain)

    @property
    def place(self) -> Place:
        """File and line."""
        return Place(self.file, self.element.sourceline or 0)


class Documents:
    """The files behind one policy, each parsed once.

    Parameters
    ----------
    root
        The folder tree that includes may read from.
    bounds
        Of them ``policy_bytes`` holds here; an included file counts each time that it is included.
    """

    def __init__(self, root: Path, bounds: Bounds = BOUNDS) -> None:
        self.root = root.resolve()
        self.bounds = bounds
        self.budget = bounds.policy_bytes
        self.problems: list[InputError] = []
        self.diagnostics: list[Diagnostic] = []
        self.sources: dict[str, str] = {}
        self._parsed: dict[Path, tuple[etree._Element, int]] = {}
        self._targets: dict[tuple[str, str], tuple[Path, str]] = {}

    def open(self, file: str) -> Item:
        """Return the root element of a file that the user named.

        Raises
        ------
        InputErrors
            If it cannot be read or is not XML that we take.
        """
        try:
            return Item.of(self._load(Path(file).resolve(), file, Place(file, 0)), file, ((file, ""),))
        except PolicyError as error:
            raise InputErrors([error]) from None
        except (OSError, RuntimeError, ValueError) as error:
            raise InputErrors([_error(Place(file, 0), shown(str(error)), "name a file that can be read")]) from None

    def children(self, item: Item) -> list[Item]:
        """Return the child elements in document order, includes replaced by what they bring.

        A problem with an include is kept in ``problems``, and the rest is still read.
        """
        found = []
        file, chain = item.file, item.chain
        for child in item.element:
            name = str(child.tag)
            if name[0] != "{":  # as nearly all
                found.append(Item(child, name, "", file, chain))
                continue
            inner = Item.of(child, file, chain)
            if inner.namespace in NAMESPACES:
                found += self._include(inner)
            else:
                found.append(inner)
        return found

    def _include(self, include: Item) -> list[Item]:
        try:
            return list(self._included(include))
        except PolicyError as error:
            self.problems.append(error)
            return []

    def _included(self, include: Item) -> Iterator[Item]:
        place = include.place
        if include.tag != "include":
            raise _error(place, f"<{shown(include.tag)}> outside <xi:include>", "remove it")
        if len(include.chain) > DEPTH:
            raise _error(place, f"includes nested deeper than {DEPTH}", "include the file directly")
        attributes = include.element.attrib
        parse = str(attributes.get("parse", "xml"))
        if parse != "xml":
            what = f"include with parse={shown(repr(parse))}"
            raise _error(place, what, "only XML is included: remove the attribute, name an XML file")
        href, xpointer = str(attributes.get("href", "")), str(attributes.get("xpointer", ""))
        path, file = self._target(href, include)
        if path not in self._parsed and _stat(path, place) is None:
            yield from self._fallback(include, href)
            return
        if (file, xpointer) in include.chain or (not href and not xpointer):
            raise _error(place, f"include loop: {shown(file)} includes itself", "break the loop")
        top = Item.of(self._load(path, file, place), file, (*include.chain, (file, xpointer)))
        chosen = self._select(top, xpointer, place) if xpointer else [top]
        self.took(include, file, xpointer, chosen)
        if not chosen:
            message = f"the include brings nothing: {xpointer} selects no element of {file}"
            self.diagnostics.append(Diagnostic(place, Severity.WARNING, shown(message), EMPTY_INCLUDE))
        yield from chosen

    def took(self, include: Item, file: str, xpointer: str, brought: list[Item]) -> None:
        """An include was read; for those who look at includes themselves."""

    def _target(self, href: str, include: Item) -> tuple[Path, str]:
        """The file behind an href: its real path, and as it is shown."""
        key = (include.file, href)
        if key not in self._targets:
            self._targets[key] = self._resolve(href, include)
        return self._targets[key]

    def _resolve(self, href: str, include: Item) -> tuple[Path, str]:
        """Resolve an href as a URI, by its text; then its symbolic links; refuse what is outside the root."""
        place = include.place
        if any(XML_BASE in element.attrib for element in (include.element, *include.element.iterancestors())):
            raise _error(place, "xml:base is not read", "write the whole relative path in href")
        if not href:
            return Path(include.file).resolve(), include.file
        if re.match(r"[A-Za-z][A-Za-z0-9+.-]*:|//", href) or "#" in href:
            raise _error(place, f"include of {shown(repr(href))}", "name a file by its relative path")
        file = os.path.normpath(os.path.join(os.path.dirname(include.file), unquote(href)))  # noqa: PTH118, PTH120 - by its text
        try:
            path = Path(file).resolve()
        except (OSError, RuntimeError, ValueError) as error:
            raise _error(place, f"include of {shown(repr(href))}: {shown(str(error))}", "name another file") from None
        if leaves(path, self.root):
            raise _error(place, f"include of {what_leaves(href, self.root)}", WIDEN)
        return path, file

    def _fallback(self, include: Item, href: str) -> Iterator[Item]:
        """XInclude 4.4: what stands in <xi:fallback> takes the place of a file that is not there."""
        fallbacks = [child for child in include.element if str(child.tag).rpartition("}")[2] == "fallback"]
        if not fallbacks:
            raise _error(include.place, f"included file {shown(repr(href))} not found", "correct the href")
        message = f"included file {href!r} not found: what stands in <fallback> is read in its place; correct the href"
        self.diagnostics.append(Diagnostic(include.place, Severity.WARNING, shown(message), FALLBACK_TAKEN))
        fallback = Item.of(fallbacks[0], include.file, (*include.chain, (include.file, "fallback")))
        if has_text(fallback):
            raise _error(fallback.place, "text in <fallback>", "write elements, or remove it")
        yield from self.children(fallback)

    def _select(self, top: Item, xpointer: str, place: Place) -> list[Item]:
        match = _XPOINTER.fullmatch(xpointer)
        if match is None:
            hint = "write xpointer(/a/b/*), steps of names and *"
            raise _error(place, f"xpointer {shown(repr(xpointer))} is not supported", hint)
        steps = match[1].split("/")[1:]
        chosen = [top] if steps[0] in ("*", top.tag) else []
        for step in steps[1:]:
            chosen = [child for item in chosen for child in self.children(item) if step in ("*", child.tag)]
        return chosen

    def _load(self, path: Path, file: str, place: Place) -> etree._Element:
        """Parse a file, once; count its bytes each time."""
        known = self._parsed.get(path)
        size = known[1] if known else _size(path, file, place)
        self.budget -= size
        if self.budget < 0:
            raise _error(place, *self.bounds.refusal("policy_bytes"))
        if known:
            return known[0]
        data = _read(path, file, place)
        root = parsed(data, file)
        self.sources[file] = hashlib.sha256(data).hexdigest()
        self._parsed[path] = (root, size)
        return root


def stands_alone(data: bytes) -> bool:
    """Whether an XML text is read from these bytes only: it is XML that we take, and nothing in it is an include."""
    try:
        root = parsed(data, "")
    except PolicyError:
        return False
    return next(root.iter(*(f"{{{namespace}}}*" for namespace in NAMESPACES)), None) is None


def has_text(parent: Item) -> bool:
    """Whether there is text beside the child elements."""
    element = parent.element
    if (text := element.text) and not text.isspace():
        return True
    for child in element:  # noqa: SIM110 - any() with a generator takes twice as long, and this is asked of all
        if (text := child.tail) and not text.isspace():
            return True
    return False


def _stat(path: Path, place: Place) -> os.stat_result | None:
    """None if the file is not there."""
    try:
        return path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, ValueError) as error:
        raise _error(place, f"{shown(str(path))} cannot be read: {reason(error)}", "name another file") from None


def _size(path: Path, file: str, place: Place) -> int:
    found = _stat(path, place)
    if found is None:
        raise _error(place, "file not found", nearest_file(Path(file)))
    if not stat.S_ISREG(found.st_mode):
        raise _error(place, f"{shown(file)} is not a regular file", "name an XML file")
    return found.st_size


def _read(path: Path, file: str, place: Place) -> bytes:
    try:
        return contents(path, file)
    except OSError as error:
        raise _error(place, f"cannot be read: {error.strerror}", "check its permissions") from None


def parsed(data: bytes, file: str) -> etree._Element:
    """Return the root element of an XML text.

    Raises
    ------
    PolicyError
        If it is not XML that we take: no entities, no DTD, no network.
    """
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, remove_comments=True, remove_pis=True
    )
    try:
        root = etree.fromstring(data, parser)
    except (etree.XMLSyntaxError, LookupError, ValueError) as error:
        line = getattr(error, "lineno", None) or 1
        what = _POSITION.sub("", str(getattr(error, "msg", None) or error)) or "not XML"
        raise _error(Place(file, line), f"not well-formed XML: {shown(what)}", "correct the XML") from None
    if _doctype(root):
        raise _error(Place(file, 1), "a document type (DTD) is not read", "remove the <!DOCTYPE …>")
    return root


def _doctype(root: etree._Element) -> str:
    return str(root.getroottree().docinfo.doctype)


def _error(place: Place, problem: str, hint: str) -> PolicyError:
    return PolicyError(place.file, place.line, problem, hint)
