"""What commands read: the same options everywhere, and one refusal where one makes no sense."""

from __future__ import annotations

import re
from pathlib import Path
from shutil import copytree
from typing import TYPE_CHECKING, Any

import pytest
import typer

from rosprivacy.cli.app import program
from rosprivacy.cli.inputs import WRITTEN, Inputs
from rosprivacy.cli.output import progress_of
from rosprivacy.settings import Settings
from tests.helpers.command import cli, run
from tests.helpers.daily import one_in
from tests.helpers.docs import CATEGORIES, blocks

if TYPE_CHECKING:
    from tests.helpers.command import Cli

__all__ = ["cli"]

POLICY = """<policy version="0.2.0"><enclaves>
<enclave path="/cam"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave>
<enclave path="/up"><profiles><profile ns="/" node="uplink">
<topics subscribe="ALLOW"><topic>/video</topic></topics></profile></profiles></enclave>
</enclaves></policy>
"""
FLEETS = ["--fleet", "f.yaml"]
STORED = "--from-database takes what is in the database: no"
NAMED = "--fleet takes what the fleet file names: no"
MISSING = "Invalid value for POLICY: name at least one policy: a file, a folder or a glob"
LABELS = """labels: 1
nodes:
  /camera: {source: [PulseCurve]}
  /uplink: {leak: [PulseCurve]}
"""
FLEET = """fleet: 1
name: clinic
models:
  m: {policies: [p.xml], labels: [l.yaml]}
groups:
  - {robots: 2, model: m}
limits: {PulseCurve: P30D}
"""
DECISIONS = "decisions: 1\nfindings:\n  - {category: PulseCurve, decision: mitigate}\n"
GROUP: Any = typer.main.get_command(program())
READERS = ("analyze", "show", "report", "graph", "mitigate", "diff", "load", "labels", "why-not")
SYSTEM = ("p.xml", "-l", "l.yaml")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A system with a category of its own, in policies, labels, a fleet, decisions and a saved graph."""
    folder = tmp_path_factory.mktemp("made")
    texts = {"p.xml": POLICY, "l.yaml": LABELS, "f.yaml": FLEET, "d.yaml": DECISIONS}
    for name, text in {**texts, "o.ttl": blocks(CATEGORIES, "turtle")[0]}.items():
        (folder / name).write_text(text)
    done = run("analyze", *SYSTEM, "--ontology", "o.ttl", "--save-graph", "g.json", "-o", "a.txt", cwd=folder)
    assert (done.returncode, done.stderr) == (1, "")
    return folder


@pytest.fixture
def clinic(made: Path, tmp_path: Path) -> Path:
    return Path(copytree(made, tmp_path / "clinic"))


USES = [  # a command, its exit code, and what it then says of the own category
    (["analyze", *SYSTEM], 1, "/uplink: PulseCurve, from /camera"),
    (["analyze", *SYSTEM, "--decisions", "d.yaml"], 1, "/uplink: PulseCurve, from /camera"),
    (["analyze", "--fleet", "f.yaml"], 1, "m_1:/uplink: PulseCurve, from m_1:/camera"),
    (["report", *SYSTEM, "-f", "markdown"], 0, "pulse curve"),
    (["report", "--fleet", "f.yaml", "-f", "markdown"], 0, "pulse curve"),
    (["graph", *SYSTEM, "--show", "privacy"], 0, "PulseCurve"),
    (["graph", "--fleet", "f.yaml", "--show", "privacy"], 0, "PulseCurve"),
    (["mitigate", *SYSTEM, "--decisions", "d.yaml"], 0, "PulseCurve"),
    (["diff", "p.xml", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml"], 0, "nothing differs"),
    (["diff", "f.yaml", "f.yaml"], 0, "nothing differs"),
    (["why-not", "/camera", "/uplink", *SYSTEM], 0, "PulseCurve"),
    (["decide", "mitigate", "--category", "PulseCurve", "--decisions", "new.yaml"], 0, "PulseCurve"),
    (["fleet", "f.yaml", "--decisions", "d.yaml"], 0, "2 robots of 1 kinds"),
    (["unload", "--fleet", "f.yaml", "--neo4j", "bolt://127.0.0.1:9"], 3, ""),
    (["load", "--fleet", "f.yaml", "--neo4j", "bolt://127.0.0.1:9"], 3, ""),
    (["load", *SYSTEM, "--neo4j", "bolt://127.0.0.1:9"], 3, ""),
]


@pytest.mark.parametrize(
    ("arguments", "code", "said"), one_in(4, USES, in_ci=1), ids=[" ".join(use[0][:3]) for use in USES]
)
def test_an_own_category_is_known_to_every_command(
    cli: Cli, clinic: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: int, said: str
) -> None:
    monkeypatch.setenv("NEO4J_PASSWORD", "none")
    done = cli(*arguments, cwd=clinic)
    assert done.returncode == 2, done.stdout
    assert "unknown category 'PulseCurve'" in done.stderr, done.stderr
    done = cli(*arguments, "--ontology", "o.ttl", cwd=clinic)
    assert done.returncode == code, done.stderr
    assert said in done.stdout


def test_a_first_label_file_and_the_schemas_name_an_own_category(cli: Cli, clinic: Path) -> None:
    for command in (["labels", "p.xml", "--init"], ["labels", "--schema"], ["fleet", "--schema"]):
        assert "PulseCurve" not in cli(*command, cwd=clinic).stdout
        done = cli(*command, "--ontology", "o.ttl", cwd=clinic)
        assert (done.returncode, done.stderr) == (0, "")
        assert "PulseCurve" in done.stdout


@pytest.mark.slow
@pytest.mark.database
@pytest.mark.usefixtures("neo4j_server")
def test_a_fleet_with_an_own_category_is_loaded_and_unloaded(cli: Cli, clinic: Path) -> None:
    for command in ("load", "unload"):
        done = cli(command, "--fleet", "f.yaml", "--ontology", "o.ttl", cwd=clinic)
        assert (done.returncode, done.stderr) == (0, ""), command


def test_a_saved_graph_is_read_by_every_command_that_reads_policies(cli: Cli, clinic: Path) -> None:
    own = ("--ontology", "o.ttl")
    for command in (["report", "-f", "markdown"], ["graph"], ["mitigate"], ["why-not", "/camera", "/uplink"]):
        done = cli(*command, "--add", "g.json", "-l", "l.yaml", *own, cwd=clinic)
        direct = cli(*command, *SYSTEM, *own, cwd=clinic)
        assert (done.returncode, done.stderr) == (direct.returncode, "")
        assert done.stdout.replace("g.json", "p.xml") == direct.stdout
    saved, read = (cli("labels", "--init", *of, cwd=clinic).stdout for of in (["--add", "g.json"], ["p.xml"]))
    assert saved == read


# ---------------------------------------------------------------- one set, one refusal


@pytest.mark.parametrize("name", READERS)
def test_every_command_that_reads_a_system_knows_every_option(name: str) -> None:
    """Those that make no sense for it are hidden and refused, not unknown."""
    known = {option for parameter in GROUP.commands[name].params for option in parameter.opts}
    assert {option for option in WRITTEN.values() if option.startswith("--")} <= known


def message(text: str) -> str:
    """An error as one line, without the frame that the terminal has."""
    return " ".join(re.sub("[─│╭╮╰╯]", " ", text).split())


@pytest.mark.parametrize("name", READERS)
def test_what_makes_no_sense_for_a_command_is_refused_in_one_wording(cli: Cli, clinic: Path, name: str) -> None:
    own = {"diff": ["p.xml"], "show": ["59dc"], "why-not": ["/camera", "/uplink"]}
    ends = [*own.get(name, ()), "p.xml"]
    for parameter in GROUP.commands[name].params:
        if parameter.hidden:
            value = [] if parameter.is_flag else ["x"]
            done = cli(name, *ends, parameter.opts[0], *value, cwd=clinic)
            assert (done.returncode, done.stdout) == (2, "")
            said = message(done.stderr)
            assert re.search(rf"Invalid value: {name} takes [\w ,]+: no {parameter.opts[0]}$", said), said


@pytest.mark.parametrize(
    ("words", "refusal"),
    [
        ([*FLEETS, "p.xml"], f"{NAMED} POLICY"),
        ([*FLEETS, *SYSTEM], f"{NAMED} POLICY, --labels"),
        ([*FLEETS, "--add", "g.json"], f"{NAMED} --add"),
        (["--from-database", "p.xml"], f"{STORED} POLICY"),
        (["--from-database", "--add", "g.json"], f"{STORED} --add"),
        (["--from-database", *FLEETS], f"{STORED} --fleet"),
        (
            ["--from-database", "--include-root", ".", "--standard-channels", "none"],
            f"{STORED} --standard-channels, ",
        ),
        (["--from-database", "--view", "enforced"], f"{STORED} --view"),
        (["--from-database", "--standard-channels", "s.yaml"], f"{STORED} --standard-channels"),
        (["--from-database", "--category", "Video"], f"{STORED} --category"),
        ([], MISSING),
        (["-l", "l.yaml"], MISSING),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
@pytest.mark.parametrize("name", ["analyze", "report", "graph", "load", "why-not"])
def test_a_second_system_beside_a_first_is_refused_in_one_wording(
    cli: Cli, clinic: Path, name: str, words: list[str], refusal: str
) -> None:
    own = ["/camera", "/uplink"] if name == "why-not" else []
    done = cli(name, *own, *words, cwd=clinic)
    assert (done.returncode, done.stdout) == (2, "")
    hidden = {option for parameter in GROUP.commands[name].params if parameter.hidden for option in parameter.opts}
    assert refusal in message(done.stderr) or hidden & set(words), done.stderr


@pytest.mark.parametrize(
    ("arguments", "refusal"),
    [
        (["analyze", *FLEETS, "--save-graph", "n.json"], f"{NAMED} --save-graph"),
        (["analyze", "--from-database", "--save-graph", "n.json"], f"{STORED} --save-graph"),
        (["load", "--results", "r", *SYSTEM], "--results takes what is in the folder: no POLICY, --labels"),
        (
            ["analyze", "--engine", "spark", *FLEETS, "--results", "r", "--decisions", "d.yaml"],
            "--results takes a fleet",
        ),
    ],
)
def test_what_only_one_command_has_is_refused_in_the_same_wording(
    cli: Cli, clinic: Path, arguments: list[str], refusal: str
) -> None:
    done = cli(*arguments, cwd=clinic)
    assert (done.returncode, done.stdout) == (2, "")
    assert refusal in message(done.stderr)


def test_the_options_mean_to_the_library_what_it_takes_by_itself() -> None:
    assert Inputs().settings == Settings(progress=progress_of)


# ---------------------------------------------------------------- help


@pytest.mark.slow
def test_help_of_every_command_shows_no_type_of_a_flag_and_no_hidden_option(cli: Cli) -> None:
    assert "<bool>" not in cli("--help").stdout
    for name, command in GROUP.commands.items():
        shown = cli(name, "--help").stdout
        assert "<bool>" not in shown
        hidden = {option for parameter in command.params if parameter.hidden for option in parameter.opts}
        assert not hidden & set(shown.split())
    assert "<bool>" not in cli("db", "start", "--help").stdout
    assert "the [spark] extra" in message(cli("analyze", "--help").stdout)
