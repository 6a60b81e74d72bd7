"""Evidence of all providers: names, types, packages, code, and what is open.

In: what was read and answered. Out: ``Evidence``; the order does not matter, and none of it labels anything.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.suggesting.broader_sources import broader_sources
from rosprivacy.analysis.suggesting.by_library import library_evidence
from rosprivacy.analysis.suggesting.by_package import package_evidence
from rosprivacy.analysis.suggesting.by_package_types import by_package_types
from rosprivacy.analysis.suggesting.carried_kinds import carried_kinds
from rosprivacy.analysis.suggesting.evidence import SOURCE
from rosprivacy.analysis.suggesting.nodes import of_nodes
from rosprivacy.analysis.suggesting.nodes_of_packages import nodes_of_packages
from rosprivacy.analysis.suggesting.open_elements import of_channels, of_open
from rosprivacy.analysis.suggesting.traffic import traffic
from rosprivacy.analysis.suggesting.unprompted import of_the_rest, unprompted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.model import Bound, FlowGraph
    from rosprivacy.analysis.suggesting.evidence import Evidence
    from rosprivacy.analysis.suggesting.library_rules import NodeUse
    from rosprivacy.analysis.suggesting.nodes_of_packages import NodeOfPackage
    from rosprivacy.analysis.suggesting.traffic import Traffic
    from rosprivacy.labelling.knowledge import Known


def evidence(
    analysis: Analysis, bound: Bound, known: Known, uses: Mapping[int, Sequence[NodeUse]]
) -> Iterator[Evidence]:
    """Yield what every provider finds.

    Parameters
    ----------
    uses
        By vertex of a node: what its code uses of libraries.
    """
    graph = analysis.graph
    told = traffic(graph, bound)
    of_packages = nodes_of_packages(graph, bound.types, known.packages)
    yield from lasting_evidence(graph, bound, told, of_packages, known, uses)
    yield from of_open(analysis.open, graph, bound, told, known.rules)
    yield from by_package_types(analysis.open, graph, bound, of_packages, known.rules)


def lasting_evidence(
    graph: FlowGraph,
    bound: Bound,
    told: Traffic,
    of_packages: Sequence[NodeOfPackage],
    known: Known,
    uses: Mapping[int, Sequence[NodeUse]],
) -> Iterator[Evidence]:
    """Yield what is found whatever a person has said: of what is bound to the graph, only types are looked at."""
    rules = known.rules
    clues = carried_kinds(graph, bound, rules)
    found = [
        *of_nodes(graph, bound, told, clues, rules),
        *unprompted(graph, told, rules.names),
        *package_evidence(graph, of_packages),
        *library_evidence(graph, bound, told, clues, uses, rules, known.libraries),
    ]
    yield from found
    yield from broader_sources(found, rules)
    sources = {one.label.element for one in found if one.label.role == SOURCE}
    yield from of_the_rest(graph, bound, told, rules, sources)
    yield from of_channels(graph, clues)
