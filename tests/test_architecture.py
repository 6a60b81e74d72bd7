"""Who may import whom, and what a light start may cost: read from the code, not from its description."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MAY = {
    "analysis": set(),
    "ontology": {"analysis"},
    "ingest": {"analysis", "ontology"},
    "queries": {"analysis", "ontology"},
    "report": {"analysis", "ontology", "queries"},
}


def imported_rooms(file: Path) -> set[str]:
    """The rooms that a module imports, whether at run time or for types only."""
    rooms = set()
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        names = []
        if isinstance(node, ast.ImportFrom):
            assert not node.level, f"{file}: relative import"
            names = [node.module or ""]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        rooms |= {name.split(".")[1] for name in names if name.startswith("rosprivacy.")}
        rooms |= {"rosprivacy" for name in names if name == "rosprivacy"}
    return rooms


@pytest.mark.parametrize("room", [room for room in MAY if any((ROOT / room).glob("*.py"))])
def test_data_flows_one_way(room: str) -> None:
    for file in (ROOT / room).rglob("*.py"):
        assert imported_rooms(file) <= MAY[room] | {room}, file


def test_the_rooms_ship_under_the_package() -> None:
    for room in MAY:
        assert (ROOT / "src" / "rosprivacy" / room).resolve() == ROOT / room


@pytest.mark.parametrize(
    ("arguments", "absent"),
    [
        (["--version"], ["lxml", "numpy", "networkx", "rdflib", "yaml", "rich.console", "neo4j", "psutil"]),
        (
            ["analyze", "examples/factory/after.policy.xml", "-l", "examples/factory/run5.labels.yaml"],
            ["networkx", "neo4j"],
        ),
    ],
)
def test_what_is_not_needed_is_not_imported(arguments: list[str], absent: list[str]) -> None:
    code = (
        "import sys\nfrom rosprivacy.cli import app\n"
        f"try: app({arguments!r})\nexcept SystemExit: pass\n"
        f"print([m for m in {absent!r} if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_rdflib_is_not_imported_once_the_ontology_is_cached(tmp_path: Path) -> None:
    code = (
        "import sys, pathlib\nfrom rosprivacy.ontology.vocabulary import load\n"
        f"load(pathlib.Path({str(tmp_path)!r}))\nprint('rdflib' in sys.modules)"
    )
    runs = [
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
        for _ in range(2)
    ]
    assert runs == ["True", "False"]
