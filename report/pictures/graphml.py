"""Picture -> GraphML, for programs that draw or count graphs (Gephi, yEd, Cytoscape, networkx).

In: a ``Picture``. Out: XML, written by networkx; every fact of the picture is an attribute, nothing is shortened.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.text import printable
from rosprivacy.report.pictures.looks import LINE_LOOKS, box_look

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.report.pictures.picture import Picture


def graphml(picture: Picture) -> str:
    """Return a picture as GraphML; lists are one name a line."""
    import networkx as nx  # noqa: PLC0415 - heavy

    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph(
        title=printable(picture.title), notes=_list(picture.notes), ways=_list(picture.ways)
    )
    for box in picture.boxes:
        graph.add_node(
            picture.keys[box.key],
            label=printable(box.names[0]),
            names=_list(box.names),
            kind=box.kind,
            robot=printable(box.robot),
            role=box.look,
            words=_list(box.words),
            reviewed=not box.open,
            wildcard=box.pattern,
            group=printable(box.group),
            fill=box_look(picture.view, box.look).colour,
        )
    for number, line in enumerate(picture.lines):
        graph.add_edge(
            picture.keys[line.source],
            picture.keys[line.target],
            key=f"e{number}",
            look=line.look,
            roles=_list(line.roles),
            carries=_list(line.carries),
            pseudonymised=line.pseudonymised,
            policy=_list(str(place) for place in line.places),
            steps=line.length,
            stroke=LINE_LOOKS[line.look].colour,
        )
    rows = ['<?xml version="1.0" encoding="UTF-8"?>', *nx.generate_graphml(graph, encoding="utf-8"), ""]
    return "\n".join(row for number, row in enumerate(rows) if number == 0 or not row.startswith("<?xml"))


def _list(texts: Iterable[str]) -> str:
    return "\n".join(printable(text) for text in texts)
