"""Law that is pointed at and not followed into paths, and the contexts of a system, as rows of the document.

In: a vocabulary, the emitted categories, the contexts of sources. Out: rows, sorted. No verdict: national law stands
there with its country, and who shows it chooses by the countries that are stated.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.contract.notation import Texts
    from rosprivacy.report.contract.stated import ContextEntry, PointerEntry

_KEYS = {"name": "provision"}  # what the contract calls otherwise than the model


def situations(vocabulary: Vocabulary, contexts: Collection[str]) -> list[ContextEntry]:
    """Return the contexts that are stated, with what they mean."""
    return [
        {
            "name": one.name,
            "title": one.title,
            "definition": one.definition,
            "translations": _texts(one.translations),
        }
        for one in vocabulary.pointed.situations
        if one.name in contexts
    ]


def pointers(vocabulary: Vocabulary, categories: Iterable[str], contexts: Collection[str]) -> list[PointerEntry]:
    """Return the provisions to look at, with the categories and contexts that call for each; every system with none."""
    emitted = [vocabulary.categories[name] for name in categories]
    return [
        {
            "provision": one.name,
            "iri": one.iri,
            "title": one.title,
            "meaning": one.meaning,
            "as_of": one.as_of,
            "applies_from": one.applies,
            "confirmed": one.confirmed,
            "adopted": one.adopted,
            "country": one.country,
            "address": one.address,
            "categories": list(kinds),
            "contexts": list(where),
            "translations": _texts(one.translations),
        }
        for one, kinds, where in vocabulary.pointed.rows(emitted, contexts)
    ]


def _texts(texts: Mapping[str, Mapping[str, str]]) -> Texts:
    return {
        language: {_KEYS.get(what, what): text for what, text in sorted(of.items())}
        for language, of in sorted(texts.items())
    }
