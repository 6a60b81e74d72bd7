"""Edits of a label file: what a person says of one element, by a short name of its own, and what differs between files.

In: what the file says of the element now, and what is said of it anew. Out: ``Edit``. In: a graph. Out: ids that stay
whatever is labelled (rule S1): each is made of what an element is, not of its place in the graph, so that it means the
same in every version of a session. It has letters and digits only, whatever stands in a policy.
"""

from __future__ import annotations

from functools import lru_cache
from hashlib import sha256
from typing import TYPE_CHECKING, Any, NamedTuple, TypedDict

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import NON_ROS
from rosprivacy.analysis.suggesting.evidence import whole
from rosprivacy.ingest.labels.edited_entries import KINDS, SaidOfElement, same_name
from rosprivacy.ingest.labels.keywords import CHANNEL, NO_KIND, NODE, moves_data

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.model import Element, FlowGraph
    from rosprivacy.ontology.vocabulary import Vocabulary

    Entries = Mapping[tuple[str, str], Any]  # (section, name) -> what the entry says

DIGITS = 16  # hexadecimal: two of a million elements are alike with a chance of one in 30 million


@lru_cache(maxsize=1 << 16)
def element_id(identity: tuple[str, str, str]) -> str:
    """Return the id of an element of this identity; its legs and sides have the same.

    >>> element_id(("", "node", "/camera"))
    'e367b8bde1c84db46'
    """
    return f"e{sha256(chr(0).join(identity).encode('utf-8', 'surrogatepass')).hexdigest()[:DIGITS]}"


def by_id(graph: FlowGraph) -> Mapping[str, Element]:
    """Return the elements of a graph, whole, by their ids, in the order of the graph."""
    return {element_id(element.identity): whole(element) for element in graph.elements}


SECTION = {
    "node": "nodes",
    "topic": "topics",
    "service": "services",
    "action": "actions",
    "channel": "channels",
    "non_ros": "elements",
    **dict.fromkeys(NON_ROS, "elements"),
}
ROLES = (*moves_data(NODE), *moves_data(CHANNEL))  # what data does there
WHOLE_NODE_KEYWORDS = {
    "conduit": "conduit",
    "mundane": "never",
    "sensitive": "sensitive",
}  # said of all kinds -> key of a map


class Label(TypedDict, total=False):
    """What a label file can say of one element; names of kinds of data may stand alone, without a list.

    Attributes
    ----------
    source, leak, conduit, sensitive, only, never
        Kinds of data; of a source also a map to the channels that they go out through. ``conduit`` and ``sensitive``
        may be True: for all kinds.
    sanitizer
        Kinds, or a map from kinds to methods.
    derives
        A map with ``from`` and ``to``, or several.
    mundane
        True: the channel carries no personal data.
    absent
        Why a node with a profile is not on the robot.
    non_ros
        What an element outside ROS is: a map with ``kind`` and what else the section ``elements`` knows.
    subjects, context, purpose, legal_basis, types
        As the label file has them.
    note
        Why.
    by
        Who says so.
    """

    source: Any
    leak: Any
    sanitizer: Any
    conduit: Any
    derives: Any
    absent: str | None
    subjects: Any
    context: Any
    purpose: Any
    legal_basis: Any
    sensitive: Any
    only: Any
    never: Any
    mundane: bool
    types: Any
    non_ros: Mapping[str, Any] | None
    note: str | None
    by: str | None


class Edit(NamedTuple):
    """One change of one entry of the label file that people edit.

    Attributes
    ----------
    section, name, value
        As of ``SaidOfElement``; a value of None takes the entry away.
    file
        The label file of a fleet that it goes to; empty where a session edits one only.
    """

    section: str
    name: str
    value: Any
    file: str = ""

    @property
    def statement(self) -> SaidOfElement:
        """What the entry says after it."""
        return SaidOfElement(self.section, self.name, self.value)


def copied(value: Any) -> Any:
    """Return an entry that stays as it is, whatever becomes of the lists and maps that it was said with.

    >>> kinds = ["Video"]
    >>> entry = copied({"leak": kinds})
    >>> kinds.append("Voice")
    >>> entry
    {'leak': ['Video']}
    """
    if isinstance(value, dict):
        return {key: copied(one) for key, one in value.items()}
    return [copied(one) for one in value] if isinstance(value, list) else value


def section_of(kind: str, name: str, file: str) -> str:
    """Return the section of label files for a kind of element."""
    if kind in KINDS:  # the section itself
        return kind
    if kind not in SECTION:
        what = f"{shown(str(kind))!r} is no kind of element that labels are about"
        raise InputErrors([LabelError(file, 0, f"{shown(name)}: {what}", f"one of {', '.join(SECTION)}")])
    return SECTION[kind]


def place_of(section: str, name: str, entries: Mapping[tuple[str, str], Any]) -> tuple[str, str]:
    """Return section and name of the entry that a file has of an element, or would get.

    A topic may stand under ``channels``, and what is called a channel under ``topics``.

    >>> place_of("topics", "=/map", {("channels", "/map"): "mundane"})
    ('channels', '/map')
    """
    kinds = set(KINDS[section])
    for sections in ([section], [there for there, other in KINDS.items() if kinds & set(other)]):
        for there, written in entries:
            if there in sections and same_name(written, name):
                return there, written
    return section, name


def entry_of(label: Label, before: Any, vocabulary: Vocabulary) -> Any:
    """Return the entry that says what a label says.

    What data does there is said anew as a whole. What else the entry states (subjects, legal basis, types, the note)
    stays, if the label does not say it too; an empty text or list takes it away.

    Parameters
    ----------
    before
        What the entry says now; None if there is none.

    Examples
    --------
    >>> from rosprivacy.ontology.vocabulary import load
    >>> entry_of({"conduit": True}, {"leak": ["Video"]}, load())
    'conduit'
    >>> entry_of({"leak": "Voice", "by": "A. Lee"}, {"source": ["Video"], "purpose": "safety"}, load())
    {'leak': ['Voice'], 'purpose': 'safety', 'author': 'A. Lee'}
    """
    said: dict[str, Any] = {"author" if key == "by" else key: one for key, one in label.items() if one is not None}
    outside = said.pop("non_ros", {})
    roles = {key: _as_list(key, said.pop(key)) for key in ROLES if key in said}
    roles = {key: one for key, one in roles.items() if one is not False}
    kept = {key: one for key, one in before.items() if key not in ROLES} if isinstance(before, dict) else {}
    more = {key: one for key, one in {**kept, **outside, **said}.items() if one not in ("", [])}
    whole = [key for key in WHOLE_NODE_KEYWORDS if roles.get(key) is True]
    if len(whole) == len(roles) == 1 and not more:
        return whole[0]
    roles |= {WHOLE_NODE_KEYWORDS[key]: _all(vocabulary) for key in whole}
    if "mundane" in roles:
        del roles["mundane"]
    first = {key: more.pop(key) for key in ("kind",) if key in more}
    return {**first, **roles, **more} or None


def _as_list(key: str, value: Any) -> Any:
    """Names as the label file has them: a list, whatever they come in."""
    if key != "absent" and value != NO_KIND and isinstance(value, str | dict if key == "derives" else str):
        return [value]
    return sorted(value) if isinstance(value, set | frozenset) else list(value) if isinstance(value, tuple) else value


def _all(vocabulary: Vocabulary) -> list[str]:
    """The kinds of data that have no broader one: together, all."""
    return sorted(name for name in vocabulary.categories if not vocabulary.hierarchy.broader(name))


def differences(before: Entries, after: Entries) -> list[Edit]:
    """Return the edits that make of some entries others.

    >>> changed = differences({("nodes", "/a"): "conduit"}, {("nodes", "/b"): {"leak": ["Video"]}})
    >>> [(edit.section, edit.name, edit.value) for edit in changed]
    [('nodes', '/a', None), ('nodes', '/b', {'leak': ['Video']})]
    """
    keys = dict.fromkeys([*before, *after])
    return [Edit(*key, after.get(key)) for key in keys if before.get(key) != after.get(key)]
