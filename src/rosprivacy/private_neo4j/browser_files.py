"""What the Neo4j Browser is given: a style sheet with our colours, our questions as saved queries and as a dashboard.

In: which categories there are. Out: files by name. The labels and types come from the schema that the program loads by.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import quote

from rosprivacy.ingest.neo4j_graph.ids import carries
from rosprivacy.ingest.neo4j_graph.schema import CARRIED, ELEMENT, FLOWS_TO, KIND_LABELS, NODES, RELATIONSHIPS
from rosprivacy.queries.library import pack
from rosprivacy.queries.saved import dashboard, zipped
from rosprivacy.report.pictures.looks import ALLOWED, DATA, OTHER, OUTLINED, grass
from rosprivacy.report.stored import CALLED_BY

if TYPE_CHECKING:
    from collections.abc import Collection

STYLE, QUERIES, DASHBOARD = "rosprivacy.grass", "rosprivacy-queries.zip", "rosprivacy-neodash.json"
CATEGORIES = "MATCH (c:DataCategory) RETURN c.label AS label, NOT EXISTS { (c)-[:BROADER]->() } AS top"
FIRST = "MATCH path = ()-[r]->() WHERE type(r) STARTS WITH 'CARRIES_' RETURN path LIMIT 300"


def browser_files(labels: Collection[str], tops: Collection[str]) -> dict[str, str | bytes]:
    """Return the files that are dropped on the Browser's page, and the dashboard that NeoDash loads.

    Parameters
    ----------
    labels
        Of categories.
    tops
        Of those among them that no other is broader than: an element with a role has the role's label of one of them.
    """
    types = {kind.type: OTHER for kind in RELATIONSHIPS if kind is not CARRIED}
    types |= {FLOWS_TO.type: ALLOWED, **{carries(label): DATA for label in sorted(labels)}}
    style = grass(
        {label: kind for kind, label in KIND_LABELS.items()},
        {role: [label + role.capitalize() for label in sorted(tops)] for role in OUTLINED},
        types,
        {
            node.label: next(name for name in CALLED_BY if name in {field.name for field in node.properties})
            for node in NODES
            if node is not ELEMENT
        },
    )
    return {STYLE: style, QUERIES: zipped(pack().values()), DASHBOARD: dashboard(pack())}


def address(page: str, bolt: str, user: str) -> str:
    """Return the page of the Browser with the server, the user's name and a first query filled in; nothing is run.

    >>> address("http://127.0.0.1:7474/browser/", "bolt://127.0.0.1:7687", "neo4j").partition("&cmd=")[0]
    'http://127.0.0.1:7474/browser/?dbms=bolt://neo4j@127.0.0.1:7687&db=neo4j'
    """
    scheme, _, place = bolt.partition("://")
    return f"{page}?dbms={scheme}://{user}@{place}&db=neo4j&cmd=edit&arg={quote(FIRST, safe='')}"
