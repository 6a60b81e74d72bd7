"""Nodes that write and are told nothing: somebody may act on them.

In: a graph, who writes and reads what, rules about names. Out: evidence that such a node is a source. A node that
writes velocities has them from somewhere. If it reads no topic and serves nothing, they come from a person (keys, a
joystick, a page), or the program makes them up: so it is ``may``, and no agreement makes it surer. The same is true of
a node that asks for a service or an action, or writes what can be anything or what somebody wants (a goal), and of
which nothing else says what it brings in: to say nothing of it would be to say that nothing comes in there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.model import interface_of
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING
from rosprivacy.analysis.suggesting.evidence import DATA_FLOW, SOURCE, Evidence, Label
from rosprivacy.analysis.suggesting.name_rules import ends_with, of_node

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.carried_kinds import Rules
    from rosprivacy.analysis.suggesting.name_rules import NameRule, NameRules
    from rosprivacy.analysis.suggesting.traffic import Traffic


def unprompted(graph: FlowGraph, told: Traffic, names: NameRules) -> Iterator[Evidence]:
    """Yield what nodes bring in that write such a topic, read none, and serve nothing.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.traffic import traffic
    >>> graph, bound, _ = factory()
    >>> names = NAMES._replace(unprompted={("video",): NAMES.carries["video",]})
    >>> [(one.label.element.name, one.reason) for one in unprompted(graph, traffic(graph, bound), names)]
    [('/camera', "writes 'video' (/video), and reads no topic: pictures")]
    """
    for vertex, written in told.writes.items() if names.unprompted else ():
        element = graph.elements[vertex]
        if not _is_told_nothing(vertex, graph, told):
            continue
        topics = (graph.elements[one] for one in written if graph.elements[one].kind == "topic")
        for topic in topics:
            if spoken := of_node(topic.name, names.unprompted):
                yield from _brought_in(
                    element, spoken.rule, f"writes '{'_'.join(spoken.words)}' ({topic.name}), and reads no topic"
                )
                break


def of_the_rest(
    graph: FlowGraph, bound: Bound, told: Traffic, rules: Rules, known: Collection[Element]
) -> Iterator[Evidence]:
    """Yield what nodes may bring in that are told nothing, and of which nothing else says what they bring in.

    Parameters
    ----------
    known
        Nodes that are suggested as sources.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from rosprivacy.analysis.example import CAMERA, VIDEO, factory
    >>> from rosprivacy.analysis.model import Confidence, MessageType, Place, Suggestion
    >>> from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.analysis.suggesting.traffic import traffic
    >>> graph, bound, hierarchy = factory()
    >>> names = NAMES._replace(unprompted={(): NAMES.carries["video",]})
    >>> at = Place("types.yaml", 1)
    >>> free = {("a/msg/Text", ""): (Suggestion("a/msg/Text", (ANYTHING,), Confidence.MAY, "", "", at),)}
    >>> rules = Rules(free, {}, names, hierarchy)
    >>> typed = replace(bound, types={VIDEO: (MessageType("a/msg/Text", at),)})
    >>> told = traffic(graph, typed)
    >>> [one.reason for one in of_the_rest(graph, typed, told, rules, ())]
    ['writes /video, and reads no topic: pictures']
    >>> list(of_the_rest(graph, typed, told, rules, [graph.elements[CAMERA]]))
    []
    """
    rule = rules.names.unprompted.get(())
    for vertex, written in told.writes.items() if rule else ():
        element = graph.elements[vertex]
        if rule and element not in known and _is_told_nothing(vertex, graph, told):
            free = next((one for one in written if _takes_anything(one, graph, bound, rules)), None)
            if free is None:
                free = next((one for one in written if ends_with(graph.elements[one].name, rules.names.wanted)), None)
            if free is not None:
                does = "asks for" if graph.elements[free].leg else "writes"
                yield from _brought_in(element, rule, f"{does} {graph.elements[free].name}, and reads no topic")


def _is_told_nothing(vertex: int, graph: FlowGraph, told: Traffic) -> bool:
    return all(graph.elements[one].leg not in ("", "request") for one in told.reads.get(vertex, ()))


def _takes_anything(channel: int, graph: FlowGraph, bound: Bound, rules: Rules) -> bool:
    """Whether a request goes there, or a message of a type that can carry anything, or that nobody has looked at."""
    element, types = graph.elements[channel], bound.types.get(channel, ())
    if element.kind != "topic":
        return element.leg == "request"
    said = [rules.suggestions.get((interface_of(one.name), "")) for one in types]
    return any(one is None or any(ANYTHING in rule.kinds for rule in one) for one in said)


def _brought_in(element: Element, rule: NameRule, because: str) -> Iterator[Evidence]:
    for kind in rule.kinds:
        yield Evidence(Label(element, SOURCE, kind), DATA_FLOW, rule.confidence, f"{because}: {rule.why}", rule.place)
