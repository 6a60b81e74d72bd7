"""Every public function of the analysis shows an example, which says something of it; doctests run them all."""

from __future__ import annotations

import ast
import doctest
import importlib

import pytest

from tests.helpers.house import MODULES

EXAMPLES = {
    f"{module}.{node.name}": ast.get_docstring(node) or ""
    for module, file in MODULES.items()
    if module.startswith("rosprivacy.analysis.")
    for node in ast.parse(file.read_text("utf-8")).body
    if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
}


def test_every_public_function_has_an_example() -> None:
    without = [name for name, text in EXAMPLES.items() if ">>> " not in text]
    assert not without, f"write one into the docstring; analysis/example.py is a small system to look at: {without}"


@pytest.mark.slow
def test_an_example_fails_where_its_function_does_nothing() -> None:
    for path, text in EXAMPLES.items():
        module, _, name = path.rpartition(".")
        for nothing in (None, ()):
            names = {**vars(importlib.import_module(module)), name: lambda *_, nothing=nothing, **__: nothing}
            example = doctest.DocTestParser().get_doctest(f"{text}\n", names, name, path, 0)
            assert doctest.DocTestRunner(verbose=False).run(example, out=lambda _: None).failed, path
