"""What is asked for: the filters of the command line -> categories."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, OntologyError, shown

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.model import Category
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


def asked_for(vocabulary: Vocabulary, settings: Settings) -> set[str] | None:
    """Return the categories that the answer is about; None for all.

    These are what the filters name, narrower kinds, and what is broader than one of them (so all kinds that overlap
    what is asked for): data of these may be of the kind asked for (S7, S11).
    """
    named = _named(vocabulary, settings)
    if named is None:
        return None
    return named.union(*(vocabulary.hierarchy.broader(name) for name in named))


def may_be(vocabulary: Vocabulary, settings: Settings, emitted: Iterable[str]) -> dict[str, list[str]]:
    """Return the emitted categories that the answer is about only since they may be what is asked for -> what of it."""
    named = _named(vocabulary, settings)
    if named is None:
        return {}
    above = {name: vocabulary.hierarchy.ancestors[name] for name in named}
    first = {name for name in named if not set(above[name]) & named - {name}}
    common = {name: [up for up in above.values() if name in up] for name in sorted(set(emitted) - named)}
    found = {name: sorted(kind for kind in first if any(kind in up for up in both)) for name, both in common.items()}
    return {name: kinds for name, kinds in found.items() if kinds}


def _named(vocabulary: Vocabulary, settings: Settings) -> set[str] | None:
    """What the filters name, with narrower kinds; None where there is no filter."""
    if not (settings.categories or settings.article9 or settings.data_types):
        return None
    asked = set(vocabulary.categories)
    problems = []
    if settings.categories:
        asked = set()
        for name in settings.categories:
            category = vocabulary.find(name)
            if category is None:
                what = f"unknown category {shown(name)!r}"
                problems.append(OntologyError("--categories", 0, what, vocabulary.hint(name)))
            else:
                asked |= vocabulary.with_narrower(category.name)
    known = sorted({kind for category in vocabulary.categories.values() for kind in category.data_types})
    for kind in settings.data_types:
        if kind not in known:
            hint = f"it is one of: {', '.join(known)}"
            problems.append(OntologyError("--data-type", 0, f"unknown data type {shown(kind)!r}", hint))
    if problems:
        raise InputErrors(problems)
    return {name for name in asked if _chosen(vocabulary.categories[name], settings)}


def _chosen(category: Category, settings: Settings) -> bool:
    """Whether the filters keep a category; what is not known of it is kept, since silence would look like an answer."""
    types = not settings.data_types or not category.data_types or set(category.data_types) & set(settings.data_types)
    return bool(types) and (not settings.article9 or category.article9 != "no")
