"""Suggestions that a person accepts -> labels, each with who accepted it, when and why in its note.

In: the text of a label file with suggestions as comments. Out: the text with the accepted ones as labels, and remarks.
Only the entries that they are about change; what comes out is read anew before it is given out.

What takes data away (a sanitizer, never) is never accepted by its confidence, whoever says so: a finding that it would
close may not be known yet. A person names the element, and gets it after what else is as sure; and only where the
policies are given as well, and no finding of such data is known, with what is accepted beside it. A conduit is accepted
by its confidence if it is ``likely``, which only the catalogue of packages makes it. Neither is put beside a source or
a leak of such data. Where several suggestions of one element are alternatives (a camera of pictures, or of depth; a
leak, or a conduit), none is taken before a person has said which.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from rosprivacy.analysis.errors import InputErrors, LabelError, shown
from rosprivacy.analysis.model import Confidence
from rosprivacy.analysis.suggesting.outdated_reasons import grounds_of
from rosprivacy.analysis.suggesting.weighing import surer
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.analysis.written_names import bare_name, literal
from rosprivacy.ingest.labels.entries import SECTIONS
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import NewLine, add_line, facts_of
from rosprivacy.ingest.policies.names import covered
from rosprivacy.ingest.reading.kept_yaml import FAILURES, changed, keeps_comments
from rosprivacy.ingest.suggestion_rules.comments import as_written, hides, taken_apart, with_comments, without_refusals

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.ingest.labels.entries import Entry
    from rosprivacy.ingest.suggestion_rules.comments import Comment
    from rosprivacy.ontology.vocabulary import Vocabulary
LIMITING = frozenset(["sanitizer", "never", "mundane", "only"])  # roles that take data away
BRINGS_OR_LETS_OUT, PASSES_OR_ENDS = ("source", "leak"), ("conduit", "sanitizer")
ONE_OF_A_KIND = ("derives", "sanitizer")  # of one kind, several of these are often what it could be instead
ALL = "*"


@dataclass(frozen=True, slots=True)
class Accepted:
    """The new text, the labels that are in it now, and what to tell a person."""

    text: str
    labels: tuple[NewLabel, ...]
    remarks: tuple[str, ...]

    @property
    def count(self) -> int:
        """How many labels these are."""
        return len(self.labels)


class NewLabel(NamedTuple):
    """One role of one element, as it is written, with a note.

    Attributes
    ----------
    line
        Of the suggestion that it comes from; 0 if from none.
    """

    section: str
    name: str
    roles: dict[str, Any]
    note: str
    line: int = 0

    @property
    def hides(self) -> bool:
        """Whether a wrong one could hide a leak, or that nobody has looked."""
        return hides(self.roles)


def accept(
    file: str,
    text: str,
    names: Sequence[str],
    person: str,
    day: str,
    vocabulary: Vocabulary,
    findings_under: Callable[[str], Collection[tuple[str, str]]] | None = None,
) -> Accepted:
    """Make labels of suggestions.

    Parameters
    ----------
    names
        Confidences, and names of elements; see ``_chosen``.
    person, day
        For the note.
    vocabulary
        In whose words the file is written.
    findings_under
        Returns the findings under a text of the file: (category, what to tell of it); None if nobody can look for any.
        Asked only if it matters, with all that is accepted and takes nothing away.

    Raises
    ------
    InputErrors
        If the file is no label file, or has comments that begin as suggestions and are none; or nothing is suggested of
        an element, or alternatives are.
    LabelError
        If the file cannot be changed without losing something.
    """
    _, comments = taken_apart(file, text)
    chosen_ones, remarks = _chosen(file, comments, names, vocabulary)
    limiting = [one for one in chosen_ones if LIMITING & set(one.roles)]
    found = None
    if limiting and findings_under:
        others = [_accepted(one, person, day) for one in chosen_ones if one not in limiting]
        found = findings_under(with_labels(file, text, others, vocabulary).text)
    allowed = []
    for one in chosen_ones:
        refused = _closing(one, found, vocabulary) if one in limiting else ""
        if refused:
            remarks.append(f"{file}:{one.line}: {shown(one.name)} {refused}")
        else:
            allowed.append(_accepted(one, person, day))
    done = with_labels(file, text, allowed, vocabulary)
    return Accepted(done.text, done.labels, (*remarks, *done.remarks))


def _accepted(comment: Comment, person: str, day: str) -> NewLabel:
    why = grounds_of(comment.why.split("; "))
    note = f"accepted by {person} on {day} ({comment.confidence}): {why}"
    return NewLabel(comment.section, comment.name, comment.roles, note, comment.line)


def with_labels(file: str, text: str, labels: Sequence[NewLabel], vocabulary: Vocabulary) -> Accepted:
    """Put labels into the text of a label file; suggestions in it that say the same are taken out.

    Raises
    ------
    InputErrors
        If the file is no label file.
    LabelError
        If it cannot be changed without losing something.
    """
    rest, comments = taken_apart(file, text)
    before = parse_labels(text, vocabulary, name=file).entries
    if facts_of(parse_labels(rest, vocabulary, name=file).entries) != facts_of(before):
        raise _by_hand(file, f"the suggestion of line {comments[0].line} is part of a text")
    rest, refusals = without_refusals(rest)
    taken: list[NewLabel] = []
    remarks: list[str] = []

    def change(top: Any) -> None:
        for label in labels:
            refused = _against(before, label, vocabulary) or _write_label(top, label, vocabulary)
            if refused:
                remarks.append(f"{file}:{label.line}: {shown(label.name)} {refused}; change it by hand")
            else:
                taken.append(label)

    try:
        new = changed(rest, change) if labels else rest
    except FAILURES as error:
        raise _by_hand(file, f"cannot be changed: {shown(str(error).splitlines()[0])}") from None
    _check(file, rest, new, taken, vocabulary)
    done = [(one.section, one.name, one.roles) for one in taken]
    left = [as_written(one) for one in comments if (one.section, one.name, one.roles) not in done]
    return Accepted(with_comments(new, [*refusals, *left]), tuple(taken), tuple(remarks))


def could_close(
    label: Mapping[str, Any], findings: Iterable[tuple[str, str]], vocabulary: Vocabulary
) -> tuple[str, ...]:
    """Return what is told of the known findings that a label could close: those of such data.

    Parameters
    ----------
    label
        One role and what it names.
    findings
        The findings: (category, what to tell of it).
    """
    if LIMITING.isdisjoint(label):
        return ()
    (value,) = label.values()
    return tuple(told for kind, told in findings if overlap(value, [kind], vocabulary) or "only" in label)


def _closing(comment: Comment, findings: Collection[tuple[str, str]] | None, vocabulary: Vocabulary) -> str:
    """Why what takes data away is not accepted: a finding is known that it could close, or nobody has looked."""
    if findings is None:
        hint = "name the policies as well, so that findings that it could close are known"
        return f"would take data away; {hint}"
    closed = could_close(comment.roles, findings, vocabulary)
    if not closed:
        return ""
    return (
        f"would take data away of which a finding is known ({shown('; '.join(closed))}); write it by hand if it is so"
    )


def _write_label(top: Any, comment: NewLabel, vocabulary: Vocabulary) -> str:
    """Write one label; return why not, if it cannot be joined to what the entry says."""
    note = DoubleQuotedScalarString(blanked(comment.note, "?"))
    ((role, value),) = comment.roles.items()
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
    other = next((one for one in against if one in entry and overlap(value, entry[one], vocabulary)), "")
    if other:
        return f"is a {other} of such data already"
    refused = _join(entry, role, value)
    if not refused:
        said = entry.get("note")
        entry["note"] = DoubleQuotedScalarString(f"{said}; {note}") if said else note
    return refused


def _against(before: Iterable[Entry], comment: NewLabel, vocabulary: Vocabulary) -> str:
    """Why one that hides is refused: a line, by a glob too, says that such data come in or go out there (rule S7)."""
    (value,) = comment.roles.values()
    for entry in before if comment.hides else ():
        meant_too = set(SECTIONS[comment.section]) & set(entry.kinds) and covered(entry.name, [bare_name(comment.name)])
        for one in entry.statements if meant_too else ():
            if one.role in BRINGS_OR_LETS_OUT and (not one.categories or overlap(value, one.categories, vocabulary)):
                return f"is a {one.role} of such data already, by line {entry.place.line}"
    return ""


def _section_of(top: Any, comment: NewLabel) -> Any:
    """The section that has an entry of that name to which the label can be joined; None if none has.

    An entry of channels speaks of a topic, a service and an action of that name. What takes data away of one of them is
    not joined to it; what such data can go through is, where it says so of other data: two lines may not (S7).
    """
    (role,) = comment.roles
    for name, kinds in SECTIONS.items():
        section = top.get(name)
        if set(SECTIONS[comment.section]) <= set(kinds) and section and comment.name in section:
            says = section[comment.name] is not None and role in section[comment.name]
            if name == comment.section or (says and role not in LIMITING):
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


def _check(file: str, old: str, new: str, labels: Iterable[NewLabel], vocabulary: Vocabulary) -> None:
    """Hold the new text against the old one: nothing is lost, and only the entries that are meant have changed."""
    touched = {(SECTIONS[comment.section], comment.name) for comment in labels}

    def read_rest(text: str) -> list[Any]:
        entries = parse_labels(text, vocabulary, name=file).entries
        return facts_of(e for e in entries if not any(e.name == name and set(k) <= set(e.kinds) for k, name in touched))

    try:
        same = read_rest(old) == read_rest(new)
    except InputErrors as error:
        first = error.errors[0]
        raise _by_hand(file, f"a suggestion makes no label: {first.problem}") from None
    if not same:
        raise _by_hand(file, "cannot be changed without changing another entry")
    if not keeps_comments(old, new):
        raise _by_hand(file, "cannot be changed without losing a comment")


def _by_hand(file: str, problem: str) -> LabelError:
    return LabelError(file, 0, problem, "write the labels by hand")


def _chosen(
    file: str, comments: Sequence[Comment], names: Sequence[str], vocabulary: Vocabulary
) -> tuple[list[Comment], list[str]]:
    """Return the suggestions that are accepted, in the order of the file, and remarks.

    Parameters
    ----------
    names
        Confidences, of which all that are as sure or surer are meant; names of elements, of which the surest are
        meant; and names with a kind or a role (``/camera=Video``, ``/uplink=leak``), or with ``*`` for all.
    """
    least = [Confidence(name) for name in names if name in tuple(Confidence)]
    taken: dict[int, Comment] = {}
    problems: list[LabelError] = []
    for name in dict.fromkeys(name for name in names if name not in tuple(Confidence)):
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


def _of_element(file: str, comments: Sequence[Comment], choice: str, vocabulary: Vocabulary) -> list[Comment]:
    """The suggestions that are meant by a name, or a name and what it is."""
    name, _, what = choice.rpartition("=") if choice.rfind("=") > 0 else (choice, "", "")
    every = [one for one in comments if one.name in (name, literal(name) if name.startswith("/") else name)]
    if not every:
        hint = "name an element of a '# suggest:' line, or certain, likely or may"
        raise LabelError(file, 0, f"nothing is suggested of {shown(name)}", hint)
    if what == ALL:
        return every
    named_so = [one for one in every if what in (*one.roles, *_words(one))] if what else _surest(every)
    if not named_so:
        raise LabelError(file, 0, f"{shown(what)!r} is not suggested of {shown(name)}", _say_which(name, every))
    if any(_alternatives(one, other, vocabulary) for one in named_so for other in named_so):
        told = ", ".join(dict.fromkeys(f"{_role(one)} {'/'.join(_words(one))} (line {one.line})" for one in named_so))
        raise LabelError(
            file, 0, f"of {shown(name)} alternatives are suggested: {shown(told)}", _say_which(name, named_so)
        )
    return named_so


def _surest(comments: Sequence[Comment]) -> list[Comment]:
    """Of what is as sure what takes data away only when it stands alone."""
    return [one for one in comments if not any(_comes_before(other, one) for other in comments)]


def _say_which(name: str, comments: Iterable[Comment]) -> str:
    first = next(iter(comments))
    what = _role(first) if _role(first) in (*BRINGS_OR_LETS_OUT[1:], *PASSES_OR_ENDS) else next(iter(_words(first)))
    return f"say which, such as --accept {shown(name)}={shown(what)}, or remove the lines that are wrong"


def _alternatives(comment: Comment, other: Comment, vocabulary: Vocabulary) -> bool:
    """Return whether two suggestions of one element are two answers to one question."""
    if comment.line == other.line or comment.name != other.name or comment.section != other.section:
        return False
    ((role, value),), ((second, instead),) = comment.roles.items(), other.roles.items()
    if role == second:
        return role == "source" or (role in ONE_OF_A_KIND and overlap(value, instead, vocabulary))
    sides = [(first in BRINGS_OR_LETS_OUT, first in PASSES_OR_ENDS) for first in (role, second)]
    against = (sides[0] == (True, False) and sides[1] == (False, True)) or (sides[1] == (True, False) and sides[0][1])
    against = against or ("sensitive" in (role, second) and (comment.takes_away or other.takes_away))
    return against and overlap(value, instead, vocabulary)


def _needs_name(comment: Comment, comments: Iterable[Comment], vocabulary: Vocabulary) -> bool:
    """Whether no word accepts it: it takes data away, is a conduit that may be, or one of a leak and a conduit."""
    if comment.takes_away or (comment.hides and comment.confidence is Confidence.MAY):
        return True
    here = [other for other in comments if other.name == comment.name and "conduit" in other.roles]
    return "leak" in comment.roles and any(_alternatives(comment, other, vocabulary) for other in here)


def _comes_before(other: Comment, comment: Comment) -> bool:
    """Whether of two suggestions for an element the other is accepted first: what takes nothing away, if as sure."""
    if other.confidence is comment.confidence:
        return comment.takes_away and not other.takes_away
    return surer(other.confidence, comment.confidence)


def _role(comment: Comment) -> str:
    return next(iter(comment.roles))


def _words(comment: Comment) -> list[str]:
    """What a suggestion names: kinds, and of what is made of them that."""
    (value,) = comment.roles.values()
    return [str(one["to"]) if isinstance(one, dict) and "to" in one else str(one) for one in value]


def _kinds(value: Any) -> Iterator[Any]:
    for one in [value] if isinstance(value, str) else value:
        yield one.get("from", "") if isinstance(one, dict) else one
