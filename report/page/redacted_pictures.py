"""Pictures with other names: those of a document that was redacted (see ``redact.py``).

In: a ``Picture``, a document and its copy. Out: a ``Picture`` in which no name is left that the copy does not have.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rosprivacy.report.naming import key

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from typing import Any

    from rosprivacy.report.pictures.picture import Box, Key, Picture


def aliases_of(document: Any, changed: Any) -> dict[Key, tuple[str, str]]:
    """Return how elements of a document are called in a copy of it whose names were replaced."""
    parts: Iterable[tuple[Any, Any]]
    if isinstance(document, list):
        parts = zip(document, changed, strict=True)
    elif isinstance(document, dict):
        if {"robot", "kind", "name"} <= set(document):
            return {key(document)[:3]: (changed["robot"], changed["name"])}
        parts = ((document[name], changed[name]) for name in document if name in changed)
    else:
        return {}
    found: dict[Key, tuple[str, str]] = {}
    for part in parts:
        found |= aliases_of(*part)
    return found


def renamed(picture: Picture, aliases: Mapping[Key, tuple[str, str]]) -> Picture:
    """Return a picture with other names; what has none is known by its kind and number in the picture only."""
    keys = {
        box.key: (alias[0], box.kind, alias[1]) if (alias := aliases.get(box.key)) else ("", box.kind, f"… {number}")
        for number, box in enumerate(picture.boxes, 1)
    }

    def names(box: Box) -> tuple[str, ...]:
        others = [aliases.get((box.robot, box.kind, name), ("", "…"))[1] for name in box.names[1:]]
        return (keys[box.key][2], *others)

    boxes = tuple(replace(box, key=keys[box.key], names=names(box), group="") for box in picture.boxes)
    lines = tuple(replace(line, source=keys[line.source], target=keys[line.target]) for line in picture.lines)
    core = frozenset(keys[one] for one in picture.core)
    return replace(picture, title="", notes=(), ways=(), boxes=boxes, lines=lines, core=core)
