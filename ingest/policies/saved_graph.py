"""A system's policies in one JSON file, to add to later: ``--save-graph`` and ``--add``.

In: policies, or a file saved before. Out: the same facts again, with file and line of each (the paper, section II-B:
'add new information from policy files to this graph'). Labels are not in it: they are a person's word on one day.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from itertools import islice
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import GraphError, InputErrors, shown
from rosprivacy.analysis.json_values import BOUND, misfits, parsed, validator
from rosprivacy.analysis.model import (
    ACCESS_GAP,
    DEAD_DENY,
    NOT_READ,
    UNREAD_FILE,
    Diagnostic,
    Grant,
    Place,
    Policy,
    Profile,
    Protection,
    Seen,
    Severity,
    TopicProtection,
)
from rosprivacy.ingest.policies.names import DDS
from rosprivacy.ingest.policies.policy_xml import ROLES
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.reading.file_kinds import SAVED_GRAPH, kind_of_file
from rosprivacy.ingest.types import types_file

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from jsonschema.protocols import Validator

    from rosprivacy.ingest.types.types_file import TypesFile

FORMAT = "rosprivacy.graph/1"
MAX_BYTES = 2**30
REMEDY = "save it again with --save-graph"
_REPEATED = re.compile(r"enclave (.+) again \(first at |several <profiles> in enclave (.+): DDS uses", re.DOTALL)
UNKNOWN = (
    "saved by an earlier version, which did not keep which names a policy writes absolute: all are taken so, as they "
    "stand here; save it again from the policies"
)
UNPROTECTED = (
    "saved by an earlier version, which did not keep what the governance says of encryption: whether others on the "
    "network can read what is sent is not known; save it again from the keystore"
)
_ROLES = {role: kind for kind, roles in ROLES.values() for role in roles}


@dataclass(frozen=True, slots=True)
class Saved:
    """What a file keeps of a system: policies, what was not read, and observed types."""

    policies: tuple[Policy, ...]
    diagnostics: tuple[Diagnostic, ...] = ()
    types: tuple[TypesFile, ...] = ()


def as_dict(
    policies: Iterable[Policy], diagnostics: Iterable[Diagnostic] = (), types: Iterable[TypesFile] = ()
) -> dict[str, Any]:
    """Return policies as plain values, in the order of their files.

    Parameters
    ----------
    diagnostics
        Of the reading: what was not read is kept, since the answer hangs on it (rule S11).
    types
        That were observed (rule S15).
    """
    observed = [types_file.as_dict(one) for one in types]
    policies = tuple(policies)
    own = {d for policy in policies for d in policy.diagnostics}
    left = dict.fromkeys(d for d in diagnostics if d.code in (NOT_READ, UNREAD_FILE, ACCESS_GAP) and d not in own)
    return {
        "format": FORMAT,
        "policies": [_policy(policy) for policy in sorted(policies, key=lambda p: p.file)],
        **({"not_read": [_diagnostic(d) for d in left]} if left else {}),
        **({"types": observed} if observed else {}),
    }


def read_saved(file: str) -> Saved:
    """Read what ``as_dict`` was written from: policies, what was not read, and observed types.

    Raises
    ------
    InputErrors
        If it is not such a file, or was changed so that it cannot be read.
    """

    def fail(line: int, problem: str, hint: str) -> GraphError:
        return GraphError(file, line, problem, hint)

    try:
        return _read(file, fail)
    except GraphError as error:
        raise InputErrors([_of_another_kind(file) or error]) from None


def _of_another_kind(file: str) -> GraphError | None:
    """What is wrong with a file that is something else by its content; None of any other."""
    try:
        kind = kind_of_file(file)
    except (OSError, ValueError):
        return None  # who reads it says why not
    return None if kind in (None, SAVED_GRAPH) else GraphError(file, 1, *kind.refused(SAVED_GRAPH.name, file))


def _read(file: str, fail: Callable[[int, str, str], GraphError]) -> Saved:
    data = parsed(read_regular(file, MAX_BYTES, fail), fail, REMEDY)
    said = data.get("format") if isinstance(data, dict) else None
    if said != FORMAT:
        newer = isinstance(said, str) and said.startswith("rosprivacy.graph/")
        hint = "use the version of rosprivacy that wrote it" if newer else "name a file written by --save-graph"
        raise fail(0, f"not a saved graph ({FORMAT})", f"{hint}, or {REMEDY}")
    wrong = misfits(_validator(), data) or list(islice(_unowned(data["policies"]), BOUND))
    if wrong:
        raise InputErrors([fail(0, f"a damaged graph: {one}", REMEDY) for one in wrong])
    policies = tuple(_read_policy(policy) for policy in data["policies"])
    if any("absolute" not in grant for policy in data["policies"] for grant in policy["grants"]):
        first = policies[0]
        told = (*first.diagnostics, Diagnostic(Place(file, 1), Severity.WARNING, UNKNOWN))
        policies = (replace(first, diagnostics=told), *policies[1:])
    left = tuple(map(_read_diagnostic, data.get("not_read", ())))
    if any("protections" not in p and any(g.get("kind") == DDS for g in p["grants"]) for p in data["policies"]):
        left = (*left, Diagnostic(Place(file, 1), Severity.WARNING, UNPROTECTED, ACCESS_GAP))
    return Saved(policies, left, tuple(map(types_file.from_dict, data.get("types", ()))))


@cache
def _validator() -> Validator:
    schema = files("rosprivacy.ingest.policies").joinpath("saved_graph.schema.json")
    return validator(json.loads(schema.read_text("utf-8")))


def _unowned(policies: Iterable[dict[str, Any]]) -> Iterator[str]:
    """Grants of profiles that are not there, and lines of files that were not read."""
    for number, policy in enumerate(policies):
        owners = {(profile["enclave"], profile["node"]) for profile in policy["profiles"]}
        for index, grant in enumerate(policy["grants"]):
            at = f"policies[{number}].grants[{index}]"
            if (grant["enclave"], grant["node"]) not in owners:
                yield f"{at} is of a node that has no profile in its enclave"
            if grant["file"] not in policy["sources"] and "basis" not in grant:  # a line of code is in no source
                yield f"{at}.file is not in the sources of its policy"


def _policy(policy: Policy) -> dict[str, Any]:
    return {
        "file": policy.file,
        "sources": dict(policy.sources),
        "profiles": [
            {
                "enclave": p.enclave,
                "node": p.node,
                "file": p.place.file,
                "line": p.place.line,
                **({"participant": p.participant} if p.participant else {}),
            }
            for p in policy.profiles
        ],
        "grants": [
            {
                "rule": "ALLOW" if grant.allow else "DENY",
                "role": grant.role,
                "name": grant.name,
                **({"kind": grant.kind, "rank": grant.rank} if grant.kind == DDS else {}),
                "absolute": grant.absolute,
                "enclave": grant.enclave,
                "node": grant.node,
                "file": grant.place.file,
                "line": grant.place.line,
                **({} if grant.allow and not grant.dead else {"dead": grant.dead}),
                **({"seen": _observation(grant.observation)} if grant.observation else {}),
                **({"basis": grant.basis} if grant.basis else {}),
            }
            for grant in policy.grants
        ],
        **({"protections": [_protection(one) for one in policy.protections]} if _is_deployed(policy) else {}),
        "diagnostics": [_diagnostic(d) for d in policy.diagnostics],
    }


def _is_deployed(policy: Policy) -> bool:
    """Whether it is made of permissions."""
    return bool(policy.protections) or any(grant.kind == DDS for grant in policy.grants)


def _protection(protection: Protection) -> dict[str, Any]:
    topics = [
        {"expression": t.expression, "encrypted": t.encrypted, "file": t.place.file, "line": t.place.line}
        for t in protection.topics
    ]
    strangers = (
        {"strangers": {"file": protection.strangers.file, "line": protection.strangers.line}}
        if protection.strangers
        else {}
    )
    return {"topics": topics, **strangers}


def _read_protection(saved: dict[str, Any]) -> Protection:
    topics = (TopicProtection(t["expression"], t["encrypted"], _place(t)) for t in saved["topics"])
    return Protection(tuple(topics), _place(saved["strangers"]) if "strangers" in saved else None)


def _observation(observation: Seen) -> dict[str, Any]:
    return {"by": list(observation.by), "first": observation.first, "last": observation.last}


def _read_seen(saved: dict[str, Any]) -> Seen:
    return Seen(tuple(saved["by"]), saved["first"], saved["last"])


def _diagnostic(d: Diagnostic) -> dict[str, Any]:
    return {
        "severity": str(d.severity),
        "message": d.message,
        "file": d.place.file,
        "line": d.place.line,
        **({"code": d.code} if d.code else {}),
    }


def _read_diagnostic(saved: dict[str, Any]) -> Diagnostic:
    return Diagnostic(_place(saved), Severity(saved["severity"]), saved["message"], saved.get("code", ""))


def _read_policy(saved: dict[str, Any]) -> Policy:
    profiles = tuple(Profile(p["enclave"], p["node"], _place(p), p.get("participant", "")) for p in saved["profiles"])
    grants = [
        Grant(
            allow=g["rule"] == "ALLOW",
            role=g["role"],
            kind=g.get("kind", _ROLES[g["role"]]),
            name=g["name"],
            enclave=g["enclave"],
            node=g["node"],
            place=_place(g),
            policy=saved["file"],
            dead=g.get("dead", False),
            absolute=g.get("absolute", True),
            observation=_read_seen(g["seen"]) if "seen" in g else None,
            rank=g.get("rank", 0),
            basis=g.get("basis", ""),
        )
        for g in saved["grants"]
    ]
    said = list(map(_read_diagnostic, saved["diagnostics"]))
    if any(g["rule"] == "DENY" and "dead" not in g for g in saved["grants"]):
        grants, more = _of_earlier_version(grants, said)
        said += more
    sources = tuple(sorted(saved["sources"].items()))
    protections = tuple(map(_read_protection, saved.get("protections", ())))
    return Policy(saved["file"], sources, profiles, tuple(grants), tuple(said), saved=True, protections=protections)


def _of_earlier_version(grants: list[Grant], diagnostics: Iterable[Diagnostic]) -> tuple[list[Grant], list[Diagnostic]]:
    """Grants of a graph that does not say which lines sros2 does not read: those that may be such take nothing away.

    The warning about a second ``<profiles>`` or ``<enclave>`` says where it begins; what stands there or below, and
    what is included from another file, may belong to it.
    """
    again = [(d.place, match[1] or match[2]) for d in diagnostics if (match := _REPEATED.match(d.message))]
    read: list[Grant] = []
    told: dict[Diagnostic, None] = {}
    for grant in grants:
        file, line = grant.place.file, grant.place.line
        starts = [p for p, path in again if path == grant.enclave and (p.file != file or p.line <= line)]
        read.append(grant._replace(dead=bool(starts)))
        if starts and not grant.allow:
            message = f"DENY of {shown(grant.name)} is taken as dead: the graph was saved by an earlier version, which"
            told[Diagnostic(grant.place, Severity.WARNING, f"{message} does not say; {REMEDY}", DEAD_DENY)] = None
    return read, list(told)


def _place(saved: dict[str, Any]) -> Place:
    return Place(saved["file"], saved["line"])
