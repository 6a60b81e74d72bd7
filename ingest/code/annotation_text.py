"""The text of a comment -> an annotation, in the short language of ``docs/annotations.md``.

In: one line of a comment. Out: what it says of an element, in the words of label files (rules S7, S8), or what is
wrong with it. A comment that looks like an annotation and is none is a problem: a label must not be lost (rule S11).
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import CLEANS, Method, Place, Statement
from rosprivacy.analysis.written_names import MUCH, did_you_mean, nearest
from rosprivacy.ingest.labels.entries import OWN, is_non_ros, naming, specificity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from rosprivacy.ontology.vocabulary import Vocabulary

OF_NODES = {
    "source": "source Video, or: source Video through /image",
    "leak": "leak Voice, Video",
    "sanitizer": "sanitizer Video anonymise",
    "conduit": "conduit, or: conduit Location",
    "derives": "derives Video -> FaceTemplate",
}
OF_CHANNELS = {
    "mundane": "mundane",
    "sensitive": "sensitive",
    "only": "only HomeMap",
    "never": "never Location",
}
NOTE = "note"
WORDS = {**OF_NODES, **OF_CHANNELS, NOTE: "note why it is so"}
SIGN, NONE, THROUGH, ARROW = "privacy", "none", "through", "->"
NO_ROLE = {"source": "no-source", "leak": "no-leak"}
LONGEST = 2_000  # characters of an annotation
_WHOLE = re.compile(r"privacy(?:\(([^()]*)\))?:(.*)", re.DOTALL)
_TOKEN = re.compile(r"\w+|[^\w\s]")
_Read = TypeVar("_Read")
_LENGTHS = range(5, 11)  # of what may be meant for the sign


class Annotation(NamedTuple):
    """One annotation.

    Attributes
    ----------
    name
        The element that it names; empty where it is about what it stands beside.
    word
        One of ``WORDS``.
    statements
        What it says of its element; none for a note.
    note
        Of a note: its text.
    """

    place: Place
    name: str
    word: str
    statements: tuple[Statement, ...] = ()
    note: str = ""


def read_annotation(text: str, place: Place, vocabulary: Vocabulary) -> Annotation | LabelError | None:
    """Read one line of a comment.

    Returns
    -------
    annotation
        Or what is wrong; None for a comment that is no annotation.

    Examples
    --------
    >>> from rosprivacy.ontology.vocabulary import load
    >>> read_annotation("privacy: source Video", Place("camera.py", 3), load()).statements[0].categories
    ('Video',)
    >>> print(read_annotation("privacy: sorce Video", Place("camera.py", 3), load()))
    camera.py:3: unknown word 'sorce' in an annotation; did you mean 'source'?
    >>> read_annotation("about privacy", Place("camera.py", 3), load())
    """
    whole = _WHOLE.fullmatch(text.strip())
    try:
        if whole is None:
            return _no_annotation(text, place)
        name, (word, _, rest) = (whole[1] or "").strip(), whole[2].strip().partition(" ")
        return _of_word(_name(whole[1], name, place), word, rest.strip(), place, vocabulary)
    except LabelError as error:
        return error


def looks_like_one(text: str) -> bool:
    """Return whether somebody may have meant a comment, or a part of it, as an annotation.

    >>> looks_like_one("Privacy: source Video"), looks_like_one("see privacy (leak)")
    (True, False)
    """
    words = _TOKEN.findall(text)
    signs = [at for at, word in enumerate(words) if _is_sign(word)]
    behind = _behind_names(words) if signs else []
    return any(_begins_one(words, at, behind) for at in signs)


def _behind_names(words: Sequence[str]) -> list[int]:
    """For each word where a name in brackets that begins there is over; where it never is, the word itself."""
    behind, closed, marked = [0] * len(words), 0, 0  # no name is over at 0
    for at in range(len(words) - 1, -1, -1):  # once through: a comment may be as long as a file
        closed = at + 1 if words[at] == ")" else closed
        marked = at if words[at] == ":" else marked
        behind[at] = closed or marked or at
    return behind


def _begins_one(words: Sequence[str], at: int, behind: Sequence[int]) -> bool:
    """Whether a word of a comment is the sign of an annotation, with what stands behind it."""
    if at and words[at - 1] == "`":  # quoted
        return False
    after = at + 1
    if words[after : after + 1] == ["("]:
        after = behind[after]
    marked = words[after : after + 1] in ([":"], ["="])
    word = "".join(words[after + marked : after + marked + 1]).lower()
    return (marked or not at) and (word in WORDS or (marked and not at and words[at] == SIGN))


@lru_cache(maxsize=2**12)
def _is_sign(word: str) -> bool:
    near = len(word) in _LENGTHS and word[0] in "pP" and "v" in word.lower()
    return near and bool(nearest(word.lower(), [SIGN], like=MUCH))


def _no_annotation(text: str, place: Place) -> LabelError | None:
    if not looks_like_one(text):
        return None
    what = f"{shown(text.strip())!r} looks like an annotation and is none"
    return LabelError(*place, what, "begin the comment line with privacy: and one of its words, or reword the comment")


def _name(written_name: str | None, name: str, place: Place) -> str:
    if len(name) > LONGEST:
        raise LabelError(*place, f"a name of more than {LONGEST} characters", "write a shorter one, or a glob")
    if written_name is not None and (is_non_ros(name) or any(c.isspace() or not c.isprintable() for c in name)):
        raise LabelError(*place, f"name {shown(name)!r} is not absolute", "begin it with /: privacy(/camera): …")
    return name


def _of_word(name: str, word: str, rest: str, place: Place, vocabulary: Vocabulary) -> Annotation:
    if len(rest) > LONGEST:
        raise LabelError(*place, f"an annotation of more than {LONGEST} characters", "write it in several lines")
    if word not in WORDS:
        hint = did_you_mean([*map(repr, nearest(word.lower(), WORDS))], f"one of {', '.join(WORDS)}")
        what = f"unknown word {shown(word)!r} in an annotation" if word else "an annotation that says nothing"
        raise LabelError(*place, what, hint)
    if word == NOTE:
        if not rest:
            raise LabelError(*place, "note without a text", f"write: {SIGN}: {WORDS[NOTE]}")
        return Annotation(place, name, word, note=rest)
    reader = _AnnotationReader(word, place, vocabulary, specificity(name), naming(name))
    return Annotation(place, name, word, tuple(reader.read(rest)))


class _AnnotationReader:
    """Reads what stands behind a word."""

    def __init__(self, word: str, place: Place, vocabulary: Vocabulary, specific: int, how: str) -> None:
        self.word = word
        self.place = place
        self.vocabulary = vocabulary
        self.blank = Statement(word, (), (OWN, specific), place, naming=how)

    def read(self, rest: str) -> Iterator[Statement]:
        word = self.word
        if word in ("mundane", "sensitive") or (word == "conduit" and not rest):
            if rest:
                raise self.wrong(f"{word} takes nothing, not {shown(rest)!r}")
            yield self.blank
        elif word in NO_ROLE and rest == NONE:
            yield self.blank._replace(role=NO_ROLE[word])
        elif word == "source":
            kinds, through, channels = (part.strip() for part in _parted(rest, THROUGH))
            names = self.items(channels, self.channel) if through else ()
            yield from (self.about(kind)._replace(through=names) for kind in self.items(kinds, self.kind))
        elif word in ("leak", "conduit"):
            yield from map(self.about, self.items(rest, self.kind))
        elif word == "sanitizer":
            yield from self.items(rest, self.sanitizer)
        elif word == "derives":
            yield from self.items(rest, self.derivation)
        else:  # only, never: one statement about all
            yield self.blank._replace(categories=tuple(sorted(set(self.items(rest, self.kind)))))

    def wrong(self, problem: str) -> LabelError:
        return LabelError(*self.place, problem, f"write: {SIGN}: {WORDS[self.word]}")

    def about(self, kind: str) -> Statement:
        return self.blank._replace(categories=(kind,))

    def items(self, text: str, read: Callable[[str], _Read]) -> tuple[_Read, ...]:
        parts = [part.strip() for part in text.split(",")]
        if not all(parts):
            raise self.wrong(f"{self.word} names nothing" if not text.strip() else f"{self.word} with a comma too many")
        return tuple(read(part) for part in parts)

    def kind(self, text: str) -> str:
        found = self.vocabulary.find(text)
        if found is None:
            raise LabelError(*self.place, f"unknown category {shown(text)!r}", self.vocabulary.hint(text))
        return found.name

    def channel(self, text: str) -> str:
        if is_non_ros(text) or any(c.isspace() or not c.isprintable() for c in text):
            raise LabelError(*self.place, f"{shown(text)!r} is not an absolute name", "begin it with /")
        return text

    def sanitizer(self, text: str) -> Statement:
        kind, _, method = text.rpartition(" ")
        if method in CLEANS:
            return self.about(self.kind(kind.strip()))._replace(method=Method(method))
        if self.vocabulary.find(text) is None and kind and self.vocabulary.find(kind.strip()):
            hint = did_you_mean(nearest(method, CLEANS), f"one of {', '.join(CLEANS)}")
            raise LabelError(*self.place, f"sanitizer method {shown(method)!r}", hint)
        return self.about(self.kind(text))._replace(method=Method.PSEUDONYMISE, stated=False)

    def derivation(self, text: str) -> Statement:
        source, arrow, made = (part.strip() for part in text.partition(ARROW))
        if not (source and arrow and made):
            raise self.wrong(f"derivation {shown(text)!r}")
        return self.about(self.kind(source))._replace(role="derivation", to=self.kind(made))


def _parted(text: str, word: str) -> tuple[str, str, str]:
    """A text before and after a word that stands by itself."""
    words = text.split()
    if word not in words:
        return text, "", ""
    at = words.index(word)
    return " ".join(words[:at]), word, " ".join(words[at + 1 :])
