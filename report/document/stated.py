"""What is stated, in the JSON document: of categories and law by the ontology, of elements by people.

In: a ``Document``, or its parts. Out: entries, sorted or in the order of the graph. No verdict: national law stands
there with its country, and who shows it chooses by the countries that are stated.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.contexts import article9_in, revealed
from rosprivacy.analysis.model import GDPR_APPLIES
from rosprivacy.analysis.non_ros import DEFAULT_ROLES, limited, not_stated
from rosprivacy.report.document.records import element_dict

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding
    from rosprivacy.analysis.findings.processed import Processed
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.model import (
        ByCategory,
        Category,
        Element,
        Legal,
        MessageType,
        NonRosFacts,
        Processing,
    )
    from rosprivacy.analysis.model.recording import Recording
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.document.contents import Document, StatedProcessing
    from rosprivacy.report.schemas.analysis import AnalysisDocument, ClosedEntry
    from rosprivacy.report.schemas.notation import Texts
    from rosprivacy.report.schemas.stated import (
        CategoryEntry,
        ContextEntry,
        NonRosEntry,
        NonRosNotKnown,
        NonRosStated,
        PersonGroupEntry,
        PointerEntry,
        ProcessedEntry,
        ProcessingEntry,
        ProvisionEntry,
        RecordingEntry,
        SurroundingsEntry,
        TypeEntry,
        TypesEntry,
    )

# Of what is stated of an element outside ROS: what stands in other entries of the document.
IN_OTHER_ENTRIES = ("limits", "adequacy", "until", "place", "day")
KEYS = {"name": "provision"}  # what the contract calls otherwise than the model


def category_entry(category: Category, hierarchy: Hierarchy, contexts: frozenset[str]) -> CategoryEntry:
    """Return a category that is emitted, with the law that its data can fall under."""
    return {
        "name": category.name,
        "iri": category.iri,
        "broader": hierarchy.broader(category.name),
        "title": category.title,
        "definition": category.definition,
        "data_types": list(category.data_types),
        "identity_factors": list(category.identity_factors),
        "gdpr": category.gdpr,
        "article9": article9_in(category, contexts),
        "reason": category.reason,
        "law": [_legal(legal) for legal in category.law],
        "in_context": [{**_legal(legal), "context": legal.context} for legal in revealed(category, contexts)],
        "look_at": list(category.look_at),
        "translations": _texts(category.translations),
    }


def _texts(texts: Mapping[str, Mapping[str, str]]) -> Texts:
    """Language -> texts in it, those that there are; English stands where the facts are."""
    named = {
        language: {KEYS.get(what, what): text for what, text in of.items() if text}
        for language, of in sorted(texts.items())
    }
    return {language: dict(sorted(of.items())) for language, of in named.items() if of}


def _legal(legal: Legal) -> ProvisionEntry:
    return {
        "provision": legal.name,
        "iri": legal.iri,
        "meaning": legal.meaning,
        "verdict": legal.verdict,
        "condition": legal.condition,
        "stated_of": legal.stated_of,
        "sources": list(legal.sources),
        "as_of": legal.as_of,
        "translations": _texts(legal.translations),
    }


def situations(vocabulary: Vocabulary, contexts: Collection[str]) -> list[ContextEntry]:
    """Return the contexts that are stated, with what they mean."""
    return [
        {
            "name": situation.name,
            "title": situation.title,
            "definition": situation.definition,
            "translations": _texts(situation.translations),
        }
        for situation in vocabulary.pointed.situations
        if situation.name in contexts
    ]


def known_groups(document: Document) -> list[PersonGroupEntry]:
    """Return the groups of the closed list that the words of labels stand for, with these words."""
    words = sorted({stated for _, groups in document.subjects for stated in groups})
    pointed = document.vocabulary.pointed
    stated_as = {group.name: [word for word in words if pointed.group_of(word) == group] for group in pointed.groups}
    return [
        {
            "name": group.name,
            "title": group.title,
            "vulnerable": group.vulnerable,
            "subjects": stated_as[group.name],
            "translations": _texts(group.translations),
        }
        for group in pointed.groups
        if stated_as[group.name]
    ]


def pointers(document: Document) -> list[PointerEntry]:
    """Return the provisions to look at, with the categories and contexts that call for each; every system with none.

    What the persons of a source call for, the kinds that it brings in do.
    """
    vocabulary = document.vocabulary
    emitted = [vocabulary.categories[name] for name in document.analysis.emitted]
    persons: dict[str, set[str]] = defaultdict(set)
    for source, groups in document.subjects:
        for category in document.brought_in.get(source, ()):
            persons[category].update(groups)
    return [
        {
            "provision": pointer.name,
            "iri": pointer.iri,
            "title": pointer.title,
            "meaning": pointer.meaning,
            "as_of": pointer.as_of,
            "applies_from": pointer.applies,
            "confirmed": pointer.confirmed,
            "adopted": pointer.adopted,
            "country": pointer.country,
            "address": pointer.address,
            "categories": list(kinds),
            "contexts": list(where),
            "translations": _texts(pointer.translations),
        }
        for pointer, kinds, where in vocabulary.pointed.rows(emitted, document.contexts.everywhere, persons)
    ]


def surroundings(document: Document) -> list[SurroundingsEntry]:
    """Return where the elements that bring data in work, as people state it of them or of their system."""
    roles = document.analysis.roles
    sources = {element for element, of_kinds in roles.items() if any("source" in of for of in of_kinds.values())}
    rows: list[SurroundingsEntry] = []
    for element, where in document.surroundings:
        if element in sources:
            rows.append({"element": element_dict(element), "contexts": list(where.contexts)})
            if where.country:
                rows[-1]["country"] = where.country
            if where.gdpr != GDPR_APPLIES:
                rows[-1]["gdpr"] = where.gdpr
    return rows


def inventory(document: Document) -> list[NonRosEntry]:
    """Return every element outside ROS with its facts (rule S9)."""
    rows: list[NonRosEntry] = []
    for element, facts in document.analysis.outside.items():
        holds = document.holds[element]
        row: NonRosEntry = {
            "element": {"robot": element.robot, "kind": element.kind, "name": element.name},
            "file": facts.place.file,
            "line": facts.place.line,
            **_facts(facts),
            "holds": list(holds),
            **_not_known(element, facts, holds, document.vocabulary.hierarchy),
        }
        rows.append(row)
    return rows


def taken_by_kind(analysis: Analysis) -> dict[str, str]:
    """Return what each kind that there is does unless a label says otherwise."""
    return {kind: DEFAULT_ROLES[kind] for kind in sorted({e.kind for e in analysis.outside} & set(DEFAULT_ROLES))}


def without_backups(analysis: Analysis) -> list[Element]:
    """Return the storages of whose backups nothing is stated: they are taken to have none (rule S9)."""
    return [e for e, facts in analysis.outside.items() if e.kind == "storage" and facts.backups is None]


def _facts(facts: NonRosFacts) -> NonRosStated:
    backups = facts.backups if isinstance(facts.backups, bool | None) else str(facts.backups)
    as_they_are = {name: value for name, value in facts._asdict().items() if name not in IN_OTHER_ENTRIES}
    written = {
        "retention": _durations(facts.retention),
        "backups": backups,
        "recording": _recording(facts.recording) if facts.recording else None,
    }
    entry: NonRosStated = _present(**as_they_are | written)
    return entry


def _present(**values: Any) -> Any:
    """Keys with what is stated of each, without those of which nothing is."""
    return {key: value for key, value in values.items() if value not in (None, "", {}, [])}


def _recording(recording: Recording) -> RecordingEntry:
    from rosprivacy.analysis.model.recording import iso  # noqa: PLC0415 - light start

    times = {"start": recording.start, "end": recording.end, "oldest": recording.oldest}
    entry: RecordingEntry = {"bag": recording.bag, "bytes": recording.size, "topics": recording.topics}
    entry.update(_present(messages=recording.messages))
    entry.update(_present(**{of: iso(time) for of, time in times.items() if time is not None}))
    return entry


def _durations(stated: tuple[tuple[str, Any], ...]) -> dict[str, str]:
    return {category or "every": str(duration) for category, duration in stated}


def _not_known(element: Element, facts: NonRosFacts, holds: tuple[str, ...], hierarchy: Hierarchy) -> NonRosNotKnown:
    """What the answer could not judge: what nobody states, or a retention without a limit to hold it against."""
    entry: NonRosNotKnown = {}
    if missing := not_stated(element, facts):
        entry["missing"] = list(missing)
    judged = element.kind == "storage" and facts.retention
    if judged and (without := [name for name in holds if not limited(facts, name, hierarchy)]):
        entry["without_limit"] = without
    return entry


def with_facts_of_elements(entries: AnalysisDocument, document: Document) -> AnalysisDocument:
    """Return entries with what is stated or seen of elements, where any of it is."""
    if document.processing is not None:
        entries = _with_processing(entries, document.processing)
    return _with_types(entries, document)


def _with_processing(entries: AnalysisDocument, processing: StatedProcessing) -> AnalysisDocument:
    """Return entries with what is stated of processing."""
    stated: list[ProcessingEntry] = []
    for robot_or_element, row in processing.of:
        stated.append(_stated(row))
        if isinstance(robot_or_element, str):
            stated[-1]["robot"] = robot_or_element
        else:
            stated[-1]["element"] = element_dict(robot_or_element)
    if stated:
        entries["processing"] = stated
    if by_kind := [_processed(row) for row in processing.by_kind]:
        entries["processed_for"] = by_kind
    return entries


def _stated(stated: Processing) -> ProcessingEntry:
    entry: ProcessingEntry = {"file": stated.place.file, "line": stated.place.line}
    purposes, bases = _by_category(stated.purposes), _by_category(stated.bases)
    entry.update(_present(controller=stated.controller, dpo=stated.dpo, purposes=purposes, legal_bases=bases))
    return entry


def _by_category(stated: ByCategory) -> dict[str, list[str]]:
    return {category or "every": list(values) for category, values in stated}


def _processed(row: Processed) -> ProcessedEntry:
    return {
        "element": element_dict(row.element),
        "category": row.category,
        "controllers": list(row.controllers),
        "officers": list(row.officers),
        "purposes": list(row.purposes),
        "legal_bases": list(row.bases),
        "missing": list(row.missing),
    }


def _with_types(entries: AnalysisDocument, document: Document) -> AnalysisDocument:
    """Return entries with the types of channels, where any are known, and what only these close."""
    closed = document.analysis.closed
    types: list[TypesEntry] = [
        {"element": element_dict(element), "types": [_type(each) for each in seen]} for element, seen in document.types
    ]
    if types:
        entries["types"] = types
    if closed:
        entries["assumptions"]["type_limits_reached"] = [
            {"element": element_dict(element), "categories": list(categories)}
            for element, categories in closed.channels
        ]
        entries["assumptions"]["closed_by_types"] = [_closed(finding) for finding in closed.findings]
    return entries


def _closed(finding: Finding) -> ClosedEntry:
    return {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "source": element_dict(finding.source),
        "leak": element_dict(finding.leak),
        "dismissed": finding.dismissed,
    }


def _type(message_type: MessageType) -> TypeEntry:
    entry: TypeEntry = {
        "type": message_type.name,
        "stated": message_type.stated,
        "file": message_type.place.file,
        "line": message_type.place.line,
    }
    nodes = {"writers": list(message_type.writers), "readers": list(message_type.readers)}
    span = {"first": message_type.first, "last": message_type.last}
    entry.update(_present(hash=message_type.hash, **nodes, **span, definition=message_type.definition))
    return entry
