"""An answer about some kinds of data -> what the label then says of the whole element.

What the label file says of other kinds stays: an answer about voice leaves alone what was said of video. A limit
(``only``) stays, too: it is a statement about every kind that it does not name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.explorer.web import forms
from rosprivacy.ingest.labels.keywords import NONE

if TYPE_CHECKING:
    from rosprivacy.explorer.web.forms import Answer

WHOLE = ("conduit", "sensitive", "mundane")  # words that stand for an entry of a label file: about every kind
PER_KIND = ("source", "leak", "sanitizer", "conduit", "sensitive", "only", "never")


def label_of(answer: Answer, now: Any) -> dict[str, Any]:
    """Return what ``Session.label`` is given.

    Parameters
    ----------
    now
        What the entry of the element says now; None if there is none.

    Examples
    --------
    >>> from rosprivacy.analysis.model import Element
    >>> node = Element("node", "/recorder")
    >>> label_of(forms.Answer(node, "leak", ("Voice",)), {"sanitizer": {"Video": "drop"}})
    {'sanitizer': {'Video': 'drop'}, 'leak': ['Voice']}
    >>> label_of(forms.Answer(node, "conduit"), {"leak": ["Voice"]})
    {'conduit': True}
    >>> label_of(forms.Answer(node, "conduit"), {"leak": ["Voice"], "derives": [{"from": "Video", "to": "Voice"}]})
    {'derives': [{'from': 'Video', 'to': 'Voice'}], 'conduit': True}
    >>> label_of(forms.Answer(node, "conduit"), {"source": ["Voice"]})
    {'source': ['Voice'], 'conduit': True}
    >>> label_of(forms.Answer(node, "conduit", ("Video",)), "conduit")
    {'conduit': True}
    >>> label_of(forms.Answer(node, "conduit", ("Video",)), {"leak": "none"})
    {'leak': 'none', 'conduit': ['Video']}
    >>> label_of(forms.Answer(Element("topic", "/scan"), "sensitive", ("Voice",)), {"only": ["Location"]})
    {'only': ['Location', 'Voice']}
    """
    label = _kept(now, answer) if _of_all(answer) else _without(now, answer)
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
    """
    return tuple(_as_list(entry.get("only"))) if isinstance(entry, dict) else ()


def _within(limit: tuple[str, ...], answer: Answer, label: dict[str, Any]) -> dict[str, Any]:
    """What is said of a channel with a limit: a kind that it carries comes into the limit, one that it does not leaves.

    A limit that nothing is left of says that no data is carried.
    """
    if answer.role == forms.SENSITIVE:
        return label | {"only": list(dict.fromkeys((*limit, *answer.kinds)))}
    left = [kind for kind in limit if kind not in answer.kinds]
    if not left:
        return {"mundane": True}
    return label | {"only": left, "never": [*_as_list(label.get("never")), *answer.kinds]}


def _by_whom(answer: Answer) -> dict[str, str]:
    said = {"note": answer.note if answer.role != forms.ABSENT else "", "by": answer.by}
    return {key: text for key, text in said.items() if text}


def _of_all(answer: Answer) -> bool:
    """Whether nothing that was said before of data that gets there stays."""
    return answer.role == forms.ABSENT or (not answer.kinds and answer.role != forms.SOURCE)


def _kept(now: Any, answer: Answer) -> dict[str, Any]:
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
    said = _as_list(entry.get("derives")) if isinstance(entry, dict) else []
    return tuple(dict.fromkeys(str(one["to"]) for one in said if isinstance(one, dict) and "to" in one))


def _without(now: Any, answer: Answer) -> dict[str, Any]:
    """What an entry says of data, without what it says of the kinds that an answer is about."""
    if isinstance(now, str):
        return {now: True} if now in WHOLE and now in {answer.role, "conduit"} else {}
    if not isinstance(now, dict):
        return {}
    if answer.role == forms.DERIVES:  # what is made of data says nothing of what becomes of the data itself
        left = {key: now[key] for key in PER_KIND if key in now}
    else:
        left = {key: _less(now[key], answer) for key in PER_KIND if key in now}
    both = {forms.SOURCE: "leak", forms.LEAK: "source"}.get(answer.role, "")  # it may bring in and let out the same
    left |= {both: now[both]} if both in now else {}
    if "derives" in now:
        again = answer.role == forms.DERIVES
        made = [one for one in _as_list(now["derives"]) if not again or _made(one) != (answer.kinds, answer.to)]
        left["derives"] = made
    return {key: said for key, said in left.items() if said}


def _less(said: Any, answer: Answer) -> Any:
    """Kinds that are said, without those of an answer; that none is said stays, until one is."""
    if said is True or said == NONE:
        return said
    if isinstance(said, dict):
        return {kind: how for kind, how in said.items() if kind not in answer.kinds}
    return [kind for kind in _as_list(said) if kind not in answer.kinds]


def _made(one: Any) -> tuple[Any, Any]:
    said = one if isinstance(one, dict) else {}
    return tuple(_as_list(said.get("from"))), said.get("to")


def _as_map(said: Any) -> dict[str, Any]:
    return dict(said) if isinstance(said, dict) else dict.fromkeys(_as_list(said))


def _as_list(said: Any) -> list[Any]:
    return [] if said in (None, NONE) else list(said) if isinstance(said, list | tuple) else [said]
