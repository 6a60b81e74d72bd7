"""Source code of our own in a folder, read for tests."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.cpp.cpp_nodes import read_cpp_nodes
from rosprivacy.ingest.scan.python.python_nodes import read_python_nodes
from rosprivacy.ingest.scan.source_trees import read_source_trees
from rosprivacy.ingest.suggestion_rules.rule_files import read_library_rules
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.scan.scan_facts import CodeFacts
    from rosprivacy.ingest.scan.source_trees import SourceTrees

RULES = read_library_rules((), load())[0]


def source_trees(folder: Path) -> SourceTrees:
    """Read all code of a folder."""
    return read_source_trees(folder, [str(folder)], RULES)


def python_nodes(folder: Path) -> CodeFacts:
    """Read the nodes of the Python code of a folder, with gaps for files that cannot be read."""
    read = source_trees(folder)
    facts = read_python_nodes(folder, read.codes, read.python)
    return facts._replace(gaps=(*facts.gaps, *read.gaps))


def cpp_nodes(folder: Path) -> CodeFacts:
    """Read the nodes of the C++ code of a folder."""
    read = source_trees(folder)
    return read_cpp_nodes(read.cpp, read.texts)
