"""A ``Document`` -> the file that the CNIL's PIA tool imports ('Importer un PIA'), for who assesses the impact.

In: a ``Document``, and what people answered in the fields of a report. Out: plain dicts and lists. The questions that
the graph can answer are filled: 121 to 123, 213, 215, 226 where processors are named, 227, 322, 324, and the measures,
with those that are decided and still to be done: the tool asks for planned ones there. A gauge shows the level that
people wrote. The others have no answer, since the tool counts an empty one as work begun; comments say what is left.

There is no evaluation, where the tool keeps an action plan: it takes a pending one as handed to the evaluator, and
closes the answers to whoever writes them.

Source: the tool's ``importData``. It needs the four lists, goes through them unguarded, and takes texts as HTML; list
answers and titles of measures as text in one view and as HTML in another, so these have nothing that HTML reads.
The tool shows its questions in the reader's language and translates no answer, so the answers are in one of three.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.decisions import Choice
from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Method
from rosprivacy.analysis.modes import View
from rosprivacy.analysis.text import cut, one_line
from rosprivacy.report.catalogs.words import Words, plain
from rosprivacy.report.cnil import answers as cnil_answers
from rosprivacy.report.cnil import inventory
from rosprivacy.report.cnil.answers import NO_ANSWERS, AnswerFacts
from rosprivacy.report.cnil.inventory import kinds_of
from rosprivacy.report.cnil.person_answers import ADVICE, LIKELIHOOD, SEVERITY, VIEWS, assessed_paths
from rosprivacy.report.cnil.told import NAMES, Html, Told, escaped, harmless, joined, paragraph, prose
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
    from rosprivacy.report.cnil.person_answers import PersonAnswers
    from rosprivacy.report.document.contents import Document

METHODS = (Method.ANONYMISE, Method.AGGREGATE, Method.DROP, Method.PSEUDONYMISE)  # in the order of the measures
REASON = 1_000  # letters of a reason
PLACEHOLDER = "measures.default_placeholder"  # the tool's own key


def cnil_pia(
    document: Document, created: str, language: str = "en", people: PersonAnswers = NO_ANSWERS
) -> dict[str, Any]:
    """Return the file's content.

    Parameters
    ----------
    created
        Time as ISO 8601; the tool sorts by it.
    language
        Of the answers: ``en``, ``de`` or ``fr``.
    people
        What people answered in the fields of a report.
    """
    view, assumptions = document.fleet, document.assumptions
    analysis = _of_shown_robots(document.analysis, view) if view else document.analysis
    told = Told(Words(language), document.vocabulary.categories)
    known = _facts(document, analysis, told, people)
    sentence = verdict_sentence(verdict_facts(analysis, document.doubts, assumptions), told.words)
    note = _note(analysis, assumptions, _fleet(view, told) if view else "", sentence, told)
    measures = [(title, joined(content, note)) for title, content in _measures(known, _planned(document))]
    answered = people.measures(known.paths, told)
    measures += [(told.bare("cnil.title.answered"), answered)] if answered else []
    lists = {322: cnil_answers.threats(known), 324: [title for title, _ in measures]}
    answers = [
        (number, {"text": text, "gauge": 0, "list": []})
        for number, text in sorted(_texts(known, assumptions, note).items())
        if text
    ]
    answers += [
        (number, {"text": text, "gauge": people.level(number, known.paths), "list": []})
        for number in (SEVERITY, LIKELIHOOD)
        if (text := people.risk(number, known.paths, told))
    ]
    answers += [(number, {"text": None, "gauge": None, "list": said}) for number, said in lists.items() if said]
    contents: dict[str, list[dict[str, Any]]] = {
        "answers": [{"reference_to": number, "data": data} for number, data in answers],
        "measures": [{"title": title, "content": content, "placeholder": PLACEHOLDER} for title, content in measures],
        "comments": [
            {"reference_to": number, "description": text, "for_measure": False} for number, text in _reserved(known)
        ],
    }
    times = {"created_at": created, "updated_at": created}
    rows = {name: [{"id": n, **row, **times} for n, row in enumerate(some, 1)] for name, some in contents.items()}
    return {"pia": _pia(assumptions, known, created), **rows, "evaluations": []}


def _facts(document: Document, analysis: Analysis, words: Told, people: PersonAnswers) -> AnswerFacts:
    findings = [finding for finding in analysis.findings if not finding.dismissed]
    patterns = {one.finding.id: one.id for one in document.fleet.patterns} if document.fleet else {}
    return AnswerFacts(
        analysis,
        kinds_of(document),
        _accepted(document, words.words),
        required(document.register),
        words,
        required(document.processing).by_kind,
        people,
        assessed_paths(findings, patterns, words),
    )


def _texts(facts: AnswerFacts, assumptions: Mapping[str, Any], note: Html) -> dict[int, Html]:
    """Number of a question that the graph can answer -> its text, empty where it stays unanswered."""
    words, people = facts.words, facts.people
    texts = {
        112: inventory.responsible(facts.processed, words),
        121: cnil_answers.data(facts),
        122: joined(cnil_answers.life_cycle(facts), _read(assumptions, people.source, words)),
        123: cnil_answers.supports(facts),
        211: inventory.purposes(facts.processed, facts.kinds, words),
        212: inventory.bases(facts.processed, facts.kinds, words),
        213: cnil_answers.minimisation(facts),
        215: cnil_answers.retention(facts),
        226: cnil_answers.processors(facts),
        227: cnil_answers.transfers(facts),
    }
    signed = {number: joined(text, note) if text else text for number, text in texts.items()}
    return {number: joined(text, people.of_all(number, words)) for number, text in signed.items()}


def _reserved(facts: AnswerFacts) -> Iterator[tuple[int, str]]:
    """Comments beside questions: what is left to people there, and which of their answers have no place."""
    words = facts.words
    yield 111, words.bare("cnil.left.all")
    yield 321, words.bare("cnil.left.risk")
    yield 331, words.bare("cnil.left.other")
    yield 341, words.bare("cnil.left.other")
    keys = facts.people.without_place(facts.paths)
    if keys:
        more = f" {words.bare('more', n=len(keys) - NAMES)}" if len(keys) > NAMES else ""
        named = f"{', '.join(keys[:NAMES])}{more}"
        yield 111, harmless(plain(words.words.pair(words("cnil.left.answers"), named)))


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
    reason = cut(one_line(decision.reason), REASON)  # so that the legal basis behind it is never what is cut
    return f"{reason} ({said})" if said else reason


def _planned(document: Document) -> dict[Decision, list[str]]:
    """Valid decisions that leave something to do -> the findings that they are about."""
    planned: dict[Decision, list[str]] = {}
    decided = document.decided
    for finding in document.analysis.findings if decided else ():
        decision = decided.valid(finding) if decided and not finding.dismissed else None
        if decision and decision.choice is not Choice.ACCEPT:
            planned.setdefault(decision, []).append(finding.id)
    return planned


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


def _pia(assumptions: Mapping[str, Any], facts: AnswerFacts, created: str) -> dict[str, Any]:
    """The record itself, without any state. Names are empty texts, not null: the tool sorts by them."""
    words, people = facts.words, facts.people
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
        "dpo_opinion": people.opinion(ADVICE),
        "dpos_names": None,
        "concerned_people_opinion": people.opinion(VIEWS),
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


def _measures(facts: AnswerFacts, planned: Mapping[Decision, list[str]]) -> Iterator[tuple[str, Html]]:
    """(title, content) of what protects data, and of what is decided to; titles are at most 120 characters."""
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
    if planned:
        rows = [_plan(decision, findings, told) for decision, findings in planned.items()]
        yield told.bare("cnil.title.planned"), joined(_rows(rows, told), paragraph(told("cnil.plan")))


def _plan(decision: Decision, findings: list[str], words: Told) -> Html:
    """What is decided about some findings, by whom, and until when the decision holds."""
    told = words.words
    texts = {
        "reason": cut(one_line(decision.reason), REASON),
        "condition": decision.condition,
        "owner": decision.owner,
        "expires": told.date(decision.expires) if decision.expires else "",
        "ticket": decision.ticket,
    }
    answers = [Html(f"{words(f'confirm.{code}')} {prose(text)}") for code, text in decision.answers]
    paths = words.line("cnil.plan.paths", words.names_shown(findings))
    rows = [words.line(f"decision.{key}", prose(text)) for key, text in texts.items() if text]
    return words.pair(words(f"decision.{decision.choice}"), Html("; ".join([paths, *rows, *answers])))


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
        verdict=prose(plain(sentence)),
        elements=words.count(count_elements(question.element for question in analysis.open).elements, "element"),
        more=Html(f" {about}." if about else ""),
    )
    return Html(f"<p><em>{said}</em></p>")


def _read(assumptions: Mapping[str, Any], answers: str, words: Told) -> Html:
    """Which files it rests on (rule S12)."""
    files = [entry for kind in ("project", "fleet", "policies", "labels") for entry in assumptions.get(kind) or ()]
    rows = [escaped(f"{entry['file'][-120:]} (sha256 {entry['sha256'][:12]})") for entry in files]
    rows += [escaped(answers)] if answers else []
    return joined(paragraph(words("cnil.rests")), _rows(rows, words)) if rows else Html("")
