"""A row of Parquet -> the rows of a robot for the database, if they are what ``parquet.py`` wrote.

In: the columns of a row, as anybody may have changed them. Out: ``RobotRows``; a problem has its column and place. The
digest of a robot tells of every change that is not meant; the shape and the ends are checked all the same, so that
nothing is lost in silence: a relationship whose end is not there would not be written.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.json_values import parsed
from rosprivacy.ingest.database.rows import RobotRows, rows_of
from rosprivacy.ingest.database.schema import ROLES
from rosprivacy.parts.unit_rows import own_properties, parts_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rosprivacy.analysis.errors import RosPrivacyError

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


def robot_rows(row: dict[str, Any], fail: Callable[[str], RosPrivacyError], hint: str) -> RobotRows:
    """Return the rows of a robot, or of what one part has of something shared.

    Parameters
    ----------
    fail
        Makes the error from the problem.
    hint
        How to get such a file, where JSON cannot be read.

    Raises
    ------
    RosPrivacyError
        What ``fail`` makes.
    """
    for column, kind in (("robot", str), ("shared", bool), ("part", int)):
        if not isinstance(row[column], kind) or row[column] == "":
            raise fail(f"a row without {column}")
    values = {column: _value(column, row[column], fail, hint) for column in (*SHAPES, "roles", "properties")}
    problem = next(_misfits(values), "")
    if problem:
        raise fail(problem)
    rows = RobotRows(row["robot"], **values)
    if rows_of(rows.robot, own_properties(rows.properties), parts_of(rows)).properties != rows.properties:
        raise fail("not as it was written: the digest is another one")
    return rows


def check_ends(rows: RobotRows, fail: Callable[[str], RosPrivacyError]) -> RobotRows:
    """Return rows of which every end is there.

    Raises
    ------
    RosPrivacyError
        What ``fail`` makes.
    """
    known = {row["id"] for row in (*rows.elements, *rows.intakes, *rows.foreign)}
    enclaves, findings = {row["id"] for row in rows.enclaves}, {row["id"] for row in rows.findings}
    ends = [(name, end, known) for name in BETWEEN for end in ("source", "target")]
    ends += [("memberships", "source", known), ("memberships", "target", enclaves)]
    ends += [("across", "source", findings), ("across", "target", known)]
    for name, end, there in ends:
        if any(row[end] not in there for row in getattr(rows, name)):
            raise fail(f"{name}: a {end} that is not there")
    if any(row["source"] not in known for some in rows.roles.values() for row in some):
        raise fail("roles: a source that is not there")
    return rows


def _value(column: str, text: str | None, fail: Callable[[str], RosPrivacyError], hint: str) -> Any:
    if text is None:
        raise fail(f"{column}: nothing")
    return parsed(text.encode(), lambda _, problem, __: fail(f"{column}: {problem}"), hint)


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
