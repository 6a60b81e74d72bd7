"""What was said of an input and what a robot rests on, as a database keeps it: two properties of a ``Robot``.

In: diagnostics, properties. Out: JSON text, and the same facts again; what earlier versions wrote has no codes. People
can change both, so a reader asks first whether they can be read.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Diagnostic, Place, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

FILES = ("policies", "labels", "fleet")


def diagnostics_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return the value of the property ``diagnostics``."""
    return json.dumps([_as_dict(diagnostic) for diagnostic in diagnostics])


def _as_dict(diagnostic: Diagnostic) -> dict[str, Any]:
    place = diagnostic.place
    code = {"code": diagnostic.code} if diagnostic.code else {}
    said = {"file": place.file, "line": place.line, "severity": diagnostic.severity, "message": diagnostic.message}
    return said | code | ({"number": diagnostic.number} if diagnostic.number > 1 else {})


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


def loaded_with(robot: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a robot was loaded with: files by kind, and the one of the standard channels (rule S12)."""
    said = json.loads(robot.get("assumptions") or "{}")
    standard = said.get("standard_channels")
    files = [entry for kind in FILES for entry in said.get(kind, ())] + ([standard] if standard else [])
    if not all(isinstance(entry[key], str) for entry in files for key in ("file", "sha256")):
        raise TypeError("a file without a name or a hash")
    return {**said, "standard_channels": standard}


def diagnostics_of(robot: Mapping[str, Any]) -> tuple[Diagnostic, ...]:
    """Return what was said of a robot when it was loaded, from its properties."""
    return tuple(
        Diagnostic(
            Place(d["file"], d["line"]), Severity(d["severity"]), d["message"], d.get("code", ""), d.get("number", 1)
        )
        for d in json.loads(robot.get("diagnostics") or "[]")
    )
