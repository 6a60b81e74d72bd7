"""What policy lines and labels say of flows and elements <-> properties of ``FLOWS_TO`` and of the roles.

In: flows, grants and statements, or the properties of one relationship. Out: the other. A row that cannot be understood
raises ``KeyError``, ``TypeError`` or ``ValueError``; ``read_back.py`` gathers them all. ``only`` and ``never`` of a
flow name what holds by rule S7; where a person changes one of these lists, it takes the place of all that files say by
that word, and outranks them.
"""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.kernel.ranks import decided
from rosprivacy.analysis.model import (
    BY_TYPE,
    CANNOT,
    GLOB,
    NAME,
    SEGMENT,
    STANDARD,
    Element,
    Flow,
    FlowGraph,
    Grant,
    Method,
    Place,
    Seen,
    Statement,
)
from rosprivacy.analysis.non_ros import BY_KIND
from rosprivacy.ingest.labels.entries import EXACT, as_ranked_now, is_log, without_text
from rosprivacy.ingest.neo4j_graph.schema import DATABASE
from rosprivacy.ingest.policies.names import covered

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.ontology.vocabulary import Vocabulary

    Row = dict[str, Any]
    Properties = Mapping[str, Any]

HAND = 2  # the tier of what a person added: above every file
WORDS = ("only", "never")
ADDED = "flow"  # the role of a flow that a person added
MATCHES = "matches"


def flow_row(robot: str, flow: Flow, source: str, target: str, properties: Row) -> Row:
    """Return the row of a flow between two ids, with the policy lines that allow it."""
    lines = [_grant_as_json(grant) for grant in flow.grants]
    of_lines = (
        {**lines[0], "further": [json.dumps(line, sort_keys=True) for line in lines[1:]] or None} if lines else {}
    )
    return {
        "source": source,
        "target": target,
        "properties": {"role": flow.role, "robot": robot, **of_lines, **properties},
    }


def allowed(result: Row, statements: Sequence[Statement], hierarchy: Hierarchy) -> Row:
    """Return the properties of an allowed flow: what the analysis says of it, and what labels say."""
    return {"decision": "allow", **result, **statement_properties(statements, hierarchy)}


def denied(flow: Flow) -> Row:
    """Return the properties of a flow that DENY lines take back."""
    lines = [json.dumps(_grant_as_json(grant), sort_keys=True) for grant in flow.denials]
    by = [str(grant.place) for grant in flow.denials]
    return {"decision": "deny", "carries": [], "denied_by": by, "denials": lines}


def _grant_as_json(grant: Grant) -> Row:
    row: Row = {"file": grant.place.file, "line": grant.place.line, "enclave": grant.enclave, "profile": grant.node}
    if grant.observation:
        row |= {
            "seen_by": list(grant.observation.by),
            "first_seen": grant.observation.first,
            "last_seen": grant.observation.last,
        }
    if grant.basis:
        row["basis"] = grant.basis
    return row


class FlowRow(NamedTuple):
    """A ``FLOWS_TO`` as it is stored: its ends by number, the server's key, its properties."""

    source: int
    target: int
    role: str
    key: str
    properties: Properties


def flow_of(row: FlowRow, elements: tuple[Element, ...]) -> Flow:
    """Return a flow, with the policy lines that allow it, or that take it back."""
    channel = elements[row.target if elements[row.target].is_channel else row.source]
    flow = Flow(row.source, row.target, row.role, grants_of(row.properties, row.role, channel))
    if row.properties.get("decision") != "deny":
        return flow
    return flow._replace(
        denials=_grants(map(json.loads, row.properties.get("denials") or ()), row.role, channel, allow=False)
    )


def grants_of(properties: Properties, role: str, channel: Element) -> tuple[Grant, ...]:
    """Return the policy lines that allow a flow."""
    lines = [properties] if properties.get("file") else []
    return _grants([*lines, *map(json.loads, properties.get("further") or ())], role, channel, allow=True)


def _grants(lines: Iterable[Properties], role: str, channel: Element, *, allow: bool) -> tuple[Grant, ...]:
    return tuple(
        Grant(
            allow=allow,
            role=role,
            kind=channel.kind,
            name=channel.name,
            enclave=str(line.get("enclave") or ""),
            node=str(line.get("profile") or ""),
            place=Place(str(line["file"]), int(line.get("line") or 0)),
            observation=_seen_in_use(line),
            basis=str(line.get("basis") or ""),
        )
        for line in lines
    )


def _seen_in_use(line: Properties) -> Seen | None:
    """When a line of an observed policy was seen in use (rule S16)."""
    if not line.get("first_seen"):
        return None
    return Seen(tuple(map(str, line.get("seen_by") or ())), str(line["first_seen"]), str(line.get("last_seen") or ""))


def statement_properties(statements: Sequence[Statement], hierarchy: Hierarchy) -> Row:
    """Return the properties of a flow of which labels say something: each statement, and two lists for people."""
    words = {statement.role for statement in statements}
    return {
        **{word: list(names) if word in words else None for word, names in _holding(statements, hierarchy).items()},
        "naming": GLOB if statements and all(statement.naming == GLOB for statement in statements) else None,
        "said_at": sorted({str(statement.place) for statement in statements}) or None,
        "statements": [json.dumps(_statement_as_json(statement), sort_keys=True) for statement in statements] or None,
    }


def names_of(properties: Properties) -> set[str]:
    """Return the categories that what is stored of a flow names."""
    stated = {name for statement in _stated(properties) for name in statement.categories}
    return stated.union(*(_names(properties, word) for word in WORDS))


def statements_of(properties: Properties, hierarchy: Hierarchy) -> tuple[Statement, ...]:
    """Return what is stored as statements: those of files as they were, but for a list that a person changed."""
    stated = _stated(properties)
    holding = _holding(stated, hierarchy)
    listed = {word: _names(properties, word) for word in WORDS}
    changed = [word for word in WORDS if listed[word] != holding[word]]
    by_hand = [Statement(word, listed[word], (HAND, EXACT), Place(DATABASE, 0)) for word in changed if listed[word]]
    return (*(statement for statement in stated if statement.role not in changed), *by_hand)


def _holding(statements: Sequence[Statement], hierarchy: Hierarchy) -> dict[str, tuple[str, ...]]:
    """By word, the names of which one of its statements holds."""
    named = sorted({name for statement in statements for name in statement.categories})
    holding = {name: decided("", statements, name, hierarchy).accepted for name in named}
    return {
        word: tuple(n for n in named if any(s.role == word and n in s.categories for s in holding[n])) for word in WORDS
    }


def _statement_as_json(statement: Statement) -> Row:
    tier, specificity = statement.rank
    return {
        "role": statement.role,
        "categories": statement.categories,
        "tier": tier,
        "specificity": specificity,
        "naming": statement.naming,
        "file": statement.place.file,
        "line": statement.place.line,
        **{key: text for key, text in (("why", statement.why), ("author", statement.author)) if text},
        **({} if statement.pinned is None else {"pinned": statement.pinned}),
    }


def _stated(properties: Properties) -> list[Statement]:
    return [
        Statement(
            fields["role"],
            tuple(fields["categories"]),
            (int(fields["tier"]), int(fields["specificity"])),
            Place(str(fields["file"]), int(fields["line"])),
            naming=fields["naming"],
            why=str(fields.get("why") or ""),
            author=str(fields.get("author") or ""),
            pinned=tuple(fields["pinned"]) if "pinned" in fields else None,
        )
        for fields in map(json.loads, properties.get("statements") or ())
    ]


def _names(properties: Properties, word: str) -> tuple[str, ...]:
    names = properties.get(word) or []
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise TypeError(f"{word} is not a list of names")
    return tuple(sorted(set(names)))


def add_roles(
    rows: dict[str, list[Row]], robot: str, key: str, statements: Iterable[Statement], vocabulary: Vocabulary
) -> None:
    """Add one relationship per category that a statement names; one about every category goes to those at the top."""
    top = [category.name for category in vocabulary.categories.values() if not category.broader]
    for statement in statements:
        if statement.rank == BY_KIND or statement.role in (CANNOT, BY_TYPE):
            continue  # nobody said it; who reads the graph takes it so too
        properties: Row = {
            "file": statement.place.file,
            "line": statement.place.line,
            "tier": statement.rank[0],
            "specificity": statement.rank[1],
            "naming": statement.naming,
            "every": None if statement.categories else True,
            "robot": robot,
            "why": statement.why or None,
            "author": statement.author or None,
            "pinned": None if statement.pinned is None else list(statement.pinned),
            **_particulars(statement),
        }
        for name in [statement.to] if statement.role == "derivation" else statement.categories or top:
            iri = vocabulary.categories[name].iri
            rows.setdefault(statement.role, []).append({"source": key, "target": iri, "properties": properties})


def _particulars(statement: Statement) -> Row:
    if statement.role == "source":
        return {"through": list(statement.through) or None}
    if statement.role == "sanitizer":
        return {"method": str(statement.method) if statement.method else None, "stated": statement.stated}
    return {"of": statement.categories[0]} if statement.role == "derivation" else {}


def role_of(role: str, category: str, properties: Properties) -> Statement:
    """Return what the properties of a role say, without its categories; one without ``tier`` is a person's later word.

    ``shipped`` is whether it is said of every category.
    """
    specificity, method, stated = int(properties.get("specificity", EXACT)), None, True
    if role == "sanitizer":
        method = Method(properties["method"]) if properties.get("method") else Method.PSEUDONYMISE
        stated = bool(properties.get("stated", bool(properties.get("method"))))
    earlier = NAME if specificity >= EXACT else SEGMENT  # of versions that wrote no naming
    made_of = str(properties.get("of") or "")
    if role == "derivation" and not made_of:
        raise ValueError(f"it does not say of what it makes {category}: SET r.of = 'Video'")
    return Statement(
        role,
        (),
        (int(properties.get("tier", HAND)), as_ranked_now(specificity)),
        Place(str(properties.get("file") or DATABASE), int(properties.get("line") or 0)),
        method,
        stated,
        made_of,
        tuple(map(str, properties.get("through") or ())),
        shipped=bool(properties.get("every")),
        naming=str(properties.get("naming") or earlier),
        why=str(properties.get("why") or ""),
        author=str(properties.get("author") or ""),
        pinned=None if properties.get("pinned") is None else tuple(map(str, properties["pinned"])),
    )


def role_statements(
    roles: Iterable[tuple[str, Statement]], element: Element, vocabulary: Vocabulary
) -> Iterator[Statement]:
    """Return what is said of an element; the categories that one label of a channel names stand together again.

    Parameters
    ----------
    roles
        (category, what ``role_of`` returns of it).
    """
    together: dict[tuple[Any, ...], list[str]] = defaultdict(list)
    for category, statement in roles:
        alone = () if statement.role in ("only", "never", "mundane") or statement.shipped else (category,)
        facts = (*statement, *alone)
        together[facts].append(category)
    for key, categories in sorted(together.items(), key=lambda item: str(item[0])):
        statement = Statement(*key[: len(Statement._fields)])
        names, to = () if statement.shipped else tuple(sorted(categories)), statement.to
        if statement.role == "derivation":  # it is stored the other way round: the target is what is made
            names, to = (statement.to,), categories[0]
        shipped = statement.role == "mundane" and statement.rank[0] <= STANDARD
        if shipped and statement.rank[0] == STANDARD and is_log(element.name):  # earlier versions: of every kind
            names = without_text(vocabulary)
        yield statement._replace(categories=names, to=to, shipped=shipped)


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
