"""Which suggestions of a label file a person means who accepts by a word, by a name, or by a name and what it is.

In: the suggestions, and what is named. Out: those that are accepted, and remarks. Where several suggestions of one
element are alternatives (a camera of pictures, or of depth; a leak, or a conduit), none is taken before a person has
said which.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.weighing import surer
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import literal

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.ingest.suggestions.comments import Comment
    from rosprivacy.ontology.vocabulary import Vocabulary

BRINGS_OR_LETS_OUT, PASSES_OR_ENDS = ("source", "leak"), ("conduit", "sanitizer")
ONE_OF_A_KIND = ("derives", "sanitizer")  # of one kind, several of these are often what it could be instead
ALL = "*"


def chosen(
    file: str, comments: Sequence[Comment], named: Sequence[str], vocabulary: Vocabulary
) -> tuple[list[Comment], list[str]]:
    """Return the suggestions that are accepted, in the order of the file, and remarks.

    Parameters
    ----------
    named
        Confidences, of which all that are as sure or surer are meant; names of elements, of which the surest are
        meant; and names with a kind or a role (``/camera=Video``, ``/uplink=leak``), or with ``*`` for all.

    Raises
    ------
    InputErrors
        If nothing is suggested of an element, or alternatives are.
    """
    least = [Confidence(name) for name in named if name in tuple(Confidence)]
    taken: dict[int, Comment] = {}
    problems: list[LabelError] = []
    for name in dict.fromkeys(name for name in named if name not in tuple(Confidence)):
        try:
            taken |= {one.line: one for one in _of_element(file, comments, name, vocabulary)}
        except LabelError as error:
            problems.append(error)
    if problems:
        raise InputErrors(problems)
    sure = [one for one in comments if any(not surer(word, one.confidence) for word in least)]
    by_name = [one for one in sure if _needs_name(one, comments, vocabulary) and one.line not in taken]
    taken |= {one.line: one for one in sure if not _needs_name(one, comments, vocabulary)}
    remarks = []
    if least and not comments:
        remarks.append(f"{file}: it has no '# suggest:' line; rosprivacy suggest POLICY --into FILE writes them")
    if by_name:
        what = f"{counted(len(by_name), 'suggestion')} could hide a leak or what nobody looked at"
        remarks.append(f"{file}: {what}: accept these one by one, by the name of the element")
    return [one for one in comments if one.line in taken], remarks


def overlap(value: Any, other: Any, vocabulary: Vocabulary) -> bool:
    """Return whether two values of roles can be about the same data; where a name is not known, they can."""
    kinds = [[vocabulary.find(str(one)) for one in _kinds(v)] for v in (value, other)]
    pairs = ((a, b) for a in kinds[0] for b in kinds[1])
    return any(not a or not b or vocabulary.hierarchy.overlap(a.name, b.name) is not None for a, b in pairs)


def _of_element(file: str, comments: Sequence[Comment], named: str, vocabulary: Vocabulary) -> list[Comment]:
    """The suggestions that are meant by a name, or a name and what it is."""
    name, _, what = named.rpartition("=") if named.rfind("=") > 0 else (named, "", "")
    there = [one for one in comments if one.name in (name, literal(name) if name.startswith("/") else name)]
    if not there:
        hint = "name an element of a '# suggest:' line, or certain, likely or may"
        raise LabelError(file, 0, f"nothing is suggested of {shown(name)}", hint)
    if what == ALL:
        return there
    meant = [one for one in there if what in (*one.said, *_words(one))] if what else _surest(there)
    if not meant:
        raise LabelError(file, 0, f"{shown(what)!r} is not suggested of {shown(name)}", _say_which(name, there))
    if any(alternatives(one, other, vocabulary) for one in meant for other in meant):
        told = ", ".join(dict.fromkeys(f"{_role(one)} {'/'.join(_words(one))} (line {one.line})" for one in meant))
        raise LabelError(
            file, 0, f"of {shown(name)} alternatives are suggested: {shown(told)}", _say_which(name, meant)
        )
    return meant


def _surest(there: Sequence[Comment]) -> list[Comment]:
    """Of what is as sure what takes data away only when it stands alone."""
    return [one for one in there if not any(_comes_before(other, one) for other in there)]


def _say_which(name: str, there: Iterable[Comment]) -> str:
    first = next(iter(there))
    what = _role(first) if _role(first) in (*BRINGS_OR_LETS_OUT[1:], *PASSES_OR_ENDS) else next(iter(_words(first)))
    return f"say which, such as --accept {shown(name)}={shown(what)}, or remove the lines that are wrong"


def alternatives(one: Comment, other: Comment, vocabulary: Vocabulary) -> bool:
    """Return whether two suggestions of one element are two answers to one question."""
    if one.line == other.line or one.name != other.name or one.section != other.section:
        return False
    ((role, value),), ((second, instead),) = one.said.items(), other.said.items()
    if role == second:
        return role == "source" or (role in ONE_OF_A_KIND and overlap(value, instead, vocabulary))
    sides = [(first in BRINGS_OR_LETS_OUT, first in PASSES_OR_ENDS) for first in (role, second)]
    against = (sides[0] == (True, False) and sides[1] == (False, True)) or (sides[1] == (True, False) and sides[0][1])
    against = against or ("sensitive" in (role, second) and (one.takes_away or other.takes_away))
    return against and overlap(value, instead, vocabulary)


def _needs_name(comment: Comment, comments: Iterable[Comment], vocabulary: Vocabulary) -> bool:
    """Whether no word accepts it: it takes data away, is a conduit that may be, or one of a leak and a conduit."""
    if comment.takes_away or (comment.hides and comment.confidence is Confidence.MAY):
        return True
    here = [other for other in comments if other.name == comment.name and "conduit" in other.said]
    return "leak" in comment.said and any(alternatives(comment, other, vocabulary) for other in here)


def _comes_before(other: Comment, comment: Comment) -> bool:
    """Whether of two suggestions for an element the other is accepted first: what takes nothing away, if as sure."""
    if other.confidence is comment.confidence:
        return comment.takes_away and not other.takes_away
    return surer(other.confidence, comment.confidence)


def _role(comment: Comment) -> str:
    return next(iter(comment.said))


def _words(comment: Comment) -> list[str]:
    """What a suggestion names: kinds, and of what is made of them that."""
    (value,) = comment.said.values()
    return [str(one["to"]) if isinstance(one, dict) and "to" in one else str(one) for one in value]


def _kinds(value: Any) -> Iterator[Any]:
    for one in [value] if isinstance(value, str) else value:
        yield one.get("from", "") if isinstance(one, dict) else one
