"""Who may import whom, and what a light start may cost: read from the code, not from its description."""

from __future__ import annotations

import ast
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

import rosprivacy
from tests.helpers.house import ROOMS, parsed
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path


pytestmark = pytest.mark.xdist_group("house")  # one process reads all modules, once


def imported_rooms(file: Path) -> set[str]:
    """The rooms that a module imports, whether at run time or for types only."""
    rooms = set()
    for node in ast.walk(parsed(file.resolve())):
        names = []
        if isinstance(node, ast.ImportFrom):
            assert not node.level, f"{file}: relative import"
            names = [node.module or ""]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        rooms |= {name.split(".")[1] for name in names if name.startswith("rosprivacy.")}
        rooms |= {"rosprivacy" for name in names if name == "rosprivacy"}
    return rooms


@pytest.mark.parametrize("room", [room for room in ROOMS if any((ROOT / room).glob("*.py"))])
def test_data_flows_one_way(room: str) -> None:
    for file in (ROOT / room).rglob("*.py"):
        assert imported_rooms(file) <= ROOMS[room] | {room}, file


THINKING = {"kernel", "findings", "whatif", "fleet", "mitigation"}  # wings of analysis that work something out


@pytest.mark.parametrize("file", sorted((ROOT / "report").rglob("*.py")), ids=lambda file: str(file.relative_to(ROOT)))
def test_what_is_written_was_thought_before(file: Path) -> None:
    """Every output is a function of the ``Document``: reports know the facts and words of analysis, and work out none.

    Pictures look at the graph itself: which of its flows are drawn follows from how many boxes there is room for.
    """
    if file.parent.name == "pictures":
        return
    tree = parsed(file)
    for_types = {
        node
        for block in ast.walk(tree)
        if isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING"
        for node in ast.walk(block)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node not in for_types:
            parts = f"{node.module}.".split(".")
            names = [alias.name for alias in node.names]
            functions = [name for name in names if name[0].islower()]
            assert not (parts[1] == "analysis" and parts[2] in THINKING and functions), f"{node.module}: {functions}"
        assert not (isinstance(node, ast.Attribute) and ast.unparse(node) == "analysis.spread"), file


def test_one_module_knows_which_bit_is_which() -> None:
    """Bits are numbered by how many categories are emitted; nobody else asks for that number (rule S8)."""
    asking = set()
    for folder in [*ROOMS, "src/rosprivacy", "benchmarks"]:
        for file in (ROOT / folder).rglob("*.py"):
            for node in ast.walk(parsed(file.resolve())):
                if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "len":
                    counted = ast.unparse(node.args[0]).rpartition(".")[2]
                    asking |= {file.resolve().relative_to(ROOT).as_posix()} if counted == "categories" else set()
    assert asking == {"analysis/kernel/spread.py"}  # where ``CategoryBits`` are made


OPENERS = {"open", "fdopen", "read_bytes", "read_text"}
WRITERS = {"write_bytes", "write_text", "mkstemp", "NamedTemporaryFile", "TemporaryFile", "rename", "truncate"}
OF_ITS_OWN = {  # modules that touch files in another way, and why none of these is a user's
    "ingest/reading/bounded_file.py": "notes what it reads; what is only looked at is in no answer, and may be written",
    "ingest/running/recorded_file.py": "notes what it reads",
    "ontology/vocabulary.py": "notes what it reads; and what is shipped",
    "report/compare/earlier.py": "notes what it reads; and what is shipped",
    "report/atomic.py": "the one writer",
    "ingest/running/zenoh_door.py": "opens a session, no file",
    "ingest/language_model.py": "opens a connection, no file",
    "ingest/policies/policy_xml.py": "asks xinclude.py to open",
    "ingest/running/observed_files.py": "asks xinclude.py to open",
    "ingest/lint.py": "asks xinclude.py to open what a policy was read from",
    "ingest/mitigation/deny_patch.py": "copies in a folder of its own, gone at once",
    "ingest/deployed/signatures.py": "a certificate that was read, in a folder of its own, gone at once",
    "ingest/labels/label_file.py": "what is shipped",
    "ontology/own.py": "what is shipped",
    "ontology/provisions.py": "what is shipped",
    "queries/library.py": "what is shipped",
    "report/catalogs/words.py": "what is shipped",
    "ingest/policies/saved_graph.py": "what is shipped; bounded_file.py reads",
    "src/rosprivacy/api.py": "begins a session, no file",
    "src/rosprivacy/cli/explore.py": "the link in a file of its own, gone at the end",
    "src/rosprivacy/explorer/web/application.py": "what is shipped",
    "src/rosprivacy/explorer/journal.py": "journals of sessions, in the user's state folder",
    "src/rosprivacy/cli/own_error.py": "the report of an error, a new file",
    "ontology/cache.py": "the cache of categories",
    "src/rosprivacy/cli/base_tree.py": "files of a revision in a folder of its own, gone at once",
    "src/rosprivacy/cli/what_runs.py": "a policy in a folder of its own, gone at once",
    "src/rosprivacy/watching.py": "a policy in a folder of its own, gone at once",
    "report/pictures/graphviz_worker.py": "a process that draws, with pipes only",
    "src/rosprivacy/cli/diff.py": "looks how a file begins; what then reads it notes it",
    "src/rosprivacy/cli/output.py": "the null device, when standard output is gone",
    "src/rosprivacy/parts/kept_parts.py": "parts that were read, for --resume; files of users are only hashed",
    "src/rosprivacy/parts/processes.py": "values of a run in a folder of its own, gone at its end",
    "src/rosprivacy/parts/session.py": "settings of Spark in a folder of its own, gone at its end",
    "src/rosprivacy/private_neo4j/connection.py": "the private Neo4j",
    "src/rosprivacy/private_neo4j/jars.py": "the private Neo4j",
    "src/rosprivacy/private_neo4j/server.py": "the private Neo4j",
    "src/rosprivacy/private_neo4j/state.py": "the private Neo4j",
}


def test_there_is_one_writer_of_files_and_every_reader_notes_them() -> None:
    """What is read is not written: that holds only as long as nothing is opened beside these."""
    folders = [*ROOMS, "src/rosprivacy"]
    touching = set()
    for file in sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py")):
        if any(link in file.parents for link in (ROOT / "src" / "rosprivacy" / room for room in ROOMS)):
            continue
        calls = (node.func for node in ast.walk(parsed(file.resolve())) if isinstance(node, ast.Call))
        names = {call.attr if isinstance(call, ast.Attribute) else getattr(call, "id", "") for call in calls}
        if names & (OPENERS | WRITERS):
            touching.add(str(file.relative_to(ROOT)))
    assert touching - OF_ITS_OWN.keys() == set()
    assert OF_ITS_OWN.keys() - touching == set()  # no reason is left over


def test_the_rooms_ship_under_the_package() -> None:
    for room in ROOMS:
        assert (ROOT / "src" / "rosprivacy" / room).resolve() == ROOT / room


LABELS = ["analyze", "examples/factory/after.policy.xml", "-l", "examples/factory/run5.labels.yaml"]
FOR_SOME = [  # of ours, needed where there is such a thing: a decision, a bag, an observation, a type, a wildcard
    *("analysis.decisions", "analysis.remembered", "analysis.model.recording", "ingest.reading.legal_basis"),
    *("ingest.policies.observed_metadata", "ingest.types.type_table"),
    *("analysis.kernel.type_limits", "cli.wrong_values", "ontology.known"),
]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "absent"),
    [
        (["--version"], ["lxml", "numpy", "networkx", "rdflib", "yaml", "rich.console", "neo4j", "psutil"]),
        (
            LABELS,
            [
                *("numpy", "networkx", "rdflib", "pydantic", "jinja2", "neo4j", "jsonschema", "ruamel", "rich"),
                *("importlib.resources", *(f"rosprivacy.{name}" for name in FOR_SOME)),
            ],
        ),
    ],
)
def test_what_is_not_needed_is_not_imported(arguments: list[str], absent: list[str]) -> None:
    code = (
        f"import sys\nfrom rosprivacy.cli.app import main\nsys.argv[1:] = {arguments!r}\n"
        "try: main()\nexcept SystemExit: pass\n"
        f"print([m for m in {absent!r} if m in sys.modules])"
    )
    for _ in range(2):  # the first run writes the cache of the ontology
        done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_start_imports_few_modules_and_makes_few_dataclasses() -> None:
    """Each module of ours costs about 0.1 ms, a frozen dataclass 0.3 (a plain tuple can be a NamedTuple)."""
    code = (
        f"import sys\nfrom rosprivacy.cli.app import main\nsys.argv[1:] = {LABELS!r}\n"
        "try: main()\nexcept SystemExit: pass\n"
        "ours = {n: vars(m) for n, m in sys.modules.items() if n.startswith('rosprivacy')}\n"
        "made = [c for n, names in ours.items() for c in names.values()"
        " if isinstance(c, type) and c.__module__ == n and '__dataclass_fields__' in vars(c)]\n"
        "print(len(ours), len(made))"
    )
    for _ in range(2):  # the first run writes the cache of the ontology
        done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    modules, dataclasses = map(int, done.stdout.splitlines()[-1].split())
    assert modules <= 215  # 207 when this was written
    assert dataclasses <= 40  # 121 before, 36 then


def test_the_version_is_told_before_typer_is_imported() -> None:
    start = "import sys; sys.argv[1:] = ['--version']; from rosprivacy.cli import main; main()"
    code = f"{start}; print('typer' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [f"rosprivacy {rosprivacy.__version__}", "False"]


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
