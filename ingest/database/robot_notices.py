"""What was said of an input, as a database keeps it: one property of a ``Robot``.

In: diagnostics. Out: JSON text, and the same diagnostics again; what earlier versions wrote has no codes.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Diagnostic, Place, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def diagnostics_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return the value of the property ``diagnostics``."""
    return json.dumps([_as_dict(diagnostic) for diagnostic in diagnostics])


def _as_dict(diagnostic: Diagnostic) -> dict[str, Any]:
    place = diagnostic.place
    code = {"code": diagnostic.code} if diagnostic.code else {}
    said = {"file": place.file, "line": place.line, "severity": diagnostic.severity, "message": diagnostic.message}
    return said | code


def diagnostics_of(robot: Mapping[str, Any]) -> tuple[Diagnostic, ...]:
    """Return what was said of a robot when it was loaded, from its properties."""
    return tuple(
        Diagnostic(Place(d["file"], d["line"]), Severity(d["severity"]), d["message"], d.get("code", ""))
        for d in json.loads(robot.get("diagnostics") or "[]")
    )
