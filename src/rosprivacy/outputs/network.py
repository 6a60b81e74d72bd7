"""An answer as a networkx graph: elements with what they carry and do, flows with what goes along them.

In: an ``Analysis``. Out: a ``MultiDiGraph`` whose vertices are ``Element`` objects, in the order of the analysed graph.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import networkx as nx

if TYPE_CHECKING:
    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Element


def to_networkx(analysis: Analysis) -> nx.MultiDiGraph[Element]:
    """Return the graph of an analysis; a flow's key is its role. What a DENY takes away is not in it (rule S5)."""
    graph, found = analysis.graph, analysis.spread
    asked = sum(found.both(category) for category in analysis.emitted)
    network: nx.MultiDiGraph[Element] = nx.MultiDiGraph(view=graph.view, verdict=str(analysis.verdict))
    for vertex, element in enumerate(graph.elements):
        plain, pseudonymised = found.planes(found.present(vertex) & asked)
        network.add_node(
            element,
            kind=element.kind,
            name=element.name,
            robot=element.robot,
            leg=element.leg,
            carries=plain,
            pseudonymised=pseudonymised,
            roles=dict(analysis.roles.get(element, {})),
        )
    for index, flow in enumerate(graph.flows):
        plain, pseudonymised = found.planes(found.along(index) & asked)
        network.add_edge(
            graph.elements[flow.source],
            graph.elements[flow.target],
            flow.role,
            carries=plain,
            pseudonymised=pseudonymised,
            lines=tuple(str(grant.place) for grant in flow.grants),
        )
    return network
