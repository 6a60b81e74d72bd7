"""An ``Answer`` -> the JSON document ``rosprivacy.analysis/1`` or ``/2``, contracts (``docs/*.schema.json``).

In: an ``Answer``. Out: plain dicts and lists, sorted, with no time in them (rule S14).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

from rosprivacy.analysis.findings.review_order import Behind
from rosprivacy.analysis.findings.sanitizing import absent, cleanings, makings, recognised
from rosprivacy.analysis.kernel.ranks import in_words
from rosprivacy.analysis.written_names import literal
from rosprivacy.report.catalogs.words import IN_ENGLISH
from rosprivacy.report.document.decisions import enforced_document, with_decisions
from rosprivacy.report.document.fleet import fleet_document
from rosprivacy.report.document.ledger import counts_of, glob_entries, ledger_rows, reliance_rows
from rosprivacy.report.document.records import (
    doubt_entry,
    element_dict,
    element_or_none,
    finding_entry,
    grant_entry,
    place_entries,
)
from rosprivacy.report.document.stated import (
    category_entry,
    inventory,
    pointers,
    situations,
    surroundings,
    taken_by_kind,
    with_processing,
    with_types,
    without_backups,
)
from rosprivacy.report.verdict import doubts_of, phrase, verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, OpenQuestion
    from rosprivacy.analysis.kernel.overruled import Overruled
    from rosprivacy.analysis.model import Category, Diagnostic, Doubt, Element, Flow, FlowGraph
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.analysis import AnalysisDocument, Assumptions, ShortDocument
    from rosprivacy.report.contract.records import (
        DeniedEntry,
        DiagnosticEntry,
        ElementEntry,
        EnclaveEntry,
        LabelKey,
        OpenEntry,
        Stopped,
    )
    from rosprivacy.report.contract.stated import DerivationEntry, OverruledEntry, SanitizerEntry, WaysEntry

FORMAT = "rosprivacy.analysis/1"
SHORT = "rosprivacy.analysis/2"
NOT_IN_SHORT = ("look_at", "taken_away", "unreached")
ASSUMED_NOT_IN_SHORT = ("globs", "standard_channels_reached")
HANGS_ON = "--hangs-on"  # what asks for it
SECTIONS = {"node": "nodes", "topic": "topics", "service": "services", "action": "actions"}  # of label files


def document(answer: Answer, *, reliance: bool = True) -> AnalysisDocument:
    """Return the JSON document of an answer; without ``reliance`` what it hangs on is not worked out."""
    made = with_types(with_processing(_analysis(answer, reliance=reliance), answer), answer)
    if answer.decided:
        made = with_decisions(made, answer.decided)
    if answer.fleet:
        made = fleet_document(made, answer.fleet, answer.fleet_counts(answer.fleet))
    if answer.enforced:
        made["enforced"] = enforced_document(answer.enforced)
    return _with_sentence(made)


def short_document(answer: Answer) -> ShortDocument:
    """Return the document without what few read; what the answer hangs on is in it only where a user asked for it."""
    whole: dict[str, Any] = {**document(answer, reliance=answer.hangs_on_named)}
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


def _analysis(answer: Answer, *, reliance: bool) -> AnalysisDocument:
    """The analysis as one JSON object, without what only some answers have."""
    analysis, taken = answer.shown, answer.taken_away
    categories, hierarchy, graph = answer.vocabulary.categories, answer.vocabulary.hierarchy, analysis.graph
    at_sources = answer.contexts
    contexts = at_sources.everywhere
    document: AnalysisDocument = {
        "format": FORMAT,
        "verdict": str(analysis.verdict),
        "view": graph.view,
        "categories": [category_entry(categories[name], hierarchy, contexts) for name in analysis.emitted],
        "findings": [finding_entry(finding, at_sources) for finding in analysis.findings],
        "open": _open(answer, analysis.open),
        "unknown_ends": [
            {
                "element": element_dict(end.element),
                "unknown": end.what,
                "categories": list(end.categories),
            }
            for end in analysis.unknown_ends
        ],
        "doubts": [doubt_entry(doubt) for doubt in answer.doubts],
        "taken_away": ledger_rows(taken),
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
        "outside": inventory(analysis, hierarchy),
        "subjects": [
            {"element": element_dict(graph.elements[vertex]), "subjects": list(groups)}
            for vertex, groups in sorted(answer.bound.subjects.items())
        ],
        "ways": _ways(answer),
        "surroundings": surroundings(answer),
        "contexts": situations(answer.vocabulary, contexts),
        "look_at": pointers(answer.vocabulary, analysis.emitted, contexts),
        "sanitizers": _sanitizers(analysis, categories),
        "derivations": _derivations(analysis),
        "unreached": _unreached(analysis),
        "enclaves": _enclaves(graph),
        "flows": len(graph.flows),
        "denied_flows": len(graph.denied),
        "denied": [_denied(flow, graph) for flow in graph.denied],
        "elements": len({element.identity for element in graph.elements}),
        "standard_channels": analysis.standard_channels,
        "diagnostics": [_diagnostic(d) for d in (*answer.diagnostics, *analysis.diagnostics)],
        "assumptions": {
            **cast("Assumptions", answer.assumptions),
            "taken_away_by": counts_of(taken),
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
            "overruled": [_overruled(one) for one in analysis.spread.overruled],
            "absent": [{"element": element_dict(element), "why": why} for element, why in absent(answer.bound, graph)],
            "globs": glob_entries(answer.globs(taken)),
        },
    }
    hangs_on = answer.hangs_on if reliance else None
    if hangs_on is None:  # so that nobody takes it for 'hangs on nothing'
        document["not_asked"] = [{"key": "hangs_on", "option": HANGS_ON}]
    else:
        document["hangs_on"] = reliance_rows(hangs_on)
    return document


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


def _overruled(overruled: Overruled) -> OverruledEntry:
    """A source or leak that another statement takes away."""
    return {
        "role": overruled.role,
        "categories": list(overruled.categories),
        "elements": list(overruled.names),
        "file": overruled.lost.place.file,
        "line": overruled.lost.place.line,
        "by": {"says": in_words(overruled.by), "file": overruled.by.place.file, "line": overruled.by.place.line},
    }


def _ways(answer: Answer) -> list[WaysEntry]:
    """What lies on the ways of each kind of data to each place."""
    rows: list[WaysEntry] = []
    for row in answer.ways:
        rows.append(
            {
                "category": row.category,
                "subjects": list(row.persons),
                "subjects_missing": row.unnamed,
                "protections": [
                    {
                        "element": element_dict(protection.element),
                        "category": protection.category,
                        "method": protection.method,
                        "stated": protection.stated,
                        "everywhere": protection.everywhere,
                    }
                    for protection in row.protections
                ],
            }
        )
        if row.element:
            rows[-1]["element"] = element_dict(row.element)
    return rows


def _sanitizers(analysis: Analysis, categories: Mapping[str, Category]) -> list[SanitizerEntry]:
    """Who cleans data."""
    kinds_at = recognised(analysis.spread, categories)
    recognising = {analysis.graph.elements[vertex]: kinds for vertex, kinds in kinds_at.items()}
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
            "recognises": list(recognising.get(cleaning.element, ())),
        }
        for cleaning in cleanings(analysis.spread, analysis.emitted)
    ]


def _derivations(analysis: Analysis) -> list[DerivationEntry]:
    """Who makes one kind of another."""
    return [
        {
            "element": element_dict(making.element),
            "from": making.made_of,
            "to": making.target,
            "reached": making.reached,
        }
        for making in makings(analysis.spread, analysis.emitted)
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


def _open(answer: Answer, questions: Iterable[OpenQuestion]) -> list[OpenEntry]:
    """Open elements, with what stands behind each."""
    order = answer.review_order
    return [_question(q, order.get(q.element.shown_as, Behind()), answer.infrastructure) for q in questions]


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


def _with_sentence(document: AnalysisDocument) -> AnalysisDocument:
    """Return a document with the verdict's sentence; what no reader reported as a diagnostic becomes one, too."""
    more: list[DiagnosticEntry] = [
        {
            "file": doubt["file"],
            "line": doubt["line"],
            "severity": "warning",
            "message": phrase([doubt], IN_ENGLISH),
            "code": doubt["doubt"],
        }
        for doubt in doubts_of(document)
        if not doubt["message"]
    ]
    return {**document, "diagnostics": [*document["diagnostics"], *more], "sentence": verdict_sentence(document)}
