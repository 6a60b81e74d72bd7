"""The regular expressions of the program, as it compiles them, and what a linter says of each.

They are found in the source (``re.compile(…)``, ``re.sub(…)`` …), and what stands there is evaluated in its module, so
that a text that is put together is seen whole.
"""

from __future__ import annotations

import ast
import json
import re
import subprocess
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rdflib import Graph

import rosprivacy
from rosprivacy.ontology.own import Lines
from rosprivacy.ontology.turtle import RP
from tests.helpers.paths import TESTS

if TYPE_CHECKING:
    from collections.abc import Iterator

LINTER = TESTS / "patterns"
PACKAGE = Path(rosprivacy.__file__).parent
WINGS = ("analysis", "ingest", "report", "queries", "ontology")  # linked folders, which rglob does not follow
USES = {"match", "fullmatch", "search", "sub", "subn", "split", "findall", "finditer"}
# What a function is given of which it makes an expression.
GIVEN: dict[str, Any] = {
    "role": "publish",
    "pattern": "/a*b*[c-d]?",
    "self": Lines("", Graph()),
    "subject": RP.label,
    "predicate": RP.label,
}


@dataclass(frozen=True, slots=True)
class Expression:
    """A regular expression, where it stands (``file:name``, or ``file:function``), and how it is used."""

    place: str
    source: str
    flags: int
    uses: frozenset[str]

    @property
    def in_javascript(self) -> tuple[str, str]:
        r"""What means the same there; one that matches from the start only says so with ``^``.

        >>> Expression("", r"(?P<a>b)\Z", re.IGNORECASE, frozenset({"match"})).in_javascript
        ('^(?:(?<a>b)$)', 'i')
        """
        source = re.sub(r"\\.", lambda escape: "$" if escape[0] == r"\Z" else escape[0], self.source, flags=re.DOTALL)
        source = source.replace("(?P<", "(?<")
        flags = self.flags
        if source.startswith("(?s)"):
            source, flags = source[4:], flags | re.DOTALL
        plain = re.sub(r"\\.", "x", source, flags=re.DOTALL)
        unlike = re.search(r"\(\?[>P(a-zA-Z]|\[\^?\]|\\[AzZ]|[*+?}]\+", re.sub(r"\[\^?[^\]]+\]", "x", plain))
        assert unlike is None, f"{self.place}: {unlike and unlike[0]} means something else in JavaScript"
        if self.uses <= {"match", "fullmatch"}:
            source = f"^(?:{source})" + ("$" if self.uses == {"fullmatch"} else "")
        named = {"i": re.IGNORECASE, "m": re.MULTILINE, "s": re.DOTALL}
        return source, "".join(letter for letter, flag in named.items() if flags & flag)


@dataclass(frozen=True, slots=True)
class Said:
    """What the linter says: ``safe``, or how steps grow, with texts on which they do."""

    status: str
    complexity: str
    degree: int
    pumps: tuple[tuple[str, str], ...]
    suffix: str

    def text(self, longest: int) -> str:
        """The worst text of at most so many characters."""
        fixed = len(self.suffix) + sum(len(prefix) for prefix, _ in self.pumps)
        times = max(1, (longest - fixed) // sum(len(pump) for _, pump in self.pumps))
        return "".join(prefix + pump * times for prefix, pump in self.pumps) + self.suffix


def expressions() -> list[Expression]:
    """All of the program, sorted by place."""
    files = sorted(file for top in (PACKAGE, *(PACKAGE / wing for wing in WINGS)) for file in top.rglob("*.py"))
    trees = {file.relative_to(PACKAGE).as_posix(): ast.parse(file.read_text("utf-8")) for file in dict.fromkeys(files)}
    found = {one for name, tree in trees.items() for one in _of_module(name, tree, trees)}
    return sorted(found, key=lambda one: (one.place, one.source))


def asked(sources: list[tuple[str, str]]) -> list[Said]:
    """What the linter says of expressions of JavaScript."""
    command = ["node", str(LINTER / "check.mjs")]
    done = subprocess.run(command, input=json.dumps(sources), capture_output=True, text=True, check=True)
    return [Said(**{**one, "pumps": tuple(map(tuple, one["pumps"]))}) for one in json.loads(done.stdout)]


def _of_module(file: str, tree: ast.Module, trees: dict[str, ast.Module]) -> Iterator[Expression]:
    parents = {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and ast.unparse(node.func).partition(".")[0] == "re" and node.args):
            continue
        module = import_module(".".join(("rosprivacy", *Path(file).with_suffix("").parts)).removesuffix(".__init__"))
        name, function = _stands_in(node, parents)
        used = ast.unparse(node.func).removeprefix("re.")
        flags = [keyword.value for keyword in node.keywords if keyword.arg == "flags"]
        uses = {used}
        if used == "compile":
            flags += node.args[1:]
            seen = [tree] if name.startswith("_") or function else list(trees.values())
            uses = {use for one in seen for use in _uses(one, name)} | _after(node, parents)
        elif used not in USES:
            continue
        source = _value(node.args[0], module)
        yield Expression(
            f"{file}:{function or name}",
            source if isinstance(source, str) else source.decode("latin-1"),
            int(_value(flags[0], module)) if flags else 0,
            frozenset(uses or {"search"}),
        )


def _stands_in(node: ast.AST, parents: dict[ast.AST, ast.AST]) -> tuple[str, str]:
    """The name that is given to an expression, and the function that it is in; either may be empty."""
    name = ""
    while not isinstance(node, ast.FunctionDef | ast.Module):
        node = parents[node]
        if isinstance(node, ast.Assign) and not name:
            name = ast.unparse(node.targets[0])
    return name, node.name if isinstance(node, ast.FunctionDef) else ""


def _uses(tree: ast.Module, name: str) -> Iterator[str]:
    """How a compiled expression of this name is used."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in USES and ast.unparse(node.value) == name:
            yield node.attr


def _after(node: ast.Call, parents: dict[ast.AST, ast.AST]) -> set[str]:
    """``match`` of ``re.compile(…).match``."""
    up = parents[node]
    return {up.attr} if isinstance(up, ast.Attribute) else set()


def _value(node: ast.expr, module: Any) -> Any:
    return eval(compile(ast.Expression(node), module.__name__, "eval"), vars(module), GIVEN)  # noqa: S307 - our source
