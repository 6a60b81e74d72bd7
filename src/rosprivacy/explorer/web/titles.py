"""What kinds of data are called on the page: names of the vocabulary in, out come words of the reader's language."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.report.catalogs.words import Words


def title_of(kind: str, vocabulary: Vocabulary, words: Words) -> str:
    """Return what a kind of data is called.

    Parameters
    ----------
    kind
        Empty for every kind.
    """
    if not kind:
        return words("x.every")
    category = vocabulary.categories[kind]
    return category.translations.get(words.language, {}).get("title") or category.title


def titles_of(vocabulary: Vocabulary, words: Words) -> dict[str, str]:
    """Return what every kind of data is called."""
    return {name: title_of(name, vocabulary, words) for name in vocabulary.categories}
