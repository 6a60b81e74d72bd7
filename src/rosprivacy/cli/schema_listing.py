"""The graph in Neo4j for people: what ``query --schema`` prints, from the tables that the program loads by."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.database.schema import NODES, RELATIONSHIPS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.database.schema import Property

CATEGORIES = """\
`Biometric` and `CARRIES_BIOMETRIC` stand for every kind of data; rosprivacy categories lists the kinds. Written in
capitals, words are parted: FaceTemplate has the labels FaceTemplate, FaceTemplateSource, FaceTemplateLeak and
FaceTemplateSanitizer, and the type CARRIES_FACE_TEMPLATE.
"""


def listing() -> str:
    """Return all labels, relationship types and properties, each with its meaning."""
    return "\n".join([CATEGORIES, *_lines()]).replace("`", "")


def _lines() -> Iterator[str]:
    for node in NODES:
        labels = f" Further labels: {node.labels}." if node.labels else ""
        yield f"(:{node.label})  {node.meaning}{labels}"
        yield from _properties(node.properties)
    for kind in RELATIONSHIPS:
        yield f"(:{kind.source})-[:{kind.type}]->(:{kind.target})  {kind.meaning}"
        yield from _properties(kind.properties)


def _properties(properties: tuple[Property, ...]) -> Iterator[str]:
    wide = max((len(field.name) for field in properties), default=0)
    for field in properties:
        yield f"    {field.name:<{wide}}  {field.type:<12}  {field.meaning}"
    yield ""
