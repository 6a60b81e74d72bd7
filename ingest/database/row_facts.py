"""Rows of Neo4j -> flows, grants and what roles say: each row by itself.

In: the properties of one relationship or element. Out: facts of the model. A row that cannot be understood raises
``KeyError``, ``TypeError`` or ``ValueError``; ``read_back.py`` gathers them all.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import NAME, SEGMENT, Element, Flow, FlowGraph, Grant, Method, Place, Seen, Statement
from rosprivacy.ingest.database.flow_statements import DATABASE, HAND
from rosprivacy.ingest.labels.entries import EXACT, as_ranked_now
from rosprivacy.ingest.policies.names import covered

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

ADDED = "flow"  # the role of a flow that a person added
MATCHES = "matches"


def flow_of(row: tuple[int, int, str, str, Mapping[str, Any]], elements: tuple[Element, ...]) -> Flow:
    """Return a flow, with the policy lines that allow it."""
    source, target, role, _, said = row
    return Flow(
        source, target, role, grants_of(said, role, elements[target if elements[target].is_channel else source])
    )


def denied_flow_of(row: tuple[int, int, str, str, Mapping[str, Any]], elements: tuple[Element, ...]) -> Flow:
    """Return a flow that DENY lines take back."""
    flow, channel = flow_of(row, elements), elements[row[1] if elements[row[1]].is_channel else row[0]]
    lines = [json.loads(line) for line in row[4].get("denials") or ()]
    return flow._replace(denials=_lines(lines, row[2], channel, allow=False))


def grants_of(said: Mapping[str, Any], role: str, channel: Element) -> tuple[Grant, ...]:
    """Return the policy lines behind a flow."""
    lines = [said] if said.get("file") else []
    lines += [json.loads(line) for line in said.get("further") or ()]
    return _lines(lines, role, channel, allow=True)


def _lines(lines: Iterable[Mapping[str, Any]], role: str, channel: Element, *, allow: bool) -> tuple[Grant, ...]:
    return tuple(
        Grant(
            allow=allow,
            role=role,
            kind=channel.kind,
            name=channel.name,
            enclave=str(line.get("enclave") or ""),
            node=str(line.get("profile") or ""),
            place=Place(str(line["file"]), int(line.get("line") or 0)),
            seen=_seen(line),
        )
        for line in lines
    )


def _seen(line: Mapping[str, Any]) -> Seen | None:
    """When a line of an observed policy was seen in use (rule S16)."""
    if not line.get("first_seen"):
        return None
    return Seen(tuple(map(str, line.get("seen_by") or ())), str(line["first_seen"]), str(line.get("last_seen") or ""))


def subjects_of(properties: Mapping[str, Any]) -> tuple[str, ...]:
    """Return whom the data of a source are about."""
    groups = properties.get("subjects") or []
    if not isinstance(groups, list) or not all(isinstance(group, str) for group in groups):
        raise TypeError("subjects is not a list of texts")
    return tuple(sorted(set(groups)))


def role_facts_of(role: str, category: str, said: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return what a relationship says.

    (role, rank, place, method, stated, what it is made of, through, every, naming, why, author, pinned)
    """
    tier, specificity = said.get("tier", HAND), said.get("specificity", EXACT)
    place = Place(str(said.get("file") or DATABASE), int(said.get("line") or 0))
    method, stated = None, True
    if role == "sanitizer":
        method = Method(said["method"]) if said.get("method") else Method.PSEUDONYMISE
        stated = bool(said.get("stated", bool(said.get("method"))))
    made_of = str(said.get("of") or "")
    if role == "derivation" and not made_of:
        raise ValueError(f"it does not say of what it makes {category}: SET r.of = 'Video'")
    through = tuple(str(name) for name in said.get("through") or ())
    return (
        role,
        (int(tier), as_ranked_now(int(specificity))),
        place,
        method,
        stated,
        made_of,
        through,
        bool(said.get("every")),
        str(said.get("naming") or (NAME if int(specificity) >= EXACT else SEGMENT)),  # absent in earlier versions
        str(said.get("why") or ""),
        str(said.get("author") or ""),
        None if said.get("pinned") is None else tuple(str(name) for name in said["pinned"]),
    )


def flows_through(
    graph: FlowGraph, statements: Mapping[int, tuple[Statement, ...]]
) -> dict[tuple[int, tuple[str, ...]], tuple[int, ...]]:
    """Return the flows of sources that are sources only through some channels."""
    wanted = {(vertex, s.through) for vertex, said in statements.items() for s in said if s.through}
    vertices = {vertex for vertex, _ in wanted}
    leaving: dict[int, list[int]] = defaultdict(list)
    for index, flow in enumerate(graph.flows):
        if flow.source in vertices:
            leaving[flow.source].append(index)
    return {
        (vertex, names): tuple(
            index
            for index in leaving[vertex]
            if any(covered(name, (graph.elements[graph.flows[index].target].name,)) for name in names)
        )
        for vertex, names in sorted(wanted)
    }
