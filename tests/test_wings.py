"""Wings of a room form a ladder, nobody imports in a circle, and a module's name says which one is meant."""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from functools import cache
from typing import TYPE_CHECKING

import pytest

from tests.helpers.house import MODULES, PACKAGE, ROOMS, WINGS, parsed
from tests.helpers.paths import ROOT, TESTS

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

# Names that stand twice: the same part of different wings, and what part that is.
SAME_PART = {
    "analysis": {
        "report/schemas",
        "report/document",
        "report/text",
    },  # the answer about a system: keys, document, lines
    "answer": {"analysis", ""},  # what was found, and all that it rests on
    "bags": {"", "report", "report/schemas"},  # the answer about bags, and its keys
    "categories": {"cli", "report/text"},  # the command, and what it prints
    "findings": {"analysis/findings", "report/rdf"},  # findings, and findings as RDF
    "fleet": {"cli", "report/text"},  # what is told of a fleet
    "lint": {"cli", "ingest", "report"},  # the command, the rules, and what it prints
    "packages": {"analysis/suggesting", "ingest/scan"},  # those that are known, and those of a checkout
    "records": {"report/schemas", "report/document"},  # the rows of a document: their keys, and how they are made
    "stated": {"report/schemas", "report/document"},  # what is stated: its keys, and how they are made
    "register": {
        "analysis/findings",
        "report/rdf",
        "report/schemas",
        "report/document",
    },  # how rows are made, their keys, and how they are told
    "review": {"report/page", "report/text"},  # what nobody has reviewed, for each kind of reader
    "ledger": {"analysis/whatif", "report/document"},  # what was taken away, and how it is told
    "mitigation": {"", "report/schemas", "report/document", "report/text"},  # what is told of proposals
    "why_not": {"analysis/whatif", "cli"},  # the question, and its answer
    "session": {"explorer", "parts"},  # what lasts from its begin to its end: of a person, and of a cluster
}


def imports(module: str) -> Iterator[str]:
    """The modules of the program that a module imports, at run time, for types, or in a function."""
    for node in ast.walk(parsed(MODULES[module])):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                inner = f"{node.module}.{alias.name}"
                yield from (name for name in [inner if inner in MODULES else str(node.module)] if name in MODULES)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in MODULES)


pytestmark = pytest.mark.xdist_group("house")  # one process reads all modules, once


@cache
def all_imports() -> Mapping[str, frozenset[str]]:
    return {module: frozenset(imports(module)) - {module} for module in MODULES}


def room_and_wing(module: str) -> tuple[str, str]:
    parts = module.split(".")[1:] or ["__init__"]
    room = parts.pop(0) if parts and parts[0] in ROOMS else "rosprivacy"
    package = MODULES[module].name == "__init__.py"
    wing = parts[0] if len(parts) > 1 or (package and parts) or (parts and parts[0] in WINGS[room]) else ""
    return room, wing


@pytest.mark.parametrize("room", WINGS)
def test_a_wing_imports_from_those_below_it(room: str) -> None:
    for module in sorted(MODULES):
        mine, wing = room_and_wing(module)
        if mine != room:
            continue
        assert wing in WINGS[room], (
            f"{module}: name its wing in WINGS of tests/helpers/house.py, and what it may import from"
        )
        for target in all_imports()[module]:
            other, below = room_and_wing(target)
            if other == room and below != wing:
                assert below in WINGS[room][wing], (
                    f"{module} imports {target}; {wing or room} may not import from {below}"
                )


@pytest.mark.parametrize("room", WINGS)
def test_the_wings_form_a_ladder(room: str) -> None:
    left = dict(WINGS[room])
    while left:
        lowest = {wing for wing, below in left.items() if not below & left.keys()}
        assert lowest, f"none of {sorted(left)} is below the others"
        left = {wing: below for wing, below in left.items() if wing not in lowest}


@pytest.mark.parametrize("room", WINGS)
def test_every_wing_is_there_and_says_what_it_is(room: str) -> None:
    folder = PACKAGE if room == "rosprivacy" else ROOT / room
    for wing in WINGS[room]:
        init = folder / wing / "__init__.py"
        if not (folder / f"{wing}.py").is_file():
            assert ast.get_docstring(parsed(init)), f"{init}: a line that says what it is"


def test_nobody_imports_in_a_circle() -> None:
    """Take away modules that import none of those left, until there are none; what stays stands in a circle."""
    left = dict(all_imports())
    left["rosprivacy"] = frozenset()  # the public API imports what it needs when it is called
    while free := {module for module, targets in left.items() if not targets & left.keys()}:
        left = {module: targets for module, targets in left.items() if module not in free}
    users = left
    while top := set(users) - {target for targets in users.values() for target in targets}:
        users = {module: targets for module, targets in users.items() if module not in top}
    assert not users, f"import in a circle: {sorted(users)}"


def test_no_name_stands_twice_but_of_the_same_part() -> None:
    wings = defaultdict(set)
    for module, file in MODULES.items():
        if file.name not in {"__init__.py", "__main__.py"}:
            wings[module.rpartition(".")[2]].add("/".join(module.split(".")[1:-1]))
    assert {name: where for name, where in wings.items() if len(where) > 1} == SAME_PART


TAKING = re.compile(r"^\s*(?:from|import) tests\b.*(?:\b(?:test_|conftest)|\($)", re.MULTILINE)  # or may go on so


def test_no_test_imports_from_test_modules() -> None:
    """What several tests need stands in ``tests/helpers``, or is a fixture of a ``conftest.py``."""
    for file in TESTS.rglob("*.py"):
        if not TAKING.search(file.read_text("utf-8")):
            continue
        for node in ast.walk(parsed(file)):
            if isinstance(node, ast.ImportFrom):
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            elif isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            else:
                continue
            taken = [name for name in names if re.match(r"tests\.(?:.*\.)?(?:test_|conftest)", name)]
            assert not taken, f"{file.relative_to(ROOT)}: put what {taken[0]} shares into tests/helpers"
