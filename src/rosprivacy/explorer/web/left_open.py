"""What a person leaves to an engineer: an entry of a label file goes in, out comes what its note keeps of that.

The element stays open: the note says nothing of data. It stands in brackets behind whatever the note said before, so
that it can be taken out again once there is an answer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.explorer.edits import ROLES
from rosprivacy.report.catalogs.words import Words

if TYPE_CHECKING:
    from collections.abc import Mapping

LANGUAGES = ("en", "de", "fr")  # in which an earlier review may have been


def left_of(entry: Any) -> str:
    """Return what is left to the engineer, with who left it; empty for nothing.

    >>> left_of({"note": "near the door [To ask the engineer: A. Lee – does it keep them?]"})
    'A. Lee – does it keep them?'
    >>> left_of("conduit")
    ''
    """
    return _parted(entry)[1]


def note_before(entry: Any) -> str:
    """Return the note without what is left to the engineer.

    >>> note_before({"note": "near the door [To ask the engineer: A. Lee]"})
    'near the door'
    """
    return _parted(entry)[0]


def leaving(entry: Any, by: str, why: str, words: Words) -> dict[str, Any]:
    """Return what ``Session.label`` is given so that an element stays as it is, with a note for the engineer.

    >>> leaving(None, "A. Lee", "", Words("en"))
    {'note': '[To ask the engineer: A. Lee]', 'by': 'A. Lee'}
    >>> leaving({"leak": ["Voice"], "note": "seen", "author": "B. Roy"}, "A. Lee", "video?", Words("en"))
    {'leak': ['Voice'], 'note': 'seen [To ask the engineer: A. Lee – video?]'}
    """
    told = f"{by} – {why}" if why else by
    note = f"{note_before(entry)} [{words('rv.left')}: {told}]".strip()
    if says_of_data(entry):  # who said that stays its author
        return {**_roles(entry), "note": note}
    return {"note": note, "by": by}


def bringing_nothing(entry: Any, by: str, why: str, words: Words) -> dict[str, Any]:
    """Return what ``Session.label`` is given where a person says that an element brings in no data of persons.

    What the entry says of data that gets there stays.

    >>> bringing_nothing({"leak": ["Voice"], "author": "B. Roy"}, "A. Lee", "a lamp", Words("en"))
    {'leak': ['Voice'], 'note': 'brings in no data of persons: a lamp (A. Lee)'}
    """
    note = words("rv.note.none", why=why)
    if says_of_data(entry):  # who said that stays its author
        return {**_roles(entry), "note": f"{note} ({by})"}
    return {"note": note, "by": by}


def brings_nothing(entry: Any) -> bool:
    """Whether a note of a review says that an element brings in no data of persons; no other note says that.

    >>> brings_nothing({"note": "brings in no data of persons: a lamp"}), brings_nothing({"note": "above the door"})
    (True, False)
    """
    note = note_before(entry)
    return any(note.startswith(Words(language)("rv.note.none", why="").strip()) for language in LANGUAGES)


def says_of_data(entry: Any) -> bool:
    """Whether an entry says what data does there.

    >>> says_of_data({"note": "a lamp"}), says_of_data("mundane")
    (False, True)
    """
    return bool(_roles(entry))


def _roles(entry: Any) -> Mapping[str, Any]:
    if isinstance(entry, str):
        return {entry: True}
    return {key: entry[key] for key in ROLES if key in entry} if isinstance(entry, dict) else {}


def _parted(entry: Any) -> tuple[str, str]:
    note = str(entry.get("note") or "") if isinstance(entry, dict) else ""
    for language in LANGUAGES:
        before, there, told = note.rpartition(f"[{Words(language)('rv.left')}: ")
        if there and told.endswith("]"):
            return before.strip(), told[:-1]
    return note, ""
