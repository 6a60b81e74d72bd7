"""Units of the code of a checkout -> which version of them is there, as the pins of a label file keep it.

In: a checkout, and units such as ``camera_driver/camera.py:Camera``: a package, the path of a file in it, and a class;
without one the whole file. Out: for each unit that is there the hash of what its code says, and its place.

White space and comments change no hash. Of Python the syntax tree is hashed, of C++ the tokens. With a class goes what
it is made of elsewhere in the checkout: of C++ its methods outside of it, and each class of the name of a base class of
it, and so on. The functions and other classes that it uses do not go with it.

Source: rule S11: a person's word holds for what the person has seen.
"""

from __future__ import annotations

import ast
import hashlib
import posixpath
from collections import defaultdict
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.model import Place
from rosprivacy.ingest.code.cpp_code import syntax_tree
from rosprivacy.ingest.code.cpp_tree import CLASSES, last_of, line_of, scope_of, text_of
from rosprivacy.ingest.code.python_tree import FAILURES, parse_python
from rosprivacy.ingest.code.source_code import OutOfTime, clock
from rosprivacy.ingest.code.source_files import MAX_BYTES
from rosprivacy.ingest.labels.pins import VERSION_DIGITS, CodeVersion
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.scan.scanned_policy import placed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from tree_sitter import Node

    from rosprivacy.ingest.code.source_code import NodeClass
    from rosprivacy.ingest.scan.scan_facts import CodeNode

    CodeClasses = tuple[str, str, tuple[NodeClass, ...]]  # file, language, its classes

UNHASHED = ("ctx", "kind", "type_comment")  # of the syntax tree: they follow from the rest, or are comments
LITERALS = ("string_literal", "raw_string_literal", "char_literal")
Mark = tuple[str]  # a sign between the parts of a syntax tree


class Piece(NamedTuple):
    """A part of a file: a class, in C++ a method that stands outside of its class, or without a name the whole file.

    Attributes
    ----------
    name
        Of the class.
    method
        Whether it is such a method of it.
    """

    name: str
    line: int
    hash: str
    method: bool = False


class CheckoutCode:
    """The code of a checkout by its units; a file is parsed when one of its units is asked for.

    Parameters
    ----------
    packages
        (name, folder relative to the root) of each.
    codes
        Of what was read as code; files relative to the root.
    """

    def __init__(self, folder: str, packages: Iterable[tuple[str, str]], codes: Iterable[CodeClasses]) -> None:
        self._folder = folder
        self._packages = sorted(packages, key=lambda package: -len(package[1]))  # inner ones first
        self._files: dict[str, list[str]] = defaultdict(list)
        self._languages: dict[str, str] = {}
        self._classes: dict[tuple[str, str], list[tuple[str, NodeClass]]] = defaultdict(list)
        for file, language, classes in codes:
            self._files[self._in_package(file)].append(file)
            self._languages[file] = language
            for one in classes:
                self._classes[language, one.name].append((file, one))
        self._all_pieces: Callable[[str], tuple[Piece, ...]] = cache(self._read)
        self._data: Callable[[str], bytes] = cache(self._bytes)

    def unit_of(self, node: CodeNode) -> str:
        """Return the unit that makes a node: its class; of one that functions make the whole file."""
        file, name = node.place.file, node.name.rpartition("::")[2]
        unit = f"{self._in_package(file)}:{name}"
        return unit if self.version(unit) else self._in_package(file)

    def version(self, unit: str) -> CodeVersion | None:
        """Return which version of a unit is there; None if it is not there, or cannot be read."""
        folder, slash, last = unit.rpartition("/")
        base, _, name = last.partition(":")
        files = self._files.get(folder + slash + base, ())
        try:
            own = [(file, piece) for file in files for piece in self._pieces(file, name) if not piece.method]
            if not own:
                return None
            hashes = {piece.hash for _, piece in own}
            for language in {self._languages[file] for file, _ in own} if name else ():
                hashes |= self._with_class(name, language, {file for file, _ in own})
        except (LabelError, OutOfTime, ImportError, *FAILURES):
            return None
        file, first = min(own, key=lambda one: (one[0], one[1].line))
        return CodeVersion(_hash(sorted(hashes)), Place(placed(file, self._folder), first.line))

    def _in_package(self, file: str) -> str:
        """The path of a file from its package, after the package's name; of others from the root."""
        for name, folder in self._packages:
            if not folder or file.startswith(f"{folder}/"):
                return posixpath.join(name, file[len(folder) + 1 if folder else 0 :])
        return file

    def _with_class(self, name: str, language: str, files: set[str]) -> set[str]:
        """The hashes of the methods of a class outside of it, and of its base classes in the checkout with theirs."""
        hashes: set[str] = set()
        seen: set[str] = set()
        waiting = [one for file, one in self._classes[language, name] if file in files]
        while waiting:
            one = waiting.pop()
            hashes |= self._methods(one.name) if language == "c++" else set()
            for base in {*one.bases} - seen:
                seen.add(base)
                for file, above in self._classes.get((language, base), ()):
                    hashes |= {piece.hash for piece in self._pieces(file, base) if not piece.method}
                    waiting.append(above)
        return hashes

    def _methods(self, of_class: str) -> set[str]:
        files = [file for file, language in self._languages.items() if language == "c++"]
        files = [file for file in files if of_class.encode() in self._data(file)]
        return {piece.hash for file in files for piece in self._pieces(file, of_class) if piece.method}

    def _pieces(self, file: str, name: str) -> list[Piece]:
        return [piece for piece in self._all_pieces(file) if piece.name == name]

    def _read(self, file: str) -> tuple[Piece, ...]:
        data = self._data(file)
        return tuple(_python_pieces(data) if self._languages[file] == "python" else _cpp_pieces(data))

    def _bytes(self, file: str) -> bytes:
        path = str(Path(self._folder, file))
        return read_regular(path, MAX_BYTES, partial(LabelError, path))


def _python_pieces(data: bytes) -> Iterator[Piece]:
    _, tree = parse_python(data)
    yield Piece("", 1, _hash(_python_words(tree)))
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield Piece(node.name, node.lineno, _hash(_python_words(node)))


def _python_words(tree: ast.AST) -> Iterator[str]:
    """What a syntax tree says, the same in each version of Python: fields that are empty are left out."""
    waiting: list[object] = [tree]
    while waiting:
        one = waiting.pop()
        if isinstance(one, ast.AST):
            yield f"{type(one).__name__}("
            fields = [(name, value) for name, value in ast.iter_fields(one) if name not in UNHASHED]
            waiting.append((")",))
            for name, value in reversed([(name, value) for name, value in fields if value is not None and value != []]):
                waiting += [value, (f"{name}=",)]
        elif isinstance(one, list):
            waiting += [("]",), *reversed(one), ("[",)]
        elif isinstance(one, tuple):
            yield one[0]
        else:  # a number can be longer than Python writes in decimal
            yield hex(one) if type(one) is int else ascii(one)


def _cpp_pieces(data: bytes) -> Iterator[Piece]:
    root = syntax_tree(data, clock()).root_node
    yield Piece("", 1, _hash(_cpp_words(root)))
    waiting = [(root, False)]
    while waiting:
        node, inside = waiting.pop()
        name = node.child_by_field_name("name")
        if node.type in CLASSES and name is not None and node.child_by_field_name("body") is not None:
            yield Piece(last_of(name), line_of(node), _hash(_cpp_words(node)))
            inside = True  # its methods are part of it
        elif node.type == "function_definition" and not inside and (of_class := scope_of(node)):
            yield Piece(of_class, line_of(node), _hash(_cpp_words(node)), method=True)
        waiting += ((child, inside) for child in reversed(node.children))


def _cpp_words(root: Node) -> Iterator[str]:
    waiting = [root]
    while waiting:
        node = waiting.pop()
        if node.type in LITERALS or not node.child_count:
            if node.type != "comment":
                text = text_of(node)
                yield text if node.type in LITERALS else " ".join(text.split())
        else:
            waiting += reversed(node.children)


def _hash(words: Iterator[str] | list[str]) -> str:
    digest = hashlib.sha256()
    for word in words:
        digest.update(word.encode("utf-8", "surrogatepass") + b"\0")
    return digest.hexdigest()[:VERSION_DIGITS]
