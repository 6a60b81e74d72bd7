"""What data are processed for, on which basis and by whom <-> properties of the graph in Neo4j (Article 30(1)).

In: ``Processing`` of an element or a robot. Out: plain values for ``schema.py``'s properties; and back, also from what
people wrote by hand.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Place, Processing
from rosprivacy.analysis.non_ros import EVERY
from rosprivacy.ingest.reading.legal_basis import HINT, legal_basis

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from rosprivacy.analysis.model import ByCategory


def processing_properties(said: Processing) -> dict[str, Any]:
    """Return the properties; None where nothing is stated.

    >>> from rosprivacy.analysis.model import UNSTATED
    >>> set(processing_properties(UNSTATED).values())
    {None}
    """
    return {
        "controller": said.controller or None,
        "dpo": said.dpo or None,
        "purposes": list(_texts(said.purposes)) or None,
        "legal_bases": list(_texts(said.bases)) or None,
        "stated_in": said.place.file if said else None,
        "stated_at": said.place.line if said else None,
    }


def processing_of(said: Mapping[str, Any], categories: Collection[str]) -> Processing:
    """Return what properties state.

    Raises
    ------
    ValueError
        If one cannot be understood; the message says which and why.
    """
    found = Processing(
        _text(said, "controller"),
        _text(said, "dpo"),
        _by_category(said, "purposes", categories),
        tuple((category, tuple(map(_basis, some))) for category, some in _by_category(said, "legal_bases", categories)),
    )
    place = Place(_text(said, "stated_in"), int(said.get("stated_at") or 0))
    return Processing(found.controller, found.dpo, found.purposes, found.bases, place) if found else found


def _texts(stated: ByCategory) -> Iterator[str]:
    """``6(1)(f)`` for every category, ``Video: 6(1)(f)`` for one."""
    yield from (f"{category}: {one}" if category else one for category, some in stated for one in some)


def _by_category(said: Mapping[str, Any], key: str, categories: Collection[str]) -> ByCategory:
    written = said.get(key) or []
    if not isinstance(written, list) or not all(isinstance(one, str) for one in written):
        raise ValueError(f"{key} is not a list of texts")
    found: dict[str, set[str]] = {}
    for one in written:
        category, colon, text = one.partition(": ")
        of, what = (category, text) if colon and category in categories else (EVERY, one)
        found.setdefault(of, set()).add(what)
    return tuple(sorted((category, tuple(sorted(some))) for category, some in found.items()))


def _basis(written: str) -> str:
    basis = legal_basis(written)
    if basis is None:
        raise ValueError(f"legal basis {written!r}; {HINT}")
    return basis


def _text(said: Mapping[str, Any], key: str) -> str:
    value = said.get(key)
    if not (value is None or isinstance(value, str)):
        raise ValueError(f"{key} is not a text")
    return value or ""
