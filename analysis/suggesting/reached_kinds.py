"""Which kinds of data get to an element, and what of a kind does."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.hierarchy import Hierarchy

    Identity = tuple[str, str, str]


def reached_kinds(analysis: Analysis) -> dict[Identity, tuple[str, ...]]:
    """Return by element the kinds of data that get there, pseudonymised ones too.

    >>> from rosprivacy.analysis.example import factory
    >>> from rosprivacy.analysis.findings.findings import analyse
    >>> [kinds for (_, _, name), kinds in reached_kinds(analyse(*factory())).items() if name == "/faces"]
    [('FaceTemplate',)]
    """
    joined = cache(lambda *some: tuple(sorted({kind for kinds in some for kind in kinds})))
    found: dict[Identity, tuple[str, ...]] = {}
    for one in analysis.carried:
        at = one.element.identity
        found[at] = joined(found.get(at, ()), one.categories, one.pseudonymised)
    return found


def narrowed(kind: str, reached: Iterable[str], hierarchy: Hierarchy) -> frozenset[str]:
    """Return what of a kind gets somewhere: the narrower kinds that do, or the kind itself where broader ones do.

    >>> from rosprivacy.analysis.example import factory
    >>> hierarchy = factory()[2]
    >>> sorted(narrowed("Biometric", ["FaceTemplate", "Voice"], hierarchy)), sorted(narrowed("Voice", [], hierarchy))
    (['FaceTemplate'], [])
    """
    there = [one for one in reached if hierarchy.overlap(kind, one) is not None]
    return frozenset(one if kind in hierarchy.ancestors[one] else kind for one in there)
