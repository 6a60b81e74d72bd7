"""Where personal data can go in a ROS 2 system: SROS 2 policies and labels in, leak paths per category out.

>>> import rosprivacy
>>> result = rosprivacy.analyze(["examples/factory/before.policy.xml"], ["examples/factory/run2.labels.yaml"])
>>> str(result.analysis.verdict)
'leak'

What is public stands in ``__all__``, and is imported when it is used. ``docs/python.md`` tells how to work with it.
"""

from __future__ import annotations

from importlib import import_module

from rosprivacy.version import __version__

TYPE_CHECKING = False  # as type checkers know it; to import ``typing`` takes as long as Python's own start
if TYPE_CHECKING:
    from typing import Any

    from rosprivacy.analysis.answer import Analysis, Finding, Verdict
    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.errors import (
        BagError,
        ClusterError,
        DatabaseError,
        DecisionError,
        DrawingError,
        FleetError,
        GraphError,
        InputError,
        InputErrors,
        LabelError,
        LimitsError,
        MiddlewareError,
        ModelError,
        ObservationError,
        OntologyError,
        PackageError,
        PolicyError,
        QueryError,
        RosPrivacyError,
        TypesError,
    )
    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.modes import View
    from rosprivacy.api import analyze, analyze_fleet, explore, parse_labels, suggest, suggest_fleet
    from rosprivacy.explorer.session import FleetSession, Session
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.result import Result

__all__ = [
    "Analysis",
    "BagError",
    "Bounds",
    "ClusterError",
    "DatabaseError",
    "DecisionError",
    "DrawingError",
    "Element",
    "Finding",
    "FleetError",
    "FleetSession",
    "GraphError",
    "InputError",
    "InputErrors",
    "LabelError",
    "Labels",
    "LimitsError",
    "MiddlewareError",
    "ModelError",
    "ObservationError",
    "OntologyError",
    "PackageError",
    "PolicyError",
    "QueryError",
    "Result",
    "RosPrivacyError",
    "Session",
    "Suggested",
    "TypesError",
    "Verdict",
    "View",
    "__version__",
    "analyze",
    "analyze_fleet",
    "explore",
    "parse_labels",
    "suggest",
    "suggest_fleet",
]
_ERRORS = "analysis.errors"
_MODULES = {  # where a name that is no error stands
    "Analysis": "analysis.answer",
    "Bounds": "analysis.bounds",
    "Element": "analysis.model",
    "Finding": "analysis.answer",
    "FleetSession": "explorer.session",
    "Labels": "ingest.labels.label_file",
    "Result": "result",
    "Suggested": "labelling.suggesting",
    "Session": "explorer.session",
    "Verdict": "analysis.answer",
    "View": "analysis.modes",
    "analyze": "api",
    "analyze_fleet": "api",
    "explore": "api",
    "parse_labels": "api",
    "suggest": "api",
    "suggest_fleet": "api",
}


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found = getattr(import_module(f"{__name__}.{_MODULES.get(name, _ERRORS)}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
