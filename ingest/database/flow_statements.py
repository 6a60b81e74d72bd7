"""What labels say of a flow <-> properties of a ``FLOWS_TO``: each statement at its rank, and two lists for people.

In: statements, or what is stored. Out: the other. ``only`` and ``never`` name what holds by rule S7; where a person
changes one of these lists, it takes the place of all that files say by that word, and outranks them.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.kernel.ranks import decided
from rosprivacy.analysis.model import GLOB, Place, Statement
from rosprivacy.ingest.labels.entries import EXACT

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.hierarchy import Hierarchy

DATABASE = "the database"
HAND = 2  # the tier of what a person added: above every file
WORDS = ("only", "never")


def as_properties(said: Sequence[Statement], hierarchy: Hierarchy) -> dict[str, Any]:
    """Return the properties of a flow of which labels say something; None for those that are absent."""
    words = {statement.role for statement in said}
    return {
        **{word: list(names) if word in words else None for word, names in _holding(said, hierarchy).items()},
        "naming": GLOB if said and all(statement.naming == GLOB for statement in said) else None,
        "said_at": sorted({str(statement.place) for statement in said}) or None,
        "statements": [json.dumps(_as_json(statement), sort_keys=True) for statement in said] or None,
    }


def names_of(properties: Mapping[str, Any]) -> set[str]:
    """Return the categories that what is stored of a flow names.

    Raises
    ------
    KeyError, TypeError, ValueError
        If it cannot be understood.
    """
    stated = {name for statement in _stated(properties) for name in statement.categories}
    return stated.union(*(_names(properties, word) for word in WORDS))


def statements_of(properties: Mapping[str, Any], hierarchy: Hierarchy) -> tuple[Statement, ...]:
    """Return what is stored as statements: those of files as they were, but for a list that a person changed."""
    stated = _stated(properties)
    holding = _holding(stated, hierarchy)
    listed = {word: _names(properties, word) for word in WORDS}
    changed = [word for word in WORDS if listed[word] != holding[word]]
    by_hand = [Statement(word, listed[word], (HAND, EXACT), Place(DATABASE, 0)) for word in changed if listed[word]]
    return (*(statement for statement in stated if statement.role not in changed), *by_hand)


def _holding(said: Sequence[Statement], hierarchy: Hierarchy) -> dict[str, tuple[str, ...]]:
    """By word, the names of which one of its statements holds."""
    named = sorted({name for statement in said for name in statement.categories})
    holding = {name: decided("", said, name, hierarchy).accepted for name in named}
    return {
        word: tuple(n for n in named if any(s.role == word and n in s.categories for s in holding[n])) for word in WORDS
    }


def _as_json(statement: Statement) -> dict[str, Any]:
    tier, specificity = statement.rank
    return {
        "role": statement.role,
        "categories": statement.categories,
        "tier": tier,
        "specificity": specificity,
        "naming": statement.naming,
        "file": statement.place.file,
        "line": statement.place.line,
        **{key: text for key, text in (("why", statement.why), ("author", statement.author)) if text},
        **({} if statement.pinned is None else {"pinned": statement.pinned}),
    }


def _stated(properties: Mapping[str, Any]) -> list[Statement]:
    stated = []
    for said in map(json.loads, properties.get("statements") or ()):
        rank, place = (int(said["tier"]), int(said["specificity"])), Place(str(said["file"]), int(said["line"]))
        why, author = (str(said.get(key) or "") for key in ("why", "author"))
        pinned = tuple(said["pinned"]) if "pinned" in said else None
        more = {"naming": said["naming"], "why": why, "author": author, "pinned": pinned}
        stated.append(Statement(said["role"], tuple(said["categories"]), rank, place, **more))
    return stated


def _names(properties: Mapping[str, Any], word: str) -> tuple[str, ...]:
    names = properties.get(word) or []
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise TypeError(f"{word} is not a list of names")
    return tuple(sorted(set(names)))
