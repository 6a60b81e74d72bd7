"""A ``Document`` as JSON, ``rosprivacy.analysis/1`` or ``/2``: contracts (``docs/*.schema.json``).

In: a ``Document``. Out: plain dicts and lists, sorted, with no time in them (rule S14).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

from rosprivacy.analysis.findings.review_order import Behind
from rosprivacy.analysis.written_names import literal
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.additions import enforced_document, fleet_document, with_decisions
from rosprivacy.report.document.contents import required
from rosprivacy.report.document.ledger import counts_of, glob_entries, ledger_rows, reliance_rows
from rosprivacy.report.document.records import (
    doubt_entry,
    element_dict,
    element_or_none,
    finding_entry,
    grant_entry,
    place_entries,
)
from rosprivacy.report.document.register import register_entry
from rosprivacy.report.document.stated import (
    category_entry,
    inventory,
    known_groups,
    pointers,
    situations,
    surroundings,
    taken_by_kind,
    with_facts_of_elements,
    without_backups,
)
from rosprivacy.report.verdict import doubts_of, phrase, verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, OpenQuestion
    from rosprivacy.analysis.findings.sanitizing import Making
    from rosprivacy.analysis.kernel.overruled import Overruled
    from rosprivacy.analysis.model import Diagnostic, Doubt, Element, Flow, FlowGraph
    from rosprivacy.analysis.whatif.ledger import GlobUse, TakenAway
    from rosprivacy.report.document.contents import Document
    from rosprivacy.report.schemas.analysis import AnalysisDocument, Assumptions, ShortDocument
    from rosprivacy.report.schemas.records import (
        DeniedEntry,
        DiagnosticEntry,
        ElementEntry,
        EnclaveEntry,
        LabelKey,
        OpenEntry,
        Stopped,
    )
    from rosprivacy.report.schemas.stated import DerivationEntry, OverruledEntry, SanitizerEntry

FORMAT = "rosprivacy.analysis/1"
SHORT = "rosprivacy.analysis/2"
NOT_IN_SHORT = ("look_at", "taken_away", "unreached")
ASSUMED_NOT_IN_SHORT = ("globs", "standard_channels_reached")
HANGS_ON = "--hangs-on"  # what asks for it
SECTIONS = {"node": "nodes", "topic": "topics", "service": "services", "action": "actions"}  # of label files


def json_document(document: Document) -> AnalysisDocument:
    """Return all of a document as JSON."""
    entries = with_facts_of_elements(_analysis(document), document)
    if document.decided:
        entries = with_decisions(entries, document.decided)
    if document.fleet and document.counts:
        entries = fleet_document(entries, document.fleet, document.counts)
    if document.enforced:
        entries["enforced"] = enforced_document(document.enforced)
    return _with_sentence(entries)


def short_document(document: Document) -> ShortDocument:
    """Return a document as JSON without what few read."""
    whole: dict[str, Any] = {**json_document(document)}
    short = {key: value for key, value in whole.items() if key not in (*NOT_IN_SHORT, "not_asked")}
    assumed = whole["assumptions"]
    short["format"] = SHORT
    short["assumptions"] = {key: value for key, value in assumed.items() if key not in ASSUMED_NOT_IN_SHORT}
    short["left_out"] = [
        *([] if "hangs_on" in whole else ["hangs_on"]),
        *NOT_IN_SHORT,
        *(f"assumptions.{key}" for key in ASSUMED_NOT_IN_SHORT),
    ]
    return cast("ShortDocument", short)


def _analysis(document: Document) -> AnalysisDocument:
    """The analysis as one JSON object, without what only some answers have."""
    taken_away, globs = required(document.ledger)
    analysis, vocabulary, graph = document.analysis, document.vocabulary, document.analysis.graph
    categories, hierarchy = vocabulary.categories, vocabulary.hierarchy
    contexts = document.contexts.everywhere
    entries: AnalysisDocument = {
        "format": FORMAT,
        "verdict": str(analysis.verdict),
        "view": graph.view,
        "categories": [category_entry(categories[name], hierarchy, contexts) for name in analysis.emitted],
        "findings": [finding_entry(finding, document.contexts) for finding in analysis.findings],
        "open": _open(document),
        "unknown_ends": [
            {"element": element_dict(end.element), "unknown": end.missing, "categories": list(end.categories)}
            for end in analysis.unknown_ends
        ],
        "doubts": [doubt_entry(doubt) for doubt in document.doubts],
        "taken_away": ledger_rows(taken_away),
        "carries": [
            {
                "element": element_dict(carried.element),
                "categories": list(carried.categories),
                "pseudonymised": list(carried.pseudonymised),
            }
            for carried in analysis.carried
        ],
        "roles": [
            {"element": element_dict(element), "category": category, "roles": list(roles)}
            for element, said in analysis.roles.items()
            for category, roles in sorted(said.items())
            if not element.is_channel
        ],
        "outside": inventory(document),
        "subjects": [
            {"element": element_dict(element), "subjects": list(groups)} for element, groups in document.subjects
        ],
        "persons": known_groups(document),
        "register": [register_entry(row) for row in document.register or ()],
        "surroundings": surroundings(document),
        "contexts": situations(vocabulary, contexts),
        "look_at": pointers(document),
        "sanitizers": _sanitizers(document),
        "derivations": _derivations(document.derivations),
        "unreached": _unreached(analysis),
        "enclaves": _enclaves(graph),
        "flows": len(graph.flows),
        "denied_flows": len(graph.denied),
        "denied": [_denied(flow, graph) for flow in graph.denied],
        "elements": len({element.identity for element in graph.elements}),
        "standard_channels": analysis.standard_channels,
        "diagnostics": [_diagnostic(d) for d in (*document.diagnostics, *analysis.diagnostics)],
        "assumptions": _assumptions(document, taken_away, globs),
    }
    if document.register is None:
        del entries["register"]
    if document.hangs_on is None:  # so that nobody takes it for 'hangs on nothing'
        entries["not_asked"] = [{"key": "hangs_on", "option": HANGS_ON}]
    else:
        entries["hangs_on"] = reliance_rows(document.hangs_on)
    return entries


def _assumptions(document: Document, taken_away: tuple[TakenAway, ...], globs: tuple[GlobUse, ...]) -> Assumptions:
    """What the answer rests on."""
    analysis = document.analysis
    return {
        **cast("Assumptions", document.assumptions),
        "taken_away_by": counts_of(taken_away),
        "taken_by_kind": taken_by_kind(analysis),
        "backups_taken_as_none": [element_dict(element) for element in without_backups(analysis)],
        "sanitizers_without_method": [
            {"element": element_dict(element), "category": category, "taken_as": "pseudonymise"}
            for element, category in analysis.unstated
        ],
        "standard_channels_reached": [_stopped(*row, analysis) for row in analysis.standard_reached],
        "standard_channels_unchanged": [
            element_dict(replace(element, leg="")) for element in analysis.standard_unchanged
        ],
        "overruled": [_overruled(one, by) for one, by in document.overruled],
        "absent": [{"element": element_dict(element), "why": why} for element, why in document.absent],
        "globs": glob_entries(globs),
    }


def label_key(element: Element) -> LabelKey:
    """Return under which section and name a label file says something of an element, and of no other.

    >>> from rosprivacy.analysis.model import Element
    >>> label_key(Element("topic", "/*", side="write"))
    {'section': 'topics', 'name': '=/*'}
    """
    section = SECTIONS.get(element.kind, "elements")
    return {"section": section, "name": element.name if section == "elements" else literal(element.name)}


def _stopped(channel: Element, categories: tuple[str, ...], analysis: Analysis) -> Stopped:
    stopped: Stopped = {"element": element_dict(replace(channel, leg="")), "categories": list(categories)}
    for row in analysis.closed_by_shipped:
        if row.end and row.channel.identity == channel.identity:
            stopped["keeps_from"] = element_dict(row.end)
    return stopped


def _overruled(overruled: Overruled, by: str) -> OverruledEntry:
    """A source or leak that another statement takes away, and what that one says."""
    return {
        "role": overruled.role,
        "categories": list(overruled.categories),
        "elements": list(overruled.names),
        "file": overruled.lost.place.file,
        "line": overruled.lost.place.line,
        "by": {"says": by, "file": overruled.by.place.file, "line": overruled.by.place.line},
    }


def _sanitizers(document: Document) -> list[SanitizerEntry]:
    """Who cleans data."""
    return [
        {
            "element": element_dict(cleaning.element),
            "category": cleaning.category,
            "method": cleaning.method,
            "stated": cleaning.stated,
            "reached": cleaning.reached,
            "leaves": list(cleaning.leaves),
            "leaves_pseudonymised": list(cleaning.pseudonymised),
            "beside": [element_dict(element) for element in cleaning.neighbours],
            "cleaning_beside": [element_dict(element) for element in cleaning.cleaning_beside],
            "places": place_entries(cleaning.places),
            "recognises": list(document.recognising.get(cleaning.element, ())),
        }
        for cleaning in document.sanitizers
    ]


def _derivations(derivations: Iterable[Making]) -> list[DerivationEntry]:
    """Who makes one kind of another."""
    return [
        {
            "element": element_dict(making.element),
            "from": making.made_of,
            "to": making.target,
            "reached": making.reached,
        }
        for making in derivations
    ]


def _unreached(analysis: Analysis) -> list[ElementEntry]:
    """The elements that no data gets to: with ``carries`` all that there is."""
    reached = {carried.element.identity for carried in analysis.carried}
    rest = {element.identity: element for element in analysis.graph.elements if element.identity not in reached}
    return [element_dict(replace(element, leg="")) for element in rest.values()]


def _enclaves(graph: FlowGraph) -> list[EnclaveEntry]:
    nodes: dict[str, set[str]] = {}
    for profile in graph.profiles:
        nodes.setdefault(profile.enclave, set()).add(profile.node)
    return [{"enclave": enclave, "nodes": sorted(inside)} for enclave, inside in sorted(nodes.items())]


def _open(document: Document) -> list[OpenEntry]:
    """Open elements, with what stands behind each."""
    order, infrastructure = document.review_order, document.infrastructure
    return [_question(q, order.get(q.element.shown_as, Behind()), infrastructure) for q in document.analysis.open]


def _question(question: OpenQuestion, behind: Behind, infrastructure: Collection[tuple[str, str]]) -> OpenEntry:
    shown: OpenEntry = {
        "element": element_dict(question.element),
        "categories": list(question.categories),
        "distance": question.distance,
        "frontier": question.frontier,
        "label": label_key(question.element),
        "through": element_or_none(behind.through),
        "closes": behind.closes,
        "leaks": behind.leaks,
        "waits": behind.waits,
        "infrastructure": (question.element.kind, question.element.name) in infrastructure,
    }
    if question.missing:
        shown["missing"] = list(question.missing)
    return shown


def _denied(flow: Flow, graph: FlowGraph) -> DeniedEntry:
    """What one line allows and another denies (rule S5)."""
    return {
        "source": element_dict(graph.elements[flow.source]),
        "target": element_dict(graph.elements[flow.target]),
        "role": flow.role,
        "allowed_by": [grant_entry(grant) for grant in flow.grants],
        "denied_by": [grant_entry(grant) for grant in flow.denials],
    }


def _diagnostic(diagnostic: Diagnostic) -> DiagnosticEntry:
    shown: DiagnosticEntry = {
        "file": diagnostic.place.file,
        "line": diagnostic.place.line,
        "severity": str(diagnostic.severity),
        "message": diagnostic.message,
    }
    if diagnostic.code:
        shown["code"] = diagnostic.code
    return shown


def verdict_facts(analysis: Analysis, doubts: Iterable[Doubt], assumptions: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the verdict's sentence is made of, without the rest of the document."""
    return {
        "verdict": str(analysis.verdict),
        "categories": analysis.emitted,
        "open": analysis.open,
        "findings": [{"accepted": finding.accepted} for finding in analysis.findings],
        "diagnostics": [{"code": diagnostic.code} for diagnostic in analysis.diagnostics],
        "doubts": [doubt_entry(doubt) for doubt in doubts],
        "assumptions": assumptions,
    }


def _with_sentence(entries: AnalysisDocument) -> AnalysisDocument:
    """Return a document with the verdict's sentence; what no reader reported as a diagnostic becomes one, too."""
    more: list[DiagnosticEntry] = [
        {
            "file": doubt["file"],
            "line": doubt["line"],
            "severity": "warning",
            "message": phrase([doubt], IN_ENGLISH),
            "code": doubt["doubt"],
        }
        for doubt in doubts_of(entries)
        if not doubt["message"]
    ]
    return {**entries, "diagnostics": [*entries["diagnostics"], *more], "sentence": verdict_sentence(entries)}
