"""The source code of a checkout, each file parsed once -> what single files say, for nodes that are made of several.

In: files. Out: what each uses, what it writes into logs, trees of Python, classes and functions of C++. A tree of C++
is let go with its file: it takes a hundred times as much memory as the text.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.ingest.code.cpp_code import cpp_code, syntax_tree
from rosprivacy.ingest.code.cpp_tree import parts
from rosprivacy.ingest.code.python_code import classes_of, not_python
from rosprivacy.ingest.code.python_tree import FAILURES, parse_python
from rosprivacy.ingest.code.python_uses import read_uses
from rosprivacy.ingest.code.source_code import Where, clock, walk
from rosprivacy.ingest.code.source_files import is_cpp, read_sources
from rosprivacy.ingest.scan.cpp.cpp_nodes import is_read
from rosprivacy.ingest.scan.cpp.cpp_units import read_cpp_file
from rosprivacy.ingest.scan.outside.cpp_logs import cpp_logs
from rosprivacy.ingest.scan.outside.log_calls import FileLogs, lines_recognising
from rosprivacy.ingest.scan.outside.python_logs import python_logs
from rosprivacy.ingest.scan.scan_facts import CodePlace, Gap

if TYPE_CHECKING:
    import ast
    from collections.abc import Iterable
    from pathlib import Path

    from rosprivacy.analysis.suggesting.library_rules import LibraryRules
    from rosprivacy.ingest.code.source_code import Code
    from rosprivacy.ingest.scan.cpp.cpp_units import CppFile
    from rosprivacy.ingest.scan.outside.value_flow import LoggedValue


class SourceTrees(NamedTuple):
    """What the files of a checkout say, each for itself.

    Attributes
    ----------
    codes
        Sorted by file, without comments and calls; what cannot be read is among them, with its problem.
    python
        By the names of ``codes``.
    texts
        Of the files of C++.
    """

    codes: tuple[Code, ...]
    python: dict[str, ast.Module]
    cpp: list[CppFile]
    texts: dict[str, bytes]
    logs: list[FileLogs]
    gaps: tuple[Gap, ...] = ()


def read_source_trees(root: Path, files: Iterable[str], rules: LibraryRules) -> SourceTrees:
    """Read source code.

    Parameters
    ----------
    root
        The checkout; what was found is placed relative to it.
    files
        As ``read_sources`` takes them.
    rules
        What libraries recognise.
    """
    read = SourceTrees((), {}, [], {}, [])

    def keep_logs(name: str, values: tuple[LoggedValue, ...]) -> None:
        if values:
            read.logs.append(FileLogs(name, values))

    def read_python(file: str, data: bytes) -> Code:
        late = clock()
        try:
            text, tree = parse_python(data)
        except FAILURES as error:
            return not_python(file, error)
        code = read_uses(file, tree, late)
        read.python[file] = tree
        keep_logs(relative(file, root), python_logs(text, tree, code, lines_recognising(code, rules)))
        return code._replace(classes=classes_of(tree, dict(code.imports)))

    def read_cpp(file: str, data: bytes) -> Code:
        late, name = clock(), relative(file, root)
        tree = syntax_tree(data, late).root_node
        pieces = walk(tree, Where(), parts, late)
        code = cpp_code(file, data, pieces, late)
        if not code.problems and is_read(data):
            read.cpp.append(read_cpp_file(name, tree, late))
            read.texts[name] = data
        keep_logs(name, cpp_logs(data, pieces, lines_recognising(code, rules)))
        return code

    found = read_sources(files, lambda file, data: (read_cpp if is_cpp(file) else read_python)(file, data))
    gaps = (
        Gap(CodePlace(relative(code.file, root), one.line), "file", one.problem)
        for code in found.codes
        for one in code.problems
    )
    return read._replace(codes=found.codes, gaps=tuple(gaps))


def relative(file: str, root: Path) -> str:
    """Return the name of a file in the facts."""
    return os.path.relpath(file, root).replace(os.sep, "/")
