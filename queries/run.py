"""Cypher -> rows: read-only by the server's own plan and access mode, with bounds on rows, size and time.

In: a driver, Cypher, values. Out: ``QueryRows`` of plain values. What does more than read the graph is refused.
"""

from __future__ import annotations

import json
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from queue import Empty, SimpleQueue
from threading import Thread
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import DatabaseError as OurDatabaseError
from rosprivacy.analysis.errors import QueryError, shown
from rosprivacy.analysis.written_names import A_LITTLE, FEW, did_you_mean, nearest
from rosprivacy.queries.graph_values import GraphValue, graph_values, nodes_in, plain, value_of, with_known
from rosprivacy.queries.library import NAMES
from rosprivacy.queries.reading import refuse_too_much, refuse_unknown_names, refuse_unless_reading

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from neo4j import Driver, Transaction

    from rosprivacy.queries.library import Query
    from rosprivacy.queries.reading import KnownNames

LIMIT = 1000
LISTED = 30  # names of a hint, where none is near
FETCHED = 100  # rows at once; the server keeps them in memory until they are read
TIMEOUT = 60.0  # seconds
LARGEST = 100 * 2**20  # of all rows, as `_size` counts; what is held here while it is turned into text
LONGEST_REASON = 400
GRACE = 10.0  # seconds beyond that bound: the server keeps it while it runs a query, not while it plans one
WAY = "path"  # the column of the pack that names elements in the order of the flow


@dataclass(frozen=True, slots=True)
class QueryRows:
    """What a query gives.

    Attributes
    ----------
    columns
        Their names.
    rows
        Values as JSON has them, and nodes, relationships and paths as ``graph_values`` has them.
    truncated
        Whether there were more than the bound.
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]
    truncated: bool = False


def run(
    driver: Driver,
    text: str,
    values: Mapping[str, Any] | None = None,
    *,
    limit: int | None = LIMIT,
    timeout: float | None = TIMEOUT,
    known_names: KnownNames | None = None,
) -> QueryRows:
    """Run Cypher that only reads.

    Parameters
    ----------
    limit
        Most rows to return; None for all.
    timeout
        Seconds that the server may take; None for as long as it takes. What it has not even planned ``GRACE`` later is
        waited for no more.
    known_names
        Names that the graph can have: one that is neither among these nor in the database is refused; None lets all
        names pass.

    Raises
    ------
    QueryError
        If it does more than read the graph, or the server refuses it: it is not Cypher, lacks a parameter, or takes
        too long or too much memory; also if its rows are too large.
    DatabaseError
        If the server cannot answer for a reason of its own.
    """
    refuse_too_much(text)
    answer = partial(_answer, driver, text, dict(values or {}), limit, timeout, known_names)
    with _refusals(driver, timeout):
        return answer() if timeout is None else _in_time(answer, timeout + GRACE)


def _in_time(answer: Callable[[], QueryRows], seconds: float) -> QueryRows:
    """Wait for an answer so long: what then still waits for the server ends when the driver is closed."""
    answers: SimpleQueue[QueryRows | BaseException] = SimpleQueue()

    def work() -> None:
        try:
            answers.put(answer())
        except BaseException as error:  # noqa: BLE001 - it is raised by whoever waits
            answers.put(error)

    Thread(target=work, daemon=True).start()
    try:
        answered = answers.get(timeout=seconds)
    except Empty:
        what = f"the server has not answered within {seconds:g} s: it may still be planning the query"
        raise QueryError(f"{what}; ask for less") from None
    if isinstance(answered, BaseException):
        raise answered
    return answered


def _answer(
    driver: Driver,
    text: str,
    values: dict[str, Any],
    limit: int | None,
    timeout: float | None,
    known_names: KnownNames | None,
) -> QueryRows:
    import neo4j  # noqa: PLC0415 - light start

    with (
        driver.session(
            default_access_mode=neo4j.READ_ACCESS,
            fetch_size=FETCHED,
            notifications_min_severity="WARNING" if known_names is not None else "OFF",
        ) as session,
        session.begin_transaction(timeout=timeout) as transaction,
    ):
        planned = refuse_unless_reading(transaction, text, values)
        if known_names is not None:
            refuse_unknown_names(transaction, planned, known_names)
        result = transaction.run(text, values)
        columns = tuple(result.keys())
        rows: list[tuple[Any, ...]] = []
        held = 0
        for record in result:
            if limit is not None and len(rows) == limit:
                return QueryRows(columns, _with_ends(transaction, rows), truncated=True)
            row = tuple(value_of(value) for value in record.values())
            held += _size([plain(value) for value in row])
            if held > LARGEST:
                raise QueryError(f"the rows take more than {LARGEST // 2**20} MB; ask for less")
            rows.append(row)
        return QueryRows(columns, _with_ends(transaction, rows))


def _with_ends(transaction: Transaction, rows: list[tuple[Any, ...]]) -> tuple[tuple[Any, ...], ...]:
    """Look up the ends of relationships that stand without them: the server names these by their ids only."""
    bare = {node.id for value in graph_values(rows) for node in nodes_in(value) if node.bare}
    if not bare:
        return tuple(rows)
    found = transaction.run("MATCH (n) WHERE elementId(n) IN $ids RETURN n", ids=sorted(bare))
    known = {node.id: node for node in (value_of(record["n"]) for record in found)}
    return tuple(with_known(row, known) for row in rows)


def check_names(driver: Driver, query: Query, values: Mapping[str, Any]) -> None:
    """See that the names that a question is asked about are in the database.

    Raises
    ------
    QueryError
        For each that is not, with the nearest that are: a mistyped name must not look like an answer (rule S11).
    """
    problems = []
    for field in query.parameters:
        asked = values[field.name]
        if field.type not in NAMES or asked == field.default:
            continue
        where, name = NAMES[field.type]
        if not run(driver, f"MATCH {where} WHERE {name} = $name RETURN 1 LIMIT 1", {"name": asked}).rows:
            rows = run(driver, f"MATCH {where} RETURN DISTINCT {name}", limit=None).rows
            names = sorted(str(name) for (name,) in rows)
            every = f"it is one of {', '.join(map(shown, names))}" if names else "load a robot first"
            others = every if len(names) <= LISTED else f"{len(names):,} others are there"
            hint = did_you_mean(nearest(asked, names, FEW, A_LITTLE), others)
            problems.append(f"{query.name}: no {field.type} {shown(asked)!r} is in the database; {hint}")
    if problems:
        raise QueryError("\n".join(problems))


def as_cell(value: Any, column: str = WAY, words: Callable[[GraphValue], str] = str) -> str:
    """Return a value as a reader of a table sees it.

    Parameters
    ----------
    column
        Its name: the names on a way stand in the order of the flow, other lists have no direction.
    words
        How a node, a relationship or a path is told.

    >>> as_cell(["/camera", "/video"], "path"), as_cell(["r1", "r2"], "robots"), as_cell(None), as_cell(True)
    ('/camera -> /video', 'r1, r2', '', 'true')
    """
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, GraphValue):
        return words(value)
    if isinstance(value, list) and value and all(isinstance(item, GraphValue) for item in value):
        return ", ".join(map(words, value))
    if isinstance(value, list) and all(isinstance(item, str) for item in value):
        return (" -> " if column == WAY else ", ").join(value)
    return json.dumps(plain(value), ensure_ascii=False, sort_keys=True)


def _size(value: Any) -> int:
    """Return about how many bytes a plain value takes as text."""
    if isinstance(value, str):
        return len(value)
    if isinstance(value, dict):
        return sum(len(key) + _size(item) for key, item in value.items())
    return sum(map(_size, value)) if isinstance(value, list | tuple) else 8


@contextmanager
def _refusals(driver: Driver, timeout: float | None) -> Iterator[None]:
    """What the server refuses, as one line; that it is lost is said by whoever opened the driver."""
    from neo4j.exceptions import (  # noqa: PLC0415 - light start
        ClientError,
        DatabaseError,
        DriverError,
        Neo4jError,
        ServiceUnavailable,
        SessionExpired,
    )

    try:
        yield
    except (ServiceUnavailable, SessionExpired):
        # A server that has no memory left for a value breaks the connection, and goes on.
        with suppress(DriverError, Neo4jError):
            driver.verify_connectivity()
            what = "the server broke off, and runs: the query or its answer is too much for it"
            raise QueryError(f"{what}; ask for less") from None
        raise
    except RecursionError:
        raise QueryError("the rows hold lists in lists that are too deep to be read; ask for less") from None
    except Neo4jError as error:
        code, what = error.code or "", shown(" ".join((error.message or str(error)).split())[:LONGEST_REASON])
        if code.endswith("Statement.AccessMode"):
            raise QueryError(
                "the query would write; queries only read: write with cypher-shell or the driver"
            ) from None
        if ".TransactionTimedOut" in code:
            hint = "ask for less, or give it longer with rosprivacy query --timeout"
            raise QueryError(f"the query took longer than {timeout:g} s; {hint}") from None
        if isinstance(error, ClientError | DatabaseError):
            raise QueryError(f"the server refuses the query: {what}; correct it") from None
        if "OutOfMemory" in code:
            raise QueryError(f"the query needs more memory than the server gives: {what}; ask for less") from None
        raise OurDatabaseError(f"the server cannot answer now: {what}; try again") from None
    except (OverflowError, UnicodeError) as error:  # before anything is sent
        raise QueryError(f"the query or a value cannot be sent: {shown(str(error))}; correct it") from None
