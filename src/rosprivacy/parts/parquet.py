"""The answer about a fleet as Parquet: written by Spark where the parts are, read by ``load`` robot by robot.

A folder with three tables. ``robots``: the rows of each robot for the database, lists as JSON; what is shared has
several, which are put together. ``elements``: for people who ask with other tools, each element with what gets there.
``answer``: one row with the format and the document of ``analyze --format json1``.
"""

from __future__ import annotations

import json
from collections import Counter
from contextlib import contextmanager
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import ClusterError, GraphError, InputError, InputErrors, RosPrivacyError, reason, shown
from rosprivacy.analysis.installing import command_for
from rosprivacy.analysis.json_values import parsed
from rosprivacy.ingest.neo4j_graph.rows import RobotRows, rows_of
from rosprivacy.ingest.neo4j_graph.schema import ROLES
from rosprivacy.parts.session import cluster_errors, scatter
from rosprivacy.parts.unit_rows import Plan, core_rows, own_properties, parts_of, put_together, unit_rows
from rosprivacy.report.compare.earlier import document_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from pyspark.sql import SparkSession

    from rosprivacy.parts.units import Unit


FORMAT = "rosprivacy-results-1"
PARTS = tuple(field.name for field in fields(RobotRows) if field.name not in ("robot", "beyond"))  # of one view only
ROBOTS = "robot string, verdict string, model string, shared boolean, part int, " + ", ".join(
    f"{name} string" for name in PARTS
)
ANSWER = "format string, document string"
WHOLE = "name a folder that analyze --results has written to its end"
ANALYSE_AGAIN = "analyse again, with analyze --results and another folder"
LISTS = ("carries", "pseudonymised", "begins", "leaks", "sanitizes", "open")
ELEMENTS = "robot string, id string, kind string, name string, leg string, " + ", ".join(
    f"{name} array<string>" for name in LISTS
)
Row = tuple[Any, ...]


def check_new(folder: str) -> None:
    """Refuse a folder in which something is.

    Raises
    ------
    InputErrors
        If it is there already; what is on another file system Spark refuses by itself.
    """
    if Path(folder).exists():
        what = "is there already"
        raise InputErrors([GraphError(folder, 0, what, "results are work: name another folder, or remove it")])


def write(spark: SparkSession, folder: str, units: Sequence[Unit], plan: Plan, document: dict[str, Any]) -> None:
    """Write the tables; ``answer`` last, so that what has none is known to be broken off.

    Raises
    ------
    ClusterError
        If that fails.
    """
    from pyspark import StorageLevel  # noqa: PLC0415 - an extra

    place = str(Path(folder).absolute()) if "://" not in folder else folder
    context = spark.sparkContext
    shared = core_rows(plan)
    core = context.parallelize([_row(rows, 0, shared=True) for rows in shared], 1)
    names = frozenset(rows.robot for rows in shared)
    parts = scatter(spark, units).rdd.zipWithIndex().flatMap(partial(_rows, plan=plan, core=names))
    robots = core.union(parts).persist(StorageLevel.MEMORY_AND_DISK)
    with cluster_errors():
        spark.createDataFrame(robots, ROBOTS).write.parquet(f"{place}/robots")
        spark.createDataFrame(robots.flatMap(_elements), ELEMENTS).write.parquet(f"{place}/elements")
        answer = [(FORMAT, json.dumps(document, sort_keys=True))]
        spark.createDataFrame(answer, ANSWER).coalesce(1).write.parquet(f"{place}/answer")


def _rows(part: tuple[Sequence[Unit], int], plan: Plan, core: frozenset[str]) -> list[Row]:
    units, number = part
    return [_row(rows, number + 1, shared=rows.robot in core) for rows in unit_rows(units, plan)]


def _row(rows: RobotRows, part: int, *, shared: bool) -> Row:
    properties = rows.properties
    said = (json.dumps(getattr(rows, name), sort_keys=True) for name in PARTS)
    return (rows.robot, properties.get("verdict"), properties.get("model"), shared, part, *said)


def _elements(row: Row) -> Iterator[Row]:
    for element in json.loads(row[5 + PARTS.index("elements")]):
        properties = element["properties"]
        lists = (properties[name] for name in LISTS)
        yield (row[0], element["id"], properties["kind"], properties["name"], properties["leg"], *lists)


def read(folder: str) -> tuple[Mapping[str, Any], Iterator[RobotRows]]:
    """Return the document and the rows of every robot; no more than a few robots are in memory at a time.

    All rows are read and checked before the first one is given, so that nothing is written of results of which some
    are damaged; they are checked again when they are given.

    Raises
    ------
    InputErrors
        If these are no whole results, or not what was written.
    ClusterError
        Without the ``[spark]`` extra, which brings what reads Parquet.
    """
    try:
        from pyarrow import dataset  # noqa: PLC0415 - an extra
    except ImportError:
        raise ClusterError(f"--results needs pyarrow; {command_for('spark')}") from None
    with _damages(folder, "no results: ", WHOLE):
        answer = dataset.dataset(f"{folder}/answer", format="parquet").to_table()
        robots = dataset.dataset(f"{folder}/robots", format="parquet")
    _check_columns(folder, answer.schema, ANSWER)
    if answer.column("format").to_pylist() != [FORMAT] or answer.column("document").null_count:
        raise InputErrors([GraphError(folder, 0, f"no results ({FORMAT})", WHOLE)])
    _check_columns(folder, robots.schema, ROBOTS)
    with _damages(folder, "damaged: ", ANALYSE_AGAIN):
        text = answer.column("document").to_pylist()[0]
    try:
        document = document_of(text.encode(), f"{folder}/answer", ANALYSE_AGAIN)
    except InputError as error:
        raise InputErrors([error]) from None
    _check_all(folder, document, robots, dataset)
    return document, _read(folder, robots, dataset)


@contextmanager
def _damages(folder: str, problem: str, hint: str) -> Iterator[None]:
    """What the library says of files that are not Parquet, or not to their end; it raises all these."""
    from pyarrow import ArrowException  # noqa: PLC0415 - an extra

    try:
        yield
    except (OSError, ArrowException, ValueError) as error:
        why = reason(error).partition(". ")[0]
        raise InputErrors([GraphError(folder, 0, f"{problem}{shown(why)}", hint)]) from None


def _check_columns(folder: str, schema: Any, columns: str) -> None:
    """Refuse tables with other columns than those that are written."""
    from pyarrow import types  # noqa: PLC0415 - an extra

    known = {"string": types.is_string, "boolean": types.is_boolean, "int": types.is_int32}
    for column in columns.split(", "):
        name, kind = column.split(" ")
        if schema.get_field_index(name) < 0:  # none, or several
            raise InputErrors([GraphError(folder, 0, "results of an earlier version", ANALYSE_AGAIN)])
        if not known[kind](schema.field(name).type):
            raise InputErrors([GraphError(folder, 0, f"the column {name} is no {kind}", ANALYSE_AGAIN)])


def _check_all(folder: str, document: Mapping[str, Any], robots: Any, dataset: Any) -> None:
    """Read everything once: what is shared in all its parts, each robot once, and every robot that the answer names."""
    if "fleet" not in document:
        raise _problem(folder, "the answer is not of a fleet")
    names = Counter(rows.robot for rows in _read(folder, robots, dataset))
    twice = sorted(name for name, number in names.items() if number > 1)
    lost = sorted({robot for group in document["fleet"]["alike"] for robot in group["robots"]} - names.keys())
    if twice or lost:
        raise _problem(folder, f"robot {shown((twice or lost)[0])} is {'there twice' if twice else 'not there'}")
    parts: dict[str, list[int]] = {}
    for row in _batched(folder, robots, None, columns=["robot", "part"]):
        parts.setdefault(row["robot"], []).append(row["part"])
    whole = list(range(max(map(max, parts.values()), default=0) + 1))
    if any(0 in numbers and sorted(numbers) != whole for numbers in parts.values()):
        raise _problem(folder, "a part of what robots share is not there, or there twice")


def _problem(folder: str, problem: str) -> InputErrors:
    return InputErrors([GraphError(folder, 0, f"damaged or changed: {problem}", ANALYSE_AGAIN)])


def _read(folder: str, robots: Any, dataset: Any) -> Iterator[RobotRows]:
    """What is shared first."""
    parts: dict[str, list[tuple[int, RobotRows]]] = {}
    is_shared = dataset.field("shared")
    for row in _batched(folder, robots, is_shared.is_null() | is_shared):  # null is refused then
        with _damage_of(folder, f"robot {shown(str(row['robot']))}"):
            parts.setdefault(row["robot"], []).append((row["part"], _rows_of(row)))
    for name, shares in sorted(parts.items()):
        with _damage_of(folder, f"{shown(name)}, which robots share"):
            rows = _with_ends(put_together([rows for _, rows in sorted(shares, key=lambda pair: pair[0])]))
        yield rows
    for row in _batched(folder, robots, ~is_shared):
        with _damage_of(folder, f"robot {shown(str(row['robot']))}"):
            rows = _with_ends(_rows_of(row))
        yield rows


def _batched(folder: str, robots: Any, chosen: Any, columns: list[str] | None = None) -> Iterator[dict[str, Any]]:
    read_ahead = {"batch_readahead": 0, "fragment_readahead": 0}
    with _damages(folder, "damaged: ", ANALYSE_AGAIN):
        for batch in robots.to_batches(batch_size=16, filter=chosen, columns=columns, **read_ahead):
            yield from batch.to_pylist()


class _DamageError(RosPrivacyError):
    """What is wrong with a row."""


@contextmanager
def _damage_of(folder: str, place: str) -> Iterator[None]:
    try:
        yield
    except _DamageError as error:
        raise _problem(folder, f"{place}: {error}") from None


TEXT, TEXTS, PLAIN = "text", "a list of texts", "plain values"
END = {"source": TEXT, "target": TEXT, "properties": PLAIN}
NODE = {"id": TEXT, "labels": TEXTS, "properties": PLAIN}
SHAPES = {
    "elements": NODE,
    "intakes": NODE,
    "enclaves": {"id": TEXT, "properties": PLAIN},
    "memberships": END,
    "flows": END,
    "derived": END,
    "carried": {"source": TEXT, "target": TEXT, "types": TEXTS},
    "findings": END | {"id": TEXT, "category": TEXT},
    "across": END,
    "foreign": NODE,
}
BETWEEN = ("flows", "derived", "carried", "findings")  # begin and end at elements
SCALARS = (str, int, float, bool, type(None))


def _rows_of(row: dict[str, Any]) -> RobotRows:
    """The rows of a robot, or of what one part has of something shared, from columns that anybody may have changed.

    The digest of a robot tells of every change that is not meant; the shape and the ends are checked all the same, so
    that nothing is lost in silence: a relationship whose end is not there would not be written.
    """
    for column, kind in (("robot", str), ("shared", bool), ("part", int)):
        if not isinstance(row[column], kind) or row[column] == "":
            raise _DamageError(f"a row without {column}")
    values = {column: _value(column, row[column]) for column in (*SHAPES, "roles", "properties")}
    for problem in _misfits(values):
        raise _DamageError(problem)
    rows = RobotRows(row["robot"], **values)
    if rows_of(rows.robot, own_properties(rows.properties), parts_of(rows)).properties != rows.properties:
        raise _DamageError("not as it was written: the digest is another one")
    return rows


def _value(column: str, text: str | None) -> Any:
    if text is None:
        raise _DamageError(f"{column}: nothing")
    return parsed(text.encode(), lambda _, problem, __: _DamageError(f"{column}: {problem}"), ANALYSE_AGAIN)


def _with_ends(rows: RobotRows) -> RobotRows:
    """The same rows, if every end is there."""
    known = {row["id"] for row in (*rows.elements, *rows.intakes, *rows.foreign)}
    enclaves, findings = {row["id"] for row in rows.enclaves}, {row["id"] for row in rows.findings}
    ends = [(name, end, known) for name in BETWEEN for end in ("source", "target")]
    ends += [("memberships", "source", known), ("memberships", "target", enclaves)]
    ends += [("across", "source", findings), ("across", "target", known)]
    for name, end, ids in ends:
        if any(row[end] not in ids for row in getattr(rows, name)):
            raise _DamageError(f"{name}: a {end} that is not there")
    if any(row["source"] not in known for listed in rows.roles.values() for row in listed):
        raise _DamageError("roles: a source that is not there")
    return rows


def _misfits(values: dict[str, Any]) -> Iterator[str]:
    """What has another shape, column by column."""
    if not _plain(values["properties"]):
        yield "properties: not plain values"
    if not isinstance(values["roles"], dict) or not values["roles"].keys() <= ROLES.keys():
        yield "roles: not lists by role"
        return
    for column, shape in SHAPES.items():
        yield from _misfit(column, values[column], shape)
    for role, some in values["roles"].items():
        yield from _misfit(f"roles.{role}", some, END)


def _misfit(column: str, rows: Any, shape: dict[str, str]) -> Iterator[str]:
    if not isinstance(rows, list):
        yield f"{column}: not a list"
        return
    for index, row in enumerate(rows):
        if not isinstance(row, dict) or row.keys() != shape.keys():
            yield f"{column}[{index}]: not {', '.join(shape)}"
        else:
            yield from (
                f"{column}[{index}].{key}: not {kind}" for key, kind in shape.items() if not _is(row[key], kind)
            )


def _is(value: Any, kind: str) -> bool:
    if kind == TEXT:
        return isinstance(value, str)
    return _texts(value) if kind == TEXTS else _plain(value)


def _texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(one, str) for one in value)


def _plain(value: Any) -> bool:
    """Whether a database can keep it as properties: scalars, and lists of texts."""
    return isinstance(value, dict) and all(isinstance(one, SCALARS) or _texts(one) for one in value.values())
