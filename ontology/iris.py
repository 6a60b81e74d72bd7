"""The two names of our terms: the one that is published, and the one under which they have always been stored.

In: an IRI or a Turtle text. Out: the same in the other form. Turtle files and linked data have the published form,
which w3id.org can lead to where the ontology lies. Documents, databases, logs and everything inside the program keep
the stored form, so that nothing that people saved or wrote finds less than before. Both mean the same wherever one is
read.
"""

from __future__ import annotations

PUBLISHED = "https://w3id.org/rosprivacy#"
STORED = "urn:x-rosprivacy:"


def as_stored(text: str) -> str:
    """Return an IRI, or a text that names some, in the stored form.

    >>> as_stored("https://w3id.org/rosprivacy#Video"), as_stored("urn:x-rosprivacy:Video"), as_stored("urn:e:Pulse")
    ('urn:x-rosprivacy:Video', 'urn:x-rosprivacy:Video', 'urn:e:Pulse')
    """
    return text.replace(PUBLISHED, STORED)


def as_published(text: str) -> str:
    """Return an IRI, or a text that names some, in the published form.

    >>> as_published("urn:x-rosprivacy:Video")
    'https://w3id.org/rosprivacy#Video'
    """
    return text.replace(STORED, PUBLISHED)
