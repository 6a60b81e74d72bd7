"""Analysis -> the file that the CNIL's PIA tool imports ('Importer un PIA'), for the person who assesses the impact.

In: an ``Answer``. Out: plain dicts and lists. The questions that the graph can answer are filled: 121 to 123, 213, 215,
226 where processors are named, 227, 322, 324, and the measures. The others have no answer: the tool counts an empty one
as work begun. All is for a person to check: no evaluation is filled, no gauge is set, the status is 'in progress'.

Source: the tool's ``importData``. It needs the four lists, goes through them unguarded, and takes texts as HTML; list
answers and titles of measures as text in one view and as HTML in another, so these have nothing that HTML reads.
The answers are in English: the tool shows its questions in the reader's language, and translates no answer.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import Method
from rosprivacy.analysis.modes import View
from rosprivacy.report import robots
from rosprivacy.report.cnil import answers as cnil_answers
from rosprivacy.report.cnil.answers import NAMES, Known
from rosprivacy.report.cnil.markup import Html, bullets, counted, escaped, joined, paragraph, prose
from rosprivacy.report.element_counts import count_elements
from rosprivacy.report.inventory import kinds_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.sanitizing import Cleaning
    from rosprivacy.analysis.fleet.patterns import FleetView
    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.report.answer import Answer

TITLES = {
    Method.ANONYMISE: "Anonymisation on the way",
    Method.AGGREGATE: "Aggregation on the way",
    Method.DROP: "Data taken out on the way",
    Method.PSEUDONYMISE: "Pseudonymisation on the way",
}  # at most 120 characters, and nothing that HTML reads
ACCESS, DENIED, STORAGE = "Access control by SROS 2 policies", "Connections denied by policy", "Encryption of storages"
GOVERNANCE = (
    "Whether the policies are enforced, and whether what is sent is encrypted, stands in the governance files of the "
    "system: to be completed."
)
PLACEHOLDER = "measures.default_placeholder"  # the tool's own key


def cnil_pia(answer: Answer, created: str) -> dict[str, Any]:
    """Return the file's content.

    Parameters
    ----------
    created
        Time as ISO 8601; the tool sorts by it.
    """
    view, vocabulary, assumptions = answer.fleet, answer.vocabulary, answer.assumptions
    analysis = _of_shown_robots(answer.shown, view) if view else answer.shown
    kinds = kinds_of(analysis, vocabulary.categories, vocabulary.hierarchy)
    known = Known(analysis, kinds, answer.stated, answer.accepted, answer.subjects, answer.retention)
    measures = list(_measures(known))
    note = _note(analysis, assumptions, robots.note(view) if view else "")
    texts = {
        121: cnil_answers.data(known),
        122: joined(cnil_answers.life_cycle(known), _read(assumptions)),
        123: cnil_answers.supports(known),
        213: cnil_answers.minimisation(known),
        215: cnil_answers.retention(known),
        227: cnil_answers.transfers(known),
    }
    lists = {322: cnil_answers.threats(known), 324: [title for title, _ in measures]}
    if processors := cnil_answers.processors(known):
        texts[226] = processors
    answers = [(number, {"text": joined(text, note), "gauge": 0, "list": []}) for number, text in sorted(texts.items())]
    answers += [(number, {"text": None, "gauge": None, "list": said}) for number, said in lists.items() if said]
    return {
        "pia": _pia(assumptions, created),
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

    def kept(flows: Any) -> Any:
        return tuple(flow for flow in flows if flow.source not in beside and flow.target not in beside)

    return replace(analysis, graph=replace(graph, flows=kept(graph.flows), denied=kept(graph.denied)))


def _pia(assumptions: Mapping[str, Any], created: str) -> dict[str, Any]:
    """The record itself. Names are empty texts, not null: the tool sorts by them."""
    files = [entry["file"] for entry in assumptions.get("fleet") or assumptions.get("policies") or ()]
    named = shown(files[0]) if files else "from the database"
    more = f" and {len(files) - 1} more" if len(files) > 1 else ""
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


def _measures(known: Known) -> Iterator[tuple[str, Html]]:
    """(title, content) of what the graph shows to protect data."""
    graph = known.analysis.graph
    if graph.profiles:
        yield ACCESS, paragraph(_access(graph), Html(GOVERNANCE))
    if graph.denied:
        pairs = sorted({(graph.elements[f.source].name, graph.elements[f.target].name) for f in graph.denied})
        yield DENIED, _rows([joined(escaped(source), Html(" to "), escaped(target)) for source, target in pairs])
    cleaned = [cleaning for kind in known.kinds for cleaning in kind.cleaned]
    for method, title in TITLES.items():
        done = [_done(cleaning) for cleaning in cleaned if cleaning.method == method]
        if done:
            still = [] if method.ends else [paragraph(Html("The data is still personal (GDPR, recital 26)."))]
            yield title, joined(_rows(done), *still)
    encrypted = [element.name for element in known.storages() if known.of(element, "encrypted") == "yes"]
    if encrypted:
        yield STORAGE, _rows([joined(escaped(name), Html(": encrypted at rest, as stated")) for name in encrypted])


def _access(graph: FlowGraph) -> Html:
    enclaves = counted(len({profile.enclave for profile in graph.profiles}), "enclave")
    profiles = counted(len({(profile.enclave, profile.node) for profile in graph.profiles}), "profile")
    flows = counted(len(graph.flows), "connection")
    if graph.view == View.enforced:
        return Html(f"In the enforced view {profiles} in {enclaves} allow {flows}. ")
    return Html(
        f"In the declared view {profiles} in {enclaves} allow {flows}. DDS enforces per enclave: a node can do "
        "whatever its enclave may (enforced view). "
    )


def _done(cleaning: Cleaning) -> Html:
    how = Html("" if cleaning.stated else " (no method stated)")
    return joined(escaped(cleaning.element.name), Html(": "), escaped(cleaning.category), how)


def _rows(rows: list[Html]) -> Html:
    more = [Html(f"and {len(rows) - NAMES:,} more")] if len(rows) > NAMES else []
    return bullets([*rows[:NAMES], *more])


def _note(analysis: Analysis, assumptions: Mapping[str, Any], about: str) -> Html:
    """Whose word this is."""
    program = escaped(f"rosprivacy {assumptions.get('rosprivacy', '')}".strip())
    unreviewed = counted(count_elements(question.element for question in analysis.open).elements, "element")
    rests = f"view {analysis.graph.view}, verdict {analysis.verdict}, {unreviewed} not reviewed"
    more = f" {prose(about)}." if about else ""
    said = f"Filled in by {program} from policies and labels ({rests}).{more} A person has to check it."
    return Html(f"<p><em>{said}</em></p>")


def _read(assumptions: Mapping[str, Any]) -> Html:
    """Which files it rests on (rule S12)."""
    files = [entry for kind in ("fleet", "policies", "labels") for entry in assumptions.get(kind) or ()]
    rows = [escaped(f"{entry['file'][-120:]} (sha256 {entry['sha256'][:12]})") for entry in files[:NAMES]]
    more = [Html(f"and {len(files) - NAMES:,} more")] if len(files) > NAMES else []
    return joined(paragraph(Html("This rests on:")), bullets([*rows, *more])) if files else Html("")
