"""What people write into the graph by hand and what means nothing there: told, with what to write instead (rule S11).

In: relationships, and elements as they are stored. Out: errors. A role is a relationship to a kind of data; the labels
of roles, and the lists beside them, are what the analysis makes of it. Each element carries a seal of these, so that a
change is seen; a role that was taken away changes none of them. Names that are not near to ours are people's own.
"""

from __future__ import annotations

import hashlib
import json
from collections import defaultdict
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import GraphError, shown
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest
from rosprivacy.ingest.neo4j_graph.ids import category_labels
from rosprivacy.ingest.neo4j_graph.schema import (
    CARRIES,
    DATABASE,
    FLOWS_TO,
    KIND_LABELS,
    RELATIONSHIPS,
    RESERVED,
    ROLES,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping

    from neo4j import ManagedTransaction, Record

    from rosprivacy.ontology.vocabulary import Vocabulary

# By the suffix of a label: the list beside it, and the role that it comes from.
MADE_OF = {
    "": ("carries", "source"),
    "Source": ("begins", "source"),
    "Leak": ("leaks", "leak"),
    "Sanitizer": ("sanitizes", "sanitizer"),
}
SEALED = tuple(name for name, _ in MADE_OF.values())
NEAR_TYPE, NEAR_LABEL = 0.72, 0.85  # LEAKED and FLOW are near to ours, LEADS_TO and HAS_ROLE are not; measured
WRITTEN = (FLOWS_TO.type, *sorted(kind.type for kind in ROLES.values()))  # what people write; the rest is made
_RELATIONSHIP_TYPES = {kind.type for kind in RELATIONSHIPS}
_EXISTS = "(any(l IN labels({0}) WHERE l IN $kinds) OR EXISTS {{ ({0})-[:FLOWS_TO]-() }})"
_ENDS = "RETURN type(r) AS type, coalesce(a.name, '') AS source, coalesce(b.name, '') AS target"
TYPES = "CALL db.relationshipTypes() YIELD relationshipType AS type RETURN type ORDER BY type"
OF_TYPES = (
    f"MATCH (a)-[r]->(b) WHERE type(r) IN $types AND (a:DataCategory OR {_EXISTS.format('a')}) "
    f"AND (b:DataCategory OR {_EXISTS.format('b')} OR size(labels(b)) = 0) {_ENDS} ORDER BY type, source, target"
)
WRONG_ENDS = (
    f"MATCH (a)-[r:{'|'.join(sorted(kind.type for kind in ROLES.values()))}]->(b) "
    "WHERE NOT (b:DataCategory AND (a:Element OR EXISTS { (a)-[:FLOWS_TO]-() })) "
    f"AND (a:DataCategory OR b:DataCategory OR {_EXISTS.format('a')}) {_ENDS} ORDER BY type, source, target"
)
_ELEMENTS = ["Element", *KIND_LABELS.values()]


def seal_of(properties: Mapping[str, Any], labels: Iterable[str]) -> str | None:
    """Return the seal of what is written of an element: its labels of kinds of data, and ``SEALED``; None for nothing.

    >>> seal_of({"leaks": [], "begins": []}, []), seal_of({"leaks": ["Video"]}, [])
    (None, '228073b206773a67')
    """
    written = [sorted(labels), *(properties.get(name) or [] for name in SEALED)]
    return hashlib.sha256(json.dumps(written, default=str).encode()).hexdigest()[:16] if any(written) else None


def meaningless_relationships(transaction: ManagedTransaction) -> Iterator[GraphError]:
    """Return those that look like one that people write, and those of a role that do not go to a kind of data."""
    types = [record["type"] for record in transaction.run(TYPES)]
    theirs = [name for name in types if name not in _RELATIONSHIP_TYPES and not name.startswith(CARRIES)]
    near = {name: close for name in theirs if (close := _near(name, WRITTEN, NEAR_TYPE))}
    wrong = transaction.run(WRONG_ENDS, kinds=_ELEMENTS)
    yield from _errors(wrong, "a role goes from an element to a kind: (n)-[:{}]->(:DataCategory {{name: 'Video'}})", {})
    if near:
        yield from _errors(transaction.run(OF_TYPES, types=sorted(near), kinds=_ELEMENTS), "", near)


def _errors(records: Iterable[Record], hint: str, near: Mapping[str, Collection[str]]) -> Iterator[GraphError]:
    """One error for each type, with the first of them."""
    by_type: dict[str, list[tuple[str, str]]] = defaultdict(list)
    for record in records:
        by_type[record["type"]].append((record["source"], record["target"]))
    for name, ends in by_type.items():
        source, target = ends[0]
        which = f"from {shown(source)!r} to {shown(target)!r}" + (
            f" and {counted(len(ends) - 1, 'other')}" * (len(ends) > 1)
        )
        what = f"the relationship {shown(name)!r} {which} means nothing"
        yield GraphError(DATABASE, 0, what, did_you_mean(near.get(name, ()), hint.format(name)))


def _near(name: str, names: Iterable[str], like: float) -> list[str]:
    """Known names that one looks like, whatever its case and its ``_``."""
    plain = {_plain(one): one for one in names}
    return [plain[close] for close in nearest(_plain(name), plain, FEW, like)]


def _plain(name: str) -> str:
    return name.replace("_", "").upper()


class Sealed:
    """What the analysis makes of the roles of elements, as labels and lists, held to what is stored."""

    def __init__(self, vocabulary: Vocabulary) -> None:
        self._ancestors = vocabulary.hierarchy.ancestors
        self._labels = category_labels(vocabulary)
        self._of = {label + end: (name, end) for name, label in self._labels.items() for end in MADE_OF}
        self._roles = [label for label, (_, end) in self._of.items() if end]
        self._strange: dict[str, list[str]] = {}

    def problems(
        self, name: str, labels: Iterable[str], properties: Mapping[str, Any], made_kinds: Iterable[str]
    ) -> Iterator[GraphError]:
        """Return what is written by hand of an element and says nothing.

        Parameters
        ----------
        made_kinds
            Kinds that a role says it makes of others.
        """
        ours = {label for label in labels if label in self._of}
        for label in sorted({*labels} - ours - RESERVED):
            if label not in self._strange:
                self._strange[label] = _near(label, self._roles, NEAR_LABEL)
            if close := self._strange[label]:
                hint = f"{did_you_mean(close)} it would say nothing either: {self._instead(close[0])}"
                yield GraphError(DATABASE, 0, f"{shown(name)!r} has the label {shown(label)}", hint)
        if seal_of(properties, ours) != properties.get("seal"):
            yield self._unsealed(name, ours, properties, made_kinds)

    def _unsealed(
        self, name: str, ours: Collection[str], properties: Mapping[str, Any], made_kinds: Iterable[str]
    ) -> GraphError:
        lists = {key: [kind for kind in _list(properties, key) if kind in self._labels] for key in SEALED}
        lists["begins"] += made_kinds
        explained = {
            self._labels[up] + end
            for end, (key, _) in MADE_OF.items()
            for kind in lists[key]
            for up in self._ancestors.get(kind, ())
        }
        strange = sorted({*ours} - explained)
        bare = [  # what lets out or cleans whatever comes has no labels where nothing comes
            (key, self._labels[kind] + end)
            for end, (key, _) in MADE_OF.items()
            for kind in lists[key]
            if self._labels[kind] + end not in ours
        ]
        first = f"{shown(name)!r} has by hand, and to no effect,"
        if strange and (not bare or bare[0][0] in ("leaks", "sanitizes")):
            what = f"{first} {'the label' if len(strange) == 1 else 'the labels'} {', '.join(strange)}"
            return GraphError(DATABASE, 0, what, f"{self._instead(strange[0])}; REMOVE n:{':'.join(strange)}")
        undo = "take it back, or unload and load the robot"
        if not bare:
            return GraphError(DATABASE, 0, f"{first} another of {', '.join(SEALED)} or of their labels", undo)
        key, label = bare[0]
        what = f"{first} another list {key}, or lacks the label {label}"
        return GraphError(DATABASE, 0, what, f"{self._instead(label)}; {undo}")

    def _instead(self, label: str) -> str:
        """The role to write instead of a label."""
        kind, end = self._of[label]
        return f"write (n)-[:{ROLES[MADE_OF[end][1]].type}]->(:DataCategory {{name: '{kind}'}})"


def _list(properties: Mapping[str, Any], key: str) -> list[Any]:
    value = properties.get(key)
    return value if isinstance(value, list) else []
