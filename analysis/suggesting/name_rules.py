"""Rules about names of topics and nodes, as data, and which of them speaks about a name.

A name is taken apart at ``/``, at signs that are no letters, and where a small letter meets a capital one. Only its
last part speaks; a part with nothing but neutral words hands over to the one before it. There the last word says most.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from rosprivacy.analysis.model import Confidence, Place

Phrase = tuple[str, ...]  # words that follow each other
LONGEST_PHRASE = 4  # words
_HUMP = re.compile("([a-z])([A-Z])")
_NO_LETTERS = re.compile("[^a-z]+")


class NameRule(NamedTuple):
    """What some words of a name, or the use of a library, suggest.

    Attributes
    ----------
    kinds
        Names of categories; none where the words say that data leave the robot, or that a topic carries none.
    to
        The categories that are made of these.
    instead_of
        Categories: where another word of the name suggests one of these, it is the kinds of this rule instead.
    where
        Of what lets data out: where they go.
    any_type
        Whether it can have any form, a flag or a velocity, so that no message type speaks against it.
    alone
        Whether it agrees with nothing, as a window does with a node that is called gui.
    by_itself
        Of what makes something: whether it reads ROS by itself, as a listener of transforms does.
    sort
        Of what lies outside ROS, for a scan of sources: one of ``SORTS``; empty where ``where`` says it.
    """

    kinds: tuple[str, ...]
    confidence: Confidence
    why: str
    place: Place
    to: tuple[str, ...] = ()
    instead_of: tuple[str, ...] = ()
    where: str = ""
    any_type: bool = False
    alone: bool = False
    by_itself: bool = False
    sort: str = ""


@dataclass(frozen=True)
class NameRules:
    """The rules of all files; a field is a section of the file, which says what it means (docs/suggestions.md)."""

    # phrase -> rule: of topics what is sent through them, and that nothing is; of nodes what they bring in or let out
    carries: Mapping[Phrase, NameRule] = field(default_factory=dict)
    nothing: Mapping[Phrase, NameRule] = field(default_factory=dict)
    brings_in: Mapping[Phrase, NameRule] = field(default_factory=dict)
    lets_out: Mapping[Phrase, NameRule] = field(default_factory=dict)
    unprompted: Mapping[Phrase, NameRule] = field(default_factory=dict)  # what who writes such a topic, and reads none
    # category -> category -> rule: what nodes make of it; what of persons a node may tell that takes such data
    becomes: Mapping[str, Mapping[str, NameRule]] = field(default_factory=dict)
    tells: Mapping[str, Mapping[str, NameRule]] = field(default_factory=dict)
    silent: frozenset[Phrase] = frozenset()  # suggest nothing wherever they stand last, such as camera_info
    neutral: frozenset[str] = frozenset()  # words that say nothing by themselves, such as raw
    simulated: frozenset[str] = frozenset()  # a node or topic with one stands for what nobody measured
    understood: frozenset[str] = frozenset()  # a topic with one carries what somebody wants, if its writer reads speech
    computed: frozenset[str] = frozenset()  # categories that programs work out, so that who writes them is no source
    not_by_type: frozenset[str] = frozenset()  # of which a type that says no more than may makes no source by itself


class Spoken(NamedTuple):
    """A rule that speaks about a name, and the words of the name that it is about."""

    rule: NameRule
    words: Phrase

    @property
    def quoted(self) -> str:
        """The words, as a reason quotes them."""
        return f"'{'_'.join(self.words)}'"


@lru_cache(maxsize=2**16)
def words(name: str) -> Phrase:
    """Return the words of one part of a name, in small letters.

    >>> words("cameraInfo_2raw")
    ('camera', 'info', 'raw')
    """
    apart = name if name.islower() else _HUMP.sub(r"\1_\2", name).lower()
    return tuple(word for word in _NO_LETTERS.split(apart) if word)


def of_topic(name: str, rules: NameRules) -> Spoken | None:
    """Return the rule that says what a topic of this name carries, if there is one.

    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> names = ("/head/camera/image_raw", "/camera/depth/image_raw", "/camera/info")
    >>> [said and (said.rule.kinds, said.words) for said in (of_topic(name, NAMES) for name in names)]
    [(('Video',), ('image',)), (('DepthImage',), ('depth',)), None]
    """
    parts = name.split("/")[::-1]
    part = _speaking(parts, rules)
    spoken = _last(part, rules.carries, rules.silent)
    return _instead(spoken, parts, rules) if spoken else None


def of_topic_nothing(name: str, rules: NameRules) -> Spoken | None:
    """Return the rule that says that a topic of this whole name is not made for personal data, if there is one.

    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> of_topic_nothing("/robot/cmd_vel", NAMES).words, of_topic_nothing("/robot/cmd_vel/face", NAMES)
    (('cmd', 'vel'), None)
    """
    part = _own(name)
    return Spoken(rules.nothing[part], part) if part in rules.nothing else None


def has_word(name: str, words: frozenset[str]) -> bool:
    """Return whether the last part of a name has one of some words.

    >>> has_word("/sim/fake_camera", frozenset(["fake"])), has_word("/fake/camera", frozenset(["fake"]))
    (True, False)
    """
    return not words.isdisjoint(_own(name))


def of_node(name: str, rules: Mapping[Phrase, NameRule], silent: frozenset[Phrase] = frozenset()) -> Spoken | None:
    """Return the rule that speaks about a node of this name, by its own part of the name.

    Parameters
    ----------
    silent
        Phrases that suggest nothing as the last words: ``get_camera_params`` is no camera.

    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> of_node("/front/camera_driver", NAMES.brings_in).words, of_node("/camera/pose", NAMES.brings_in)
    (('camera',), None)
    """
    return _last(_own(name), rules, silent)


def _own(name: str) -> Phrase:
    return words(name.rpartition("/")[2])


def _speaking(parts: Sequence[str], rules: NameRules) -> Phrase:
    """The words of the first part with any that is not neutral."""
    return next((part for part in map(words, parts) if not rules.neutral.issuperset(part)), ())


def _last(part: Phrase, rules: Mapping[Phrase, NameRule], silent: frozenset[Phrase]) -> Spoken | None:
    """The rule about the last words of a part that a rule is about; of several phrases there the longest."""
    for phrase in _phrases(part):
        if phrase in silent:
            return None
        if phrase in rules:
            return Spoken(rules[phrase], phrase)
    return None


@lru_cache(maxsize=2**16)
def _phrases(part: Phrase) -> tuple[Phrase, ...]:
    """The phrases of a part of a name: those that end last first, of these the longest first; O(words)."""
    beginnings = (part[max(0, end - LONGEST_PHRASE) : end] for end in range(len(part), 0, -1))
    return tuple(phrase for beginning in beginnings for phrase in _last_phrases(beginning))


def _last_phrases(part: Phrase) -> tuple[Phrase, ...]:
    """The phrases at the end of a part, the longest first."""
    return tuple(part[start:] for start in range(max(0, len(part) - LONGEST_PHRASE), len(part)))


def _instead(spoken: Spoken, parts: Sequence[str], rules: NameRules) -> Spoken:
    """What another word of the name makes of what its last one says: a depth image is no video."""
    for part in parts:
        for phrase in _phrases(words(part)):
            rule = rules.carries.get(phrase)
            if rule and rule.instead_of and not set(spoken.rule.kinds).isdisjoint(rule.instead_of):
                return Spoken(rule, phrase)
    return spoken
