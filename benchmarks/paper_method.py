"""The paper's method as a plain networkx program: one kind of data, one graph, the paths from source to leak.

    python benchmarks/paper_method.py POLICY CATEGORIZATION.json

The measure for ``turtlebot.py``. Written from the paper, sections II-A and II-B, not from its program; where that is
known to be wrong or slow for no reason the better way is taken, since the comparison shall not live on that:
``~`` is expanded, nodes and channels have names of their own, and what no source reaches is left out before paths are
searched. What makes the method is kept: a service or action is one vertex that data passes both ways, an
uncategorised node counts as a leak, wildcards are plain names.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import networkx as nx
from lxml import etree

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    Vertex = tuple[str, str]  # "node" or the kind of channel, name
    Graph = nx.DiGraph[Vertex]

# role -> whether data goes from the node to the channel, and from the channel to the node
DIRECTIONS = {
    "publish": (True, False),
    "subscribe": (False, True),
    "request": (True, True),
    "reply": (True, True),
    "call": (True, True),
    "execute": (True, True),
}
STANDARD = (
    "/rosout", "/parameter_events", "/clock", "/describe_parameters", "/get_parameters", "/get_parameter_types",
    "/list_parameters", "/set_parameters", "/set_parameters_atomically",
)  # fmt: skip


def ros_graph(policy: str) -> Graph:
    """Return every node and channel of a policy, and what each line allows or denies between them."""
    tree = etree.parse(policy)
    tree.xinclude()
    graph: Graph = nx.DiGraph()
    for profile in tree.iter("profile"):
        namespace, base = profile.get("ns") or "/", profile.get("node") or ""
        node = ("node", _full_name(base, namespace, base))
        graph.add_node(node)
        for channel, role, rule in _lines(profile, namespace, base):
            out, back = DIRECTIONS[role]
            if out:
                graph.add_edge(node, channel, rule=rule)
            if back:
                graph.add_edge(channel, node, rule=rule)
    return graph


def _lines(profile: etree._Element, namespace: str, base: str) -> Iterator[tuple[Vertex, str, str]]:
    """(channel, role, ALLOW or DENY) of a profile, without the standard channels."""
    for group in profile:
        for item in group:
            if not isinstance(item.tag, str) or item.tag not in ("topic", "service", "action"):
                continue
            name = _full_name(item.text or "", namespace, base)
            if not name.endswith(STANDARD):
                yield from (
                    ((item.tag, name), role, str(rule)) for role, rule in group.attrib.items() if role in DIRECTIONS
                )


def _full_name(name: str, namespace: str, base: str) -> str:
    if name.startswith("/"):
        return name
    prefix = namespace.rstrip("/")
    return f"{prefix}/{base}{name[1:]}" if name.startswith("~") else f"{prefix}/{name}"


def privacy_graph(graph: Graph, categorization: dict[str, list[str]]) -> Graph:
    """Return what can transport personal data: no sanitizers, no mundane channels, no denied edges."""
    small = graph.copy()
    sanitizers, mundane = set(categorization["sanitizer"]), set(categorization["mundane"])
    small.remove_nodes_from(
        [vertex for vertex in graph if vertex[1] in (sanitizers if vertex[0] == "node" else mundane)]
    )
    small.remove_edges_from([(a, b) for a, b, line in small.edges(data=True) if line["rule"] != "ALLOW"])
    sources = _sources(small, categorization)
    reached = set(sources).union(*(nx.descendants(small, source) for source in sources))
    return small.subgraph(reached).copy()


def _sources(graph: Graph, categorization: dict[str, list[str]]) -> list[Vertex]:
    return [("node", name) for name in categorization["source"] if ("node", name) in graph]


def leak_paths(graph: Graph, categorization: dict[str, list[str]]) -> Iterable[list[Vertex]]:
    """Return the edge-disjoint paths from each source to each leak, but for those through another leak."""
    sources = _sources(graph, categorization)
    harmless = {name for role in ("source", "conduit", "sanitizer") for name in categorization[role]}
    leaks = [vertex for vertex in graph if vertex[0] == "node" and vertex[1] not in harmless]
    others = set(leaks)
    for source in sources:
        reached = nx.descendants(graph, source)
        for leak in leaks:
            if leak not in reached:
                continue
            for path in nx.edge_disjoint_paths(graph, source, leak):
                if others.isdisjoint(path[1:-1]):
                    yield path


def main() -> None:
    """Print the paths, and whether there are any."""
    policy, file = sys.argv[1:]
    categorization = json.loads(Path(file).read_text("utf-8"))
    paths = list(leak_paths(privacy_graph(ros_graph(policy), categorization), categorization))
    for path in paths:
        print(" -> ".join(name for _, name in path))
    print(f"{len(paths)} vulnerable paths")


if __name__ == "__main__":
    main()
