"""Names say what a thing is: words that only bind a sentence together name no function, parameter or attribute."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

import pytest

from tests.helpers.house import MODULES, parsed

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.xdist_group("house")  # one process reads all modules, once

GRAMMAR = frozenset(
    """
    told said one found some there here these those this that it its beside kept given made seen known left held wanted
    asked put gone taken had done been being then else both each others any none more most less least only even also
    same so too again once needed meant called named such which what who whose
    """.split()  # noqa: SIM905 - to be read as a text
)
# Published keys, the fields of a label, and an option of a command: their names are contracts.
STORED = {
    "analysis.DeviantEntry.more", "analysis.StandardFile.taken", "bags.BagEntry.beside", "records.GrantEntry.seen",
    "stated.SanitizerEntry.beside", "edits.Label.only", "graph.graph.most", "records.ChangedSince.what",
}  # fmt: skip


def definitions(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """(where it is defined, name) of functions, their parameters, attributes, and variables of a module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield "", node.name
            every = node.args
            listed = [*every.posonlyargs, *every.args, *every.kwonlyargs, every.vararg, every.kwarg]
            yield from ((f"{node.name}.", argument.arg) for argument in listed if argument)
        elif isinstance(node, ast.ClassDef):
            fields = [field.target for field in node.body if isinstance(field, ast.AnnAssign)]
            yield from ((f"{node.name}.", field.id) for field in fields if isinstance(field, ast.Name))
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield "", node.attr
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else []
        yield from (("", target.id) for target in targets if isinstance(target, ast.Name))


def grammar(module: str) -> list[str]:
    """Names of a module that are words of grammar, each as often as it is defined."""
    short = module.rpartition(".")[2]
    return [
        f"{module}: {where}{name}"
        for where, name in definitions(parsed(MODULES[module]))
        if name.strip("_").lower() in GRAMMAR and not name.startswith("__") and f"{short}.{where}{name}" not in STORED
    ]


def test_no_name_is_only_grammar() -> None:
    names = [name for module in MODULES for name in grammar(module)]
    assert not names, "say what it is, with a noun of the field"


def test_what_it_sees() -> None:
    code = "KEPT = 1\nclass A:\n    seen: int\n    def told(self, some: int) -> None:\n        self.left = some\n"
    names = [name for _, name in definitions(ast.parse(code)) if name.lower() in GRAMMAR]
    assert sorted(names) == ["KEPT", "left", "seen", "some", "told"]
