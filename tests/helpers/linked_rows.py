"""The register of processing as linked data has it: the rows of the JSON document, put together from RDF alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rdflib import RDF, RDFS, Literal

from rosprivacy.analysis.legal import GROUPS, group_of
from rosprivacy.report.rdf.terms import DPV, RP

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rdflib import Graph
    from rdflib.term import Node

ROLES: Mapping[Node, str] = {
    DPV.DataController: "controller", DPV.JointDataControllers: "joint-controller", DPV.DataProcessor: "processor",
    DPV.ThirdParty: "third-party",
}  # fmt: skip
ANYBODY = "whoever receives what "
BASES = ("bases", "special_bases", "criminal_bases")


def rows_told(graph: Graph) -> dict[str, dict[str, Any]]:
    """Return id -> row; lists are sorted, as RDF has no order."""
    rows = [_row(graph, iri) for iri in graph.subjects(RDF.type, RP.RegisterRow)]
    return {row["id"]: row for row in rows}


def comparable(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row of the JSON document whose lists are sorted; what stands in it twice, once.

    Of a fleet with its robots, without what only decisions need.
    """
    plain = {**row, "robots": row.get("fleet", {}).get("robots", [])}
    return {key: _sorted(value) if isinstance(value, list) else value for key, value in plain.items() if key != "fleet"}


def _sorted(values: list[Any]) -> list[Any]:
    return sorted({repr(value): value for value in values}.values(), key=repr)


def _value(graph: Graph, node: Node, predicate: Node, default: Any = None) -> Any:
    values = [*graph.objects(node, predicate)]
    assert len(values) <= 1, (node, predicate, values)
    return values[0].toPython() if values and isinstance(values[0], Literal) else values[0] if values else default


def _texts(graph: Graph, node: Node, *way: Node) -> list[str]:
    nodes = [node]
    for step in way:
        nodes = [value for one in nodes for value in graph.objects(one, step)]
    return sorted({str(one) for one in nodes})


def _element(graph: Graph, iri: Node) -> dict[str, Any]:
    told = {key: _value(graph, iri, RP[key]) for key in ("robot", "kind", "name", "leg", "pattern")}
    return {
        "robot": told["robot"] or "",
        "kind": told["kind"],
        "name": told["name"],
        **({"leg": told["leg"]} if told["leg"] else {}),
        **({"pattern": True} if told["pattern"] else {}),
    }


def _elements(graph: Graph, iri: Node, predicate: Node) -> list[Any]:
    return _sorted([_element(graph, element) for element in graph.objects(iri, predicate)])


def _kind(graph: Graph, node: Node, predicate: Node) -> str:
    return str(_value(graph, node, predicate)).removeprefix(str(RP))


def _measure(graph: Graph, node: Node) -> dict[str, Any]:
    told = {key: _value(graph, node, RP[key]) for key in ("method", "stated", "everywhere")}
    return {"element": _element(graph, _value(graph, node, RP.at)), "category": _kind(graph, node, RP.cleans), **told}


def _derivation(graph: Graph, node: Node) -> dict[str, Any]:
    ends = {"from": _kind(graph, node, RP.arrivesAs), "to": _kind(graph, node, RP.leavesAs)}
    return {"element": _element(graph, _value(graph, node, RP.at)), **ends}


def _durations(graph: Graph, iri: Node, *, of_backups: bool) -> list[str]:
    conditions = graph.objects(iri, DPV.hasStorageCondition)
    wanted = [one for one in conditions if _value(graph, one, RP.ofBackups) is of_backups]
    return sorted(str(time) for one in wanted for time in graph.objects(one, DPV.hasDuration))


def _one(values: list[str]) -> str:
    assert len(values) <= 1, values
    return values[0] if values else ""


def _row(graph: Graph, iri: Node) -> dict[str, Any]:
    stated = _texts(graph, iri, RP.statedLegalBasis)
    recipients = [*graph.objects(iri, DPV.hasRecipient)]
    roles = {role for one in recipients for kind in graph.objects(one, RDF.type) if (role := ROLES.get(kind))}
    operators = {name for one in recipients for name in _texts(graph, one, RDFS.label) if not name.startswith(ANYBODY)}
    encrypted = _value(graph, iri, RP.encrypted)
    more, backups = _durations(graph, iri, of_backups=True), _value(graph, iri, RP.backups)
    return {
        "id": _value(graph, iri, RP.id),
        "robots": _texts(graph, iri, RP.onRobot),
        "category": _kind(graph, iri, RP.category),
        "places": _elements(graph, iri, RP.place),
        "pseudonymised": _value(graph, iri, RP.pseudonymised),
        "article9": _value(graph, iri, RP.article9),
        "sources": _elements(graph, iri, DPV.hasDataSource),
        "derivations": _sorted([_derivation(graph, one) for one in graph.objects(iri, RP.derivation)]),
        "measures": _sorted([_measure(graph, one) for one in graph.objects(iri, DPV.hasTechnicalMeasure)]),
        "subjects": _texts(graph, iri, DPV.hasDataSubject, RDFS.label),
        "contexts": _texts(graph, iri, RP.context),
        "countries": _texts(graph, iri, RP.sourceCountry),
        "purposes": _texts(graph, iri, DPV.hasPurpose, RDFS.label),
        "controllers": _texts(graph, iri, DPV.hasDataController, RDFS.label),
        "officers": _texts(graph, iri, DPV.hasDataProtectionOfficer, RDFS.label),
        **{
            key: [basis for basis in stated if group_of(basis) == group]
            for key, group in zip(BASES, GROUPS, strict=False)
        },
        "safeguards": _texts(graph, iri, RP.statedSafeguard),
        "operator": _one(sorted(operators)),
        "recipient": _one(sorted(roles)),
        "contract": _value(graph, iri, RP.contract, ""),
        "country": _one(_texts(graph, iri, DPV.hasCountry, RP.country)),
        "area": _value(graph, iri, RP.area, ""),
        "transfer": _value(graph, iri, RP.transferBasis, ""),
        "retention": _durations(graph, iri, of_backups=False),
        "backups": _one(more) or backups,
        "encrypted": None if encrypted is None else encrypted == "yes",
        "look_at": _texts(graph, iri, RP.lookAt, RP.identifier),
        "findings": _texts(graph, iri, RP.found, RP.id),
        "state": _value(graph, iri, RP.state),
        "to_complete": _texts(graph, iri, RP.toComplete),
    }
