"""A system's policies in one JSON file, to add to later: ``--save-graph`` and ``--add``.

In: policies, or a file saved before. Out: the same facts again, with file and line of each (the paper, section II-B:
'add new information from policy files to this graph'). Labels are not in it: they are a person's word on one day.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import GraphError, InputErrors
from rosprivacy.analysis.model import Grant, Place, Policy, Profile
from rosprivacy.ingest.policy import ROLES

if TYPE_CHECKING:
    from collections.abc import Iterable

FORMAT = "rosprivacy.graph/1"
_ROLES = {role: kind for kind, roles in ROLES.values() for role in roles}


def as_dict(policies: Iterable[Policy]) -> dict[str, Any]:
    """Return policies as plain values, in the order of their files."""
    return {"format": FORMAT, "policies": [_policy(policy) for policy in sorted(policies, key=lambda p: p.file)]}


def read_saved(file: str) -> tuple[Policy, ...]:
    """Read what ``as_dict`` was written from.

    Raises
    ------
    InputErrors
        If it is not such a file, or was changed so that it cannot be read.
    """
    try:
        data = json.loads(Path(file).read_bytes())
    except OSError as error:
        raise InputErrors([GraphError(file, 0, f"cannot be read: {error.strerror}", "correct the path")]) from None
    except (ValueError, RecursionError) as error:
        problem = GraphError(file, getattr(error, "lineno", 1), "not JSON", "save it again with --save-graph")
        raise InputErrors([problem]) from None
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        hint = "name a file written by --save-graph of this version"
        raise InputErrors([GraphError(file, 1, f"not a saved graph ({FORMAT})", hint)])
    try:
        return tuple(_read_policy(policy) for policy in data["policies"])
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        what = f"a damaged graph: {type(error).__name__} at {error}"
        raise InputErrors([GraphError(file, 1, what, "save it again with --save-graph")]) from None


def _policy(policy: Policy) -> dict[str, Any]:
    return {
        "file": policy.file,
        "sources": dict(policy.sources),
        "profiles": [
            {"enclave": p.enclave, "node": p.node, "file": p.place.file, "line": p.place.line} for p in policy.profiles
        ],
        "grants": [
            {
                "rule": "ALLOW" if grant.allow else "DENY",
                "role": grant.role,
                "name": grant.name,
                "enclave": grant.enclave,
                "node": grant.node,
                "file": grant.place.file,
                "line": grant.place.line,
            }
            for grant in policy.grants
        ],
    }


def _read_policy(saved: dict[str, Any]) -> Policy:
    profiles = [Profile(_text(p["enclave"]), _text(p["node"]), _place(p)) for p in saved["profiles"]]
    grants = [
        Grant(
            {"ALLOW": True, "DENY": False}[g["rule"]],
            g["role"],
            _ROLES[g["role"]],
            _text(g["name"]),
            _text(g["enclave"]),
            _text(g["node"]),
            _place(g),
        )
        for g in saved["grants"]
    ]
    sources = tuple(sorted((_text(name), _text(digest)) for name, digest in saved["sources"].items()))
    return Policy(_text(saved["file"]), sources, tuple(profiles), tuple(grants))


def _place(saved: dict[str, Any]) -> Place:
    line = saved["line"]
    if not isinstance(line, int):
        raise TypeError(f"line {line!r}")
    return Place(_text(saved["file"]), line)


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(repr(value))
    return value
