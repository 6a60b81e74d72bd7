"""Which categories can be special ones (GDPR, Article 9(1)), always or on a condition: as the ontology says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.legal import SPECIAL

if TYPE_CHECKING:
    from rosprivacy.ontology.vocabulary import Vocabulary


def special_provision(vocabulary: Vocabulary, name: str) -> str:
    """Return the name of the provision of Article 9(1) that data of a category can be under; empty if there is none.

    Data that only may reveal what the article speaks of do not count.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> special_provision(load(), "FaceTemplate"), special_provision(load(), "Video")
    ('GDPR Art. 9(1) biometric data', '')
    """
    law = vocabulary.categories[name].law
    return next((legal.name for legal in law if legal.special and legal.verdict in SPECIAL), "")
