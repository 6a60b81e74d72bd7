"""JSON for users is written in one place, and nothing in it can play with a terminal."""

from __future__ import annotations

import ast
import json
import tracemalloc
from typing import TYPE_CHECKING

import pytest

from rosprivacy.report.json_text import as_text, in_pieces
from tests.helpers.command import Cli, cli
from tests.helpers.fleet_files import policy
from tests.helpers.house import ROOMS, parsed
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["cli"]

# C1, ends of lines of Unicode, and all that turn the direction of writing (Unicode 16, UAX 9).
ODD = [
    *map(chr, range(0x7F, 0xA0)), "\u2028", "\u2029", "\u061c", "\u200e", "\u200f",
    *map(chr, range(0x202A, 0x202F)), *map(chr, range(0x2066, 0x206A)),
]  # fmt: skip
LABELS = 'labels: 1\nnodes:\n  /camera: {source: [Voice]}\n  /uplink: {leak: [Voice], note: "a\\u009B\\u202Eb"}\n'


def test_the_value_stays_and_the_text_is_printable() -> None:
    value = {"".join(ODD): ["é 人 😀", "\udc80", *ODD]}
    text = as_text(value)
    assert json.loads(text) == value
    assert text.replace("\n", "").isprintable()
    assert "é 人 😀" in text  # letters are for people


@pytest.mark.slow
def test_a_large_document_is_not_in_memory_as_text() -> None:
    """At e6bf35d the text was there three times, and each of its tokens by itself."""
    value = [{"name": f"/camera{number}", "steps": [number, "é"]} for number in range(30_000)]
    tracemalloc.start()
    size = sum(map(len, in_pieces(value)))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert size == len(as_text(value)) > 2_000_000
    assert most < size / 4


@pytest.mark.parametrize(
    "arguments",
    [
        ["analyze", "-f", "json"], ["analyze", "-f", "sarif"], ["analyze", "-f", "cnil-pia"],
        ["analyze", "-f", "json-ld"], ["analyze", "-f", "turtle"], ["analyze", "--per-policy", "-f", "json"],
        ["mitigate", "-f", "json"], ["why-not", "/camera", "/uplink", "-f", "json"],
    ],
)  # fmt: skip
def test_no_command_writes_a_sign_that_cannot_be_printed(cli: Cli, tmp_path: Path, arguments: list[str]) -> None:
    """In an earlier version ``analyze -f json`` and ``-f sarif`` have them raw (U+009B and U+202E)."""
    topic = "/audio" + "".join(ODD[1:])
    (tmp_path / "p.policy.xml").write_text(policy(f"/camera>{topic}", f"/uplink<{topic}"), "utf-8")
    (tmp_path / "l.yaml").write_text(LABELS, "utf-8")
    command, *options = arguments
    elements = [one for one in options if one in ("/camera", "/uplink")]
    options = [one for one in options if one not in elements]
    done = cli(command, *elements, "p.policy.xml", "-l", "l.yaml", *options, cwd=tmp_path)
    assert done.stdout.startswith(("{", "@prefix")), done.stderr
    assert r"\u202" in done.stdout.casefold()
    assert all(line.isprintable() for line in done.stdout.split("\n"))


@pytest.mark.slow
def test_json_and_csv_for_users_are_written_in_one_place_each() -> None:
    """Any other that leaves signs as they are (``ensure_ascii=False``) says here what it is for."""
    raw, csv = set(), set()
    for file in (path for room in [*ROOMS, "src/rosprivacy"] for path in (ROOT / room).rglob("*.py")):
        place = file.resolve().relative_to(ROOT).as_posix()
        for node in ast.walk(parsed(file.resolve())):
            if isinstance(node, ast.keyword) and node.arg == "ensure_ascii":
                raw.add(place)
            if isinstance(node, ast.Import) and any(name.name == "csv" for name in node.names):
                csv.add(place)
    assert csv == {"report/spreadsheet.py"}
    assert raw - {"report/json_text.py"} == {
        "ingest/decisions/decision_chain.py",  # a line of the log, which is hashed as it is written
        "ingest/labels/label_file.py",  # read again at once
        "ingest/labels/label_writer.py",  # a label file of the user's, written back
        "src/rosprivacy/cli/init.py",  # names in a project file, which are printable, and an author that is made so
        "report/rdf/serialise.py",  # a literal of Turtle, made printable with its file
        "report/rdf/findings.py",  # a text in linked data
        "report/rdf/redacted.py",  # a value, looked up in what is replaced
        "ingest/neo4j_graph/bag_rows.py",  # a property in the database
        "queries/run.py",  # a cell of a table
        "queries/saved.py",  # our own questions
    }
