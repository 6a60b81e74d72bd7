"""What a person could say of channels, and of elements that data reach and that nobody has reviewed (rule S11).

A node there passes data on: a conduit. Where no policy lets them go on, it lets them out, or is an end of them: a leak
or a conduit, and no rule knows which. If a person says that it lets another kind out, it may let this one out, too. A
channel there is sensitive, since what arrives there may go through it; or it is made for other things than that kind,
by its types or its name: never. All of it is ``may``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.evidence import (
    CONDUIT,
    DATA_FLOW,
    LEAK,
    NAMED,
    NEIGHBOUR,
    NEVER,
    SENSITIVE,
    TYPE,
    Evidence,
    SuggestedLabel,
    whole,
)
from rosprivacy.analysis.suggesting.name_rules import of_topic_nothing

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import OpenQuestion
    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.channels import Clue, Rules, Traffic
    from rosprivacy.analysis.suggesting.evidence import Identity

FLOWS = Place("the policies", 0)  # where a reason stands that is drawn from who writes and reads what
NOWHERE = "and no policy lets it go on: a leak if the node keeps it, shows it, or sends it elsewhere, else a conduit"
SHOWN = 3  # names in a reason


def of_channels(graph: FlowGraph, clues: Mapping[int, tuple[Clue, ...]]) -> Iterator[Evidence]:
    """Yield of each channel that it may carry what its types and its name suggest.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.channels import Rules, carried_kinds
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> graph, bound, hierarchy = factory()
    >>> said = of_channels(graph, carried_kinds(graph, bound, Rules({}, {}, NAMES, hierarchy)))
    >>> [(one.label.element.name, one.label.role, one.label.kind) for one in said]
    [('/faces', 'sensitive', 'FaceTemplate'), ('/video', 'sensitive', 'Video')]
    """
    for vertex, some in clues.items():
        for clue in some:
            label = SuggestedLabel(whole(graph.elements[vertex]), SENSITIVE, clue.kind)
            yield Evidence(label, clue.ground, clue.confidence, clue.reason, clue.place)


def of_open(
    questions: Iterable[OpenQuestion], graph: FlowGraph, bound: Bound, ends: Traffic, rules: Rules
) -> Iterator[Evidence]:
    """Yield what could be said of open elements, for each kind that reaches them.

    What is said of one leg is a label of the whole: ``never`` is proposed only if no leg is made for the kind.

    >>> from rosprivacy.analysis.answer import OpenQuestion
    >>> from rosprivacy.analysis.example import FILTERED, factory
    >>> from rosprivacy.analysis.suggesting.channels import Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> graph, bound, hierarchy = factory()
    >>> asked = [OpenQuestion(graph.elements[FILTERED], ("Video",), 3, False)]
    >>> (said,) = of_open(asked, graph, bound, traffic(graph, bound), Rules({}, {}, NAMES, hierarchy))
    >>> said.label.role, said.reason
    ('sensitive', 'neighbour of /filter, which Video reaches')
    """
    at: dict[tuple[str, str, str, str], list[int]] = {}
    legs: dict[Identity, set[str]] = {}
    asked = tuple(questions)
    identities = {question.element.identity for question in asked}
    for vertex, element in enumerate(graph.elements):
        if element.identity in identities:
            at.setdefault(element.shown_as, []).append(vertex)
            legs.setdefault(element.identity, set()).add(element.leg)

    def names(vertices: Iterable[int], ends: Mapping[int, tuple[int, ...]]) -> list[str]:
        return sorted({graph.elements[one].name for vertex in vertices for one in ends.get(vertex, ())})

    for question in asked:
        element = question.element
        vertices = at[element.shown_as]
        if element.is_node:
            leaks = [one for vertex in vertices for one in bound.elements.get(vertex, ()) if one.role == LEAK]
            let_out = sorted({kind for one in leaks for kind in one.categories})
            yield from _at_node(question, let_out, names(vertices, ends.writes))
        elif element.is_channel:
            types = sorted({one.name for vertex in vertices for one in bound.types.get(vertex, ())})
            yield from _at_channel(question, types, legs[element.identity], names(vertices, ends.writers), rules)


def _at_node(question: OpenQuestion, let_out: Sequence[str], written: Sequence[str]) -> Iterator[Evidence]:
    for kind in question.categories:
        roles: tuple[str, ...]
        if let_out:
            roles, rest = (LEAK,), f"and a label says that it lets {_first_few(let_out)} out"
        elif written:
            roles, rest = (CONDUIT,), f"which can go on to {_first_few(written)}"
        else:
            roles, rest = (LEAK, CONDUIT), NOWHERE
        for role in roles:
            label = SuggestedLabel(whole(question.element), role, kind)
            yield Evidence(label, DATA_FLOW, Confidence.MAY, f"it gets {kind}, {rest}", FLOWS)


def _at_channel(
    question: OpenQuestion, types: Sequence[str], legs: Collection[str], writers: Sequence[str], rules: Rules
) -> Iterator[Evidence]:
    element = question.element
    nothing = of_topic_nothing(element.name, rules.names) if element.kind == "topic" else None
    for kind in question.categories:
        never = SuggestedLabel(whole(element), NEVER, kind)
        if types and all(rules.no_leg_carries(kind, name, legs) for name in types):
            reason = f"type {_first_few(types)} of {element.name} is not made for {kind}"
            place = _place(types, element, rules)
            family = str(place) if all(rules.suggests_nothing(kind, name, legs) for name in types) else ""
            yield Evidence(never, TYPE, Confidence.MAY, reason, place, family)
        elif nothing:
            reason = f"{nothing.quoted} is its name: {nothing.rule.why}"
            yield Evidence(never, NAMED, Confidence.MAY, reason, nothing.rule.place)
        else:
            reason = f"neighbour of {_first_few(writers)}, which {kind} reaches" if writers else f"{kind} reaches it"
            yield Evidence(SuggestedLabel(whole(element), SENSITIVE, kind), NEIGHBOUR, Confidence.MAY, reason, FLOWS)


def _first_few(names: Sequence[str]) -> str:
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more


def _place(types: Sequence[str], element: Element, rules: Rules) -> Place:
    """The line of the table that says what a type cannot carry, or what it suggests."""
    for name in types:
        limit = rules.limits.get((name, element.leg))
        suggested = rules.suggestions.get((name, element.leg), ())
        if limit or suggested:
            return limit.place if limit else suggested[0].place
    return FLOWS
