"""Which categories can be special ones (GDPR, Article 9): read from the law that the ontology names, not known here."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rosprivacy.ontology.vocabulary import Vocabulary

_ARTICLE_9 = re.compile(r"\bArt(?:icle|\.)? ?9\b")


def special_provision(vocabulary: Vocabulary, name: str) -> str:
    """Return the name of the provision of Article 9 that data of a category can be under; empty if there is none.

    That of a broader category holds too.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> special_provision(load(), "FaceTemplate"), special_provision(load(), "Video")
    ('GDPR Art. 9(1) biometric data', '')
    """
    for above in (name, *vocabulary.hierarchy.broader(name)):
        for legal in vocabulary.categories[above].law:
            if legal.verdict != "no" and _ARTICLE_9.search(legal.name):
                return legal.name
    return ""
