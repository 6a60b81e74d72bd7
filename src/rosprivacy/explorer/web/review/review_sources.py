"""What may bring data in, where nobody suggests it: a session and a text to find go in, out come ``Sources``.

Nothing is followed that nobody names (rule S11): so a review asks for it, instead of ending with nothing asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.explorer.web.left_open import left_of, note_before
from rosprivacy.explorer.web.review.review_questions import named_with_robots

if TYPE_CHECKING:
    from rosprivacy.explorer.web.standing import Standing
    from rosprivacy.report.catalogs.words import Words

MOST = 40  # rows; the others are found by name
LONGEST = 200  # letters of what is looked for


class Source(NamedTuple):
    """Something that may be named, and what was noted of it."""

    id: str
    name: str
    said: str


class Sources(NamedTuple):
    """What a person chooses from.

    Attributes
    ----------
    find
        What names are looked for by; empty for all.
    more
        How many rows are left out.
    followed
        Whether something was named already.
    """

    find: str
    rows: tuple[Source, ...]
    more: int
    followed: bool


def sources_of(standing: Standing, find: str, words: Words) -> Sources:
    """Return the elements that can be named: all but channels, what nobody spoke of first."""
    find = find[:LONGEST]
    first = {at for some in standing.places.values() for at in some}
    fitting = [
        (at, element)
        for at, element in standing.elements.items()
        if at in first and not element.is_channel and find.casefold() in element.full_name.casefold()
    ]
    fitting = [one for one in fitting if standing.session.can_answer(one[1])]
    fitting.sort(key=lambda one: one[0] in standing.spoken)
    rows = []
    for at, element in fitting[:MOST]:
        entry = next(iter(standing.said_of(element)), None) if at in standing.spoken else None
        note = shown(note_before(entry) or left_of(entry))
        rows.append(Source(at, named_with_robots(element, standing, words), note))
    return Sources(shown(find), tuple(rows), len(fitting[MOST:]), bool(standing.analysis.emitted))
