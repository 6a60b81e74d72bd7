"""What identifies things in the database: ids of elements and enclaves, labels of categories, all names there can be.

In: elements, enclave paths, a vocabulary. Out: strings that are the same for no two, checked where Cypher needs an
identifier.
"""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown
from rosprivacy.ingest.neo4j_graph.schema import CARRIED, CARRIES, NODES, RELATIONSHIPS, RESERVED, SUFFIXES, quoted

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from rosprivacy.analysis.model import Element
    from rosprivacy.ontology.vocabulary import Vocabulary

LABELS_OF_CATEGORIES = "MATCH (c:DataCategory) RETURN c.label"
LONGEST_ID = 1000  # characters; an index key has room for 8 kB
_WORDS = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])")


def element_id(robot: str, element: Element) -> str:
    r"""Return what identifies an element in the database, the same for no two.

    >>> from rosprivacy.analysis.model import Element
    >>> element_id("r1", Element("service", "/add", leg="request"))
    'r1|service|/add|request'
    """
    parts = [robot, element.kind, element.name, element.leg, element.side, *element.without]
    return _joined(parts)


def _joined(parts: Iterable[str]) -> str:
    text = "|".join(part.replace("\\", "\\\\").replace("|", "\\|") for part in parts).rstrip("|")
    return text if len(text) <= LONGEST_ID else f"sha256:{hashlib.sha256(text.encode()).hexdigest()}"


def enclave_id(robot: str, path: str) -> str:
    """Return what identifies an enclave in the database."""
    return _joined([robot, path])


def topic_id(bag: str, topic: str) -> str:
    """Return what identifies a topic of a bag, by where the bag is."""
    return _joined([bag, topic])


def intake_id(element: str) -> str:
    """Return what identifies the intake of an element, by the element's id."""
    return f"{element}|intake"


def carries(label: str) -> str:
    """Return the type of the relationships along which a kind of data goes, by its label.

    >>> carries("FaceTemplate"), carries("RFIDTag")
    ('CARRIES_FACE_TEMPLATE', 'CARRIES_RFID_TAG')
    """
    return CARRIES + _WORDS.sub("_", label).upper()


def category_labels(vocabulary: Vocabulary) -> dict[str, str]:
    """Return the label of each category by its name.

    Raises
    ------
    InputErrors
        If one is not an identifier, or stands for something else in the graph already.
    """
    problems = []
    taken = dict.fromkeys(RESERVED, "the graph's own")
    for category in vocabulary.categories.values():
        try:
            quoted(category.label)
        except ValueError:
            what = f"<{category.iri}> has the label {shown(category.label)!r}, which is not an identifier"
            problems.append(OntologyError("ontology", 0, what, "use letters, digits and _"))
            continue
        named = (*(category.label + suffix for suffix in SUFFIXES), carries(category.label))
        for name in named:
            other = taken.setdefault(name, category.name)
            if other != category.name:
                what = f"the label {name!r} of {category.name!r} is that of {other!r} too"
                problems.append(OntologyError("ontology", 0, what, "rename it"))
    if problems:
        raise InputErrors(problems)
    return {category.name: category.label for category in vocabulary.categories.values()}


def schema_names(stems: Collection[str]) -> dict[str, frozenset[str]]:
    """Return the labels, relationship types and properties that there can be, of the schema and of categories.

    Who asks in Cypher for a name that is none of these, and not in the database, has mistyped it.

    Parameters
    ----------
    stems
        Labels of categories.

    >>> sorted(schema_names(["Video"])["label"] - schema_names([])["label"])
    ['Video', 'VideoLeak', 'VideoSanitizer', 'VideoSource']
    >>> schema_names(["Video"])["relationship type"] - schema_names([])["relationship type"]
    frozenset({'CARRIES_VIDEO'})
    """
    types = {kind.type for kind in RELATIONSHIPS if kind is not CARRIED}
    properties = [*(kind.properties for kind in NODES), *(kind.properties for kind in RELATIONSHIPS)]
    return {
        "label": RESERVED | {stem + suffix for stem in stems for suffix in SUFFIXES},
        "relationship type": frozenset(types | {carries(stem) for stem in stems}),
        "property": frozenset(field.name for fields in properties for field in fields),
    }
