"""The spaces of a language: in French, the marks that a space stands before keep to their word.

In: a text as it is typed, with plain spaces. Out: the same with spaces at which no line breaks.
"""

from __future__ import annotations

import re

WIDE, NARROW = "\u00a0", "\u202f"  # as the Imprimerie nationale has them: before a colon and in quotes; before ; ? !
_FRENCH = ((re.compile(r" (?=[:»])|(?<=«) "), WIDE), (re.compile(r" (?=[;?!])"), NARROW))


def spaced(text: str, language: str) -> str:
    """Return a text with the spaces of its language.

    >>> spaced("Source : « oui » ; non ?", "fr").encode("ascii", "namereplace").count(b"NO-BREAK SPACE")
    5
    >>> spaced("Source : yes", "en")
    'Source : yes'
    """
    for mark, space in _FRENCH if language == "fr" else ():
        text = mark.sub(space, text)
    return text


def plain(text: str) -> str:
    """Return a text with plain spaces, for a picture: it breaks its lines itself, and shows other spaces escaped."""
    return text.replace(WIDE, " ").replace(NARROW, " ")
