"""The pages of ``docs/reference/``: what the program says of itself, as Markdown.

``python -m tests.test_docs`` writes the folder anew. No page of it is written by hand, and none counts as text that a
person has to read.
"""

from __future__ import annotations

import ast
import json
from functools import cache, partial
from itertools import groupby
from typing import TYPE_CHECKING, Any

import typer

from rosprivacy.analysis.bounds import BOUNDS, COUNTED
from rosprivacy.analysis.model import RANKS
from rosprivacy.analysis.python_311 import StrEnum
from rosprivacy.cli.app import program
from rosprivacy.cli.exit_code import CODES
from rosprivacy.cli.inputs import WRITTEN
from rosprivacy.cli.options import QUESTION_PANEL, READ
from rosprivacy.formats import FORMATS
from rosprivacy.ingest.lint import RULES
from rosprivacy.ingest.neo4j_graph.schema import NODES, RELATIONSHIPS, Property
from rosprivacy.ontology.vocabulary import TOP, load
from rosprivacy.queries.library import pack
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.tables import TABLES
from rosprivacy.report.page.edpb_questions import QUESTIONS, Origin
from rosprivacy.report.text import categories
from tests.fuzzing import record
from tests.helpers import contract
from tests.helpers.house import PACKAGE, ROOMS, WINGS
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

FOLDER = ROOT / "docs" / "reference"
FUZZED = ROOT / "tests" / "fuzzing" / "record.json"
WRITTEN_BY = "Written by `python -m tests.test_docs` from the program; do not edit.\n"
COMMANDS = """\
A command line has a command, what it reads, and options: `rosprivacy analyze robot.policy.xml -l labels.yaml`.
`rosprivacy --install-completion` teaches the names to your shell.

"""
EXIT_CODES = "## Exit codes\n\n"
MATRIX = """
## What is read

The same options mean the same in every command. Where one makes no sense, the command says so and ends with 2.
`decide` has a `--category` and a `--decisions` of its own.

"""
BOUNDED = """
## Bounds

What an input may press on. Above a bound the message says how much there is, and `--bound NAME=N` sets another one. No
system known to us meets one. `--max-paths` bounds the list of paths.

"""
GRAPH = """\
`rosprivacy load` writes this graph ([the database](../database.md)). `carries` and `pseudonymised`, like the labels,
name broader kinds too; the other lists name kinds exactly.

"""
QUERIES = """\
`rosprivacy query NAME` asks one, with `parameter=value` behind it. A parameter in brackets may be left out.
[The database](../database.md) tells how.

"""
FORMATS_OF = """\
`--format NAME` of [`analyze`](commands/analyze.md) and [`report`](commands/report.md).
[Formats](../formats.md) tells for whom each is.

"""
TABLES_OF = "\n## Tables\n\n`rosprivacy analyze --tables FOLDER` and `result.tables()` in Python.\n\n"
KINDS = """\
Each line has the name, the English title, the identity factors, and what Article 9(1) and Article 10 say of it.
[Kinds of data](../categories.md) explains these.

"""
DOUBTS = """\
What breaks makes the verdict undetermined at best. What rides is named in the verdict's sentence.
[Decisions](../decisions.md#doubts) tells how a person accepts one.

"""
LINT = "[`rosprivacy lint`](../lint.md) looks for these.\n\n"
EDPB = "`rosprivacy report --format edpb-dpia` writes them ([the page of it](../edpb.md)).\n\n"
HOUSE = "Every folder of the program. [Architecture](../architecture.md) tells how data goes through them.\n\n"
FUZZING = "How it is done, and what must hold of each input: [security](../security.md#fuzzing).\n\n"


def pages() -> dict[Path, Callable[[], str]]:
    """Each page of the reference, and what makes it."""
    named: dict[str, Callable[[], str]] = {
        "index": index,
        "commands": commands,
        "graph": graph,
        "queries": queries,
        "formats": formats,
        "categories": kinds_of_data,
        "doubts": doubts,
        "lint": lint,
        "edpb": edpb,
        "house": house,
        "fuzzing": fuzzing,
        "documents": lambda: contract.index(WRITTEN_BY),
        **{f"commands/{name}": partial(command_page, name) for name in command_group()},
        **{f"documents/{name}": partial(contract.page, name, WRITTEN_BY) for name in contract.DOCUMENTS},
    }
    return {FOLDER / f"{name}.md": make for name, make in named.items()}


def page(title: str, *parts: str) -> str:
    return "\n".join([f"# {title}\n", WRITTEN_BY, "".join(parts)])


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    cells = ((cell.replace("|", r"\|") for cell in line) for line in lines)
    return "".join(f"|{'|'.join(f' {cell} ' if cell else ' ' for cell in line)}|\n" for line in cells)


def index() -> str:
    """The pages of the folder; those of a command or a document stand on the page of all of them."""
    rows = (
        ("[Commands](commands.md)", "every command and option, exit codes, bounds"),
        ("[JSON documents](documents.md)", "every field of what `--format json` prints"),
        ("[Formats and tables](formats.md)", "every format, and the columns of the tables"),
        ("[Graph](graph.md)", "labels, relationships and properties in Neo4j"),
        ("[Queries](queries.md)", "the questions that come with the program, with their parameters"),
        ("[Kinds of data](categories.md)", "the tree of all kinds that come with the program"),
        ("[Doubts](doubts.md)", "what is not known, with its rank and what to do"),
        ("[Lint](lint.md)", "the rules, and what comes of breaking them"),
        ("[The EDPB's template](edpb.md)", "its questions, and where each answer comes from"),
        ("[The house](house.md)", "the folders of the program, and what each may import"),
        ("[Fuzzing](fuzzing.md)", "the record of hostile inputs"),
    )
    return page("Reference", table(("page", "what it has"), rows))


@cache
def command_group() -> dict[str, Any]:
    """The commands by name, made once."""
    group: Any = typer.main.get_command(program())
    return dict(group.commands)


def commands() -> str:
    """All commands, what they end with, what they read, and what is bounded."""
    group = command_group()
    first = {name: " ".join(command.help.split("\n\n")[0].split()) for name, command in group.items()}
    listed = table(
        ("command", "what it does"), ((f"[`{name}`](commands/{name}.md)", what) for name, what in first.items())
    )
    codes = table(("code", "meaning"), ((str(code), meaning) for code, meaning in CODES.items()))
    bounds = table(
        ("name", "default", "of what"),
        ((f"`{name}`", f"{getattr(BOUNDS, name):,}", what) for name, what in COUNTED.items()),
    )
    return page("The command line", COMMANDS, listed, "\n", EXIT_CODES, codes, MATRIX, matrix(group), BOUNDED, bounds)


def matrix(group: dict[str, Any]) -> str:
    """Which command takes which of the shared options."""
    taken = {name: set(shared_options(command)) for name, command in group.items()}
    columns = [name for name in group if taken[name]]
    rows = (
        [f"`{written}`", *("x" if name in taken[one] else "" for one in columns)] for name, written in WRITTEN.items()
    )
    return table(["", *columns], rows)


def shared_options(command: Any) -> Iterator[str]:
    """The options of a command that mean what they mean everywhere; some commands have others of the same name."""
    for parameter in getattr(command, "params", ()):
        panel = getattr(parameter, "rich_help_panel", None)
        if not parameter.hidden and (panel in (READ, QUESTION_PANEL) or parameter.metavar == "POLICY"):
            yield from {parameter.name} & WRITTEN.keys()


def command_page(name: str) -> str:
    """A command with its options; of a group each of its commands."""
    command = command_group()[name]
    parts = [f"{command.help}\n"]
    if inner := getattr(command, "commands", {}):
        for each, one in sorted(inner.items()):
            parts += [f"\n## rosprivacy {name} {each}\n\n{one.help}\n", options(one)]
    else:
        parts.append(options(command))
    return page(f"rosprivacy {name}", *parts)


def options(command: Any) -> str:
    """The options of a command with their defaults, as the program knows them; empty if it has none."""
    rows = []
    for parameter in (each for each in command.params if not getattr(each, "hidden", False)):
        names = ", ".join(f"`{option}`" for option in parameter.opts + parameter.secondary_opts)
        argument = parameter.param_type_name == "argument"
        default = parameter.default
        if isinstance(default, bool) or default in (None, ()):
            default = ""
        values = f" One of {', '.join(type(default))}." if isinstance(default, StrEnum) else ""
        meaning = (getattr(parameter, "help", "") or "").replace("\\[", "[")  # rich's way to write a bracket
        rows.append((f"`{parameter.metavar or parameter.name}`" if argument else names, str(default), meaning + values))
    return "\n" + table(("option", "default", "meaning"), rows) if rows else ""


def graph() -> str:
    """The schema that the program loads by; relationships with the same properties stand above one table."""
    parts = [GRAPH, "## Nodes\n"]
    for node in NODES:
        labels = f" Further labels: {node.labels}." if node.labels else ""
        parts += [f"\n### {node.label}\n\n{node.meaning}{labels}\n\n", properties(node.properties)]
    parts.append("\n## Relationships\n")
    for held, kinds in groupby(RELATIONSHIPS, key=lambda kind: kind.properties):
        parts += [f"\n**`(:{kind.source})-[:{kind.type}]->(:{kind.target})`** {kind.meaning}\n" for kind in kinds]
        parts += ["\n", properties(held)] if held else []
    return page("The graph in Neo4j", *parts)


def properties(held: tuple[Property, ...]) -> str:
    return table(("property", "type", "meaning"), ((f"`{one.name}`", one.type, one.meaning) for one in held))


def queries() -> str:
    """The questions of the query pack, from the headers of its files."""
    rows = []
    for query in pack().values():
        names = (f"`{one.name}`" if one.default is None else f"[`{one.name}`]" for one in query.parameters)
        drawn = " Can be drawn." if query.drawable else ""
        rows.append((f"`{query.name}`", ", ".join(names), query.description + drawn))
    return page("Queries", QUERIES, table(("query", "parameters", "question"), rows))


def formats() -> str:
    """The formats with their options, and the columns of the tables."""
    listed = (
        (
            f"`{name}`",
            f"`{one.suffix}`",
            ", ".join(f"`{style}`" for style in one.styles),
            "yes" if one.both_views else "no",
        )
        for name, one in FORMATS.items()
    )
    columns = ((f"`{name}`", f"`{column}`", what) for name, of in TABLES.items() for column, what in of.items())
    return page(
        "Formats and tables",
        FORMATS_OF,
        table(("format", "file", "settings that it heeds", "tells both views"), listed),
        TABLES_OF,
        table(("table", "column", "meaning"), columns),
    )


def kinds_of_data() -> str:
    """The tree as the program prints it."""
    return page("All kinds of data", KINDS, f"```text\n{categories.tree(load(), TOP)}```\n")


def doubts() -> str:
    """Each sort of doubt with its rank, and what to do."""
    rows = (
        (f"`{name}`", str(rank), IN_ENGLISH(f"doubt.{name}.title"), IN_ENGLISH(f"doubt.{name}.do"))
        for name, rank in RANKS.items()
    )
    return page("Doubts", DOUBTS, table(("doubt", "rank", "what it is", "what to do"), rows))


def lint() -> str:
    """The rules of ``rosprivacy lint``."""
    rows = ((f"`{rule.name}`", rule.severity, as_text(rule.about), as_text(rule.why)) for rule in RULES.values())
    return page("Lint", LINT, table(("rule", "severity", "broken by", "what comes of it"), rows))


def as_text(text: str) -> str:
    return text.replace("*", r"\*").replace("<", "&lt;")


def edpb() -> str:
    """The questions of the EDPB's template: how many by origin, and where each answer comes from."""
    origins = {origin: IN_ENGLISH(f"edpb.origin.{origin}") for origin in Origin}
    counts = ((title, str(sum(one.origin is origin for one in QUESTIONS))) for origin, title in origins.items())
    rows = []
    for one in QUESTIONS:
        fields = (*one.columns, *([one.answer] if one.answer else []), *(f"risk.….{field}" for field in one.risks))
        about = ", ".join([*([one.fact] if one.fact else []), *(f"`{field}`" for field in fields)])
        rows.append((one.number, IN_ENGLISH(one.words), origins[one.origin], about))
    head = ("part", "question", "answer", "columns of the register, what the analysis says, fields of the assessment")
    return page("The EDPB's template", EDPB, table(("answer", "questions"), counts), "\n", table(head, rows))


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
    return page("The house", HOUSE, table(("folder", "what it is", "may import"), rows))


def house_row(folder: Path, may: str) -> tuple[str, str, str]:
    first = (ast.get_docstring(ast.parse((folder / "__init__.py").read_text("utf-8"))) or "").split("\n\n")[0]
    return f"`{folder.relative_to(ROOT)}/`", " ".join(first.split()).replace("``", "`"), may


def fuzzing() -> str:
    """The record of the last run that was kept."""
    return page("Fuzzing", FUZZING, record.table(json.loads(FUZZED.read_text("utf-8"))))
