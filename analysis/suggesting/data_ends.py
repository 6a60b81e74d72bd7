"""Where data surely goes on and where it ends, if channels carry what their types are made for: for a trial.

In: what is suggested of types, and a spread. Out: limits for a trial only, and the nodes at which data ends and of
which nobody says what they do with it. Such a node keeps, shows or sends what it gets, or makes something else of it.
No verdict rests on this: a type can carry more than it is made for (rule S15).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.kernel.type_limits import TypeLimit, TypeLimits
from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.evidence import DATA_FLOW, LEAK, Evidence, LabelProposal, SuggestedLabel

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.kernel.spread import Spread
    from rosprivacy.analysis.model import Category, Element, FlowGraph
    from rosprivacy.analysis.suggesting.channels import Rules, Traffic

TYPES = Place("what types are made for", 0)
BULKY = frozenset({"video", "image", "audio", "depth", "thermal", "point-cloud", "map"})  # no text or row of numbers
ARRAYS = "MultiArray"  # of std_msgs: bytes and numbers of any sort
ENDS_HERE = "nothing that it writes is made for this: it keeps, shows or sends it, or makes something else of it"


def unlikely_kinds(rules: Rules, categories: Mapping[str, Category]) -> TypeLimits:
    """Return as limits what each type is not made for: kinds that the table does not suggest of it.

    A type that can hold any text, such as that of diagnostics, is made for no pictures and sounds.

    Examples
    --------
    >>> from rosprivacy.ingest.types import TABLE
    >>> from rosprivacy.ingest.types.type_table import read_table
    >>> from rosprivacy.analysis.suggesting.channels import Rules
    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> from rosprivacy.ontology.vocabulary import load
    >>> vocabulary, table = load(), read_table(TABLE, load())
    >>> limits = unlikely_kinds(Rules(table.suggestions, {}, NAMES, vocabulary.hierarchy), vocabulary.categories).of
    >>> of_text = limits["std_msgs/msg/String", ""].kinds
    >>> "Video" in of_text, "SpeechTranscript" in of_text, "Voice" in limits["sensor_msgs/msg/Image", ""].kinds
    (True, False, True)
    """
    bulky = {name for name, kind in categories.items() if kind.data_types and BULKY.issuperset(kind.data_types)}
    anything = {name for name, kind in categories.items() if not kind.broader}
    limits = {}
    for key, suggested in rules.suggestions.items():
        kinds = {kind for suggestion in suggested for kind in suggestion.kinds}
        of_text = bool(kinds) and kinds <= anything and not key[0].endswith(ARRAYS)
        excluded = {kind for kind in categories if rules.excludes(kind, key)} | (bulky if of_text else set())
        limits[key] = TypeLimit(frozenset(excluded), TYPES)
    return TypeLimits("", "", limits, by_purpose=True)


def data_ends(spread: Spread, traffic: Traffic, silent: Collection[Element]) -> Iterator[LabelProposal]:
    """Yield, for each node of which nobody speaks, that it may let out what ends there: what goes on nowhere from it.

    At a node that only reads, and asks services, all of it ends.

    Parameters
    ----------
    spread
        Under what channels are made for.

    Examples
    --------
    >>> from rosprivacy.analysis.example import ARCHIVE, factory
    >>> from rosprivacy.analysis.kernel.spreading import spread
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> graph, bound, hierarchy = factory()
    >>> ends = data_ends(spread(graph, bound, hierarchy), traffic(graph, bound), [graph.elements[ARCHIVE]])
    >>> [(one.label.element.name, one.label.kind) for one in ends]
    [('/archive', 'FaceTemplate'), ('/archive', 'Video')]
    """
    onward: dict[int, int] = {}
    for index, flow in enumerate(spread.graph.flows):
        onward[flow.source] = onward.get(flow.source, 0) | spread.along(index)
    for vertex, element in enumerate(spread.graph.elements):
        if not element.is_node or element not in silent:
            continue
        goes_on = 0 if only_reads(spread.graph, traffic, vertex) else onward.get(vertex, 0)
        for kind in spread.names(spread.arrives.get(vertex, 0) & ~goes_on):
            label = SuggestedLabel(element, LEAK, kind)
            evidence = Evidence(label, DATA_FLOW, Confidence.MAY, ENDS_HERE, TYPES)
            yield LabelProposal(label, Confidence.MAY, (evidence,))


def only_reads(graph: FlowGraph, traffic: Traffic, vertex: int) -> bool:
    """Return whether a node reads channels and writes none but the requests of services that it asks.

    >>> from rosprivacy.analysis.example import ARCHIVE, FILTER, factory
    >>> from rosprivacy.analysis.suggesting.channels import traffic
    >>> graph, bound, _ = factory()
    >>> [only_reads(graph, traffic(graph, bound), vertex) for vertex in (ARCHIVE, FILTER)]
    [True, False]
    """
    written = (graph.elements[channel].leg for channel in traffic.writes.get(vertex, ()))
    return vertex in traffic.reads and all(leg == "request" for leg in written)
