"""What an edit does: what differs between two answers of a session, and between two states of its label file.

In: results, or entries by section and name. Out: ``Change``, ``Difference``, edits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.explorer.edits import Edit

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.answer import Verdict
    from rosprivacy.result import Result

    Entries = Mapping[tuple[str, str], Any]


class Difference(NamedTuple):
    """What is so in one answer and not in another.

    Attributes
    ----------
    before, verdict
        The verdicts.
    opened, closed
        Ids of the findings that stand in the second one only, and in the first one only.
    more, fewer
        How many elements are open in the second one only, and in the first one only.
    """

    before: Verdict
    verdict: Verdict
    opened: tuple[str, ...]
    closed: tuple[str, ...]
    more: int
    fewer: int


class Change(NamedTuple):
    """What an edit did; the rest is as of ``Difference``.

    Attributes
    ----------
    version
        Of the session after it.
    """

    edit: Edit
    version: int
    before: Verdict
    verdict: Verdict
    opened: tuple[str, ...] = ()
    closed: tuple[str, ...] = ()
    more: int = 0
    fewer: int = 0


def compared(before: Result, after: Result) -> Difference:
    """Return what differs between two answers."""
    stood, stands = ([f.id for f in result.analysis.findings if f.stands] for result in (before, after))
    had, has = set(stood), set(stands)
    was, now = ({q.element.shown_as for q in result.analysis.open} for result in (before, after))
    return Difference(
        before.analysis.verdict,
        after.analysis.verdict,
        tuple(one for one in stands if one not in had),
        tuple(one for one in stood if one not in has),
        len(now - was),
        len(was - now),
    )


class Merged(NamedTuple):
    """What somebody else said of entries that this session said something of, too.

    Attributes
    ----------
    theirs
        What the file now says, where what was said here was saved before: it stands.
    both
        What the file now says, where this session says something else that is not saved.
    """

    theirs: tuple[Edit, ...]
    both: tuple[Edit, ...]


def merged(known: Entries, theirs: Entries, mine: Entries) -> Merged:
    """Return where an edited label file and a session speak of the same entry.

    Parameters
    ----------
    known, theirs
        What the file said as the session knows it, and what it says now.
    mine
        What the session says.

    Examples
    --------
    >>> place = ("nodes", "/a")
    >>> [edit.value for edit in merged({}, {place: "conduit"}, {place: {"leak": ["Video"]}}).both]
    ['conduit']
    >>> [edit.value for edit in merged({place: "mundane"}, {place: "conduit"}, {place: "mundane"}).theirs]
    ['conduit']
    """
    found: dict[bool, list[Edit]] = {True: [], False: []}
    for edit in differences(known, theirs):
        place = edit.section, edit.name
        if mine.get(place) != edit.value:
            found[mine.get(place) == known.get(place)].append(edit)
    return Merged(tuple(found[True]), tuple(found[False]))


def differences(before: Entries, after: Entries) -> list[Edit]:
    """Return the edits that make of some entries others.

    >>> changed = differences({("nodes", "/a"): "conduit"}, {("nodes", "/b"): {"leak": ["Video"]}})
    >>> [(edit.section, edit.name, edit.value) for edit in changed]
    [('nodes', '/a', None), ('nodes', '/b', {'leak': ['Video']})]
    """
    keys = dict.fromkeys([*before, *after])
    return [Edit(*key, after.get(key)) for key in keys if before.get(key) != after.get(key)]
