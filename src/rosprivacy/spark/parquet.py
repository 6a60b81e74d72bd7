"""The answer about a fleet as Parquet: written by Spark where the parts are, read by ``load`` robot by robot.

A folder with three tables. ``robots``: the rows of each robot for the database, lists as JSON; what is shared has
several, which are put together. ``elements``: for people who ask with other tools, each element with what gets there.
``answer``: one row with the format and the document of ``analyze --format json``.
"""

from __future__ import annotations

import json
from dataclasses import fields
from functools import partial
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import ClusterError, GraphError, InputErrors, reason, shown
from rosprivacy.ingest.database.rows import RobotRows
from rosprivacy.report.installing import command_for
from rosprivacy.spark.session import scatter, told
from rosprivacy.spark.unit_rows import Plan, core_rows, put_together, unit_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from pyspark.sql import SparkSession

    from rosprivacy.spark.units import Unit

FORMAT = "rosprivacy-results-1"
PARTS = tuple(field.name for field in fields(RobotRows) if field.name != "robot")
ROBOTS = "robot string, verdict string, model string, shared boolean, part int, " + ", ".join(
    f"{name} string" for name in PARTS
)
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
    with told():
        spark.createDataFrame(robots, ROBOTS).write.parquet(f"{place}/robots")
        spark.createDataFrame(robots.flatMap(_elements), ELEMENTS).write.parquet(f"{place}/elements")
        answer = [(FORMAT, json.dumps(document, sort_keys=True))]
        spark.createDataFrame(answer, "format string, document string").coalesce(1).write.parquet(f"{place}/answer")


def _rows(part: tuple[Sequence[Unit], int], plan: Plan, core: frozenset[str]) -> list[Row]:
    units, number = part
    return [_row(rows, number + 1, shared=rows.robot in core) for rows in unit_rows(units, plan)]


def _row(rows: RobotRows, part: int, *, shared: bool) -> Row:
    properties = rows.properties
    said = (json.dumps(getattr(rows, name), sort_keys=True) for name in PARTS)
    return (rows.robot, properties["verdict"], properties.get("model"), shared, part, *said)


def _elements(row: Row) -> Iterator[Row]:
    for element in json.loads(row[5 + PARTS.index("elements")]):
        properties = element["properties"]
        lists = (properties[name] for name in LISTS)
        yield (row[0], element["id"], properties["kind"], properties["name"], properties["leg"], *lists)


def read(folder: str) -> tuple[dict[str, Any], Iterator[RobotRows]]:
    """Return the document and the rows of every robot; no more than a few robots are in memory at a time.

    Raises
    ------
    InputErrors
        If these are no whole results.
    ClusterError
        Without the ``[spark]`` extra, which brings what reads Parquet.
    """
    try:
        from pyarrow import ArrowException, dataset  # noqa: PLC0415 - an extra
    except ImportError:
        raise ClusterError(f"--results needs pyarrow; {command_for('spark')}") from None
    hint = "name a folder that analyze --results has written to its end"
    try:
        answer = dataset.dataset(f"{folder}/answer", format="parquet").to_table().to_pylist()
        robots = dataset.dataset(f"{folder}/robots", format="parquet")
    except (OSError, ArrowException, ValueError) as error:
        why = reason(error).partition(". ")[0]
        raise InputErrors([GraphError(folder, 0, f"no results: {shown(why)}", hint)]) from None
    if [row.get("format") for row in answer] != [FORMAT]:
        raise InputErrors([GraphError(folder, 0, f"no results ({FORMAT})", hint)])
    if set(PARTS) - set(robots.schema.names):
        hint = "analyse again, with analyze --results and another folder"
        raise InputErrors([GraphError(folder, 0, "results of an earlier version", hint)])
    return json.loads(answer[0]["document"]), _read(robots, dataset)


def _read(robots: Any, dataset: Any) -> Iterator[RobotRows]:
    """What is shared first."""
    shared: dict[str, list[tuple[int, RobotRows]]] = {}
    is_shared = dataset.field("shared")
    for row in _each(robots, is_shared):
        shared.setdefault(row["robot"], []).append((row["part"], _robot_rows(row)))
    for _, some in sorted(shared.items()):
        yield put_together([rows for _, rows in sorted(some, key=lambda pair: pair[0])])
    yield from map(_robot_rows, _each(robots, ~is_shared))


def _each(robots: Any, chosen: Any) -> Iterable[dict[str, Any]]:
    batches = robots.to_batches(batch_size=16, filter=chosen, batch_readahead=0, fragment_readahead=0)
    return chain.from_iterable(batch.to_pylist() for batch in batches)


def _robot_rows(row: dict[str, Any]) -> RobotRows:
    return RobotRows(row["robot"], **{name: json.loads(row[name]) for name in PARTS})
