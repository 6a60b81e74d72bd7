"""Choices -> ontologies, saved analyses, results in Parquet, queries, durations and names."""

from __future__ import annotations

import json
from contextlib import suppress
from functools import cache
from io import BytesIO
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.ingest.neo4j_graph.fleet_rows import robot_rows
from rosprivacy.ingest.neo4j_graph.rows import rows_of
from rosprivacy.parts.parquet import FORMAT, PARTS
from rosprivacy.queries.library import pack
from tests.fuzzing.words import DURATIONS, ODD_TEXT, with_fault

if TYPE_CHECKING:
    from random import Random

    from tests.fuzzing.choices import Choices

DAY = "2026-01-01"
PREFIXES = """\
@prefix : <urn:e:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix pd: <https://w3id.org/dpv/pd#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
"""
PARENTS = ("rp:Health", "rp:Video", "rp:PersonalData", "rp:Location , rp:Household", ":VisitorToken", "rp:Nowhere")
SAID = (
    'skos:altLabel "badge no."@en', 'skos:prefLabel "Ausweis"@de', 'rp:dataType "text"', 'skos:note "x"@en',
    'rp:article9 "no" ; rp:reason "none"@en ; rp:source rp:GDPR-9-1', "skos:exactMatch pd:Name",
    'rp:fallsUnder [ rp:provision rp:GDPR-9-1 ; rp:verdict "always" ; rp:source rp:GDPR-9-1 ]',
    "rp:gdprCategory rp:GDPR-4-1",
    "skos:narrower rp:Video", "<urn:e:q> 1.5", "skos:broader pd:Identifying", 'skos:altLabel "voice"@en',
)  # fmt: skip
QUERY_WORDS = (
    "string", "integer", "boolean", "list of string", "robot", "category", ", default ", '""', "1", "true", "//",
    "order",
    "RETURN", "ORDER BY", "$category", "{", "}", "(", "'", "/*", "*/", " AS ", ",", "\n", "SET",
    "// param x: string, y\n",
)  # fmt: skip
UNITS = ("Y", "M", "D", "W", "T", "H", "S", "P", "-", "+", ".", ",", " ", "٣")
PIECES = ("/", "*", "?", "[a-c]", "[!a]", "[", "]", "a", "b", "ab", "~", "-", "{", "=", "\\", "é")


def ontology(choices: Choices) -> dict[str, str]:
    concepts = []
    for name in ("VisitorToken", "GaitTrace")[: 1 + choices.below(2)]:
        label = f'rp:label "{name}"' if not choices.once_in(8) else "skos:inScheme rp:Categories"
        said = [label, f"skos:broader {choices.pick(PARENTS[: 6 if choices.once_in(6) else 4])}"]
        said += [f'skos:prefLabel "{name.lower()} seen"@en', f'skos:definition "A {name}."@en']
        said += choices.some(SAID[: len(SAID) if choices.once_in(3) else 5], most=2)
        concepts.append(f":{name} a skos:Concept ;\n    " + " ;\n    ".join(said) + " .\n")
    return {"own.ttl": PREFIXES + "".join(concepts)}


@cache
def _documents() -> tuple[Any, Any]:
    """Documents of the example, of a robot and of a fleet, to damage."""
    results = (
        rosprivacy.analyze("base.xml", "base.yaml", today=DAY),
        rosprivacy.analyze_fleet("example.yaml", today=DAY),
    )
    robot, fleet = (json.loads(result.to("json1")) for result in results)
    return robot, fleet


@cache
def _rows(robot: str) -> dict[str, Any]:
    """The rows of a robot of the example."""
    result = rosprivacy.analyze("base.xml", "base.yaml", today=DAY)
    rows = robot_rows(robot, result.analysis, result.bound, result.vocabulary, {"model": "m"})
    return _with_digest(robot, {part: getattr(rows, part) for part in PARTS})


def _with_digest(robot: str, said: dict[str, Any]) -> dict[str, Any]:
    """Rows with the digest that goes with them, so that it is not the first thing that is wrong."""
    parts = {part: said[part] for part in PARTS if part != "properties"}
    own = {key: said["properties"][key] for key in ("verdict", "view", "model")}
    return {**parts, "properties": rows_of(robot, own, parts).properties}


def analysis(choices: Choices) -> dict[str, str]:
    document = _documents()[0]
    if choices.once_in(2):
        document = with_fault(choices, document)
    return {"old.json": json.dumps(document)}


def parquet(choices: Choices) -> dict[str, bytes]:
    """A folder as ``analyze --results`` writes it: an answer, and the rows of its robots; half of them with a fault."""
    fault = choices.pick(("", "", "", "document", "rows", "column", "robot", "bytes"))
    document = _documents()[1]
    if fault == "document":
        document = with_fault(choices, document)
    robots = []
    for name in document["fleet"]["alike"][0]["robots"] if fault != "document" else ("r1", "r2"):
        said: Any = _rows(name)
        if fault == "rows":
            said = with_fault(choices, said)
            with suppress(AttributeError, KeyError, TypeError):
                said = _with_digest(name, said)
        texts = {part: json.dumps(said.get(part) if isinstance(said, dict) else said) for part in PARTS}
        robots.append({"robot": name, "verdict": "leak", "model": "m", "shared": False, "part": 0, **texts})
    if fault == "column":
        for row in robots:
            del row[choices.pick(list(row))]
    if fault == "robot":
        robots[0][choices.pick(("robot", "shared", "part", "model"))] = choices.pick((None, "r9", True, 7))
    answer = [{"format": FORMAT, "document": json.dumps(document)}]
    damaged = choices.random() if fault == "bytes" else None
    folders: dict[str, list[dict[str, Any]]] = {"results/answer/a.parquet": answer, "results/robots/r.parquet": robots}
    return {file: _table(rows, damaged) for file, rows in folders.items()}


def _table(rows: list[dict[str, Any]], damaged: Random | None) -> bytes:
    from pyarrow import ArrowException, Table, bool_, int32, parquet, schema, string

    kinds = {"shared": bool_(), "part": int32()}
    names = dict.fromkeys(name for row in rows for name in row)
    columns = {name: [row.get(name) for row in rows] for name in names}
    file = BytesIO()
    try:
        table = Table.from_pydict(columns, schema([(name, kinds.get(name, string())) for name in names]))
    except (ArrowException, TypeError):  # a value of another type: the column is what it says
        table = Table.from_pylist([{name: str(value) for name, value in row.items()} for row in rows])
    parquet.write_table(table, file, compression="none")
    data = bytearray(file.getvalue())
    if damaged:
        for _ in range(damaged.randint(1, 3)):
            data[damaged.randrange(len(data))] ^= 1 << damaged.randrange(8)
    return bytes(data)


@cache
def _queries() -> tuple[str, ...]:
    """The questions of the program, each under the name that the target reads."""
    return tuple(query.text.replace(f"// name: {name}\n", "// name: asked\n", 1) for name, query in pack().items())


def query(choices: Choices) -> dict[str, str]:
    text = choices.pick(_queries())
    for _ in range(choices.below(3)):
        lines = text.split("\n")
        at, word = choices.below(min(len(lines), 256)), choices.pick((*QUERY_WORDS, *ODD_TEXT))
        cut = choices.below(min(len(lines[at]) + 1, 256))
        lines[at] = choices.pick((lines[at][:cut] + word + lines[at][cut:], word, f"{lines[at]}\n{lines[at]}"))
        text = "\n".join(lines)
    return {"asked.cypher": text}


def duration(choices: Choices) -> dict[str, str]:
    if choices.once_in(4):
        return {"duration": choices.pick(DURATIONS)}
    text = "P"
    for unit in choices.some("YMWD", most=2):
        text += f"{_number(choices)}{unit}"
    if choices.once_in(2):
        text += "T" + "".join(f"{_number(choices)}{unit}" for unit in choices.some("HMS", 1))
    if choices.once_in(4):
        at = choices.below(len(text) + 1)
        text = text[:at] + choices.pick((*UNITS, "9" * 400, *ODD_TEXT)) + text[at:]
    return {"duration": text}


def _number(choices: Choices) -> str:
    return choices.pick(("0", "1", "7", "30", "999", "0.5", "1,5", "12000"))


def names(choices: Choices) -> dict[str, str]:
    """Four names, one a line."""
    lines = ["".join(choices.pick(PIECES) for _ in range(1 + choices.below(14))) for _ in range(4)]
    return {"names": "\n".join(line.replace("\n", "") for line in lines)}
