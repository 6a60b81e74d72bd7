"""Robots of a database that another version of the program loaded: they have to be loaded again.

In: properties of ``Robot`` nodes. Out: one sentence that names them. An earlier version did not write all that an
answer rests on, so what it wrote would be read as if there were nothing (DESIGN.md, Contracts).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.database.schema import SCHEMA

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

ROBOTS = "MATCH (r:Robot) RETURN r.name AS name, r.version AS version, r.schema AS schema"
HINT = "load it again from its files, with rosprivacy load"
NAMED = 5


def of_other_schemas(robots: Iterable[Mapping[str, Any]]) -> str:
    """Return which robots another version loaded; empty if none. What people add by hand was never loaded.

    >>> of_other_schemas([{"name": "r1", "version": 1}, {"name": "r2", "version": 3, "schema": SCHEMA}])
    'robot r1 was loaded by an earlier version'
    >>> of_other_schemas([{"name": "mine"}])
    ''
    """
    others = {str(robot["name"]): robot.get("schema") for robot in robots if robot.get("version")}
    others = {name: schema for name, schema in sorted(others.items()) if schema != SCHEMA}
    if not others:
        return ""
    names = ", ".join(map(shown, list(others)[:NAMED])) + (f" and {len(others) - NAMED:,} more" * (len(others) > NAMED))
    which = "an earlier version" if all((schema or 1) < SCHEMA for schema in others.values()) else "another version"
    return (
        f"{'robot' if len(others) == 1 else 'robots'} {names} {'was' if len(others) == 1 else 'were'} loaded by {which}"
    )
