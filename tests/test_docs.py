"""The documentation says what is true: its commands run, its label files are read, its option tables are the code's.

``python -m tests.test_docs`` writes what is generated anew: tables, ``docs/command-line.md``, the JSON schemas of the
documents and ``docs/documents.md``.
"""

from __future__ import annotations

import ast
import doctest
import json
import re
import shlex
import shutil
from functools import partial
from typing import TYPE_CHECKING, Any

import pytest
import typer

import rosprivacy
from rosprivacy.analysis.bounds import BOUNDS, COUNTED
from rosprivacy.analysis.model import NON_ROS, RANKS
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.app import program
from rosprivacy.cli.exit_code import CODES
from rosprivacy.cli.inputs import WRITTEN
from rosprivacy.cli.options import QUESTION_PANEL, READ
from rosprivacy.ingest.labels.keywords import CHANNEL, KEYWORDS, NODE, rows
from rosprivacy.ingest.labels.label_file import read_labels
from rosprivacy.ingest.lint import RULES
from rosprivacy.ingest.neo4j_graph.schema import NODES, RELATIONSHIPS, Property
from rosprivacy.ontology.vocabulary import TOP, load
from rosprivacy.queries.library import pack
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.tables import TABLES
from rosprivacy.report.page.edpb_questions import QUESTIONS, Origin
from rosprivacy.report.text import categories
from tests.fuzzing import record
from tests.fuzzing.targets import TARGETS
from tests.helpers import contract
from tests.helpers.docs import CATEGORIES, blocks
from tests.helpers.house import MODULES, PACKAGE, ROOMS, WINGS
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from tests.helpers.command import Cli

ARCHITECTURE = ROOT / "docs" / "architecture.md"
COMMAND_LINE = ROOT / "docs" / "command-line.md"
DATABASE = ROOT / "docs" / "database.md"
FORMATS_PAGE = ROOT / "docs" / "formats.md"
LABELS = ROOT / "docs" / "labels.md"
LINT = ROOT / "docs" / "lint.md"
EDPB = ROOT / "docs" / "edpb.md"
DECISIONS = ROOT / "docs" / "decisions.md"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]
NEEDS_SERVER = ("load", "query", "db", "explore")  # their tests are those of the database; the last is one itself
SECURITY = ROOT / "docs" / "security.md"
FUZZED = ROOT / "tests" / "fuzzing" / "record.json"
PAGES.append(ROOT / "SECURITY.md")

HEAD = """\
# The command line

Written by `python -m tests.test_docs` from the program; do not edit.

Shell completion: `rosprivacy --install-completion`.

"""
EXIT_CODES = "\n".join(
    ["| code | meaning |", "| --- | --- |", *(f"| {code} | {meaning} |" for code, meaning in CODES.items()), ""]
)

MATRIX = """
## What is read

The same options mean the same in every command. Where one makes no sense, the command says so and ends with 2.
`decide` has a `--category` and a `--decisions` of its own.
"""


BOUNDED = """
## Bounds

What an input may press on. Above a bound the message says how much there is, and `--bound NAME=N` sets another one; no
system known to us meets one. The list of ways is bounded by `--max-paths`.

| name | default | of what |
| --- | --- | --- |
"""


def command_line() -> str:
    """The options of every command, as the program knows them."""
    group: Any = typer.main.get_command(program())
    text = HEAD + EXIT_CODES + matrix(group.commands) + bounds()
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            rows = [f"| `rosprivacy {name} {n}` | {c.help} |" for n, c in sorted(command.commands.items())]
            lines = ["", f"## rosprivacy {name}", "", command.help, "", "| command | |", "| --- | --- |", *rows, ""]
            text += "\n".join(lines)
            continue
        text += f"\n## rosprivacy {name}\n\n{command.help}\n\n| option | default | meaning |\n| --- | --- | --- |\n"
        for parameter in (each for each in command.params if not getattr(each, "hidden", False)):
            names = ", ".join(f"`{option}`" for option in parameter.opts + parameter.secondary_opts)
            shown = f"`{parameter.metavar}`" if parameter.param_type_name == "argument" else names
            default = parameter.default
            if isinstance(default, bool) or default in (None, ()):
                default = ""
            values = f" One of {', '.join(type(default))}." if isinstance(default, StrEnum) else ""
            meaning = (getattr(parameter, "help", "") or "").replace("\\[", "[")  # rich's way to write a bracket
            text += f"| {shown} | {default} | {meaning}{values} |\n"
    return text


def bounds() -> str:
    """What is bounded, by default."""
    return BOUNDED + "".join(f"| `{name}` | {getattr(BOUNDS, name):,} | {what} |\n" for name, what in COUNTED.items())


def matrix(commands: dict[str, Any]) -> str:
    """Which command takes which of the shared options."""
    taken = {name: set(shared_options(command)) for name, command in commands.items()}
    columns = [name for name in commands if taken[name]]
    lines = [f"| | {' | '.join(columns)} |", f"| --- |{' --- |' * len(columns)}"]
    for option, written in WRITTEN.items():
        crosses = ("x" if option in taken[name] else "" for name in columns)
        lines.append(f"| `{written}` | {' | '.join(crosses)} |")
    return "\n".join([MATRIX, *lines, ""])


def shared_options(command: Any) -> Iterator[str]:
    """The options of a command that mean what they mean everywhere; some commands have others of the same name."""
    for parameter in getattr(command, "params", ()):
        panel = getattr(parameter, "rich_help_panel", None)
        if not parameter.hidden and (panel in (READ, QUESTION_PANEL) or parameter.metavar == "POLICY"):
            yield from {parameter.name} & WRITTEN.keys()


def schema_tables() -> str:
    """The tables of docs/database.md, from the schema that the program loads by."""
    lines = []
    for node in NODES:
        labels = f" Further labels: {node.labels}." if node.labels else ""
        lines += [f"**`(:{node.label})`** {node.meaning}{labels}", "", *property_rows(node.properties), ""]
    for kind in RELATIONSHIPS:
        lines += [f"**`(:{kind.source})-[:{kind.type}]->(:{kind.target})`** {kind.meaning}", ""]
        lines += [*property_rows(kind.properties), ""] if kind.properties else []
    return "\n".join(lines)


def property_rows(properties: tuple[Property, ...]) -> list[str]:
    rows = [f"| `{p.name}` | {p.type} | {p.meaning} |" for p in properties]
    return ["| property | type | meaning |", "| --- | --- | --- |", *rows]


def query_table() -> str:
    """The table of the query pack in docs/database.md, from the headers of the files."""
    rows = []
    for query in pack().values():
        parameters = ", ".join(f"`{p.name}`" if p.default is None else f"[`{p.name}`]" for p in query.parameters)
        drawn = " Can be drawn." if query.drawable else ""
        rows.append(f"| `{query.name}` | {parameters} | {query.description}{drawn} |")
    return "\n".join(["| query | parameters | question |", "| --- | --- | --- |", *rows, ""])


def with_parts(text: str, **parts: str) -> str:
    """A page with its generated parts anew."""
    for name, part in parts.items():
        before, after = text.split(f"<!-- {name}: written by python -m tests.test_docs -->\n")
        text = f"{before}<!-- {name}: written by python -m tests.test_docs -->\n{part}<!-- end -->\n"
        text += after.split("<!-- end -->\n", 1)[1]
    return text


def database_page(text: str) -> str:
    return with_parts(text, schema=schema_tables(), queries=query_table())


def lint_page(text: str) -> str:
    rows = [f"| `{rule.name}` | {rule.severity} | {rule.about} | {rule.why} |" for rule in RULES.values()]
    head = ["| rule | severity | broken by | what comes of it |", "| --- | --- | --- | --- |"]
    return with_parts(text, rules="\n".join([*head, *rows, ""]).replace("*", r"\*").replace("<", "&lt;"))


def security_page(text: str) -> str:
    return with_parts(text, fuzzing=record.table(json.loads(FUZZED.read_text("utf-8"))))


def edpb_page(text: str) -> str:
    """The page with the questions of the EDPB's template: how many by origin, and where each answer comes from."""
    counts = [
        f"| {IN_ENGLISH(f'edpb.origin.{origin}')} | {sum(one.origin is origin for one in QUESTIONS)} |"
        for origin in Origin
    ]
    rows = []
    for one in QUESTIONS:
        fields = (*one.columns, *([one.answer] if one.answer else []), *(f"risk.….{field}" for field in one.risks))
        about = ", ".join([*([one.fact] if one.fact else []), *(f"`{field}`" for field in fields)])
        rows.append(f"| {one.number} | {IN_ENGLISH(one.words)} | {IN_ENGLISH(f'edpb.origin.{one.origin}')} | {about} |")
    head = ["| part | question | answer | columns of the register, what the analysis says, fields of the assessment |"]
    parts = ["| answer | questions |", "| --- | --- |", *counts, "", *head, "| --- | --- | --- | --- |", *rows, ""]
    return with_parts(text, questions="\n".join(parts))


def decisions_page(text: str) -> str:
    """The page with the table of doubts: each sort with its rank, and what to do."""
    rows = [
        f"| `{name}` | {rank} | {IN_ENGLISH(f'doubt.{name}.title')} | {IN_ENGLISH(f'doubt.{name}.do')} |"
        for name, rank in RANKS.items()
    ]
    head = ["| doubt | rank | what it is | what to do |", "| --- | --- | --- | --- |"]
    return with_parts(text, doubts="\n".join([*head, *rows, ""]))


def labels_page(text: str) -> str:
    """The page with the tables of keywords: of nodes, of channels, and the facts of elements outside ROS."""
    head = ["| label | meaning |", "| --- | --- |"]
    nodes, channels = (
        "\n".join([*head, *(f"| {written} | {meaning} |" for one in KEYWORDS if where in one.where
                           for written, meaning in rows(one.docs)), ""])
        for where in (NODE, CHANNEL)
    )  # fmt: skip
    facts = ["| fact | of | meaning |", "| --- | --- | --- |"]
    for one in (one for one in KEYWORDS if set(one.where) <= set(NON_ROS)):
        of = "all" if one.where == NON_ROS else ", ".join(one.where).replace("-", " ")
        facts += [f"| {written} | {of} | {meaning} |" for written, meaning in rows(one.docs)]
    return with_parts(text, nodes=nodes, channels=channels, facts="\n".join([*facts, ""]))


def house() -> str:
    """The rooms and their wings, with what each of them says of itself and may import."""
    rows = []
    for room in (*ROOMS, "rosprivacy"):
        folder = PACKAGE if room == "rosprivacy" else ROOT / room
        others = "every room" if room == "rosprivacy" else ", ".join(sorted(ROOMS[room])) or "no other room"
        rows.append(house_row(folder, others))
        ladder = sorted((len(below), wing, sorted(below - {""})) for wing, below in WINGS[room].items())
        for _, wing, below in ladder:
            if wing and (folder / wing / "__init__.py").is_file():
                rows.append(house_row(folder / wing, f"of its room: {', '.join(below) or 'no other wing'}"))
                inner = sorted(file.parent for file in (folder / wing).rglob("*/__init__.py"))
                rows += [house_row(one, "as its wing") for one in inner]
    return "\n".join(["| folder | what it is | may import |", "| --- | --- | --- |", *rows, ""])


def house_row(folder: Path, may: str) -> str:
    said = (ast.get_docstring(ast.parse((folder / "__init__.py").read_text("utf-8"))) or "").split("\n\n")[0]
    return f"| `{folder.relative_to(ROOT)}/` | {' '.join(said.split()).replace('``', '`')} | {may} |"


def schema_text(document: Any, earlier: str) -> str:
    """The schema of a document, whatever stood there before."""
    del earlier
    return contract.text(document)


def formats_page(text: str) -> str:
    """The page with the columns of the tables."""
    rows = [f"| `{table}` | `{column}` | {meaning} |" for table, of in TABLES.items() for column, meaning in of.items()]
    return with_parts(text, tables="\n".join(["| table | column | meaning |", "| --- | --- | --- |", *rows, ""]))


def categories_page(text: str) -> str:
    """The page with the tree as the program prints it."""
    tree = f"```text\n{categories.tree(load(), TOP)}```"
    return re.sub(r"```text\n.*?```", lambda _: tree, text, count=1, flags=re.DOTALL)


GENERATED: dict[Path, Callable[[str], str]] = {
    ARCHITECTURE: lambda text: with_parts(text, house=house()),
    CATEGORIES: categories_page,
    COMMAND_LINE: lambda _: command_line(),
    DATABASE: database_page,
    DECISIONS: decisions_page,
    EDPB: edpb_page,
    FORMATS_PAGE: formats_page,
    LABELS: labels_page,
    LINT: lint_page,
    SECURITY: security_page,
    contract.PAGE: lambda _: contract.page(),
    **{contract.file_of(name): partial(schema_text, document) for name, document in contract.DOCUMENTS.items()},
}


@pytest.mark.parametrize("file", GENERATED, ids=lambda file: str(file.name))
def test_what_is_generated_is_that_of_the_program(file: Path) -> None:
    text = file.read_text("utf-8")
    assert text == GENERATED[file](text), "python -m tests.test_docs"


def test_the_house_names_every_folder() -> None:
    folders = {f"`{file.parent.relative_to(ROOT)}/`" for file in MODULES.values()}
    assert folders <= set(re.findall(r"`[\w/]+/`", ARCHITECTURE.read_text("utf-8")))


def test_what_the_architecture_names_is_there() -> None:
    """Files, and after a colon what they define."""
    named = re.findall(r"`((?:[\w.-]+/)+[\w.-]+\.\w+)(?::(\w+))?`", ARCHITECTURE.read_text("utf-8"))
    assert len(named) > 30
    for file, name in named:
        assert (ROOT / file).is_file(), file
        assert not name or re.search(rf"\b(def|class) {name}\b", (ROOT / file).read_text("utf-8")), (file, name)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.name))
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text("utf-8")):
        assert target.startswith("http") or (page.parent / target).exists(), target


@pytest.mark.parametrize("page", [ROOT / "README.md", ROOT / "docs" / "labels.md"], ids=lambda page: str(page.name))
def test_the_label_files_that_are_shown_are_read(page: Path, tmp_path: Path) -> None:
    found = [block for block in blocks(page, "yaml") if block.startswith("labels:")]
    assert found
    for block in found:
        file = tmp_path / "labels.yaml"
        file.write_text(block)
        assert read_labels(str(file), load()).entries


@pytest.mark.slow
def test_what_is_shown_of_python_is_what_it_prints(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    page = ROOT / "docs" / "python.md"
    code = "".join(blocks(page, "pycon"))
    shown: list[str] = []
    runner = doctest.DocTestRunner()
    ran = runner.run(doctest.DocTestParser().get_doctest(code, {}, page.name, str(page), 0), out=shown.append)
    assert (ran.failed, "".join(shown)) == (0, "")
    assert ran.attempted > 20


def test_the_readmes_first_finding_is_what_is_printed(cli: Cli) -> None:
    (command,) = [line for line in blocks(ROOT / "README.md", "console")[1].splitlines() if line]
    program, *arguments = command.split()
    done = cli(*arguments, cwd=ROOT)
    assert (program, done.returncode) == ("rosprivacy", 1)
    (shown,) = [block for block in blocks(ROOT / "README.md", "text") if block.startswith("leak:")]
    for line in shown.splitlines():
        assert line == "…" or line in done.stdout.splitlines(), line


@pytest.mark.slow
def test_the_readmes_commands_run_as_they_stand_there(cli: Cli, tmp_path: Path) -> None:
    """In their order, in one folder, with a policy, the examples and an environment as a reader has them."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    shutil.copytree(ROOT / "examples" / "factory", tmp_path, dirs_exist_ok=True)
    for name in ("my_robot", "old", "new"):
        shutil.copy(tmp_path / "before.policy.xml", tmp_path / f"{name}.policy.xml")
    lines = [line for block in blocks(ROOT / "README.md", "console") for line in block.splitlines()]
    ran = {}
    for line in lines:
        program, *arguments = shlex.split(line, comments=True)
        if program == "rosprivacy" and arguments[0] not in NEEDS_SERVER:
            done = cli(*arguments, cwd=tmp_path)
            ran[arguments[0]] = done.returncode
            assert done.returncode in (0, 1, 4), (line, done.stderr)
    assert ran.keys() == {"analyze", "try", "init", "labels", "mitigate", "report", "graph", "diff"}
    assert (tmp_path / "report.html").stat().st_size > 10_000


@pytest.mark.slow
def test_the_first_hour_goes_as_its_page_says(cli: Cli, tmp_path: Path) -> None:
    page = ROOT / "docs" / "first-hour.md"
    shutil.copy(ROOT / "examples" / "telepresence" / "graph.txt", tmp_path)
    codes, answers = {}, []
    for line in [line for block in blocks(page, "console") for line in block.splitlines()]:
        program, *words = shlex.split(line)
        done = cli(*words, cwd=tmp_path)
        assert program == "rosprivacy"
        codes[words[0]] = done.returncode
        answers.append(done.stdout)
    assert codes == {"try": 4, "init": 0, "labels": 0, "analyze": 1, "mitigate": 0, "report": 0, "diff": 0}
    (shown,) = blocks(page, "text")
    assert shown in answers[0]
    assert {file.name for file in tmp_path.iterdir()} >= {"robot.types.yaml", "rosprivacy.toml", "report.html"}


def test_every_id_in_the_readme_is_of_the_system_that_it_analyses() -> None:
    folder = ROOT / "examples" / "factory"
    document = rosprivacy.analyze(str(folder / "before.policy.xml"), str(folder / "run2.labels.yaml")).document()
    known = [finding["id"] for finding in document["findings"]]
    named = re.findall(r"\b(?=[a-f]*\d)(?=\d*[a-f])[0-9a-f]{4,16}\b", (ROOT / "README.md").read_text("utf-8"))
    assert named
    assert not [one for one in named if not any(full.startswith(one) for full in known)]


@pytest.mark.slow
@pytest.mark.parametrize("block", blocks(ROOT / "docs" / "categories.md", "turtle"))
def test_the_ontologies_that_are_shown_are_read(block: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.ttl"
    file.write_text(block, "utf-8")
    found = load(tmp_path / "cache", [str(file)])
    assert len(found.categories) > len(load().categories)


def test_the_record_of_the_fuzzing_has_each_reader() -> None:
    targets = json.loads(FUZZED.read_text("utf-8"))["targets"]
    assert {name for name, counts in targets.items() if counts["inputs"]} == TARGETS.keys()


def test_what_holds_a_promise_is_there() -> None:
    """docs/security.md names a test or a file for each promise."""
    named = re.findall(r"`((?:[\w.-]+/)+[\w.-]+\.\w+)(?:::(\w+))?`", SECURITY.read_text("utf-8"))
    assert len(named) > 20
    for file, test in named:
        assert not test or f"def {test}(" in (ROOT / file).read_text("utf-8"), (file, test)
        assert (ROOT / file).is_file(), file


def test_the_readme_is_for_a_person_in_a_hurry() -> None:
    assert len((ROOT / "README.md").read_text("utf-8").split()) <= 900


def test_the_page_of_labels_has_every_keyword() -> None:
    assert all(f"`{one.name}" in LABELS.read_text("utf-8") for one in KEYWORDS)


def test_no_registry_is_named() -> None:
    """Mirrors are the user's own configuration."""
    for page in PAGES:
        assert not re.search(r"pypi\.org|pythonhosted|repo1?\.maven|registry\.npmjs", page.read_text("utf-8"))


if __name__ == "__main__":
    for generated, anew in GENERATED.items():
        generated.write_text(anew(generated.read_text("utf-8")), "utf-8")
