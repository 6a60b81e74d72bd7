"""What the label file says of an element after an answer: the entry of now and an answer in, out comes its label.

What the file says of other kinds stays: an answer about voice leaves alone what was said of video. A limit (``only``)
stays, too: it is a statement about every kind that it does not name. What a person leaves to an engineer is kept in the
note of the entry, in brackets behind whatever it said before, so that it can be taken out once there is an answer: the
element stays open, since a note says nothing of data.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import BY_TYPE
from rosprivacy.explorer.edits import ROLES
from rosprivacy.explorer.web import forms
from rosprivacy.ingest.labels.keywords import NO_KIND
from rosprivacy.report.catalogs.words import Words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.explorer.web.forms import FormAnswer

LANGUAGES = ("en", "de", "fr")  # in which an earlier review may have been
WHOLE_NODE_ROLES = (
    "conduit",
    "sensitive",
    "mundane",
)  # words that stand for an entry of a label file: about every kind
PER_KIND = ("source", "leak", "sanitizer", "conduit", "sensitive", "only", "never")


def label_of(answer: FormAnswer, now: Any) -> dict[str, Any]:
    """Return what ``Session.label`` is given.

    Parameters
    ----------
    now
        What the entry of the element says now; None if there is none.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> node = Element("node", "/recorder")
    >>> label_of(forms.FormAnswer(node, "leak", ("Voice",)), {"sanitizer": {"Video": "drop"}})
    {'sanitizer': {'Video': 'drop'}, 'leak': ['Voice']}
    >>> label_of(forms.FormAnswer(node, "conduit"), {"leak": ["Voice"]})
    {'conduit': True}
    >>> label_of(forms.FormAnswer(node, "conduit"), {"leak": ["Voice"], "derives": [{"from": "Video", "to": "Voice"}]})
    {'derives': [{'from': 'Video', 'to': 'Voice'}], 'conduit': True}
    >>> label_of(forms.FormAnswer(node, "conduit"), {"source": ["Voice"]})
    {'source': ['Voice'], 'conduit': True}
    >>> label_of(forms.FormAnswer(node, "conduit", ("Video",)), "conduit")
    {'conduit': True}
    >>> label_of(forms.FormAnswer(node, "conduit", ("Video",)), {"leak": "none"})
    {'leak': 'none', 'conduit': ['Video']}
    >>> label_of(forms.FormAnswer(Element("topic", "/scan"), "sensitive", ("Voice",)), {"only": ["Location"]})
    {'only': ['Location', 'Voice']}
    """
    label = _unaffected(now, answer) if _of_all(answer) else _without(now, answer)
    role, kinds = answer.role, list(answer.kinds)
    if role == forms.ABSENT:
        label["absent"] = answer.note
    elif role == forms.SANITIZER:
        label["sanitizer"] = {**_as_map(label.get("sanitizer")), **dict.fromkeys(kinds, answer.method)}
    elif role == forms.DERIVES:
        label["derives"] = [*_as_list(label.get("derives")), *({"from": kind, "to": answer.to} for kind in kinds)]
    elif kinds and limit_of(now):
        return _within(limit_of(now), answer, label) | _by_whom(answer)
    elif role == forms.MUNDANE and kinds:
        label["never"] = [*_as_list(label.get("never")), *kinds]
    elif not kinds or label.get(role) is True:
        label[role] = True
    elif isinstance(label.get(role), dict):  # of a source: the channels that others go out through
        raise forms.FormError("What the label file says there names channels: change it in the file.")
    else:
        label[role] = [*_as_list(label.get(role)), *kinds]
    return label | _by_whom(answer)


def limit_of(entry: Any) -> tuple[str, ...]:
    """Return the kinds of data that an entry says a channel carries at most; none where it states no limit.

    >>> limit_of({"only": ["Location"], "note": "seen"}), limit_of("sensitive")
    (('Location',), ())

    A line about its type names no kind:

    >>> limit_of({"only": "by-type"})
    ()
    """
    limit = entry.get("only") if isinstance(entry, dict) else None
    return () if limit == BY_TYPE else tuple(_as_list(limit))


def _within(limit: tuple[str, ...], answer: FormAnswer, label: dict[str, Any]) -> dict[str, Any]:
    """What is said of a channel with a limit: a kind that it carries comes into the limit, one that it does not leaves.

    A limit that nothing is left of says that no data is carried.
    """
    if answer.role == forms.SENSITIVE:
        return label | {"only": list(dict.fromkeys((*limit, *answer.kinds)))}
    left = [kind for kind in limit if kind not in answer.kinds]
    if not left:
        return {"mundane": True}
    return label | {"only": left, "never": [*_as_list(label.get("never")), *answer.kinds]}


def _by_whom(answer: FormAnswer) -> dict[str, str]:
    words = {"note": answer.note if answer.role != forms.ABSENT else "", "by": answer.by}
    return {key: text for key, text in words.items() if text}


def _of_all(answer: FormAnswer) -> bool:
    """Whether nothing that was said before of data that gets there stays."""
    return answer.role == forms.ABSENT or (not answer.kinds and answer.role != forms.SOURCE)


def _unaffected(now: Any, answer: FormAnswer) -> dict[str, Any]:
    """What an entry says that the element brings in, or makes of data: an answer about every kind takes none back.

    Such an answer says what becomes of the data that get there, and nothing of what is made of them.
    """
    stays = isinstance(now, dict) and answer.role != forms.ABSENT
    return {key: now[key] for key in ("source", "derives") if key in now} if stays else {}


def made_by(entry: Any) -> tuple[str, ...]:
    """Return what an entry says that an element makes of other data.

    >>> made_by({"derives": [{"from": "Video", "to": "FaceTemplate"}]}), made_by("conduit")
    (('FaceTemplate',), ())
    """
    derivations = _as_list(entry.get("derives")) if isinstance(entry, dict) else []
    return tuple(dict.fromkeys(str(each["to"]) for each in derivations if isinstance(each, dict) and "to" in each))


def _without(now: Any, answer: FormAnswer) -> dict[str, Any]:
    """What an entry says of data, without what it says of the kinds that an answer is about."""
    if isinstance(now, str):
        return {now: True} if now in WHOLE_NODE_ROLES and now in {answer.role, "conduit"} else {}
    if not isinstance(now, dict):
        return {}
    if answer.role == forms.DERIVES:  # what is made of data says nothing of what becomes of the data itself
        left = {key: now[key] for key in PER_KIND if key in now}
    else:
        left = {key: _without_answer(now[key], answer) for key in PER_KIND if key in now}
    both = {forms.SOURCE: "leak", forms.LEAK: "source"}.get(answer.role, "")  # it may bring in and let out the same
    left |= {both: now[both]} if both in now else {}
    if "derives" in now:
        again = (answer.kinds, answer.to) if answer.role == forms.DERIVES else None
        left["derives"] = [each for each in _as_list(now["derives"]) if again is None or _derivations(each) != again]
    return {key: value for key, value in left.items() if value}


def _without_answer(value: Any, answer: FormAnswer) -> Any:
    """Kinds that are said, without those of an answer; a word in their place stays."""
    if value is True or value in (NO_KIND, BY_TYPE):
        return value
    if isinstance(value, dict):
        return {kind: how for kind, how in value.items() if kind not in answer.kinds}
    return [kind for kind in _as_list(value) if kind not in answer.kinds]


def _derivations(derivation: Any) -> tuple[Any, Any]:
    ends = derivation if isinstance(derivation, dict) else {}
    return tuple(_as_list(ends.get("from"))), ends.get("to")


def _as_map(value: Any) -> dict[str, Any]:
    return dict(value) if isinstance(value, dict) else dict.fromkeys(_as_list(value))


def _as_list(value: Any) -> list[Any]:
    return [] if value in (None, NO_KIND) else list(value) if isinstance(value, list | tuple) else [value]


# --- notes of a review


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
    whom = f"{by} – {why}" if why else by
    note = f"{note_before(entry)} [{words('review.left')}: {whom}]".strip()
    if says_of_data(entry):  # who said that stays its author
        return {**_roles(entry), "note": note}
    return {"note": note, "by": by}


def bringing_nothing(entry: Any, by: str, why: str, words: Words) -> dict[str, Any]:
    """Return what ``Session.label`` is given where a person says that an element brings in no data of persons.

    What the entry says of data that gets there stays.

    >>> bringing_nothing({"leak": ["Voice"], "author": "B. Roy"}, "A. Lee", "a lamp", Words("en"))
    {'leak': ['Voice'], 'note': 'brings in no data of persons: a lamp (A. Lee)'}
    """
    note = words("review.note.none", why=why)
    if says_of_data(entry):  # who said that stays its author
        return {**_roles(entry), "note": f"{note} ({by})"}
    return {"note": note, "by": by}


def brings_nothing(entry: Any) -> bool:
    """Whether a note of a review says that an element brings in no data of persons; no other note says that.

    >>> brings_nothing({"note": "brings in no data of persons: a lamp"}), brings_nothing({"note": "above the door"})
    (True, False)
    """
    note = note_before(entry)
    return any(note.startswith(Words(language)("review.note.none", why="").strip()) for language in LANGUAGES)


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
        before, mark, left = note.rpartition(f"[{Words(language)('review.left')}: ")
        if mark and left.endswith("]"):
            return before.strip(), left[:-1]
    return note, ""
