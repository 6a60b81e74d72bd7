"""Nodes, relationships and paths that a query gives -> a picture; all of them are drawn, and nothing else.

In: values of a query's rows. Out: a ``Picture``. Where all that a query gives are elements and the relationships along
which data goes (``CARRIES_…``), it is a privacy view, with the roles that the elements have for the kinds of data that
are drawn. Otherwise it is a ROS graph view: flows say what is allowed, and other relationships have their type on them.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Place
from rosprivacy.queries.graph_values import Node, Path, Relationship, nodes_in
from rosprivacy.report.pictures.looks import (
    ALLOWED,
    DATA,
    DENIED,
    DERIVATION,
    END,
    LEAK,
    MATCHES,
    OPEN,
    OTHER,
    REVIEWED,
    SANITIZER,
    SOURCE,
    WAY,
)
from rosprivacy.report.pictures.phrases import Phrases
from rosprivacy.report.pictures.picture import (
    PRIVACY,
    RECORD,
    ROS,
    Box,
    Picture,
    PictureLine,
    sorted_boxes,
    sorted_lines,
)
from rosprivacy.report.pictures.privacy import BOUND
from rosprivacy.report.stored import flow_said, record_kind, record_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.queries.graph_values import GraphValue
    from rosprivacy.report.pictures.picture import Key
    from rosprivacy.report.stored import StoredNames


def query_view(
    values: Iterable[GraphValue],
    names: StoredNames,
    title: str,
    notes: tuple[str, ...] = (),
    say: Phrases | None = None,
) -> Picture:
    """Return the picture of what a query gives.

    Elements are drawn as elsewhere: the legs of a service, the sides of a wildcard and an ``Intake`` with its element
    are one box. Other nodes are one box for each name.

    Parameters
    ----------
    say
        The words on the boxes; None for English.
    """
    graph = _Graph(names, say or Phrases())
    for value in values:
        graph.add(value)
    return graph.picture(title, notes)


class _Graph:
    """What is drawn, by the ids of the server: each node and each relationship once."""

    def __init__(self, names: StoredNames, say: Phrases) -> None:
        self._names, self._say = names, say
        self._nodes: dict[str, Node] = {}
        self._relationships: dict[str, Relationship] = {}

    def add(self, value: GraphValue) -> None:
        self._nodes |= {node.id: node for node in nodes_in(value)}
        found = value.relationships if isinstance(value, Path) else (value,) if isinstance(value, Relationship) else ()
        self._relationships |= {relationship.id: relationship for relationship in found}

    def picture(self, title: str, notes: tuple[str, ...]) -> Picture:
        elements = {node.id: self._names.element(node) for node in self._nodes.values()}
        keys = {node.id: _key(node, elements[node.id]) for node in self._nodes.values()}
        data = bool(self._relationships) and all(elements.values()) and all(map(self._kind, self._relationships))
        together: dict[Key, list[Node]] = defaultdict(list)
        for node in sorted(self._nodes.values(), key=lambda node: (keys[node.id], node.labels)):
            together[keys[node.id]].append(node)
        kinds = {self._kind(id_) for id_ in self._relationships} if data else set()
        boxes = [
            _carrying(key, nodes, elements[nodes[0].id], kinds, self._say)
            if data
            else _plain(key, nodes[0], elements[nodes[0].id])
            for key, nodes in together.items()
        ]
        looks = self._data_looks(kinds) if data else {}
        lines: dict[tuple[object, ...], PictureLine] = {}
        for id_, relationship in self._relationships.items():
            ends = keys[relationship.start.id], keys[relationship.end.id]
            line = self._line(*ends, relationship, looks.get(id_))
            slot = (*ends, line.look, line.words)
            if ends[0] != ends[1] or line.look == OTHER:
                lines[slot] = _merged(lines[slot], line) if slot in lines else line
        view = PRIVACY if data else ROS
        return Picture(view, title, sorted_boxes(boxes), sorted_lines(lines.values()), notes, words=self._say.words)

    def _kind(self, id_: str) -> str:
        """The kind of data that goes along a relationship, as its type writes it; empty where it is another type."""
        type_ = self._relationships[id_].type
        return type_.removeprefix(self._names.carries) if type_.startswith(self._names.carries) else ""

    def _data_looks(self, kinds: Iterable[str]) -> dict[str, str]:
        """Relationship -> its look: from where a drawn path of one kind of data goes on to a leak of it."""
        looks = dict.fromkeys(self._relationships, DATA)
        for kind in kinds:
            back: dict[str, list[str]] = defaultdict(list)
            for id_, relationship in self._relationships.items():
                if self._kind(id_) == kind:
                    back[relationship.end.id].append(id_)
            waiting = [id_ for id_ in back if _role(self._nodes[id_], "leaks", "LEAK", {kind})]
            seen = set(waiting)
            while waiting:
                for id_ in back[waiting.pop()]:
                    looks[id_] = WAY
                    start = self._relationships[id_].start.id
                    if start not in seen:
                        seen.add(start)
                        waiting.append(start)
        return looks

    def _line(self, source: Key, target: Key, relationship: Relationship, look: str | None) -> PictureLine:
        file, line = (relationship.properties.get(name) for name in ("file", "line"))
        places = (Place(str(file), line if isinstance(line, int) else 0),) if file else ()
        if look:
            return PictureLine(source, target, look, carries=(relationship.type,))
        if relationship.type != self._names.flow:
            return PictureLine(source, target, OTHER, places=places, words=relationship.type)
        role, denied = flow_said(relationship)
        look = DENIED if denied else MATCHES if role == "matches" else ALLOWED
        return PictureLine(source, target, look, (role,), places=places)


def _key(node: Node, element: Mapping[str, Any] | None) -> Key:
    if element:
        return element["robot"], element["kind"], element["name"]
    return str(node.properties.get("robot", "")), RECORD, f"{record_name(node)} ({record_kind(node)})"


def _plain(key: Key, node: Node, element: Mapping[str, Any] | None) -> Box:
    if element:
        return Box(key, (key[2],), key[1], pattern=element["pattern"])
    return Box(key, (record_name(node),), RECORD, (record_kind(node),))


def _carrying(
    key: Key, nodes: Iterable[Node], element: Mapping[str, Any] | None, kinds: Iterable[str], say: Phrases
) -> Box:
    """An element with its roles for some kinds of data; the legs of a service share them."""
    assert element

    def of(name: str) -> list[str]:
        return sorted({category for node in nodes for category in _categories_named(node, name, kinds)})

    begins, leaks, cleans, stops, unknown = map(of, ("begins", "leaks", "sanitizes", "stops", "open"))
    ended = [category for category in cleans if category in stops]
    hidden = [category for category in cleans if category not in stops]
    made = sorted({label for node in nodes for label in _labelled(node, "SOURCE", kinds)})
    roles = {
        LEAK: any(_role(node, "leaks", "LEAK", kinds) for node in nodes),
        SOURCE: begins,
        DERIVATION: made,
        END: ended and ended == cleans,
        SANITIZER: cleans,
        OPEN: unknown,
        REVIEWED: True,
    }
    said = {"source": begins, "leak": leaks, "pseudonymises": hidden, "cleans": ended, "unreviewed": unknown}
    words = [say.of(text, categories, BOUND) for text, categories in said.items() if categories]
    if made and not begins:
        words.append(say.words("picture.makes", names=say.listed((label[: -len("Source")] for label in made), BOUND)))
    look = next(role for role, holds in roles.items() if holds)
    return Box(key, (key[2],), look, tuple(words), bool(unknown), pattern=element["pattern"])


def _categories_named(node: Node, name: str, kinds: Iterable[str]) -> list[str]:
    """Which categories a list of an element names, of those that are drawn."""
    drawn = {_written(kind) for kind in kinds}
    listed = node.properties.get(name, ())
    return [text for text in listed if _written(str(text)) in drawn] if isinstance(listed, list) else []


def _role(node: Node, name: str, suffix: str, kinds: Iterable[str]) -> bool:
    """Whether an element has a role for a kind: by its list; an ``Intake`` has labels only."""
    return bool(_categories_named(node, name, kinds) if name in node.properties else _labelled(node, suffix, kinds))


def _labelled(node: Node, suffix: str, kinds: Iterable[str]) -> list[str]:
    wanted = {_written(kind) + suffix for kind in kinds}
    return [label for label in node.labels if _written(label) in wanted]


def _written(name: str) -> str:
    """A category's name, its label and the type of its relationships, all written alike."""
    return name.replace("_", "").upper()


def _merged(first: PictureLine, second: PictureLine) -> PictureLine:
    places = sorted({*first.places, *second.places}, key=lambda place: (place.file, place.line))
    return replace(
        first,
        roles=tuple(sorted({*first.roles, *second.roles})),
        carries=tuple(sorted({*first.carries, *second.carries})),
        places=tuple(places),
    )
