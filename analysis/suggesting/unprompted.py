"""Nodes that command the robot and are told nothing: somebody may act on them.

In: a graph, who writes and reads what, rules about names. Out: evidence that such a node is a source. A node that
writes velocities has them from somewhere. If it reads no topic and serves nothing, they come from a person (keys, a
joystick, a page), or the program makes them up: so it is ``may``, and no agreement makes it surer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.evidence import DATA_FLOW, SOURCE, Evidence, Label
from rosprivacy.analysis.suggesting.name_rules import has_word, of_node

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import FlowGraph
    from rosprivacy.analysis.suggesting.name_rules import NameRules
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
        asked = (graph.elements[one] for one in told.reads.get(vertex, ()))
        if has_word(element.name, names.simulated) or any(one.leg in ("", "request") for one in asked):
            continue
        topics = (graph.elements[one] for one in written if graph.elements[one].kind == "topic")
        for topic in topics:
            if spoken := of_node(topic.name, names.unprompted):
                reason = f"writes '{'_'.join(spoken.words)}' ({topic.name}), and reads no topic: {spoken.rule.why}"
                for kind in spoken.rule.kinds:
                    label = Label(element, SOURCE, kind)
                    yield Evidence(label, DATA_FLOW, spoken.rule.confidence, reason, spoken.rule.place)
                break
