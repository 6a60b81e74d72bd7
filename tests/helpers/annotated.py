"""Source code in memory -> what its annotations say; for tests of several modules."""

from __future__ import annotations

from rosprivacy.ingest.code.annotated_elements import attach
from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ingest.code.python_code import read_python
from rosprivacy.ontology.vocabulary import load

PYTHON, CPP = "a.py", "a.cpp"


def said_by(*files: tuple[str, str], namespace: str = "/") -> tuple[list[tuple[str, str, int]], list[str]]:
    """Return (section, name, line) of what some files of code say, and all problems."""
    codes = [(read_python if file.endswith(".py") else read_cpp)(file, text.encode()) for file, text in files]
    labelled, problems = attach(codes, load(), namespace)
    return [(one.section, one.name, one.place.line) for one in labelled], [str(problem) for problem in problems]
