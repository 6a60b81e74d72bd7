"""Suggestions that a person accepts -> labels, each with who accepted it, when and why in its note.

In: the text of a label file with suggestions as comments. Out: the text with the accepted ones as labels, and remarks.
Only the entries that they are about change; what comes out is read anew before it is given out.

What takes data away (a sanitizer, never) is never accepted by its confidence, whoever says so: a finding that it would
close may not be known yet. A person names the element, and gets it after what else is as sure. A conduit is accepted by
its confidence if it is ``likely``, which only the catalogue of packages makes it. Neither is put beside a source or a
leak of such data.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.weighing import surer
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.analysis.written_names import literal, meant
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_reader import SECTIONS
from rosprivacy.ingest.labels.label_writer import NewLine, add_line, facts_of
from rosprivacy.ingest.policies.names import covered
from rosprivacy.ingest.reading.kept_yaml import FAILURES, changed, keeps_comments
from rosprivacy.ingest.suggestions.comments import as_written, taken_apart, with_comments

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.suggestions.comments import Comment
    from rosprivacy.ontology.vocabulary import Vocabulary

BRINGS_OR_LETS_OUT, PASSES_OR_ENDS = ("source", "leak"), ("conduit", "sanitizer")


@dataclass(frozen=True, slots=True)
class Accepted:
    """The new text, how many suggestions became labels, and what to tell a person."""

    text: str
    count: int
    remarks: tuple[str, ...]


def accept(file: str, text: str, named: Sequence[str], who: str, day: str, vocabulary: Vocabulary) -> Accepted:
    """Make labels of suggestions.

    Parameters
    ----------
    named
        Confidences, of which all that are as sure or surer are meant; and names of elements, of which the surest are
        meant, since others are often what it could be instead; of these what takes data away only when it stands alone.
    who, day
        For the note.
    vocabulary
        In whose words the file is written.

    Raises
    ------
    InputErrors
        If the file is no label file, or has comments that begin as suggestions and are none.
    LabelError
        If nothing is suggested of an element, or the file cannot be changed without losing something.
    """
    rest, comments = taken_apart(file, text)
    before = parse_labels(text, vocabulary, name=file).entries
    if facts_of(parse_labels(rest, vocabulary, name=file).entries) != facts_of(before):
        raise _by_hand(file, f"the suggestion of line {comments[0].line} is part of a text")
    chosen, remarks = _chosen(file, comments, named)
    taken: list[Comment] = []

    def change(top: Any) -> None:
        for comment in chosen:
            refused = _against(before, comment, vocabulary)
            refused = refused or _put(top, comment, f"accepted by {who} on {day}", vocabulary)
            if refused:
                remarks.append(f"{file}:{comment.line}: {shown(comment.name)} {refused}; change it by hand")
            else:
                taken.append(comment)

    try:
        new = changed(rest, change) if chosen else rest
    except FAILURES as error:
        raise _by_hand(file, f"cannot be changed: {shown(str(error).splitlines()[0])}") from None
    _check(file, rest, new, taken, vocabulary)
    left = [as_written(comment) for comment in comments if comment not in taken]
    return Accepted(with_comments(new, left), len(taken), tuple(remarks))


def _chosen(file: str, comments: Sequence[Comment], named: Sequence[str]) -> tuple[list[Comment], list[str]]:
    """The suggestions that are accepted, in the order of the file."""
    least = [Confidence(name) for name in named if name in tuple(Confidence)]
    elements = {literal(name) if name.startswith("/") else name for name in named if name not in tuple(Confidence)}
    there = {comment.name for comment in comments}
    unknown = sorted(elements - there)
    if unknown:
        what = f"nothing is suggested of {', '.join(map(shown, unknown))}"
        raise LabelError(file, 0, what, "name an element of a '# suggest:' line, or certain, likely or may")
    chosen, by_name = [], 0
    for comment in comments:
        sure = any(not surer(one, comment.confidence) for one in least)
        one_of = comment.name in elements and not any(
            other.name == comment.name and _comes_before(other, comment) for other in comments
        )
        if one_of or (sure and not _needs_name(comment)):
            chosen.append(comment)
        elif sure:
            by_name += 1
    remarks = []
    if by_name:
        what = f"{counted(by_name, 'suggestion')} could hide a leak or what nobody looked at"
        remarks.append(f"{file}: {what}: accept these one by one, by the name of the element")
    return chosen, remarks


def _needs_name(comment: Comment) -> bool:
    return comment.takes_away or (comment.hides and comment.confidence is Confidence.MAY)


def _comes_before(other: Comment, comment: Comment) -> bool:
    """Whether of two suggestions for an element the other is accepted first: what takes nothing away, if as sure."""
    if other.confidence is comment.confidence:
        return comment.takes_away and not other.takes_away
    return surer(other.confidence, comment.confidence)


def _put(top: Any, comment: Comment, how: str, vocabulary: Vocabulary) -> str:
    """Write one label; return why not, if it cannot be joined to what the entry says."""
    note = DoubleQuotedScalarString(blanked(f"{how} ({comment.confidence}): {comment.why}", "?"))
    ((role, value),) = comment.said.items()
    section = _section_of(top, comment)
    if section is None:
        add_line(top, NewLine(comment.section, comment.name, "", _flow({role: value, "note": note})))
        return ""
    entry = section[comment.name]
    if entry is None:
        section[comment.name] = _flow({role: value, "note": note})
        return ""
    if entry == "conduit" and not comment.hides:
        return "is a conduit already"
    if not isinstance(entry, CommentedMap) or "absent" in entry:
        return f"is {shown(str(entry))} already"
    against = BRINGS_OR_LETS_OUT if comment.hides else PASSES_OR_ENDS if role in BRINGS_OR_LETS_OUT else ()
    other = next((one for one in against if one in entry and _overlap(value, entry[one], vocabulary)), "")
    if other:
        return f"is a {other} of such data already"
    refused = _join(entry, role, value)
    if not refused:
        said = entry.get("note")
        entry["note"] = DoubleQuotedScalarString(f"{said}; {note}") if said else note
    return refused


def _against(before: Iterable[Entry], comment: Comment, vocabulary: Vocabulary) -> str:
    """Why one that hides is refused: a line, by a glob too, says that such data come in or go out there (rule S7)."""
    (value,) = comment.said.values()
    for entry in before if comment.hides else ():
        meant_too = set(SECTIONS[comment.section]) & set(entry.kinds) and covered(entry.name, [meant(comment.name)])
        for one in entry.statements if meant_too else ():
            if one.role in BRINGS_OR_LETS_OUT and (not one.categories or _overlap(value, one.categories, vocabulary)):
                return f"is a {one.role} of such data already, by line {entry.place.line}"
    return ""


def _overlap(value: Any, other: Any, vocabulary: Vocabulary) -> bool:
    """Whether two roles can be about the same data; where a name is not known, they can."""
    kinds = [[vocabulary.find(str(one)) for one in ([v] if isinstance(v, str) else v)] for v in (value, other)]
    pairs = ((a, b) for a in kinds[0] for b in kinds[1])
    return any(not a or not b or vocabulary.hierarchy.overlap(a.name, b.name) is not None for a, b in pairs)


def _section_of(top: Any, comment: Comment) -> Any:
    """The section that has an entry of that name for elements of that kind; None if none has."""
    for name, kinds in SECTIONS.items():
        section = top.get(name)
        if set(SECTIONS[comment.section]) <= set(kinds) and section and comment.name in section:
            return section
    return None


def _join(entry: Any, role: str, value: Any) -> str:
    """Put a role into an entry; return why not."""
    old = entry.get(role)
    if role not in entry:
        entry.insert(0, role, _flow(value))
    elif isinstance(old, list) and isinstance(value, list):
        old.extend(_flow(one) for one in value if one not in old)
    elif isinstance(old, dict) and isinstance(value, dict):
        if any(old.get(kind, method) != method for kind, method in value.items()):
            return f"says another {role} already"
        old.update(value)
    elif isinstance(old, str) and isinstance(value, list) and old != "none":
        entry[role] = _flow([old, *(one for one in value if one != old)])
    else:
        return f"says {role} in another form already"
    return ""


def _flow(value: Any) -> Any:
    """A value as it is written on one line."""
    if isinstance(value, dict):
        map_ = CommentedMap((key, _flow(one)) for key, one in value.items())
        map_.fa.set_flow_style()
        return map_
    if isinstance(value, list):
        list_ = CommentedSeq(map(_flow, value))
        list_.fa.set_flow_style()
        return list_
    return value


def _check(file: str, old: str, new: str, taken: Iterable[Comment], vocabulary: Vocabulary) -> None:
    """Hold the new text against the old one: nothing is lost, and only the entries that are meant have changed."""
    touched = {(SECTIONS[comment.section], comment.name) for comment in taken}

    def others(text: str) -> list[Any]:
        entries = parse_labels(text, vocabulary, name=file).entries
        return facts_of(e for e in entries if not any(e.name == name and set(k) <= set(e.kinds) for k, name in touched))

    try:
        same = others(old) == others(new)
    except InputErrors as error:
        first = error.errors[0]
        raise _by_hand(file, f"a suggestion makes no label: {first.problem}") from None
    if not same:
        raise _by_hand(file, "cannot be changed without changing another entry")
    if not keeps_comments(old, new):
        raise _by_hand(file, "cannot be changed without losing a comment")


def _by_hand(file: str, problem: str) -> LabelError:
    return LabelError(file, 0, problem, "write the labels by hand")
