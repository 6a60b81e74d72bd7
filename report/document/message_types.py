"""The message types of channels, as the document tells them (rule S15)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.report.document.element_entry import element_dict

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Finding
    from rosprivacy.analysis.model import Element, MessageType
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.analysis import AnalysisDocument, ClosedEntry
    from rosprivacy.report.contract.stated import TypeEntry, TypesEntry


def with_types(document: AnalysisDocument, answer: Answer) -> AnalysisDocument:
    """Return a document with the types of channels, where any are known, and what only these close."""
    closed = answer.shown.closed
    types: list[TypesEntry] = [
        {"element": element_dict(element), "types": [_type(one) for one in some]}
        for element, some in typed_channels(answer)
    ]
    if types:
        document["types"] = types
    if closed:
        document["assumptions"]["type_limits_reached"] = [
            {"element": element_dict(element), "categories": list(categories)}
            for element, categories in closed.channels
        ]
        document["assumptions"]["closed_by_types"] = [_closed(finding) for finding in closed.findings]
    return document


def typed_channels(answer: Answer) -> list[tuple[Element, tuple[MessageType, ...]]]:
    """Return the types of each channel that has any, in the order of the graph; both sides of a wildcard once."""
    elements = answer.analysis.graph.elements
    together: dict[Any, tuple[Element, dict[MessageType, None]]] = {}
    beside = answer.fleet.likeness.second if answer.fleet else ()
    for vertex, types in answer.bound.types.items():
        element = elements[vertex]
        if element.robot in beside:
            continue
        together.setdefault(element.shown_as, (element, {}))[1].update(dict.fromkeys(types))
    return [(element, tuple(some)) for element, some in together.values()]


def _closed(finding: Finding) -> ClosedEntry:
    return {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "source": element_dict(finding.source),
        "leak": element_dict(finding.leak),
        "dismissed": finding.dismissed,
    }


def _type(one: MessageType) -> TypeEntry:
    told: TypeEntry = {"type": one.name, "stated": one.stated, "file": one.place.file, "line": one.place.line}
    if one.hash:
        told["hash"] = one.hash
    if one.writers:
        told["writers"] = list(one.writers)
    if one.readers:
        told["readers"] = list(one.readers)
    if one.first:
        told["first"] = one.first
    if one.last:
        told["last"] = one.last
    return told
