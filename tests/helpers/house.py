"""The house as the tests hold it: its rooms and wings with what they may import, and all modules."""

from __future__ import annotations

import ast
from functools import cache
from typing import TYPE_CHECKING

from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE = ROOT / "src" / "rosprivacy"
# Which rooms a room may import from.
ROOMS: dict[str, set[str]] = {
    "analysis": set(),
    "ontology": {"analysis"},
    "ingest": {"analysis", "ontology"},
    "queries": {"analysis", "ontology"},
    "report": {"analysis", "ontology", "queries"},
}
# Which wings a wing may import from; '' is what stands in the room itself. A name of one module is that module alone.
PYTHON = {"python_311"}  # what Python 3.10 lacks
MODEL = {"", "model"}
FACTS = MODEL | {"kernel", "answer", "case", "contexts", "decisions", "legal"}
READING = {"reading", "policies"}
ANSWERS = {"", "result", "answering"}
WORK = ANSWERS | {"formats", "outputs", "mitigation", "systems", "both_views", "checking", "linting", "labelling"}
WINGS: dict[str, dict[str, set[str]]] = {
    "analysis": {
        "python_311": set(),
        "durations": set(),
        "model": {"durations"} | PYTHON,
        "": {"model", "durations"} | PYTHON,
        "kernel": MODEL,
        "answer": MODEL | {"kernel"} | PYTHON,
        "case": MODEL | {"answer"},
        "decisions": MODEL | {"answer", "case", "legal"} | PYTHON,
        "legal": MODEL | {"answer"} | PYTHON,
        "contexts": MODEL | {"answer"},
        "findings": FACTS,
        "whatif": FACTS | {"findings"},
        "fleet": FACTS | {"findings"},
        "mitigation": FACTS | {"findings"},
        "suggesting": MODEL | {"kernel", "answer"},
    },
    "ingest": {
        "": set(),
        "reading": set(),
        "types": {"reading"},
        "suggestion_rules": {"reading", "policies", "labels"},
        "known_packages": {"reading"},
        "policies": {"reading", "types"},
        "decisions": {"reading"},
        "running": READING | {"types"},
        "labels": READING | {"running"},
        "code": READING | {"labels"},
        "scan": READING | {"code", "deployed", "known_packages", "labels", "running", "suggestion_rules", "types"},
        "mitigation": READING,
        "language_model": {"reading"},
        "deployed": READING,
        "lint": READING,
        "fleet": READING | {"labels", "types"},
        "neo4j_graph": READING | {"labels", "fleet"},
    },
    "ontology": {"": set()},
    "queries": {"": set()},
    "report": {
        "schemas": set(),
        "catalogs": set(),
        "": {"schemas", "catalogs"},
        "document": {"", "schemas", "catalogs"},
        "text": {"", "document", "catalogs"},
        "pictures": {"", "catalogs"},
        "compare": {"", "schemas", "document"},
        "page": {"", "document", "pictures", "compare", "catalogs"},
        "bags": {"", "schemas"},
        "shared_bag": {"", "schemas", "bags"},
        "lint": {"", "schemas", "sarif"},
        "suggested_labels": {"", "schemas", "catalogs"},
        "sarif": {"", "document", "catalogs"},
        "cnil": {"", "document", "catalogs"},
        "rdf": {"", "schemas", "document"},
    },
    "rosprivacy": {
        "": set(),
        "outputs": {""},
        "formats": {"", "outputs"},
        "result": {"", "outputs", "formats"},
        "mitigation": {"", "result"},
        "answering": {"", "result", "mitigation"},
        "systems": ANSWERS,
        "api": {"", "result", "systems", "labelling", "explorer"},
        "__init__": {"", "result", "api", "labelling", "explorer"},
        "both_views": ANSWERS | {"systems"},
        "checking": ANSWERS | {"systems"},
        "linting": ANSWERS | {"systems"},
        "labelling": ANSWERS | {"systems"},
        "bags": ANSWERS | {"systems"},
        "bag_copy": ANSWERS | {"systems", "bags"},
        "observing": {""},
        "scanning": {""},
        "watching": ANSWERS | {"systems", "observing"},
        "parts": ANSWERS | {"systems"},
        "private_neo4j": {""},
        "explorer": WORK,
        "cli": WORK | {"bags", "bag_copy", "observing", "scanning", "watching", "private_neo4j", "parts", "explorer"},
        "__main__": {"cli"},
    },
}


@cache
def parsed(file: Path) -> ast.Module:
    """The code of a module; nobody changes it."""
    return ast.parse(file.read_text("utf-8"))


def modules() -> dict[str, Path]:
    """Every module of the program: its dotted name and its file."""
    folders = [*(ROOT / room for room in ROOMS), PACKAGE]
    files = [file for folder in folders for file in folder.rglob("*.py")]
    found = {}
    for file in files:
        parts = file.relative_to(PACKAGE if PACKAGE in file.parents else ROOT).with_suffix("").parts
        found[".".join(("rosprivacy", *(parts[:-1] if parts[-1] == "__init__" else parts)))] = file
    return found


MODULES = modules()
