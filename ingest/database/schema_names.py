"""The names that the graph can have: labels, relationship types and properties, of the schema and of categories.

In: labels of categories. Out: names by kind, for those who ask in Cypher: a name that is none of these and not in the
database is a slip of the pen, one that is merely not in the database yet is not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.database.ids import carries
from rosprivacy.ingest.database.schema import CARRIED, NODES, RELATIONSHIPS, RESERVED, SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Iterable

LABELS_OF_CATEGORIES = "MATCH (c:DataCategory) RETURN c.label"


def schema_names(categories: Iterable[str]) -> dict[str, frozenset[str]]:
    """Return the labels, relationship types and properties that there can be.

    Parameters
    ----------
    categories
        Their labels.

    >>> sorted(schema_names(["Video"])["label"] - schema_names([])["label"])
    ['Video', 'VideoLeak', 'VideoSanitizer', 'VideoSource']
    >>> schema_names(["Video"])["relationship type"] - schema_names([])["relationship type"]
    frozenset({'CARRIES_VIDEO'})
    """
    stems = list(categories)
    properties = [field for node in NODES for field in node.properties]
    properties += [field for kind in RELATIONSHIPS for field in kind.properties]
    return {
        "label": RESERVED | {stem + suffix for stem in stems for suffix in SUFFIXES},
        "relationship type": frozenset(
            {kind.type for kind in RELATIONSHIPS if kind is not CARRIED} | {carries(stem) for stem in stems}
        ),
        "property": frozenset(field.name for field in properties),
    }
