"""Suggestions in a label file: written there as comments, and made labels when a person accepts them.

In: policies and label files, or the label file alone. Out: its new text, and what to tell about it. What labels take
away of the data that a newly accepted one brings is told: they were said when nobody knew of that. No label is refused
by it and no verdict changes: a person has said both. But who accepted a ``never`` when there was no source was told of
no finding, and who accepts the source has to hear of the ``never``.
"""

from __future__ import annotations

import os
from collections import defaultdict
from functools import partial
from typing import TYPE_CHECKING, TypeVar

from rosprivacy.analysis.errors import InputError, LabelError, shown
from rosprivacy.analysis.kernel.ranks import in_words
from rosprivacy.analysis.kernel.search import present, search
from rosprivacy.analysis.kernel.states import Net
from rosprivacy.analysis.model import TYPE_LINE
from rosprivacy.analysis.suggesting.evidence import WrittenLabel
from rosprivacy.analysis.suggesting.label_questions import one_line
from rosprivacy.clock import today
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import NEW, facts_of
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_utf8
from rosprivacy.ingest.reading.path_kinds import exists
from rosprivacy.ingest.suggestion_rules.accepting import LIMITING, NewLabel, accept, overlap
from rosprivacy.ingest.suggestion_rules.comments import comment_of, taken_apart, with_comments
from rosprivacy.labelling.label_lines import LabelLines, own_file
from rosprivacy.ontology.vocabulary import load
from rosprivacy.systems.robot_system import answer_robot, read_label_files

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.kernel.search import Search
    from rosprivacy.analysis.many_flows import Meeting
    from rosprivacy.analysis.model import Element, Statement
    from rosprivacy.analysis.whatif.ledger import TakenAway
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.labelling.suggesting import Suggested
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings

    What = tuple[object, ...]  # what one row takes away of one kind, whatever the line is that says so
NewOrWritten = TypeVar("NewOrWritten", NewLabel, WrittenLabel)
BRINGING = ("source", "derives", "leak")
HINT = "see whether it is still so"
LOOK = "name the policies as well, and what of it is on the way is told"


def with_suggestions(file: str, suggestions: Suggested) -> LabelLines:
    """Return a label file with what is suggested, in place of what was suggested before.

    Raises
    ------
    InputErrors
        With every problem of the input.
    LabelError
        If the file has no room for comments, as JSON has none.
    """
    vocabulary = suggestions.result.vocabulary
    text = text_of(file)
    comments = [comment_of(one) for one in suggestions.proposals if one.label not in suggestions.by_hand]
    new = with_comments(taken_apart(file, text)[0], comments)
    check_room(file, text, new, vocabulary)
    return LabelLines(file, new, len(comments))


def check_room(file: str, text: str, new: str, vocabulary: Vocabulary) -> None:
    """Hold a text with comments at its end against that without.

    Raises
    ------
    InputErrors
        If it is no label file.
    LabelError
        If the file has no room for comments, as JSON has none.
    """
    before = facts_of(parse_labels(text, vocabulary, name=file).entries)
    if text.lstrip().startswith("{") or facts_of(parse_labels(new, vocabulary, name=file).entries) != before:
        raise LabelError(file, 0, "has no room for comments at its end", "name a file in YAML, a line for each section")


def with_accepted(
    labels: tuple[str, ...],
    names: Sequence[str],
    by: str | None,
    settings: Settings,
    policies: tuple[str, ...] = (),
) -> LabelLines:
    """Return the label file that people edit, with the suggestions in it that are accepted as labels.

    Parameters
    ----------
    policies
        Without them no findings are known, and so nothing is accepted that takes data away.
    names
        Confidences and names of elements.
    by
        Who accepts them; by default the author of the file.

    Raises
    ------
    InputErrors
        With every problem of the file.
    LabelError
        If it is not there: then there is nothing to accept.
    """
    file = own_file(labels)
    text = _read(file)
    who = who_says(file, by)
    vocabulary = load(ontologies=settings.ontologies)

    def read(new: str) -> tuple[str | Labels, ...]:
        """The label files, with that text of the one that is written."""
        own = parse_labels(new, vocabulary, name=file, category=settings.category, bounds=settings.bounds)
        return tuple(own if one == file else one for one in labels)

    def result(new: str) -> Result:
        return answer_robot(policies, read(new), settings)

    def findings_under(new: str) -> list[tuple[str, str]]:
        return [(one.category, one_line(one)) for one in result(new).analysis.findings]

    done = accept(file, text, names, who, today(os.environ), vocabulary, findings_under if policies else None)
    new_data = brings(done.labels)
    told: Iterable[str] = ()
    if new_data and policies:
        told = limits_on_the_way(result(text), result(done.text))
    elif new_data:
        told = _limits_said(new_data, _own_labels(read(done.text), vocabulary, settings), vocabulary)
    return LabelLines(file, done.text, done.count, (*done.remarks, *told))


def _own_labels(labels: tuple[str | Labels, ...], vocabulary: Vocabulary, settings: Settings) -> tuple[Labels, ...]:
    """What people have said, without what comes with the program."""
    return tuple(one for one in read_label_files(labels, vocabulary, settings) if not one.shipped)


def who_says(file: str, by: str | None, does: str = "accepts") -> str:
    """Return who accepts or answers: the one who is named, else the author of the file.

    Raises
    ------
    InputError
        If nobody is.
    """
    who = (by or _author(file, text_of(file))).strip()
    if not who:
        raise InputError(file, 0, f"nobody says who {does}", "add --by NAME, or 'author: NAME' to the file")
    return who


def text_of(file: str) -> str:
    """Return the text of a label file; of one that is not there the beginning of one.

    Raises
    ------
    LabelError
        If it cannot be read.
    """
    return _read(file) if exists(file) else NEW


def _read(file: str) -> str:
    return read_utf8(file, yaml_values.MAX_BYTES, partial(LabelError, file))[0]


def _author(file: str, text: str) -> str:
    value = yaml_values.parse(text, partial(LabelError, file)).get("author")
    return value.text if value else ""


def brings(labels: Iterable[NewOrWritten]) -> tuple[NewOrWritten, ...]:
    """Return the labels by which there are data, or an end of data, that were not there."""
    return tuple(one for one in labels if any(role in BRINGING for role in one.roles))


def limits_on_the_way(before: Result, after: Result) -> Iterator[str]:
    """Yield what labels take away after that they did not take away before, one line each.

    What is taken away of a new source is new, also where the same line took the same kind of another source before.
    """
    old = {what for row in before.taken_away for what, _ in _whats(row)}
    new = _newly_there(before, after)
    for row in after.taken_away:
        there = new.get(row.element, ()) if row.element else ()
        kinds = [kind for what, kind in _whats(row) if what not in old or kind in there]
        if kinds and row.by in LIMITING and row.element:
            to = f" -> {shown(row.to.name)}" if row.to else ""
            end = f"; behind it lies the leak {shown(row.leak.name)}" if row.leak else ""
            where = f"{row.element.kind} {shown(row.element.name)}{to}"
            at = ", ".join(map(str, row.places))
            yield f"{at}: {row.by} of {where} takes {', '.join(kinds)} away, which is accepted now{end}; {HINT}"


def _newly_there(before: Result, after: Result) -> Mapping[Element, Collection[str]]:
    """Where data of sources gets that were no sources of it before, kind by kind: at limits, too, where it ends."""
    old, new = before.analysis.spread, after.analysis.spread
    known = {old.graph.elements[vertex]: set(old.names(old.begins(vertex))) for vertex in old.facts}
    starts: dict[int, list[int]] = defaultdict(list)  # by the bits that are followed
    elements, net = new.graph.elements, Net.cached(new)
    for vertex in sorted(new.facts):
        begun = set(new.names(new.begins(vertex)))
        again = begun & known.get(elements[vertex], set())
        if begun - again:
            starts[new.all_bits & ~sum(map(new.forms_of, again))].append(vertex)
    found: dict[Element, set[str]] = defaultdict(set)
    for bits, some in starts.items():
        reach = search(net, some, bits, {})
        for vertex, there in _reached(net, reach, bits):
            found[elements[vertex]].update(new.names(there))
    return found


def _reached(net: Net, reach: Search, allowed: int) -> Iterator[tuple[int, int]]:
    """Vertices and the bits that get there, also where nothing of them is taken up: there limits are."""
    spread = net.spread
    met: dict[int, tuple[Meeting, int]] = {}
    for vertex in {*reach.arrived_bits, *reach.begun}:
        yield vertex, present(reach, vertex)
    for vertex in {*reach.left_bits, *reach.begun}:
        leaving = reach.left_bits.get(vertex, 0)
        for index, target, _ in net.flows.get(vertex, ()):
            begun = spread.flow_emits.get(index, 0) & allowed if vertex in reach.begun else 0
            yield target, (leaving | begun) & spread.flow_keeps.get(index, spread.all_bits)
        for meeting in net.meetings.get(vertex, ()):
            met[id(meeting)] = meeting, met.get(id(meeting), (meeting, 0))[1] | leaving
    for meeting, bits in met.values():
        yield from ((target, bits) for target in meeting.read)


def _limits_said(accepted: Sequence[NewLabel], files: Iterable[Labels], vocabulary: Vocabulary) -> Iterator[str]:
    """Yield what label files take away of data that accepted labels are about: where, nobody knows without policies."""
    for file in files:
        said = [(one, shown(entry.name)) for entry in file.entries for one in entry.statements]
        said += [
            (one, f"{shown(flow.source)} -> {shown(flow.target)}") for flow in file.flows for one in flow.statements
        ]
        there = [
            f"{in_words(one) if one.role == TYPE_LINE else one.role} of {name} (line {one.place.line})"
            for one, name in said
            if one.role in (*LIMITING, TYPE_LINE) and any(_limits(one, label, vocabulary) for label in accepted)
        ]
        if there:
            what = ", ".join(dict.fromkeys(kind for label in accepted for kind in _kinds(label)))
            yield f"{file.file}: {what} is accepted, and such data may be taken away by {', '.join(there)}; {LOOK}"


def _limits(statement: Statement, label: NewLabel, vocabulary: Vocabulary) -> bool:
    """Whether a statement may take away data that a label is about."""
    if statement.role == TYPE_LINE:
        return True
    if statement.role == "only":
        kinds = [vocabulary.find(kind) for kind in _kinds(label)]
        through = set(statement.categories)
        return any(not kind or not through & set(vocabulary.hierarchy.ancestors[kind.name]) for kind in kinds)
    return not statement.categories or overlap(list(statement.categories), _kinds(label), vocabulary)


def _kinds(label: NewLabel) -> list[str]:
    """What there is more of: of a derivation what it makes."""
    ((_, value),) = label.roles.items()
    return [str(one["to"] if isinstance(one, dict) else one) for one in value]


def _whats(row: TakenAway) -> Iterator[tuple[What, str]]:
    for kind in row.categories:
        yield (row.by, row.element, row.to, kind, row.leak), kind
