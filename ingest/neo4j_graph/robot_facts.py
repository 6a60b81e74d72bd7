"""What is known of a robot as a whole, as properties of ``Robot``: what it was read with, and by which version.

In: diagnostics; properties. Out: JSON text, and the same facts again; what earlier versions wrote has no codes. People
can change the properties, so a reader asks first whether they can be read. An earlier version did not write all that
an answer rests on: what it wrote would be read as if there were nothing, so such robots have to be loaded again.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.ingest.neo4j_graph.schema import SCHEMA

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

FILES = ("policies", "labels", "fleet")
ROBOTS = "MATCH (r:Robot) RETURN r.name AS name, r.version AS version, r.schema AS schema"
HINT = "load it again from its files, with rosprivacy load"
SHOWN_AT_MOST = 5  # robots in a message


def diagnostics_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return the value of the property ``diagnostics``."""
    return json.dumps([_as_dict(diagnostic) for diagnostic in diagnostics])


def _as_dict(diagnostic: Diagnostic) -> dict[str, Any]:
    place = diagnostic.place
    code = {"code": diagnostic.code} if diagnostic.code else {}
    said = {"file": place.file, "line": place.line, "severity": diagnostic.severity, "message": diagnostic.message}
    return said | code | ({"number": diagnostic.number} if diagnostic.number > 1 else {})


def diagnostics_of(robot: Mapping[str, Any]) -> tuple[Diagnostic, ...]:
    """Return what was said of a robot when it was loaded, from its properties."""
    return tuple(
        Diagnostic(
            Place(d["file"], d["line"]), Severity(d["severity"]), d["message"], d.get("code", ""), d.get("number", 1)
        )
        for d in json.loads(robot.get("diagnostics") or "[]")
    )


def loaded_with(robot: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a robot was loaded with: files by kind, and the one of the standard channels (rule S12)."""
    said = json.loads(robot.get("assumptions") or "{}")
    standard = said.get("standard_channels")
    files = [entry for kind in FILES for entry in said.get(kind, ())] + ([standard] if standard else [])
    if not all(isinstance(entry[key], str) for entry in files for key in ("file", "sha256")):
        raise TypeError("a file without a name or a hash")
    return {**said, "standard_channels": standard}


def unreadable(robot: Mapping[str, Any]) -> str:
    """Return which property of a robot is not as ``load`` writes it; empty if they are.

    >>> unreadable({"diagnostics": "[{}]"}), unreadable({"assumptions": '{"policies": 7}'}), unreadable({})
    ('diagnostics', 'assumptions', '')
    """
    for name, read in (("diagnostics", diagnostics_of), ("assumptions", loaded_with)):
        try:
            read(robot)
        except (AttributeError, KeyError, RecursionError, TypeError, ValueError):
            return name
    return ""


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
    names = ", ".join(map(shown, list(others)[:SHOWN_AT_MOST])) + (
        f" and {len(others) - SHOWN_AT_MOST:,} more" * (len(others) > SHOWN_AT_MOST)
    )
    which = "an earlier version" if all((schema or 1) < SCHEMA for schema in others.values()) else "another version"
    return (
        f"{'robot' if len(others) == 1 else 'robots'} {names} {'was' if len(others) == 1 else 'were'} loaded by {which}"
    )
