"""Analysis -> the JSON document ``rosprivacy.analysis/1``, a contract (``docs/analysis.schema.json``).

In: an ``Analysis`` and what it rests on. Out: plain dicts and lists, sorted, with no time in them (rule S14).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, cast

from rosprivacy.analysis.contexts import article9_in, revealed
from rosprivacy.analysis.findings.review_order import Behind
from rosprivacy.analysis.findings.sanitizing import absent, cleanings, makings, recognised
from rosprivacy.analysis.kernel.ranks import in_words
from rosprivacy.analysis.legal import turned_special
from rosprivacy.analysis.written_names import literal
from rosprivacy.report.document import ledger, reliance
from rosprivacy.report.document.doubts import doubt_entry
from rosprivacy.report.document.element_entry import element_dict
from rosprivacy.report.document.non_ros import inventory, taken_by_kind, without_backups
from rosprivacy.report.document.pointers import pointers, situations

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis, Finding, OpenQuestion, Step
    from rosprivacy.analysis.contexts import Contexts
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.kernel.overruled import Overruled
    from rosprivacy.analysis.model import Category, Diagnostic, Element, Flow, FlowGraph, Grant, Legal, Reason
    from rosprivacy.report.answer import Answer
    from rosprivacy.report.contract.analysis import AnalysisDocument, Assumptions
    from rosprivacy.report.contract.notation import Texts
    from rosprivacy.report.contract.records import (
        DeniedEntry,
        DiagnosticEntry,
        ElementEntry,
        EnclaveEntry,
        FindingEntry,
        FindingMore,
        GrantEntry,
        LabelKey,
        LawEntry,
        OpenEntry,
        StepEntry,
        Stopped,
        WhyEntry,
    )
    from rosprivacy.report.contract.stated import (
        CategoryEntry,
        DerivationEntry,
        OverruledEntry,
        ProvisionEntry,
        SanitizerEntry,
        SurroundingsEntry,
        WaysEntry,
    )

FORMAT = "rosprivacy.analysis/1"
HANGS_ON = "--hangs-on"  # what asks for it
SECTIONS = {"node": "nodes", "topic": "topics", "service": "services", "action": "actions"}  # of label files
_KEYS = {"name": "provision"}  # what the contract calls otherwise than the model


def analysis_document(answer: Answer) -> AnalysisDocument:
    """Return the analysis as one JSON object; decisions and a fleet's keys are added in ``whole.py``."""
    analysis, taken = answer.shown, answer.taken_away
    categories, hierarchy, graph = answer.vocabulary.categories, answer.vocabulary.hierarchy, analysis.graph
    at_sources = answer.contexts
    contexts = at_sources.everywhere
    document: AnalysisDocument = {
        "format": FORMAT,
        "verdict": str(analysis.verdict),
        "view": graph.view,
        "categories": [_category(categories[name], hierarchy, contexts) for name in analysis.emitted],
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
        "taken_away": ledger.rows(taken, element_dict),
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
        "surroundings": _surroundings(answer),
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
            "taken_away_by": ledger.counts(taken),
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
            "globs": ledger.globs(answer.globs(taken), element_dict),
        },
    }
    if answer.hangs_on is None:  # so that nobody takes it for 'hangs on nothing'
        document["not_asked"] = [{"key": "hangs_on", "option": HANGS_ON}]
    else:
        document["hangs_on"] = reliance.rows(answer.hangs_on, element_dict)
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


def _overruled(one: Overruled) -> OverruledEntry:
    """A source or leak that another statement takes away."""
    return {
        "role": one.role,
        "categories": list(one.categories),
        "elements": list(one.names),
        "file": one.lost.place.file,
        "line": one.lost.place.line,
        "by": {"says": in_words(one.by), "file": one.by.place.file, "line": one.by.place.line},
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
                        "element": element_dict(one.element),
                        "category": one.category,
                        "method": one.method,
                        "stated": one.stated,
                        "everywhere": one.everywhere,
                    }
                    for one in row.protections
                ],
            }
        )
        if row.element:
            rows[-1]["element"] = element_dict(row.element)
    return rows


def _sanitizers(analysis: Analysis, categories: Mapping[str, Category]) -> list[SanitizerEntry]:
    """Who cleans data."""
    found = recognised(analysis.spread, categories)
    recognising = {analysis.graph.elements[vertex]: kinds for vertex, kinds in found.items()}
    return [
        {
            "element": element_dict(cleaning.element),
            "category": cleaning.category,
            "method": cleaning.method,
            "stated": cleaning.stated,
            "reached": cleaning.reached,
            "leaves": list(cleaning.leaves),
            "leaves_pseudonymised": list(cleaning.pseudonymised),
            "beside": [element_dict(element) for element in cleaning.beside],
            "cleaning_beside": [element_dict(element) for element in cleaning.cleaning_beside],
            "places": [{"file": place.file, "line": place.line} for place in cleaning.places],
            "recognises": list(recognising.get(cleaning.element, ())),
        }
        for cleaning in cleanings(analysis.spread, analysis.emitted)
    ]


def _derivations(analysis: Analysis) -> list[DerivationEntry]:
    """Who makes one kind of another."""
    return [
        {"element": element_dict(making.element), "from": making.made_of, "to": making.made, "reached": making.reached}
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


def _surroundings(answer: Answer) -> list[SurroundingsEntry]:
    """Where the elements that bring data in work, as people state it of them or of their system."""
    analysis, bound = answer.shown, answer.bound
    elements = analysis.graph.elements
    sources = {element for element, said in analysis.roles.items() if any("source" in of for of in said.values())}
    rows: list[SurroundingsEntry] = []
    for vertex, where in sorted(bound.surroundings.items()):
        if elements[vertex] in sources:
            rows.append({"element": element_dict(elements[vertex]), "contexts": list(where.contexts)})
            if where.country:
                rows[-1]["country"] = where.country
    return rows


def _category(category: Category, hierarchy: Hierarchy, contexts: frozenset[str]) -> CategoryEntry:
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
        "translations": _translations(category.translations),
    }


def _translations(texts: Mapping[str, Mapping[str, str]]) -> Texts:
    """Language -> texts in it; English stands where the facts are."""
    said = {language: {what: text for what, text in sorted(of.items()) if text} for language, of in texts.items()}
    return {language: said[language] for language in sorted(said) if said[language]}


def _law(law: Iterable[Legal]) -> list[LawEntry]:
    """Return what a person has to look up about a finding's data: no verdict on the system."""
    return [{"provision": legal.name, "verdict": legal.verdict, "condition": legal.condition} for legal in law]


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
        "translations": _translations(
            {
                language: {_KEYS.get(what, what): text for what, text in of.items()}
                for language, of in legal.translations.items()
            }
        ),
    }


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
        "through": element_dict(behind.through) if behind.through else None,
        "closes": behind.closes,
        "leaks": behind.leaks,
        "waits": behind.waits,
        "infrastructure": (question.element.kind, question.element.name) in infrastructure,
    }
    if question.missing:
        shown["missing"] = list(question.missing)
    return shown


def _why(why: Reason) -> WhyEntry:
    return {"key": why.key, "values": dict(why.values)}


def finding_entry(finding: Finding, contexts: Contexts) -> FindingEntry:
    """Return a finding; its data became a special category at ``special_from``, where that was none before."""
    categories = contexts.categories
    category, turned = categories[finding.category], turned_special(finding, categories)
    reason: FindingMore = {"reason": finding.reason, "because": _why(finding.why)} if finding.why else {}
    beside: FindingMore = {"beside_pseudonymised": True} if finding.beside else {}
    shown: FindingEntry = {
        "id": finding.id,
        "kind": finding.kind,
        "category": finding.category,
        "pseudonymised": finding.pseudonymised,
        "source": element_dict(finding.source),
        "leak": element_dict(finding.leak),
        "witness": [element_dict(element) for element in finding.witness],
        "steps": [_step(step) for step in finding.steps],
        "disjoint_paths": finding.number_of_paths,
        "through": [element_dict(element) for element in finding.through],
        "dismissed": finding.dismissed,
        "article9": contexts.article9(finding),
        "special_from": element_dict(turned) if turned else None,
        "law": _law(category.law),
        "in_context": [
            {"context": legal.context, **said} for legal in contexts.revealed(finding) for said in _law((legal,))
        ],
        **reason,
        "accepted": finding.accepted,
        **beside,
    }
    if finding.paths:
        shown["paths"] = [[element_dict(element) for element in path] for path in finding.paths]
        shown["paths_bounded"] = finding.bounded
    return shown


def _step(step: Step) -> StepEntry:
    return {
        "role": step.role,
        "category": step.category,
        "pseudonymised": step.pseudonymised,
        "policy": [_grant(grant) for grant in step.grants],
    }


def _denied(flow: Flow, graph: FlowGraph) -> DeniedEntry:
    """What one line allows and another denies (rule S5)."""
    return {
        "source": element_dict(graph.elements[flow.source]),
        "target": element_dict(graph.elements[flow.target]),
        "role": flow.role,
        "allowed_by": [_grant(grant) for grant in flow.grants],
        "denied_by": [_grant(grant) for grant in flow.denials],
    }


def _grant(grant: Grant) -> GrantEntry:
    line: GrantEntry = {
        "file": grant.place.file,
        "line": grant.place.line,
        "enclave": grant.enclave,
        "profile": grant.node,
    }
    if grant.seen:
        line["seen"] = {"by": list(grant.seen.by), "first": grant.seen.first, "last": grant.seen.last}
    return line


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
