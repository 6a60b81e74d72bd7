"""The way from an answer to its ``Document``, of which every output is a function: all thinking ends here.

In: an ``Answer``, and which costly fields are asked for. Out: a ``Document``.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.findings.sanitizing import absent, cleanings, makings, recognised
from rosprivacy.analysis.kernel.ranks import in_words
from rosprivacy.analysis.policy_lines import first_lines, in_a_file
from rosprivacy.report.document.contents import (
    IN_JSON,
    LEDGER,
    PATHS,
    POSITIONS,
    PROCESSING,
    PROPOSALS,
    REGISTER,
    RELIANCE,
    Document,
    EnforcedFacts,
    Ledger,
    Positions,
    StatedProcessing,
)
from rosprivacy.report.places import PlaceIndex, roles_of, to_review

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks
    from rosprivacy.analysis.model import Element, Flow, MessageType, Place, Processing
    from rosprivacy.answer import Answer, Enforced
    from rosprivacy.report.document.contents import Shown


def document_of(answer: Answer, fields: Collection[str] = IN_JSON) -> Document:
    """Return all that an answer says.

    Parameters
    ----------
    fields
        What only some outputs tell, by the names in ``contents.py``. What a user asked for by name is always there.
    """
    analysis, bound, spread = answer.shown, answer.bound, answer.shown.spread
    elements, kinds = analysis.graph.elements, answer.vocabulary.categories
    return Document(
        analysis=analysis,
        vocabulary=answer.vocabulary,
        diagnostics=answer.diagnostics,
        assumptions=answer.assumptions,
        doubts=answer.doubts,
        policies=answer.named_files,
        decided=answer.decided,
        accepted=answer.accepted,
        fleet=answer.fleet,
        counts=answer.fleet_counts(answer.fleet) if answer.fleet else None,
        contexts=answer.contexts,
        outside=answer.analysis.outside,
        subjects=tuple((elements[vertex], groups) for vertex, groups in sorted(bound.subjects.items())),
        surroundings=tuple((elements[vertex], where) for vertex, where in sorted(bound.surroundings.items())),
        types=_types(answer),
        sanitizers=cleanings(spread, analysis.emitted),
        derivations=makings(spread, analysis.emitted),
        recognising={elements[vertex]: made for vertex, made in recognised(spread, kinds).items()},
        brought_in=_brought_in(analysis),
        holds=_holds(analysis),
        absent=absent(bound, analysis.graph),
        overruled=tuple((one, in_words(one.by)) for one in spread.overruled),
        infrastructure=answer.infrastructure,
        review_order=answer.review_order,
        enforced=_enforced(answer.enforced, fields) if answer.enforced else None,
        ledger=Ledger(answer.taken_away, answer.globs(answer.taken_away)) if LEDGER in fields else None,
        hangs_on=answer.hangs_on if RELIANCE in fields or answer.hangs_on_named else None,
        proposals=answer.proposals() if PROPOSALS in fields else None,
        register=answer.register if REGISTER in fields else None,
        processing=StatedProcessing(_processing(answer), answer.processed) if PROCESSING in fields else None,
        positions=_positions(analysis, answer.assumptions) if POSITIONS in fields else None,
        paths_to_leaks=_paths(analysis) if PATHS in fields else None,
    )


def _enforced(enforced: Enforced, fields: Collection[str]) -> EnforcedFacts:
    answer = enforced.answer
    return EnforcedFacts(
        answer.analysis,
        answer.contexts,
        answer.decided,
        enforced.added,
        enforced.open,
        positions=_positions(answer.analysis, answer.assumptions) if POSITIONS in fields else None,
        paths_to_leaks=_paths(answer.analysis) if PATHS in fields else None,
    )


def _paths(analysis: Analysis) -> PathsToLeaks:
    from rosprivacy.analysis.findings.flows_to_leaks import PathsToLeaks  # noqa: PLC0415 - for pictures only

    return PathsToLeaks(analysis)


def _processing(answer: Answer) -> tuple[tuple[str | Element, Processing], ...]:
    """What is stated of robots, then of elements in the order of the graph."""
    elements, bound = answer.analysis.graph.elements, answer.bound
    of_elements = ((elements[vertex], processing) for vertex, processing in sorted(bound.processing.items()))
    return (
        *((robot, processing) for robot, processing in bound.of_robots.items() if answer.shows(robot)),
        *((element, processing) for element, processing in of_elements if answer.shows(element.robot)),
    )


def _types(answer: Answer) -> tuple[tuple[Element, tuple[MessageType, ...]], ...]:
    """The types of each channel that has any, in the order of the graph; both sides of a wildcard once."""
    elements = answer.analysis.graph.elements
    together: dict[Shown, tuple[Element, dict[MessageType, None]]] = {}
    for vertex, types in answer.bound.types.items():
        element = elements[vertex]
        if answer.shows(element.robot):
            together.setdefault(element.shown_as, (element, {}))[1].update(dict.fromkeys(types))
    return tuple((element, tuple(types)) for element, types in together.values())


def _brought_in(analysis: Analysis) -> dict[Element, frozenset[str]]:
    elements = analysis.graph.elements
    emitted = {
        elements[vertex]: frozenset(category for category, fact in decided.items() if fact.emits)
        for vertex, decided in analysis.spread.facts.items()
    }
    return {element: categories for element, categories in emitted.items() if categories}


def _holds(analysis: Analysis) -> dict[Element, tuple[str, ...]]:
    if not analysis.outside:
        return {}
    spread = analysis.spread
    vertices = {element: vertex for vertex, element in enumerate(analysis.graph.elements)}
    return {element: tuple(spread.names(spread.present(vertices[element]))) for element in analysis.outside}


def _positions(analysis: Analysis, assumptions: Mapping[str, Any]) -> Positions:
    return Positions(_places(analysis, assumptions), _flows(analysis))


def _places(analysis: Analysis, assumptions: Mapping[str, Any]) -> PlaceIndex:
    """In one pass over elements and, where channels are to be reviewed, over flows."""
    profiles: dict[str, Place] = {}
    for profile in analysis.graph.profiles:
        if in_a_file(profile.place):
            profiles.setdefault(profile.node, profile.place)
    wanted = {question.element.shown_as for question in to_review(analysis) if question.element.is_channel}
    files = [entry["file"] for kind in ("labels", "policies") for entry in assumptions.get(kind) or ()]
    return PlaceIndex(_roles(analysis), first_lines(analysis.graph, wanted), profiles, tuple(files))


def _roles(analysis: Analysis) -> dict[tuple[Shown, str, str], Place]:
    """The lines of labels at the ends of findings; the statement of the highest rank stands first (rule S7)."""
    rows = {row for finding in analysis.findings for row in roles_of(finding)}
    ends = {shown for shown, _, _ in rows}
    vertices: dict[Shown, list[int]] = {}
    for vertex, element in enumerate(analysis.graph.elements if ends else ()):
        if element.shown_as in ends:
            vertices.setdefault(element.shown_as, []).append(vertex)
    lines: dict[tuple[Shown, str, str], Place] = {}
    for shown, role, category in rows:
        facts = (analysis.spread.facts.get(vertex, {}).get(category) for vertex in vertices.get(shown, ()))
        places = (statement.place for fact in facts if fact for statement in fact.by_role(role))
        if place := next(filter(in_a_file, places), None):
            lines[shown, role, category] = place
    return lines


def _flows(analysis: Analysis) -> dict[tuple[Shown, Shown], Flow]:
    """O(flows), and nothing where no further paths were asked for."""
    paths = [path for finding in analysis.findings for path in finding.paths]
    wanted = {(a.shown_as, b.shown_as) for path in paths for a, b in pairwise(path)}
    elements = analysis.graph.elements
    flows: dict[tuple[Shown, Shown], Flow] = {}
    for flow in analysis.graph.flows if wanted else ():
        pair = (elements[flow.source].shown_as, elements[flow.target].shown_as)
        if pair in wanted:
            flows.setdefault(pair, flow)
    return flows
