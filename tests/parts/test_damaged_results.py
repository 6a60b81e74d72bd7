"""Parquet that came to harm is refused in one line, exit code 2, before anything is written.

The tables are written here as Spark writes them; that it does so is held by ``test_spark.py``. A run that accepts them
asks for a database that is not there: exit code 3.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.neo4j_graph.rows import rows_of
from rosprivacy.parts.parquet import ANSWER, FORMAT, PARTS, ROBOTS, read
from rosprivacy.parts.unit_rows import own_properties, parts_of
from tests.helpers.command import Cli, refused
from tests.helpers.daily import one_in
from tests.helpers.damages import damaged, damaged_bytes, one_line_each
from tests.helpers.fleet_files import MODELS, folder, write
from tests.helpers.fleet_rows import rows as rows_in_memory

if TYPE_CHECKING:
    from collections.abc import Callable

    from rosprivacy.ingest.neo4j_graph.rows import RobotRows

__all__ = ["folder"]  # a fixture
parquet = pytest.importorskip("pyarrow.parquet", reason="without the [spark] extra")

Table = list[dict[str, Any]]
FLEET = f"""fleet: 1
{MODELS}robots:
  e1: {{model: eye, domain: 3}}
  e2: {{model: eye, domain: 3}}
  w: {{model: wall, domain: 3}}
elements: {{bucket: {{kind: storage}}}}
flows: [{{from: '*:/uplink', to: bucket}}]
"""
NOWHERE = ("--neo4j", "bolt://127.0.0.1:9")


def written(robots: Table, answer: Table) -> str:
    """A folder of results."""
    import pyarrow as pa

    kinds = {"string": pa.string(), "boolean": pa.bool_(), "int": pa.int32()}
    for name, table, columns in (("robots", robots, ROBOTS), ("answer", answer, ANSWER)):
        fields = [(column, kinds[kind]) for column, kind in (pair.split(" ") for pair in columns.split(", "))]
        Path("results", name).mkdir(parents=True)
        parquet.write_table(pa.Table.from_pylist(table, pa.schema(fields)), f"results/{name}/part.parquet")
    return "results"


def row(rows: RobotRows, part: int, *, shared: bool) -> dict[str, Any]:
    columns = {name: json.dumps(getattr(rows, name), sort_keys=True) for name in PARTS}
    return {"robot": rows.robot, "verdict": "leak", "model": None, "shared": shared, "part": part, **columns}


def rewritten(one: dict[str, Any], column: str, value: Any) -> dict[str, Any]:
    """A row with another column, and a digest that fits it, as somebody makes it who knows how."""
    parts = {name: json.loads(one[name]) for name in PARTS} | {column: value}
    properties = own_properties(parts.pop("properties"))
    return row(rows_of(one["robot"], properties, parts), one["part"], shared=one["shared"])


@pytest.fixture
def tables() -> tuple[Table, Table]:
    """Two robots that are alike, a third, and what they share, in two parts."""
    write("f.yaml", FLEET)
    robots, names = [], {"e1", "e2", "w"}
    for rows in rows_in_memory("f.yaml"):
        shared = rows.robot not in names
        robots.append(row(rows, 0 if shared else 1, shared=shared))
        if shared:
            nothing: dict[str, Any] = {name: {} if name == "roles" else [] for name in parts_of(rows)}
            robots.append(row(rows_of(rows.robot, own_properties(rows.properties), nothing), 1, shared=True))
    document = json.dumps(rosprivacy.analyze_fleet("f.yaml").document())
    return robots, [{"format": FORMAT, "document": document}]


def first(robots: Table, name: str = "e1") -> dict[str, Any]:
    return next(one for one in robots if one["robot"] == name)


def test_what_is_whole_is_read(cli: Cli, tables: tuple[Table, Table]) -> None:
    document, rows = read(written(*tables))
    assert document["verdict"] == "leak"
    assert {one.robot for one in rows} >= {"e1", "e2", "w"}
    done = cli("load", "--results", "results", *NOWHERE)
    assert (done.returncode, done.stdout) == (3, "")


def column(name: str, value: Any, robot: str = "e1") -> Callable[[Table, Table], None]:
    return lambda robots, _: first(robots, robot).update({name: value})


def part(name: str, value: Any) -> Callable[[Table, Table], None]:
    """With a digest that fits."""
    return lambda robots, _: first(robots).update(rewritten(first(robots), name, value))


def shared(robots: Table) -> Table:
    return [one for one in robots if one["shared"]]


DAMAGES: dict[str, Callable[[Table, Table], Any]] = {
    "robot e1: elements: not JSON, or not to its end": column("elements", "[{]"),
    "robot e1: elements: the file is empty": column("elements", ""),
    "robot e1: flows: nothing": column("flows", None),
    "robot e1: properties: not plain values": column("properties", "[]"),
    "robot e1: properties: digest is too large a number": column("properties", '{"digest": 1e999}'),
    "robot e1: flows: the key 'a' stands twice": column("flows", '[{"a": 1, "a": 2}]'),
    "robot e1: roles: not lists by role": column("roles", "[]"),
    "robot e1: findings: not a list": column("findings", "{}"),
    "robot e1: flows[0]: not source, target, properties": column("flows", "[{}]"),
    "robot e1: elements[0].id: not text": column("elements", '[{"id": 1, "labels": [], "properties": {}}]'),
    "robot e1: not as it was written: the digest is another one": column("flows", "[]"),
    "robot e2: not as it was written: the digest is another one": column("robot", "e2"),
    "robot None: a row without robot": column("robot", None),
    "robot e1: a row without part": column("part", None),
    "robot e1: a row without shared": column("shared", None),
    "robot e1 is not there": lambda robots, _: robots.remove(first(robots)),
    "robot e1 is there twice": lambda robots, _: robots.append(first(robots)),
    "a part of what robots share is not there, or there twice": lambda robots, _: robots.remove(shared(robots)[1]),
    "robot e1: flows: a source that is not there": part("elements", []),
    "robot e1: enclaves[0].properties: not plain values": part("enclaves", [{"id": "a", "properties": {"a": {}}}]),
    "robot e1: carried[0].types: not a list of texts": part("carried", [{"source": "a", "target": "a", "types": "a"}]),
    "results/answer:1: not JSON, or not to its end": lambda _, answer: answer[0].update(document="{"),
    "results/answer: damaged or changed: the document lacks ": lambda _, answer: answer[0].update(
        document='{"format": "rosprivacy.analysis/1"}'
    ),
    "results: no results (rosprivacy-results-1)": lambda _, answer: answer.append(answer[0]),
}


@pytest.mark.parametrize("said", one_in(4, DAMAGES, in_ci=1))
def test_damaged_rows_are_refused_with_their_place(cli: Cli, tables: tuple[Table, Table], said: str) -> None:
    DAMAGES[said](*tables)
    (line,) = refused(cli("load", "--results", written(*tables), *NOWHERE))
    assert said in line


@pytest.mark.parametrize("cut", [0, 3, 0.5, 0.9])
@pytest.mark.parametrize("table", ["answer", "robots"])
def test_truncated_files_are_refused(cli: Cli, tables: tuple[Table, Table], table: str, cut: float) -> None:
    file = Path(written(*tables), table, "part.parquet")
    data = file.read_bytes()
    file.write_bytes(data[: int(cut if cut > 1 else cut * len(data))])
    (line,) = refused(cli("load", "--results", "results", *NOWHERE))
    assert line.startswith("results: ")


@pytest.mark.parametrize(("table", "name", "kind"), [("robots", "part", "string"), ("answer", "document", "int64")])
def test_columns_of_another_type_are_refused(
    cli: Cli, tables: tuple[Table, Table], table: str, name: str, kind: str
) -> None:
    import pyarrow as pa

    file = Path(written(*tables), table, "part.parquet")
    there = parquet.read_table(file)
    at = there.schema.get_field_index(name)
    values = pa.array([None] * there.num_rows, getattr(pa, kind)())
    parquet.write_table(there.set_column(at, name, values), file)
    (line,) = refused(cli("load", "--results", "results", *NOWHERE))
    assert f"the column {name} is no " in line


def test_a_file_in_place_of_the_folder_and_a_folder_without_tables(cli: Cli) -> None:
    for name in ("eye.xml", "none", "."):
        (line,) = refused(cli("load", "--results", name, *NOWHERE))
        assert ": no results" in line


@pytest.mark.parametrize("cli", ["here"], indirect=True)  # there are many
@pytest.mark.parametrize("seed", one_in(60, range(240)))
def test_any_damage_ends_as_documented(cli: Cli, tables: tuple[Table, Table], seed: int) -> None:
    random = Random(f"parquet {seed}")  # noqa: S311 - repeatable
    robots, answer = tables
    if random.random() < 1 / 3:
        file = Path(written(*tables), random.choice(["robots", "answer"]), "part.parquet")
        file.write_bytes(damaged_bytes(random, file.read_bytes()))
    else:
        one = random.choice([*robots, *answer])
        texts = [name for name in one if isinstance(one[name], str)]
        name = random.choice(texts)
        one[name] = damaged(random, one[name].encode()).decode("utf-8", "replace")
        written(*tables)
    one_line_each(cli("load", "--results", "results", *NOWHERE), {2, 3})


def test_a_library_user_gets_input_errors(tables: tuple[Table, Table]) -> None:
    column("flows", "[]")(*tables)
    with pytest.raises(InputErrors, match=r"^results: damaged or changed: robot e1: "):
        read(written(*tables))
    shutil.rmtree("results")
