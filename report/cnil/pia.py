"""A ``Document`` -> the file that the CNIL's PIA tool imports ('Importer un PIA'), for who assesses the impact.

In: a ``Document``. Out: plain dicts and lists. The questions that the graph can answer are filled: 121 to 123, 213,
215, 226 where processors are named, 227, 322, 324, and the measures. The others have no answer: the tool counts an
empty one as work begun. All is for a person to check: no evaluation is filled, no gauge is set, the status is 'in
progress'.

Source: the tool's ``importData``. It needs the four lists, goes through them unguarded, and takes texts as HTML; list
answers and titles of measures as text in one view and as HTML in another, so these have nothing that HTML reads.
The tool shows its questions in the reader's language and translates no answer, so the answers are in one of three.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Method
from rosprivacy.analysis.modes import View
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.cnil import answers as cnil_answers
from rosprivacy.report.cnil import inventory
from rosprivacy.report.cnil.answers import AnswerFacts
from rosprivacy.report.cnil.inventory import kinds_of
from rosprivacy.report.cnil.told import NAMES, Html, Told, escaped, joined, paragraph
from rosprivacy.report.document.analysis import verdict_facts
from rosprivacy.report.document.contents import required
from rosprivacy.report.naming import count_elements
from rosprivacy.report.verdict import verdict_sentence

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.decisions import Decision
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.report.document.contents import Document

METHODS = (Method.ANONYMISE, Method.AGGREGATE, Method.DROP, Method.PSEUDONYMISE)  # in the order of the measures
PLACEHOLDER = "measures.default_placeholder"  # the tool's own key


def cnil_pia(document: Document, created: str, language: str = "en") -> dict[str, Any]:
    """Return the file's content.

    Parameters
    ----------
    created
        Time as ISO 8601; the tool sorts by it.
    language
        Of the answers: ``en``, ``de`` or ``fr``.
    """
    view, vocabulary, assumptions = document.fleet, document.vocabulary, document.assumptions
    analysis = _of_shown_robots(document.analysis, view) if view else document.analysis
    kinds = kinds_of(document)
    told = Told(Words(language), vocabulary.categories)
    accepted = _accepted(document, told.words)
    register, processed = required(document.register), required(document.processing).by_kind
    known = AnswerFacts(analysis, kinds, accepted, register, told, processed)
    measures = list(_measures(known))
    sentence = verdict_sentence(verdict_facts(analysis, document.doubts, assumptions), told.words)
    note = _note(analysis, assumptions, _fleet(view, told) if view else "", sentence, told)
    texts = {
        121: cnil_answers.data(known),
        122: joined(cnil_answers.life_cycle(known), _read(assumptions, told)),
        123: cnil_answers.supports(known),
        213: cnil_answers.minimisation(known),
        215: cnil_answers.retention(known),
        227: cnil_answers.transfers(known),
    }
    lists = {322: cnil_answers.threats(known), 324: [title for title, _ in measures]}
    stated = {
        112: inventory.responsible(known.processed, told),
        211: inventory.purposes(known.processed, kinds, told),
        212: inventory.bases(known.processed, kinds, told),
        226: cnil_answers.processors(known),
    }
    texts |= {number: text for number, text in stated.items() if text}
    answers = [(number, {"text": joined(text, note), "gauge": 0, "list": []}) for number, text in sorted(texts.items())]
    answers += [(number, {"text": None, "gauge": None, "list": said}) for number, said in lists.items() if said]
    return {
        "pia": _pia(assumptions, created, told),
        "answers": [
            {"id": order, "reference_to": number, "data": data, "created_at": created, "updated_at": created}
            for order, (number, data) in enumerate(answers, 1)
        ],
        "measures": [
            {
                "id": order,
                "title": title,
                "content": joined(content, note),
                "placeholder": PLACEHOLDER,
                "created_at": created,
                "updated_at": created,
            }
            for order, (title, content) in enumerate(measures, 1)
        ],
        "evaluations": [],
        "comments": [],
    }


def _of_shown_robots(analysis: Analysis, view: FleetView) -> Analysis:
    """Return the analysis without flows of robots that only stand beside others."""
    graph = analysis.graph
    beside = {v for v, element in enumerate(graph.elements) if element.robot in view.likeness.second}

    def is_shown(flows: Any) -> Any:
        return tuple(flow for flow in flows if flow.source not in beside and flow.target not in beside)

    return replace(analysis, graph=replace(graph, flows=is_shown(graph.flows), denied=is_shown(graph.denied)))


def _accepted(document: Document, words: Words) -> dict[str, str]:
    """Id of a finding -> why a person accepted it: reason, owner, legal basis, until when (rule S10)."""
    decided = document.decided
    accepted = [finding for finding in document.analysis.findings if finding.accepted] if decided else []
    decisions = {finding.id: decided.valid(finding) for finding in accepted} if decided else {}
    return {finding: _why(decision, words) for finding, decision in decisions.items() if decision}


def _why(decision: Decision, words: Words) -> str:
    until = words("cnil.until", date=words.date(decision.expires)) if decision.expires else ""
    said = ", ".join(part for part in (decision.owner, *map(words.basis, decision.legal_basis), until) if part)
    return f"{decision.reason} ({said})" if said else decision.reason


def _fleet(view: FleetView, words: Told) -> Html:
    """What a reader has to know who sees the robots that are shown only."""
    members = view.likeness.members
    robots = words.count(sum(map(len, members.values())), "robot")
    alike = {robot: len(some) for robot, some in members.items() if len(some) > 1}
    if not alike:
        return words("cnil.fleet", robots=robots)
    rows = [words("cnil.fleet.for", robot=escaped(robot), n=number) for robot, number in alike.items()]
    more = [words("more", n=len(rows) - NAMES)] if len(rows) > NAMES else []
    return words("cnil.fleet.alike", robots=robots, rows=Html(", ".join([*rows[:NAMES], *more])))


def _pia(assumptions: Mapping[str, Any], created: str, words: Told) -> dict[str, Any]:
    """The record itself. Names are empty texts, not null: the tool sorts by them."""
    files = [entry["file"] for entry in assumptions.get("fleet") or assumptions.get("policies") or ()]
    named = shown(files[0]) if files else words("cnil.database")
    more = f" {words('more', n=len(files) - 1)}" if len(files) > 1 else ""
    return {
        "name": f"rosprivacy: {named}{more}",
        "category": "",
        "author_name": "",
        "evaluator_name": "",
        "validator_name": "",
        "status": 0,
        "dpo_status": None,
        "dpo_opinion": None,
        "dpos_names": None,
        "concerned_people_opinion": None,
        "concerned_people_status": None,
        "concerned_people_searched_opinion": None,
        "concerned_people_searched_content": None,
        "people_names": None,
        "rejection_reason": "",
        "applied_adjustments": "",
        "is_example": 0,
        "is_archive": 0,
        "structure_id": None,
        "created_at": created,
        "updated_at": created,
    }


def _measures(facts: AnswerFacts) -> Iterator[tuple[str, Html]]:
    """(title, content) of what the graph shows to protect data; titles are at most 120 characters."""
    graph, told = facts.analysis.graph, facts.words
    if graph.profiles:
        yield told.bare("cnil.title.access"), paragraph(_access(graph, told), Html(" "), told("cnil.governance"))
    if graph.denied:
        pairs = sorted({(graph.elements[f.source].name, graph.elements[f.target].name) for f in graph.denied})
        ends = [told("entry.from.to", source=escaped(source), leak=escaped(target)) for source, target in pairs]
        yield told.bare("cnil.title.denied"), _rows(ends, told)
    for method in METHODS:
        done = _cleanings(facts, method)
        if done:
            still = [] if method.ends else [paragraph(told("cnil.recital26"))]
            yield told.bare(f"cnil.title.{method}"), joined(_rows(done, told), *still)
    encrypted = dict.fromkeys(place for row in facts.leaving() if row.encrypted for place in row.places)
    if encrypted:
        rows = [told.pair(escaped(place.full_name), told("cnil.encrypted")) for place in encrypted]
        yield told.bare("cnil.title.encrypted"), _rows(rows, told)


def _cleanings(facts: AnswerFacts, method: Method) -> list[Html]:
    """Who cleans data of the rows in one way, and for which places: on every path there, or on some."""
    told = facts.words
    places: dict[Html, dict[str, dict[str, None]]] = {}
    for row in facts.register:
        for one in row.measures:
            if one.method == method:
                how = Html("" if one.stated else f" ({told('cnil.no.method')})")
                cleans = joined(told.pair(escaped(one.element.name), escaped(told.data(one.category))), how)
                ways = "cnil.measure.all" if one.everywhere else "cnil.measure.some"
                there = places.setdefault(cleans, {}).setdefault(ways, {})
                there |= dict.fromkeys(map(told.name, row.places))
    return [
        joined(cleans, *(joined(Html("; "), told.line(ways, told.names_shown(to))) for ways, to in where.items() if to))
        for cleans, where in places.items()
    ]


def _access(graph: FlowGraph, words: Told) -> Html:
    return words(
        "cnil.access.enforced" if graph.view == View.enforced else "cnil.access.declared",
        enclaves=words.count(len({profile.enclave for profile in graph.profiles}), "enclave"),
        profiles=words.count(len({(profile.enclave, profile.node) for profile in graph.profiles}), "cnil.profile"),
        flows=words.count(len(graph.flows), "cnil.connection"),
    )


def _rows(rows: list[Html], words: Told) -> Html:
    return words.rows(rows[:NAMES], len(rows))


def _note(analysis: Analysis, assumptions: Mapping[str, Any], about: str, sentence: str, words: Told) -> Html:
    """Whose word this is, and the answer that it rests on."""
    said = words(
        "cnil.note",
        program=escaped(f"rosprivacy {assumptions.get('rosprivacy', '')}".strip()),
        view=Html(analysis.graph.view),
        verdict=escaped(plain(sentence)),
        elements=words.count(count_elements(question.element for question in analysis.open).elements, "element"),
        more=Html(f" {about}." if about else ""),
    )
    return Html(f"<p><em>{said}</em></p>")


def _read(assumptions: Mapping[str, Any], words: Told) -> Html:
    """Which files it rests on (rule S12)."""
    files = [entry for kind in ("project", "fleet", "policies", "labels") for entry in assumptions.get(kind) or ()]
    rows = [escaped(f"{entry['file'][-120:]} (sha256 {entry['sha256'][:12]})") for entry in files]
    return joined(paragraph(words("cnil.rests")), _rows(rows, words)) if files else Html("")
